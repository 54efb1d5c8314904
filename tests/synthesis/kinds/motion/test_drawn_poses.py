"""Tolerances of two to four positions where a slider, stated rotations or a driver dyad are asked for too."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.support.synthesis.drawn_poses import LID, ZONES, Statement, planted_slider


def within(design: Any, problem: Statement) -> None:
    """What a design says of each pose is within the tolerance, and its own check says so too."""
    for stated, target in zip(problem["positions"], design.targets, strict=True):
        tolerance = stated.get("tolerance", {"x": 0.0, "y": 0.0, "angle": 0.0})
        assert target.point_residual <= math.hypot(tolerance["x"], tolerance["y"]) + 1e-7
        assert abs(target.angle_residual) <= tolerance["angle"] + 1e-7
    assert {check.name: check.passed for check in design.verification.checks}["within_tolerance"]


@pytest.mark.slow
@pytest.mark.parametrize("seed", further([5, 12, 16], [5]))
def test_a_slider_uses_the_tolerances(seed: int) -> None:
    """No slider-crank was met that meets these positions exactly with its pivots in their zones."""
    problem = planted_slider(seed)
    assert not solve(parse_problem(problem | {"method": "exact"})).designs
    result = solve(parse_problem(problem))
    assert not result.search.complete
    for design in result.designs:
        assert design.mechanism.type == "slider_crank"
        assert design.verification.passed
        within(design, problem)
    assert result.designs


@pytest.mark.slow
def test_a_fourbar_with_a_driver_dyad_uses_the_tolerances() -> None:
    problem: Statement = {"kind": "motion", "positions": LID, "driver_dyad": True, "constraints": ZONES}
    designs = solve(parse_problem(problem)).designs
    for design in designs:
        assert design.mechanism.type == "watt_2"
        assert design.verification.passed
        within(design, problem)
    assert designs


@pytest.mark.campaign
def test_a_link_at_a_stated_angle_uses_the_tolerances() -> None:
    problem: Statement = {
        "kind": "motion",
        "positions": LID,
        "method": "least_squares",
        "input_side": {"link_angle": 60.0},
        "constraints": {"fixed_pivot_region": ZONES["fixed_pivot_region"]},
    }
    assert not solve(parse_problem(problem | {"method": "exact"})).designs
    designs = solve(parse_problem(problem)).designs
    for design in designs:
        assert design.verification.passed
        within(design, problem)
        assert math.remainder(design.mechanism.reference_input_angle - 60.0, 180.0) == pytest.approx(0.0, abs=1e-6)
    assert designs


@pytest.mark.parametrize(
    ("side", "field"),
    [({"rotations": [None, 80.0]}, "/input_side/rotations"), ({"link_angle": 20.0}, "/input_side/link_angle")],
)
def test_what_holds_at_positions_met_exactly_is_refused_beside_tolerances(side: Statement, field: str) -> None:
    first = {**LID[0], "tolerance": {"x": 20.0, "y": 20.0, "angle": 10.0}}
    problem: Statement = {"kind": "motion", "positions": [first, *LID[1:]], "input_side": side}
    assert [c.path for c in parse_problem(problem).find_contradictions()] == [field]
    assert not parse_problem(problem | {"method": "exact"}).find_contradictions()


FIRST_MISSED: list[Statement] = [
    {"x": 20.0, "y": 53.0, "angle": 110.0, "tolerance": {"x": 5.0, "y": 5.0, "angle": 3.0}},
    {"x": 62.0, "y": -37.0, "angle": 138.0},
]


@pytest.mark.slow
@pytest.mark.parametrize("side", [{}, {"dyad": "PR"}, {"dyad": "RP"}])
def test_the_reference_is_the_first_target_where_that_may_be_missed(side: Statement) -> None:
    """Its input, its body's angle and its P are those of the first target."""
    problem: Statement = {"kind": "motion", "positions": FIRST_MISSED, "output_side": side}
    if not side:
        problem["input_side"] = {"fixed_pivot": [90.0, 40.0]}
    designs = solve(parse_problem(problem)).designs
    assert designs
    for design in designs:
        mechanism, target, stated = design.mechanism, design.targets[0], FIRST_MISSED[0]
        assert math.remainder(target.input_angle - mechanism.reference_input_angle, 360.0) == pytest.approx(
            0.0, abs=1e-5
        )
        stands = stated["angle"] if mechanism.reference_body_angle is None else mechanism.reference_body_angle
        assert abs(stands - stated["angle"]) == pytest.approx(target.angle_residual, abs=1e-5)
        x, y = mechanism.skeleton.joints["P"]
        assert math.hypot(x - stated["x"], y - stated["y"]) == pytest.approx(target.point_residual, abs=1e-5)


@pytest.mark.campaign
def test_a_driver_dyad_drives_linkages_whose_first_position_is_missed() -> None:
    problem: Statement = {"kind": "motion", "positions": FIRST_MISSED, "driver_dyad": True}
    problem["constraints"] = {"moving_pivot_region": {"x": [20.0, 154.0], "y": [-8.0, 126.0]}}
    result = solve(parse_problem(problem))
    assert result.search.rejected.get("driver_dyad", 0) <= 2
    missed = 0
    for design in result.designs:
        assert design.verification.passed
        within(design, {"positions": [FIRST_MISSED[0], FIRST_MISSED[1]]})
        missed += design.targets[0].point_residual > 1e-3
    assert missed


def test_rotations_that_are_all_open_state_nothing() -> None:
    problem: Statement = {"kind": "motion", "positions": LID, "input_side": {"rotations": [None, None]}}
    assert not parse_problem(problem).find_contradictions()


@pytest.mark.slow
@pytest.mark.parametrize("stated", [{"moving_pivot": [10.0, -20.0]}, {"coupler_vector": {"angle": 20.0}}])
def test_what_is_stated_of_the_body_goes_with_it_where_its_first_position_is_missed(stated: Statement) -> None:
    """With 60 degrees demanded no slider-crank is met unless the first tolerance is used."""
    first = {"x": 0.0, "y": 0.0, "angle": 0.0, "tolerance": {"x": 3.0, "y": 3.0, "angle": 3.0}}
    problem: Statement = {
        "kind": "motion",
        "positions": [first, {"x": 40.0, "y": 15.0, "angle": -25.0}, {"x": 75.0, "y": 5.0, "angle": -60.0}],
        "input_side": stated,
        "output_side": {"dyad": "PR"},
        "constraints": {"min_transmission_angle": 60.0},
    }
    designs = solve(parse_problem(problem)).designs
    assert any(design.targets[0].point_residual > 0.1 for design in designs)
    for design in designs:
        joints = {name: complex(*place) for name, place in design.mechanism.skeleton.joints.items()}
        back = cmath.exp(-1j * math.radians(design.mechanism.reference_body_angle or 0.0))
        arm = back * (joints["P"] - joints["A"])
        if "moving_pivot" in stated:
            assert -arm == pytest.approx(complex(10.0, -20.0), abs=1e-5)
        else:
            assert math.degrees(cmath.phase(arm)) == pytest.approx(20.0, abs=1e-5)


@pytest.mark.campaign
def test_designs_of_several_sets_of_poses_differ() -> None:
    problem: Statement = {
        "kind": "motion",
        "positions": [
            {"x": 0.0, "y": 0.0, "angle": 0.0},
            {"x": 40.0, "y": 15.0, "angle": -25.0, "tolerance": 4.0},
            {"x": 75.0, "y": 5.0, "angle": -60.0, "tolerance": 4.0},
        ],
        "input_side": {"link_angle": 60.0},
        "output_side": {"fixed_pivot": [60.0, -50.0]},
    }
    designs = solve(parse_problem(problem)).designs
    joints = np.array([[complex(*place) for place in d.mechanism.skeleton.joints.values()] for d in designs])
    apart = np.abs(joints[:, None] - joints).max(axis=2) + 1e9 * np.eye(len(designs))
    assert len(designs) > 5
    assert apart.min() > 0.015 * 76.0
