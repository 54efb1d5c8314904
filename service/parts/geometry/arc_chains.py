"""Chains of arcs and lines through points of a curve that stay within a tolerance of it."""

from __future__ import annotations

import cmath
import math
from itertools import pairwise

import numpy as np

from kinematics.arrays import Complex
from service.parts.geometry.regions import find_arc

ARC_TOLERANCE = 1e-3
"""Maximum distance of arcs from the points of a curve, millimetres."""

STRAIGHT_BULGE = 1e-9
"""Bulge below which an edge is a line."""


MIN_CORNER_ANGLE, MIN_CORNER_RATIO = 0.12, 3.0
"""Minimum angle of a corner, radians, and minimum ratio of it to the angles of the neighbouring points."""


class ArcChain:
    """A chain of arcs and lines: its corners from the first to the last, and the bulge from each to the next."""

    def __init__(self, corners: list[complex], bulges: list[float]) -> None:
        self.corners, self.bulges = corners, bulges

    def reverse(self) -> ArcChain:
        """Return the chain in opposite order."""
        return ArcChain(self.corners[::-1], [-bulge for bulge in self.bulges[::-1]])

    def mirror(self) -> ArcChain:
        """Reflect the chain in the real axis."""
        return ArcChain([z.conjugate() for z in self.corners], [-bulge for bulge in self.bulges])

    def rotate(self, turn: complex) -> ArcChain:
        """Rotate the chain about 0."""
        return ArcChain([turn * z for z in self.corners], self.bulges)

    def append(self, other: ArcChain) -> ArcChain:
        """Append another chain that begins at the end of this one."""
        return ArcChain([*self.corners[:-1], *other.corners], [*self.bulges, *other.bulges])

    def merge_edges(self, at: int, centre: complex, near: float) -> ArcChain:
        """Merge the two edges at a corner if both are arcs about the given centre."""
        ends = self.corners[at - 1 : at + 2]
        pair = self.bulges[at - 1 : at + 1]
        # Lines have no centre.
        if not all(abs(bulge) > STRAIGHT_BULGE for bulge in pair):
            return self
        if any(
            abs(find_arc(*edge, bulge)[0] - centre) > near for edge, bulge in zip(pairwise(ends), pair, strict=True)
        ):
            return self
        # Bulges are tangents of quarter angles, so the angles add.
        whole = math.tan(math.atan(pair[0]) + math.atan(pair[1]))
        return ArcChain(
            [*self.corners[:at], *self.corners[at + 1 :]], [*self.bulges[: at - 1], whole, *self.bulges[at + 1 :]]
        )


def fit_chain(points: Complex, tolerance: float = ARC_TOLERANCE) -> ArcChain:
    """Fit a chain of arcs that are as long as the tolerance permits.

    The corners of the chain are some of the given points, and include the corners of the curve.

    Parameters
    ----------
    points : Complex
        Shape (n,), at least two, so dense that an arc through three of them matches the curve.
    """
    corners, bulges, at, last = [complex(points[0])], [], 0, len(points) - 1
    sharp = [*_find_corners(points), last]
    while at < last:
        stop = min(k for k in sharp if k > at)
        end = at + 1
        # Stop at the next corner: an arc through three points would pass them all, even around a corner.
        for far in range(at + 2, stop + 1):
            if _measure_deviation(points[at : far + 1], _find_bulge(points, at, far)) > tolerance:
                break
            end = far
        if end == stop - 1 and end > at + 2:
            # Leave at least two steps before a corner, so that the rest can be an arc, too.
            end -= 1
        bulge = _find_bulge(points, at, end) if end > at + 1 else 0.0
        corners.append(complex(points[end]))
        bulges.append(bulge)
        at = end
    return ArcChain(corners, bulges)


def _find_corners(points: Complex) -> list[int]:
    """Return the points at which the curve turns sharply."""
    along = np.diff(points)
    turns = np.abs(np.angle(along[1:] / along[:-1]))
    beside = np.pad(turns, 1)
    # Compare with both neighbours: a dense curve turns steadily.
    most = np.maximum(beside[:-2], beside[2:])
    return [int(k) + 1 for k in np.flatnonzero((turns > MIN_CORNER_ANGLE) & (turns > MIN_CORNER_RATIO * most))]


def _find_bulge(points: Complex, first: int, last: int) -> float:
    """Return the bulge of the arc from one point to another through the one in the middle."""
    return _compute_bulge(points[first], points[(first + last) // 2], points[last])


def _compute_bulge(start: complex, middle: complex, end: complex) -> float:
    """Return the bulge of the arc through three points, from the angle between the ends as seen from the middle."""
    seen = cmath.phase((start - middle) / (end - middle))
    # Inscribed angle theorem.
    bulge = math.copysign(1.0 / math.tan(0.5 * abs(seen)), seen) if seen else 0.0
    return bulge if abs(bulge) > STRAIGHT_BULGE else 0.0


def _measure_deviation(points: Complex, bulge: float) -> float:
    """Return the maximum distance of points from the arc, or the line, between the first and the last."""
    start, end = complex(points[0]), complex(points[-1])
    if bulge == 0.0:
        return float(np.abs(((points - start) * (end - start).conjugate()).imag).max()) / abs(end - start)
    centre, _ = find_arc(start, end, bulge)
    return float(np.abs(np.abs(points - centre) - abs(start - centre)).max())
