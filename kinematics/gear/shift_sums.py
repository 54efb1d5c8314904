"""Which sums of profile shifts a pair of external gears can have, compiled; all lengths in modules.

Whether a sum suits is decided by its best split (:mod:`kinematics.gear.splits`). Over a range of sums the margin of the
best split may rise and fall more than once: the sums that suit are a list of intervals. They are found on a grid, about
every local maximum and minimum of it, and by bisection of every change.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from kinematics.gear.shifting import (
    GOLDEN,
    KEPT,
    SECTIONS,
    TOLD,
    Demands,
    Rack,
    Working,
    at_distance,
    best_split,
    nearby,
    rack_of,
    with_sum,
)
from kinematics.gear.splits import greatest_margin, sound_split

NARROW = 1e-6
"""Sums of shifts nearer to one another than this are not told apart in search of a greatest or least margin."""

SUMS = 32
"""Parts into which a range of sums is divided in search of those that suit."""

NEWTON = 1e-8
"""Share to which tan φ_w is told where margins beyond some 1e-12 modules decide: its error is about the square."""

HALVINGS = 28
"""Halvings of an interval of sums at whose one end no split suits: 1e-9 modules of it remain."""


@njit(cache=True, nogil=True)
def suits(teeth: int, mate: int, working: Working, demands: Demands) -> bool:
    """Whether a split of the sum keeps all demands."""
    split = sound_split(teeth, mate, working, demands, rack_of(demands), math.nan)
    if math.isinf(split):
        return best_split(teeth, mate, working, demands, -KEPT)[1] >= -KEPT
    return not math.isnan(split)


@njit(cache=True, nogil=True)
def _split_of_sum(
    teeth: int, mate: int, total: float, demands: Demands, rack: Rack, start: float, guess: float
) -> tuple[float, float]:
    """A split of a sum that keeps all demands, nan where there is none, and tan φ_w; both have a first value."""
    working, tangent = nearby(teeth, mate, total, rack, start, NEWTON)
    if not working.distance > 0.0:
        return math.nan, tangent
    split = sound_split(teeth, mate, working, demands, rack, guess)
    if math.isinf(split):
        split, most = best_split(teeth, mate, with_sum(teeth, mate, total, demands), demands, -KEPT)
        if not most >= -KEPT:
            split = math.nan
    return split, tangent


@njit(cache=True, nogil=True)
def _sum_suits(teeth: int, mate: int, total: float, demands: Demands) -> bool:
    return not math.isnan(_split_of_sum(teeth, mate, total, demands, rack_of(demands), 0.0, math.nan)[0])


@njit(cache=True, nogil=True)
def _of_sum(teeth: int, mate: int, total: float, demands: Demands, enough: float) -> float:
    """The greatest margin of a sum, as golden sections tell it."""
    working = with_sum(teeth, mate, total, demands)
    if not working.distance > 0.0:
        return -math.inf
    return best_split(teeth, mate, working, demands, enough)[1]


@njit(cache=True, nogil=True)
def _peak(teeth: int, mate: int, left: float, right: float, sign: float, demands: Demands) -> float:
    """The sum between two with the greatest ``sign`` × margin, as soon as that tells it from its neighbours."""
    # A maximum is looked for among sums that do not suit, until one does; a minimum until one does not.
    one, other = right - GOLDEN * (right - left), left + GOLDEN * (right - left)
    first = sign * _of_sum(teeth, mate, one, demands, math.inf)
    second = sign * _of_sum(teeth, mate, other, demands, math.inf)
    for _ in range(SECTIONS):
        most = max(first, second)
        if (most >= -KEPT if sign > 0.0 else most > KEPT) or right - left < NARROW:
            break
        if first < second:
            left, one, first = one, other, second
            other = left + GOLDEN * (right - left)
            second = sign * _of_sum(teeth, mate, other, demands, math.inf)
        else:
            right, other, second = other, one, first
            one = right - GOLDEN * (right - left)
            first = sign * _of_sum(teeth, mate, one, demands, math.inf)
    return one if first > second else other


@njit(cache=True, nogil=True)
def _grid(low: float, high: float) -> NDArray[np.float64]:
    """Sums from ``low`` to ``high`` in rising order, that nearest to no shift among them."""
    sums = np.empty(SUMS + 2)
    for i in range(SUMS + 1):
        sums[i] = low + (high - low) * i / SUMS
    sums[SUMS] = high
    sums[SUMS + 1] = min(max(0.0, low), high)
    return np.sort(sums)


@njit(cache=True, nogil=True)
def _margins(teeth: int, mate: int, sums: NDArray[np.float64], demands: Demands) -> NDArray[np.float64]:
    """Between what limits the greatest margin of every sum lies, its sign as golden sections tell it."""
    margins = np.full((len(sums), 2), -math.inf)
    rack, guess, tangent = rack_of(demands), math.nan, 0.0
    for i, total in enumerate(sums):
        working, tangent = nearby(teeth, mate, total, rack, tangent, NEWTON)
        if not working.distance > 0.0:
            continue
        found = greatest_margin(teeth, mate, working, demands, rack, guess + 0.5 * (total - sums[max(0, i - 1)]))
        guess = found.split
        margins[i, 0], margins[i, 1] = found.least, found.most
        if math.isinf(guess):
            golden = _of_sum(teeth, mate, total, demands, math.inf)
            margins[i, 0], margins[i, 1], guess = golden, golden + TOLD, math.nan
    return margins


@njit(cache=True, nogil=True)
def _is_extreme(
    teeth: int, mate: int, i: int, sums: NDArray[np.float64], margins: NDArray[np.float64], demands: Demands
) -> bool:
    """Whether a sum that does not suit has no less margin than its neighbours, or one that suits no more."""
    before, after = max(0, i - 1), min(len(sums) - 1, i + 1)
    sign = -1.0 if margins[i, 0] >= -KEPT else 1.0
    # Golden sections miss the greatest margin by less than they have to tell: where that could decide, they do.
    own = (
        min(sign * (margins[i, 0] - TOLD), sign * margins[i, 1]),
        max(sign * (margins[i, 0] - TOLD), sign * margins[i, 1]),
    )
    beaten, beats = False, True
    for k in (before, after):
        if k != i:
            ends = sign * (margins[k, 0] - TOLD), sign * margins[k, 1]
            beaten |= own[1] < min(ends)
            beats &= own[0] >= max(ends)
    if beaten or beats:
        return beats and not beaten
    golden = [sign * _of_sum(teeth, mate, sums[k], demands, math.inf) for k in (before, i, after)]
    return not golden[1] < max(golden[0], golden[2])


@njit(cache=True, nogil=True)
def _looked_at(teeth: int, mate: int, low: float, high: float, demands: Demands) -> NDArray[np.float64]:
    """Sums in rising order, between which the margin passes its limit once at most; rows of a sum and its margin."""
    sums = _grid(low, high)
    n = len(sums)
    margins = _margins(teeth, mate, sums, demands)
    seen = np.empty((2 * n, 2))
    seen[:n, 0], seen[:n, 1] = sums, margins[:, 0]
    count = n
    for i in range(n):
        sound = margins[i, 0] >= -KEPT
        # A margin that is least at an end of the range hides nothing beyond it.
        if margins[i, 1] == -math.inf or (sound and (i == 0 or i == n - 1)):
            continue
        if not _is_extreme(teeth, mate, i, sums, margins, demands):
            continue
        before, after = max(0, i - 1), min(n - 1, i + 1)
        total = _peak(teeth, mate, sums[before], sums[after], -1.0 if sound else 1.0, demands)
        seen[count, 0], seen[count, 1] = total, _of_sum(teeth, mate, total, demands, math.inf)
        count += 1
    return seen[:count][np.argsort(seen[:count, 0])]


@njit(cache=True, nogil=True)
def sums_that_suit(teeth: int, mate: int, low: float, high: float, demands: Demands) -> NDArray[np.float64]:
    """All sums of shifts between ``low`` and ``high`` that suit a pair.

    Two maxima of the margin that are nearer to one another than two parts of the range may be taken for one.

    Returns
    -------
    array of shape (k, 2)
        Intervals in rising order.
    """
    seen = _looked_at(teeth, mate, low, high, demands)
    found = np.empty((len(seen), 2))
    count = 0
    for i in range(len(seen)):
        if not seen[i, 1] >= -KEPT:
            continue
        if i == 0 or not seen[i - 1, 1] >= -KEPT:
            found[count, 0] = seen[i, 0] if i == 0 else _last_sum(teeth, mate, seen[i, 0], seen[i - 1, 0], demands)
        if i == len(seen) - 1 or not seen[i + 1, 1] >= -KEPT:
            last = i == len(seen) - 1
            found[count, 1] = seen[i, 0] if last else _last_sum(teeth, mate, seen[i, 0], seen[i + 1, 0], demands)
            count += 1
    return found[:count].copy()


@njit(cache=True, nogil=True)
def _last_sum(teeth: int, mate: int, sound: float, end: float, demands: Demands) -> float:
    """The last sum from one that suits towards one that does not."""
    rack, split, tangent = rack_of(demands), math.nan, 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (sound + end)
        found, tangent = _split_of_sum(teeth, mate, middle, demands, rack, tangent, split + 0.5 * (middle - sound))
        if not math.isnan(found):
            sound, split = middle, found
        else:
            end = middle
    return sound


@njit(cache=True, nogil=True)
def sum_that_suits(teeth: int, mate: int, low: float, high: float, demands: Demands) -> float:
    """A sum of shifts between ``low`` and ``high`` that suits a pair; nan: none does."""
    # From no shift on, where most pairs are sound, then all over the range.
    at = min(max(0.0, low), high)
    if _sum_suits(teeth, mate, at, demands):
        return at
    for total in _grid(low, high):
        if _sum_suits(teeth, mate, total, demands):
            return float(total)
    for row in _looked_at(teeth, mate, low, high, demands):
        if row[1] >= -KEPT:
            return float(row[0])
    return math.nan


@njit(cache=True, nogil=True)
def _sums_between(teeth: int, mate: int, near: float, far: float, ends: bool, demands: Demands) -> NDArray[np.float64]:
    """Intervals of sums that suit at distances from ``near`` to ``far``; without ``ends`` one sum, twice."""
    low, high = 2.0 * demands.least_shift, 2.0 * demands.most_shift
    first = at_distance(teeth, mate, near, demands)
    if first.shortening >= 0.0:
        low = max(low, first.total)
    if far < math.inf:
        last = at_distance(teeth, mate, far, demands)
        high = min(high, last.total) if last.shortening >= 0.0 else -math.inf
    if not low <= high:
        return np.empty((0, 2))
    if low == high:
        return np.full((1, 2), low) if _sum_suits(teeth, mate, low, demands) else np.empty((0, 2))
    if ends:
        return sums_that_suit(teeth, mate, low, high, demands)
    total = sum_that_suits(teeth, mate, low, high, demands)
    return np.full((1, 2), total) if total >= low else np.empty((0, 2))


@njit(cache=True, nogil=True)
def sound_between(
    least: NDArray[np.float64], most: NDArray[np.float64], ends: bool, demands: Demands
) -> NDArray[np.float64]:
    """Between which distances every pair suits, of those from ``least[a, b]`` to ``most[a, b]``.

    Parameters
    ----------
    least, most : array of shape (n, n)
        Symmetric, in modules; equal for one distance, 0 and infinity for any; nan where a pair is not asked for.
    ends : bool
        Whether all distances that suit are wanted; otherwise it is one that suits, twice.

    Returns
    -------
    array of shape (n, n, k, 2)
        Up to k intervals of each pair in rising order, then nan.
    """
    n = len(least)
    found = np.full((n, n, 1, 2), np.nan)
    for a in range(n):
        for b in range(a, n):
            near, far = least[a, b], most[a, b]
            if not near <= far:
                continue
            if near == far:
                working = at_distance(a, b, near, demands)
                if working.shortening >= 0.0 and suits(a, b, working, demands):
                    found[a, b, 0], found[b, a, 0] = near, near
                continue
            sums = _sums_between(a, b, near, far, ends, demands)
            if len(sums) > found.shape[2]:
                wider = np.full((n, n, len(sums), 2), np.nan)
                wider[:, :, : found.shape[2]] = found
                found = wider
            for i in range(len(sums)):
                for end in range(2):
                    distance = with_sum(a, b, sums[i, end], demands).distance
                    found[a, b, i, end], found[b, a, i, end] = distance, distance
    return found
