"""Triangulation of bodies, for pictures and for interference checks of parts with non-parallel axes.

Arcs are divided to stay within a sag; flat ends are triangulated with their holes.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray

from service.parts.bodies import Body, Mesh, Prism, Tapered, Turned, Twisted
from service.parts.carved import Carved
from service.parts.shapes import Outline, Region, ring_of

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

AROUND = 48
"""Number of facets around a body of revolution."""

LEAST_TWISTED = 4
"""Minimum number of layers of a twisted prism; a layer rotates by at most a tenth of a radian."""


def facets(body: Body, sag: float) -> Real:
    """Return triangles of a body's surface, counter-clockwise as seen from outside, shape (m, 3, 3)."""
    if isinstance(body, Tapered):
        body = body.mesh
    if isinstance(body, Carved):
        return body.facets
    if isinstance(body, Mesh):
        return body.corners[body.triangles]
    if isinstance(body, Turned):
        return _turned(body)
    if isinstance(body, Twisted):
        return _twisted(body, sag)
    return _prism(body, sag)


def _prism(body: Prism, sag: float) -> Real:
    outer, holes = _rings(body.region, sag)
    walls = [_wall(line, line, body.low, body.high) for line in (outer, *(hole[::-1] for hole in holes))]
    return np.concatenate([*walls, *_ends(outer, holes, outer, body.low, body.high)])


def _twisted(body: Twisted, sag: float) -> Real:
    outer, holes = _rings(body.section, sag)
    # Flat facets of a twisted wall deviate with the square of their twist.
    count = max(LEAST_TWISTED, int(np.ceil(abs(body.twist) / 0.1)))
    shares = np.linspace(0.0, 1.0, count + 1)
    lines = [body.centre + (outer - body.centre) * np.exp(1j * body.twist * share) for share in shares]
    heights = body.low + shares * (body.high - body.low)
    walls = [
        _wall(one, other, low, high)
        for (one, other), (low, high) in zip(pairwise(lines), pairwise(heights.tolist()), strict=True)
    ]
    walls += [_wall(hole[::-1], hole[::-1], body.low, body.high) for hole in holes]
    return np.concatenate([*walls, *_ends(outer, holes, lines[-1], body.low, body.high)])


def _turned(body: Turned) -> Real:
    turns = np.exp(2j * np.pi * np.arange(AROUND) / AROUND)
    found = []
    for a, b in pairwise((*body.profile, body.profile[0])):
        low, high = (body.centre + z.real * turns for z in (a, b))
        found.append(_wall(low, high, a.imag, b.imag))
    triangles = np.concatenate(found)
    sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
    # Edges on the axis give degenerate triangles.
    return np.asarray(triangles[sides.min(axis=1) > 0.0])


def _rings(region: Region, sag: float) -> tuple[Complex, list[Complex]]:
    def line(outline: Outline) -> Complex:
        return ring_of(outline, beyond=False, sag=sag)

    return line(region.outer), [line(hole) for hole in region.holes]


def _wall(one: Complex, other: Complex, low: float, high: float) -> Real:
    """Return triangles between a closed line and another above it, with the solid at their left."""
    a, b = _at(one, low), _at(other, high)
    a_ahead, b_ahead = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
    return np.concatenate([np.stack([a, a_ahead, b_ahead], axis=1), np.stack([a, b_ahead, b], axis=1)])


def _ends(outer: Complex, holes: list[Complex], upper: Complex, low: float, high: float) -> list[Real]:
    below = _flat(outer, holes, low)
    # The lower face looks downwards: reverse its triangles.
    return [below[:, ::-1], _flat(upper, holes, high)]


def _flat(outer: Complex, holes: list[Complex], height: float) -> Real:
    face = shapely.Polygon(_pairs(outer), [_pairs(hole) for hole in holes])
    pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(face))
    corners = shapely.get_coordinates(pieces).reshape(-1, 4, 2)[:, :3]
    a, b, c = (corners[:, k] @ (1.0, 1j) for k in range(3))
    # The triangulation does not guarantee an orientation.
    clockwise = ((b - a).conjugate() * (c - a)).imag < 0.0
    corners[clockwise] = corners[clockwise, ::-1]
    return np.concatenate([corners, np.full((*corners.shape[:2], 1), height)], axis=2)


def _at(line: Complex, height: float) -> Real:
    return np.column_stack([line.real, line.imag, np.full(len(line), height)])


def _pairs(line: Complex) -> Real:
    return np.column_stack([line.real, line.imag])
