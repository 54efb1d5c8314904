"""Interference of the parts of an assembly, and minimum walls of plates around their holes.

This module knows only the parts, not the planes assigned to them. It moves every part, takes all pairs of bodies with
common heights, and intersects their cross sections there (:mod:`service.parts.geometry.solids`) as polygons. Polygons
of solids are circumscribed about their arcs, those of holes inscribed, so that prisms found free of interference are
truly free at the inputs examined. Rings about a common axis that move together are compared by their radii.

Parts with non-parallel axes move in planes of different frames: :mod:`service.parts.assembly.interference_crossed_axes`
compares them.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from service.parts.assembly.interference_crossed_axes import CrossingCheck
from service.parts.assembly.model import SHEET_SORTS, Assembly, Carrier, Part
from service.parts.geometry.regions import Disc, Outline, Region, make_polygon
from service.parts.geometry.solids import divide_heights

CHECK_COUNT = 144
"""Number of inputs at which parts are compared."""

CROSSING_STRIDE = 3
"""Stride of the inputs at which parts with crossing axes are compared; that comparison is the slowest."""

ROUNDING_SHARE = 1e-9
"""Maximum apparent overlap of touching faces due to rounding, as a share of the assembly's size."""

MAX_SAG = 5e-3
"""Maximum distance of polygons from arcs, millimetres; less than the clearances of large bores."""

TOUCH_DEPTH = 2e-3
"""Apparent penetration of touching parts, such as a roller and its cam, that is tolerated, millimetres."""

TOUCH_DEPTH_SHARE = 2e-5
"""The same as a share of the assembly's size; the larger of both applies."""


class Overlap(NamedTuple):
    """Two interfering parts, and the input at which their overlap is largest.

    The area is that shared by sections of the two, or that of surfaces inside each other if their axes cross.
    """

    parts: tuple[str, str]
    at: float
    area: float


class ThinWall(NamedTuple):
    """A plate with a wall below the minimum, and its thickness."""

    part: str
    left: float


def find_overlaps(assembly: Assembly, count: int = CHECK_COUNT, *, across: bool = True) -> list[Overlap]:
    """Find the pairs of parts that interfere at some of ``count`` inputs of the motion.

    Parameters
    ----------
    assembly : Assembly
    count : int
        Number of inputs, spread over the whole motion.
    across : bool
        Whether to compare parts with non-parallel axes, which takes longest.
    """
    inputs = assembly.motion.sample_inputs(count)
    size = assembly.size
    moved = _MovedRegions(assembly, inputs)
    crossed = np.arange(0, count, CROSSING_STRIDE)
    crossing = CrossingCheck(assembly, inputs[crossed])
    found = []
    for one, other in combinations(assembly.parts, 2):
        most = np.zeros(count)
        if not moved.is_same_frame(one.carrier, other.carrier):
            if not across:
                continue
            shared = crossing.estimate_overlap(one, other)
            most[crossed] = shared
            if shared.max() > 0.0:
                worst = int(np.argmax(most))
                found.append(Overlap((one.name, other.name), float(inputs[worst]), float(most[worst])))
            continue
        for first, second in _iterate_sections(one, other, ROUNDING_SHARE * size):
            if one.carrier == other.carrier and _is_concentric(first, second):
                most = np.maximum(most, _measure_ring_overlap(first, second, ROUNDING_SHARE * size))
            else:
                touch = frozenset((one.name, other.name)) in assembly.touching
                most = np.maximum(
                    most, moved.measure_overlap((one.carrier, first), (other.carrier, second), touch=touch)
                )
        worst = int(np.argmax(most))
        # Touching faces overlap by rounding errors only.
        if most[worst] > (ROUNDING_SHARE * size) ** 2:
            found.append(Overlap((one.name, other.name), float(inputs[worst]), float(most[worst])))
    return found


def find_thin_walls(assembly: Assembly, wall: float) -> list[ThinWall]:
    """Find plates with a wall thinner than ``wall`` between a hole and the edge or another hole."""
    found = []
    for part in assembly.parts:
        if part.sort not in SHEET_SORTS:
            continue
        # Bosses of a base are rings around its holes; for a one-piece cam every wall is checked.
        for region in (body.region for body in (part.bodies if part.sort == "cam" else part.bodies[:1])):
            holes = [shapely.Polygon(_to_pairs(make_polygon(hole, beyond=True))) for hole in region.holes]
            edge = shapely.LinearRing(_to_pairs(make_polygon(region.outer, beyond=False)))
            inside = shapely.Polygon(edge)
            left = [edge.distance(hole) if inside.contains(hole) else 0.0 for hole in holes]
            # Walls between holes count like walls to the edge.
            left += [one.distance(other) for one, other in combinations(holes, 2)]
            if left and min(left) < wall:
                found.append(ThinWall(part.name, min(left)))
    return found


def _iterate_sections(one: Part, other: Part, rounding: float) -> Iterator[tuple[Region, Region]]:
    """Yield the cross sections of two parts at common heights."""
    # No common height: no interference.
    if min(one.high, other.high) - max(one.low, other.low) <= rounding:
        return
    for first, second in product(one.bodies, other.bodies):
        for low, high in divide_heights(first, second, rounding):
            yield from product(first.cut_between(low, high), second.cut_between(low, high))


def _is_concentric(first: Region, second: Region) -> bool:
    outlines = (first.outer, *first.holes, second.outer, *second.holes)
    discs = [outline.centre for outline in outlines if isinstance(outline, Disc)]
    return len(discs) == len(outlines) and all(centre == discs[0] for centre in discs)


def _measure_ring_overlap(first: Region, second: Region, rounding: float) -> float:
    """Return the common area of two concentric rings, from their radii."""
    (low, high), (inner, outer) = _get_radii(first), _get_radii(second)
    least, most = max(low, inner), min(high, outer)
    return float(np.pi * (most**2 - least**2)) if most - least > rounding else 0.0


def _get_radii(region: Region) -> tuple[float, float]:
    assert isinstance(region.outer, Disc)
    inner = [hole.radius for hole in region.holes if isinstance(hole, Disc)]
    return max(inner, default=0.0), region.outer.radius


ALL_INPUTS = slice(None)

Carried = tuple[Carrier, Region]
"""A region and its carrier."""


class _MovedRegions:
    """The regions of an assembly at all inputs, each computed once."""

    def __init__(self, assembly: Assembly, inputs: NDArray[np.float64]) -> None:
        state = assembly.motion.compute_state(inputs)
        carriers = {part.carrier for part in assembly.parts}
        self._placed = {carrier: assembly.motion.compute_placement(carrier, state) for carrier in carriers}
        self._touch = max(TOUCH_DEPTH, TOUCH_DEPTH_SHARE * assembly.size)
        self._boxes: dict[Carried, NDArray[np.float64]] = {}
        self._polygons: dict[tuple[Carried, bool, bool], NDArray[np.object_]] = {}

    def is_same_frame(self, one: Carrier, other: Carrier) -> bool:
        """Return whether the parts of two carriers move in parallel planes."""
        return self._placed[one].frame is self._placed[other].frame

    def measure_overlap(self, first: Carried, second: Carried, *, touch: bool) -> NDArray[np.float64]:
        """Return the common area of two regions at each input; for touching parts only that beyond the tolerance."""
        a, b = self._get_box(first), self._get_box(second)
        # Bounding boxes reject most inputs cheaply.
        near = np.asarray(np.concatenate([a[:, :2] < b[:, 2:], b[:, :2] < a[:, 2:]], axis=1).all(axis=1))
        still = first[0] == second[0]
        if still:
            # They are at rest relative to each other: one input suffices.
            near[1:] = False
        areas = np.zeros(len(near))
        if near.any():
            one, other = (
                self._get_solid(carried, beyond=not touch, still=still)[near[:1] if still else near]
                for carried in (first, second)
            )
            if touch:
                # Shrink one of two touching parts by the permitted penetration.
                one = shapely.buffer(one, -self._touch)
            # Most pairs do not intersect, and that test is faster than the intersection.
            meets = shapely.intersects(one, other)
            areas[np.flatnonzero(near)[meets]] = shapely.area(shapely.intersection(one[meets], other[meets]))
        return areas

    def _move_outline(
        self, carried: Carried, outline: Outline, *, beyond: bool, still: bool = False
    ) -> NDArray[np.float64]:
        """Return an outline at each input, shape (n, m, 2), or only at the first."""
        return self._move_points(
            carried[0], make_polygon(outline, beyond=beyond, sag=MAX_SAG), slice(1 if still else None)
        )

    def _move_points(
        self, carrier: Carrier, places: NDArray[np.complex128], some: slice = ALL_INPUTS
    ) -> NDArray[np.float64]:
        """Return points of a plane at some of the inputs, shape (n, m, 2)."""
        placed = self._placed[carrier]
        moved = placed.turn[some, None] * places + placed.shift[some, None]
        return np.stack([moved.real, moved.imag], axis=-1)

    def _get_box(self, carried: Carried) -> NDArray[np.float64]:
        """Return left, low, right and high of a region at each input, shape (n, 4)."""
        if carried not in self._boxes:
            outer = self._move_points(carried[0], _find_hull(make_polygon(carried[1].outer, beyond=True, sag=MAX_SAG)))
            self._boxes[carried] = np.concatenate([outer.min(axis=1), outer.max(axis=1)], axis=1)
        return self._boxes[carried]

    def _get_solid(self, carried: Carried, *, beyond: bool, still: bool) -> NDArray[np.object_]:
        """Return a region as a polygon at each input, or only at the first; circumscribed (``beyond``) or inscribed."""
        key = carried, beyond, still
        if key not in self._polygons:
            region = carried[1]
            holes = [
                shapely.linearrings(self._move_outline(carried, hole, beyond=not beyond, still=still))
                for hole in region.holes
            ]
            outer = shapely.linearrings(self._move_outline(carried, region.outer, beyond=beyond, still=still))
            solid = shapely.polygons(outer, holes=np.stack(holes, axis=1)) if holes else shapely.polygons(outer)
            self._polygons[key] = solid
        return self._polygons[key]


def _find_hull(ring: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Return the corners of a polygon's convex hull, the only ones that can be extreme."""
    return np.asarray(shapely.get_coordinates(shapely.convex_hull(shapely.MultiPoint(_to_pairs(ring)))) @ (1.0, 1j))


def _to_pairs(points: NDArray[np.complex128]) -> NDArray[np.float64]:
    return np.column_stack([points.real, points.imag])
