"""Dwells of stated lengths and places through HTTP: solved under other demands, drawn, driven, or refused."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from itertools import combinations

import numpy as np
import pytest

from synthesis.registry import list_examples
from tests.campaign import further
from tests.service.stated.linkages import WEIGHED
from tests.support.service.answers import finished
from tests.support.synthesis.triad_dwells import ELSEWHERE, built

UNEQUAL = {**list_examples("dwell")[2], "max_designs": 1}
HIGH = {
    "kind": "dwell",
    "dwells": [{"angle": 60.0, "at": "high"}],
    "output": {"type": "slider", "stroke": 40.0},
    "mechanism": "watt_2",
    "max_designs": 1,
}
WITHIN = {**HIGH, "dwells": [{"angle": 50.0, "at": 0.5}], "mechanism": "pseudo_arc"}
TASKS = {
    "unequal": UNEQUAL,
    "unequal by a Stephenson II, even links, in a zone": {
        **UNEQUAL,
        "mechanism": "stephenson_2",
        "constraints": {
            "min_transmission_angle": 30.0,
            "max_link_ratio": 4.0,
            "link_length": {"min": 8.0},
            "fixed_pivot_region": {"x": [0.0, 200.0], "y": [-200.0, 200.0]},
        },
    },
    "watt, of one class, within a zone": {
        **HIGH,
        "constraints": {
            "grashof": "crank_rocker",
            "min_transmission_angle": 30.0,
            "max_link_ratio": 9.0,
            "fixed_pivot_region": {"x": [0.0, 200.0], "y": [-200.0, 200.0]},
        },
    },
    "within, as double crank": {**WITHIN, "constraints": {"grashof": "double_crank"}},
    "unequal, short links, in a box": {
        **UNEQUAL,
        "constraints": {"link_length": {"max": 60.0}},
        "space": {"box": [[-300.0, -300.0], [300.0, 300.0]]},
    },
}


@pytest.mark.slow
@pytest.mark.parametrize("name", further(list(TASKS), ["unequal"]))
def test_dwells_are_solved_drawn_and_driven(client, name):
    problem = TASKS[name]
    body = finished(client, problem)
    assert body["status"] == "succeeded"
    (design,) = body["result"]["designs"]
    demands = problem.get("constraints", {})
    if "grashof" in demands:
        assert design["metrics"]["grashof"] == demands["grashof"]
    assert design["metrics"]["min_transmission_angle"] >= demands.get("min_transmission_angle", 20.0)
    joints = design["mechanism"]["skeleton"]["joints"]
    pins = [
        math.dist(joints[one], joints[other])
        for link in design["mechanism"]["skeleton"]["links"]
        for one, other in combinations(link["joints"], 2)
    ]
    assert design["metrics"]["link_ratio"] == pytest.approx(max(pins) / min(pins))
    assert max(pins) / min(pins) <= demands.get("max_link_ratio", math.inf) * (1.0 + 1e-6)
    if "link_length" in demands:
        assert max(pins) <= demands["link_length"].get("max", math.inf) + 1e-6
        assert min(pins) >= demands["link_length"].get("min", 0.0) - 1e-6
    place = f"/v1/jobs/{body['id']}/designs/0"
    drawing = client.get(f"{place}.svg")
    assert drawing.status_code == 200, drawing.text
    assert "% of the way" in drawing.text
    curves = [e for e in ET.fromstring(drawing.text).iter() if e.get("data-curve") == "dwell"]
    assert len(curves) == len(problem["dwells"])
    answer = client.get(f"{place}/motion?steps=720")
    assert answer.status_code == 200, answer.text
    motion = answer.json()
    slides = problem["output"]["type"] == "slider"
    moved = np.array(motion["slides"]["D"]["position"] if slides else motion["links"]["output"]["angle"])
    low, way = moved.min(), np.ptp(moved)
    around = np.concatenate([moved[:-1], moved[:-1]])
    for dwell, told, rest in zip(problem["dwells"], design["dwells"], design["targets"], strict=True):
        assert told["angle"] == dwell["angle"]
        first = round(2.0 * ((rest["input_angle"] - motion["input_angle"][0]) % 360.0))
        held = around[first : first + round(2.0 * dwell["angle"]) + 1]
        assert np.isclose((held.mean() - low) / way, told["at"], atol=0.01)
        assert abs(told["at"] - {"low": 0.0, "high": 1.0}.get(dwell["at"], dwell["at"])) <= 0.05
        assert np.isclose(np.ptp(held), told["error"], rtol=0.3, atol=1e-4 * way)
    analysed = client.post("/v1/analyses", json={"mechanism": design["mechanism"]})
    assert analysed.status_code == 200, analysed.text


@pytest.mark.campaign
def test_a_stephenson_ii_keeps_what_is_stated_beside_its_dwells(client):
    problem = {
        "kind": "dwell",
        "mechanism": "stephenson_2",
        "dwell_angle": 45.0,
        "count": 2,
        "output": {"type": "rocker", "swing": 50.0},
        "length_unit": "m",
        "crank": 0.02,
        "pivot": [1.5, -0.5],
        "rank_by": "planes",
        "include_failed": True,
        "max_designs": 3,
        "layout": {"link_width": 0.004, "pin_diameter": 0.002, "thickness": 0.002},
        "dynamics": WEIGHED,
        "constraints": {"moving_pivot_region": {"x": [1.3, 1.7], "y": [-0.7, -0.3]}, "max_joint_force": 1e9},
        "space": {"box": [[1.2, -0.8], [1.8, -0.2]]},
    }
    body = finished(client, problem)
    assert body["status"] == "succeeded"
    designs = body["result"]["designs"]
    assert designs
    for number, design in enumerate(designs):
        mechanism = design["mechanism"]
        assert mechanism["type"] == "dwell_stephenson_2"
        assert mechanism["links"]["input"] == pytest.approx(0.02)
        assert mechanism["fixed_pivots"]["O2"] == pytest.approx([1.5, -0.5])
        assert design["layout"] is not None
        assert design["forces"] is not None
        assert set(design["metrics"]["transmission_angles"]) == {"link_3", "link_5", "output"}
        assert design["metrics"]["grashof"] is None
        motion = client.get(f"/v1/jobs/{body['id']}/designs/{number}/motion?steps=720").json()
        if design["verification"]["passed"]:
            for name in "ABCDE":
                x, y = (np.array(motion["joints"][name][axis]) for axis in "xy")
                assert 1.2 - 1e-9 <= x.min() <= x.max() <= 1.8 + 1e-9
                assert -0.8 - 1e-9 <= y.min() <= y.max() <= -0.2 + 1e-9


@pytest.mark.campaign
def test_of_a_stephenson_ii_out_of_reach_a_shorter_dwell_is_told(client):
    problem = {**UNEQUAL, "mechanism": "stephenson_2", "dwells": [{"angle": 250.0, "at": "low"}], "tolerance": 0.5}
    result = finished(client, problem)["result"]
    assert result["designs"] == []
    assert "may still exist" in result["summary"]
    (angle,) = result["nearest_miss"]["reachable"]["dwell_angles"]
    assert 30.0 < angle < 250.0
    assert result["nearest_miss"]["design"]["mechanism"]["type"] == "dwell_stephenson_2"


@pytest.mark.campaign
def test_what_the_summary_tells_of_a_design_is_true_in_any_order(client):
    layout = {"link_width": 4.0, "pin_diameter": 2.0, "thickness": 2.0}
    result = finished(client, {**HIGH, "max_designs": 2, "layout": layout, "rank_by": "planes"})["result"]
    jitters = [design["metrics"]["jitter"] for design in result["designs"]]
    told = re.search(r"In the (first|stillest) the output moves by at most (\S+) mm", result["summary"])
    assert told, result["summary"]
    assert told[1] == "stillest"
    assert float(told[2]) <= min(jitters) * 1.05
    plain = finished(client, {**HIGH, "max_designs": 2})["result"]
    told = re.search(r"In the first the output moves by at most (\S+) mm", plain["summary"])
    assert told, plain["summary"]
    assert float(told[1]) == pytest.approx(plain["designs"][0]["metrics"]["jitter"], rel=0.05)


@pytest.mark.parametrize(
    ("changed", "path"),
    [
        ({"dwells": []}, "/problem/dwells"),
        ({"dwells": [{"angle": 10.0, "at": 0.2 * k} for k in range(4)]}, "/problem/dwells"),
        ({"dwells": [{"angle": 0.0, "at": "low"}]}, "/problem/dwells/0/angle"),
        ({"dwells": [{"angle": 360.0, "at": "low"}]}, "/problem/dwells/0/angle"),
        ({"dwells": [{"angle": "60", "at": "low"}]}, "/problem/dwells/0/angle"),
        ({"dwells": [{"angle": 60.0, "at": "middle"}]}, "/problem/dwells/0/at"),
        ({"dwells": [{"angle": 60.0, "at": 1.5}]}, "/problem/dwells/0/at"),
        ({"dwells": [{"angle": 60.0, "at": -1e-9}]}, "/problem/dwells/0/at"),
        ({"dwells": [{"angle": 60.0, "at": True}]}, "/problem/dwells/0/at"),
        ({"dwells": [{"angle": 60.0}]}, "/problem/dwells/0/at"),
        ({"dwells": [{"angle": 60.0, "at": 0.5, "to": 3}]}, "/problem/dwells/0/to"),
        ({"dwells": [{"angle": 180.0, "at": "low"}, {"angle": 180.0, "at": "high"}]}, "/problem/dwells"),
        ({"dwells": [{"angle": 30.0, "at": 0.0}, {"angle": 30.0, "at": "low"}]}, "/problem/dwells/1/at"),
        ({"dwells": [{"angle": 30.0, "at": 0.4}, {"angle": 30.0, "at": 0.45}]}, "/problem/dwells/1/at"),
        (
            {"tolerance": 10.0, "dwells": [{"angle": 30.0, "at": 0.4}, {"angle": 30.0, "at": 0.6}]},
            "/problem/dwells/1/at",
        ),
        ({"dwell_angle": 60.0}, "/problem/dwell_angle"),
        ({"count": 2}, "/problem/count"),
        ({"dwells": None}, "/problem/dwell_angle"),
        ({"output": {"type": "slider", "stroke": 0.0}}, "/problem/output/stroke"),
        ({"constraints": {"grashof": "double_rocker"}}, "/problem/constraints/grashof"),
        ({**UNEQUAL, "constraints": {"grashof": "double_crank"}}, "/problem/constraints/grashof"),
    ],
)
def test_what_cannot_be_is_refused_at_its_field(client, changed, path):
    answer = client.post("/v1/jobs", json={"problem": {**HIGH, **changed}})
    assert answer.status_code == 422, answer.text
    assert {error["path"] for error in answer.json()["errors"]} == {path}


def test_a_class_that_one_of_the_types_can_have_is_not_refused(client):
    problem = {**UNEQUAL, "mechanism": "auto", "constraints": {"grashof": "double_crank"}}
    assert client.post("/v1/jobs", json={"problem": problem}).status_code == 202


@pytest.mark.slow
def test_the_cycle_of_a_given_linkage_that_comes_back_in_two_turns_is_both(client):
    """Its crank meets no toggle, but link 4 is elsewhere after one turn."""
    mechanism = built(np.array(ELSEWHERE))
    joints = {name: [complex(z).real, complex(z).imag] for name, z in mechanism.joints.items()}
    links = [{"name": name, "joints": list(pins)} for name, pins in mechanism.links.items()]
    skeleton = {"joints": joints, "links": links, "slides": [], "gears": [], "input_link": "input"}
    start = float(np.degrees(mechanism.reference_input))
    over = {"from": start, "to": start + 720.0, "steps": 144}
    layout = {"link_width": 0.01, "pin_diameter": 0.005, "thickness": 0.01, "over": "cycle"}
    asked = {"mechanism": {"type": "skeleton", "skeleton": skeleton}, "motion": over, "layout": layout}
    answer = client.post("/v1/analyses", json=asked)
    assert answer.status_code == 200, answer.text
    motion = answer.json()
    assert all(motion["valid"])
    b = np.array([motion["joints"]["B"][axis] for axis in "xy"])
    assert np.allclose(b[:, 0], b[:, -1], atol=1e-9)
    assert np.abs(b[:, 72] - b[:, 0]).max() > 0.1
    free = motion["layout"]["free_range"]
    assert 650.0 < free[1] - free[0] < 720.0
