"""Which point of a curve belongs to which demanded point, when the order is kept: dynamic programming over samples.

The least sum of squared distances over all ways to go along the samples without turning back is found row by row: the
best way to have met point k at sample j or before is the best of the ways before it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit

Real = NDArray[np.float64]
Whole = NDArray[np.int64]


@njit(cache=True, nogil=True)
def assign(
    squares: Real, first: int, length: int, way: int, totals: Real, back: NDArray[np.int16], chosen: Whole, bound: float
) -> float:
    """Samples for points from sample ``first`` on, ``length`` of them, going ``way`` (±1) round; the least sum.

    ``squares`` (points, samples) are squared distances. ``chosen`` gets steps from the first sample, which do not fall.
    Returns infinity, and chooses nothing, as soon as the sum is known to be above ``bound``.
    """
    n, count = squares.shape
    for row in range(n):
        best, at, least = np.inf, 0, np.inf
        here, j = squares[row], first
        for k in range(length):
            if row == 0:
                best = 0.0
            elif totals[k] < best:
                best, at = totals[k], k
            total = best + here[j]
            totals[k] = total
            least = min(least, total)
            back[row, k] = at
            j += way
            if j == count:
                j = 0
            elif j < 0:
                j = count - 1
        if least > bound:
            return np.inf
    k = int(np.argmin(totals[:length]))
    least = float(totals[k])
    for row in range(n - 1, -1, -1):
        chosen[row] = k
        if row:
            k = int(back[row, k])
    return least


@njit(cache=True, nogil=True)
def pool(values: Real, weights: Real, blocks: Whole) -> int:
    """Values that do not fall, nearest to the given ones in the weighed squares (pool adjacent violators), in place.

    ``blocks`` gets the number of the block that each belongs to; returns how many there are.
    """
    n = values.size
    mean, load, begin = np.empty(n), np.empty(n), np.empty(n + 1, np.int64)
    count = 0
    for k in range(n):
        mean[count], load[count], begin[count] = values[k], weights[k], k
        count += 1
        while count > 1 and mean[count - 2] >= mean[count - 1]:
            total = load[count - 2] + load[count - 1]
            mean[count - 2] = (mean[count - 2] * load[count - 2] + mean[count - 1] * load[count - 1]) / total
            load[count - 2] = total
            count -= 1
    begin[count] = n
    for block in range(count):
        for k in range(begin[block], begin[block + 1]):
            values[k] = mean[block]
            blocks[k] = block
    return count
