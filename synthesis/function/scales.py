"""More pairs than proportions and zeros can meet: one or two scales are open.

A scale stands inside of cosines, so that its equations are no polynomials. For given scales the first six equations
leave one point v of P⁶ (:mod:`synthesis.function.closure`), an analytic function of the scales; what is left of the
equations, and the cubic, must vanish there. For one scale this is a function of one number over an interval: it is
interpolated by Chebyshev polynomials, whose roots are eigenvalues (Boyd, SIAM J. Numer. Anal. 40 (2002) 1666,
doi:10.1137/S0036142901398325). For two scales the sign changes of both conditions on a grid are refined.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from synthesis.function.closure import Closure
from synthesis.function.precision import equations, left_over

Real = NDArray[np.float64]
Zeros = tuple[float | None, float | None]

SIX = 6

DEGREES = 64, 128, 256
"""Degrees of the interpolation, one after another until it is good enough."""

RESOLVED = 1e-11
"""Last coefficients of the interpolation, relative to the largest, at which it has converged."""

NEARLY_REAL = 1e-6
"""Distance from the interval, as a share of it, at which a root is still looked at."""

CLEAR = 1e-6
"""Roots nearer to each other than this share of the interval are not told apart with certainty."""

GRID = 120
"""Scales a side, logarithmically spaced, where two are open."""


class Scaled(NamedTuple):
    """Linkages with the scales at which they meet all pairs.

    Attributes
    ----------
    dimensions : float, shape (k, 7)
        Five dimensions and both scales.
    degenerate : int
        Solutions with a link of no or of infinite length.
    proved : bool
        There are no others with scales between the limits.
    """

    dimensions: Real
    degenerate: int
    proved: bool


class Scaling:
    """Pairs whose scales are open.

    Parameters
    ----------
    closure : Closure
        The type of linkage.
    inputs, outputs : float, shape (n,)
        Pairs, to be multiplied by the scales; of a side with a given zero from the value 0, else from the first.
    zeros : pair of float or None
        Given zeros, radians, or in units of the slider's range.
    """

    def __init__(self, closure: Closure, inputs: Real, outputs: Real, zeros: Zeros) -> None:
        self.closure, self.inputs, self.outputs, self.zeros = closure, inputs, outputs, zeros

    def conditions(self, k: Real, scale: Real) -> tuple[Real, Real, Real]:
        """What must vanish, shape (..., conditions); the point v; how well it is determined."""
        rows = equations(self.closure, k[..., None] * self.inputs, scale[..., None] * self.outputs, self.zeros)
        basis, independent = left_over(rows[..., :SIX, :])
        v = basis[..., 0, :]
        # The sign of v that makes it the generalized cross product of the rows, which is analytic.
        whole = np.concatenate([rows[..., :SIX, :], v[..., None, :]], axis=-2)
        v = v * np.where(np.linalg.det(whole) >= 0.0, 1.0, -1.0)[..., None]
        values = np.einsum("...rj,...j->...r", rows[..., SIX:, :], v)
        if None in self.zeros:
            values = np.concatenate([values, self.closure.cubic(v)[..., None]], axis=-1)
        return values, v, independent


def one_scale(pairs: Scaling, limits: tuple[float, float], side: int, other: float) -> Scaled:
    """All linkages with the scale of one side open between limits, the other's given.

    Parameters
    ----------
    pairs : Scaling
        One pair more than is met with all scales given.
    limits : pair of float
        Of the open scale, both of one sign.
    side : 0 or 1
        Input or output.
    other : float
        The other side's scale.
    """
    low, high = limits

    def at(x: Real) -> tuple[Real, Real, Real]:
        open_, given = x, np.full_like(x, other)
        return pairs.conditions(*((open_, given) if side == 0 else (given, open_)))

    resolved = False
    series: Real = np.zeros(1)
    for degree in DEGREES:
        nodes = chebyshev.chebpts1(degree + 1)
        values = at(0.5 * (low + high) + 0.5 * (high - low) * nodes)[0][:, 0]
        series = _fitted(nodes, values)
        tail = float(np.abs(series[-4:]).max())
        resolved = tail <= RESOLVED * float(np.abs(series).max())
        if resolved:
            break
    roots = chebyshev.chebroots(series[: _last(series) + 1])
    near = (np.abs(roots.imag) <= NEARLY_REAL) & (np.abs(roots.real) <= 1.0 + NEARLY_REAL)
    x = np.unique(np.clip(roots.real[near], -1.0, 1.0))
    apart = bool(np.all(np.diff(x) > CLEAR)) and not np.any(near & (roots.imag != 0.0))
    scales = 0.5 * (low + high) + 0.5 * (high - low) * x
    if not len(scales):
        return Scaled(np.empty((0, 7)), 0, resolved)
    _, v, independent = at(scales)
    found = pairs.closure.dimensions(v)
    both = (scales, np.full_like(scales, other))
    columns = both if side == 0 else both[::-1]
    found = np.column_stack([found, *columns])
    sound = np.isfinite(found[:, 0])
    proved = resolved and apart and bool(np.all(independent > 1e-11))
    return Scaled(found[sound], int(np.count_nonzero(~sound)), proved)


def _fitted(nodes: Real, values: Real) -> Real:
    """Chebyshev coefficients of the interpolation at the nodes of the first kind, by their orthogonality."""
    n = len(nodes)
    series = 2.0 / n * np.cos(np.outer(np.arange(n), np.arccos(nodes))) @ values
    series[0] *= 0.5
    return np.asarray(series)


def _last(series: Real) -> int:
    """The last coefficient above rounding."""
    large = np.flatnonzero(np.abs(series) > 1e-15 * np.abs(series).max())
    return max(int(large[-1]) if len(large) else 0, 1)


def two_scales(
    pairs: Scaling, input_limits: tuple[float, float], output_limits: tuple[float, float], extra: Real
) -> Real:
    """Linkages near which both conditions vanish, with both scales open: to be refined; shape (k, 7).

    Parameters
    ----------
    pairs : Scaling
        Two pairs more than are met with all scales given.
    input_limits, output_limits : pair of float
        Of the scales; both of one sign.
    extra : float, shape (m, 2)
        Scales that are looked at too.
    """
    k, scale = (
        math.copysign(1.0, low) * np.geomspace(abs(low), abs(high), GRID) for low, high in (input_limits, output_limits)
    )
    at = np.stack(np.meshgrid(k, scale, indexing="ij"), axis=-1)
    values, v, _ = pairs.conditions(at[..., 0], at[..., 1])
    positive = values > 0.0
    corners = np.stack([positive[:-1, :-1], positive[1:, :-1], positive[:-1, 1:], positive[1:, 1:]])
    crossed = np.all(corners.any(axis=0) & ~corners.all(axis=0), axis=-1)
    i, j = np.nonzero(crossed)
    found = [np.column_stack([pairs.closure.dimensions(v[i, j]), at[i, j]])]
    if len(extra):
        found.append(np.column_stack([pairs.closure.dimensions(pairs.conditions(extra[:, 0], extra[:, 1])[1]), extra]))
    both = np.concatenate(found)
    return np.asarray(both[np.isfinite(both[:, 0])])
