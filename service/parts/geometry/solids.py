"""Solids of parts, each upright along its axis: prisms, twisted prisms, cones and meshes.

Bodies of revolution with cuts are in :mod:`service.parts.geometry.cut_solids`.

Every body has a volume, a lowest and a highest point, its *shadow* (the region that it covers, seen along the axis),
a closed mesh, and a cross section between two heights. Two parts on parallel axes are compared by the latter: for a
prism it is the region, for all others the section half-way between. The heights are divided into :data:`SLICE_COUNT`
steps. Few are sufficient for teeth that are twisted against each other, because in the course of the motion every
height shows the same relative positions.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from service.parts.geometry.cut_solids import CutBody
from service.parts.geometry.meshed_body import MeshedBody
from service.parts.geometry.meshes import extrude, join_triangles, revolve
from service.parts.geometry.regions import (
    Disc,
    Loop,
    Region,
    make_polygon,
    measure_area,
    move_outline,
)

if TYPE_CHECKING:
    from manifold3d import Manifold

SLICE_COUNT = 5
"""Number of height steps in which two bodies are compared unless both are prisms."""

HOLE_OVERHANG = 1.0
"""Extension of the tool of a hole beyond both ends of a body, millimetres."""

TIP_OVERHANG = 0.1
"""Extension of the ends of tapered teeth beyond their tips, as a share of the length of the ends."""


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

    def make_mesh(self, sag: float) -> Manifold:
        """Return the mesh within a sag of the body."""
        return extrude(self.region, self.low, self.high, sag)


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
        return (Region(move_outline(self.section.outer, turn, self.centre - turn * self.centre), self.section.holes),)

    def make_mesh(self, sag: float) -> Manifold:
        """Return the mesh within a sag of the body, apart from the facets of its twisted walls."""
        outer = move_outline(self.section.outer, 1.0 + 0j, -self.centre)
        made = extrude(Region(outer), self.low, self.high, sag, twist=self.twist)
        return _drill(made.translate((self.centre.real, self.centre.imag, 0.0)), self, self.section, sag)


@dataclass(frozen=True, eq=False)
class TaperedBody(MeshedBody):
    """Intersection of a body of revolution with a cone of straight lines to an apex, such as bevel teeth.

    Both have their axis at the origin. Holes are not tapered.

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
    """

    section: Region
    profile: tuple[complex, ...]
    apex: float
    at: float
    teeth: int

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
        return Region(Disc(0j, max(z.real for z in self.profile)), self.section.holes)

    def find_ends(self, places: Complex) -> tuple[Complex, Complex]:
        """Return the intersections of lines to the apex with the lower and the upper end, as radius + i · height.

        Parameters
        ----------
        places : Complex
            Points of the outline in the plane ``at`` through which the lines run, shape (n,).
        """
        _, inner, outer, upper_outer, upper_inner, _ = self.profile
        # Slope of each line to the apex: radius per height.
        slope = np.abs(places) / (self.at - self.apex)
        found = []
        for a, b in ((inner, outer), (upper_inner, upper_outer)):
            before, after = (z.real - slope * (z.imag - self.apex) for z in (a, b))
            # Intersection of the line with the edge of the half section.
            share = np.clip(before / (before - after), 0.0, 1.0)
            found.append(np.asarray(a + share * (b - a), np.complex128))
        return found[0], found[1]

    def scale(self, height: Real) -> Real:
        """Return the scale of the section at heights relative to ``at``."""
        return (height - self.apex) / (self.at - self.apex)

    def make_mesh(self, sag: float) -> Manifold:
        """Return the mesh within a sag of the body."""
        low, high = self.scale(np.array([self.low, self.high])).tolist()
        cone = Region(move_outline(self.section.outer, low))
        made = extrude(cone, self.low, self.high, sag, top=high / low)
        axis, inner, outer, upper_outer, upper_inner, upper_axis = self.profile
        # Extend both ends beyond the tips, so that no other face of the body of revolution lies in one of the cone's.
        ends = (z + TIP_OVERHANG * (z - root) for z, root in ((outer, inner), (upper_outer, upper_inner)))
        turned = revolve(Loop((axis, inner, *ends, upper_inner, upper_axis), (0.0,) * 6), sag)
        return _drill(made ^ turned, self, self.section, sag)


@dataclass(frozen=True, eq=False)
class Mesh(MeshedBody):
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

    def make_mesh(self, sag: float) -> Manifold:
        """Return the mesh."""
        return join_triangles(self.corners, self.triangles)


Body = Prism | TwistedPrism | TaperedBody | CutBody | Mesh


def divide_heights(first: Body, second: Body, rounding: float) -> list[tuple[float, float]]:
    """Return the height intervals in which two bodies are compared; an empty list if they share no height."""
    low, high = max(first.low, second.low), min(first.high, second.high)
    if high - low <= rounding:
        return []
    # Prisms have the same section at every height.
    count = 1 if isinstance(first, Prism) and isinstance(second, Prism) else SLICE_COUNT
    return list(pairwise(np.linspace(low, high, count + 1).tolist()))


def _drill(made: Manifold, body: TwistedPrism | TaperedBody, section: Region, sag: float) -> Manifold:
    """Return a mesh with the straight holes of its section."""
    for hole in section.holes:
        low, high = body.low - HOLE_OVERHANG, body.high + HOLE_OVERHANG
        made -= extrude(Region(hole), low, high, sag, beyond=True)
    return made


def _measure_net_area(region: Region) -> float:
    return measure_area(region.outer) - math.fsum(measure_area(hole) for hole in region.holes)
