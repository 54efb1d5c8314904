"""The proof of a cam: its follower is laid against the finished profile, and what it does is measured.

Nothing that a solver computed is taken over but the answer itself. The points of the profile alone give
displacement, pressure angle and radius of curvature at cam angles four times as close as the design's; the
displacement is compared with the program's table, its quintic between, and the program's table with what the problem
states: laws and rests by the analysis core. What is stated of automatic and optimal motions (ends, conditions, bands,
limits on velocity, acceleration and jerk) is measured on the profile too (:mod:`synthesis.kinds.cam.measured_rates`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.contact import Contour
from kinematics.cam.follower import Follower
from kinematics.cam.motion_laws import LAWS
from kinematics.cam.program import TURN
from kinematics.cam.segments import Condition as PolynomialCondition
from kinematics.cam.segments import dwell, law_segment, polynomial_segment
from kinematics.errors import DimensionError, ShapeError
from synthesis.kinds.cam.design import CamMechanism, ProgramTable
from synthesis.kinds.cam.measured_rates import rate_checks
from synthesis.kinds.cam.mechanism import (
    core_follower,
    points_of,
    profile_points,
    table_angles,
)
from synthesis.kinds.cam.problem import (
    CamProblem,
    Dwell,
    Move,
    OscillatingRoller,
    Polynomial,
    TranslatingRoller,
)
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ACCELERATION, ANGLE, JERK, LENGTH, VELOCITY, Dimension

Real = NDArray[np.float64]

FINER = 4
"""Cam angles of the verification for each one of the design."""

REPRODUCED = 1e-6
"""Deviation of the measured displacement from the program, as a share of the lift: a micrometre in a metre of lift."""

REPRODUCED_WITH_JUMPS = 1e-4
"""The same where the client accepted jumps in velocity or acceleration, which no curve through points can follow."""

STATED = 1e-7
"""Deviation of the program from the statement, as a share of the lift."""

LIMIT_SLACK = 1e-6
"""Relative slack of limits on the motion where the program's table has it, which keeps them exactly."""

MEASURED_SLACK = 2e-3
"""Relative slack of limits on pressure angle, curvature and width, which are measured on a curve through points: where
the acceleration bends, its local fifth degree is off by that much."""


@dataclass(frozen=True)
class Measured:
    """What the finished profile does, at the finer cam angles.

    ``off`` is the greatest deviation of the displacement from the program, at each angle of its table and from there to
    the next, as a share of the lift; NaN where the follower touches nothing.
    """

    angle: Real
    s: Real
    pressure_angle: Real
    rising: NDArray[np.bool_]
    convex_radius: float
    concave_radius: float
    sweep: float
    radius: float
    off: Real


def verify(problem: CamProblem, mechanism: CamMechanism) -> tuple[Verification, Measured | None]:
    """Measure a cam against its problem.

    Parameters
    ----------
    problem : CamProblem
        What was asked.
    mechanism : CamMechanism
        The finished cam; its pitch curve is not looked at.

    Returns
    -------
    Verification, Measured or None
        None where the follower cannot be laid against the profile at all.
    """
    try:
        contour = Contour(profile_points(mechanism))
        follower = core_follower(mechanism)
        angle = finer(table_angles(mechanism.program))
        contact = contour.follow(follower, angle, mechanism.rotation)
    except (DimensionError, ShapeError):
        return Verification(passed=False, checks=[Check(name="follower_can_be_laid_on", passed=False)]), None
    table = np.array(mechanism.program.s) * problem.displacement_unit
    lift = float(np.ptp(table)) or 1.0
    checks = program_checks(problem, mechanism.program, lift)
    touches = bool(contact.valid.all())
    program = between(table_angles(mechanism.program), table, mechanism.program)
    off = np.abs(contact.s - program).reshape(-1, FINER).max(axis=1) / lift
    gap = float(off.max()) if touches else math.inf
    allowed = REPRODUCED_WITH_JUMPS if problem.accept_discontinuity else REPRODUCED
    checks += [
        Check(name="touches_everywhere", passed=touches),
        Check(name="reproduces_program", passed=gap <= allowed, value=min(gap, 1e9), limit=allowed),
        Check(name="no_cusp", passed=not contour.cusped),
        Check(name="does_not_cross_itself", passed=len(contour.crossings) == 0),
    ]
    if problem.closure == "form":
        found, gaps = _groove_checks(mechanism, follower, angle, program, lift, allowed)
        checks += found
        off = np.maximum(off, gaps.reshape(-1, FINER).max(axis=1))
    curvature = _curvature(contour)
    rising = np.repeat(np.array(mechanism.program.v), FINER) >= 0.0
    roller = isinstance(problem.follower, TranslatingRoller | OscillatingRoller)
    concave = float(-1.0 / curvature.min()) if curvature.min() < 0.0 else math.inf
    reach = _reach(mechanism, contact.point, angle)
    measured = Measured(
        angle,
        contact.s,
        contact.pressure_angle,
        rising,
        float(1.0 / curvature.max()) if curvature.max() > 0.0 else math.inf,
        concave,
        float(np.ptp(reach)),
        float(np.abs(contour.points).max()),
        off,
    )
    if touches:

        def measure(angle: Real) -> tuple[Real, Real]:
            found = contour.follow(follower, angle, mechanism.rotation)
            return found.s, found.v

        checks += rate_checks(problem, measure, lift, allowed)
        checks += _limit_checks(problem, mechanism, measured, roller)
    return Verification.of(checks), measured


def _groove_checks(
    mechanism: CamMechanism, follower: Follower, angle: Real, program: Real, lift: float, allowed: float
) -> tuple[list[Check], Real]:
    """The roller against the outer wall, from within: the same program comes back. Also how far it is off."""
    none = [Check(name="outer_wall_reproduces_program", passed=False)], np.zeros_like(angle)
    if mechanism.outer_wall is None:
        return none
    try:
        wall = Contour(points_of(mechanism.outer_wall))
        found = wall.within(follower, angle, mechanism.rotation)
    except (DimensionError, ShapeError):
        return none
    gaps = np.abs(found - program) / lift
    gap = float(gaps.max()) if np.isfinite(found).all() else math.inf
    sound = not wall.cusped and len(wall.crossings) == 0
    return [
        Check(name="outer_wall_reproduces_program", passed=gap <= allowed, value=min(gap, 1e9), limit=allowed),
        Check(name="outer_wall_is_sound", passed=sound),
    ], gaps


def finer(angle: Real) -> Real:
    """Each interval of a closed series of angles in equal parts."""
    step = np.diff(np.append(angle, TURN + angle[0]))
    return np.asarray((angle[:, None] + step[:, None] * (np.arange(FINER) / FINER)).reshape(-1), np.float64)


def between(angle: Real, s: Real, program: ProgramTable) -> Real:
    """Displacement at the finer angles, from the table's s, v, a at both ends of each interval: its quintic.

    The profile's points are the contacts at the table's angles, so that between them alone it can go astray.
    """
    step = np.diff(np.append(angle, TURN + angle[0]))[:, None]
    begin = s[:, None], step * np.array(program.v)[:, None], step**2 * np.array(program.a)[:, None]
    end = tuple(np.roll(values, -1, axis=0) for values in (s, np.array(program.v), np.array(program.a)))
    rest = end[0][:, None] - begin[0] - begin[1] - 0.5 * begin[2]
    rest1 = step * end[1][:, None] - begin[1] - begin[2]
    rest2 = step**2 * end[2][:, None] - begin[2]
    u = np.arange(FINER) / FINER
    third = 10.0 * rest - 4.0 * rest1 + 0.5 * rest2
    fourth = -15.0 * rest + 7.0 * rest1 - rest2
    fifth = 6.0 * rest - 3.0 * rest1 + 0.5 * rest2
    found = begin[0] + u * (begin[1] + u * (0.5 * begin[2] + u * (third + u * (fourth + u * fifth))))
    return np.asarray(found.reshape(-1), np.float64)


def _curvature(contour: Contour) -> Real:
    """Of the circle through each three neighbouring points of the profile, positive where convex.

    Between its points the curvature of a cam can bend sharply, where its jerk jumps; a circle through three points
    averages over them and does not overshoot, as the derivatives of a curve of higher degree do.
    """
    points = contour.points
    before, after = np.roll(points, 1), np.roll(points, -1)
    sides = np.abs(points - before) * np.abs(after - points) * np.abs(after - before)
    sign = 1.0 if contour.turns_ccw else -1.0
    return np.asarray(2.0 * sign * (np.conj(points - before) * (after - points)).imag / sides)


def _reach(mechanism: CamMechanism, contact: NDArray[np.complex128], angle: Real) -> Real:
    """Where on a face the contact is, along the face; zero for a roller."""
    if mechanism.base_radius is None:
        return np.zeros_like(angle)
    sign = 1.0 if mechanism.rotation == "ccw" else -1.0
    ground = contact * np.exp(1j * sign * angle)
    if mechanism.follower.type == "translating_flat":
        return np.asarray(ground.imag)
    pivot, face = mechanism.follower.pivot_distance or 0.0, mechanism.follower.face_offset or 0.0
    return np.asarray(np.sqrt(np.maximum(np.abs(ground - pivot) ** 2 - face**2, 0.0)))


def _limit_checks(problem: CamProblem, mechanism: CamMechanism, measured: Measured, roller: bool) -> list[Check]:
    limits, checks = problem.limits, []
    if roller:
        steepest = {}
        for name, where in (("pressure_angle", measured.rising), ("pressure_angle_fall", ~measured.rising)):
            steepest[name] = math.degrees(float(measured.pressure_angle[where].max())) if where.any() else 0.0
        fall = limits.pressure_angle_fall or limits.pressure_angle
        checks.append(
            at_most("pressure_angle", steepest["pressure_angle"], limits.pressure_angle, MEASURED_SLACK, ANGLE)
        )
        checks.append(at_most("pressure_angle_fall", steepest["pressure_angle_fall"], fall, MEASURED_SLACK, ANGLE))
        radius = mechanism.follower.roller_radius or 0.0
        ratio = pitch_radius(measured, radius) / radius
        checks.append(at_least("curvature_ratio", ratio, limits.curvature_ratio, MEASURED_SLACK))
        base = (mechanism.prime_radius or 0.0) - radius
    else:
        checks.append(at_least("min_radius", measured.convex_radius, limits.min_radius, MEASURED_SLACK, LENGTH))
        checks.append(Check(name="convex", passed=math.isinf(measured.concave_radius)))
        if limits.face_width is not None:
            checks.append(at_most("face_width", measured.sweep, limits.face_width, MEASURED_SLACK, LENGTH))
        base = mechanism.base_radius or 0.0
    pivot = mechanism.follower.pivot_distance
    if pivot is not None:
        # The cam turns all around, so that its greatest radius comes to where the arm is borne.
        checks.append(
            Check(
                name="clears_pivot",
                passed=measured.radius < pivot,
                value=measured.radius,
                limit=pivot,
                dimension=LENGTH,
            )
        )
    if limits.hub_radius > 0.0:
        checks.append(at_least("hub_radius", base, limits.hub_radius, LIMIT_SLACK, LENGTH))
    if limits.size is not None:
        checks.append(
            at_most("size", mechanism.prime_radius or mechanism.base_radius or 0.0, limits.size, LIMIT_SLACK, LENGTH)
        )
    return checks


def pitch_radius(measured: Measured, roller_radius: float) -> float:
    """Least |radius of curvature| of the pitch curve: the roller's radius outside the profile."""
    return min(measured.convex_radius + roller_radius, measured.concave_radius - roller_radius)


def program_checks(problem: CamProblem, program: ProgramTable, lift: float) -> list[Check]:
    """The program's table against the statement, segment by segment."""
    angle, table = table_angles(program), np.array(program.s) * problem.displacement_unit
    v, a, j = (np.array(values) for values in (program.v, program.a, program.j))
    off, start = 0.0, 0.0
    for segment, (low, high) in zip(problem.segments, problem.heights(), strict=True):
        span = math.radians(segment.angle)
        inside = (angle >= start - 1e-12) & (angle <= start + span + 1e-12)
        at, s = np.clip(angle[inside] - start, 0.0, span), table[inside]
        if isinstance(segment, Dwell):
            known = dwell(span, low)
        elif isinstance(segment, Polynomial):
            conditions = [PolynomialCondition(*c) for c in problem.polynomial_conditions(segment)]
            known = polynomial_segment(span, conditions)
        elif isinstance(segment, Move) and segment.law in ("auto", "optimal"):
            start += span
            continue
        else:
            law = segment.law if isinstance(segment, Move) else "constant_velocity"
            known = law_segment(LAWS[law], span, low, high)
        if len(at):
            off = max(off, float(np.abs(known.pieces.motion(at).s - s).max()))
        start += span
    checks = [Check(name="keeps_the_statement", passed=off / lift <= STATED, value=off / lift, limit=STATED)]
    where = _open_angles(problem, angle)
    if where.any():
        for dimension, values in ((VELOCITY, v), (ACCELERATION, a), (JERK, j)):
            limit = getattr(problem.limits, dimension)
            if limit is not None:
                peak = float(np.abs(values[where]).max())
                checks.append(at_most(f"table_{dimension}", peak, limit, LIMIT_SLACK, dimension))
    return checks


def _open_angles(problem: CamProblem, angle: Real) -> NDArray[np.bool_]:
    """Angles within automatic and optimal segments."""
    where = np.zeros(len(angle), dtype=bool)
    start = 0.0
    for segment in problem.segments:
        end = start + math.radians(segment.angle)
        if isinstance(segment, Move) and segment.law in ("auto", "optimal"):
            where |= (angle > start + 1e-12) & (angle < end - 1e-12)
        start = end
    return where


def at_least(name: str, value: float, limit: float, slack: float, dimension: Dimension | None = None) -> Check:
    """A measured value that may not fall below a limit."""
    return Check(
        name=name, passed=value >= limit * (1.0 - slack), value=min(value, 1e9), limit=limit, dimension=dimension
    )


def at_most(name: str, value: float, limit: float, slack: float, dimension: Dimension | None = None) -> Check:
    """A measured value that may not exceed a limit."""
    return Check(name=name, passed=value <= limit * (1.0 + slack), value=value, limit=limit, dimension=dimension)
