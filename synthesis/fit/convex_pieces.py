"""Decomposition of outlines into convex pieces: only convex shapes have a well-defined depth of overlap.

A polygon is triangulated, and neighbours are merged over every diagonal that is not needed at either end (Hertel &
Mehlhorn 1983, doi:10.1007/3-540-12689-9_105). The result has at most four times the minimum number of pieces.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex
from synthesis.model.triangles import triangulate_polygon

COARSE_SHARE = 1e-3
"""Share of the task's size by which an outline with many corners is simplified."""

MAX_EXACT_CORNERS = 12
"""Maximum number of corners of an outline that is used without simplification."""

COARSENING_FACTOR = 3.0
"""Factor by which the tolerance of simplification grows while an outline has too many pieces."""

HULL = 0.3
"""Tolerance of simplification, as a share of the extent, beyond which the convex hull is used: an outline simplified
that much keeps no detail that its hull would lose."""

STRAIGHTNESS_TOLERANCE = 1e-12
"""Sine of an inward bend that is attributed to rounding."""


def decompose_convex(corners: Complex, size: float, most: int | None = None) -> tuple[list[Complex], float]:
    """Cover an outline by anticlockwise convex polygons; return these and how far the outline may extend beyond them.

    Parameters
    ----------
    corners : complex, shape (k,)
        Corners of a simple polygon. One or two points are a piece by themselves.
    size : float
        Size of the task, in the unit of the corners.
    most : int, optional
        Maximum number of pieces: an outline with more is simplified further, in the end to its convex hull.
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
        # Shapely's normalized exterior is clockwise and closed: drop the last point and reverse it.
        outline = get_coordinates(polygon.exterior.normalize()).view(np.complex128).ravel()[:-1][::-1]
        if _is_convex(outline):
            return [outline], beyond
        # A cut removes at most two inward corners, so the number of pieces exceeds half their number. This test avoids
        # triangulating an outline that has too many in any case.
        if most is None or np.count_nonzero(_measure_bends(outline) < 0.0) < 2 * most:
            pieces = _merge_pieces([_orient_anticlockwise(triangle) for triangle in triangulate_polygon(outline)])
            if most is None or len(pieces) <= most:
                return pieces, beyond
        coarse *= COARSENING_FACTOR
        if coarse > HULL * np.abs(corners - corners[0]).max():
            # The hull contains the outline, so nothing extends beyond it.
            polygon, beyond = drawn.convex_hull, 0.0
        else:
            polygon, beyond = drawn.simplify(coarse), coarse


def _orient_anticlockwise(corners: Complex) -> Complex:
    area = float((corners.conj() * np.roll(corners, -1)).imag.sum())
    return corners if area > 0.0 else corners[::-1]


def _measure_bends(corners: Complex) -> NDArray[np.float64]:
    """Return a measure of the bend at every corner of an anticlockwise outline, negative if inward; shape (k,)."""
    ahead = np.roll(corners, -1) - corners
    behind = np.roll(ahead, 1)
    return np.asarray((behind.conj() * ahead).imag + STRAIGHTNESS_TOLERANCE * np.abs(behind * ahead))


def _is_convex(corners: Complex) -> bool:
    """Return whether an anticlockwise outline bends to the left at every corner."""
    return bool((_measure_bends(corners) >= 0.0).all())


def _merge_pieces(pieces: list[Complex]) -> list[Complex]:
    """Merge neighbouring pieces wherever the union is convex."""
    polygons: dict[int, list[complex]] = {n: [complex(z) for z in piece] for n, piece in enumerate(pieces)}
    sides: dict[tuple[complex, complex], int] = {}
    for number, polygon in polygons.items():
        for k, start in enumerate(polygon):
            sides[start, polygon[(k + 1) % len(polygon)]] = number
    # Each side is examined once; a merged piece takes over the sides of both.
    for start, end in list(sides):
        n, beside = sides.get((start, end)), sides.get((end, start))
        # A side with a piece on only one side belongs to the outline.
        if n is None or beside is None:
            continue
        first, second = polygons[n], polygons[beside]
        # From the end of the diagonal around the first piece to its start, and on around the second piece.
        at, there = first.index(end), second.index(start)
        whole = [*first[at:], *first[:at], *[*second[there:], *second[:there]][1:-1]]
        if not _is_convex(np.array(whole)):
            continue
        polygons[n] = whole
        del polygons[beside], sides[start, end], sides[end, start]
        for k, corner in enumerate(whole):
            sides[corner, whole[(k + 1) % len(whole)]] = n
    return [np.array(polygon) for polygon in polygons.values()]
