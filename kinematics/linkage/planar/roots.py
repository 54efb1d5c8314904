"""Roots of many functions at once, each with a change of sign in a bracket.

Chandrupatla's method (Adv. Eng. Software 28 (1997) 145, doi:10.1016/s0965-9978(96)00051-8): inverse quadratic
interpolation through three points where it is safe, halving elsewhere; superlinear, and never worse than a few times
bisection. Evaluations are arrays over all brackets, because one evaluation costs hardly less than a hundred of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.compiling import njit

MAX_STEPS = 100
"""Maximum number of evaluations; a dozen is usual."""

EPSILON, SMALLEST_NUMBER = float(np.finfo(float).eps), float(np.finfo(float).tiny)


def find_roots(
    function: Callable[[Real], Real], low: Real, high: Real, at_low: Real | None = None, at_high: Real | None = None
) -> tuple[Real, Real]:
    """Shrink brackets, each with a change of sign, down to rounding.

    Parameters
    ----------
    function : callable
        Takes points of shape (n,), one for each bracket, and returns values of the same shape.
    low, high : float, shape (n,)
        Ends of the brackets; the values there have opposite signs, or one of them is zero.
    at_low, at_high : float, shape (n,), optional
        Values there, if already known.

    Returns
    -------
    positive, negative : float, shape (n,)
        Ends of the final brackets at which the function is nonnegative, and nonpositive.
    """
    x1, x2 = low.astype(np.float64), high.astype(np.float64)
    f1 = function(x1) if at_low is None else at_low.astype(np.float64)
    f2 = function(x2) if at_high is None else at_high.astype(np.float64)
    state = np.stack([x1, f1, x2, f2, x2, f2])
    x = x1 + 0.5 * (x2 - x1)
    for _ in range(MAX_STEPS):
        if _advance(state, function(x), x):
            break
    x1, f1, x2, f2, _, _ = state
    positive = np.where((f1 >= 0.0) & ((f2 < 0.0) | (np.abs(f1) <= np.abs(f2))), x1, x2)
    negative = np.where((f1 <= 0.0) & ((f2 > 0.0) | (np.abs(f1) <= np.abs(f2))), x1, x2)
    return positive, negative


@njit(cache=True, nogil=True, error_model="numpy")
def _advance(state: Real, values: Real, x: Real) -> bool:
    """Process the values at ``x``, replace ``x`` by the next places, and return whether all brackets are closed.

    ``state``, shape (6, n): the newest end of each bracket, its other end and the previous end, a place and a value
    each.
    """
    done = True
    for n in range(len(x)):
        x1, f1, x2, f2, _, _ = state[:, n]
        f = values[n]
        x3, f3 = x1, f1
        if np.sign(f) != np.sign(f1):
            x3, f3, x2, f2 = x2, f2, x1, f1
        x1, f1 = x[n], f
        state[0, n], state[1, n], state[2, n], state[3, n], state[4, n], state[5, n] = x1, f1, x2, f2, x3, f3
        near = x1 if abs(f1) < abs(f2) else x2
        share = (2.0 * EPSILON * abs(near) + SMALLEST_NUMBER) / abs(x2 - x1)
        if share > 0.5 or f1 == 0.0:
            x[n] = x1
            continue
        done, t = False, 0.5
        xi, phi = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
        # Chandrupatla's criterion: inverse quadratic interpolation is safe only if it is monotonic.
        if phi * phi < xi and (1.0 - phi) ** 2 < 1.0 - xi:
            t = f1 / (f2 - f1) * f3 / (f2 - f3) + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        if not math.isfinite(t):
            t = 0.5
        x[n] = x1 + min(max(t, min(share, 0.5)), max(1.0 - share, 0.5)) * (x2 - x1)
    return done


def find_sign_changes(values: Real) -> NDArray[np.int64]:
    """Find indices n along a grid with a change of sign between n and n + 1, not across unknown (NaN) values."""
    known = np.isfinite(values[:-1]) & np.isfinite(values[1:])
    with np.errstate(invalid="ignore"):
        return np.flatnonzero(known & ((values[:-1] > 0.0) != (values[1:] > 0.0)))
