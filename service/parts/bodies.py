"""What parts are made of: prisms, bodies of revolution, twisted prisms and meshes, each upright along its own axis.

Every body says what it encloses, from which height to which it reaches, its *shadow* (the region that it covers, seen
along the axis), and what of the plane it takes between two heights. The last is what two parts are compared by:

* of a prism its region, which is exact;
* of a body of revolution the ring of its widest and its narrowest radius there, which is never too little;
* of a twisted prism and of a mesh the section half-way between, which is exact at that height. The heights are taken in
  :data:`SLICES` steps, and teeth that are twisted against each other look at one height as they do at another a little
  later.
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

from service.parts.shapes import Disc, Loop, Outline, Region, area, hull, ring, ring_of, turned

Real = NDArray[np.float64]

SLICES = 5
"""Steps in which two bodies are compared along the height that they share, where one of them is no prism."""


class Prism(NamedTuple):
    """A region from one height to another."""

    region: Region
    low: float
    high: float

    @property
    def volume(self) -> float:
        """Cubic millimetres."""
        return _net(self.region) * (self.high - self.low)

    def within(self, low: float, high: float) -> tuple[Region, ...]:
        """What of the plane it takes between two heights."""
        return (self.region,)


class Turned(NamedTuple):
    """A body of revolution about an upright axis.

    ``profile`` are the corners of its half section, counter-clockwise: radius + i · height, no radius below 0.
    """

    profile: tuple[complex, ...]
    centre: complex = 0j

    @property
    def low(self) -> float:
        """Height of its lowest point."""
        return min(z.imag for z in self.profile)

    @property
    def high(self) -> float:
        """Height of its uppermost point."""
        return max(z.imag for z in self.profile)

    @property
    def region(self) -> Region:
        """Its shadow."""
        return self.within(self.low, self.high)[0]

    @property
    def volume(self) -> float:
        """∮ π r² dz along the half section, cubic millimetres."""
        around = pairwise((*self.profile, self.profile[0]))
        return math.fsum(
            math.pi / 3.0 * (a.real**2 + a.real * b.real + b.real**2) * (b.imag - a.imag) for a, b in around
        )

    def within(self, low: float, high: float) -> tuple[Region, ...]:
        """The ring of its radii between two heights; none where it is not there."""
        section = shapely.Polygon([(z.real, z.imag) for z in self.profile])
        least, _, most, _ = shapely.clip_by_rect(section, -1.0, low, section.bounds[2] + 1.0, high).bounds
        return (ring(self.centre, float(most), float(least)),) if most > 0.0 else ()


class Twisted(NamedTuple):
    """A prism whose outline turns evenly about an upright axis as it goes up, as helical teeth do; holes go straight.

    ``section`` is the region at ``low``, ``twist`` how far the outline at ``high`` is turned against it, radians.
    """

    section: Region
    low: float
    high: float
    twist: float
    centre: complex

    @property
    def region(self) -> Region:
        """Its shadow: a disc with its holes."""
        outer = ring_of(self.section.outer, beyond=False)
        return Region(Disc(self.centre, float(np.abs(outer - self.centre).max())), self.section.holes)

    @property
    def volume(self) -> float:
        """Cubic millimetres: that of the prism."""
        return _net(self.section) * (self.high - self.low)

    def within(self, low: float, high: float) -> tuple[Region, ...]:
        """Its section half-way between two heights."""
        turn = cmath.rect(1.0, self.twist * (0.5 * (low + high) - self.low) / (self.high - self.low))
        return (Region(turned(self.section.outer, turn, self.centre), self.section.holes),)


@dataclass(frozen=True, eq=False)
class Mesh:
    """A body by its surface: triangles, their corners counter-clockwise as seen from outside.

    Attributes
    ----------
    corners : Real
        Shape (n, 3): x, y and height, millimetres.
    triangles : NDArray[np.int64]
        Shape (m, 3): numbers of corners; every edge is in two triangles, once in each direction.
    """

    corners: Real
    triangles: NDArray[np.int64]

    @property
    def low(self) -> float:
        """Height of its lowest point."""
        return float(self.corners[:, 2].min())

    @property
    def high(self) -> float:
        """Height of its uppermost point."""
        return float(self.corners[:, 2].max())

    @cached_property
    def region(self) -> Region:
        """The hull of its shadow."""
        points = shapely.convex_hull(shapely.MultiPoint(self.corners[:, :2]))
        around = hull([complex(x, y) for x, y in shapely.get_coordinates(points)])
        return Region(Loop(tuple(around), (0.0,) * len(around)))

    @property
    def volume(self) -> float:
        """By the divergence theorem, cubic millimetres."""
        a, b, c = (self.corners[self.triangles[:, k]] for k in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)

    def within(self, low: float, high: float) -> tuple[Region, ...]:
        """Its section half-way between two heights."""
        heights = np.unique(self.corners[:, 2])
        at = 0.5 * (low + high)
        if (heights == at).any():  # no corner may lie in the plane
            at = 0.5 * (at + float(heights[heights > at].min(initial=high)))
        above = self.corners[:, 2] > at
        cut = self.triangles[above[self.triangles].any(axis=1) & ~above[self.triangles].all(axis=1)]
        ends = []
        for one, other in ((0, 1), (1, 2), (2, 0)):
            # Each edge is cut in one order of its corners, so that two triangles have one point of it.
            edge = np.sort(cut[:, [one, other]], axis=1)
            a, b = self.corners[edge[:, 0]], self.corners[edge[:, 1]]
            crossed = above[edge[:, 0]] != above[edge[:, 1]]
            share = (at - a[:, 2]) / np.where(crossed, b[:, 2] - a[:, 2], np.inf)
            ends.append(np.where(crossed[:, None], a[:, :2] + share[:, None] * (b[:, :2] - a[:, :2]), np.nan))
        found = np.stack(ends, axis=1)
        lines = found[~np.isnan(found[:, :, 0])].reshape(-1, 2, 2)
        faces = shapely.get_parts(shapely.build_area(shapely.multilinestrings(lines)))
        return tuple(_region_of(face) for face in faces)


Body = Prism | Turned | Twisted | Mesh


def slices(first: Body, second: Body, rounding: float) -> list[tuple[float, float]]:
    """The heights between which two bodies are compared; none where they share no more height than rounding."""
    low, high = max(first.low, second.low), min(first.high, second.high)
    if high - low <= rounding:
        return []
    count = 1 if isinstance(first, Prism) and isinstance(second, Prism) else SLICES
    return list(pairwise(np.linspace(low, high, count + 1).tolist()))


def _net(region: Region) -> float:
    return area(region.outer) - math.fsum(area(hole) for hole in region.holes)


def _region_of(face: shapely.Polygon) -> Region:
    outer, *holes = (_loop(ring_) for ring_ in (face.exterior, *face.interiors))
    return Region(outer, tuple(holes))


def _loop(line: shapely.LinearRing) -> Outline:
    places = shapely.get_coordinates(line)[:-1]
    if not shapely.is_ccw(line):
        places = places[::-1]
    return Loop(tuple(complex(x, y) for x, y in places), (0.0,) * len(places))
