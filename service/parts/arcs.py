"""Chains of arcs and lines through points of a curve, none of which is farther from it than a tolerance."""

from __future__ import annotations

import cmath
import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from service.parts.shapes import arc

Complex = NDArray[np.complex128]

TOLERANCE = 1e-3
"""How far arcs may be from the points of a curve, millimetres."""

STRAIGHT = 1e-9
"""Bulge below which an edge is a line."""


CORNER, SHARPER = 0.12, 3.0
"""A corner turns by more than this, radians, and by so many times more than the curve does before it and after it."""


class Chain:
    """Corners from the first point to the last, and the bulge from each to the next."""

    def __init__(self, corners: list[complex], bulges: list[float]) -> None:
        self.corners, self.bulges = corners, bulges

    def reversed(self) -> Chain:
        """The same from the last corner to the first."""
        return Chain(self.corners[::-1], [-bulge for bulge in self.bulges[::-1]])

    def mirrored(self) -> Chain:
        """Reflected in the real axis."""
        return Chain([z.conjugate() for z in self.corners], [-bulge for bulge in self.bulges])

    def turned(self, turn: complex) -> Chain:
        """Turned about 0."""
        return Chain([turn * z for z in self.corners], self.bulges)

    def then(self, other: Chain) -> Chain:
        """With another that begins where this ends."""
        return Chain([*self.corners[:-1], *other.corners], [*self.bulges, *other.bulges])

    def joined(self, at: int, centre: complex, near: float) -> Chain:
        """With the two edges at a corner made one, where both are arcs about a centre."""
        ends = self.corners[at - 1 : at + 2]
        pair = self.bulges[at - 1 : at + 1]
        if not all(abs(bulge) > STRAIGHT for bulge in pair):
            return self
        if any(abs(arc(*edge, bulge)[0] - centre) > near for edge, bulge in zip(pairwise(ends), pair, strict=True)):
            return self
        whole = math.tan(math.atan(pair[0]) + math.atan(pair[1]))
        return Chain(
            [*self.corners[:at], *self.corners[at + 1 :]], [*self.bulges[: at - 1], whole, *self.bulges[at + 1 :]]
        )


def fitted(points: Complex, tolerance: float = TOLERANCE) -> Chain:
    """The chain of as long arcs as keep to the points; its corners are some of them, those of the curve among them.

    Parameters
    ----------
    points : Complex
        Shape (n,), two at least, near enough to one another that an arc through three of them is the curve.
    """
    corners, bulges, at, last = [complex(points[0])], [], 0, len(points) - 1
    sharp = [*_corners(points), last]
    while at < last:
        stop = min(k for k in sharp if k > at)
        end = at + 1
        # An arc through three points keeps to all of them, even around a corner.
        for far in range(at + 2, stop + 1):
            if _away(points[at : far + 1], _through(points, at, far)) > tolerance:
                break
            end = far
        if end == stop - 1 and end > at + 2:
            # What is left before a corner is to be an arc too, of two steps at least.
            end -= 1
        bulge = _through(points, at, end) if end > at + 1 else 0.0
        corners.append(complex(points[end]))
        bulges.append(bulge)
        at = end
    return Chain(corners, bulges)


def _corners(points: Complex) -> list[int]:
    """Points at which the curve turns sharply."""
    along = np.diff(points)
    turns = np.abs(np.angle(along[1:] / along[:-1]))
    beside = np.pad(turns, 1)
    most = np.maximum(beside[:-2], beside[2:])
    return [int(k) + 1 for k in np.flatnonzero((turns > CORNER) & (turns > SHARPER * most))]


def _through(points: Complex, first: int, last: int) -> float:
    """Bulge of the arc from one point to another through that in the middle."""
    return _bulge(points[first], points[(first + last) // 2], points[last])


def _bulge(start: complex, middle: complex, end: complex) -> float:
    """Of the arc through three points, by the angle under which the ends are seen from the middle."""
    seen = cmath.phase((start - middle) / (end - middle))
    bulge = math.copysign(1.0 / math.tan(0.5 * abs(seen)), seen) if seen else 0.0
    return bulge if abs(bulge) > STRAIGHT else 0.0


def _away(points: Complex, bulge: float) -> float:
    """The greatest distance of points from the arc, or the line, between the first and the last."""
    start, end = complex(points[0]), complex(points[-1])
    if bulge == 0.0:
        return float(np.abs(((points - start) * (end - start).conjugate()).imag).max()) / abs(end - start)
    centre, _ = arc(start, end, bulge)
    return float(np.abs(np.abs(points - centre) - abs(start - centre)).max())
