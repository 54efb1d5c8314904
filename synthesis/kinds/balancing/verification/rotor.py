"""Verification of a balanced rotor: its masses are rotated as points in space, and the bearing forces are computed.

None of the solver's formulas is used. Every unbalance and every correction of the answer is a point mass on a
circle. At positions over a turn, the forces at both bearings are solved from Newton's and Euler's equations of the
whole rotor, and are compared with those before the correction.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from synthesis.kinds.balancing.design import (
    BearingForces,
    PlaneBalance,
    RotorCorrection,
    RotorDesign,
    RotorMechanism,
    RotorMetrics,
    RotorUnbalance,
)
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.rotor.solver import Balancing, Rotor, compute_coefficients, get_length_scale
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import GRADE
from synthesis.model.dynamics.request import METRES_PER_UNIT
from synthesis.model.linkage.input_motion import RAD_PER_S
from synthesis.verification.checks import check_error, check_maximum

POSITION_COUNT = 72
"""Number of positions over a turn at which the forces are solved."""

BALANCE_TOLERANCE = 1e-10
"""Remaining force, as a share of the summed forces of the single unbalances, that is attributed to rounding."""

VIBRATION_TOLERANCE = 1e-9
"""Share of the readings up to which predicted ones count as zero."""

GRAM_MILLIMETRES = 1e6
"""g·mm in a kg·m."""


class RotatingForces(NamedTuple):
    """Maxima over a turn of the total force, of its moment about the first plane, and of the bearing forces."""

    force: float
    moment: float
    supports: list[float]


class Points(NamedTuple):
    """Point masses on circles: mass times radius, angle (radians) and position along the axis."""

    moments: Real
    angles: Real
    z: Real


def verify_rotor(problem: BalancingProblem, rotor: Rotor, found: Balancing) -> RotorDesign:
    """Measure a rotor with its corrections."""
    planes, unit = problem.used_planes, get_length_scale(problem)
    written = GRAM_MILLIMETRES * unit if problem.units == "si" else 1.0
    mechanism = _build_mechanism(problem, rotor, found, written)
    before, after = _list_points(mechanism, written, corrected=False), _list_points(mechanism, written, corrected=True)
    added = [0j] * len(planes)
    for weight in found.weights:
        added[weight.plane] += weight.moment
    left = [abs(complex(needed) - moment) for needed, moment in zip(found.needed, added, strict=True)]
    checks = _check_residuals(problem, before, after, left)
    grades = _compute_grades(problem, before, after)
    if problem.max_grade is not None and grades is not None:
        checks.append(check_maximum("grade", grades[1], problem.max_grade, GRADE))
    vibration = None
    if problem.influence is not None:
        initial = np.array([reading.vector for reading in problem.influence.initial])
        vibration = np.abs(initial + compute_coefficients(problem) @ np.array(added))
        if _is_continuous(problem) and len(vibration) == len(planes):
            largest = float(np.abs(initial).max())
            checks.append(
                check_error("vibration", _compute_share(float(vibration.max()), largest), VIBRATION_TOLERANCE)
            )
    speed = None if problem.rpm is None else problem.rpm * RAD_PER_S
    supports, turning = problem.supports, 1.0 if speed is None else speed
    at_first, at_last = (_rotate_points(points, planes[0], supports, unit, turning) for points in (before, after))
    metrics = RotorMetrics(
        residual_unbalance=written * sum(left),
        bound=written * sum(found.bounds),
        optimal=found.proved,
        places=len(found.weights),
        initial_unbalance=written * abs(complex(rotor.moments.sum())),
        residual_couple=at_last.moment if speed is not None and len(planes) == 1 else None,
        initial_grade=None if grades is None else grades[0],
        grade=None if grades is None else grades[1],
        shaking_force=None if speed is None else at_first.force,
        shaking_moment=None if speed is None else at_first.moment,
        residual_vibration=None if vibration is None else vibration.tolist(),
        planes=[
            PlaneBalance(
                z=planes[plane],
                needed=written * abs(complex(needed)),
                needed_angle=math.degrees(float(np.angle(needed))),
                residual=written * left[plane],
                bound=written * found.bounds[plane],
                places=sum(weight.plane == plane for weight in found.weights),
            )
            for plane, needed in enumerate(found.needed)
        ],
        bearings=None
        if speed is None or supports is None
        else [
            BearingForces(z=z, before=first, after=last)
            for z, first, last in zip(supports, at_first.supports, at_last.supports, strict=True)
        ],
    )
    return RotorDesign(mechanism=mechanism, verification=Verification.from_checks(checks), metrics=metrics)


def _build_mechanism(problem: BalancingProblem, rotor: Rotor, found: Balancing, written: float) -> RotorMechanism:
    """Build the rotor of the answer."""
    planes, supports = problem.used_planes, problem.supports
    return RotorMechanism(
        unbalances=[
            RotorUnbalance(unbalance=written * abs(moment), angle=math.degrees(float(np.angle(moment))), z=z)
            for moment, z in zip(rotor.moments.tolist(), rotor.z.tolist(), strict=True)
        ],
        corrections=[
            RotorCorrection(
                plane=weight.plane,
                z=planes[weight.plane],
                angle=weight.angle,
                unbalance=written * abs(weight.moment),
                mass=weight.mass,
                radius=weight.radius,
                removed=weight.removed,
            )
            for weight in found.weights
        ],
        planes=planes,
        bearings=None if supports is None else (supports[0], supports[1]),
    )


def _list_points(mechanism: RotorMechanism, written: float, *, corrected: bool) -> Points:
    """List the point masses of the answer's rotor, mass times length unit."""
    rows = [(entry.unbalance, entry.angle, entry.z) for entry in mechanism.unbalances]
    if corrected:
        # Removed material acts against its direction.
        signs = [-1.0 if entry.removed else 1.0 for entry in mechanism.corrections]
        added = zip(signs, mechanism.corrections, strict=True)
        rows += [(sign * entry.unbalance, entry.angle, entry.z) for sign, entry in added]
    moments, angles, z = np.array(rows, np.float64).T
    return Points(moments / written, np.radians(angles), z)


def _rotate_points(
    points: Points, about: float, supports: list[float] | None, unit: float, speed: float
) -> RotatingForces:
    """Rotate the rotor over a turn, and compute the forces that its points' accelerations require at the bearings."""
    turn = 2.0 * np.pi * np.arange(POSITION_COUNT) / POSITION_COUNT
    angles = points.angles + turn[:, None]
    pull = unit * speed**2 * points.moments
    forces = np.stack([pull * np.cos(angles), pull * np.sin(angles)], axis=-1)  # (positions, points, 2)
    whole = forces.sum(axis=1)
    moment = ((points.z - about)[:, None] * forces).sum(axis=1)
    held: list[float] = []
    if supports is not None:
        # Force and moment equilibrium determine the forces of both bearings.
        levers = np.array([[1.0, 1.0], [supports[0] - about, supports[1] - about]])
        carried = np.linalg.solve(levers, np.stack([whole, moment], axis=1))
        held = np.hypot(carried[..., 0], carried[..., 1]).max(axis=0).tolist()
    return RotatingForces(
        float(np.hypot(whole[:, 0], whole[:, 1]).max()), unit * float(np.hypot(moment[:, 0], moment[:, 1]).max()), held
    )


def _check_residuals(problem: BalancingProblem, before: Points, after: Points, left: list[float]) -> list[Check]:
    """Check the residuals in the planes; single masses must leave no residual and no force on the bearings."""
    planes = problem.used_planes
    measured = _rotate_points(after, planes[0], planes if len(planes) == 2 else None, 1.0, 1.0)
    # A single plane can only balance the force.
    found = measured.supports or [measured.force]
    parts = _sum_magnitudes(before, planes)
    # Compare the residuals measured on the rotating rotor with the reported ones.
    off = max(abs(one - other) for one, other in zip(found, left, strict=True))
    checks = [check_error("residual", _compute_share(off, parts), BALANCE_TOLERANCE)]
    if _is_continuous(problem) and len(planes) == 2 and problem.supports is not None:
        forces = _rotate_points(after, planes[0], problem.supports, 1.0, 1.0).supports
        checks.append(
            check_error(
                "bearing_forces",
                _compute_share(max(forces), _sum_magnitudes(after, problem.supports)),
                BALANCE_TOLERANCE,
            )
        )
    return checks


def _sum_magnitudes(points: Points, supports: list[float]) -> float:
    """Sum the magnitudes of the bearing forces of the single points: the scale of rounding of their vector sum."""
    if len(supports) == 1:
        return float(np.abs(points.moments).sum())
    near, far = supports
    # The lever rule gives the shares of both bearings.
    shares = np.abs((points.z - near) / (far - near)) + np.abs((points.z - far) / (far - near))
    return float((np.abs(points.moments) * shares).sum())


def _compute_grades(problem: BalancingProblem, *rotors: Points) -> list[float] | None:
    """Compute the balance grades e ω of rotors, mm/s; None without mass and speed.

    If the bearings are known, the unbalance is the sum of those in the bearings' planes (the tolerance planes of
    ISO 21940-11), so that a couple left by a single plane of correction counts, too.
    """
    if problem.rotor_mass is None or problem.rpm is None:
        return None
    # e ω = U ω/m, in mm/s.
    rate = METRES_PER_UNIT[problem.length_unit] * 1e3 * problem.rpm * RAD_PER_S / problem.rotor_mass
    turned = [_rotate_points(points, problem.planes[0], problem.supports, 1.0, 1.0) for points in rotors]
    return [rate * (sum(one.supports) if one.supports else one.force) for one in turned]


def _is_continuous(problem: BalancingProblem) -> bool:
    """Return whether each plane has one mass of exactly the required size and angle."""
    return problem.correction is None or problem.correction.place_choice is None


def _compute_share(part: float, whole: float) -> float:
    return part / whole if whole > 0.0 else 0.0
