"""Cams: the best motion program, the smallest feasible cam for it, and its verification."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from kinematics.cam import follower as core
from kinematics.cam.profile import Cam
from kinematics.cam.program import Program
from kinematics.errors import DimensionError
from synthesis.kinds.cam.answer import (
    force_checks,
    joints_of,
    motion_metrics,
    none_of,
    optimality_of,
    result_of,
    segments_of,
)
from synthesis.kinds.cam.barrel import solve_barrel
from synthesis.kinds.cam.composition import (
    Composition,
    NoProgram,
    compose,
    least_face_radius,
    least_pitch_radius,
    roller_radius_range,
)
from synthesis.kinds.cam.conjugate import pair_mechanism, second_cam, second_metrics, verify_pair, with_equal_rollers
from synthesis.kinds.cam.design import CamDesign, CamMechanism, CamMetrics, CamResult
from synthesis.kinds.cam.followers import (
    BarrelRoller,
    LengthRange,
    OscillatingFlat,
    OscillatingRoller,
    TranslatingFlat,
    TranslatingRoller,
)
from synthesis.kinds.cam.loads import arm_length
from synthesis.kinds.cam.measured_forces import measured_contact, overturning_checks
from synthesis.kinds.cam.mechanism import cam_mechanism, profile_angles, refined
from synthesis.kinds.cam.optimal import STEPS
from synthesis.kinds.cam.overturning import face_offset, moment_share, overturning_moment
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.reproduction import REPRODUCED
from synthesis.kinds.cam.resolution import resolved
from synthesis.kinds.cam.sizing import (
    RollerLimits,
    Size,
    free_offset,
    free_pivot,
    oscillating_flat,
    oscillating_roller,
    translating_flat,
    translating_roller,
)
from synthesis.kinds.cam.verification import Measured, verify
from synthesis.model.answer import Verification
from synthesis.model.kind import Progress
from synthesis.model.statement import Contradiction, ContradictionError

Real = NDArray[np.float64]

UNSOUND = {"no_cusp", "does_not_cross_itself", "outer_wall_is_sound", "second_no_cusp", "second_does_not_cross_itself"}
"""Checks that more points cannot repair."""

PEAKS = {"peak_velocity", "peak_acceleration", "peak_jerk"}
"""Checks of differenced measurements, which fail with too few points although the program keeps the limit."""

HALVED = 7.0
"""Deviation, in units of the permitted one, for which :func:`refined` divides a step in two."""

PEAK_ACCELERATIONS = (6.0, 8.0, 11.0, 16.0)
"""Peak accelerations, in units of lift and angle squared, tried to trade size by pressure angle against curvature."""

JERK_SHARE = 25.0
"""Peak jerk that goes with them: the acceleration may change fully within an eighth of the angle of a segment."""

BOUND_TOLERANCE = 0.01
"""Share by which a cam may exceed the bound and still end the search."""

NOT_ZERO = 1e-300
"""Curvature that stands for a straight pitch curve, which allows a roller of any radius."""

MIN_BASE = 1e-3
"""Minimum base radius of a cam, as a share of the travel, if the client requests no hub."""


MEASURED_SHORT = 1e-3
"""Relative shortfall of the curvature that counts as an error of measurement, after which the cam is sized again."""


def solve_cam(problem: CamProblem, progress: Progress) -> CamResult:
    """Solve a cam problem."""
    progress(0.05, "composing the motion program")
    composed = compose(problem, progress=progress, reach=(0.05, 0.4))
    if isinstance(composed, NoProgram):
        return none_of(problem, composed.reason, composed.proven, "motion_limits")
    composed = _smoothed(problem, composed, progress)
    if not problem.accept_discontinuity and not composed.program.obeys_fundamental_law:
        # Automatic laws may still leave a jump between segments; report the first one.
        joint = next(joint for joint in composed.program.continuity if not all(joint.continuous[:3]))
        where = f"/segments/{joint.segments[1]}"
        raise ContradictionError(Contradiction(where, "the motion is not continuous there; see accept_discontinuity"))
    progress(0.5, "sizing the cam")
    if isinstance(problem.follower, BarrelRoller):
        return solve_barrel(problem, problem.follower, composed, progress)
    sized = _sized(problem, composed.program)
    if sized is None:
        proven = not isinstance(getattr(problem.follower, "pivot_distance", None), LengthRange)
        proven = proven and getattr(problem.follower, "offset", None) != "free" and composed.bound is None
        # The width of an arm's face is checked on a grid of start angles only, which proves nothing.
        proven = proven and (problem.limits.face_width is None or not isinstance(problem.follower, OscillatingFlat))
        reason = "no cam of any size follows the program within the limits on pressure angle, curvature and face width"
        return none_of(problem, reason, proven, "size")
    # With conjugate closure the second cam follows from the first one's program.
    cam, size = sized
    cams = _pair(problem, cam)
    if cams is None:
        reason = "the second of the conjugate cams has no size within the limits on pressure angle and curvature"
        return none_of(problem, reason, False, "size")
    progress(0.7, "verifying")
    mechanism, verification, measured = _verified(problem, cams, progress)
    tighter = _tightened(problem, verification)
    # A second sizing, with a slightly tighter curvature, makes up for the error of the measurement.
    if tighter is not None and (larger := _sized(tighter, composed.program)) is not None:
        cams, size = _pair(tighter, larger[0]) or cams, larger[1]
        mechanism, verification, measured = _verified(problem, cams, progress)
    cam = cams[0]
    if measured is None:
        return none_of(problem, _not_laid_on(cam), False, "follower_can_be_laid_on")
    metrics = _metrics(problem, cam, mechanism, measured)
    held = [*force_checks(problem, metrics.forces), *measured_contact(problem, mechanism, metrics.forces)]
    held += overturning_checks(problem, mechanism, metrics)
    verification = Verification.of([*verification.checks, *held])
    design = CamDesign(
        mechanism=mechanism,
        segments=segments_of(problem, composed),
        joints=joints_of(problem, composed.program),
        optimality=optimality_of(problem, composed, cam.size),
        verification=verification,
        metrics=metrics,
    )
    progress(1.0, "verified")
    return result_of(problem, composed, design, size, ("prime" if cam.roller_radius else "base", cam.size))


def _pair(problem: CamProblem, cam: Cam) -> tuple[Cam, ...] | None:
    """Return the cam alone, or with its conjugate cam; None if that has no feasible size."""
    if problem.closure != "conjugate":
        return (cam,)

    def sized(other: CamProblem, program: Program) -> Cam | None:
        found = _sized(other, program)
        return None if found is None else found[0]

    second = second_cam(problem, cam, sized)
    return None if second is None else with_equal_rollers(cam, second)


def _verified(
    problem: CamProblem, cams: tuple[Cam, ...], progress: Progress
) -> tuple[CamMechanism, Verification, Measured | None]:
    """Return the finished cams, their checks and the measurements; None if the follower cannot be laid on."""
    cam, groove = cams[0], problem.closure == "form"
    curves = [cam.profile, cam.outer_wall] if groove else [one.profile for one in cams]
    # Both curves share their angles: those of the curve that needs more of them.
    # Every curve that a roller touches asks for points of its own.
    laid = [profile_angles(cam.program, curve, cam.roller_radius, problem.profile_points) for curve in curves]
    make: Callable[[Real], CamMechanism] = partial(cam_mechanism, cam, groove=groove)
    if len(cams) > 1:
        make = partial(pair_mechanism, cams[0], cams[1])
    proof = verify if len(cams) == 1 else verify_pair
    return resolved(max(laid, key=len), make, partial(proof, problem), _closer, progress)


def _tightened(problem: CamProblem, verification: Verification) -> CamProblem | None:
    """Tighten the curvature limit so that the measured curvature meets the requested one.

    Sizes are exact; the finished cam is measured through its points, on the safe side. None unless only a little
    curvature is missing.
    """
    failed = [check for check in verification.checks if not check.passed]
    if not failed or {check.name for check in failed} - {"curvature_ratio", "second_curvature_ratio"}:
        return None
    # The largest shortfall decides; failed checks have a limit and a value.
    short = max((check.limit or 0.0) / (check.value or math.inf) - 1.0 for check in failed)
    if not 0.0 < short < MEASURED_SHORT:
        return None
    limit = problem.limits.curvature_ratio * (1.0 + 2.0 * short)
    return problem.model_copy(update={"limits": problem.limits.model_copy(update={"curvature_ratio": limit})})


def _not_laid_on(cam: Cam) -> str:
    """Explain why the follower cannot be laid against the profile."""
    if cam.program.smoothness < 2:
        return "the profile breaks off at a jump of the displacement or the velocity; choose laws that join"
    if cam.roller_radius <= 0.0:
        return "the follower cannot be laid against the profile"
    return (
        f"the contact of a roller of radius {cam.roller_radius:.6g} on a cam of prime radius {cam.size:.6g} is not "
        "resolved by the maximum number of points per profile; use a larger roller or a slower motion"
    )


def _smoothed(problem: CamProblem, composed: Composition, progress: Progress) -> Composition:
    """For minimum size: find the motion whose cam is smallest if curvature counts as well.

    The convex program considers pressure angle, not the curvature of a roller's pitch curve, and the motion of minimum
    size is abrupt if no limit holds its acceleration. So it is solved again under limits on acceleration and jerk, and
    the smallest of the cams is used. The bound remains that of all motions.
    """
    if problem.minimize != "size" or composed.bound is None or roller_radius_range(problem) is None:
        return composed
    stated = problem.limits
    unlimited = stated.acceleration is None and stated.jerk is None
    # Without limits of its own the first motion has unusable spikes, so its cam is not a candidate.
    best, least = composed, math.inf if unlimited else _radius(problem, composed)
    span = min(s.angle for s in composed.program.segments if s.pieces.count > 1)
    for n, share in enumerate(PEAK_ACCELERATIONS):
        if least <= composed.bound * (1.0 + BOUND_TOLERANCE):
            break
        progress(0.4 + 0.1 * n / len(PEAK_ACCELERATIONS), "trading size by pressure angle against size by curvature")
        a = share * composed.program.lift / span**2
        j = JERK_SHARE * a / span
        limits = stated.model_copy(
            update={"acceleration": min(stated.acceleration or a, a), "jerk": min(stated.jerk or j, j)}
        )
        reach = 0.4 + 0.1 * n / len(PEAK_ACCELERATIONS), 0.4 + 0.1 * (n + 1) / len(PEAK_ACCELERATIONS)
        # The coarse grid suffices to compare sizes; the bound comes from the first solution.
        other = compose(problem.model_copy(update={"limits": limits}), STEPS[:1], progress, reach)
        if isinstance(other, Composition):
            radius = _radius(problem, other)
            if radius < least:
                best, least = replace(other, bound=composed.bound, scope=composed.scope), radius
    return best


def _radius(problem: CamProblem, composed: Composition) -> float:
    sized = _sized(problem, composed.program)
    return math.inf if sized is None else sized[0].size


def _closer(angle: Real, measured: Measured, failed: set[str]) -> Real | None:
    """Return a finer set of angles if the profile has too few points; None if more points do not help."""
    if failed & UNSOUND:
        return None
    if failed & {"reproduces_program", "outer_wall_reproduces_program", "second_reproduces_program"}:
        return refined(angle, measured.off, REPRODUCED)
    for doubtful in (measured.unsettled, measured.unsteady):
        if doubtful.any():
            return refined(angle, doubtful, 1.0)
    # The table keeps the limit but the measured peak does not: closer points make the differences accurate.
    if failed & PEAKS and not failed & {f"table_{peak[5:]}" for peak in PEAKS}:
        return refined(angle, np.full_like(angle, HALVED), 1.0)
    return None


def _sized(problem: CamProblem, program: Program) -> tuple[Cam, Size] | None:
    """Return the smallest cam, or the one of given radius; None if no radius is feasible."""
    follower, limits = problem.follower, problem.limits
    rollers = roller_radius_range(problem)
    try:
        if rollers is None:
            return _flat_cam(problem, program)
        least = rollers[0] + _least_base(problem, program)
        rise = math.radians(limits.pressure_angle)
        fall = math.radians(limits.falling_pressure_angle)
        roller_limits = RollerLimits(rise, fall, least_pitch_radius(limits, rollers[0]), least)
        roller_limits = replace(roller_limits, moment=moment_share(problem, program))
        size: Size | None
        core_follower: core.Roller
        if isinstance(follower, TranslatingRoller):
            if follower.prime_radius is not None:
                size = Size(follower.prime_radius, True)
            elif follower.offset == "free":
                centred = translating_roller(program, 0.0, roller_limits)
                # The best offset is smaller than the radius of a centred follower, which would be a worse cam.
                widest = centred.radius if centred is not None else program.lift * 10.0
                size = free_offset(program, roller_limits, (-widest, widest))
            else:
                size = translating_roller(program, float(follower.offset), roller_limits)
            if size is None:
                return None
            offset = size.free if follower.offset == "free" else float(follower.offset)
            core_follower = core.TranslatingRoller(size.radius, rollers[0], offset or 0.0)
        else:
            assert isinstance(follower, OscillatingRoller)
            pivot = follower.pivot_distance
            if follower.prime_radius is not None:
                size = Size(follower.prime_radius, True)
            elif isinstance(pivot, LengthRange):
                size = free_pivot(program, follower.arm, (pivot.min, pivot.max), follower.sense, roller_limits)
            else:
                size = oscillating_roller(program, follower.arm, pivot, follower.sense, roller_limits)
            if size is None:
                return None
            distance = size.free if isinstance(pivot, LengthRange) else pivot
            assert distance is not None
            core_follower = core.OscillatingRoller(size.radius, rollers[0], follower.arm, distance, follower.sense)
        return _largest_roller(Cam(program, core_follower, problem.rotation), rollers[1], problem), size
    except DimensionError:
        return None


def _least_base(problem: CamProblem, program: Program) -> float:
    """Return the least radius of the base circle: the hub's, or the least that leaves a cam around its centre.

    The travel of an arm is that of its roller, or of a face at the pivot's distance.
    """
    follower = problem.follower
    reach = arm_length(problem) if isinstance(follower, OscillatingRoller) else 1.0
    reach = follower.pivot_distance if isinstance(follower, OscillatingFlat) else reach
    return max(problem.limits.hub_radius, MIN_BASE * program.lift * reach)


def _flat_cam(problem: CamProblem, program: Program) -> tuple[Cam, Size] | None:
    """Return the smallest cam under a flat face, or the one of given radius; None if no radius is feasible."""
    follower, limits = problem.follower, problem.limits
    least = _least_base(problem, program)
    size: Size | None
    core_follower: core.Flat
    if isinstance(follower, TranslatingFlat):
        size = Size(follower.base_radius, True) if follower.base_radius else None
        size = size or translating_flat(program, least_face_radius(problem), least)
        offset = face_offset(problem, program) if follower.offset == "free" else float(follower.offset)
        core_follower = core.TranslatingFlat(size.radius, offset)
    else:
        assert isinstance(follower, OscillatingFlat)
        pivot, face, sense = follower.pivot_distance, follower.face_offset, follower.sense
        size = Size(follower.base_radius, True) if follower.base_radius else None
        size = size or oscillating_flat(
            program, pivot, face, sense, least_face_radius(problem), least, limits.face_width
        )
        if size is None:
            return None
        core_follower = core.OscillatingFlat(size.radius, pivot, face, sense)
    return Cam(program, core_follower, problem.rotation), size


def _largest_roller(cam: Cam, largest: float, problem: CamProblem) -> Cam:
    """Give the cam the largest roller that curvature and hub allow: contact stress falls with its radius."""
    follower = cam.follower
    assert isinstance(follower, core.TranslatingRoller | core.OscillatingRoller)
    if largest <= follower.roller_radius:
        return cam
    # The largest roller whose offset curve keeps the required ratio to the pitch curve.
    curvature = max(cam.pitch_curvature_extremes.largest, NOT_ZERO)
    allowed = 1.0 / curvature / least_pitch_radius(problem.limits, 1.0)
    fits = follower.prime_radius - _least_base(problem, cam.program)
    radius = max(min(largest, allowed, fits), follower.roller_radius)
    return replace(cam, follower=replace(follower, roller_radius=radius))


def _metrics(problem: CamProblem, cam: Cam, mechanism: CamMechanism, measured: Measured) -> CamMetrics:
    """Return the metrics of the measured profile as the answer reports them."""
    program = cam.program
    roller = cam.roller_radius > 0.0
    return CamMetrics(
        size=measured.radius,
        lift=program.lift / problem.displacement_unit,
        max_pressure_angle_rise=measured.rising if roller else None,
        max_pressure_angle_fall=measured.falling if roller else None,
        min_convex_radius=measured.convex_radius,
        min_concave_radius=None if math.isinf(measured.concave_radius) else measured.concave_radius,
        curvature_ratio=measured.curvature_ratio if roller else None,
        face_width=None if roller else measured.sweep,
        second=second_metrics(problem, mechanism),
        overturning_moment=overturning_moment(problem, cam),
        **motion_metrics(problem, program),
    )
