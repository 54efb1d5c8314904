"""The curve that is asked for, as shapes and fits see it: equal steps along it, and crank angles at its points."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from synthesis.kinds.path.problem import PathProblem

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

SHAPE_POINTS = 48
"""Points of a shape: descriptors up to the 24th, far more than coupler curves have."""

FEW_POINTS, FILL = 12, 0.1
"""Fewer points than this say little of a curve. Where it is to be matched the lines between them count too, with this
share of the weight; where its points are to be met a smooth curve is laid through them."""

DENSE = 24
"""Points from which on their polyline tells the curve between them."""

SMOOTH_POINTS = 240
"""Points of that smooth curve."""


class Target:
    """The target, moved to the origin and scaled to a unit diagonal of the box around it.

    Where points have tolerances the squares of their distances weigh as the inverse squares of these, 1 for the least.
    """

    def __init__(self, problem: PathProblem) -> None:
        given = np.array([point.point for point in problem.points])
        widths = np.ones(len(given)) if problem.tolerances is None else problem.tolerances
        if problem.closed and len(given) > 3 and given[-1] == given[0]:
            given, widths = given[:-1], widths[:-1]
        self.closed = problem.closed
        self.centre = complex(0.5 * (given.real.min() + given.real.max()), 0.5 * (given.imag.min() + given.imag.max()))
        self.size = math.hypot(float(np.ptp(given.real)), float(np.ptp(given.imag)))
        self.points = (given - self.centre) / self.size
        self.steps, self.places = equal_steps(self.points, self.closed, SHAPE_POINTS)
        few = len(given) < FEW_POINTS
        self.fitted = np.concatenate([self.points, self.steps]) if few else self.points
        fill = FILL * len(given) / SHAPE_POINTS
        self.weights = np.concatenate([(widths.min() / widths) ** 2, np.full(SHAPE_POINTS if few else 0, fill)])

    def angles(self, theta: Real) -> Real:
        """Crank angles at the points to be fitted, from those at equal steps along the target."""
        at = angles_at(self.places, theta, self.closed, 2.0 * math.pi)
        return np.concatenate([at, theta]) if len(self.fitted) > len(self.points) else at


def equal_steps(points: Complex, closed: bool, count: int) -> tuple[Complex, Real]:
    """Points at equal distances along a polyline, and the places of its corners along it as shares of its length.

    A closed one does not repeat its first point, in ``points`` or in the answer. The length must not be zero.
    """
    whole = np.concatenate([points, points[:1]]) if closed else points
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(whole)))])
    at = np.linspace(0.0, along[-1], count, endpoint=not closed)
    return np.interp(at, along, whole.real) + 1j * np.interp(at, along, whole.imag), along[: len(points)] / along[-1]


def smooth_steps(points: Complex, closed: bool) -> tuple[Complex, Real]:
    """Equal steps along a curve through the points, and the points' places on it as shares of its length.

    The curve is a cubic spline over the chords through few points, straight lines between many. Repeated points have
    one place.
    """
    if len(points) >= FEW_POINTS:
        return equal_steps(points, closed, SHAPE_POINTS)
    whole = np.append(points, points[0]) if closed else points
    chords = np.abs(np.diff(whole))
    corners = np.concatenate([[0.0], np.cumsum(chords)])
    knots, first = np.unique(corners, return_index=True)
    dense = np.union1d(np.linspace(0.0, corners[-1], SMOOTH_POINTS), knots)
    spline = CubicSpline(knots, whole[first], bc_type="periodic" if closed else "not-a-knot")
    curve = np.asarray(spline(dense), np.complex128)
    lengths = np.abs(np.diff(curve))
    shares = np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
    steps, _ = equal_steps(curve[:-1] if closed else curve, closed, SHAPE_POINTS)
    return steps, np.interp(corners[: len(points)], dense, shares)


def angles_at(places: Real, theta: Real, closed: bool, cycle: float) -> Real:
    """Crank angles at places along the target (shares of its length), from those at its equal steps.

    Once round a closed target the crank makes a cycle (radians), onward or backward as the steps tell.
    """
    shares = np.linspace(0.0, 1.0, SHAPE_POINTS, endpoint=not closed)
    if closed:
        turn = math.copysign(cycle, theta[-1] - theta[0])
        shares, theta = np.append(shares, 1.0), np.append(theta, theta[0] + turn)
    return np.asarray(np.interp(places, shares, theta))
