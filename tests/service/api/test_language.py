"""Answers, errors and progress in the language that a client prefers, with the ids of their messages."""

from __future__ import annotations

import copy
import re

from kinematics.message import LANGUAGES
from synthesis.registry import get_first_example
from tests.support.service.answers import finished

GERMAN = {"Accept-Language": "de-CH, en;q=0.3"}
ENGLISH = {"Accept-Language": "en-GB, de;q=0.3"}

# No train within these limits has the ratio, so the answer is a sentence with values.
UNREACHABLE = {"kind": "gear_train", "ratio": "pi", "max_stages": 1, "teeth": {"min": 17, "max": 19}}

UNSOLVABLE_FOURBAR = {
    "mechanism": {"type": "fourbar", "links": {"ground": 10.0, "crank": 1.0, "coupler": 2.0, "rocker": 3.0}},
    "motion": {"from": 0, "to": 360, "steps": 10},
}


def test_a_refusal_is_written_in_the_language_of_the_request(client):
    problem = copy.deepcopy(get_first_example("motion"))
    problem["positions"][1] = problem["positions"][0]
    body = {"problem": problem}
    german, english = (client.post("/v1/jobs", json=body, headers=headers) for headers in (GERMAN, ENGLISH))
    assert (german.status_code, german.headers["content-language"]) == (422, "de")
    assert (english.status_code, english.headers["content-language"]) == (422, "en")
    assert "Accept-Language" in german.headers["vary"]
    german, english = german.json(), english.json()
    assert [one["path"] for one in german["errors"]] == [one["path"] for one in english["errors"]]
    assert german["messages"] == english["messages"]
    for name in ("title", "detail"):
        assert german[name] != english[name]
    for here, there in zip(german["errors"], english["errors"], strict=True):
        assert here["detail"] != there["detail"]
    assert {one["path"] for one in english["messages"]} == {
        "/title", "/detail", *(f"/errors/{k}/detail" for k in range(len(english["errors"])))
    }  # fmt: skip


def test_faults_of_single_fields_are_written_in_the_language_of_the_request(client):
    body = {"problem": {**get_first_example("motion"), "max_designs": 0, "seed": "one"}}
    german, english = (client.post("/v1/jobs", json=body, headers=headers).json() for headers in (GERMAN, ENGLISH))
    assert len(german["errors"]) == len(english["errors"]) == 2
    assert all(a["detail"] != b["detail"] for a, b in zip(german["errors"], english["errors"], strict=True))


def test_a_stored_answer_is_read_in_either_language(client):
    job = finished(client, UNREACHABLE)
    path = f"/v1/jobs/{job['id']}"
    german, english = (client.get(path, headers=headers) for headers in (GERMAN, ENGLISH))
    assert german.headers["etag"] != english.headers["etag"]
    assert client.get(path, headers={**GERMAN, "If-None-Match": german.headers["etag"]}).status_code == 304
    assert client.get(path, headers={**ENGLISH, "If-None-Match": german.headers["etag"]}).status_code == 200
    here, there = german.json()["result"], english.json()["result"]
    assert here["summary"] != there["summary"]
    assert here["messages"] == there["messages"]
    summary = next(one for one in there["messages"] if one["path"] == "/summary")
    assert re.fullmatch(r"\w+-[\w-]+|joined", summary["id"])
    # Everything but the texts is the same.
    for answer in (here, there):
        for one in answer["messages"]:
            parent = answer
            *steps, last = one["path"].split("/")[1:]
            for step in steps:
                parent = parent[int(step) if isinstance(parent, list) else step]
            parent[int(last) if isinstance(parent, list) else last] = None
    assert here == there


def test_an_analysis_is_refused_in_the_language_of_the_request(client):
    german, english = (
        client.post("/v1/analyses", json=UNSOLVABLE_FOURBAR, headers=headers) for headers in (GERMAN, ENGLISH)
    )
    assert german.status_code == english.status_code == 422
    assert german.json()["errors"][0]["path"] == english.json()["errors"][0]["path"]
    assert german.json()["errors"][0]["detail"] != english.json()["errors"][0]["detail"]


def test_unknown_languages_are_answered_in_english(client):
    for header in ("", "fr", "de;q=0", "*;q=0.1", "nonsense;;;q=x", ",".join(["zz"] * 1000)):
        answer = client.get("/v1/jobs/unknown", headers={"Accept-Language": header})
        assert answer.headers["content-language"] == LANGUAGES[0], header
