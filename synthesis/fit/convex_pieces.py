"""Outlines as convex pieces: what a fit steers clear of is convex, since only then has an overlap a depth.

A polygon is triangulated, and neighbours are joined again over every diagonal that both its ends can do without (Hertel
& Mehlhorn 1983, doi:10.1007/3-540-12689-9_105): at most four times as many pieces remain as must.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synthesis.model.triangles import triangles_of

Complex = NDArray[np.complex128]

COARSE = 1e-3
"""Share of the task's size by which an outline with many corners is simplified."""

FEW = 12
"""Corners of an outline that is taken as it is."""

STRAIGHT = 1e-12
"""Sine of a corner that bends in by rounding alone."""


def convex_pieces(corners: Complex, size: float) -> tuple[list[Complex], float]:
    """Convex polygons, each anticlockwise, that cover an outline, and how far the outline may reach beyond them.

    Parameters
    ----------
    corners : complex, shape (k,)
        Of a simple polygon; a point, or two points, is a piece by itself.
    size : float
        Of the task, in the unit of the corners.
    """
    if len(corners) < 3:
        return [np.asarray(corners)], 0.0
    from shapely import Polygon, get_coordinates

    polygon, beyond = Polygon(np.stack([corners.real, corners.imag], axis=1)), 0.0
    if len(corners) > FEW:
        polygon, beyond = polygon.simplify(COARSE * size), COARSE * size
    outline = get_coordinates(polygon.exterior.normalize()).view(np.complex128).ravel()[:-1][::-1]
    if _is_convex(outline):
        return [outline], beyond
    return _joined([_anticlockwise(corners) for corners in triangles_of(outline)]), beyond


def _anticlockwise(corners: Complex) -> Complex:
    area = float((corners.conj() * np.roll(corners, -1)).imag.sum())
    return corners if area > 0.0 else corners[::-1]


def _is_convex(corners: Complex) -> bool:
    """Whether an anticlockwise outline bends to the left at every corner."""
    ahead = np.roll(corners, -1) - corners
    behind = np.roll(ahead, 1)
    return bool(((behind.conj() * ahead).imag >= -STRAIGHT * np.abs(behind * ahead)).all())


def _joined(pieces: list[Complex]) -> list[Complex]:
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
