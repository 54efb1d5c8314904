"""The constant documents of the API: built once, kept in the cache folder, and the same as the code says."""

import asyncio
import gzip
import json
import os
import time

import pytest

from service.api.http import documents
from service.api.http.documents import Documents, read_documents, write_documents
from service.api.http.problem_details import Refusal
from service.api.routes import problems
from service.api.routes.docs import remove_keys
from synthesis.registry import KINDS
from tests.support.service.api_document import read_api_document


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "mechsynth"


def build_two():
    """Stand for the documents, and count how often they are built in a file that all processes can see."""
    with open(os.environ["XDG_CACHE_HOME"] + "/built", "a") as built:
        built.write("x")
    yield {"first": gzip.compress(b"1")}
    yield {"second": gzip.compress(b"2")}


def die():
    yield {"first": gzip.compress(b"1")}
    os._exit(1)


def find(served, *names):
    async def read_all():
        return [(await served.find(name)).content for name in names]

    return asyncio.run(read_all())


def serve(build, ahead=False):
    served = Documents(build, "error", "text", ahead=ahead)
    served.start(after=lambda: True)
    return served


def test_documents_are_built_when_they_are_needed_and_once(cache):
    for _ in range(2):
        served = serve(build_two)
        try:
            assert find(served, "second", "first") == [b"2", b"1"]
        finally:
            served.stop()
    assert (cache.parent / "built").read_text() == "x"
    assert {file.name for file in cache.glob("documents-*/*")} == {"first.json.gz", "second.json.gz"}


def test_documents_are_built_ahead(cache):
    served = serve(build_two, ahead=True)
    try:
        latest = time.monotonic() + 60.0
        while read_documents() is None and time.monotonic() < latest:
            time.sleep(0.05)
        assert read_documents().keys() == {"first", "second"}
    finally:
        served.stop()


def test_a_folder_that_cannot_be_written_does_not_matter(cache):
    cache.write_text("a file where the folder would be")
    served = serve(build_two)
    try:
        assert find(served, "first") == [b"1"]
    finally:
        served.stop()


def test_documents_that_cannot_be_built_are_refused_for_now(cache, monkeypatch):
    monkeypatch.setattr(documents, "MAX_WAIT_S", 3.0)
    served = serve(die)
    try:
        with pytest.raises(Refusal) as refused:
            find(served, "second")
        assert (refused.value.status, refused.value.headers) == (503, {"Retry-After": "5"})
        assert read_documents() is None
    finally:
        served.stop()


def test_documents_of_other_versions_are_removed_some_day(cache):
    old, recent = cache / "documents-old", cache / "documents-recent"
    for folder in (old, recent):
        folder.mkdir(parents=True)
    os.utime(old, (0.0, 0.0))
    assert [*write_documents(build_two)] == [*build_two()]
    assert not old.exists()
    assert recent.exists()


@pytest.mark.slow
def test_the_service_sends_what_the_code_says(client):
    listed = client.get("/v1/problems")
    assert listed.headers["content-encoding"] == "gzip"
    assert listed.json() == json.loads(gzip.decompress(problems.pack_documents()["problems"]))
    for kind in listed.json()["problems"]:
        answer = client.get(f"/v1/problems/{kind['kind']}")
        assert answer.json() == kind
        again = client.get(f"/v1/problems/{kind['kind']}", headers={"If-None-Match": answer.headers["etag"]})
        assert (again.status_code, again.content) == (304, b"")
    assert len(listed.json()["problems"]) == len(KINDS)
    assert client.get("/openapi.json").json() == remove_keys(read_api_document())


def test_there_is_no_other_kind(client):
    answer = client.get("/v1/problems/perpetual_motion")
    assert answer.status_code == 404
    assert "gear_train" in answer.json()["detail"]
