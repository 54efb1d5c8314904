"""Mass properties of links from their shapes: widened hulls, polygons, prisms and cylinders.

A :class:`Section` is an area with its first moment and its polar second moment about the origin. These add and
subtract, so that holes are sections too. A link is the convex hull of its joints widened by half its width: the hull's
polygon, a strip along each edge, and at each corner a sector of the corner's exterior angle. For two joints that is a
bar with semicircular ends (Norton, *Design of Machinery*, Sec. 10.3-10.6).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, Self

from kinematics.dynamics.bodies import Body, make_body


class Section(NamedTuple):
    """Area, ∫ z dA and ∫ |z|² dA about the origin."""

    area: float
    first: complex
    polar: float

    def plus(self, added: Section, sign: float = 1.0) -> Self:
        """Return the sum with another section (sign 1) or the difference (sign −1)."""
        return type(self)(
            self.area + sign * added.area, self.first + sign * added.first, self.polar + sign * added.polar
        )

    @property
    def centroid(self) -> complex:
        """Centroid of the section."""
        return self.first / self.area

    def body(self, density: float, thickness: float) -> Body:
        """Return the plate of this section, with its mass properties about its centroid."""
        # Parallel axis theorem, from the origin to the centroid.
        own = self.polar - abs(self.first) ** 2 / self.area
        return make_body(density * thickness * self.area, self.centroid, density * thickness * own)


EMPTY_SECTION = Section(0.0, 0j, 0.0)


def _build_section(area: float, centre: complex, own: float) -> Section:
    """Build a section from its centre and its polar moment about that centre."""
    return Section(area, area * centre, own + area * abs(centre) ** 2)


def make_disc(centre: complex, radius: float) -> Section:
    """Return the section of a disc."""
    return _build_section(math.pi * radius**2, centre, 0.5 * math.pi * radius**4)


def make_rectangle(centre: complex, length: float, width: float) -> Section:
    """Return the section of a rectangle; its angle does not matter."""
    area = length * width
    return _build_section(area, centre, area * (length**2 + width**2) / 12.0)


def make_polygon(corners: Sequence[complex]) -> Section:
    """Return the section of a simple polygon of either orientation, by triangles from the origin."""
    area, first, polar = 0.0, 0j, 0.0
    for z, w in zip(corners, [*corners[1:], corners[0]], strict=True):
        doubled = (z.conjugate() * w).imag
        area += doubled / 2.0
        first += doubled * (z + w) / 6.0
        polar += doubled * (abs(z) ** 2 + (z.conjugate() * w).real + abs(w) ** 2) / 12.0
    # A clockwise polygon gives negative values; make the result independent of the orientation.
    sense = -1.0 if area < 0.0 else 1.0
    return Section(sense * area, sense * first, sense * polar)


def _make_sector(centre: complex, radius: float, towards: complex, angle: float) -> Section:
    """Return a sector of a circle about ``centre``, symmetric about a direction."""
    area = 0.5 * radius**2 * angle
    arm = (2.0 * radius / 3.0) * (math.sin(angle / 2.0) / (angle / 2.0)) * towards
    about_centre = radius**4 * angle / 4.0
    # From the circle's centre to the sector's centroid.
    own = about_centre - area * abs(arm) ** 2
    return _build_section(area, centre + arm, own)


def find_hull(points: Sequence[complex]) -> list[complex]:
    """Return the corners of the convex hull, counter-clockwise; two if all are collinear (Andrew's monotone chain)."""
    # Duplicates would break the chain's orientation test.
    listed = sorted(set(points), key=lambda z: (z.real, z.imag))
    if len(listed) < 3:
        return listed

    def trace_chain(order: Sequence[complex]) -> list[complex]:
        kept: list[complex] = []
        for z in order:
            while len(kept) > 1 and ((kept[-1] - kept[-2]).conjugate() * (z - kept[-2])).imag <= 0.0:
                kept.pop()
            kept.append(z)
        return kept[:-1]

    return trace_chain(listed) + trace_chain(listed[::-1])


def make_widened_hull(points: Sequence[complex], width: float) -> Section:
    """Return the convex hull of points, widened by half a width all round."""
    corners = find_hull(points)
    radius = 0.5 * width
    if len(corners) == 1:
        return make_disc(corners[0], radius)
    total = make_polygon(corners)
    edges = [w - z for z, w in zip(corners, [*corners[1:], corners[0]], strict=True)]
    for z, edge, before in zip(corners, edges, [edges[-1], *edges[:-1]], strict=True):
        length = abs(edge)
        outward, outward_before = -1j * edge / length, -1j * before / abs(before)
        total = total.plus(make_rectangle(z + edge / 2.0 + outward * radius / 2.0, length, radius))
        turned = abs(
            math.atan2((outward_before.conjugate() * outward).imag, (outward_before.conjugate() * outward).real)
        )
        middle = outward_before * complex(math.cos(turned / 2.0), math.sin(turned / 2.0))
        # Collinear edges leave no sector.
        if turned > 0.0:
            total = total.plus(_make_sector(z, radius, middle, turned))
    return total


def make_square_bar(start: complex, end: complex, width: float, overhang: float) -> Section:
    """Return a bar with square ends that project beyond its two joints."""
    return make_rectangle((start + end) / 2.0, abs(end - start) + 2.0 * overhang, width)


def make_cylinder(
    centre: complex, diameter: float, length: float, density: float, *, bore: float = 0.0, in_plane: bool = False
) -> Body:
    """Return a (hollow) cylinder, its axis normal to the plane, or in it."""
    mass = density * math.pi / 4.0 * (diameter**2 - bore**2) * length
    squares = (diameter**2 + bore**2) / 4.0
    inertia = mass * (squares / 4.0 + length**2 / 12.0) if in_plane else mass * squares / 2.0
    return make_body(mass, centre, inertia)
