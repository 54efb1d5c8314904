"""Bodies of revolution with cuts by cylinders, slots, cones and half-spaces, as a lathe and a mill produce them.

A cut defines the depth of points in it, its section at a height, and the surfaces of its walls. The body is the set of
points inside its half section and in no cut. Its sections are exact at their heights except for polygons that replace
arcs; its surface is cut out of the surfaces of revolution and the walls, triangle by triangle.

Directions are given by azimuth (the angle about the axis) and elevation (above the plane normal to the axis).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import affinity

from kinematics.arrays import Mask, Real
from service.parts.geometry.regions import Disc, Loop, Outline, Region, make_polygon

Depth = Callable[[Real], Real]
"""Function of the depth of points, shape (..., 3), in a set; negative outside."""

MAX_SAG = 5e-4
"""Maximum distance of polygons from arcs, millimetres."""

STEPS_AROUND, STEPS_ALONG = 144, 48
"""Number of triangle steps about the axis, and along it over the size of the body."""

FINE_EDGES, FINE_EDGES_IN_HOLE = 60.0, 4.0
"""Minimum numbers of triangle edges near a cut that span the body's size, and the radius of each cylinder that is cut.
The smallest of the resulting edge lengths applies."""

FAR_SHARE = 0.1
"""Distance from a polygon's box, as a share of its size, beyond which the box replaces it."""

SECTION_COUNT, GAUSS_NODES = 48, 6
"""Number of intervals in which sections are integrated, and of Gauss nodes in each."""

CURVE_POINTS = 241
"""Number of points of a section of a cone."""


class SlotCut(NamedTuple):
    """A cylinder about a direction from the origin; if ``open``, with all points of its width below it.

    It is the path of a round cutter, whose axis points to the origin, from below up to the direction.
    """

    azimuth: float
    elevation: float
    half: float
    open: bool

    @property
    def axes(self) -> Real:
        """Unit vectors as rows: across, upwards in the plane of the axis, and along the axis."""
        (c, s), (a, b) = _make_unit(self.azimuth), _make_unit(self.elevation)
        return np.array([(-s, c, 0.0), (-b * c, -b * s, a), (a * c, a * s, b)])

    def compute_depth(self, points: Real) -> Real:
        """Return the depth of points, shape (..., 3); negative outside."""
        across, up, along = np.moveaxis(points @ self.axes.T, -1, 0)
        # Below the axis an open slot has straight walls: only the distance sideways counts.
        away = np.hypot(across, np.maximum(up, 0.0) if self.open else up)
        return np.asarray(np.minimum(self.half - away, along))

    def take_section(self, height: float, far: float) -> shapely.Geometry:
        """Return its section at a height above 0, up to a distance."""
        slope = math.tan(self.elevation)
        ellipse = shapely.Polygon(_to_pairs(make_polygon(Disc(0j, self.half), beyond=False, sag=MAX_SAG)))
        # A horizontal section of an inclined cylinder is an ellipse.
        ellipse = affinity.scale(ellipse, 1.0 / math.sin(self.elevation), 1.0, origin=(0.0, 0.0))
        found = affinity.translate(ellipse, height / slope)
        if self.open:
            found = shapely.union(found, shapely.box(height / slope, -self.half, far, self.half))
        # The cutter ends at the origin.
        found = shapely.intersection(found, shapely.box(-height * slope, -far, 3.0 * far, far))
        return affinity.rotate(found, self.azimuth, origin=(0.0, 0.0), use_radians=True)

    def make_walls(self, far: float) -> list[Real]:
        """Return grids of its walls, shapes (n, m, 3)."""
        turn = np.linspace(0.0, math.pi if self.open else 2.0 * math.pi, STEPS_ALONG + 1)
        lines = [np.column_stack([self.half * np.cos(turn), self.half * np.sin(turn)])]
        if self.open:
            down = -np.linspace(0.0, far, STEPS_ALONG + 1)
            lines += [np.column_stack([np.full_like(down, side * self.half), down]) for side in (-1.0, 1.0)]
        out = np.linspace(0.0, far, STEPS_ALONG + 1)
        across, up, along = self.axes
        return [line[:, None, :1] * across + line[:, None, 1:] * up + out[None, :, None] * along for line in lines]


class ConeCut(NamedTuple):
    """A cone about a horizontal direction, its apex at the origin."""

    azimuth: float
    angle: float

    def compute_depth(self, points: Real) -> Real:
        """Return the depth of points; negative outside."""
        c, s = _make_unit(self.azimuth)
        along = points[..., 0] * c + points[..., 1] * s
        across = np.hypot(points[..., 1] * c - points[..., 0] * s, points[..., 2])
        return np.asarray(along * math.sin(self.angle) - across * math.cos(self.angle))

    def take_section(self, height: float, far: float) -> shapely.Geometry:
        """Return its section, bounded by a hyperbola."""
        y = np.linspace(-far, far, CURVE_POINTS)
        # Hyperbola: section of the cone at that height.
        x = np.hypot(y, height) / math.tan(self.angle)
        curve = np.column_stack([np.minimum(x, 2.0 * far), y])
        found = shapely.Polygon([*curve, (3.0 * far, far), (3.0 * far, -far)])
        return affinity.rotate(found, self.azimuth, origin=(0.0, 0.0), use_radians=True)

    def make_walls(self, far: float) -> list[Real]:
        """Return the grid of the cone."""
        turn, out = (
            np.linspace(0.0, 2.0 * math.pi, 2 * STEPS_ALONG + 1)[:, None],
            np.linspace(0.0, far, STEPS_ALONG + 1),
        )
        c, s = _make_unit(self.azimuth)
        x, y = math.cos(self.angle) * out, math.sin(self.angle) * np.cos(turn) * out
        z = math.sin(self.angle) * np.sin(turn) * out
        return [np.stack([x * c - y * s, x * s + y * c, z], axis=-1)]


class HalfSpaceCut(NamedTuple):
    """The half-space of points closer to the axis, in a direction, than a distance."""

    azimuth: float
    distance: float

    def compute_depth(self, points: Real) -> Real:
        """Return the depth of points; negative outside."""
        c, s = _make_unit(self.azimuth)
        return np.asarray(self.distance - points[..., 0] * c - points[..., 1] * s)

    def take_section(self, height: float, far: float) -> shapely.Geometry:
        """Return its section, a half-plane."""
        found = shapely.box(-2.0 * far, -2.0 * far, self.distance, 2.0 * far)
        return affinity.rotate(found, self.azimuth, origin=(0.0, 0.0), use_radians=True)

    def make_walls(self, far: float) -> list[Real]:
        """Return the grid of the plane."""
        c, s = _make_unit(self.azimuth)
        y, z = np.linspace(-far, far, 2 * STEPS_ALONG + 1)[:, None], np.linspace(0.0, far, STEPS_ALONG + 1)
        x, y, z = np.broadcast_arrays(self.distance, y, z)
        return [np.stack([x * c - y * s, x * s + y * c, z], axis=-1)]


class BoreCut(NamedTuple):
    """A hole along the axis."""

    outline: Outline

    def compute_depth(self, points: Real) -> Real:
        """Return the depth of points; negative outside."""
        return _compute_inside_depth(_make_polygon(self.outline), points[..., 0], points[..., 1])

    def take_section(self, height: float, far: float) -> shapely.Geometry:
        """Return its outline."""
        return _make_polygon(self.outline)

    def make_walls(self, far: float) -> list[Real]:
        """Return the grid of its walls."""
        line = make_polygon(self.outline, beyond=False)
        line = np.append(line, line[:1])[:, None]
        x, y, z = np.broadcast_arrays(line.real, line.imag, np.linspace(0.0, far, STEPS_ALONG + 1))
        return [np.stack([x, y, z], axis=-1)]


Cut = SlotCut | ConeCut | HalfSpaceCut | BoreCut


@dataclass(frozen=True, eq=False)
class CutBody:
    """A body of revolution about the vertical axis through the origin, above height 0, with cuts.

    Attributes
    ----------
    profile : Loop
        The half section, counter-clockwise, with arcs: radius + i · height.
    cuts : tuple of Cut
    """

    profile: Loop
    cuts: tuple[Cut, ...]

    @cached_property
    def half(self) -> shapely.Polygon:
        """Half section as a polygon."""
        found = _make_polygon(self.profile)
        shapely.prepare(found)
        return found

    @property
    def low(self) -> float:
        """Height of the lowest point."""
        return float(self.half.bounds[1])

    @property
    def high(self) -> float:
        """Height of the highest point."""
        return float(self.half.bounds[3])

    @property
    def far(self) -> float:
        """Distance from the origin beyond which the body has no points, with a margin."""
        return 1.2 * math.hypot(self.half.bounds[2], self.half.bounds[3])

    @cached_property
    def region(self) -> Region:
        """Shadow of the body, from its sections."""
        heights = np.linspace(self.low, self.high, SECTION_COUNT + 2)[1:-1]
        whole = shapely.union_all([self._take_section(height) for height in heights.tolist()])
        faces = [face for face in shapely.get_parts(whole) if isinstance(face, shapely.Polygon)]
        return _make_region(max(faces, key=lambda face: face.area))

    @property
    def volume(self) -> float:
        """Volume: sections integrated between the corners of the half section by Gauss's rule, cubic millimetres."""
        places, weights = np.polynomial.legendre.leggauss(GAUSS_NODES)
        corners = [z.imag for z in self.profile.corners]
        heights = np.unique(np.round([*corners, *np.linspace(self.low, self.high, SECTION_COUNT + 1)], 9)).tolist()
        return math.fsum(
            0.5 * (high - low) * weight * self._take_section(0.5 * (low + high) + 0.5 * (high - low) * place).area
            for low, high in pairwise(heights)
            for place, weight in zip(places.tolist(), weights.tolist(), strict=True)
        )

    def cut_between(self, low: float, high: float) -> tuple[Region, ...]:
        """Return the section half-way between two heights."""
        faces = shapely.get_parts(self._take_section(0.5 * (low + high)))
        return tuple(_make_region(face) for face in faces if isinstance(face, shapely.Polygon))

    def find_inside(self, points: Real, deep: float) -> Mask:
        """Return which of the points, shape (n, 3), lie inside deeper than rounding."""
        radii = np.hypot(points[:, 0], points[:, 1])
        found = np.asarray(shapely.contains_xy(self.half, radii, points[:, 2]))
        for cut in self.cuts:
            # Test only points that previous cuts left.
            found[found] = cut.compute_depth(points[found]) < -deep
        # Points on the axis are inside, too.
        beside = np.flatnonzero(found & (radii > 2.0 * deep))
        found[beside] = _compute_inside_depth(self.half, radii[beside], points[beside, 2]) > deep
        return found

    @cached_property
    def facets(self) -> Real:
        """Triangles of the surface, counter-clockwise from outside, shape (m, 3, 3); some edges do not match."""
        found = []
        for grid in self._make_revolved_grids():
            triangles = self._orient_triangles(_make_triangles(grid), self._compute_depth)
            for cut in self.cuts:
                triangles = _clip_triangles(triangles, _make_outside_depth(cut), self._fine)
            found.append(triangles)
        for cut in self.cuts:
            for grid in cut.make_walls(self.far):
                triangles = self._orient_triangles(self._select_outer(_make_triangles(grid)), _make_outside_depth(cut))
                for depth in (
                    self._compute_depth,
                    *(_make_outside_depth(other) for other in self.cuts if other is not cut),
                ):
                    triangles = _clip_triangles(triangles, depth, self._fine)
                found.append(triangles)
        return np.concatenate(found)

    def _compute_depth(self, points: Real) -> Real:
        return _compute_inside_depth(self.half, np.hypot(points[..., 0], points[..., 1]), points[..., 2])

    @property
    def _fine(self) -> float:
        """Maximum triangle edge near a cut: a share of the body and of the narrowest hole."""
        return min(
            [self.far / FINE_EDGES, *(cut.half / FINE_EDGES_IN_HOLE for cut in self.cuts if isinstance(cut, SlotCut))]
        )

    def _select_outer(self, triangles: Real) -> Real:
        """Return the triangles that are at least as far from the origin as the body."""
        away = np.linalg.norm(triangles, axis=2)
        least = shapely.distance(self.half, shapely.Point(0.0, 0.0))
        return np.asarray(triangles[away.max(axis=1) > least])

    def _orient_triangles(self, triangles: Real, depth: Depth) -> Real:
        """Orient triangles so that they face the direction of decreasing depth."""
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        length = np.linalg.norm(normals, axis=1)
        triangles, normals = triangles[length > 0.0], normals[length > 0.0] / length[length > 0.0, None]
        # Probe the depth on both sides of each triangle.
        middle, step = triangles.mean(axis=1), 1e-3 * self.far
        rising = depth(middle + step * normals) > depth(middle - step * normals)
        triangles[rising] = triangles[rising, ::-1]
        return triangles

    def _make_revolved_grids(self) -> list[Real]:
        """Return grids of the surfaces of revolution, one per edge of the half section."""
        turns = np.linspace(0.0, 2.0 * math.pi, STEPS_AROUND + 1)
        line = make_polygon(self.profile, beyond=False)
        step = self.far / STEPS_ALONG
        found = []
        for start, end in zip(line, np.roll(line, -1), strict=True):
            if max(start.real, end.real) <= 0.0:
                continue
            edge = start + (end - start) * np.linspace(0.0, 1.0, math.ceil(abs(end - start) / step) + 1)
            x, y = edge.real[:, None] * np.cos(turns), edge.real[:, None] * np.sin(turns)
            found.append(np.stack([x, y, np.broadcast_to(edge.imag[:, None], x.shape)], axis=-1))
        return found

    def _take_section(self, height: float) -> shapely.Geometry:
        _, _, most, _ = self.half.bounds
        crossed = shapely.intersection(self.half, shapely.LineString([(-1.0, height), (most + 1.0, height)]))
        rings = []
        for piece in shapely.get_parts(crossed):
            least, _, outer, _ = piece.bounds
            disc = _make_polygon(Disc(0j, outer)) if outer > 0.0 else shapely.Polygon()
            rings.append(shapely.difference(disc, _make_polygon(Disc(0j, least))) if least > 0.0 else disc)
        taken = [cut.take_section(height, self.far) for cut in self.cuts]
        return shapely.difference(shapely.union_all(rings), shapely.union_all(taken))


def _make_outside_depth(cut: Cut) -> Depth:
    return lambda points: -cut.compute_depth(points)


def _clip_triangles(triangles: Real, depth: Depth, fine: float) -> Real:
    """Clip triangles, shape (m, 3, 3), to positive depth; triangles near depth 0 are divided first."""
    done = []
    while len(triangles):
        longest = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
        # Only triangles that may cross the boundary are divided.
        coarse = (longest > fine) & (np.abs(depth(triangles.mean(axis=1))) < longest)
        done.append(triangles[~coarse])
        triangles = _divide_triangles(triangles[coarse])
    triangles = np.concatenate([*done, np.zeros((0, 3, 3))])
    value = depth(triangles)
    positive = value > 0.0
    count = positive.sum(axis=1)
    found = [triangles[count == 3]]
    for number, one_alone in ((1, True), (2, False)):
        some = np.flatnonzero(count == number)
        if not some.size:
            continue
        # Rotate the corners so that the one whose sign differs comes first.
        first = np.argmax(positive[some] == one_alone, axis=1)
        order = (first[:, None] + np.arange(3)) % 3
        corners = np.take_along_axis(triangles[some], order[:, :, None], axis=1)
        at = np.take_along_axis(value[some], order, axis=1)
        a, b, c = (corners[:, k] for k in range(3))
        # Linear interpolation of the depth along both edges of the differing corner.
        ab, ac = (a + (at[:, 0] / (at[:, 0] - at[:, k]))[:, None] * (other - a) for k, other in ((1, b), (2, c)))
        # One corner inside leaves a triangle, two leave a quadrilateral.
        if one_alone:
            found.append(np.stack([a, ab, ac], axis=1))
        else:
            found += [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
    return np.concatenate(found)


def _divide_triangles(triangles: Real) -> Real:
    a, b, c = (triangles[:, k] for k in range(3))
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    four = (a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)
    return np.concatenate([np.stack(corners, axis=1) for corners in four])


def _make_triangles(grid: Real) -> Real:
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    halves = np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)
    return np.concatenate([half.reshape(-1, 3, 3) for half in halves])


def _compute_inside_depth(polygon: shapely.Polygon, x: Real, y: Real) -> Real:
    """Return the depth of points in a polygon; negative outside. Far away, the distance from its box replaces it."""
    left, low, right, high = polygon.bounds
    # Distance from the bounding box: exact zero inside it.
    away = -np.hypot(np.maximum(0.0, np.maximum(left - x, x - right)), np.maximum(0.0, np.maximum(low - y, y - high)))
    near = away > -FAR_SHARE * max(right - left, high - low)
    u, v = x[near], y[near]
    edge = polygon.exterior
    shapely.prepare([polygon, edge])
    distance = shapely.distance(edge, shapely.points(u, v))
    away[near] = np.where(shapely.contains_xy(polygon, u, v), distance, -distance)
    return np.asarray(away)


def _make_unit(angle: float) -> tuple[float, float]:
    return math.cos(angle), math.sin(angle)


def _to_pairs(places: NDArray[np.complex128]) -> Real:
    return np.column_stack([places.real, places.imag])


def _make_polygon(outline: Outline) -> shapely.Polygon:
    return shapely.Polygon(_to_pairs(make_polygon(outline, beyond=False, sag=MAX_SAG)))


def _make_region(face: shapely.Polygon) -> Region:
    outer, *holes = (_make_loop(line) for line in (face.exterior, *face.interiors))
    return Region(outer, tuple(holes))


def _make_loop(line: shapely.LinearRing) -> Loop:
    places = shapely.get_coordinates(line)[:-1] @ (1.0, 1j)
    if not shapely.is_ccw(line):
        places = places[::-1]
    return Loop(tuple(places.tolist()), (0.0,) * len(places))
