"""Nonlinear least squares of a Python function: Levenberg and Marquardt's method of MINPACK, through scipy.

For problems whose unknowns are solved for on the way; those that are one compiled function go to
:mod:`synthesis.numerics.levenberg`. Failure to converge is a status of a fit, never an exception, as a single bad start
says nothing about the others.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from synthesis.numerics.status import Status

Real = NDArray[np.float64]

Function = Callable[[Real], Real]
"""Residuals of shape (m,), or their Jacobian of shape (m, n), at a point of shape (n,)."""

TIGHT = 1e-13
"""Relative change of cost or point below which a fit has arrived: some hundred roundings."""

EVALUATIONS = 200
"""Evaluations at most; a start near a minimum takes ten or twenty."""

_STATUS = {
    -1: Status.IMPOSSIBLE,
    0: Status.STEP_LIMIT,
    1: Status.GRADIENT,
    2: Status.COST,
    3: Status.STEP,
    4: Status.COST,
}
"""Scipy's statuses; its 4 is 2 and 3 together."""


class Fit(NamedTuple):
    """Where one start has led: the point, half the sum of squares there, and how the method has ended."""

    point: Real
    cost: float
    status: Status


def fit(
    residuals: Function, jacobian: Function, start: Real, *, tolerance: float = TIGHT, evaluations: int = EVALUATIONS
) -> Fit:
    """Descend from one start to a local minimum of half the sum of squared residuals.

    Parameters
    ----------
    residuals, jacobian : callable
        Residuals (m,) and Jacobian (m, n), finite everywhere; m may be less than n.
    start : float, shape (n,)
        Where to begin.
    tolerance : float
        Relative change of cost and point at which to stop.
    evaluations : int
        Evaluations of the residuals at most.
    """
    values = residuals(start)
    if not len(start):
        return Fit(start, 0.5 * float(values @ values), Status.STEP)
    # MINPACK wants at least as many residuals as unknowns.
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
