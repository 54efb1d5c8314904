"""Ackermann's steering linkage: a symmetrical fourbar with the minimum of the maximum steering error.

The arms, of k pivot distances, lean by α from the vehicle's axis, towards each other if the tie rod is behind the
kingpins, away from each other if it is ahead. For a given arm the maximum error up to the lock has a single minimum
over α, at which errors of both signs are equally large; k is then optimized between its limits.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from scipy.optimize import minimize_scalar

from kinematics.arrays import Real
from kinematics.linkage.steering import compute_outer_angle
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar, remove_coupler_point

LEAN_ANGLES = np.radians(np.linspace(0.5, 80.0, 160))
"""Angles of the arms that are evaluated first, radians."""

COARSE_SAMPLE_COUNT, FINE_SAMPLE_COUNT = 65, 721
"""Number of inner wheel angles at which the error is evaluated: for many linkages at once, and for a single one."""

ARM_LENGTH_COUNT = 9
"""Number of lengths of the arms that are evaluated first."""

ANGLE_TOLERANCE, ARM_TOLERANCE = 1e-10, 1e-7
"""Tolerances of the best angle (radians) and length (pivot distances); the error is flat at its minimum."""

Side = Literal["behind", "ahead"]


def find_ackermann_linkages(problem: SteeringProblem) -> list[FourbarMechanism]:
    """Return the best linkages for each permitted side of the tie rod: of any arms, and of the shortest and longest."""
    ratio, lock = problem.pivot_distance / problem.wheelbase, math.radians(problem.lock)
    low, high = problem.arms
    found = []
    for side in problem.sides:
        lengths = np.linspace(low, high, ARM_LENGTH_COUNT) if high > low else np.array([low])
        errors = [find_best_lean(float(k), ratio, lock, side)[1] for k in lengths]
        # The grid brackets the minimum, which a bounded search then refines.
        n = int(np.argmin(errors))
        if not math.isfinite(errors[n]):
            continue
        best = float(lengths[n])
        if high > low:
            ends = float(lengths[max(n - 1, 0)]), float(lengths[min(n + 1, ARM_LENGTH_COUNT - 1)])
            closer = minimize_scalar(
                lambda k, side=side: find_best_lean(float(k), ratio, lock, side)[1],
                bounds=ends,
                method="bounded",
                options={"xatol": ARM_TOLERANCE},
            )
            best = float(closer.x) if closer.fun < errors[n] else best
        # The shortest and longest arms are offered too, for their size and their forces.
        for k in dict.fromkeys((best, low, high)):
            lean, error = find_best_lean(k, ratio, lock, side)
            if math.isfinite(error):
                found.append(_build_mechanism(problem, k, lean, side))
    return found


def find_best_lean(arm: float, ratio: float, lock: float, side: Side) -> tuple[float, float]:
    """Find the lean angle of the arms that minimizes the maximum error, and that error, radians.

    The error is infinite if the linkage does not reach the lock at any lean angle.
    """
    theta = np.linspace(0.0, lock, COARSE_SAMPLE_COUNT)[1:]
    worst = np.abs(_compute_errors(arm, LEAN_ANGLES[:, None], theta, ratio, side)).max(axis=1)
    worst = np.where(np.isfinite(worst), worst, np.inf)
    n = int(np.argmin(worst))
    if not math.isfinite(worst[n]):
        return math.nan, math.inf
    theta = np.linspace(0.0, lock, FINE_SAMPLE_COUNT)[1:]

    def compute_max_error(lean: float) -> float:
        found = float(np.abs(_compute_errors(arm, np.asarray(lean), theta, ratio, side)).max())
        # A finite penalty keeps the search going where the tie rod does not reach.
        return found if math.isfinite(found) else math.pi

    ends = float(LEAN_ANGLES[max(n - 1, 0)]), float(LEAN_ANGLES[min(n + 1, len(LEAN_ANGLES) - 1)])
    closer = minimize_scalar(compute_max_error, bounds=ends, method="bounded", options={"xatol": ANGLE_TOLERANCE})
    return float(closer.x), float(closer.fun)


def _compute_errors(arm: float, lean: Real, theta: Real, ratio: float, side: Side) -> Real:
    """Return steering errors at inner angles, radians; NaN where the tie rod does not reach."""
    sense = 1.0 if side == "behind" else -1.0
    left = arm * sense * (np.sin(lean) - 1j * np.cos(lean))
    right = -left.conjugate()
    # The tie rod follows from the straight position, where the linkage is symmetrical.
    rod = 1.0 - 2.0 * left.real
    reach = 1.0 - left * np.exp(1j * theta)
    f = np.abs(reach)
    # B lies on the circles about A and O4, on the same side as in the straight position.
    along = (f * f + rod * rod - arm * arm) / (2.0 * f)
    with np.errstate(invalid="ignore"):
        across = -sense * np.sqrt((rod - along) * (rod + along))
    turned = (reach / f * (along + 1j * across) - reach) / right
    return np.asarray(np.angle(turned) - compute_outer_angle(theta, ratio))


def _build_mechanism(problem: SteeringProblem, arm: float, lean: float, side: Side) -> FourbarMechanism:
    """Build the linkage in the straight position, its kingpins on the x-axis, the vehicle along y."""
    half, sense = 0.5 * problem.pivot_distance, 1.0 if side == "behind" else -1.0
    left = arm * problem.pivot_distance * sense * complex(math.sin(lean), -math.cos(lean))
    a, b = -half + left, half - left.conjugate()
    return remove_coupler_point(build_fourbar(FourbarConfiguration(complex(-half), a, b, complex(half), a)))
