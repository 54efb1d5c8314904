"""Steering through HTTP: solved, drawn and driven."""

from __future__ import annotations

import pytest

from synthesis.registry import get_first_example
from tests.support.service.answers import drawn, finished


@pytest.fixture(scope="module")
def job(server):
    return finished(server.client, get_first_example("steering"))


def test_the_example_has_linkages_and_gears(job):
    assert job["status"] == "succeeded"
    assert {design["mechanism"]["type"] for design in job["result"]["designs"]} == {"fourbar", "davis"}
    assert all(design["verification"]["passed"] for design in job["result"]["designs"])


@pytest.mark.slow
def test_designs_are_drawn_and_driven(client, job):
    for n, design in enumerate(job["result"]["designs"]):
        place = f"/v1/jobs/{job['id']}/designs/{n}"
        root = drawn(client, place, design)
        assert len([g for g in root.iter() if g.get("data-configuration")]) == 3
        assert {g.get("data-diagram") for g in root.iter() if g.get("data-diagram")} == {"outer", "error"}
        motion = client.get(f"{place}/motion?steps=36")
        assert motion.status_code == 200, motion.text
        assert all(motion.json()["valid"])
        # The positions that the answer lists are those that an analysis of the mechanism gives.
        last = design["targets"][-1]
        turns = design["mechanism"]["type"] == "fourbar"
        driven, absent = ("input_angle", "input_place") if turns else ("input_place", "input_angle")
        assert absent not in last, "an input is at an angle, or at a place"
        body = {"mechanism": design["mechanism"], "motion": {"at": last[driven]}}
        here = client.post("/v1/analyses", json=body).json()
        name = "output" if design["mechanism"]["type"] == "fourbar" else "right_arm"
        body["motion"]["at"] = design["targets"][0][driven]
        straight = client.post("/v1/analyses", json=body).json()
        turned = here["links"][name]["angle"][0] - straight["links"][name]["angle"][0]
        assert (turned - last["outer"] + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(("stated", "path"), [({"lock": 90.0}, "/problem/lock"), ({"track": 1.0}, "/problem/track")])
def test_a_refusal_names_the_field(client, stated, path):
    answer = client.post("/v1/jobs", json={"problem": {**get_first_example("steering"), **stated}})
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == [path]
