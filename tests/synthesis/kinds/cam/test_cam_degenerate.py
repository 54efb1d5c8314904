"""Cams at the edge of sense: each is refused where it is stated, or answered rightly, or said not to be found."""

from __future__ import annotations

import copy
import math

import numpy as np
import pytest
from pydantic import ValidationError

from synthesis.dispatch import solve
from synthesis.kinds.cam.sizing.critical_points import find_smallest_allowed
from synthesis.registry import list_examples, parse_problem
from tests.campaign import further
from tests.support.synthesis.cam_sampling import random_program

BASE = list_examples("cam")[0]
ROLLER = {"type": "translating_roller", "roller_radius": 10.0}
ARM = {"type": "oscillating_roller", "roller_radius": 8.0, "arm": 80.0, "pivot_distance": 100.0}
BARREL = {"type": "barrel_roller", "roller_radius": 10.0}


def cam(lift=25.0, laws=("modified_sine", "cycloidal"), angles=(90.0, 90.0, 90.0, 90.0), **changes):
    rest, rise, top, fall = angles
    segments = [
        {"motion": "dwell", "angle": rest},
        {"motion": "rise", "angle": rise, "lift": lift, "law": laws[0]},
        {"motion": "dwell", "angle": top},
        {"motion": "return", "angle": fall, "law": laws[1]},
    ]
    return copy.deepcopy(BASE) | {"segments": segments} | changes


def polynomial(*values):
    conditions = [{"angle": angle} | stated for angle, stated in values]
    return cam(segments=[{"motion": "polynomial", "angle": 360.0, "conditions": conditions}])


REST = {"v": 0.0, "a": 0.0}

REFUSED = {
    "lift zero": (cam(0.0), "/segments/1/lift"),
    "lift not a number": (cam(math.nan), "/segments/1/lift"),
    "one dwell": (cam(segments=[{"motion": "dwell", "angle": 360.0}]), "/segments"),
    "dwells": (cam(segments=[{"motion": "dwell", "angle": 180.0}] * 2), "/segments"),
    "level polynomial": (polynomial((0.0, {"s": 5.0})), "/segments"),
    "level polynomial with conditions": (polynomial((0.0, {"s": 5.0} | REST), (180.0, {"s": 5.0})), "/segments"),
    "constant velocity of no lift": (
        cam(segments=[{"motion": "constant_velocity", "angle": 360.0, "lift": 0.0}]),
        "/segments",
    ),
    "one rise": (cam(segments=[{"motion": "rise", "angle": 360.0, "lift": 5.0, "law": "cycloidal"}]), "/segments/0"),
    "359.999 degrees": (cam(angles=(90.0, 90.0, 90.0, 89.999)), "/segments"),
    "an instant": (cam(angles=(90.0, 1e-9, 90.0, 180.0 - 1e-9)), "/segments/1/angle"),
    "roller larger than prime circle": (cam(follower=ROLLER | {"prime_radius": 9.0}), "/follower/prime_radius"),
    "offset beyond prime circle": (
        cam(follower=ROLLER | {"prime_radius": 40.0, "offset": -50.0}),
        "/follower/offset",
    ),
    "arm that does not reach": (cam(10.0, follower=ARM | {"prime_radius": 15.0}), "/follower/prime_radius"),
    "speed zero": (cam(speed_rpm=0.0), "/speed_rpm"),
    "spring that pulls off": (cam(dynamics={"mass": 1.0, "spring_rate": -1.0}), "/dynamics/spring_rate"),
    "mass zero": (cam(dynamics={"mass": 0.0}), "/dynamics/mass"),
    "mass at no speed": (cam(dynamics={"mass": 1.0}, speed_rpm=None), "/speed_rpm"),
    "groove for a face": (cam(follower={"type": "translating_flat"}, closure="form"), "/closure"),
}


def stated_at(location, value):
    """The pointer of a fault: of its location the steps that the statement has, not the members of unions tried."""
    pointer = ""
    for step in location:
        if isinstance(step, int) or (isinstance(value, dict) and step in value):
            pointer, value = f"{pointer}/{step}", value[step]
    return pointer


@pytest.mark.parametrize("name", REFUSED)
def test_what_makes_no_sense_is_refused_with_its_field(name):
    statement, path = REFUSED[name]
    try:
        found = [contradiction.path for contradiction in parse_problem(statement).find_contradictions()]
    except ValidationError as error:
        found = [stated_at(one["loc"][1:], statement) for one in error.errors()]
    assert path in found


ANSWERED = {
    "tiny lift": cam(1e-6),
    "tiny lift and roller": cam(1e-6, follower=ROLLER | {"roller_radius": 1e-6}),
    "huge lift and roller": cam(1e6, follower=ROLLER | {"roller_radius": 1e5}),
    "tiny optimal": cam(1e-6, ("optimal", "optimal"), follower=ROLLER | {"roller_radius": 1e-6}),
    "huge optimal": cam(1e6, ("optimal", "optimal"), follower=ROLLER | {"roller_radius": 1e5}),
    "limits far away": cam(25.0, ("optimal", "optimal"), limits={"velocity": 1e9, "acceleration": 1e9, "jerk": 1e9}),
    "offset far out": cam(follower=ROLLER | {"offset": -500.0}),
    "short arm": cam(10.0, follower=ARM | {"arm": 1.0}),
    "one polynomial": polynomial((0.0, {"s": 0.0} | REST), (180.0, {"s": 10.0}), (360.0, {"s": 0.0} | REST)),
    "fall first": cam(
        segments=[{"motion": motion, "angle": 180.0, "lift": 25.0, "law": "cycloidal"} for motion in ("fall", "rise")]
    ),
    "a little over a turn": cam(angles=(90.0, 90.0, 90.0, 90.00000001)),
    "no spring": cam(dynamics={"mass": 1.0}),
    "tiny groove": cam(1e-6, closure="form"),
    "tiny barrel lift": cam(1e-6, follower=BARREL),
    "huge barrel": cam(1e6, follower=BARREL | {"roller_radius": 1e5}),
}


@pytest.mark.campaign
@pytest.mark.parametrize("rotation", ["ccw", "cw"])
@pytest.mark.parametrize("name", ANSWERED)
def test_what_is_extreme_is_answered(name, rotation):
    result = solve(parse_problem(ANSWERED[name] | {"rotation": rotation}), lambda fraction, message: None)
    (design,) = result.designs
    assert design.verification.passed
    bound = design.optimality.bound
    assert bound is None or 0.0 < bound <= design.optimality.value


NOT_FOUND = {
    "roller too small for the lift": cam(1e6),
    "roller too small for a slow angle": cam(limits={"pressure_angle": 0.1}),
    "roller too small for a ratio": cam(limits={"curvature_ratio": 1e9}),
    "prime circle like a planet": cam(follower=ROLLER | {"prime_radius": 1e9}),
    "hub like a planet": cam(limits={"hub_radius": 1e6}),
    "rise in an instant": cam(angles=(90.0, 1e-3, 90.0, 179.999)),
    "prime circle hardly larger than the roller": cam(follower=ROLLER | {"prime_radius": 10.0001}),
    "groove that crosses itself": cam(
        closure="form",
        follower=ROLLER | {"prime_radius": 11.0},
        limits={"pressure_angle": 85.0, "curvature_ratio": 0.0},
    ),
    "barrel too thin": cam(follower=BARREL | {"cylinder_radius": 1e-3}),
    "barrel too thick": cam(follower=BARREL | {"cylinder_radius": 1e8}),
    "face around its pivot": cam(
        10.0, follower={"type": "oscillating_flat", "pivot_distance": 120.0, "face_offset": -200.0}
    ),
}


@pytest.mark.parametrize("name", further(NOT_FOUND, NOT_FOUND.keys() - {"prime circle hardly larger than the roller"}))
def test_what_is_not_found_is_not_said_not_to_exist(name):
    result = solve(parse_problem(NOT_FOUND[name]), lambda fraction, message: None)
    assert result.designs == []
    assert not result.search.complete
    assert len(result.summary) > 40


def test_a_face_that_is_too_narrow_is_not_proven_to_be():
    """Its start angles are looked at one by one."""
    follower = {"type": "oscillating_flat", "pivot_distance": 120.0}
    statement = cam(10.0, follower=follower, limits={"face_width": 1e-3})
    result = solve(parse_problem(statement), lambda fraction, message: None)
    assert result.designs == []
    assert not result.search.complete


def test_exchanges_that_do_not_end_prove_nothing(monkeypatch):
    monkeypatch.setattr("synthesis.kinds.cam.sizing.critical_points.MAX_EXCHANGES", 1)
    program = random_program(np.random.default_rng(1), 1.0)
    found = find_smallest_allowed(program, lambda motion, p: np.abs(motion.a) / p - 1.0 + 0.0 * motion.s, 1e-3, 1e6)
    assert found is not None
