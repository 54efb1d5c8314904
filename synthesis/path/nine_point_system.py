"""The nine-point path problem as a square polynomial system, and the symmetries of its solutions.

A fourbar's coupler point P goes through δ₀ = 0, δ₁ … δ₈. In isotropic coordinates a plane vector is the pair (z, z̄) of
independent complex numbers, which are conjugate in a real solution. Each of the two dyads has its moving pivot x and
its link r = x − a (a: the fixed pivot), both in the first position and relative to P there. When the coupler has turned
by θⱼ the link has moved by α = δⱼ + x sⱼ, β = δ̄ⱼ + x̄ s̄ⱼ and has kept its length:

    αβ + r β + r̄ α = 0                            j = 1 … 8, for each dyad

with s = θ − 1 and s̄ = 1/θ − 1 (Wampler, Morgan & Sommese 1992, doi:10.1115/1.2916909, in other letters). These are 16
equations for y = (x₁, x̄₁, r₁, r̄₁, x₂, x̄₂, r₂, r̄₂, s₁ … s₈) and the parameters p = (δ₁ … δ₈, δ̄₁ … δ̄₈). Since sⱼ stands
in two of them only, it is eliminated from each pair of linearized equations, and eight remain to be solved. Couplers of
large linkages hardly turn, which s tells with all its digits where θ would have lost them.

Exchanging the dyads and going over to one of the two cognates (Roberts 1875) gives the same coupler curve, so that
solutions come in orbits of six; there are 8652 = 6 · 1442 for general parameters. In the three cognates the coupler
turns as the coupler, the first or the second link of one of them does. Symmetric functions of these three rotations are
the orbit's own, and are of ordinary size however large the linkage is.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from synthesis.numerics.continuation import SYSTEM
from synthesis.numerics.double_double import add, multiply, reciprocal
from synthesis.numerics.elimination import factor, solve

Complex = NDArray[np.complex128]

UNKNOWNS, PARAMETERS, POINTS = 16, 16, 8

ORBITS = 1442
"""Cognate triples through nine general points, real and complex (Wampler, Morgan & Sommese 1992)."""

GROUPS = np.array([0] * 4 + [1] * 4 + [2] * 8)
"""The vectors of a dyad share a scale, and so do the rotations."""

SCRATCH = 192

_WEIGHTS = np.exp(1j * np.arange(1, 9) ** 2)
"""Some directions of no meaning, by which eight rotations are summed up to one number."""


@njit(cache=True, nogil=True)
def _solve(
    y: Complex, differences: Complex, gaps: Complex, dp: Complex, newton: Complex, tangent: Complex, work: Complex
) -> int:
    """Newton's step and the tangent, from α, β of both dyads at each point and from the gaps of the equations there."""
    matrix, rows = work[:64].reshape((8, 8)), work[64:144].reshape((8, 10))
    pivots = np.empty(8, np.int64)
    for j in range(8):
        s, turn_back = y[8 + j], 1.0 / (1.0 + y[8 + j])
        s_back = -s * turn_back
        alpha_1, beta_1, alpha_2, beta_2 = differences[j, 0], differences[j, 1], differences[j, 2], differences[j, 3]
        gap_1, gap_2 = gaps[j, 0], gaps[j, 1]
        # by α and by β
        by_alpha_1, by_beta_1 = beta_1 + y[3], alpha_1 + y[2]
        by_alpha_2, by_beta_2 = beta_2 + y[7], alpha_2 + y[6]
        # by θ
        square = turn_back * turn_back
        by_turn_1 = by_alpha_1 * y[0] - by_beta_1 * y[1] * square
        by_turn_2 = by_alpha_2 * y[4] - by_beta_2 * y[5] * square
        size_1 = abs(by_turn_1.real) + abs(by_turn_1.imag)
        size_2 = abs(by_turn_2.real) + abs(by_turn_2.imag)
        if not (size_1 > 0.0 or size_2 > 0.0):
            return 0
        share = 1.0 / (size_1 + size_2)
        to_1, to_2 = by_turn_2 * share, -by_turn_1 * share
        matrix[j, 0] = to_1 * by_alpha_1 * s
        matrix[j, 1] = to_1 * by_beta_1 * s_back
        matrix[j, 2] = to_1 * beta_1
        matrix[j, 3] = to_1 * alpha_1
        matrix[j, 4] = to_2 * by_alpha_2 * s
        matrix[j, 5] = to_2 * by_beta_2 * s_back
        matrix[j, 6] = to_2 * beta_2
        matrix[j, 7] = to_2 * alpha_2
        newton[j] = -(to_1 * gap_1 + to_2 * gap_2)
        moved_1 = by_alpha_1 * dp[j] + by_beta_1 * dp[8 + j]
        moved_2 = by_alpha_2 * dp[j] + by_beta_2 * dp[8 + j]
        tangent[j] = -(to_1 * moved_1 + to_2 * moved_2)
        # θ comes back from the equation in which it counts more
        if size_1 >= size_2:
            inverse = -1.0 / by_turn_1
            rows[j, 0], rows[j, 1] = by_alpha_1 * s * inverse, by_beta_1 * s_back * inverse
            rows[j, 2], rows[j, 3] = beta_1 * inverse, alpha_1 * inverse
            rows[j, 4], rows[j, 5], rows[j, 6] = gap_1 * inverse, moved_1 * inverse, 0.0
        else:
            inverse = -1.0 / by_turn_2
            rows[j, 0], rows[j, 1] = by_alpha_2 * s * inverse, by_beta_2 * s_back * inverse
            rows[j, 2], rows[j, 3] = beta_2 * inverse, alpha_2 * inverse
            rows[j, 4], rows[j, 5], rows[j, 6] = gap_2 * inverse, moved_2 * inverse, 4.0
    if not factor(matrix, pivots):
        return 0
    solve(matrix, pivots, newton[:8])
    solve(matrix, pivots, tangent[:8])
    for j in range(8):
        first = int(rows[j, 6].real)
        step, slope = rows[j, 4], rows[j, 5]
        for k in range(4):
            step += rows[j, k] * newton[first + k]
            slope += rows[j, k] * tangent[first + k]
        newton[8 + j], tangent[8 + j] = step, slope
    return 1


@njit(SYSTEM, cache=True, nogil=True)
def nine_point_system(
    y: Complex, low: Complex, p: Complex, dp: Complex, newton: Complex, tangent: Complex, work: Complex
) -> int:
    """The system, of the type that the continuation follows, in ordinary precision."""
    differences, gaps = work[144:176].reshape((8, 4)), work[176:192].reshape((8, 2))
    for j in range(8):
        s = y[8 + j]
        s_back = -s / (1.0 + s)
        for dyad in range(2):
            first = 4 * dyad
            alpha, beta = p[j] + y[first] * s, p[8 + j] + y[first + 1] * s_back
            differences[j, 2 * dyad], differences[j, 2 * dyad + 1] = alpha, beta
            gaps[j, dyad] = alpha * (beta + y[first + 3]) + y[first + 2] * beta
    return _solve(y, differences, gaps, dp, newton, tangent, work)


@njit(SYSTEM, cache=True, nogil=True)
def nine_point_system_extended(
    y: Complex, low: Complex, p: Complex, dp: Complex, newton: Complex, tangent: Complex, work: Complex
) -> int:
    """The system with its residuals in twice the precision, for solutions that ordinary rounding would lose.

    Newton's method converges to the digits of its residuals; its matrix needs no more than some right ones.
    """
    differences, gaps = work[144:176].reshape((8, 4)), work[176:192].reshape((8, 2))
    for j in range(8):
        s, s_low = y[8 + j], low[8 + j]
        turn, turn_low = add(1.0 + 0j, 0j, s, s_low)
        back, back_low = reciprocal(turn, turn_low)
        s_back, s_back_low = multiply(-s, -s_low, back, back_low)
        for dyad in range(2):
            k = 4 * dyad
            moved, moved_low = multiply(y[k], low[k], s, s_low)
            alpha, alpha_low = add(moved, moved_low, p[j], 0j)
            moved, moved_low = multiply(y[k + 1], low[k + 1], s_back, s_back_low)
            beta, beta_low = add(moved, moved_low, p[8 + j], 0j)
            to, to_low = add(beta, beta_low, y[k + 3], low[k + 3])
            one, one_low = multiply(alpha, alpha_low, to, to_low)
            other, other_low = multiply(y[k + 2], low[k + 2], beta, beta_low)
            gap, _ = add(one, one_low, other, other_low)
            differences[j, 2 * dyad], differences[j, 2 * dyad + 1] = alpha, beta
            gaps[j, dyad] = gap
    return _solve(y, differences, gaps, dp, newton, tangent, work)


def residuals(y: Complex, p: Complex, low: Complex | None = None) -> NDArray[np.float64]:
    """Largest |αβ + rβ + r̄α| of each solution y (+ low), shape (...), for y of shape (..., 16)."""
    exact = y if low is None else y.astype(np.clongdouble) + low
    s = exact[..., 8:]
    s_back = -s / (1.0 + s)
    largest = np.zeros(y.shape[:-1])
    for dyad in (0, 4):
        x, x_conj, r, r_conj = (exact[..., dyad + k, None] for k in range(4))
        alpha, beta = p[:8] + x * s, p[8:] + x_conj * s_back
        largest = np.maximum(largest, np.abs(alpha * beta + r * beta + r_conj * alpha).max(axis=-1))
    return np.asarray(largest, np.float64)


def conditions(y: Complex, p: Complex) -> NDArray[np.float64]:
    """Condition of the Jacobian at each solution, unknowns and equations scaled to their size: shape (solutions,)."""
    jacobian = np.zeros((len(y), 16, UNKNOWNS), np.complex128)
    s = y[:, 8:]
    s_back = -s / (1.0 + s)
    j = np.arange(8)
    for dyad in (0, 4):
        x, x_conj, r, r_conj = (y[:, dyad + k, None] for k in range(4))
        alpha, beta = p[:8] + x * s, p[8:] + x_conj * s_back
        by_alpha, by_beta = beta + r_conj, alpha + r
        rows = 2 * dyad + j
        jacobian[:, rows, dyad : dyad + 4] = np.stack([by_alpha * s, by_beta * s_back, beta, alpha], axis=-1)
        jacobian[:, rows, 8 + j] = by_alpha * x - by_beta * x_conj / (1.0 + s) ** 2
    jacobian *= np.abs(y)[:, None, :]
    jacobian /= np.linalg.norm(jacobian, axis=-1, keepdims=True)
    return np.asarray(np.linalg.cond(jacobian))


def rotations(y: Any, p: Complex) -> Complex:
    """Rotations, less 1, of coupler, first and second link at the points: shape (..., 3, 8)."""
    s = y[..., 8:]
    links = [(p[:8] + y[..., k, None] * s) / y[..., k + 2, None] for k in (0, 4)]
    return np.asarray(np.stack([s, *links], axis=-2))


def orbit_keys(y: Complex, p: Complex, low: Complex | None = None) -> Complex:
    """What the six solutions y (+ low) of an orbit have in common and no others have: shape (..., 3)."""
    exact = y if low is None else y.astype(np.clongdouble) + low
    first, second, third = np.moveaxis(rotations(exact, p).astype(np.complex128), -2, 0)
    sums = first + second + third
    pairs = first * second + second * third + third * first
    return np.stack([sums @ _WEIGHTS, pairs @ _WEIGHTS, (sums * sums) @ _WEIGHTS], axis=-1)


def exchanged(y: Complex) -> Complex:
    """The solutions with their dyads exchanged."""
    return np.concatenate([y[..., 4:8], y[..., :4], y[..., 8:]], axis=-1)


def cognate(y: Complex, p: Complex) -> Complex:
    """The cognates that share the first fixed pivot: their first dyad stands on it, their second on the third pivot.

    With P at 0 and κ = −x₁/(x₂ − x₁) their moving pivots are q = −r₁ and q(1 − κ), their links −x₁ and κ r₂, and their
    coupler turns as the first link did (Roberts' construction).
    """
    x_1, c_1, r_1, d_1, x_2, c_2, r_2, d_2 = np.moveaxis(y[..., :8], -1, 0)
    ratio, conj_ratio = -x_1 / (x_2 - x_1), -c_1 / (c_2 - c_1)
    vectors = [-r_1, -d_1, -x_1, -c_1, -r_1 * (1.0 - ratio), -d_1 * (1.0 - conj_ratio), ratio * r_2, conj_ratio * d_2]
    return np.asarray(np.concatenate([np.stack(vectors, axis=-1), rotations(y, p)[..., 1, :]], axis=-1))


def cognates(y: Complex, p: Complex) -> Complex:
    """The three members of each orbit that differ by more than the order of their dyads: shape (..., 3, 16)."""
    return np.stack([y, cognate(y, p), cognate(exchanged(y), p)], axis=-2)


def random_problem(rng: np.random.Generator) -> tuple[Complex, Complex]:
    """A solution that was drawn, and the parameters that it solves: y and p, shape (16,) each.

    For given dyads and rotation both equations of a point are bilinear in (δ, δ̄), with the same quadratic term.
    """

    def drawn() -> Complex:
        return np.asarray((rng.normal(size=8) + 1j * rng.normal(size=8)) * np.sqrt(0.5))

    vectors, turned = drawn(), drawn() * np.sqrt(2.0) - 1.0
    p = np.empty(PARAMETERS, np.complex128)
    for j, s in enumerate(turned):
        s_back = -s / (1.0 + s)
        by_delta, by_conj, rest = [], [], []
        for dyad in (0, 4):
            x, x_conj, r, r_conj = vectors[dyad : dyad + 4]
            by_delta.append(x_conj * s_back + r_conj)
            by_conj.append(x * s + r)
            rest.append(x * s * x_conj * s_back + r * x_conj * s_back + r_conj * x * s)
        slope = -(by_delta[0] - by_delta[1]) / (by_conj[0] - by_conj[1])
        offset = -(rest[0] - rest[1]) / (by_conj[0] - by_conj[1])
        quadratic = [slope, offset + by_delta[0] + by_conj[0] * slope, by_conj[0] * offset + rest[0]]
        p[j] = np.roots(quadratic)[rng.integers(2)]
        p[8 + j] = slope * p[j] + offset
    return np.concatenate([vectors, turned]), p
