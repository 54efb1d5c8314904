"""Curves of a drawing as cubic Béziers, and the polygons that approximate them.

A point is a complex number x + iy. A line is the cubic whose control points divide it into three equal parts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex
from service.outlines.limits import MAX_COORDINATE

STRAIGHTNESS_TOLERANCE = 1e-12
"""Maximum deviation of a cubic's control points from those of a line, as a share of its length, for which the cubic
counts as a line. Transforms cause rounding errors of this order.
"""


@dataclass(frozen=True)
class Source:
    """The element that a curve comes from."""

    element: str
    id: str | None = None
    name: str | None = None
    layer: str | None = None


@dataclass(frozen=True)
class Circle:
    """A full circle."""

    centre: complex
    radius: float


@dataclass(frozen=True)
class Curve:
    """A connected curve.

    ``pieces`` are its consecutive cubics, shape (n, 4); empty for a circle.
    """

    source: Source
    pieces: Complex
    closed: bool
    circle: Circle | None = None

    @property
    def start(self) -> complex:
        """First point of the curve."""
        return complex(self.pieces[0, 0])

    @property
    def end(self) -> complex:
        """Last point of the curve."""
        return complex(self.pieces[-1, 3])

    @property
    def finite(self) -> bool:
        """Whether every coordinate is a finite number of at most ``MAX_COORDINATE`` in magnitude."""
        if self.circle is not None:
            return abs(self.circle.centre) + self.circle.radius <= MAX_COORDINATE
        return bool(np.all(np.abs(self.pieces) <= MAX_COORDINATE))

    @property
    def corners(self) -> tuple[complex, complex]:
        """Lower left and upper right corner of a box that contains the curve."""
        if self.circle is not None:
            reach = complex(self.circle.radius, self.circle.radius)
            return self.circle.centre - reach, self.circle.centre + reach
        x, y = self.pieces.real, self.pieces.imag
        return complex(x.min(), y.min()), complex(x.max(), y.max())

    def scale_by(self, factor: float) -> Curve:
        """Return the curve scaled by a factor, for a change of unit."""
        circle = self.circle and Circle(self.circle.centre * factor, self.circle.radius * factor)
        return replace(self, pieces=self.pieces * factor, circle=circle)


def reverse_curve(curve: Curve) -> Curve:
    """Return the curve traversed in the opposite direction."""
    return replace(curve, pieces=np.ascontiguousarray(curve.pieces[::-1, ::-1]))


NO_PIECES: Complex = np.empty((0, 4), np.complex128)


def make_bezier(start: complex, first: complex, second: complex, end: complex) -> Complex:
    """Build a cubic from its four control points, shape (1, 4)."""
    return np.array([[start, first, second, end]])


def make_line(start: complex, end: complex) -> Complex:
    """Build a line as a cubic, shape (1, 4)."""
    return make_bezier(start, start + (end - start) / 3.0, end + (start - end) / 3.0, end)


def make_quadratic(start: complex, control: complex, end: complex) -> Complex:
    """Build a quadratic Bézier as a cubic (degree elevation), shape (1, 4)."""
    return make_bezier(start, start + 2.0 / 3.0 * (control - start), end + 2.0 / 3.0 * (control - end), end)


def make_polyline(points: Complex) -> Complex:
    """Build lines through consecutive points as cubics, shape (n - 1, 4)."""
    start, end = points[:-1], points[1:]
    return np.stack([start, start + (end - start) / 3.0, end + (start - end) / 3.0, end], axis=1)


def count_chords(pieces: Complex, tolerance: float) -> NDArray[np.int64]:
    """Return the number of chords that each cubic needs to stay within the tolerance, shape (n,).

    The distance of a cubic from a chord over 1/n of its parameter is at most M/(8n²), where M = 6 max|Δ²| bounds its
    second derivative by the second differences of its control points; Wang, Journal of Shanghai Jiaotong University
    3 (1984).
    """
    bends = np.abs(pieces[:, :-2] - 2.0 * pieces[:, 1:-1] + pieces[:, 2:]).max(axis=1)
    length = np.abs(np.diff(pieces, axis=1)).sum(axis=1)
    # Rounded transforms leave tiny second differences on straight lines; one chord is enough there.
    bends = np.where(bends <= STRAIGHTNESS_TOLERANCE * length, 0.0, bends)
    counts = np.sqrt(6.0 * bends / (8.0 * tolerance))
    # The cap keeps absurd coordinates from overflowing the integer type.
    return np.maximum(np.ceil(np.minimum(counts, 1e9)), 1.0).astype(np.int64)


def flatten_pieces(pieces: Complex, tolerance: float) -> Complex:
    """Sample points along a curve, both ends included, so that the chords stay within the tolerance; shape (m,)."""
    counts = count_chords(pieces, tolerance)
    owner = np.repeat(np.arange(len(pieces)), counts)
    t = (np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[owner]
    p0, p1, p2, p3 = pieces[owner].T
    s = 1.0 - t
    points = s**3 * p0 + 3.0 * s**2 * t * p1 + 3.0 * s * t**2 * p2 + t**3 * p3
    return np.append(points, pieces[-1, 3])
