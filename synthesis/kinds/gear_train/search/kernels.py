"""Compiled loops of the search for tooth numbers.

A train of k stages has drivers a₁...a_k and driven gears b₁...b_k; its ratio is N/D with integers N = Πb and D = Πa.

The error against the target T = T_hi + T_lo (two floats) is e = |N − T D| / (T D). N and D are below 2⁵³, the product
T_hi·D is split without rounding (Dekker), and N minus its head is exact if the two are near each other; so e is
accurate to a few units of its own last place, down to about 2⁻¹⁰⁰.

The results are collected in a :class:`~synthesis.kinds.gear_train.search.shortlist.Shortlist`: the best trains in
order, up to its capacity, and the minimum error of each size, from which the Pareto set follows. A train is decoded
only if it could enter one of the two.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers, Real
from kinematics.compiling import njit
from synthesis.kinds.gear_train.search.pairing_rules import (
    MAX_STAGES,
    Rule,
    arrange_pairs,
    is_foremost,
    is_within_limits,
)
from synthesis.kinds.gear_train.search.shortlist import TIE_TOLERANCE, Shortlist, enter, is_improvement

Gears = NDArray[np.int16]

SPLITTER = 134217729.0
"""2²⁷ + 1: splits a float of 53 bits into two of 26 bits, whose products are exact (Veltkamp, Dekker)."""

DISTANCE_TOLERANCE = 1e-13
"""Gap between the distance intervals of coaxial meshes, as a share of the distance, that is attributed to rounding."""

WINDOW_MARGIN = 1e-12
"""Relative widening of the window of errors, so that rounding excludes no train. The exact order is found later."""


@njit(cache=True, nogil=True, inline="always")
def compute_error(n: int, d: int, target: float, rest: float) -> float:
    """Return the relative error of the ratio n/d."""
    x, y = float(d), target
    p = x * y
    # Dekker's product: x·y = p + low exactly, from the halves of both factors.
    c = SPLITTER * x
    xh = c - (c - x)
    c = SPLITTER * y
    yh = c - (c - y)
    xl, yl = x - xh, y - yh
    low = ((xh * yh - p) + xh * yl + xl * yh) + xl * yl
    return abs(((float(n) - p) - low) - rest * x) / p


@njit(cache=True, nogil=True)
def compute_divisor(a: int, b: int) -> int:
    """Return the greatest common divisor."""
    while b:
        a, b = b, a % b
    return a


@njit(cache=True, nogil=True, inline="always")
def _compute_window(ranked: float, front: float, tolerance: float) -> float:
    """Return the maximum error of trains that matter, slightly widened, so that rounding excludes none."""
    return min(max(ranked, front), tolerance) * (1.0 + WINDOW_MARGIN) + TIE_TOLERANCE


@njit(cache=True, nogil=True)
def _compute_ranked_error(size: int, shortlist: Shortlist, by_size: bool) -> float:
    """Return the maximum error with which a train of the given size enters the shortlist by rank; 0 if none can."""
    last = len(shortlist.error) - 1
    if shortlist.kept[0] <= last:
        return np.inf
    if by_size:
        return 0.0 if size > shortlist.size[last] else np.inf
    return float(shortlist.error[last])


@njit(cache=True, nogil=True)
def _is_empty(starts: Integers, size: int) -> bool:
    """Return whether no rows have a size."""
    return size > len(starts) - 2 or starts[size] == starts[size + 1]


@njit(cache=True, nogil=True)
def match(
    k: int,
    drivers: Gears,
    driver_products: Integers,
    driver_starts: Integers,
    driven: Gears,
    driven_products: Integers,
    driven_starts: Integers,
    from_size: int,
    to_size: int,
    rule: Rule,
    shortlist: Shortlist,
) -> None:
    """Meet in the middle: all drivers × all driven gears, for sizes from ``from_size`` up to and without ``to_size``.

    The rows of ``drivers`` of size u are ``driver_starts[u]`` to ``driver_starts[u + 1]``, sorted by product;
    ``driven`` has the same layout. For each pair of sizes, one pass over both lists finds all pairs with errors that
    could matter.
    """
    teeth = np.zeros(3 * MAX_STAGES, np.int64)
    # The Pareto front so far: a train must be nearer than all smaller ones to enter it.
    front = np.inf
    for s in range(min(from_size, len(shortlist.least_error))):
        front = min(front, shortlist.least_error[s])
    for size in range(from_size, to_size):
        for step in range(2 * size + 1 if rule.largest else size + 1):
            # All pairs (u, v) with u + v = size, or with max(u, v) = size if the largest gear counts.
            u = min(step, size)
            v = (2 * size - step if step > size else size) if rule.largest else size - step
            if _is_empty(driver_starts, u) or _is_empty(driven_starts, v):
                continue
            start, end = driven_starts[v], driven_starts[v + 1]
            middle = start
            for i in range(driver_starts[u], driver_starts[u + 1]):
                d = driver_products[i]
                wanted = rule.target * d
                # Both lists rise, so that the nearest driven product only moves upward.
                while middle < end and driven_products[middle] < wanted:
                    middle += 1
                # From the nearest product outward, first downward, until the error leaves the window.
                for upward in range(2):
                    j = middle if upward else middle - 1
                    while start <= j < end:
                        ranked = _compute_ranked_error(size, shortlist, rule.by_size)
                        near = abs(driven_products[j] - wanted)
                        window = _compute_window(ranked, min(front, shortlist.least_error[size]), rule.tolerance)
                        if near > window * wanted:
                            break
                        e = compute_error(driven_products[j], d, rule.target, rule.target_rest)
                        if e <= rule.tolerance and is_improvement(e, size, shortlist, rule.by_size):
                            for stage in range(k):
                                teeth[stage] = drivers[i, stage]
                                teeth[MAX_STAGES + stage] = driven[j, stage]
                            if is_within_limits(teeth, k, rule) and arrange_pairs(teeth, k, rule):
                                enter(e, size, teeth, shortlist, rule.by_size)
                        j += 1 if upward else -1
        front = min(front, shortlist.least_error[size])


@njit(cache=True, nogil=True)
def match_all(
    k: int,
    drivers: Gears,
    driver_products: Integers,
    driver_sizes: Integers,
    driver_order: Integers,
    driven: Gears,
    driven_products: Integers,
    driven_sizes: Integers,
    driven_order: Integers,
    from_size: int,
    rule: Rule,
    shortlist: Shortlist,
) -> None:
    """Match like :func:`match`, for all sizes from ``from_size`` up in one pass over both lists sorted by product.

    The pass visits every train that is near enough for the smallest of these sizes, so that it is only efficient if
    there are few such trains.
    """
    teeth = np.zeros(3 * MAX_STAGES, np.int64)
    capacity, middle = len(shortlist.error), 0
    front = np.inf
    for s in range(min(from_size, len(shortlist.least_error))):
        front = min(front, shortlist.least_error[s])
    for place in range(len(driver_order)):
        i = driver_order[place]
        d = driver_products[i]
        wanted = rule.target * d
        while middle < len(driven_order) and driven_products[driven_order[middle]] < wanted:
            middle += 1
        for upward in range(2):
            at = middle if upward else middle - 1
            while 0 <= at < len(driven_order):
                j = driven_order[at]
                at += 1 if upward else -1
                if rule.by_size:
                    # By size, larger trains cannot enter a full shortlist.
                    full = shortlist.kept[0] == capacity and from_size > shortlist.size[capacity - 1]
                    ranked = 0.0 if full else np.inf
                else:
                    ranked = shortlist.error[capacity - 1] if shortlist.kept[0] == capacity else np.inf
                if abs(driven_products[j] - wanted) > _compute_window(ranked, front, rule.tolerance) * wanted:
                    break
                one, other = driver_sizes[i], driven_sizes[j]
                size = max(one, other) if rule.largest else one + other
                if size < from_size or size >= len(shortlist.least_error):
                    continue
                e = compute_error(driven_products[j], d, rule.target, rule.target_rest)
                if e <= rule.tolerance and is_improvement(e, size, shortlist, rule.by_size):
                    for stage in range(k):
                        teeth[stage] = drivers[i, stage]
                        teeth[MAX_STAGES + stage] = driven[j, stage]
                    if is_within_limits(teeth, k, rule) and arrange_pairs(teeth, k, rule):
                        enter(e, size, teeth, shortlist, rule.by_size)


@njit(cache=True, nogil=True)
def count_products(
    k: int,
    drivers: Gears,
    driver_products: Integers,
    driven: Gears,
    driven_products: Integers,
    over: int,
    under: int,
    rule: Rule,
) -> int:
    """Count the trains with exactly the ratio over/under, a reduced fraction; ``driven`` is sorted by product."""
    teeth = np.zeros(3 * MAX_STAGES, np.int64)
    count = 0
    # Without rules for meshes every pairing is allowed, which saves millions of calls.
    any_pairing = not rule.ordered and not rule.by_mesh
    for i in range(len(driver_products)):
        # N/D = over/under needs D divisible by the reduced denominator.
        if driver_products[i] % under != 0:
            continue
        wanted = driver_products[i] // under * over
        j = np.searchsorted(driven_products, wanted)
        while j < len(driven_products) and driven_products[j] == wanted:
            for stage in range(k):
                teeth[stage] = drivers[i, stage]
                teeth[MAX_STAGES + stage] = driven[j, stage]
            count += is_within_limits(teeth, k, rule) and (any_pairing or arrange_pairs(teeth, k, rule))
            j += 1
    return count


@njit(cache=True, nogil=True)
def enumerate_tuples(values: Integers, starts: Integers, counts: Integers, ordered: bool, rows: Gears) -> int:
    """Enumerate all choices of one value for each stage; return their number, and write as many as ``rows`` can hold.

    Stage i chooses from ``values[starts[i]:starts[i + 1]]``. Without ``ordered`` the choices rise, each multiset once.
    If ``counts`` is not empty a value t occurs at most ``counts[t]`` times.
    """
    k = len(starts) - 1
    place = np.zeros(k, np.int64)
    stage, number = 0, 0
    place[0] = starts[0]
    # Depth-first search with an explicit stack: ``place[stage]`` is the current choice of each stage.
    while stage >= 0:
        if place[stage] >= starts[stage + 1]:
            stage -= 1
            if stage >= 0:
                place[stage] += 1
            continue
        if len(counts) > 0:
            same = 0
            for i in range(stage + 1):
                same += values[place[i]] == values[place[stage]]
            if same > counts[values[place[stage]]]:
                place[stage] += 1
                continue
        if stage < k - 1:
            stage += 1
            place[stage] = starts[stage] if ordered else starts[stage] + place[stage - 1] - starts[stage - 1]
            continue
        if number < len(rows):
            for i in range(k):
                rows[number, i] = values[place[i]]
        number += 1
        place[stage] += 1
    return number


@njit(cache=True, nogil=True)
def has_common_distance(distances: Real, place: Integers, k: int) -> bool:
    """Return whether k meshes have a common distance; it suffices to test the lower ends of their intervals."""
    for i in range(k):
        for p in range(distances.shape[1]):
            distance, agreed = distances[place[i], p, 0], 0
            for m in range(k):
                for q in range(distances.shape[1]):
                    near, far = distances[place[m], q, 0], distances[place[m], q, 1]
                    if near <= distance <= far * (1.0 + DISTANCE_TOLERANCE):
                        agreed += 1
                        break
            if agreed == k:
                return True
    return False


@njit(cache=True, nogil=True)
def _find_ratio(ratio: Real, wanted: float, low: int, end: int) -> int:
    """Return the first place from ``low`` on with a ratio of at least ``wanted``, in ratios of non-decreasing order."""
    while low < end:
        half = (low + end) // 2
        if ratio[half] < wanted:
            low = half + 1
        else:
            end = half
    return low


@njit(cache=True, nogil=True)
def _is_tied(numerator: int, denominator: int, tied: Integers) -> bool:
    """Return whether a fraction is one of those whose trains are counted."""
    for t in range(len(tied)):
        common = compute_divisor(numerator, denominator)
        if numerator // common == tied[t, 0] and denominator // common == tied[t, 1]:
            return True
    return False


@njit(cache=True, nogil=True)
def _is_counted(
    teeth: Integers, canonical: Integers, distances: Real, place: Integers, k: int, coaxial: bool, rule: Rule
) -> bool:
    """Return whether a train is possible and is the one that counts for its gears; ``canonical`` is a work array."""
    sound = has_common_distance(distances, place, k) and is_within_limits(teeth, k, rule)
    if sound and not coaxial and not rule.ordered:
        # The canonical train has drivers and driven gears sorted: its best pairing must be the
        # present one.
        for i in range(2 * MAX_STAGES):
            canonical[i] = teeth[i]
        sort(canonical, 0, k)
        sort(canonical, MAX_STAGES, k)
        sound = arrange_pairs(canonical, k, rule) and has_same_meshes(teeth, canonical, k)
    elif sound and rule.ordered:
        sound = is_foremost(teeth, k, rule, coaxial)
    return sound


@njit(cache=True, nogil=True)
def _complete_trains(
    k: int, g: int, begin: int, end: int, place: Integers, front: float, a: Integers, b: Integers, mark: Integers,
    ratio: Real, least_size: Integers, distances: Real, coaxial: bool, rule: Rule, shortlist: Shortlist, tied: Integers,
    teeth: Integers, canonical: Integers,
) -> float:  # fmt: skip
    """Complete the meshes at ``place`` by those of the last stage; return the error of the Pareto front.

    The last stage is searched from ``begin`` to ``end``; other parameters as for :func:`combine`.
    """
    up, down, so_far, gears, widest = 1, 1, 1.0, 0, 0
    for i in range(k - 1):
        up *= b[place[i]]
        down *= a[place[i]]
        so_far *= ratio[place[i]]
        gears += a[place[i]] + b[place[i]]
        widest = max(widest, a[place[i]], b[place[i]])
    # The last stage must supply the rest of the ratio: bisect for it, then search outward on both sides.
    wanted = rule.target / so_far
    low = begin if rule.ordered or k == 1 else place[k - 2]
    middle = _find_ratio(ratio, wanted, low, end)
    for upward in range(2):
        j = middle if upward else middle - 1
        while low <= j < end:
            ranked = _compute_ranked_error(least_size[g], shortlist, rule.by_size)
            if len(tied) > 0:
                # For counting ties, only the error of the best train is of interest.
                ranked = front = shortlist.error[0]
            if abs(ratio[j] - wanted) > _compute_window(ranked, front, rule.tolerance) * wanted:
                break
            e = compute_error(up * b[j], down * a[j], rule.target, rule.target_rest)
            size = max(widest, a[j], b[j]) if rule.largest else gears + a[j] + b[j]
            wanted_tie = _is_tied(up * b[j], down * a[j], tied)
            few = size < len(shortlist.least_error)
            if wanted_tie or (
                len(tied) == 0 and few and e <= rule.tolerance and is_improvement(e, size, shortlist, rule.by_size)
            ):
                place[k - 1] = j
                for i in range(k):
                    teeth[i], teeth[MAX_STAGES + i] = a[place[i]], b[place[i]]
                    teeth[2 * MAX_STAGES + i] = mark[place[i]]
                sound = _is_counted(teeth, canonical, distances, place, k, coaxial, rule)
                if sound and wanted_tie:
                    shortlist.ties[0] += 1
                elif sound:
                    enter(e, size, teeth, shortlist, rule.by_size)
                    if size <= least_size[g]:
                        front = min(front, e)
            j += 1 if upward else -1
    return front


@njit(cache=True, nogil=True)
def combine(
    k: int,
    a: Integers,
    b: Integers,
    mark: Integers,
    ratio: Real,
    groups: Integers,
    least_size: Integers,
    distances: Real,
    first: int,
    last: int,
    coaxial: bool,
    rule: Rule,
    shortlist: Shortlist,
    tied: Integers,
) -> None:
    """Combine trains of one mesh a:b from each stage's list, for the groups from ``first`` up to and without ``last``.

    In a group, the stages' lists are ``groups[g, i]`` to ``groups[g, i + 1]``, sorted by the ratio b/a. Without
    ``rule.ordered`` they are one list, and every multiset occurs once. All stages except the last are enumerated, and
    the fitting meshes of the last stage are found by bisection. ``least_size`` of the groups must not decrease. The
    meshes of a train must agree on a distance within one of the intervals ``distances[row]`` of each. With
    ``coaxial``, the pairing is fixed, and only one order of the meshes counts. Otherwise only the pairing that
    ``arrange_pairs`` would choose counts, so that each set of gears occurs once.

    If ``tied`` has rows of fractions, no train is entered, and the trains with exactly these ratios are counted.
    """
    teeth, canonical = np.zeros(3 * MAX_STAGES, np.int64), np.zeros(3 * MAX_STAGES, np.int64)
    place = np.zeros(MAX_STAGES + 1, np.int64)
    for g in range(first, last):
        front = np.inf
        for s in range(least_size[g] + 1):
            front = min(front, shortlist.least_error[s])
        begin = groups[g, k - 1] if rule.ordered else groups[g, 0]
        end = groups[g, k] if rule.ordered else groups[g, 1]
        stage = 0
        place[0] = groups[g, 0]
        while stage >= 0:
            if stage < k - 1:
                stop = groups[g, stage + 1] if rule.ordered else end
                if place[stage] >= stop:
                    stage -= 1
                    if stage >= 0:
                        place[stage] += 1
                    continue
                stage += 1
                place[stage] = groups[g, stage] if rule.ordered else place[stage - 1]
                continue
            front = _complete_trains(
                k, g, begin, end, place, front, a, b, mark, ratio, least_size, distances, coaxial, rule, shortlist,
                tied, teeth, canonical,
            )  # fmt: skip
            stage -= 1
            if stage >= 0:
                place[stage] += 1


@njit(cache=True, nogil=True)
def sort(teeth: Integers, start: int, count: int) -> None:
    """Sort some of the numbers in place, in rising order."""
    # Insertion sort: there are at most four numbers.
    for i in range(start + 1, start + count):
        value, j = teeth[i], i
        while j > start and teeth[j - 1] > value:
            teeth[j] = teeth[j - 1]
            j -= 1
        teeth[j] = value


@njit(cache=True, nogil=True)
def has_same_meshes(one: Integers, other: Integers, k: int) -> bool:
    """Return whether two trains have the same meshes in any order."""
    used = np.zeros(MAX_STAGES, np.bool_)
    for i in range(k):
        met = False
        for j in range(k):
            if not used[j] and not met and one[i] == other[j] and one[MAX_STAGES + i] == other[MAX_STAGES + j]:
                used[j] = met = True
        if not met:
            return False
    return True
