"""``GET /v1/jobs/{id}/designs/{n}/motion``: the cycle of a design that the service has found."""

import copy
import json

import numpy as np
import pytest

from service.answers import designs
from service.api.http.problem_details import Refusal
from tests.support.service.analyses import assert_as_documented, joint
from tests.support.service.running import PROBLEM


@pytest.fixture(scope="module")
def found(server):
    """A finished job with many designs, cranks and rockers."""
    job = server.post(problem=PROBLEM, wait=30)
    assert job["status"] == "succeeded"
    return job


@pytest.fixture(scope="module")
def motions(server, found):
    out = []
    for n in range(len(found["result"]["designs"])):
        answer = server.client.get(f"/v1/jobs/{found['id']}/designs/{n}/motion", params={"steps": 720})
        assert answer.status_code == 200, answer.text
        assert answer.headers["content-type"] == "application/json"
        assert "NaN" not in answer.text
        assert_as_documented(answer.json())
        out.append(answer.json())
    return out


def turns_through(motion):
    (here,) = (b for circuit in motion["circuits"] for b in circuit["branches"] if b["reference"])
    return here["full"]


def test_there_are_cranks_and_rockers_among_them(motions):
    assert {turns_through(motion) for motion in motions} == {True, False}


def test_a_crank_starts_at_the_first_target_and_closes_on_itself(found, motions):
    for design, motion in zip(found["result"]["designs"], motions, strict=True):
        if turns_through(motion):
            at = motion["input_angle"]
            assert np.isclose(at[0], design["mechanism"]["reference_input_angle"])
            assert np.isclose(at[-1] - at[0], 360.0)
            assert all(motion["valid"])
            for name in motion["joints"]:
                track = joint(motion, name)
                assert abs(track[-1] - track[0]) < 1e-9 * design["metrics"]["size"]


def test_a_rocker_goes_from_toggle_to_toggle(motions):
    for motion in motions:
        if not turns_through(motion):
            at = np.array(motion["input_angle"])
            assert all(motion["valid"])
            ends = np.mod(at[[0, -1]], 360.0)
            assert all(np.isclose(ends[:, None], np.array(motion["toggles"])).any(axis=1))
            middle = motion["joints"]["B"]["vx"][1:-1]
            assert None not in middle
            assert np.abs(np.array(motion["links"]["coupler"]["omega"][1:-1])).argmax() in (0, len(middle) - 1)


def test_the_coupler_point_passes_the_targets(server, found, motions):
    for n, (design, motion) in enumerate(zip(found["result"]["designs"], motions, strict=True)):
        track = joint(motion, "P")
        step = np.abs(np.diff(track)).max()
        for target, position in zip(design["targets"], found["problem"]["positions"], strict=True):
            demanded = complex(position["x"], position["y"])
            assert np.abs(track - demanded).min() <= step
            body = {"mechanism": design["mechanism"], "motion": {"at": target["input_angle"]}}
            here = server.client.post("/v1/analyses", json=body).json()
            assert abs(joint(here, "P")[0] - demanded) < 1e-8 * design["metrics"]["size"], n


def test_rates_are_by_the_radian(motions):
    for motion in motions:
        known = np.array([x for x in motion["links"]["input"]["omega"] if x is not None])
        assert np.allclose(known, 1.0)


@pytest.mark.parametrize(("query", "count"), [("", 361), ("?steps=1", 2), ("?steps=3600", 3601)])
def test_steps(client, found, query, count):
    motion = client.get(f"/v1/jobs/{found['id']}/designs/0/motion{query}").json()
    assert len(motion["input_angle"]) == len(motion["joints"]["P"]["x"]) == count


@pytest.mark.parametrize(
    ("query", "path"),
    [("steps=0", "/query/steps"), ("steps=3601", "/query/steps"), ("steps=x", "/query/steps"),
     ("steps=", "/query/steps"), ("step=5", "/query/step")],
)  # fmt: skip
def test_a_bad_parameter_is_named(client, found, query, path):
    answer = client.get(f"/v1/jobs/{found['id']}/designs/0/motion?{query}")
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == [path]


def test_a_design_beyond_what_can_be_stated_is_not_moved_but_said_to_be_so(found):
    result = copy.deepcopy(found["result"])
    result["designs"][0]["mechanism"]["skeleton"]["joints"]["B"] = [2e9, 0.0]
    with pytest.raises(Refusal) as refused:
        designs.move_design(json.dumps(result), "0", 36)
    assert (refused.value.status, refused.value.type) == (409, "/problems/no-motion")
