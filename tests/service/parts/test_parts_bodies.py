"""Bodies and smooth outlines: their volumes, shadows and sections, by other routes than their own."""

from __future__ import annotations

import io
import math
from itertools import product

import ezdxf
import numpy as np
import pytest
import shapely
from scipy.spatial import ConvexHull

from service.parts.assembly.interference import find_overlaps
from service.parts.assembly.model import Assembly, Carrier, Frame, Part
from service.parts.drawings.depth_buffer import find_nearest
from service.parts.drawings.dxf import write_cutting_dxf
from service.parts.gears.motion import BodyRotation, TrainMotion
from service.parts.geometry.meshes import read_triangles
from service.parts.geometry.regions import (
    Disc,
    Loop,
    Region,
    make_polygon,
    make_ring,
    measure_area,
    measure_extent,
    move_outline,
)
from service.parts.geometry.solids import Mesh, Prism, TaperedBody, TwistedPrism, divide_heights
from service.parts.geometry.splines import Curve

WAVE = 60
"""Points of a contour of three lobes."""

TURNS = np.exp(2j * math.pi * np.arange(WAVE) / WAVE)
LOBES = Curve(tuple(((20.0 + 3.0 * (TURNS**3).real) * TURNS).tolist()))


def polygon(points: np.ndarray) -> shapely.Polygon:
    return shapely.Polygon(np.column_stack([points.real, points.imag]))


def test_a_curve_is_the_smooth_line_through_its_points() -> None:
    angles = np.linspace(0.0, 2.0 * math.pi, 4001)
    true = (20.0 + 3.0 * np.cos(3.0 * angles)) * np.exp(1j * angles)
    assert LOBES.area == pytest.approx(polygon(true).area, rel=2e-5)
    assert measure_extent(LOBES, 1.0 + 0j) == pytest.approx((true.real.min(), true.real.max()), abs=2e-3)
    inner, outer = (polygon(LOBES.make_polygon(beyond=beyond)) for beyond in (False, True))
    dense = polygon(LOBES.spline(np.linspace(0.0, LOBES.spline.t[-4], 4000, endpoint=False)) @ (1.0, 1j))
    assert outer.contains(dense)
    assert dense.contains(inner)
    assert outer.area - inner.area < 2e-3 * dense.area
    at = np.linspace(0.0, LOBES.spline.t[-4], 101)
    assert np.abs(LOBES.b_spline(at) - LOBES.spline(at)).max() < 1e-12
    quarter = move_outline(LOBES, 1j, 5.0 - 5.0j)
    assert measure_extent(quarter, 1j) == pytest.approx(np.add(measure_extent(LOBES, 1.0 + 0j), -5.0), abs=1e-12)


def test_a_drawing_has_a_curve_as_the_same_spline() -> None:
    part = Part("cam", "cam", "cam", Carrier("cam", None), (Prism(Region(LOBES), 0.0, 1.0),), 1j, (1, 1), "", "#000000")
    (drawn,) = ezdxf.read(io.StringIO(write_cutting_dxf(part, "A"))).modelspace().query("SPLINE")
    found = np.array([p.x + 1j * p.y for p in drawn.construction_tool().points(np.linspace(0.0, drawn.knots[-1], 60))])
    true = (LOBES.spline(np.linspace(0.0, LOBES.spline.t[-4], 60)) @ (1.0, 1j)) / 1j
    corner = complex(measure_extent(LOBES, 1j)[0], measure_extent(LOBES, -1.0 + 0j)[0])
    assert np.abs(found + corner - true).max() < 1e-9


def test_arcs_that_turn_to_the_right_are_kept_on_the_right_side() -> None:
    """Of a square with a bite out of one side the polygon beyond covers all of it, the other none of what is cut."""
    bitten = Loop((0j, 3 + 0j, 7 + 0j, 10 + 0j, 10 + 10j, 10j), (0.0, -1.0, 0.0, 0.0, 0.0, 0.0))
    true = shapely.box(0, 0, 10, 10).difference(shapely.Point(5, 0).buffer(2.0, quad_segs=4096))
    assert measure_area(bitten) == pytest.approx(true.area, rel=1e-6)
    inner, outer = (polygon(make_polygon(bitten, beyond=beyond)) for beyond in (False, True))
    assert inner.area < measure_area(bitten) < outer.area
    assert true.difference(outer).area < 1e-5
    assert inner.difference(true).area < 1e-5


def test_a_twisted_prism_turns_evenly() -> None:
    bar = Region(Loop((4 - 1j, 4 + 1j, -4 + 1j, -4 - 1j), (0.0,) * 4), (Disc(0j, 0.5),))
    body = TwistedPrism(bar, 2.0, 10.0, math.pi, 0j)
    assert body.volume == pytest.approx(8.0 * (16.0 - math.pi * 0.25))
    (middle,) = body.cut_between(5.0, 7.0)
    assert measure_extent(middle.outer, 1j)[1] == pytest.approx(4.0)
    assert body.region == Region(Disc(0j, pytest.approx(abs(4 + 1j))), (Disc(0j, 0.5),))


def test_a_mesh_of_a_prism_has_its_volume_and_its_sections() -> None:
    corners = np.array(list(product((0.0, 2.0), (0.0, 3.0), (0.0, 4.0))))
    found = ConvexHull(corners)
    triangles = np.array(
        [
            (a, b, c) if np.cross(corners[b] - corners[a], corners[c] - corners[a]) @ normal[:3] > 0.0 else (a, c, b)
            for (a, b, c), normal in zip(found.simplices, found.equations, strict=True)
        ]
    )
    box = Mesh(corners, triangles)
    assert box.volume == pytest.approx(24.0)
    for low, high in ((1.0, 2.0), (0.0, 0.0)):
        (region,) = box.cut_between(low, high)
        assert measure_area(region.outer) == pytest.approx(6.0)
    assert measure_area(box.region.outer) == pytest.approx(6.0)
    # Two boxes in one are a box with a hole in every section, where the inner one is turned inside out.
    shell = Mesh(
        np.concatenate([corners, 0.5 + 0.5 * corners]), np.concatenate([triangles, triangles[:, ::-1] + len(corners)])
    )
    assert shell.volume == pytest.approx(21.0)
    (hollow,) = shell.cut_between(2.0, 2.2)
    assert measure_area(hollow.outer) - sum(map(measure_area, hollow.holes)) == pytest.approx(4.5)


def test_bodies_are_compared_along_the_height_that_they_share() -> None:
    low, high = Prism(make_ring(0j, 1.0), 0.0, 4.0), Prism(make_ring(0j, 1.0), 3.0, 5.0)
    assert divide_heights(low, high, 1e-9) == [(3.0, 4.0)]
    assert divide_heights(low, Prism(make_ring(0j, 1.0), 4.0, 5.0), 1e-9) == []
    worm = TwistedPrism(make_ring(0j, 1.0), 1.0, 6.0, 2.0, 0j)
    assert divide_heights(low, worm, 1e-9)[0][0] == 1.0
    assert divide_heights(low, worm, 1e-9)[-1][1] == 4.0


def test_a_cone_to_an_apex_is_as_large_as_its_frustum_and_its_surface_is_closed() -> None:
    # A square pyramid's frustum, its sides within the body of revolution.
    half, low, high = 4.0, 10.0, 16.0
    square = Loop((half - 1j * half, half + 1j * half, -half + 1j * half, -half - 1j * half), (0.0,) * 4)
    wide = 20.0
    profile = (low * 1j, 3.0 + low * 1j, wide + low * 1j, wide + high * 1j, 3.0 + high * 1j, high * 1j)
    body = TaperedBody(Region(square, (Disc(0j, 1.0),)), profile, apex=0.0, at=10.0, teeth=4)
    areas = [(2.0 * half * height / 10.0) ** 2 for height in (low, high)]
    frustum = (high - low) / 3.0 * (areas[0] + areas[1] + math.sqrt(areas[0] * areas[1]))
    assert body.volume == pytest.approx(frustum - math.pi * (high - low), rel=1e-3)
    corners, triangles = read_triangles(body.make_mesh(0.02))
    a, b, c = (corners[triangles[:, k]] for k in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0 == pytest.approx(body.volume, rel=5e-3)
    edges = [(a, b) for one in triangles.tolist() for a, b in zip(one, one[1:] + one[:1], strict=True)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)


@pytest.mark.parametrize(("gap", "meets"), [(0.05, False), (-0.05, True)])
def test_parts_of_crossing_axes_meet_where_they_do(gap: float, meets: bool) -> None:
    """A turning bar on one axis over a shaft on another: it reaches as far down as the shaft's surface, or not."""
    up = np.eye(3)[2]
    frames = [
        Frame(origin, np.column_stack([np.cross(up, along), up, along]))
        for origin, along in ((np.zeros(3), np.eye(3)[0]), (np.array([0.0, 0.0, 13.0 + gap]), np.eye(3)[1]))
    ]
    bar = Loop((-10.0 - 2.0j, 10.0 - 2.0j, 10.0 + 2.0j, -10.0 + 2.0j), (0.0,) * 4)
    bodies = (Prism(Region(Disc(0j, 3.0 - 0.2)), -20.0, 20.0), Prism(Region(bar), -3.0, 3.0))
    parts = tuple(
        Part(f"part_{n}", "", "gear", Carrier(f"shaft_{n}", None), (body,), 1.0 + 0j, (n, n), "", "#000000")
        for n, body in enumerate(bodies)
    )
    motion = TrainMotion({f"shaft_{n}": BodyRotation(0j, 1.0 + n, frame=frame) for n, frame in enumerate(frames)}, 40.0)
    # The bar's corners are √104 = 10.198 from its axis, and the shaft leaves 10.2 and the gap.
    found = find_overlaps(Assembly(parts, motion, 1, 1, 1.0, 1.0), 720)
    assert [one.parts for one in found] == ([("part_0", "part_1")] if meets else [])


def test_of_triangles_in_a_picture_the_nearest_is_seen() -> None:
    """Sample by sample, each triangle by the shares that its corners have of it."""
    corners = np.random.default_rng(5).uniform(-4.0, 30.0, (25, 3, 3))
    rows, columns = 20, 24
    found = find_nearest(corners, columns, rows)
    for row in range(rows):
        for column in range(columns):
            flat = np.concatenate([corners[:, :, :2], np.ones((25, 3, 1))], axis=2)
            shares = np.linalg.solve(np.swapaxes(flat, 1, 2), np.array([column, row, 1.0])[None, :, None])[:, :, 0]
            near = np.where(shares.min(axis=1) >= 0.0, (shares * corners[:, :, 2]).sum(axis=1), -np.inf)
            assert found[row, column] == (near.argmax() if near.max() > -np.inf else -1)
    assert len(np.unique(found)) > 8
