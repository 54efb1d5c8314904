"""Whether the parts of an assembly want one place at once, and whether enough is left of the plates around their holes.

This knows the parts alone, not the planes that were found for them: it moves every part, takes all pairs of bodies that
share some height, and intersects what they take of the plane there (:mod:`service.parts.bodies`) as polygons. A polygon
of what is solid lies outside of its arcs, one of a hole inside, so that prisms that are free of overlaps here are so in
truth at the inputs looked at. Rings about one axis that go together are compared by their radii.

Parts whose axes are not parallel move in planes of different frames: :mod:`service.parts.crossing` compares them.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from service.parts.bodies import slices
from service.parts.crossing import Crossing
from service.parts.model import FLAT, Assembly, Carrier, Part
from service.parts.shapes import Disc, Outline, Region, ring_of

POSITIONS = 144
"""Inputs at which parts are looked at."""

CROSSED = 3
"""Every so many inputs parts of crossing axes are looked at."""

ROUNDING = 1e-9
"""Share of the assembly's size by which faces that touch may seem to overlap."""

SAG = 5e-3
"""How far polygons are from the arcs that they stand for, millimetres: less than the clearances of large bores."""

TOUCH = 2e-3
"""How deep two parts may seem to be in each other that touch, such as a roller and its cam, millimetres."""

TOUCH_SHARE = 2e-5
"""The same as a share of the assembly's size, where that is more."""


class Overlap(NamedTuple):
    """Two parts that want one place, and the input at which they want the most of it.

    The area is what sections of the two share, or what of their surfaces lies in each other where their axes cross.
    """

    parts: tuple[str, str]
    at: float
    area: float


class Thin(NamedTuple):
    """A place of a plate at which less is left than must be, and how much is."""

    part: str
    left: float


def overlaps(assembly: Assembly, count: int = POSITIONS, *, across: bool = True) -> list[Overlap]:
    """The pairs of parts that overlap at some of ``count`` inputs of the motion.

    Parameters
    ----------
    assembly : Assembly
    count : int
        Inputs, spread over the whole motion.
    across : bool
        Whether parts are compared whose axes are not parallel, which takes the longest.
    """
    inputs = assembly.motion.inputs(count)
    size = assembly.size
    moved = _Moved(assembly, inputs)
    crossed = np.arange(0, count, CROSSED)
    crossing = Crossing(assembly, inputs[crossed])
    found = []
    for one, other in combinations(assembly.parts, 2):
        most = np.zeros(count)
        if not moved.in_one_frame(one.carrier, other.carrier):
            if not across:
                continue
            shared = crossing.shared(one, other)
            most[crossed] = shared
            if shared.max() > 0.0:
                worst = int(np.argmax(most))
                found.append(Overlap((one.name, other.name), float(inputs[worst]), float(most[worst])))
            continue
        for first, second in _meeting(one, other, ROUNDING * size):
            if one.carrier == other.carrier and _about_one_axis(first, second):
                most = np.maximum(most, _on_one_pin(first, second, ROUNDING * size))
            else:
                touch = frozenset((one.name, other.name)) in assembly.touching
                most = np.maximum(most, moved.shared((one.carrier, first), (other.carrier, second), touch=touch))
        worst = int(np.argmax(most))
        if most[worst] > (ROUNDING * size) ** 2:
            found.append(Overlap((one.name, other.name), float(inputs[worst]), float(most[worst])))
    return found


def too_thin(assembly: Assembly, wall: float) -> list[Thin]:
    """Plates of which less than ``wall`` is left between a hole and the edge or another hole."""
    found = []
    for part in assembly.parts:
        if part.sort not in FLAT:
            continue
        # Bosses of a base are rings about their holes; of a cam in one piece each wall is looked at.
        for region in (body.region for body in (part.bodies if part.sort == "cam" else part.bodies[:1])):
            holes = [shapely.Polygon(_pairs(ring_of(hole, beyond=True))) for hole in region.holes]
            edge = shapely.LinearRing(_pairs(ring_of(region.outer, beyond=False)))
            inside = shapely.Polygon(edge)
            left = [edge.distance(hole) if inside.contains(hole) else 0.0 for hole in holes]
            left += [one.distance(other) for one, other in combinations(holes, 2)]
            if left and min(left) < wall:
                found.append(Thin(part.name, min(left)))
    return found


def _meeting(one: Part, other: Part, rounding: float) -> Iterator[tuple[Region, Region]]:
    """Regions that bodies of two parts take between the same heights."""
    if min(one.high, other.high) - max(one.low, other.low) <= rounding:
        return
    for first, second in product(one.bodies, other.bodies):
        for low, high in slices(first, second, rounding):
            yield from product(first.within(low, high), second.within(low, high))


def _about_one_axis(first: Region, second: Region) -> bool:
    outlines = (first.outer, *first.holes, second.outer, *second.holes)
    discs = [outline.centre for outline in outlines if isinstance(outline, Disc)]
    return len(discs) == len(outlines) and all(centre == discs[0] for centre in discs)


def _on_one_pin(first: Region, second: Region, rounding: float) -> float:
    """The area that two rings about one centre share, by their radii."""
    (low, high), (inner, outer) = _radii(first), _radii(second)
    least, most = max(low, inner), min(high, outer)
    return float(np.pi * (most**2 - least**2)) if most - least > rounding else 0.0


def _radii(region: Region) -> tuple[float, float]:
    assert isinstance(region.outer, Disc)
    inner = [hole.radius for hole in region.holes if isinstance(hole, Disc)]
    return max(inner, default=0.0), region.outer.radius


ALL = slice(None)

Carried = tuple[Carrier, Region]
"""A region and what it moves with."""


class _Moved:
    """The regions of an assembly at all inputs, each made once."""

    def __init__(self, assembly: Assembly, inputs: NDArray[np.float64]) -> None:
        state = assembly.motion.at(inputs)
        carriers = {part.carrier for part in assembly.parts}
        self._placed = {carrier: assembly.motion.placed(carrier, state) for carrier in carriers}
        self._touch = max(TOUCH, TOUCH_SHARE * assembly.size)
        self._boxes: dict[Carried, NDArray[np.float64]] = {}
        self._polygons: dict[tuple[Carried, bool, bool], NDArray[np.object_]] = {}

    def in_one_frame(self, one: Carrier, other: Carrier) -> bool:
        """Whether what two carriers carry moves in parallel planes."""
        return self._placed[one].frame is self._placed[other].frame

    def shared(self, first: Carried, second: Carried, *, touch: bool) -> NDArray[np.float64]:
        """The area that two regions share at each input, of those that touch each other what is beyond rounding."""
        a, b = self._box(first), self._box(second)
        near = np.asarray(np.concatenate([a[:, :2] < b[:, 2:], b[:, :2] < a[:, 2:]], axis=1).all(axis=1))
        still = first[0] == second[0]
        if still:
            # They do not move against each other.
            near[1:] = False
        areas = np.zeros(len(near))
        if near.any():
            one, other = (
                self._solid(carried, beyond=not touch, still=still)[near[:1] if still else near]
                for carried in (first, second)
            )
            if touch:
                one = shapely.buffer(one, -self._touch)
            # Most do not meet, which is seen sooner than what they share.
            meets = shapely.intersects(one, other)
            areas[np.flatnonzero(near)[meets]] = shapely.area(shapely.intersection(one[meets], other[meets]))
        return areas

    def _ring(self, carried: Carried, outline: Outline, *, beyond: bool, still: bool = False) -> NDArray[np.float64]:
        """An outline at each input, shape (n, m, 2), or at the first alone."""
        return self._turned(carried[0], ring_of(outline, beyond=beyond, sag=SAG), slice(1 if still else None))

    def _turned(self, carrier: Carrier, places: NDArray[np.complex128], some: slice = ALL) -> NDArray[np.float64]:
        """Places of a plane at some of the inputs, shape (n, m, 2)."""
        placed = self._placed[carrier]
        moved = placed.turn[some, None] * places + placed.shift[some, None]
        return np.stack([moved.real, moved.imag], axis=-1)

    def _box(self, carried: Carried) -> NDArray[np.float64]:
        """Left, low, right and high of a region at each input, shape (n, 4)."""
        if carried not in self._boxes:
            outer = self._turned(carried[0], _hull(ring_of(carried[1].outer, beyond=True, sag=SAG)))
            self._boxes[carried] = np.concatenate([outer.min(axis=1), outer.max(axis=1)], axis=1)
        return self._boxes[carried]

    def _solid(self, carried: Carried, *, beyond: bool, still: bool) -> NDArray[np.object_]:
        """A region as a polygon at each input, or at the first alone; outside of it (``beyond``), or inside."""
        key = carried, beyond, still
        if key not in self._polygons:
            region = carried[1]
            holes = [
                shapely.linearrings(self._ring(carried, hole, beyond=not beyond, still=still)) for hole in region.holes
            ]
            outer = shapely.linearrings(self._ring(carried, region.outer, beyond=beyond, still=still))
            solid = shapely.polygons(outer, holes=np.stack(holes, axis=1)) if holes else shapely.polygons(outer)
            self._polygons[key] = solid
        return self._polygons[key]


def _hull(ring: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """The corners of a polygon that can be the outermost in some direction."""
    return np.asarray(shapely.get_coordinates(shapely.convex_hull(shapely.MultiPoint(_pairs(ring)))) @ (1.0, 1j))


def _pairs(points: NDArray[np.complex128]) -> NDArray[np.float64]:
    return np.column_stack([points.real, points.imag])
