"""Gears as a rack and a cutter leave them, and how two of them run: no formula of the involute is used.

A point of the blank at the radius ρ, at the angle α in the frame of the machine, is inside a tooth of the rack when the
rack has moved by s with |ρ sin α − s| ≤ w(d), d its depth below the rack's reference line and w half the width of the
rack's tooth there. The blank has turned by s / r meanwhile, so that the space between two teeth has the half angle

    S(ρ) = max over α of  α − (ρ sin α − w(d)) / r.

A ring is cut by a pinion in the same way: on the circle ρ a tooth of the cutter, of half angle T(ρ_c) at its own radius
ρ_c, reaches to α − (β − T) z_c / z. Two finished gears turn in the ratio of their teeth, a tooth of the first in the
middle of a space of the second. The corner of a tip stands some angle off the flank that it passes; the least of that
angle is half the play, and the place where it is reached is the end of contact. Lengths are in modules.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)

DEGREE = 72
"""Of the polynomial that stands for the flank of a cutter."""


class Rack(NamedTuple):
    """Pressure angle, depth of the tooth below the reference line, radius of its rounded tip."""

    angle: float
    depth: float
    rounding: float


def rack(angle: float) -> Rack:
    """The rack of full-depth teeth; its tip is rounded by 0.38 modules, or by as much as it is wide enough for."""
    half_tip = 0.25 * math.pi - 1.25 * math.tan(angle)
    return Rack(angle, 1.25, min(0.38, half_tip / math.tan(0.25 * math.pi - 0.5 * angle)))


class Body(NamedTuple):
    """A gear: teeth, reference radius moved out by the shift, tip radius; of a ring the cutter and its flank.

    ``flank`` are the coefficients of T over √(ρ² − least²), scaled to −1 ... 1; empty for an external gear.
    """

    teeth: int
    shift: float
    tip: float
    rack: Rack
    distance: float
    cutter_teeth: int
    cutter_tip: float
    flank: NDArray[np.float64]


@njit(cache=True, nogil=True)
def _half_width(depth: float, tool: Rack) -> float:
    """Half the width of the rack's tooth; −1 beyond its tip."""
    slope, centre = math.tan(tool.angle), tool.depth - tool.rounding
    straight = centre + tool.rounding * math.sin(tool.angle)
    if depth <= straight:
        return 0.25 * math.pi - depth * slope
    if depth > tool.depth:
        return -1.0
    beside = 0.25 * math.pi - straight * slope - tool.rounding * math.cos(tool.angle)
    return beside + math.sqrt(max(tool.rounding**2 - (depth - centre) ** 2, 0.0))


@njit(cache=True, nogil=True)
def _by_rack(alpha: float, radius: float, teeth: int, shift: float, tool: Rack) -> float:
    r = 0.5 * teeth
    width = _half_width(r + shift - radius * math.cos(alpha), tool)
    return -9.0 if width < 0.0 else alpha - (radius * math.sin(alpha) - width) / r


@njit(cache=True, nogil=True)
def _flank_of_cutter(radius: float, body: Body) -> float:
    """Half the angle of the cutter's tooth; below its base circle the flank is radial."""
    least = 0.5 * body.cutter_teeth * math.cos(body.rack.angle)
    most = math.sqrt(body.cutter_tip**2 - least**2)
    x = 2.0 * math.sqrt(max(radius * radius - least * least, 0.0)) / most - 1.0
    one, two = 0.0, 0.0
    for i in range(len(body.flank) - 1, 0, -1):
        one, two = 2.0 * x * one - two + body.flank[i], one
    return x * one - two + body.flank[0]


@njit(cache=True, nogil=True)
def _by_cutter(alpha: float, radius: float, body: Body) -> float:
    x, y = radius * math.cos(alpha) - body.distance, radius * math.sin(alpha)
    own = math.hypot(x, y)
    if own > body.cutter_tip:
        return -9.0
    return alpha - (math.atan2(y, x) - _flank_of_cutter(own, body)) * body.cutter_teeth / body.teeth


@njit(cache=True, nogil=True)
def _swept(alpha: float, radius: float, body: Body) -> float:
    if len(body.flank) > 0:
        return _by_cutter(alpha, radius, body)
    return _by_rack(alpha, radius, body.teeth, body.shift, body.rack)


@njit(cache=True, nogil=True)
def space(radius: float, body: Body) -> tuple[float, float]:
    """Half the angle of the space at a radius, and where it was cut: depth on the rack, or radius on the cutter."""
    if len(body.flank) > 0:
        # The circle is inside the cutter's tips as far as it is within their reach.
        d = body.distance
        cosine = (radius * radius + d * d - body.cutter_tip**2) / (2.0 * radius * d)
    else:
        cosine = (0.5 * body.teeth + body.shift - body.rack.depth) / radius
    if cosine >= 1.0:
        return 0.0, math.inf
    most = math.acos(max(cosine, -1.0))
    number = 160
    best, at = -9.0, 0.0
    for i in range(number + 1):
        alpha = most * (2.0 * i / number - 1.0) * (1.0 - 1e-15)
        found = _swept(alpha, radius, body)
        if found > best:
            best, at = found, alpha
    low, high = max(-most, at - 2.0 * most / number), min(most, at + 2.0 * most / number)
    one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    left, right = _swept(one, radius, body), _swept(other, radius, body)
    for _ in range(70):
        if left < right:
            low, one, left = one, other, right
            other = low + GOLDEN * (high - low)
            right = _swept(other, radius, body)
        else:
            high, other, right = other, one, left
            one = high - GOLDEN * (high - low)
            left = _swept(one, radius, body)
    if max(left, right) > best:
        best, at = (left, one) if left > right else (right, other)
    if len(body.flank) > 0:
        return best, math.hypot(radius * math.cos(at) - body.distance, radius * math.sin(at))
    return best, 0.5 * body.teeth + body.shift - radius * math.cos(at)


def external(teeth: int, shift: float, addendum: float, tool: Rack) -> Body:
    """A gear cut by a rack; its tips are turned to the reference radius + shift + addendum."""
    return Body(teeth, shift, 0.5 * teeth + shift + addendum, tool, 0.0, 0, 0.0, np.zeros(0))


@njit(cache=True, nogil=True)
def _straight_cut(alpha: float, radius: float, teeth: int, slope: float) -> float:
    r = 0.5 * teeth
    return alpha - (radius * math.sin(alpha) - 0.25 * math.pi + (r - radius * math.cos(alpha)) * slope) / r


@njit(cache=True, nogil=True)
def _sharp(teeth: int, angle: float, radius: float) -> float:
    """Half the angle of a tooth whose flank a rack without end cuts: only its straight part touches at α below φ."""
    slope, low, high = math.tan(angle), angle - 0.5 * math.pi, angle
    for _ in range(90):
        one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        if _straight_cut(one, radius, teeth, slope) < _straight_cut(other, radius, teeth, slope):
            low = one
        else:
            high = other
    return math.pi / teeth - _straight_cut(0.5 * (low + high), radius, teeth, slope)


def ring(teeth: int, shift: float, addendum: float, tool: Rack, cutter_teeth: int) -> Body:
    """A ring cut by a pinion of 1.25 modules addendum until its spaces are π/2 + 2 x tan φ wide at its reference."""
    tip = 0.5 * cutter_teeth + 1.25
    least = 0.5 * cutter_teeth * math.cos(tool.angle)
    nodes = np.cos(math.pi * (np.arange(DEGREE) + 0.5) / DEGREE)
    along = 0.5 * (nodes + 1.0) * math.sqrt(tip**2 - least**2)
    flank = np.array([_sharp(cutter_teeth, tool.angle, math.hypot(least, u)) for u in along])
    coefficients = np.polynomial.chebyshev.chebfit(nodes, flank, DEGREE - 1)
    r = 0.5 * teeth
    wanted = (0.5 * math.pi + 2.0 * shift * math.tan(tool.angle)) / (2.0 * r)
    apart = r - 0.5 * cutter_teeth
    body = Body(teeth, shift, r + shift - addendum, tool, apart, cutter_teeth, tip, coefficients)
    low, high = apart + shift - 1.0, apart + shift + 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if space(r, body._replace(distance=middle))[0] < wanted else (low, middle)
    return body._replace(distance=0.5 * (low + high))


@njit(cache=True, nogil=True)
def _tooth(radius: float, body: Body) -> float:
    return math.pi / body.teeth - space(radius, body)[0]


@njit(cache=True, nogil=True)
def _off_second(turn: float, distance: float, first: Body, second: Body, corner: float) -> tuple[float, float]:
    """Angle of the second gear between its flank and the corner of the first, and the radius of that place on it."""
    inside = len(second.flank) > 0
    x, y = first.tip * math.cos(turn + corner), first.tip * math.sin(turn + corner)
    if inside:
        x += distance
        own, angle = math.hypot(x, y), math.atan2(y, x)
        if own < second.tip:
            return 9.0, own
    else:
        own, angle = math.hypot(distance - x, y), math.atan2(y, distance - x)
        if own > second.tip:
            return 9.0, own
    return turn * first.teeth / second.teeth + space(own, second)[0] - angle, own


@njit(cache=True, nogil=True)
def _off_first(turn: float, distance: float, first: Body, second: Body, corner: float) -> tuple[float, float]:
    """Angle of the first gear between its flank and the corner of the second, and the radius of that place on it."""
    angle = turn * first.teeth / second.teeth + corner
    x, y = second.tip * math.cos(angle), second.tip * math.sin(angle)
    x = x - distance if len(second.flank) > 0 else distance - x
    own = math.hypot(x, y)
    if own > first.tip:
        return 9.0, own
    return math.atan2(y, x) - turn - _tooth(own, first), own


@njit(cache=True, nogil=True)
def _off(turn: float, distance: float, first: Body, second: Body, corner: float, of_first: bool) -> tuple[float, float]:
    if of_first:
        return _off_second(turn, distance, first, second, corner)
    return _off_first(turn, distance, first, second, corner)


@njit(cache=True, nogil=True)
def nearest(distance: float, first: Body, second: Body, of_first: bool) -> tuple[float, float, float]:
    """The least angle by which a corner of the first (or second) gear clears the mate, where, and the radius there."""
    corner = _tooth(first.tip, first) if of_first else space(second.tip, second)[0]
    # Neither gear comes round far enough for the next turn of the corner to meet the mate.
    span = min(4.0 * math.pi / first.teeth + 0.9, 2.5, 2.5 * second.teeth / first.teeth)
    number = 1600
    best, at = 9.0, 0.0
    for i in range(number + 1):
        turn = span * (2.0 * i / number - 1.0)
        found = _off(turn, distance, first, second, corner, of_first)[0]
        if found < best:
            best, at = found, turn
    low, high = at - 2.0 * span / number, at + 2.0 * span / number
    for _ in range(80):
        one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        left = _off(one, distance, first, second, corner, of_first)[0]
        right = _off(other, distance, first, second, corner, of_first)[0]
        if left < right:
            high = other
        else:
            low = one
    middle = 0.5 * (low + high)
    found, own = _off(middle, distance, first, second, corner, of_first)
    return found, middle, own


class Run(NamedTuple):
    """What two cut gears show when they turn; lengths in modules."""

    backlash: float
    other_backlash: float
    contact_ratio: float
    in_fillet: tuple[bool, bool]
    tip_thickness: tuple[float, float]


def run(distance: float, first: Body, second: Body) -> Run:
    """Turn two gears at a distance; both backlashes agree where no corner meets anything but a flank."""
    inside = len(second.flank) > 0
    off_second, ends_at, on_second = nearest(distance, first, second, True)
    off_first, begins_at, on_first = nearest(distance, first, second, False)
    teeth = first.teeth / second.teeth
    apart = abs(second.teeth - first.teeth) if inside else second.teeth + first.teeth
    radii = distance * first.teeth / apart, distance * second.teeth / apart
    begins = begins_at + off_second / teeth
    fillets = (
        space(on_first, first)[1] > _straight(first.rack),
        space(on_second, second)[1] >= second.cutter_tip * (1.0 - 1e-9) if inside else
        space(on_second, second)[1] > _straight(second.rack),
    )  # fmt: skip
    tips = first.tip * _tooth(first.tip, first), second.tip * (math.pi / second.teeth - space(second.tip, second)[0])
    return Run(
        2.0 * off_second * radii[1],
        2.0 * off_first * radii[0],
        abs(ends_at - begins) * first.teeth / (2.0 * math.pi),
        (bool(fillets[0]), bool(fillets[1])),
        (2.0 * tips[0], 2.0 * tips[1]),
    )


def _straight(tool: Rack) -> float:
    return tool.depth - tool.rounding * (1.0 - math.sin(tool.angle))


def is_undercut(body: Body) -> bool:
    """Whether the rounded tip of the rack cuts where its straight flank would touch: looked for along the flank."""
    straight = _straight(body.rack)
    r = 0.5 * body.teeth
    root = r + body.shift - body.rack.depth
    for radius in np.linspace(max(r * math.cos(body.rack.angle), root) * (1.0 + 1e-9), body.tip, 800):
        cut, depth = space(radius, body)
        flank = math.pi / body.teeth - _shifted(body, float(radius))
        if depth > straight + 1e-9 and cut > flank + 1e-11:
            return True
    return False


def involute_radius(body: Body) -> float:
    """The radius from which on the straight flank of the rack, not its rounded tip, made a gear, undercut or not."""
    r = 0.5 * body.teeth + body.shift
    low, high = (r - body.rack.depth) * (1.0 + 1e-9), body.tip
    for _ in range(50):
        middle = 0.5 * (low + high)
        ends = [math.acos(min(1.0, (r - depth) / middle)) for depth in (_straight(body.rack), body.rack.depth)]
        flank = _most(-ends[0], ends[0], middle, body)
        tip = max(_most(ends[0], ends[1], middle, body), _most(-ends[1], -ends[0], middle, body))
        low, high = (low, middle) if flank >= tip else (middle, high)
    return high


@njit(cache=True, nogil=True)
def _most(low: float, high: float, radius: float, body: Body) -> float:
    """The greatest angle that the rack cuts between two angles: a grid, narrowed around its best."""
    best, first, last = -9.0, low, high
    for _ in range(8):
        step, at = (high - low) / 100, low
        for i in range(101):
            found = _by_rack(low + i * step, radius, body.teeth, body.shift, body.rack)
            if found > best:
                best, at = found, low + i * step
        low, high = max(first, at - step), min(last, at + step)
    return best


def _shifted(body: Body, radius: float) -> float:
    """Half the angle of the tooth that the endless rack cuts, moved out by the shift."""
    return _sharp(body.teeth, body.rack.angle, radius) + 2.0 * body.shift * math.tan(body.rack.angle) / body.teeth
