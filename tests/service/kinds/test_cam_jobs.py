"""The examples of cams through HTTP: solved, verified, drawn, tabled and driven; a refusal names the field."""

from __future__ import annotations

import copy

import pytest

from synthesis.registry import KINDS
from tests.support.service.running import REACHED_S, SOON_S, until

EXAMPLES = KINDS["cam"].problem.model_config["json_schema_extra"]["examples"]
NAMES = ("double dwell", "rise-fall-dwell", "critical path", "valve", "barrel")


@pytest.mark.parametrize("example", EXAMPLES, ids=NAMES)
def test_examples_run_and_are_drawn(client, example):
    job = client.post("/v1/jobs", json={"problem": example}, headers={"Prefer": "wait=30"})
    assert job.status_code == 200, job.text
    body = job.json()
    assert body["status"] == "succeeded"
    (design,) = body["result"]["designs"]
    assert design["verification"]["passed"]
    place = f"/v1/jobs/{body['id']}/designs/0"
    for form, begins in (("svg", b"<"), ("dxf", b""), ("csv", b"")):
        answer = client.get(f"{place}.{form}")
        assert answer.status_code == 200, answer.text
        assert len(answer.content) > 1000
        assert answer.content.startswith(begins)
    motion = client.get(f"{place}/motion?steps=36")
    assert motion.status_code == 200, motion.text


@pytest.mark.parametrize("law", ["simple_harmonic", "constant_acceleration", "cycloidal"])
def test_of_a_jerk_without_bound_no_peak_is_told(client, law):
    """Both laws that jump: at their ends, and within."""
    moves = [{"motion": motion, "angle": 90, "lift": 20, "law": law} for motion in ("rise", "fall")]
    dwell = {"motion": "dwell", "angle": 90}
    problem = {**EXAMPLES[0], "segments": [moves[0], dwell, moves[1], dwell], "accept_discontinuity": True}
    job = client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": "wait=30"})
    assert job.status_code == 200, job.text
    result = job.json()["result"]
    (design,) = result["designs"]
    jumps = [joint["jump"]["a"] for joint in design["joints"] if "a" not in joint["continuous"]]
    if law == "cycloidal":
        assert not jumps
        assert design["metrics"]["peak_jerk"] > 0.0
    else:
        assert max(map(abs, jumps)) > 1.0
        assert design["metrics"]["peak_jerk"] is None
    assert ("the jerk has no finite peak" in result["summary"]) is bool(jumps)
    assert design["segments"][0]["peak_jerk"] >= 0.0


def test_a_broken_joint_is_refused_with_its_place(client):
    example = copy.deepcopy(EXAMPLES[0])
    example["segments"][1]["law"] = "simple_harmonic"
    answer = client.post("/v1/jobs", json={"problem": example})
    assert answer.status_code == 422
    (first, *_) = answer.json()["errors"]
    assert first["path"] == "/problem/segments/1"
    assert "fundamental law" in first["detail"]


@pytest.mark.parametrize("name", ["velocity", "acceleration", "jerk"])
def test_a_limit_on_the_motion_is_refused_where_every_law_is_stated(client, name):
    problem = EXAMPLES[0] | {"limits": {"pressure_angle": 30.0, name: 1e-3}}
    answer = client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == [f"/problem/limits/{name}"]


def test_a_groove_is_drawn_with_both_walls(client):
    job = client.post(
        "/v1/jobs", json={"problem": EXAMPLES[0] | {"closure": "form"}}, headers={"Prefer": "wait=30"}
    ).json()
    (design,) = job["result"]["designs"]
    assert len(design["mechanism"]["outer_wall"]["x"]) == len(design["mechanism"]["profile"]["x"])
    place = f"/v1/jobs/{job['id']}/designs/0"
    assert 'data-part="outer wall"' in client.get(f"{place}.svg").text
    assert "OUTER_WALL" in client.get(f"{place}.dxf").text
    assert "outer_wall_x [mm]" in client.get(f"{place}.csv").text


@pytest.mark.slow
def test_a_convex_program_tells_its_progress_and_is_cancelled(server):
    """Motion and size of 24 optimal segments together: some programs of thousands of variables, one after the other."""
    segments = [
        {"motion": "rise" if k % 2 == 0 else "fall", "angle": 15.0, "lift": 10.0, "law": "optimal"} for k in range(24)
    ]
    problem = {
        "kind": "cam",
        "segments": segments,
        "follower": {"type": "translating_roller", "roller_radius": 10.0},
        "limits": {"pressure_angle": 30.0},
        "minimize": "size",
    }
    job = server.post(problem=problem)
    heard = until(
        lambda: (found := server.job(job["id"])) and "convex program" in found["progress"]["message"] and found,
        REACHED_S,
        "a message from the convex program",
    )
    assert heard["status"] == "running"
    assert 0.0 < heard["progress"]["fraction"] < 1.0
    assert server.client.delete(f"/v1/jobs/{job['id']}").status_code == 202
    cancelled = server.reaches(job["id"], "cancelled", SOON_S)
    assert cancelled["result"] is None
    # Its worker is free again: the next job is answered.
    server.reaches(server.post(problem=EXAMPLES[0])["id"], "succeeded")
