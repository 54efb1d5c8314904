"""Bounds for rotations of links and displacements of joints while the input stays near a known position.

The bounds are rigorous except for rounding, and shrink to zero with the range of the input: with its root at a toggle,
in proportion to it elsewhere. They follow the closures of :mod:`planar.closures` in order. Let every known joint j lie
within ε_j of its place in the known position, and every known link be rotated from it by at most δ. A closure
Re(e^{−iφ} k) = r has the solutions φ = arg k ∓ arccos(r/|k|), so that

    δ ≤ (maximum change of arg k) + (maximum change of arccos(r/|k|)):

    RRR   |k| = b d with d the distance of the pins, r/|k| = (b² + d² − c²)/(2 b d); d changes by e = ε_p + ε_q at most;
          the ratio is minimal at d² = b² − c² if that lies between the extremes of d, and monotonic otherwise;
    RPR   |k| = d, r is constant;
    RRP   |k| = b, arg k changes as the line's link turns, r by as much as the pin and the line's link at the pin move.

A change of a vector of length d by e turns it by arcsin(e/d) at most. A joint on a link lies within
ε + 2 ρ sin(δ/2) of its place, ε that of another joint of the link and ρ their distance.

The distance of two parts changes by no more than the sum of their motions. If their links share a joint, only the
motion relative to that joint counts, since moving both together does not change the distance; parts of one link keep
their distance. A disc about a joint is a part of every link that has that joint.

Links of a class III group follow by the theorem in :mod:`planar.triads`: with η ω ≤ 1/2 the only solution lies within
2 η of the known one in a norm that weighs each link's rotation.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Integers, Mask, Real
from kinematics.compiling import njit
from kinematics.linkage.clearance.outlines import OPTIONS
from kinematics.linkage.planar.drive_kernels import (
    CARRIED_LINK,
    GEAR,
    JOINT,
    KIND,
    LINK,
    OTHER_LINK,
    OTHER_PIN,
    PIN,
    RPR,
    RRP,
    RRR,
    SLIDE,
)
from kinematics.linkage.planar.triads import Loops, evaluate, invert

NORM_WEIGHTS = 0.25 ** np.arange(0.0, 11.0)
"""Weights of the slowest link relative to the fastest in the norm of the theorem: near a toggle only the fastest
counts."""

MAX_CONDITION = 1e12
"""Condition number of the loop equations above which too few digits remain to invert them."""


@njit(**OPTIONS)
def _find_normal(angle: float) -> complex:
    """Return the unit normal of a line at an angle."""
    return complex(-math.sin(angle), math.cos(angle))


@njit(**OPTIONS)
def _bound_slotted(apart: float, d: float, r: float) -> float:
    """Bound the rotation of a link whose line, at the signed distance r from its pin, goes through a joint.

    ``d`` is the distance of pin and joint, which changes by at most ``apart``.
    """
    # The closure exists only for distances of at least |r|.
    least = max(d - apart, abs(r))
    spread = 0.0
    # With r = 0 the angle does not depend on the distance.
    if r != 0.0:
        spread = _bound_spread(r / max(d, abs(r)), r / (d + apart), r / least)
    return float(min(_bound_swing(apart, d) + spread, math.pi))


@njit(**OPTIONS)
def _bound_carried(x: Complex, on: Mask, pin: int, turned: float, moved: Real) -> float:
    """Bound the displacement of the point of a link at a pin that is not its own.

    It moves at most as far as a joint of the link (``on``), plus the displacement by the rotation about that joint.
    """
    carried = np.inf
    for k in range(len(x)):
        if on[k]:
            chord = 2.0 * abs(x[pin] - x[k]) * math.sin(0.5 * turned)
            carried = min(carried, moved[k] + chord)
    return carried


@njit(**OPTIONS)
def bound_by_closures(
    rows: Integers,
    ratios: Real,
    gives: Integers,
    on: Mask,
    place: Complex,
    line: Complex,
    line_angles: Real,
    driver: Integers,
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
        Arrays of the :class:`Code` of a mechanism with a single design.
    on : bool, shape (links, joints)
        Joints of each link.
    places : complex, shape (joints, n)
        Joints at n positions, in unit coordinates.
    turn : complex, shape (links, n)
        e^{iφ} of the links there.
    half : float, shape (n,)
        Half the range of the input about its value there: radians, or unit lengths along an input slide.
    turned : float, shape (links, n)
        Rotations, at most π. Those of the links of a class III group are given, the others are filled.
    moved : float, shape (joints, n)
        Displacements, in unit lengths, filled.
    """
    for n in range(len(half)):
        x = places[:, n]
        moved[:, n] = np.inf
        for j in range(1, gives[0, 0] + 1):
            # Joints on the ground do not move.
            moved[gives[0, j], n] = 0.0
        turned[0, n] = 0.0
        if driver[0] < 0:
            moved[driver[1], n] = half[n]
        else:
            # A rotation of π bounds every rotation, since chords are largest there.
            turned[driver[0], n] = min(half[n], math.pi)
            _bound_joints(driver[0], driver[1], n, gives, place, turned, moved)
        for row in range(len(rows)):
            step = rows[row]
            kind, link, pin, joint, other = step[KIND], step[LINK], step[PIN], step[JOINT], step[OTHER_LINK]
            if kind == GEAR:
                turned[link, n] = min(abs(ratios[row]) * turned[other, n], math.pi)
            elif kind == CARRIED_LINK:
                turned[link, n] = _bound_swing(moved[pin, n] + moved[joint, n], abs(place[joint] - place[pin]))
            elif kind == RRR:
                other_pin = step[OTHER_PIN]
                apart, d = moved[pin, n] + moved[other_pin, n], abs(x[other_pin] - x[pin])
                b, c = abs(place[joint] - place[pin]), abs(place[joint] - place[other_pin])
                about = _bound_swing(apart, d)
                turned[link, n] = min(about + _bound_opening(b, c, d, apart), math.pi)
                turned[other, n] = min(about + _bound_opening(c, b, d, apart), math.pi)
                _bound_joints(other, other_pin, n, gives, place, turned, moved)
                # The shared joint is bounded by both links; keep the smaller bound.
                chord = 2.0 * c * math.sin(0.5 * turned[other, n])
                moved[joint, n] = min(moved[joint, n], moved[other_pin, n] + chord)
            elif kind == RPR:
                distance = (_find_normal(line_angles[step[SLIDE]]).conjugate() * (line[step[SLIDE]] - place[pin])).real
                turned[link, n] = _bound_slotted(moved[pin, n] + moved[joint, n], abs(x[joint] - x[pin]), distance)
            elif kind == RRP:
                carried = _bound_carried(x, on[other], pin, turned[other, n], moved[:, n]) if other != 0 else 0.0
                e = moved[pin, n] + carried
                normal = turn[other, n] * _find_normal(line_angles[step[SLIDE]])
                length = abs(place[joint] - place[pin])
                ratio = (normal.conjugate() * (x[joint] - x[pin])).real / length
                spread = _bound_spread(ratio, ratio - e / length, ratio + e / length)
                turned[link, n] = min(turned[other, n] + spread, math.pi)
            _bound_joints(link, pin, n, gives, place, turned, moved)


@njit(**OPTIONS)
def _bound_joints(link: int, pin: int, n: int, gives: Integers, place: Complex, turned: Real, moved: Real) -> None:
    """Bound the displacements of the joints that a link determines."""
    for j in range(1, gives[link, 0] + 1):
        joint = gives[link, j]
        chord = 2.0 * abs(place[joint] - place[pin]) * math.sin(0.5 * turned[link, n])
        moved[joint, n] = min(moved[joint, n], moved[pin, n] + chord)


@njit(**OPTIONS)
def _bound_swing(change: float, length: float) -> float:
    """Return the maximum rotation of a vector of given length when it changes by a vector of size ``change``."""
    # A change larger than the vector can turn it anywhere.
    return math.asin(change / length) if change < length else math.pi


@njit(**OPTIONS)
def _bound_opening(b: float, c: float, d: float, apart: float) -> float:
    """Bound the change of a triangle's angle between the sides b and d when d changes by at most ``apart``.

    Only values of d for which the triangle exists count.
    """
    low, high = max(d - apart, abs(b - c)), min(d + apart, b + c)
    spread = _bound_spread(_compute_cosine(b, c, d), _compute_cosine(b, c, low), _compute_cosine(b, c, high))
    # For b > c the angle is not monotonic in d: it has a maximum where c is normal to d.
    if b > c:
        turning = math.sqrt((b - c) * (b + c))
        if low < turning < high:
            spread = max(spread, abs(math.acos(min(max(_compute_cosine(b, c, d), -1.0), 1.0)) - math.acos(turning / b)))
    return float(spread)


@njit(**OPTIONS)
def _compute_cosine(b: float, c: float, d: float) -> float:
    """Return the cosine of a triangle's angle between its sides b and d; 0 in the limit d → 0."""
    return ((b - c) * (b + c) + d * d) / (2.0 * b * d) if d > 0.0 else 0.0


@njit(**OPTIONS)
def _bound_spread(cosine: float, low: float, high: float) -> float:
    """Return the maximum difference of the angle of a cosine from the angles of two others, clipped to ±1."""
    angle = math.acos(min(max(cosine, -1.0), 1.0))
    first = abs(math.acos(min(max(low, -1.0), 1.0)) - angle)
    return float(max(first, abs(math.acos(min(max(high, -1.0), 1.0)) - angle)))


@njit(**OPTIONS)
def bound_approaches(
    on: Mask, carries: Mask, reach: Real, pairs: Integers, items: Integers, turned: Real, moved: Real
) -> Real:
    """Bound the decrease of the distances of pairs around known positions.

    Parameters
    ----------
    on : bool, shape (links, joints)
        Joints of each link; link 0 is the ground.
    carries : bool, shape (parts, links)
        Links relative to which a part is at rest.
    reach : float, shape (parts, joints)
        Maximum distance of the points of a part from a joint, in unit lengths.
    pairs : int, shape (p, 2)
        Parts.
    items : int, shape (m, 2)
        Pair and position of each item.
    turned, moved : float, shapes (links, n) and (joints, n)
        Bounds of :func:`bound_by_closures`.

    Returns
    -------
    float, shape (m,)
        Bounds in unit lengths.
    """
    out = np.empty(len(items))
    for m in range(len(items)):
        pair, n = items[m]
        p, q = pairs[pair]
        least = _bound_motion(on, carries, reach, p, n, turned, moved) + _bound_motion(
            on, carries, reach, q, n, turned, moved
        )
        for link in range(len(on)):
            if not carries[p, link]:
                continue
            for other in range(len(on)):
                if not carries[q, other]:
                    continue
                # Parts at rest on the same link keep their distance.
                if other == link:
                    least = 0.0
                chord, across = 2.0 * math.sin(0.5 * turned[link, n]), 2.0 * math.sin(0.5 * turned[other, n])
                for j in range(on.shape[1]):
                    if on[link, j] and on[other, j]:
                        least = min(least, reach[p, j] * chord + reach[q, j] * across)
        out[m] = least
    return out


@njit(**OPTIONS)
def _bound_motion(on: Mask, carries: Mask, reach: Real, part: int, n: int, turned: Real, moved: Real) -> float:
    """Bound the motion of the points of a part."""
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


def bound_by_theorem(loops: Loops, rotations: Real, half: Real) -> Real:
    """Bound the rotations of a class III group; π where the theorem does not apply.

    Parameters
    ----------
    loops : Loops
        Loops of one design.
    rotations : float, shape (links, n)
        Rotations of the unknown links at n positions, radians.
    half : float, shape (n,)
        Half the range of the input about its value there, radians.

    Returns
    -------
    float, shape (links, n)
    """
    bounds = np.full(rotations.shape, np.pi)
    _bound_by_balls(loops.coefficients, loops.by_input, rotations, half, bounds)
    return bounds


@njit(**OPTIONS)
def _bound_by_balls(c: Complex, k: Complex, rotations: Real, half: Real, bounds: Real) -> None:
    """Reduce the bounds to the radii of the balls; c and k are those of the loops."""
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
        # The loops are ill-conditioned near a toggle: keep the trivial bound π.
        if not invert(inverse) * largest < MAX_CONDITION:
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
        # Any norm gives a valid bound, so try several and keep the smallest radius per link.
        for share in NORM_WEIGHTS:
            eta = omega = 0.0
            for row in range(links):
                weight[row] = rate[row] + share * fastest
                if weight[row] == 0.0:
                    # A link without rate may have any weight.
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
