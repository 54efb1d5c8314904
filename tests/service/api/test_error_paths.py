"""Whatever is wrong with a request, the path of each fault leads to a place that the client has sent."""

import copy

import pytest
from pydantic import ValidationError

from service import requests
from service.answers.analysis import analyse
from service.api.http.schemas import JobRequest
from service.refusals import Refusal, refuse_invalid_body
from synthesis.analyses import list_families
from synthesis.registry import KINDS, list_examples
from tests.support.service.variations import variations

ANALYSES = {family.request.__name__: family.request.get_example() for family in list_families()}


def leads(body, pointer):
    """Whether a pointer leads to a place of the body, or to a field that is missing from an object of it."""
    if pointer == "":
        return True
    *way, last = [step.replace("~1", "/").replace("~0", "~") for step in pointer[1:].split("/")]
    for step in way:
        if isinstance(body, dict) and step in body:
            body = body[step]
        elif isinstance(body, list) and step.isdecimal() and int(step) < len(body):
            body = body[int(step)]
        else:
            return False
    return isinstance(body, dict) or (isinstance(body, list) and last.isdecimal() and int(last) < len(body))


def take_problem(body):
    """The paths of the faults for which the body of a job is refused; None where it is accepted."""
    try:
        problem = JobRequest.model_validate(body).problem
    except ValidationError as error:
        return [path for path, _ in refuse_invalid_body(error, body, JobRequest).errors]
    return [f"/problem{path}" for path, _ in requests.check_consistency(problem)] or None


def take_analysis(body):
    """The paths of the faults for which an analysis is refused; None where it is answered."""
    try:
        analyse(body)
    except Refusal as refusal:
        return [path for path, _ in refusal.errors]
    return None


def astray(take, bodies):
    """The pointers that lead nowhere, and how many bodies were refused."""
    wrong, refused = [], 0
    for body in bodies:
        paths = take(body)
        if paths is None:
            continue
        refused += 1
        assert paths, body
        wrong += [(path, body) for path in paths if not leads(body, path)]
    return wrong, refused


@pytest.mark.parametrize("kind", KINDS)
def test_of_a_problem(kind):
    wrong, refused = astray(take_problem, variations({"problem": list_examples(kind)[0], "label": "varied"}))
    assert not wrong
    assert refused > 20


@pytest.mark.parametrize("family", ANALYSES)
def test_of_an_analysis(family):
    wrong, refused = astray(take_analysis, variations(ANALYSES[family]))
    assert not wrong
    assert refused > 10


@pytest.mark.parametrize(
    ("kind", "change", "path"),
    [
        ("cam", lambda problem: problem["segments"][0].update(angle=-1.0), "/problem/segments/0/angle"),
        ("cam", lambda problem: problem["segments"][0].pop("angle"), "/problem/segments/0/angle"),
        ("cam", lambda problem: problem["follower"].update(no_such=1), "/problem/follower/no_such"),
        ("motion", lambda problem: problem.update(driver_dyad={"no_such": 1}), "/problem/driver_dyad/no_such"),
        ("motion", lambda problem: problem.update({"<motion>": 1}), "/problem/<motion>"),
    ],
    ids=["tagged", "missing", "unknown", "one of several", "like a tag"],
)
def test_a_path_has_no_step_that_is_not_in_the_body(scripted, kind, change, path):
    body = {"problem": copy.deepcopy(list_examples(kind)[0])}
    change(body["problem"])
    assert path in [fault["path"] for fault in scripted.client.post("/v1/jobs", json=body).json()["errors"]]
