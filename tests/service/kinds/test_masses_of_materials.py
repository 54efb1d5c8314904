"""Links that weigh what their plates do: a material in place of a density, and sizes that are those of the layout."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.campaign import further
from tests.service.stated.linkages import DWELL, FUNCTION, LINE, MOTION, PARALLEL, PATH, QUICK_RETURN, STEERING
from tests.support.service.answers import finished

DENSITIES = {"steel": 7850.0, "aluminium": 2700.0, "PETG": 1270.0}
LAYOUT = {"link_width": 0.5, "pin_diameter": 0.2, "thickness": 3.0}
KINDS = {
    "motion": MOTION,
    "path": PATH,
    "function": FUNCTION,
    "quick_return": QUICK_RETURN,
    "straight_line": LINE,
    "dwell": DWELL,
    "parallel_motion": PARALLEL,
    "steering": {**STEERING, "mechanism": "ackermann"},
}


def peaks(client: Any, problem: dict[str, Any]) -> tuple[Any, dict[str, float]]:
    """The job, and the forces of its first design."""
    job = finished(client, {**problem, "max_designs": 1})
    assert job["status"] == "succeeded", job["error"]
    forces = job["result"]["designs"][0]["forces"]
    assert "remark" not in forces, forces
    return job, {name: forces[name]["max"] for name in ("shaking_force", "joint_force")}


@pytest.mark.parametrize("kind", further(KINDS, ["motion"]))
def test_plates_of_a_material_are_those_of_the_layout_where_no_sizes_are_stated(client: Any, kind: str) -> None:
    base = {**KINDS[kind], "layout": LAYOUT}

    def of(**links: Any) -> dict[str, float]:
        return peaks(client, {**base, "dynamics": {"links": links, "speed_rpm": 60.0}})[1]

    plates = of(material="steel")
    for material in ("aluminium", "PETG"):
        lighter = of(material=material)
        for name, force in plates.items():
            assert lighter[name] == pytest.approx(DENSITIES[material] / DENSITIES["steel"] * force, rel=1e-6)
    assert plates == of(density=7850.0, width=0.5, thickness=3.0)
    assert plates == of(material="steel", density=None, width=None, thickness=None)
    assert of(material="steel", thickness=6.0)["shaking_force"] == pytest.approx(
        2.0 * plates["shaking_force"], rel=1e-6
    )
    assert of(material="steel", width=0.9)["shaking_force"] > 1.01 * plates["shaking_force"]


def test_a_block_of_the_callers_takes_the_plates_of_the_layout_and_what_is_stated_of_a_link_comes_first(
    client: Any,
) -> None:
    job, plates = peaks(
        client, {**MOTION, "layout": LAYOUT, "dynamics": {"links": {"material": "steel"}, "speed_rpm": 60.0}}
    )
    path = f"/v1/jobs/{job['id']}/designs/0/forces"

    def posted(block: dict[str, Any]) -> float:
        answer = client.post(path, json={"dynamics": {"speed_rpm": 60.0, **block}})
        assert answer.status_code == 200, answer.text
        force = answer.json()["dynamics"]["shaking"]["force"]
        return max(math.hypot(x, y) for x, y in zip(force["x"], force["y"], strict=True))

    assert posted({"links": {"material": "steel"}}) == pytest.approx(plates["shaking_force"], rel=1e-3)
    none = {link: {"mass": 0.0} for link in ("input", "coupler", "output")}
    assert posted({"links": {"material": "steel"}, "bodies": none}) == 0.0
    own = {**none, "input": {"shape": {"material": "aluminium", "width": 0.5, "thickness": 3.0}}}
    same = {**none, "input": {"shape": {"density": 2700.0, "width": 0.5, "thickness": 3.0}}}
    assert posted({"bodies": own}) == posted({"bodies": same}) > 0.0


@pytest.mark.parametrize(
    ("problem", "path"),
    [
        ({"dynamics": {"links": {"material": "steel"}, "speed_rpm": 1.0}}, "/problem/dynamics/links"),
        ({"dynamics": {"links": {"material": "steel", "width": 1.0}, "speed_rpm": 1.0}}, "/problem/dynamics/links"),
        ({"dynamics": {"links": {"width": 1.0, "thickness": 1.0}, "speed_rpm": 1.0}}, "/problem/dynamics/links"),
        (
            {"layout": LAYOUT, "dynamics": {"links": {"material": "steel", "density": 1.0}, "speed_rpm": 1.0}},
            "/problem/dynamics/links",
        ),
        ({"dynamics": {"links": {"material": "tin"}, "speed_rpm": 1.0}}, "/problem/dynamics/links/material"),
        (
            {"layout": LAYOUT, "dynamics": {"links": {"material": "steel"}, "units": "consistent", "speed_rpm": 1.0}},
            "/problem/dynamics",
        ),
        (
            {"dynamics": {"bodies": {"input": {"mass": 1.0, "cg": [0, 0], "shape": {"material": "steel", "width": 1.0,
             "thickness": 1.0}}}, "speed_rpm": 1.0}},
            "/problem/dynamics/bodies/input",
        ),
    ],
)  # fmt: skip
def test_what_is_no_plate_is_told(client: Any, problem: dict[str, Any], path: str) -> None:
    refused = client.post("/v1/jobs", json={"problem": {**MOTION, **problem}})
    assert refused.status_code == 422, refused.text
    assert path in [error["path"] for error in refused.json()["errors"]]
