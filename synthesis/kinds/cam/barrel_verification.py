"""The proof of a barrel cam: a roller is laid against both walls of the finished groove, and what it does is measured.

Displacement, velocity and pressure angle come from the points of the walls alone, at cam angles four times as close as
the design's; the cylinder is unrolled, as it is for the making of such cams.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.program import TURN
from kinematics.cam.unrolled import UnrolledWall
from kinematics.errors import DimensionError, ShapeError
from synthesis.kinds.cam.design import BarrelCamMechanism
from synthesis.kinds.cam.measured_rates import Measure, rate_checks
from synthesis.kinds.cam.mechanism import points_of, table_angles
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.verification import (
    FINER,
    LIMIT_SLACK,
    MEASURED_SLACK,
    REPRODUCED,
    REPRODUCED_WITH_JUMPS,
    at_least,
    at_most,
    between,
    finer,
    program_checks,
)
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import ANGLE, LENGTH

Real = NDArray[np.float64]


@dataclass(frozen=True)
class MeasuredBarrel:
    """What the finished groove does: greatest pressure angles (degrees), least radius of its pitch curve.

    ``off`` is the greatest deviation of either wall from the program, from each angle of the table to the next, as a
    share of the lift; NaN where the roller touches nothing.
    """

    rising: float
    falling: float
    least_radius: float
    off: Real


def verify_barrel(problem: CamProblem, mechanism: BarrelCamMechanism) -> tuple[Verification, MeasuredBarrel | None]:
    """Measure a barrel cam against its problem; None where the roller cannot be laid against a wall at all."""
    radius, roller = mechanism.cylinder_radius, mechanism.follower.roller_radius
    angle = table_angles(mechanism.program)
    close = finer(angle)
    try:
        walls = {
            name: UnrolledWall(points_of(curve), TURN * radius)
            for name, curve in (("lower", mechanism.lower_wall), ("upper", mechanism.upper_wall))
        }
        lower = walls["lower"].follow(radius * close, roller, 1)
        upper = walls["upper"].follow(radius * close, roller, -1)
    except (DimensionError, ShapeError):
        return Verification(passed=False, checks=[Check(name="follower_can_be_laid_on", passed=False)]), None
    table = np.array(mechanism.program.s)
    lift = float(np.ptp(table)) or 1.0
    program = between(angle, table, mechanism.program)
    allowed = REPRODUCED_WITH_JUMPS if problem.accept_discontinuity else REPRODUCED
    checks = program_checks(problem, mechanism.program, lift)
    off: Real = np.zeros(len(angle))
    sound = True
    for name, touch in (("lower", lower), ("upper", upper)):
        deviation = np.abs(touch.y - program).reshape(-1, FINER).max(axis=1) / lift
        touches = bool(np.isfinite(touch.y).all())
        gap = float(deviation.max()) if touches else math.inf
        wall = f"{name}_wall_reproduces_program"
        checks.append(Check(name=wall, passed=gap <= allowed, value=min(gap, 1e9), limit=allowed))
        off, sound = np.maximum(off, deviation), sound and touches
    cusped = any(wall.cusped for wall in walls.values())
    checks.append(Check(name="no_cusp", passed=not cusped))
    slope = np.stack([lower.tangent, upper.tangent])
    steep = np.degrees(np.abs(np.angle(slope))).max(axis=0)
    rising = np.repeat(np.array(mechanism.program.v), FINER) >= 0.0
    least = _pitch_radius(walls["lower"], walls["upper"], roller)
    measured = MeasuredBarrel(
        float(steep[rising].max()) if rising.any() else 0.0,
        float(steep[~rising].max()) if (~rising).any() else 0.0,
        least,
        off,
    )
    if sound:
        limits = problem.limits
        fall = limits.pressure_angle_fall or limits.pressure_angle
        checks += rate_checks(problem, _measure(walls["lower"], radius, roller), lift, allowed)
        checks.append(at_most("pressure_angle", measured.rising, limits.pressure_angle, MEASURED_SLACK, ANGLE))
        checks.append(at_most("pressure_angle_fall", measured.falling, fall, MEASURED_SLACK, ANGLE))
        checks.append(at_least("curvature_ratio", least / roller, limits.curvature_ratio, MEASURED_SLACK))
        if limits.hub_radius > 0.0:
            checks.append(at_least("hub_radius", radius, limits.hub_radius, LIMIT_SLACK, LENGTH))
        if limits.size is not None:
            checks.append(at_most("size", radius, limits.size, LIMIT_SLACK, LENGTH))
    return Verification.of(checks), measured


def _measure(wall: UnrolledWall, radius: float, roller: float) -> Measure:
    """s and v = R times the slope of the wall where the roller touches it."""

    def measure(angle: Real) -> tuple[Real, Real]:
        touch = wall.follow(radius * angle, roller, 1)
        return touch.y, radius * touch.tangent.imag / touch.tangent.real

    return measure


def _pitch_radius(lower: UnrolledWall, upper: UnrolledWall, roller: float) -> float:
    """Least radius of curvature of the pitch curve, which lies a roller's radius inside each wall."""
    found = [math.inf]
    for wall, side in ((lower, 1.0), (upper, -1.0)):
        for sign in (1.0, -1.0):
            bend = float((sign * wall.curvature).max())
            if bend > 0.0:
                found.append(1.0 / bend - side * sign * roller)
    return min(found)
