"""A room around what a linkage sweeps, into which it fits by 2 mm."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import affinity

from kinematics.arrays import Complex

Statement = dict[str, Any]

FITS = 2.0
"""Millimetres by which the planted linkage fits."""

PLAIN = 0.3
"""Millimetres by which outlines are simplified, and as much further away."""

LEAST_OBSTACLE = 15.0
"""Millimetres that an obstacle measures at least, by the root of its area or its radius."""

TRIES = 40
"""Random shapes until one is left where the linkage is not."""


class SweptLinkage(NamedTuple):
    """A linkage in many positions on its way.

    Attributes
    ----------
    links : mapping of str to complex ndarray, shape (positions, joints)
        The joints of each moving link. Where a body is carried its link is the bar between the pivots.
    body : complex ndarray, shape (positions, corners), or None
        The outline of what is carried.
    link_width : float
        In mm.
    """

    links: Mapping[str, Complex]
    body: Complex | None
    link_width: float

    @property
    def region(self) -> shapely.Geometry:
        """All that it sweeps."""
        parts = [shapely.buffer(hulls(joints), 0.5 * self.link_width) for joints in self.links.values()]
        if self.body is not None:
            parts.append(polygons(self.body))
        return shapely.union_all(np.concatenate(parts))


def hulls(joints: Complex) -> NDArray[np.object_]:
    """Hulls of joints (n, k) as n geometries."""
    return np.asarray(shapely.convex_hull(shapely.multipoints(np.stack([joints.real, joints.imag], axis=-1))))


def polygons(corners: Complex) -> NDArray[np.object_]:
    """Outlines (n, k) as n geometries."""
    return np.asarray(shapely.polygons(np.stack([corners.real, corners.imag], axis=-1)))


def room_around(rng: np.random.Generator, linkage: SweptLinkage, *, boxed: float = 0.7) -> Statement:
    """Box, obstacles, clearance and link width of a ``space`` block; zones are of the caller's choice.

    Parameters
    ----------
    rng : numpy.random.Generator
    linkage : SweptLinkage
        In positions near to one another: no part of it moves more than 2 mm from one to the next.
    boxed : float
        Share of rooms with a box.
    """
    swept = linkage.region
    left, low, right, high = swept.bounds
    clearance = round(float(rng.choice([0.0, rng.uniform(0.0, 5.0)])), 3)
    kept_free = swept.buffer(clearance + FITS + PLAIN).simplify(PLAIN)
    room: Statement = {"link_width": linkage.link_width, "clearance": clearance}
    obstacles = [obstacle(rng, kept_free) for _ in range(int(rng.integers(1, 4)))]
    room["obstacles"] = [zone for zone in obstacles if zone is not None]
    if rng.random() < boxed or not room["obstacles"]:
        room["box"] = [[left - FITS, low - FITS], [right + FITS, high + FITS]]
    return room


def obstacle(rng: np.random.Generator, kept_free: shapely.Geometry) -> Statement | None:
    """A zone beside a region, most often on its edge; None where no room is left for one."""
    left, low, right, high = kept_free.bounds
    extent = math.hypot(right - left, high - low)
    for _ in range(TRIES):
        boundary = kept_free.boundary
        place = boundary.interpolate(rng.uniform(0.0, boundary.length))
        if rng.random() < 0.3:
            away = extent * rng.uniform(0.03, 0.25) * np.exp(1j * rng.uniform(-math.pi, math.pi))
            centre = shapely.Point(place.x + away.real, place.y + away.imag)
            radius = float(centre.distance(kept_free))
            if radius >= LEAST_OBSTACLE:
                return {"circle": {"center": [centre.x, centre.y], "radius": radius}}
            continue
        size = extent * rng.uniform(0.1, 0.4)
        shape = affinity.translate(affinity.rotate(_block(rng, size), rng.uniform(0.0, 360.0)), place.x, place.y)
        rest = shapely.get_parts(shape.difference(kept_free))
        rest = rest[shapely.area(rest) >= LEAST_OBSTACLE**2]
        for part in rest[np.argsort(-shapely.area(rest))]:
            if not part.interiors and part.geom_type == "Polygon":
                return {"polygon": [list(corner) for corner in part.exterior.coords[:-1]]}
    return None


def _block(rng: np.random.Generator, size: float) -> shapely.Geometry:
    """A rectangle, an L, a U or a star about the origin."""
    wide, tall = size * rng.uniform(0.3, 1.0, 2)
    whole = shapely.box(-0.5 * wide, -0.5 * tall, 0.5 * wide, 0.5 * tall)
    match int(rng.integers(4)):
        case 0:
            return whole
        case 1:
            return whole.difference(shapely.box(0.0, 0.0, wide, tall))
        case 2:
            return whole.difference(shapely.box(-0.2 * wide, -0.1 * tall, 0.2 * wide, tall))
        case _:
            return shapely.Polygon(_star(rng, 0.5 * size))


def _star(rng: np.random.Generator, radius: float) -> list[tuple[float, float]]:
    """A polygon that its centre, the origin, sees all of."""
    count = int(rng.integers(4, 8))
    angles = math.tau * (np.arange(count) + rng.uniform(0.0, 0.6, count)) / count
    reach = radius * rng.uniform(0.5, 1.0, count)
    return [(float(r * math.cos(t)), float(r * math.sin(t))) for r, t in zip(reach, angles, strict=True)]


def zone_around(rng: np.random.Generator, pivot: complex, extent: float) -> Statement:
    """A zone with a pivot in it, 2 mm from its edge at least; ``extent`` is that of the linkage, mm."""
    radius = extent * rng.uniform(0.04, 0.14) + 2.0 * FITS
    near = shapely.Point(pivot.real, pivot.imag)
    while True:
        away = radius * rng.uniform(0.0, 0.6) * np.exp(1j * rng.uniform(-math.pi, math.pi))
        centre = pivot + complex(away)
        if rng.random() < 0.3:
            return {"circle": {"center": [centre.real, centre.imag], "radius": max(radius, abs(away) + FITS)}}
        shape = affinity.translate(shapely.Polygon(_star(rng, 1.3 * radius)), centre.real, centre.imag)
        if shape.contains(near) and shape.exterior.distance(near) >= FITS:
            return {"polygon": [list(corner) for corner in shape.exterior.coords[:-1]]}


def zones_around(rng: np.random.Generator, pivot: complex, extent: float) -> Statement | list[Statement]:
    """A zone with a pivot in it, now and then beside another one."""
    zone = zone_around(rng, pivot, extent)
    if rng.random() > 0.2:
        return zone
    elsewhere = pivot + extent * rng.uniform(0.3, 0.6) * np.exp(1j * rng.uniform(-math.pi, math.pi))
    return [zone_around(rng, complex(elsewhere), extent), zone]
