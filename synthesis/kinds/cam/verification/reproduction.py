"""Comparison of a finished cam with the motion program: the table with the request, and the follower with the table.

For any cam, the follower is measured at cam angles four times as close as the table's, and compared there with the
quintic through s, v, a of the table's neighbouring angles. The deviations are shares of the lift.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import TURN
from kinematics.cam.motion.segments import Condition, build_dwell, build_law_segment, build_polynomial_segment
from synthesis.kinds.cam.design import ProgramTable
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.profile import read_table_angles
from synthesis.kinds.cam.statement.segments import Dwell, Move, Polynomial
from synthesis.model.answer import Check
from synthesis.model.dimension import ACCELERATION, JERK, VELOCITY
from synthesis.verification.checks import check_error, check_maximum

REFINEMENT_FACTOR = 4
"""Number of cam angles of the verification for each cam angle of the design."""

DISPLACEMENT_TOLERANCE = 1e-6
"""Permitted deviation of the measured displacement from the program, as a share of the lift: 1 µm for 1 m of lift."""

DISPLACEMENT_TOLERANCE_WITH_JUMPS = 1e-4
"""The same tolerance if the client accepts jumps in velocity or acceleration, which no curve through points follows."""

PROGRAM_TOLERANCE = 1e-7
"""Permitted deviation of the program from the request, as a share of the lift."""

TABLE_SLACK = 1e-6
"""Relative slack of limits on values from the program's table or on dimensions, which keep them exactly."""

ANGLE_TOLERANCE = 1e-12
"""Angle in radians within which an angle of the table is a joint of two segments."""

MAX_REPORTED = 1e9
"""Value reported instead of an unbounded one, which JSON cannot represent."""


def limit_reported(value: float) -> float:
    """Limit a measured value to one that a check can report."""
    return min(value, MAX_REPORTED)


@dataclass(frozen=True)
class Reproduction:
    """Target motion of a follower at the verification's cam angles.

    Attributes
    ----------
    angle : float64, shape (4 n,)
        Cam angles, radians; n is the length of the program's table.
    displacement : float64, shape (4 n,)
        The program there, in radians for an arm.
    lift : float
        The program's travel, by which deviations are divided.
    tolerance : float
        Deviation that passes, as a share of the lift.
    checks : list of Check
        The program's table against the request.
    """

    angle: Real
    displacement: Real
    lift: float
    tolerance: float
    checks: list[Check]

    @classmethod
    def from_program(cls, problem: CamProblem, program: ProgramTable) -> Reproduction:
        """Build the target from the program's table of a finished cam."""
        angle, displacement = read_table_angles(program), np.array(program.s) * problem.displacement_unit
        # A program that never moves is compared absolutely.
        lift = float(np.ptp(displacement)) or 1.0
        return cls(
            _subdivide_angles(angle),
            _interpolate_quintic(angle, displacement, program),
            lift,
            DISPLACEMENT_TOLERANCE_WITH_JUMPS if problem.accept_discontinuity else DISPLACEMENT_TOLERANCE,
            check_program(problem, program, lift),
        )

    def deviation(self, measured: Real) -> Real:
        """Return the maximum deviation of a measured displacement between table angles, as a share of the lift.

        Shape (n,), from each angle of the table to the next; NaN if the follower touches nothing.
        """
        return np.asarray(np.abs(measured - self.displacement).reshape(-1, REFINEMENT_FACTOR).max(axis=1) / self.lift)

    def check(self, name: str, deviation: Real, touches: bool) -> Check:
        """Check that the program is reproduced; it is not if the follower touches nothing."""
        worst = float(deviation.max()) if touches else math.inf
        return check_error(name, limit_reported(worst), self.tolerance)


def _subdivide_angles(angle: Real) -> Real:
    """Divide each interval of a closed series of angles into equal parts."""
    step = np.diff(np.append(angle, TURN + angle[0]))
    return np.asarray(
        (angle[:, None] + step[:, None] * (np.arange(REFINEMENT_FACTOR) / REFINEMENT_FACTOR)).reshape(-1), np.float64
    )


def _interpolate_quintic(angle: Real, s: Real, program: ProgramTable) -> Real:
    """Interpolate the displacement at the finer angles by the quintic through s, v, a at both ends of each interval.

    The profile's points are the contacts at the table's angles, so that the profile can only deviate between them.
    """
    step = np.diff(np.append(angle, TURN + angle[0]))[:, None]
    begin = s[:, None], step * np.array(program.v)[:, None], step**2 * np.array(program.a)[:, None]
    end = tuple(np.roll(values, -1, axis=0) for values in (s, np.array(program.v), np.array(program.a)))
    rest = end[0][:, None] - begin[0] - begin[1] - 0.5 * begin[2]
    rest1 = step * end[1][:, None] - begin[1] - begin[2]
    rest2 = step**2 * end[2][:, None] - begin[2]
    u = np.arange(REFINEMENT_FACTOR) / REFINEMENT_FACTOR
    # Coefficients of u³, u⁴, u⁵ of the Hermite quintic, from the remainders after the start's Taylor terms.
    third = 10.0 * rest - 4.0 * rest1 + 0.5 * rest2
    fourth = -15.0 * rest + 7.0 * rest1 - rest2
    fifth = 6.0 * rest - 3.0 * rest1 + 0.5 * rest2
    quintic = begin[0] + u * (begin[1] + u * (0.5 * begin[2] + u * (third + u * (fourth + u * fifth))))
    return np.asarray(quintic.reshape(-1), np.float64)


def check_program(problem: CamProblem, program: ProgramTable, lift: float) -> list[Check]:
    """Check the program's table against the request, segment by segment."""
    angle, table = read_table_angles(program), np.array(program.s) * problem.displacement_unit
    worst, start = 0.0, 0.0
    # Limits on the motion apply to automatic and optimal segments only: the others follow the client's laws.
    limited = np.zeros(len(angle), dtype=bool)
    stated = zip(problem.segments, problem.program.list_laws(), problem.program.heights(), strict=True)
    for segment, law, (low, high) in stated:
        span = math.radians(segment.angle)
        end = start + span
        inside = (angle >= start - ANGLE_TOLERANCE) & (angle <= end + ANGLE_TOLERANCE)
        at, s = np.clip(angle[inside] - start, 0.0, span), table[inside]
        if isinstance(segment, Move) and segment.follows_criterion:
            limited |= (angle > start + ANGLE_TOLERANCE) & (angle < end - ANGLE_TOLERANCE)
            start = end
            continue
        if isinstance(segment, Dwell):
            exact = build_dwell(span, low)
        elif isinstance(segment, Polynomial):
            exact = build_polynomial_segment(span, [Condition(*c) for c in problem.program.convert_conditions(segment)])
        else:
            exact = build_law_segment(LAWS[law], span, low, high)
        if len(at):
            worst = max(worst, float(np.abs(exact.pieces.motion(at).s - s).max()))
        start = end
    checks = [check_error("keeps_the_statement", worst / lift, PROGRAM_TOLERANCE)]
    for dimension, values in ((VELOCITY, program.v), (ACCELERATION, program.a), (JERK, program.j)):
        limit = getattr(problem.limits, dimension)
        if limit is not None and limited.any():
            peak = float(np.abs(np.array(values)[limited]).max())
            checks.append(check_maximum(f"table_{dimension}", peak, limit, dimension, TABLE_SLACK))
    return checks
