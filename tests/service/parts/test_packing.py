"""Answers come packed, and not at all where the client has them; events and files come as they did."""

import gzip
import io
import zipfile

import pytest

from tests.support.service.running import PROBLEM
from tests.support.service.scripted_server import GATED

FOURBAR = {**PROBLEM, "positions": [*PROBLEM["positions"], {"x": 25.0, "y": 8.0, "angle": 55.0}]}


def bytes_of(client, path, **headers):
    with client.stream("GET", path, headers=headers) as answer:
        return answer, b"".join(answer.iter_raw())


@pytest.mark.slow
@pytest.mark.parametrize("path", ["/v1/problems", "/openapi.json"])
def test_what_is_the_same_for_all_is_packed_and_sent_once(client, path):
    answer, packed = bytes_of(client, path)
    plain, whole = bytes_of(client, path, **{"Accept-Encoding": "identity"})
    assert answer.headers["content-encoding"] == "gzip"
    assert gzip.decompress(packed) == whole
    assert len(packed) < len(whole) / 4
    assert int(plain.headers["content-length"]) == len(whole)
    for tag in (answer.headers["etag"], plain.headers["etag"]):
        again, nothing = bytes_of(client, path, **{"If-None-Match": tag})
        assert (again.status_code, nothing) == (304, b"")
    assert bytes_of(client, path, **{"If-None-Match": '"another"'})[0].status_code == 200
    head = client.head(path)
    assert (head.status_code, head.content, head.headers["etag"]) == (200, b"", answer.headers["etag"])


def test_a_job_is_packed_under_the_tag_that_it_has_unpacked(server):
    job = server.post(wait=60, problem=FOURBAR)
    path = f"/v1/jobs/{job['id']}"
    answer, packed = bytes_of(server.client, path)
    plain, whole = bytes_of(server.client, path, **{"Accept-Encoding": "identity"})
    assert (answer.headers["content-encoding"], gzip.decompress(packed)) == ("gzip", whole)
    assert answer.headers["vary"] == "Accept-Language, Accept-Encoding"
    assert answer.headers["etag"] == plain.headers["etag"]
    assert answer.headers["etag"].startswith("W/"), "it is not the same byte by byte"
    assert bytes_of(server.client, path, **{"If-None-Match": plain.headers["etag"]})[0].status_code == 304
    drawing, packed = bytes_of(server.client, f"{path}/designs/0.svg")
    assert drawing.headers["content-encoding"] == "gzip"
    assert gzip.decompress(packed).startswith(b"<")
    parts, zipped = bytes_of(server.client, f"{path}/designs/0/parts?process=laser")
    assert "content-encoding" not in parts.headers
    assert zipfile.ZipFile(io.BytesIO(zipped)).testzip() is None


def test_events_come_one_by_one_and_as_they_are(scripted):
    """The first ones are there while the job waits for what the test does then."""
    gate = scripted.folder / "open"
    gate.unlink(missing_ok=True)
    job = scripted.post(seed=GATED)
    try:
        with scripted.client.stream("GET", f"/v1/jobs/{job['id']}/events") as answer:
            assert "content-encoding" not in answer.headers
            came = answer.iter_raw()
            text = ""
            while "waiting" not in text:
                text += next(came).decode()
            assert scripted.job(job["id"])["status"] == "running"
            gate.touch()
            assert "succeeded" in b"".join(came).decode()
    finally:
        gate.touch()
