"""Universal joints: the book's numbers, the geometry of the cross in space, and laws of shafts in a row."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kinematics.errors import DimensionError
from kinematics.linkage.universal_joint import (
    Joint,
    compute_joint_angle,
    compute_max_joint_angle,
    compute_shaft_motion,
    find_shaft_extremes,
)
from tests.cases import cases

RPM = math.pi / 30.0
ANGLES = st.floats(0.0, 1.5)


def one(degrees):
    return [Joint(math.radians(degrees))]


@pytest.mark.parametrize("case", cases("hooke", "steering_hooke"))
def test_speeds_and_greatest_acceleration(case):
    joint, speed = one(case.inputs["delta"]), case.inputs.get("rpm", 0.0) * RPM
    found = find_shaft_extremes(joint)
    # The book puts the greatest acceleration where cos 2α = 2 sin² δ/(2 − sin² δ).
    s = math.sin(joint[0].angle) ** 2
    near = 0.5 * math.acos(2.0 * s / (2.0 - s))
    computed = {
        "wa": speed,
        "wmax": found.greatest * speed,
        "wmin": found.least * speed,
        "cos2a": math.cos(2.0 * near),
        "a_approx": math.degrees(near),
        "acc_approx": abs(float(compute_shaft_motion(joint, near).ratio_rate)) * speed**2,
        "a_exact": math.degrees(found.steepest_at),
        "acc_exact": found.acceleration * speed**2,
        "min_num": found.least,
        "max_num": found.greatest,
        "fluct": found.fluctuation,
    }
    case.check(**{name: computed[name] for name in case.expected})


@pytest.mark.parametrize("case", cases("hooke_delta", "steering_hooke"))
def test_angle_for_a_fluctuation(case):
    angle = compute_joint_angle(case.inputs["fluct"])
    found, rpm = find_shaft_extremes([Joint(angle)]), case.inputs["rpm"]
    case.check(delta=math.degrees(angle), rpm_max=found.greatest * rpm, rpm_min=found.least * rpm)


@pytest.mark.parametrize("case", cases("hooke_band", "steering_hooke"))
def test_angle_for_limits_of_the_speed(case):
    rpm = case.inputs["rpm"]
    angle = compute_max_joint_angle(case.inputs["lo"] / rpm, case.inputs["hi"] / rpm)
    found = find_shaft_extremes([Joint(angle)])
    case.check(delta=math.degrees(angle), rpm_max=found.greatest * rpm, rpm_min=found.least * rpm)


@pytest.mark.parametrize("case", cases("hooke_double_wrong", "steering_hooke"))
def test_a_double_joint_with_forks_at_right_angles_is_twice_as_uneven(case):
    angle, rpm = math.radians(case.inputs["delta"]), case.inputs["rpm"]
    found = find_shaft_extremes([Joint(angle), Joint(angle, 0.5 * math.pi)])
    case.check(min=found.least * rpm, max=found.greatest * rpm)


@pytest.mark.parametrize("case", cases("hooke_torque", "steering_hooke"))
def test_torque_of_an_inertia(case):
    stated, joint, speed = case.inputs, one(case.inputs["delta"]), case.inputs["rpm"] * RPM
    at = math.radians(stated["alpha_or_beta"])
    if stated.get("by") != "alpha":
        at = math.atan(math.tan(at) * math.cos(joint[0].angle))
    moved = compute_shaft_motion(joint, at)
    acceleration = abs(float(moved.ratio_rate)) * speed**2
    computed = {
        "alpha": math.degrees(at),
        "wa": speed,
        "wb": float(moved.ratio) * speed,
        "acc": acceleration,
        "T_inertia": acceleration * stated["inertia"],
    }
    case.check(**{name: computed[name] for name in case.expected})


@pytest.mark.parametrize("case", cases("hooke_shaft_torque", "steering_hooke"))
def test_torque_of_a_shaft(case):
    stated, joint, speed = case.inputs, one(case.inputs["delta"]), case.inputs["rpm"] * RPM
    s = math.sin(joint[0].angle) ** 2
    near = 0.5 * math.acos(2.0 * s / (2.0 - s))
    acceleration = abs(float(compute_shaft_motion(joint, near).ratio_rate)) * speed**2
    share = stated["inertia"] * acceleration
    # The book rounds 2π and the acceleration; its tolerances allow for the former.
    assert acceleration == pytest.approx(case.expected["acc"].value, abs=4.0)
    computed = {
        "cos2a": math.cos(2.0 * near),
        "a": math.degrees(near),
        "wa": speed,
        "acc": acceleration,
        "T_fluct": share,
        "T_hi": stated["T"] + share,
        "T_lo": stated["T"] - share,
        "swing": 2.0 * share,
    }
    case.check(**{name: computed[name] for name in case.expected})


def cross_in_space(angle, alpha):
    """Output angle of one joint: the driven fork's axis is square to the driver's, and to its own shaft."""
    driver = np.array([0.0, 0.0, 1.0])
    driven = np.array([math.sin(angle), 0.0, math.cos(angle)])
    # Fork of the driver: square to its shaft, in the plane of the shafts (x, z) at alpha = 0.
    fork = np.array([math.cos(alpha), math.sin(alpha), 0.0])
    other = np.cross(driven, fork)
    other /= np.linalg.norm(other)
    start = np.cross(driven, np.array([1.0, 0.0, 0.0]))
    start /= np.linalg.norm(start)
    assert abs(other @ fork) < 1e-12
    assert abs(driver @ fork) < 1e-12
    return math.atan2(np.cross(start, other) @ driven, start @ other)


@pytest.mark.parametrize("degrees", [0.0, 10.0, 45.0, 80.0])
def test_one_joint_is_a_cross_in_space(degrees):
    for alpha in np.linspace(-3.0, 3.0, 13):
        expected = cross_in_space(math.radians(degrees), alpha)
        assert float(compute_shaft_motion(one(degrees), alpha).angle) == pytest.approx(expected, abs=1e-12)


@given(st.lists(st.tuples(ANGLES, st.floats(-7.0, 7.0)), min_size=1, max_size=4))
def test_rates_are_derivatives_and_stay_within_the_extremes(stated):
    joints = [Joint(*joint) for joint in stated]
    at, step = np.linspace(0.0, 2.0 * math.pi, 181), 1e-5
    here, after, before = (compute_shaft_motion(joints, at + d) for d in (0.0, step, -step))
    found = find_shaft_extremes(joints)
    scale = found.greatest**4
    assert np.allclose((after.angle - before.angle) / (2.0 * step), here.ratio, atol=1e-6 * scale)
    assert np.allclose((after.ratio - before.ratio) / (2.0 * step), here.ratio_rate, atol=1e-5 * scale)
    assert here.ratio.max() <= found.greatest * (1.0 + 1e-9)
    assert here.ratio.min() >= found.least * (1.0 - 1e-9)
    assert np.abs(here.ratio_rate).max() <= found.acceleration * (1.0 + 1e-9) + 1e-12
    assert here.angle[-1] - here.angle[0] == pytest.approx(2.0 * math.pi, abs=1e-9)
    assert float(compute_shaft_motion(joints, found.fastest_at).ratio) == pytest.approx(found.greatest, rel=1e-9)
    steepest = compute_shaft_motion(joints, found.fastest_at + found.steepest_at)
    assert abs(float(steepest.ratio_rate)) == pytest.approx(found.acceleration, rel=1e-6, abs=1e-9)


@given(ANGLES, st.floats(0.0, 6.0))
def test_two_equal_joints_with_forks_in_one_plane_even_the_speed(angle, alpha):
    joints = [Joint(angle), Joint(angle)]
    assert float(compute_shaft_motion(joints, alpha).ratio) == pytest.approx(1.0, abs=1e-11 / math.cos(angle) ** 2)


def test_what_no_joint_has_is_refused():
    for joints in ([], [Joint(0.5 * math.pi)], [Joint(-0.1)], [Joint(math.nan)]):
        with pytest.raises(DimensionError):
            find_shaft_extremes(joints)
    with pytest.raises(DimensionError):
        compute_joint_angle(-0.1)
    with pytest.raises(DimensionError):
        compute_max_joint_angle(1.1, 2.0)
    with pytest.raises(DimensionError):
        compute_max_joint_angle(0.5, 0.9)
