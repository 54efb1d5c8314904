"""Straight lines through HTTP: solved, verified, drawn, driven; a refusal names the field."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest

from synthesis.kinds.straight_line.problem import LINE_MECHANISMS
from tests.support.service.analyses import assert_as_documented, joint
from tests.support.service.answers import finished


@pytest.mark.parametrize("mechanism", LINE_MECHANISMS)
def test_every_type_is_solved_drawn_and_driven(client, mechanism):
    problem = {"kind": "straight_line", "length": 80.0, "mechanism": mechanism, "direction": 90.0}
    body = finished(client, problem)
    assert body["status"] == "succeeded"
    design = body["result"]["designs"][0]
    assert design["verification"]["passed"]
    place = f"/v1/jobs/{body['id']}/designs/0"
    drawing = client.get(f"{place}.svg")
    assert drawing.status_code == 200, drawing.text
    root = ET.fromstring(drawing.text)
    marks = {e.get("data-line") for e in root.iter()} | {e.get("data-diagram") for e in root.iter()}
    assert {"demanded", "deviation", "velocity"} <= marks
    drawn = {e.get("data-joint") for e in root.iter()} - {None}
    assert drawn == set(design["mechanism"]["skeleton"]["joints"])
    answer = client.get(f"{place}/motion?steps=720")
    assert answer.status_code == 200, answer.text
    motion = answer.json()
    assert_as_documented(motion)
    track = joint(motion, "P")
    assert np.nanmin(np.abs(track)) < 1.0
    analysed = client.post(
        "/v1/analyses",
        json={"mechanism": design["mechanism"], "motion": {"at": design["targets"][1]["input_angle"]}},
    )
    assert analysed.status_code == 200, analysed.text
    assert abs(joint(analysed.json(), "P")[0] - 80.0j) < 0.3


@pytest.mark.parametrize(
    ("fields", "path"),
    [
        ({"length": 0.0}, "/problem/length"),
        ({"crank_range": 0.0}, "/problem/crank_range"),
        ({"crank_range": 360.0}, "/problem/crank_range"),
        ({"mechanism": "scott_russell", "crank_range": 180.0}, "/problem/crank_range"),
        ({"direction": "up"}, "/problem/direction"),
        ({"start": [0.0, 1e10]}, "/problem/start/1"),
        ({"constraints": {"full_rotation": True, "grashof": "non_grashof"}}, "/problem/constraints/full_rotation"),
    ],
)
def test_what_cannot_be_is_refused_at_its_field(client, fields, path):
    problem = {"kind": "straight_line", "length": 80.0, **fields}
    answer = client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422, answer.text
    assert path in [error["path"] for error in answer.json()["errors"]]
