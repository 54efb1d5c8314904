"""Curves that sixbars draw by a link which no fourbar alone moves, with their slopes in every dimension.

A fourbar O2 A B O4 whose crank turns through carries a dyad C–E–D: pin C lies on one of its links, the *carrier*, pin D
on another, the *holder*, and the links C E, on which P is, and E D close the loop. By the links that carry and hold,

================= ===================== ==========================================================
carrier, holder   sixbar                what is joined
================= ===================== ==========================================================
coupler, ground   Stephenson III        D is a third fixed pivot, O6
coupler, rocker   Watt I                links that are joined at B; the same with the two exchanged
coupler, crank    Watt I                links that are joined at A; the same with the two exchanged
crank, rocker     Stephenson I          opposite links; the same with the two exchanged
================= ===================== ==========================================================

All have the same fifteen unknowns x: those of the fourbar's chart (:mod:`synthesis.fit.chart`) as far as its lengths,
then C and D, each in the frame of its link, ln r₁ and ln r₂, the lengths C E and E D, and P in the frame of C E. The
frame of the crank has its origin at O2 and its real axis through A, the coupler's goes from A to B, the rocker's from
O4 to B; the ground's is that of the task.

With v the unit vector from C to E and F = r₁ v − (D − C), which has the length r₂, Re(F̄ dF) = r₂ dr₂ gives the turn of
v for any change, as in :mod:`synthesis.fit.coupler_curve`; the cosine of the angle between the links at E is

    cos μ = (r₁² + r₂² − |D − C|²) / 2 r₁ r₂.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.coupler_curve import scaled, turned, two_bars, unit

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

GROUND, CRANK, COUPLER, ROCKER = range(4)
"""Links that C and D lie on."""

INPUT = 4
"""In place of the holder: the fourbar stands on the input link, and E D is the ground, of a Stephenson II
(:mod:`synthesis.fit.inverted_curve`); the carrier is then the link that P is on."""

C, D, DYAD, P = 7, 9, 11, 13
"""Where the pins, the logarithms of the dyad's lengths, and P stand in the unknowns."""

UNKNOWNS = 15
"""How many unknowns a sixbar has; derivatives have that by the crank angle behind those by the unknowns."""


@njit(**OPTIONS)
def turn_of(f: complex, change: complex, per: float) -> float:
    """The turn that keeps |F| while F changes otherwise."""
    return -(f.real * change.real + f.imag * change.imag) / per


@njit(**OPTIONS)
def across(along: complex, change: complex) -> float:
    """The part of a change across a direction."""
    return along.real * change.imag - along.imag * change.real


@njit(**OPTIONS)
def fourbar(x: Real, lengths: Real, sign: float, crank: complex, ground: complex) -> tuple[bool, complex, complex]:
    """Whether the fourbar closes, and the unit vectors of coupler and rocker."""
    base = scaled(ground, lengths[0]) - scaled(crank, lengths[1])
    closes, along = two_bars(base, lengths[2], lengths[3], sign)
    return closes, along, scaled(scaled(along, lengths[2]) - base, 1.0 / lengths[3])


@njit(**OPTIONS)
def pin(
    frame: int,
    local: complex,
    o2: complex,
    lengths: Real,
    ground: complex,
    crank: complex,
    along: complex,
    out: complex,
) -> complex:
    """A pin's place from its coordinates in the frame of its link."""
    place: complex = local
    if frame == CRANK:
        place = o2 + local * crank
    elif frame == COUPLER:
        place = o2 + scaled(crank, lengths[1]) + local * along
    elif frame == ROCKER:
        place = o2 + scaled(ground, lengths[0]) + local * out
    return place


@njit(**OPTIONS)
def joints(
    x: Real, lengths: Real, sign: float, carrier: int, holder: int, side: float, theta: float, places: Complex
) -> bool:
    """Whether a sixbar closes with the crank at θ; A, B, C, D, E and P are written into ``places`` (6,).

    ``sign`` and ``side`` are the assemblies of the fourbar's dyad and of C–E–D.
    """
    o2, ground, crank = complex(x[0], x[1]), unit(x[2]), unit(theta)
    closes, along, out = fourbar(x, lengths, sign, crank, ground)
    if not closes:
        return False
    places[0] = o2 + scaled(crank, lengths[1])
    places[1] = places[0] + scaled(along, lengths[2])
    places[2] = pin(carrier, complex(x[C], x[C + 1]), o2, lengths, ground, crank, along, out)
    places[3] = pin(holder, complex(x[D], x[D + 1]), o2, lengths, ground, crank, along, out)
    first = math.exp(x[DYAD])
    joined, v = two_bars(places[3] - places[2], first, math.exp(x[DYAD + 1]), side)
    places[4] = places[2] + scaled(v, first)
    places[5] = places[2] + complex(x[P], x[P + 1]) * v
    return bool(joined)


@njit(**OPTIONS)
def pin_velocity(
    frame: int, local: complex, arm: complex, along: complex, out: complex, turn: float, swing: float, crank: complex
) -> complex:
    """A pin's derivative by the crank angle, from those of coupler and rocker."""
    moved = 0j
    if frame == CRANK:
        moved = turned(local * crank)
    elif frame == COUPLER:
        moved = turned(arm) + scaled(turned(local * along), turn)
    elif frame == ROCKER:
        moved = scaled(turned(local * out), swing)
    return moved


@njit(**OPTIONS)
def velocity(
    x: Real, lengths: Real, sign: float, carrier: int, holder: int, side: float, theta: float
) -> tuple[bool, complex, complex]:
    """Whether a sixbar closes, P, and P's derivative by the crank angle."""
    o2, ground, crank = complex(x[0], x[1]), unit(x[2]), unit(theta)
    closes, along, out = fourbar(x, lengths, sign, crank, ground)
    if not closes:
        return False, 0j, 0j
    arm, bar, f = scaled(crank, lengths[1]), scaled(along, lengths[2]), scaled(out, lengths[3])
    g, moved = turned(bar), turned(arm)
    turn = turn_of(f, moved, f.real * g.real + f.imag * g.imag)
    swing = across(out, moved + scaled(g, turn)) / lengths[3]
    local_c, local_d = complex(x[C], x[C + 1]), complex(x[D], x[D + 1])
    c = pin(carrier, local_c, o2, lengths, ground, crank, along, out)
    base = pin(holder, local_d, o2, lengths, ground, crank, along, out) - c
    first = math.exp(x[DYAD])
    closes, v = two_bars(base, first, math.exp(x[DYAD + 1]), side)
    if not closes:
        return False, 0j, 0j
    by_c = pin_velocity(carrier, local_c, arm, along, out, turn, swing, crank)
    by_d = pin_velocity(holder, local_d, arm, along, out, turn, swing, crank)
    f, g = scaled(v, first) - base, turned(scaled(v, first))
    spin = turn_of(f, by_c - by_d, f.real * g.real + f.imag * g.imag)
    reach = complex(x[P], x[P + 1]) * v
    return True, c + reach, by_c + scaled(turned(reach), spin)


@njit(**OPTIONS)
def _pin_with_slopes(
    frame: int, at: int, x: Real, lengths: Real, chart: Real, ground: complex, crank: complex, along: complex,
    out: complex, turn: Real, swing: Real, by: Complex,
) -> complex:  # fmt: skip
    """A pin and its derivatives, from those of the turns of coupler and rocker; ``at`` is where its numbers stand."""
    by[:] = 0.0
    local, o2 = complex(x[at], x[at + 1]), complex(x[0], x[1])
    direction = 1.0 + 0j
    if frame != GROUND:
        by[0], by[1] = 1.0 + 0j, 1j
    if frame == CRANK:
        direction = crank
        by[UNKNOWNS] = turned(local * crank)
    elif frame == COUPLER:
        direction = along
        swung = turned(local * along)
        for k in range(2, 7):
            by[k] = scaled(swung, turn[k])
        for k in range(4):
            by[3 + k] += scaled(crank, chart[1, k])
        by[UNKNOWNS] = turned(scaled(crank, lengths[1])) + scaled(swung, turn[UNKNOWNS])
    elif frame == ROCKER:
        direction = out
        swung = turned(local * out)
        for k in range(2, 7):
            by[k] = scaled(swung, swing[k])
        by[2] += turned(scaled(ground, lengths[0]))
        for k in range(4):
            by[3 + k] += scaled(ground, chart[0, k])
        by[UNKNOWNS] = scaled(swung, swing[UNKNOWNS])
    by[at], by[at + 1] = direction, turned(direction)
    place: complex = pin(frame, local, o2, lengths, ground, crank, along, out)
    return place


@njit(**OPTIONS)
def pins_with_slopes(
    x: Real, lengths: Real, chart: Real, sign: float, carrier: int, holder: int, theta: float, turns: Real,
    by_c: Complex, by_d: Complex,
) -> tuple[bool, complex, complex]:  # fmt: skip
    """Whether the fourbar closes, C and D, and their derivatives (16,) by the unknowns and, last, the crank angle.

    ``turns`` (2, 16) gets those of the directions of coupler and rocker.
    """
    ground, crank = unit(x[2]), unit(theta)
    closes, along, out = fourbar(x, lengths, sign, crank, ground)
    if not closes:
        return False, 0j, 0j
    turn, swing = turns[0], turns[1]
    arm, bar, f = scaled(crank, lengths[1]), scaled(along, lengths[2]), scaled(out, lengths[3])
    g = turned(bar)
    per = f.real * g.real + f.imag * g.imag
    over = 1.0 / lengths[3]
    moved = -turned(scaled(ground, lengths[0]))
    turn[2] = turn_of(f, moved, per)
    swing[2] = across(out, moved + scaled(g, turn[2])) * over
    moved = turned(arm)
    turn[UNKNOWNS] = turn_of(f, moved, per)
    swing[UNKNOWNS] = across(out, moved + scaled(g, turn[UNKNOWNS])) * over
    for k in range(4):
        moved = scaled(crank, chart[1, k]) - scaled(ground, chart[0, k]) + scaled(along, chart[2, k])
        turn[3 + k] = turn_of(f, moved, per) + lengths[3] * chart[3, k] / per
        swing[3 + k] = across(out, moved + scaled(g, turn[3 + k])) * over
    c = _pin_with_slopes(carrier, C, x, lengths, chart, ground, crank, along, out, turn, swing, by_c)
    d = _pin_with_slopes(holder, D, x, lengths, chart, ground, crank, along, out, turn, swing, by_d)
    return True, c, d


@njit(**OPTIONS)
def point_with_slopes(
    x: Real, side: float, c: complex, d: complex, by_c: Complex, by_d: Complex, slopes: Complex
) -> tuple[bool, complex]:
    """Whether C–E–D closes, P, and P's derivatives (16,), from the pins and theirs."""
    first, second = math.exp(x[DYAD]), math.exp(x[DYAD + 1])
    closes, v = two_bars(d - c, first, second, side)
    if not closes:
        return False, 0j
    bar, reach = scaled(v, first), complex(x[P], x[P + 1]) * v
    f, g, swung = bar - (d - c), turned(bar), turned(reach)
    per = f.real * g.real + f.imag * g.imag
    for k in range(UNKNOWNS + 1):
        slopes[k] = by_c[k] + scaled(swung, turn_of(f, by_c[k] - by_d[k], per))
    slopes[DYAD] = scaled(swung, turn_of(f, bar, per))
    slopes[DYAD + 1] = scaled(swung, second * second / per)
    slopes[P], slopes[P + 1] = v, turned(v)
    return True, c + reach


@njit(**OPTIONS)
def cosine(x: Real, c: complex, d: complex) -> float:
    """The cosine of the angle between the links at E."""
    first, second, base = math.exp(x[DYAD]), math.exp(x[DYAD + 1]), d - c
    square = base.real * base.real + base.imag * base.imag
    return (first * first + second * second - square) / (2.0 * first * second)


@njit(**OPTIONS)
def cosine_with_slopes(x: Real, c: complex, d: complex, by_c: Complex, by_d: Complex, row: Real) -> float:
    """The same, and its derivatives by the unknowns (15,), from the pins and theirs."""
    first, second, base = math.exp(x[DYAD]), math.exp(x[DYAD + 1]), d - c
    over = 1.0 / (first * second)
    for k in range(UNKNOWNS):
        change = by_d[k] - by_c[k]
        row[k] = -over * (base.real * change.real + base.imag * change.imag)
    value: float = cosine(x, c, d)
    row[DYAD] = over * first * first - value
    row[DYAD + 1] = over * second * second - value
    return value
