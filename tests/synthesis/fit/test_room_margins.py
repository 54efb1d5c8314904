"""Margins of a room: against shapely, and their derivatives against differences."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from shapely import (
    MultiPoint,
    Point,
    Polygon,
    constrained_delaunay_triangles,
    convex_hull,
    distance,
    linestrings,
    polygons,
    union_all,
)
from shapely.errors import GEOSException

from kinematics.arrays import Complex, Real
from synthesis.fit.convex_pieces import decompose_convex
from synthesis.fit.separation import compute_separation, measure_depth
from synthesis.fit.workspace import AIM_SHARE, HEADER_SIZE, WINDOW_COUNT, pack_workspace
from synthesis.fit.workspace_margins import (
    CONVERGENCE_TOLERANCE,
    ROW_SIZE,
    compute_margins,
    count_margins,
    count_steps,
    differentiate_margin,
)
from synthesis.model.linkage.workspace import Space

ORIGIN, SIZE, FIRST = 1.0 + 1.0j, 7.0, 4.0 + 4.0j

SPACE: dict[str, Any] = {
    "fixed_pivots": {
        "input": {"polygon": [[-2, -2], [2, -2], [2, 2], [0, 1], [-2, 2]]},
        "output": [{"circle": {"center": [4, 0], "radius": 1}}, {"circle": {"center": [6, 0], "radius": 1}}],
    },
    "moving_pivots": {"input": {"circle": {"center": [1, 0], "radius": 2}, "frame": "body"}},
    "box": [[-10, -10], [10, 10]],
    "body": {"outline": [[3, 3], [5, 3], [5, 4], [4, 4], [4, 5], [3, 5]]},
    "obstacles": [
        {"polygon": [[-4, -4], [-2, -4], [-2, -1], [-3, -1], [-3, -3], [-4, -3]]},
        {"circle": {"center": [8, 3], "radius": 1}},
        {"polygon": [[3, 2], [3.5, 2.5], [3, 2.5]]},
    ],
    "clearance": 0.1,
    "link_width": 0.3,
}


def shaped(corners: Complex) -> Any:
    """The convex hull of corners."""
    return MultiPoint(np.stack([corners.real, corners.imag], axis=1)).convex_hull


def drawn(rng: np.random.Generator, count: int) -> Complex:
    return np.asarray(rng.normal(size=(count, 2)) @ np.array([1.0, 1.0j]))


def convex(rng: np.random.Generator, count: int) -> Complex:
    """The corners of a convex polygon, anticlockwise."""
    corners = np.array(shaped(drawn(rng, count)).exterior.coords)[:-1] @ np.array([1.0, 1.0j])
    area = (corners.conj() * np.roll(corners, -1)).imag.sum()
    return np.ascontiguousarray(corners if area > 0 else corners[::-1])


@pytest.mark.parametrize("corners", [1, 2, 3])
def test_cores_that_are_apart_have_the_distance_of_shapely(corners: int) -> None:
    rng = np.random.default_rng(corners)
    for _ in range(60):
        first, second = 2.0 * drawn(rng, corners), convex(rng, 6)
        weights = np.empty(corners)
        apart, normal = compute_separation(first, second, weights)
        true = shaped(first).distance(Polygon(np.stack([second.real, second.imag], axis=1)))
        assert weights.sum() == pytest.approx(1.0)
        assert abs(normal) == pytest.approx(1.0)
        if true > 0.0:
            assert apart == pytest.approx(true, abs=1e-12)
        else:
            assert apart <= 0.0
            # Moved along the normal by the depth they only touch, and by less they still overlap.
            for share, meets in ((1.0 + 1e-9, False), (0.99, True)):
                there = shaped(first - share * apart * normal)
                overlap = there.intersection(shaped(second))
                assert (not overlap.is_empty and there.intersects(shaped(second).buffer(-1e-10))) == meets


def test_the_signed_distance_has_the_slope_that_its_weights_tell() -> None:
    rng = np.random.default_rng(9)
    for _ in range(60):
        corners = int(rng.integers(1, 5))
        first = drawn(rng, corners) if corners < 4 else convex(rng, 4)
        weights, ahead, behind = (np.empty(len(first)) for _ in range(3))
        second = convex(rng, 5) if rng.uniform() < 0.8 else drawn(rng, 1)
        _, normal = compute_separation(first, second, weights)
        change = 1e-7 * drawn(rng, len(first))
        difference = (
            compute_separation(first + change, second, ahead)[0] - compute_separation(first - change, second, behind)[0]
        )
        if np.allclose(ahead, behind, atol=1e-3):
            assert difference == pytest.approx(2.0 * (normal.conjugate() * (weights * change).sum()).real, abs=1e-11)


def test_depth_within_a_polygon_is_that_of_shapely_with_its_slope() -> None:
    rng = np.random.default_rng(2)
    corners = np.array([0, 4, 4 + 3j, 2 + 1j, 3j])
    polygon = Polygon(np.stack([corners.real, corners.imag], axis=1))
    for z in 4.0 * drawn(rng, 100) + (2 + 1j):
        depth, toward = measure_depth(complex(z), corners)
        away = polygon.exterior.distance(Point(z.real, z.imag))
        assert depth == pytest.approx(away if polygon.contains(Point(z.real, z.imag)) else -away)
        ahead, _ = measure_depth(complex(z + 1e-7 * toward), corners)
        assert ahead - depth == pytest.approx(1e-7, abs=1e-12)


def test_convex_pieces_cover_an_outline_and_no_more() -> None:
    rng = np.random.default_rng(5)
    for count in (3, 5, 8, 11):
        turns = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
        outline = rng.uniform(0.3, 1.0, count) * np.exp(1j * turns)
        whole = Polygon(np.stack([outline.real, outline.imag], axis=1))
        pieces, beyond = decompose_convex(outline, 1.0)
        shapes = [Polygon(np.stack([piece.real, piece.imag], axis=1)) for piece in pieces]
        assert beyond == 0.0
        assert union_all(shapes).symmetric_difference(whole).area < 1e-12
        assert sum(shape.area for shape in shapes) == pytest.approx(whole.area)
        assert all(shape.convex_hull.area == pytest.approx(shape.area) for shape in shapes)
        assert len(pieces) <= max(count - 2, 1)
    assert len(decompose_convex(np.array([0, 2, 2 + 1j, 1 + 1j, 1 + 2j, 2j]), 1.0)[0]) == 2


def test_an_outline_that_geos_gives_up_on_is_triangulated() -> None:
    outline = np.array([
        12.516134435664963 + 18.963296921408656j,
        10.529923085234165 + 20.11676733633025j,
        12.368215140496247 + 23.282203136273584j,
        10.382003790065447 + 24.43567355119518j,
        11.62582779282273 + 26.57746871148346j,
        12.580250526294327 + 22.341032856720222j,
        12.826945855918304 + 21.863954905860286j,
        13.189065293074938 + 21.598338846253984j,
        13.596491793302977 + 21.506068611006597j,
        13.98684322896866 + 21.49577496388775j,
    ])  # fmt: skip
    shape = Polygon(np.stack([outline.real, outline.imag], axis=1))
    with pytest.raises(GEOSException):
        constrained_delaunay_triangles(shape)
    pieces, _ = decompose_convex(outline, 1.0)
    assert union_all([shaped(piece) for piece in pieces]).area == pytest.approx(shape.area, rel=1e-9)


@pytest.mark.parametrize("most", [1, 4, 30])
def test_an_outline_of_no_more_pieces_than_it_may_have_is_still_covered(most: int) -> None:
    turns = np.arange(400) * 2.0 * np.pi / 400
    star = np.where(np.arange(400) % 2, 0.7, 1.0) * np.exp(1j * turns)
    teeth = np.concatenate([[5 * k, 5 * k + 40j, 5 * k + 4 + 40j, 5 * k + 4] for k in range(60)] + [[299 - 9j, -9j]])
    for outline in (star, teeth):
        pieces, beyond = decompose_convex(outline, 1.0, most)
        assert 1 <= len(pieces) <= most
        assert union_all([shaped(piece) for piece in pieces]).buffer(beyond * 1.01 + 1e-9).covers(shaped(outline))
        assert beyond <= 0.5 * np.abs(outline - outline.mean()).max()


def test_an_outline_of_many_corners_reaches_no_farther_than_is_told() -> None:
    turns = np.linspace(0.0, 2.0 * np.pi, 500, endpoint=False)
    outline = (1.0 + 0.2 * np.cos(5.0 * turns)) * np.exp(1j * turns)
    pieces, beyond = decompose_convex(outline, 1.0)
    cover = union_all([Polygon(np.stack([piece.real, piece.imag], axis=1)) for piece in pieces])
    assert 0.0 < beyond < 0.01
    assert cover.buffer(beyond * 1.01).contains(MultiPoint(np.stack([outline.real, outline.imag], axis=1)))
    assert sum(len(piece) for piece in pieces) < 300


def test_what_demands_nothing_is_no_room() -> None:
    assert len(pack_workspace(None, 0j, 1.0)) == 0
    assert len(pack_workspace(Space(clearance=1.0, link_width=2.0), 0j, 1.0)) == 0
    assert count_margins(pack_workspace(None, 0j, 1.0)) == 0


def motion(x: Real, ring: bool) -> Complex:
    """Some motion of five joints and a body that depends smoothly on ten numbers."""
    n = count_steps(ring)
    t = np.arange(n) / (n if ring else n - 1) * (2.0 * np.pi if ring else 2.0)
    places = np.empty((n, 6), np.complex128)
    places[:, 0], places[:, 3] = complex(x[0], x[1]), complex(x[2], x[3])
    places[:, 1] = places[:, 0] + x[4] * np.exp(1j * t)
    places[:, 2] = places[:, 3] + x[5] * np.exp(1j * (0.3 * np.sin(t) + x[6]))
    places[:, 5] = np.exp(1j * (x[7] + 0.5 * np.sin(t)))
    places[:, 4] = places[:, 1] + complex(x[8], x[9]) * places[:, 5]
    return places


def at(room: Real, x: Real, ring: bool) -> tuple[Real, Real]:
    count = count_margins(room)
    values, rows, places = np.empty(count), np.empty((count, ROW_SIZE)), motion(x, ring)
    compute_margins(room, places, ring, places[0].copy(), values, rows)
    return values, rows


def start(rng: np.random.Generator) -> Real:
    return np.asarray(0.3 * rng.normal(size=10) + np.array([-0.3, -0.3, 0.5, 0, 0.2, 0.3, 1, 0.2, 0.2, 0.2]))


@pytest.mark.parametrize("carries", [True, False])
@pytest.mark.parametrize("ring", [True, False])
def test_derivatives_of_margins_are_those_of_differences(carries: bool, ring: bool) -> None:
    space = Space.model_validate(SPACE)
    room = pack_workspace(space, ORIGIN, SIZE, first=FIRST if carries else None)
    rng = np.random.default_rng(3)
    agreed = looked_at = 0
    for _ in range(6):
        x, step = start(rng), 1e-6
        values, rows = at(room, x, ring)
        slopes = np.empty((count_steps(ring), 6, 10), np.complex128)
        differences = np.empty((len(values), 10))
        for i in range(10):
            change = np.zeros(10)
            change[i] = step
            slopes[:, :, i] = (motion(x + change, ring) - motion(x - change, ring)) / (2.0 * step)
            differences[:, i] = (at(room, x + change, ring)[0] - at(room, x - change, ring)[0]) / (2.0 * step)
        own = np.empty((len(values), 10))
        for k in range(len(values)):
            differentiate_margin(rows[k], ring, slopes, slopes[0].copy(), own[k])
        near = values < CONVERGENCE_TOLERANCE
        apart = np.abs(own - differences).max(axis=1)
        # Where the nearest place is at a kink, as the deepest mostly is, a difference is the slope of neither side.
        agreed += int((near & (apart < 1e-4)).sum())
        looked_at += int(near.sum())
    assert looked_at > 100
    assert agreed > 0.85 * looked_at


@pytest.mark.parametrize("carries", [True, False])
def test_margins_are_the_least_distances_of_shapely_over_a_fine_motion(carries: bool) -> None:
    """Every margin together: the least of them is what an independent sweep measures."""
    space = Space.model_validate({**SPACE, "fixed_pivots": None, "moving_pivots": None, "box": None})
    room = pack_workspace(space, ORIGIN, SIZE, first=FIRST if carries else None)
    obstacles = [
        Polygon(zone.polygon) if zone.polygon else Point(zone.circle.center).buffer(zone.circle.radius, quad_segs=256)
        for zone in space.obstacles
        if zone.polygon or zone.circle
    ]
    outline = np.array([3 + 3j, 5 + 3j, 5 + 4j, 4 + 4j, 4 + 5j, 3 + 5j])
    rng = np.random.default_rng(4)
    met = 0
    for _ in range(6):
        x = start(rng)
        values, _ = at(room, x, False)
        n = count_steps(False)
        coarse = motion(x, False)
        places = CubicSpline(np.arange(n), coarse)(np.linspace(0, n - 1, 400))
        z = ORIGIN + SIZE * places[:, :5]
        links = [z[:, [0, 1]], z[:, [3, 2]], z[:, [1, 2]] if carries else z[:, [1, 2, 4]]]
        body = z[:, 4:] + places[:, 5:] * (outline - FIRST)
        least = np.inf
        for obstacle in obstacles:
            for link in links:
                hulls = convex_hull(linestrings(np.stack([link.real, link.imag], axis=-1)))
                least = min(least, float(distance(hulls, obstacle).min()) - 0.15)
            if carries:
                least = min(least, float(distance(polygons(np.stack([body.real, body.imag], axis=-1)), obstacle).min()))
        own = float(values.min()) + AIM_SHARE + 0.1 / SIZE
        if least > 0.0:
            met += 1
            assert min(own, CONVERGENCE_TOLERANCE) * SIZE == pytest.approx(
                min(least, CONVERGENCE_TOLERANCE * SIZE), abs=0.02
            )
        else:
            assert own < 1e-3
    assert met


def test_the_box_is_kept_as_shapely_finds_it() -> None:
    space = Space.model_validate({"box": [[-3, -4], [8, 6]], "link_width": 0.4})
    room = pack_workspace(space, ORIGIN, SIZE)
    assert len(room) > HEADER_SIZE
    x = start(np.random.default_rng(6))
    values, _ = at(room, x, True)
    places = ORIGIN + SIZE * motion(x, True)[:, :5]
    left, low, right, high = MultiPoint(np.stack([places.real.ravel(), places.imag.ravel()], axis=1)).bounds
    sides = values.reshape(WINDOW_COUNT, 4).min(axis=0) * SIZE
    wanted = np.array([left + 3, 8 - right, low + 4, 6 - high]) - 0.2 - AIM_SHARE * SIZE
    np.testing.assert_allclose(sides, wanted, atol=0.01)


def test_pivots_are_held_to_the_nearest_of_their_zones() -> None:
    space = Space.model_validate({"fixed_pivots": SPACE["fixed_pivots"], "moving_pivots": SPACE["moving_pivots"]})
    room = pack_workspace(space, ORIGIN, SIZE, first=FIRST)
    x = start(np.random.default_rng(8))
    values, _ = at(room, x, True)
    assert len(values) == 3
    here = motion(x, True)[0]
    o2, a, _, o4, p = ORIGIN + SIZE * here[:5]
    polygon = Polygon(SPACE["fixed_pivots"]["input"]["polygon"])
    away = polygon.exterior.distance(Point(o2.real, o2.imag))
    assert values[0] * SIZE == pytest.approx(
        (away if polygon.contains(Point(o2.real, o2.imag)) else -away) - AIM_SHARE * SIZE
    )
    assert values[1] * SIZE == pytest.approx(max(1 - abs(o4 - 4), 1 - abs(o4 - 6)) - AIM_SHARE * SIZE)
    on_body = FIRST + (a - p) * np.conj(here[5])
    assert values[2] * SIZE == pytest.approx(2 - abs(on_body - 1) - AIM_SHARE * SIZE)
