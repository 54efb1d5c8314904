"""Nonlinear least squares of Python functions, by MINPACK's Levenberg–Marquardt method through SciPy.

Use it for residuals that are Python functions; :mod:`synthesis.numerics.levenberg` solves problems that are one
compiled function. Failure to converge is a status, never an exception, because one bad start says nothing about the
others.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from scipy.optimize import least_squares

from kinematics.arrays import Real
from synthesis.numerics.status import Status

Function = Callable[[Real], Real]
"""Residuals of shape (m,), or their Jacobian of shape (m, n), at a point of shape (n,)."""

DEFAULT_TOLERANCE = 1e-13
"""Relative change of cost or point below which a fit has converged: a few hundred rounding errors."""

MAX_EVALUATIONS = 200
"""Maximum number of evaluations; a start near a minimum needs ten or twenty."""

_STATUS = {
    -1: Status.IMPOSSIBLE,
    0: Status.STEP_LIMIT,
    1: Status.GRADIENT,
    2: Status.COST,
    3: Status.STEP,
    4: Status.COST,
}
"""Status by SciPy's code; its code 4 means 2 and 3 together."""


class Fit(NamedTuple):
    """Result of a fit from one start: final point, half the sum of squares there, and status."""

    point: Real
    cost: float
    status: Status


def fit(
    residuals: Function,
    jacobian: Function,
    start: Real,
    *,
    tolerance: float = DEFAULT_TOLERANCE,
    evaluations: int = MAX_EVALUATIONS,
) -> Fit:
    """Descend from one start to a local minimum of half the sum of squared residuals.

    Parameters
    ----------
    residuals, jacobian : callable
        Residuals (m,) and Jacobian (m, n), finite everywhere; m may be less than n.
    start : float, shape (n,)
        Starting point.
    tolerance : float
        Relative change of cost and point at which to stop.
    evaluations : int
        Maximum number of evaluations of the residuals.
    """
    values = residuals(start)
    # Without unknowns the start is the minimum; SciPy rejects an empty vector.
    if not len(start):
        return Fit(start, 0.5 * float(values @ values), Status.STEP)
    # MINPACK requires at least as many residuals as unknowns.
    method = "lm" if len(values) >= len(start) else "trf"
    done = least_squares(
        residuals,
        start,
        jac=jacobian,
        method=method,
        ftol=tolerance,
        xtol=tolerance,
        gtol=tolerance,
        max_nfev=evaluations,
    )
    return Fit(done.x, float(done.cost), _STATUS[done.status])
