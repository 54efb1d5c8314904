"""Regions of the plane: outlines of straight lines and arcs, or of a smooth curve, with holes.

An outline is a :class:`Disc`, or a :class:`Loop`: corners counter-clockwise, from each to the next a line, or an arc of
which the *bulge* is the tangent of a quarter of its angle (as DXF has it), positive where it turns to the left; or a
:class:`~service.parts.curves.Curve`.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from service.parts.curves import Curve

Complex = NDArray[np.complex128]

SEGMENTS = 96
"""Edges of the polygon that stands for a whole circle."""


class Disc(NamedTuple):
    """A circle and what it encloses."""

    centre: complex
    radius: float


class Loop(NamedTuple):
    """A closed outline: corners counter-clockwise, and the bulge of the edge from each to the next."""

    corners: tuple[complex, ...]
    bulges: tuple[float, ...]

    def edges(self) -> Iterator[tuple[complex, complex, float]]:
        """Start, end and bulge of each edge."""
        yield from zip(self.corners, (*self.corners[1:], self.corners[0]), self.bulges, strict=True)


Outline = Disc | Loop | Curve


class Region(NamedTuple):
    """An outline and the holes in it."""

    outer: Outline
    holes: tuple[Outline, ...] = ()


def turned(outline: Outline, turn: complex, about: complex) -> Outline:
    """An outline turned about a point by a direction of length 1."""
    if isinstance(outline, Disc):
        return Disc(about + turn * (outline.centre - about), outline.radius)
    if isinstance(outline, Curve):
        return Curve(tuple(about + turn * (z - about) for z in outline.points))
    return Loop(tuple(about + turn * (z - about) for z in outline.corners), outline.bulges)


def larger(outline: Outline, scale: float, about: complex) -> Outline:
    """An outline made larger about a point."""
    if isinstance(outline, Disc):
        return Disc(about + scale * (outline.centre - about), scale * outline.radius)
    if isinstance(outline, Curve):
        return Curve(tuple(about + scale * (z - about) for z in outline.points))
    return Loop(tuple(about + scale * (z - about) for z in outline.corners), outline.bulges)


def ring(centre: complex, outer: float, inner: float = 0.0) -> Region:
    """A ring, or a disc without a hole, by its radii."""
    return Region(Disc(centre, outer), (Disc(centre, inner),) if inner > 0.0 else ())


def widened(points: Sequence[complex], radius: float) -> Outline:
    """The convex hull of circles of one radius about points.

    Examples
    --------
    A bar with round ends:

    >>> widened([0j, 10 + 0j], 2.0)
    Loop(corners=(-2j, (10-2j), (10+2j), 2j), bulges=(0.0, 1.0, 0.0, 1.0))
    """
    around = hull(points)
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
        turn = cmath.phase(outward[ahead] / outward[k]) % (2.0 * math.pi)
        corners += [around[k] + radius * outward[k], around[ahead] + radius * outward[k]]
        bulges += [0.0, math.tan(0.25 * turn)]
    return Loop(tuple(corners), tuple(bulges))


def hull(points: Sequence[complex]) -> list[complex]:
    """Corners of the convex hull, counter-clockwise: two of points on a line, and one of points in one place."""
    size = max(abs(z - points[0]) for z in points)
    kept: list[complex] = []
    for z in points:
        if all(abs(z - w) > 1e-9 * size for w in kept):
            kept.append(z)
    if len(kept) < 2:
        return kept[:1]
    # Gift wrapping from the lowest: each next corner has all others at its left; of those on one line the farthest.
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


def ring_of(outline: Outline, *, beyond: bool, sag: float = math.inf) -> Complex:
    """An outline as a polygon, whose arcs lie all outside of the true ones (``beyond``), or all inside.

    Parameters
    ----------
    sag : float
        How far the polygon may be from arcs; :data:`SEGMENTS` edges stand for a whole circle at least.
    """
    if isinstance(outline, Curve):
        return outline.ring(beyond=beyond)
    if isinstance(outline, Disc):
        edges = _edges(outline.radius, sag)
        half = math.pi / edges
        radius = outline.radius / math.cos(half) if beyond else outline.radius
        turns = np.exp(2j * half * np.arange(edges))
        return np.asarray(outline.centre + radius * turns)
    pieces: list[complex] = []
    for start, end, bulge in outline.edges():
        pieces.append(start)
        if bulge == 0.0:
            continue
        centre, angle = arc(start, end, bulge)
        count = max(2, math.ceil(abs(angle) / (2.0 * math.pi) * _edges(abs(start - centre), sag)))
        # Tangents from the middle of each step lie outside of the arc's circle, and its chords inside. What is enclosed
        # is inside where the arc turns to the left.
        tangent = beyond == (bulge > 0.0)
        grown = 1.0 / math.cos(0.5 * angle / count) if tangent else 1.0
        shares = (np.arange(count) + 0.5) if tangent else np.arange(1, count)
        turned = (start - centre) * np.exp(1j * angle / count * shares)
        pieces += (centre + grown * turned).tolist()
    return np.array(pieces)


def _edges(radius: float, sag: float) -> int:
    """Of a polygon that stands for a circle."""
    return max(SEGMENTS, math.ceil(math.pi / math.sqrt(2.0 * sag / radius)))


def arc(start: complex, end: complex, bulge: float) -> tuple[complex, float]:
    """Centre and signed angle of an arc."""
    angle = 4.0 * math.atan(bulge)
    centre = 0.5 * (start + end) + 1j * (end - start) * (1.0 - bulge**2) / (4.0 * bulge)
    return centre, angle


def middle_of(start: complex, end: complex, bulge: float) -> complex:
    """The point of an arc half-way."""
    return 0.5 * (start + end) - 0.5j * bulge * (end - start)


def extent(outline: Outline, along: complex) -> tuple[float, float]:
    """The least and the greatest place of an outline along a direction of length 1."""
    if isinstance(outline, Curve):
        return outline.extent(along)
    if isinstance(outline, Disc):
        at = (outline.centre * along.conjugate()).real
        return at - outline.radius, at + outline.radius
    places: list[float] = []
    for start, end, bulge in outline.edges():
        places.append((start * along.conjugate()).real)
        if bulge:
            centre, angle = arc(start, end, bulge)
            radius, first = abs(start - centre), cmath.phase((start - centre) / along)
            for k in range(-4, 5):
                # Where the arc is farthest along the direction, or against it.
                if min(first, first + angle) <= k * math.pi <= max(first, first + angle):
                    places.append((centre * along.conjugate()).real + radius * (-1.0) ** k)
    return min(places), max(places)


def area(outline: Outline) -> float:
    """What an outline encloses."""
    if isinstance(outline, Curve):
        return outline.area
    if isinstance(outline, Disc):
        return math.pi * outline.radius**2
    total = 0.0
    for start, end, bulge in outline.edges():
        total += 0.5 * (start.conjugate() * end).imag
        if bulge:
            centre, angle = arc(start, end, bulge)
            total += 0.5 * abs(start - centre) ** 2 * (angle - math.sin(angle))
    return total
