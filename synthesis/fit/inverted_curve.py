"""Curves traced by Stephenson II sixbars, by inversion, with their derivatives in every dimension.

Seen from its input link, a Stephenson II is a Stephenson III: links 3, 4 and 5 are a fourbar on the input, and the
ground is the link E D of a dyad C–E–D, with C on link 4, and E and D the fixed pivots of output and input. So the
linkage is driven by link 3, relative to the input, and the result is then rotated so that the ground is at rest. The
fifteen unknowns are those of :mod:`synthesis.fit.sixbar_curve`, some with another meaning:

* the first three are the input's fixed pivot, O2, and the direction from it to the output's, O4;
* A₀, the pin of link 3 on the input, is the origin of the input's frame, whose real axis goes to B₀, the pin of link 5
  on the input; D, the place of O2, is in that frame, C in that of link 4 (origin A, real axis to B);
* ln r₁ and ln r₂ belong to the output and the ground;
* P is in the frame of link 3 (origin A₀, axis to A), 4, or 5 (origin B₀, axis to B).

θ is the angle of link 3 in the input's frame. The kinds of links are named as in that module: the crank is link 3, the
coupler link 4, the rocker link 5.
"""

from __future__ import annotations

import math

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import OPTIONS
from synthesis.fit.coupler_curve import close_two_bars, compute_unit_vector, rotate_left, scale_complex
from synthesis.fit.sixbar_curve import (
    COUPLER,
    CRANK,
    DYAD,
    ROCKER,
    UNKNOWNS,
    C,
    D,
    P,
    close_fourbar,
    compute_pin_velocity,
    compute_turn_rate,
    differentiate_pins,
    locate_pin,
    project_across,
)
from synthesis.fit.triad_slant import cross, differentiate_leg_slant, dot, find_min_slant

A0, A, B, B0, PIN, POINT, PIVOT = range(7)
"""Joints: pin of link 3 on the input and on link 4; of link 5 on link 4 and on the input; of the output on link 4; P;
and the output's fixed pivot."""

GROUND_JOINT_COUNT = 6
"""Number of joints that move on the ground: all but the last."""


@njit(**OPTIONS)
def compute_inverted_joints(
    x: Real, lengths: Real, sign: float, carrier: int, side: float, theta: float, places: Complex
) -> tuple[bool, float, float]:
    """Return whether a Stephenson II closes with link 3 at θ, and cosine and sine of its minimum transmission angle.

    Parameters
    ----------
    x, lengths : float, shapes (15,) and (4,)
        Unknowns, and lengths of the fourbar on the input.
    sign, side : float
        Assemblies of the fourbar's dyad and of C–E–D.
    carrier : int
        The link that carries P.
    theta : float
        Angle of link 3, radians.
    places : complex, shape (GROUND_JOINT_COUNT,)
        Output: the joints, relative to the ground.
    """
    crank = compute_unit_vector(theta)
    # Ground vector 1: the fourbar stands on the input, whose real axis it uses.
    closes, along, out = close_fourbar(x, lengths, sign, crank, 1.0 + 0j)
    if not closes:
        return False, 0.0, 0.0
    a, pivot, d = scale_complex(crank, lengths[1]), complex(lengths[0], 0.0), complex(x[D], x[D + 1])
    b, c = a + scale_complex(along, lengths[2]), a + complex(x[C], x[C + 1]) * along
    first, second = math.exp(x[DYAD]), math.exp(x[DYAD + 1])
    closes, v = close_two_bars(d - c, first, second, side)
    if not closes:
        return False, 0.0, 0.0
    e = c + scale_complex(v, first)
    p = locate_pin(carrier, complex(x[P], x[P + 1]), 0j, lengths, 1.0 + 0j, crank, along, out)
    # Rotation from the input's frame to the ground's: it turns D → E onto the given direction of the ground line.
    back = compute_unit_vector(x[2]) * scale_complex((e - d).conjugate(), 1.0 / second)
    o2 = complex(x[0], x[1])
    places[A0], places[A], places[B] = o2 - back * d, o2 + back * (a - d), o2 + back * (b - d)
    places[B0], places[PIN], places[POINT] = o2 + back * (pivot - d), o2 + back * (c - d), o2 + back * (p - d)
    cosine, sine, _ = find_min_slant(c, e, 0j, a, pivot, b)
    return True, cosine, sine


@njit(**OPTIONS)
def compute_inverted_velocity(
    x: Real, lengths: Real, sign: float, carrier: int, side: float, theta: float
) -> tuple[bool, complex, complex]:
    """Return whether a Stephenson II closes, P, and P's derivative by θ, both relative to the ground."""
    crank = compute_unit_vector(theta)
    closes, along, out = close_fourbar(x, lengths, sign, crank, 1.0 + 0j)
    if not closes:
        return False, 0j, 0j
    arm, f, g = (
        scale_complex(crank, lengths[1]),
        scale_complex(out, lengths[3]),
        rotate_left(scale_complex(along, lengths[2])),
    )
    moved = rotate_left(arm)
    turn = compute_turn_rate(f, moved, dot(f, g))
    swing = project_across(out, moved + scale_complex(g, turn)) / lengths[3]
    local_c, local_p, d = complex(x[C], x[C + 1]), complex(x[P], x[P + 1]), complex(x[D], x[D + 1])
    c = arm + local_c * along
    first, second = math.exp(x[DYAD]), math.exp(x[DYAD + 1])
    closes, v = close_two_bars(d - c, first, second, side)
    if not closes:
        return False, 0j, 0j
    by_c = compute_pin_velocity(COUPLER, local_c, arm, along, out, turn, swing, crank)
    bar = scale_complex(v, first)
    g = rotate_left(bar)
    f = bar - (d - c)
    by_e = by_c + scale_complex(g, compute_turn_rate(f, by_c, dot(f, g)))
    # Angular velocity of the ground relative to the input; subtracting it gives the motion on the ground.
    spin = cross(f, by_e) / (second * second)
    p = locate_pin(carrier, local_p, 0j, lengths, 1.0 + 0j, crank, along, out) - d
    by_p = compute_pin_velocity(carrier, local_p, arm, along, out, turn, swing, crank)
    back = compute_unit_vector(x[2]) * scale_complex(f.conjugate(), 1.0 / second)
    return True, complex(x[0], x[1]) + back * p, back * (by_p - scale_complex(rotate_left(p), spin))


@njit(**OPTIONS)
def _differentiate_point(
    carrier: int, point: complex, crank: complex, along: complex, out: complex, turns: Real, by: Complex
) -> None:
    """Write the derivatives of the coupler point, which is fixed in the crank, the coupler or the rocker."""
    direction = crank
    if carrier == CRANK:
        by[POINT, UNKNOWNS] = rotate_left(point * crank)
    elif carrier == COUPLER:
        direction = along
        for k in range(3, UNKNOWNS + 1):
            by[POINT, k] = by[A, k] + scale_complex(rotate_left(point * along), turns[0, k])
    elif carrier == ROCKER:
        direction = out
        for k in range(3, UNKNOWNS + 1):
            by[POINT, k] = by[B0, k] + scale_complex(rotate_left(point * out), turns[1, k])
    by[POINT, P], by[POINT, P + 1] = direction, rotate_left(direction)


@njit(**OPTIONS)
def _differentiate_pivot(f: complex, link: complex, second: float, by: Complex, spin: Real) -> None:
    """Write the derivatives of E and of the ground's angle; F = D → E, ``link`` = C → E, ``second`` = |F|."""
    g = rotate_left(link)
    per = dot(f, g)
    # Derivatives of E: the change of C − D turns and stretches the bar C–E.
    for k in range(3, UNKNOWNS + 1):
        apart = by[PIN, k]
        # D is itself an unknown and moves the other end of the bar.
        if k == D:
            apart -= 1.0
        elif k == D + 1:
            apart -= 1j
        rate = compute_turn_rate(f, apart, per)
        if k == DYAD:
            rate = compute_turn_rate(f, link, per)
            by[PIVOT, k] = link
        elif k == DYAD + 1:
            # ln r₂ changes |F| itself: dr₂ = r₂.
            rate = second * second / per
        by[PIVOT, k] += by[PIN, k] + scale_complex(g, rate)
        apart = by[PIVOT, k]
        if k == D:
            apart -= 1.0
        elif k == D + 1:
            apart -= 1j
        # Rotation of the ground link D → E.
        spin[k] = cross(f, apart) / (second * second)


@njit(**OPTIONS)
def compute_inverted_slopes(
    x: Real, lengths: Real, chart: Real, sign: float, carrier: int, side: float, theta: float, turns: Real,
    places: Complex, by: Complex,
) -> bool:  # fmt: skip
    """Return whether a Stephenson II closes; write the joints and their derivatives as the *input* sees them.

    Parameters
    ----------
    x, lengths, sign, carrier, side, theta
        As for :func:`compute_inverted_joints`.
    chart : float, shape (4, 4)
        Slopes of the lengths (:func:`synthesis.fit.chart.compute_lengths`).
    turns : float, shape (3, 16)
        Output: derivatives of the angles of link 4, of link 5, and of the ground.
    places, by : complex, shapes (7,) and (7, 16)
        Output: all joints, and their derivatives by the unknowns and, last, by θ. Those by the first three are 0.
    """
    # The first three unknowns place the linkage on the ground and have no effect in the input's frame.
    here = x.copy()
    here[:3] = 0.0
    closes, c, d = differentiate_pins(here, lengths, chart, sign, COUPLER, 0, theta, turns[:2], by[PIN], by[PIVOT])
    if not closes:
        return False
    first, second = math.exp(x[DYAD]), math.exp(x[DYAD + 1])
    closes, v = close_two_bars(d - c, first, second, side)
    if not closes:
        return False
    crank = compute_unit_vector(theta)
    _, along, out = close_fourbar(here, lengths, sign, crank, 1.0 + 0j)
    by[:] = 0.0
    turns[:, :3] = 0.0
    turn = turns[0]
    places[A0], places[A], places[B0] = 0j, scale_complex(crank, lengths[1]), complex(lengths[0], 0.0)
    bar, local, point = scale_complex(along, lengths[2]), complex(x[C], x[C + 1]), complex(x[P], x[P + 1])
    places[B], places[PIN] = places[A] + bar, c
    places[POINT] = locate_pin(carrier, point, 0j, lengths, 1.0 + 0j, crank, along, out)
    link = scale_complex(v, first)
    f = link - (d - c)
    places[PIVOT] = c + link
    for k in range(4):
        by[A, 3 + k] = scale_complex(crank, chart[1, k])
        by[B0, 3 + k] = complex(chart[0, k], 0.0)
    # The crank rotates about the frame's origin; the last column is the derivative by θ.
    by[A, UNKNOWNS] = rotate_left(places[A])
    swung = rotate_left(local * along)
    for k in range(3, UNKNOWNS + 1):
        by[B, k] = by[A, k] + scale_complex(rotate_left(bar), turn[k])
        by[PIN, k] = by[A, k] + scale_complex(swung, turn[k])
    for k in range(4):
        by[B, 3 + k] += scale_complex(along, chart[2, k])
    by[PIN, C], by[PIN, C + 1] = along, rotate_left(along)
    _differentiate_point(carrier, point, crank, along, out, turns, by)
    _differentiate_pivot(f, link, second, by, turns[2])
    return True


@njit(**OPTIONS)
def transform_to_ground(x: Real, joint: int, turns: Real, places: Complex, by: Complex, slopes: Complex) -> complex:
    """Return a joint relative to the ground and write its derivatives, shape (16,).

    ``turns``, ``places`` and ``by`` are the results of :func:`compute_inverted_slopes`.
    """
    d, spin = complex(x[D], x[D + 1]), turns[2]
    back = compute_unit_vector(x[2]) * scale_complex((places[PIVOT] - d).conjugate(), math.exp(-x[DYAD + 1]))
    here = places[joint] - d
    across_it = rotate_left(here)
    # Subtract the rotation of the ground, then rotate into its frame.
    for k in range(3, UNKNOWNS + 1):
        slopes[k] = by[joint, k] - scale_complex(across_it, spin[k])
    slopes[D] -= 1.0
    slopes[D + 1] -= 1j
    for k in range(3, UNKNOWNS + 1):
        slopes[k] = back * slopes[k]
    # The first three unknowns act on the ground: translation of O2 and rotation about it.
    slopes[0], slopes[1], slopes[2] = 1.0 + 0j, 1j, rotate_left(back * here)
    seen: complex = complex(x[0], x[1]) + back * here
    return seen


@njit(**OPTIONS)
def differentiate_slant(places: Complex, by: Complex, row: Real) -> float:
    """Return the cosine of the minimum transmission angle, and write its derivatives by the unknowns (15,)."""
    pins = places[PIN], places[PIVOT], places[A0], places[A], places[B0], places[B]
    cosine, _, leg = find_min_slant(*pins)
    for k in range(UNKNOWNS):
        row[k] = differentiate_leg_slant(
            leg, pins, (by[PIN, k], by[PIVOT, k], by[A0, k], by[A, k], by[B0, k], by[B, k])
        )
    return cosine
