"""Watt II sixbars that meet nine pairs of input and output: the polynomial system.

A Watt II is two fourbars in series. Sizes and directions of their grounds change nothing of what the output does, so
that both are 1. At the first pair the crank is a, the rocker c, both as vectors from their pivots; of the second
fourbar the input link, which is keyed to that rocker, is d and the output e. From the first pair to the j-th the input
has turned by 1 + sⱼ, the output by 1 + rⱼ and the link between them by 1 + t. The couplers keep their lengths where

    α₁ t + β₁ t̄ + f = 0,    α₁ = c (1 − ā (1 + s̄)),     β₁ = c̄ (1 − a (1 + s)),    f = −s a (1 + c̄) − s̄ ā (1 + c),
    α₂ t + β₂ t̄ + g = 0,    α₂ = −d (1 + ē (1 + r̄)),    β₂ = −d̄ (1 + e (1 + r)),    g = r e (1 − d̄) + r̄ ē (1 − d),

with isotropic coordinates: a vector and its conjugate are two unknowns, s̄ = −s/(1 + s). Both are linear in t and t̄,
and t + t̄ + t t̄ = 0 leaves one equation of each pair but the first:

    T T̄ + X (T + T̄) = 0,    T = g β₁ − f β₂,    T̄ = f α₂ − g α₁,    X = α₁ β₂ − α₂ β₁.

These are eight equations for eight unknowns, so that nine pairs have finitely many Watt II sixbars: for general turns
:data:`SOLUTIONS`, counted by monodromy (``tools/watt_start.py``). Eight pairs leave one freedom.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.numerics.continuation import SYSTEM
from synthesis.numerics.double_double import add, multiply, reciprocal
from synthesis.numerics.elimination import reduce

Complex = NDArray[np.complex128]

Pair = tuple[complex, complex]
"""A number of twice the precision."""

PAIRS = 9

SOLUTIONS = 26_370
"""Solutions for general turns, none of them singular."""

UNKNOWNS, PARAMETERS, SCRATCH = 8, 16, 88
"""a, ā, c, c̄, d, d̄, e, ē; s₁…s₈, r₁…r₈; and what the system needs to work with."""

TURNS = 32
"""Parameters where the turns' conjugates are stated too: s₁…s₈, s̄₁…s̄₈, r₁…r₈, r̄₁…r̄₈."""

GROUPS = np.array([0, 0, 1, 1, 2, 2, 3, 3], np.int64)
"""Each vector has a scale of its own."""

APART = 1e-9
"""Share of the size of c by which it differs from −d in a counted solution."""

LARGEST = 1e150
"""An entry of the matrix beyond this is not finite enough to go on with."""


@njit(cache=True, nogil=True)
def _row(y: Complex, turns: Complex, moves: Complex, row: Complex) -> None:
    """A pair's derivatives by the unknowns, less its equation, and less its derivative as the turns move.

    ``turns``: s, s̄, r, r̄; ``moves``: how they move.
    """
    a, a_bar, c, c_bar = y[0], y[1], y[2], y[3]
    d, d_bar, e, e_bar = y[4], y[5], y[6], y[7]
    s, s_bar, r, r_bar = turns[0], turns[1], turns[2], turns[3]
    ds, ds_bar, dr, dr_bar = moves[0], moves[1], moves[2], moves[3]
    u, v, w, z = 1.0 + s, 1.0 + s_bar, 1.0 + r, 1.0 + r_bar
    alpha_1, beta_1 = c * (1.0 - a_bar * v), c_bar * (1.0 - a * u)
    alpha_2, beta_2 = -d * (1.0 + e_bar * z), -d_bar * (1.0 + e * w)
    f = -s * a * (1.0 + c_bar) - s_bar * a_bar * (1.0 + c)
    g = r * e * (1.0 - d_bar) + r_bar * e_bar * (1.0 - d)
    t, t_bar = g * beta_1 - f * beta_2, f * alpha_2 - g * alpha_1
    x = alpha_1 * beta_2 - alpha_2 * beta_1
    by_t, by_t_bar, by_x = t_bar + x, t + x, t + t_bar
    by_alpha_1, by_beta_1 = by_x * beta_2 - by_t_bar * g, by_t * g - by_x * alpha_2
    by_alpha_2, by_beta_2 = by_t_bar * f - by_x * beta_1, by_x * alpha_1 - by_t * f
    by_f, by_g = by_t_bar * alpha_2 - by_t * beta_2, by_t * beta_1 - by_t_bar * alpha_1
    row[0] = -by_beta_1 * c_bar * u - by_f * s * (1.0 + c_bar)
    row[1] = -by_alpha_1 * c * v - by_f * s_bar * (1.0 + c)
    row[2] = by_alpha_1 * (1.0 - a_bar * v) - by_f * s_bar * a_bar
    row[3] = by_beta_1 * (1.0 - a * u) - by_f * s * a
    row[4] = -by_alpha_2 * (1.0 + e_bar * z) - by_g * r_bar * e_bar
    row[5] = -by_beta_2 * (1.0 + e * w) - by_g * r * e
    row[6] = -by_beta_2 * d_bar * w + by_g * r * (1.0 - d_bar)
    row[7] = -by_alpha_2 * d * z + by_g * r_bar * (1.0 - d)
    row[8] = -(t * t_bar + x * (t + t_bar))
    row[9] = (
        by_alpha_1 * c * a_bar * ds_bar
        + by_beta_1 * c_bar * a * ds
        + by_f * (ds * a * (1.0 + c_bar) + ds_bar * a_bar * (1.0 + c))
        + by_alpha_2 * d * e_bar * dr_bar
        + by_beta_2 * d_bar * e * dr
        - by_g * (dr * e * (1.0 - d_bar) + dr_bar * e_bar * (1.0 - d))
    )


@njit(cache=True, nogil=True)
def _solved(matrix: Complex, newton: Complex, tangent: Complex) -> int:
    """Both steps from the rows of all pairs, each scaled by its greatest derivative; 0 where they are singular."""
    for row in matrix:
        largest = 0.0
        for k in range(8):
            largest = max(largest, abs(row[k].real), abs(row[k].imag))
        if not 0.0 < largest < LARGEST:
            return 0
        row /= largest
    if not reduce(matrix):
        return 0
    newton[:], tangent[:] = matrix[:, 8], matrix[:, 9]
    return 1


@njit(cache=True, nogil=True)
def _spread(p: Complex, dp: Complex, j: int, turns: Complex, moves: Complex) -> None:
    """s, s̄, r, r̄ of a pair, and how they move."""
    for k, at in ((0, j), (2, 8 + j)):
        back = 1.0 / (1.0 + p[at])
        turns[k], turns[k + 1] = p[at], -p[at] * back
        moves[k], moves[k + 1] = dp[at], -dp[at] * back * back


@njit(SYSTEM, cache=True, nogil=True)
def nine_pair_system(
    y: Complex, low: Complex, p: Complex, p_low: Complex, dp: Complex, newton: Complex, tangent: Complex, work: Complex
) -> int:
    """The system, of the type that the continuation follows."""
    matrix, turns, moves = work[:80].reshape((8, 10)), work[80:84], work[84:88]
    for j in range(8):
        _spread(p, dp, j, turns, moves)
        _row(y, turns, moves, matrix[j])
    return _solved(matrix, newton, tangent)


@njit(cache=True, nogil=True)
def _sum(one: Pair, other: Pair) -> Pair:
    return add(one[0], one[1], other[0], other[1])


@njit(cache=True, nogil=True)
def _difference(one: Pair, other: Pair) -> Pair:
    return add(one[0], one[1], -other[0], -other[1])


@njit(cache=True, nogil=True)
def _product(one: Pair, other: Pair) -> Pair:
    return multiply(one[0], one[1], other[0], other[1])


@njit(cache=True, nogil=True)
def _inverse(one: Pair) -> Pair:
    return reciprocal(one[0], one[1])


@njit(cache=True, nogil=True)
def _equation(y: Complex, low: Complex, s: Pair, s_bar: Pair, r: Pair, r_bar: Pair) -> complex:
    """T T̄ + X (T + T̄) of a pair, computed in twice the precision."""
    one = (1.0 + 0j, 0j)
    a, a_bar, c, c_bar = (y[0], low[0]), (y[1], low[1]), (y[2], low[2]), (y[3], low[3])
    d, d_bar, e, e_bar = (y[4], low[4]), (y[5], low[5]), (y[6], low[6]), (y[7], low[7])
    alpha_1 = _product(c, _difference(one, _product(a_bar, _sum(one, s_bar))))
    beta_1 = _product(c_bar, _difference(one, _product(a, _sum(one, s))))
    # With the other sign each: α₂, β₂ and f.
    alpha_2 = _product(d, _sum(one, _product(e_bar, _sum(one, r_bar))))
    beta_2 = _product(d_bar, _sum(one, _product(e, _sum(one, r))))
    f = _sum(_product(_product(s, a), _sum(one, c_bar)), _product(_product(s_bar, a_bar), _sum(one, c)))
    g = _sum(_product(_product(r, e), _difference(one, d_bar)), _product(_product(r_bar, e_bar), _difference(one, d)))
    t = _difference(_product(g, beta_1), _product(f, beta_2))
    t_bar = _difference(_product(f, alpha_2), _product(g, alpha_1))
    x = _difference(_product(alpha_2, beta_1), _product(alpha_1, beta_2))
    gap = _sum(_product(t, t_bar), _product(x, _sum(t, t_bar)))
    return gap[0]


@njit(SYSTEM, cache=True, nogil=True)
def nine_pair_system_extended(
    y: Complex, low: Complex, p: Complex, p_low: Complex, dp: Complex, newton: Complex, tangent: Complex, work: Complex
) -> int:
    """The system with its equations in twice the precision.

    Newton's method converges to the digits of its equations; its matrix needs no more than some right ones. At end
    points the parameters may be all :data:`TURNS`: the conjugates of real turns are exact then, so that what is real is
    found so.
    """
    matrix, turns, moves = work[:80].reshape((8, 10)), work[80:84], work[84:88]
    one = (1.0 + 0j, 0j)
    for j in range(8):
        if p.size == TURNS:
            turns[:], moves[:] = p[j:TURNS:8], dp[j:TURNS:8]
            s, s_bar, r, r_bar = (turns[0], 0j), (turns[1], 0j), (turns[2], 0j), (turns[3], 0j)
        else:
            _spread(p, dp, j, turns, moves)
            s, r = (p[j], p_low[j]), (p[8 + j], p_low[8 + j])
            s_bar = _product((-s[0], -s[1]), _inverse(_sum(one, s)))
            r_bar = _product((-r[0], -r[1]), _inverse(_sum(one, r)))
        _row(y, turns, moves, matrix[j])
        matrix[j, 8] = -_equation(y, low, s, s_bar, r, r_bar)
    return _solved(matrix, newton, tangent)


def is_linkage(y: Complex) -> NDArray[np.bool_]:
    """Whether a solution is one of the counted ones: shape (...), for y of shape (..., 8).

    Where d = −c the joints B and C and the pivots O2 and O6 fall together, and the system has whole curves of
    solutions, to which paths come that have lost their way.
    """
    c, d = y[..., 2:4], y[..., 4:6]
    return np.asarray((np.abs(c + d) > APART * np.abs(c)).any(axis=-1))


def residuals(y: Complex, p: Complex) -> NDArray[np.float64]:
    """Largest |T T̄ + X (T + T̄)| of each solution beside its terms, shape (...), for y of shape (..., 8)."""
    a, a_bar, c, c_bar, d, d_bar, e, e_bar = np.moveaxis(y, -1, 0)[..., None]
    s, r = p[:8], p[8:]
    v, z = 1.0 / (1.0 + s), 1.0 / (1.0 + r)
    s_bar, r_bar = -s * v, -r * z
    alpha_1, beta_1 = c * (1.0 - a_bar * v), c_bar * (1.0 - a * (1.0 + s))
    alpha_2, beta_2 = -d * (1.0 + e_bar * z), -d_bar * (1.0 + e * (1.0 + r))
    f = -s * a * (1.0 + c_bar) - s_bar * a_bar * (1.0 + c)
    g = r * e * (1.0 - d_bar) + r_bar * e_bar * (1.0 - d)
    t, t_bar, x = g * beta_1 - f * beta_2, f * alpha_2 - g * alpha_1, alpha_1 * beta_2 - alpha_2 * beta_1
    terms = np.abs(t * t_bar) + np.abs(x * t) + np.abs(x * t_bar)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray((np.abs(t * t_bar + x * (t + t_bar)) / terms).max(axis=-1))
