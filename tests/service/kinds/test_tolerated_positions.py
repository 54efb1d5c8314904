"""Tolerances of two to four positions through HTTP: used beside whatever else is stated of the linkage, or refused."""

import math

import pytest

from tests.campaign import further
from tests.support.service.answers import drawn, finished
from tests.support.synthesis.drawn_poses import LID, ZONES, planted_slider

STATED = {
    "slider": planted_slider(12),
    "link angle": {
        "kind": "motion",
        "positions": LID,
        "input_side": {"link_angle": 60.0},
        "constraints": {"fixed_pivot_region": ZONES["fixed_pivot_region"]},
    },
    "driver dyad": {"kind": "motion", "positions": LID, "driver_dyad": True, "constraints": ZONES},
}
"""None has an answer without its tolerances."""


@pytest.mark.slow
@pytest.mark.parametrize("name", further(STATED, list(STATED)[:1]))
def test_tolerances_are_used_beside_other_choices_and_demands(client, name):
    problem = STATED[name]
    job = finished(client, problem)
    assert job["status"] == "succeeded", job["error"]
    designs = job["result"]["designs"]
    assert designs
    for design in designs:
        assert design["verification"]["passed"]
        checks = {check["name"]: check for check in design["verification"]["checks"]}
        assert 0.0 < checks["within_tolerance"]["value"] <= 1.0
        for stated, target in zip(problem["positions"], design["targets"], strict=True):
            allowed = stated.get("tolerance", {"x": 0.0, "y": 0.0, "angle": 0.0})
            assert target["point_residual"] <= math.hypot(allowed["x"], allowed["y"]) + 1e-7
            assert abs(target["angle_residual"]) <= allowed["angle"] + 1e-7
    drawn(client, f"/v1/jobs/{job['id']}/designs/0", designs[0])


@pytest.mark.parametrize(
    ("side", "first", "path"),
    [
        ({"rotations": [40.0, 80.0]}, {}, "/problem/input_side/rotations"),
        ({"link_angle": 20.0}, {"tolerance": 5.0}, "/problem/input_side/link_angle"),
    ],
)
def test_what_holds_at_positions_met_exactly_is_refused_beside_tolerances(client, side, first, path):
    problem = {"kind": "motion", "positions": [LID[0] | first, *LID[1:]], "input_side": side}
    answer = client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == [path]


@pytest.mark.slow
@pytest.mark.parametrize("side", [{}, {"output_side": {"dyad": "PR"}}, {"driver_dyad": True}])
@pytest.mark.parametrize("tolerance", [1e-14, {"x": 1e-14, "angle": 1e-15}, {"angle": 1e-13}])
def test_tolerances_below_rounding_give_what_exact_positions_give(client, side, tolerance):
    exact = [{"x": x, "y": y, "angle": a} for x, y, a in ((100, 100, 0), (120, 110, 25), (145, 108, 60))]
    stated = [exact[0], *({**position, "tolerance": tolerance} for position in exact[1:])]
    results = [
        finished(client, {"kind": "motion", "positions": positions, "max_designs": 3, **side})["result"]
        for positions in (exact, stated)
    ]
    assert results[0]["designs"]
    assert results[1]["designs"] == results[0]["designs"]
    assert results[1]["search"] == results[0]["search"]


@pytest.mark.slow
@pytest.mark.parametrize("angles", further([[0, 30, 60], [0, 20, 40, 60], [0, -60, -90]], [[0, 30, 60]]))
def test_a_body_that_turns_about_a_point_within_tolerances_of_its_angle_is_driven(client, angles):
    """The linkage holds the point nearly still, so that it alone does not tell where a target is met."""
    positions = [{"x": 0, "y": 0, "angle": angle, "tolerance": {"angle": 3.0}} for angle in angles]
    result = finished(client, {"kind": "motion", "positions": positions, "driver_dyad": True})["result"]
    assert len(result["designs"]) == 10
    for design in result["designs"]:
        checks = {check["name"]: check for check in design["verification"]["checks"]}
        assert design["verification"]["passed"]
        assert checks["limits"]["value"] <= checks["limits"]["limit"]
        assert all(target["point_residual"] <= 1e-8 for target in design["targets"])
        assert all(abs(target["angle_residual"]) <= 3.0 for target in design["targets"])
