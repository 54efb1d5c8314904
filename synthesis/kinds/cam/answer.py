"""What every answer about a cam has in common: segments, joints, how good the program is, forces, and the result."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from kinematics.cam.dynamics import RunningCam
from kinematics.cam.extremes import extremes
from kinematics.cam.program import Program
from kinematics.cam.springs import Spring
from synthesis.kinds.cam.composition import Composition, root_mean_square
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
from synthesis.kinds.cam.excesses import warning_of
from synthesis.kinds.cam.followers import RateRange
from synthesis.kinds.cam.loads import (
    arm_length,
    held,
    least_rate,
    radians_a_second,
    weakest_contact,
)
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.segments import Move
from synthesis.kinds.cam.sizing import Size
from synthesis.kinds.cam.vibration import train_vibration
from synthesis.model.answer import Check
from synthesis.model.dimension import FORCE
from synthesis.outcome.sifting import Sifting
from synthesis.proof.checks import at_least

FORCE_SLACK = 1e-9
"""Relative slack of the least contact force: the least preload gives exactly that, but for rounding."""

SAMPLES = 181
"""Cam angles between two changes of walls at which is asked which cam pushes; it is one and the same in between."""

BINDS = 1e-6
"""Relative distance to a demand within which it is met with nothing to spare."""


def segments_of(problem: CamProblem, composed: Composition) -> list[CamSegment]:
    """Every segment with its law, its place and its exact peaks."""
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


def joints_of(problem: CamProblem, program: Program) -> list[CamJoint]:
    """Joints of the segments, and inner jumps."""
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


def optimality_of(problem: CamProblem, composed: Composition, size: float) -> Optimality:
    """The criterion's value and its bound; ``size`` is the cam's, where that is the criterion."""
    value, scope = composed.value, composed.scope
    if problem.minimize == "size":
        value = size
        if composed.bound is not None:
            scope += "; the bound is by pressure angle, or by curvature and width of a face"
    bound = None if composed.bound is None else min(composed.bound, value)
    if problem.minimize == "peak_contact_force":
        value /= arm_length(problem)
        bound = None if bound is None else bound / arm_length(problem)
    gap = value / bound - 1.0 if bound else None
    return Optimality(
        criterion=problem.minimize,
        value=value,
        bound=bound,
        gap=gap,
        scope=scope,
        warning=warning_of(problem, composed),
    )


def forces_of(problem: CamProblem, program: Program) -> CamForces | None:
    """Contact force and torque of the follower, with spring and least preload where the client leaves them free."""
    if problem.dynamics is None:
        return None
    stated, pressed = problem, held(problem, program)
    problem, running, spring, top_rpm = pressed.problem, pressed.running, pressed.spring, pressed.top_rpm
    dynamics, load, arm = problem.dynamics, running.load, arm_length(problem)
    assert dynamics is not None
    groove = problem.grooved
    force, torque = running.force_extremes, running.torque_extremes
    over_speeds = None if top_rpm is None else _over_speeds(running, top_rpm, arm)
    changes = np.unique(np.degrees(running.reversals()).round(9)).tolist() if groove else None
    damping = dynamics.damping_ratio
    train, warning = train_vibration(problem, running)
    return CamForces(
        preload=load.preload / arm,
        least_preload=pressed.least_preload / arm,
        min_contact_force=force.least / arm,
        max_contact_force=force.greatest / arm,
        min_torque=torque.least,
        max_torque=torque.greatest,
        wall_changes=changes,
        pushing=_pushing(running, changes) if problem.closure == "conjugate" and changes is not None else None,
        spring_rate=load.spring_rate / arm**2,
        jump_speed=None if groove else _jump_rpm(running),
        natural_frequency=load.natural_frequency,
        damped_frequency=load.natural_frequency * math.sqrt(1.0 - damping**2) if damping < 1.0 else None,
        frequency_ratio=load.natural_frequency / running.speed,
        over_speeds=over_speeds,
        spring=None if spring is None or over_speeds is None else _choice(stated, spring, over_speeds, arm),
        train=train,
        warning=warning,
    )


def _pushing(running: RunningCam, changes: Sequence[float]) -> list[PushingCam]:
    """Which of two conjugate cams pushes between the changes: the first where the force is along the displacement."""
    starts = list(changes) or [0.0]
    ends = [*starts[1:], starts[0] if changes else 360.0]
    found = []
    for start, end in zip(starts, ends, strict=True):
        last = end if end > start else end + 360.0
        force = running.force(np.radians(np.linspace(start, last, SAMPLES)[1:-1]))
        strongest = force[np.abs(force).argmax()]
        found.append(PushingCam(start=start, end=end, cam=1 if strongest >= 0.0 else 2))
    return found


def _jump_rpm(running: RunningCam) -> float | None:
    """The speed at which the follower first leaves the cam; where it rests without any force it has not left it."""
    speed = running.jump_speed(-FORCE_SLACK * running.force_extremes.largest)
    return None if math.isinf(speed) else speed * 30.0 / math.pi


def _over_speeds(running: RunningCam, top_rpm: float, arm: float) -> ContactOverSpeeds:
    """Where the follower is pressed to the cam least, at any speed up to the greatest."""
    weakest = weakest_contact(running.program, running.load, top_rpm)
    return ContactOverSpeeds(
        max_rpm=top_rpm,
        min_contact_force=weakest.force / arm,
        angle=math.degrees(weakest.angle),
        rpm=weakest.speed * 30.0 / math.pi,
    )


def _choice(problem: CamProblem, spring: Spring, over_speeds: ContactOverSpeeds, arm: float) -> SpringChoice:
    """The chosen spring with its bound, and the demands that are met with nothing to spare."""
    dynamics = problem.dynamics
    assert dynamics is not None
    assert problem.speed_rpm is not None
    force, rate, stated = spring.greatest_force / arm, spring.rate / arm**2, dynamics.spring_rate
    binding: list[Binding] = []
    if over_speeds.min_contact_force <= dynamics.least_force + BINDS * abs(force):
        binding.append("least_force")
    low, high = (stated.min, stated.max) if isinstance(stated, RateRange) else (0.0, math.inf)
    if dynamics.min_frequency_ratio is not None:
        speed = radians_a_second(problem.speed_rpm)
        needed = least_rate(dynamics, problem.length_unit, speed)
        if low < needed and rate <= needed * (1.0 + BINDS):
            binding.append("min_frequency_ratio")
            low = -1.0
    if rate <= low * (1.0 + BINDS):
        binding.append("spring_rate/min")
    if rate >= high * (1.0 - BINDS):
        binding.append("spring_rate/max")
    bound = None if spring.bound is None else spring.bound / arm
    gap = force / bound - 1.0 if bound else None
    return SpringChoice(max_contact_force=force, bound=bound, gap=gap, binding=binding)


def force_checks(problem: CamProblem, forces: CamForces | None) -> list[Check]:
    """Whether the follower stays on the cam with the least force that is demanded, none where no other is stated.

    Between two walls the force may have either sign.
    """
    if forces is None or problem.dynamics is None:
        return []
    checks, demanded = [], problem.dynamics
    if demanded.min_frequency_ratio is not None:
        checks.append(at_least("frequency_ratio", forces.frequency_ratio, demanded.min_frequency_ratio))
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


def motion_metrics(problem: CamProblem, program: Program) -> dict[str, Any]:
    """Metrics of the motion alone, whatever cam makes it."""
    _, v, a, j = program.peaks
    torque = extremes(lambda at: np.asarray(program.pieces.motion(at).v * program.pieces.motion(at).a), program.breaks)
    return {
        "peak_velocity": v.largest,
        "peak_acceleration": a.largest,
        "peak_jerk": j.largest if program.obeys_fundamental_law else None,
        "rms_acceleration": root_mean_square(program, lambda motion: motion.a),
        "peak_inertia_torque": torque.largest,
        "forces": forces_of(problem, program),
    }


def result_of(
    problem: CamProblem,
    composed: Composition,
    design: CamDesign | BarrelCamDesign,
    size: Size,
    radius: tuple[str, float],
) -> CamResult:
    """The result with its only candidate; ``radius`` is its name and value, for the summary."""
    passed = design.verification.passed
    failed = [check.name for check in design.verification.checks if not check.passed]
    sifting = Sifting[CamDesign | BarrelCamDesign](problem)
    sifting.add(design)
    name, length = radius
    if passed:
        summary = f"A cam of {name} radius {length:.6g} {problem.length_unit} carries the program."
        if design.optimality.bound is not None and design.optimality.gap is not None:
            gap = 100.0 * design.optimality.gap
            summary += f" Its {problem.minimize.replace('_', ' ')} is within {gap:.2g} % of the least possible."
        if design.optimality.warning is not None:
            summary += f" {design.optimality.warning}"
        if design.metrics.peak_jerk is None:
            summary += " Where its acceleration jumps the jerk has no bound, so that no peak of it is told."
    else:
        summary = (
            f"The smallest cam found, of {name} radius {length:.6g} {problem.length_unit}, fails: {', '.join(failed)}."
        )
        if "meets_accelerations" in failed and problem.limits.jerk is None:
            summary += " Without a limit on jerk an acceleration may be met for an instant only; state one."
    stated = any(getattr(problem.follower, f"{part}_radius", None) for part in ("prime", "base", "cylinder"))
    given = composed.bound is None and not any(isinstance(s, Move) and s.law == "auto" for s in problem.segments)
    # With the laws given and the smallest cam proven, a limit on size is broken by every cam.
    proof = given and size.proven and failed == ["size"]
    return CamResult(
        designs=sifting.designs(list),
        search=CamSearch(**dict(sifting.search(_method(composed, stated), complete=proof)), sizing_proven=size.proven),
        summary=summary,
    )


def _method(composed: Composition, stated: bool) -> str:
    program = "convex_program" if composed.bound is not None else "laws"
    return f"{program}, {'stated size' if stated else 'exact sizing'}"


def none_of(problem: CamProblem, reason: str, proven: bool, cause: str) -> CamResult:
    """No design, and why."""
    sifting = Sifting[CamDesign](problem)
    sifting.reject(cause)
    method = "convex_program" if cause == "motion_limits" else "exact sizing"
    return CamResult(
        designs=[],
        search=CamSearch(**dict(sifting.search(method, complete=proven)), sizing_proven=proven),
        summary=f"None exists: {reason}." if proven else f"None found: {reason}.",
    )
