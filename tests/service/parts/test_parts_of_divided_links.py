"""A Whitworth quick return as parts: its lever is two plates on one shaft, on either side of the second base."""

from __future__ import annotations

import io
import math
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any

import ezdxf
import numpy as np
import pytest

from service.parts.assembly.interference import find_overlaps
from service.parts.assembly.model import Assembly
from service.parts.assembly.sizes import NotMade, PartsQuery
from service.parts.geometry.regions import Disc
from service.parts.geometry.solids import Prism
from service.parts.registry import make_parts
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.support.service.answers import finished
from tests.support.service.parts import bill, parts, refused

WHITWORTH: dict[str, Any] = {
    "kind": "quick_return", "mechanism": "whitworth", "time_ratio": 1.4, "stroke": 100.0, "length_unit": "mm",
    "ground_angle": 37.0, "max_designs": 1,
}  # fmt: skip


@cache
def solved(ratio: float) -> tuple[Any, Any]:
    problem = parse_problem({**WHITWORTH, "time_ratio": ratio})
    return solve(problem, lambda _fraction, _message: None).designs[0], problem


def assembly(ratio: float = 1.4, **query: Any) -> Assembly:
    return make_parts(*solved(ratio), PartsQuery(**query))


def keyed(content: bytes) -> tuple[complex, float]:
    """Centre of a bore with a keyway, and the direction of the keyway."""
    outlines = [
        outline
        for outline in ezdxf.read(io.StringIO(content.decode())).modelspace().query("LWPOLYLINE")
        if max(abs(bulge) for *_, bulge in outline.get_points("xyb")) > 1.0
    ]
    (bore,) = outlines
    corners = [(complex(x, y), bulge) for x, y, bulge in bore.get_points("xyb")]
    (start, bulge), (end, _) = next(
        (corners[k], corners[(k + 1) % len(corners)]) for k in range(len(corners)) if abs(corners[k][1]) > 1.0
    )
    # The chord of the open side of the circle, and how far it is from the centre.
    angle = 4.0 * math.atan(bulge)
    centre = 0.5 * (start + end) + 1j * (end - start) / (2.0 * math.tan(0.5 * angle))
    key = np.mean([z for z, _ in corners]) - centre
    return centre, float(np.angle(key))


@pytest.mark.slow
def test_the_lever_is_cut_as_two_plates_that_are_keyed_alike(server: Any) -> None:
    client = server.client
    place = f"/v1/jobs/{finished(client, WHITWORTH)['id']}/designs/0"
    links = client.get(place.rsplit("/designs")[0]).json()["result"]["designs"][0]["mechanism"]["links"]
    files = parts(client, place, pin=5)
    lower, upper = (keyed(files[f"dxf/link_{half}_rocker.dxf"]) for half in ("lower", "upper"))
    assert lower == pytest.approx(upper, abs=1e-6)
    space = ezdxf.read(io.StringIO(files["dxf/link_upper_rocker.dxf"].decode())).modelspace()
    (hole,) = space.query("CIRCLE")
    assert abs(complex(*hole.dxf.center.vec2) - upper[0]) == pytest.approx(links["rocker"], abs=1e-6)
    rows = bill(files)
    assert rows["key"]["quantity"] == "3"
    assert {name: rows[name]["plane"] for name in ("link_input", "link_lower_rocker", "second_base",
                                                   "link_upper_rocker", "link_coupler", "pin_o4")} == {
        "link_input": "1", "link_lower_rocker": "2", "second_base": "3", "link_upper_rocker": "4",
        "link_coupler": "5", "pin_o4": "2-4",
    }  # fmt: skip
    read_me = files["README.txt"].decode()
    assert "second base: block_d_2, second_base" in read_me
    assert "Link rocker consists of two plates" in read_me
    view = client.get(f"{place}/assembly", params={"pin": 5, "positions": 4}).json()
    assert (view["planes"], view["bases"]) == (4, 2)
    carried = {part["name"]: part["carrier"] for part in view["parts"]}
    one = ("link_lower_rocker", "link_upper_rocker", "pin_o4", "key_o4_2", "key_o4_4")
    assert len({carried[name] for name in one}) == 1
    (fault,) = refused(client, place, 422, shafts="both_sides")["errors"]
    assert fault["path"] == "/query/shafts"
    (fault,) = refused(client, place, 422, width=60)["errors"]
    assert fault["path"] == "/query/width"
    assert "fit at scale" in fault["detail"]


@pytest.mark.parametrize(("ratio", "process"), [(1.2, "laser"), (2.5, "print"), (1.8, "mill")])
def test_nothing_on_the_levers_shaft_may_move_farther_than_the_play(ratio: float, process: Any) -> None:
    whole = assembly(ratio, process=process, pin=4.0)
    shaft = next(part for part in whole.parts if part.name == "pin_o4")
    outer = shaft.region.outer
    assert isinstance(outer, Disc)
    by_name = {part.name: part for part in whole.parts}
    stacked = [by_name["link_lower_rocker"], by_name["second_base"], by_name["link_upper_rocker"]]
    stacked += [part for part in whole.parts if "_o4_" in part.name and part.sort in ("washer", "spacer")]
    faces = sorted((body.low, body.high) for part in stacked for body in part.bodies if _holds(body, outer.centre))
    sizes = {"laser": 0.1, "print": 0.2, "mill": 0.05}
    gaps = [above[0] - below[1] for below, above in pairwise(faces)]
    assert min(gaps) >= -1e-9
    assert 0.0 < sum(gaps) <= 2.0 * sizes[process] + 1e-9
    assert shaft.low < faces[0][0] < faces[-1][1] < shaft.high


def _holds(body: Any, centre: complex) -> bool:
    """Whether a body lies around an axis: every plate but for bosses of other shafts does."""
    outer = body.region.outer
    return not isinstance(outer, Disc) or abs(outer.centre - centre) < 1e-9


@pytest.mark.parametrize(("part", "planes"), [("link_upper_rocker", -1), ("link_coupler", -4)])
def test_a_plate_on_the_other_side_of_the_base_would_be_in_the_way(part: str, planes: int) -> None:
    """The check that knows nothing of planes sees it."""
    whole = assembly(pin=4.0)
    low = {one.name: one.low for one in whole.parts}
    up = planes * (low["link_lower_rocker"] - low["link_input"])
    moved = []
    for one in whole.parts:
        bodies = tuple(Prism(body.region, body.low + up, body.high + up) for body in one.bodies if one.name == part)
        moved.append(replace(one, bodies=bodies or one.bodies))
    assert any(part in pair.parts for pair in find_overlaps(replace(whole, parts=tuple(moved)), 24))


@pytest.mark.slow
def test_the_least_scale_is_told_where_the_pins_are_too_thick() -> None:
    with pytest.raises(NotMade, match=r"fit at scale [\d.]+ or more") as refusal:
        assembly(2.5, pin=8.0)
    scale = float(str(refusal.value).split("scale ")[1].split()[0])
    assert assembly(2.5, pin=8.0, scale=scale).sides == 2
