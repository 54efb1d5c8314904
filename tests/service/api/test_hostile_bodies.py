"""Bodies that no honest client sends: each is refused quickly, with a problem that says where, and repeats nothing."""

import json

import pytest

from synthesis.registry import KINDS
from tests.support.service import hostile
from tests.support.service.hostile_bodies import ENORMOUS, INVALID, MALFORMED, MIB, raw, with_x
from tests.support.service.running import PROBLEM

HANGS_S = 10.0
"""An answer that takes so long is taken for a hang; how quick refusals are is measured, not tested."""


def refused(client, body, **headers):
    headers = {"Content-Type": "application/json", **headers}
    answer = client.post("/v1/jobs", content=body, headers=headers, timeout=HANGS_S)
    assert answer.headers["content-type"] == "application/problem+json"
    problem = answer.json()
    assert problem["status"] == answer.status_code
    assert problem["type"].startswith("/problems/")
    assert problem["title"]
    assert problem["detail"]
    assert problem["instance"] == "/v1/jobs"
    assert len(problem.get("errors", [])) <= 20
    return answer.status_code, problem


@pytest.mark.parametrize("name", MALFORMED)
def test_what_is_not_json(client, name):
    status, problem = refused(client, MALFORMED[name])
    assert status == 400
    assert problem["type"] == "/problems/malformed-json"


@pytest.mark.parametrize("name", INVALID)
def test_what_states_no_problem(client, name):
    body, path = INVALID[name]
    status, problem = refused(client, body)
    assert status == 422
    paths = [error["path"] for error in problem["errors"]]
    if path is not None:
        assert path in paths
    for error in problem["errors"]:
        assert error["detail"].endswith((".", "?"))
        assert error["detail"][0].isupper()
        assert "perpetuum" not in error["detail"]


@pytest.mark.parametrize("name", ENORMOUS)
def test_what_is_large(client, name):
    assert len(ENORMOUS[name]) <= MIB
    status, problem = refused(client, ENORMOUS[name])
    assert status == 422
    assert len(json.dumps(problem)) < 20_000


@pytest.mark.slow
@pytest.mark.parametrize("kind", list(KINDS))
def test_every_field_of_every_kind_spoilt(client, kind):
    bodies = dict(hostile.of_kind(kind))
    assert len(bodies) >= 12
    for name, body in bodies.items():
        status, _ = refused(client, body)
        assert status in (400, 422), name


def test_punctuation_within_strings_is_not_counted(client):
    """What looks like a hundred thousand values is two strings; they are refused for what they are."""
    status, problem = refused(client, raw(r'{"kind": "[{,}]\"\\' + "[,]{,}" * 50_000 + '", "a": "\\\\"}'))
    assert status == 422
    assert [error["path"] for error in problem["errors"]] == ["/problem/kind"]


def test_at_most_twenty_faults_are_listed(client):
    body = raw('{"kind":"motion",' + ",".join(f'"wrong_{n}":0' for n in range(50)) + "}")
    _, problem = refused(client, body)
    assert len(problem["errors"]) == 20
    assert "More than 20 fields" in problem["detail"]


def test_what_has_to_be_a_list_is_told_so(client):
    _, problem = refused(client, raw('{"kind":"motion","positions":3}'))
    assert [(each["path"], each["detail"]) for each in problem["errors"]] == [
        ("/problem/positions", 'Expected a list, for example [{"x": 0, "y": 0, "angle": 0}].')
    ]


def test_a_body_over_the_limit_by_its_header(client):
    status, problem = refused(client, b" " * (MIB + 1))
    assert (status, problem["type"]) == (413, "/problems/body-too-large")


def test_a_body_over_the_limit_without_a_header(client):
    def stream():
        for _ in range(20):
            yield b" " * 65_536

    status, problem = refused(client, stream())
    assert (status, problem["type"]) == (413, "/problems/body-too-large")


@pytest.mark.parametrize(
    "media_type", ["", "text/plain", "application/x-www-form-urlencoded", "application/xml", "\xe9"]
)
def test_a_body_of_another_type(client, media_type):
    body = json.dumps({"problem": PROBLEM}).encode()
    answer = client.post("/v1/jobs", content=body, headers={"Content-Type": media_type.encode("latin-1")})
    assert answer.status_code == 415
    assert answer.json()["type"] == "/problems/unsupported-media-type"


def test_a_body_without_a_type(client):
    answer = client.post("/v1/jobs", content=json.dumps({"problem": PROBLEM}).encode())
    assert answer.status_code == 415


def test_a_compressed_body(client):
    assert refused(client, b"\x1f\x8b", **{"Content-Encoding": "gzip"})[0] == 415


GIVEN_TWICE = {
    "of a position": (with_x('1, "x": 2'), "/problem/positions/0/x"),
    "with an equal value": (with_x('1, "x": 1'), "/problem/positions/0/x"),
    "written otherwise": (with_x('1, "\\u0078": 2'), "/problem/positions/0/x"),
    "at the top": (b'{"problem": {"kind": "motion"}, "label": "a:b", "label": "c"}', "/label"),
    "an object": (b'{"problem": {"a/b": {"c": 1}, "a/b": {"c": 1}}}', "/problem/a~1b"),
    "in a member that is lost": (b'{"label": {"a": 1, "a": 2}, "label": "\\":"}', "/label/a"),
}


@pytest.mark.parametrize("route", ["/v1/jobs", "/v1/analyses"])
@pytest.mark.parametrize("name", GIVEN_TWICE)
def test_a_key_that_is_given_twice_is_refused_where_it_stands(client, name, route):
    body, path = GIVEN_TWICE[name]
    answer = client.post(route, content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code == 422
    twice = {error["path"] for error in answer.json()["errors"] if "twice" in error["detail"]}
    assert path in twice


def test_equal_keys_of_different_objects_and_colons_in_strings_are_none(client):
    body = json.dumps({"problem": PROBLEM, "label": 'a "b": {"c": 1, "c": 2} \\'}).encode()
    answer = client.post("/v1/jobs", content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code in (200, 202), answer.text
