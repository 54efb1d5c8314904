"""Compiled Levenberg–Marquardt method with geodesic acceleration, for minima at the end of curved valleys.

If many combinations of the unknowns hardly change the residuals r, the minimum lies in a curved valley that is far
longer than it is wide. A step along its tangent v leaves the valley and is rejected. With the second derivative of the
residuals along v a step follows the bend (Transtrum & Sethna, arXiv:1201.5885, 2012):

    [J; √μ D] v = −[r; 0],     [J; √μ D] a = −[r_vv; 0],     δ = v + a/2,

    r_vv = 2 ((r(x + h v) − r)/h − J v)/h,

A step is accepted if |D a| ≤ α |D v| and the sum of squares decreases. D holds the maximum norm of each column of J so
far. One QR decomposition solves both systems; normal equations would lose the flat directions that matter here.
Problems have the form of :mod:`synthesis.numerics.levenberg`. Where rows appear or vanish, as those of limits do, a
step has no acceleration.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from kinematics.arrays import Integers, Real
from kinematics.compiling import njit
from synthesis.numerics.levenberg import MATRIX, ROWS, VECTOR, Rows, compute_half_square

FIRST_DAMPING, MIN_DAMPING, MAX_DAMPING = 1e-3, 1e-20, 1e8
"""Damping μ: initial value, minimum, and the value above which the descent has stalled."""

DAMPING_DECREASE, DAMPING_INCREASE = 5.0, 2.0
"""Factors by which the damping falls after an accepted step and rises after a rejected one."""

MAX_ACCELERATION_RATIO = 0.75
"""Maximum ratio α of acceleration to velocity, both scaled by D."""

DIFFERENCE_STEP = 0.1
"""Step h of the finite difference for the second derivative, as a multiple of the velocity."""

MAX_STEP = 1.0
"""Maximum change of an unknown in one step."""

ROUNDING_COST = 1e-29
"""Cost below which it is pure rounding, since residuals are scaled to the size of the task."""

MIN_RELATIVE_GAIN, MAX_STALLED_STEPS = 1e-9, 5
"""Relative gain at or below which a step counts as idle, and the number of consecutive idle steps that end the descent.
"""


@njit(cache=True, nogil=True, error_model="numpy")
def _decompose_qr(matrix: Real, rows: int, columns: int, heads: Real) -> bool:
    """Decompose a matrix in place by Householder reflections; return whether it has full rank.

    Afterwards R is stored above the diagonal and its diagonal in ``heads``. The reflection vectors are stored on and
    below the diagonal.
    """
    for j in range(columns):
        square = 0.0
        for i in range(j, rows):
            square += matrix[i, j] * matrix[i, j]
        if not square > 0.0:
            return False
        # The sign opposite to the head avoids cancellation in the reflection vector.
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
def _solve_qr(matrix: Real, rows: int, columns: int, heads: Real, right: Real, step: Real) -> None:
    """Solve the least-squares problem of a decomposed system for ``step``; ``right`` is overwritten."""
    # Apply the reflections to the right side, then substitute backward in R.
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
def _compute_scaled_norm(scale: Real, step: Real) -> float:
    """Return the norm |D step|."""
    total = 0.0
    for j in range(step.size):
        total += (scale[j] * step[j]) ** 2
    return math.sqrt(total)


@njit(cache=True, nogil=True, error_model="numpy")
def _list_open_unknowns(jacobian: Real, m: int, open_: Integers) -> int:
    """Write the indices of the unknowns whose column is not zero; return their count."""
    # Columns of zeros belong to unknowns that the problem holds fixed; the QR decomposition must not contain them.
    free = 0
    for j in range(len(open_)):
        norm = 0.0
        for i in range(m):
            norm += jacobian[i, j] * jacobian[i, j]
        if norm > 0.0:
            open_[free] = j
            free += 1
    return free


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_damped_matrix(
    jacobian: Real, m: int, open_: Integers, free: int, damping: float, scale: Real, matrix: Real
) -> None:
    """Write the columns of the open unknowns above the damping rows; ``scale`` has their maximum norms so far."""
    for j in range(free):
        norm = 0.0
        for i in range(m):
            matrix[i, j] = jacobian[i, open_[j]]
            norm += matrix[i, j] * matrix[i, j]
        # The running maximum makes the scaling monotonic, which Moré's convergence proof needs.
        scale[j] = max(scale[j], math.sqrt(norm))
        for i in range(free):
            matrix[m + i, j] = 0.0
        matrix[m + j, j] = math.sqrt(damping) * scale[j]


@njit(cache=True, nogil=True, error_model="numpy")
def _write_bending(
    jacobian: Real, m: int, open_: Integers, free: int, velocity: Real, residuals: Real, ahead: Real, right: Real
) -> None:
    """Write minus the second derivative of the residuals along the velocity, from the residuals a small step ahead."""
    right[: m + free] = 0.0
    for i in range(m):
        along = 0.0
        for j in range(free):
            along += jacobian[i, open_[j]] * velocity[j]
        right[i] = -2.0 / DIFFERENCE_STEP * ((ahead[i] - residuals[i]) / DIFFERENCE_STEP - along)


@njit(cache=True, nogil=True, error_model="numpy")
def _solve_velocity(
    matrix: Real, m: int, free: int, heads: Real, residuals: Real, right: Real, velocity: Real
) -> float:
    """Solve for the velocity with the decomposed matrix, and return the magnitude of its largest component."""
    right[: m + free] = 0.0
    right[:m] = -residuals[:m]
    _solve_qr(matrix, m + free, free, heads, right, velocity)
    return float(np.abs(velocity).max())


@njit(cache=True, nogil=True, error_model="numpy")
def _move_open(x: Real, open_: Integers, free: int, step: Real, trial: Real) -> None:
    """Write x with a step of the open unknowns into ``trial``."""
    trial[:] = x
    for j in range(free):
        trial[open_[j]] += step[j]


@njit(
    types.float64(types.FunctionType(ROWS), VECTOR, MATRIX, VECTOR, VECTOR, VECTOR, types.int64, types.int64),
    cache=True,
    nogil=True,
    error_model="numpy",
)
def follow_valley(
    rows: Rows, x: Real, points: Real, setting: Real, multipliers: Real, state: Real, most: int, steps: int
) -> float:
    """Descend from x in place, and return half the sum of squares at the end; infinite if the start is impossible.

    Parameters
    ----------
    rows, x, points, setting, multipliers, state, most
        As for :func:`synthesis.numerics.levenberg.descend`.
    steps : int
        Maximum number of steps to try, rejected ones included.
    """
    n = x.size
    residuals, jacobian = np.zeros(most), np.zeros((most, n))
    tried, unused = np.zeros(most), np.zeros((most, n))
    m = rows(x, points, setting, multipliers, state, residuals, jacobian)
    if m < 0:
        return math.inf
    cost = compute_half_square(residuals, m)
    trial, trial_state, open_ = np.empty(n), np.empty(state.size), np.zeros(n, np.int64)
    free = _list_open_unknowns(jacobian, m, open_)
    velocity, acceleration, heads, scale = np.zeros(free), np.zeros(free), np.zeros(free), np.zeros(free)
    matrix, right = np.zeros((most + free, free)), np.zeros(most + free)
    damping, idle = FIRST_DAMPING, 0
    for _ in range(steps):
        # The descent ends at rounding level, without an acceptable damping, or without progress.
        if cost < ROUNDING_COST or damping > MAX_DAMPING or idle >= MAX_STALLED_STEPS:
            break
        _fill_damped_matrix(jacobian, m, open_, free, damping, scale, matrix)
        if not _decompose_qr(matrix, m + free, free, heads):
            break
        longest = _solve_velocity(matrix, m, free, heads, residuals, right, velocity)
        # Infinite or NaN: the decomposition was numerically singular.
        if not longest < math.inf:
            break
        # A long step says nothing about the direction of the valley at x: damp it instead of shortening it.
        if longest > MAX_STEP:
            damping *= DAMPING_INCREASE
            continue
        _move_open(x, open_, free, DIFFERENCE_STEP * velocity, trial)
        trial_state[:] = state
        ahead = rows(trial, points, setting, multipliers, trial_state, tried, unused)
        if ahead < 0:
            damping *= DAMPING_INCREASE
            continue
        acceleration[:] = 0.0
        if ahead == m:
            # Second derivative of the residuals along the velocity, by a one-sided difference with the known slope.
            _write_bending(jacobian, m, open_, free, velocity, residuals, tried, right)
            _solve_qr(matrix, m + free, free, heads, right, acceleration)
        # A large acceleration means that the quadratic model does not hold over this step.
        limit = MAX_ACCELERATION_RATIO * _compute_scaled_norm(scale, velocity)
        if not _compute_scaled_norm(scale, acceleration) <= limit:
            damping *= DAMPING_INCREASE
            continue
        # Second-order Taylor step x(1) = x + v + a/2 along the geodesic.
        _move_open(x, open_, free, velocity + 0.5 * acceleration, trial)
        trial_state[:] = state
        reached = rows(trial, points, setting, multipliers, trial_state, tried, unused)
        gained = compute_half_square(tried, reached) if reached >= 0 else math.inf
        if not gained < cost:
            damping *= DAMPING_INCREASE
            continue
        # Several idle steps in turn are needed: in a curved valley a single small gain is normal.
        idle = idle + 1 if cost - gained <= MIN_RELATIVE_GAIN * cost else 0
        cost, m = gained, reached
        x[:] = trial
        state[:] = trial_state
        # Swap buffers instead of copying.
        residuals, tried, jacobian, unused = tried, residuals, unused, jacobian
        damping = max(damping / DAMPING_DECREASE, MIN_DAMPING)
    return cost
