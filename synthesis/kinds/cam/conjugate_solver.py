"""Conjugate cams: the second cam of a pair, and the verification that a rigid follower fits both at every angle."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from kinematics.arrays import Real
from kinematics.cam import follower as core
from kinematics.cam.conjugate import compute_span, reverse_program, transform_between_cams
from kinematics.cam.finished.contact import Contour
from kinematics.cam.finished.extreme_values import find_worst_values
from kinematics.cam.motion.program import Program
from kinematics.cam.profile import Cam
from kinematics.errors import DimensionError, ShapeError
from synthesis.kinds.cam.design import CamCurve, CamMechanism, SecondCam, SecondMetrics
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.profile import build_cam_mechanism, build_core_follower, find_stretches, read_points
from synthesis.kinds.cam.statement.followers import OscillatingRoller, TranslatingRoller
from synthesis.kinds.cam.verification.reproduction import Reproduction, limit_reported
from synthesis.kinds.cam.verification.verify import (
    MeasuredProfile,
    build_measured_profile,
    check_roller,
    check_sizes,
    compute_curvature_slack,
    verify,
)
from synthesis.mechanisms.cam import build_follower
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import LENGTH
from synthesis.verification.checks import check_error

Sized = Callable[[CamProblem, Program], Cam | None]

DISTANCE_TOLERANCE = 1e-12
"""Relative variation of the rollers' distance over a turn that is attributed to rounding."""


def size_second_cam(problem: CamProblem, first: Cam, sized: Sized) -> Cam | None:
    """Size the smallest second cam within the limits, for the first cam's offset or pivot; None if there is none."""
    stated, follower = problem.follower, first.follower
    if isinstance(stated, TranslatingRoller):
        # Seen from the opposite side, the same slide has the opposite offset, and the same arm has the opposite
        # sense.
        assert isinstance(follower, core.TranslatingRoller)
        changed = {"offset": -follower.offset, "prime_radius": None}
    else:
        assert isinstance(stated, OscillatingRoller)
        assert isinstance(follower, core.OscillatingRoller)
        changed = {"sense": -stated.sense, "prime_radius": None, "pivot_distance": follower.pivot_distance}
    other = problem.model_copy(update={"follower": stated.model_copy(update=changed)})
    return sized(other, reverse_program(first.program))


def with_equal_rollers(first: Cam, second: Cam) -> tuple[Cam, Cam]:
    """Give both cams the smaller roller radius, because the largest roller for one curve may not fit the other."""
    # Equal rollers make the yoke symmetrical and exchangeable.
    radius = min(first.roller_radius, second.roller_radius)
    return _with_roller(first, radius), _with_roller(second, radius)


def _with_roller(cam: Cam, radius: float) -> Cam:
    assert isinstance(cam.follower, core.TranslatingRoller | core.OscillatingRoller)
    return replace(cam, follower=replace(cam.follower, roller_radius=radius))


def build_pair_mechanism(first: Cam, second: Cam, angle: Real) -> CamMechanism:
    """Build the mechanism of both cams at given cam angles."""
    mechanism, other = build_cam_mechanism(first, angle), build_cam_mechanism(second, angle)
    one, two = first.follower, second.follower
    assert isinstance(one, core.TranslatingRoller | core.OscillatingRoller)
    assert isinstance(two, core.TranslatingRoller | core.OscillatingRoller)
    apart = compute_span(one, two, first.program.peaks[0].greatest)
    swings = isinstance(one, core.OscillatingRoller)
    # The profile is stored in the common frame, the follower as its own cam sees it.
    found = SecondCam(
        follower=other.follower,
        prime_radius=second.size,
        # On an arm the rollers span an angle; the distance of their centres is its chord.
        roller_distance=2.0 * one.arm * math.sin(0.5 * apart) if isinstance(one, core.OscillatingRoller) else apart,
        arm_angle=math.degrees(apart) if swings else None,
        profile=_rotate_curve(one, other.profile),
        pitch_curve=_rotate_curve(one, other.pitch_curve),
    )
    return mechanism.model_copy(update={"second": found})


def _rotate_curve(follower: core.Roller, curve: CamCurve) -> CamCurve:
    points = transform_between_cams(follower, read_points(curve))
    return CamCurve(angle=curve.angle, x=points.real.tolist(), y=points.imag.tolist())


def verify_pair(problem: CamProblem, mechanism: CamMechanism) -> tuple[Verification, MeasuredProfile | None]:
    """Verify both cams; the second is measured by :func:`measure_second_cam`."""
    verification, measured = verify(problem, mechanism)
    if measured is None:
        return verification, None
    checks, second = measure_second_cam(problem, mechanism)
    both = Verification.from_checks([*verification.checks, *checks])
    if second is None:
        return both, None
    # Points are refined together, so that each angle carries the worse of both deviations.
    return both, replace(
        measured,
        off=np.maximum(measured.off, second.off),
        unsettled=np.maximum(measured.unsettled, second.unsettled),
        unsteady=np.maximum(measured.unsteady, second.unsteady),
    )


def measure_second_cam(problem: CamProblem, mechanism: CamMechanism) -> tuple[list[Check], MeasuredProfile | None]:
    """Measure the second roller laid against its profile: the rigid follower must hold it at this position."""
    second, first = mechanism.second, build_core_follower(mechanism)
    assert second is not None
    assert isinstance(first, core.TranslatingRoller | core.OscillatingRoller)
    demanded = Reproduction.from_program(problem, mechanism.program)
    try:
        stretches = find_stretches(mechanism.program)
        follower = build_follower(second.follower.type, second.prime_radius, second.follower)
        assert isinstance(follower, core.TranslatingRoller | core.OscillatingRoller)
        # The second profile is stored in the first cam's frame: rotate it back into its own frame.
        own = transform_between_cams(first, read_points(second.profile))
        contour = Contour(own, np.radians(mechanism.program.angle), stretches.breaks)
        contact = contour.follow(follower, demanded.angle, mechanism.rotation)
        found = find_worst_values(contour, follower, mechanism.rotation, stretches)
    except (DimensionError, ShapeError):
        return [Check(name="second_reproduces_program", passed=False)], None
    apart = second.roller_distance if second.arm_angle is None else math.radians(second.arm_angle)
    # The second follower's displacement is the distance of the first one below its highest position. The rollers keep
    # their distance, so that the sum of both displacements is constant.
    off = demanded.deviation(apart - compute_span(first, follower, 0.0) - contact.s)
    measured = build_measured_profile(found, follower.roller_radius, off)
    distance = np.abs(read_points(mechanism.pitch_curve) - read_points(second.pitch_curve)) / second.roller_distance
    limits, slack = problem.limits, compute_curvature_slack(measured.unsettled, measured.rounded)
    checks = [
        check_error("roller_distance", float(np.abs(distance - 1.0).max()), DISTANCE_TOLERANCE),
        demanded.check("second_reproduces_program", off, bool(contact.valid.all())),
        Check(name="second_no_cusp", passed=not contour.has_cusp),
        Check(name="second_does_not_cross_itself", passed=len(contour.crossings) == 0),
    ]
    others = check_roller(limits, measured.rising, measured.falling, measured.curvature_ratio, slack)
    others += check_sizes(limits, second.prime_radius - follower.roller_radius, second.prime_radius)
    pivot = second.follower.pivot_distance
    if pivot is not None:
        clear = measured.radius < pivot
        others.append(Check(name="clears_pivot", passed=clear, value=measured.radius, limit=pivot, dimension=LENGTH))
    return [*checks, *(check.model_copy(update={"name": f"second_{check.name}"}) for check in others)], measured


def compute_second_metrics(problem: CamProblem, mechanism: CamMechanism) -> SecondMetrics | None:
    """Return the metrics of the second cam; None for a single cam."""
    if mechanism.second is None:
        return None
    _, measured = measure_second_cam(problem, mechanism)
    assert measured is not None, "the pair was verified"
    return SecondMetrics(
        size=measured.radius,
        max_pressure_angle_rise=measured.rising,
        max_pressure_angle_fall=measured.falling,
        min_convex_radius=limit_reported(measured.convex_radius),
        min_concave_radius=None if math.isinf(measured.concave_radius) else measured.concave_radius,
        curvature_ratio=limit_reported(measured.curvature_ratio),
    )
