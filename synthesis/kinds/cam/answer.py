"""Parts that the answers for all types of cam share: segments, joints, optimality, forces, and the result."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np

from kinematics.cam.dynamics import RunningCam
from kinematics.cam.motion.extremes import find_extremes
from kinematics.cam.motion.program import Program
from kinematics.cam.springs import Spring
from kinematics.message import compose, join_messages
from synthesis.kinds.cam.design import (
    BarrelCamDesign,
    Binding,
    CamDesign,
    CamForces,
    CamJoint,
    CamJump,
    CamResult,
    CamSearch,
    CamSegment,
    ContactOverSpeeds,
    Optimality,
    PushingCam,
    SpringChoice,
)
from synthesis.kinds.cam.dynamics.vibration import compute_train_vibration
from synthesis.kinds.cam.follower_loads import (
    compute_min_rate,
    convert_rpm,
    find_weakest_contact,
    get_arm_length,
    press_follower,
)
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.program.composition import Composition
from synthesis.kinds.cam.program.criterion import compute_root_mean_square
from synthesis.kinds.cam.program.derivative_warnings import describe_excesses
from synthesis.kinds.cam.sizing.sizing import Size
from synthesis.kinds.cam.statement.followers import RateRange
from synthesis.kinds.cam.statement.segments import Move
from synthesis.model.answer import Check
from synthesis.model.dimension import FORCE
from synthesis.model.json_object import JsonObject
from synthesis.results.candidate_log import CandidateLog
from synthesis.verification.checks import check_minimum

FORCE_SLACK = 1e-9
"""Relative slack of the minimum contact force, which the smallest sufficient preload attains to rounding."""

SAMPLE_COUNT = 181
"""Number of cam angles sampled between two wall changes to decide which cam pushes there."""

ACTIVE_TOLERANCE = 1e-6
"""Relative distance to a constraint within which the constraint counts as active."""


DECIDING_TOLERANCE = 5e-3
"""Distance of a measured value from its limit, as a share, up to which the limit counts as setting the size."""


def describe_segments(problem: CamProblem, composed: Composition) -> list[CamSegment]:
    """Return every segment with its law, its cam angles and its exact peaks."""
    segments, start = [], 0.0
    unit = 1.0 / problem.displacement_unit
    for stated, name, segment in zip(problem.segments, composed.names, composed.program.segments, strict=True):
        ends = segment.pieces.motion(0.0), segment.pieces.motion(segment.angle, before=True)
        segments.append(
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
    return segments


def describe_joints(problem: CamProblem, program: Program) -> list[CamJoint]:
    """Return the joints between segments, and jumps inside segments."""
    names: tuple[Literal["s", "v", "a", "j"], ...] = ("s", "v", "a", "j")
    unit = 1.0 / problem.displacement_unit
    joints = []
    for joint in program.continuity:
        jump = joint.jump
        joints.append(
            CamJoint(
                angle=math.degrees(joint.angle),
                segments=joint.segments,
                continuous=[name for name, same in zip(names, joint.continuous, strict=True) if same],
                jump=CamJump(s=jump[0] * unit, v=jump[1], a=jump[2], j=jump[3]),
            )
        )
    return joints


def evaluate_optimality(problem: CamProblem, composed: Composition, size: float) -> Optimality:
    """Return the criterion's value and lower bound; ``size`` is the cam's size, the value if it is the criterion."""
    value, scope = composed.value, composed.scope
    if problem.minimize == "size":
        value = size
        # The convex program bounds the size by pressure angle and curvature only; the other limits may
        # enlarge the cam.
        if composed.bound is not None:
            scope = compose("cam-scope-of-size", scope=scope)
    bound = None if composed.bound is None else min(composed.bound, value)
    # The program works with moments about an oscillating arm's pivot; the answer is in forces at the roller.
    if problem.minimize == "peak_contact_force":
        value /= get_arm_length(problem)
        bound = None if bound is None else bound / get_arm_length(problem)
    # A bound of zero proves nothing about the gap.
    gap = value / bound - 1.0 if bound else None
    return Optimality(
        criterion=problem.minimize,
        value=value,
        bound=bound,
        gap=gap,
        scope=scope,
        warning=describe_excesses(problem, composed),
    )


def compute_forces(problem: CamProblem, program: Program) -> CamForces | None:
    """Compute contact force and torque of the follower; a free spring and a free preload are chosen first."""
    if problem.dynamics is None:
        return None
    stated, pressed = problem, press_follower(problem, program)
    problem, running, spring, top_rpm = pressed.problem, pressed.running, pressed.spring, pressed.top_rpm
    dynamics, load, arm = problem.dynamics, running.load, get_arm_length(problem)
    assert dynamics is not None
    groove = problem.is_form_closed
    force, torque = running.force_extremes, running.torque_extremes
    over_speeds = None if top_rpm is None else _find_contact_over_speeds(running, top_rpm, arm)
    # The roller changes walls of a groove at the angles at which the force changes sign.
    changes = np.unique(np.degrees(running.find_reversals()).round(9)).tolist() if groove else None
    damping = load.damping_ratio
    train, warning = compute_train_vibration(problem, running)
    return CamForces(
        preload=load.preload / arm,
        least_preload=pressed.least_preload / arm,
        min_contact_force=force.least / arm,
        max_contact_force=force.greatest / arm,
        min_torque=torque.least,
        max_torque=torque.greatest,
        wall_changes=changes,
        pushing=_find_pushing_cams(running, changes)
        if problem.closure == "conjugate" and changes is not None
        else None,
        spring_rate=load.spring_rate / arm**2,
        jump_speed=None if groove else _compute_jump_rpm(running),
        natural_frequency=load.natural_frequency,
        # An overdamped follower (damping ratio of at least 1) does not oscillate, so it has no damped
        # frequency.
        damped_frequency=load.natural_frequency * math.sqrt(1.0 - damping**2) if damping < 1.0 else None,
        frequency_ratio=load.natural_frequency / running.speed,
        over_speeds=over_speeds,
        spring=None
        if spring is None or over_speeds is None
        else _describe_spring_choice(stated, spring, over_speeds, arm),
        train=train,
        warning=warning,
    )


def _find_pushing_cams(running: RunningCam, changes: Sequence[float]) -> list[PushingCam]:
    """Find which conjugate cam pushes between wall changes: the first if the force acts along the displacement."""
    # Without wall changes, one cam pushes over the whole turn.
    starts = list(changes) or [0.0]
    ends = [*starts[1:], starts[0] if changes else 360.0]
    found = []
    for start, end in zip(starts, ends, strict=True):
        last = end if end > start else end + 360.0
        # Read the sign at the sample with the largest force, because near the changes it is only rounding. Both ends
        # are left out.
        force = running.force(np.radians(np.linspace(start, last, SAMPLE_COUNT)[1:-1]))
        strongest = force[np.abs(force).argmax()]
        found.append(PushingCam(start=start, end=end, cam=1 if strongest >= 0.0 else 2))
    return found


def _compute_jump_rpm(running: RunningCam) -> float | None:
    """Return the lowest speed at which the follower leaves the cam, rev/min.

    A follower that rests on the cam without force has not left it.
    """
    speed = running.find_jump_speed(-FORCE_SLACK * running.force_extremes.largest)
    return None if math.isinf(speed) else speed * 30.0 / math.pi


def _find_contact_over_speeds(running: RunningCam, top_rpm: float, arm: float) -> ContactOverSpeeds:
    """Find the minimum contact force over the turn and over all speeds up to the maximum."""
    weakest = find_weakest_contact(running.program, running.load, top_rpm)
    return ContactOverSpeeds(
        max_rpm=top_rpm,
        min_contact_force=weakest.force / arm,
        angle=math.degrees(weakest.angle),
        rpm=weakest.speed * 30.0 / math.pi,
    )


def _describe_spring_choice(
    problem: CamProblem, spring: Spring, over_speeds: ContactOverSpeeds, arm: float
) -> SpringChoice:
    """Describe the chosen spring with its lower bound and its active constraints."""
    dynamics = problem.dynamics
    assert dynamics is not None
    assert problem.speed_rpm is not None
    force, rate, stated = spring.greatest_force / arm, spring.rate / arm**2, dynamics.spring_rate
    binding: list[Binding] = []
    if over_speeds.min_contact_force <= dynamics.least_force + ACTIVE_TOLERANCE * abs(force):
        binding.append("least_force")
    # A free rate has no given range.
    low, high = (stated.min, stated.max) if isinstance(stated, RateRange) else (0.0, math.inf)
    if dynamics.min_frequency_ratio is not None:
        speed = convert_rpm(problem.speed_rpm)
        needed = compute_min_rate(dynamics, problem.length_unit, speed)
        if low < needed and rate <= needed * (1.0 + ACTIVE_TOLERANCE):
            binding.append("min_frequency_ratio")
            # The frequency ratio, not the lower end of the range, determines the rate: do not report both.
            low = -1.0
    if rate <= low * (1.0 + ACTIVE_TOLERANCE):
        binding.append("spring_rate/min")
    if rate >= high * (1.0 - ACTIVE_TOLERANCE):
        binding.append("spring_rate/max")
    bound = None if spring.bound is None else spring.bound / arm
    gap = force / bound - 1.0 if bound else None
    return SpringChoice(max_contact_force=force, bound=bound, gap=gap, binding=binding)


def check_forces(problem: CamProblem, forces: CamForces | None) -> list[Check]:
    """Check that the minimum contact force is at least the required one (0 by default).

    Between two walls the force may have either sign, so that only the frequency ratio is checked there.
    """
    if forces is None or problem.dynamics is None:
        return []
    checks, demanded = [], problem.dynamics
    if demanded.min_frequency_ratio is not None:
        checks.append(check_minimum("frequency_ratio", forces.frequency_ratio, demanded.min_frequency_ratio))
    if forces.wall_changes is not None:
        return checks
    least, found = demanded.least_force, forces.min_contact_force
    if forces.over_speeds is not None:
        found = min(found, forces.over_speeds.min_contact_force)
    rounding = FORCE_SLACK * max(abs(found), abs(forces.max_contact_force), least)
    return [
        Check(name="contact_force", passed=found >= least - rounding, value=found, limit=least, dimension=FORCE),
        *checks,
    ]


def compute_motion_metrics(problem: CamProblem, program: Program) -> JsonObject:
    """Compute the metrics of the motion program alone, which do not depend on the cam."""
    _, v, a, j = program.peaks
    torque = find_extremes(
        lambda at: np.asarray(program.pieces.motion(at).v * program.pieces.motion(at).a), program.breaks
    )
    return {
        "peak_velocity": v.largest,
        "peak_acceleration": a.largest,
        # At a jump of the acceleration the jerk is unbounded, so no peak is reported.
        "peak_jerk": j.largest if program.obeys_fundamental_law else None,
        "rms_acceleration": compute_root_mean_square(program, lambda motion: motion.a),
        "peak_inertia_torque": torque.largest,
        "forces": compute_forces(problem, program),
    }


def build_result(
    problem: CamProblem,
    composed: Composition,
    design: CamDesign | BarrelCamDesign,
    size: Size,
    radius: tuple[str, float],
) -> CamResult:
    """Build the result for its only candidate; ``radius`` is the name and value of the cam's radius in the summary."""
    passed = design.verification.passed
    failed = [check.name for check in design.verification.checks if not check.passed]
    sifting = CandidateLog[CamDesign | BarrelCamDesign](problem)
    sifting.record_candidate(design)
    circle, length = radius
    if passed:
        summary = [compose("cam-follows-program", circle=circle, radius=f"{length:.6g}", unit=problem.length_unit)]
        summary += _describe_deciding_defaults(problem, design)
        if design.optimality.bound is not None and design.optimality.gap is not None:
            gap = 100.0 * design.optimality.gap
            summary.append(compose("cam-is-near-minimum", criterion=problem.minimize, gap=f"{gap:.2g}"))
        if design.optimality.warning is not None:
            summary.append(design.optimality.warning)
        if design.metrics.peak_jerk is None:
            summary.append(compose("cam-jerk-unbounded"))
    else:
        summary = [
            compose(
                "cam-fails-checks",
                circle=circle,
                radius=f"{length:.6g}",
                unit=problem.length_unit,
                checks=", ".join(failed),
            )
        ]
        if "meets_accelerations" in failed and problem.limits.jerk is None:
            summary.append(compose("cam-acceleration-for-instant"))
    stated = _has_given_size(problem)
    given = composed.bound is None and not any(isinstance(s, Move) and s.law == "auto" for s in problem.segments)
    # If the laws are given and the cam is proven to be the smallest, every cam breaks a failed limit on size.
    proof = given and size.proven and failed == ["size"]
    return CamResult(
        designs=sifting.select_designs(list),
        search=CamSearch(
            **dict(sifting.build_search(_describe_method(composed, stated), complete=proof)), sizing_proven=size.proven
        ),
        summary=join_messages(summary),
    )


def _describe_deciding_defaults(problem: CamProblem, design: CamDesign | BarrelCamDesign) -> list[str]:
    """Describe the limits that the client has not given and that the size of the cam just keeps."""
    if _has_given_size(problem):
        return []
    fields = {"curvature_ratio": "curvature_ratio", "pressure_angle": "pressure_angle"}
    if problem.limits.pressure_angle_fall is None:
        fields["pressure_angle_fall"] = "pressure_angle"
    deciding = {}
    for check in design.verification.checks:
        field = fields.get(check.name)
        if field is None or field in problem.limits.model_fields_set or check.value is None or not check.limit:
            continue
        if abs(check.value / check.limit - 1.0) <= DECIDING_TOLERANCE:
            deciding[field] = f"{getattr(problem.limits, field):g}"
    return [compose("cam-size-set-by-default", limit=name, value=value) for name, value in deciding.items()]


def _has_given_size(problem: CamProblem) -> bool:
    """Return whether a radius is given, which then is not the result of an optimization."""
    return any(getattr(problem.follower, f"{part}_radius", None) for part in ("prime", "base", "cylinder"))


def _describe_method(composed: Composition, has_fixed_size: bool) -> str:
    program = "convex_program" if composed.bound is not None else "laws"
    return f"{program}, {'given size' if has_fixed_size else 'exact sizing'}"


def build_empty_result(problem: CamProblem, reason: str, proven: bool, cause: str) -> CamResult:
    """Build a result without designs that gives the reason."""
    sifting = CandidateLog[CamDesign](problem)
    sifting.reject(cause)
    method = "convex_program" if cause == "motion_limits" else "exact sizing"
    return CamResult(
        designs=[],
        search=CamSearch(**dict(sifting.build_search(method, complete=proven)), sizing_proven=proven),
        summary=compose("cam-none-exists" if proven else "cam-none-found", reason=reason),
    )
