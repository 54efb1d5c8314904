"""Profile shifts of external pairs, compiled: the mesh of a sum of shifts, and the best split of a sum.

All lengths are in modules. At the working pressure angle φ_w a pair of z₁, z₂ teeth without play has the shifts

    Σ = (z₁ + z₂) (inv φ_w − inv φ) / (2 tan φ),        C = (z₁ + z₂) cos φ / (2 cos φ_w),

and its tips are shortened by Σ − (C − C₀), so that the clearance stays. The *margin* of a split x₁ + x₂ = Σ is the
minimum over the margins of its constraints: flank above the base circle (undercut) and below the mate's tip (fillet
interference) of both gears, path of contact, tip thickness, addendum. For a given sum each of them is a concave or a
monotonic function of x₁ as long as both gears keep an addendum. So the feasible splits form an interval, and their
margin has a single maximum, which golden sections find. The balanced split has equal maximum specific sliding on both
flanks; the difference falls with x₁, so the nearest feasible split is that split or an end of the interval.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from kinematics.compiling import njit
from kinematics.gear.teeth import invert_involute_tangent, involute

MARGIN_TOLERANCE = 1e-10
"""Violation of a constraint, in modules, that is tolerated: rounding must not reject pairs that lie on a limit."""

FULL_PRECISION = 4e-16
"""Relative tolerance of tan φ_w for full double precision."""

GOLDEN_RATIO = 0.5 * (math.sqrt(5.0) - 1.0)

GOLDEN_SECTION_STEPS = 52
"""Number of golden sections of an interval: 1e-11 of it remains."""

TIP_SLOPE_BOUND = 6.0
"""Maximum slope of the tip thickness over the shift. Together with 2 / sin φ, the slope of the ends of involutes, it
bounds the slopes of all margins."""

MARGIN_RESOLUTION = 1e-5
"""Accuracy, modules, of a margin that is compared with other margins."""


class PairConstraints(NamedTuple):
    """Constraints on a pair; shifts, depth and thickness in modules, the angle in radians.

    ``depth`` is the depth of the cutting rack's straight flank below its reference line. For helical teeth all values
    refer to the plane of rotation, where the ``addendum`` is less than a module.
    """

    pressure_angle: float
    depth: float
    least_shift: float
    most_shift: float
    contact_ratio: float
    tip_thickness: float
    addendum: float = 1.0


class Working(NamedTuple):
    """A pair at its distance: sum of shifts, distance, shortening of the tips, and length of action C sin φ_w."""

    total: float
    distance: float
    shortening: float
    line: float


class Rack(NamedTuple):
    """Functions of the pressure angle φ: sine, cosine, 4 tan φ (by which shift thickens a tooth), and inv φ."""

    sine: float
    cosine: float
    slope: float
    involute: float


class Margins(NamedTuple):
    """Margin of each constraint for a split, modules; negative if violated.

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
    """Radii of both tips, and their distances from the tangent points along the line of action."""

    radius: float
    mate_radius: float
    reach: float
    mate_reach: float


inv, _tangent = njit(cache=True, nogil=True)(involute), njit(cache=True, nogil=True)(invert_involute_tangent)


@njit(cache=True, nogil=True)
def build_rack(demands: PairConstraints) -> Rack:
    """Build the functions of the constraints' pressure angle."""
    phi = demands.pressure_angle
    return Rack(math.sin(phi), math.cos(phi), 4.0 * math.tan(phi), inv(phi))


@njit(cache=True, nogil=True)
def from_distance(teeth: int, mate: int, distance: float, demands: PairConstraints) -> Working:
    """Return the pair at a centre distance; its sum is nan if the base circles overlap."""
    phi = demands.pressure_angle
    standard = 0.5 * (teeth + mate)
    # The line of action needs a gap between the base circles.
    if not standard * math.cos(phi) < distance:
        return Working(math.nan, distance, math.nan, math.nan)
    cosine = standard * math.cos(phi) / distance
    working = math.acos(cosine)
    total = (teeth + mate) * (inv(working) - inv(phi)) / (2.0 * math.tan(phi))
    return Working(total, distance, max(0.0, total - (distance - standard)), distance * math.sin(working))


@njit(cache=True, nogil=True)
def from_sum(teeth: int, mate: int, total: float, demands: PairConstraints) -> Working:
    """Return the pair with a sum of shifts; its distance is nan if no distance takes up the sum."""
    return from_sum_near(teeth, mate, total, build_rack(demands), 0.0, FULL_PRECISION)[0]


@njit(cache=True, nogil=True)
def from_sum_near(
    teeth: int, mate: int, total: float, rack: Rack, near: float, tolerance: float
) -> tuple[Working, float]:
    """Return the pair with a sum of shifts, and its tan φ_w to a relative tolerance, from a guess if positive."""
    # inv φ_w of the mesh without play.
    value = rack.involute + 0.5 * rack.slope * total / (teeth + mate)
    if not value > 0.0:
        return Working(total, math.nan, math.nan, math.nan), near
    t = _tangent(value, near, tolerance)
    standard = 0.5 * (teeth + mate)
    distance = standard * rack.cosine * math.sqrt(1.0 + t * t)
    return Working(total, distance, max(0.0, total - (distance - standard)), standard * rack.cosine * t), t


@njit(cache=True, nogil=True)
def compute_margin(teeth: int, mate: int, working: Working, shift: float, demands: PairConstraints) -> float:
    """Compute the margin of a split; ``shift`` is that of the first gear."""
    return compute_margin_with_rack(teeth, mate, working, shift, demands, build_rack(demands))


@njit(cache=True, nogil=True)
def compute_margin_with_rack(
    teeth: int, mate: int, working: Working, shift: float, demands: PairConstraints, rack: Rack
) -> float:
    """Compute the margin of a split, given the rack of the constraints."""
    other = working.total - shift
    least = min(demands.addendum + shift - working.shortening, demands.addendum + other - working.shortening)
    # Without an addendum the other margins are neither concave nor monotonic, so the search cannot use them.
    if not least >= -MARGIN_TOLERANCE:
        return least
    left = compute_margins(teeth, mate, working, shift, demands, rack)[0]
    for value in left:
        least = min(least, value)
    return least


@njit(cache=True, nogil=True)
def compute_margins(
    teeth: int, mate: int, working: Working, shift: float, demands: PairConstraints, rack: Rack
) -> tuple[Margins, Tips]:
    """Compute the margins of all constraints for a split, and the tips."""
    other = working.total - shift
    sine, cosine = rack.sine, rack.cosine
    base, mate_base = 0.5 * teeth * cosine, 0.5 * mate * cosine
    heads = demands.addendum + shift - working.shortening, demands.addendum + other - working.shortening
    tip, mate_tip = 0.5 * teeth + heads[0], 0.5 * mate + heads[1]
    # Measured from the tangent points: the starts of the involutes, and the tips.
    form = 0.5 * teeth * sine - (demands.depth - shift) / sine
    mate_form = 0.5 * mate * sine - (demands.depth - other) / sine
    reach = math.sqrt(max(tip * tip - base * base, 0.0))
    mate_reach = math.sqrt(max(mate_tip * mate_tip - mate_base * mate_base, 0.0))
    # inv φ at a tip is reach / base − atan(reach / base).
    sharper = rack.involute - reach / base + math.atan(reach / base)
    mate_sharper = rack.involute - mate_reach / mate_base + math.atan(mate_reach / mate_base)
    thick = tip * ((math.pi + rack.slope * shift) / teeth + 2.0 * sharper)
    mate_thick = mate_tip * ((math.pi + rack.slope * other) / mate + 2.0 * mate_sharper)
    left = Margins(
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
def bound_splits(working: Working, demands: PairConstraints) -> tuple[float, float]:
    """Return the range of shifts of the first gear in which both gears are within their limits and keep an addendum.

    Both ends are nan if there is no such range.
    """
    total, head = working.total, working.shortening - demands.addendum
    # Limits of the second shift, expressed by the first.
    low = max(demands.least_shift, total - demands.most_shift, head)
    high = min(demands.most_shift, total - demands.least_shift, total - head)
    # An interval empty only by rounding still contains its single point.
    if not low <= high + 2.0 * MARGIN_TOLERANCE:
        return math.nan, math.nan
    return min(low, high), max(low, high)


@njit(cache=True, nogil=True)
def find_best_split(
    teeth: int, mate: int, working: Working, demands: PairConstraints, enough: float
) -> tuple[float, float]:
    """Find the shift of the first gear with the maximum margin, and that margin.

    The search stops when a margin reaches ``enough`` or no split can be feasible; then only the sign of the margin is
    meaningful. With an infinite ``enough`` it runs until the margin is known to :data:`MARGIN_RESOLUTION` and its sign
    is certain.
    """
    low, high = bound_splits(working, demands)
    if not low <= high:
        return math.nan, -math.inf
    rack = build_rack(demands)
    steepest = 2.0 / rack.sine + TIP_SLOPE_BOUND
    one, other = high - GOLDEN_RATIO * (high - low), low + GOLDEN_RATIO * (high - low)
    left = compute_margin_with_rack(teeth, mate, working, one, demands, rack)
    right = compute_margin_with_rack(teeth, mate, working, other, demands, rack)
    for _ in range(GOLDEN_SECTION_STEPS):
        # The maximum cannot exceed the best value by more than the steepest slope times the remaining interval.
        most, rest = max(left, right), steepest * (high - low)
        if most >= enough or (most + rest < -MARGIN_TOLERANCE and (enough < math.inf or rest < MARGIN_RESOLUTION)):
            break
        if rest < MARGIN_RESOLUTION and enough == math.inf and most >= -MARGIN_TOLERANCE:
            break
        if left < right:
            low, one, left = one, other, right
            other = low + GOLDEN_RATIO * (high - low)
            right = compute_margin_with_rack(teeth, mate, working, other, demands, rack)
        else:
            high, other, right = other, one, left
            one = high - GOLDEN_RATIO * (high - low)
            left = compute_margin_with_rack(teeth, mate, working, one, demands, rack)
    return (one, left) if left > right else (other, right)


@njit(cache=True, nogil=True)
def _compare_sliding(teeth: int, mate: int, working: Working, shift: float, demands: PairConstraints) -> float:
    """Compare maximum specific sliding: positive if the first flank's is larger; falls with the first gear's shift."""
    cosine = math.cos(demands.pressure_angle)
    base, mate_base = 0.5 * teeth * cosine, 0.5 * mate * cosine
    tip = 0.5 * teeth + demands.addendum + shift - working.shortening
    mate_tip = 0.5 * mate + demands.addendum + working.total - shift - working.shortening
    reach = math.sqrt(max(tip * tip - base * base, 0.0))
    mate_reach = math.sqrt(max(mate_tip * mate_tip - mate_base * mate_base, 0.0))
    # u₂ z₁ / (u₁ z₂) against u₁ z₂ / (u₂ z₁), multiplied out so that it stays monotonic beyond the tangent points.
    own, other = working.line - mate_reach, working.line - reach
    return mate_reach * other * teeth * teeth - reach * own * mate * mate


@njit(cache=True, nogil=True)
def find_balanced_split(teeth: int, mate: int, working: Working, demands: PairConstraints) -> float:
    """Find the feasible split nearest to balanced specific sliding; nan if none is feasible.

    Returns
    -------
    float
        The shift of the first gear; the second gear has the rest of the sum.
    """
    # Any clearly feasible split serves as the inner end of the bisection.
    sound, most = find_best_split(teeth, mate, working, demands, 1e-6)
    if not most >= -MARGIN_TOLERANCE:
        return math.nan
    low, high = bound_splits(working, demands)
    if _compare_sliding(teeth, mate, working, low, demands) <= 0.0:
        wanted = low
    elif _compare_sliding(teeth, mate, working, high, demands) >= 0.0:
        wanted = high
    else:
        for _ in range(60):
            middle = 0.5 * (low + high)
            if _compare_sliding(teeth, mate, working, middle, demands) > 0.0:
                low = middle
            else:
                high = middle
        wanted = 0.5 * (low + high)
    if compute_margin(teeth, mate, working, wanted, demands) >= -MARGIN_TOLERANCE:
        return wanted
    # The balanced split is infeasible: bisect for the end of the feasible interval on its side.
    for _ in range(60):
        middle = 0.5 * (sound + wanted)
        if compute_margin(teeth, mate, working, middle, demands) >= -MARGIN_TOLERANCE:
            sound = middle
        else:
            wanted = middle
    return sound
