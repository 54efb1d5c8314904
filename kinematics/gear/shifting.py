"""Profile shifts of external pairs, compiled: which sums of shifts a pair can have, and how a sum is best split.

All lengths are in modules. At the working pressure angle φ_w a pair of z₁, z₂ teeth without play has the shifts

    Σ = (z₁ + z₂) (inv φ_w − inv φ) / (2 tan φ),        C = (z₁ + z₂) cos φ / (2 cos φ_w),

and its tips are shortened by Σ − (C − C₀), so that the clearance stays. Of a split x₁ + x₂ = Σ the *margin* is the
least of what is left of its demands: flank above the base circle (undercut) and below the mate's tip (fillet
interference) of both gears, path of contact, tip thickness, addendum. For a given sum each of them is a concave or a
monotonic function of x₁ as long as both gears keep an addendum: so the splits that keep all demands are an interval,
and their margin has one maximum, which golden sections find. The balanced split has the same greatest specific sliding
on both flanks, a difference that falls with x₁: the split nearest to it is that split or an end of the interval.

Over a range of sums the margin of the best split may rise and fall more than once: the sums that suit are a list of
intervals. They are found on a grid, about every local maximum and minimum of it, and by bisection of every change.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from kinematics.gear.teeth import involute, tangent_of_involute

KEPT = 1e-10
"""Margin by which a demand may be missed, in modules: rounding must not condemn pairs that are on a limit."""

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)

SECTIONS = 52
"""Golden sections of an interval: 1e-11 of it remains."""

STEEP = 6.0
"""A bound of how fast a margin changes with a shift is 2 / sin φ of the ends of involutes, and this of thick tips."""

TOLD = 1e-5
"""To how many modules a margin is known that is compared with others'."""

NARROW = 1e-6
"""Sums of shifts nearer to one another than this are not told apart in search of a greatest or least margin."""

SUMS = 32
"""Parts into which a range of sums is divided in search of those that suit."""

HALVINGS = 28
"""Halvings of an interval of sums at whose one end no split suits: 1e-9 modules of it remain."""


class Demands(NamedTuple):
    """What a pair has to keep; shifts, depth and thickness in modules, the angle in radians.

    ``depth``: how far below its reference line the straight flank of the cutting rack reaches. Of helical teeth all are
    those of the plane of rotation, where the ``addendum`` is less than a module.
    """

    pressure_angle: float
    depth: float
    least_shift: float
    most_shift: float
    contact_ratio: float
    tip_thickness: float
    addendum: float = 1.0


class Working(NamedTuple):
    """A pair at its distance: the sum of shifts, distance, shortening of the tips, and the line of action C sin φ_w."""

    total: float
    distance: float
    shortening: float
    line: float


class Rack(NamedTuple):
    """Of the pressure angle φ: sine and cosine, 4 tan φ by which a shift thickens a tooth, and inv φ."""

    sine: float
    cosine: float
    slope: float
    involute: float


inv, _tangent = njit(cache=True, nogil=True)(involute), njit(cache=True, nogil=True)(tangent_of_involute)


@njit(cache=True, nogil=True)
def _rack(demands: Demands) -> Rack:
    phi = demands.pressure_angle
    return Rack(math.sin(phi), math.cos(phi), 4.0 * math.tan(phi), inv(phi))


@njit(cache=True, nogil=True)
def at_distance(teeth: int, mate: int, distance: float, demands: Demands) -> Working:
    """The pair at a centre distance; a sum of nan where the base circles do not part."""
    phi = demands.pressure_angle
    standard = 0.5 * (teeth + mate)
    if not standard * math.cos(phi) < distance:
        return Working(math.nan, distance, math.nan, math.nan)
    cosine = standard * math.cos(phi) / distance
    working = math.acos(cosine)
    total = (teeth + mate) * (inv(working) - inv(phi)) / (2.0 * math.tan(phi))
    return Working(total, distance, max(0.0, total - (distance - standard)), distance * math.sin(working))


@njit(cache=True, nogil=True)
def with_sum(teeth: int, mate: int, total: float, demands: Demands) -> Working:
    """The pair of a sum of shifts; a distance of nan where no distance takes it up."""
    phi = demands.pressure_angle
    value = inv(phi) + 2.0 * math.tan(phi) * total / (teeth + mate)
    if not value > 0.0:
        return Working(total, math.nan, math.nan, math.nan)
    t = _tangent(value)
    standard = 0.5 * (teeth + mate)
    distance = standard * math.cos(phi) * math.sqrt(1.0 + t * t)
    return Working(total, distance, max(0.0, total - (distance - standard)), standard * math.cos(phi) * t)


@njit(cache=True, nogil=True)
def margin(teeth: int, mate: int, working: Working, shift: float, demands: Demands) -> float:
    """The margin of a split; ``shift`` is that of the first gear."""
    return _margin(teeth, mate, working, shift, demands, _rack(demands))


@njit(cache=True, nogil=True)
def _margin(teeth: int, mate: int, working: Working, shift: float, demands: Demands, rack: Rack) -> float:
    other = working.total - shift
    sine, cosine = rack.sine, rack.cosine
    base, mate_base = 0.5 * teeth * cosine, 0.5 * mate * cosine
    heads = demands.addendum + shift - working.shortening, demands.addendum + other - working.shortening
    tip, mate_tip = 0.5 * teeth + heads[0], 0.5 * mate + heads[1]
    least = min(heads[0], heads[1])
    if not least >= -KEPT:
        return least
    # From the tangent points on: where the involutes begin, and how far out the tips are.
    form = 0.5 * teeth * sine - (demands.depth - shift) / sine
    mate_form = 0.5 * mate * sine - (demands.depth - other) / sine
    reach = math.sqrt(max(tip * tip - base * base, 0.0))
    mate_reach = math.sqrt(max(mate_tip * mate_tip - mate_base * mate_base, 0.0))
    least = min(least, form, mate_form, working.line - mate_reach - form, working.line - reach - mate_form)
    least = min(least, reach + mate_reach - working.line - demands.contact_ratio * math.pi * cosine)
    # inv φ at a tip is reach / base − atan(reach / base).
    sharper = rack.involute - reach / base + math.atan(reach / base)
    mate_sharper = rack.involute - mate_reach / mate_base + math.atan(mate_reach / mate_base)
    thick = tip * ((math.pi + rack.slope * shift) / teeth + 2.0 * sharper)
    mate_thick = mate_tip * ((math.pi + rack.slope * other) / mate + 2.0 * mate_sharper)
    return min(least, thick - demands.tip_thickness, mate_thick - demands.tip_thickness)


@njit(cache=True, nogil=True)
def _span(working: Working, demands: Demands) -> tuple[float, float]:
    """The shifts of the first gear at which both are within the limits and keep an addendum; nan: none are."""
    total, head = working.total, working.shortening - demands.addendum
    low = max(demands.least_shift, total - demands.most_shift, head)
    high = min(demands.most_shift, total - demands.least_shift, total - head)
    if not low <= high + 2.0 * KEPT:
        return math.nan, math.nan
    return min(low, high), max(low, high)


@njit(cache=True, nogil=True)
def best_split(teeth: int, mate: int, working: Working, demands: Demands, enough: float) -> tuple[float, float]:
    """The shift of the first gear with the greatest margin, and that margin.

    It is looked for until a margin is ``enough``, or no split can be sound: then the margin tells no more than its
    sign. With an infinite ``enough`` it is looked for until it is known to :data:`TOLD`, and its sign surely.
    """
    low, high = _span(working, demands)
    if not low <= high:
        return math.nan, -math.inf
    rack = _rack(demands)
    steepest = 2.0 / rack.sine + STEEP
    one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    left = _margin(teeth, mate, working, one, demands, rack)
    right = _margin(teeth, mate, working, other, demands, rack)
    for _ in range(SECTIONS):
        most, rest = max(left, right), steepest * (high - low)
        if most >= enough or (most + rest < -KEPT and (enough < math.inf or rest < TOLD)):
            break
        if rest < TOLD and enough == math.inf and most >= -KEPT:
            break
        if left < right:
            low, one, left = one, other, right
            other = low + GOLDEN * (high - low)
            right = _margin(teeth, mate, working, other, demands, rack)
        else:
            high, other, right = other, one, left
            one = high - GOLDEN * (high - low)
            left = _margin(teeth, mate, working, one, demands, rack)
    return (one, left) if left > right else (other, right)


@njit(cache=True, nogil=True)
def suits(teeth: int, mate: int, working: Working, demands: Demands) -> bool:
    """Whether a split of the sum keeps all demands."""
    return best_split(teeth, mate, working, demands, -KEPT)[1] >= -KEPT


@njit(cache=True, nogil=True)
def _excess(teeth: int, mate: int, working: Working, shift: float, demands: Demands) -> float:
    """By how much the first flank's greatest specific sliding is larger; it falls with the shift of the first gear."""
    cosine = math.cos(demands.pressure_angle)
    base, mate_base = 0.5 * teeth * cosine, 0.5 * mate * cosine
    tip = 0.5 * teeth + demands.addendum + shift - working.shortening
    mate_tip = 0.5 * mate + demands.addendum + working.total - shift - working.shortening
    reach = math.sqrt(max(tip * tip - base * base, 0.0))
    mate_reach = math.sqrt(max(mate_tip * mate_tip - mate_base * mate_base, 0.0))
    # u₂ z₁ / (u₁ z₂) against u₁ z₂ / (u₂ z₁), multiplied out: beyond the tangent points it goes on in the same sense.
    own, other = working.line - mate_reach, working.line - reach
    return mate_reach * other * teeth * teeth - reach * own * mate * mate


@njit(cache=True, nogil=True)
def balanced_split(teeth: int, mate: int, working: Working, demands: Demands) -> float:
    """Of the splits that keep all demands the one nearest to balanced specific sliding; nan: none keeps them.

    Returns
    -------
    float
        The shift of the first gear; the second has the rest of the sum.
    """
    sound, most = best_split(teeth, mate, working, demands, 1e-6)
    if not most >= -KEPT:
        return math.nan
    low, high = _span(working, demands)
    if _excess(teeth, mate, working, low, demands) <= 0.0:
        wanted = low
    elif _excess(teeth, mate, working, high, demands) >= 0.0:
        wanted = high
    else:
        for _ in range(60):
            middle = 0.5 * (low + high)
            if _excess(teeth, mate, working, middle, demands) > 0.0:
                low = middle
            else:
                high = middle
        wanted = 0.5 * (low + high)
    if margin(teeth, mate, working, wanted, demands) >= -KEPT:
        return wanted
    for _ in range(60):
        middle = 0.5 * (sound + wanted)
        if margin(teeth, mate, working, middle, demands) >= -KEPT:
            sound = middle
        else:
            wanted = middle
    return sound


@njit(cache=True, nogil=True)
def _of_sum(teeth: int, mate: int, total: float, demands: Demands, enough: float) -> float:
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
def _looked_at(teeth: int, mate: int, low: float, high: float, demands: Demands) -> NDArray[np.float64]:
    """Sums in rising order, between which the margin passes its limit once at most; rows of a sum and its margin."""
    sums = _grid(low, high)
    n = len(sums)
    margins = np.array([_of_sum(teeth, mate, total, demands, math.inf) for total in sums])
    seen = np.empty((2 * n, 2))
    seen[:n, 0], seen[:n, 1] = sums, margins
    count = n
    for i in range(n):
        if margins[i] == -math.inf:
            continue
        before, after = max(0, i - 1), min(n - 1, i + 1)
        sound = margins[i] >= -KEPT
        sign = -1.0 if sound else 1.0
        if sign * margins[i] < max(sign * margins[before], sign * margins[after]):
            continue
        if sound and (before == i or after == i):
            # A margin that is least at an end of the range hides nothing beyond it.
            continue
        total = _peak(teeth, mate, sums[before], sums[after], sign, demands)
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
    for _ in range(HALVINGS):
        middle = 0.5 * (sound + end)
        if _of_sum(teeth, mate, middle, demands, -KEPT) >= -KEPT:
            sound = middle
        else:
            end = middle
    return sound


@njit(cache=True, nogil=True)
def sum_that_suits(teeth: int, mate: int, low: float, high: float, demands: Demands) -> float:
    """A sum of shifts between ``low`` and ``high`` that suits a pair; nan: none does."""
    # From no shift on, where most pairs are sound, then all over the range.
    at = min(max(0.0, low), high)
    if _of_sum(teeth, mate, at, demands, -KEPT) >= -KEPT:
        return at
    for total in _grid(low, high):
        if _of_sum(teeth, mate, total, demands, -KEPT) >= -KEPT:
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
        sound = _of_sum(teeth, mate, low, demands, -KEPT) >= -KEPT
        return np.full((1, 2), low) if sound else np.empty((0, 2))
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
