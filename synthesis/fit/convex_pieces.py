"""Outlines as convex pieces: what a fit steers clear of is convex, since only then has an overlap a depth.

A polygon is triangulated, and neighbours are joined again over every diagonal that both its ends can do without (Hertel
& Mehlhorn 1983, doi:10.1007/3-540-12689-9_105): at most four times as many pieces remain as must.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex
from synthesis.model.triangles import triangulate_polygon

COARSE_SHARE = 1e-3
"""Share of the task's size by which an outline with many corners is simplified."""

MAX_EXACT_CORNERS = 12
"""Corners of an outline that is taken as it is."""

COARSENING_FACTOR = 3.0
"""Factor by which it is simplified further, where it has too many pieces."""

HULL = 0.3
"""Beyond this share of its extent nothing is left of an outline that its convex hull does not say better."""

STRAIGHTNESS_TOLERANCE = 1e-12
"""Sine of a corner that bends in by rounding alone."""


def decompose_convex(corners: Complex, size: float, most: int | None = None) -> tuple[list[Complex], float]:
    """Convex polygons, each anticlockwise, that cover an outline, and how far the outline may reach beyond them.

    Parameters
    ----------
    corners : complex, shape (k,)
        Of a simple polygon; a point, or two points, is a piece by itself.
    size : float
        Of the task, in the unit of the corners.
    most : int, optional
        So many pieces at most: an outline of more is simplified further, in the end to its convex hull.
    """
    if len(corners) < 3:
        return [np.asarray(corners)], 0.0
    from shapely import Polygon, get_coordinates

    drawn, beyond = Polygon(np.stack([corners.real, corners.imag], axis=1)), 0.0
    polygon = drawn
    if len(corners) > MAX_EXACT_CORNERS:
        polygon, beyond = drawn.simplify(COARSE_SHARE * size), COARSE_SHARE * size
    coarse = COARSE_SHARE * max(float(np.ptp(corners.real)), float(np.ptp(corners.imag)))
    while True:
        outline = get_coordinates(polygon.exterior.normalize()).view(np.complex128).ravel()[:-1][::-1]
        if _is_convex(outline):
            return [outline], beyond
        # A cut takes away two corners that bend in at most, so there are more pieces than half of these.
        if most is None or np.count_nonzero(_measure_bends(outline) < 0.0) < 2 * most:
            pieces = _merge_pieces([_orient_anticlockwise(triangle) for triangle in triangulate_polygon(outline)])
            if most is None or len(pieces) <= most:
                return pieces, beyond
        coarse *= COARSENING_FACTOR
        if coarse > HULL * np.abs(corners - corners[0]).max():
            polygon, beyond = drawn.convex_hull, 0.0
        else:
            polygon, beyond = drawn.simplify(coarse), coarse


def _orient_anticlockwise(corners: Complex) -> Complex:
    area = float((corners.conj() * np.roll(corners, -1)).imag.sum())
    return corners if area > 0.0 else corners[::-1]


def _measure_bends(corners: Complex) -> NDArray[np.float64]:
    """At every corner of an anticlockwise outline a number that is negative where it bends in; shape (k,)."""
    ahead = np.roll(corners, -1) - corners
    behind = np.roll(ahead, 1)
    return np.asarray((behind.conj() * ahead).imag + STRAIGHTNESS_TOLERANCE * np.abs(behind * ahead))


def _is_convex(corners: Complex) -> bool:
    """Whether an anticlockwise outline bends to the left at every corner."""
    return bool((_measure_bends(corners) >= 0.0).all())


def _merge_pieces(pieces: list[Complex]) -> list[Complex]:
    """Neighbouring pieces as one, wherever that is convex."""
    polygons: dict[int, list[complex]] = {n: [complex(z) for z in piece] for n, piece in enumerate(pieces)}
    sides: dict[tuple[complex, complex], int] = {}
    for number, polygon in polygons.items():
        for k, start in enumerate(polygon):
            sides[start, polygon[(k + 1) % len(polygon)]] = number
    for start, end in list(sides):
        n, beside = sides.get((start, end)), sides.get((end, start))
        if n is None or beside is None:
            continue
        first, second = polygons[n], polygons[beside]
        # From the end of the diagonal round the first to its start, and on round the second.
        at, there = first.index(end), second.index(start)
        whole = [*first[at:], *first[:at], *[*second[there:], *second[:there]][1:-1]]
        if not _is_convex(np.array(whole)):
            continue
        polygons[n] = whole
        del polygons[beside], sides[start, end], sides[end, start]
        for k, corner in enumerate(whole):
            sides[corner, whole[(k + 1) % len(whole)]] = n
    return [np.array(polygon) for polygon in polygons.values()]
