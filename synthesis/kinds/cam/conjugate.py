"""Conjugate cams: the second cam of a pair, sized like the first, and the verification that both rollers always fit."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from kinematics.cam import follower as core
from kinematics.cam.conjugate import opposed, span, turned
from kinematics.cam.contact import Contour
from kinematics.cam.finished import worst
from kinematics.cam.profile import Cam
from kinematics.cam.program import Program
from kinematics.errors import DimensionError, ShapeError
from synthesis.kinds.cam.design import CamCurve, CamMechanism, SecondCam, SecondMetrics
from synthesis.kinds.cam.followers import OscillatingRoller, TranslatingRoller
from synthesis.kinds.cam.mechanism import cam_mechanism, core_follower, points_of, stretches_of
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.reproduction import Reproduction, reported
from synthesis.kinds.cam.verification import Measured, curvature_slack, measured_of, roller_checks, size_checks, verify
from synthesis.mechanisms.cam import follower_by_dimensions
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import LENGTH
from synthesis.proof.checks import tolerated

Real = NDArray[np.float64]

Sized = Callable[[CamProblem, Program], Cam | None]

SAME_DISTANCE = 1e-12
"""Relative change of the rollers' distance over a turn that is attributed to rounding."""


def second_cam(problem: CamProblem, first: Cam, sized: Sized) -> Cam | None:
    """Size the smallest second cam within the limits, for the first cam's offset or pivot; None if there is none."""
    stated, follower = problem.follower, first.follower
    if isinstance(stated, TranslatingRoller):
        # Seen from the opposite side the same slide has the opposite offset, and the same arm the opposite
        # sense.
        assert isinstance(follower, core.TranslatingRoller)
        changed = {"offset": -follower.offset, "prime_radius": None}
    else:
        assert isinstance(stated, OscillatingRoller)
        assert isinstance(follower, core.OscillatingRoller)
        changed = {"sense": -stated.sense, "prime_radius": None, "pivot_distance": follower.pivot_distance}
    other = problem.model_copy(update={"follower": stated.model_copy(update=changed)})
    return sized(other, opposed(first.program))


def with_equal_rollers(first: Cam, second: Cam) -> tuple[Cam, Cam]:
    """Give both cams the smaller of their rollers' radii: the largest that one curve allows may not fit the other."""
    # Equal rollers make the yoke symmetrical and exchangeable.
    radius = min(first.roller_radius, second.roller_radius)
    return _with_roller(first, radius), _with_roller(second, radius)


def _with_roller(cam: Cam, radius: float) -> Cam:
    assert isinstance(cam.follower, core.TranslatingRoller | core.OscillatingRoller)
    return replace(cam, follower=replace(cam.follower, roller_radius=radius))


def pair_mechanism(first: Cam, second: Cam, angle: Real) -> CamMechanism:
    """Build the mechanism of both cams at given cam angles."""
    mechanism, other = cam_mechanism(first, angle), cam_mechanism(second, angle)
    one, two = first.follower, second.follower
    assert isinstance(one, core.TranslatingRoller | core.OscillatingRoller)
    assert isinstance(two, core.TranslatingRoller | core.OscillatingRoller)
    apart = span(one, two, first.program.peaks[0].greatest)
    swings = isinstance(one, core.OscillatingRoller)
    # The profile is stored in the common frame, the follower as its own cam sees it.
    found = SecondCam(
        follower=other.follower,
        prime_radius=second.size,
        # On an arm the rollers span an angle; the distance of their centres is its chord.
        roller_distance=2.0 * one.arm * math.sin(0.5 * apart) if isinstance(one, core.OscillatingRoller) else apart,
        arm_angle=math.degrees(apart) if swings else None,
        profile=_turned(one, other.profile),
        pitch_curve=_turned(one, other.pitch_curve),
    )
    return mechanism.model_copy(update={"second": found})


def _turned(follower: core.Roller, curve: CamCurve) -> CamCurve:
    points = turned(follower, points_of(curve))
    return CamCurve(angle=curve.angle, x=points.real.tolist(), y=points.imag.tolist())


def verify_pair(problem: CamProblem, mechanism: CamMechanism) -> tuple[Verification, Measured | None]:
    """Verify both cams; the second is measured by :func:`second_measured`."""
    verification, measured = verify(problem, mechanism)
    if measured is None:
        return verification, None
    checks, second = second_measured(problem, mechanism)
    both = Verification.of([*verification.checks, *checks])
    if second is None:
        return both, None
    # Points are refined together, so that each angle carries the worse of both deviations.
    return both, replace(
        measured,
        off=np.maximum(measured.off, second.off),
        unsettled=np.maximum(measured.unsettled, second.unsettled),
        unsteady=np.maximum(measured.unsteady, second.unsteady),
    )


def second_measured(problem: CamProblem, mechanism: CamMechanism) -> tuple[list[Check], Measured | None]:
    """Measure the second roller laid against its profile: the rigid follower must carry it there."""
    second, first = mechanism.second, core_follower(mechanism)
    assert second is not None
    assert isinstance(first, core.TranslatingRoller | core.OscillatingRoller)
    demanded = Reproduction.of(problem, mechanism.program)
    try:
        stretches = stretches_of(mechanism.program)
        follower = follower_by_dimensions(second.follower.type, second.prime_radius, second.follower)
        assert isinstance(follower, core.TranslatingRoller | core.OscillatingRoller)
        # The second profile is stored in the first cam's frame; rotate it back into its own.
        own = turned(first, points_of(second.profile))
        contour = Contour(own, np.radians(mechanism.program.angle), stretches.breaks)
        contact = contour.follow(follower, demanded.angle, mechanism.rotation)
        found = worst(contour, follower, mechanism.rotation, stretches)
    except (DimensionError, ShapeError):
        return [Check(name="second_reproduces_program", passed=False)], None
    apart = second.roller_distance if second.arm_angle is None else math.radians(second.arm_angle)
    # The second follower's displacement is what the first one lacks to its highest position.
    # The rollers keep their distance: the second displacement plus the first's is constant.
    off = demanded.deviation(apart - span(first, follower, 0.0) - contact.s)
    measured = measured_of(found, follower.roller_radius, off)
    distance = np.abs(points_of(mechanism.pitch_curve) - points_of(second.pitch_curve)) / second.roller_distance
    limits, slack = problem.limits, curvature_slack(measured.unsettled, measured.rounded)
    checks = [
        tolerated("roller_distance", float(np.abs(distance - 1.0).max()), SAME_DISTANCE),
        demanded.check("second_reproduces_program", off, bool(contact.valid.all())),
        Check(name="second_no_cusp", passed=not contour.cusped),
        Check(name="second_does_not_cross_itself", passed=len(contour.crossings) == 0),
    ]
    others = roller_checks(limits, measured.rising, measured.falling, measured.curvature_ratio, slack)
    others += size_checks(limits, second.prime_radius - follower.roller_radius, second.prime_radius)
    pivot = second.follower.pivot_distance
    if pivot is not None:
        clear = measured.radius < pivot
        others.append(Check(name="clears_pivot", passed=clear, value=measured.radius, limit=pivot, dimension=LENGTH))
    return [*checks, *(check.model_copy(update={"name": f"second_{check.name}"}) for check in others)], measured


def second_metrics(problem: CamProblem, mechanism: CamMechanism) -> SecondMetrics | None:
    """Return the metrics of the second cam; None for a single cam."""
    if mechanism.second is None:
        return None
    _, measured = second_measured(problem, mechanism)
    assert measured is not None, "the pair was verified"
    return SecondMetrics(
        size=measured.radius,
        max_pressure_angle_rise=measured.rising,
        max_pressure_angle_fall=measured.falling,
        min_convex_radius=reported(measured.convex_radius),
        min_concave_radius=None if math.isinf(measured.concave_radius) else measured.concave_radius,
        curvature_ratio=reported(measured.curvature_ratio),
    )
