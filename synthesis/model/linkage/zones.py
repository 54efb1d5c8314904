"""Models of areas in the plane: permitted zones of pivots, and obstacles."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Literal, Protocol, Self

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.model.problem import Point, PositiveLength, Statement
from synthesis.model.triangles import triangulate_polygon

if TYPE_CHECKING:
    from shapely import Polygon
    from shapely.geometry.base import BaseGeometry


MAX_VERTICES = 1000
"""Maximum number of vertices of an outline; they suffice for a circle in steps of a third of a degree. The cost of a
sweep grows with the number of pairs of edges."""

EDGE_TOLERANCE = 1e-9
"""Distance outside an area, as a share of the largest coordinate, up to which points count as lying on its edge."""

FLATNESS_TOLERANCE = 1e-9
"""Area of a polygon, as a share of the square of its extent, up to which it counts as degenerate."""


class Area(Protocol):
    """An area in which points may lie."""

    def compute_distances(self, points: Complex) -> Real:
        """Compute distances of points (any shape) from the area, length units; 0 inside and on the edge."""

    def sample_points(self, rng: np.random.Generator, count: int) -> Complex:
        """Sample points uniformly from the area, complex, shape (count,)."""

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Bounding box: minimum and maximum x, minimum and maximum y."""


def _require_simple(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    from shapely import Polygon, is_valid_reason

    extent = np.ptp(np.array(points), axis=0).max()
    if extent == 0.0 or Polygon(points).area <= FLATNESS_TOLERANCE * extent**2:
        raise ValueError(compose("model-outline-without-area"))
    if not Polygon(points).is_valid:
        # The reason ends with the coordinates of an intersection, such as "Self-intersection[3 2]".
        x, y = is_valid_reason(Polygon(points)).rpartition("[")[2].rstrip("]").split()
        raise ValueError(compose("model-outline-intersects-itself", x=x, y=y))
    return points


Outline = Annotated[list[Point], Field(min_length=3, max_length=MAX_VERTICES), AfterValidator(_require_simple)]
"""Corners of a simple polygon, in order, either way round; it need not be convex. The first is not repeated."""


class Circle(Statement):
    """A circle with its interior."""

    center: Point
    radius: PositiveLength


def _build_geometry(corners: Complex) -> BaseGeometry:
    """Build the Shapely geometry of a point, a line or a polygon from its corners."""
    from shapely import LineString, Point, Polygon

    pairs = np.stack([corners.real, corners.imag], axis=1)
    return Point(pairs[0]) if len(pairs) == 1 else LineString(pairs) if len(pairs) == 2 else Polygon(pairs)


class Zone(Statement):
    """An area: a polygon, which need not be convex, or a circle."""

    polygon: Outline | None = None
    circle: Circle | None = None

    @model_validator(mode="after")
    def _validate_shape(self) -> Self:
        if (self.polygon is None) == (self.circle is None):
            raise ValueError(compose("model-zone-form"))
        return self

    @cached_property
    def _shape(self) -> Polygon:
        from shapely import Polygon, prepare

        assert self.polygon is not None
        shape = Polygon(self.polygon)
        prepare(shape)
        return shape

    def compute_distances(self, points: Complex) -> Real:
        """Compute distances of points (any shape) from the zone, length units; 0 inside and on the edge to rounding."""
        if self.circle is not None:
            centre = complex(*self.circle.center)
            away = np.abs(points - centre) - self.circle.radius
            slack = EDGE_TOLERANCE * (abs(centre) + self.circle.radius)
        else:
            import shapely

            away = shapely.distance(self._shape, shapely.points(np.real(points), np.imag(points)))
            slack = EDGE_TOLERANCE * float(np.abs(self._shape.bounds).max())
        return np.asarray(np.where(away > slack, away, 0.0))

    def compute_distance_from(self, corners: Complex) -> float:
        """Compute the distance from a point, a line or a polygon given by its corners; 0 if they touch."""
        from shapely import Point

        other = _build_geometry(corners)
        if self.circle is not None:
            return max(float(other.distance(Point(self.circle.center))) - self.circle.radius, 0.0)
        return float(other.distance(self._shape))

    def is_entered_by(self, corners: Complex) -> bool:
        """Return whether a point, a line or a polygon reaches the interior instead of only touching the edge."""
        from shapely import Point

        other = _build_geometry(corners)
        if self.circle is not None:
            return bool(other.distance(Point(self.circle.center)) < self.circle.radius)
        return bool(other.relate_pattern(self._shape, "T********"))

    def sample_points(self, rng: np.random.Generator, count: int) -> Complex:
        """Sample points uniformly from the area, complex, shape (count,)."""
        if self.circle is not None:
            distance = self.circle.radius * np.sqrt(rng.uniform(0.0, 1.0, count))
            return np.asarray(complex(*self.circle.center) + distance * np.exp(2j * np.pi * rng.uniform(size=count)))
        outline, _ = self.outline
        corners = triangulate_polygon(outline)
        weights = np.abs(((corners[:, 1] - corners[:, 0]).conj() * (corners[:, 2] - corners[:, 0])).imag)
        chosen = corners[rng.choice(len(corners), count, p=weights / weights.sum())]
        first, second = rng.uniform(0.0, 1.0, (2, count))
        # Reflect samples beyond the diagonal of the parallelogram into the triangle.
        beyond = first + second > 1.0
        first, second = np.where(beyond, 1.0 - first, first), np.where(beyond, 1.0 - second, second)
        sides = chosen[:, 1:] - chosen[:, :1]
        return np.asarray(chosen[:, 0] + first * sides[:, 0] + second * sides[:, 1])

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Bounding box: minimum and maximum x, minimum and maximum y."""
        points, radius = self.outline
        x, y = points.real, points.imag
        return float(x.min() - radius), float(x.max() + radius), float(y.min() - radius), float(y.max() + radius)

    @property
    def size(self) -> float:
        """Area in square length units."""
        return float(np.pi * self.circle.radius**2 if self.circle is not None else self._shape.area)

    @property
    def outline(self) -> tuple[Complex, float]:
        """Corners, or the centre of a circle, and the radius by which they are widened."""
        if self.circle is not None:
            return np.array([complex(*self.circle.center)]), self.circle.radius
        assert self.polygon is not None
        return np.array([complex(*corner) for corner in self.polygon]), 0.0


class MovingZone(Zone):
    """A zone of a moving pivot in the first position."""

    frame: Annotated[
        Literal["plane", "body"],
        Field(
            description="plane: position of the pivot in the plane in the first position. body: position on the body, "
            "drawn with the body in its first position."
        ),
    ] = "plane"

    def move_with_body(self, moved: Callable[[tuple[float, float]], tuple[float, float]]) -> Self:
        """Return the zone after a motion of the body, which maps points by ``moved``; a zone of the plane unchanged."""
        if self.frame == "plane":
            return self
        if self.circle is not None:
            circle = self.circle.model_copy(update={"center": moved(self.circle.center)})
            return type(self)(circle=circle, frame=self.frame)
        assert self.polygon is not None
        return type(self)(polygon=[moved(corner) for corner in self.polygon], frame=self.frame)


class AnyZone:
    """Union of several zones: a point may lie in any of them."""

    def __init__(self, zones: Sequence[Zone]) -> None:
        self.zones = tuple(zones)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, AnyZone) and self.zones == other.zones

    def __hash__(self) -> int:
        return hash(len(self.zones))

    def compute_distances(self, points: Complex) -> Real:
        """Compute the distances of points (any shape) from the nearest zone, length units."""
        return np.asarray(np.min([zone.compute_distances(points) for zone in self.zones], axis=0))

    def sample_points(self, rng: np.random.Generator, count: int) -> Complex:
        """Sample points from the zones in proportion to their areas, complex, shape (count,)."""
        sizes = np.array([zone.size for zone in self.zones])
        drawn = np.stack([zone.sample_points(rng, count) for zone in self.zones])
        return np.asarray(drawn[rng.choice(len(sizes), count, p=sizes / sizes.sum()), np.arange(count)])

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Bounding box of all zones."""
        boxes = np.array([zone.bounds for zone in self.zones])
        least, greatest = boxes.min(axis=0), boxes.max(axis=0)
        return float(least[0]), float(greatest[1]), float(least[2]), float(greatest[3])
