"""Whether a sum of profile shifts can be split soundly, and with what margin, by slopes, compiled; lengths in modules.

Golden sections (:func:`~kinematics.gear.shifting.best_split`) need some thirty margins for a sum, and a search over
sums asks for hundreds of sums. What a split x leaves of each demand is concave in x, but for the two distances from a
fillet, which are convex and fall, or rise, all over the interval of splits. So a split that misses a demand which rises
with x condemns all splits before it, and those behind it as far as the tangent goes (of a convex demand as far as its
steepest slope does): a few splits decide whether there is a sound one. In the same way the lines that bound all demands
bound the greatest margin from above, which the splits where they meet bound from below.

Both decide as golden sections do: nearer to a limit than :data:`CLEAR` they leave it to those.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from kinematics.compiling import njit
from kinematics.gear.shifting import (
    KEPT,
    TOLD,
    Demands,
    Left,
    Rack,
    Tips,
    Working,
    splits_within,
    what_is_left,
)

CLEAR = 1e-9
"""Margin beyond its limit from which on golden sections find a sound split too: they come within 1e-10 of the best."""

ROUNDED = 1e-12
"""Modules by which rounding may move a margin, or an end of an interval of splits; it is some 1e-14."""

STEPS = 40
"""Splits that are tried before golden sections are asked."""


FILLETS = (4, 5)
"""Places of the convex demands."""


class Slopes(NamedTuple):
    """How fast what is left of each demand grows with the split; of fillets the steepest within the interval."""

    head: float
    mate_head: float
    form: float
    mate_form: float
    fillet: float
    mate_fillet: float
    contact: float
    thick: float
    mate_thick: float


class Margin(NamedTuple):
    """The greatest margin of all splits of a sum lies between ``least`` and ``most``; ``split`` has the former.

    An infinite ``split`` says that the margin is too near to a limit to tell its sign.
    """

    least: float
    most: float
    split: float


@njit(cache=True, nogil=True)
def _slopes(
    teeth: int, mate: int, left: Left, tips: Tips, low: float, high: float, split: float, demands: Demands, rack: Rack
) -> Slopes:
    base, mate_base = 0.5 * teeth * rack.cosine, 0.5 * mate * rack.cosine
    # The line to the mate's fillet is steepest where the tip is farthest in: 1 / sin φ less tip / reach of that tip.
    far, mate_far = tips.radius + (high - split), tips.mate_radius + (split - low)
    steep = 1.0 / rack.sine - mate_far / math.sqrt(mate_far * mate_far - mate_base * mate_base)
    mate_steep = 1.0 / rack.sine - far / math.sqrt(far * far - base * base)
    return Slopes(
        1.0,
        -1.0,
        1.0 / rack.sine,
        -1.0 / rack.sine,
        -steep,
        mate_steep,
        tips.radius / tips.reach - tips.mate_radius / tips.mate_reach,
        (left.thick + demands.tip_thickness) / tips.radius + rack.slope * tips.radius / teeth - 2.0 * tips.reach / base,
        2.0 * tips.mate_reach / mate_base
        - rack.slope * tips.mate_radius / mate
        - (left.mate_thick + demands.tip_thickness) / tips.mate_radius,
    )


@njit(cache=True, nogil=True)
def sound_split(teeth: int, mate: int, working: Working, demands: Demands, rack: Rack, guess: float) -> float:
    """A split of the sum that keeps all demands; nan: there is none; infinite: too near to a limit to tell.

    Parameters
    ----------
    guess : float
        A split to begin with; nan for the middle.
    """
    low, high = splits_within(working, demands)
    if not low <= high:
        return math.nan
    split = guess if low <= guess <= high else 0.5 * (low + high)
    missed = -KEPT - ROUNDED
    for _ in range(STEPS):
        left, tips = what_is_left(teeth, mate, working, split, demands, rack)
        least = math.inf
        for value in left:
            least = min(least, value)
        if least >= CLEAR - KEPT:
            return split
        if least >= missed:
            break
        slopes = _slopes(teeth, mate, left, tips, low, high, split, demands, rack)
        first, last = low, high
        for number in range(len(left)):
            value, slope = left[number], slopes[number]
            if value >= missed:
                continue
            if slope > 0.0:
                first = max(first, split - (value - missed) / slope)
            elif slope < 0.0:
                last = min(last, split - (value - missed) / slope)
            else:
                return math.nan
        if first > last + ROUNDED:
            return math.nan
        if first > last:
            break
        low, high = first, last
        split = 0.5 * (low + high)
    return math.inf


@njit(cache=True, nogil=True)
def greatest_margin(teeth: int, mate: int, working: Working, demands: Demands, rack: Rack, guess: float) -> Margin:
    """The greatest margin of all splits of a sum, told to :data:`TOLD`, and its sign.

    Parameters
    ----------
    guess : float
        A split to begin with; nan for the middle.
    """
    low, high = splits_within(working, demands)
    if not low <= high:
        return Margin(-math.inf, -math.inf, math.nan)
    split = guess if low <= guess <= high else 0.5 * (low + high)
    best, most, at = -math.inf, math.inf, split
    # The lines that bound the margin from both ends of what is left of the interval: it is no greater than either.
    rise, fall = math.inf, -math.inf
    rising, falling = math.inf, math.inf
    for _ in range(STEPS):
        left, tips = what_is_left(teeth, mate, working, split, demands, rack)
        slopes = _slopes(teeth, mate, left, tips, low, high, split, demands, rack)
        least, slope = math.inf, 0.0
        for number in range(len(left)):
            if left[number] < least:
                least, slope = left[number], slopes[number]
        if least > best:
            best, at = least, split
        if slope == 0.0:
            most = min(most, least)
        elif slope > 0.0:
            low, rising, rise = split, least, slope
            most = min(most, least + slope * (high - split))
        else:
            high, falling, fall = split, least, slope
            most = min(most, least + slope * (low - split))
        following = 0.5 * (low + high)
        if rising < math.inf and falling < math.inf:
            # Where both lines meet.
            following = low + (falling - rising - fall * (high - low)) / (rise - fall)
            most = min(most, rising + rise * (following - low))
        # Demands that go the other way from this split on bound the margin too, those of fillets by their value.
        for number in range(len(left)):
            if slope != 0.0 and slopes[number] * slope <= 0.0:
                own = 0.0 if number in FILLETS else slopes[number]
                away = (left[number] - least) / (slope - own)
                bound = least + slope * away
                if bound < most:
                    most, following = bound, split + away
        if most - best <= 0.5 * TOLD and (most < -KEPT - CLEAR or best >= CLEAR - KEPT):
            return Margin(best, most, at)
        if not low < high:
            break
        split = min(max(following, low), high)
        if split in (low, high):
            split = 0.5 * (low + high)
    return Margin(best, most, math.inf)
