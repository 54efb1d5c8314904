"""Constrained least squares by the augmented Lagrangian method: descents repeat until the limits hold to rounding.

The method minimizes half the sum of squared residuals under inequalities g(x) ≥ 0 and equations h(x) = 0 (Nocedal &
Wright, *Numerical Optimization*, 2nd ed., secs. 10.3, 17.3). With multipliers λ and a weight w each limit adds one
residual to the problem of :mod:`synthesis.numerics.levenberg`,

    √w (λ/w − g)   where it is positive,        √w (λ/w − h),

and between descents λ becomes max(0, λ − w g), or λ − w h. The cost stays a sum of squares. The multipliers converge
to the Lagrange multipliers of the limits, so that the limits hold to rounding in the end although w stays moderate.

The values g and h are called *margins*. A problem keeps them at the end of its ``state``, one for each multiplier, and
appends their rows by :func:`append_limit_rows`. A limit that was not given has an infinite margin.
"""

from __future__ import annotations

import math

import numpy as np
from numba import types

from kinematics.arrays import Real
from kinematics.compiling import njit
from synthesis.numerics.levenberg import MATRIX, ROWS, VECTOR, Rows, compute_half_square, descend
from synthesis.numerics.status import Status

VIOLATION_TOLERANCE = 1e-11
"""Violation of a limit (in task sizes, or as a share of a length) that counts as rounding."""

MAX_ROUNDS, MAX_STEPS = 20, 300
"""Maximum number of descents, and of steps in each: a problem of a few unknowns that needs more has no minimum."""

GRADIENT_TOLERANCE = 1e-14
"""Relative decrease of the cost at which a descent ends: see :func:`synthesis.numerics.levenberg.descend`."""

SLOW_DECREASE, WEIGHT_INCREASE = 0.25, 10.0
"""Share of the violation above which a descent counts as slow, and the factor that the weight then grows by."""

MIN_WEIGHT = 1e-300
"""Weight w with which limits add nothing to the sum of squares. It cannot be 0 because the rows divide by it."""

_IMPOSSIBLE, _INFEASIBLE = int(Status.IMPOSSIBLE), int(Status.INFEASIBLE)


@njit(cache=True, nogil=True)
def compute_load(margin: float, multiplier: float, weight: float, equation: bool) -> float:
    """Return λ/w − g if the limit bears a load, otherwise 0."""
    load: float = multiplier / weight - margin
    return load if equation or load > 0.0 else 0.0


@njit(cache=True, nogil=True)
def append_limit_rows(
    margins: Real, gradients: Real, equations: int, multipliers: Real, residuals: Real, jacobian: Real, m: int
) -> int:
    """Append the residuals of the limits that bear a load, from row m on, and return the new number of rows.

    Parameters
    ----------
    margins, gradients : float64, shapes (limits,) and (limits, n)
        Values g, the last ``equations`` of them h, and their derivatives by the unknowns.
    multipliers : float64, shape (limits + 1,)
        λ of each limit, then w.
    residuals, jacobian : float64, shapes (most,) and (most, n)
        Output: rows from m on are overwritten.
    """
    limits = margins.size
    weight = multipliers[limits]
    root = math.sqrt(weight)
    for k in range(limits):
        # A limit that was not requested: infinity must not enter the products below.
        if margins[k] == np.inf:
            continue
        load = compute_load(margins[k], multipliers[k], weight, k >= limits - equations)
        # A limit without load adds no row, so that the number of rows changes from step to step.
        if load != 0.0:
            residuals[m] = root * load
            for i in range(gradients.shape[1]):
                jacobian[m, i] = -root * gradients[k, i]
            m += 1
    return m


@njit(cache=True, nogil=True)
def _update_multipliers(margins: Real, equations: int, multipliers: Real) -> float:
    """Update the multipliers for the next descent from the margins of the last one; return the largest violation."""
    limits = margins.size
    weight, worst = multipliers[limits], 0.0
    for k in range(limits):
        # Absent limits keep the multiplier 0.
        if margins[k] < np.inf:
            equation = k >= limits - equations
            # An inequality is violated on one side only, an equation on both.
            worst = max(worst, abs(margins[k]) if equation else -margins[k])
            multipliers[k] = weight * compute_load(margins[k], multipliers[k], weight, equation)
    return worst


@njit(
    types.int64(
        types.FunctionType(ROWS), VECTOR, MATRIX, VECTOR, VECTOR, types.int64,
        types.int64, types.int64, types.float64, types.int64, types.int64, VECTOR
    ),
    cache=True,
    nogil=True,
)  # fmt: skip
def descend_constrained(
    rows: Rows,
    x: Real,
    points: Real,
    setting: Real,
    state: Real,
    most: int,
    limits: int,
    equations: int,
    weight: float,
    rounds: int,
    steps: int,
    ended: Real,
) -> int:
    """Descend in place to a minimum at which all limits hold, and return the status of the last descent.

    Limits with kinks, such as minimum distances, may stay violated: if several sides of a kink bear a load, the
    multipliers do not converge, and the violation decreases only as the weight grows.

    Parameters
    ----------
    rows, x, points, setting, state, most
        As for :func:`synthesis.numerics.levenberg.descend`.
    limits, equations : int
        Number of limits, and of equations among them, which come last.
    weight : float
        Initial w.
    rounds, steps : int
        Maximum number of descents (the multipliers are updated after each) and of steps per descent:
        :data:`MAX_ROUNDS` and :data:`MAX_STEPS`, or fewer if steps are expensive.
    ended : float64, shape (1,)
        Output: half the sum of squares at the minimum without the rows of the limits; infinite without a minimum.
    """
    multipliers = np.zeros(limits + 1)
    multipliers[limits] = weight
    # Zeros, because functions write only those entries of a row that may differ from 0.
    residuals, jacobian = np.empty(most), np.zeros((most, x.size))
    margins = state[state.size - limits :]
    before = worst = np.inf
    status = _IMPOSSIBLE
    ended[0] = np.inf
    for _ in range(rounds):
        _, status = descend(rows, x, points, setting, multipliers, state, most, steps, GRADIENT_TOLERANCE)
        # The start is outside the domain; more weight cannot help.
        if status == _IMPOSSIBLE:
            return _IMPOSSIBLE
        worst = _update_multipliers(margins, equations, multipliers)
        if worst <= VIOLATION_TOLERANCE:
            break
        if worst > SLOW_DECREASE * before:
            # Multipliers estimate those of the constrained minimum, so they are kept when the weight changes.
            multipliers[limits] *= WEIGHT_INCREASE
        before = worst
    # Evaluate once more with the limits switched off: the reported cost must not contain their penalty.
    multipliers[:limits], multipliers[limits] = 0.0, MIN_WEIGHT
    m = rows(x, points, setting, multipliers, state, residuals, jacobian)
    if m < 0:
        return _IMPOSSIBLE
    ended[0] = compute_half_square(residuals, m)
    # Accept ten times the tolerance: an update in the last round may have come close without reaching it.
    end: int = status if worst <= 10.0 * VIOLATION_TOLERANCE else _INFEASIBLE
    return end
