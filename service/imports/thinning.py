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

from service.outlines.curves import Complex

MOST_TRIES = 16
"""Tolerances that are tried for a number of points; each is a pass over the curve."""

SMALLEST = 1e-9
"""Share of the extent that is tried first where no tolerance is known."""

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
    low = high = middle = reach = 0.0
    opened = False
    while k <= last:
        dx, dy = x[k] - x[anchor], y[k] - y[anchor]
        distance = math.hypot(dx, dy)
        fits = True
        if opened:
            # The direction, measured from the first one that the wedge had.
            turn = math.remainder(math.atan2(dy, dx) - middle, math.tau)
            fits = low <= turn <= high and distance >= reach
        if not fits:
            # The point before was the last that one chord reaches.
            anchor = k - 1
            chosen.append(anchor)
            opened, reach = False, 0.0
            continue
        if distance > tolerance:
            half = math.asin(tolerance / distance)
            if opened:
                low, high = max(low, turn - half), min(high, turn + half)
            else:
                opened, middle, low, high = True, math.atan2(dy, dx), -half, half
            reach = max(reach, distance)
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
    tried = 4.0 * max(tolerance, SMALLEST * float(np.abs(points - points[0]).max()))
    for _ in range(MOST_TRIES):
        found = thinned(points, tried, free)
        if NEAR_ENOUGH * count <= len(found) <= count:
            return found
        if len(found) < count:
            high = tried
        else:
            low, above = tried, found
        tried = 4.0 * tried if np.isinf(high) else math.sqrt(low * high) if low > 0.0 else 0.25 * high
    while len(above) > count:
        at = points[above]
        one, other = at[1:-1] - at[:-2], at[2:] - at[1:-1]
        area = np.full(len(at), np.inf)
        area[1:-1] = np.abs((one.conj() * other).imag)
        # Of two neighbours one goes at a time, of equal ones the first.
        least = (area[1:-1] < area[:-2]) & (area[1:-1] <= area[2:])
        gone = 1 + np.flatnonzero(least)
        gone = gone[np.argsort(area[gone], kind="stable")[: len(above) - count]]
        above = np.delete(above, gone)
    return above


def astray(points: Complex, chosen: NDArray[np.int64]) -> float:
    """The greatest distance of a point from the chord that passes it."""
    if len(chosen) == len(points):
        return 0.0
    owner = np.searchsorted(chosen, np.arange(len(points)), side="right").clip(1, len(chosen) - 1)
    start, end = points[chosen[owner - 1]], points[chosen[owner]]
    along, away = end - start, points - start
    size = np.abs(along) ** 2
    share = np.divide((away * along.conj()).real, size, out=np.zeros(len(points)), where=size > 0.0)
    return float(np.abs(away - np.clip(share, 0.0, 1.0) * along).max())
