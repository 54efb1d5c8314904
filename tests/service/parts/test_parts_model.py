"""What parts are made of: outlines, planes of washers, what overlaps, and the process that makes them."""

from __future__ import annotations

import asyncio
import math
import operator
import os
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from service.parts.assembly.interference import find_overlaps, find_thin_walls
from service.parts.assembly.items import list_items
from service.parts.assembly.model import Assembly
from service.parts.assembly.sizes import PartsQuery
from service.parts.drawings.assembly_sheet import draw_assembly_sheet, group_layers
from service.parts.export import worker
from service.parts.export.worker import Workshop
from service.parts.export.zip_package import write_package
from service.parts.geometry.regions import Disc, make_polygon, measure_area, measure_extent, widen_hull
from service.parts.geometry.solids import Prism
from service.parts.registry import make_parts
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.support.service.parts import MOTION, SLIDER
from tests.support.service.request_pool import never

PLACES = st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=1, max_size=6)


@cache
def assembly(kind: str, **query: Any) -> Assembly:
    problem = parse_problem({"fourbar": MOTION, "slider": SLIDER}[kind])
    design = solve(problem, lambda _fraction, _message: None).designs[0]
    return make_parts(design, problem, PartsQuery(**query))


@given(PLACES, st.floats(0.1, 3.0))
def test_a_widened_hull_is_what_another_library_makes(places: list[tuple[int, int]], radius: float) -> None:
    outline = widen_hull([complex(*place) for place in places], radius)
    other = shapely.MultiPoint(places).convex_hull.buffer(radius, quad_segs=256)
    assert measure_area(outline) == pytest.approx(other.area, rel=1e-4)
    left, low, right, high = other.bounds
    assert measure_extent(outline, 1.0 + 0.0j) == pytest.approx((left, right), abs=1e-9 + 1e-5 * radius)
    assert measure_extent(outline, 1j) == pytest.approx((low, high), abs=1e-9 + 1e-5 * radius)
    inner, outer = (shapely.Polygon([(z.real, z.imag) for z in make_polygon(outline, beyond=b)]) for b in (False, True))
    assert inner.area <= measure_area(outline) * (1.0 + 1e-12)
    assert measure_area(outline) <= outer.area * (1.0 + 1e-12)


@pytest.mark.parametrize("kind", ["fourbar", "slider"])
def test_no_point_of_one_part_ever_lies_in_another(kind: str) -> None:
    """By points drawn in each part, at inputs of their own."""
    whole, rng = assembly(kind), np.random.default_rng(7)
    inputs = (
        whole.motion.sample_inputs(41) if whole.motion.closed else rng.uniform(whole.motion.low, whole.motion.high, 41)
    )
    driven = whole.motion.compute_state(inputs)
    drawn = []
    for part in whole.parts:
        placed = whole.motion.compute_placement(part.carrier, driven)
        for prism in part.bodies:
            polygon = solid(prism)
            left, low, right, high = polygon.bounds
            points = rng.uniform((left, low), (right, high), (300, 2))
            kept = points[shapely.contains_xy(polygon, points[:, 0], points[:, 1])] @ (1.0, 1j)
            drawn.append((part.name, prism, polygon, placed, kept))
    tried = 0
    for name, prism, _, placed, points in drawn:
        for other, hit, polygon, where, _ in drawn:
            if name == other or min(prism.high, hit.high) - max(prism.low, hit.low) < 1e-9:
                continue
            at = placed.turn * points[:, None] + placed.shift
            seen = (at - where.shift) / where.turn
            tried += seen.size
            assert not shapely.contains_xy(polygon, seen.real, seen.imag).any(), (name, other)
    assert tried > 100_000


def solid(prism: Prism) -> shapely.Polygon:
    outer, *holes = (
        [(z.real, z.imag) for z in make_polygon(outline, beyond=False)]
        for outline in (prism.region.outer, *prism.region.holes)
    )
    return shapely.Polygon(outer, holes)


@pytest.mark.parametrize("sort", ["link", "pin", "washer", "spacer", "ring", "base"])
def test_a_part_that_is_out_of_its_plane_is_found(sort: str) -> None:
    whole = assembly("fourbar")
    assert find_overlaps(whole) == []
    part = next(part for part in whole.parts if part.sort == sort)
    lifted = replace(part, bodies=tuple(Prism(p.region, p.low + 0.3, p.high + 0.3) for p in part.bodies))
    moved = replace(whole, parts=tuple(lifted if one is part else one for one in whole.parts))
    # What lies on it, or what holds it, is now in its way.
    assert any(part.name in found.parts for found in find_overlaps(moved)), part.name


def test_parts_that_meet_at_one_input_are_found() -> None:
    whole = assembly("fourbar")
    by_plane = {part.planes[0]: part for part in whole.parts if part.sort == "link"}
    low, high = by_plane[1], by_plane[2]
    down = replace(
        high, bodies=tuple(Prism(p.region, q.low, q.high) for p, q in zip(high.bodies, low.bodies, strict=True))
    )
    found = find_overlaps(replace(whole, parts=(low, down)))
    assert found
    assert found[0].area > 1.0


def test_holes_too_near_the_edge_are_found() -> None:
    whole = assembly("fourbar", width=15.0, pin=5.0)
    left = 0.5 * (15.0 - 5.2)
    assert find_thin_walls(whole, 0.998 * left) == []
    assert {thin.part for thin in find_thin_walls(whole, 1.001 * left)} >= {"base", "link_input"}


@pytest.mark.parametrize("process", ["laser", "print", "mill"])
def test_pins_hold_what_they_join_and_end_within_the_gaps(process: str) -> None:
    whole = assembly("fourbar", width=15.0, pin=5.0, process=process)
    for joint in ("O2", "A", "B", "O4"):
        name = joint.lower()
        pin = next(part for part in whole.parts if part.name == f"pin_{name}")
        outer = pin.region.outer
        assert isinstance(outer, Disc)
        stacked = sorted(
            (prism.low, prism.high)
            for part in whole.parts
            for prism in part.bodies
            for hole in prism.region.holes
            if isinstance(hole, Disc) and abs(hole.centre - outer.centre) < 1e-9
        )
        assert pin.low <= stacked[0][0] + 1e-9
        assert pin.high >= stacked[-1][1] - 1e-9
        # Nothing on it may move farther along it than the play of the gaps and the grooves.
        free = stacked[0][0]
        slack = 0.0
        for low, high in stacked:
            slack += max(low - free, 0.0)
            free = max(free, high)
        assert 0.0 < slack <= 5 * {"laser": 0.1, "print": 0.2, "mill": 0.05}[process]
    if process == "print":
        assert not any(part.standard for part in whole.parts)


def test_the_side_view_is_to_scale_and_tells_all_planes() -> None:
    whole = assembly("fourbar")
    text = draw_assembly_sheet(whole, list_items(whole), "A fourbar")
    assert [layer.name for layer in group_layers(whole) if layer.name] == ["base", "plane 1", "plane 2", "plane 3"]
    for words in ("plane 1: ", "plane 3: ", "base, ", "washers ISO 7089", "rings DIN 471", ">O2<", ">B<"):
        assert words in text
    for part in whole.parts:
        assert f'data-part="{part.name}"' in text


def test_alike_parts_are_one_item_and_every_part_is_in_one() -> None:
    whole = assembly("fourbar")
    listed = list_items(whole)
    assert sorted(part.name for item in listed for part in item.parts) == sorted(part.name for part in whole.parts)
    assert len({item.name for item in listed}) == len(listed)
    for item in listed:
        assert all(math.isclose(part.volume, item.part.volume, rel_tol=1e-9) for part in item.parts)


def test_the_same_design_gives_the_same_files(monkeypatch: Any) -> None:
    monkeypatch.setattr("service.parts.export.zip_package.is_installed", lambda: False)
    whole = assembly("fourbar")
    first, second = (write_package(whole, "laser", "A", whole.motion.sample_inputs(1)[0]) for _ in range(2))
    assert first == second


def test_what_was_made_is_kept_until_there_is_too_much(monkeypatch: Any) -> None:
    monkeypatch.setattr(worker, "MAX_CACHE_BYTES", 10)
    monkeypatch.setattr(worker, "_prepare", operator.itemgetter)  # loads nothing
    bench = Workshop(memory_mb=100, timeout_s=1.0)

    async def all_of_it() -> list[bytes]:
        return [await bench.run_cached(never, "acme", os.urandom, size) for size in (5, 4, 5, 3, 5, 4)]

    try:
        made = asyncio.run(all_of_it())
    finally:
        bench.stop()
    assert made[2] == made[0] == made[4]
    assert made[5] != made[1]


def test_the_input_has_the_colour_that_it_has_on_the_stage() -> None:
    """Warm for the input and cool for the coupler, as the page's own colours are."""
    colours = {part.name: part.colour for part in assembly("fourbar").parts}
    red, blue = (int(colours["link_input"][k : k + 2], 16) for k in (1, 5))
    assert red > 2 * blue
    red, blue = (int(colours["link_coupler"][k : k + 2], 16) for k in (1, 5))
    assert blue > 2 * red
