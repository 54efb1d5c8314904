"""Levenberg and Marquardt's method with inequalities, compiled: thousands of small descents in a second.

Half the sum of squared residuals is made least under equations h(x) = 0 and inequalities g(x) ≥ 0 by the augmented
Lagrangian (Nocedal & Wright, *Numerical Optimization*, 2nd ed., secs. 10.3, 17.3): a limit is one more residual,

    √w (λ/w − g)   where it is positive,        √w (h − λ/w),

and between descents λ becomes the part of λ − w g that is positive, or λ − w h. The residuals stay a sum of squares,
and limits are met in the end to rounding, as the multipliers λ bear their load and not the weight w.

A problem is one compiled function that writes residuals and their Jacobian, limits among them:

    rows(x, points, setting, multipliers, state, residuals, jacobian) -> number of rows, or −1 where x is impossible

``points`` and ``setting`` are what the problem is made of. ``multipliers`` has λ for each limit and w as its last
number. ``state`` is what a problem remembers of the last point that was accepted, and changes as it likes: unknowns
that it eliminates itself. The type of the function is :data:`ROWS`, so that one compiled method serves all.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

Real = NDArray[np.float64]

_VECTOR = types.Array(types.float64, 1, "C")
_MATRIX = types.Array(types.float64, 2, "C")

ROWS = types.int64(_VECTOR, _MATRIX, _VECTOR, _VECTOR, _VECTOR, _VECTOR, _MATRIX)
"""The type of a problem: x, points, setting, multipliers, state, residuals, jacobian."""

LEAST_DAMPING, FIRST_DAMPING, MOST_DAMPING = 1e-15, 1e-3, 1e12

LONGEST_STEP = 1.0
"""Longest step of one unknown; unknowns are scaled so that this is far."""

NOTHING = 1e-30
"""A sum of squares that is rounding alone."""


@njit(cache=True, nogil=True)
def solve_positive(matrix: Real, right: Real, n: int) -> bool:
    """Solve a symmetric positive definite system in place by Cholesky's method; False where it is not definite."""
    for j in range(n):
        for k in range(j):
            matrix[j, j] -= matrix[j, k] * matrix[j, k]
        if not matrix[j, j] > 0.0:
            return False
        matrix[j, j] = math.sqrt(matrix[j, j])
        for i in range(j + 1, n):
            for k in range(j):
                matrix[i, j] -= matrix[i, k] * matrix[j, k]
            matrix[i, j] /= matrix[j, j]
    for i in range(n):
        for k in range(i):
            right[i] -= matrix[i, k] * right[k]
        right[i] /= matrix[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            right[i] -= matrix[k, i] * right[k]
        right[i] /= matrix[i, i]
    return True


@njit(cache=True, nogil=True)
def _normal(residuals: Real, jacobian: Real, m: int, n: int, matrix: Real, gradient: Real) -> None:
    for i in range(n):
        gradient[i] = 0.0
        for j in range(i + 1):
            matrix[i, j] = 0.0
    for k in range(m):
        row, value = jacobian[k], residuals[k]
        for i in range(n):
            if row[i] != 0.0:
                gradient[i] += row[i] * value
                for j in range(i + 1):
                    matrix[i, j] += row[i] * row[j]


@njit(
    types.float64(
        types.FunctionType(ROWS), _VECTOR, _MATRIX, _VECTOR, _VECTOR, _VECTOR, types.int64, types.int64, types.float64
    ),
    cache=True,
    nogil=True,
)
def descend(
    rows: Any,
    x: Real,
    points: Real,
    setting: Real,
    multipliers: Real,
    state: Real,
    most: int,
    steps: int,
    tolerance: float,
) -> float:
    """Descend from x, in place, to a local minimum; returns half the sum of squares there, infinite if x is impossible.

    Parameters
    ----------
    rows : compiled function of type :data:`ROWS`
        The problem.
    x, points, setting, multipliers, state : float64
        What it is given; ``x`` and ``state`` are changed.
    most : int
        Rows at most.
    steps : int
        Steps at most, tried ones included.
    tolerance : float
        Relative decrease at which the descent ends when two steps in turn make no more.
    """
    n = x.size
    residuals, trial_residuals = np.empty(most), np.empty(most)
    jacobian, trial_jacobian = np.zeros((most, n)), np.zeros((most, n))
    m = rows(x, points, setting, multipliers, state, residuals, jacobian)
    if m < 0:
        return np.inf
    trial, trial_state = np.empty(n), np.empty(state.size)
    matrix, factor, gradient, step = np.empty((n, n)), np.empty((n, n)), np.empty(n), np.empty(n)
    scale = np.full(n, 1e-12)
    cost = 0.0
    for k in range(m):
        cost += 0.5 * residuals[k] * residuals[k]
    _normal(residuals, jacobian, m, n, matrix, gradient)
    damping, growth, small = FIRST_DAMPING, 2.0, 0
    for _ in range(steps):
        if not 1e-300 < cost < np.inf or cost < NOTHING:
            break
        for i in range(n):
            scale[i] = max(scale[i], matrix[i, i])
            step[i] = -gradient[i]
            for j in range(i + 1):
                factor[i, j] = matrix[i, j]
            factor[i, i] += damping * scale[i]
        if not solve_positive(factor, step, n):
            damping *= 10.0
            if damping > MOST_DAMPING:
                break
            continue
        longest = 0.0
        for i in range(n):
            longest = max(longest, abs(step[i]))
        if not longest < np.inf:
            break
        short = LONGEST_STEP / longest if longest > LONGEST_STEP else 1.0
        expected = 0.0
        for i in range(n):
            step[i] *= short
        for i in range(n):
            trial[i] = x[i] + step[i]
            curved = 0.0
            for j in range(n):
                curved += (matrix[i, j] if j <= i else matrix[j, i]) * step[j]
            expected -= step[i] * (gradient[i] + 0.5 * curved)
        trial_state[:] = state
        found = rows(trial, points, setting, multipliers, trial_state, trial_residuals, trial_jacobian)
        now = np.inf
        if found >= 0:
            now = 0.0
            for k in range(found):
                now += 0.5 * trial_residuals[k] * trial_residuals[k]
        if now < cost:
            ratio = (cost - now) / expected if expected > 0.0 else 1.0
            small = small + 1 if cost - now <= tolerance * cost else 0
            cost = now
            x[:] = trial
            state[:] = trial_state
            m = found
            residuals, trial_residuals = trial_residuals, residuals
            jacobian, trial_jacobian = trial_jacobian, jacobian
            _normal(residuals, jacobian, m, n, matrix, gradient)
            damping = max(damping * max(1.0 / 3.0, 1.0 - (2.0 * ratio - 1.0) ** 3), LEAST_DAMPING)
            growth = 2.0
            if small >= 2:
                break
        else:
            # A step that should gain less than rounding and gains nothing: the minimum is here.
            if expected <= 1e-15 * cost or longest < 1e-15:
                break
            damping *= growth
            growth *= 2.0
            if damping > MOST_DAMPING:
                break
    return cost
