"""A request that is sent again by its key is done once."""

from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest

from tests.support.service.running import PROBLEM
from tests.support.service.scripted_server import GATED, INSTANT


def post(server, key, seed=INSTANT, wait=None, client=None, **fields):
    headers = [("Idempotency-Key", key)] + ([("Prefer", f"wait={wait}")] if wait else [])
    body = {"problem": {**PROBLEM, "seed": seed}, **fields}
    return (client or server.client).post("/v1/jobs", json=body, headers=headers)


def count(server):
    return len(server.client.get("/v1/jobs?limit=100").json()["jobs"])


def test_the_same_request_has_one_job(scripted):
    before = count(scripted)
    first = post(scripted, "same", wait=20)
    again = post(scripted, "same")
    assert (first.status_code, again.status_code) == (200, 200)
    assert again.json() == first.json()
    assert again.headers["location"] == first.headers["location"]
    assert "preference-applied" not in again.headers
    assert count(scripted) == before + 1


def test_the_same_request_is_known_by_its_meaning(scripted):
    first = post(scripted, "meaning", wait=20).json()
    body = {"label": None, "problem": {"seed": INSTANT, "max_designs": 10, **dict(reversed(PROBLEM.items()))}}
    body["problem"]["positions"] = [{name: int(v) for name, v in p.items()} for p in PROBLEM["positions"]]
    again = scripted.client.post("/v1/jobs", json=body, headers={"Idempotency-Key": "meaning"})
    assert again.json()["id"] == first["id"]


def test_a_retry_waits_for_the_job_under_way(scripted):
    gate = scripted.folder / "open"
    gate.unlink(missing_ok=True)
    first = post(scripted, "waiting", GATED)
    again = post(scripted, "waiting", GATED)
    assert (first.status_code, again.status_code) == (202, 202)
    assert again.json()["id"] == first.json()["id"]
    with ThreadPoolExecutor(1) as pool:
        waiting = pool.submit(post, scripted, "waiting", GATED, wait=20)
        gate.touch()
        answer = waiting.result(20)
    assert (answer.status_code, answer.json()["status"]) == (200, "succeeded")
    assert answer.json()["id"] == first.json()["id"]


@pytest.mark.parametrize("other", [{"seed": GATED}, {"label": "another"}])
def test_another_request_is_refused(scripted, other):
    key = f"other-{next(iter(other))}"
    first = post(scripted, key, wait=20)
    before = count(scripted)
    answer = post(scripted, key, **other)
    assert (answer.status_code, answer.json()["type"]) == (409, "/problems/idempotency-key-reused")
    assert count(scripted) == before
    assert post(scripted, key).json() == first.json()


def test_a_removed_job_frees_its_key(scripted):
    first = post(scripted, "freed", wait=20).json()
    assert scripted.client.delete(f"/v1/jobs/{first['id']}").status_code == 204
    second = post(scripted, "freed", wait=20, label="another")
    assert second.status_code == 200
    assert second.json()["id"] != first["id"]


@pytest.mark.parametrize("same", [True, False])
def test_of_many_posts_at_once_one_wins(scripted, same):
    before = count(scripted)
    with ThreadPoolExecutor(8) as pool:
        clients = [httpx.Client(base_url=scripted.url, timeout=30.0) for _ in range(8)]
        labels = [None if same else f"{n}" for n in range(8)]
        sent = [
            pool.submit(post, scripted, f"race-{same}", client=client, label=label)
            for client, label in zip(clients, labels, strict=True)
        ]
        answers = [future.result(30) for future in sent]
        for client in clients:
            client.close()
    assert count(scripted) == before + 1
    accepted = [answer for answer in answers if answer.status_code in (200, 202)]
    assert len({answer.json()["id"] for answer in accepted}) == 1
    assert len(accepted) == (8 if same else 1)
    assert all(answer.status_code == 409 for answer in answers if answer not in accepted)


@pytest.mark.parametrize("key", [b"", b"a b", b"x" * 201, b"\xe9", b"a\tb"])
def test_a_key_that_cannot_be(scripted, key):
    answer = post(scripted, key)
    assert answer.status_code == 422
    assert [error["path"] for error in answer.json()["errors"]] == ["/header/idempotency-key"]


def test_two_keys(scripted):
    headers = [("Idempotency-Key", "a"), ("Idempotency-Key", "b")]
    answer = scripted.client.post("/v1/jobs", json={"problem": PROBLEM}, headers=headers)
    assert [error["path"] for error in answer.json()["errors"]] == ["/header/idempotency-key"]


def test_the_longest_key(scripted):
    assert post(scripted, "~" * 200, wait=20).status_code == 200
