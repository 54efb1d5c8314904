"""Thinning of the points of a curve within a chord tolerance: many in bends, few on straight pieces.

From an anchor point the curve is followed as long as one chord can represent it. That is the case as long as the curve
does not turn back and the direction to the next point stays in a wedge. The wedge contains the rays from the anchor
that pass every point so far within the tolerance. The result is the longest possible chord from the anchor, and the
time is proportional to the number of points (Zhao and Saalfeld, Linear-time sleeve-fitting polyline simplification
algorithms, AutoCarto 13, 1997, pp. 214–223). On a circle all chords except the last are equally long.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex

MAX_TRIES = 12
"""Maximum number of tolerances tried to reach a number of points; each is a pass over the curve."""

MIN_FILL_SHARE = 0.9
"""Minimum share of the permitted number of points at which the search for a smaller tolerance ends."""


def reduce_points(points: Complex, tolerance: float, kept: Sequence[bool] | NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return ascending indices of points whose chords represent all points; the first and the last are included.

    Parameters
    ----------
    points : complex, shape (n,)
        Points along the curve.
    tolerance : float
        Maximum distance of a point from its chord.
    kept : shape (n,)
        Points to keep in any case.
    """
    x, y = points.real.tolist(), points.imag.tolist()
    stays = np.asarray(kept, bool).tolist()
    last = len(x) - 1
    chosen = [0]
    anchor, k = 0, 1
    # The wedge is stored as vectors along its right and left sides, with the square of the maximum distance so far.
    opened = False
    right_x = right_y = left_x = left_y = reach = 0.0
    narrow = tolerance * tolerance
    while k <= last:
        dx, dy = x[k] - x[anchor], y[k] - y[anchor]
        square = dx * dx + dy * dy
        if opened and not (square >= reach and right_x * dy - right_y * dx >= 0.0 and dx * left_y - dy * left_x >= 0.0):
            # The chord to this point would pass an earlier one too far away: the previous point becomes the anchor.
            anchor = k - 1
            chosen.append(anchor)
            opened, reach = False, 0.0
            continue
        if square > narrow:
            # Tangents from the anchor to the circle around the point whose radius is the tolerance.
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


def limit_points(points: Complex, count: int, tolerance: float) -> NDArray[np.int64]:
    """Return indices of at most ``count`` points, including the first and the last, whose chords represent all points.

    ``tolerance`` is one that needs more points. If no tolerance gives nearly ``count`` points, as for a polygon, points
    are removed that form the smallest triangles with their neighbours (Visvalingam and Whyatt, The Cartographic Journal
    30 (1993), 46–51).
    """
    free = np.zeros(len(points), bool)
    low, high = tolerance, np.inf
    above = np.arange(len(points))
    # First guess: the deviation of a circle's chords decreases with the square of their number.
    tried = max(4.0 * tolerance, float(np.abs(points - points[0]).max()) / count**2)
    for _ in range(MAX_TRIES):
        # Points dropped at a smaller tolerance need not be considered again at a larger one.
        found = above[reduce_points(points[above], tried, free[above])]
        if MIN_FILL_SHARE * count <= len(found) <= count:
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
        # Remove several at a time if many must go, but no two neighbours.
        smallest = np.sort(np.argpartition(area, excess // 4)[: excess // 4 + 1])
        begins = np.append(True, np.diff(smallest) > 1)
        run = np.arange(len(smallest)) - np.maximum.accumulate(np.where(begins, np.arange(len(smallest)), 0))
        above = np.delete(above, 1 + smallest[run % 2 == 0])
    return above


def measure_deviation(points: Complex, chosen: NDArray[np.int64]) -> float:
    """Return the maximum distance of a point from its chord."""
    return 0.0 if len(chosen) == len(points) else float(_measure_distances(points, chosen).max())


def add_farthest(points: Complex, chosen: NDArray[np.int64]) -> NDArray[np.int64]:
    """Add the point that is farthest from its chord among those not chosen."""
    away = _measure_distances(points, chosen)
    away[chosen] = -1.0
    return np.sort(np.append(chosen, np.argmax(away)))


def _measure_distances(points: Complex, chosen: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the distance of each point from its chord."""
    owner = np.searchsorted(chosen, np.arange(len(points)), side="right").clip(1, len(chosen) - 1)
    start, end = points[chosen[owner - 1]], points[chosen[owner]]
    along, away = end - start, points - start
    size = np.abs(along) ** 2
    share = np.divide((away * along.conj()).real, size, out=np.zeros(len(points)), where=size > 0.0)
    return np.asarray(np.abs(away - np.clip(share, 0.0, 1.0) * along))
