"""All stationary points of a piecewise smooth function of one variable: worst values are exact, not sampled.

On each piece the function is replaced by the polynomial through Chebyshev points; the piece is halved until the
polynomial agrees to rounding (Battles & Trefethen, SIAM J. Sci. Comput. 25 (2004) 1743,
doi:10.1137/S1064827503430126); the derivative's roots are the eigenvalues of its colleague matrix (Good 1961; Boyd,
*Solving Transcendental Equations*, SIAM 2014, ch. 2). Values are the polynomial's, so that at a jump they are limits
from within the piece; at a stationary point their error is the square of the point's error, that is, rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Real

Function = Callable[[Real], Real]

DEGREE = 16
"""Degree of the local polynomials: high enough that a piece of a law needs one or two, low enough for fast
eigenvalues."""

RESOLUTION_TOLERANCE = 1e-13
"""Size of the last coefficients, relative to the function's largest value, at which a polynomial is accepted."""

ROUNDING_ERROR = 8.0 * float(np.finfo(np.float64).eps)
"""Rounding error of a point, as a share of its value: 8 ε, a generous bound."""

MAX_HALVINGS = 24
"""Maximum number of halvings; a kink or jump inside a piece, which no polynomial fits, is located to 1e-7 of it."""

MAX_OPEN_PARTS = 4096
"""Number of unresolved parts, beyond two per break, at which the rest is accepted unresolved. Kinks leave a few parts
in each round. Only a function that consists of rounding noise leaves this number, and halving does not help there."""

NEGLIGIBLE_COEFFICIENT = 1e-15
"""Share of a polynomial's largest coefficient below which a leading one is rounding and is dropped."""

MAX_IMAGINARY_PART = 1e-4
"""Imaginary part up to which an eigenvalue counts as a real root. A spurious root costs one evaluation, whereas
rounding splits a double root by the square root of ε, about 1e-8."""

ROOT_TOLERANCE = 1e-9
"""Function value, relative to the largest, up to which a candidate is a root and not the real part of a complex
pair."""

DUPLICATE_TOLERANCE = 1e-12
"""Distance below which two roots are the same, relative to the whole interval."""

_CHEBYSHEV_NODES = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
_FIT_MATRIX = np.cos(np.outer(np.arange(DEGREE + 1), np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1)))
_FIT_MATRIX *= 2.0 / (DEGREE + 1)
_FIT_MATRIX[0] *= 0.5
_END_VALUES = np.stack([(-1.0) ** np.arange(DEGREE + 1), np.ones(DEGREE + 1)])


@dataclass(frozen=True)
class Extremes:
    """Minimum and maximum over all pieces, and where they occur; the first place if several have the same value."""

    least: float
    greatest: float
    at_least: float
    at_greatest: float

    @property
    def largest(self) -> float:
        """Maximum absolute value."""
        return max(abs(self.least), abs(self.greatest))


def find_extremes(function: Function, breaks: ArrayLike) -> Extremes:
    """Find the minimum and maximum of a function that is smooth between breaks, one-sided limits included.

    Parameters
    ----------
    function : callable
        Maps points of any shape to finite values of the same shape. It is never called at a break.
    breaks : float, shape (n + 1,)
        Ascending.
    """
    low, high, series, owner = _fit_series(function, np.asarray(breaks, dtype=np.float64))
    # Chebyshev polynomials are at most 1 in size: a part whose series stays within the known range holds no extreme.
    ends = series @ _END_VALUES.T
    swing = np.abs(series[:, 1:]).sum(axis=1) * (1.0 + ROUNDING_ERROR)
    beyond = (series[:, 0] - swing <= ends.min()) | (series[:, 0] + swing >= ends.max())
    points, values = _find_stationary(low, high, series, owner, beyond)
    least, greatest = int(values.argmin()), int(values.argmax())
    return Extremes(float(values[least]), float(values[greatest]), float(points[least]), float(points[greatest]))


def find_stationary_points(function: Function, breaks: ArrayLike) -> tuple[Real, Real]:
    """Find every point where the derivative vanishes, and both sides of every break, ascending, with their values.

    Returns
    -------
    points, values : float, shape (m,)
        Places and values there; at breaks the values are the limits from within each piece.
    """
    low, high, series, owner = _fit_series(function, np.asarray(breaks, dtype=np.float64))
    return _find_stationary(low, high, series, owner, np.ones(len(low), np.bool_))


def _find_stationary(
    low: Real, high: Real, series: Real, owner: NDArray[np.int64], where: NDArray[np.bool_]
) -> tuple[Real, Real]:
    """Find points and values where selected series have zero slope, and at the ends of all series; ascending."""
    some = np.flatnonzero(where)
    row, root = _find_series_roots(_differentiate_series(series[some]))
    row = some[row]
    inner = _scale_to_piece(low[row], high[row], root)
    points = np.concatenate([low, inner, high])
    # T_k(cos x) = cos k x.
    at_inner = (series[row] * np.cos(np.arange(DEGREE + 1) * np.arccos(root)[:, None])).sum(axis=1)
    ends = series @ _END_VALUES.T
    values = np.concatenate([ends[:, 0], at_inner, ends[:, 1]])
    order = np.lexsort((np.concatenate([owner, owner[row], owner]), points))
    return points[order], values[order]


def find_roots(function: Function, breaks: Real) -> Real:
    """Find every root of a function that is smooth between breaks, ascending; a jump across zero is not a root.

    A piece on which the function vanishes identically has no roots. A double root may appear twice.
    """
    low, high, series, _ = _fit_series(function, breaks)
    row, root = _find_series_roots(series)
    points = _scale_to_piece(low[row], high[row], root)
    size = np.abs(series).max(initial=0.0)
    found = np.sort(points[np.abs(function(points)) <= ROOT_TOLERANCE * size]) if len(points) else points
    # A root where two halves of a piece meet is found in both.
    apart = np.diff(found) > DUPLICATE_TOLERANCE * float(breaks[-1] - breaks[0])
    return found[np.append(True, apart)] if len(found) else found


def _fit_series(function: Function, breaks: Real) -> tuple[Real, Real, Real, NDArray[np.int64]]:
    """Halve pieces until their Chebyshev series hold to rounding; return ends, series and the piece of each part."""
    low, high = breaks[:-1], breaks[1:]
    owner = np.arange(len(low))
    done: list[tuple[Real, Real, Real, NDArray[np.int64]]] = []
    size = 0.0
    for step in range(MAX_HALVINGS + 1):
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        values = function(middle[:, None] + half[:, None] * _CHEBYSHEV_NODES)
        size = max(size, float(np.abs(values).max(initial=0.0)))
        # Subtract the first value of each row, so that a constant has no rounding at all.
        series = (values - values[:, :1]) @ _FIT_MATRIX.T
        series[:, 0] += values[:, 0]
        # Rounding of the argument does not shrink by halving: on a short steep piece it dominates.
        rounding = ROUNDING_ERROR * np.abs(middle) / half * np.ptp(values, axis=1)
        # Three coefficients, because every second one vanishes for an odd or even function.
        good = np.abs(series[:, -3:]).max(axis=1) <= RESOLUTION_TOLERANCE * size + rounding
        if step == MAX_HALVINGS or len(low) > MAX_OPEN_PARTS + 2 * len(breaks):
            good[:] = True
        done.append((low[good], high[good], series[good], owner[good]))
        bad = ~good
        if not bad.any():
            break
        low, high = np.concatenate([low[bad], middle[bad]]), np.concatenate([middle[bad], high[bad]])
        owner = np.concatenate([owner[bad], owner[bad]])
    lows, highs, fits, owners = (np.concatenate(parts) for parts in zip(*done, strict=True))
    return lows, highs, fits, owners


def _scale_to_piece(low: Real, high: Real, root: Real) -> Real:
    """Map roots in [−1, 1] to points of pieces, clipped so that rounding cannot move them over an end."""
    return np.clip(0.5 * (low + high) + 0.5 * (high - low) * root, low, high)


def _differentiate_series(series: Real) -> Real:
    """Differentiate Chebyshev series, one order shorter: d_{k−1} = d_{k+1} + 2 k c_k."""
    n = series.shape[1] - 1
    result = np.zeros((len(series), n + 2))
    for k in range(n, 0, -1):
        result[:, k - 1] = result[:, k + 1] + 2.0 * k * series[:, k]
    result[:, 0] *= 0.5
    return result[:, :n]


def _find_series_roots(series: Real) -> tuple[NDArray[np.int64], Real]:
    """Find rows and roots in [−1, 1] of Chebyshev series, batched by their true degree."""
    size = np.abs(series)
    # A constant term larger than the sum of all others excludes a root.
    possible = (size[:, 0] <= size[:, 1:].sum(axis=1)) & (size.max(axis=1) > 0.0)
    large = size > NEGLIGIBLE_COEFFICIENT * size.max(axis=1, keepdims=True)
    degree = series.shape[1] - 1 - np.argmax(large[:, ::-1], axis=1)
    found_rows, found_roots = [np.empty(0, dtype=np.int64)], [np.empty(0)]
    for n in range(1, series.shape[1]):
        rows = np.flatnonzero(possible & (degree == n))
        if not len(rows):
            continue
        # The colleague matrix: eigenvalues are the roots of a series in Chebyshev polynomials.
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
        real = (np.abs(values.imag) <= MAX_IMAGINARY_PART) & (np.abs(values.real) <= 1.0 + MAX_IMAGINARY_PART)
        which, _ = np.nonzero(real)
        found_rows.append(rows[which])
        found_roots.append(np.clip(values.real[real], -1.0, 1.0))
    return np.concatenate(found_rows), np.concatenate(found_roots)
