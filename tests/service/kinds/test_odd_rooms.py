"""Rooms that nobody would draw, for every kind of linkage: refused at their field, or answered soon and honestly."""

import copy

import pytest

from synthesis.model.linkage.problem import LinkageProblem
from synthesis.registry import KINDS, list_examples
from tests.campaign import further
from tests.support.problems.room_cases import ANSWERED, REFUSED, size_of, star
from tests.support.service.answers import finished

LINKAGES = [name for name, kind in KINDS.items() if issubclass(kind.problem, LinkageProblem)]

SOON = {"motion": 3, "path": 1, "function": 2, "dwell": 1}
"""The example of a kind that is soon solved, where that is not the first."""

QUICK = [
    ("motion", "everything in the way"),
    ("motion", "tiny zones for all pivots"),
    ("motion", "a clearance larger than the box"),
]


def problem_of(kind, **more):
    return {**copy.deepcopy(list_examples(kind)[SOON.get(kind, 0)]), **more}


@pytest.mark.slow
@pytest.mark.parametrize("kind", LINKAGES)
def test_a_room_that_cannot_be_is_refused_at_its_field(client, kind):
    problem = problem_of(kind)
    size = size_of(problem)
    for name, make in REFUSED.items():
        room, place = make(size)
        answer = client.post("/v1/jobs", json={"problem": {**problem, "space": room}})
        assert answer.status_code == 422, (name, answer.text)
        told = [error["path"] for error in answer.json().get("errors", [])]
        assert any(path.startswith(f"/problem/space/{place}") for path in told), (name, answer.text)


@pytest.mark.parametrize("kind", LINKAGES)
def test_more_corners_than_a_body_holds(client, kind):
    room = {"obstacles": [{"polygon": star(0.0, 0.0, 1.0, 5000)}]}
    answer = client.post("/v1/jobs", json={"problem": problem_of(kind, space=room)})
    assert answer.status_code == 422
    assert "values" in answer.json()["detail"]


@pytest.mark.timeout(400)
@pytest.mark.parametrize(("kind", "name"), further([(kind, name) for kind in LINKAGES for name in ANSWERED], QUICK))
def test_a_room_that_leaves_little_is_answered_with_what_is_missing(client, kind, name):
    problem = problem_of(kind, max_designs=3, **({"rounds": 1} if kind == "path" else {}))
    room = ANSWERED[name](size_of(problem))
    stated = {"problem": {**problem, "space": room}}
    answer = client.post("/v1/jobs", json=stated)
    if answer.status_code == 422:
        # What holds the first position, or the pivots that are stated, holds all there are.
        assert all(error["path"].startswith("/problem/space/") for error in answer.json()["errors"]), answer.text
        return
    job = finished(client, stated["problem"])
    assert job["status"] == "succeeded", job["error"]
    result = job["result"]
    for design in result["designs"]:
        checks = {check["name"]: check["passed"] for check in design["verification"]["checks"]}
        swept = room.get("obstacles") or room.get("box")
        assert all(checks.values())
        assert not swept or {"obstacles", "box"} & set(checks)
    if not result["designs"]:
        assert result["nearest_miss"] is not None or result["summary"]
