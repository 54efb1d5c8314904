"""Fourbars on two given fixed pivots whose coupler point goes through five points: the polynomial system.

Everything is relative to the first point. A dyad has the fixed pivot a, given, and the moving pivot x in the first
position; the coupler has turned by e^{iφⱼ} = 1 + sⱼ at point δⱼ, j = 1…4. With isotropic coordinates (each vector and
its conjugate are two unknowns) the dyad keeps its length where

    αβ + rβ + r̄α = 0,    α = δⱼ + x sⱼ,    β = δ̄ⱼ + x̄ s̄ⱼ,    r = x − a,    s̄ⱼ = −sⱼ/(1 + sⱼ)

(Wampler, Morgan & Sommese 1992, eq. 6 with r no longer free): eight equations for x, x̄ of both dyads and four sⱼ.
Eliminating each sⱼ leaves four quartics in four unknowns with at most 36 solutions (Morgan & Wampler 1990,
doi:10.1115/1.2912641); for general points and pivots there are as many, none singular.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex
from kinematics.compiling import njit
from synthesis.numerics.continuation import SYSTEM, CompiledSystem
from synthesis.numerics.elimination import factor, solve

SOLUTION_COUNT = 36
"""Number of solutions for general points and pivots."""

UNKNOWN_COUNT, PARAMETER_COUNT, SCRATCH_SIZE = 8, 12, 72
"""Number of unknowns x₁, x̄₁, x₂, x̄₂, s₁…s₄; of parameters δ₁…δ₄, their conjugates, a₁, ā₁, a₂, ā₂; size of the
workspace."""

MIN_SCALE = 1e-300
"""Number added to the size of s, which scales a column, so that a coupler that does not turn causes no division by
zero."""

SCALE_GROUPS = np.array([0, 0, 0, 0, 1, 1, 1, 1], np.int64)
"""Scale group of each unknown: the vectors share a scale, and the rotations share another."""


@njit(SYSTEM, cache=True, nogil=True)
def evaluate_five_point_system(
    y: Complex, low: Complex, p: Complex, p_low: Complex, dp: Complex, newton: Complex, tangent: Complex, work: Complex
) -> int:
    """Compute Newton's step and the tangent of the system, in the form that the continuation follows."""
    matrix = work[:64].reshape((8, 8))
    pivots = work[64:72].view(np.int64)
    matrix[:] = 0.0
    for j in range(4):
        s = y[4 + j]
        back = 1.0 / (1.0 + s)
        s_back, slope = -s * back, -back * back
        for dyad in range(2):
            row, k = 2 * j + dyad, 2 * dyad
            x, x_bar, a, a_bar = y[k], y[k + 1], p[8 + k], p[9 + k]
            alpha, beta = p[j] + x * s, p[4 + j] + x_bar * s_back
            by_alpha, by_beta = beta + x_bar - a_bar, alpha + x - a
            matrix[row, k] = by_alpha * s + beta
            matrix[row, k + 1] = by_beta * s_back + alpha
            matrix[row, 4 + j] = by_alpha * x + by_beta * x_bar * slope
            newton[row] = -(alpha * beta + (x - a) * beta + (x_bar - a_bar) * alpha)
            tangent[row] = -(by_alpha * dp[j] + by_beta * dp[4 + j] - dp[8 + k] * beta - dp[9 + k] * alpha)
    # A singular matrix makes the continuation shorten its step.
    if not factor(matrix, pivots):
        return 0
    solve(matrix, pivots, newton)
    solve(matrix, pivots, tangent)
    return 1


def compute_residuals(y: Complex, p: Complex) -> NDArray[np.float64]:
    """Return the largest |αβ + rβ + r̄α| of each solution, shape (...), for y of shape (..., 8)."""
    s = y[..., 4:]
    s_back = -s / (1.0 + s)
    largest = np.zeros(y.shape[:-1])
    for k in (0, 2):
        x, x_bar, a, a_bar = y[..., k, None], y[..., k + 1, None], p[8 + k], p[9 + k]
        alpha, beta = p[:4] + x * s, p[4:8] + x_bar * s_back
        gaps = np.abs(alpha * beta + (x - a) * beta + (x_bar - a_bar) * alpha)
        largest = np.maximum(largest, gaps.max(axis=-1))
    return np.asarray(largest)


def compute_conditions(y: Complex, p: Complex) -> NDArray[np.float64]:
    """Return the condition number of the Jacobian at each solution, shape (solutions,).

    Rows and columns are scaled to their size.
    """
    jacobian = np.zeros((len(y), UNKNOWN_COUNT, UNKNOWN_COUNT), np.complex128)
    s = y[:, 4:]
    back = 1.0 / (1.0 + s)
    s_back, slope = -s * back, -back * back
    j = np.arange(4)
    for dyad in range(2):
        k = 2 * dyad
        x, x_bar = y[:, k, None], y[:, k + 1, None]
        alpha, beta = p[:4] + x * s, p[4:8] + x_bar * s_back
        by_alpha, by_beta = beta + x_bar - p[9 + k], alpha + x - p[8 + k]
        rows = 2 * j + dyad
        jacobian[:, rows, k] = by_alpha * s + beta
        jacobian[:, rows, k + 1] = by_beta * s_back + alpha
        jacobian[:, rows, 4 + j] = by_alpha * x + by_beta * x_bar * slope
    vectors = np.abs(y[:, :4]).max(axis=1)[:, None]
    sizes = np.concatenate([np.repeat(vectors, 4, axis=1), np.abs(s) + MIN_SCALE], axis=1)
    # Scale columns by their unknowns, so that large linkages do not appear singular.
    jacobian *= sizes[:, None, :]
    # Without this scaling the condition would measure the units of the rows, not nearness to a double solution.
    norms = np.abs(jacobian).max(axis=2)
    jacobian /= np.where(norms > 0.0, norms, 1.0)[:, :, None]
    return np.asarray(np.linalg.cond(jacobian))


FIVE_POINT_SYSTEM = CompiledSystem(evaluate_five_point_system, SCALE_GROUPS, SCRATCH_SIZE)
"""The equations for the tracker."""
