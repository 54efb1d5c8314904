"""All stationary points of a piecewise smooth function of one number, so that a worst value is exact and not sampled.

On each piece the function is replaced by the polynomial through Chebyshev's points, the piece being halved until the
polynomial agrees to rounding (Battles & Trefethen, SIAM J. Sci. Comput. 25 (2004) 1743,
doi:10.1137/S1064827503430126); the derivative's roots are the eigenvalues of its colleague matrix (Good 1961; Boyd,
*Solving Transcendental Equations*, SIAM 2014, ch. 2). Values are the polynomial's, so that at a jump they are limits
from within the piece; at a stationary point they err by the square of the point's error, which is to say by rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Real = NDArray[np.float64]
Function = Callable[[Real], Real]

DEGREE = 16
"""Of the local polynomials: high enough that a law's piece needs one or two, low enough for quick eigenvalues."""

RESOLVED = 1e-13
"""Size of the last coefficients, relative to the function's largest value, at which a polynomial is accepted."""

ROUNDED = 8.0 * float(np.finfo(np.float64).eps)
"""Error of a point by rounding, as a share of it, with some room."""

HALVINGS = 24
"""At most; a kink or a jump inside a piece, which no polynomial fits, is closed in to 1e-7 of the piece."""

CROWDED = 4096
"""Parts still open, beyond those that the breaks ask for, at which the rest is taken as it is: kinks leave a few open
in each round, and only a function that is rounding from end to end leaves so many, which no halving mends."""

NEGLIGIBLE = 1e-15
"""Share of a polynomial's largest coefficient below which a leading one is rounding and is dropped."""

NEAR_REAL = 1e-4
"""Imaginary part up to which an eigenvalue is taken as a real root. A root too many costs one value of the function,
a double root that is split by rounding lies within the square root of it."""

NEAR_ROOT = 1e-9
"""Value, relative to the largest, up to which a real eigenvalue is a root and not the real part of a pair."""

SAME = 1e-12
"""Distance of one root found twice, relative to the whole interval."""

_NODES = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
_FIT = np.cos(np.outer(np.arange(DEGREE + 1), np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1)))
_FIT *= 2.0 / (DEGREE + 1)
_FIT[0] *= 0.5
_ENDS = np.stack([(-1.0) ** np.arange(DEGREE + 1), np.ones(DEGREE + 1)])


@dataclass(frozen=True)
class Extremes:
    """Least and greatest value over all pieces, and where they are; of equal ones the first."""

    least: float
    greatest: float
    at_least: float
    at_greatest: float

    @property
    def largest(self) -> float:
        """The greatest absolute value."""
        return max(abs(self.least), abs(self.greatest))


def extremes(function: Function, breaks: ArrayLike) -> Extremes:
    """Least and greatest value of a function that is smooth between breaks, one-sided limits at the breaks included.

    Parameters
    ----------
    function : callable
        Takes points of any shape and gives finite values of the same shape. It is never called at a break.
    breaks : float, shape (n + 1,)
        Ascending.
    """
    low, high, series, owner = _fit(function, np.asarray(breaks, dtype=np.float64))
    # Chebyshev polynomials are at most 1: a part whose series cannot leave the range of what is known holds no extreme.
    ends = series @ _ENDS.T
    swing = np.abs(series[:, 1:]).sum(axis=1) * (1.0 + ROUNDED)
    beyond = (series[:, 0] - swing <= ends.min()) | (series[:, 0] + swing >= ends.max())
    points, values = _stationary(low, high, series, owner, beyond)
    least, greatest = int(values.argmin()), int(values.argmax())
    return Extremes(float(values[least]), float(values[greatest]), float(points[least]), float(points[greatest]))


def stationary_points(function: Function, breaks: ArrayLike) -> tuple[Real, Real]:
    """Every point where the derivative vanishes, and both sides of every break, ascending, with the values there.

    Returns
    -------
    points, values : float, shape (m,)
        At the breaks the limits from within each piece.
    """
    low, high, series, owner = _fit(function, np.asarray(breaks, dtype=np.float64))
    return _stationary(low, high, series, owner, np.ones(len(low), np.bool_))


def _stationary(
    low: Real, high: Real, series: Real, owner: NDArray[np.int64], where: NDArray[np.bool_]
) -> tuple[Real, Real]:
    """Points and values where some of the series have no slope, and at the ends of all; ascending."""
    some = np.flatnonzero(where)
    row, root = _roots(_differentiated(series[some]))
    row = some[row]
    inner = _within(low[row], high[row], root)
    points = np.concatenate([low, inner, high])
    at_inner = (series[row] * np.cos(np.arange(DEGREE + 1) * np.arccos(root)[:, None])).sum(axis=1)
    ends = series @ _ENDS.T
    values = np.concatenate([ends[:, 0], at_inner, ends[:, 1]])
    order = np.lexsort((np.concatenate([owner, owner[row], owner]), points))
    return points[order], values[order]


def roots(function: Function, breaks: Real) -> Real:
    """Every root of a function that is smooth between breaks, ascending; a jump through zero at a break is none.

    Where the function vanishes on a whole piece nothing is reported for it. A double root may appear twice.
    """
    low, high, series, _ = _fit(function, breaks)
    row, root = _roots(series)
    points = _within(low[row], high[row], root)
    size = np.abs(series).max(initial=0.0)
    found = np.sort(points[np.abs(function(points)) <= NEAR_ROOT * size]) if len(points) else points
    # A root where two halves of a piece meet is found in both.
    apart = np.diff(found) > SAME * float(breaks[-1] - breaks[0])
    return found[np.append(True, apart)] if len(found) else found


def _fit(function: Function, breaks: Real) -> tuple[Real, Real, Real, NDArray[np.int64]]:
    """Ends and Chebyshev series of parts so small that the series hold to rounding, and the piece each is part of."""
    low, high = breaks[:-1], breaks[1:]
    owner = np.arange(len(low))
    done: list[tuple[Real, Real, Real, NDArray[np.int64]]] = []
    size = 0.0
    for step in range(HALVINGS + 1):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        values = function(middle[:, None] + half[:, None] * _NODES)
        size = max(size, float(np.abs(values).max(initial=0.0)))
        # Less the first value of each row, so that a constant has no rounding at all.
        series = (values - values[:, :1]) @ _FIT.T
        series[:, 0] += values[:, 0]
        # The argument is rounded too, which no halving mends: on a short steep piece its rounding is all there is left.
        rounding = ROUNDED * np.abs(middle) / half * np.ptp(values, axis=1)
        good = np.abs(series[:, -3:]).max(axis=1) <= RESOLVED * size + rounding
        if step == HALVINGS or len(low) > CROWDED + 2 * len(breaks):
            good[:] = True
        done.append((low[good], high[good], series[good], owner[good]))
        bad = ~good
        if not bad.any():
            break
        low, high = np.concatenate([low[bad], middle[bad]]), np.concatenate([middle[bad], high[bad]])
        owner = np.concatenate([owner[bad], owner[bad]])
    lows, highs, fits, owners = (np.concatenate(parts) for parts in zip(*done, strict=True))
    return lows, highs, fits, owners


def _within(low: Real, high: Real, root: Real) -> Real:
    """Points of pieces from roots in [−1, 1]; rounding does not carry them over an end."""
    return np.clip(0.5 * (low + high) + 0.5 * (high - low) * root, low, high)


def _differentiated(series: Real) -> Real:
    """Chebyshev series of the derivatives, one order shorter: d_{k−1} = d_{k+1} + 2 k c_k."""
    n = series.shape[1] - 1
    result = np.zeros((len(series), n + 2))
    for k in range(n, 0, -1):
        result[:, k - 1] = result[:, k + 1] + 2.0 * k * series[:, k]
    result[:, 0] *= 0.5
    return result[:, :n]


def _roots(series: Real) -> tuple[NDArray[np.int64], Real]:
    """Rows and roots in [−1, 1] of Chebyshev series, batched by their true degree."""
    size = np.abs(series)
    possible = (size[:, 0] <= size[:, 1:].sum(axis=1)) & (size.max(axis=1) > 0.0)
    large = size > NEGLIGIBLE * size.max(axis=1, keepdims=True)
    degree = series.shape[1] - 1 - np.argmax(large[:, ::-1], axis=1)
    found_rows, found_roots = [np.empty(0, dtype=np.int64)], [np.empty(0)]
    for n in range(1, series.shape[1]):
        rows = np.flatnonzero(possible & (degree == n))
        if not len(rows):
            continue
        matrix = np.zeros((len(rows), n, n))
        if n == 1:
            matrix[:, 0, 0] = -series[rows, 0] / series[rows, 1]
        else:
            matrix[:, 0, 1] = 1.0
            below = np.arange(1, n)
            matrix[:, below, below - 1] = 0.5
            matrix[:, below[:-1], below[:-1] + 1] = 0.5
            matrix[:, n - 1, :] -= 0.5 * series[rows, :n] / series[rows, n : n + 1]
        values = np.linalg.eigvals(matrix)
        real = (np.abs(values.imag) <= NEAR_REAL) & (np.abs(values.real) <= 1.0 + NEAR_REAL)
        which, _ = np.nonzero(real)
        found_rows.append(rows[which])
        found_roots.append(np.clip(values.real[real], -1.0, 1.0))
    return np.concatenate(found_rows), np.concatenate(found_roots)
