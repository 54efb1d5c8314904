"""Fewer points for a curve, within a chord tolerance: many where it bends, few where it is straight.

From a point on, the curve is followed as long as one chord stands for it: as long as it does not turn back, and the
direction to the next point lies within the wedge in which every point passed so far is no farther than the tolerance
from the ray. That is the longest chord that begins there, and the time is proportional to the number of points (Zhao
and Saalfeld, Linear-time sleeve-fitting polyline simplification algorithms, AutoCarto 13, 1997, pp. 214–223). On a
circle all chords but the last are equally long.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex

MOST_TRIES = 12
"""Tolerances that are tried for a number of points; each is a pass over the curve."""

NEAR_ENOUGH = 0.9
"""A curve that has this share of the points that it may have is not tried with more."""


def thinned(points: Complex, tolerance: float, kept: Sequence[bool] | NDArray[np.bool_]) -> NDArray[np.int64]:
    """The numbers of points whose chords stand for all, ascending, the first and the last among them.

    Parameters
    ----------
    points : complex, shape (n,)
        Along the curve.
    tolerance : float
        Greatest distance of a point from the chord that passes it.
    kept : shape (n,)
        Points that stay whatever the tolerance.
    """
    x, y = points.real.tolist(), points.imag.tolist()
    stays = np.asarray(kept, bool).tolist()
    last = len(x) - 1
    chosen = [0]
    anchor, k = 0, 1
    # The wedge from its right to its left side, as vectors, and the square of the distance that was reached.
    opened = False
    right_x = right_y = left_x = left_y = reach = 0.0
    narrow = tolerance * tolerance
    while k <= last:
        dx, dy = x[k] - x[anchor], y[k] - y[anchor]
        square = dx * dx + dy * dy
        if opened and not (square >= reach and right_x * dy - right_y * dx >= 0.0 and dx * left_y - dy * left_x >= 0.0):
            # The point before was the last that one chord reaches.
            anchor = k - 1
            chosen.append(anchor)
            opened, reach = False, 0.0
            continue
        if square > narrow:
            # The tangents to the circle about the point, as wide as the tolerance.
            along = math.sqrt(square - narrow)
            from_x, from_y = dx * along + dy * tolerance, dy * along - dx * tolerance
            to_x, to_y = dx * along - dy * tolerance, dy * along + dx * tolerance
            if not opened or right_x * from_y - right_y * from_x > 0.0:
                right_x, right_y = from_x, from_y
            if not opened or to_x * left_y - to_y * left_x > 0.0:
                left_x, left_y = to_x, to_y
            opened, reach = True, square
        if stays[k] or k == last:
            anchor = k
            chosen.append(k)
            opened, reach = False, 0.0
        k += 1
    return np.array(chosen)


def at_most(points: Complex, count: int, tolerance: float) -> NDArray[np.int64]:
    """The numbers of ``count`` points at most, the first and the last among them, whose chords stand for all.

    ``tolerance`` is one that takes more points. Where no tolerance takes nearly as many as there may be, as of a
    polygon, those go one by one that make the smallest triangles with their neighbours (Visvalingam and Whyatt, The
    Cartographic Journal 30 (1993), 46–51).
    """
    free = np.zeros(len(points), bool)
    low, high = tolerance, np.inf
    above = np.arange(len(points))
    # Of a circle it takes the square of π over the number of its chords.
    tried = max(4.0 * tolerance, float(np.abs(points - points[0]).max()) / count**2)
    for _ in range(MOST_TRIES):
        # What a smaller tolerance has left out is nearer than that.
        found = above[thinned(points[above], tried, free[above])]
        if NEAR_ENOUGH * count <= len(found) <= count:
            return found
        if len(found) < count:
            high = tried
        else:
            low, above = tried, found
        tried = 4.0 * tried if np.isinf(high) else math.sqrt(low * high) if low > 0.0 else 0.25 * high
    while (excess := len(above) - count) > 0:
        at = points[above]
        one, other = at[1:-1] - at[:-2], at[2:] - at[1:-1]
        area = np.abs((one.conj() * other).imag)
        # Some at once where many must go, but no two neighbours.
        smallest = np.sort(np.argpartition(area, excess // 4)[: excess // 4 + 1])
        begins = np.append(True, np.diff(smallest) > 1)
        run = np.arange(len(smallest)) - np.maximum.accumulate(np.where(begins, np.arange(len(smallest)), 0))
        above = np.delete(above, 1 + smallest[run % 2 == 0])
    return above


def astray(points: Complex, chosen: NDArray[np.int64]) -> float:
    """The greatest distance of a point from the chord that passes it."""
    return 0.0 if len(chosen) == len(points) else float(_away(points, chosen).max())


def with_farthest(points: Complex, chosen: NDArray[np.int64]) -> NDArray[np.int64]:
    """One point more: of those that are not among them, the one that is farthest from its chord."""
    away = _away(points, chosen)
    away[chosen] = -1.0
    return np.sort(np.append(chosen, np.argmax(away)))


def _away(points: Complex, chosen: NDArray[np.int64]) -> NDArray[np.float64]:
    """The distance of each point from the chord that passes it."""
    owner = np.searchsorted(chosen, np.arange(len(points)), side="right").clip(1, len(chosen) - 1)
    start, end = points[chosen[owner - 1]], points[chosen[owner]]
    along, away = end - start, points - start
    size = np.abs(along) ** 2
    share = np.divide((away * along.conj()).real, size, out=np.zeros(len(points)), where=size > 0.0)
    return np.asarray(np.abs(away - np.clip(share, 0.0, 1.0) * along))
