"""Chains of arcs and lines through points of a curve, none of which is farther from it than a tolerance."""

from __future__ import annotations

import cmath
import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from service.parts.shapes import arc

Complex = NDArray[np.complex128]

TOLERANCE = 1e-4
"""How far arcs may be from the points of a curve, millimetres."""

STRAIGHT = 1e-9
"""Bulge below which an edge is a line."""


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
    """The chain of as long arcs as keep to the points; its corners are some of them.

    Parameters
    ----------
    points : Complex
        Shape (n,), two at least, near enough to one another that an arc through three of them is the curve.
    """
    corners, bulges, at, last = [complex(points[0])], [], 0, len(points) - 1
    while at < last:
        end, bulge = at + 1, 0.0
        for far in range(at + 2, last + 1):
            tried = _bulge(points[at], points[(at + far) // 2], points[far])
            if _away(points[at : far + 1], tried) > tolerance:
                break
            end, bulge = far, tried
        corners.append(complex(points[end]))
        bulges.append(bulge)
        at = end
    return Chain(corners, bulges)


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
