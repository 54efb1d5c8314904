"""Verify steering mechanisms: drive them to both locks, and measure the wheels' angles.

A fourbar is driven at its left arm in closed form, any other mechanism by its closures. The vehicle turns to the left
if the arms turn counter-clockwise: the left wheel is then the inner one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from kinematics.arrays import Real
from kinematics.errors import DimensionError, MechanismError
from kinematics.linkage.fourbar import BarkerClass, barker_class, find_transmission_extremes, positions, stays_on_branch
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.refined_extremes import find_minimum_near
from kinematics.linkage.steering import compute_outer_angle
from synthesis.kinds.steering.design import (
    DavisMechanism,
    SteeringDesign,
    SteeringMechanisms,
    SteeringMetrics,
    SteeringPosition,
)
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ANGLE, LENGTH
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.conversion import build_driven_fourbar
from synthesis.verification.checks import check_maximum, check_minimum
from synthesis.verification.constraints import check_constraints
from synthesis.verification.measures import list_link_lengths, measure_linkage
from synthesis.verification.reconstruction import rebuild_mechanism

SAMPLE_COUNT = 2049
"""Number of inputs from lock to lock, half of them on each side of the straight position: 64 per reported position."""

REPORTED_COUNT = 17
"""Number of positions that an answer lists, from straight to the lock."""

LOCK_TOLERANCE = 1e-9
"""Maximum deviation of the inner wheel from the lock, radians; the input for the lock is found by bisection."""

MAX_BISECTIONS = 60
"""Number of bisections to find a lock: 2⁻⁶⁰ of the range is below rounding."""

MAX_BAR_TRAVEL = 1e6
"""Maximum travel of the bar to lock a wheel, in pivot distances; a gear that needs more does not lock."""

MAX_EXACT_ERROR = 1e-9
"""Maximum steering error of Davis's gear, degrees, which covers rounding."""


class _SteeringMotion(NamedTuple):
    """Wheel angles at inputs from lock to lock, and a function for any other input.

    Angles are in radians, counter-clockwise from the straight position.
    """

    inputs: Real
    left: Real
    right: Real
    wheels: Callable[[Real], tuple[Real, Real]]
    transmission: dict[str, float]
    on_branch: bool
    barker: BarkerClass | None = None


class _HalfTurn(NamedTuple):
    """A turn to one side: wheel angles in radians, the steering error in degrees, and the inputs."""

    inner: Real
    outer: Real
    error: Real
    inputs: Real


def _check_error(problem: SteeringProblem, worst: float, *, exact: bool) -> list[Check]:
    """Check the maximum steering error, degrees; ``exact``: whether the mechanism steers correctly by its principle."""
    checks = [check_maximum("steers_correctly", worst, MAX_EXACT_ERROR, ANGLE)] if exact else []
    if problem.max_steering_error is not None:
        checks.append(check_maximum("steering_error", worst, problem.max_steering_error, ANGLE))
    return checks


def _compute_turning_radius(problem: SteeringProblem, outer: float) -> float:
    """Return the turning radius of the outer front wheel; ``outer`` is its angle at the lock, radians."""
    overhang = 0.5 * ((problem.track or problem.pivot_distance) - problem.pivot_distance)
    return problem.wheelbase / math.sin(outer) + overhang


def _list_positions(half: _HalfTurn, ratio: float, *, turns: bool) -> list[SteeringPosition]:
    """Return positions evenly spaced over a turn; ``turns``: whether the input turns rather than slides."""
    listed = np.linspace(0, len(half.inner) - 1, REPORTED_COUNT, dtype=int)
    return [
        SteeringPosition(
            index=n,
            input_angle=math.degrees(float(half.inputs[k])) if turns else None,
            input_place=None if turns else float(half.inputs[k]),
            inner=math.degrees(float(half.inner[k])),
            outer=math.degrees(float(half.outer[k])),
            required=math.degrees(float(compute_outer_angle(half.inner[k], ratio))),
            error=float(half.error[k]),
        )
        for n, k in enumerate(listed)
    ]


def verify_steering(problem: SteeringProblem, design: SteeringMechanisms) -> SteeringDesign | None:
    """Drive a steering mechanism from lock to lock and measure it.

    Parameters
    ----------
    problem : SteeringProblem
        The problem.
    design : a mechanism
        In the straight position. Only the dimensions are used; those of Davis's gear are its skeleton.

    Returns
    -------
    SteeringDesign or None
        None if the mechanism does not reach both locks.
    """
    driven = _drive_fourbar(problem, design) if isinstance(design, FourbarMechanism) else _drive_gear(problem, design)
    if driven is None:
        return None
    is_fourbar = isinstance(design, FourbarMechanism)
    ratio, lock = problem.pivot_distance / problem.wheelbase, math.radians(problem.lock)
    # Both turns are measured at once: the left wheel is the inner one in left turns only.
    inner, outer = _sort_wheels(driven.left, driven.right)
    error = np.degrees(outer - compute_outer_angle(inner, ratio))

    def evaluate_errors(inputs: Real) -> Real:
        nearer, farther = _sort_wheels(*driven.wheels(inputs))
        return -np.abs(np.degrees(farther - compute_outer_angle(nearer, ratio)))

    worst = -find_minimum_near(evaluate_errors, driven.inputs, -np.abs(error))[1]
    joints = {name: complex(*place) for name, place in design.skeleton.joints.items()}
    arm = joints["A"] - joints["O2"]
    behind = arm.imag < 0.0
    # The mechanism is symmetrical: positions of the left turn are enough for the report.
    half = _HalfTurn(*(values[SAMPLE_COUNT // 2 :] for values in (inner, outer, error, driven.inputs)))
    measures = measure_linkage(
        list_link_lengths(design),
        problem.pivot_distance,
        math.inf,  # steering has no quality
        driven.transmission,
        np.array(list(joints.values())),
        barker=driven.barker,
        same_branch=driven.on_branch,
        visits_in_order=bool(np.all(np.diff(driven.left) > 0.0) and np.all(np.diff(driven.right) > 0.0)),
        full_rotation=False,
        used=(float(driven.inputs[0]), float(driven.inputs[-1])),
        slides=not is_fourbar,
    )
    # The arm turns with its wheel, so that their distance is the same at every angle.
    clearance = problem.wheel_face - (joints["O2"].real - joints["A"].real) if is_fourbar else None
    metrics = SteeringMetrics(
        steering_error=worst,
        correct_at=_find_sign_changes(np.degrees(half.inner), half.error) if worst > MAX_EXACT_ERROR else [],
        outer_lock=math.degrees(float(half.outer[-1])),
        arm_length=abs(arm),
        arm_angle=math.degrees(math.atan2(arm.real if behind else -arm.real, abs(arm.imag))),
        tie_rod="behind" if behind else "ahead",
        turning_radius=_compute_turning_radius(problem, float(compute_outer_angle(lock, ratio))),
        **measures.select_fields(SteeringMetrics),
        tie_rod_clearance=clearance,
        bar_travel=None if is_fourbar else float(np.abs(driven.inputs).max()),
    )
    checks = [
        Check(name="reaches_locks", passed=abs(float(inner.max()) - lock) <= LOCK_TOLERANCE),
        Check(name="same_branch", passed=driven.on_branch),
    ]
    checks += _check_error(problem, worst, exact=not is_fourbar)
    if clearance is not None and problem.wheel_width is not None:
        checks.append(check_minimum("tie_rod_clearance", clearance, 0.0, LENGTH))
    fixed = [joints.pop(name) for name in ("O2", "O4")]
    of_constraints = check_constraints(problem.constraints, measures, fixed, list(joints.values()))
    checks += [check for check in of_constraints if check.name != "same_branch"]  # always checked above
    return SteeringDesign(
        mechanism=design,
        targets=_list_positions(half, ratio, turns=is_fourbar),
        verification=Verification.from_checks(checks),
        metrics=metrics,
    )


def _sort_wheels(left: Real, right: Real) -> tuple[Real, Real]:
    """Return the angles of the inner and the outer wheel."""
    to_left = left >= 0.0
    return np.where(to_left, left, -right), np.where(to_left, right, -left)


def _drive_fourbar(problem: SteeringProblem, design: FourbarMechanism) -> _SteeringMotion | None:
    """Drive the fourbar at its left arm, to the lock on one side and until the right wheel locks on the other."""
    try:
        linkage, assembly, straight = build_driven_fourbar(design)
    except DimensionError:
        return None
    lock = math.radians(problem.lock)
    start = positions(linkage, straight, assembly)

    def measure_right_wheel(turned: Real) -> Real:
        at = positions(linkage, straight + turned, assembly).output_angle
        return np.asarray(np.angle(np.exp(1j * (at - float(start.output_angle)))))

    # In a right turn the right wheel is the inner one and determines the lock.
    low = _find_right_lock(measure_right_wheel, -lock, lock)
    if low is None:
        return None
    half = SAMPLE_COUNT // 2
    left = np.concatenate([np.linspace(low, 0.0, half + 1)[:-1], np.linspace(0.0, lock, half + 1)])
    moved = measure_right_wheel(left)
    if not np.isfinite(moved).all():
        return None
    least = float(find_transmission_extremes(linkage, straight + low, straight + lock)[0])
    stays = bool(stays_on_branch(linkage, straight + low, straight + lock))

    def measure_wheels(inputs: Real) -> tuple[Real, Real]:
        return inputs - straight, measure_right_wheel(inputs - straight)

    return _SteeringMotion(
        straight + left, left, moved, measure_wheels, {"coupler": least}, stays, barker_class(linkage)
    )


def _drive_gear(problem: SteeringProblem, design: DavisMechanism) -> _SteeringMotion | None:
    """Drive Davis's gear at its bar, until the inner wheel locks on either side."""
    mechanism = rebuild_mechanism(design)
    if mechanism is None:
        return None
    try:
        drive(mechanism, np.zeros(1), order=0)
    except MechanismError:
        return None
    lock, size = math.radians(problem.lock), problem.pivot_distance
    # A bar behind the kingpins moves to the right for a turn to the left.
    sense = -1.0 if float(mechanism.joints["A"].imag) > 0.0 else 1.0
    straight = float(mechanism.reference_input)

    def measure_arm(name: str, travel: Real) -> Real:
        turned = drive(mechanism, straight + sense * travel, order=0).angles[name][0] - mechanism.link_angle(name)
        return np.asarray(np.angle(np.exp(1j * turned)))

    far = size
    while not float(measure_arm("left_arm", np.array([far]))[0]) > lock:
        # The travel to the lock has no simple bound: double it until the wheel is beyond the lock.
        far *= 2.0
        if far > MAX_BAR_TRAVEL * size:
            return None
    _, locked = _bisect_lock(lambda bar: not float(measure_arm("left_arm", np.array([bar]))[0]) < lock, 0.0, far)
    travel = np.linspace(-locked, locked, SAMPLE_COUNT)
    motion = drive(mechanism, straight + sense * travel, order=1)
    left, right = measure_arm("left_arm", travel), measure_arm("right_arm", travel)
    if not (np.isfinite(left).all() and np.isfinite(right).all()):
        return None
    least = {link: math.asin(min(float(np.abs(sine).min()), 1.0)) for link, sine in motion.sines.items()}

    def measure_wheels(inputs: Real) -> tuple[Real, Real]:
        at = sense * (inputs - straight)
        return measure_arm("left_arm", at), measure_arm("right_arm", at)

    return _SteeringMotion(straight + sense * travel, left, right, measure_wheels, least, bool(motion.smooth.all()))


def _find_right_lock(right: Callable[[Real], Real], low: float, lock: float) -> float | None:
    """Find the (negative) angle of the left wheel at which the right one is at −lock; None if it does not reach it."""
    # In a right turn the right wheel is the inner one and turns further. Beyond its lock it may have no position.
    if float(right(np.array([low]))[0]) > -lock:
        return None
    return _bisect_lock(lambda left: not float(right(np.array([left]))[0]) > -lock, 0.0, low)[0]


def _bisect_lock(beyond: Callable[[float], bool], inside: float, outside: float) -> tuple[float, float]:
    """Bisect between inputs on both sides of a lock; return the last input before the lock and the first one beyond."""
    for _ in range(MAX_BISECTIONS):
        middle = 0.5 * (inside + outside)
        inside, outside = (inside, middle) if beyond(middle) else (middle, outside)
    return inside, outside


def _find_sign_changes(inner: Real, error: Real) -> list[float]:
    """Return the inner wheel angles, except 0, at which the steering error changes its sign.

    The error is interpolated by cubic polynomials between the samples.
    """
    return [float(at) for at in CubicSpline(inner, error).roots(extrapolate=False) if at > inner[1]]
