"""Feasible sums of profile shifts of a pair of external gears, compiled; all lengths in modules.

A sum is feasible if its best split satisfies all constraints (:mod:`kinematics.gear.splits`). Over a range of sums the
margin of the best split may rise and fall more than once, so the feasible sums are a list of intervals. They are found
on a grid, near every local maximum and minimum on it, and by bisection of every change of feasibility.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from kinematics.gear.shifting import (
    GOLDEN_RATIO,
    GOLDEN_SECTION_STEPS,
    MARGIN_RESOLUTION,
    MARGIN_TOLERANCE,
    PairConstraints,
    Rack,
    Working,
    build_rack,
    find_best_split,
    from_distance,
    from_sum,
    from_sum_near,
)
from kinematics.gear.splits import bound_greatest_margin, find_sound_split

MIN_SUM_SEPARATION = 1e-6
"""Distance of two sums of shifts below which the search for an extreme margin stops."""

SUM_PARTS = 32
"""Number of parts into which a range of sums is divided in the search for feasible ones."""

NEWTON_TOLERANCE = 1e-8
"""Relative last step of Newton's method for tan φ_w: its error is about the square, enough for margins of 1e-12
modules."""

HALVING_STEPS = 28
"""Halvings of an interval of sums with one infeasible end: 1e-9 modules of it remain."""


@njit(cache=True, nogil=True)
def is_suitable(teeth: int, mate: int, working: Working, demands: PairConstraints) -> bool:
    """Return whether some split of the sum satisfies all constraints."""
    split = find_sound_split(teeth, mate, working, demands, build_rack(demands), math.nan)
    # Infinite: too close to a limit for the fast test by slopes, so golden sections decide.
    if math.isinf(split):
        return find_best_split(teeth, mate, working, demands, -MARGIN_TOLERANCE)[1] >= -MARGIN_TOLERANCE
    return not math.isnan(split)


@njit(cache=True, nogil=True)
def _find_split(
    teeth: int, mate: int, total: float, demands: PairConstraints, rack: Rack, start: float, guess: float
) -> tuple[float, float]:
    """Find a feasible split of a sum, nan if there is none, and tan φ_w, both from first guesses."""
    working, tangent = from_sum_near(teeth, mate, total, rack, start, NEWTON_TOLERANCE)
    # "not >" also rejects the nan of a sum that no distance takes up.
    if not working.distance > 0.0:
        return math.nan, tangent
    split = find_sound_split(teeth, mate, working, demands, rack, guess)
    if math.isinf(split):
        split, most = find_best_split(teeth, mate, from_sum(teeth, mate, total, demands), demands, -MARGIN_TOLERANCE)
        if not most >= -MARGIN_TOLERANCE:
            split = math.nan
    return split, tangent


@njit(cache=True, nogil=True)
def _is_sum_suitable(teeth: int, mate: int, total: float, demands: PairConstraints) -> bool:
    return not math.isnan(_find_split(teeth, mate, total, demands, build_rack(demands), 0.0, math.nan)[0])


@njit(cache=True, nogil=True)
def _evaluate_sum(teeth: int, mate: int, total: float, demands: PairConstraints, enough: float) -> float:
    """Evaluate the maximum margin of a sum by golden sections."""
    working = from_sum(teeth, mate, total, demands)
    if not working.distance > 0.0:
        return -math.inf
    return find_best_split(teeth, mate, working, demands, enough)[1]


@njit(cache=True, nogil=True)
def _find_peak(teeth: int, mate: int, left: float, right: float, sign: float, demands: PairConstraints) -> float:
    """Find the sum with the maximum ``sign`` × margin between two; stop as soon as its sign decides."""
    # A maximum is sought among infeasible sums until one is feasible; a minimum until one is infeasible.
    one, other = right - GOLDEN_RATIO * (right - left), left + GOLDEN_RATIO * (right - left)
    first = sign * _evaluate_sum(teeth, mate, one, demands, math.inf)
    second = sign * _evaluate_sum(teeth, mate, other, demands, math.inf)
    for _ in range(GOLDEN_SECTION_STEPS):
        most = max(first, second)
        if (most >= -MARGIN_TOLERANCE if sign > 0.0 else most > MARGIN_TOLERANCE) or right - left < MIN_SUM_SEPARATION:
            break
        if first < second:
            left, one, first = one, other, second
            other = left + GOLDEN_RATIO * (right - left)
            second = sign * _evaluate_sum(teeth, mate, other, demands, math.inf)
        else:
            right, other, second = other, one, first
            one = right - GOLDEN_RATIO * (right - left)
            first = sign * _evaluate_sum(teeth, mate, one, demands, math.inf)
    return one if first > second else other


@njit(cache=True, nogil=True)
def _build_grid(low: float, high: float) -> NDArray[np.float64]:
    """Build a grid of sums from ``low`` to ``high``, ascending, including the one nearest to zero."""
    sums = np.empty(SUM_PARTS + 2)
    for i in range(SUM_PARTS + 1):
        sums[i] = low + (high - low) * i / SUM_PARTS
    # Exact end, free of rounding.
    sums[SUM_PARTS] = high
    sums[SUM_PARTS + 1] = min(max(0.0, low), high)
    return np.sort(sums)


@njit(cache=True, nogil=True)
def _bound_margins(teeth: int, mate: int, sums: NDArray[np.float64], demands: PairConstraints) -> NDArray[np.float64]:
    """Bound the maximum margin of every sum from both sides; the sign agrees with golden sections."""
    margins = np.full((len(sums), 2), -math.inf)
    rack, guess, tangent = build_rack(demands), math.nan, 0.0
    for i, total in enumerate(sums):
        working, tangent = from_sum_near(teeth, mate, total, rack, tangent, NEWTON_TOLERANCE)
        if not working.distance > 0.0:
            continue
        # Start from the neighbour's split with half the change of the sum.
        found = bound_greatest_margin(teeth, mate, working, demands, rack, guess + 0.5 * (total - sums[max(0, i - 1)]))
        guess = found.split
        margins[i, 0], margins[i, 1] = found.least, found.most
        if math.isinf(guess):
            golden = _evaluate_sum(teeth, mate, total, demands, math.inf)
            margins[i, 0], margins[i, 1], guess = golden, golden + MARGIN_RESOLUTION, math.nan
    return margins


@njit(cache=True, nogil=True)
def _is_extreme(
    teeth: int, mate: int, i: int, sums: NDArray[np.float64], margins: NDArray[np.float64], demands: PairConstraints
) -> bool:
    """Return whether an infeasible sum is a local maximum of the margin, or a feasible one a local minimum."""
    before, after = max(0, i - 1), min(len(sums) - 1, i + 1)
    sign = -1.0 if margins[i, 0] >= -MARGIN_TOLERANCE else 1.0
    # The bounds differ by up to MARGIN_RESOLUTION; where that could change the decision, golden sections decide.
    own = (
        min(sign * (margins[i, 0] - MARGIN_RESOLUTION), sign * margins[i, 1]),
        max(sign * (margins[i, 0] - MARGIN_RESOLUTION), sign * margins[i, 1]),
    )
    beaten, beats = False, True
    for k in (before, after):
        if k != i:
            ends = sign * (margins[k, 0] - MARGIN_RESOLUTION), sign * margins[k, 1]
            beaten |= own[1] < min(ends)
            beats &= own[0] >= max(ends)
    if beaten or beats:
        return beats and not beaten
    golden = [sign * _evaluate_sum(teeth, mate, sums[k], demands, math.inf) for k in (before, i, after)]
    return not golden[1] < max(golden[0], golden[2])


@njit(cache=True, nogil=True)
def _list_examined_sums(
    teeth: int, mate: int, low: float, high: float, demands: PairConstraints
) -> NDArray[np.float64]:
    """List sums, ascending, between which the margin crosses its limit at most once; rows of sum and margin."""
    sums = _build_grid(low, high)
    n = len(sums)
    margins = _bound_margins(teeth, mate, sums, demands)
    seen = np.empty((2 * n, 2))
    seen[:n, 0], seen[:n, 1] = sums, margins[:, 0]
    count = n
    for i in range(n):
        sound = margins[i, 0] >= -MARGIN_TOLERANCE
        # A minimum at an end of the range cannot hide an infeasible stretch.
        if margins[i, 1] == -math.inf or (sound and (i == 0 or i == n - 1)):
            continue
        if not _is_extreme(teeth, mate, i, sums, margins, demands):
            continue
        before, after = max(0, i - 1), min(n - 1, i + 1)
        total = _find_peak(teeth, mate, sums[before], sums[after], -1.0 if sound else 1.0, demands)
        seen[count, 0], seen[count, 1] = total, _evaluate_sum(teeth, mate, total, demands, math.inf)
        count += 1
    return seen[:count][np.argsort(seen[:count, 0])]


@njit(cache=True, nogil=True)
def find_suitable_sums(teeth: int, mate: int, low: float, high: float, demands: PairConstraints) -> NDArray[np.float64]:
    """Find all feasible sums of shifts of a pair between ``low`` and ``high``.

    Two maxima of the margin closer than two parts of the range may be merged into one.

    Returns
    -------
    array of shape (k, 2)
        Intervals in rising order.
    """
    seen = _list_examined_sums(teeth, mate, low, high, demands)
    found = np.empty((len(seen), 2))
    count = 0
    for i in range(len(seen)):
        if not seen[i, 1] >= -MARGIN_TOLERANCE:
            continue
        if i == 0 or not seen[i - 1, 1] >= -MARGIN_TOLERANCE:
            # An interval starts here: bisect towards the infeasible neighbour.
            found[count, 0] = seen[i, 0] if i == 0 else _find_last_sum(teeth, mate, seen[i, 0], seen[i - 1, 0], demands)
        if i == len(seen) - 1 or not seen[i + 1, 1] >= -MARGIN_TOLERANCE:
            last = i == len(seen) - 1
            found[count, 1] = seen[i, 0] if last else _find_last_sum(teeth, mate, seen[i, 0], seen[i + 1, 0], demands)
            count += 1
    return found[:count].copy()


@njit(cache=True, nogil=True)
def _find_last_sum(teeth: int, mate: int, sound: float, end: float, demands: PairConstraints) -> float:
    """Bisect for the last feasible sum between a feasible and an infeasible one."""
    rack, split, tangent = build_rack(demands), math.nan, 0.0
    for _ in range(HALVING_STEPS):
        middle = 0.5 * (sound + end)
        found, tangent = _find_split(teeth, mate, middle, demands, rack, tangent, split + 0.5 * (middle - sound))
        if not math.isnan(found):
            sound, split = middle, found
        else:
            end = middle
    return sound


@njit(cache=True, nogil=True)
def find_suitable_sum(teeth: int, mate: int, low: float, high: float, demands: PairConstraints) -> float:
    """Find a feasible sum of shifts of a pair between ``low`` and ``high``; nan if there is none."""
    # Zero shift first, which is feasible for most pairs, then the whole range.
    at = min(max(0.0, low), high)
    if _is_sum_suitable(teeth, mate, at, demands):
        return at
    for total in _build_grid(low, high):
        if _is_sum_suitable(teeth, mate, total, demands):
            return float(total)
    for row in _list_examined_sums(teeth, mate, low, high, demands):
        if row[1] >= -MARGIN_TOLERANCE:
            return float(row[0])
    return math.nan


@njit(cache=True, nogil=True)
def _find_sums_between(
    teeth: int, mate: int, near: float, far: float, ends: bool, demands: PairConstraints
) -> NDArray[np.float64]:
    """Find the intervals of feasible sums at distances from ``near`` to ``far``; without ``ends`` one sum, twice."""
    # The sum of two shifts within their limits.
    low, high = 2.0 * demands.least_shift, 2.0 * demands.most_shift
    first = from_distance(teeth, mate, near, demands)
    # nan where the base circles overlap at this distance.
    if first.shortening >= 0.0:
        low = max(low, first.total)
    if far < math.inf:
        last = from_distance(teeth, mate, far, demands)
        high = min(high, last.total) if last.shortening >= 0.0 else -math.inf
    if not low <= high:
        return np.empty((0, 2))
    if low == high:
        return np.full((1, 2), low) if _is_sum_suitable(teeth, mate, low, demands) else np.empty((0, 2))
    if ends:
        return find_suitable_sums(teeth, mate, low, high, demands)
    total = find_suitable_sum(teeth, mate, low, high, demands)
    return np.full((1, 2), total) if total >= low else np.empty((0, 2))


@njit(cache=True, nogil=True)
def find_sound_distances(
    least: NDArray[np.float64], most: NDArray[np.float64], ends: bool, demands: PairConstraints
) -> NDArray[np.float64]:
    """Find the feasible distances of every pair between ``least[a, b]`` and ``most[a, b]``.

    Parameters
    ----------
    least, most : array of shape (n, n)
        Symmetric, in modules; equal for one distance, 0 and infinity for any; nan for pairs to skip.
    ends : bool
        Find all feasible distances; otherwise a single one, given twice.

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
                working = from_distance(a, b, near, demands)
                if working.shortening >= 0.0 and is_suitable(a, b, working, demands):
                    found[a, b, 0], found[b, a, 0] = near, near
                continue
            sums = _find_sums_between(a, b, near, far, ends, demands)
            if len(sums) > found.shape[2]:
                wider = np.full((n, n, len(sums), 2), np.nan)
                wider[:, :, : found.shape[2]] = found
                found = wider
            for i in range(len(sums)):
                for end in range(2):
                    distance = from_sum(a, b, sums[i, end], demands).distance
                    found[a, b, i, end], found[b, a, i, end] = distance, distance
    return found
