"""The block ``manufacture`` through HTTP: every field of it, beside other demands; and what is refused."""

from __future__ import annotations

import copy
import json
from typing import Any

import pytest

from synthesis.model.manufacture.request import Manufacture
from synthesis.registry import list_examples
from tests.service.stated.linkages import BOTH_OPEN, DRIVEN, MOTION, PATH, QUICK_RETURN, TOLERATED
from tests.statements import fields
from tests.support.service.answers import finished
from tests.support.service.space import TURNS

OPEN = {**MOTION, **BOTH_OPEN}
BLOCK = {
    "tolerances": {"length": 0.1, "pivot": 0.05},
    "quality": {"max_error": 0.2, "max_angle_error": 0.2},
    "samples": 8001,
}
ANGLES = {
    "tolerances": {"length": 0.004, "pivot": 0.002},
    "quality": {"max_angle_error": 0.004},
    "samples": 8001,
}
POINTS = {"tolerances": {"length": 0.05}, "quality": {"max_error": 0.05}, "samples": 8001}


def changed(block: dict[str, Any], place: str, value: Any) -> dict[str, Any]:
    block = copy.deepcopy(block)
    *outer, last = place.split(".")
    at = block
    for name in outer:
        at = at.setdefault(name, {})
    at[last] = value
    return block


ANSWERED: dict[str, Any] = {}
"""What was answered to each problem: many tests begin from one."""


def made(client, problem, block):
    stated = {**problem, "manufacture": block}
    key = json.dumps(stated, sort_keys=True)
    if key not in ANSWERED:
        job = finished(client, stated)
        assert job["status"] == "succeeded", job["error"]
        ANSWERED[key] = job["result"]
    return ANSWERED[key]


GRID = {"round": {"length": 0.5, "coordinates": 0.5}}
SLIDES = {**OPEN, "output_side": {"dyad": "PR", "slide_angle": 15.0}}

LOGARITHM = {**list_examples("function")[2], "max_designs": 2}
TRAVELS = {"tolerances": {"length": 0.1}, "quality": {"max_error": 40.0}, "samples": 1000, **GRID}

FIELDS: dict[str, Any] = {
    "round": {"length": 0.5, "coordinates": 0.5},
    "round.length": 1.0,
    "round.coordinates": 1.0,
    "stock": {"links": [85.0, 115.0]},
    "stock.links": [85.0, 110.0, 115.0],
    "widest": True,
    "tolerances": {"length": 0.2},
    "tolerances.length": 0.3,
    "tolerances.pivot": 0.3,
    "tolerances.pin_clearance": 0.02,
    "distribution": "normal",
    "quality": {"max_error": 0.15},
    "quality.max_error": 0.1,
    "quality.max_angle_error": 0.1,
    "quality.yield": 0.9,
    "input": "fixed",
    "samples": 9001,
    "seed": 12,
}
"""Of each field another value than that of the block."""


def test_every_field_has_a_value():
    assert FIELDS.keys() == fields(Manufacture.model_json_schema()).keys()


@pytest.mark.slow
@pytest.mark.parametrize("name", FIELDS)
def test_a_field_makes_another_answer(client, name):
    outer = name.partition(".")[0]
    base, block = (LOGARITHM, TRAVELS) if outer in ("round", "stock") else (MOTION, BLOCK)
    if name == "widest":
        block = changed(BLOCK, "quality.yield", 0.5)
    if name == "round":
        block = {field: value for field, value in TRAVELS.items() if field != "round"}
    assert made(client, base, changed(block, name, FIELDS[name])) != made(client, base, block)


@pytest.mark.slow
def test_designs_are_those_on_the_grid_with_the_exact_ones_beside_them(client):
    """Beside a room, planes, a limit of the angle, a yield, and the order by it."""
    demands = {
        "space": {"box": [[-400.0, -400.0], [400.0, 400.0]], "link_width": 10.0},
        "layout": {"link_width": 5.0, "pin_diameter": 4.0, "thickness": 4.0, "max_planes": 4},
        "constraints": {"min_transmission_angle": 30.0},
        "max_designs": 2,
    }
    block = {**BLOCK, **GRID, "quality": {"max_error": 0.5, "max_angle_error": 0.5, "yield": 0.5}}
    job = finished(client, {**SLIDES, **demands, "manufacture": block})
    assert len(job["result"]["designs"]) == 2
    for n, design in enumerate(job["result"]["designs"]):
        checks = {check["name"]: check for check in design["verification"]["checks"]}
        named = {"max_error", "max_angle_error", "yield", "box", "planes", "transmission_angle"}
        assert named <= checks.keys()
        assert all(check["passed"] for check in checks.values())
        dimensions = design["manufacture"]["dimensions"]
        assert dimensions.keys() == {one["dimension"] for one in design["manufacture"]["sensitivities"]}
        assert all(float(2.0 * value).is_integer() for value in dimensions.values())
        links, pivot = design["mechanism"]["links"], design["mechanism"]["fixed_pivot"]
        assert [*pivot, links["crank"], links["coupler"]] == [
            dimensions[name] for name in ("fixed_pivot.x", "fixed_pivot.y", "links.crank", "links.coupler")
        ]
        exact, cost = design["exact"], design["manufacture"]["cost"]
        assert exact["rms_residual"] < 1e-9 < design["metrics"]["rms_residual"]
        assert cost["rms_residual"] == pytest.approx(design["metrics"]["rms_residual"], abs=1e-9)
        assert cost["max_error"] == pytest.approx(checks["max_error"]["value"], abs=1e-9)
        assert exact["mechanism"]["links"] != links
        svg = client.get(f"/v1/jobs/{job['id']}/designs/{n}.svg")
        assert svg.status_code == 200
        motion = client.get(f"/v1/jobs/{job['id']}/designs/{n}/motion").json()
        assert motion["joints"].keys() >= {"A", "B", "P"}
    report = client.get(f"/v1/jobs/{job['id']}/report.html")
    assert report.status_code == 200, report.text
    assert "Exact: rms residual" in report.text


def test_designs_are_told_as_they_are_made_and_still_drawn(server, client):
    job = finished(client, {**MOTION, "manufacture": BLOCK})
    designs = job["result"]["designs"]
    assert designs
    for n, design in enumerate(designs):
        told, told_yield = design["manufacture"], design["metrics"]["yield"]
        assert told_yield.keys() == {"value", "low", "high", "samples"}
        assert 0.0 <= told_yield["low"] <= told_yield["value"] <= told_yield["high"] <= 1.0
        assert told["seed"] == 0
        assert told["worst_case"].keys() == {"assembles", "max_error", "max_angle_error"}
        assert {one["dimension"] for one in told["sensitivities"]} == {
            *(f"fixed_pivots.{side}.{axis}" for side in ("input", "output") for axis in "xy"),
            *(f"links.{link}" for link in ("input", "coupler", "output")),
            *(f"coupler_point.{way}" for way in ("along", "across")),
        }
        for one in told["sensitivities"]:
            assert one["tolerance"] == (0.05 if one["dimension"].startswith("fixed") else 0.1)
            assert len(one["x"]) == len(one["y"]) == len(one["angle"]) == len(design["targets"])
        assert client.get(f"/v1/jobs/{job['id']}/designs/{n}.svg").status_code == 200
    report = client.get(f"/v1/jobs/{job['id']}/report.html")
    assert report.status_code == 200, report.text
    assert "Manufacture: worst case: max error" in report.text
    assert "Yield: low" in report.text
    with server.solving_anew():
        again = finished(client, job["problem"], fresh=True)
    assert again["result"] == job["result"]


@pytest.mark.parametrize(
    ("problem", "block", "quantities"),
    [
        (MOTION, BLOCK, {"x", "y", "angle"}),
        ({**PATH, "max_designs": 2}, POINTS, {"x", "y"}),
        (TURNS, ANGLES, {"angle"}),
    ],
    ids=["motion", "path", "function"],
)
def test_a_kind_tells_what_it_measures(client, problem, block, quantities):
    for design in made(client, problem, block)["designs"]:
        assert 0.0 < design["metrics"]["yield"]["value"] < 1.0
        for one in design["manufacture"]["sensitivities"]:
            assert one.keys() == quantities | {"dimension", "tolerance", "share", "transmission"}


def test_without_the_block_there_is_nothing_of_it(client):
    job = finished(client, MOTION)
    assert job["problem"]["manufacture"] is None
    for design in job["result"]["designs"]:
        assert "manufacture" not in design
        assert "yield" not in design["metrics"]


def test_tolerances_alone_have_no_yield(client):
    for design in made(client, MOTION, {"tolerances": {"length": 0.1}})["designs"]:
        assert "yield" not in design["metrics"]
        assert design["manufacture"].keys() == {"worst_case", "matter", "sensitivities"}


def test_beside_a_room_planes_and_constraints(client):
    """All demands hold at once: each of them has its check."""
    demands = {
        "space": {"box": [[-400.0, -400.0], [400.0, 400.0]], "link_width": 10.0},
        "layout": {"link_width": 5.0, "pin_diameter": 4.0, "thickness": 4.0, "max_planes": 4},
        "constraints": {"min_transmission_angle": 5.0, "link_length": {"max": 300.0}},
        "rank_by": "yield",
    }
    block = changed(BLOCK, "quality", {"max_error": 0.4, "max_angle_error": 0.4, "yield": 0.5})
    (design,) = made(client, {**MOTION, **demands}, block)["designs"]
    checks = {check["name"]: check for check in design["verification"]["checks"]}
    assert {"yield", "box", "planes", "transmission_angle", "longest_link"} <= checks.keys()
    assert all(check["passed"] for check in checks.values())
    assert checks["yield"]["limit"] == 0.5 <= checks["yield"]["value"] == design["metrics"]["yield"]["low"]
    none = made(client, {**MOTION, **demands, "constraints": {"min_transmission_angle": 11.0}}, block)
    assert [gap["check"] for gap in none["nearest_miss"]["gaps"]] == ["transmission_angle"]


@pytest.mark.slow
def test_play_is_told_at_every_target_and_grows_with_the_clearance(client):
    one, two = (
        made(client, MOTION, {"tolerances": {"pin_clearance": clearance}})["designs"][0] for clearance in (0.001, 0.002)
    )
    for small, large, place in zip(
        one["manufacture"]["play"], two["manufacture"]["play"], MOTION["positions"], strict=True
    ):
        for quantity in ("max_error", "max_angle_error"):
            assert 1.9 < large[quantity] / small[quantity] < 2.2
        away = [abs(complex(*corner) - complex(place["x"], place["y"])) for corner in small["outline"]]
        assert 0.0 < min(away) <= small["max_error"] <= max(away)
    assert "yield" not in one["metrics"]


@pytest.mark.slow
def test_beside_tolerances_of_positions(client):
    stated = {**MOTION, **TOLERATED}
    (tight,), (wide,) = (
        made(client, stated, changed(BLOCK, "tolerances.length", length))["designs"] for length in (0.1, 0.4)
    )
    assert 0.0 < wide["metrics"]["yield"]["value"] < tight["metrics"]["yield"]["value"] < 1.0


def test_a_demand_that_none_keeps_is_told_as_the_nearest_miss(client):
    result = made(client, MOTION, changed(changed(BLOCK, "quality.yield", 0.99), "quality.max_error", 0.02))
    assert result["designs"] == []
    assert result["search"]["rejected"] == {"yield": 1}
    (gap,) = result["nearest_miss"]["gaps"]
    assert gap["check"] == "yield"
    assert gap["limit"] == 0.99
    assert gap["value"] == result["nearest_miss"]["design"]["metrics"]["yield"]["low"]


REFUSED: dict[str, tuple[dict[str, Any], Any, str]] = {
    "an empty block": (OPEN, {}, "/manufacture"),
    "a grid of nothing": (OPEN, {"round": {"length": 0.0, "coordinates": 1.0}}, "/manufacture/round/length"),
    "half a grid": (OPEN, {"round": {"length": 0.5}}, "/manufacture/round/coordinates"),
    "an empty stock": (OPEN, {"stock": {"links": []}}, "/manufacture/stock/links"),
    "a link of no length in stock": (OPEN, {"stock": {"links": [0.0]}}, "/manufacture/stock/links/0"),
    "pivots on the body that no grid keeps": (MOTION, GRID, "/manufacture/round"),
    "links that no stock keeps": (MOTION, {"stock": {"links": [40.0]}}, "/manufacture/stock"),
    "a yield of what is exact": (
        OPEN,
        {**GRID, "quality": {"max_error": 1.0, "yield": 0.9}},
        "/manufacture/tolerances",
    ),
    "a grid for another kind": (QUICK_RETURN, GRID, "/manufacture"),
    "no tolerances": (OPEN, {"quality": {"max_error": 0.1}}, "/manufacture/tolerances"),
    "tolerances of nothing": (OPEN, {**BLOCK, "tolerances": {}}, "/manufacture/tolerances"),
    "a quality of nothing": (OPEN, {**BLOCK, "quality": {"yield": 0.9}}, "/manufacture/quality"),
    "the widest for no yield": (OPEN, {**BLOCK, "widest": True}, "/manufacture/widest"),
    "a quality of play": (OPEN, {**BLOCK, "tolerances": {"pin_clearance": 0.1}}, "/manufacture/tolerances"),
    "a negative tolerance": (OPEN, changed(BLOCK, "tolerances.length", -0.1), "/manufacture/tolerances/length"),
    "a yield of all": (OPEN, changed(BLOCK, "quality.yield", 1.0), "/manufacture/quality/yield"),
    "a yield of none": (OPEN, changed(BLOCK, "quality.yield", 0.0), "/manufacture/quality/yield"),
    "too few samples for a yield": (OPEN, changed(BLOCK, "quality.yield", 0.9999), "/manufacture/samples"),
    "too many samples": (OPEN, {**BLOCK, "samples": 10_000_000}, "/manufacture/samples"),
    "too many samples for so many points": (
        {"kind": "path", "points": [{"x": float(k), "y": k * k * 0.01} for k in range(100)]},
        {**POINTS, "samples": 100_000},
        "/manufacture/samples",
    ),
    "no such distribution": (OPEN, {**BLOCK, "distribution": "triangular"}, "/manufacture/distribution"),
    "no such field": (OPEN, {**BLOCK, "process": "milled"}, "/manufacture/process"),
    "an angle of a path": (
        PATH,
        changed(POINTS, "quality.max_angle_error", 1.0),
        "/manufacture/quality/max_angle_error",
    ),
    "a distance of an output that turns": (
        TURNS,
        changed(ANGLES, "quality.max_error", 1.0),
        "/manufacture/quality/max_error",
    ),
    "inputs that are stated": (TURNS, {**ANGLES, "input": "adjusted"}, "/manufacture/input"),
    "a driver": ({**MOTION, **DRIVEN, "driver_dyad": True}, BLOCK, "/manufacture"),
    "a block that turns": ({**OPEN, "output_side": {"dyad": "RP"}}, BLOCK, "/manufacture"),
    "a slider that drives": ({**OPEN, "input_side": {"dyad": "PR"}}, BLOCK, "/manufacture"),
    "a fivebar": ({**PATH, "mechanism": "geared_fivebar"}, POINTS, "/manufacture"),
    "a place that is free": (
        {**PATH, "method": "curve_match", "placement_free": ["position"]},
        POINTS,
        "/manufacture",
    ),
    "a rank without a yield": ({**OPEN, "rank_by": "yield"}, {"tolerances": {"length": 0.1}}, "/rank_by"),
    "a number for the block": (OPEN, 3, "/manufacture"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_is_refused_by_its_field(client, name):
    problem, block, path = REFUSED[name]
    answer = client.post("/v1/jobs", json={"problem": {**problem, "manufacture": block}})
    assert answer.status_code == 422, answer.text
    assert f"/problem{path}" in [error["path"] for error in answer.json()["errors"]]


EXACTNESS = {name: BLOCK[name] for name in ("tolerances", "quality", "samples")}


@pytest.fixture(scope="module")
def design(server):
    job = finished(server.client, {**MOTION, "manufacture": BLOCK})
    return job["result"]["designs"][0]


def analysed(client, mechanism, targets, **more):
    return client.post("/v1/analyses", json={"mechanism": mechanism, "targets": targets, **more})


def test_an_analysis_tells_of_a_design_what_its_job_does(client, design):
    answer = analysed(client, design["mechanism"], MOTION["positions"], manufacture=EXACTNESS)
    assert answer.status_code == 200, answer.text
    told = answer.json()
    assert told["yield"] == design["metrics"]["yield"]
    assert told["manufacture"]["matter"] == design["manufacture"]["matter"]
    assert told["manufacture"]["worst_case"] == pytest.approx(design["manufacture"]["worst_case"])
    for target, met in zip(design["targets"], told["targets"], strict=True):
        assert met["input_angle"] == pytest.approx(target["input_angle"], abs=1e-6)
        assert max(met["point_residual"], met["angle_residual"]) < 1e-7


def test_a_client_checks_its_own_rounding(client, design):
    """Of a mechanism with lengths in whole numbers it is told what it misses, and how many will be good."""
    exact = design["mechanism"]
    pivots = {side: [round(z, 1) for z in place] for side, place in exact["fixed_pivots"].items()}
    links = {name: round(length, 1) for name, length in exact["links"].items() if name != "ground"}
    own = {
        "type": "fourbar",
        "fixed_pivots": pivots,
        "links": links,
        "coupler_point": exact["coupler_point"],
        "assembly": exact["assembly"],
        "reference_input_angle": exact["reference_input_angle"],
    }
    at = [
        {**place, "input_angle": target["input_angle"]}
        for place, target in zip(MOTION["positions"], design["targets"], strict=True)
    ]
    free, fixed = (
        analysed(client, own, targets, manufacture=EXACTNESS).json() for targets in (MOTION["positions"], at)
    )
    for near, there in zip(free["targets"], fixed["targets"], strict=True):
        assert 1e-4 < near["point_residual"] < 1.0
        assert near["input_angle"] == pytest.approx(there["input_angle"], abs=2.0)
        assert near["input_angle"] != there["input_angle"]
    assert free["yield"]["value"] < 1.0
    bare = analysed(client, own, MOTION["positions"]).json()
    assert bare["targets"] == free["targets"]
    assert "manufacture" not in bare
    assert "yield" not in bare


@pytest.mark.slow
def test_points_and_outputs_are_targets_too(client):
    path = finished(client, {**PATH, "max_designs": 1})["result"]["designs"][0]
    points = [{"x": point["x"], "y": point["y"]} for point in PATH["points"]]
    told = analysed(client, path["mechanism"], points, manufacture=POINTS).json()
    assert max(met["point_residual"] for met in told["targets"]) < 1e-6
    assert 0.0 < told["yield"]["value"] < 1.0
    turns = finished(client, {**TURNS, "max_designs": 1})["result"]["designs"][0]
    outputs = [{"output": met["output_place"], "input_angle": met["input_angle"]} for met in turns["targets"]]
    told = analysed(client, turns["mechanism"], outputs, manufacture=ANGLES).json()
    assert max(abs(met["error"]) for met in told["targets"]) < 1e-9
    whole = finished(client, {**TURNS, "max_designs": 1, "manufacture": ANGLES})["result"]["designs"][0]
    assert told["yield"] == whole["metrics"]["yield"]
    one = [{**outputs[0], "output": outputs[0]["output"] + 1.0}, *outputs[1:]]
    assert analysed(client, turns["mechanism"], one).json()["targets"][0]["error"] == pytest.approx(-1.0)


@pytest.mark.parametrize(
    "name", [name for name in FIELDS if name.partition(".")[0] not in ("round", "stock", "widest")]
)
def test_a_field_makes_another_analysis(client, design, name):
    answers = [
        analysed(client, design["mechanism"], MOTION["positions"], manufacture=block).json()
        for block in (EXACTNESS, changed(EXACTNESS, name, FIELDS[name]))
    ]
    assert answers[0] != answers[1]


FIVEBAR = {
    "type": "geared_fivebar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 1.0, "coupler_1": 7.0, "coupler_2": 7.0, "output": 1.2},
    "gear_ratio": -2.0,
    "phase": 30.0,
}
BARE = {
    "type": "fourbar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
}
POINT, POSE, OUTPUT = {"x": 1.0, "y": 2.0}, {"x": 1.0, "y": 2.0, "angle": 3.0}, {"output": 90.0, "input_angle": 10.0}
REFUSED_ANALYSES: dict[str, tuple[Any, Any, Any, str]] = {
    "a block without targets": (BARE, [], EXACTNESS, "/targets"),
    "no point": (BARE, [{"x": 1.0}], None, "/targets/0"),
    "an output without its input": (BARE, [{"output": 1.0}], None, "/targets/0"),
    "an output and a point": (BARE, [{**POINT, **OUTPUT}], None, "/targets/0"),
    "targets of two sorts": (BARE, [POINT, OUTPUT], None, "/targets/1"),
    "a body without a reference": (BARE, [POSE], None, "/mechanism/reference_input_angle"),
    "another mechanism": (FIVEBAR, [POINT], None, "/targets"),
    "no tolerances": (BARE, [POINT], {"quality": {"max_error": 1.0}}, "/manufacture/tolerances"),
    "an angle of a point": (BARE, [POINT], {**EXACTNESS}, "/manufacture/quality/max_angle_error"),
    "a demand": (BARE, [POINT], changed(POINTS, "quality.yield", 0.9), "/manufacture/quality/yield"),
    "a grid": (BARE, [POINT], {**POINTS, **GRID}, "/manufacture/round"),
    "inputs that are stated": (BARE, [OUTPUT], {**ANGLES, "input": "adjusted"}, "/manufacture/input"),
    "too many targets": (BARE, [POINT] * 201, None, "/targets"),
}


@pytest.mark.parametrize("name", REFUSED_ANALYSES)
def test_an_analysis_refuses_what_cannot_be_by_its_field(client, name):
    mechanism, targets, block, path = REFUSED_ANALYSES[name]
    more = {} if block is None else {"manufacture": block}
    answer = analysed(client, mechanism, targets, **more)
    assert answer.status_code == 422, answer.text
    assert path in [error["path"] for error in answer.json()["errors"]]
