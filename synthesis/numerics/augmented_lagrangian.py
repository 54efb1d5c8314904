"""Limits of least squares, met by multipliers: descents that are repeated until the limits hold to rounding.

Half the sum of squared residuals is made least under inequalities g(x) ≥ 0 and equations h(x) = 0 by the augmented
Lagrangian (Nocedal & Wright, *Numerical Optimization*, 2nd ed., secs. 10.3, 17.3). With multipliers λ and a weight w a
limit is one more residual of :mod:`synthesis.numerics.levenberg`,

    √w (λ/w − g)   where it is positive,        √w (λ/w − h),

and between descents λ becomes max(0, λ − w g), or λ − w h. The cost stays a sum of squares, and limits hold to rounding
in the end although w stays moderate, since the multipliers converge to the limits' forces.

The values g and h are *margins*. A problem keeps them at the end of its ``state``, one for each multiplier, and appends
their rows by :func:`limit_rows`. An infinite margin is that of a limit that is not stated.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import types
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.numerics.levenberg import MATRIX, ROWS, VECTOR, descend, half_square
from synthesis.numerics.status import Status

Real = NDArray[np.float64]

VIOLATION_TOLERANCE = 1e-11
"""Violation of a limit (task sizes; shares of a length) that counts as rounding."""

MAX_ROUNDS, MAX_STEPS = 20, 300
"""Number of descents, and of steps of each, after which a problem of a few unknowns has no minimum."""

TOLERANCE = 1e-14
"""Of a descent: see :func:`synthesis.numerics.levenberg.descend`."""

SLOW_DECREASE, WEIGHT_INCREASE = 0.25, 10.0
"""Where a descent leaves more than the first share of the violation, the weight is multiplied by the second."""

MIN_WEIGHT = 1e-300
"""A weight w with which limits add nothing to the sum of squares; w divides, so that it cannot be 0."""

_IMPOSSIBLE, _INFEASIBLE = int(Status.IMPOSSIBLE), int(Status.INFEASIBLE)


@njit(cache=True, nogil=True)
def load_of(margin: float, multiplier: float, weight: float, equation: bool) -> float:
    """λ/w − g where the limit bears a load, else 0."""
    load: float = multiplier / weight - margin
    return load if equation or load > 0.0 else 0.0


@njit(cache=True, nogil=True)
def limit_rows(
    margins: Real, gradients: Real, equations: int, multipliers: Real, residuals: Real, jacobian: Real, m: int
) -> int:
    """Append the residuals of limits that bear a load from row m on; returns the number of rows.

    Parameters
    ----------
    margins, gradients : float64, shapes (limits,) and (limits, n)
        Values g, and h for the last ``equations`` of them, and their derivatives by the unknowns.
    multipliers : float64, shape (limits + 1,)
        λ of each, and w.
    residuals, jacobian : float64, shapes (most,) and (most, n)
        Written.
    """
    limits = margins.size
    weight = multipliers[limits]
    root = math.sqrt(weight)
    for k in range(limits):
        if margins[k] == np.inf:
            continue
        load = load_of(margins[k], multipliers[k], weight, k >= limits - equations)
        if load != 0.0:
            residuals[m] = root * load
            for i in range(gradients.shape[1]):
                jacobian[m, i] = -root * gradients[k, i]
            m += 1
    return m


@njit(cache=True, nogil=True)
def _renew(margins: Real, equations: int, multipliers: Real) -> float:
    """Multipliers for the next descent from the margins at the end of the last; the largest violation."""
    limits = margins.size
    weight, worst = multipliers[limits], 0.0
    for k in range(limits):
        if margins[k] < np.inf:
            equation = k >= limits - equations
            worst = max(worst, abs(margins[k]) if equation else -margins[k])
            multipliers[k] = weight * load_of(margins[k], multipliers[k], weight, equation)
    return worst


@njit(
    types.int64(
        types.FunctionType(ROWS), VECTOR, MATRIX, VECTOR, VECTOR, types.int64,
        types.int64, types.int64, types.float64, types.int64, types.int64, VECTOR
    ),
    cache=True,
    nogil=True,
)  # fmt: skip
def hold(
    rows: Any,
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
    """Descend in place to a minimum at which all limits hold; returns the status of the last descent.

    Limits with kinks, such as least distances have, may be left violated: where several sides of one bear a load the
    multipliers do not converge, and the violation falls only as the weight grows.

    Parameters
    ----------
    rows, x, points, setting, state, most
        As for :func:`synthesis.numerics.levenberg.descend`.
    limits, equations : int
        Number of limits, and how many of them, the last, are equations.
    weight : float
        w at first.
    rounds, steps : int
        Greatest number of descents, with the multipliers renewed after each, and of steps of each:
        :data:`MAX_ROUNDS`, :data:`MAX_STEPS`, or fewer where they are expensive.
    ended : float64, shape (1,)
        Gets half the sum of squares there, without that of the limits; infinite where there is no minimum.
    """
    multipliers = np.zeros(limits + 1)
    multipliers[limits] = weight
    residuals, jacobian = np.empty(most), np.zeros((most, x.size))
    margins = state[state.size - limits :]
    before = worst = np.inf
    status = _IMPOSSIBLE
    ended[0] = np.inf
    for _ in range(rounds):
        _, status = descend(rows, x, points, setting, multipliers, state, most, steps, TOLERANCE)
        if status == _IMPOSSIBLE:
            return _IMPOSSIBLE
        worst = _renew(margins, equations, multipliers)
        if worst <= VIOLATION_TOLERANCE:
            break
        if worst > SLOW_DECREASE * before:
            # Multipliers are forces: they are kept when the weight changes.
            multipliers[limits] *= WEIGHT_INCREASE
        before = worst
    multipliers[:limits], multipliers[limits] = 0.0, MIN_WEIGHT
    m = rows(x, points, setting, multipliers, state, residuals, jacobian)
    if m < 0:
        return _IMPOSSIBLE
    ended[0] = half_square(residuals, m)
    end: int = status if worst <= 10.0 * VIOLATION_TOLERANCE else _INFEASIBLE
    return end
