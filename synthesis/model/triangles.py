"""Triangulation of polygons."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Complex

TRIAL_ROTATIONS = (0.0, 0.37, 0.81, 1.3, 2.1, 2.9)
"""Rotations (radians) to try in turn until an outline is triangulated: GEOS occasionally fails on valid outlines,
depending on the last digits of their corners."""


def triangulate_polygon(corners: Complex) -> Complex:
    """Triangulate a polygon without additional corners; return the triangles, complex, shape (k, 3).

    An outline that touches itself by rounding is split there. If the triangulation fails, the convex hull is used.
    """
    from shapely import Polygon, constrained_delaunay_triangles, get_coordinates, get_parts
    from shapely.errors import GEOSException

    for turn in TRIAL_ROTATIONS:
        turned = corners * np.exp(1j * turn)
        shape = Polygon(np.stack([turned.real, turned.imag], axis=1))
        # A buffer of width 0 splits an outline that touches itself.
        shape = shape if shape.is_valid else shape.buffer(0.0)
        try:
            parts = get_parts(constrained_delaunay_triangles(shape))
        except GEOSException:
            continue
        # Map each vertex back to the nearest original corner: the rotation must not change the coordinates.
        places = np.array([get_coordinates(part).view(np.complex128).ravel()[:3] for part in parts])
        return np.asarray(corners[np.abs(places[..., None] - turned).argmin(axis=-1)])
    # A fan around one corner triangulates the convex hull.
    hull = get_coordinates(shape.convex_hull).view(np.complex128).ravel()[:-1] * np.exp(-1j * turn)
    return np.stack([np.full(len(hull) - 2, hull[0]), hull[1:-1], hull[2:]], axis=1)
