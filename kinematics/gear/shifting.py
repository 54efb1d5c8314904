"""Profile shifts of external pairs, compiled: which sums of shifts a pair can have, and how a sum is best split.

All lengths are in modules. At the working pressure angle φ_w a pair of z₁, z₂ teeth without play has the shifts

    Σ = (z₁ + z₂) (inv φ_w − inv φ) / (2 tan φ),        C = (z₁ + z₂) cos φ / (2 cos φ_w),

and its tips are shortened by Σ − (C − C₀), so that the clearance stays. Of a split x₁ + x₂ = Σ the *margin* is the
least of what is left of its demands: flank above the base circle (undercut) and below the mate's tip (fillet
interference) of both gears, path of contact, tip thickness, addendum. For a given sum each of them is a concave or a
monotonic function of x₁ as long as both gears keep an addendum: so the splits that keep all demands are an interval,
and their margin has one maximum, which golden sections find. The balanced split has the same greatest specific sliding
on both flanks, a difference that falls with x₁: the split nearest to it is that split or an end of the interval.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from kinematics.compiling import njit
from kinematics.gear.teeth import involute, tangent_of_involute

KEPT = 1e-10
"""Margin by which a demand may be missed, in modules: rounding must not condemn pairs that are on a limit."""

TO_THE_LAST = 4e-16
"""Share to which tan φ_w is told where every digit counts."""

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)

SECTIONS = 52
"""Golden sections of an interval: 1e-11 of it remains."""

STEEP = 6.0
"""A bound of how fast a margin changes with a shift is 2 / sin φ of the ends of involutes, and this of thick tips."""

TOLD = 1e-5
"""To how many modules a margin is known that is compared with others'."""


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


class Left(NamedTuple):
    """What a split leaves of each demand, modules: negative where it is missed.

    Addendum of both gears, flank above the base circles and below the mate's tip, path of contact, thickness of tips.
    """

    head: float
    mate_head: float
    form: float
    mate_form: float
    fillet: float
    mate_fillet: float
    contact: float
    thick: float
    mate_thick: float


class Tips(NamedTuple):
    """Radii of both tips, and how far out they are from the tangent points on the line of action."""

    radius: float
    mate_radius: float
    reach: float
    mate_reach: float


inv, _tangent = njit(cache=True, nogil=True)(involute), njit(cache=True, nogil=True)(tangent_of_involute)


@njit(cache=True, nogil=True)
def rack_of(demands: Demands) -> Rack:
    """What the demands' pressure angle gives."""
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
    return nearby(teeth, mate, total, rack_of(demands), 0.0, TO_THE_LAST)[0]


@njit(cache=True, nogil=True)
def nearby(teeth: int, mate: int, total: float, rack: Rack, near: float, told: float) -> tuple[Working, float]:
    """The pair of a sum of shifts, and its tan φ_w, which is told to a share, from a first value on if one is known."""
    value = rack.involute + 0.5 * rack.slope * total / (teeth + mate)
    if not value > 0.0:
        return Working(total, math.nan, math.nan, math.nan), near
    t = _tangent(value, near, told)
    standard = 0.5 * (teeth + mate)
    distance = standard * rack.cosine * math.sqrt(1.0 + t * t)
    return Working(total, distance, max(0.0, total - (distance - standard)), standard * rack.cosine * t), t


@njit(cache=True, nogil=True)
def margin(teeth: int, mate: int, working: Working, shift: float, demands: Demands) -> float:
    """The margin of a split; ``shift`` is that of the first gear."""
    return margin_of(teeth, mate, working, shift, demands, rack_of(demands))


@njit(cache=True, nogil=True)
def margin_of(teeth: int, mate: int, working: Working, shift: float, demands: Demands, rack: Rack) -> float:
    """The margin of a split with the rack of the demands at hand."""
    other = working.total - shift
    least = min(demands.addendum + shift - working.shortening, demands.addendum + other - working.shortening)
    if not least >= -KEPT:
        return least
    left = what_is_left(teeth, mate, working, shift, demands, rack)[0]
    for value in left:
        least = min(least, value)
    return least


@njit(cache=True, nogil=True)
def what_is_left(
    teeth: int, mate: int, working: Working, shift: float, demands: Demands, rack: Rack
) -> tuple[Left, Tips]:
    """What a split leaves of every demand, and where the tips are."""
    other = working.total - shift
    sine, cosine = rack.sine, rack.cosine
    base, mate_base = 0.5 * teeth * cosine, 0.5 * mate * cosine
    heads = demands.addendum + shift - working.shortening, demands.addendum + other - working.shortening
    tip, mate_tip = 0.5 * teeth + heads[0], 0.5 * mate + heads[1]
    # From the tangent points on: where the involutes begin, and how far out the tips are.
    form = 0.5 * teeth * sine - (demands.depth - shift) / sine
    mate_form = 0.5 * mate * sine - (demands.depth - other) / sine
    reach = math.sqrt(max(tip * tip - base * base, 0.0))
    mate_reach = math.sqrt(max(mate_tip * mate_tip - mate_base * mate_base, 0.0))
    # inv φ at a tip is reach / base − atan(reach / base).
    sharper = rack.involute - reach / base + math.atan(reach / base)
    mate_sharper = rack.involute - mate_reach / mate_base + math.atan(mate_reach / mate_base)
    thick = tip * ((math.pi + rack.slope * shift) / teeth + 2.0 * sharper)
    mate_thick = mate_tip * ((math.pi + rack.slope * other) / mate + 2.0 * mate_sharper)
    left = Left(
        heads[0],
        heads[1],
        form,
        mate_form,
        working.line - mate_reach - form,
        working.line - reach - mate_form,
        reach + mate_reach - working.line - demands.contact_ratio * math.pi * cosine,
        thick - demands.tip_thickness,
        mate_thick - demands.tip_thickness,
    )
    return left, Tips(tip, mate_tip, reach, mate_reach)


@njit(cache=True, nogil=True)
def splits_within(working: Working, demands: Demands) -> tuple[float, float]:
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
    low, high = splits_within(working, demands)
    if not low <= high:
        return math.nan, -math.inf
    rack = rack_of(demands)
    steepest = 2.0 / rack.sine + STEEP
    one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    left = margin_of(teeth, mate, working, one, demands, rack)
    right = margin_of(teeth, mate, working, other, demands, rack)
    for _ in range(SECTIONS):
        most, rest = max(left, right), steepest * (high - low)
        if most >= enough or (most + rest < -KEPT and (enough < math.inf or rest < TOLD)):
            break
        if rest < TOLD and enough == math.inf and most >= -KEPT:
            break
        if left < right:
            low, one, left = one, other, right
            other = low + GOLDEN * (high - low)
            right = margin_of(teeth, mate, working, other, demands, rack)
        else:
            high, other, right = other, one, left
            one = high - GOLDEN * (high - low)
            left = margin_of(teeth, mate, working, one, demands, rack)
    return (one, left) if left > right else (other, right)


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
    low, high = splits_within(working, demands)
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
