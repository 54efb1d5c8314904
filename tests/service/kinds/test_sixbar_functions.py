"""Functions by sixbars through HTTP: solved, proved by another formulation, drawn, driven; refusals name the field."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from synthesis.kinds.function import type_selection
from synthesis.kinds.function.design import FunctionResult
from synthesis.model.answer import Search
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.oracles.loops import Loops
from tests.support.service.analyses import assert_as_documented
from tests.support.service.answers import finished
from tests.support.sixbars.driven import find_dyad_pins
from tests.support.sixbars.planted_functions import planted

SINE: dict[str, Any] = {
    "kind": "function",
    "function": {"name": "sine", "x": [0.0, 90.0]},
    "input_range": 90.0,
    "output_range": 90.0,
    "max_designs": 2,
}
FOURBARS_BEST = 0.1903
"""Degrees, the least greatest structural error of a fourbar for this."""

LONG_S = 800.0
"""A busy machine may need that long for all sixbars through nine pairs."""

TYPES = "watt_2", "stephenson_2", "stephenson_3"
PAIRS = [{"input": x, "output": round(20.0 + 0.9 * x + 12.0 * math.sin(x / 20.0), 6)} for x in range(0, 80, 10)]


def answered(client, **more) -> dict[str, Any]:
    body = finished(client, SINE | more)
    assert body["status"] == "succeeded", body
    return body


def passed(body) -> list[dict[str, Any]]:
    return [design for design in body["result"]["designs"] if design["verification"]["passed"]]


def shown_by_loops(design, values, outputs, *, off: float):
    """The output, driven by its loops through values of the input, is off what its dial should show by ``off`` degrees
    at most, and the linkage stays on one branch; its loops, and what they have met."""
    dials, skeleton = design["dials"], design["mechanism"]["skeleton"]
    at = {name: complex(*place) for name, place in skeleton["joints"].items()}
    links = {link["name"]: link["joints"] for link in skeleton["links"]}
    # The body that the loops follow is the output.
    traced = {
        **skeleton,
        "joints": {**skeleton["joints"], "P": skeleton["joints"][links["output"][1]]},
        "links": [
            {**link, "joints": [*link["joints"], "P"]} if link["name"] == "output" else link
            for link in skeleton["links"]
        ],
    }
    inputs = np.radians(
        [dials["input"]["place"] + dials["input"]["scale"] * (x - dials["input"]["at"]) for x in values]
    )
    first = np.angle(at["A"] - at["O2"])
    assert abs(math.remainder(inputs[0] - first, math.tau)) < 1e-9
    loops = Loops(traced)
    met = loops.followed(inputs - inputs[0])
    assert met.branch > 0.0
    pivot, pin = links["output"]
    stands = np.degrees(np.angle(at[pin] - at[pivot]) + met.turns)
    wanted = [dials["output"]["place"] + dials["output"]["scale"] * (y - dials["output"]["at"]) for y in outputs]
    errors = [math.remainder(one - other, 360.0) for one, other in zip(stands, wanted, strict=True)]
    assert max(map(abs, errors)) <= off + 1e-7
    return loops, met


def held_against_loops(design, values, outputs, *, off: float) -> None:
    """The same, and the linkage transmits as it says."""
    loops, met = shown_by_loops(design, values, outputs, off=off)
    told = design["metrics"]["transmission_angles"]
    pins = {"coupler": "B", "link_5": "D"}
    if design["mechanism"]["type"] == "eightbar":
        pins = find_dyad_pins("eightbar", loops)
    seen = loops.transmission(met, pins)
    assert set(told) == set(seen)
    for link, angle in seen.items():
        # Between the steps the least may be a little less.
        assert told[link] - 1e-6 <= angle <= told[link] + 0.05


def sine_is_met(design) -> None:
    x = np.linspace(0.0, 90.0, 31)
    held_against_loops(design, x, np.sin(np.radians(x)), off=design["structural_error"]["max"])


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.parametrize("kind", further([*TYPES, "eightbar"], ["stephenson_2", "eightbar"]))
def test_every_type_is_solved_proved_drawn_and_driven(client, kind):
    constraints = {"min_transmission_angle": 25.0, "max_link_ratio": 50.0}
    body = answered(client, mechanisms=[kind], constraints=constraints)
    designs = passed(body)
    assert len(designs) == 2
    for design in designs:
        assert design["mechanism"]["type"] == kind
        assert design["metrics"]["min_transmission_angle"] >= 25.0
        assert design["metrics"]["link_ratio"] <= 50.0
        assert design["structural_error"]["max"] < FOURBARS_BEST / 2.0
        sine_is_met(design)
    assert kind != "watt_2" or designs[0]["structural_error"]["max"] < FOURBARS_BEST / 20.0
    assert body["result"]["search"]["complete"] is False
    place = f"/v1/jobs/{body['id']}/designs/0"
    drawing = client.get(f"{place}.svg").text
    root = ET.fromstring(drawing)
    assert {e.get("data-joint") for e in root.iter()} - {None} == set(designs[0]["mechanism"]["skeleton"]["joints"])
    assert "function generator" in drawing
    for ending in ("dxf", "csv"):
        assert client.get(f"{place}.{ending}").status_code == 200, ending
    motion = client.get(f"{place}/motion?steps=72").json()
    assert_as_documented(motion)
    assert sum(motion["valid"]) > 3
    analysed = client.post("/v1/analyses", json={"mechanism": designs[0]["mechanism"]})
    assert analysed.status_code == 200, analysed.text
    assert client.get(f"/v1/jobs/{body['id']}/report.html").status_code == 200


@pytest.mark.slow
def test_auto_takes_the_fourbar_where_one_is_precise(client):
    precise = {"function": {"name": "reciprocal", "x": [1.0, 2.0]}, "constraints": {"min_transmission_angle": 10.0}}
    auto = answered(client, mechanisms="auto", **precise)["result"]
    assert auto == answered(client, **precise)["result"]
    assert {design["mechanism"]["type"] for design in auto["designs"]} == {"fourbar"}


@pytest.mark.campaign
@pytest.mark.timeout(300)
@pytest.mark.parametrize("types", further(["auto", ["fourbar", "watt_2"]], [["fourbar", "watt_2"]]))
def test_sixbars_are_offered_beside_a_fourbar_and_the_summary_says_so(client, types):
    result = answered(client, mechanisms=types, max_designs=3)["result"]
    plain = answered(client, max_designs=3)["result"]["designs"]
    errors = {design["mechanism"]["type"]: design["structural_error"]["max"] for design in result["designs"]}
    assert [one for one in result["designs"] if one["mechanism"]["type"] == "fourbar"] == plain[:1]
    assert all(error <= 0.5 * errors["fourbar"] for kind, error in errors.items() if kind != "fourbar")
    assert set(errors) - {"fourbar"} <= set(TYPES)
    assert "of the best fourbar's and are listed with it." in result["summary"]


@pytest.mark.campaign
def test_a_sixbar_in_the_place_of_the_fourbar_is_not_said_to_be_beside_it(client):
    result = answered(client, mechanisms=["fourbar", "watt_2"], max_designs=1)["result"]
    assert [design["mechanism"]["type"] for design in result["designs"]] == ["watt_2"]
    assert "of the best fourbar's and are listed in its place." in result["summary"]
    assert "beside" not in result["summary"]


@pytest.mark.campaign
@pytest.mark.timeout(300)
def test_what_is_ordered_by_forces_and_then_cut_is_not_said_to_be_offered(client):
    result = answered(
        client,
        mechanisms=["fourbar", "watt_2"],
        layout={"link_width": 4.0, "pin_diameter": 2.0, "thickness": 2.0},
        dynamics={"links": {"density": 1.0, "thickness": 1.0, "width": 1.0}, "speed_rpm": 1.0},
        constraints={"max_joint_force": 1e-7},
        rank_by="joint_force",
    )["result"]
    assert {design["mechanism"]["type"] for design in result["designs"]} == {"fourbar"}
    assert "of the best fourbar's." in result["summary"]
    assert "offered" not in result["summary"]


@pytest.mark.parametrize(
    ("fourbars", "sixbars", "most", "later", "offered", "told"),
    [
        ([(4.0, 30.0)], [(1.0, 30.0), (3.0, 30.0)], 5, False, [1.0, 4.0],
         "Sixbars reduce the error to 25 % of the best fourbar's and are listed with it."),
        ([(4.0, 30.0)], [(1.0, 30.0)], 1, False, [1.0],
         "Sixbars reduce the error to 25 % of the best fourbar's and are listed in its place."),
        ([(4.0, 30.0)], [(1.0, 30.0)], 40, True, [1.0, 4.0], "Sixbars reduce the error to 25 % of the best fourbar's."),
        ([(4.0, 30.0)], [(3.0, 30.0)], 5, False, [4.0],
         "No sixbar found clearly improves on the best fourbar's error."),
        ([(4.0, 10.0)], [(5.0, 25.0)], 5, False, [4.0, 5.0],
         "The best fourbar has a minimum transmission angle of only 10.0°; sixbars exceed it and are listed with it."),
        ([(4.0, 10.0)], [(5.0, 25.0)], 1, False, [4.0],
         "The best fourbar has a minimum transmission angle of only 10.0°; sixbars exceed it; "
         "they are not listed because of max_designs."),
        ([], [(3.0, 15.0)], 5, False, [3.0], "No fourbar was found, only sixbars."),
        ([], [], 5, False, [], "Neither a fourbar nor a sixbar was found."),
    ],
)  # fmt: skip
def test_what_is_offered_beside_a_fourbar_is_what_is_told(monkeypatch, fourbars, sixbars, most, later, offered, told):
    monkeypatch.setattr(type_selection, "rank_by_error", lambda _, designs: sorted(designs, key=_error))
    monkeypatch.setattr(type_selection, "get_error", lambda _, design: _error(design))
    limits = SimpleNamespace(min_transmission_angle=None)
    problem = SimpleNamespace(max_designs=most, constraints=limits, is_listed_later=later)
    results = [
        FunctionResult.model_construct(
            designs=[
                SimpleNamespace(
                    metrics=SimpleNamespace(min_transmission_angle=least),
                    verification=SimpleNamespace(passed=True),
                    error=error,
                )
                for error, least in designs
            ],
            search=Search(method="a", complete=False, candidates=9, accepted=len(designs),
                          rejected={"residual": 9 - len(designs)}, seed=0),
            summary="",
        )
        for designs in (fourbars, sixbars)
    ]  # fmt: skip
    answer = type_selection.merge_type_results(problem, *results)
    assert [_error(design) for design in answer.designs] == offered
    assert answer.summary.strip() == told
    assert answer.search.accepted == len(offered)
    assert answer.search.candidates == 18 == answer.search.accepted + sum(answer.search.rejected.values())


def _error(design) -> float:
    return design.error


@pytest.mark.parametrize(
    ("mechanisms", "sixbar_error", "searched", "told"),
    [
        ("auto", 0.5, ["simple", "sixbar"], "Sixbars reduce the error to"),
        ("auto", 2.0, ["simple", "sixbar", "eightbar"], "Eightbars reduce the error to 5 % of that of the best"),
        (["fourbar", "eightbar"], 2.0, ["simple", "eightbar"], "Eightbars reduce the error to 1 % of that of the best"),
        (["watt_2", "eightbar"], 0.5, ["sixbar", "eightbar"], "Eightbars reduce the error to 20 %"),
        (["watt_2", "eightbar"], 0.01, ["sixbar"], ""),
    ],
)
def test_eightbars_follow_sixbars_that_miss_by_far(monkeypatch, mechanisms, sixbar_error, searched, told):
    """A half sine ends where it begins: errors are shares of 90°, how far the output goes."""
    called: list[str] = []

    def solve(name: str, error: float) -> FunctionResult:
        called.append(name)
        design = SimpleNamespace(
            metrics=SimpleNamespace(min_transmission_angle=30.0, output_range=0.0),
            structural_error=SimpleNamespace(max=error),
            dials=SimpleNamespace(output=SimpleNamespace(scale=90.0)),
            targets=[SimpleNamespace(output=value) for value in (0.0, 1.0, 0.0)],
            verification=SimpleNamespace(passed=True),
        )
        search = Search(method="a", complete=False, candidates=1, accepted=1, rejected={}, seed=0)
        return FunctionResult.model_construct(designs=[design], search=search, summary="")

    def solve_linkages(_problem, types, _progress) -> FunctionResult:
        return solve("eightbar", 0.1) if "eightbar" in types else solve("sixbar", sixbar_error)

    monkeypatch.setattr(type_selection, "rank_by_error", lambda _, designs: designs)
    monkeypatch.setattr(type_selection, "solve_linkages", solve_linkages)
    half = {"function": {"name": "sine", "x": [0.0, 180.0]}, "mechanisms": mechanisms}
    problem = parse_problem(SINE | half)
    answer = type_selection.solve_types(problem, lambda _problem, _progress: solve("simple", 10.0), lambda *_: None)
    assert called == searched
    assert told in answer.summary


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_demands_are_kept_together(client):
    constraints = {
        "min_transmission_angle": 30.0,
        "max_link_ratio": 12.0,
        "link_length": {"min": 4.0, "max": 160.0},
        "fixed_pivot_region": {"x": [0.0, 120.0], "y": [0.0, 150.0]},
        "moving_pivot_region": {"x": [-20.0, 200.0], "y": [-40.0, 180.0]},
    }
    space = {"box": [[-30.0, -50.0], [210.0, 190.0]], "link_width": 6.0}
    designs = passed(answered(client, mechanisms=["watt_2"], constraints=constraints, space=space))
    assert designs
    for design in designs:
        names = {check["name"] for check in design["verification"]["checks"]}
        assert {"transmission_angle", "link_ratio", "longest_link", "fixed_pivot_region", "box"} <= names
        lengths = design["mechanism"]["links"].values()
        assert min(lengths) >= 4.0
        assert max(lengths) <= 160.0
        for x, y in design["mechanism"]["fixed_pivots"].values():
            assert 0.0 <= x <= 120.0
            assert 0.0 <= y <= 150.0
        sine_is_met(design)


@pytest.mark.campaign
def test_pivots_that_are_stated_are_those_of_input_and_output(client):
    """The second fourbar is turned and sized so that its pins keep their region, where it is most even or not."""
    pivots = {"input": [10.0, 5.0], "output": [90.0, 30.0]}
    region = {"x": [-5.0, 110.0], "y": [-5.0, 75.0]}
    more = {"fixed_pivots": pivots, "constraints": {"moving_pivot_region": region}}
    design = passed(answered(client, mechanisms=["watt_2"], max_designs=1, **more))[0]
    assert design["mechanism"]["fixed_pivots"]["O2"] == pytest.approx(pivots["input"])
    assert design["mechanism"]["fixed_pivots"]["O6"] == pytest.approx(pivots["output"])
    joints = design["mechanism"]["skeleton"]["joints"]
    for name in "ABCD":
        assert all(region[axis][0] <= at <= region[axis][1] for axis, at in zip("xy", joints[name], strict=True))
    sine_is_met(design)


@pytest.mark.campaign
@pytest.mark.parametrize(("kind", "count"), further([("stephenson_3", 6), ("watt_2", 8)], [("stephenson_3", 6)]))
def test_pairs_are_met_exactly(client, kind, count):
    task = {"kind": "function", "pairs": PAIRS[:count], "mechanisms": [kind], "max_designs": 1}
    body = finished(client, task)
    design = passed(body)[0]
    assert design["verification"]["checks"][0]["name"] == "reaches_targets"
    assert max(target["residual"] for target in design["targets"]) < 1e-9
    values, outputs = zip(*((pair["input"], pair["output"]) for pair in PAIRS[:count]), strict=True)
    held_against_loops(design, values, outputs, off=1e-6)
    assert design["dials"]["input"]["scale"] == design["dials"]["output"]["scale"] == 1.0


@pytest.mark.campaign
@pytest.mark.timeout(900)
def test_all_watt_2_through_nine_points_are_computed(client):
    """Nine points of the logarithm, of which some solutions are nearly singular: what is offered meets them by its
    loops."""
    task = {
        "kind": "function",
        "function": {"name": "logarithm", "x": [1.0, 10.0]},
        "input_range": 60.0,
        "output_range": 60.0,
        "precision_points": 9,
        "mechanisms": ["watt_2"],
        "constraints": {"min_transmission_angle": 15.0},
    }
    body = finished(client, task, LONG_S)
    result = body["result"]
    assert result["search"]["method"] == "nine_pair_continuation"
    assert "26\u202f370 of 26\u202f370 Watt II solutions for the nine pairs were computed" in result["summary"]
    assert result["search"]["candidates"] == 838
    designs = passed(body)
    assert len(designs) == result["search"]["accepted"] == 3
    x = 5.5 - 4.5 * np.cos((2.0 * np.arange(9) + 1.0) * math.pi / 18.0)
    for design in designs:
        assert design["structural_error"]["max"] < 0.1
        shown_by_loops(design, x, np.log10(x), off=1e-7)


@pytest.mark.campaign
@pytest.mark.timeout(900)
def test_many_pairs_of_a_watt_2_are_met(client):
    """The second planted one of the benchmark."""
    rng = np.random.default_rng([0, 0])
    task, constraints = [planted("watt_2", rng) for _ in range(2)][1]
    body = finished(client, {"kind": "function", **task, "mechanisms": ["watt_2"], "constraints": constraints}, LONG_S)
    best = passed(body)[0]
    assert best["structural_error"]["max"] < 1e-7
    inputs, outputs = zip(*((pair["input"], pair["output"]) for pair in task["pairs"]), strict=True)
    held_against_loops(best, inputs, outputs, off=1e-7)


@pytest.mark.campaign
def test_least_squares_are_no_greater_than_those_of_minimax(client):
    by = {
        criterion: passed(answered(client, mechanisms=["stephenson_3"], criterion=criterion, max_designs=1))[0]
        for criterion in ("least_squares", "minimax")
    }
    for design in by.values():
        sine_is_met(design)
    assert by["least_squares"]["structural_error"]["rms"] < FOURBARS_BEST / 100.0


GRID = {"round": {"length": 0.5, "coordinates": 0.5}}
NINE = {
    "function": None,
    "input_range": None,
    "output_range": None,
    "criterion": "precision",
    "pairs": [*PAIRS, {"input": 80, "output": 83.0}],
}
ZONE = {"fixed_pivots": {"input": {"circle": {"center": [0.0, 0.0], "radius": 9.0}}}}


@pytest.mark.parametrize(
    ("more", "paths"),
    [
        ({"mechanisms": []}, {"/mechanisms"}),
        ({"mechanisms": ["watt_1"]}, {"/mechanisms/0"}),
        ({"mechanisms": "sixbar"}, {"/mechanisms"}),
        ({"mechanisms": ["slider_crank"]}, {"/mechanisms"}),
        ({"mechanisms": ["watt_2"], "mechanism": "slider_crank", "output_range": 50.0}, {"/mechanisms"}),
        ({"mechanisms": ["watt_2"], "zeros": {"input": 10.0}}, {"/zeros"}),
        ({"mechanisms": ["watt_2"], "manufacture": GRID}, {"/manufacture"}),
        ({"mechanisms": ["fourbar", "watt_2"], "manufacture": GRID}, {"/manufacture"}),
        ({"mechanisms": ["watt_2"], "space": ZONE}, {"/space/fixed_pivots"}),
        ({"mechanisms": ["stephenson_2"], "constraints": {"grashof": "crank_rocker"}}, {"/constraints/grashof"}),
        ({"mechanisms": ["watt_2", "stephenson_3"], "precision_points": 9}, {"/precision_points"}),
        ({"mechanisms": ["watt_2"], "precision_points": 10}, {"/precision_points"}),
        (NINE | {"mechanisms": ["watt_2", "stephenson_3"]}, {"/pairs"}),
        (NINE | {"mechanisms": ["watt_2"], "scales": {"input": 1.0}}, {"/scales/output"}),
        ({"mechanisms": ["watt_2"], "precision_points": 9, "output_range": None}, {"/output_range"}),
        ({"mechanisms": "auto", "precision_points": 8}, {"/precision_points"}),
    ],
)
def test_what_cannot_be_is_refused_at_its_field(client, more, paths):
    answer = client.post("/v1/jobs", json={"problem": SINE | more})
    assert answer.status_code == 422, answer.text
    assert {error["path"] for error in answer.json()["errors"]} == {f"/problem{path}" for path in paths}


@pytest.mark.parametrize(
    "more",
    [
        {"mechanism": "slider_crank", "output_range": 50.0},
        {"zeros": {"input": 10.0}},
        {"manufacture": GRID},
        {"space": ZONE},
        {"constraints": {"grashof": "crank_rocker"}},
    ],
)
def test_what_is_refused_beside_a_list_is_taken_without_it_and_by_auto(client, more):
    for types in ({}, {"mechanisms": "auto"}):
        answer = client.post("/v1/jobs", json={"problem": SINE | more | types})
        assert answer.status_code == 202, answer.text
        assert client.delete(f"/v1/jobs/{answer.json()['id']}").status_code in (200, 202, 204)


@pytest.mark.campaign
@pytest.mark.timeout(300)
def test_a_type_without_a_class_is_dropped_where_one_is_demanded(client):
    mixed = answered(
        client, mechanisms=["stephenson_2", "watt_2"], constraints={"grashof": "double_crank"}, max_designs=1
    )["result"]
    assert {design["mechanism"]["type"] for design in mixed["designs"]} == {"watt_2"}
    assert {design["metrics"]["grashof"] for design in mixed["designs"]} == {"double_crank"}
    dropped = "Stephenson II sixbars were not searched: they do not support constraints.grashof."
    assert dropped in mixed["summary"]
    types = {"mechanisms": ["fourbar", "stephenson_2"]}
    plain, beside = (
        answered(client, constraints={"grashof": "crank_rocker"}, max_designs=1, **more)["result"]
        for more in ({}, types)
    )
    assert beside["designs"] == plain["designs"]
    assert dropped in beside["summary"]
    assert dropped not in plain["summary"]


@pytest.mark.campaign
@pytest.mark.parametrize(
    "more",
    [
        pytest.param({"mechanism": "slider_crank", "output_range": 50.0}, marks=pytest.mark.campaign),
        {"zeros": {"input": 30.0}, "criterion": "least_squares"},
        {"manufacture": GRID},
    ],
)
def test_auto_says_where_it_has_no_sixbars(client, more):
    auto, plain = (answered(client, max_designs=1, **more, **types)["result"] for types in ({"mechanisms": "auto"}, {}))
    assert auto["designs"] == plain["designs"]
    fields = {"mechanism"} & set(more) or set(more) - {"output_range", "criterion"}
    assert f"Sixbars were not searched: they do not support {', '.join(fields)}." in auto["summary"]
    assert "Sixbars" not in plain["summary"]
