"""Mass properties of shapes against shapely's polygons, the bar's own formula, and Monte Carlo."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from kinematics.dynamics import shapes
from kinematics.dynamics.bodies import join_bodies, make_body

CHORDS = 180
"""A quarter circle by so many chords."""


def by_triangles(outline: shapely.Polygon) -> tuple[float, complex, float]:
    """Area, centroid and polar moment about the centroid of a polygon with holes, over a triangulation."""
    area, first, polar = 0.0, 0j, 0.0
    for triangle in shapely.constrained_delaunay_triangles(outline).geoms:
        corners = [complex(*xy) for xy in triangle.exterior.coords[:3]]
        own, centre = triangle.area, sum(corners) / 3.0
        # A triangle's second moments are those of its area by thirds at the midpoints of its sides.
        middles = [(a + b) / 2.0 for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
        area, first = area + own, first + own * centre
        polar += own / 3.0 * sum(abs(z) ** 2 for z in middles)
    return area, first / area, polar - abs(first) ** 2 / area


@pytest.mark.parametrize("joints", [2, 3, 5])
@pytest.mark.parametrize("hole", [0.0, 0.3])
def test_widened_hull_is_the_buffered_polygon(joints: int, hole: float) -> None:
    rng = np.random.default_rng(joints)
    points = [complex(*xy) for xy in rng.normal(size=(joints, 2)) * 3.0]
    section = shapes.make_widened_hull(points, 0.8)
    outline = shapely.MultiPoint([(z.real, z.imag) for z in points]).convex_hull.buffer(0.4, quad_segs=CHORDS)
    if hole:
        section = section.plus(shapes.make_disc(points[0], hole / 2.0), -1.0)
        outline = outline.difference(shapely.Point(points[0].real, points[0].imag).buffer(hole / 2.0, quad_segs=CHORDS))
    area, centre, polar = by_triangles(outline)
    plate = section.body(1.0, 1.0)
    assert section.area == pytest.approx(area, rel=1e-4)
    assert abs(section.centroid - centre) < 1e-4
    assert float(plate.inertia) == pytest.approx(polar, rel=1e-4)


def test_bar_with_round_ends_by_its_own_formula() -> None:
    """Rectangle and two half discs, each moved from its own centre by the parallel axis (Norton 10.8)."""
    length, width, thickness, density = 7.0, 1.2, 0.5, 3.0
    bar = shapes.make_widened_hull([1 + 1j, 1 + 1j + length * np.exp(0.7j)], width).body(density, thickness)
    r = width / 2.0
    half = math.pi * r * r / 2.0
    own = density * thickness * half * r * r * (0.5 - 16.0 / (9.0 * math.pi**2))
    apart = length / 2.0 + 4.0 * r / (3.0 * math.pi)
    plate = density * thickness * length * width
    inertia = plate * (length**2 + width**2) / 12.0 + 2.0 * (own + density * thickness * half * apart**2)
    assert float(bar.mass) == pytest.approx(
        density * thickness * (length * width + math.pi * width**2 / 4.0), rel=1e-13
    )
    assert float(bar.inertia) == pytest.approx(inertia, rel=1e-12)
    assert complex(bar.cg) == pytest.approx(1 + 1j + length / 2.0 * np.exp(0.7j))


def test_polygon_in_either_sense_and_hull_of_points_on_a_line() -> None:
    corners = [0j, 4 + 0j, 4 + 1j, 1 + 3j]
    one, two = shapes.make_polygon(corners), shapes.make_polygon(corners[::-1])
    assert one == pytest.approx(two)
    area, centre, polar = by_triangles(shapely.Polygon([(z.real, z.imag) for z in corners]))
    assert (one.area, float(one.body(1.0, 1.0).inertia)) == pytest.approx((area, polar))
    assert one.centroid == pytest.approx(centre)
    straight, bar = shapes.make_widened_hull([0j, 1 + 0j, 3 + 0j], 0.5), shapes.make_widened_hull([0j, 3 + 0j], 0.5)
    assert straight == pytest.approx(bar)


@pytest.mark.parametrize("in_plane", [False, True])
def test_cylinders_and_prisms_by_monte_carlo(in_plane: bool) -> None:
    rng = np.random.default_rng(3)
    diameter, bore, length, density = 2.0, 0.8, 3.0, 1.5
    box = rng.uniform(-0.5, 0.5, (400_000, 3)) * [diameter, diameter, length]
    radius = np.hypot(box[:, 0], box[:, 1])
    inside = box[(radius <= diameter / 2.0) & (radius >= bore / 2.0)]
    mass = density * diameter * diameter * length * len(inside) / len(box)
    squares = inside[:, 0] ** 2 + inside[:, 2 if in_plane else 1] ** 2
    part = shapes.make_cylinder(0j, diameter, length, density, bore=bore, in_plane=in_plane)
    assert float(part.mass) == pytest.approx(mass, rel=5e-3)
    assert float(part.inertia) == pytest.approx(mass * squares.mean(), rel=5e-3)


def test_bodies_join_about_their_common_centre() -> None:
    whole = join_bodies([make_body(2.0, 1 + 0j, 0.5), make_body(6.0, 5 + 0j, 0.25), make_body(0.0, 100 + 0j, 3.0)])
    assert (float(whole.mass), complex(whole.cg)) == (8.0, 4 + 0j)
    assert float(whole.inertia) == pytest.approx(0.5 + 0.25 + 3.0 + 2.0 * 9.0 + 6.0)
