"""Parallel motion through HTTP: solved, drawn, driven; a refusal names the field."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest

from synthesis.registry import get_first_example
from tests.support.service.analyses import assert_as_documented, joint
from tests.support.service.answers import finished


@pytest.mark.timeout(300)
def test_the_example_is_solved_drawn_and_driven(client):
    problem = get_first_example("parallel_motion")
    job = finished(client, problem)
    assert job["status"] == "succeeded"
    assert job["result"]["designs"]
    for n, design in enumerate(job["result"]["designs"]):
        drawing = client.get(f"/v1/jobs/{job['id']}/designs/{n}.svg")
        assert drawing.status_code == 200, drawing.text
        root = ET.fromstring(drawing.text)
        assert {e.get("data-body") for e in root.iter()} - {None} == {"1", "2", "3", "4"}
        motion = client.get(f"/v1/jobs/{job['id']}/designs/{n}/motion?steps=90").json()
        assert_as_documented(motion)
        apart = joint(motion, "Q") - joint(motion, "P")
        # Within the range that was driven: near the toggles of a rocker guide and body may come into line.
        low, high = design["metrics"]["input_range"]
        at = np.array(motion["input_angle"])
        inside = (at > min(low, high)) & (at < max(low, high))
        if design["metrics"]["full_rotation"]:
            assert np.abs(apart - apart[0]).max() < 1e-9 * design["metrics"]["size"]
        elif inside.any():
            assert np.abs(apart[inside] - apart[inside][0]).max() < 1e-9 * design["metrics"]["size"]
    analysed = client.post("/v1/analyses", json={"mechanism": job["result"]["designs"][0]["mechanism"]})
    assert analysed.status_code == 200, analysed.text


@pytest.mark.parametrize(
    ("fields", "path"),
    [
        ({}, "/problem/linkage"),
        ({"linkage": {"links": {"input": 0.0, "coupler": 1.0, "output": 1.0}}}, "/problem/linkage/links/input"),
        ({"path": {"kind": "path", "points": []}}, "/problem/path/points"),
    ],
)
def test_what_cannot_be_is_refused_at_its_field(client, fields, path):
    answer = client.post("/v1/jobs", json={"problem": {"kind": "parallel_motion", **fields}})
    assert answer.status_code == 422, answer.text
    assert path in [error["path"] for error in answer.json()["errors"]]
