"""Compiled loops of the search for tooth numbers.

A train of k stages has drivers a₁...a_k and driven gears b₁...b_k; its ratio is N/D with integers N = Πb and D = Πa.

The error against the target T = T_hi + T_lo (two floats) is e = |N − T D| / (T D). N and D are below 2⁵³, the product
T_hi·D is split without rounding (Dekker), and N minus its head is exact where the two are near each other; so e is
good to a few units of its own last place, however small, down to about 2⁻¹⁰⁰. Two errors that differ by less than
:data:`SAME` of themselves are taken for a tie here; the callers order what comes out in exact arithmetic.

The results are collected in a :class:`Found`: the best trains in order, as many as it has room for, and the least error
of each size, from which the Pareto set follows. A train is decoded only if it could enter one of the two.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Integers = NDArray[np.int64]
Floats = NDArray[np.float64]
Gears = NDArray[np.int16]

MOST_STAGES = 4

SPLITTER = 134217729.0
"""2²⁷ + 1: times a float of 53 bits it parts it into two of 26 bits, whose products are exact (Veltkamp, Dekker)."""

WINDOW_MARGIN = 1e-12
"""Share by which the window of errors is widened: rounding must not lose a train, and the order is exact later."""

SAME = 1e-14
"""Errors closer than this share of themselves count as tied in the loops: some thirty roundings."""

NOISE = 1e-28
"""Error that a train of exactly the target's ratio can show: the target's two floats are good to 2⁻¹⁰⁵."""


class Found(NamedTuple):
    """What a search has met so far; arrays that the kernels write to.

    ``kept[0]`` trains stand in ``error``, ``size``, ``teeth`` in the order of the ranking; ``least_error[s]`` belongs
    to the train ``least_teeth[s]`` of size s. Teeth are a₁...a₄ b₁...b₄ and marks₁...₄ of the stages, 0 for no stage.
    """

    kept: Integers
    error: Floats
    size: Integers
    teeth: Integers
    least_error: Floats
    least_teeth: Integers
    ties: Integers

    @classmethod
    def empty(cls, capacity: int, largest_size: int) -> Found:
        """Room for ``capacity`` best trains and for sizes up to ``largest_size``."""
        return cls(
            np.zeros(1, np.int64),
            np.full(capacity, np.inf),
            np.zeros(capacity, np.int64),
            np.zeros((capacity, 3 * MOST_STAGES), np.int64),
            np.full(largest_size + 1, np.inf),
            np.zeros((largest_size + 1, 3 * MOST_STAGES), np.int64),
            np.zeros(1, np.int64),
        )


class Rule(NamedTuple):
    """What makes a train a candidate and how candidates are ranked.

    ``allowed[a, b]`` tells which meshes may be, where ``by_mesh``; ``stock[t]`` how many gears of t teeth there are,
    where ``by_stock``. ``with_idler``: in one stage, of the pairs ``idled``, an idler stands between the gears, and has
    to mesh soundly (``sound``) with both; of a stock it takes one more gear. ``most_total`` bounds the sum of all
    teeth. ``ordered``: stages have ranges of their own, of the place i of a train's teeth from ``least[i]`` to
    ``most[i]``. ``by_size``: the smallest trains first,
    else the nearest. ``largest``: the size of a train is its largest gear, else the sum of all teeth.
    """

    target: float
    target_rest: float
    tolerance: float
    by_size: bool
    largest: bool
    ordered: bool
    least: Integers
    most: Integers
    by_mesh: bool
    allowed: NDArray[np.bool_]
    with_idler: bool
    sound: NDArray[np.bool_]
    idled: NDArray[np.bool_]
    by_stock: bool
    stock: Integers
    most_total: int


@njit(cache=True, nogil=True, inline="always")
def error_of(n: int, d: int, target: float, rest: float) -> float:
    """Relative error of the ratio n/d."""
    x, y = float(d), target
    p = x * y
    c = SPLITTER * x
    xh = c - (c - x)
    c = SPLITTER * y
    yh = c - (c - y)
    xl, yl = x - xh, y - yh
    low = ((xh * yh - p) + xh * yl + xl * yh) + xl * yl
    return abs(((float(n) - p) - low) - rest * x) / p


@njit(cache=True, nogil=True)
def divisor(a: int, b: int) -> int:
    """Greatest common divisor."""
    while b:
        a, b = b, a % b
    return a


@njit(cache=True, nogil=True)
def within_limits(teeth: Integers, k: int, rule: Rule) -> bool:
    """Whether there are enough gears of each tooth number, and the sum of all teeth is small enough."""
    total = 0
    for i in range(k):
        total += teeth[i] + teeth[MOST_STAGES + i]
    if total > rule.most_total:
        return False
    if rule.by_stock:
        for i in range(2 * k):
            one = teeth[i] if i < k else teeth[MOST_STAGES + i - k]
            same = 0
            for j in range(2 * k):
                other = teeth[j] if j < k else teeth[MOST_STAGES + j - k]
                same += one == other
            if same > rule.stock[one]:
                return False
    return True


@njit(cache=True, nogil=True)
def takes_idler(teeth: Integers, k: int, rule: Rule) -> bool:
    """Whether an idler that there is can stand in a stage, and all other stages are allowed without one."""
    for stage in range(k):
        a, b = teeth[stage], teeth[MOST_STAGES + stage]
        others = True
        for j in range(k):
            others = others and (j == stage or rule.allowed[teeth[j], teeth[MOST_STAGES + j]])
        if not others or not rule.idled[a, b]:
            continue
        if not rule.by_stock:
            return True
        for idler in range(len(rule.stock)):
            if rule.stock[idler] > 0 and rule.sound[a, idler] and rule.sound[idler, b]:
                spare = rule.stock[idler]
                for j in range(k):
                    spare -= (teeth[j] == idler) + (teeth[MOST_STAGES + j] == idler)
                if spare > 0:
                    return True
    return False


@njit(cache=True, nogil=True)
def may_be(teeth: Integers, k: int, rule: Rule) -> bool:
    """Whether all stages of a train, as its gears are paired, are allowed."""
    if not rule.by_mesh:
        return True
    for i in range(k):
        a, b = teeth[i], teeth[MOST_STAGES + i]
        if not (rule.allowed[a, b] or (rule.with_idler and rule.idled[a, b])):
            return False
    return not rule.with_idler or takes_idler(teeth, k, rule)


@njit(cache=True, nogil=True)
def widest(teeth: Integers, k: int) -> float:
    """The largest stage ratio, larger over smaller gear; equal for equal ratios, which are rounded once."""
    ratio = 1.0
    for i in range(k):
        a, b = teeth[i], teeth[MOST_STAGES + i]
        ratio = max(ratio, max(a, b) / min(a, b))
    return ratio


@njit(cache=True, nogil=True)
def orders(k: int) -> int:
    """How many orders k things have."""
    count = 1
    for i in range(2, k + 1):
        count *= i
    return count


@njit(cache=True, nogil=True)
def rearrange(teeth: Integers, start: int, k: int, order: int, moved: Integers) -> None:
    """Write k of the numbers, from ``start`` on, in one of their orders; 0 is the one that they have."""
    for i in range(k):
        moved[start + i] = teeth[start + i]
    for i in range(k):
        rest = orders(k - 1 - i)
        chosen, order = start + i + order // rest, order % rest
        value = moved[chosen]
        for j in range(chosen, start + i, -1):
            moved[j] = moved[j - 1]
        moved[start + i] = value


@njit(cache=True, nogil=True)
def in_ranges(teeth: Integers, start: int, k: int, rule: Rule) -> bool:
    """Whether the drivers, or the driven gears, of a train lie within the ranges of their places."""
    inside = True
    for i in range(start, start + k):
        inside = inside and rule.least[i] <= teeth[i] <= rule.most[i]
    return inside


@njit(cache=True, nogil=True)
def foremost(teeth: Integers, k: int, rule: Rule, coaxial: bool) -> bool:
    """Whether a train stands for all that have its gears in other places (``coaxial``: its meshes).

    Of those within the ranges it has the smallest largest stage ratio, and of such ones the smallest first numbers.
    """
    if not may_be(teeth, k, rule):
        return False
    own, count = widest(teeth, k), orders(k)
    other = np.zeros(3 * MOST_STAGES, np.int64)
    for order in range(count):
        rearrange(teeth, 0, k, order, other)
        if not in_ranges(other, 0, k, rule):
            continue
        rearrange(teeth, 2 * MOST_STAGES, k, order, other)
        for mates in range(order if coaxial else 0, order + 1 if coaxial else count):
            rearrange(teeth, MOST_STAGES, k, mates, other)
            if not in_ranges(other, MOST_STAGES, k, rule) or not may_be(other, k, rule):
                continue
            ratio = widest(other, k)
            if ratio > own:
                continue
            if ratio < own:
                return False
            for i in range(len(teeth)):
                if other[i] != teeth[i]:
                    if other[i] < teeth[i]:
                        return False
                    break
    return True


@njit(cache=True, nogil=True)
def pair_up(teeth: Integers, k: int, rule: Rule) -> bool:
    """Bring the driven gears of a train into the order of the smallest largest stage ratio; False: none is allowed.

    Without ranges by place both come in rising order, and of all pairings that has the smallest largest stage ratio;
    where it is not allowed the others are tried. With ranges every order comes by itself, and the foremost is taken.
    """
    if rule.ordered:
        return foremost(teeth, k, rule, False)
    if may_be(teeth, k, rule):
        return True
    trial, best = teeth.copy(), teeth.copy()
    least = np.inf
    for order in range(1, orders(k)):
        rearrange(teeth, MOST_STAGES, k, order, trial)
        if may_be(trial, k, rule) and widest(trial, k) < least:
            least = widest(trial, k)
            best[:] = trial
    teeth[:] = best
    return least < np.inf


@njit(cache=True, nogil=True)
def before(e: float, s: int, other_e: float, other_s: int, by_size: bool) -> bool:
    """Whether a train of error e and size s ranks before another."""
    if by_size and s != other_s:
        return s < other_s
    slack = SAME * (e + other_e) + NOISE
    if abs(e - other_e) > slack:
        return e < other_e
    return s < other_s


@njit(cache=True, nogil=True)
def worth(e: float, s: int, shortlist: Found, by_size: bool) -> bool:
    """Whether a train would enter the best or improve on its size."""
    capacity, count = len(shortlist.error), shortlist.kept[0]
    if count < capacity or before(e, s, shortlist.error[capacity - 1], shortlist.size[capacity - 1], by_size):
        return True
    return bool(e < shortlist.least_error[s])


@njit(cache=True, nogil=True)
def enter(e: float, s: int, teeth: Integers, shortlist: Found, by_size: bool) -> None:
    """Take a train in."""
    if e < shortlist.least_error[s]:
        shortlist.least_error[s] = e
        for i in range(len(teeth)):
            shortlist.least_teeth[s, i] = teeth[i]
    capacity, count = len(shortlist.error), shortlist.kept[0]
    if count == capacity and not before(e, s, shortlist.error[capacity - 1], shortlist.size[capacity - 1], by_size):
        return
    place = min(count, capacity - 1)
    while place > 0 and before(e, s, shortlist.error[place - 1], shortlist.size[place - 1], by_size):
        shortlist.error[place] = shortlist.error[place - 1]
        shortlist.size[place] = shortlist.size[place - 1]
        for i in range(len(teeth)):
            shortlist.teeth[place, i] = shortlist.teeth[place - 1, i]
        place -= 1
    shortlist.error[place], shortlist.size[place] = e, s
    for i in range(len(teeth)):
        shortlist.teeth[place, i] = teeth[i]
    shortlist.kept[0] = min(count + 1, capacity)


@njit(cache=True, nogil=True, inline="always")
def _window(ranked: float, front: float, tolerance: float) -> float:
    """Error up to which hits matter, a little wide: rounding must not lose one."""
    return min(max(ranked, front), tolerance) * (1.0 + WINDOW_MARGIN) + SAME


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
    shortlist: Found,
) -> None:
    """Meet in the middle: all drivers × all driven gears, for the sizes from ``from_size`` up to, without, ``to_size``.

    The rows of ``drivers`` of size u are ``driver_starts[u]`` to ``driver_starts[u + 1]``, in the order of their
    products; ``driven`` likewise. For each pair of sizes one pass over both lists meets every pair whose error could
    matter.
    """
    teeth = np.zeros(3 * MOST_STAGES, np.int64)
    most_drivers, most_driven = len(driver_starts) - 2, len(driven_starts) - 2
    front = np.inf
    for s in range(min(from_size, len(shortlist.least_error))):
        front = min(front, shortlist.least_error[s])
    for size in range(from_size, to_size):
        for step in range(2 * size + 1 if rule.largest else size + 1):
            u = min(step, size)
            v = (2 * size - step if step > size else size) if rule.largest else size - step
            if (
                u > most_drivers
                or v > most_driven
                or driver_starts[u] == driver_starts[u + 1]
                or driven_starts[v] == driven_starts[v + 1]
            ):
                continue
            start, end = driven_starts[v], driven_starts[v + 1]
            middle = start
            for i in range(driver_starts[u], driver_starts[u + 1]):
                d = driver_products[i]
                wanted = rule.target * d
                while middle < end and driven_products[middle] < wanted:
                    middle += 1
                capacity = len(shortlist.error)
                for upward in range(2):
                    j = middle if upward else middle - 1
                    while start <= j < end:
                        full = shortlist.kept[0] == capacity
                        if rule.by_size:
                            ranked = 0.0 if full and size > shortlist.size[capacity - 1] else np.inf
                        else:
                            ranked = shortlist.error[capacity - 1] if full else np.inf
                        near = abs(driven_products[j] - wanted)
                        if near > _window(ranked, min(front, shortlist.least_error[size]), rule.tolerance) * wanted:
                            break
                        e = error_of(driven_products[j], d, rule.target, rule.target_rest)
                        if e <= rule.tolerance and worth(e, size, shortlist, rule.by_size):
                            for stage in range(k):
                                teeth[stage] = drivers[i, stage]
                                teeth[MOST_STAGES + stage] = driven[j, stage]
                            if within_limits(teeth, k, rule) and pair_up(teeth, k, rule):
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
    shortlist: Found,
) -> None:
    """As :func:`match`, for all sizes from ``from_size`` up in one pass over both lists in the order of the products.

    It meets what comes near enough for the least of these sizes, so that it is for when little does.
    """
    teeth = np.zeros(3 * MOST_STAGES, np.int64)
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
                    full = shortlist.kept[0] == capacity and from_size > shortlist.size[capacity - 1]
                    ranked = 0.0 if full else np.inf
                else:
                    ranked = shortlist.error[capacity - 1] if shortlist.kept[0] == capacity else np.inf
                if abs(driven_products[j] - wanted) > _window(ranked, front, rule.tolerance) * wanted:
                    break
                one, other = driver_sizes[i], driven_sizes[j]
                size = max(one, other) if rule.largest else one + other
                if size < from_size or size >= len(shortlist.least_error):
                    continue
                e = error_of(driven_products[j], d, rule.target, rule.target_rest)
                if e <= rule.tolerance and worth(e, size, shortlist, rule.by_size):
                    for stage in range(k):
                        teeth[stage] = drivers[i, stage]
                        teeth[MOST_STAGES + stage] = driven[j, stage]
                    if within_limits(teeth, k, rule) and pair_up(teeth, k, rule):
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
    """How many trains have exactly the ratio over/under, a reduced fraction; ``driven`` is ordered by its products."""
    teeth = np.zeros(3 * MOST_STAGES, np.int64)
    count = 0
    for i in range(len(driver_products)):
        if driver_products[i] % under != 0:
            continue
        wanted = driver_products[i] // under * over
        j = np.searchsorted(driven_products, wanted)
        while j < len(driven_products) and driven_products[j] == wanted:
            for stage in range(k):
                teeth[stage] = drivers[i, stage]
                teeth[MOST_STAGES + stage] = driven[j, stage]
            count += within_limits(teeth, k, rule) and pair_up(teeth, k, rule)
            j += 1
    return count


@njit(cache=True, nogil=True)
def tuples(values: Integers, starts: Integers, counts: Integers, ordered: bool, rows: Gears) -> int:
    """All choices of one value for each stage; returns their number, and writes them while ``rows`` has room.

    Stage i chooses from ``values[starts[i]:starts[i + 1]]``. Not ``ordered``: rising, each multiset once. Where
    ``counts`` is not empty a value t is taken at most ``counts[t]`` times.
    """
    k = len(starts) - 1
    place = np.zeros(k, np.int64)
    stage, number = 0, 0
    place[0] = starts[0]
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
def combine(
    k: int,
    a: Integers,
    b: Integers,
    mark: Integers,
    ratio: Floats,
    groups: Integers,
    least_size: Integers,
    first: int,
    last: int,
    coaxial: bool,
    rule: Rule,
    shortlist: Found,
    tied: Integers,
) -> None:
    """Trains of one mesh a:b from each stage's list, for the groups ``first`` up to, without, ``last``.

    In a group the stages' lists are ``groups[g, i]`` to ``groups[g, i + 1]``, in the order of the ratio b/a; without
    ``rule.ordered`` they are one list, and every multiset is met once. All stages but one are enumerated and the
    fitting meshes of the last are found by bisection. ``least_size`` of the groups must not fall. ``coaxial``: the
    pairing is what it is, and of the places of the meshes one choice counts; else only the pairing that ``pair_up``
    would choose counts, so that gears are met once.

    With fractions in the rows of ``tied`` nothing is entered, but the trains of exactly these ratios are counted.
    """
    teeth, canonical = np.zeros(3 * MOST_STAGES, np.int64), np.zeros(3 * MOST_STAGES, np.int64)
    place = np.zeros(MOST_STAGES + 1, np.int64)
    capacity = len(shortlist.error)
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
            up, down, so_far, gears, widest = 1, 1, 1.0, 0, 0
            for i in range(k - 1):
                up *= b[place[i]]
                down *= a[place[i]]
                so_far *= ratio[place[i]]
                gears += a[place[i]] + b[place[i]]
                widest = max(widest, a[place[i]], b[place[i]])
            wanted = rule.target / so_far
            low = begin if rule.ordered or k == 1 else place[k - 2]
            middle, top = low, end
            while middle < top:
                half = (middle + top) // 2
                if ratio[half] < wanted:
                    middle = half + 1
                else:
                    top = half
            for upward in range(2):
                j = middle if upward else middle - 1
                while low <= j < end:
                    full = shortlist.kept[0] == capacity
                    if rule.by_size:
                        ranked = 0.0 if full and least_size[g] > shortlist.size[capacity - 1] else np.inf
                    else:
                        ranked = shortlist.error[capacity - 1] if full else np.inf
                    if len(tied) > 0:
                        ranked = front = shortlist.error[0]
                    if abs(ratio[j] - wanted) > _window(ranked, front, rule.tolerance) * wanted:
                        break
                    e = error_of(up * b[j], down * a[j], rule.target, rule.target_rest)
                    size = max(widest, a[j], b[j]) if rule.largest else gears + a[j] + b[j]
                    wanted_tie = False
                    for t in range(len(tied)):
                        common = divisor(up * b[j], down * a[j])
                        if up * b[j] // common == tied[t, 0] and down * a[j] // common == tied[t, 1]:
                            wanted_tie = True
                    few = size < len(shortlist.least_error)
                    if wanted_tie or (
                        len(tied) == 0 and few and e <= rule.tolerance and worth(e, size, shortlist, rule.by_size)
                    ):
                        place[k - 1] = j
                        for i in range(k):
                            teeth[i], teeth[MOST_STAGES + i] = a[place[i]], b[place[i]]
                            teeth[2 * MOST_STAGES + i] = mark[place[i]]
                        sound = within_limits(teeth, k, rule)
                        if sound and not coaxial and not rule.ordered:
                            for i in range(2 * MOST_STAGES):
                                canonical[i] = teeth[i]
                            sort(canonical, 0, k)
                            sort(canonical, MOST_STAGES, k)
                            sound = pair_up(canonical, k, rule) and same_meshes(teeth, canonical, k)
                        elif sound and rule.ordered:
                            sound = foremost(teeth, k, rule, coaxial)
                        if sound and wanted_tie:
                            shortlist.ties[0] += 1
                        elif sound:
                            enter(e, size, teeth, shortlist, rule.by_size)
                            if size <= least_size[g]:
                                front = min(front, e)
                    j += 1 if upward else -1
            stage -= 1
            if stage >= 0:
                place[stage] += 1


@njit(cache=True, nogil=True)
def sort(teeth: Integers, start: int, count: int) -> None:
    """Put some of the numbers into rising order, in place."""
    for i in range(start + 1, start + count):
        value, j = teeth[i], i
        while j > start and teeth[j - 1] > value:
            teeth[j] = teeth[j - 1]
            j -= 1
        teeth[j] = value


@njit(cache=True, nogil=True)
def same_meshes(one: Integers, other: Integers, k: int) -> bool:
    """Whether two trains have the same meshes in any order."""
    used = np.zeros(MOST_STAGES, np.bool_)
    for i in range(k):
        met = False
        for j in range(k):
            if not used[j] and not met and one[i] == other[j] and one[MOST_STAGES + i] == other[MOST_STAGES + j]:
                used[j] = met = True
        if not met:
            return False
    return True
