"""Places of a traced curve and of the polyline through targets that are nearest to each other."""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS

X, Y = 3, 4
"""Columns of a target with its place; :mod:`synthesis.fit.linkage.residuals` has the others."""

MIN_LENGTH = 1e-9
"""Length, in task sizes, below which a direction is undefined."""

SWITCH_SHARE = 0.98
"""Share of a point's squared distance below which another step of the input becomes its nearest place; less than 1, so
that equally near places do not alternate."""


@njit(**OPTIONS)
def find_nearest_side(x: float, y: float, targets: Real, closed: bool) -> tuple[float, float, float, float]:
    """Return the vector from the nearest place of the polyline through targets to a point, and a direction across it.

    The direction is that vector's, or the normal of the side for a point on it.
    """
    n, least = len(targets), np.inf
    off_x, off_y, side_x, side_y = 0.0, 0.0, 0.0, 1.0
    for k in range(n if closed else n - 1):
        other = k + 1 if k + 1 < n else 0
        sx, sy = targets[other, X] - targets[k, X], targets[other, Y] - targets[k, Y]
        gx, gy = x - targets[k, X], y - targets[k, Y]
        square = sx * sx + sy * sy
        share = (gx * sx + gy * sy) / square if square > 0.0 else 0.0
        # Beyond an end of the side its corner is nearest.
        share = min(max(share, 0.0), 1.0)
        ex, ey = gx - share * sx, gy - share * sy
        far = ex * ex + ey * ey
        if far < least:
            least, off_x, off_y = far, ex, ey
            if square > 0.0:
                side_x, side_y = -sy / math.sqrt(square), sx / math.sqrt(square)
    far = math.sqrt(least)
    if far > MIN_LENGTH:
        side_x, side_y = off_x / far, off_y / far
    return off_x, off_y, side_x, side_y


@njit(**OPTIONS)
def find_nearest_step(target: Real, curve: Real, theta: float, low: float, per: float, near: float) -> float:
    """Return the input at the step of the curve that is nearest to a target, or θ if that is as near."""
    least = SWITCH_SHARE * near
    for k in range(len(curve)):
        square = (curve[k, 0] - target[X]) ** 2 + (curve[k, 1] - target[Y]) ** 2
        if square < least:
            least, theta = square, low + per * k
    return theta


@njit(**OPTIONS)
def measure_arcs(curve: Real, closed: bool, arcs: Real) -> None:
    """Write the share of the curve's length that each of its steps stands for."""
    n, total = len(curve), 0.0
    for k in range(n):
        before = k - 1 if k > 0 else (n - 1 if closed else 0)
        after = k + 1 if k + 1 < n else (0 if closed else n - 1)
        arcs[k] = math.hypot(curve[after, 0] - curve[before, 0], curve[after, 1] - curve[before, 1])
        total += arcs[k]
    for k in range(n):
        arcs[k] /= max(total, MIN_LENGTH)
