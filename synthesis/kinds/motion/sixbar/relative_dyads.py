"""Dyads between two moving bodies in five relative poses, compiled for thousands of pairs of bodies.

Relative to the first body, the second takes five positions X → r_k X + c_k, the first of which is the identity. A link
pinned to both, at O on the first and A on the second, has constant length: four conditions that are linear in

    x = (p, A, O, d + ie),      with two quadrics p (d + ie) = conj(O) A
    (:mod:`synthesis.kinds.motion.dyads.finite_sets`).

They leave a plane in which the quadrics are two conics. A member det(F₁ + λF₂) = 0 of their pencil is a pair of lines,
which intersect the conics in the four common points (Richter-Gebert, *Perspectives on Projective Geometry*, Sec. 11.4);
real ones are refined by Newton's method. :func:`synthesis.kinds.motion.dyads.finite_sets.find_section` finds a provably
complete set for one pair of bodies; this module solves thousands in the same time, and drops dyads that do not
converge.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import types

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.numerics.elimination import factor, solve

_PLACES = types.complex128[::1]

CONDITION_COUNT = 4
"""Number of conditions of five positions."""

MAX_DYADS = 4
"""Maximum number of dyads of five positions."""

MIN_PIVOT = 1e-13
"""Minimum pivot of the elimination of unit rows; below it the conditions are dependent, and no dyad of the family is
returned."""

MAX_DISTANCE = 100.0
"""Maximum distance of a usable pivot, in task sizes."""

NEWTON_STEPS, CONVERGENCE_TOLERANCE = 8, 1e-13
"""Maximum number of Newton steps, and the convergence tolerance of the residual relative to the squared dyad size."""

DUPLICATE_TOLERANCE = 1e-7
"""Distance of two dyads, relative to their size, below which they are duplicates."""

JIT_OPTIONS: Any = {"cache": True, "nogil": True, "error_model": "numpy"}


@njit(**JIT_OPTIONS)
def compute_relative_poses(
    one: Complex, one_turn: Complex, other: Complex, other_turn: Complex, shift: Complex, turn: Complex
) -> None:
    """Compute the poses of a body relative to a first one: X → turn · X + shift; all arrays have shape (5,).

    A body's pose moves its points from the first position to X → z + u (X − z₀), with u₀ = 1.
    """
    for k in range(len(one)):
        back = one_turn[k].conjugate()
        turn[k] = back * other_turn[k]
        # Undo the first body's motion, applied to the second body's.
        shift[k] = one[0] + back * (other[k] - one[k]) - turn[k] * other[0]


@njit(
    types.int64(_PLACES, _PLACES, types.complex128, types.complex128, _PLACES, _PLACES),
    **JIT_OPTIONS,
)
def solve_relative_dyads(
    shift: Complex, turn: Complex, known_fixed: complex, known_moving: complex, fixed: Complex, moving: Complex
) -> int:
    """Solve for all real dyads of five relative poses, except a known one; return their number, at most four.

    Parameters
    ----------
    shift, turn : complex, shape (5,)
        Poses of :func:`compute_relative_poses`.
    known_fixed, known_moving : complex
        A dyad that already joins the bodies; NaN for none.
    fixed, moving : complex, shape (4,)
        Output: pins on the first and on the second body, in the first position.
    """
    basis = np.empty((7, 3))
    # Dependent conditions leave a family of dyads, of which none is preferred.
    if not _solve_plane(shift, turn, basis):
        return 0
    first, second = np.empty((3, 3)), np.empty((3, 3))
    _restrict_conics(basis, first, second)
    points, x, pair = np.empty((MAX_DYADS, 3)), np.empty(7), np.empty(2, np.complex128)
    found = _intersect_conics(first, second, points)
    count = 0
    for n in range(found):
        for i in range(7):
            x[i] = basis[i, 0] * points[n, 0] + basis[i, 1] * points[n, 1] + basis[i, 2] * points[n, 2]
        # A small p means pivots far away: nearly a slider.
        if abs(x[0]) * MAX_DISTANCE <= math.hypot(x[1], x[2]) or abs(x[0]) * MAX_DISTANCE <= math.hypot(x[3], x[4]):
            continue
        pair[0], pair[1] = complex(x[3], x[4]) / x[0], complex(x[1], x[2]) / x[0]
        if not _refine_dyad(shift, turn, pair):
            continue
        size = 1.0 + abs(pair[0]) + abs(pair[1])
        # Written as "not <=", so that a NaN known dyad never counts as equal.
        new = not (abs(pair[0] - known_fixed) + abs(pair[1] - known_moving) <= DUPLICATE_TOLERANCE * size)
        for m in range(count):
            new &= abs(pair[0] - fixed[m]) + abs(pair[1] - moving[m]) > DUPLICATE_TOLERANCE * size
        if new:
            fixed[count], moving[count] = pair[0], pair[1]
            count += 1
    return count


@njit(**JIT_OPTIONS)
def _solve_plane(shift: Complex, turn: Complex, basis: Real) -> bool:
    """Solve the four conditions by elimination with full pivoting: write a basis of the null space, columns (7, 3).

    Return False if the conditions are dependent.
    """
    rows = np.empty((CONDITION_COUNT, 7))
    for k in range(CONDITION_COUNT):
        r, c = turn[k + 1], shift[k + 1]
        forward = r.conjugate() * c
        # 1 − cos from the sine avoids cancellation at small rotations.
        fall = r.imag * r.imag / (1.0 + abs(r.real)) if r.real > 0.0 else 1.0 - r.real
        rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3] = 0.5 * abs(c) ** 2, forward.real, forward.imag, -c.real
        rows[k, 4], rows[k, 5], rows[k, 6] = -c.imag, fall, r.imag
        size = 0.0
        for i in range(7):
            size += rows[k, i] * rows[k, i]
        for i in range(7):
            # Unit rows make the pivot tolerance meaningful.
            rows[k, i] /= math.sqrt(size)
    order = np.arange(7)
    for n in range(CONDITION_COUNT):
        best, row, column = 0.0, n, n
        for i in range(n, CONDITION_COUNT):
            for j in range(n, 7):
                if abs(rows[i, order[j]]) > best:
                    best, row, column = abs(rows[i, order[j]]), i, j
        if not best > MIN_PIVOT:
            return False
        for j in range(7):
            rows[n, j], rows[row, j] = rows[row, j], rows[n, j]
        order[n], order[column] = order[column], order[n]
        pivot = rows[n, order[n]]
        # Gauss–Jordan: the columns of the free unknowns then give the null space directly.
        for j in range(7):
            rows[n, j] /= pivot
        for i in range(CONDITION_COUNT):
            factor = 0.0 if i == n else rows[i, order[n]]
            for j in range(7):
                rows[i, j] -= factor * rows[n, j]
    for i in range(7):
        for m in range(3):
            basis[i, m] = 0.0
    for m in range(3):
        free = order[CONDITION_COUNT + m]
        basis[free, m] = 1.0
        for n in range(CONDITION_COUNT):
            basis[order[n], m] = -rows[n, free]
        # Unit vectors keep the conics well scaled.
        size = 0.0
        for i in range(7):
            size += basis[i, m] * basis[i, m]
        for i in range(7):
            basis[i, m] /= math.sqrt(size)
    return True


@njit(**JIT_OPTIONS)
def _restrict_conics(basis: Real, first: Real, second: Real) -> None:
    """Write the quadrics restricted to the plane, as symmetric matrices of unit norm."""
    sizes = np.zeros(2)
    for i in range(3):
        p, ax, ay, ox, oy, d, e = (
            basis[0, i], basis[1, i], basis[2, i], basis[3, i], basis[4, i], basis[5, i], basis[6, i],
        )  # fmt: skip
        for j in range(3):
            first[i, j] = p * basis[5, j] + basis[0, j] * d
            first[i, j] -= ox * basis[1, j] + basis[3, j] * ax + oy * basis[2, j] + basis[4, j] * ay
            second[i, j] = p * basis[6, j] + basis[0, j] * e
            second[i, j] -= ox * basis[2, j] + basis[3, j] * ay - oy * basis[1, j] - basis[4, j] * ax
            sizes[0] += first[i, j] ** 2
            sizes[1] += second[i, j] ** 2
    for i in range(3):
        for j in range(3):
            # The tiny summand avoids 0/0 for a conic that vanishes on the plane.
            first[i, j] /= math.sqrt(sizes[0]) + 1e-300
            second[i, j] /= math.sqrt(sizes[1]) + 1e-300


@njit(**JIT_OPTIONS)
def _compute_adjugate(m: Real, out: Real) -> None:
    """Compute the adjugate of a symmetric 3 × 3 matrix."""
    out[0, 0] = m[1, 1] * m[2, 2] - m[1, 2] * m[1, 2]
    out[1, 1] = m[0, 0] * m[2, 2] - m[0, 2] * m[0, 2]
    out[2, 2] = m[0, 0] * m[1, 1] - m[0, 1] * m[0, 1]
    out[0, 1] = out[1, 0] = m[0, 2] * m[1, 2] - m[0, 1] * m[2, 2]
    out[0, 2] = out[2, 0] = m[0, 1] * m[1, 2] - m[0, 2] * m[1, 1]
    out[1, 2] = out[2, 1] = m[0, 1] * m[0, 2] - m[0, 0] * m[1, 2]


@njit(**JIT_OPTIONS)
def _intersect_conics(first: Real, second: Real, points: Real) -> int:
    """Find the real common points of two conics, shape (count, 3); return their number."""
    adjugate, other = np.empty((3, 3)), np.empty((3, 3))
    _compute_adjugate(first, adjugate)
    _compute_adjugate(second, other)
    # Coefficients of det(F₁ + λ F₂), from the derivatives of the determinant.
    c0 = c1 = c2 = c3 = 0.0
    for i in range(3):
        c0 += adjugate[0, i] * first[0, i]
        c3 += other[0, i] * second[0, i]
        for j in range(3):
            c1 += adjugate[i, j] * second[i, j]
            c2 += other[i, j] * first[i, j]
    roots = np.empty((3, 2))
    pair, bars = np.empty((3, 3)), np.empty((2, 3))
    for n in range(_solve_cubic(c0, c1, c2, c3, roots)):
        # Any real line pair of the pencil gives all common points; try the next root only if its lines are complex.
        for i in range(3):
            for j in range(3):
                pair[i, j] = roots[n, 0] * first[i, j] + roots[n, 1] * second[i, j]
        if not _split_lines(pair, bars):
            continue
        count = 0
        for i in range(2):
            count = _intersect_line(bars[i], first, second, points, count)
        if count:
            return count
    return 0


@njit(**JIT_OPTIONS)
def _solve_cubic(c0: float, c1: float, c2: float, c3: float, roots: Real) -> int:
    """Find the real roots (μ, λ) of c₀μ³ + c₁μ²λ + c₂μλ² + c₃λ³ as unit vectors; return their number."""
    # Divide by the larger of the end coefficients; exchanging μ and λ reverses the coefficients.
    turned = abs(c3) < abs(c0)
    count: int = _solve_proper_cubic(c3, c2, c1, c0, roots) if turned else _solve_proper_cubic(c0, c1, c2, c3, roots)
    for n in range(count if turned else 0):
        roots[n, 0], roots[n, 1] = roots[n, 1], roots[n, 0]
    return count


@njit(**JIT_OPTIONS)
def _solve_proper_cubic(c0: float, c1: float, c2: float, c3: float, roots: Real) -> int:
    """Find the same roots by Cardano's formula, if c₃ does not vanish; polish them by Newton's method."""
    if c3 == 0.0:
        return 0
    a, b, c = c2 / c3, c1 / c3, c0 / c3
    q, r = (a * a - 3.0 * b) / 9.0, (2.0 * a * a * a - 9.0 * a * b + 27.0 * c) / 54.0
    values = np.empty(3)
    # Three real roots: the trigonometric form avoids complex numbers.
    if r * r < q * q * q:
        angle = math.acos(min(max(r / math.sqrt(q * q * q), -1.0), 1.0))
        for n in range(3):
            values[n] = -2.0 * math.sqrt(q) * math.cos((angle + 2.0 * math.pi * n) / 3.0) - a / 3.0
        count = 3
    else:
        # One real root; copysign avoids cancellation in the cube root's argument.
        big = -math.copysign((abs(r) + math.sqrt(r * r - q * q * q)) ** (1.0 / 3.0), r)
        values[0] = big + (q / big if big != 0.0 else 0.0) - a / 3.0
        count = 1
    for n in range(count):
        x = values[n]
        # Cardano loses digits for clustered roots; three Newton steps restore them.
        for _ in range(3):
            slope = (3.0 * x + 2.0 * a) * x + b
            if slope != 0.0:
                x -= (((x + a) * x + b) * x + c) / slope
        size = math.hypot(1.0, x)
        roots[n, 0], roots[n, 1] = 1.0 / size, x / size
    return count


@njit(**JIT_OPTIONS)
def _split_lines(pair: Real, bars: Real) -> bool:
    """Split a conic of rank two into its two lines (2, 3); return whether they are real."""
    adjugate = np.empty((3, 3))
    _compute_adjugate(pair, adjugate)
    # Divide by the largest diagonal entry: the lines' intersection.
    i = 0
    for j in range(1, 3):
        if abs(adjugate[j, j]) > abs(adjugate[i, i]):
            i = j
    # A positive minor means a pair of complex lines.
    if not adjugate[i, i] < 0.0:
        return False
    root = math.sqrt(-adjugate[i, i])
    x, y, z = adjugate[0, i] / root, adjugate[1, i] / root, adjugate[2, i] / root
    single = pair.copy()
    # Adding the cross-product matrix of the intersection leaves a matrix of rank one: line times line.
    single[0, 1], single[0, 2], single[1, 2] = single[0, 1] + z, single[0, 2] - y, single[1, 2] + x
    single[1, 0], single[2, 0], single[2, 1] = single[1, 0] - z, single[2, 0] + y, single[2, 1] - x
    # Read both lines from the largest entry, for accuracy.
    row, column = 0, 0
    for m in range(3):
        for n in range(3):
            if abs(single[m, n]) > abs(single[row, column]):
                row, column = m, n
    if single[row, column] == 0.0:
        return False
    for i in range(3):
        bars[0, i], bars[1, i] = single[row, i], single[i, column]
    return True


@njit(**JIT_OPTIONS)
def _intersect_line(line: Real, first: Real, second: Real, points: Real, count: int) -> int:
    """Append the real points of a line on both conics, from the conic with the larger restriction to the line."""
    # Eliminate the coordinate with the largest coefficient, to parametrise the line without small divisors.
    i = 0
    for j in range(1, 3):
        if abs(line[j]) > abs(line[i]):
            i = j
    j, k = (i + 1) % 3, (i + 2) % 3
    along = np.zeros((2, 3))
    along[0, j], along[0, i] = 1.0, -line[j] / line[i]
    along[1, k], along[1, i] = 1.0, -line[k] / line[i]
    a = b = c = 0.0
    for n in range(2):
        conic = first if n == 0 else second
        u = v = w = 0.0
        for m in range(3):
            for o in range(3):
                u += along[0, m] * conic[m, o] * along[0, o]
                v += along[0, m] * conic[m, o] * along[1, o]
                w += along[1, m] * conic[m, o] * along[1, o]
        # The line may lie on one conic, whose restriction then vanishes.
        if abs(u) + abs(v) + abs(w) > abs(a) + abs(b) + abs(c):
            a, b, c = u, v, w
    square = b * b - a * c
    # No real intersection; also false for NaN.
    if not square >= 0.0:
        return count
    # a s² + 2 b s t + c t² = 0
    # The stable form of the quadratic formula: no cancellation.
    q = -(b + math.copysign(math.sqrt(square), b))
    for n in range(2):
        s, t = (q, a) if n == 0 else (c, q)
        if (s != 0.0 or t != 0.0) and count < len(points):
            size = math.hypot(s, t)
            for m in range(3):
                points[count, m] = (s * along[0, m] + t * along[1, m]) / size
            count += 1
    return count


@njit(**JIT_OPTIONS)
def _refine_dyad(shift: Complex, turn: Complex, pair: Complex) -> bool:
    """Refine (O, A) by Newton's method on its four conditions; return whether it converged."""
    system, values, pivots = (
        np.empty((CONDITION_COUNT, 4)),
        np.empty(CONDITION_COUNT),
        np.empty(CONDITION_COUNT, np.int64),
    )
    for _ in range(NEWTON_STEPS):
        o, a = pair[0], pair[1]
        worst = 0.0
        for k in range(CONDITION_COUNT):
            r, c = turn[k + 1], shift[k + 1]
            gap = r * a + c - a
            values[k] = (c.conjugate() * r * a).real - (o.conjugate() * gap).real + 0.5 * abs(c) ** 2
            by_a = r.conjugate() * c - (r.conjugate() - 1.0) * o
            system[k, 0], system[k, 1], system[k, 2], system[k, 3] = -gap.real, -gap.imag, by_a.real, by_a.imag
            worst = max(worst, abs(values[k]))
        size = 1.0 + abs(o) + abs(a)
        # Leave diverging iterations early, also those with NaN.
        if not size < 3.0 * MAX_DISTANCE:
            return False
        # The conditions are quadratic in the coordinates, hence the squared size.
        if worst <= CONVERGENCE_TOLERANCE * size * size:
            return True
        if not factor(system, pivots):
            return False
        solve(system, pivots, values)
        pair[0] -= complex(values[0], values[1])
        pair[1] -= complex(values[2], values[3])
    return False
