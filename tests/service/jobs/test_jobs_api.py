"""The jobs of the HTTP contract, against the real service and the real solver."""

import re
import time
from datetime import datetime

import pytest

from service.api.http.schemas import Job, JobList
from tests.support.service.running import PROBLEM
from tests.support.service.scripted_server import GATED

# Everything is chosen, so that there is one design and nothing to search.
SOLVED = {
    **PROBLEM,
    "input_side": {"fixed_pivot": [0.0, -20.0], "rotations": [60.0]},
    "output_side": {"fixed_pivot": [20.0, -20.0], "rotations": [50.0]},
}
SUMMARY_KEYS = ["id", "kind", "label", "status", "created_at", "started_at", "finished_at", "progress"]
KEYS = [*SUMMARY_KEYS, "problem", "result", "error"]


@pytest.fixture(scope="session")
def solved(server):
    job = server.post(problem=SOLVED, wait=30, label="Müller's ⚙")
    assert job["status"] == "succeeded", job
    return job


@pytest.mark.slow
def test_a_job_is_accepted_and_found_again(server, client):
    answer = client.post("/v1/jobs", json={"problem": PROBLEM})
    assert answer.status_code == 202
    job = answer.json()
    assert list(job) == KEYS
    assert answer.headers["location"] == f"/v1/jobs/{job['id']}"
    assert int(answer.headers["retry-after"]) >= 1
    assert "preference-applied" not in answer.headers
    assert (job["label"], job["result"], job["error"], job["finished_at"]) == (None, None, None, None)
    finished = server.reaches(job["id"], "succeeded", 60)
    assert finished["id"] == job["id"]


@pytest.mark.slow
def test_waiting_gives_the_finished_job(client):
    answer = client.post("/v1/jobs", json={"problem": SOLVED}, headers={"Prefer": "wait=30"})
    assert answer.status_code == 200
    assert answer.headers["preference-applied"] == "wait"
    assert answer.headers["location"] == f"/v1/jobs/{answer.json()['id']}"
    assert answer.json()["status"] == "succeeded"


@pytest.mark.slow
def test_a_wait_ends_with_the_job(server):
    began = time.perf_counter()
    for _ in range(10):
        assert server.post(problem=SOLVED, wait=30)["status"] == "succeeded"
    assert time.perf_counter() - began < 5.0, "answered when the time was up, not when the job was done"


def test_the_finished_job_is_what_the_schema_says(client, solved):
    job = client.get(f"/v1/jobs/{solved['id']}").json()
    assert job == solved
    assert list(job) == KEYS
    Job.model_validate(job)
    assert job["label"] == "Müller's ⚙"
    assert job["progress"] == {"fraction": 1.0, "message": "succeeded"}
    assert job["problem"]["length_unit"] == "mm", "defaults are filled in"
    assert len(job["result"]["designs"]) == 1
    assert all(design["verification"]["passed"] for design in job["result"]["designs"])
    times = [job[key] for key in ("created_at", "started_at", "finished_at")]
    assert all(re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{6}Z", moment) for moment in times)
    assert times == sorted(times)
    assert datetime.fromisoformat(times[0]).tzinfo is not None


def test_the_same_problem_has_the_same_answer(server, solved):
    assert server.post(problem=SOLVED, wait=30)["result"] == solved["result"]


@pytest.mark.parametrize(
    "prefer",
    [
        "respond-async, wait=20",
        'wait="20"',
        "WAIT = 20; foo=bar",
        'x="a,wait=1", wait=20',
        "handling=lenient,wait=20,wait=0",
    ],
)
def test_a_wait_is_found_among_other_preferences(client, prefer):
    answer = client.post("/v1/jobs", json={"problem": SOLVED}, headers={"Prefer": prefer})
    assert answer.status_code == 200


def test_a_wait_is_found_in_a_second_header(client):
    headers = [("Prefer", "return=representation"), ("Prefer", "wait=20")]
    assert client.post("/v1/jobs", json={"problem": SOLVED}, headers=headers).status_code == 200


@pytest.mark.parametrize(
    "prefer",
    [b"", b"wait", b"wait=", b"wait=-1", b"wait=0", b"wait=soon", b"wait=1.5", b"wait=1e3", b'wait="', b"xwait=20",
     b"wait=" + b"9" * 900, b"\xff\xfe", b";;;===,,,", b'"' * 500],
)  # fmt: skip
def test_a_garbled_preference_is_passed_over(client, prefer):
    answer = client.post("/v1/jobs", json={"problem": SOLVED}, headers={"Prefer": prefer})
    assert answer.status_code == 202


def test_a_finished_job_is_removed(server, client):
    job = server.post(problem=SOLVED, wait=30)
    answer = client.delete(f"/v1/jobs/{job['id']}")
    assert (answer.status_code, answer.content) == (204, b"")
    assert client.get(f"/v1/jobs/{job['id']}").status_code == 404
    assert client.delete(f"/v1/jobs/{job['id']}").status_code == 404


@pytest.mark.parametrize(
    "job_id",
    ["x", "01ARZ3NDEKTSV4RRFFQ69G5FAV", "01arz3ndektsv4rrffq69g5fav", "8" * 26, "%00", "..%2f..", "%ff%fe", "a" * 5000],
)
@pytest.mark.parametrize(
    ("method", "suffix"), [("GET", ""), ("DELETE", ""), ("GET", "/designs/0.svg"), ("GET", "/designs/0/motion")]
)
def test_an_id_of_no_job(client, method, job_id, suffix):
    answer = client.request(method, f"/v1/jobs/{job_id}{suffix}")
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.slow
def test_a_design_is_drawn(client, solved):
    answer = client.get(f"/v1/jobs/{solved['id']}/designs/0.svg")
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("image/svg+xml")
    assert answer.headers["content-security-policy"].startswith("default-src 'none';")
    assert answer.headers["content-security-policy"].endswith("; sandbox")
    for form in ("svg", "csv", "dxf", "gif"):
        file = client.get(f"/v1/jobs/{solved['id']}/designs/0.{form}")
        assert (file.status_code, file.headers["x-content-type-options"]) == (200, "nosniff")
    assert "<svg" in answer.text
    assert "Müller" in answer.text


@pytest.mark.parametrize("number", ["1", "99", "-1", "x", "0x0", "", "1e0", "%30%00", "9" * 4000, "٣", " 0"])
@pytest.mark.parametrize("suffix", [".svg", "/motion"])
def test_a_design_that_is_not_there(client, solved, number, suffix):
    answer = client.get(f"/v1/jobs/{solved['id']}/designs/{number}{suffix}")
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.slow
@pytest.mark.parametrize("what", ["0.svg", "0/motion"])
def test_a_design_of_an_unfinished_job(scripted, what):
    (scripted.folder / "open").unlink(missing_ok=True)
    job = scripted.post(GATED)
    path = f"/v1/jobs/{job['id']}"
    scripted.reaches(job["id"], "running")
    answer = scripted.client.get(f"{path}/designs/{what}")
    assert (answer.status_code, answer.json()["type"]) == (409, "/problems/no-result")
    assert scripted.client.delete(path).json()["status"] == "cancelled"
    after = scripted.client.get(f"{path}/designs/{what}")
    assert (after.status_code, after.json()["detail"]) == (409, "The job is cancelled and has no result.")


@pytest.mark.slow
def test_a_job_that_has_not_changed_is_not_sent_again(scripted):
    (scripted.folder / "open").unlink(missing_ok=True)
    job = scripted.post(GATED)
    path = f"/v1/jobs/{job['id']}"
    scripted.reaches(job["id"], "running")
    first = scripted.client.get(path)
    tag = first.headers["etag"]
    for known in (tag, f"W/{tag}", f'"x", {tag}', "*"):
        again = scripted.client.get(path, headers={"If-None-Match": known})
        assert (again.status_code, again.content, again.headers["etag"]) == (304, b"", tag)
    (scripted.folder / "open").touch()
    scripted.reaches(job["id"], "succeeded")
    after = scripted.client.get(path, headers={"If-None-Match": tag})
    assert after.status_code == 200
    assert after.headers["etag"] != tag


@pytest.mark.parametrize("known", [b"", b"1", b'"', b'"999"', b'W/"', b"\xff", b'"' * 500])
def test_a_tag_of_another_state_or_none_gives_the_job(client, solved, known):
    answer = client.get(f"/v1/jobs/{solved['id']}", headers={"If-None-Match": known})
    assert answer.status_code == 200


@pytest.mark.slow
def test_jobs_are_listed_page_by_page(server, client):
    ids = [server.post(problem=SOLVED, wait=30, label=f"page {n}")["id"] for n in range(5)]
    seen, cursor = [], None
    while True:
        query = {"limit": 2} | ({"cursor": cursor} if cursor else {})
        page = client.get("/v1/jobs", params=query).json()
        JobList.model_validate(page)
        assert len(page["jobs"]) <= 2
        seen += [job["id"] for job in page["jobs"]]
        cursor = page["next_cursor"]
        if cursor is None:
            break
    assert seen[:5] == ids[::-1]
    assert seen == sorted(set(seen), reverse=True)
    item = client.get("/v1/jobs?limit=1").json()["jobs"][0]
    assert list(item) == SUMMARY_KEYS


def test_a_list_is_filtered(client, solved):
    for query, there in (
        ("status=succeeded", True),
        ("status=failed", False),
        ("kind=motion", True),
    ):
        jobs = client.get(f"/v1/jobs?{query}&limit=100").json()["jobs"]
        assert (solved["id"] in [job["id"] for job in jobs]) == there


@pytest.mark.parametrize(
    ("query", "path"),
    [
        ("limit=0", "/query/limit"),
        ("limit=101", "/query/limit"),
        ("limit=x", "/query/limit"),
        ("limit=", "/query/limit"),
        ("limit=" + "9" * 5000, "/query/limit"),
        ("status=sleeping", "/query/status"),
        ("status=%00", "/query/status"),
        ("kind=perpetuum_mobile", "/query/kind"),
        ("kind=", "/query/kind"),
        ("kind=x%00", "/query/kind"),
        ("cursor=x", "/query/cursor"),
        ("cursor=%ff", "/query/cursor"),
        ("cursor=" + "A" * 36, "/query/cursor"),
        ("cursor=" + "A" * 101, "/query/cursor"),
        ("stauts=queued", "/query/stauts"),
    ],
)
def test_a_bad_parameter_is_named(client, query, path):
    answer = client.get(f"/v1/jobs?{query}")
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == [path]
