"""Rules for candidate trains, and the permitted pairings of the gears of a train, compiled.

A train is an array of a₁...a₄ b₁...b₄ (drivers and driven gears) and marks₁...₄ of the stages, 0 for no stage.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers
from kinematics.compiling import njit

MAX_STAGES = 4
"""Maximum number of stages of a train."""


class Rule(NamedTuple):
    """The constraints on a candidate train, and the ranking of candidates.

    With ``by_mesh``, ``allowed[a, b]`` are the permitted meshes. With ``by_stock``, ``stock[t]`` is the number of gears
    with t teeth. With ``by_stage``, stage i may only have the meshes of ``of_stage[i]``. With ``with_idler``, an idler
    is placed between the gears of one stage with a pair from ``idled``. The idler must mesh soundly (``sound``) with
    both gears and uses one more gear of the stock. ``most_total`` bounds the sum of all teeth. With ``ordered``, stages
    have ranges of their own, from ``least[i]`` to ``most[i]`` for place i of a train's teeth. ``by_size`` ranks the
    smallest trains first, otherwise the nearest. With ``largest``, the size of a train is its largest gear, otherwise
    the sum of all teeth. Gears change places only between stages of equal ``likeness``.
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
    by_stage: bool
    of_stage: NDArray[np.bool_]
    with_idler: bool
    sound: NDArray[np.bool_]
    idled: NDArray[np.bool_]
    by_stock: bool
    stock: Integers
    most_total: int
    likeness: Integers


@njit(cache=True, nogil=True)
def is_within_limits(teeth: Integers, k: int, rule: Rule) -> bool:
    """Return whether there are enough gears of each tooth number, and the sum of all teeth is small enough."""
    total = 0
    for i in range(k):
        total += teeth[i] + teeth[MAX_STAGES + i]
    if total > rule.most_total:
        return False
    if rule.by_stock:
        for i in range(2 * k):
            one = teeth[i] if i < k else teeth[MAX_STAGES + i - k]
            same = 0
            for j in range(2 * k):
                other = teeth[j] if j < k else teeth[MAX_STAGES + j - k]
                same += one == other
            if same > rule.stock[one]:
                return False
    return True


@njit(cache=True, nogil=True)
def can_take_idler(teeth: Integers, k: int, rule: Rule) -> bool:
    """Return whether an available idler can be placed in a stage, with all other stages allowed without one."""
    for stage in range(k):
        a, b = teeth[stage], teeth[MAX_STAGES + stage]
        others = True
        for j in range(k):
            others = others and (j == stage or rule.allowed[teeth[j], teeth[MAX_STAGES + j]])
        if not others or not rule.idled[a, b]:
            continue
        if not rule.by_stock:
            return True
        for idler in range(len(rule.stock)):
            if rule.stock[idler] > 0 and rule.sound[a, idler] and rule.sound[idler, b]:
                # The train itself may use up the gears that the idler would need.
                spare = rule.stock[idler]
                for j in range(k):
                    spare -= (teeth[j] == idler) + (teeth[MAX_STAGES + j] == idler)
                if spare > 0:
                    return True
    return False


@njit(cache=True, nogil=True)
def is_allowed(teeth: Integers, k: int, rule: Rule) -> bool:
    """Return whether all stages of a train are allowed in its present pairing."""
    if not rule.by_mesh:
        return True
    for i in range(k):
        a, b = teeth[i], teeth[MAX_STAGES + i]
        if not (rule.allowed[a, b] or (rule.with_idler and rule.idled[a, b])):
            return False
        if rule.by_stage and not rule.of_stage[i, a, b]:
            return False
    return not rule.with_idler or can_take_idler(teeth, k, rule)


@njit(cache=True, nogil=True)
def compute_widest_ratio(teeth: Integers, k: int) -> float:
    """Return the largest stage ratio, larger over smaller gear. Equal ratios give equal floats (one rounding each)."""
    ratio = 1.0
    for i in range(k):
        a, b = teeth[i], teeth[MAX_STAGES + i]
        ratio = max(ratio, max(a, b) / min(a, b))
    return ratio


@njit(cache=True, nogil=True)
def count_orders(k: int) -> int:
    """Return the number of orders of k things."""
    count = 1
    for i in range(2, k + 1):
        count *= i
    return count


@njit(cache=True, nogil=True)
def reorder_gears(teeth: Integers, start: int, k: int, order: int, moved: Integers) -> None:
    """Write k of the numbers, from ``start`` on, in one of their orders; order 0 is the present one."""
    for i in range(k):
        moved[start + i] = teeth[start + i]
    # The digits of the order in the factorial number system select the numbers one by one.
    for i in range(k):
        rest = count_orders(k - 1 - i)
        chosen, order = start + i + order // rest, order % rest
        value = moved[chosen]
        for j in range(chosen, start + i, -1):
            moved[j] = moved[j - 1]
        moved[start + i] = value


@njit(cache=True, nogil=True)
def is_in_ranges(teeth: Integers, start: int, k: int, rule: Rule) -> bool:
    """Return whether the drivers, or the driven gears, of a train lie within the ranges of their places."""
    inside = True
    for i in range(start, start + k):
        inside = inside and rule.least[i] <= teeth[i] <= rule.most[i]
    return inside


@njit(cache=True, nogil=True)
def is_among_alike(k: int, order: int, likeness: Integers, moved: Integers) -> bool:
    """Return whether an order only moves things between like stages; ``moved`` is written to."""
    moved[:k] = likeness[:k]
    reorder_gears(likeness, 0, k, order, moved)
    alike = True
    for i in range(k):
        alike = alike and moved[i] == likeness[i]
    return alike


@njit(cache=True, nogil=True)
def is_foremost(teeth: Integers, k: int, rule: Rule, coaxial: bool) -> bool:
    """Return whether a train represents all trains with its gears (if ``coaxial``, its meshes) in other places.

    Among the trains within the ranges, the representative has the smallest maximum stage ratio. Ties are broken by the
    lexicographically smallest tooth numbers.
    """
    if not is_allowed(teeth, k, rule):
        return False
    own, count = compute_widest_ratio(teeth, k), count_orders(k)
    other, alike = np.zeros(3 * MAX_STAGES, np.int64), np.zeros(MAX_STAGES, np.int64)
    for order in range(count):
        reorder_gears(teeth, 0, k, order, other)
        if not is_among_alike(k, order, rule.likeness, alike) or not is_in_ranges(other, 0, k, rule):
            continue
        reorder_gears(teeth, 2 * MAX_STAGES, k, order, other)
        # Coaxial meshes move as a whole; otherwise drivers and driven gears move independently.
        for mates in range(order if coaxial else 0, order + 1 if coaxial else count):
            reorder_gears(teeth, MAX_STAGES, k, mates, other)
            if not is_among_alike(k, mates, rule.likeness, alike):
                continue
            if not is_in_ranges(other, MAX_STAGES, k, rule) or not is_allowed(other, k, rule):
                continue
            ratio = compute_widest_ratio(other, k)
            if ratio > own:
                continue
            if ratio < own:
                return False
            # Among equal ratios the lexicographically smallest arrangement represents the rest.
            for i in range(len(teeth)):
                if other[i] != teeth[i]:
                    if other[i] < teeth[i]:
                        return False
                    break
    return True


@njit(cache=True, nogil=True)
def arrange_pairs(teeth: Integers, k: int, rule: Rule) -> bool:
    """Reorder the driven gears of a train for the smallest maximum stage ratio; return False if no order is allowed.

    Without ranges by place, drivers and driven gears are passed in rising order, the pairing with the smallest maximum
    stage ratio. If this is not allowed, the other orders are tried. With ranges, every order is passed separately, and
    only the representative counts (:func:`is_foremost`).
    """
    if rule.ordered:
        return is_foremost(teeth, k, rule, False)
    if is_allowed(teeth, k, rule):
        return True
    # The present order was not allowed: try all others.
    trial, best = teeth.copy(), teeth.copy()
    least = np.inf
    for order in range(1, count_orders(k)):
        reorder_gears(teeth, MAX_STAGES, k, order, trial)
        if is_allowed(trial, k, rule) and compute_widest_ratio(trial, k) < least:
            least = compute_widest_ratio(trial, k)
            best[:] = trial
    teeth[:] = best
    return least < np.inf
