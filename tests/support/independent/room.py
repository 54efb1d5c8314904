"""The room of a linkage: pivots in their zones by shapely, and distances of hulls of joints over a dense sweep."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from kinematics.arrays import Complex, Real
from tests.support.independent.comparison import Beside
from tests.support.independent.drive import Drive
from tests.support.independent.extremes import greatest, least


def compare_room(beside: Beside, stated: dict[str, Any], drive: Drive, way: tuple[float, float]) -> None:
    """Zones, the box and the obstacles of the statement, over the turns of ``way``."""
    room = stated.get("space")
    if room is None:
        return
    for name, pins in (("fixed_pivots", ("O2", "O4")), ("moving_pivots", ("A", "B"))):
        gone = 0.0
        for side, pin in zip(("input", "output"), pins, strict=True):
            zones = room.get(name, {}).get(side)
            if zones is not None:
                place = drive.home[drive.names.index(pin)]
                listed = [shape_of(zone) for zone in (zones if isinstance(zones, list) else [zones])]
                pivot = shapely.Point(place.real, place.imag)
                gone = max(gone, min(max(float(shape.distance(pivot)) - radius, 0.0) for shape, radius in listed))
        beside.check(f"{name.removesuffix('s')}_zones", gone, drive.size)
    low, high = sorted(way)
    half = 0.5 * room.get("link_width", 0.0)
    if "box" in room:
        (left, down), (right, up) = room["box"]

        def beyond(turns: Real) -> Real:
            z = drive.at(turns)
            return np.max([left - z.real, z.real - right, down - z.imag, z.imag - up], axis=(0, 2)) + half

        beside.check("box", max(greatest(beyond, low, high).value, 0.0), drive.size)
    apart = []
    for zone in room.get("obstacles", []):
        shape, radius = shape_of(zone)
        for joints in _links(drive):
            nearest = least(lambda turns, j=joints, s=shape: _distances(drive, turns, j, s), low, high).value
            apart.append(nearest - half - radius)
    if apart:
        beside.check("obstacles", min(apart), drive.size)


def shape_of(zone: dict[str, Any]) -> tuple[shapely.Geometry, float]:
    """A polygon, or the centre of a circle; and the radius by which it is widened."""
    if "circle" in zone:
        return shapely.Point(zone["circle"]["center"]), float(zone["circle"]["radius"])
    return shapely.Polygon(zone["polygon"]), 0.0


def _links(drive: Drive) -> list[list[int]]:
    return [joints for name, joints in drive.links.items() if name != "ground"]


def _distances(drive: Drive, turns: Real, joints: list[int], shape: shapely.Geometry) -> Real:
    places: Complex = drive.at(turns)[:, joints]
    hulls = shapely.convex_hull(shapely.multipoints(np.stack([places.real, places.imag], axis=-1)))
    return np.asarray(shapely.distance(hulls, shape))
