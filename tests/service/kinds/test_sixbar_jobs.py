"""Motion by sixbars through HTTP: solved, proved by another formulation, drawn, driven; a refusal names the field."""

from __future__ import annotations

import cmath
import math
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from synthesis.fit.linkage.topology import list_forms
from synthesis.kinds.motion import type_selection
from synthesis.kinds.motion.design import MotionResult
from synthesis.model.answer import Search
from synthesis.model.linkage.sixbars import SIXBAR_NAMES
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.oracles.loops import Loops
from tests.support.service.analyses import assert_as_documented
from tests.support.service.answers import finished
from tests.support.service.sixbar_jobs import FIVE, TASK
from tests.support.sixbars.driven import find_dyad_pins
from tests.support.sixbars.motion import on_a_way
from tests.support.sixbars.planted_motion import planted

SIX = [*FIVE, {"x": 118.0, "y": -80.0, "angle": -48.0}]
SIXBARS = "watt_1", "stephenson_2", "stephenson_1", "stephenson_3"
NAMES = {**SIXBAR_NAMES, "eightbar": "Eightbar"}
FOURBAR_TASK = [FIVE[0], FIVE[1], {"x": 70.0, "y": 20.0, "angle": 30.0}]


def answered(client, **more) -> dict[str, Any]:
    body = finished(client, TASK | more)
    assert body["status"] == "succeeded", body
    return body


def passed(body) -> list[dict[str, Any]]:
    return [design for design in body["result"]["designs"] if design["verification"]["passed"]]


def held_against_loops(design, positions, only: Sequence[int] | None = None) -> None:
    """The design follows its loops through all positions, or some, on one branch, and transmits as it says."""
    inputs = np.radians([target["input_angle"] for target in design["targets"]])
    assert np.all(np.diff(inputs) > 0.0) or np.all(np.diff(inputs) < 0.0)
    loops = Loops(design["mechanism"]["skeleton"])
    met = loops.followed(inputs - inputs[0])
    assert met.branch > 0.0
    size = max(abs(complex(p["x"] - q["x"], p["y"] - q["y"])) for p in positions for q in positions)
    for k in range(len(positions)) if only is None else only:
        position = positions[k]
        assert abs(met.points[k] - complex(position["x"], position["y"])) < 1e-7 * size
        turn = np.radians(position["angle"] - positions[0]["angle"])
        assert abs(np.exp(1j * met.turns[k]) - np.exp(1j * turn)) < 1e-7
    seen = loops.transmission(met, find_dyad_pins(design["mechanism"]["type"], loops))
    assert design["metrics"]["transmission_angles"] == pytest.approx(seen, abs=0.05)


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.parametrize("kind", further([*SIXBARS, "eightbar"], ["watt_1", "eightbar"]))
def test_every_type_is_solved_proved_drawn_and_driven(client, kind):
    body = answered(client, mechanisms=[kind])
    designs = passed(body)
    assert len(designs) == 2
    for design in designs:
        assert design["mechanism"]["type"] == kind
        assert design["metrics"]["min_transmission_angle"] >= 20.0
        assert design["metrics"]["reach"] <= 5.0
        held_against_loops(design, FIVE)
    place = f"/v1/jobs/{body['id']}/designs/0"
    root = ET.fromstring(client.get(f"{place}.svg").text)
    assert {e.get("data-joint") for e in root.iter()} - {None} == set(designs[0]["mechanism"]["skeleton"]["joints"])
    assert NAMES[kind] in client.get(f"{place}.svg").text
    for ending in ("dxf", "csv"):
        assert client.get(f"{place}.{ending}").status_code == 200, ending
    motion = client.get(f"{place}/motion?steps=72").json()
    assert_as_documented(motion)
    assert sum(motion["valid"]) > 3
    analysed = client.post("/v1/analyses", json={"mechanism": designs[0]["mechanism"]})
    assert analysed.status_code == 200, analysed.text
    assert analysed.json()["classification"]["mobility"] == 1
    assert client.get(f"/v1/jobs/{body['id']}/report.html").status_code == 200


@pytest.mark.campaign
@pytest.mark.parametrize("count", further([2, 4], []))
def test_fewer_positions_are_met_by_sixbars_too(client, count):
    positions = FIVE[:count]
    for design in passed(answered(client, positions=positions)):
        assert len(design["targets"]) == count
        held_against_loops(design, positions)


@pytest.mark.campaign
def test_positions_within_tolerances(client):
    positions = [position | {"tolerance": {"x": 2.0, "y": 2.0, "angle": 2.0}} for position in FIVE]
    designs = passed(answered(client, positions=positions))
    assert len(designs) == 2
    for design in designs:
        check = next(c for c in design["verification"]["checks"] if c["name"] == "within_tolerance")
        assert check["passed"]
        assert all(t["point_residual"] <= 2.9 and t["angle_residual"] <= 2.0 for t in design["targets"])


def test_auto_takes_the_fourbar_where_one_is_sound(client):
    plain = {k: v for k, v in TASK.items() if k != "mechanisms"} | {"positions": FOURBAR_TASK}
    without = finished(client, plain)["result"]
    auto = answered(client, positions=FOURBAR_TASK, mechanisms="auto")["result"]
    assert auto == without
    assert {design["mechanism"]["type"] for design in auto["designs"]} == {"fourbar"}


@pytest.mark.campaign
def test_auto_takes_sixbars_where_no_fourbar_is_sound_and_says_so(client):
    result = answered(client, mechanisms="auto")["result"]
    assert {design["mechanism"]["type"] for design in result["designs"]} <= set(SIXBARS)
    assert "No fourbar or slider-crank solves this; sixbars do." in result["summary"]
    assert "no fourbar exists" in result["summary"]


@pytest.mark.campaign
def test_types_that_were_not_tried_are_not_said_to_fail(client):
    result = answered(client, mechanisms=["slider_crank", "watt_1"], max_designs=1)["result"]
    assert "No linkage of the requested types was found except sixbars." in result["summary"]
    assert "No fourbar or slider-crank" not in result["summary"]


def test_auto_looks_for_sliders_too(client):
    turned = cmath.rect(1.0, 0.3)
    pin, crank = 30.0 - 10.0j, 25.0
    # P is at the slider, the crank's pin at a distance of 90 from it.
    angles = [0.3, 0.8, 1.2, 1.6, 2.1]
    pins = [crank * cmath.rect(1.0, angle) + pin for angle in angles]
    along = [(z / turned).real + math.sqrt(90.0**2 - (z / turned).imag ** 2) for z in pins]
    poses = [
        {"x": (x * turned).real, "y": (x * turned).imag, "angle": math.degrees(cmath.phase(x * turned - z))}
        for x, z in zip(along, pins, strict=True)
    ]
    plain = {k: v for k, v in TASK.items() if k != "mechanisms"} | {"positions": poses}
    without = finished(client, plain)["result"]
    assert {design["mechanism"]["type"] for design in without["designs"]} == {"slider_crank"}
    assert answered(client, positions=poses, mechanisms="auto")["result"] == without


def test_a_list_has_no_inverted_slider_crank_that_it_does_not_name(client):
    pivot, offset = 60.0 + 15.0j, 12.0
    # A line of the body, 12 from the crank's pin, slides through the pivot.
    pins = [25.0 * cmath.rect(1.0, angle) for angle in (0.3, 0.8, 1.2, 1.6, 2.1)]
    turns = [cmath.phase(pivot - z) - math.asin(offset / abs(pivot - z)) for z in pins]
    poses = [{"x": z.real, "y": z.imag, "angle": math.degrees(turn)} for z, turn in zip(pins, turns, strict=True)]
    poses = [
        pose | {"x": pose["x"] + 20.0 * math.cos(turn), "y": pose["y"] + 20.0 * math.sin(turn)}
        for pose, turn in zip(poses, turns, strict=True)
    ]
    plain = {k: v for k, v in TASK.items() if k != "mechanisms"} | {"positions": poses}
    without = finished(client, plain)["result"]
    assert {design["mechanism"]["type"] for design in passed({"result": without})} == {"inverted_slider_crank"}
    listed = answered(client, positions=poses, mechanisms=["fourbar", "slider_crank"])["result"]
    assert {design["mechanism"]["type"] for design in listed["designs"]} <= {"fourbar", "slider_crank"}
    assert answered(client, positions=poses, mechanisms="auto")["result"] == without


def _as_of(sort: str, least: float) -> SimpleNamespace:
    """As much of a design as decides what is offered."""
    angle = SimpleNamespace(min_transmission_angle=least)
    return SimpleNamespace(name=sort, metrics=angle, verification=SimpleNamespace(passed=True))


@pytest.mark.parametrize(
    ("fourbar", "sixbars", "most", "offered", "told"),
    [
        (10.0, [15.0, 8.0], 5, [15.0, 10.0], "sixbars exceed it and are listed with it."),
        (10.0, [9.0, 8.0], 5, [10.0], "no sixbar found exceeds it."),
        (10.0, [15.0, 14.0, 13.0], 2, [15.0, 10.0], "sixbars exceed it and are listed with it."),
        (10.0, [15.0], 1, [15.0], "sixbars exceed it and are listed in its place."),
    ],
)
def test_what_is_offered_beside_a_fourbar_is_what_is_told(monkeypatch, fourbar, sixbars, most, offered, told):
    monkeypatch.setattr(type_selection, "make_ranking", lambda _: partial(sorted, key=_least, reverse=True))
    problem = SimpleNamespace(max_designs=most, rank_by="quality", is_listed_later=False)
    results = [
        MotionResult.model_construct(
            designs=[_as_of("design", angle) for angle in angles],
            search=Search(method="a", complete=False, candidates=9, accepted=len(angles),
                          rejected={"residual": 9 - len(angles)}, seed=0),
            summary="",
        )
        for angles in ([fourbar], sixbars)
    ]  # fmt: skip
    answer = type_selection.merge_type_results(problem, *results)
    assert [_least(design) for design in answer.designs] == offered
    assert told in answer.summary
    assert answer.search.accepted == len(offered)
    assert answer.search.candidates == 18 == answer.search.accepted + sum(answer.search.rejected.values())


def _least(design) -> float:
    return design.metrics.min_transmission_angle


NINE = {"positions": on_a_way(np.random.default_rng(1), 9), "method": "least_squares"}


@pytest.mark.parametrize(
    ("stated", "sixbar_error", "searched", "told"),
    [
        (NINE | {"mechanisms": "auto"}, 0.02, ["simple", "sixbar"], "sixbars have at most half of that"),
        (NINE | {"mechanisms": "auto"}, 0.04, ["simple", "sixbar", "eightbar"], "fewer links has a root-mean-square"),
        (NINE | {"mechanisms": ["fourbar", "eightbar"]}, 0.02, ["simple", "eightbar"], "eightbars have at most half"),
        (NINE | {"mechanisms": ["watt_1", "eightbar"]}, 0.04, ["sixbar", "eightbar"], "eightbars have at most half"),
        ({"mechanisms": "auto"}, 0.04, ["simple", "sixbar"], "no sixbar found exceeds it"),
        ({"mechanisms": ["watt_1", "eightbar"]}, 0.0, ["sixbar", "eightbar"], "no eightbar found exceeds it"),
    ],
)
def test_eightbars_follow_sixbars_that_miss_by_far(monkeypatch, stated, sixbar_error, searched, told):
    called: list[str] = []

    def build_solver(name: str, error: float):
        def solve(_problem, _progress) -> MotionResult:
            called.append(name)
            metrics = SimpleNamespace(min_transmission_angle=15.0, rms_residual=error)
            if "method" in stated:
                metrics.min_transmission_angle = 30.0
            design = SimpleNamespace(name=name, metrics=metrics, verification=SimpleNamespace(passed=True))
            search = Search(method="a", complete=False, candidates=1, accepted=1, rejected={}, seed=0)
            return MotionResult.model_construct(designs=[design], search=search, summary="")

        return solve

    monkeypatch.setattr(type_selection, "make_ranking", lambda _: list)
    monkeypatch.setattr(type_selection, "solve_sixbars", build_solver("sixbar", sixbar_error))
    monkeypatch.setattr(type_selection, "solve_eightbars", build_solver("eightbar", 0.01))
    answer = type_selection.solve_types(
        parse_problem(TASK | stated), build_solver("simple", 0.2), lambda *_: None
    )  # fmt: skip
    assert called == searched
    assert told in answer.summary


@pytest.mark.slow
def test_seven_positions_are_met_by_sixbars(client):
    positions = on_a_way(np.random.default_rng(2), 7)
    body = answered(client, positions=positions, mechanisms=list(SIXBARS), seed=2)
    designs = passed(body)
    assert designs
    for design in designs:
        held_against_loops(design, positions)
        assert design["metrics"]["min_transmission_angle"] >= 20.0


@pytest.mark.campaign
def test_of_nine_positions_the_ends_are_met_and_the_rest_nearer_than_by_fourbars(client):
    positions = on_a_way(np.random.default_rng(1), 9)
    for end in (positions[0], positions[-1]):
        end["exact"] = True
    body = answered(client, positions=positions, mechanisms="auto", max_designs=3)
    designs = passed(body)
    assert designs[0]["mechanism"]["type"] in NAMES
    held_against_loops(designs[0], positions, only=[0, 8])
    alone = passed(finished(client, {k: v for k, v in TASK.items() if k != "mechanisms"} | {"positions": positions}))
    errors = [one["metrics"]["rms_residual"] for one in (designs[0], *alone)]
    assert all(2.0 * errors[0] < error for error in errors[1:])
    assert errors[0] < 0.05


@pytest.mark.campaign
@pytest.mark.timeout(700)
def test_many_positions_of_a_sixbar_are_met_again_under_its_demands(client):
    """24 of a planted Watt I, which transmits with 20° and stays within a box."""
    positions = planted(np.random.default_rng(0), list_forms("watt_1", guides=True)[0], 24)
    size = max(abs(complex(p["x"] - q["x"], p["y"] - q["y"])) for p in positions for q in positions)
    far = 6.0 * size
    box = [[-far, -far], [far, far]]
    demands = {"constraints": {"min_transmission_angle": 20.0}, "space": {"box": box}}
    body = finished(client, TASK | demands | {"positions": positions}, 600.0)
    best = passed(body)[0]
    assert best["metrics"]["rms_residual"] < 1e-6
    assert best["metrics"]["min_transmission_angle"] >= 20.0
    inputs = np.radians([target["input_angle"] for target in best["targets"]])
    met = Loops(best["mechanism"]["skeleton"]).followed(inputs - inputs[0])
    assert met.branch > 0.0
    assert len(inputs) == 24
    assert np.abs(met.points - [complex(p["x"], p["y"]) for p in positions]).max() < 1e-5 * size
    turned = np.exp(1j * met.turns) - np.exp(1j * np.radians([p["angle"] - positions[0]["angle"] for p in positions]))
    assert np.abs(turned).max() < 1e-5
    places = np.array([list(place.values()) for place in met.places])
    assert max(np.abs(places.real).max(), np.abs(places.imag).max()) <= far


@pytest.mark.campaign
def test_more_than_five_positions_are_fitted_by_fourbars_where_sixbars_lack_something(client):
    stated = {"positions": SIX, "input_side": {"fixed_pivot": [40.0, -80.0]}, "include_failed": True}
    result = answered(client, mechanisms="auto", **stated)["result"]
    without = finished(client, {k: v for k, v in TASK.items() if k != "mechanisms"} | stated)["result"]
    assert result["designs"] == without["designs"]
    assert [design["mechanism"]["fixed_pivots"]["input"] for design in result["designs"]] == 2 * [[40.0, -80.0]]
    assert "Sixbars were not searched: they do not support input_side." in result["summary"]


@pytest.mark.campaign
@pytest.mark.parametrize(
    ("stated", "field"),
    [
        ({"ground_line": {"point": [0.0, -50.0], "angle": 0.0}}, "ground_line"),
        ({"input_side": {"fixed_pivot": [40.0, -80.0]}}, "input_side"),
        ({"manufacture": {"round": {"length": 0.5, "coordinates": 0.5}}}, "manufacture"),
    ],
)
def test_auto_takes_what_sixbars_cannot_keep_and_says_that_it_has_none(client, stated, field):
    plain = {"kind": "motion", "positions": FIVE[:3], "max_designs": 2, **stated}
    without = finished(client, plain)["result"]
    auto = finished(client, plain | {"mechanisms": "auto"})["result"]
    assert auto["designs"] == without["designs"]
    assert auto["search"] == without["search"]
    assert f"Sixbars were not searched: they do not support {field}." in auto["summary"]


@pytest.mark.parametrize("types", [["fourbar"], ["slider_crank"]])
def test_types_of_two_dyads_alone(client, types):
    result = answered(client, positions=FOURBAR_TASK, mechanisms=types)["result"]
    assert {design["mechanism"]["type"] for design in result["designs"]} == set(types)


@pytest.mark.parametrize(
    "chain",
    [
        pytest.param({"links": [120.0, None], "elbow": "left"}, marks=pytest.mark.campaign),
        {"fixed_pivot": [20.0, -120.0], "moving_pivot": [0.0, -14.0]},
    ],
)
def test_the_chain_is_kept_as_it_is_stated(client, chain):
    body = answered(client, mechanisms=list(SIXBARS), chain=chain)
    assert "Stephenson II sixbars were not searched: they do not support chain." in body["result"]["summary"]
    designs = passed(body)
    assert designs
    for design in designs:
        skeleton = design["mechanism"]["skeleton"]
        joints = {name: complex(*place) for name, place in skeleton["joints"].items()}
        links = {link["name"]: set(link["joints"]) for link in skeleton["links"]}
        body = next(name for name, on in links.items() if "P" in on)
        chains = [
            (pivot, knee, pin)
            for one in links.keys() - {"ground", body}
            for two in links.keys() - {"ground", body, one}
            for pivot in links["ground"] & links[one]
            for knee in links[one] & links[two]
            for pin in links[two] & links[body]
        ]
        assert any(kept(chain, *(joints[name] for name in names)) for names in chains)
        assert next(c for c in design["verification"]["checks"] if c["name"] == "chain")["passed"]


@pytest.mark.campaign
@pytest.mark.parametrize(
    "stated",
    [
        {"chain": {"links": [700.0, None]}, "constraints": {"max_link_ratio": 50.0}},
        pytest.param(
            {"constraints": {"fixed_pivot_region": {"x": [1600.0, 2900.0], "y": [-1000.0, 1000.0]}}},
            marks=pytest.mark.campaign,
        ),
    ],
)
def test_limits_that_nobody_stated_do_not_exclude_what_is_stated(client, stated):
    designs = passed(answered(client, **stated))
    assert designs
    assert all(design["metrics"]["reach"] > 5.0 for design in designs)


@pytest.mark.slow
def test_a_chain_gives_a_body_that_only_turns_its_size(client):
    positions = [{"x": 0.0, "y": 0.0, "angle": angle} for angle in (0.0, 30.0, 60.0)]
    designs = passed(answered(client, positions=positions, chain={"fixed_pivot": [100.0, None]}))
    assert len(designs) == 2
    for design in designs:
        assert design["metrics"]["min_transmission_angle"] >= 20.0
        assert design["metrics"]["reach"] <= 5.0


def test_a_chain_is_not_refused_for_a_place_of_the_body_that_may_be_missed(client):
    chain = {"links": [60.0, 60.0], "fixed_pivot": [0.0, -120.5], "moving_pivot": [0.0, 0.0]}
    near = {"x": 4.0, "y": 1.0, "angle": 8.0}
    for first, status in ((FIVE[0], 422), (FIVE[0] | {"tolerance": 2.0}, 202)):
        problem = TASK | {"positions": [first, near], "chain": chain}
        assert client.post("/v1/jobs", json={"problem": problem}).status_code == status


def kept(chain, pivot, knee, pin) -> bool:
    wanted = [
        *zip((abs(knee - pivot), abs(pin - knee)), chain.get("links", [None, None]), strict=True),
        *zip((pivot.real, pivot.imag), chain.get("fixed_pivot", [None, None]), strict=True),
        *zip((pin.real, pin.imag), chain.get("moving_pivot", [None, None]), strict=True),
    ]
    left = ((pin - pivot).conjugate() * (knee - pivot)).imag > 0.0
    bends = chain.get("elbow", "any") in ("any", "left" if left else "right")
    return bends and all(stated is None or abs(value - stated) < 1e-6 for value, stated in wanted)


@pytest.mark.campaign
@pytest.mark.parametrize(
    "constraints",
    [
        pytest.param(
            {"full_rotation": True, "grashof": "crank_rocker", "min_transmission_angle": 30.0},
            marks=pytest.mark.campaign,
        ),
        {
            "max_link_ratio": 4.0,
            "link_length": {"min": 30.0, "max": 200.0},
            "fixed_pivot_region": {"x": [-50.0, 100.0], "y": [-150.0, -50.0]},
        },
    ],
)
def test_constraints_hold_for_every_pivot_and_link(client, constraints):
    designs = passed(answered(client, mechanisms=list(SIXBARS), constraints=constraints))
    assert designs
    for design in designs:
        metrics, mechanism = design["metrics"], design["mechanism"]
        lengths = mechanism["links"].values()
        assert metrics["full_rotation"] or not constraints.get("full_rotation")
        assert metrics["grashof"] == constraints.get("grashof", metrics["grashof"])
        assert metrics["min_transmission_angle"] >= constraints.get("min_transmission_angle", 0.0)
        assert max(lengths) / min(lengths) <= constraints.get("max_link_ratio", 1e9) * (1.0 + 1e-9)
        stated = constraints.get("link_length", {"min": 0.0, "max": 1e9})
        assert stated["min"] <= min(lengths)
        assert max(lengths) <= stated["max"]
        region = constraints.get("fixed_pivot_region", {"x": [-1e9, 1e9], "y": [-1e9, 1e9]})
        for x, y in mechanism["fixed_pivots"].values():
            assert region["x"][0] <= x <= region["x"][1]
            assert region["y"][0] <= y <= region["y"][1]
        held_against_loops(design, FIVE)


@pytest.mark.campaign
def test_room_planes_and_forces_hold_together(client):
    body = answered(
        client,
        mechanisms=list(SIXBARS),
        max_designs=1,
        space={"box": [[-60.0, -160.0], [200.0, 100.0]], "link_width": 4.0},
        layout={"link_width": 4.0, "pin_diameter": 3.0, "thickness": 3.0},
        dynamics={"links": {"density": 7.8e-6, "thickness": 3.0, "width": 4.0}, "speed_rpm": 10.0},
        constraints={"max_joint_force": 1e9},
    )
    (design,) = passed(body)
    names = {check["name"] for check in design["verification"]["checks"]}
    assert {"box", "joint_force"} <= names
    assert {link["name"] for link in design["mechanism"]["skeleton"]["links"]} - {"ground"} == set(
        design["layout"]["planes"]
    )
    for x, y in design["mechanism"]["skeleton"]["joints"].values():
        assert -60.0 <= x <= 200.0
        assert -160.0 <= y <= 100.0


@pytest.mark.parametrize(
    ("changed", "path"),
    [
        ({"mechanisms": []}, "/problem/mechanisms"),
        ({"mechanisms": ["watt_2"]}, "/problem/mechanisms"),
        ({"mechanisms": "fourbar"}, "/problem/mechanisms"),
        ({"input_side": {"fixed_pivot": [0.0, 0.0]}}, "/problem/input_side"),
        ({"output_side": {"dyad": "PR"}}, "/problem/output_side"),
        ({"ground_line": {"point": [0.0, 0.0], "angle": 0.0}}, "/problem/ground_line"),
        ({"driver_dyad": True}, "/problem/driver_dyad"),
        ({"manufacture": {"tolerances": {"length": 0.1}}}, "/problem/manufacture"),
        ({"space": {"fixed_pivots": {"input": {"circle": {"center": [0, 0], "radius": 9}}}}}, "/problem/space"),
        ({"positions": on_a_way(np.random.default_rng(0), 61)}, "/problem/mechanisms"),
        ({"positions": SIX, "chain": {"elbow": "left"}}, "/problem/chain"),
        ({"method": "least_squares", "chain": {"elbow": "left"}}, "/problem/chain"),
        ({"mechanisms": ["fourbar"], "chain": {"elbow": "left"}}, "/problem/chain"),
        ({"chain": {"elbow": "up"}}, "/problem/chain/elbow"),
        ({"chain": {"links": [1.0, 0.0]}}, "/problem/chain/links"),
        (
            {"chain": {"links": [10.0, 10.0], "fixed_pivot": [0.0, -90.0], "moving_pivot": [0.0, 0.0]}},
            "/problem/chain/links",
        ),
        ({"mechanisms": "auto", "chain": {"elbow": "left"}}, "/problem/chain"),
        ({"mechanisms": ["fourbar", "watt_1"], "chain": {"elbow": "left"}}, "/problem/chain"),
        ({"mechanisms": "auto", "positions": SIX, "chain": {"elbow": "left"}}, "/problem/chain"),
        ({"mechanisms": ["stephenson_2"], "constraints": {"grashof": "crank_rocker"}}, "/problem/constraints/grashof"),
        (
            {"mechanisms": ["stephenson_2"], "constraints": {"full_rotation": True}},
            "/problem/constraints/full_rotation",
        ),
        ({"mechanisms": ["fourbar", "stephenson_2"], "chain": {"elbow": "left"}}, "/problem/chain"),
        ({"mechanisms": ["slider_crank"], "driver_dyad": True}, "/problem/driver_dyad"),
        ({"mechanisms": ["slider_crank"], "constraints": {"grashof": "double_crank"}}, "/problem/constraints/grashof"),
        (
            {"mechanisms": ["slider_crank"], "positions": FIVE[:2], "ground_line": {"point": [0.0, 0.0], "angle": 0.0}},
            "/problem/ground_line",
        ),
        (
            {"mechanisms": ["slider_crank"], "positions": FIVE[:2], "output_side": {"fixed_pivot": [0.0, 0.0]}},
            "/problem/output_side/fixed_pivot",
        ),
        ({"mechanisms": ["fourbar"], "output_side": {"dyad": "PR"}}, "/problem/mechanisms"),
        ({"mechanisms": ["slider_crank"], "output_side": {"dyad": "RP"}}, "/problem/mechanisms"),
        ({"mechanisms": ["slider_crank"], "output_side": {"dyad": "RR"}}, "/problem/mechanisms"),
    ],
)
def test_what_cannot_be_had_is_refused_at_its_field(client, changed, path):
    answer = client.post("/v1/jobs", json={"problem": TASK | changed})
    assert answer.status_code == 422, answer.text
    assert any(fault["path"].startswith(path) for fault in answer.json()["errors"]), answer.text


@pytest.mark.campaign
def test_a_body_that_turns_about_one_point_has_many_cranks_and_is_carried(client):
    positions = [{"x": 5.0, "y": 5.0, "angle": 12.0 * k} for k in range(5)]
    designs = passed(answered(client, positions=positions, mechanisms=["stephenson_2"], max_designs=1))
    (design,) = designs
    assert all(target["point_residual"] < 1e-7 and target["angle_residual"] < 1e-7 for target in design["targets"])
