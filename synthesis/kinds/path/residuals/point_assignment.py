"""Assign samples of a curve to the required points in their order, by dynamic programming.

Among all monotone assignments of points to samples the one with the minimum sum of squared distances is built row by
row: the best assignment that reaches point k at sample j or earlier extends the best one of the points before it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers, Real
from kinematics.compiling import njit


@njit(cache=True, nogil=True)
def assign_samples(
    squares: Real,
    first: int,
    length: int,
    way: int,
    totals: Real,
    back: NDArray[np.int16],
    chosen: Integers,
    bound: float,
) -> float:
    """Assign to each point one of ``length`` samples from sample ``first`` on, in order, and return the minimum sum.

    ``way`` (±1) is the direction along the closed sequence of samples. ``squares`` (points, samples) are squared
    distances. ``chosen`` receives, for each point, the number of steps from the first sample; it never decreases.
    Returns infinity, and leaves ``chosen`` unset, as soon as the sum is known to exceed ``bound``.
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
            # totals[k] becomes the minimum for points 0..row with point ``row`` at sample k; back[row, k] remembers
            # the previous k.
            totals[k] = total
            least = min(least, total)
            back[row, k] = at
            j += way
            if j == count:
                j = 0
            elif j < 0:
                j = count - 1
        # Sums only grow from row to row, so that the search can stop here.
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
def fit_isotonic(values: Real, weights: Real, blocks: Integers) -> int:
    """Replace values in place by the nearest non-decreasing ones in weighted least squares (pool adjacent violators).

    ``blocks`` receives for each value the number of its block of equal values; returns the number of blocks.
    """
    n = values.size
    mean, load, begin = np.empty(n), np.empty(n), np.empty(n + 1, np.int64)
    count = 0
    for k in range(n):
        mean[count], load[count], begin[count] = values[k], weights[k], k
        count += 1
        # Merge a block with its predecessor while the order is violated; the weighted mean is optimal for both.
        while count > 1 and mean[count - 2] >= mean[count - 1]:
            total = load[count - 2] + load[count - 1]
            # The merged block may violate the order with its new predecessor, hence the loop.
            mean[count - 2] = (mean[count - 2] * load[count - 2] + mean[count - 1] * load[count - 1]) / total
            load[count - 2] = total
            count -= 1
    begin[count] = n
    for block in range(count):
        for k in range(begin[block], begin[block + 1]):
            values[k] = mean[block]
            blocks[k] = block
    return count
