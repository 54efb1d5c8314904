"""Every check that exists for a demand on a cam is in the answer, whatever else is demanded: all pairs of demands."""

from __future__ import annotations

import copy
from itertools import combinations
from typing import Any

import pytest

from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.campaign import further

Statement = dict[str, Any]

BASE: Statement = {
    "kind": "cam",
    "segments": [
        {"motion": "dwell", "angle": 90.0},
        {"motion": "rise", "angle": 90.0, "lift": 20.0, "law": "optimal"},
        {"motion": "dwell", "angle": 60.0},
        {"motion": "return", "angle": 120.0, "law": "modified_sine"},
    ],
    "minimize": "peak_acceleration",
    "speed_rpm": 300.0,
    "limits": {"jerk": 2500.0, "pressure_angle": 40.0},
    "include_failed": True,
}

ROLLER: Statement = {"type": "translating_roller", "roller_radius": 8.0}
FACE: Statement = {"type": "translating_flat"}

ALWAYS = {"keeps_the_statement", "touches_everywhere", "reproduces_program", "no_cusp", "does_not_cross_itself"}

OF_ROLLERS = {"pressure_angle", "pressure_angle_fall", "curvature_ratio"}
OF_FACES = {"min_radius", "convex"}

DEMANDS: dict[str, tuple[Statement, set[str]]] = {
    "velocity": ({"limits": {"velocity": 40.0}}, {"table_velocity", "peak_velocity"}),
    "acceleration": ({"limits": {"acceleration": 90.0}}, {"table_acceleration", "peak_acceleration"}),
    "jerk": ({"limits": {"jerk": 2000.0}}, {"table_jerk", "peak_jerk"}),
    "hub": ({"limits": {"hub_radius": 20.0}}, {"hub_radius"}),
    "size": ({"limits": {"size": 200.0}}, {"size"}),
    "fall": ({"limits": {"pressure_angle_fall": 45.0}}, set()),
    "preload": ({"dynamics": {"mass": 0.5, "spring_rate": 3.0, "preload": 20.0}}, {"contact_force"}),
    "least force": ({"dynamics": {"mass": 0.5, "spring_rate": 3.0, "least_force": 5.0}}, {"contact_force"}),
    "damping": ({"dynamics": {"mass": 0.5, "spring_rate": 3.0, "damping_ratio": 0.05}}, {"contact_force"}),
    "position": ({"conditions": [{"angle": 45.0, "s": 9.0}]}, {"meets_positions"}),
    "rate": ({"conditions": [{"angle": 50.0, "v": 20.0}]}, {"meets_positions", "meets_velocities"}),
    "band": ({"bands": [{"start": 60.0, "end": 66.0, "lower": 12.0, "upper": 19.0}]}, {"meets_positions"}),
    "face width": ({"limits": {"face_width": 90.0}}, {"face_width"}),
    "jumps": ({"accept_discontinuity": True}, set()),
    "rotation": ({"rotation": "cw"}, set()),
}
"""What is added to the statement, and the checks that have to stand in its answer."""

ONLY_FACES = {"face width"}
ONLY_ROLLERS = {"fall"}


def stated(follower: Statement, *names: str) -> tuple[Statement, set[str]]:
    """A statement with some demands at once, and the checks that it must have."""
    problem = copy.deepcopy(BASE) | {"follower": follower}
    wanted = ALWAYS | (OF_FACES if follower is FACE else OF_ROLLERS) | {"table_jerk", "peak_jerk"}
    for name in names:
        fields, checks = DEMANDS[name]
        wanted |= checks
        for field, value in fields.items():
            if field in ("conditions", "bands"):
                problem["segments"][1].setdefault(field, []).extend(value)
            elif isinstance(value, dict):
                problem[field] = problem.get(field, {}) | value
            else:
                problem[field] = value
    return problem, wanted


def pairs(only: set[str]) -> list[tuple[str, str]]:
    """All pairs of demands that go together with a follower."""
    return list(combinations([name for name in DEMANDS if name not in only], 2))


def missing(follower: Statement, *names: str) -> set[str]:
    """The checks that the answer lacks."""
    problem, wanted = stated(follower, *names)
    (design,) = solve(parse_problem(problem)).designs
    return wanted - {check.name for check in design.verification.checks}


@pytest.mark.slow
@pytest.mark.parametrize("name", further(DEMANDS, ("least force", "hub", "rate", "jumps")))
def test_a_demand_alone_is_checked(name: str) -> None:
    assert not missing(FACE if name in ONLY_FACES else ROLLER, name)


@pytest.mark.campaign
@pytest.mark.parametrize("pair", pairs(ONLY_FACES), ids="+".join)
def test_two_demands_are_both_checked_under_a_roller(pair: tuple[str, str]) -> None:
    assert not missing(ROLLER, *pair)


@pytest.mark.campaign
@pytest.mark.parametrize("pair", pairs(ONLY_ROLLERS), ids="+".join)
def test_two_demands_are_both_checked_under_a_face(pair: tuple[str, str]) -> None:
    assert not missing(FACE, *pair)


@pytest.mark.campaign
def test_all_demands_at_once_are_checked() -> None:
    assert not missing(ROLLER, *(name for name in DEMANDS if name not in ONLY_FACES))
    assert not missing(FACE, *(name for name in DEMANDS if name not in ONLY_ROLLERS))
