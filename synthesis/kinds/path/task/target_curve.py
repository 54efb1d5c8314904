"""The target curve for shape comparison and fits: equal steps along it, and crank angles at its points."""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicSpline

from kinematics.arrays import Complex, Real
from synthesis.kinds.path.problem import PathProblem

SHAPE_POINT_COUNT = 48
"""Number of points of a shape: descriptors up to the 24th, far more than coupler curves have."""

MIN_DEFINING_POINTS, FILL_WEIGHT = 12, 0.1
"""Minimum number of points that define a curve well, and share of the weight of the lines between fewer points. These
lines count if the curve is to be matched; if the points are to be met, a smooth curve through them is used."""

MIN_POLYLINE_POINTS = 24
"""Number of points from which on their polyline represents the curve between them."""

SMOOTH_POINT_COUNT = 240
"""Number of points of the smooth curve through few points."""


class TargetCurve:
    """The target curve, moved to the origin and scaled to a unit diagonal of the box around it.

    If points have tolerances, their squared distances are weighted by the inverse squares of these, with 1 for the
    smallest.
    """

    def __init__(self, problem: PathProblem) -> None:
        given = np.array([point.point for point in problem.points])
        widths = np.ones(len(given)) if problem.tolerances is None else problem.tolerances
        if problem.closed and len(given) > 3 and given[-1] == given[0]:
            # A closed curve may repeat its first point as the last; it counts once.
            given, widths = given[:-1], widths[:-1]
        self.closed = problem.closed
        self.centre = complex(0.5 * (given.real.min() + given.real.max()), 0.5 * (given.imag.min() + given.imag.max()))
        self.size = math.hypot(float(np.ptp(given.real)), float(np.ptp(given.imag)))
        self.points = (given - self.centre) / self.size
        self.steps, self.places = sample_equal_steps(self.points, self.closed, SHAPE_POINT_COUNT)
        few = len(given) < MIN_DEFINING_POINTS
        self.fitted = np.concatenate([self.points, self.steps]) if few else self.points
        # The fill points together weigh a fixed share of the given points, independently of their number.
        fill = FILL_WEIGHT * len(given) / SHAPE_POINT_COUNT
        self.weights = np.concatenate([(widths.min() / widths) ** 2, np.full(SHAPE_POINT_COUNT if few else 0, fill)])

    def interpolate_angles(self, theta: Real) -> Real:
        """Return crank angles at the points to be fitted, from those at equal steps along the target."""
        at = interpolate_crank_angles(self.places, theta, self.closed, 2.0 * math.pi)
        return np.concatenate([at, theta]) if len(self.fitted) > len(self.points) else at


def sample_equal_steps(points: Complex, closed: bool, count: int) -> tuple[Complex, Real]:
    """Return points at equal distances along a polyline, and the places of its corners as shares of its length.

    A closed polyline does not repeat its first point, in ``points`` or in the result. Its length must not be zero.
    """
    whole = np.concatenate([points, points[:1]]) if closed else points
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(whole)))])
    at = np.linspace(0.0, along[-1], count, endpoint=not closed)
    return np.interp(at, along, whole.real) + 1j * np.interp(at, along, whole.imag), along[: len(points)] / along[-1]


def sample_smooth_steps(points: Complex, closed: bool) -> tuple[Complex, Real]:
    """Return equal steps along a curve through the points, and the points' places on it as shares of its length.

    The curve is a cubic spline over the chords through few points, straight lines between many. Repeated points share
    one place.
    """
    # Dense polylines need no spline, which could overshoot at corners.
    if len(points) >= MIN_DEFINING_POINTS:
        return sample_equal_steps(points, closed, SHAPE_POINT_COUNT)
    whole = np.append(points, points[0]) if closed else points
    chords = np.abs(np.diff(whole))
    corners = np.concatenate([[0.0], np.cumsum(chords)])
    knots, first = np.unique(corners, return_index=True)
    # The knots are included so that the curve passes exactly through the points.
    dense = np.union1d(np.linspace(0.0, corners[-1], SMOOTH_POINT_COUNT), knots)
    spline = CubicSpline(knots, whole[first], bc_type="periodic" if closed else "not-a-knot")
    curve = np.asarray(spline(dense), np.complex128)
    lengths = np.abs(np.diff(curve))
    shares = np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
    steps, _ = sample_equal_steps(curve[:-1] if closed else curve, closed, SHAPE_POINT_COUNT)
    return steps, np.interp(corners[: len(points)], dense, shares)


def interpolate_crank_angles(places: Real, theta: Real, closed: bool, cycle: float) -> Real:
    """Interpolate crank angles at places along the target (shares of its length) from those at its equal steps.

    Around a closed target the crank turns by one cycle (radians), forward or backward as the steps show.
    """
    shares = np.linspace(0.0, 1.0, SHAPE_POINT_COUNT, endpoint=not closed)
    if closed:
        turn = math.copysign(cycle, theta[-1] - theta[0])
        shares, theta = np.append(shares, 1.0), np.append(theta, theta[0] + turn)
    return np.asarray(np.interp(places, shares, theta))
