"""Regions of the plane: outlines of straight lines and arcs, or of a smooth curve, with holes.

An outline is a :class:`Disc`, or a :class:`Loop`: corners counter-clockwise, joined by lines or arcs. The *bulge* of an
arc is the tangent of a quarter of its angle (as in DXF), positive for a turn to the left. Or it is a
:class:`~service.parts.geometry.splines.Curve`.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex
from service.parts.geometry.splines import Curve

SEGMENTS_PER_TURN = 96
"""Number of edges of the polygon that approximates a full circle."""


class Disc(NamedTuple):
    """A circle, filled."""

    centre: complex
    radius: float


class Loop(NamedTuple):
    """A closed outline: corners counter-clockwise, and the bulge of the edge from each to the next."""

    corners: tuple[complex, ...]
    bulges: tuple[float, ...]

    def iterate_edges(self) -> Iterator[tuple[complex, complex, float]]:
        """Yield start, end and bulge of each edge."""
        yield from zip(self.corners, (*self.corners[1:], self.corners[0]), self.bulges, strict=True)


Outline = Disc | Loop | Curve


class Region(NamedTuple):
    """An outline with holes."""

    outer: Outline
    holes: tuple[Outline, ...] = ()


def move_outline(outline: Outline, turn: complex, shift: complex = 0j) -> Outline:
    """Rotate and scale an outline about 0 by a complex number, then shift it."""
    if isinstance(outline, Disc):
        return Disc(turn * outline.centre + shift, abs(turn) * outline.radius)
    if isinstance(outline, Curve):
        return Curve(tuple(turn * z + shift for z in outline.points))
    return Loop(tuple(turn * z + shift for z in outline.corners), outline.bulges)


def make_ring(centre: complex, outer: float, inner: float = 0.0) -> Region:
    """Return a ring by its radii, or a disc if the inner radius is 0."""
    return Region(Disc(centre, outer), (Disc(centre, inner),) if inner > 0.0 else ())


def widen_hull(points: Sequence[complex], radius: float) -> Outline:
    """Return the convex hull of circles of one radius about points.

    Examples
    --------
    A bar with round ends:

    >>> widen_hull([0j, 10 + 0j], 2.0)
    Loop(corners=(-2j, (10-2j), (10+2j), 2j), bulges=(0.0, 1.0, 0.0, 1.0))
    """
    around = find_hull(points)
    if len(around) == 1:
        return Disc(around[0], radius)
    corners: list[complex] = []
    bulges: list[float] = []
    count = len(around)
    outward = [
        -1j * (around[(k + 1) % count] - around[k]) / abs(around[(k + 1) % count] - around[k]) for k in range(count)
    ]
    for k in range(count):
        ahead = (k + 1) % count
        # The normals of a convex polygon turn counter-clockwise by less than π.
        turn = cmath.phase(outward[ahead] / outward[k]) % (2.0 * math.pi)
        corners += [around[k] + radius * outward[k], around[ahead] + radius * outward[k]]
        bulges += [0.0, math.tan(0.25 * turn)]
    return Loop(tuple(corners), tuple(bulges))


def find_hull(points: Sequence[complex]) -> list[complex]:
    """Return the corners of the convex hull, counter-clockwise: two for collinear points, one for coincident points."""
    size = max(abs(z - points[0]) for z in points)
    kept: list[complex] = []
    for z in points:
        # Coincident points would make zero-length edges.
        if all(abs(z - w) > 1e-9 * size for w in kept):
            kept.append(z)
    if len(kept) < 2:
        return kept[:1]
    # Gift wrapping from the lowest point: each next corner has all others at its left; of collinear ones the farthest.
    at = start = min(kept, key=lambda z: (z.imag, z.real))
    found = []
    while True:
        found.append(at)
        ahead = next(z for z in kept if z != at)
        for z in kept:
            if z == at:
                continue
            side = ((ahead - at).conjugate() * (z - at)).imag / abs(ahead - at)
            if side < -1e-9 * size or (side <= 1e-9 * size and abs(z - at) > abs(ahead - at)):
                ahead = z
        at = ahead
        if at == start or len(found) > len(kept):
            return found


def make_polygon(outline: Outline, *, beyond: bool, sag: float = math.inf) -> Complex:
    """Approximate an outline by a polygon whose arcs are all circumscribed (``beyond``), or all inscribed.

    Parameters
    ----------
    sag : float
        Maximum distance of the polygon from arcs; a full circle has at least :data:`SEGMENTS_PER_TURN` edges.
    """
    if isinstance(outline, Curve):
        return outline.make_polygon(beyond=beyond)
    if isinstance(outline, Disc):
        edges = count_edges(outline.radius, sag)
        # Circumscribed polygons have their corners outside by 1/cos of half the step.
        half = math.pi / edges
        radius = outline.radius / math.cos(half) if beyond else outline.radius
        turns = np.exp(2j * half * np.arange(edges))
        return np.asarray(outline.centre + radius * turns)
    pieces: list[complex] = []
    for start, end, bulge in outline.iterate_edges():
        pieces.append(start)
        if bulge == 0.0:
            continue
        centre, angle = find_arc(start, end, bulge)
        count = max(2, math.ceil(abs(angle) / (2.0 * math.pi) * count_edges(abs(start - centre), sag)))
        # Tangents at the middle of each step lie outside the arc's circle, chords inside. The enclosed area is inside
        # the circle if the arc turns to the left.
        tangent = beyond == (bulge > 0.0)
        grown = 1.0 / math.cos(0.5 * angle / count) if tangent else 1.0
        shares = (np.arange(count) + 0.5) if tangent else np.arange(1, count)
        turned = (start - centre) * np.exp(1j * angle / count * shares)
        pieces += (centre + grown * turned).tolist()
    return np.array(pieces)


def count_edges(radius: float, sag: float) -> int:
    """Return the number of edges of a polygon that approximates a circle within a sag."""
    return max(SEGMENTS_PER_TURN, math.ceil(math.pi / math.sqrt(2.0 * sag / radius)))


def find_arc(start: complex, end: complex, bulge: float) -> tuple[complex, float]:
    """Return centre and signed angle of an arc."""
    angle = 4.0 * math.atan(bulge)
    centre = 0.5 * (start + end) + 1j * (end - start) * (1.0 - bulge**2) / (4.0 * bulge)
    return centre, angle


def find_arc_middle(start: complex, end: complex, bulge: float) -> complex:
    """Return the midpoint of an arc."""
    return 0.5 * (start + end) - 0.5j * bulge * (end - start)


def measure_extent(outline: Outline, along: complex) -> tuple[float, float]:
    """Return the minimum and maximum coordinate of an outline along a unit direction."""
    if isinstance(outline, Curve):
        return outline.measure_extent(along)
    if isinstance(outline, Disc):
        at = (outline.centre * along.conjugate()).real
        return at - outline.radius, at + outline.radius
    places: list[float] = []
    for start, end, bulge in outline.iterate_edges():
        places.append((start * along.conjugate()).real)
        if bulge:
            centre, angle = find_arc(start, end, bulge)
            radius, first = abs(start - centre), cmath.phase((start - centre) / along)
            # An arc spans at most a full turn either way, so these multiples of π cover it.
            for k in range(-4, 5):
                # Points of the arc with extreme coordinates along the direction.
                if min(first, first + angle) <= k * math.pi <= max(first, first + angle):
                    places.append((centre * along.conjugate()).real + radius * (-1.0) ** k)
    return min(places), max(places)


def measure_area(outline: Outline) -> float:
    """Return the area enclosed by an outline."""
    if isinstance(outline, Curve):
        return outline.area
    if isinstance(outline, Disc):
        return math.pi * outline.radius**2
    total = 0.0
    for start, end, bulge in outline.iterate_edges():
        # Shoelace formula for the chords, plus the segments between chord and arc.
        total += 0.5 * (start.conjugate() * end).imag
        if bulge:
            centre, angle = find_arc(start, end, bulge)
            total += 0.5 * abs(start - centre) ** 2 * (angle - math.sin(angle))
    return total
