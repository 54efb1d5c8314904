"""Timed and fitted paths through HTTP: solved, verified, drawn and driven; refusals name the field."""

import copy
import math
import re

import numpy as np
import pytest

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, positions
from synthesis.registry import list_examples
from tests.support.service.running import SOON_S, until

TIMED = [example for example in list_examples("path") if example.get("timing") == "prescribed"]


@pytest.mark.parametrize("example", TIMED, ids=["exact", "fitted"])
def test_timed_examples_run_and_are_drawn(client, example):
    job = client.post("/v1/jobs", json={"problem": example}, headers={"Prefer": "wait=30"})
    assert job.status_code == 200, job.text
    body = job.json()
    assert body["status"] == "succeeded", body["error"]
    result = body["result"]
    assert result["designs"]
    for design in result["designs"]:
        assert design["verification"]["passed"]
        assert design["cognate_choice"]
        targets = design["targets"]
        given = [point["crank_angle"] for point in example["points"]]
        turned = [target["input_angle"] - targets[0]["input_angle"] for target in targets]
        assert all(math.isclose(one, other - given[0], abs_tol=1e-9) for one, other in zip(turned, given, strict=True))
        total = sum(target["point_residual"] ** 2 for target in targets)
        assert math.isclose(design["metrics"]["sum_of_squares"], total, rel_tol=1e-9, abs_tol=1e-20)
    place = f"/v1/jobs/{body['id']}/designs/0"
    drawing = client.get(f"{place}.svg")
    assert drawing.status_code == 200, drawing.text
    fitted = result["search"]["method"] == "least_squares"
    assert bool(re.search("data-miss", drawing.text)) == fitted
    # The crank's angles stand in the drawing's table of targets.
    shown = [float(words.replace("\u2212", "-")) for words in re.findall(r">([\u2212\d.]+)°<", drawing.text)]
    for target in result["designs"][0]["targets"]:
        assert min(abs(target["input_angle"] - angle) for angle in shown) < 0.1
    assert client.get(f"{place}/motion?steps=36").status_code == 200


@pytest.mark.parametrize(
    ("change", "path"),
    [
        (lambda problem: problem["points"][2].pop("crank_angle"), "/problem/points/2/crank_angle"),
        (lambda problem: problem["points"][3].update(crank_angle=0.0), "/problem/points/3/crank_angle"),
        (lambda problem: problem.update(crank_phase="absolute", method="exact"), "/problem/method"),
        (lambda problem: problem.update(points=problem["points"] * 201), "/problem/points"),
    ],
)
def test_refusals_name_the_field(client, change, path):
    problem = copy.deepcopy(TIMED[0])
    change(problem)
    answer = client.post("/v1/jobs", json={"problem": problem})
    assert answer.status_code == 422
    assert path in [error["path"] for error in answer.json()["errors"]]


NINE_POINTS = [
    {"x": x, "y": y} for x, y in zip([5, 9, 14, 18, 20, 19, 15, 9, 5], [2, 0, 1, 4, 8, 12, 14, 12, 7], strict=True)
]


@pytest.mark.slow
def test_a_nine_point_search_tells_its_progress_and_is_cancelled(server):
    """The search takes seconds, nearly all of them in compiled code."""

    def cancelled_attempts():
        return server.sample("mechsynth_job_attempts_total", outcome="cancelled")

    cancelled_before = cancelled_attempts()  # other tests cancel jobs of the same server
    job = server.post(problem={"kind": "path", "points": NINE_POINTS})
    until(lambda: 0.0 < server.job(job["id"])["progress"]["fraction"] < 0.9, 60.0, "progress")
    workers = set(server.workers())
    assert server.client.delete(f"/v1/jobs/{job['id']}").status_code == 202
    server.reaches(job["id"], "cancelled", SOON_S)
    until(lambda: cancelled_attempts() > cancelled_before, SOON_S, "the end of the search")
    assert workers <= set(server.workers()), "it has stopped by itself"
    server.reaches(server.post(problem=TIMED[0])["id"], "succeeded")


@pytest.mark.slow
def test_tolerances_of_points_hold_both_ways_and_the_front_is_told(client):
    """An ellipse that no fourbar draws exactly, with tolerances that some keep."""
    turns = [2.0 * math.pi * k / 16 for k in range(16)]
    points = [{"x": 40.0 * math.cos(t), "y": 15.0 * math.sin(t), "tolerance": 1.0} for t in turns]
    stated = {"kind": "path", "closed": True, "method": "least_squares", "points": points}
    job = client.post("/v1/jobs", json={"problem": stated}, headers={"Prefer": "wait=60"}).json()
    assert job["status"] == "succeeded", job["error"]
    designs = job["result"]["designs"]
    assert len(designs) > 1
    for design in designs:
        checks = {check["name"]: check for check in design["verification"]["checks"]}
        assert checks["within_tolerance"]["value"] <= 1.0
        assert checks["curve_within_tolerance"]["value"] <= 1.0
        assert design["metrics"]["max_distance"] <= 1.0
        assert design["metrics"]["curve_distance"] < 2.5
    front = job["result"]["front"]
    assert front["quantities"] == ["rms", "min_transmission_angle", "size"]
    assert set(front["designs"]) <= set(range(len(designs)))


def test_tolerances_for_some_points_alone_are_refused(client):
    points = [{"x": float(k), "y": float(k * k)} for k in range(6)]
    points[2]["tolerance"] = 0.5
    answer = client.post("/v1/jobs", json={"problem": {"kind": "path", "method": "least_squares", "points": points}})
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == ["/problem/points/0/tolerance"]


def test_a_fit_begins_at_a_linkage_that_is_stated(client):
    planted = Fourbar(1.0 - 2.0j, 7.0 + 1.0j, 2.0, 6.0, 5.0, 3.0 + 2.0j)
    way = positions(planted, np.linspace(0.3, 4.0, 12), OPEN_ASSEMBLY)
    points = [{"x": z.real, "y": z.imag} for z in way.p]
    joints = {"O2": 1.0 - 2.0j, "A": way.a[3], "B": way.b[3], "O4": 7.0 + 1.0j, "P": way.p[3]}
    start = {name: [1.04 * z.real, z.imag] for name, z in joints.items()}
    problem = {"kind": "path", "points": points, "method": "least_squares", "start": start}
    job = client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": "wait=30"}).json()
    (design,) = job["result"]["designs"]
    assert design["metrics"]["max_distance"] < 1e-6
    assert design["mechanism"]["links"]["input"] == pytest.approx(2.0, abs=1e-5)
    refused = client.post("/v1/jobs", json={"problem": {**problem, "method": "auto"}})
    assert refused.status_code == 422
    assert [fault["path"] for fault in refused.json()["errors"]] == ["/problem/method"]
