"""Compiled analysis of fourbars, design by design: the formulas of :mod:`circuits` and :mod:`transmission` in scalars.

``pivots`` and ``lengths`` are the blocks of a :class:`Fourbar`, (3, D); ``start`` and ``end`` are absolute input
angles, (M,). One design may be given for all M.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Integers, Mask, Real
from kinematics.compiling import njit
from kinematics.linkage.kernels import OPTIONS

CHANGE_POINT_TOLERANCE = 1e-9
"""|S + L − P − Q| below this share of the perimeter counts as the special case: the transmission angle at such a
change point is then below about 1e-4 rad, where the direction of motion is unreliable."""

TOGGLE_TOLERANCE = 1e-12
"""Distance, radians, within which the end of a motion counts as at a toggle: rounding of an angle after some turns."""

FULL_TURN = 2.0 * math.pi


@njit(**OPTIONS)
def _find_toggle(t: float, a: float, d: float, slack: float) -> tuple[float, bool]:
    """Find |δ| where f = t, and whether f reaches t at all: |d − a| ≤ t ≤ d + a."""
    below, above = t - abs(d - a), (d + a) - t
    # Within the slack of a change point the toggle is taken to lie exactly on the ground line.
    numerator = (below if below > slack else 0.0) * (t + abs(d - a))
    denominator = (above if above > slack else 0.0) * ((d + a) + t)
    return 2.0 * math.atan2(math.sqrt(numerator), math.sqrt(denominator)), below >= -slack and above >= -slack


@njit(**OPTIONS)
def _find_limits(a: float, b: float, c: float, d: float) -> tuple[bool, float, float, bool, bool]:
    """Return whether the linkage can be assembled, the range of |δ|, and whether its ends are toggles."""
    slack = CHANGE_POINT_TOLERANCE * (a + b + c + d)
    folded_angle, folded = _find_toggle(abs(b - c), a, d, slack)
    extended_angle, extended = _find_toggle(b + c, a, d, slack)
    if 2.0 * max(a, b, c, d) > d + a + b + c:
        return False, math.nan, math.nan, False, False
    return True, folded_angle if folded else 0.0, extended_angle if extended else math.pi, folded, extended


@njit(**OPTIONS)
def find_limits(pivots: Complex, lengths: Real, ends: Real, toggles: Mask) -> None:
    """Fill lower and upper limits of |δ| into ``ends`` (2, D), and whether they are toggles into ``toggles`` (2, D)."""
    for i in range(pivots.shape[1]):
        d = abs(pivots[1, i] - pivots[0, i])
        _, ends[0, i], ends[1, i], toggles[0, i], toggles[1, i] = _find_limits(
            lengths[0, i], lengths[1, i], lengths[2, i], d
        )


@njit(**OPTIONS)
def _is_on_branch(a: float, b: float, c: float, d: float, start: float, end: float) -> bool:
    """Return whether the input turns from start to end (from the ground line) without a toggle or change point."""
    free, lower, upper, folded, extended = _find_limits(a, b, c, d)
    low, high = min(start, end), max(start, end)
    for toggle, exists in ((lower, folded), (upper, extended)):
        for sign in (1.0, -1.0):
            turns = math.ceil((low - TOGGLE_TOLERANCE - sign * toggle) / FULL_TURN) if exists else 0.0
            free = free and not (exists and sign * toggle + turns * FULL_TURN <= high + TOGGLE_TOLERANCE)
    # No toggle in between: then one inner point decides whether the range can be assembled.
    middle = 0.5 * (low + high)
    middle = abs(math.atan2(math.sin(middle), math.cos(middle)))
    return bool(free and lower <= middle <= upper)


@njit(**OPTIONS)
def check_branch(pivots: Complex, lengths: Real, start: Real, end: Real, free: Mask) -> None:
    """Fill into ``free`` (M,) whether the input turns from start to end without a toggle or change point."""
    for i in range(len(free)):
        j = i if pivots.shape[1] > 1 else 0
        ground = pivots[1, j] - pivots[0, j]
        ground_angle = math.atan2(ground.imag, ground.real)
        free[i] = _is_on_branch(
            lengths[0, j], lengths[1, j], lengths[2, j], abs(ground), start[i] - ground_angle, end[i] - ground_angle
        )


@njit(**OPTIONS)
def _has_joined_circuits(a: float, b: float, c: float, d: float) -> bool:
    """Return whether the circuits are joined at change points."""
    least, greatest, perimeter = min(d, a, b, c), max(d, a, b, c), d + a + b + c
    low, high = min(max(d, a), max(b, c)), max(min(d, a), min(b, c))
    return abs((greatest - max(low, high)) - (min(low, high) - least)) <= CHANGE_POINT_TOLERANCE * perimeter


@njit(**OPTIONS)
def _find_side(delta: float) -> float:
    """Return the side of the ground line on which the input lies: 1, −1, or 0 on it."""
    sine = math.sin(delta)
    return 1.0 if sine > 0.0 else (-1.0 if sine < 0.0 else 0.0)


@njit(**OPTIONS)
def compare_circuits(
    pivots: Complex, lengths: Real, theta: Real, sign: Real, other: Real, others: Real, same: Mask
) -> None:
    """Fill into ``same`` (M,) whether two valid configurations lie on one circuit."""
    for i in range(len(same)):
        j = i if pivots.shape[1] > 1 else 0
        a, b, c, ground = lengths[0, j], lengths[1, j], lengths[2, j], pivots[1, j] - pivots[0, j]
        ground_angle = math.atan2(ground.imag, ground.real)
        good, _, _, folded, extended = _find_limits(a, b, c, abs(ground))
        if _has_joined_circuits(a, b, c, abs(ground)):
            same[i] = good
        elif not folded and not extended:
            same[i] = good and sign[i] == others[i]
        else:
            one_side = _find_side(theta[i] - ground_angle) == _find_side(other[i] - ground_angle)
            same[i] = good and (not (folded and extended) or one_side)


@njit(**OPTIONS)
def _is_monotone(values: Real) -> bool:
    """Return whether values are strictly monotonic."""
    rising, falling = True, True
    for k in range(1, len(values)):
        rising, falling = rising and values[k] > values[k - 1], falling and values[k] < values[k - 1]
    return rising or falling


@njit(**OPTIONS)
def _cover_shortest(onward: Real) -> None:
    """Shift rotations 0 ≤ ρ < 2π by full turns, in place, into the shortest range that covers all of them."""
    # The shortest cover is the circle without its widest gap.
    around = np.sort(onward)
    widest, end = around[0] + FULL_TURN - around[-1], around[-1]
    for k in range(len(around) - 1, 0, -1):
        if around[k] - around[k - 1] >= widest:
            widest, end = around[k] - around[k - 1], around[k - 1]
    for k in range(len(onward)):
        if onward[k] > end:
            onward[k] -= FULL_TURN


@njit(**OPTIONS)
def _find_limits_around(delta: float, lower: float, upper: float, folded: bool, extended: bool) -> tuple[float, float]:
    """Find the ends of the range of δ, radians, that contains ``delta``, for an input with toggles."""
    if not folded:
        return -upper, upper
    if not extended:
        return lower, FULL_TURN - lower
    return (lower, upper) if math.sin(delta) >= 0.0 else (-upper, -lower)


@njit(**OPTIONS)
def traverse(
    pivots: Complex, lengths: Real, theta: Real, sign: Real, angles: Real
) -> tuple[bool, bool, bool, float, float]:
    """Traverse targets (n,) with one design: on one branch, on one circuit, in order, and the range used.

    The targets' angles, continuous from the first, are written into ``angles`` (n,).
    """
    n, first, last = len(theta), theta[0], len(theta) - 1
    a, b, c, ground = lengths[0, 0], lengths[1, 0], lengths[2, 0], pivots[1, 0] - pivots[0, 0]
    d, ground_angle = abs(ground), math.atan2(ground.imag, ground.real)
    good, lower, upper, folded, extended = _find_limits(a, b, c, d)
    one_assembly = good
    for k in range(n):
        one_assembly = one_assembly and sign[k] == sign[0]
    onward, backward = np.zeros(n), np.zeros(n)
    for k in range(1, n):
        onward[k] = np.mod(theta[k] - first, FULL_TURN)
        backward[k] = onward[k] - FULL_TURN if onward[k] > 0.0 else 0.0
    if one_assembly:
        from_ground = first - ground_angle
        ahead = _is_monotone(onward) and _is_on_branch(a, b, c, d, from_ground, from_ground + onward[last])
        back = _is_monotone(backward) and _is_on_branch(a, b, c, d, from_ground, from_ground + backward[last])
        if ahead or back:
            turned = onward if ahead and (not back or abs(onward[last]) <= abs(backward[last])) else backward
            angles[:] = first + turned
            return True, True, True, first, first + turned[last]
    same, pair = np.empty(1, np.bool_), np.empty((4, 1))
    one_circuit = True
    for k in range(n):
        pair[0, 0], pair[1, 0], pair[2, 0], pair[3, 0] = first, sign[0], theta[k], sign[k]
        compare_circuits(pivots, lengths, pair[0], pair[1], pair[2], pair[3], same)
        one_circuit = one_circuit and same[0]
    if not folded and not extended:
        _cover_shortest(onward)
        angles[:] = first + onward
        return one_assembly, one_circuit, False, angles.min(), angles.max()
    low, high = _find_limits_around(first - ground_angle, lower, upper, folded, extended)
    low, high = low + ground_angle, high + ground_angle
    for k in range(n):
        angle = low + np.mod(theta[k] - low, FULL_TURN)
        angles[k] = angle - FULL_TURN if angle - high > low + FULL_TURN - angle else angle
    start, end = angles.min(), angles.max()
    if one_assembly:
        free = _is_on_branch(a, b, c, d, start - ground_angle, end - ground_angle)
        return free, free or one_circuit, False, start, end
    # Unroll the circuit: forward on the first assembly, through the toggle, back on the other.
    around = 2.0 * (high - low)
    for k in range(n):
        onward[k] = angles[k] - low if sign[k] == sign[0] else around - (angles[k] - low)
    begin = onward[0]
    for k in range(n):
        onward[k] = np.mod(onward[k] - begin, around)
        backward[k] = onward[k] - around if onward[k] > 0.0 else 0.0
    return False, one_circuit, (_is_monotone(onward) or _is_monotone(backward)) and one_circuit, start, end


@njit(**OPTIONS)
def _compute_included_angle(b: float, c: float, f: float) -> float:
    """Compute the angle at B of the triangle with sides b, c and base f; 0 or π for a base too short or too long."""
    numerator = (f + (b - c)) * (f - (b - c))
    denominator = (b + c + f) * (b + c - f)
    return 2.0 * math.atan2(math.sqrt(max(numerator, 0.0)), math.sqrt(max(denominator, 0.0)))


@njit(**OPTIONS)
def _is_angle_in_range(low: float, high: float, angle: float) -> bool:
    """Return whether low ≤ angle + 2πm ≤ high for some integer m."""
    return math.floor((high - angle) / FULL_TURN) >= math.ceil((low - angle) / FULL_TURN)


@njit(**OPTIONS)
def find_extremes(pivots: Complex, lengths: Real, start: Real, end: Real, least: Real, greatest: Real) -> None:
    """Fill the minimum and maximum transmission angle over the ranges of the input, (M,)."""
    for i in range(len(least)):
        j = i if pivots.shape[1] > 1 else 0
        a, b, c, ground = lengths[0, j], lengths[1, j], lengths[2, j], pivots[1, j] - pivots[0, j]
        d, ground_angle = abs(ground), math.atan2(ground.imag, ground.real)
        low, high = min(start[i], end[i]) - ground_angle, max(start[i], end[i]) - ground_angle
        f_low = math.hypot(d - a * math.cos(low), a * math.sin(low))
        f_high = math.hypot(d - a * math.cos(high), a * math.sin(high))
        shortest = abs(d - a) if _is_angle_in_range(low, high, 0.0) else min(f_low, f_high)
        longest = d + a if _is_angle_in_range(low, high, math.pi) else max(f_low, f_high)
        gamma_low, gamma_high = _compute_included_angle(b, c, shortest), _compute_included_angle(b, c, longest)
        acute_low, acute_high = min(gamma_low, math.pi - gamma_low), min(gamma_high, math.pi - gamma_high)
        # The included angle passes 90° inside the range: the acute angle then peaks there.
        square = gamma_low <= 0.5 * math.pi <= gamma_high
        least[i] = min(acute_low, acute_high)
        greatest[i] = 0.5 * math.pi if square else max(acute_low, acute_high)


@njit(**OPTIONS)
def classify_barker(pivots: Complex, lengths: Real, types: Integers) -> None:
    """Fill Barker's type numbers 1 to 14 into ``types`` (D,), 0 for a linkage that cannot be assembled."""
    for i in range(len(types)):
        d, a, b, c = abs(pivots[1, i] - pivots[0, i]), lengths[0, i], lengths[1, i], lengths[2, i]
        least, greatest, perimeter = min(d, a, b, c), max(d, a, b, c), d + a + b + c
        shortest = 0 if d == least else (1 if a == least else (2 if b == least else 3))
        longest = 0 if d == greatest else (1 if a == greatest else (2 if b == greatest else 3))
        # The two middle lengths, ascending.
        low, high = min(max(d, a), max(b, c)), max(min(d, a), min(b, c))
        p, q = min(low, high), max(low, high)
        # Differences first: nearly equal lengths must not cancel.
        excess = (greatest - q) - (p - least)
        equal = CHANGE_POINT_TOLERANCE * perimeter
        if 2.0 * greatest > perimeter:
            types[i] = 0
        elif abs(excess) > equal:
            types[i] = 1 + shortest if excess < 0.0 else 5 + longest
        elif greatest - least <= equal:
            types[i] = 14
        elif p - least <= equal and greatest - q <= equal:
            types[i] = 13
        else:
            types[i] = 9 + shortest
