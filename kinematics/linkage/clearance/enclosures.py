"""How far links can turn and joints can move while the input stays within a given distance of a known position.

The bounds are rigorous but for rounding, and shrink to nothing with the range of the input: with its root where a
mechanism is at a toggle, in proportion to it elsewhere. They go through the closures of :mod:`planar.closures` in
order. Let every known joint j lie within ε_j of its place in the known position, and every known link be turned from it
by at most δ. A closure Re(e^{−iφ} k) = r has the solutions φ = arg k ∓ arccos(r/|k|), so that

    δ ≤ (the most that arg k can change) + (the most that arccos(r/|k|) can change):

    RRR   |k| = b d with d the distance of the pins, r/|k| = (b² + d² − c²)/(2 b d); d changes by e = ε_p + ε_q at most;
          the ratio is least at d² = b² − c² where that is between the extremes of d, and monotone beside it;
    RPR   |k| = d, r is constant;
    RRP   |k| = b, arg k changes as the line's link turns, r by as much as the pin and the line's link at the pin move.

A change of a vector of length d by e turns it by arcsin(e/d) at most. A joint on a link lies within
ε + 2 ρ sin(δ/2) of its place, ε that of another joint of the link and ρ their distance.

The distance of two parts changes by no more than both of them move; by no more than they move beside a joint of both of
their links, since moving them together does not change it; and of one link by nothing. A disc about a joint is a part
of every link that has that joint.

Links of a class III group follow by the theorem in :mod:`planar.triads`: with η ω ≤ 1/2 the only solution lies within
2 η of the known one in a norm that weighs each link's rotation.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from kinematics.linkage.clearance.outlines import OPTIONS, Complex, Indices, Real
from kinematics.linkage.planar.drive_kernels import (
    CARRIED,
    GEAR,
    JOINT,
    KIND,
    LINK,
    OTHER,
    OTHER_PIN,
    PIN,
    RPR,
    RRP,
    RRR,
    SLIDE,
)
from kinematics.linkage.planar.triads import Loops, evaluate, invert

Mask = NDArray[np.bool_]

SHARES = 0.25 ** np.arange(0.0, 11.0)
"""Weights of the slowest link beside the fastest in the norm of the theorem: near a toggle the fastest alone counts."""

CONDITION = 1e12
"""Of the loop equations, beyond which too few digits are left to invert them."""


@njit(**OPTIONS)
def by_closures(
    rows: Indices,
    ratios: Real,
    gives: Indices,
    on: Mask,
    place: Complex,
    line: Complex,
    line_angles: Real,
    driver: Indices,
    places: Complex,
    turn: Complex,
    half: Real,
    turned: Real,
    moved: Real,
) -> None:
    """Fill the bounds of rotations and displacements.

    Parameters
    ----------
    rows, ratios, gives, place, line, line_angles, driver
        Of the :class:`Code` of a mechanism, those of its one design.
    on : bool, shape (links, joints)
        Which joints a link has.
    places : complex, shape (joints, n)
        Where the joints are at n positions, in unit coordinates.
    turn : complex, shape (links, n)
        e^{iφ} of the links there.
    half : float, shape (n,)
        How far the input may be from its value there: radians, or unit lengths of an input slide.
    turned : float, shape (links, n)
        Rotations, at most π. Those of the links of a class III group are given, the others are filled.
    moved : float, shape (joints, n)
        Displacements, in unit lengths, filled.
    """
    for n in range(len(half)):
        x = places[:, n]
        moved[:, n] = np.inf
        for j in range(1, gives[0, 0] + 1):
            moved[gives[0, j], n] = 0.0
        turned[0, n] = 0.0
        if driver[0] < 0:
            moved[driver[1], n] = half[n]
        else:
            turned[driver[0], n] = min(half[n], math.pi)
            _carry(driver[0], driver[1], n, gives, place, turned, moved)
        for row in range(len(rows)):
            step = rows[row]
            kind, link, pin, joint, other = step[KIND], step[LINK], step[PIN], step[JOINT], step[OTHER]
            if kind == GEAR:
                turned[link, n] = min(abs(ratios[row]) * turned[other, n], math.pi)
            elif kind == CARRIED:
                turned[link, n] = _swing(moved[pin, n] + moved[joint, n], abs(place[joint] - place[pin]))
            elif kind == RRR:
                other_pin = step[OTHER_PIN]
                apart, d = moved[pin, n] + moved[other_pin, n], abs(x[other_pin] - x[pin])
                b, c = abs(place[joint] - place[pin]), abs(place[joint] - place[other_pin])
                about = _swing(apart, d)
                turned[link, n] = min(about + _opening(b, c, d, apart), math.pi)
                turned[other, n] = min(about + _opening(c, b, d, apart), math.pi)
                _carry(other, other_pin, n, gives, place, turned, moved)
                # The joint that they share is known by both.
                chord = 2.0 * c * math.sin(0.5 * turned[other, n])
                moved[joint, n] = min(moved[joint, n], moved[other_pin, n] + chord)
            elif kind == RPR:
                apart, d = moved[pin, n] + moved[joint, n], abs(x[joint] - x[pin])
                angle = line_angles[step[SLIDE]]
                normal = complex(-math.sin(angle), math.cos(angle))
                r = (normal.conjugate() * (line[step[SLIDE]] - place[pin])).real
                least = max(d - apart, abs(r))
                spread = 0.0
                if r != 0.0:
                    spread = _spread(r / max(d, abs(r)), r / (d + apart), r / least)
                turned[link, n] = min(_swing(apart, d) + spread, math.pi)
            elif kind == RRP:
                # The point of the line's link that lies at the pin moves no farther than a joint of it, and about it.
                carried = 0.0
                if other != 0:
                    carried = np.inf
                    for k in range(len(place)):
                        if on[other, k]:
                            chord = 2.0 * abs(x[pin] - x[k]) * math.sin(0.5 * turned[other, n])
                            carried = min(carried, moved[k, n] + chord)
                e = moved[pin, n] + carried
                angle = line_angles[step[SLIDE]]
                normal = turn[other, n] * complex(-math.sin(angle), math.cos(angle))
                length = abs(place[joint] - place[pin])
                ratio = (normal.conjugate() * (x[joint] - x[pin])).real / length
                spread = _spread(ratio, ratio - e / length, ratio + e / length)
                turned[link, n] = min(turned[other, n] + spread, math.pi)
            _carry(link, pin, n, gives, place, turned, moved)


@njit(**OPTIONS)
def _carry(link: int, pin: int, n: int, gives: Indices, place: Complex, turned: Real, moved: Real) -> None:
    """Displacements of the joints that a link makes known."""
    for j in range(1, gives[link, 0] + 1):
        joint = gives[link, j]
        chord = 2.0 * abs(place[joint] - place[pin]) * math.sin(0.5 * turned[link, n])
        moved[joint, n] = min(moved[joint, n], moved[pin, n] + chord)


@njit(**OPTIONS)
def _swing(change: float, length: float) -> float:
    """What a vector of this length turns by at most when it changes by a vector of at most this length."""
    return math.asin(change / length) if change < length else math.pi


@njit(**OPTIONS)
def _opening(b: float, c: float, d: float, apart: float) -> float:
    """By how much the angle of a triangle between the sides b and d changes at most when d does by ``apart``.

    Only where the triangle exists.
    """
    low, high = max(d - apart, abs(b - c)), min(d + apart, b + c)
    spread = _spread(_cosine(b, c, d), _cosine(b, c, low), _cosine(b, c, high))
    if b > c:
        turning = math.sqrt((b - c) * (b + c))
        if low < turning < high:
            spread = max(spread, abs(math.acos(min(max(_cosine(b, c, d), -1.0), 1.0)) - math.acos(turning / b)))
    return float(spread)


@njit(**OPTIONS)
def _cosine(b: float, c: float, d: float) -> float:
    """Cosine of the angle of a triangle between its sides b and d; 0 in the limit of no d."""
    return ((b - c) * (b + c) + d * d) / (2.0 * b * d) if d > 0.0 else 0.0


@njit(**OPTIONS)
def _spread(cosine: float, low: float, high: float) -> float:
    """The most that the angle of a cosine differs from the angles of two others, those beyond ±1 being at ±1."""
    angle = math.acos(min(max(cosine, -1.0), 1.0))
    first = abs(math.acos(min(max(low, -1.0), 1.0)) - angle)
    return float(max(first, abs(math.acos(min(max(high, -1.0), 1.0)) - angle)))


@njit(**OPTIONS)
def approaches(on: Mask, carries: Mask, reach: Real, pairs: Indices, items: Indices, turned: Real, moved: Real) -> Real:
    """By how much the distances of pairs may be less than they are in known positions.

    Parameters
    ----------
    on : bool, shape (links, joints)
        Which joints a link has; link 0 is the ground.
    carries : bool, shape (parts, links)
        The links that a part is at rest on.
    reach : float, shape (parts, joints)
        How far the points of a part are from a joint at most, in unit lengths.
    pairs : int, shape (p, 2)
        Parts.
    items : int, shape (m, 2)
        Which pair at which position.
    turned, moved : float, shapes (links, n) and (joints, n)
        Bounds of :func:`by_closures`.

    Returns
    -------
    float, shape (m,)
        In unit lengths.
    """
    out = np.empty(len(items))
    for m in range(len(items)):
        pair, n = items[m]
        p, q = pairs[pair]
        least = _alone(on, carries, reach, p, n, turned, moved) + _alone(on, carries, reach, q, n, turned, moved)
        for link in range(len(on)):
            if not carries[p, link]:
                continue
            for other in range(len(on)):
                if not carries[q, other]:
                    continue
                if other == link:
                    least = 0.0
                chord, across = 2.0 * math.sin(0.5 * turned[link, n]), 2.0 * math.sin(0.5 * turned[other, n])
                for j in range(on.shape[1]):
                    if on[link, j] and on[other, j]:
                        least = min(least, reach[p, j] * chord + reach[q, j] * across)
        out[m] = least
    return out


@njit(**OPTIONS)
def _alone(on: Mask, carries: Mask, reach: Real, part: int, n: int, turned: Real, moved: Real) -> float:
    """How far the points of a part move at most."""
    least = np.inf
    for link in range(len(on)):
        if carries[part, link]:
            if link == 0:
                return 0.0
            chord = 2.0 * math.sin(0.5 * turned[link, n])
            for j in range(on.shape[1]):
                if on[link, j]:
                    least = min(least, moved[j, n] + reach[part, j] * chord)
    return least


def by_theorem(loops: Loops, rotations: Real, half: Real) -> Real:
    """Bounds of the rotations of a class III group; π where the theorem does not hold.

    Parameters
    ----------
    loops : Loops
        Of one design.
    rotations : float, shape (links, n)
        Of the unknown links, at n positions, radians.
    half : float, shape (n,)
        How far the input may be from its value there, radians.

    Returns
    -------
    float, shape (links, n)
    """
    bounds = np.full(rotations.shape, np.pi)
    _within_balls(loops.coefficients, loops.by_input, rotations, half, bounds)
    return bounds


@njit(**OPTIONS)
def _within_balls(c: Complex, k: Complex, rotations: Real, half: Real, bounds: Real) -> None:
    """Lower the bounds to the radii of the balls; c and k are those of the loops."""
    loops, links = c.shape
    value, inverse = np.empty(links), np.empty((links, links))
    rate, strength, weight = np.empty(links), np.empty((links, links)), np.empty(links)
    none = np.zeros(loops, np.complex128)
    for n in range(len(half)):
        phi = rotations[:, n].copy()
        if not np.isfinite(phi).all():
            continue
        evaluate(c, none, none, phi, 0.0, value, inverse)
        largest = 0.0
        for row in range(links):
            largest = max(largest, np.abs(inverse[row]).sum())
        if not invert(inverse) * largest < CONDITION:
            continue
        change = 2.0 * math.sin(0.5 * min(half[n], math.pi))
        for row in range(links):
            by_input = 0j
            for loop in range(loops):
                by_input += complex(inverse[row, loop], -inverse[row, loop + loops]) * k[loop]
            rate[row] = abs(by_input) * change
            for col in range(links):
                by_link = 0j
                for loop in range(loops):
                    by_link += complex(inverse[row, loop], -inverse[row, loop + loops]) * c[loop, col]
                strength[row, col] = abs(by_link)
        fastest = rate.max()
        for share in SHARES:
            eta = omega = 0.0
            for row in range(links):
                weight[row] = rate[row] + share * fastest
                if weight[row] == 0.0:
                    weight[row] = 1.0
            for row in range(links):
                eta = max(eta, rate[row] / weight[row])
                bend = 0.0
                for col in range(links):
                    bend += strength[row, col] * weight[col] * weight[col]
                omega = max(omega, bend / weight[row])
            if eta * omega <= 0.5:
                radius = 2.0 * eta / (1.0 + math.sqrt(1.0 - 2.0 * eta * omega))
                for row in range(links):
                    bounds[row, n] = min(bounds[row, n], weight[row] * radius)
