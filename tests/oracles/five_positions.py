"""How many real dyads five positions have, by exact arithmetic.

With rational positions, and rotations by rational half-angle tangents, everything is a rational number. The condition
that a link keeps its length from the first position to the k-th is linear in the moving pivot A for a given fixed pivot
O = x + iy,

    p_k(x, y) A_x + q_k(x, y) A_y = s_k(x, y),        k = 2 … 5,        p, q, s of degree one in x and y.

Two of the conditions give A by Cramer's rule; put into the others they are two cubic curves (Burmester's). Their
resultant by y, a polynomial in x, vanishes at the four dyads, and at the three poles of the positions used for A, whose
abscissas are divided out. What is left is a quartic with rational coefficients, and Sturm's theorem counts its real
roots: nothing is rounded on the way.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations, pairwise

Polynomial = list[Fraction]
"""Coefficients, of ascending degree."""

Pose = tuple[Fraction, Fraction, Fraction]
"""x, y and the tangent of half the angle."""


def real_dyads(poses: list[Pose]) -> int:
    """Number of real dyads, those with a pivot at infinity left out, of five positions in general."""
    rows = [_row(poses[0], pose) for pose in poses[1:]]

    def cubics(x: Fraction) -> tuple[Polynomial, Polynomial]:
        (p2, q2, s2), (p3, q3, s3), *rest = [[_at(form, x) for form in row] for row in rows]
        d = _minus(_times(p2, q3), _times(p3, q2))
        ax = _minus(_times(s2, q3), _times(s3, q2))
        ay = _minus(_times(p2, s3), _times(p3, s2))
        one, other = (_minus(_plus(_times(p, ax), _times(q, ay)), _times(s, d)) for p, q, s in rest)
        return one, other

    # Degree 9 − 2: the cubics have the two isotropic points in common.
    xs = [Fraction(k) for k in range(-4, 4)]
    polynomial = _interpolated(xs, [_resultant(*cubics(x)) for x in xs])
    for j, k in combinations(range(3), 2):
        polynomial = _without_root(polynomial, _pole_abscissa(poses[j], poses[k]))
    assert len(polynomial) == 5
    return _real_roots(polynomial)


def _turn(pose: Pose) -> tuple[Fraction, Fraction]:
    t = pose[2]
    return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)


def _row(first: Pose, later: Pose) -> list[tuple[Fraction, Fraction, Fraction]]:
    """p, q and s of one condition, each as (constant, coefficient of x, coefficient of y)."""
    (c0, s0), (c1, s1) = _turn(first), _turn(later)
    rx, ry = c1 * c0 + s1 * s0, s1 * c0 - c1 * s0
    cx, cy = later[0] - (rx * first[0] - ry * first[1]), later[1] - (ry * first[0] + rx * first[1])
    # |A_k − O|² = |A − O|² with A_k = c + r A.
    p = (cx * rx + cy * ry, 1 - rx, -ry)
    q = (-cx * ry + cy * rx, ry, 1 - rx)
    s = (-(cx * cx + cy * cy) / 2, cx, cy)
    return [p, q, s]


def _pole_abscissa(one: Pose, other: Pose) -> Fraction:
    """x of the point that does not move between two positions."""
    (c0, s0), (c1, s1) = _turn(one), _turn(other)
    rx, ry = c1 * c0 + s1 * s0, s1 * c0 - c1 * s0
    cx, cy = other[0] - (rx * one[0] - ry * one[1]), other[1] - (ry * one[0] + rx * one[1])
    # (1 − r) z = c
    return (cx * (1 - rx) - cy * ry) / ((1 - rx) ** 2 + ry**2)


def _at(form: tuple[Fraction, Fraction, Fraction], x: Fraction) -> Polynomial:
    return [form[0] + form[1] * x, form[2]]


def _times(f: Polynomial, g: Polynomial) -> Polynomial:
    product = [Fraction(0)] * (len(f) + len(g) - 1)
    for i, a in enumerate(f):
        for j, b in enumerate(g):
            product[i + j] += a * b
    return product


def _plus(f: Polynomial, g: Polynomial) -> Polynomial:
    size = max(len(f), len(g))
    return [(f[k] if k < len(f) else 0) + (g[k] if k < len(g) else 0) + Fraction(0) for k in range(size)]


def _minus(f: Polynomial, g: Polynomial) -> Polynomial:
    return _plus(f, [-b for b in g])


def _resultant(f: Polynomial, g: Polynomial) -> Fraction:
    """Determinant of Sylvester's matrix of two cubics, by elimination."""
    rows = [[Fraction(0)] * k + h[::-1] + [Fraction(0)] * (2 - k) for h in (f, g) for k in range(3)]
    value = Fraction(1)
    for k in range(6):
        pivot = next((i for i in range(k, 6) if rows[i][k]), None)
        if pivot is None:
            return Fraction(0)
        if pivot != k:
            rows[k], rows[pivot] = rows[pivot], rows[k]
            value = -value
        value *= rows[k][k]
        for i in range(k + 1, 6):
            share = rows[i][k] / rows[k][k]
            rows[i] = [a - share * b for a, b in zip(rows[i], rows[k], strict=True)]
    return value


def _interpolated(xs: list[Fraction], values: list[Fraction]) -> Polynomial:
    """Newton's divided differences."""
    table = list(values)
    for level in range(1, len(xs)):
        for k in range(len(xs) - 1, level - 1, -1):
            table[k] = (table[k] - table[k - 1]) / (xs[k] - xs[k - level])
    polynomial = [table[-1]]
    for k in range(len(xs) - 2, -1, -1):
        polynomial = _plus(_times(polynomial, [-xs[k], Fraction(1)]), [table[k]])
    return _trimmed(polynomial)


def _without_root(f: Polynomial, root: Fraction) -> Polynomial:
    quotient: Polynomial = []
    carry = Fraction(0)
    for a in reversed(f):
        carry = a + carry * root
        quotient.append(carry)
    assert quotient.pop() == 0
    return quotient[::-1]


def _trimmed(f: Polynomial) -> Polynomial:
    while len(f) > 1 and f[-1] == 0:
        f = f[:-1]
    return f


def _real_roots(f: Polynomial) -> int:
    """Number of distinct real roots by Sturm's theorem."""
    chain = [f, [k * a for k, a in enumerate(f)][1:]]
    while len(chain[-1]) > 1:
        rest, divisor = chain[-2], chain[-1]
        while len(rest) >= len(divisor):
            share = rest[-1] / divisor[-1]
            shift = len(rest) - len(divisor)
            rest = [a - share * divisor[k - shift] if k >= shift else a for k, a in enumerate(rest)][:-1]
        rest = _trimmed(rest) if rest else [Fraction(0)]
        if rest == [0]:
            break
        chain.append([-a for a in rest])
    changes = []
    for sign in (-1, 1):
        signs = [g[-1] * sign ** (len(g) - 1) > 0 for g in chain]
        changes.append(sum(a != b for a, b in pairwise(signs)))
    return changes[0] - changes[1]
