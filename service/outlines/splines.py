"""Conversion of B-splines, including rational ones, to cubic Béziers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from kinematics.arrays import Complex
from service.outlines.faults import Obstacle

MAX_DEGREE = 15
"""Highest degree that is read; drawings use 3, seldom 5."""

MAX_CUBICS = 64
"""Maximum number of cubics for one knot span."""

SPLINE_TOLERANCE = 1e-6
"""Largest deviation of the cubics from the spline as a share of its extent; far below any flattening tolerance."""


def convert_spline(degree: int, knots: Sequence[float], points: Complex, weights: Sequence[float]) -> Complex:
    """Convert a B-spline to cubics that have its points and tangents at their ends, shape (n, 4).

    The number of cubics per knot span is doubled until their midpoints lie within :data:`SPLINE_TOLERANCE` of the
    spline. Non-rational splines of degree three are converted exactly.

    Parameters
    ----------
    points : complex, shape (m,)
        Control points.
    knots : sequence of m + degree + 1 floats
    weights : sequence of m floats
        All ones if the spline is not rational.

    Raises
    ------
    ValueError
        If the numbers do not define a spline, or if the spline needs more than :data:`MAX_CUBICS` cubics per span.
    """
    t, w = np.array(knots, float), np.array(weights, float)
    if not 1 <= degree <= MAX_DEGREE or len(points) <= degree or len(t) != len(points) + degree + 1:
        raise Obstacle("outlines-spline-knots-or-degree")
    if not (np.isfinite(t).all() and np.isfinite(w).all() and np.all(np.diff(t) >= 0.0) and w.min() > 0.0):
        raise Obstacle("outlines-spline-knots-not-ascending")
    curve = BSpline(t, np.stack([w * points.real, w * points.imag, w], axis=1), degree)
    slope = curve.derivative()
    inner = t[degree : len(points) + 1]
    spans = np.unique(inner)
    if len(spans) < 2:
        raise Obstacle("outlines-spline-knots-span-nothing")
    extent = float(np.abs(points - points[0]).max())
    count = 1
    while count <= MAX_CUBICS:
        ends = np.unique(spans[:-1, None] + np.diff(spans)[:, None] * np.linspace(0.0, 1.0, count + 1))
        low, high = ends[:-1], ends[1:]
        # At a knot the tangent may jump: evaluate it slightly inside the span.
        inside = 1e-9 * (high - low)
        start, end = _evaluate(curve, low), _evaluate(curve, high)
        first = _evaluate_slope(curve, slope, low + inside) * (high - low) / 3.0
        last = _evaluate_slope(curve, slope, high - inside) * (high - low) / 3.0
        found = np.stack([start, start + first, end - last, end], axis=1)
        middle = found @ np.array([1.0, 3.0, 3.0, 1.0]) / 8.0
        if np.abs(middle - _evaluate(curve, 0.5 * (low + high))).max() <= SPLINE_TOLERANCE * extent:
            return np.asarray(found)
        # Not accurate enough: double the cubics in every span.
        count *= 2
    raise Obstacle("outlines-bend-too-sharp")


def _evaluate(curve: BSpline, t: NDArray[np.float64]) -> Complex:
    x, y, w = curve(t).T
    return np.asarray((x + 1j * y) / w)


def _evaluate_slope(curve: BSpline, slope: BSpline, t: NDArray[np.float64]) -> Complex:
    _, _, w = curve(t).T
    dx, dy, dw = slope(t).T
    return np.asarray((dx + 1j * dy - dw * _evaluate(curve, t)) / w)
