"""The nine-point path problem as a square polynomial system, and the symmetries of its solutions.

A fourbar's coupler point P goes through δ₀ = 0, δ₁ … δ₈. In isotropic coordinates a plane vector is the pair (z, z̄) of
independent complex numbers, which are conjugate in a real solution. Each of the two dyads has its moving pivot x and
its link r = x − a (a: the fixed pivot), both in the first position and relative to P there. When the coupler has turned
by θⱼ the link has moved by α = δⱼ + x sⱼ, β = δ̄ⱼ + x̄ s̄ⱼ and has kept its length:

    αβ + r β + r̄ α = 0                            j = 1 … 8, for each dyad

with s = θ − 1 and s̄ = 1/θ − 1 (Wampler, Morgan & Sommese 1992, doi:10.1115/1.2916909, in other letters). These are 16
equations for y = (x₁, x̄₁, r₁, r̄₁, x₂, x̄₂, r₂, r̄₂, s₁ … s₈) and the parameters p = (δ₁ … δ₈, δ̄₁ … δ̄₈). Since sⱼ stands
in two of them only, it is eliminated from each pair of linearized equations, and eight remain to be solved. Couplers of
large linkages hardly turn; s represents this with all its digits, which θ would lose.

Exchanging the dyads and changing to one of the two cognates (Roberts 1875) gives the same coupler curve, so that
solutions come in orbits of six; there are 8652 = 6 · 1442 for general parameters. In the three cognates the coupler
turns like the coupler, the first or the second link of one of them. Symmetric functions of these three rotations
identify the orbit, and are of ordinary size however large the linkage is.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.numerics.continuation import SYSTEM
from synthesis.numerics.double_double import add, multiply, reciprocal
from synthesis.numerics.elimination import reduce

Complex = NDArray[np.complex128]

UNKNOWNS, PARAMETERS, POINTS = 16, 16, 8

ORBITS = 1442
"""Number of cognate triples through nine general points, real and complex (Wampler, Morgan & Sommese 1992)."""

GROUPS = np.array([0] * 4 + [1] * 4 + [2] * 8)
"""Scale group of each unknown: the vectors of a dyad share a scale, and so do the rotations."""

OPTIONS: Any = {"cache": True, "nogil": True, "error_model": "numpy"}
"""Compiler options of the kernels: vectors for the eight points, with fused multiplications and no exceptions."""

LANES = 8
"""Numbers per quantity in the workspace, one for each point; imaginary parts follow LANES after the real ones."""

PAIR = 2 * LANES

S, TURN_BACK, S_BACK, DELTA, DELTA_BAR, STEP, STEP_BAR = range(0, 7 * PAIR, PAIR)
"""Offsets in the workspace of rotations, parameters and their changes."""

ALPHA_1, BETA_1, GAP_1, ALPHA_2, BETA_2, GAP_2 = range(7 * PAIR, 13 * PAIR, PAIR)
"""Offsets of the quantities derived from them."""

COLUMNS, ROWS = 13 * PAIR, 23 * PAIR
"""Offsets of ten columns of the equations without the rotations, right sides last, and of the six that give the
rotations."""

FIRST = 29 * PAIR
"""Offset of the index of the first vector of the dyad that gives the rotation."""

MATRIX = (29 * PAIR + LANES) // 2
"""Offset of the equations as rows, in complex numbers of the workspace."""

SCRATCH = MATRIX + 80

APART = 1e-9
"""Minimum separation of two dyads, as a share of their size: nearer ones are no linkage, and not among the 1442."""

_WEIGHTS = np.exp(1j * np.arange(1, 9) ** 2)
"""Arbitrary directions that combine eight rotations into one number."""


@njit(**OPTIONS)
def _get(w: Any, at: int) -> complex:
    return complex(w[at], w[at + LANES])


@njit(**OPTIONS)
def _put(w: Any, at: int, z: complex) -> None:
    w[at], w[at + LANES] = z.real, z.imag


@njit(**OPTIONS)
def _inverse(z: complex) -> complex:
    size = 1.0 / (z.real * z.real + z.imag * z.imag)
    return complex(z.real * size, -z.imag * size)


@njit(**OPTIONS)
def _spread(y: Complex, p: Complex, dp: Complex, w: Any, points: int) -> None:
    """Copy rotations and parameters into the workspace, as vectors over the points."""
    for j in range(points):
        _put(w, S + j, y[8 + j])
        _put(w, DELTA + j, p[j])
        _put(w, DELTA_BAR + j, p[8 + j])
        _put(w, STEP + j, dp[j])
        _put(w, STEP_BAR + j, dp[8 + j])


@njit(**OPTIONS)
def _differences(y: Complex, w: Any, points: int) -> None:
    """Compute α, β and the residuals of the equations at all points.

    The number of points is an argument so that loops over it are vectorized instead of unrolled.
    """
    x_1, c_1, r_1, d_1, x_2, c_2, r_2, d_2 = y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7]
    for j in range(points):
        s = _get(w, S + j)
        back = _inverse(1.0 + s)
        s_back = -s * back
        _put(w, TURN_BACK + j, back)
        _put(w, S_BACK + j, s_back)
        delta, delta_bar = _get(w, DELTA + j), _get(w, DELTA_BAR + j)
        alpha, beta = delta + x_1 * s, delta_bar + c_1 * s_back
        _put(w, ALPHA_1 + j, alpha)
        _put(w, BETA_1 + j, beta)
        _put(w, GAP_1 + j, alpha * (beta + d_1) + r_1 * beta)
        alpha, beta = delta + x_2 * s, delta_bar + c_2 * s_back
        _put(w, ALPHA_2 + j, alpha)
        _put(w, BETA_2 + j, beta)
        _put(w, GAP_2 + j, alpha * (beta + d_2) + r_2 * beta)


@njit(**OPTIONS)
def _equations(y: Complex, w: Any, points: int) -> None:
    """Compute the equations of each point with its rotation eliminated, and those that give the rotation."""
    x_1, c_1, r_1, d_1, x_2, c_2, r_2, d_2 = y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7]
    for j in range(points):
        s, back, s_back = _get(w, S + j), _get(w, TURN_BACK + j), _get(w, S_BACK + j)
        alpha_1, beta_1, gap_1 = _get(w, ALPHA_1 + j), _get(w, BETA_1 + j), _get(w, GAP_1 + j)
        alpha_2, beta_2, gap_2 = _get(w, ALPHA_2 + j), _get(w, BETA_2 + j), _get(w, GAP_2 + j)
        step, step_bar = _get(w, STEP + j), _get(w, STEP_BAR + j)
        # Derivatives by α and by β.
        by_alpha_1, by_beta_1 = beta_1 + d_1, alpha_1 + r_1
        by_alpha_2, by_beta_2 = beta_2 + d_2, alpha_2 + r_2
        # Derivatives by θ.
        square = back * back
        by_turn_1 = by_alpha_1 * x_1 - by_beta_1 * c_1 * square
        by_turn_2 = by_alpha_2 * x_2 - by_beta_2 * c_2 * square
        size_1 = by_turn_1.real * by_turn_1.real + by_turn_1.imag * by_turn_1.imag
        size_2 = by_turn_2.real * by_turn_2.real + by_turn_2.imag * by_turn_2.imag
        share = 1.0 / math.sqrt(size_1 + size_2)
        # This unit combination of the pair cancels the rotation's column; scaling keeps it well conditioned.
        to_1, to_2 = by_turn_2 * share, -by_turn_1 * share
        moved_1 = by_alpha_1 * step + by_beta_1 * step_bar
        moved_2 = by_alpha_2 * step + by_beta_2 * step_bar
        by_x_1, by_c_1 = by_alpha_1 * s, by_beta_1 * s_back
        by_x_2, by_c_2 = by_alpha_2 * s, by_beta_2 * s_back
        _put(w, COLUMNS + j, to_1 * by_x_1)
        _put(w, COLUMNS + PAIR + j, to_1 * by_c_1)
        _put(w, COLUMNS + 2 * PAIR + j, to_1 * beta_1)
        _put(w, COLUMNS + 3 * PAIR + j, to_1 * alpha_1)
        _put(w, COLUMNS + 4 * PAIR + j, to_2 * by_x_2)
        _put(w, COLUMNS + 5 * PAIR + j, to_2 * by_c_2)
        _put(w, COLUMNS + 6 * PAIR + j, to_2 * beta_2)
        _put(w, COLUMNS + 7 * PAIR + j, to_2 * alpha_2)
        _put(w, COLUMNS + 8 * PAIR + j, -(to_1 * gap_1 + to_2 * gap_2))
        _put(w, COLUMNS + 9 * PAIR + j, -(to_1 * moved_1 + to_2 * moved_2))
        # Recover θ from the equation with the larger derivative by it: the other could divide by almost zero.
        one = size_1 >= size_2
        # The row of θ is divided by its own coefficient once, here.
        inverse = -_inverse(by_turn_1 if one else by_turn_2)
        _put(w, ROWS + j, (by_x_1 if one else by_x_2) * inverse)
        _put(w, ROWS + PAIR + j, (by_c_1 if one else by_c_2) * inverse)
        _put(w, ROWS + 2 * PAIR + j, (beta_1 if one else beta_2) * inverse)
        _put(w, ROWS + 3 * PAIR + j, (alpha_1 if one else alpha_2) * inverse)
        _put(w, ROWS + 4 * PAIR + j, (gap_1 if one else gap_2) * inverse)
        _put(w, ROWS + 5 * PAIR + j, (moved_1 if one else moved_2) * inverse)
        w[FIRST + j] = 0.0 if one else 4.0


@njit(**OPTIONS)
def _solve(y: Complex, newton: Complex, tangent: Complex, work: Complex, points: int) -> int:
    """Compute Newton's step and the tangent from α, β of both dyads and the residuals at each point."""
    w = work.view(np.float64)
    _equations(y, w, points)
    matrix = work[MATRIX : MATRIX + 80].reshape((8, 10))
    for c in range(10):
        for j in range(8):
            matrix[j, c] = _get(w, COLUMNS + PAIR * c + j)
    if not reduce(matrix):
        return 0
    for j in range(8):
        newton[j], tangent[j] = matrix[j, 8], matrix[j, 9]
    for j in range(8):
        first = int(w[FIRST + j])
        step, slope = _get(w, ROWS + 4 * PAIR + j), _get(w, ROWS + 5 * PAIR + j)
        for k in range(4):
            by = _get(w, ROWS + PAIR * k + j)
            step += by * newton[first + k]
            slope += by * tangent[first + k]
        # Back substitution: rotations follow from the eight vectors.
        newton[8 + j], tangent[8 + j] = step, slope
    return 1


@njit(SYSTEM, **OPTIONS)
def nine_point_system(
    y: Complex, low: Complex, p: Complex, p_low: Complex, dp: Complex, newton: Complex, tangent: Complex, work: Complex
) -> int:
    """Compute Newton's step and the tangent in ordinary precision, in the form that the continuation follows."""
    points = p.size // 2
    w = work.view(np.float64)
    _spread(y, p, dp, w, points)
    _differences(y, w, points)
    return int(_solve(y, newton, tangent, work, points))


@njit(SYSTEM, cache=True, nogil=True)
def nine_point_system_extended(
    y: Complex, low: Complex, p: Complex, p_low: Complex, dp: Complex, newton: Complex, tangent: Complex, work: Complex
) -> int:
    """Compute the same with residuals in twice the precision, for solutions that ordinary rounding would lose.

    Newton's method converges to the precision of its residuals; its matrix needs only a few correct digits.
    """
    points = p.size // 2
    w = work.view(np.float64)
    _spread(y, p, dp, w, points)
    for j in range(points):
        s, s_low = y[8 + j], low[8 + j]
        turn, turn_low = add(1.0 + 0j, 0j, s, s_low)
        back, back_low = reciprocal(turn, turn_low)
        s_back, s_back_low = multiply(-s, -s_low, back, back_low)
        _put(w, TURN_BACK + j, back)
        _put(w, S_BACK + j, s_back)
        for dyad in range(2):
            k = 4 * dyad
            moved, moved_low = multiply(y[k], low[k], s, s_low)
            alpha, alpha_low = add(moved, moved_low, p[j], p_low[j])
            moved, moved_low = multiply(y[k + 1], low[k + 1], s_back, s_back_low)
            beta, beta_low = add(moved, moved_low, p[8 + j], p_low[8 + j])
            to, to_low = add(beta, beta_low, y[k + 3], low[k + 3])
            one, one_low = multiply(alpha, alpha_low, to, to_low)
            other, other_low = multiply(y[k + 2], low[k + 2], beta, beta_low)
            gap, _ = add(one, one_low, other, other_low)
            _put(w, (ALPHA_2 if dyad else ALPHA_1) + j, alpha)
            _put(w, (BETA_2 if dyad else BETA_1) + j, beta)
            _put(w, (GAP_2 if dyad else GAP_1) + j, gap)
    return int(_solve(y, newton, tangent, work, points))


def is_linkage(y: Complex) -> NDArray[np.bool_]:
    """Return whether the two dyads of a solution differ: shape (...), for y of shape (..., 16).

    They must differ in both isotropic coordinates. If they agree in one, the system has whole curves of solutions, on
    which lost paths end.
    """
    differ = np.ones(y.shape[:-1], np.bool_)
    for half in ([0, 2], [1, 3]):
        first, second = y[..., half], y[..., [k + 4 for k in half]]
        size = np.maximum(np.abs(first), np.abs(second)).max(axis=-1)
        # Both halves must differ: see above.
        differ &= np.abs(first - second).max(axis=-1) > APART * size
    return differ


def residuals(y: Complex, p: Complex, low: Complex | None = None) -> NDArray[np.float64]:
    """Return the largest |αβ + rβ + r̄α| of each solution y (+ low), shape (...), for y of shape (..., 16)."""
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
    """Return the condition of the Jacobian at each solution, unknowns and equations scaled to their size: shape
    (solutions,)."""
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
    """Return the rotations, minus 1, of coupler, first and second link at the points: shape (..., 3, 8)."""
    s = y[..., 8:]
    links = [(p[:8] + y[..., k, None] * s) / y[..., k + 2, None] for k in (0, 4)]
    return np.asarray(np.stack([s, *links], axis=-2))


def orbit_keys(y: Complex, p: Complex, low: Complex | None = None) -> Complex:
    """Return invariants shared by the six solutions y (+ low) of an orbit and by no others: shape (..., 3)."""
    exact = y if low is None else y.astype(np.clongdouble) + low
    first, second, third = np.moveaxis(rotations(exact, p).astype(np.complex128), -2, 0)
    sums = first + second + third
    pairs = first * second + second * third + third * first
    return np.stack([sums @ _WEIGHTS, pairs @ _WEIGHTS, (sums * sums) @ _WEIGHTS], axis=-1)


def exchanged(y: Complex) -> Complex:
    """Return the solutions with their dyads exchanged."""
    return np.concatenate([y[..., 4:8], y[..., :4], y[..., 8:]], axis=-1)


def cognate(y: Complex, p: Complex) -> Complex:
    """Return the cognates that share the first fixed pivot: their first dyad stands on it, their second on the third
    pivot.

    With P at 0 and κ = −x₁/(x₂ − x₁) their moving pivots are q = −r₁ and q(1 − κ), their links −x₁ and κ r₂, and their
    coupler turns as the first link did (Roberts' construction).
    """
    x_1, c_1, r_1, d_1, x_2, c_2, r_2, d_2 = np.moveaxis(y[..., :8], -1, 0)
    ratio, conj_ratio = -x_1 / (x_2 - x_1), -c_1 / (c_2 - c_1)
    vectors = [-r_1, -d_1, -x_1, -c_1, -r_1 * (1.0 - ratio), -d_1 * (1.0 - conj_ratio), ratio * r_2, conj_ratio * d_2]
    return np.asarray(np.concatenate([np.stack(vectors, axis=-1), rotations(y, p)[..., 1, :]], axis=-1))


def cognates(y: Complex, p: Complex) -> Complex:
    """Return the three members of each orbit that differ by more than the order of their dyads: shape (..., 3, 16)."""
    return np.stack([y, cognate(y, p), cognate(exchanged(y), p)], axis=-2)
