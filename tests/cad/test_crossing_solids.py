"""Solids of gears whose shafts are not parallel: valid, as large as the model says, and never in one another."""

from __future__ import annotations

from functools import cache
from itertools import combinations
from typing import Any

import pytest

from service.parts import cad
from service.parts.made import made
from service.parts.model import Assembly
from service.parts.sizes import PartsQuery
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.cad.readers import assert_valid_glb
from tests.service.test_parts_of_gears import BEVELS, WORM

pytestmark = [pytest.mark.cad, pytest.mark.timeout(600)]

PROBLEMS: dict[str, dict[str, Any]] = {"worm": WORM, "bevels": BEVELS}

INPUTS = {"worm": (0.777,), "bevels": (0.0, 0.777)}
"""Where the kernel looks at them: it takes a minute or two for one place of a worm in its gear."""

FLAT = 1e-4
"""Millimetres that two boxes may share: the kernel's are a little too large."""


@cache
def assembly(name: str) -> Assembly:
    problem = parse_problem(PROBLEMS[name])
    return made(solve(problem, lambda _fraction, _message: None).designs[0], problem, PartsQuery())


@cache
def solids(name: str) -> list[Any]:
    return [cad.solid(part) for part in assembly(name).parts]


@pytest.mark.parametrize("name", PROBLEMS)
def test_solids_are_valid_and_as_large_as_the_model_says(name: str) -> None:
    for part, solid in zip(assembly(name).parts, solids(name), strict=True):
        assert solid.is_valid
        # Sections of bevel teeth are polygons in the model.
        assert solid.volume == pytest.approx(part.volume, rel=1e-4 if part.sort == "gear" else 1e-6)
    assert_valid_glb(cad.glb(cad.placed(assembly(name), solids(name), 0.3), "assembly"))


@pytest.mark.parametrize("name", PROBLEMS)
def test_the_kernel_sees_no_solid_in_another(name: str) -> None:
    whole = assembly(name)
    for at in INPUTS[name]:
        placed = cad.placed(whole, solids(name), at)
        for (n, one), (m, other) in combinations(enumerate(placed), 2):
            a, b = one.bounding_box(), other.bounding_box()
            if all(
                min(getattr(a.max, axis), getattr(b.max, axis)) - max(getattr(a.min, axis), getattr(b.min, axis)) > FLAT
                for axis in "XYZ"
            ):
                common = one.intersect(other)
                shared = sum(getattr(body, "volume", 0.0) for body in ([] if common is None else list(common)))
                assert shared < 1e-6, (whole.parts[n].name, whole.parts[m].name)
