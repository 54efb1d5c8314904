"""Cams: the best motion program, the smallest sound cam that carries it, and its verification."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np

from kinematics.cam import follower as core
from kinematics.cam.dynamics import RunningCam
from kinematics.cam.extremes import extremes
from kinematics.cam.profile import Cam
from kinematics.cam.program import Program
from kinematics.errors import DimensionError
from synthesis.cam.composition import (
    Composition,
    NoProgram,
    arm_length,
    compose,
    follower_load,
    least_face_radius,
    roller_radius_range,
    root_mean_square,
)
from synthesis.cam.mechanism import cam_mechanism, profile_angles, refined
from synthesis.cam.optimal import STEPS
from synthesis.cam.sizing import (
    RollerLimits,
    Size,
    free_offset,
    free_pivot,
    oscillating_flat,
    oscillating_roller,
    translating_flat,
    translating_roller,
)
from synthesis.cam.verification import MEASURED_SLACK, REPRODUCED, Measured, pitch_radius, verify
from synthesis.designs.cam import (
    CamDesign,
    CamForces,
    CamJoint,
    CamMetrics,
    CamResult,
    CamSearch,
    CamSegment,
    Optimality,
)
from synthesis.kinds import Progress
from synthesis.problems import Contradiction, ContradictionError
from synthesis.problems.cam import CamProblem, LengthRange, Move, OscillatingRoller, TranslatingFlat, TranslatingRoller

FINEST = 12_000
"""Points of a profile at most. Where a motion changes its acceleration within less than a step, points are put closer
until the profile reproduces it; beyond this number the design fails its verification."""

SHAPE = {"curvature_ratio", "min_radius", "convex"}
"""Checks of curvature, which a profile of too few points can fail although its cam does not."""

REFINEMENTS = 8
"""Times that points are put closer at most."""

SMOOTHER = (6.0, 8.0, 11.0, 16.0)
"""Peak accelerations, by lift and angle squared, between which size by pressure angle and by curvature are traded."""

JERK_SHARE = 25.0
"""Peak jerk that goes with them: the acceleration may change fully within an eighth of the angle of a segment."""

NEAR_BOUND = 0.01
"""A cam within this share of the bound is small enough."""

NO_UNDERCUT = 1.02
"""Radius of curvature of the pitch curve over the roller's at least, whatever is asked: at 1 the cam has a cusp."""

LEAST_BASE = 1e-3
"""Base radius of a roller's cam at least, as a share of the lift, where the client asks for no hub."""

SLOW = 10.0
"""Natural frequency over cam speed below which the follower's own vibration is worth a warning (Norton §15.4)."""


def solve_cam(problem: CamProblem, progress: Progress) -> CamResult:
    """Solve a cam problem."""
    progress(0.05, "composing the motion program")
    composed = compose(problem)
    if isinstance(composed, NoProgram):
        return _none(problem, composed.reason, composed.proven, "motion_limits")
    composed = _smoothed(problem, composed, progress)
    if not problem.accept_discontinuity and not composed.program.obeys_fundamental_law:
        joint = next(joint for joint in composed.program.continuity if not all(joint.continuous[:3]))
        where = f"/segments/{joint.segments[1]}"
        raise ContradictionError(Contradiction(where, "the motion is not continuous there; see accept_discontinuity"))
    progress(0.5, "sizing the cam")
    sized = _sized(problem, composed.program)
    if sized is None:
        proven = not isinstance(getattr(problem.follower, "pivot_distance", None), LengthRange)
        proven = proven and getattr(problem.follower, "offset", None) != "free" and composed.bound is None
        reason = "no cam of any size carries the program within the limits on pressure angle, curvature and face width"
        return _none(problem, reason, proven, "size")
    cam, size = sized
    progress(0.7, "verifying")
    angle = profile_angles(cam, problem.profile_points)
    mechanism = cam_mechanism(cam, angle)
    verification, measured = verify(problem, mechanism)
    for _ in range(REFINEMENTS):
        if measured is None or not np.isfinite(measured.off).all():
            break
        failed = {check.name for check in verification.checks if not check.passed}
        if "reproduces_program" in failed:
            finer = refined(angle, measured.off, REPRODUCED)
        elif failed & SHAPE and not _shape_fails(problem, cam):
            finer = refined(angle, np.ones_like(angle), REPRODUCED)
        else:
            break
        if len(finer) > FINEST:
            break
        angle = finer
        progress(0.8, f"verifying with {len(angle)} points")
        mechanism = cam_mechanism(cam, angle)
        verification, measured = verify(problem, mechanism)
    if measured is None:
        return _none(problem, "the follower cannot be laid against the profile", False, "follower_can_be_laid_on")
    design = CamDesign(
        mechanism=mechanism,
        segments=_segments(problem, composed),
        joints=_joints(problem, composed.program),
        optimality=_optimality(problem, composed, cam),
        verification=verification,
        metrics=_metrics(problem, cam, measured),
    )
    progress(1.0, "verified")
    return _result(problem, composed, design, size)


def _smoothed(problem: CamProblem, composed: Composition, progress: Progress) -> Composition:
    """For the least size: the motion whose cam is smallest when curvature counts as well.

    The convex program knows pressure angle, not the curvature of a roller's pitch curve, and the motion of least
    size is abrupt where nothing limits its acceleration. So it is solved again under limits on acceleration and
    jerk, and the smallest of the cams is taken. The bound stays that of all motions.
    """
    if problem.minimize != "size" or composed.bound is None or roller_radius_range(problem) is None:
        return composed
    stated = problem.limits
    unlimited = stated.acceleration is None and stated.jerk is None
    best, least = composed, math.inf if unlimited else _radius(problem, composed)
    span = min(s.angle for s in composed.program.segments if s.pieces.count > 1)
    for n, share in enumerate(SMOOTHER):
        if least <= composed.bound * (1.0 + NEAR_BOUND):
            break
        progress(0.1 + 0.4 * n / len(SMOOTHER), "trading size by pressure angle against size by curvature")
        a = share * composed.program.lift / span**2
        j = JERK_SHARE * a / span
        limits = stated.model_copy(
            update={"acceleration": min(stated.acceleration or a, a), "jerk": min(stated.jerk or j, j)}
        )
        other = compose(problem.model_copy(update={"limits": limits}), STEPS[:1])
        if isinstance(other, Composition):
            radius = _radius(problem, other)
            if radius < least:
                best, least = replace(other, bound=composed.bound, scope=composed.scope), radius
    return best


def _radius(problem: CamProblem, composed: Composition) -> float:
    sized = _sized(problem, composed.program)
    return math.inf if sized is None else sized[0].size


def _shape_fails(problem: CamProblem, cam: Cam) -> bool:
    """Whether the exact curves break a limit on curvature: then more points of the profile would not help."""
    limits = problem.limits
    if cam.roller_radius > 0.0:
        ratio = max(limits.curvature_ratio, NO_UNDERCUT)
        return cam.pitch_curvature_extremes.largest * ratio * cam.roller_radius > 1.0 + MEASURED_SLACK
    return cam.radius_extremes.least < least_face_radius(problem) * (1.0 - MEASURED_SLACK)


def _sized(problem: CamProblem, program: Program) -> tuple[Cam, Size] | None:
    """The smallest cam, or the one whose radius is stated; None where no radius is sound."""
    follower, limits = problem.follower, problem.limits
    rollers = roller_radius_range(problem)
    try:
        if rollers is None:
            return _flat_cam(problem, program)
        least = rollers[0] + max(limits.hub_radius, LEAST_BASE * program.lift)
        rise = math.radians(limits.pressure_angle)
        fall = math.radians(limits.pressure_angle_fall or limits.pressure_angle)
        roller_limits = RollerLimits(rise, fall, max(limits.curvature_ratio, NO_UNDERCUT) * rollers[0], least)
        size: Size | None
        made: core.Roller
        if isinstance(follower, TranslatingRoller):
            if follower.prime_radius is not None:
                size = Size(follower.prime_radius, True)
            elif follower.offset == "free":
                centred = translating_roller(program, 0.0, roller_limits)
                widest = centred.radius if centred is not None else program.lift * 10.0
                size = free_offset(program, roller_limits, (-widest, widest))
            else:
                size = translating_roller(program, float(follower.offset), roller_limits)
            if size is None:
                return None
            offset = size.free if follower.offset == "free" else float(follower.offset)
            made = core.TranslatingRoller(size.radius, rollers[0], offset or 0.0)
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
            made = core.OscillatingRoller(size.radius, rollers[0], follower.arm, distance, follower.sense)
        return _largest_roller(Cam(program, made, problem.rotation), rollers[1], problem), size
    except DimensionError:
        return None


def _flat_cam(problem: CamProblem, program: Program) -> tuple[Cam, Size] | None:
    follower, limits = problem.follower, problem.limits
    least = max(limits.hub_radius, LEAST_BASE * (program.lift if isinstance(follower, TranslatingFlat) else 0.0))
    size: Size | None
    made: core.Flat
    if isinstance(follower, TranslatingFlat):
        size = Size(follower.base_radius, True) if follower.base_radius else None
        size = size or translating_flat(program, least_face_radius(problem), least)
        made = core.TranslatingFlat(size.radius)
    else:
        assert not isinstance(follower, TranslatingRoller | OscillatingRoller)
        pivot, face, sense = follower.pivot_distance, follower.face_offset, follower.sense
        size = Size(follower.base_radius, True) if follower.base_radius else None
        size = size or oscillating_flat(
            program, pivot, face, sense, least_face_radius(problem), least, limits.face_width
        )
        if size is None:
            return None
        made = core.OscillatingFlat(size.radius, pivot, face, sense)
    return Cam(program, made, problem.rotation), size


def _largest_roller(cam: Cam, largest: float, problem: CamProblem) -> Cam:
    """The cam with the largest roller that curvature and hub allow: contact stress falls with it."""
    follower = cam.follower
    assert isinstance(follower, core.TranslatingRoller | core.OscillatingRoller)
    if largest <= follower.roller_radius:
        return cam
    found = cam.pitch_curvature_extremes
    steepest = max(found.largest, 1e-300)
    allowed = 1.0 / steepest / max(problem.limits.curvature_ratio, NO_UNDERCUT)
    hub = max(problem.limits.hub_radius, LEAST_BASE * cam.program.lift)
    radius = max(min(largest, allowed, follower.prime_radius - hub), follower.roller_radius)
    return replace(cam, follower=replace(follower, roller_radius=radius))


def _segments(problem: CamProblem, composed: Composition) -> list[CamSegment]:
    found, start = [], 0.0
    unit = 1.0 / problem.displacement_unit
    for stated, name, segment in zip(problem.segments, composed.names, composed.program.segments, strict=True):
        ends = segment.pieces.motion(0.0), segment.pieces.motion(segment.angle, before=True)
        found.append(
            CamSegment(
                motion=stated.motion,
                law=name,
                start=start,
                angle=stated.angle,
                displacement=(float(ends[0].s) * unit, float(ends[1].s) * unit),
                peak_velocity=segment.extremes(1).largest,
                peak_acceleration=segment.extremes(2).largest,
                peak_jerk=segment.extremes(3).largest,
            )
        )
        start += stated.angle
    return found


def _joints(problem: CamProblem, program: Program) -> list[CamJoint]:
    """Joints of the segments, and inner jumps."""
    names: tuple[Literal["s", "v", "a", "j"], ...] = ("s", "v", "a", "j")
    unit = 1.0 / problem.displacement_unit
    found = []
    for joint in program.continuity:
        jump = joint.jump
        found.append(
            CamJoint(
                angle=math.degrees(joint.angle),
                segments=joint.segments,
                continuous=[name for name, same in zip(names, joint.continuous, strict=True) if same],
                jump=(jump[0] * unit, jump[1], jump[2], jump[3]),
            )
        )
    return found


def _optimality(problem: CamProblem, composed: Composition, cam: Cam) -> Optimality:
    value, scope = composed.value, composed.scope
    if problem.minimize == "size":
        value = cam.size
        if composed.bound is not None:
            scope += "; the bound is by pressure angle, or by curvature and width of a face"
    bound = None if composed.bound is None else min(composed.bound, value)
    if problem.minimize == "peak_contact_force":
        value /= arm_length(problem)
        bound = None if bound is None else bound / arm_length(problem)
    gap = value / bound - 1.0 if bound else None
    return Optimality(criterion=problem.minimize, value=value, bound=bound, gap=gap, scope=scope)


def _metrics(problem: CamProblem, cam: Cam, measured: Measured) -> CamMetrics:
    program = cam.program
    roller = cam.roller_radius
    _, v, a, j = program.peaks
    angles = {}
    for name, where in (("rise", measured.rising), ("fall", ~measured.rising)):
        angles[name] = math.degrees(float(np.nanmax(measured.pressure_angle[where], initial=0.0))) if roller else None
    return CamMetrics(
        size=measured.radius,
        lift=program.lift / problem.displacement_unit,
        max_pressure_angle_rise=angles["rise"],
        max_pressure_angle_fall=angles["fall"],
        min_convex_radius=measured.convex_radius,
        min_concave_radius=None if math.isinf(measured.concave_radius) else measured.concave_radius,
        curvature_ratio=pitch_radius(measured, roller) / roller if roller else None,
        face_width=None if roller else measured.sweep,
        peak_velocity=v.largest,
        peak_acceleration=a.largest,
        peak_jerk=j.largest,
        rms_acceleration=root_mean_square(program, lambda motion: motion.a),
        peak_inertia_torque=extremes(
            lambda at: np.asarray(program.pieces.motion(at).v * program.pieces.motion(at).a), program.breaks
        ).largest,
        forces=_forces(problem, program),
    )


def _forces(problem: CamProblem, program: Program) -> CamForces | None:
    """Contact force and torque of the follower, with the least preload where the client leaves it free."""
    dynamics = problem.dynamics
    if dynamics is None:
        return None
    load, speed = follower_load(problem)
    arm = arm_length(problem)
    least = RunningCam(program, replace(load, preload=0.0), speed).least_preload(dynamics.least_force * arm)
    preload = least if dynamics.preload is None else load.preload
    running = RunningCam(program, replace(load, preload=preload), speed)
    force, torque = running.force_extremes, running.torque_extremes
    warnings = []
    if force.least < 0.0:
        warnings.append("the follower leaves the cam")
    elif force.least < dynamics.least_force * arm * (1.0 - 1e-9):
        warnings.append("the contact force falls below the least that was asked for")
    ratio = load.natural_frequency / speed
    if 0.0 < ratio < SLOW:
        warnings.append(f"the natural frequency is only {ratio:.3g} times the cam's speed; the follower will vibrate")
    return CamForces(
        preload=preload / arm,
        least_preload=least / arm,
        min_contact_force=force.least / arm,
        max_contact_force=force.greatest / arm,
        min_torque=torque.least,
        max_torque=torque.greatest,
        natural_frequency=load.natural_frequency,
        frequency_ratio=ratio,
        warning="; ".join(warnings) or None,
    )


def _result(problem: CamProblem, composed: Composition, design: CamDesign, size: Size) -> CamResult:
    passed = design.verification.passed
    failed = [check.name for check in design.verification.checks if not check.passed]
    kept = passed or problem.include_failed
    mechanism = design.mechanism
    radius = mechanism.prime_radius or mechanism.base_radius or 0.0
    name = "prime" if mechanism.prime_radius is not None else "base"
    if passed:
        summary = f"A cam of {name} radius {radius:.6g} {problem.length_unit} carries the program."
        if design.optimality.bound is not None and design.optimality.gap is not None:
            gap = 100.0 * design.optimality.gap
            summary += f" Its {problem.minimize} {design.optimality.value:.6g} is within {gap:.2g} % of the bound."
    else:
        summary = (
            f"The smallest cam found, of {name} radius {radius:.6g} {problem.length_unit}, fails: {', '.join(failed)}."
        )
        if "meets_accelerations" in failed and problem.limits.jerk is None:
            summary += " Without a limit on jerk an acceleration may be met for an instant only; state one."
    stated = getattr(problem.follower, "prime_radius", None) or getattr(problem.follower, "base_radius", None)
    given = composed.bound is None and not any(isinstance(s, Move) and s.law == "auto" for s in problem.segments)
    # With the laws given and the smallest cam proven, a limit on size is broken by every cam.
    proof = given and size.proven and failed == ["size"]
    return CamResult(
        designs=[design] if kept else [],
        search=CamSearch(
            method=_method(composed, stated is not None),
            complete=proof,
            candidates=1,
            accepted=int(passed),
            rejected={} if passed else {failed[0]: 1},
            seed=problem.seed,
            sizing_proven=size.proven,
        ),
        summary=summary,
    )


def _method(composed: Composition, stated: bool) -> str:
    program = "convex_program" if composed.bound is not None else "laws"
    return f"{program}, {'stated size' if stated else 'exact sizing'}"


def _none(problem: CamProblem, reason: str, proven: bool, cause: str) -> CamResult:
    return CamResult(
        designs=[],
        search=CamSearch(
            method="convex_program" if cause == "motion_limits" else "exact sizing",
            complete=proven,
            candidates=1,
            accepted=0,
            rejected={cause: 1},
            seed=problem.seed,
            sizing_proven=proven,
        ),
        summary=f"None exists: {reason}." if proven else f"None found: {reason}.",
    )
