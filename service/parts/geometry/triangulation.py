"""Triangulation of bodies, for pictures and for interference checks of parts with non-parallel axes.

Arcs are divided to stay within a sag; flat ends are triangulated with their holes.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import shapely

from kinematics.arrays import Complex, Real
from service.parts.geometry.cut_solids import CutBody
from service.parts.geometry.regions import Outline, Region, make_polygon
from service.parts.geometry.solids import Body, Mesh, Prism, RevolvedBody, TaperedBody, TwistedPrism

FACETS_AROUND = 48
"""Number of facets around a body of revolution."""

MIN_TWIST_LAYERS = 4
"""Minimum number of layers of a twisted prism; a layer rotates by at most a tenth of a radian."""


def triangulate(body: Body, sag: float) -> Real:
    """Return triangles of a body's surface, counter-clockwise as seen from outside, shape (m, 3, 3)."""
    if isinstance(body, TaperedBody):
        body = body.mesh
    if isinstance(body, CutBody):
        return body.facets
    if isinstance(body, Mesh):
        return body.corners[body.triangles]
    if isinstance(body, RevolvedBody):
        return _triangulate_revolved(body)
    if isinstance(body, TwistedPrism):
        return _triangulate_twisted(body, sag)
    return _triangulate_prism(body, sag)


def _triangulate_prism(body: Prism, sag: float) -> Real:
    outer, holes = _make_rings(body.region, sag)
    walls = [_make_wall(line, line, body.low, body.high) for line in (outer, *(hole[::-1] for hole in holes))]
    return np.concatenate([*walls, *_make_ends(outer, holes, outer, body.low, body.high)])


def _triangulate_twisted(body: TwistedPrism, sag: float) -> Real:
    outer, holes = _make_rings(body.section, sag)
    # Flat facets of a twisted wall deviate with the square of their twist.
    count = max(MIN_TWIST_LAYERS, int(np.ceil(abs(body.twist) / 0.1)))
    shares = np.linspace(0.0, 1.0, count + 1)
    lines = [body.centre + (outer - body.centre) * np.exp(1j * body.twist * share) for share in shares]
    heights = body.low + shares * (body.high - body.low)
    walls = [
        _make_wall(one, other, low, high)
        for (one, other), (low, high) in zip(pairwise(lines), pairwise(heights.tolist()), strict=True)
    ]
    walls += [_make_wall(hole[::-1], hole[::-1], body.low, body.high) for hole in holes]
    return np.concatenate([*walls, *_make_ends(outer, holes, lines[-1], body.low, body.high)])


def _triangulate_revolved(body: RevolvedBody) -> Real:
    turns = np.exp(2j * np.pi * np.arange(FACETS_AROUND) / FACETS_AROUND)
    found = []
    for a, b in pairwise((*body.profile, body.profile[0])):
        low, high = (body.centre + z.real * turns for z in (a, b))
        found.append(_make_wall(low, high, a.imag, b.imag))
    triangles = np.concatenate(found)
    sides = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2)
    # Edges on the axis give degenerate triangles.
    return np.asarray(triangles[sides.min(axis=1) > 0.0])


def _make_rings(region: Region, sag: float) -> tuple[Complex, list[Complex]]:
    def make_line(outline: Outline) -> Complex:
        return make_polygon(outline, beyond=False, sag=sag)

    return make_line(region.outer), [make_line(hole) for hole in region.holes]


def _make_wall(one: Complex, other: Complex, low: float, high: float) -> Real:
    """Return triangles between a closed line and another above it, with the solid at their left."""
    a, b = _lift_line(one, low), _lift_line(other, high)
    a_ahead, b_ahead = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
    return np.concatenate([np.stack([a, a_ahead, b_ahead], axis=1), np.stack([a, b_ahead, b], axis=1)])


def _make_ends(outer: Complex, holes: list[Complex], upper: Complex, low: float, high: float) -> list[Real]:
    below = _triangulate_face(outer, holes, low)
    # The lower face looks downwards: reverse its triangles.
    return [below[:, ::-1], _triangulate_face(upper, holes, high)]


def _triangulate_face(outer: Complex, holes: list[Complex], height: float) -> Real:
    face = shapely.Polygon(_to_pairs(outer), [_to_pairs(hole) for hole in holes])
    pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(face))
    corners = shapely.get_coordinates(pieces).reshape(-1, 4, 2)[:, :3]
    a, b, c = (corners[:, k] @ (1.0, 1j) for k in range(3))
    # The triangulation does not guarantee an orientation.
    clockwise = ((b - a).conjugate() * (c - a)).imag < 0.0
    corners[clockwise] = corners[clockwise, ::-1]
    return np.concatenate([corners, np.full((*corners.shape[:2], 1), height)], axis=2)


def _lift_line(line: Complex, height: float) -> Real:
    return np.column_stack([line.real, line.imag, np.full(len(line), height)])


def _to_pairs(line: Complex) -> Real:
    return np.column_stack([line.real, line.imag])
