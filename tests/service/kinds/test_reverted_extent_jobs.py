"""How far a search of reverted trains may reach: by the meshes that share a distance, through HTTP and counted."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from fractions import Fraction
from typing import Any

import httpx
import pytest

from synthesis.kinds.gear_train.statement import search_size
from synthesis.registry import parse_problem
from tests.support.service.answers import finished

MANY_MODULES: dict[str, Any] = {
    "kind": "gear_train", "ratio": "pi", "max_stages": 4, "teeth": {"min": 12, "max": 66}, "reverted": True,
    "module": [4.0, 5.0, 6.0, 8.0, 10.0, 12.0], "max_designs": 2,
}  # fmt: skip
"""Some 10⁷ choices of three stages that share a distance with the fourth; 4·10⁹ whatever their distances."""


@pytest.mark.campaign
def test_many_modules_in_four_stages_are_searched(client: httpx.Client) -> None:
    job = finished(client, MANY_MODULES)
    assert job["status"] == "succeeded", job["error"]
    design = job["result"]["designs"][0]
    assert job["result"]["search"]["complete"]
    assert design["verification"]["passed"]
    stages = design["mechanism"]["stages"]
    assert len({stage["module"] * (stage["driver"] + stage["driven"]) for stage in stages}) == 1
    assert abs(design["metrics"]["relative_error"]) < 1e-6


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"teeth": {"min": 12, "max": 400}}, "/problem/teeth"),
        ({"teeth": None, "stock": [*range(12, 400)]}, "/problem/stock"),
    ],
)  # fmt: skip
def test_what_would_take_hours_is_refused(client: httpx.Client, changes: dict[str, Any], path: str) -> None:
    reply = client.post("/v1/jobs", json={"problem": {**MANY_MODULES, **changes}})
    assert reply.status_code == 422
    faults = {fault["path"]: fault["detail"] for fault in reply.json()["errors"]}
    assert "combinations of meshes" in faults[path]


@pytest.mark.parametrize("gears", [{"teeth": {"min": 14, "max": 29}}, {"stock": [15, 15, 18, 22, 23, 40]}])
@pytest.mark.parametrize("stages", [2, 3, 4])
def test_the_extent_is_that_of_meshes_of_one_distance(
    gears: dict[str, Any], stages: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Counted mesh by mesh: choices of all stages but one, of every distance."""
    modules = [1.0, 1.25, 2.0]
    stated = {**MANY_MODULES, "teeth": None, "module": modules, "max_stages": stages, **gears}
    numbers = sorted(set(gears["stock"])) if "stock" in gears else range(14, 30)
    meshes = Counter(
        Fraction(str(module)) * (one + two) for module in modules for one, two in itertools.product(numbers, repeat=2)
    )
    choices = sum(math.comb(count + stages - 2, stages - 1) for count in meshes.values())
    problem = parse_problem({key: value for key, value in stated.items() if value is not None})
    for most, refused in ((choices, False), (choices - 1, True)):
        monkeypatch.setattr(search_size, "COAXIAL_LIMIT", (most, search_size.COAXIAL_LIMIT[1]))
        assert any("combinations" in fault.detail for fault in problem.find_contradictions()) == refused
