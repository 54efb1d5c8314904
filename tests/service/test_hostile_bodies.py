"""Bodies that no honest client sends: each is refused quickly, with a problem that says where, and repeats nothing."""

import copy
import json

import pytest

from synthesis.registry import KINDS
from tests.service import hostile
from tests.service.running import PROBLEM

MIB = 1 << 20
HANGS_S = 10.0
"""An answer that takes so long is taken for a hang; how quick refusals are is measured, not tested."""


def raw(problem: str) -> bytes:
    return f'{{"problem": {problem}}}'.encode()


def changed(path, value):
    """The good body with one value put in."""
    body = {"problem": copy.deepcopy(PROBLEM)}
    *parents, last = path
    place = body
    for step in parents:
        place = place[step]
    place[last] = value
    return json.dumps(body).encode()


POSITION = '{"x": 0, "y": 0, "angle": 0}'


def with_x(number: str) -> bytes:
    return raw(f'{{"kind": "motion", "positions": [{{"x": {number}, "y": 0, "angle": 0}}, {POSITION}]}}')


MALFORMED = {
    "empty": b"",
    "spaces": b"   ",
    "truncated": b'{"problem": {"kind": "motion", "positions": [',
    "two values": b"{} {}",
    "not json": b"problem=motion",
    "single quotes": b"{'problem': 1}",
    "trailing comma": b'{"problem": {},}',
    "comment": b'{"problem": {} /* x */}',
    "lone surrogate": b'{"problem": {}, "label": "\\ud800"}',
    "lone low surrogate": b'{"problem": {}, "label": "\\udc00 x"}',
    "bad utf-8": b'{"problem": {}, "label": "\xff\xfe"}',
    "overlong utf-8": b'{"problem": {}, "label": "\xc0\xaf"}',
    "utf-16": '{"problem": {}}'.encode("utf-16"),
    "byte order mark": b'\xef\xbb\xbf{"problem": {}}',
    "nul byte": b'{"problem": {}}\x00',
    "control character in a string": b'{"problem": {}, "label": "a\x01"}',
    "deep lists": b"[" * 100_000,
    "deep objects": b'{"a":' * 100_000,
    "5000 digits": with_x("1" * 5000),
    "a million digits": with_x("1" * 1_000_000),
    "leading zero": with_x("01"),
    "hexadecimal": with_x("0x10"),
    "python's true": b'{"problem": True}',
}

INVALID = {
    "a list": (b"[]", ""),
    "a string": (b'"problem"', ""),
    "a number": (b"3", ""),
    "null": (b"null", ""),
    "no problem": (b"{}", "/problem"),
    "problem null": (raw("null"), "/problem"),
    "problem a list": (raw("[1]"), "/problem"),
    "problem a string": (raw('"motion"'), "/problem"),
    "no kind": (raw(f'{{"positions": [{POSITION}, {{"x": 1, "y": 0, "angle": 0}}]}}'), "/problem/kind"),
    "unknown kind": (changed(("problem", "kind"), "perpetuum_mobile"), "/problem/kind"),
    "kind a list": (changed(("problem", "kind"), ["motion"]), "/problem/kind"),
    "unknown field": (changed(("problem", "postions"), []), "/problem/postions"),
    "unknown field above": (json.dumps({"problem": PROBLEM, "priority": 1}).encode(), "/priority"),
    "field that needs escapes": (changed(("problem", "a/b~c"), 0), "/problem/a~1b~0c"),
    "nan": (with_x("NaN"), "/problem/positions/0/x"),
    "infinity": (with_x("Infinity"), "/problem/positions/0/x"),
    "minus infinity": (with_x("-Infinity"), "/problem/positions/0/x"),
    "1e999": (with_x("1e999"), "/problem/positions/0/x"),
    "absurdly large": (with_x("1e10"), "/problem/positions/0/x"),
    "an integer beyond doubles": (with_x("1" * 400), "/problem/positions/0/x"),
    "a number as a string": (with_x('"1"'), "/problem/positions/0/x"),
    "a number as a truth": (with_x("true"), "/problem/positions/0/x"),
    "a number as null": (with_x("null"), "/problem/positions/0/x"),
    "one position": (changed(("problem", "positions"), [PROBLEM["positions"][0]]), "/problem/positions"),
    "no positions": (changed(("problem", "positions"), []), "/problem/positions"),
    "positions an object": (changed(("problem", "positions"), {"0": 1}), "/problem/positions"),
    "equal positions": (changed(("problem", "positions"), [PROBLEM["positions"][0]] * 2), "/problem/positions/1"),
    "missing coordinate": (changed(("problem", "positions", 1), {"x": 1, "y": 1}), "/problem/positions/1/angle"),
    "too many choices": (
        changed(
            ("problem", "input_side"),
            {"fixed_pivot": [0, 0], "link_angle": 1.0, "coupler_vector": {"length": 1.0, "angle": 1.0}},
        ),
        "/problem/input_side",
    ),
    "pivot of three numbers": (changed(("problem", "input_side"), {"fixed_pivot": [0, 0, 0]}), None),
    "negative count": (changed(("problem", "max_designs"), -1), "/problem/max_designs"),
    "fractional count": (changed(("problem", "max_designs"), 1.5), "/problem/max_designs"),
    "huge seed": (changed(("problem", "seed"), 2**63), "/problem/seed"),
    "interval upside down": (
        changed(("problem", "constraints"), {"fixed_pivot_region": {"x": [1, 0], "y": [0, 1]}}),
        "/problem/constraints/fixed_pivot_region/x",
    ),
    "label a number": (json.dumps({"problem": PROBLEM, "label": 7}).encode(), "/label"),
    "label too long": (json.dumps({"problem": PROBLEM, "label": "x" * 201}).encode(), "/label"),
    "label with NUL": (json.dumps({"problem": PROBLEM, "label": "a\0b"}).encode(), "/label"),
}

ENORMOUS = {
    "a million positions": raw('{"kind": "motion", "positions": [' + "0," * 500_000 + "0]}"),
    "a hundred thousand unknown fields": raw("{" + ",".join(f'"{n:x}":0' for n in range(100_000)) + "}"),
    "deep and closed": raw("[" * 50_000 + "]" * 50_000),
    "many empty lists": raw("[" + "[]," * 340_000 + "[]]"),
    "many deep lists": raw("[" + ("[" * 99 + "]" * 99 + ",") * 5000 + "[]]"),
    "many small objects": raw("[" + '{"a":{"b":{"c":{}}}},' * 47_000 + "{}]"),
    "many strings of quotes": raw("[" + r'"\"\\",' * 130_000 + "0]"),
    "one name many times": raw("{" + '"kind":"motion",' * 60_000 + '"kind":"motion"}'),
    "a long string": raw('"' + "x" * (MIB - 100) + '"'),
    "a long field name": raw('{"' + "x" * (MIB - 100) + '": 0}'),
    "nearly too many values": raw("{" + ",".join(f'"{n:x}":0' for n in range(19_000)) + "}"),
}


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
        assert error["detail"].endswith(".")
        assert error["detail"][0].isupper()
        assert "perpetuum" not in error["detail"]


@pytest.mark.parametrize("name", ENORMOUS)
def test_what_is_large(client, name):
    assert len(ENORMOUS[name]) <= MIB
    status, problem = refused(client, ENORMOUS[name])
    assert status == 422
    assert len(json.dumps(problem)) < 20_000


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
    assert "more than 20 faults" in problem["detail"]


def test_what_has_to_be_a_list_is_told_so(client):
    _, problem = refused(client, raw('{"kind":"motion","positions":3}'))
    assert [(each["path"], each["detail"]) for each in problem["errors"]] == [
        ("/problem/positions", "This must be a list.")
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
