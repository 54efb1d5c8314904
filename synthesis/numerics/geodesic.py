"""Levenberg and Marquardt's method with geodesic acceleration, compiled: for minima at the end of curved valleys.

Where many combinations of the unknowns hardly change the residuals r, the least squares lie in a valley that is curved
and far longer than wide. Steps along its tangent v leave it and are refused. With the second derivative of the
residuals along v a step follows it round (Transtrum & Sethna, arXiv:1201.5885, 2012):

    [J; √μ D] v = −[r; 0],     [J; √μ D] a = −[r_vv; 0],     δ = v + a/2,

    r_vv = 2 ((r(x + h v) − r)/h − J v)/h,

accepted where |D a| ≤ α |D v| and the squares are less. D is the greatest norm of each column of J so far. Both systems
are solved by one QR decomposition, as normal equations lose the directions that are looked for. Problems are those of
:mod:`synthesis.numerics.levenberg`; their rows are as many, and in the same order, wherever they are asked for.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import types
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.numerics.levenberg import MATRIX, ROWS, VECTOR, half_square

Real = NDArray[np.float64]

FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-3, 1e-20, 1e8
"""Damping μ: at first, least, and that above which the descent has stalled."""

LOWERED, RAISED = 5.0, 2.0
"""By what it falls with a step that is accepted, and rises with one that is refused."""

ALPHA = 0.75
"""Greatest acceleration beside the velocity."""

DIFFERENCE = 0.1
"""Step h of the second derivative, in velocities."""

LONGEST = 1.0
"""Greatest change of an unknown in one step."""

ROUNDING = 1e-29
"""Cost that is rounding alone; residuals are scaled to the task."""

SMALL_GAIN, PATIENCE = 1e-9, 5
"""Relative gain with which a step counts as none, and how many such in turn end the descent."""


@njit(cache=True, nogil=True, error_model="numpy")
def _decomposed(matrix: Real, rows: int, columns: int, heads: Real) -> bool:
    """Householder's decomposition in place: R above, the vectors below and on the diagonal with ``heads`` for R's."""
    for j in range(columns):
        square = 0.0
        for i in range(j, rows):
            square += matrix[i, j] * matrix[i, j]
        if not square > 0.0:
            return False
        norm = -math.copysign(math.sqrt(square), matrix[j, j])
        heads[j] = norm
        matrix[j, j] -= norm
        scale = square - norm * (matrix[j, j] + norm)
        for k in range(j + 1, columns):
            product = 0.0
            for i in range(j, rows):
                product += matrix[i, j] * matrix[i, k]
            product /= scale
            for i in range(j, rows):
                matrix[i, k] -= product * matrix[i, j]
    return True


@njit(cache=True, nogil=True, error_model="numpy")
def _solved(matrix: Real, rows: int, columns: int, heads: Real, right: Real, step: Real) -> None:
    """Least squares of a decomposed system; ``right`` is used up."""
    for j in range(columns):
        scale = -heads[j] * matrix[j, j]
        product = 0.0
        for i in range(j, rows):
            product += matrix[i, j] * right[i]
        product /= scale
        for i in range(j, rows):
            right[i] -= product * matrix[i, j]
    for j in range(columns - 1, -1, -1):
        value = right[j]
        for k in range(j + 1, columns):
            value -= matrix[j, k] * step[k]
        step[j] = value / heads[j]


@njit(cache=True, nogil=True, error_model="numpy")
def _scaled_norm(scale: Real, step: Real) -> float:
    total = 0.0
    for j in range(step.size):
        total += (scale[j] * step[j]) ** 2
    return math.sqrt(total)


@njit(
    types.float64(types.FunctionType(ROWS), VECTOR, MATRIX, VECTOR, VECTOR, VECTOR, types.int64, types.int64),
    cache=True,
    nogil=True,
    error_model="numpy",
)
def follow_valley(
    rows: Any, x: Real, points: Real, setting: Real, multipliers: Real, state: Real, most: int, steps: int
) -> float:
    """Descend from x, in place; returns half the sum of squares there, infinite where the start is impossible.

    Parameters
    ----------
    rows, x, points, setting, multipliers, state, most
        As for :func:`synthesis.numerics.levenberg.descend`.
    steps : int
        Greatest number of velocities that are tried, refused ones included.
    """
    n = x.size
    residuals, jacobian = np.zeros(most), np.zeros((most, n))
    tried, unused = np.zeros(most), np.zeros((most, n))
    m = rows(x, points, setting, multipliers, state, residuals, jacobian)
    if m < 0:
        return math.inf
    cost = half_square(residuals, m)
    trial, trial_state = np.empty(n), np.empty(state.size)
    open_, scale = np.zeros(n, np.int64), np.zeros(n)
    free = 0
    for j in range(n):
        norm = 0.0
        for i in range(m):
            norm += jacobian[i, j] * jacobian[i, j]
        if norm > 0.0:
            open_[free] = j
            free += 1
    velocity, acceleration, heads = np.zeros(free), np.zeros(free), np.zeros(free)
    scale = np.zeros(free)
    matrix, right = np.zeros((most + free, free)), np.zeros(most + free)
    damping, idle = FIRST_DAMPING, 0
    for _ in range(steps):
        if cost < ROUNDING or damping > MOST_DAMPING or idle >= PATIENCE:
            break
        for j in range(free):
            norm = 0.0
            for i in range(m):
                matrix[i, j] = jacobian[i, open_[j]]
                norm += matrix[i, j] * matrix[i, j]
            scale[j] = max(scale[j], math.sqrt(norm))
            for i in range(free):
                matrix[m + i, j] = 0.0
            matrix[m + j, j] = math.sqrt(damping) * scale[j]
        if not _decomposed(matrix, m + free, free, heads):
            break
        right[: m + free] = 0.0
        right[:m] = -residuals[:m]
        _solved(matrix, m + free, free, heads, right, velocity)
        longest = np.abs(velocity).max()
        if not longest < math.inf:
            break
        # A long step is no direction of the valley at x.
        if longest > LONGEST:
            damping *= RAISED
            continue
        trial[:] = x
        for j in range(free):
            trial[open_[j]] += DIFFERENCE * velocity[j]
        trial_state[:] = state
        if rows(trial, points, setting, multipliers, trial_state, tried, unused) != m:
            damping *= RAISED
            continue
        right[: m + free] = 0.0
        for i in range(m):
            along = 0.0
            for j in range(free):
                along += jacobian[i, open_[j]] * velocity[j]
            right[i] = -2.0 / DIFFERENCE * ((tried[i] - residuals[i]) / DIFFERENCE - along)
        _solved(matrix, m + free, free, heads, right, acceleration)
        if not _scaled_norm(scale, acceleration) <= ALPHA * _scaled_norm(scale, velocity):
            damping *= RAISED
            continue
        trial[:] = x
        for j in range(free):
            trial[open_[j]] += velocity[j] + 0.5 * acceleration[j]
        trial_state[:] = state
        reached = rows(trial, points, setting, multipliers, trial_state, tried, unused)
        gained = half_square(tried, m) if reached == m else math.inf
        if not gained < cost:
            damping *= RAISED
            continue
        idle = idle + 1 if cost - gained <= SMALL_GAIN * cost else 0
        cost = gained
        x[:] = trial
        state[:] = trial_state
        residuals, tried = tried, residuals
        jacobian, unused = unused, jacobian
        damping = max(damping / LOWERED, LEAST_DAMPING)
    return cost
