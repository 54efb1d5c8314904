"""Interference of parts with non-parallel axes: surface points of each part are tested for being inside the other.

Bodies with crossing axes have no common planes in which their sections could be intersected. So the surface of each
body is covered with points one *step* apart along edges and over faces. Points on the outlines of teeth include all
corners of their polygons. Every point that lies inside the other body, deeper than rounding, is counted. Each body is
tested against the other, so only a wedge between neighbouring points can be missed, less than half a step deep.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from kinematics.arrays import Mask, Real
from service.parts.assembly.model import Assembly, Carrier, Part, compute_poses
from service.parts.geometry.cut_solids import CutBody
from service.parts.geometry.meshes import DISPLAY_SAG, read_triangles, to_pairs
from service.parts.geometry.regions import Outline, Region, make_polygon
from service.parts.geometry.solids import Body, Mesh, Prism, TaperedBody, TwistedPrism

STEPS_PER_SIZE = 160.0
"""Number of steps in the size of an assembly."""

HEAP_EDGE = 8.0
"""Edge of the cubes into which points are grouped, in steps."""

MIN_DEPTH = 4e-3
"""Minimum depth of a counted point in a body, millimetres; more than the distance of polygons from arcs."""

LEVEL_COUNT = 160
"""Number of sections of a mesh; between two sections a point must lie in both."""

MAX_SAG = 2e-3
"""Maximum distance of polygons from arcs, millimetres."""


_TURNS = np.arange(90) * math.pi * (3.0 - math.sqrt(5.0))
_HEIGHTS = 1.0 - (2.0 * np.arange(90) + 1.0) / 90.0
_RADII = np.sqrt(1.0 - _HEIGHTS**2)
DIRECTIONS = np.column_stack([_RADII * np.cos(_TURNS), _RADII * np.sin(_TURNS), _HEIGHTS])
"""Evenly distributed unit vectors (Fibonacci sphere)."""


class PointGroups(NamedTuple):
    """Groups of points, each within a radius of its group's middle, shape (m, 3)."""

    points: list[Real]
    middles: Real
    radius: float


class BodySurface:
    """A body with its surface points and a test for points inside, in the coordinates of its plane."""

    def __init__(self, body: Body, step: float) -> None:
        self._body, self._step = body, step
        self._sections: dict[int, shapely.Geometry] = {}

    @cached_property
    def points(self) -> Real:
        """Surface points, shape (n, 3): x, y and height."""
        body = self._body
        if isinstance(body, TaperedBody):
            return self._sample_tapered(body)
        if isinstance(body, CutBody):
            return read_triangles(body.make_mesh(DISPLAY_SAG).refine_to_length(self._step))[0]
        if isinstance(body, Mesh):
            return _sample_triangles(body.corners[body.triangles], self._step)
        assert isinstance(body, Prism | TwistedPrism)
        region = body.section if isinstance(body, TwistedPrism) else body.region
        heights = _make_steps(body.low, body.high, self._step)
        found = []
        for outline in (region.outer, *region.holes):
            around = _sample_outline(outline, self._step)
            turns = np.ones(len(heights), np.complex128)
            centre = 0j
            if isinstance(body, TwistedPrism) and outline is region.outer:
                centre = body.centre
                turns = np.exp(1j * body.twist * (heights - body.low) / (body.high - body.low))
            places = centre + turns[:, None] * (around - centre)
            found.append(np.stack([places.real, places.imag, np.broadcast_to(heights[:, None], places.shape)], axis=-1))
        sides = np.concatenate([one.reshape(-1, 3) for one in found])
        return np.concatenate([sides, *self._sample_faces(region, body)])

    @cached_property
    def outermost(self) -> Real:
        """The extreme points in each of many directions."""
        body = self._body
        points = body.corners if isinstance(body, Mesh) else self.points
        farthest = [int(np.argmax(points @ direction)) for direction in DIRECTIONS]
        return np.asarray(points[np.unique(farthest)])

    @cached_property
    def bounds(self) -> tuple[Real, Real]:
        """Lowest and highest corner of the bounding box."""
        return self.points.min(axis=0), self.points.max(axis=0)

    @cached_property
    def heaps(self) -> PointGroups:
        """Points grouped by cubes, so that most groups are rejected as a whole."""
        edge = HEAP_EDGE * self._step
        cells = np.floor((self.points - self.bounds[0]) / edge).astype(np.int64)
        # Encode each cube as one number: sorting rows is a hundred times slower.
        _, cube = np.unique(cells @ np.cumprod([1, *(cells.max(axis=0)[:2] + 1)]), return_inverse=True)
        order = np.argsort(cube, kind="stable")
        ends = np.cumsum(np.bincount(cube))[:-1]
        ordered = self.points[order]
        starts = np.concatenate([[0], ends])
        middles = 0.5 * (np.minimum.reduceat(ordered, starts) + np.maximum.reduceat(ordered, starts))
        return PointGroups(np.split(ordered, ends), middles, 0.5 * math.sqrt(3.0) * edge)

    def find_inside(self, points: Real) -> Mask:
        """Return which of the points, shape (n, 3), lie inside."""
        body = self._body
        if isinstance(body, CutBody):
            return body.find_inside(points, MIN_DEPTH)
        deep = (points[:, 2] > body.low + MIN_DEPTH) & (points[:, 2] < body.high - MIN_DEPTH)
        found = np.zeros(len(points), np.bool_)
        if not deep.any():
            return found
        x, y, z = points[deep].T
        if isinstance(body, Mesh):
            found[deep] = self._find_in_sections(body, points[deep])
            return found
        if isinstance(body, TaperedBody):
            share = body.scale(z)
            # Project the point along the line to the apex onto the reference plane.
            place = (x + 1j * y) / share
            radii = np.hypot(x, y)
            inside = shapely.contains_xy(self._section, place.real, place.imag)
            inside &= shapely.contains_xy(self._profile, radii, z)
            found[deep] = inside & ~shapely.contains_xy(self._holes, x, y)
            return found
        if isinstance(body, TwistedPrism):
            # Undo the twist, then test in the reference section.
            back = np.exp(-1j * body.twist * (z - body.low) / (body.high - body.low))
            turned = body.centre + back * (x + 1j * y - body.centre)
            inside = shapely.contains_xy(self._section, turned.real, turned.imag)
            found[deep] = inside & ~shapely.contains_xy(self._holes, x, y)
            return found
        found[deep] = shapely.contains_xy(self._section, x, y) & ~shapely.contains_xy(self._holes, x, y)
        return found

    def _find_in_sections(self, body: Mesh, points: Real) -> Mask:
        """Return which points lie in both neighbouring sections of a mesh, taken at equal steps."""
        step = (body.high - body.low) / LEVEL_COUNT
        level = np.floor((points[:, 2] - body.low) / step).astype(int)
        inside = np.zeros(len(points), np.bool_)
        for k in np.unique(level).tolist():
            own = level == k
            x, y = points[own, 0], points[own, 1]
            inside[own] = shapely.contains_xy(self._get_section(body, k), x, y) & shapely.contains_xy(
                self._get_section(body, k + 1), x, y
            )
        return inside

    def _get_section(self, body: Mesh, number: int) -> shapely.Geometry:
        if number not in self._sections:
            # Avoid the end faces, where sections degenerate.
            height = body.low + (body.high - body.low) * min(max(number, 0.01), LEVEL_COUNT - 0.01) / LEVEL_COUNT
            faces = [
                shapely.difference(
                    _make_polygon(region.outer), shapely.union_all([_make_polygon(hole) for hole in region.holes])
                )
                for region in body.cut_between(height, height)
            ]
            self._sections[number] = shapely.buffer(shapely.union_all(faces), -MIN_DEPTH, join_style="mitre")
            shapely.prepare(self._sections[number])
        return self._sections[number]

    @cached_property
    def _section(self) -> shapely.Geometry:
        body = self._body
        region = body.section if isinstance(body, TwistedPrism | TaperedBody) else body.region
        # Only points deeper than the polygon error count.
        inner = shapely.buffer(_make_polygon(region.outer), -MIN_DEPTH)
        shapely.prepare(inner)
        return inner

    @cached_property
    def _holes(self) -> shapely.Geometry:
        body = self._body
        region = body.section if isinstance(body, TwistedPrism | TaperedBody) else body.region
        wider = shapely.buffer(shapely.union_all([_make_polygon(hole) for hole in region.holes]), MIN_DEPTH)
        shapely.prepare(wider)
        return wider

    @cached_property
    def _profile(self) -> shapely.Geometry:
        assert isinstance(self._body, TaperedBody)
        inner = shapely.buffer(shapely.Polygon([(z.real, z.imag) for z in self._body.profile]), -MIN_DEPTH)
        # Points on the axis are inside, too.
        inner = shapely.union(
            inner, shapely.box(0.0, self._body.low + MIN_DEPTH, 2.0 * MIN_DEPTH, self._body.high - MIN_DEPTH)
        )
        shapely.prepare(inner)
        return inner

    def _sample_tapered(self, body: TaperedBody) -> Real:
        """Return points along the lines of the flanks, and from there inwards to the ends of the teeth."""
        around = _sample_outline(
            body.section.outer, self._step / float(body.scale(np.array([body.low, body.high])).max())
        )
        low, high = body.find_ends(around)
        _, inner, *_, upper, _ = body.profile
        ways = [(np.full(len(around), inner), low), (low, high), (high, np.full(len(around), upper))]
        turns = around / np.abs(around)
        found = []
        for start, end in ways:
            for share in np.linspace(0.0, 1.0, math.ceil(float(np.abs(end - start).max()) / self._step) + 1):
                place = start + share * (end - start)
                at = place.real * turns
                found.append(np.column_stack([at.real, at.imag, place.imag]))
        heights = _make_steps(body.low, body.high, self._step)
        for hole in body.section.holes:
            edge = np.tile(_sample_outline(hole, self._step), len(heights))
            found.append(np.column_stack([edge.real, edge.imag, np.repeat(heights, len(edge) // len(heights))]))
        return np.concatenate(found)

    def _sample_faces(self, region: Region, body: Prism | TwistedPrism) -> list[Real]:
        """Return points over the lower and the upper face."""
        outer = _make_polygon(region.outer)
        holes = shapely.union_all([_make_polygon(hole) for hole in region.holes])
        left, low, right, high = outer.bounds
        x, y = (
            each.ravel()
            for each in np.meshgrid(_make_steps(left, right, self._step), _make_steps(low, high, self._step))
        )
        solid = shapely.contains_xy(outer, x, y)
        faces = []
        for height in (body.low, body.high):
            place = x + 1j * y
            if isinstance(body, TwistedPrism) and height == body.high:
                place = body.centre + np.exp(1j * body.twist) * (place - body.centre)
            open_ = shapely.contains_xy(holes, place.real, place.imag)
            kept = place[solid & ~open_]
            faces.append(np.column_stack([kept.real, kept.imag, np.full(len(kept), height)]))
        return faces


class CrossingCheck:
    """The parts of an assembly at inputs, shape (n,); compares pairs in different planes."""

    def __init__(self, assembly: Assembly, inputs: Real) -> None:
        state, carriers = assembly.motion.compute_state(inputs), dict.fromkeys(part.carrier for part in assembly.parts)
        self._placed = {carrier: assembly.motion.compute_placement(carrier, state) for carrier in carriers}
        self._count = len(inputs)
        self._step = assembly.size / STEPS_PER_SIZE
        self._surfaces: dict[str, list[BodySurface]] = {}
        self._places: dict[Carrier, tuple[Real, Real]] = {}
        self._boxes: dict[tuple[str, int], tuple[Real, Real]] = {}

    def estimate_overlap(self, one: Part, other: Part) -> Real:
        """Estimate the surface area of two parts inside each other at each input, shape (n,)."""
        most = np.zeros(self._count)
        for (n, first), (m, second) in product(
            enumerate(self._get_surfaces(one)), enumerate(self._get_surfaces(other))
        ):
            (low, high), (bottom, top) = self._get_box(one, n), self._get_box(other, m)
            # Bounding boxes in space reject most inputs.
            near = np.flatnonzero(((low < top) & (bottom < high)).all(axis=1))
            if not self._is_moving(one) and not self._is_moving(other):
                near = near[:1]
            for k in near:
                found = self._count_inside(one, first, other, second, int(k)) + self._count_inside(
                    other, second, one, first, int(k)
                )
                # Each point represents a square of one step.
                most[k] += found * self._step**2
        return most

    def _get_surfaces(self, part: Part) -> list[BodySurface]:
        if part.name not in self._surfaces:
            self._surfaces[part.name] = [BodySurface(body, self._step) for body in part.bodies]
        return self._surfaces[part.name]

    def _is_moving(self, part: Part) -> bool:
        placed = self._placed[part.carrier]
        return bool(np.ptp(np.abs(placed.turn - placed.turn[0])) > 0.0 or np.ptp(np.abs(placed.shift)) > 0.0)

    def _get_position(self, carrier: Carrier) -> tuple[Real, Real]:
        """Return rotation and position in space at each input, shapes (count, 3, 3) and (count, 3)."""
        if carrier not in self._places:
            self._places[carrier] = compute_poses(self._placed[carrier], self._count)
        return self._places[carrier]

    def _get_box(self, part: Part, number: int) -> tuple[Real, Real]:
        """Return lowest and highest corner of a body in space at each input."""
        if (part.name, number) not in self._boxes:
            rotation, place = self._get_position(part.carrier)
            points = np.einsum("kij,nj->kni", rotation, self._get_surfaces(part)[number].outermost) + place[:, None]
            # Between two of the directions a body may extend slightly farther: add one step.
            self._boxes[part.name, number] = points.min(axis=1) - self._step, points.max(axis=1) + self._step
        return self._boxes[part.name, number]

    def _count_inside(self, one: Part, first: BodySurface, other: Part, second: BodySurface, k: int) -> int:
        """Count the points of the first body inside the second at an input."""
        (turn, place), (turned, moved) = self._get_position(one.carrier), self._get_position(other.carrier)
        # Transform points of the first body into the frame of the second.
        rotation, shift = turned[k].T @ turn[k], turned[k].T @ (place[k] - moved[k])
        low, high = second.bounds
        heaps = first.heaps
        # Test groups first; only groups near the other body are expanded.
        middles = heaps.middles @ rotation.T + shift
        reached = ((middles > low - heaps.radius) & (middles < high + heaps.radius)).all(axis=1)
        if not reached.any():
            return 0
        points = np.concatenate([heaps.points[n] for n in np.flatnonzero(reached)]) @ rotation.T + shift
        for axis in range(3):
            points = points[(points[:, axis] > low[axis]) & (points[:, axis] < high[axis])]
        return int(np.count_nonzero(second.find_inside(points))) if len(points) else 0


def _sample_triangles(triangles: Real, step: float) -> Real:
    """Return the corners of triangles, shape (m, 3, 3), and points on those larger than a step."""
    a, b, c = (triangles[:, k] for k in range(3))
    one, other = (np.ceil(np.linalg.norm(edge, axis=1) / step).astype(int) + 1 for edge in (b - a, c - a))
    found = [triangles.reshape(-1, 3)]
    for k in np.flatnonzero(np.maximum(one, other) > 2).tolist():
        u, v = (share.ravel() for share in np.meshgrid(np.linspace(0.0, 1.0, one[k]), np.linspace(0.0, 1.0, other[k])))
        u, v = u[u + v <= 1.0, None], v[u + v <= 1.0, None]
        found.append(a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]))
    return np.concatenate(found)


def _make_polygon(outline: Outline) -> shapely.Polygon:
    places = make_polygon(outline, beyond=False, sag=MAX_SAG)
    return shapely.Polygon(to_pairs(places))


def _sample_outline(outline: Outline, step: float) -> NDArray[np.complex128]:
    """Return the corners of an outline's polygon, and points between corners more than a step from each other."""
    corners = make_polygon(outline, beyond=False, sag=MAX_SAG)
    pieces = [
        start + (end - start) * np.arange(count) / count
        for start, end in zip(corners, np.roll(corners, -1), strict=True)
        for count in (max(1, math.ceil(abs(end - start) / step)),)
    ]
    return np.concatenate(pieces)


def _make_steps(low: float, high: float, step: float) -> Real:
    return np.linspace(low, high, math.ceil((high - low) / step) + 1)
