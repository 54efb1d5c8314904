"""Bodies of revolution with cuts by cylinders, slots, cones and half-spaces, as a lathe and a mill produce them.

A cut is a tool: an outline that is extruded from the origin along an axis, or a cone. The body is the half section
revolved about the axis, less all tools.

Directions are given by azimuth (the angle about the axis) and elevation (above the plane normal to the axis).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from kinematics.arrays import Mask, Real
from service.parts.geometry.meshed_body import MeshedBody
from service.parts.geometry.meshes import SECTION_SAG, extrude, revolve, to_pairs
from service.parts.geometry.regions import Disc, Loop, Outline, Region, count_edges, make_polygon

if TYPE_CHECKING:
    from manifold3d import Manifold

UPRIGHT = np.eye(3)
"""Axes of a tool that cuts along the heights."""

FAR_SHARE = 0.1
"""Distance from a polygon's box, as a share of its size, beyond which the box replaces it."""


class Tool(NamedTuple):
    """An outline that is extruded along the third of its ``axes``, unit vectors as rows, up to a distance."""

    outline: Outline
    axes: Real


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

    def make_tool(self, far: float) -> Tool:
        """Return the tool; an open slot extends the cylinder downwards by a rectangle."""
        section: Outline = Disc(0j, self.half)
        if self.open:
            corners = complex(self.half, -far), complex(self.half), complex(-self.half), complex(-self.half, -far)
            section = Loop(corners, (0.0, 1.0, 0.0, 0.0))
        return Tool(section, self.axes)


class ConeCut(NamedTuple):
    """A cone about a horizontal direction, its apex at the origin."""

    azimuth: float
    angle: float

    @property
    def axes(self) -> Real:
        """Unit vectors as rows: upwards, across, and along the axis."""
        c, s = _make_unit(self.azimuth)
        return np.array([(0.0, 0.0, 1.0), (s, -c, 0.0), (c, s, 0.0)])

    def compute_depth(self, points: Real) -> Real:
        """Return the depth of points; negative outside."""
        up, across, along = np.moveaxis(points @ self.axes.T, -1, 0)
        return np.asarray(along * math.sin(self.angle) - np.hypot(across, up) * math.cos(self.angle))


class HalfSpaceCut(NamedTuple):
    """The half-space of points closer to the axis, in a direction, than a distance."""

    azimuth: float
    distance: float

    def compute_depth(self, points: Real) -> Real:
        """Return the depth of points; negative outside."""
        c, s = _make_unit(self.azimuth)
        return np.asarray(self.distance - points[..., 0] * c - points[..., 1] * s)

    def make_tool(self, far: float) -> Tool:
        """Return the tool, a block."""
        box = (-far + 1j * far, -far - 1j * far, self.distance - 1j * far, self.distance + 1j * far)
        return Tool(Loop(tuple(z * complex(*_make_unit(self.azimuth)) for z in box), (0.0,) * 4), UPRIGHT)


class BoreCut(NamedTuple):
    """A hole along the axis."""

    outline: Outline

    def compute_depth(self, points: Real) -> Real:
        """Return the depth of points; negative outside."""
        return _compute_inside_depth(_make_polygon(self.outline), points[..., 0], points[..., 1])

    def make_tool(self, far: float) -> Tool:
        """Return the tool."""
        return Tool(self.outline, UPRIGHT)


Cut = SlotCut | ConeCut | HalfSpaceCut | BoreCut


@dataclass(frozen=True, eq=False)
class CutBody(MeshedBody):
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

    @cached_property
    def far(self) -> float:
        """Distance from the origin beyond which the body has no points, with a margin."""
        return 1.2 * math.hypot(*self.half.bounds[2:])

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

    def make_mesh(self, sag: float) -> Manifold:
        """Subtract all tools from the body of revolution."""
        from manifold3d import Manifold, OpType

        tools = [_make_tool_mesh(cut, self.far, sag) for cut in self.cuts]
        return Manifold.batch_boolean([revolve(self.profile, sag), *tools], OpType.Subtract)


def _make_tool_mesh(cut: Cut, far: float, sag: float) -> Manifold:
    """Return the mesh of a tool, which includes the tool."""
    from manifold3d import Manifold

    if isinstance(cut, ConeCut):
        radius = far * math.tan(cut.angle)
        edges = count_edges(radius, sag)
        made, axes = Manifold.cylinder(far, 0.0, radius / math.cos(math.pi / edges), edges), cut.axes
    else:
        tool = cut.make_tool(far)
        made, axes = extrude(Region(tool.outline), 0.0, far, sag, beyond=True), tool.axes
    return made.transform(np.column_stack([axes.T, np.zeros(3)]))


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


def _make_polygon(outline: Outline) -> shapely.Polygon:
    return shapely.Polygon(to_pairs(make_polygon(outline, beyond=False, sag=SECTION_SAG)))


def _make_unit(angle: float) -> tuple[float, float]:
    return math.cos(angle), math.sin(angle)
