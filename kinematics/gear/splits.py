"""Feasibility and margin of the splits of a sum of profile shifts, by slopes, compiled; lengths in modules.

Golden sections (:func:`~kinematics.gear.shifting.find_best_split`) need some thirty margins per sum, and a search over
sums examines hundreds. The margin of each constraint is concave in the split x, except the two distances from a fillet,
which are convex and monotonic over the interval of splits. If a split x violates a constraint whose margin rises with
x, all smaller splits violate it too, and so do larger ones as far as the tangent (for a convex margin, the steepest
slope) reaches: a few splits decide feasibility. In the same way the tangents bound the maximum margin from above, and
the splits where they meet bound it from below.

Both agree with golden sections: closer to a limit than :data:`CLEAR_MARGIN` they leave the decision to those.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from kinematics.compiling import njit
from kinematics.gear.shifting import (
    MARGIN_RESOLUTION,
    MARGIN_TOLERANCE,
    Margins,
    PairConstraints,
    Rack,
    Tips,
    Working,
    bound_splits,
    compute_margins,
)

CLEAR_MARGIN = 1e-9
"""Margin above which golden sections find a feasible split too: they come within 1e-10 of the maximum."""

ROUNDING_ERROR = 1e-12
"""Bound, modules, for the effect of rounding on a margin or an end of an interval; the actual effect is about 1e-14."""

MAX_STEPS = 40
"""Number of splits tried before the decision is left to golden sections."""


FILLET_INDICES = (4, 5)
"""Indices of the convex margins."""


class Slopes(NamedTuple):
    """Slope of each margin over the split; for fillets the steepest slope within the interval."""

    head: float
    mate_head: float
    form: float
    mate_form: float
    fillet: float
    mate_fillet: float
    contact: float
    thick: float
    mate_thick: float


class MarginBounds(NamedTuple):
    """Bounds ``least`` and ``most`` of the maximum margin over all splits of a sum; ``split`` attains the lower one.

    An infinite ``split`` means that the margin is too close to a limit to decide its sign.
    """

    least: float
    most: float
    split: float


@njit(cache=True, nogil=True)
def _compute_slopes(
    teeth: int,
    mate: int,
    left: Margins,
    tips: Tips,
    low: float,
    high: float,
    split: float,
    demands: PairConstraints,
    rack: Rack,
) -> Slopes:
    """Compute the slopes of all margins at a split of the interval from ``low`` to ``high``."""
    base, mate_base = 0.5 * teeth * rack.cosine, 0.5 * mate * rack.cosine
    # The distance from the mate's fillet is steepest where the tip reaches deepest: 1 / sin φ − tip / reach.
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
def find_sound_split(
    teeth: int, mate: int, working: Working, demands: PairConstraints, rack: Rack, guess: float
) -> float:
    """Find a feasible split of the sum; nan if there is none, infinite if it is too close to a limit to decide.

    Parameters
    ----------
    guess : float
        A split to begin with; nan for the middle.
    """
    low, high = bound_splits(working, demands)
    if not low <= high:
        return math.nan
    split = guess if low <= guess <= high else 0.5 * (low + high)
    # Only violations beyond rounding may exclude splits.
    missed = -MARGIN_TOLERANCE - ROUNDING_ERROR
    for _ in range(MAX_STEPS):
        left, tips = compute_margins(teeth, mate, working, split, demands, rack)
        least = math.inf
        for value in left:
            least = min(least, value)
        if least >= CLEAR_MARGIN - MARGIN_TOLERANCE:
            return split
        # Between the tolerance and CLEAR_MARGIN the decision is left to golden sections.
        if least >= missed:
            break
        slopes = _compute_slopes(teeth, mate, left, tips, low, high, split, demands, rack)
        first, last = low, high
        for number in range(len(left)):
            # Each violated margin excludes splits up to where its tangent reaches the limit.
            value, slope = left[number], slopes[number]
            if value >= missed:
                continue
            if slope > 0.0:
                first = max(first, split - (value - missed) / slope)
            elif slope < 0.0:
                last = min(last, split - (value - missed) / slope)
            else:
                return math.nan
        # The excluded ranges overlap: no split is left.
        if first > last + ROUNDING_ERROR:
            return math.nan
        if first > last:
            break
        low, high = first, last
        split = 0.5 * (low + high)
    return math.inf


@njit(cache=True, nogil=True)
def bound_greatest_margin(
    teeth: int, mate: int, working: Working, demands: PairConstraints, rack: Rack, guess: float
) -> MarginBounds:
    """Bound the maximum margin over all splits of a sum to within :data:`MARGIN_RESOLUTION`, and decide its sign.

    Parameters
    ----------
    guess : float
        A split to begin with; nan for the middle.
    """
    low, high = bound_splits(working, demands)
    if not low <= high:
        return MarginBounds(-math.inf, -math.inf, math.nan)
    split = guess if low <= guess <= high else 0.5 * (low + high)
    best, most, at = -math.inf, math.inf, split
    # Tangents at both ends of the remaining interval bound the margin from above.
    rise, fall = math.inf, -math.inf
    rising, falling = math.inf, math.inf
    for _ in range(MAX_STEPS):
        left, tips = compute_margins(teeth, mate, working, split, demands, rack)
        slopes = _compute_slopes(teeth, mate, left, tips, low, high, split, demands, rack)
        least, slope = math.inf, 0.0
        for number in range(len(left)):
            if left[number] < least:
                least, slope = left[number], slopes[number]
        if least > best:
            best, at = least, split
        # A horizontal tangent of a concave margin is its maximum.
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
            # Next try the intersection of both tangents, where the upper bound is attained.
            following = low + (falling - rising - fall * (high - low)) / (rise - fall)
            most = min(most, rising + rise * (following - low))
        # Margins with the opposite slope bound the maximum too; those of fillets, being convex, by their value.
        for number in range(len(left)):
            if slope != 0.0 and slopes[number] * slope <= 0.0:
                own = 0.0 if number in FILLET_INDICES else slopes[number]
                away = (left[number] - least) / (slope - own)
                bound = least + slope * away
                if bound < most:
                    most, following = bound, split + away
        if most - best <= 0.5 * MARGIN_RESOLUTION and (
            most < -MARGIN_TOLERANCE - CLEAR_MARGIN or best >= CLEAR_MARGIN - MARGIN_TOLERANCE
        ):
            return MarginBounds(best, most, at)
        if not low < high:
            break
        split = min(max(following, low), high)
        # A repeated split would not shrink the interval.
        if split in (low, high):
            split = 0.5 * (low + high)
    return MarginBounds(best, most, math.inf)
