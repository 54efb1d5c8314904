"""Whatever is wrong with a request, the path of each fault leads to a place that the client has sent."""

import copy
import time

import httpx
import pytest

from synthesis.analyses import list_families
from synthesis.registry import KINDS, list_examples
from tests.support.service.running import SCRIPTED, RunningServer
from tests.support.service.variations import variations

ANALYSES = {family.request.__name__: family.request.get_example() for family in list_families()}


@pytest.fixture(scope="module")
def asked(tmp_path_factory):
    server = RunningServer(
        tmp_path_factory.mktemp("paths"), SCRIPTED, workers=1, rate_limit="off", max_queued=100_000, log_level="warning"
    )
    with httpx.Client(base_url=server.url, timeout=60.0) as client:
        yield client
    assert server.stop() == 0
    assert "Traceback" not in server.log()


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


def astray(client, url, bodies):
    """The pointers that lead nowhere, and how many bodies were refused."""
    wrong, refused = [], 0
    for body in bodies:
        answer = client.post(url, json=body)
        while answer.status_code == 503:  # the first analyses may have to compile their kernels
            time.sleep(float(answer.headers["retry-after"]))  # as a client is asked to
            answer = client.post(url, json=body)
        assert answer.status_code in (200, 202, 422), answer.text
        if answer.status_code != 422:
            continue
        refused += 1
        problem = answer.json()
        assert problem["errors"], problem
        wrong += [(fault, body) for fault in problem["errors"] if not leads(body, fault["path"])]
    return wrong, refused


@pytest.mark.slow
@pytest.mark.timeout(400)
@pytest.mark.parametrize("kind", KINDS)
def test_of_a_problem(asked, kind):
    wrong, refused = astray(asked, "/v1/jobs", variations({"problem": list_examples(kind)[0], "label": "varied"}))
    assert not wrong
    assert refused > 20


@pytest.mark.slow
@pytest.mark.timeout(400)
@pytest.mark.parametrize("family", ANALYSES)
def test_of_an_analysis(asked, family):
    wrong, refused = astray(asked, "/v1/analyses", variations(ANALYSES[family]))
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
