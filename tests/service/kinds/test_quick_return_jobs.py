"""Quick return through HTTP: solved, drawn and driven; refusals name their fields."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synthesis.registry import KINDS
from tests.support.service.answers import drawn, finished

EXAMPLES = KINDS["quick_return"].problem.model_config["json_schema_extra"]["examples"]


def solved(client, problem):
    job = finished(client, problem)
    assert job["status"] == "succeeded"
    return job


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=("fourbar", "auto", "positions", "layout"))
def test_examples_are_solved_drawn_and_driven(client, example):
    job = solved(client, example)
    designs = job["result"]["designs"]
    assert designs
    firsts = {design["mechanism"]["type"]: n for n, design in reversed(list(enumerate(designs)))}
    for n, design in [(n, designs[n]) for n in sorted(firsts.values())]:
        assert design["verification"]["passed"]
        assert math.isclose(design["metrics"]["time_ratio"], example["time_ratio"], abs_tol=1e-9)
        place = f"/v1/jobs/{job['id']}/designs/{n}"
        root = drawn(client, place, design)
        assert len([g for g in root.iter() if g.get("data-configuration")]) == 2
        assert {g.get("data-diagram") for g in root.iter() if g.get("data-diagram")} == {"output", "rate"}
        motion = client.get(f"{place}/motion?steps=720")
        assert motion.status_code == 200, motion.text
        moved = motion.json()
        assert all(moved["valid"])
        # From limit to limit in 720 steps the output goes one way in the slow stroke and back in the fast one.
        if "swing" in design["metrics"]:
            output = np.unwrap(np.radians(moved["links"]["output"]["angle"]))
            travel = math.radians(design["metrics"]["swing"])
        else:
            (joint,) = [name for name in moved["slides"] if name in "BCD"]
            output, travel = np.array(moved["slides"][joint]["position"]), design["metrics"]["stroke"]
        assert math.isclose(np.ptp(output), travel, rel_tol=1e-4)
        turned = moved["input_angle"][int(np.argmax(np.abs(output - output[0])))] - moved["input_angle"][0]
        assert abs(turned - design["metrics"]["slow_rotation"]) <= 0.5


def test_a_pair_out_of_reach_is_answered_with_the_range(client):
    job = solved(client, {"kind": "quick_return", "time_ratio": 9.0, "swing": 40.0, "mechanism": "fourbar"})
    assert job["result"]["designs"] == []
    assert job["result"]["search"]["complete"]
    (reach,) = job["result"]["reachable"]
    assert math.isclose(reach["greatest"], 580.0 / 140.0)
    assert "4.14286" in job["result"]["summary"]
    assert job["result"]["nearest_miss"] is None, "no demand is the trouble"


def test_a_limit_out_of_reach_is_answered_with_the_nearest_miss(client):
    statement = {**EXAMPLES[0], "constraints": {"min_transmission_angle": 88.5}}
    miss = solved(client, statement)["result"]["nearest_miss"]
    (gap,) = miss["gaps"]
    assert gap == {
        "check": "transmission_angle",
        "value": miss["design"]["metrics"]["min_transmission_angle"],
        "limit": 88.5,
        "dimension": "angle",
    }
    statement["constraints"]["min_transmission_angle"] = miss["reachable"]["min_transmission_angle"] - 1e-6
    result = solved(client, statement)["result"]
    assert result["designs"]
    assert result["nearest_miss"] is None


@pytest.mark.parametrize(
    ("stated", "path"),
    [
        ({"time_ratio": 1.2, "swing": 0.0}, "/problem/swing"),
        ({"time_ratio": 0.5, "swing": 40.0}, "/problem/time_ratio"),
        ({"time_ratio": 1.2, "mechanism": "fourbar"}, "/problem/swing"),
        ({"time_ratio": 1.2, "swing": 40.0, "ratio": 2.0}, "/problem/ratio"),
    ],
)
def test_a_refusal_names_the_field(client, stated, path):
    answer = client.post("/v1/jobs", json={"problem": {"kind": "quick_return", **stated}})
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == [path]
