"""Form-closed cams: both walls of the groove are made, and each alone gives the program back."""

from __future__ import annotations

import copy

import numpy as np
import pytest

from synthesis.analyses import parse_request
from synthesis.dispatch import solve
from synthesis.kinds.cam.verification.verify import verify
from synthesis.registry import list_examples, parse_problem

GROOVE = copy.deepcopy(list_examples("cam")[0]) | {"closure": "form", "dynamics": {"mass": 1.0}}
FOLLOWERS = [
    {"type": "translating_roller", "roller_radius": 8.0, "offset": 6.0},
    {"type": "oscillating_roller", "roller_radius": 8.0, "arm": 80.0, "pivot_distance": 100.0},
    {"type": "oscillating_roller", "roller_radius": 8.0, "arm": 80.0, "pivot_distance": 100.0, "sense": -1},
]


def designed(follower, rotation="ccw", **changes):
    statement = copy.deepcopy(GROOVE) | {"follower": follower, "rotation": rotation} | changes
    for segment in statement["segments"]:
        if "lift" in segment:
            segment["lift"] = 12.0
    problem = parse_problem(statement)
    (design,) = solve(problem, lambda fraction, message: None).designs
    return problem, design


def points(curve):
    return np.array(curve.x) + 1j * np.array(curve.y)


@pytest.mark.slow
@pytest.mark.parametrize("rotation", ["ccw", "cw"])
@pytest.mark.parametrize("follower", FOLLOWERS, ids=["slide", "arm with", "arm against"])
def test_both_walls_carry_the_roller(follower, rotation):
    _, design = designed(follower, rotation)
    checks = {check.name: check for check in design.verification.checks}
    assert checks["outer_wall_reproduces_program"].passed
    assert checks["outer_wall_reproduces_program"].value <= 1e-6
    mechanism = design.mechanism
    # The walls are a roller's diameter apart across every centre, and its radius from all of them.
    centre, inner, outer = (points(c) for c in (mechanism.pitch_curve, mechanism.profile, mechanism.outer_wall))
    assert np.abs(np.abs(centre - inner) - 8.0).max() < 1e-9
    assert np.abs(np.abs(centre - outer) - 8.0).max() < 1e-9
    assert np.abs(0.5 * (inner + outer) - centre).max() < 1e-9
    for k in range(0, len(centre), 37):
        assert np.abs(outer - centre[k]).min() > 8.0 - 1e-3
    assert design.metrics.forces.wall_changes


@pytest.mark.parametrize("radius", [10.5, 11.25, 12.0, 12.75, 13.5, 14.25])
def test_small_rollers_get_the_points_that_the_outer_wall_needs(radius):
    """Its chords are longer than the inner wall's, and the roller must span some of either."""
    follower = {"type": "translating_roller", "roller_radius": radius, "prime_radius": 80.0}
    _, design = designed(follower, profile_points=180)
    assert design.verification.passed


@pytest.mark.slow
def test_a_wall_that_was_tampered_with_is_found():
    problem, design = designed(FOLLOWERS[0])
    wall = design.mechanism.outer_wall
    bump = list(wall.x)
    bump[200] += 0.002

    def broken(curve):
        verdict, _ = verify(problem, design.mechanism.model_copy(update={"outer_wall": curve}))
        return {check.name for check in verdict.checks if not check.passed}

    assert broken(wall) == set()
    assert "outer_wall_reproduces_program" in broken(wall.model_copy(update={"x": bump}))
    wide = wall.model_copy(update={"x": [1.001 * x for x in wall.x], "y": [1.001 * y for y in wall.y]})
    assert "outer_wall_reproduces_program" in broken(wide)
    assert "outer_wall_reproduces_program" in broken(None)


@pytest.mark.slow
def test_the_analysis_measures_the_play():
    _, design = designed(FOLLOWERS[1])
    mechanism = design.mechanism.model_dump(exclude_none=True)
    answer = parse_request({"mechanism": mechanism}).build_answer()
    assert np.abs(answer["play"]).max() < 1e-4
    mechanism["follower"]["roller_radius"] = 7.9
    mechanism["prime_radius"] -= 0.05
    loose = parse_request({"mechanism": mechanism}).build_answer()
    # 0.2 between the walls, across the roller's way; on an arm of 80 that is 0.14° and more where the wall is oblique.
    assert min(loose["play"]) > 0.13


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"follower": {"type": "translating_flat"}}, "/closure"),
        ({"minimize": "peak_contact_force", "dynamics": {"mass": 1.0}, "speed_rpm": 60.0}, "/minimize"),
    ],
)
def test_what_a_groove_cannot_do_is_refused(changes, path):
    found = parse_problem(copy.deepcopy(GROOVE) | changes).find_contradictions()
    assert path in [contradiction.path for contradiction in found]
