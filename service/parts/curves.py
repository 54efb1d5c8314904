"""A closed smooth outline through many points: the periodic cubic spline, parameter by parameter the length of chords.

Drawings and solids have the same curve as a B-spline, whose knots and poles :attr:`Curve.spline` has.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, PPoly, make_interp_spline

Complex = NDArray[np.complex128]

STEPS = 4
"""Edges of the polygon that stands for a curve between two of its points."""

GAUSS = ((-(0.6**0.5), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6**0.5, 5.0 / 18.0))
"""Places and weights by which polynomials up to the fifth degree are integrated exactly."""


@dataclass(frozen=True)
class Curve:
    """A closed curve through points, counter-clockwise; the last is not the first again."""

    points: tuple[complex, ...]

    @cached_property
    def spline(self) -> BSpline:
        """The curve by the length of its chords: x and y, cubic, its second derivative continuous all around."""
        places = np.array([*self.points, self.points[0]])
        along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(places)))])
        return make_interp_spline(along, np.column_stack([places.real, places.imag]), k=3, bc_type="periodic")

    @property
    def clamped(self) -> BSpline:
        """The same curve from its first point to its first point, as files have it: its end knots fourfold."""
        ends = self.spline.t[[3, -4]].tolist()
        spline = BSpline(self.spline.t, self.spline.c, 3)
        for end in ends:
            spline = spline.insert_knot(end, 3)
        first, last = np.searchsorted(spline.t, ends[0], "left"), np.searchsorted(spline.t, ends[1], "right")
        return BSpline(spline.t[first:last], spline.c[first : last - 4], 3)

    @cached_property
    def _steps(self) -> NDArray[np.float64]:
        """Parameters of the polygon."""
        knots = self.spline.t[3:-3]
        shares = np.arange(STEPS) / STEPS
        return np.asarray((knots[:-1, None] + np.diff(knots)[:, None] * shares).ravel())

    @property
    def through(self) -> Complex:
        """Points on the curve, :data:`STEPS` for each of those that it was made of."""
        return np.asarray(self.spline(self._steps) @ (1.0, 1j))

    def ring(self, *, beyond: bool) -> Complex:
        """A polygon that lies outside of the curve (``beyond``), or inside of it.

        Its corners are moved along the normals by what the curve rises above a chord at most, h² |r''| / 8.
        """
        at = self._steps
        places, along, bent = (self.spline(at, nu) @ (1.0, 1j) for nu in (0, 1, 2))
        step = np.diff(at, append=self.spline.t[-4])
        rise = (np.maximum(step, np.roll(step, 1)) ** 2 * np.abs(bent)).max() / 8.0
        outward = -1j * along / np.abs(along)
        return np.asarray(places + (rise if beyond else -rise) * outward)

    @property
    def area(self) -> float:
        """½ ∮ x dy − y dx, exact for the spline."""
        knots = self.spline.t[3:-3]
        half, middle = 0.5 * np.diff(knots), 0.5 * (knots[1:] + knots[:-1])
        total = 0.0
        for place, weight in GAUSS:
            x, y = self.spline(middle + place * half).T
            dx, dy = self.spline(middle + place * half, 1).T
            total += weight * float(((x * dy - y * dx) * half).sum())
        return total

    def extent(self, along: complex) -> tuple[float, float]:
        """The least and the greatest place along a direction of length 1."""
        one = BSpline(self.spline.t, self.spline.c @ (along.real, along.imag), 3)
        turning = PPoly.from_spline(one.derivative()).roots(extrapolate=False)
        at = np.concatenate([self.spline.t[3:-3], turning[np.isfinite(turning)]])
        places = one(at)
        return float(places.min()), float(places.max())
