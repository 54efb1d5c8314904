"""Constraints through HTTP, one case of each kind that has them: checked in the answer, or refused at their field."""

from __future__ import annotations

import pytest

from synthesis.registry import get_first_example
from tests.support.service.answers import finished
from tests.support.synthesis.constraints import TIMED_PATH

STATED = {
    "max_link_ratio": 1e4,
    "fixed_pivot_region": {"x": [-1e7, 1e7], "y": [-1e7, 1e7]},
    "link_length": {"min": 1e-6, "max": 1e6},
}
CHECKED = {"same_branch", "visits_in_order", "link_ratio", "fixed_pivot_region", "shortest_link", "longest_link"}

QUICK = {
    "motion": get_first_example("motion") | {"max_designs": 2},
    "path": TIMED_PATH,
    "function": get_first_example("function")
    | {"function": None, "input_range": None, "output_range": None, "criterion": None}
    | {"pairs": [{"input": 40.0, "output": 70.0}, {"input": 45.0, "output": 76.0}]},
    "quick_return": get_first_example("quick_return"),
    "straight_line": {"kind": "straight_line", "length": 60.0, "mechanism": "peaucellier"},
    "steering": get_first_example("steering") | {"mechanism": "davis"},
    "dwell": get_first_example("dwell") | {"max_designs": 1},
    "parallel_motion": get_first_example("parallel_motion"),
}

REFUSED = {
    "motion": ({"output_side": {"dyad": "PR"}}, "grashof", "double_rocker"),
    "path": (get_first_example("path") | {"timing": "free", "mechanism": "slider_crank"}, "grashof", "crank_rocker"),
    "function": ({"mechanism": "slider_crank"}, "grashof", "crank_rocker"),
    "quick_return": ({}, "grashof", "double_rocker"),
    "straight_line": ({}, "grashof", "crank_rocker"),
    "steering": ({}, "full_rotation", True),
    "dwell": ({}, "grashof", "double_crank"),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", QUICK)
def test_constraints_stand_in_the_answer(server, kind):
    job = finished(server.client, {**QUICK[kind], "constraints": STATED})
    designs = job["result"]["designs"]
    assert designs
    for design in designs:
        assert {check["name"] for check in design["verification"]["checks"]} >= CHECKED


@pytest.mark.parametrize("kind", REFUSED)
def test_what_cannot_apply_is_refused_at_its_field(client, kind):
    fields, name, demand = REFUSED[kind]
    statement = {**QUICK[kind], **fields, "constraints": {name: demand}}
    answer = client.post("/v1/jobs", json={"problem": statement})
    assert answer.status_code == 422
    errors = {error["path"]: error["detail"] for error in answer.json()["errors"]}
    assert errors.keys() == {f"/problem/constraints/{name}"}
    assert all(len(detail.split()) > 3 for detail in errors.values())
