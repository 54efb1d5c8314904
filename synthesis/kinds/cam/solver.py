"""Cams: the best motion program, the smallest feasible cam for it, and its verification."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from kinematics.arrays import Real
from kinematics.cam import follower as core
from kinematics.cam.motion.program import Program
from kinematics.cam.profile import Cam
from kinematics.errors import DimensionError
from kinematics.message import compose
from synthesis.kinds.cam.answer import (
    build_empty_result,
    build_result,
    check_forces,
    compute_motion_metrics,
    describe_joints,
    describe_segments,
    evaluate_optimality,
)
from synthesis.kinds.cam.barrel_solver import solve_barrel
from synthesis.kinds.cam.conjugate_solver import (
    build_pair_mechanism,
    compute_second_metrics,
    size_second_cam,
    verify_pair,
    with_equal_rollers,
)
from synthesis.kinds.cam.design import CamDesign, CamMechanism, CamMetrics, CamResult
from synthesis.kinds.cam.dynamics.overturning import compute_overturning_moment, find_face_offset, make_moment_share
from synthesis.kinds.cam.follower_loads import get_arm_length
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.profile import build_cam_mechanism, choose_profile_angles, refine_angles
from synthesis.kinds.cam.program.composition import Composition, NoProgram, compose_program
from synthesis.kinds.cam.program.optimal import GRID_STEP_COUNTS
from synthesis.kinds.cam.program.radius_limits import (
    compute_min_face_radius,
    compute_min_pitch_radius,
    get_roller_radius_range,
)
from synthesis.kinds.cam.sizing.resolution import resolve_profile
from synthesis.kinds.cam.sizing.sizing import (
    RollerLimits,
    Size,
    search_offset,
    search_pivot,
    size_oscillating_flat,
    size_oscillating_roller,
    size_translating_flat,
    size_translating_roller,
)
from synthesis.kinds.cam.statement.followers import (
    BarrelRoller,
    LengthRange,
    OscillatingFlat,
    OscillatingRoller,
    TranslatingFlat,
    TranslatingRoller,
)
from synthesis.kinds.cam.verification.forces import check_measured_contact, check_overturning
from synthesis.kinds.cam.verification.reproduction import DISPLACEMENT_TOLERANCE
from synthesis.kinds.cam.verification.verify import MeasuredProfile, verify
from synthesis.model.answer import Verification
from synthesis.model.kind import Progress
from synthesis.model.problem import Contradiction, ContradictionError

UNFIXABLE_CHECKS = {
    "no_cusp",
    "does_not_cross_itself",
    "outer_wall_is_sound",
    "second_no_cusp",
    "second_does_not_cross_itself",
}
"""Checks that more points cannot repair."""

PEAK_CHECKS = {"peak_velocity", "peak_acceleration", "peak_jerk"}
"""Checks of differenced measurements, which fail with too few points even if the program keeps the limit."""

HALVING_DEVIATION = 7.0
"""Deviation, as a multiple of the permitted one, for which :func:`refine_angles` divides a step in two."""

PEAK_ACCELERATIONS = (6.0, 8.0, 11.0, 16.0)
"""Limits on the acceleration, in units of lift over angle squared, tried to trade pressure angle against curvature."""

JERK_SHARE = 25.0
"""Limit on the jerk that goes with them: the acceleration may change fully within an eighth of a segment's angle."""

BOUND_TOLERANCE = 0.01
"""Excess of a cam's size over the bound, as a share, at which the search ends."""

MIN_CURVATURE = 1e-300
"""Positive substitute for the curvature of a straight pitch curve, which allows a roller of any radius."""

MIN_BASE_SHARE = 1e-3
"""Minimum base radius of a cam, as a share of the travel, if the client requests no hub."""


MAX_SHORTFALL = 1e-3
"""Maximum relative shortfall of the curvature that counts as a measurement error, for which the cam is sized again."""


def solve_cam(problem: CamProblem, progress: Progress) -> CamResult:
    """Find the best motion program of a cam problem and the smallest cam for it, and verify them."""
    progress(0.05, compose("cam-composing-program"))
    composed = compose_program(problem, progress=progress, reach=(0.05, 0.4))
    if isinstance(composed, NoProgram):
        return build_empty_result(problem, composed.reason, composed.proven, "motion_limits")
    composed = _smooth_motion(problem, composed, progress)
    if not problem.accept_discontinuity and not composed.program.obeys_fundamental_law:
        # Automatic laws may still leave a jump between segments: report the first one.
        joint = next(joint for joint in composed.program.continuity if not all(joint.continuous[:3]))
        where = f"/segments/{joint.segments[1]}"
        raise ContradictionError(Contradiction(where, compose("cam-motion-jumps")))
    progress(0.5, compose("cam-sizing"))
    if isinstance(problem.follower, BarrelRoller):
        return solve_barrel(problem, problem.follower, composed, progress)
    sized = _size_cam(problem, composed.program)
    if sized is None:
        follower, proven = problem.follower, composed.bound is None
        if isinstance(follower, TranslatingRoller | TranslatingFlat):
            proven = proven and follower.offset != "free"
        elif isinstance(follower, OscillatingRoller):
            proven = proven and not isinstance(follower.pivot_distance, LengthRange)
        else:
            # The width of an arm's face is only checked on a grid of start angles, which is no proof.
            proven = proven and problem.limits.face_width is None
        reason = compose("cam-no-size-fits")
        return build_empty_result(problem, reason, proven, "size")
    # With conjugate closure, the second cam follows from the program of the first.
    cam, size = sized
    cams = _add_second_cam(problem, cam)
    if cams is None:
        reason = compose("cam-no-second-size-fits")
        return build_empty_result(problem, reason, False, "size")
    progress(0.7, compose("cam-verifying"))
    mechanism, verification, measured = _verify_cams(problem, cams, progress)
    tighter = _tighten_curvature(problem, verification)
    # A second sizing with a slightly tighter limit on curvature compensates for the measurement error.
    if tighter is not None and (larger := _size_cam(tighter, composed.program)) is not None:
        cams, size = _add_second_cam(tighter, larger[0]) or cams, larger[1]
        mechanism, verification, measured = _verify_cams(problem, cams, progress)
    cam = cams[0]
    if measured is None:
        return build_empty_result(problem, _explain_no_contact(cam), False, "follower_can_be_laid_on")
    metrics = _compute_metrics(problem, cam, mechanism, measured)
    held = [*check_forces(problem, metrics.forces), *check_measured_contact(problem, mechanism, metrics.forces)]
    held += check_overturning(problem, mechanism, metrics)
    verification = Verification.from_checks([*verification.checks, *held])
    design = CamDesign(
        mechanism=mechanism,
        segments=describe_segments(problem, composed),
        joints=describe_joints(problem, composed.program),
        optimality=evaluate_optimality(problem, composed, cam.size),
        verification=verification,
        metrics=metrics,
    )
    progress(1.0, compose("cam-verified"))
    return build_result(problem, composed, design, size, ("prime" if cam.roller_radius else "base", cam.size))


def _add_second_cam(problem: CamProblem, cam: Cam) -> tuple[Cam, ...] | None:
    """Return the cam alone, or with its conjugate cam; None if that has no feasible size."""
    if problem.closure != "conjugate":
        return (cam,)

    def size_other(other: CamProblem, program: Program) -> Cam | None:
        found = _size_cam(other, program)
        return None if found is None else found[0]

    second = size_second_cam(problem, cam, size_other)
    return None if second is None else with_equal_rollers(cam, second)


def _verify_cams(
    problem: CamProblem, cams: tuple[Cam, ...], progress: Progress
) -> tuple[CamMechanism, Verification, MeasuredProfile | None]:
    """Return the finished cams, their checks and the measurements, None if the follower cannot touch the profile."""
    cam, groove = cams[0], problem.closure == "form"
    curves = [cam.profile, cam.outer_wall] if groove else [one.profile for one in cams]
    # All curves that a roller touches share their angles, those of the curve that needs the most points.
    laid = [choose_profile_angles(cam.program, curve, cam.roller_radius, problem.profile_points) for curve in curves]
    make: Callable[[Real], CamMechanism] = partial(build_cam_mechanism, cam, groove=groove)
    if len(cams) > 1:
        make = partial(build_pair_mechanism, cams[0], cams[1])
    proof = verify if len(cams) == 1 else verify_pair
    return resolve_profile(max(laid, key=len), make, partial(proof, problem), _refine_profile, progress)


def _tighten_curvature(problem: CamProblem, verification: Verification) -> CamProblem | None:
    """Tighten the curvature limit so that the measured curvature satisfies the requested limit.

    Sizes are exact, whereas the measurement through the points of the finished cam errs on the safe side. Return None
    unless the shortfall is small and concerns only curvature.
    """
    failed = [check for check in verification.checks if not check.passed]
    if not failed or {check.name for check in failed} - {"curvature_ratio", "second_curvature_ratio"}:
        return None
    # The largest shortfall decides. Failed checks have a limit and a value.
    short = max((check.limit or 0.0) / (check.value or math.inf) - 1.0 for check in failed)
    if not 0.0 < short < MAX_SHORTFALL:
        return None
    limit = problem.limits.curvature_ratio * (1.0 + 2.0 * short)
    return problem.model_copy(update={"limits": problem.limits.model_copy(update={"curvature_ratio": limit})})


def _explain_no_contact(cam: Cam) -> str:
    """Explain why the follower cannot be laid against the profile."""
    if cam.program.smoothness < 2:
        return compose("cam-profile-breaks-off")
    if cam.roller_radius <= 0.0:
        return compose("cam-no-contact")
    return compose("cam-profile-unresolved", roller=f"{cam.roller_radius:.6g}", radius=f"{cam.size:.6g}")


def _smooth_motion(problem: CamProblem, composed: Composition, progress: Progress) -> Composition:
    """Find, for minimum size, the motion with the smallest cam under limits on curvature as well.

    The convex program considers the pressure angle but not the curvature of a roller's pitch curve, and the motion of
    minimum size is abrupt unless its acceleration is limited. The program is therefore solved again under several
    limits on acceleration and jerk, and the smallest of the cams is used. The lower bound remains that of all motions.
    """
    if problem.minimize != "size" or composed.bound is None or get_roller_radius_range(problem) is None:
        return composed
    stated = problem.limits
    unlimited = stated.acceleration is None and stated.jerk is None
    # Without requested limits the first motion has unusable spikes, so that its cam is not a candidate.
    best, least = composed, math.inf if unlimited else _compute_radius(problem, composed)
    span = min(s.angle for s in composed.program.segments if s.pieces.count > 1)
    for n, share in enumerate(PEAK_ACCELERATIONS):
        if least <= composed.bound * (1.0 + BOUND_TOLERANCE):
            break
        progress(0.4 + 0.1 * n / len(PEAK_ACCELERATIONS), compose("cam-trading-sizes"))
        a = share * composed.program.lift / span**2
        j = JERK_SHARE * a / span
        limits = stated.model_copy(
            update={"acceleration": min(stated.acceleration or a, a), "jerk": min(stated.jerk or j, j)}
        )
        reach = 0.4 + 0.1 * n / len(PEAK_ACCELERATIONS), 0.4 + 0.1 * (n + 1) / len(PEAK_ACCELERATIONS)
        # The coarse grid suffices to compare sizes. The bound comes from the first solution.
        other = compose_program(problem.model_copy(update={"limits": limits}), GRID_STEP_COUNTS[:1], progress, reach)
        if isinstance(other, Composition):
            radius = _compute_radius(problem, other)
            if radius < least:
                best, least = replace(other, bound=composed.bound, scope=composed.scope), radius
    return best


def _compute_radius(problem: CamProblem, composed: Composition) -> float:
    sized = _size_cam(problem, composed.program)
    return math.inf if sized is None else sized[0].size


def _refine_profile(angle: Real, measured: MeasuredProfile, failed: set[str]) -> Real | None:
    """Return a refined set of angles if the profile has too few points; None if more points do not help."""
    if failed & UNFIXABLE_CHECKS:
        return None
    if failed & {"reproduces_program", "outer_wall_reproduces_program", "second_reproduces_program"}:
        return refine_angles(angle, measured.off, DISPLACEMENT_TOLERANCE)
    for doubtful in (measured.unsettled, measured.unsteady):
        if doubtful.any():
            return refine_angles(angle, doubtful, 1.0)
    # The table keeps the limit but the measured peak does not: closer points make the differences accurate.
    if failed & PEAK_CHECKS and not failed & {f"table_{peak[5:]}" for peak in PEAK_CHECKS}:
        return refine_angles(angle, np.full_like(angle, HALVING_DEVIATION), 1.0)
    return None


def _size_cam(problem: CamProblem, program: Program) -> tuple[Cam, Size] | None:
    """Return the smallest cam, or the cam of given radius; None if no radius is feasible."""
    follower, limits = problem.follower, problem.limits
    rollers = get_roller_radius_range(problem)
    try:
        if rollers is None:
            return _size_flat_cam(problem, program)
        least = rollers[0] + _compute_min_base(problem, program)
        rise = math.radians(limits.pressure_angle)
        fall = math.radians(limits.falling_pressure_angle)
        roller_limits = RollerLimits(rise, fall, compute_min_pitch_radius(limits, rollers[0]), least)
        roller_limits = replace(roller_limits, moment=make_moment_share(problem, program))
        size: Size | None
        core_follower: core.Roller
        if isinstance(follower, TranslatingRoller):
            if follower.prime_radius is not None:
                size = Size(follower.prime_radius, True)
            elif follower.offset == "free":
                centred = size_translating_roller(program, 0.0, roller_limits)
                # An offset beyond the radius of the cam for a centred follower would give a larger cam.
                widest = centred.radius if centred is not None else program.lift * 10.0
                size = search_offset(program, roller_limits, (-widest, widest))
            else:
                size = size_translating_roller(program, float(follower.offset), roller_limits)
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
                size = search_pivot(program, follower.arm, (pivot.min, pivot.max), follower.sense, roller_limits)
            else:
                size = size_oscillating_roller(program, follower.arm, pivot, follower.sense, roller_limits)
            if size is None:
                return None
            distance = size.free if isinstance(pivot, LengthRange) else pivot
            assert distance is not None
            core_follower = core.OscillatingRoller(size.radius, rollers[0], follower.arm, distance, follower.sense)
        return _fit_largest_roller(Cam(program, core_follower, problem.rotation), rollers[1], problem), size
    except DimensionError:
        return None


def _compute_min_base(problem: CamProblem, program: Program) -> float:
    """Return the minimum radius of the base circle: the hub's, or the smallest that leaves a cam around its centre.

    The travel of an arm is that of its roller, or that of a face at the pivot distance.
    """
    follower = problem.follower
    reach = get_arm_length(problem) if isinstance(follower, OscillatingRoller) else 1.0
    reach = follower.pivot_distance if isinstance(follower, OscillatingFlat) else reach
    return max(problem.limits.hub_radius, MIN_BASE_SHARE * program.lift * reach)


def _size_flat_cam(problem: CamProblem, program: Program) -> tuple[Cam, Size] | None:
    """Return the smallest cam under a flat face, or the cam of given radius; None if no radius is feasible."""
    follower, limits = problem.follower, problem.limits
    least = _compute_min_base(problem, program)
    size: Size | None
    core_follower: core.Flat
    if isinstance(follower, TranslatingFlat):
        size = Size(follower.base_radius, True) if follower.base_radius else None
        size = size or size_translating_flat(program, compute_min_face_radius(problem), least)
        offset = find_face_offset(problem, program) if follower.offset == "free" else float(follower.offset)
        core_follower = core.TranslatingFlat(size.radius, offset)
    else:
        assert isinstance(follower, OscillatingFlat)
        pivot, face, sense = follower.pivot_distance, follower.face_offset, follower.sense
        size = Size(follower.base_radius, True) if follower.base_radius else None
        size = size or size_oscillating_flat(
            program, pivot, face, sense, compute_min_face_radius(problem), least, limits.face_width
        )
        if size is None:
            return None
        core_follower = core.OscillatingFlat(size.radius, pivot, face, sense)
    return Cam(program, core_follower, problem.rotation), size


def _fit_largest_roller(cam: Cam, largest: float, problem: CamProblem) -> Cam:
    """Give the cam the largest roller that curvature and hub allow: contact stress falls with its radius."""
    follower = cam.follower
    assert isinstance(follower, core.TranslatingRoller | core.OscillatingRoller)
    if largest <= follower.roller_radius:
        return cam
    # This is the largest roller with the required ratio of the pitch curve's radius of curvature to its own radius.
    curvature = max(cam.pitch_curvature_extremes.largest, MIN_CURVATURE)
    allowed = 1.0 / curvature / compute_min_pitch_radius(problem.limits, 1.0)
    fits = follower.prime_radius - _compute_min_base(problem, cam.program)
    radius = max(min(largest, allowed, fits), follower.roller_radius)
    return replace(cam, follower=replace(follower, roller_radius=radius))


def _compute_metrics(problem: CamProblem, cam: Cam, mechanism: CamMechanism, measured: MeasuredProfile) -> CamMetrics:
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
        second=compute_second_metrics(problem, mechanism),
        overturning_moment=compute_overturning_moment(problem, cam),
        **compute_motion_metrics(problem, program),
    )
