"""More pairs than proportions and zeros can meet: solve for one or two open scales.

A scale occurs inside cosines, so its equations are not polynomial. For given scales the first six equations leave one
point v of P⁶ (:mod:`synthesis.kinds.function.fourbar.closure`), an analytic function of the scales; the remaining
equations and the cubic must vanish there. For one scale this is a function of one variable over an interval, which is
interpolated by Chebyshev polynomials; their roots are eigenvalues (Boyd, SIAM J. Numer. Anal. 40 (2002) 1666,
doi:10.1137/S0036142901398325). For two scales, sign changes of both conditions on a grid are refined.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from kinematics.arrays import Real
from synthesis.kinds.function.fourbar.closure import Closure
from synthesis.kinds.function.fourbar.precision_points import build_equations, find_null_space

Zeros = tuple[float | None, float | None]

EQUATION_COUNT = 6

CHEBYSHEV_DEGREE, MAX_DEPTH = 32, 10
"""Degree of the interpolation on a piece of the interval, and maximum number of times that a piece is halved."""

SERIES_TOLERANCE, ROUNDING_FACTOR = 1e-9, 4e-15
"""Convergence of the interpolation: tolerance of its last coefficients, relative to the largest; and their rounding
error, to be divided by the independence of the equations."""

MIN_ROOT_SEPARATION = 1e-3
"""Minimum distance of roots from each other and from the real axis, in half-lengths of their piece, to distinguish them
with certainty: the square root of the interpolation's error, with a margin."""

GRID_SIZE = 120
"""Number of logarithmically spaced scales per side if two are open."""

DIFFERENCE_STEP, NEWTON_STEPS, MAX_STEP = 1e-5, 8, 0.05
"""Refinement of two scales: finite-difference step in the logarithm, number of Newton steps, maximum step length."""


class ScaledLinkages(NamedTuple):
    """Linkages with the scales at which they meet all pairs.

    Attributes
    ----------
    dimensions : float, shape (k, 7)
        Five dimensions and both scales.
    degenerate : int
        Number of solutions with a link of zero or infinite length.
    proved : bool
        Whether the set is proved complete for scales between the limits.
    """

    dimensions: Real
    degenerate: int
    proved: bool


class Scaling:
    """Conditions of pairs with open scales.

    Parameters
    ----------
    closure : Closure
        The type of linkage.
    inputs, outputs : float, shape (n,)
        Pairs, to be multiplied by the scales; measured from the value 0 if the side's zero is given, else from the
        first value.
    zeros : pair of float or None
        Given zeros, radians, or in units of the slider's range.
    """

    def __init__(self, closure: Closure, inputs: Real, outputs: Real, zeros: Zeros) -> None:
        self.closure, self.inputs, self.outputs, self.zeros = closure, inputs, outputs, zeros

    def conditions(self, k: Real, scale: Real) -> tuple[Real, Real, Real]:
        """Return the values that must vanish, shape (..., conditions), the point v, and the independence of its
        equations."""
        rows = build_equations(self.closure, k[..., None] * self.inputs, scale[..., None] * self.outputs, self.zeros)
        basis, independent = find_null_space(rows[..., :EQUATION_COUNT, :])
        v = basis[..., 0, :]
        # Choose the sign that makes v the generalized cross product of the rows, which is analytic in the scales.
        whole = np.concatenate([rows[..., :EQUATION_COUNT, :], v[..., None, :]], axis=-2)
        v = v * np.where(np.linalg.det(whole) >= 0.0, 1.0, -1.0)[..., None]
        values = np.einsum("...rj,...j->...r", rows[..., EQUATION_COUNT:, :], v)
        if None in self.zeros:
            values = np.concatenate([values, self.closure.cubic(v)[..., None]], axis=-1)
        return values, v, independent


def solve_one_scale(pairs: Scaling, limits: tuple[float, float], side: int, other: float) -> ScaledLinkages:
    """Find all linkages with the scale of one side open between limits, and the other given.

    Parameters
    ----------
    pairs : Scaling
        One pair more than can be met with given scales.
    limits : pair of float
        Limits of the open scale, both of the same sign.
    side : 0 or 1
        Input or output.
    other : float
        The other side's scale.
    """

    def evaluate_at(x: Real) -> tuple[Real, Real, Real]:
        given = np.full_like(x, other)
        return pairs.conditions(*((x, given) if side == 0 else (given, x)))

    roots, proved = _find_roots(lambda x: (evaluate_at(x)[0][:, 0], evaluate_at(x)[2]), limits)
    if not len(roots):
        return ScaledLinkages(np.empty((0, 7)), 0, proved)
    found = pairs.closure.dimensions(evaluate_at(roots)[1])
    both = (roots, np.full_like(roots, other))
    found = np.column_stack([found, *(both if side == 0 else both[::-1])])
    sound = np.isfinite(found[:, 0])
    return ScaledLinkages(found[sound], int(np.count_nonzero(~sound)), proved)


def _find_roots(function: Callable[[Real], tuple[Real, Real]], limits: tuple[float, float]) -> tuple[Real, bool]:
    """Find all roots in an interval of a function, which also returns the independence of its equations.

    Returns
    -------
    roots : float, shape (k,)
    proved : bool
        Whether every piece is resolved and all roots are clearly separated.
    """
    nodes = chebyshev.chebpts1(CHEBYSHEV_DEGREE + 1)
    transform = 2.0 / len(nodes) * np.cos(np.outer(np.arange(len(nodes)), np.arccos(nodes)))
    transform[0] *= 0.5
    pieces, found, proved = [(*limits, 0)], [], True
    while pieces:
        low, high, depth = pieces.pop()
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        values, independent = function(middle + half * nodes)
        series = transform @ values
        allowed = max(SERIES_TOLERANCE, ROUNDING_FACTOR / max(float(independent.min()), 1e-300))
        resolved = float(np.abs(series[-3:]).max()) <= allowed * float(np.abs(series).max())
        if not resolved and depth < MAX_DEPTH:
            pieces += [(low, middle, depth + 1), (middle, high, depth + 1)]
            continue
        # Drop negligible trailing coefficients: they would put spurious roots near the ends.
        large = np.flatnonzero(np.abs(series) > 0.1 * allowed * np.abs(series).max())
        roots = chebyshev.chebroots(series[: max(int(large[-1]), 1) + 1]) if len(large) else np.empty(0)
        roots = roots[(np.abs(roots.real) <= 1.0 + MIN_ROOT_SEPARATION) & (np.abs(roots.imag) <= MIN_ROOT_SEPARATION)]
        proved &= (
            resolved
            and not np.any(roots.imag != 0.0)
            and bool(np.all(np.diff(np.sort(roots.real)) > MIN_ROOT_SEPARATION))
        )
        found.append(middle + half * np.clip(roots.real, -1.0, 1.0))
    return np.unique(np.concatenate(found)), proved


def solve_two_scales(
    pairs: Scaling, input_limits: tuple[float, float], output_limits: tuple[float, float], extra: Real
) -> Real:
    """Find approximate linkages with both scales open, at which both conditions nearly vanish; shape (k, 7).

    Parameters
    ----------
    pairs : Scaling
        Two pairs more than can be met with given scales.
    input_limits, output_limits : pair of float
        Limits of the scales, both of the same sign.
    extra : float, shape (m, 2)
        Additional scales to try.
    """
    k, scale = (
        math.copysign(1.0, low) * np.geomspace(abs(low), abs(high), GRID_SIZE)
        for low, high in (input_limits, output_limits)
    )
    at = np.stack(np.meshgrid(k, scale, indexing="ij"), axis=-1)
    values, _, _ = pairs.conditions(at[..., 0], at[..., 1])
    positive = values > 0.0
    corners = np.stack([positive[:-1, :-1], positive[1:, :-1], positive[:-1, 1:], positive[1:, 1:]])
    # A cell may contain a solution only if every condition changes its sign among the four corners.
    crossed = np.all(corners.any(axis=0) & ~corners.all(axis=0), axis=-1)
    i, j = np.nonzero(crossed)
    starts = np.sqrt(at[i, j] * at[i + 1, j + 1]) * np.sign(at[i, j])
    both = np.concatenate([_refine_scales(pairs, starts), extra])
    found = np.column_stack([pairs.closure.dimensions(pairs.conditions(both[:, 0], both[:, 1])[1]), both])
    return np.asarray(found[np.isfinite(found).all(axis=1)])


def _refine_scales(pairs: Scaling, scales: Real) -> Real:
    """Refine many pairs of scales by Newton's method in their logarithms, with finite differences; shape (k, 2)."""
    ahead = np.exp(DIFFERENCE_STEP * np.eye(2))
    for _ in range(NEWTON_STEPS):
        moved = [scales * factor for factor in (ahead[0], 1.0 / ahead[0], ahead[1], 1.0 / ahead[1])]
        here = pairs.conditions(scales[:, 0], scales[:, 1])[0]
        there = [pairs.conditions(m[:, 0], m[:, 1])[0] for m in moved]
        jacobian = np.stack([there[0] - there[1], there[2] - there[3]], axis=-1) / (2.0 * DIFFERENCE_STEP)
        step = -np.einsum("kij,kj->ki", np.linalg.pinv(jacobian), here)
        scales = scales * np.exp(np.clip(step, -MAX_STEP, MAX_STEP))
    return scales
