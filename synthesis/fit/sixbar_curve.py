"""Curves of sixbars traced by a link that is not part of a fourbar, with their derivatives in every dimension.

A fourbar O2 A B O4 with a fully rotating crank carries a dyad C–E–D: pin C lies on one of its links, the *carrier*, pin
D on another, the *holder*, and the links C E, which has P, and E D close the loop. By carrier and holder:

================= ===================== ==========================================================
carrier, holder   sixbar                joined links
================= ===================== ==========================================================
coupler, ground   Stephenson III        D is a third fixed pivot, O6
coupler, rocker   Watt I                two that share pin B; the same with the two exchanged
coupler, crank    Watt I                two that share pin A; the same with the two exchanged
crank, rocker     Stephenson I          two opposite ones; the same with the two exchanged
================= ===================== ==========================================================

All have the same fifteen unknowns x: those of the fourbar's chart (:mod:`synthesis.fit.chart`) up to its lengths, then
C and D, each in the frame of its link, ln r₁ and ln r₂, the lengths C E and E D, and P in the frame of C E. The
frame of the crank has its origin at O2 and its real axis through A, the coupler's goes from A to B, the rocker's from
O4 to B; the ground's is that of the task.

With v the unit vector from C to E and F = r₁ v − (D − C), which has the length r₂, Re(F̄ dF) = r₂ dr₂ gives the turn of
v for any change, as in :mod:`synthesis.fit.coupler_curve`; the cosine of the angle between the links at E is

    cos μ = (r₁² + r₂² − |D − C|²) / 2 r₁ r₂.
"""

from __future__ import annotations

import math

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.coupler_curve import close_two_bars, compute_unit_vector, rotate_left, scale_complex

GROUND, CRANK, COUPLER, ROCKER = range(4)
"""Links that may contain C and D."""

INPUT = 4
"""Code for the holder of a Stephenson II: the fourbar is on the input link, and E D is the ground
(:mod:`synthesis.fit.inverted_curve`); the carrier is then the link that has P."""

C, D, DYAD, P = 7, 9, 11, 13
"""Indices of the pins, of the logarithms of the dyad's lengths, and of P among the unknowns."""

UNKNOWNS = 15
"""Number of unknowns of a sixbar. The derivative by the crank angle follows those by the unknowns."""


@njit(**OPTIONS)
def compute_turn_rate(f: complex, change: complex, per: float) -> float:
    """Return the rotation that keeps |F| while F changes by ``change``."""
    return -(f.real * change.real + f.imag * change.imag) / per


@njit(**OPTIONS)
def project_across(along: complex, change: complex) -> float:
    """Return the component of a change perpendicular to a direction, positive to its left."""
    return along.real * change.imag - along.imag * change.real


@njit(**OPTIONS)
def close_fourbar(
    x: Real, lengths: Real, sign: float, crank: complex, ground: complex
) -> tuple[bool, complex, complex]:
    """Return whether the fourbar closes, and the unit vectors of coupler and rocker."""
    base = scale_complex(ground, lengths[0]) - scale_complex(crank, lengths[1])
    closes, along = close_two_bars(base, lengths[2], lengths[3], sign)
    return closes, along, scale_complex(scale_complex(along, lengths[2]) - base, 1.0 / lengths[3])


@njit(**OPTIONS)
def locate_pin(
    frame: int,
    local: complex,
    o2: complex,
    lengths: Real,
    ground: complex,
    crank: complex,
    along: complex,
    out: complex,
) -> complex:
    """Return a pin's place from its coordinates in the frame of its link."""
    place: complex = local
    if frame == CRANK:
        place = o2 + local * crank
    elif frame == COUPLER:
        place = o2 + scale_complex(crank, lengths[1]) + local * along
    elif frame == ROCKER:
        place = o2 + scale_complex(ground, lengths[0]) + local * out
    return place


@njit(**OPTIONS)
def locate_joints(
    x: Real, lengths: Real, sign: float, carrier: int, holder: int, side: float, theta: float, places: Complex
) -> bool:
    """Return whether a sixbar closes with the crank at θ; write A, B, C, D, E and P into ``places`` (6,).

    ``sign`` and ``side`` are the assemblies of the fourbar's dyad and of C–E–D.
    """
    o2, ground, crank = complex(x[0], x[1]), compute_unit_vector(x[2]), compute_unit_vector(theta)
    closes, along, out = close_fourbar(x, lengths, sign, crank, ground)
    if not closes:
        return False
    places[0] = o2 + scale_complex(crank, lengths[1])
    places[1] = places[0] + scale_complex(along, lengths[2])
    places[2] = locate_pin(carrier, complex(x[C], x[C + 1]), o2, lengths, ground, crank, along, out)
    places[3] = locate_pin(holder, complex(x[D], x[D + 1]), o2, lengths, ground, crank, along, out)
    first = math.exp(x[DYAD])
    joined, v = close_two_bars(places[3] - places[2], first, math.exp(x[DYAD + 1]), side)
    places[4] = places[2] + scale_complex(v, first)
    places[5] = places[2] + complex(x[P], x[P + 1]) * v
    return bool(joined)


@njit(**OPTIONS)
def compute_pin_velocity(
    frame: int, local: complex, arm: complex, along: complex, out: complex, turn: float, swing: float, crank: complex
) -> complex:
    """Return a pin's derivative by the crank angle, given the rotation rates of coupler and rocker."""
    moved = 0j
    if frame == CRANK:
        moved = rotate_left(local * crank)
    elif frame == COUPLER:
        moved = rotate_left(arm) + scale_complex(rotate_left(local * along), turn)
    elif frame == ROCKER:
        moved = scale_complex(rotate_left(local * out), swing)
    return moved


@njit(**OPTIONS)
def compute_velocity(
    x: Real, lengths: Real, sign: float, carrier: int, holder: int, side: float, theta: float
) -> tuple[bool, complex, complex]:
    """Return whether a sixbar closes, P, and P's derivative by the crank angle."""
    o2, ground, crank = complex(x[0], x[1]), compute_unit_vector(x[2]), compute_unit_vector(theta)
    closes, along, out = close_fourbar(x, lengths, sign, crank, ground)
    if not closes:
        return False, 0j, 0j
    arm, bar, f = scale_complex(crank, lengths[1]), scale_complex(along, lengths[2]), scale_complex(out, lengths[3])
    g, moved = rotate_left(bar), rotate_left(arm)
    turn = compute_turn_rate(f, moved, f.real * g.real + f.imag * g.imag)
    # B moves across the rocker only; its velocity over the rocker's length is the rocker's rate.
    swing = project_across(out, moved + scale_complex(g, turn)) / lengths[3]
    local_c, local_d = complex(x[C], x[C + 1]), complex(x[D], x[D + 1])
    c = locate_pin(carrier, local_c, o2, lengths, ground, crank, along, out)
    base = locate_pin(holder, local_d, o2, lengths, ground, crank, along, out) - c
    first = math.exp(x[DYAD])
    closes, v = close_two_bars(base, first, math.exp(x[DYAD + 1]), side)
    if not closes:
        return False, 0j, 0j
    by_c = compute_pin_velocity(carrier, local_c, arm, along, out, turn, swing, crank)
    by_d = compute_pin_velocity(holder, local_d, arm, along, out, turn, swing, crank)
    f, g = scale_complex(v, first) - base, rotate_left(scale_complex(v, first))
    # Only the relative motion of C and D turns the dyad.
    spin = compute_turn_rate(f, by_c - by_d, f.real * g.real + f.imag * g.imag)
    reach = complex(x[P], x[P + 1]) * v
    return True, c + reach, by_c + scale_complex(rotate_left(reach), spin)


@njit(**OPTIONS)
def _differentiate_pin(
    frame: int, at: int, x: Real, lengths: Real, chart: Real, ground: complex, crank: complex, along: complex,
    out: complex, turn: Real, swing: Real, by: Complex,
) -> complex:  # fmt: skip
    """Return a pin and write its derivatives, given those of the rotations of coupler and rocker.

    ``at`` is the index of the pin's coordinates among the unknowns.
    """
    by[:] = 0.0
    local, o2 = complex(x[at], x[at + 1]), complex(x[0], x[1])
    direction = 1.0 + 0j
    # A pin on the ground does not move with O2.
    if frame != GROUND:
        by[0], by[1] = 1.0 + 0j, 1j
    if frame == CRANK:
        direction = crank
        by[UNKNOWNS] = rotate_left(local * crank)
    elif frame == COUPLER:
        direction = along
        swung = rotate_left(local * along)
        # Unknowns 2 to 6 are the direction of the ground line and the lengths: the only ones that turn the fourbar's
        # links.
        for k in range(2, 7):
            by[k] = scale_complex(swung, turn[k])
        for k in range(4):
            by[3 + k] += scale_complex(crank, chart[1, k])
        by[UNKNOWNS] = rotate_left(scale_complex(crank, lengths[1])) + scale_complex(swung, turn[UNKNOWNS])
    elif frame == ROCKER:
        direction = out
        swung = rotate_left(local * out)
        for k in range(2, 7):
            by[k] = scale_complex(swung, swing[k])
        # The rocker's origin O4 moves with the ground line's direction and length.
        by[2] += rotate_left(scale_complex(ground, lengths[0]))
        for k in range(4):
            by[3 + k] += scale_complex(ground, chart[0, k])
        by[UNKNOWNS] = scale_complex(swung, swing[UNKNOWNS])
    # The pin's own coordinates, in the frame of its link.
    by[at], by[at + 1] = direction, rotate_left(direction)
    place: complex = locate_pin(frame, local, o2, lengths, ground, crank, along, out)
    return place


@njit(**OPTIONS)
def differentiate_pins(
    x: Real, lengths: Real, chart: Real, sign: float, carrier: int, holder: int, theta: float, turns: Real,
    by_c: Complex, by_d: Complex,
) -> tuple[bool, complex, complex]:  # fmt: skip
    """Return whether the fourbar closes, and C and D; write their derivatives, each of shape (16,).

    They are by the unknowns and, last, by the crank angle. ``turns`` (2, 16) receives the derivatives of the directions
    of coupler and rocker.
    """
    ground, crank = compute_unit_vector(x[2]), compute_unit_vector(theta)
    closes, along, out = close_fourbar(x, lengths, sign, crank, ground)
    if not closes:
        return False, 0j, 0j
    turn, swing = turns[0], turns[1]
    arm, bar, f = scale_complex(crank, lengths[1]), scale_complex(along, lengths[2]), scale_complex(out, lengths[3])
    g = rotate_left(bar)
    per = f.real * g.real + f.imag * g.imag
    over = 1.0 / lengths[3]
    # Turning the ground line moves O4 at a fixed absolute crank angle.
    moved = -rotate_left(scale_complex(ground, lengths[0]))
    turn[2] = compute_turn_rate(f, moved, per)
    swing[2] = project_across(out, moved + scale_complex(g, turn[2])) * over
    moved = rotate_left(arm)
    turn[UNKNOWNS] = compute_turn_rate(f, moved, per)
    swing[UNKNOWNS] = project_across(out, moved + scale_complex(g, turn[UNKNOWNS])) * over
    for k in range(4):
        moved = (
            scale_complex(crank, chart[1, k]) - scale_complex(ground, chart[0, k]) + scale_complex(along, chart[2, k])
        )
        # The second term is the change of |F| = c itself.
        turn[3 + k] = compute_turn_rate(f, moved, per) + lengths[3] * chart[3, k] / per
        swing[3 + k] = project_across(out, moved + scale_complex(g, turn[3 + k])) * over
    c = _differentiate_pin(carrier, C, x, lengths, chart, ground, crank, along, out, turn, swing, by_c)
    d = _differentiate_pin(holder, D, x, lengths, chart, ground, crank, along, out, turn, swing, by_d)
    return True, c, d


@njit(**OPTIONS)
def differentiate_point(
    x: Real, side: float, c: complex, d: complex, by_c: Complex, by_d: Complex, slopes: Complex
) -> tuple[bool, complex]:
    """Return whether C–E–D closes, and P; write P's derivatives (16,), given the pins and their derivatives."""
    first, second = math.exp(x[DYAD]), math.exp(x[DYAD + 1])
    closes, v = close_two_bars(d - c, first, second, side)
    if not closes:
        return False, 0j
    bar, reach = scale_complex(v, first), complex(x[P], x[P + 1]) * v
    f, g, swung = bar - (d - c), rotate_left(bar), rotate_left(reach)
    per = f.real * g.real + f.imag * g.imag
    for k in range(UNKNOWNS + 1):
        slopes[k] = by_c[k] + scale_complex(swung, compute_turn_rate(f, by_c[k] - by_d[k], per))
    # ln r₁ stretches the bar by its own vector; ln r₂ changes |F| by r₂.
    slopes[DYAD] = scale_complex(swung, compute_turn_rate(f, bar, per))
    slopes[DYAD + 1] = scale_complex(swung, second * second / per)
    slopes[P], slopes[P + 1] = v, rotate_left(v)
    return True, c + reach


@njit(**OPTIONS)
def compute_cosine(x: Real, c: complex, d: complex) -> float:
    """Return the cosine of the angle between the links at E."""
    first, second, base = math.exp(x[DYAD]), math.exp(x[DYAD + 1]), d - c
    square = base.real * base.real + base.imag * base.imag
    return (first * first + second * second - square) / (2.0 * first * second)


@njit(**OPTIONS)
def differentiate_cosine(x: Real, c: complex, d: complex, by_c: Complex, by_d: Complex, row: Real) -> float:
    """Return the cosine of the angle between the links at E, and write its derivatives by the unknowns, shape (15,)."""
    first, second, base = math.exp(x[DYAD]), math.exp(x[DYAD + 1]), d - c
    over = 1.0 / (first * second)
    for k in range(UNKNOWNS):
        change = by_d[k] - by_c[k]
        row[k] = -over * (base.real * change.real + base.imag * change.imag)
    value: float = compute_cosine(x, c, d)
    # By ln r₁ and ln r₂ the law of cosines gives r₁/r₂ − cos μ and r₂/r₁ − cos μ.
    row[DYAD] = over * first * first - value
    row[DYAD + 1] = over * second * second - value
    return value
