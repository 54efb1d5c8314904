"""Roots of many functions at once, each known to change sign in a bracket.

Chandrupatla's method (Adv. Eng. Software 28 (1997) 145, doi:10.1016/s0965-9978(96)00051-8): inverse quadratic
interpolation through three points where it is safe, halving elsewhere; superlinear, and never worse than a few times
bisection. Evaluations are arrays over all brackets, because one of them costs hardly less than a hundred.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]

STEPS = 100
"""Evaluations at most; a dozen is usual."""


def find_roots(
    function: Callable[[Real], Real], low: Real, high: Real, at_low: Real | None = None, at_high: Real | None = None
) -> tuple[Real, Real]:
    """Close brackets with a change of sign in each down to rounding.

    Parameters
    ----------
    function : callable
        Takes points of shape (n,), one for each bracket, and returns values of the same shape.
    low, high : float, shape (n,)
        Ends of the brackets; the values there have opposite signs, or one of them is zero.
    at_low, at_high : float, shape (n,), optional
        The values there, where they are known already.

    Returns
    -------
    positive, negative : float, shape (n,)
        The ends of the final brackets where the function is not negative, and where it is not positive.
    """
    x1, x2 = low.astype(np.float64), high.astype(np.float64)
    f1 = function(x1) if at_low is None else at_low
    f2 = function(x2) if at_high is None else at_high
    x3, f3 = x2.copy(), f2.copy()
    t = np.full(len(x1), 0.5)
    for _ in range(STEPS):
        x = x1 + t * (x2 - x1)
        f = function(x)
        same = np.sign(f) == np.sign(f1)
        x3, f3 = np.where(same, x1, x2), np.where(same, f1, f2)
        x2, f2 = np.where(same, x2, x1), np.where(same, f2, f1)
        x1, f1 = x, f
        near = np.abs(f1) < np.abs(f2)
        tolerance = 2.0 * np.finfo(float).eps * np.abs(np.where(near, x1, x2)) + np.finfo(float).tiny
        with np.errstate(divide="ignore", invalid="ignore"):
            share = tolerance / np.abs(x2 - x1)
            xi, phi = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
            safe = (phi * phi < xi) & ((1.0 - phi) ** 2 < 1.0 - xi)
            quadratic = f1 / (f2 - f1) * f3 / (f2 - f3) + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        if np.all((share > 0.5) | (f1 == 0.0)):
            break
        t = np.where(safe & np.isfinite(quadratic), quadratic, 0.5)
        t = np.clip(t, np.minimum(share, 0.5), np.maximum(1.0 - share, 0.5))
    positive = np.where((f1 >= 0.0) & ((f2 < 0.0) | (np.abs(f1) <= np.abs(f2))), x1, x2)
    negative = np.where((f1 <= 0.0) & ((f2 > 0.0) | (np.abs(f1) <= np.abs(f2))), x1, x2)
    return positive, negative


def sign_changes(values: Real) -> NDArray[np.int64]:
    """Indices n along a grid between which and n + 1 the values change sign; not across unknown (NaN) ones."""
    known = np.isfinite(values[:-1]) & np.isfinite(values[1:])
    with np.errstate(invalid="ignore"):
        return np.flatnonzero(known & ((values[:-1] > 0.0) != (values[1:] > 0.0)))
