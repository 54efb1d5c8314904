"""A closed smooth outline through many points: the periodic cubic spline, parametrized by chord length.

Drawings and solids use the same curve as a B-spline with the knots and poles of :attr:`Curve.spline`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, PPoly, make_interp_spline

from kinematics.arrays import Complex

STEPS_PER_SPAN = 4
"""Number of polygon edges between two points of a curve."""

GAUSS_RULE = ((-(0.6**0.5), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6**0.5, 5.0 / 18.0))
"""Nodes and weights of three-point Gauss quadrature, exact for polynomials up to degree five."""


@dataclass(frozen=True)
class Curve:
    """A closed curve through points, counter-clockwise; the first point is not repeated."""

    points: tuple[complex, ...]

    @cached_property
    def spline(self) -> BSpline:
        """The curve by chord length: x and y, cubic, with a continuous second derivative all around."""
        places = np.array([*self.points, self.points[0]])
        along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(places)))])
        return make_interp_spline(along, np.column_stack([places.real, places.imag]), k=3, bc_type="periodic")

    @property
    def b_spline(self) -> BSpline:
        """The same curve as files require it, from its first point round to it again, with fourfold end knots."""
        ends = self.spline.t[[3, -4]].tolist()
        spline = BSpline(self.spline.t, self.spline.c, 3)
        # Multiplicity four at the ends clamps the spline, as DXF and STEP require.
        for end in ends:
            spline = spline.insert_knot(end, 3)
        first, last = np.searchsorted(spline.t, ends[0], "left"), np.searchsorted(spline.t, ends[1], "right")
        return BSpline(spline.t[first:last], spline.c[first : last - 4], 3)

    @cached_property
    def _steps(self) -> NDArray[np.float64]:
        """Parameters of the polygon's corners."""
        knots = self.spline.t[3:-3]
        shares = np.arange(STEPS_PER_SPAN) / STEPS_PER_SPAN
        return np.asarray((knots[:-1, None] + np.diff(knots)[:, None] * shares).ravel())

    @property
    def through(self) -> Complex:
        """Points on the curve, :data:`STEPS_PER_SPAN` per given point."""
        return np.asarray(self.spline(self._steps) @ (1.0, 1j))

    def make_polygon(self, *, beyond: bool) -> Complex:
        """Return a polygon outside the curve (``beyond``), or inside it.

        Its corners are moved along the normals by the maximum rise of the curve above a chord, h² |r''| / 8.
        """
        at = self._steps
        places, along, bent = (self.spline(at, nu) @ (1.0, 1j) for nu in (0, 1, 2))
        # The larger of the two neighbouring steps bounds the rise at a corner.
        step = np.diff(at, append=self.spline.t[-4])
        rise = (np.maximum(step, np.roll(step, 1)) ** 2 * np.abs(bent)).max() / 8.0
        outward = -1j * along / np.abs(along)
        return np.asarray(places + (rise if beyond else -rise) * outward)

    @property
    def area(self) -> float:
        """½ ∮ x dy − y dx, exact for the spline."""
        knots = self.spline.t[3:-3]
        # The integrand is a polynomial of degree five between knots.
        half, middle = 0.5 * np.diff(knots), 0.5 * (knots[1:] + knots[:-1])
        total = 0.0
        for place, weight in GAUSS_RULE:
            x, y = self.spline(middle + place * half).T
            dx, dy = self.spline(middle + place * half, 1).T
            total += weight * float(((x * dy - y * dx) * half).sum())
        return total

    def measure_extent(self, along: complex) -> tuple[float, float]:
        """Return the minimum and maximum coordinate along a unit direction."""
        one = BSpline(self.spline.t, self.spline.c @ (along.real, along.imag), 3)
        # Extremes are at roots of the derivative; the knots are added in case a root is missed by rounding.
        turning = PPoly.from_spline(one.derivative()).roots(extrapolate=False)
        at = np.concatenate([self.spline.t[3:-3], turning[np.isfinite(turning)]])
        places = one(at)
        return float(places.min()), float(places.max())
