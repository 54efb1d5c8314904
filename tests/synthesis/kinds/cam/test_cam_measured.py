"""Limits and conditions of optimal motions, measured on the finished profile: found where broken, despite the table."""

from __future__ import annotations

import copy
import math

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.cam.profile import build_cam_mechanism, choose_profile_angles
from synthesis.kinds.cam.program.composition import compose_program
from synthesis.kinds.cam.solver import _size_cam
from synthesis.kinds.cam.verification.rates import PEAK_SLACK
from synthesis.kinds.cam.verification.verify import verify
from synthesis.registry import parse_problem

BASE = {
    "kind": "cam",
    "segments": [
        {"motion": "dwell", "angle": 90.0},
        {"motion": "rise", "angle": 90.0, "lift": 25.0, "law": "optimal"},
        {"motion": "dwell", "angle": 90.0},
        {"motion": "return", "angle": 90.0, "law": "optimal"},
    ],
    "follower": {"type": "translating_roller", "roller_radius": 10.0},
    "limits": {"pressure_angle": 30.0, "jerk": 700.0},
}


def problem(limits=None, conditions=(), bands=(), **changes):
    statement = copy.deepcopy(BASE) | changes
    statement["limits"] |= limits or {}
    statement["segments"][1] |= {"conditions": list(conditions), "bands": list(bands)}
    return parse_problem(statement)


def made(stated):
    """The finished cam, and its exact program."""
    program = compose_program(stated).program
    cam, _ = _size_cam(stated, program)
    return build_cam_mechanism(cam, choose_profile_angles(program, cam.profile, cam.roller_radius, 1440)), program


def failed(stated, mechanism):
    verdict, _ = verify(stated, mechanism)
    return {check.name for check in verdict.checks if not check.passed}


def values(stated, mechanism):
    verdict, _ = verify(stated, mechanism)
    return {check.name: check.value for check in verdict.checks}


@pytest.mark.campaign
@pytest.mark.parametrize(
    ("minimize", "limits"),
    [
        ("peak_acceleration", {}),
        ("peak_jerk", {"velocity": 40.0}),
        ("rms_jerk", {"jerk": 900.0}),
        ("peak_velocity", {"acceleration": 60.0}),
    ],
)
@pytest.mark.parametrize("continuity", ["acceleration", "jerk"])
def test_measured_peaks_are_the_exact_ones(minimize, limits, continuity):
    """Means over windows: never above the exact peak but by the slack, and those of the program's own derivatives."""
    stated = problem({"velocity": 45.0, "acceleration": 75.0} | limits, minimize=minimize, continuity=continuity)
    mechanism, program = made(stated)
    found = values(stated, mechanism)
    for order, name in enumerate(("velocity", "acceleration", "jerk"), 1):
        exact = program.peaks[order].largest
        assert found[f"peak_{name}"] <= exact * (1.0 + PEAK_SLACK)
        assert found[f"peak_{name}"] == pytest.approx(window_peak(program, order), rel=5e-3)
    assert failed(stated, mechanism) == set()


def window_peak(program, order):
    """Greatest mean of the exact derivative under a B-spline of 1/80 (acceleration) or 1/40 (jerk) of the segment."""
    fine = 3200
    peaks = []
    for start in (0.5 * math.pi, 1.5 * math.pi):
        at = start + 0.5 * math.pi * (np.arange(fine) + 0.5) / fine
        curve = program.motion(at)[order]
        width = {1: 1, 2: fine // 80, 3: fine // 40}[order]
        for _ in range(order if order > 1 else 0):
            curve = np.convolve(curve, np.full(width, 1.0 / width), mode="valid")
        peaks.append(float(np.abs(curve).max()))
    return max(peaks)


def zeroed(mechanism):
    """The same profile beside a table that claims no rates at all."""
    none = [0.0] * len(mechanism.program.angle)
    return mechanism.model_copy(update={"program": mechanism.program.model_copy(update={"a": none, "j": none})})


@pytest.mark.parametrize(("name", "share"), [("velocity", 0.99), ("acceleration", 0.99), ("jerk", 0.99)])
def test_a_broken_limit_is_found_on_the_profile_alone(name, share):
    stated = problem({"velocity": 45.0, "acceleration": 75.0})
    mechanism, program = made(stated)
    peak = program.peaks[("velocity", "acceleration", "jerk").index(name) + 1].largest
    stricter = problem({"velocity": 45.0, "acceleration": 75.0} | {name: share * peak})
    assert f"peak_{name}" in failed(stricter, zeroed(mechanism))


CONDITIONS = [{"angle": 40.0, "s": 10.0, "v": 24.0}, {"angle": 60.3, "a": -20.0}]


@pytest.mark.slow
def test_conditions_are_measured_at_their_own_angles():
    """None of them is an angle of the table, 60.3 least of all."""
    stated = problem(conditions=CONDITIONS)
    mechanism, _ = made(stated)
    assert failed(stated, mechanism) == set()
    found = values(stated, mechanism)
    assert found["meets_velocities"] <= 1e-3
    assert found["meets_accelerations"] <= 1e-2


@pytest.mark.parametrize(
    ("which", "name", "off", "check"),
    [
        (0, "s", 1e-4, "meets_positions"),
        (0, "v", 0.1, "meets_velocities"),
        (1, "a", 1.5, "meets_accelerations"),
    ],
)
def test_a_condition_that_is_not_met_is_found(which, name, off, check):
    mechanism, _ = made(problem(conditions=CONDITIONS))
    others = copy.deepcopy(CONDITIONS)
    others[which][name] += off
    assert failed(problem(conditions=others), mechanism) == {check}


@pytest.mark.campaign
def test_a_band_that_is_left_is_found():
    band = {"start": 40.1, "end": 44.9, "lower": 10.0, "upper": 16.0}
    stated = problem(bands=[band])
    mechanism, program = made(stated)
    assert failed(stated, mechanism) == set()
    top = float(program.motion(math.radians(90.0 + 44.9)).s)
    tight = problem(bands=[band | {"upper": top - 1e-3}])
    assert failed(tight, mechanism) == {"meets_positions"}


@pytest.mark.slow
@pytest.mark.parametrize("continuity", ["acceleration", "jerk"])
def test_a_stated_jerk_is_a_condition_like_others(continuity):
    stated = problem(conditions=[{"angle": 40.0, "j": 3.0}], continuity=continuity)
    composed = compose_program(stated)
    assert float(composed.program.motion(math.radians(130.0)).j) == pytest.approx(3.0, abs=1e-6)


@pytest.mark.campaign
def test_an_acceleration_of_an_instant_is_not_called_met():
    """Without a limit on jerk the cheapest motion meets it in a spike that no profile shows."""
    statement = copy.deepcopy(BASE) | {"limits": {"pressure_angle": 30.0}, "minimize": "peak_velocity"}
    statement["segments"][1] |= {"conditions": [{"angle": 40.0, "a": 3.0}, {"angle": 45.0, "s": 12.0, "v": 20.0}]}
    result = solve(parse_problem(statement), lambda fraction, message: None)
    assert result.designs == []
    assert not result.search.complete
    assert "set `limits.jerk`" in result.summary


SHARP = {
    "barrel": ({"type": "barrel_roller", "roller_radius": 5.0}, (53.66, 37.14)),
    "slide": ({"type": "translating_roller", "roller_radius": 5.0}, (42.13, 44.34)),
}


@pytest.mark.parametrize("name", SHARP)
def test_the_greatest_slope_beside_a_sharp_bend_is_measured(name):
    """The velocity bends into its plateau: points stand as close as the pressure angle there asks for."""
    follower, (rise, fall) = SHARP[name]
    rest = 0.5 * (360.0 - rise - fall)
    move = {"lift": 10.0, "law": "modified_constant_velocity"}
    segments = [
        {"motion": "rise", "angle": rise} | move,
        {"motion": "dwell", "angle": rest},
        {"motion": "fall", "angle": fall} | move,
        {"motion": "dwell", "angle": 360.0 - rise - fall - rest},
    ]
    limits = {"pressure_angle": 30.0, "curvature_ratio": 0.0}
    stated = {"kind": "cam", "segments": segments, "follower": follower, "limits": limits, "profile_points": 180}
    (design,) = solve(parse_problem(stated), lambda fraction, message: None).designs
    metrics = design.metrics
    steepest = max(metrics.max_pressure_angle_rise, metrics.max_pressure_angle_fall)
    assert steepest == pytest.approx(30.0, rel=1e-6)


def test_a_short_chord_beside_a_long_one_is_measured_where_the_curvature_is_greatest():
    """A bend of the motion is a fiftieth of a degree from a point: the chord between is too short to be divided."""
    move = {"lift": 8.441, "law": "trapezoidal"}
    segments = [
        {"motion": "rise", "angle": 103.526} | move,
        {"motion": "dwell", "angle": 83.426},
        {"motion": "fall", "angle": 68.538} | move,
        {"motion": "dwell", "angle": 104.51},
    ]
    follower = {"type": "oscillating_flat", "pivot_distance": 180.0, "face_offset": -3.658}
    stated = {"kind": "cam", "segments": segments, "follower": follower, "limits": {"min_radius": 5.864}}
    (design,) = solve(parse_problem(stated), lambda fraction, message: None).designs
    assert design.metrics.min_convex_radius == pytest.approx(5.864, rel=2e-6)


@pytest.mark.slow
def test_an_acceleration_that_is_left_as_fast_as_a_jerk_allows_is_met():
    """The cheapest motion comes to it for two degrees only, which is as abrupt as the client has allowed."""
    conditions = [{"angle": 45.0, "a": 0.0}, {"angle": 22.5, "a": 40.5}]
    stated = problem({"jerk": 1006.0}, conditions, minimize="rms_acceleration")
    mechanism, program = made(stated)
    assert float(program.motion(math.radians(112.5)).a) == pytest.approx(40.5)
    assert abs(float(program.motion(math.radians(114.5)).a) - 40.5) > 8.0
    assert values(stated, mechanism)["meets_accelerations"] <= 1e-2
    conditions[1]["a"] += 1.5
    assert "meets_accelerations" in failed(problem({"jerk": 1006.0}, conditions), mechanism)


@pytest.mark.campaign
@pytest.mark.parametrize(
    ("count", "lift"),
    [
        (60, 5.0),
        pytest.param(200, 5.0, marks=pytest.mark.campaign),
        pytest.param(200, 0.05, marks=pytest.mark.campaign),
    ],
)
def test_many_short_segments(count, lift):
    """1.8° each of 200: points are put where they are needed, and the profile reproduces them all."""
    moves = [
        {"motion": "rise" if k % 2 == 0 else "fall", "angle": 360.0 / count, "lift": lift, "law": "modified_sine"}
        for k in range(count)
    ]
    stated = copy.deepcopy(BASE) | {"segments": moves, "limits": {"pressure_angle": 30.0}}
    result = solve(parse_problem(stated), lambda fraction, message: None)
    (design,) = result.designs
    assert design.verification.passed
    assert len(design.segments) == count
