"""Closed meshes of regions, by Manifold, with the operations that bodies are made of.

Meshes of extruded bodies lie inside them: polygons of outlines are inscribed, those of holes circumscribed. Inner walls
of revolved bodies and twisted walls deviate to either side. No mesh deviates by more than a *sag* from its body.
Manifold is imported when the first mesh is made.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from service.parts.geometry.regions import Loop, Region, count_edges, make_polygon

if TYPE_CHECKING:
    from manifold3d import CrossSection, Manifold

SECTION_SAG, DISPLAY_SAG = 5e-3, 0.02
"""Maximum distance from arcs of polygons in sections, and of displayed ones, millimetres."""

MAX_LAYER_TWIST = 0.1
"""Maximum twist of a layer of a twisted prism, radians."""

MIN_TWIST_LAYERS = 4
"""Minimum number of layers of a twisted prism, so that walls with little twist are curved, too."""


def make_section(region: Region, sag: float, *, beyond: bool = False) -> CrossSection:
    """Return a region with polygons instead of arcs, inside the region, or around it (``beyond``)."""
    from manifold3d import CrossSection

    outer = make_polygon(region.outer, beyond=beyond, sag=sag)
    holes = [make_polygon(hole, beyond=not beyond, sag=sag) for hole in region.holes]
    whole = CrossSection([to_pairs(outer)])
    return whole - CrossSection([to_pairs(hole) for hole in holes]) if holes else whole


def extrude(
    region: Region, low: float, high: float, sag: float, *, twist: float = 0.0, top: float = 1.0, beyond: bool = False
) -> Manifold:
    """Extrude a region from one height to another.

    Parameters
    ----------
    twist : float
        Rotation of the upper end about the origin, radians.
    top : float
        Scale of the upper end about the origin.
    beyond : bool
        Whether the mesh lies around the body instead of inside it.
    """
    from manifold3d import Manifold

    # Flat facets of a twisted wall deviate with the square of their twist.
    layers = max(MIN_TWIST_LAYERS, math.ceil(abs(twist) / MAX_LAYER_TWIST)) if twist else 1
    made = Manifold.extrude(
        make_section(region, sag, beyond=beyond), high - low, layers - 1, math.degrees(twist), (top, top)
    )
    return made.translate((0.0, 0.0, low))


def revolve(profile: Loop, sag: float) -> Manifold:
    """Revolve a half section, radius + i · height, about the axis of heights."""
    from manifold3d import Manifold

    farthest = max(z.real for z in profile.corners)
    return Manifold.revolve(make_section(Region(profile), sag), count_edges(farthest, sag))


def join_triangles(corners: Real, triangles: NDArray[np.int64]) -> Manifold:
    """Return the body enclosed by triangles, whose corners are counter-clockwise as seen from outside."""
    from manifold3d import Error, Manifold, Mesh64

    # Manifold takes only arrays that can be written.
    made = Manifold(Mesh64(np.array(corners, order="C"), np.array(triangles, np.uint64, order="C")))
    assert made.status() == Error.NoError, made.status()
    return made


def read_triangles(mesh: Manifold) -> tuple[Real, NDArray[np.int64]]:
    """Return the corners of a mesh, shape (n, 3), and their indices in each triangle, shape (m, 3)."""
    found = mesh.to_mesh64()
    return np.asarray(found.vert_properties[:, :3], np.float64), np.asarray(found.tri_verts, np.int64)


def list_regions(section: CrossSection) -> tuple[Region, ...]:
    """Return the parts of a section that do not touch each other."""
    found = []
    # Diagonals of walls leave corners on straight edges.
    for piece in section.simplify().decompose():
        outlines = [contour @ (1.0, 1j) for contour in piece.to_polygons()]
        if outlines:
            # The outer contour is the only one that is counter-clockwise.
            outer, *holes = sorted(outlines, key=_measure_area, reverse=True)
            found.append(Region(_make_loop(outer), tuple(_make_loop(hole[::-1]) for hole in holes)))
    return tuple(found)


def _measure_area(places: Complex) -> float:
    return 0.5 * float((places.conjugate() * np.roll(places, -1)).imag.sum())


def _make_loop(places: Complex) -> Loop:
    return Loop(tuple(places.tolist()), (0.0,) * len(places))


def to_pairs(places: Complex) -> Real:
    """Return the coordinates of points, shape (n, 2)."""
    return np.column_stack([places.real, places.imag])
