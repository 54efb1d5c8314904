"""What is wrong with a batch is found in bounded time, and told by its place."""

import time

import pytest

from service.api.http.problem_details import Refusal
from service.api.routes.batch_plans import build_plan
from service.api.routes.batch_schemas import BatchRequest
from service.error_messages import MAX_FAULTS

SEEDS = {"field": "/seed", "from": 0, "to": 9999, "count": 10_000}
MOTION = {"kind": "motion", "positions": [{"x": 0, "y": 0, "angle": 0}, {"x": 9, "y": 5, "angle": 30}]}
SOON_S = 3.0
"""Three times what is allowed; looking at all hundred samples takes ten times that, and more."""


def refused(problem, vary, **fields):
    began = time.thread_time()
    with pytest.raises(Refusal) as caught:
        build_plan(BatchRequest.model_validate({"problem": problem, "vary": vary, **fields}))
    assert time.thread_time() - began < SOON_S
    assert caught.value.status == 422
    return caught.value


@pytest.mark.parametrize("varied", [[], [{"field": "/segments/0/motion", "values": ["dwell"]}]])
def test_what_is_wrong_with_the_problem_itself_is_told_at_once(varied):
    refusal = refused({"kind": "cam", "segments": [{}] * 9000}, [*varied, SEEDS])
    assert {path.split("/")[1] for path, _ in refusal.errors} == {"problem"}
    assert refusal.detail.endswith(
        ": The field 'motion' is required. More than 20 fields of the request are invalid; the first 20 are listed."
    )
    assert refusal.type == "/problems/invalid-problem"


@pytest.mark.slow
def test_faults_beside_a_varied_field_are_looked_for_no_longer_than_may_be():
    """These could go by its value, so that other samples are looked at as well."""
    problem = {**MOTION, "constraints": {f"q{k}": 1 for k in range(9000)}}
    refusal = refused(problem, [{"field": "/constraints/grashof", "values": ["any"]}, SEEDS])
    path, detail = refusal.errors[0]
    assert path == "/problem/constraints/q0"
    assert detail.startswith("Unknown field; the fields are `min_transmission_angle`, ")


def test_values_with_very_many_faults_are_told_in_part():
    values = [[{"x": 0.0, "y": 0.0, f"q{k}": n} for k in range(900)] for n in range(9)]
    refusal = refused({"kind": "path"}, [{"field": "/points", "values": values}, {**SEEDS, "count": 10}])
    assert len(refusal.errors) == MAX_FAULTS + 1
    assert refusal.errors[7][0] == "/vary/0/values/0/7/q7"


def test_a_spaced_value_is_told_by_itself():
    refusal = refused(MOTION, [{"field": "/max_designs", "from": 0.123456789, "to": 0.2, "count": 3}])
    assert refusal.errors[0][0] == "/vary/0"
    assert "The value is 0.123456789." in refusal.errors[0][1]


def test_a_field_that_another_goes_by_does_not_condemn_the_problem():
    """With the first value of `motion` the lift is a field that there is not, with others it is one."""
    from synthesis.registry import get_first_example

    cam = get_first_example("cam")
    segment = next(k for k, each in enumerate(cam["segments"]) if "lift" in each)
    motions = ["dwell", cam["segments"][segment]["motion"]]
    body = {"problem": cam, "vary": [{"field": f"/segments/{segment}/motion", "values": motions}]}
    _, plan, _ = build_plan(BatchRequest.model_validate(body))
    assert plan.total == 2
