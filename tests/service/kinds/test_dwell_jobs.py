"""Dwells through HTTP: solved, verified, drawn, driven; a refusal names the field."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest

from tests.support.service.analyses import assert_as_documented
from tests.support.service.answers import finished

TASKS = {
    "dwell_rocker": {"mechanism": "pseudo_arc", "output": {"type": "rocker", "swing": 60.0}},
    "dwell_slider": {"output": {"type": "slider", "stroke": 40.0}},
    "dwell_stephenson_2": {"mechanism": "stephenson_2", "output": {"type": "rocker", "swing": 55.0}, "crank": 12.0},
    "dwell_slot": {"mechanism": "straight_slot", "output": {"type": "rocker", "swing": 50.0}},
}


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.parametrize("kind", TASKS)
def test_every_type_is_solved_drawn_and_driven(client, kind):
    problem = {"kind": "dwell", "dwell_angle": 60.0, "max_designs": 1, **TASKS[kind]}
    body = finished(client, problem)
    assert body["status"] == "succeeded"
    (design,) = body["result"]["designs"]
    assert design["mechanism"]["type"] == kind
    if "crank" in problem:
        assert np.isclose(design["mechanism"]["links"]["input"], problem["crank"])
    place = f"/v1/jobs/{body['id']}/designs/0"
    drawing = client.get(f"{place}.svg")
    assert drawing.status_code == 200, drawing.text
    root = ET.fromstring(drawing.text)
    assert {"output", "acceleration"} <= {e.get("data-diagram") for e in root.iter()}
    assert {e.get("data-joint") for e in root.iter()} - {None} == set(design["mechanism"]["skeleton"]["joints"])
    answer = client.get(f"{place}/motion?steps=720")
    assert answer.status_code == 200, answer.text
    motion = answer.json()
    assert_as_documented(motion)
    moved = motion["slides"]["D"]["position"] if kind == "dwell_slider" else motion["links"]["output"]["angle"]
    first = round(design["targets"][0]["input_angle"] - motion["input_angle"][0]) * 2
    held = np.array((moved[:-1] + moved[:-1])[first : first + 121])
    assert np.isclose(np.ptp(held), design["metrics"]["jitter"], rtol=0.3, atol=1e-6)
    assert np.isclose(np.ptp(moved), design["metrics"]["way"], rtol=1e-3)
    analysed = client.post("/v1/analyses", json={"mechanism": design["mechanism"]})
    assert analysed.status_code == 200, analysed.text
    assert all(analysed.json()["valid"])


@pytest.mark.parametrize(
    ("changed", "path"),
    [
        ({"coupler_point": {"distance": 1.0, "angle": 0.0}}, "/mechanism/coupler_point"),
        ({"reference_input_angle": 0.0}, "/mechanism/reference_input_angle"),
    ],
)
def test_dimensions_that_the_skeleton_does_not_have(client, changed, path):
    problem = {"kind": "dwell", "dwell_angle": 60.0, "max_designs": 1, **TASKS["dwell_rocker"]}
    body = finished(client, problem)
    mechanism = {**body["result"]["designs"][0]["mechanism"], **changed}
    answer = client.post("/v1/analyses", json={"mechanism": mechanism})
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == [path]


@pytest.mark.parametrize(
    ("fields", "path"),
    [
        ({"dwell_angle": 0.0}, "/problem/dwell_angle"),
        ({"dwell_angle": 360.0}, "/problem/dwell_angle"),
        ({"dwell_angle": 200.0, "count": 2}, "/problem/dwell_angle"),
        ({"output": {"type": "rocker", "swing": 180.0}}, "/problem/output/swing"),
        ({"tolerance": 60.0}, "/problem/tolerance"),
        ({"mechanism": "stephenson_2", "output": {"type": "slider", "stroke": 9.0}}, "/problem/mechanism"),
        ({"mechanism": "stephenson_2", "constraints": {"grashof": "crank_rocker"}}, "/problem/constraints/grashof"),
    ],
)
def test_what_cannot_be_is_refused_at_its_field(client, fields, path):
    problem = {"kind": "dwell", "dwell_angle": 60.0, "output": {"type": "rocker", "swing": 60.0}, **fields}
    answer = client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422, answer.text
    assert path in [error["path"] for error in answer.json()["errors"]]
