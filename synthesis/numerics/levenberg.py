"""Compiled Levenberg–Marquardt method for thousands of small descents per second.

The method minimizes half the sum of squared residuals from a starting point. Limits are residuals, too, and
:mod:`synthesis.numerics.augmented_lagrangian` enforces them.

A problem is one compiled function that writes the residuals and their Jacobian:

    rows(x, points, setting, multipliers, state, residuals, jacobian) -> number of rows m, or −1 if x is impossible

``points`` and ``setting`` are the data of the problem. ``multipliers`` has one number for each limit, followed by
their weight. ``state`` holds unknowns that the function eliminates itself, such as crank angles; it is kept only for
accepted steps. All functions have the type :data:`ROWS`, so that the method is compiled once.

With r the residuals, J their Jacobian, A = JᵀJ and g = Jᵀr, a step solves

    (A + μ D) δ = −g,        D = the maximum diagonal of A so far (Moré 1978, doi:10.1007/BFb0067700),

and its predicted gain is −δᵀ(g + A δ/2). With ρ the ratio of the actual to the predicted gain, an accepted step
multiplies the damping μ by max(1/3, 1 − (2ρ − 1)³); rejected steps multiply it by 2, 4, 8 … in turn (Nielsen 1999,
IMM-REP-1999-05, sec. 3).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import types
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.compiling import njit
from synthesis.numerics.cholesky import solve_positive
from synthesis.numerics.status import Status

VECTOR = types.Array(types.float64, 1, "C")
MATRIX = types.Array(types.float64, 2, "C")

ROWS = types.int64(VECTOR, MATRIX, VECTOR, VECTOR, VECTOR, VECTOR, MATRIX)
"""The type of a problem: x, points, setting, multipliers, state, residuals, jacobian."""

Rows = Callable[[Real, Real, Real, Real, Real, Real, Real], int]
"""The same type for a type checker."""

MIN_DAMPING, FIRST_DAMPING, MAX_DAMPING = 1e-15, 1e-3, 1e12
"""Damping μ: minimum, initial value, and the value above which the descent has stalled."""

MAX_STEP = 1.0
"""Maximum change of an unknown in one step; problems scale their unknowns so that this is a long step."""

ZERO_COST = 1e-30
"""Cost below which it is pure rounding, since residuals are scaled to the size of the task."""

MIN_SCALE = 1e-12
"""Minimum entry of D: an unknown that no residual depends on keeps its value."""

STEP_TOLERANCE = 1e-15
"""Length of a step, or ratio of the predicted gain to the cost, below which it is rounding."""

_NO_DECREASE, _SINGULAR, _IMPOSSIBLE = int(Status.NO_DECREASE), int(Status.SINGULAR), int(Status.IMPOSSIBLE)
_STEP_LIMIT, _GRADIENT, _COST = int(Status.STEP_LIMIT), int(Status.GRADIENT), int(Status.COST)
_STEP, _ZERO = int(Status.STEP), int(Status.ZERO)

DESCENT_RESULT = types.Tuple((types.float64, types.int64))
"""Compiled type of a descent's result: half the sum of squares and the :class:`~synthesis.numerics.status.Status`."""


@njit(cache=True, nogil=True)
def compute_half_square(residuals: Real, m: int) -> float:
    """Return half the sum of squares of the first m residuals."""
    cost = 0.0
    for k in range(m):
        cost += 0.5 * residuals[k] * residuals[k]
    return cost


@njit(cache=True, nogil=True)
def _build_normal_equations(residuals: Real, jacobian: Real, m: int, n: int, matrix: Real, gradient: Real) -> None:
    """Write g and the lower triangle of A for the first m rows."""
    for i in range(n):
        gradient[i] = 0.0
        for j in range(i + 1):
            matrix[i, j] = 0.0
    for k in range(m):
        row, value = jacobian[k], residuals[k]
        # Many rows depend on few unknowns: skipping zeros saves most of the products.
        for i in range(n):
            if row[i] != 0.0:
                gradient[i] += row[i] * value
                for j in range(i + 1):
                    matrix[i, j] += row[i] * row[j]


@njit(cache=True, nogil=True)
def _predict_gain(matrix: Real, gradient: Real, step: Real) -> float:
    """Return the predicted gain −δᵀ(g + A δ/2), from the lower triangle of A."""
    gain = 0.0
    for i in range(step.size):
        curved = 0.0
        for j in range(step.size):
            curved += (matrix[i, j] if j <= i else matrix[j, i]) * step[j]
        gain -= step[i] * (gradient[i] + 0.5 * curved)
    return gain


@njit(cache=True, nogil=True)
def _damp_equations(matrix: Real, gradient: Real, damping: float, scale: Real, factor: Real, step: Real) -> None:
    """Write the damped normal equations: their lower triangle into ``factor``, the right side into ``step``.

    ``scale`` is the maximum diagonal so far, relative to which the damping is measured.
    """
    for i in range(len(scale)):
        scale[i] = max(scale[i], matrix[i, i])
        step[i] = -gradient[i]
        for j in range(i + 1):
            factor[i, j] = matrix[i, j]
        factor[i, i] += damping * scale[i]


@njit(cache=True, nogil=True)
def _solve_step(matrix: Real, gradient: Real, damping: float, scale: Real, factor: Real, step: Real) -> float:
    """Write the damped step; return its largest change before it is shortened, −1 if the equations are singular."""
    _damp_equations(matrix, gradient, damping, scale, factor, step)
    if not solve_positive(factor, step):
        return -1.0
    longest: float = np.abs(step).max()
    # Shorten, but keep the direction; the predicted gain is then computed for the shortened step.
    step *= MAX_STEP / longest if longest > MAX_STEP else 1.0
    return longest


@njit(cache=True, nogil=True)
def _compute_damping_factor(gained: float, expected: float) -> float:
    """Return the factor of the damping after a step that gained less or more than expected."""
    # Without a predicted gain the model is at rounding level; 1 leaves the damping moderate.
    ratio = gained / expected if expected > 0.0 else 1.0
    return max(1.0 / 3.0, 1.0 - (2.0 * ratio - 1.0) ** 3)


@njit(
    DESCENT_RESULT(
        types.FunctionType(ROWS), VECTOR, MATRIX, VECTOR, VECTOR, VECTOR, types.int64, types.int64, types.float64
    ),
    cache=True,
    nogil=True,
)
def descend(
    rows: Rows, x: Real, points: Real, setting: Real, multipliers: Real, state: Real, most: int, steps: int,
    tolerance: float,
) -> tuple[float, int]:  # fmt: skip
    """Descend from x in place to a local minimum, and return half the sum of squares there and the status.

    Parameters
    ----------
    rows : compiled function of type :data:`ROWS`
        The problem.
    x, points, setting, multipliers, state : float64
        Arguments of the function; ``x`` and ``state`` are changed in place.
    most : int
        Maximum number of rows.
    steps : int
        Maximum number of steps, rejected ones included.
    tolerance : float
        The descent has converged when the cost decreases by less than this share in two consecutive steps.

    Returns
    -------
    cost : float
        Infinite if the start is impossible.
    status : int
        A :class:`~synthesis.numerics.status.Status`.
    """
    n = x.size
    residuals, trial_residuals = np.empty(most), np.empty(most)
    jacobian, trial_jacobian = np.zeros((most, n)), np.zeros((most, n))
    m = rows(x, points, setting, multipliers, state, residuals, jacobian)
    if m < 0:
        return np.inf, _IMPOSSIBLE
    trial, trial_state = np.empty(n), np.empty(state.size)
    matrix, factor, gradient, step = np.empty((n, n)), np.empty((n, n)), np.empty(n), np.empty(n)
    scale = np.full(n, MIN_SCALE)
    cost = compute_half_square(residuals, m)
    # Also true for NaN.
    if not cost < np.inf:
        return np.inf, _IMPOSSIBLE
    _build_normal_equations(residuals, jacobian, m, n, matrix, gradient)
    damping, growth, small = FIRST_DAMPING, 2.0, 0
    for _ in range(steps):
        if cost < ZERO_COST:
            return cost, _ZERO
        longest = _solve_step(matrix, gradient, damping, scale, factor, step)
        # A matrix that is not positive definite to rounding needs much more damping: increase it in large steps.
        if longest < 0.0:
            damping *= 10.0
            if damping > MAX_DAMPING:
                return cost, _SINGULAR
            continue
        if not longest < np.inf:
            return cost, _SINGULAR
        expected = _predict_gain(matrix, gradient, step)
        trial[:] = x + step
        trial_state[:] = state
        trial_m = rows(trial, points, setting, multipliers, trial_state, trial_residuals, trial_jacobian)
        trial_cost = compute_half_square(trial_residuals, trial_m) if trial_m >= 0 else np.inf
        if trial_cost < cost:
            damping = max(damping * _compute_damping_factor(cost - trial_cost, expected), MIN_DAMPING)
            growth = 2.0
            small = small + 1 if cost - trial_cost <= tolerance * cost else 0
            cost, m = trial_cost, trial_m
            x[:], state[:] = trial, trial_state
            residuals, trial_residuals = trial_residuals, residuals
            jacobian, trial_jacobian = trial_jacobian, jacobian
            _build_normal_equations(residuals, jacobian, m, n, matrix, gradient)
            # Require two in succession, because a single tiny gain may follow a badly damped step.
            if small >= 2:
                return cost, _COST
            continue
        # The step was rejected, but the predicted gain is only rounding: the point is stationary to working precision.
        if expected <= STEP_TOLERANCE * cost:
            return cost, _GRADIENT
        # A step below rounding cannot change the point.
        if longest < STEP_TOLERANCE:
            return cost, _STEP
        damping *= growth
        growth *= 2.0
        if damping > MAX_DAMPING:
            return cost, _NO_DECREASE
    return cost, _STEP_LIMIT


@njit(
    types.void(
        types.FunctionType(ROWS), MATRIX, MATRIX, VECTOR, VECTOR, MATRIX, types.int64, types.int64, types.float64,
        VECTOR, types.Array(types.int64, 1, "C"),
    ),
    cache=True,
    nogil=True,
)  # fmt: skip
def descend_each(
    rows: Rows,
    starts: Real,
    points: Real,
    setting: Real,
    multipliers: Real,
    states: Real,
    most: int,
    steps: int,
    tolerance: float,
    costs: Real,
    statuses: NDArray[np.int64],
) -> None:
    """Descend from each start in place; ``costs`` and ``statuses`` receive the results. See :func:`descend`."""
    for k in range(len(starts)):
        costs[k], statuses[k] = descend(
            rows, starts[k], points, setting, multipliers, states[k], most, steps, tolerance
        )
