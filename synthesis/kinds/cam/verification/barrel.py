"""Verification of a barrel cam: lay a roller against both walls of the finished groove and measure its motion.

Displacement, velocity and pressure angle come from the points of the walls alone, at cam angles four times as close as
the design's. The cylinder is unrolled, as in the manufacture of such cams.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real
from kinematics.cam.finished.barrel_contact import UnrolledWall
from kinematics.cam.finished.extreme_values import WorstWallValues, find_worst_wall_values
from kinematics.cam.motion.program import TURN
from kinematics.errors import DimensionError, ShapeError
from synthesis.kinds.cam.design import BarrelCamMechanism
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.profile import find_stretches, read_points
from synthesis.kinds.cam.verification.rates import Measure, check_rates
from synthesis.kinds.cam.verification.reproduction import Reproduction
from synthesis.kinds.cam.verification.verify import NO_CONTACT_CHECK, check_roller, check_sizes, compute_curvature_slack
from synthesis.model.answer import Check, Verification


@dataclass(frozen=True)
class MeasuredBarrel:
    """Measurements on the finished groove: maximum pressure angles (degrees), minimum pitch curve radius, length.

    ``off`` is the maximum deviation of either wall from the program, from each angle of the table to the next, as a
    share of the lift; NaN if the roller touches no wall. ``unsettled`` is the dependence of the curvature on the point
    spacing, from each angle to the next, as a multiple of the permitted value. It covers the places where the curvature
    may have its maximum. ``unsteady`` is the same for the pressure angle.
    """

    rising: float
    falling: float
    least_radius: float
    length: float
    off: Real
    unsettled: Real
    unsteady: Real


def verify_barrel(problem: CamProblem, mechanism: BarrelCamMechanism) -> tuple[Verification, MeasuredBarrel | None]:
    """Measure a barrel cam against its problem; None if the roller cannot be laid against a wall at all."""
    radius, roller = mechanism.cylinder_radius, mechanism.follower.roller_radius
    demanded = Reproduction.from_program(problem, mechanism.program)
    try:
        at, stretches = np.radians(mechanism.program.angle), find_stretches(mechanism.program)
        lower, upper = (
            UnrolledWall(read_points(curve), TURN * radius, at, stretches.breaks)
            for curve in (mechanism.lower_wall, mechanism.upper_wall)
        )
        # Side 1 is the lower wall, which the roller touches from above; side −1 the upper wall.
        touches = lower.follow(radius * demanded.angle, roller, 1), upper.follow(radius * demanded.angle, roller, -1)
    except (DimensionError, ShapeError):
        return Verification.from_checks([NO_CONTACT_CHECK]), None
    off = [demanded.deviation(touch.y) for touch in touches]
    touched = [bool(np.isfinite(touch.y).all()) for touch in touches]
    checks = [
        *demanded.checks,
        demanded.check("lower_wall_reproduces_program", off[0], touched[0]),
        demanded.check("upper_wall_reproduces_program", off[1], touched[1]),
        Check(name="no_cusp", passed=not (lower.has_cusp or upper.has_cusp)),
    ]
    try:
        walls = (
            find_worst_wall_values(lower, roller, 1, stretches),
            find_worst_wall_values(upper, roller, -1, stretches),
        )
    except DimensionError:
        return Verification.from_checks([*checks, NO_CONTACT_CHECK]), None
    # The worse value of both walls counts.
    rising, falling = (math.degrees(max(getattr(wall, name) for wall in walls)) for name in ("rising", "falling"))
    unsettled, unsteady = (
        np.maximum(getattr(walls[0], name), getattr(walls[1], name)) for name in ("unsettled", "unsteady")
    )
    length = walls[1].highest - walls[0].lowest
    measured = MeasuredBarrel(
        rising, falling, _compute_pitch_radius(*walls, roller), length, np.maximum(*off), unsettled, unsteady
    )
    # A wall that the roller loses has no displacements to difference; its reproduction check has failed already.
    if all(touched):
        worst = float(measured.off.max())
        checks += check_rates(problem, _measure(lower, radius, roller), demanded.lift, demanded.tolerance, worst)
        slack = compute_curvature_slack(unsettled, max(wall.rounded for wall in walls))
        checks += check_roller(problem.limits, rising, falling, measured.least_radius / roller, slack)
        checks += check_sizes(problem.limits, radius, radius)
    return Verification.from_checks(checks), measured


def _measure(wall: UnrolledWall, radius: float, roller: float) -> Measure:
    """Return a function for s and v, where v is R times the slope of the wall at the contact with the roller."""

    def measure(angle: Real) -> tuple[Real, Real]:
        touch = wall.follow(radius * angle, roller, 1)
        return touch.y, radius * touch.tangent.imag / touch.tangent.real

    return measure


def _compute_pitch_radius(lower: WorstWallValues, upper: WorstWallValues, roller: float) -> float:
    """Return the minimum radius of curvature of the pitch curve, which runs one roller radius inside each wall."""
    # The offset by the roller radius shortens radii on the one side of a bend and lengthens them on the other.
    bends = (lower.up, -roller), (lower.down, roller), (upper.up, roller), (upper.down, -roller)
    return min((1.0 / bend + inside for bend, inside in bends if bend > 0.0), default=math.inf)
