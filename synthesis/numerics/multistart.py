"""Nonlinear least squares from many starts.

Each start goes to the stationary point of its basin by Levenberg and Marquardt's method (MINPACK, through scipy); the
points that are reached are sorted by cost, and those that are the same to within a stated distance are returned once.
Failure to converge is a status of a fit, never an exception, as a single bad start says nothing about the others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

Real = NDArray[np.float64]

Function = Callable[[Real], Real]
"""Residuals of shape (m,), or their Jacobian of shape (m, n), at a point of shape (n,)."""

TIGHT = 1e-13
"""Relative change of cost or point below which a fit has arrived: some hundred roundings."""

EVALUATIONS = 200
"""Evaluations at most; a start near a minimum takes ten or twenty."""


class Fit(NamedTuple):
    """Where one start has led: the point, half the sum of squares there, and whether the method has arrived."""

    point: Real
    cost: float
    converged: bool


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
    if not len(start):
        found = residuals(start)
        return Fit(start, 0.5 * float(found @ found), True)
    # MINPACK wants at least as many residuals as unknowns.
    method = "lm" if len(residuals(start)) >= len(start) else "trf"
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
    return Fit(done.x, float(done.cost), done.status > 0)


def multistart(
    residuals: Function,
    jacobian: Function,
    starts: Iterable[Real],
    *,
    same: float,
    tolerance: float = TIGHT,
    evaluations: int = EVALUATIONS,
) -> list[Fit]:
    """Minima that are reached from many starts, least cost first, each once.

    Parameters
    ----------
    residuals, jacobian : callable
        See :func:`fit`.
    starts : iterable of float arrays, shape (n,)
        Where to begin.
    same : float
        Minima whose points differ by less than this in every coordinate, as a share of 1 + |coordinate|, are one.
    """
    fits = [fit(residuals, jacobian, start, tolerance=tolerance, evaluations=evaluations) for start in starts]
    return distinct_fits(fits, same=same)


def distinct_fits(fits: Iterable[Fit], *, same: float) -> list[Fit]:
    """Fits with a finite cost, least first, each once."""
    kept: list[Fit] = []
    for candidate in sorted((f for f in fits if np.isfinite(f.cost)), key=lambda f: f.cost):
        near = (np.abs(candidate.point - k.point) <= same * (1.0 + np.abs(k.point)) for k in kept)
        if not any(bool(agree.all()) for agree in near):
            kept.append(candidate)
    return kept
