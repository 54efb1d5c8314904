"""Function generation through HTTP: solved, verified, drawn and driven; a refusal names the field."""

from __future__ import annotations

import re

import pytest

from synthesis.registry import list_examples

EXAMPLES = list_examples("function")


def solved(server, problem):
    """The finished job of a problem; the first one of its kind loads what it needs."""
    return server.reaches(server.post(problem=problem, wait=30)["id"], "succeeded", 90.0)


@pytest.fixture(scope="module")
def jobs(server):
    return [solved(server, example) for example in EXAMPLES]


def test_examples_run(jobs):
    for job in jobs:
        assert job["status"] == "succeeded", job
        assert job["result"]["designs"]
        for design in job["result"]["designs"]:
            assert design["verification"]["passed"]


def test_designs_are_drawn_and_tabled(server, jobs):
    for job in jobs:
        place = f"/v1/jobs/{job['id']}/designs/0"
        drawing = server.client.get(f"{place}.svg")
        assert drawing.status_code == 200, drawing.text
        met = "pairs" in job["problem"] and job["problem"]["pairs"] is not None
        assert f'data-diagram="{"output" if met else "structural_error"}"' in drawing.text
        design = job["result"]["designs"][0]
        assert drawing.text.count('data-configuration="') == min(12, len(design["targets"]))
        table = server.client.get(f"{place}.csv").text.splitlines()
        assert table[0].startswith("input,input_angle_deg,structural_error_")
        assert len(table) == 1 + len(design["structural_error"]["curve"]["input"])


def test_designs_move(server, jobs):
    for job in jobs:
        design = job["result"]["designs"][0]
        motion = server.client.get(f"/v1/jobs/{job['id']}/designs/0/motion?steps=720")
        assert motion.status_code == 200, motion.text
        moved = motion.json()
        # The motion meets each target's input angle, modulo full turns, and the output there.
        target = design["targets"][-1]
        near = min(
            range(len(moved["input_angle"])),
            key=lambda k: abs((moved["input_angle"][k] - target["input_angle"] + 180.0) % 360.0 - 180.0),
        )
        if design["structural_error"]["unit"] == "degrees":
            off = moved["links"]["output"]["angle"][near] - target["output_place"]
            assert abs((off + 180.0) % 360.0 - 180.0) < 2.0


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"function": {"name": "logarithm", "x": [-1.0, 2.0]}}, "/problem/function/x"),
        ({"function": {"name": "tangent", "x": [45.0, 135.0]}}, "/problem/function/x"),
        ({"function": {"name": "reciprocal", "x": [-1.0, 1.0]}}, "/problem/function/x"),
        ({"function": {"name": "power", "exponent": 0.0, "x": [1.0, 2.0]}}, "/problem/function/exponent"),
        ({"function": {"name": "exec('1')", "x": [1.0, 2.0]}}, "/problem/function/name"),
        ({"input_range": 360.0}, "/problem/input_range"),
        ({"pairs": [{"input": 0.0, "output": 0.0}, {"input": 1.0, "output": 1.0}]}, "/problem/function"),
    ],
)
def test_a_refusal_names_the_field(server, change, path):
    answer = server.client.post("/v1/jobs", json={"problem": {**EXAMPLES[0], **change}})
    assert answer.status_code == 422
    assert path in [error["path"] for error in answer.json()["errors"]], answer.text


def test_no_expression_reaches_the_answer(server, jobs):
    drawing = server.client.get(f"/v1/jobs/{jobs[0]['id']}/designs/0.svg").text
    assert not re.search(r"<script|NaN", drawing)


def test_a_design_that_breaks_a_check_is_drawn_too(server):
    pairs = [(0.0, 0.0), (40.0, 60.0), (70.0, 10.0), (100.0, 80.0), (140.0, 5.0)]
    problem = {
        "kind": "function",
        "pairs": [{"input": x, "output": y} for x, y in pairs],
        "include_failed": True,
    }
    job = solved(server, problem)
    designs = job["result"]["designs"]
    assert designs
    assert not designs[0]["verification"]["passed"]
    for n in range(len(designs)):
        assert server.client.get(f"/v1/jobs/{job['id']}/designs/{n}.svg").status_code == 200
