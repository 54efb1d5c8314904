"""Solids of parts, each upright along its axis: prisms, bodies of revolution, twisted prisms, cones and meshes.

Bodies of revolution with cuts are in :mod:`service.parts.geometry.cut_solids`.

Every body has a volume, a lowest and a highest point, its *shadow* (the region that it covers, seen along the axis),
and a cross section between two heights. Two parts are compared by the latter:

* for a prism its region, which is exact;
* for a body of revolution the ring between its minimum and maximum radius there, which is never too small;
* for all others the section half-way between, which is exact at that height. The heights are divided into
  :data:`SLICE_COUNT` steps. Few are sufficient for teeth that are twisted against each other, because in the course of
  the motion every height shows the same relative positions.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from service.parts.geometry.cut_solids import CutBody
from service.parts.geometry.regions import (
    Disc,
    Loop,
    Outline,
    Region,
    find_hull,
    make_polygon,
    make_ring,
    measure_area,
    rotate_outline,
)

SLICE_COUNT = 5
"""Number of height steps in which two bodies are compared unless both are prisms."""


GAUSS_NODES = 12
"""Number of Gauss nodes between two corners of a profile in the integration of sections."""

SECTION_SAG = 5e-4
"""Maximum distance of section polygons from arcs, millimetres."""


DISPLAY_SAG = 0.02
"""Maximum distance of displayed polygons from arcs, millimetres."""


class Prism(NamedTuple):
    """A region extruded from one height to another."""

    region: Region
    low: float
    high: float

    @property
    def volume(self) -> float:
        """Volume, cubic millimetres."""
        return _measure_net_area(self.region) * (self.high - self.low)

    def cut_between(self, low: float, high: float) -> tuple[Region, ...]:
        """Return the cross section between two heights."""
        return (self.region,)


class RevolvedBody(NamedTuple):
    """A body of revolution about an upright axis.

    ``profile`` are the corners of its half section, counter-clockwise: radius + i · height, no radius below 0.
    """

    profile: tuple[complex, ...]
    centre: complex = 0j

    @property
    def low(self) -> float:
        """Height of the lowest point."""
        return min(z.imag for z in self.profile)

    @property
    def high(self) -> float:
        """Height of the highest point."""
        return max(z.imag for z in self.profile)

    @property
    def region(self) -> Region:
        """Shadow of the body."""
        return self.cut_between(self.low, self.high)[0]

    @property
    def volume(self) -> float:
        """∮ π r² dz along the half section, cubic millimetres."""
        around = pairwise((*self.profile, self.profile[0]))
        return math.fsum(
            math.pi / 3.0 * (a.real**2 + a.real * b.real + b.real**2) * (b.imag - a.imag) for a, b in around
        )

    def cut_between(self, low: float, high: float) -> tuple[Region, ...]:
        """Return the ring of the radii between two heights; an empty tuple outside the body."""
        # Coordinates of the half section are radius and height.
        section = shapely.Polygon([(z.real, z.imag) for z in self.profile])
        least, _, most, _ = shapely.clip_by_rect(section, -1.0, low, section.bounds[2] + 1.0, high).bounds
        return (make_ring(self.centre, float(most), float(least)),) if most > 0.0 else ()


class TwistedPrism(NamedTuple):
    """A prism whose outline rotates evenly about an upright axis with height, as helical teeth do; holes are straight.

    ``section`` is the region at ``low``; ``twist`` is the rotation of the outline at ``high`` against it, radians.
    """

    section: Region
    low: float
    high: float
    twist: float
    centre: complex

    @property
    def region(self) -> Region:
        """Shadow of the body: a disc with its holes."""
        outer = make_polygon(self.section.outer, beyond=False)
        return Region(Disc(self.centre, float(np.abs(outer - self.centre).max())), self.section.holes)

    @property
    def volume(self) -> float:
        """Volume, cubic millimetres: that of the prism."""
        return _measure_net_area(self.section) * (self.high - self.low)

    def cut_between(self, low: float, high: float) -> tuple[Region, ...]:
        """Return the section half-way between two heights."""
        # The twist grows linearly with height.
        turn = cmath.rect(1.0, self.twist * (0.5 * (low + high) - self.low) / (self.high - self.low))
        return (Region(rotate_outline(self.section.outer, turn, self.centre), self.section.holes),)


class TaperedBody(NamedTuple):
    """Intersection of a body of revolution with a cone of straight lines to an apex, such as bevel teeth.

    Holes are not tapered.

    Attributes
    ----------
    section : Region
        The cone's section at the height ``at``, a loop, with one hole around the axis, within the planes of both
        ends.
    profile : tuple of complex
        Six corners of the half section of the body of revolution, radius + i · height: on the axis, at the inner end of
        the teeth, at their outer end; then the same at the upper end, from there back to the axis.
    apex, at : float
        Heights; the body lies below the apex.
    teeth : int
        Number of repetitions of the same corners and edges around the loop.
    centre : complex
    """

    section: Region
    profile: tuple[complex, ...]
    apex: float
    at: float
    teeth: int
    centre: complex = 0j

    @property
    def low(self) -> float:
        """Height of the lowest point."""
        return min(z.imag for z in self.profile)

    @property
    def high(self) -> float:
        """Height of the highest point."""
        return max(z.imag for z in self.profile)

    @property
    def region(self) -> Region:
        """Shadow of the body: a disc with its holes."""
        return Region(Disc(self.centre, max(z.real for z in self.profile)), self.section.holes)

    @property
    def volume(self) -> float:
        """Volume: sections integrated between the corners of the profile by Gauss's rule, cubic millimetres."""
        places, weights = np.polynomial.legendre.leggauss(GAUSS_NODES)
        heights = np.unique([z.imag for z in self.profile])
        return math.fsum(
            0.5 * (high - low) * weight * self._take_section(0.5 * (low + high) + 0.5 * (high - low) * place).area
            for low, high in pairwise(heights.tolist())
            for place, weight in zip(places.tolist(), weights.tolist(), strict=True)
        )

    def find_ends(self, places: Complex) -> tuple[Complex, Complex]:
        """Return the intersections of lines to the apex with the lower and the upper end, as radius + i · height.

        Parameters
        ----------
        places : Complex
            Points of the outline in the plane ``at`` through which the lines run, shape (n,).
        """
        _, inner, outer, upper_outer, upper_inner, _ = self.profile
        # Slope of each line to the apex: radius per height.
        slope = np.abs(places - self.centre) / (self.at - self.apex)
        found = []
        for a, b in ((inner, outer), (upper_inner, upper_outer)):
            before, after = (z.real - slope * (z.imag - self.apex) for z in (a, b))
            # Intersection of the line with the edge of the half section.
            share = np.clip(before / (before - after), 0.0, 1.0)
            found.append(np.asarray(a + share * (b - a), np.complex128))
        return found[0], found[1]

    @property
    def mesh(self) -> Mesh:
        """Surface as triangles, arcs as polygons within :data:`DISPLAY_SAG`."""
        _, inner, *_, upper, _ = self.profile
        places = make_polygon(self.section.outer, beyond=False, sag=DISPLAY_SAG)
        turns = (places - self.centre) / np.abs(places - self.centre)
        (hole,) = self.section.holes
        bore = make_polygon(hole, beyond=False, sag=DISPLAY_SAG)
        low, high = self.find_ends(places)
        levels = (np.full(turns.shape, inner), low, high, np.full(turns.shape, upper))
        around = [np.column_stack(_to_columns(self.centre + z.real * turns, z.imag)) for z in levels]
        bores = [np.column_stack(_to_columns(bore, np.full(bore.shape, z.imag))) for z in (inner, upper)]
        count, holes = len(turns), len(bore)
        faces = [_make_band(k * count, (k + 1) * count, count) for k in range(3)]
        first = 4 * count
        faces += [_make_band(first, first + holes, holes)[:, ::-1]]
        angles = np.angle(turns), np.angle(bore - self.centre)
        faces += [
            _make_annulus(angles[0], 3 * count, angles[1], first + holes),
            _make_annulus(angles[0], 0, angles[1], first)[:, ::-1],
        ]
        return Mesh(np.concatenate([*around, *bores]), np.concatenate(faces))

    def scale(self, height: Real) -> Real:
        """Return the scale of the section at heights, shape (n,), relative to ``at``."""
        return (height - self.apex) / (self.at - self.apex)

    def cut_between(self, low: float, high: float) -> tuple[Region, ...]:
        """Return the section half-way between two heights."""
        faces = shapely.get_parts(self._take_section(0.5 * (low + high)))
        return tuple(_make_region(face) for face in faces if isinstance(face, shapely.Polygon))

    def _take_section(self, height: float) -> shapely.Geometry:
        outer = _make_polygon(self.section.outer, self.centre, float(self.scale(np.array(height))))
        half = shapely.Polygon([(z.real, z.imag) for z in self.profile])
        cut = shapely.intersection(half, shapely.LineString([(0.0, height), (2.0 * half.bounds[2], height)]))
        # Inner and outer radius of the body of revolution at that height.
        least, _, most, _ = cut.bounds if not cut.is_empty else (0.0,) * 4
        whole = shapely.intersection(outer, _make_polygon(Disc(self.centre, most), 0j, 1.0))
        inner = (Disc(self.centre, least),) if least > 0.0 else ()
        holes = [_make_polygon(hole, 0j, 1.0) for hole in (*inner, *self.section.holes)]
        return shapely.difference(whole, shapely.union_all(holes))


@dataclass(frozen=True, eq=False)
class Mesh:
    """A body by its surface: triangles, corners counter-clockwise as seen from outside.

    Attributes
    ----------
    corners : Real
        Shape (n, 3): x, y and height, millimetres.
    triangles : NDArray[np.int64]
        Shape (m, 3): indices of corners; every edge belongs to two triangles, once in each direction.
    """

    corners: Real
    triangles: NDArray[np.int64]

    @property
    def low(self) -> float:
        """Height of the lowest point."""
        return float(self.corners[:, 2].min())

    @property
    def high(self) -> float:
        """Height of the highest point."""
        return float(self.corners[:, 2].max())

    @cached_property
    def region(self) -> Region:
        """Convex hull of the shadow."""
        points = shapely.convex_hull(shapely.MultiPoint(self.corners[:, :2]))
        around = find_hull([complex(x, y) for x, y in shapely.get_coordinates(points)])
        return Region(Loop(tuple(around), (0.0,) * len(around)))

    @property
    def volume(self) -> float:
        """Volume by the divergence theorem, cubic millimetres."""
        a, b, c = (self.corners[self.triangles[:, k]] for k in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)

    def cut_between(self, low: float, high: float) -> tuple[Region, ...]:
        """Return the section half-way between two heights."""
        heights = np.unique(self.corners[:, 2])
        at = 0.5 * (low + high)
        # A corner in the plane would make the section ambiguous: move the plane to between that height and the next.
        if (heights == at).any():  # no corner may lie in the plane
            at = 0.5 * (at + float(heights[heights > at].min(initial=high)))
        above = self.corners[:, 2] > at
        cut = self.triangles[above[self.triangles].any(axis=1) & ~above[self.triangles].all(axis=1)]
        ends = []
        for one, other in ((0, 1), (1, 2), (2, 0)):
            # Cut each edge with its corners in one order, so that both its triangles get the identical point.
            edge = np.sort(cut[:, [one, other]], axis=1)
            a, b = self.corners[edge[:, 0]], self.corners[edge[:, 1]]
            # Two of the three edges of a cut triangle cross the plane.
            crossed = above[edge[:, 0]] != above[edge[:, 1]]
            share = (at - a[:, 2]) / np.where(crossed, b[:, 2] - a[:, 2], np.inf)
            ends.append(np.where(crossed[:, None], a[:, :2] + share[:, None] * (b[:, :2] - a[:, :2]), np.nan))
        found = np.stack(ends, axis=1)
        lines = found[~np.isnan(found[:, :, 0])].reshape(-1, 2, 2)
        faces = shapely.get_parts(shapely.build_area(shapely.multilinestrings(lines)))
        return tuple(_make_region(face) for face in faces)


Body = Prism | RevolvedBody | TwistedPrism | TaperedBody | CutBody | Mesh


def divide_heights(first: Body, second: Body, rounding: float) -> list[tuple[float, float]]:
    """Return the height intervals in which two bodies are compared; an empty list if they share no height."""
    low, high = max(first.low, second.low), min(first.high, second.high)
    if high - low <= rounding:
        return []
    # Prisms have the same section at every height.
    count = 1 if isinstance(first, Prism) and isinstance(second, Prism) else SLICE_COUNT
    return list(pairwise(np.linspace(low, high, count + 1).tolist()))


def _to_columns(places: Complex, heights: Real) -> tuple[Real, Real, Real]:
    return places.real, places.imag, heights


def _make_band(lower: int, upper: int, count: int) -> NDArray[np.int64]:
    """Return triangles between two rings of ``count`` points, facing outwards if the rings are counter-clockwise."""
    at = np.arange(count)
    ahead = (at + 1) % count
    return np.concatenate([
        np.column_stack([lower + at, lower + ahead, upper + ahead]),
        np.column_stack([lower + at, upper + ahead, upper + at]),
    ])  # fmt: skip


def _make_annulus(outer: Real, first: int, inner: Real, second: int) -> NDArray[np.int64]:
    """Return triangles between two rings about one point by their points' angles, counter-clockwise from above."""
    angles, numbers = [], []
    for ring_angles, start in ((outer, first), (inner, second)):
        least = int(np.argmin(ring_angles % (2.0 * math.pi)))
        angles.append(np.roll(ring_angles % (2.0 * math.pi), -least))
        numbers.append(start + np.roll(np.arange(len(ring_angles)), -least))
    found, at = [], [0, 0]
    # Advance on the ring whose next point has the smaller angle.
    while at[0] < len(angles[0]) or at[1] < len(angles[1]):
        here = [int(numbers[k][at[k] % len(numbers[k])]) for k in (0, 1)]
        ahead = [float(angles[k][at[k] + 1]) if at[k] + 1 < len(angles[k])
                 else angles[k][0] + 2.0 * math.pi if at[k] < len(angles[k]) else math.inf for k in (0, 1)]  # fmt: skip
        step = 0 if ahead[0] <= ahead[1] else 1
        next_ = int(numbers[step][(at[step] + 1) % len(numbers[step])])
        found.append((here[0], next_, here[1]))
        at[step] += 1
    return np.array(found)


def _make_polygon(outline: Outline, about: complex, scale: float) -> shapely.Polygon:
    """Return an outline scaled about a point as a polygon within :data:`SECTION_SAG`."""
    places = about + scale * (make_polygon(outline, beyond=False, sag=SECTION_SAG) - about)
    return shapely.Polygon(np.column_stack([places.real, places.imag]))


def _measure_net_area(region: Region) -> float:
    return measure_area(region.outer) - math.fsum(measure_area(hole) for hole in region.holes)


def _make_region(face: shapely.Polygon) -> Region:
    outer, *holes = (_make_loop(ring_) for ring_ in (face.exterior, *face.interiors))
    return Region(outer, tuple(holes))


def _make_loop(line: shapely.LinearRing) -> Outline:
    places = shapely.get_coordinates(line)[:-1]
    if not shapely.is_ccw(line):
        places = places[::-1]
    return Loop(tuple(complex(x, y) for x, y in places), (0.0,) * len(places))
