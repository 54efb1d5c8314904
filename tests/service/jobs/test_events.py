"""A job as server-sent events: what a listener sees, whenever it comes, and that the store is asked once for all."""

import asyncio
import json
import threading
import time
from dataclasses import dataclass

import httpx
import pytest
from starlette.requests import Request

from service.api.http.problem_details import Refusal
from service.api.http.schemas import describe_job
from service.api.routes import events
from service.jobs.events.notifier import ChangeNotifier
from service.jobs.events.poller import PERIOD_S, JobPoller
from service.jobs.job_store import JobStore
from service.jobs.store.database import connect, upgrade
from service.jobs.store.states import Cost
from tests.support.service.running import SCRIPTED, SOON_S, RunningServer, until
from tests.support.service.scripted_server import GATED, INSTANT, NATIVE, STEPS

NOWHERE = "01K6WM2B7Q3W9Z0V5N8XJ4R1TD"


@dataclass(frozen=True)
class Event:
    name: str
    data: dict
    id: str | None

    @property
    def final(self):
        return self.name == "state" and self.data["status"] in ("succeeded", "failed", "cancelled")


def parsed(block):
    """An event as the HTML standard reads it, or None for a comment."""
    fields = {}
    for line in block.split("\n"):
        name, _, value = line.partition(":")
        if name:
            fields[name] = fields[name] + "\n" + value[1:] if name in fields else value.removeprefix(" ")
    return Event(fields["event"], json.loads(fields["data"]), fields.get("id")) if "data" in fields else None


def events_of(text):
    return [event for block in text.split("\n\n") if (event := parsed(block))]


@pytest.fixture
def gate(scripted):
    gate = scripted.folder / "open"
    gate.unlink(missing_ok=True)
    yield gate
    gate.touch()


def listen(server, job_id, last=None, **keys):
    headers = {} if last is None else {"Last-Event-ID": last}
    return server.client.get(f"/v1/jobs/{job_id}/events", headers=headers, **keys)


def states(seen):
    return [event.data["status"] for event in seen if event.name == "state"]


def test_a_listener_sees_the_states_and_the_progress(scripted, gate):
    job = scripted.post(STEPS)
    seen = []
    with scripted.client.stream("GET", f"/v1/jobs/{job['id']}/events") as stream:
        assert stream.headers["content-type"].startswith("text/event-stream")
        assert stream.headers["cache-control"] == "no-store"
        text = ""
        for chunk in stream.iter_text():
            text += chunk
            if "event: progress" in text:  # the worker goes on to say the same
                gate.touch()
        seen = events_of(text)
    assert states(seen)[-2:] == ["running", "succeeded"]
    assert [event.final for event in seen] == [False] * (len(seen) - 1) + [True]
    assert {"fraction": 0.25, "message": "a quarter"} in [event.data for event in seen if event.name == "progress"]
    revisions = [int(event.id.partition("-")[0]) for event in seen]
    assert revisions == sorted(set(revisions))
    listed = {key: value for key, value in scripted.job(job["id"]).items() if key not in ("problem", "result", "error")}
    assert seen[-1].data == listed


def test_a_finished_job_has_its_final_state_only(scripted, gate):
    job = scripted.post(INSTANT, wait=20)
    seen = events_of(listen(scripted, job["id"]).text)
    assert states(seen) == ["succeeded"]
    assert len(seen) == 1


def test_a_stream_is_resumed_where_it_broke(scripted, gate):
    job = scripted.post(GATED)
    scripted.reaches(job["id"], "running")
    with scripted.client.stream("GET", f"/v1/jobs/{job['id']}/events") as stream:
        first = next(event for text in stream.iter_text() for event in events_of(text))
    assert first.data["status"] == "running"
    resumed = []
    with scripted.client.stream("GET", f"/v1/jobs/{job['id']}/events", headers={"Last-Event-ID": first.id}) as stream:
        gate.touch()
        resumed = events_of(stream.read().decode())
    assert states(resumed) == ["succeeded"]
    last = resumed[-1].id
    answer = listen(scripted, job["id"], last)
    assert (answer.status_code, answer.content) == (204, b"")
    # An id of a state that the job was in before, and what is no id at all.
    assert states(events_of(listen(scripted, job["id"], first.id).text)) == ["succeeded"]
    for foreign in ("", "7", "x" * 5000, "1-perfect", "-1-running", last + "0"):
        assert states(events_of(listen(scripted, job["id"], foreign).text)) == ["succeeded"]


def test_a_cancelled_job_ends_its_stream(scripted, gate):
    job = scripted.post(NATIVE)
    scripted.reaches(job["id"], "running")
    with scripted.client.stream("GET", f"/v1/jobs/{job['id']}/events") as stream:
        assert httpx.delete(f"{scripted.url}/v1/jobs/{job['id']}").status_code == 202
        seen = events_of(stream.read().decode())
    assert states(seen)[-1] == "cancelled"
    assert sum(event.final for event in seen) == 1


@pytest.mark.parametrize("job_id", [NOWHERE, "nope", "%00"])
def test_there_are_no_events_of_no_job(scripted, job_id):
    answer = listen(scripted, job_id)
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"


def test_head_does_not_wait_for_the_end(scripted, gate):
    job = scripted.post(GATED)
    began = time.monotonic()
    answer = scripted.client.head(f"/v1/jobs/{job['id']}/events")
    assert time.monotonic() - began < 5.0
    assert (answer.status_code, answer.content) == (200, b"")
    assert answer.headers["content-type"].startswith("text/event-stream")


@pytest.mark.slow
@pytest.mark.campaign
def test_two_hundred_listeners_see_one_end_each(scripted, gate):
    job = scripted.post(STEPS)
    listeners = 200

    async def one(client, connected):
        text = ""
        async with client.stream("GET", f"/v1/jobs/{job['id']}/events") as stream:
            async for chunk in stream.aiter_text():
                if not text:
                    connected.append(1)
                    if len(connected) == listeners:
                        gate.touch()
                text += chunk
        return events_of(text)

    async def all_of_them():
        limits = httpx.Limits(max_connections=listeners)
        async with httpx.AsyncClient(base_url=scripted.url, timeout=30.0, limits=limits) as client:
            connected = []
            return await asyncio.gather(*(one(client, connected) for _ in range(listeners)))

    seen = asyncio.run(all_of_them())
    assert [sum(event.final for event in of_one) for of_one in seen] == [1] * listeners
    assert all(of_one[-1].final for of_one in seen)


@pytest.mark.slow
def test_listeners_that_leave_are_no_defect(scripted, gate):
    job = scripted.post(GATED)
    before = scripted.log().count("Traceback")
    for _ in range(20):
        with scripted.client.stream("GET", f"/v1/jobs/{job['id']}/events") as stream:
            next(stream.iter_text())
    gate.touch()
    scripted.reaches(job["id"], "succeeded")
    assert scripted.log().count("Traceback") == before


@pytest.mark.slow
@pytest.mark.campaign
def test_a_stopping_server_ends_the_streams_and_the_next_one_resumes_them(tmp_path):
    server = RunningServer(tmp_path, SCRIPTED, workers=1)
    job = server.post(GATED)
    server.reaches(job["id"], "running")
    texts = []

    def follow():
        with httpx.stream("GET", f"{server.url}/v1/jobs/{job['id']}/events", timeout=20.0) as stream:
            for text in stream.iter_text():
                texts.append(text)

    thread = threading.Thread(target=follow)
    thread.start()
    until(lambda: texts)
    began = time.monotonic()
    assert server.stop() == 0
    thread.join(SOON_S)
    assert time.monotonic() - began < SOON_S
    seen = events_of("".join(texts))
    assert not any(event.final for event in seen)

    (tmp_path / "open").touch()
    server = RunningServer(tmp_path, SCRIPTED, workers=1)
    try:
        resumed = events_of(listen(server, job["id"], seen[-1].id).text)
    finally:
        assert server.stop() == 0
    assert sum(event.final for event in resumed) == 1
    assert states(resumed)[-1] == "succeeded"


class CountingStore(JobStore):
    reads = 0

    def load_summaries(self, job_ids):
        self.reads += 1
        return super().load_summaries(job_ids)


@pytest.fixture
def store(tmp_path):
    engine = connect(f"sqlite:///{tmp_path / 'jobs.sqlite3'}", durable=False)
    upgrade(engine)
    yield CountingStore(engine)
    engine.dispose()


def with_poller(store, listen):
    """Run a coroutine function beside a poller of the store; nothing may be left that listens."""

    async def run():
        notifier = ChangeNotifier(asyncio.get_running_loop())
        poller = JobPoller(store, notifier)
        reading = asyncio.create_task(poller.run())
        try:
            async with asyncio.timeout(20):
                return await listen(poller)
        finally:
            notifier.close()
            await asyncio.wait_for(reading, 5.0)
            assert poller.listeners == 0

    return asyncio.run(run())


async def stream(poller, job, seen=None):
    return events_of(
        b"".join([text async for text in events._generate_events(poller, job, seen, describe_job)]).decode()
    )


def new_job(store):
    return store.create(tenant="", kind="motion", label=None, problem="{}")


async def begun(poller, job):
    """A stream of the job that has become a listener."""
    following = asyncio.create_task(stream(poller, job))
    while not poller.listeners:
        await asyncio.sleep(0)  # the task takes its turn
    return following


@pytest.mark.slow
def test_the_store_is_read_once_for_all_listeners(store):
    job = new_job(store)

    async def listen(poller):
        streams = [asyncio.create_task(stream(poller, job)) for _ in range(300)]
        began = time.monotonic()
        await asyncio.sleep(1.0)  # the reads of a time are counted
        reads, most = store.reads, 2 + (time.monotonic() - began) / PERIOD_S
        claim = store.take("claim", [Cost.LONG])
        store.complete(job.id, claim.attempt, "{}")
        return reads, most, await asyncio.gather(*streams)

    reads, most, seen = with_poller(store, listen)
    assert 1 <= reads <= most
    assert {tuple(states(of_one)) for of_one in seen} == {("queued", "succeeded")}


def test_the_listeners_of_a_tenant_leave_room_for_others(store, monkeypatch):
    monkeypatch.setattr(events, "MAX_LISTENERS", 3)
    jobs = {
        tenant: store.create(tenant=tenant, kind="motion", label=None, problem="{}") for tenant in ("flood", "other")
    }
    request = Request({"type": "http", "method": "GET", "headers": []})

    async def listen(poller):
        following = [asyncio.create_task(stream(poller, jobs["flood"])) for _ in range(3)]
        while poller.listeners < 3:
            await asyncio.sleep(0)  # the tasks take their turns
        with pytest.raises(Refusal) as refused:
            await events.follow_job(request, poller, "flood", jobs["flood"].id)
        heard = await events.follow_job(request, poller, "other", jobs["other"].id)
        store.cancel(jobs["flood"].id)
        await asyncio.gather(*following)
        assert (await events.follow_job(request, poller, "flood", jobs["flood"].id)).status_code == 200
        return refused.value, heard

    refused, heard = with_poller(store, listen)
    assert (refused.status, heard.status_code) == (503, 200)


@pytest.mark.slow
def test_the_store_is_not_read_for_nobody(store):
    job = new_job(store)
    store.cancel(job.id)

    async def listen(poller):
        await asyncio.sleep(0.6)  # more than two periods
        assert store.reads == 0
        await stream(poller, store.get(job.id))
        await asyncio.sleep(0.6)  # and again
        return store.reads

    assert with_poller(store, listen) <= 1


def test_a_job_that_is_removed_before_its_end_was_seen(store):
    job = new_job(store)

    async def listen(poller):
        following = await begun(poller, job)
        store.cancel(job.id)
        store.delete(job.id)
        return await following

    seen = with_poller(store, listen)
    assert [(event.name, event.data.get("status")) for event in seen] in (
        [("state", "queued"), ("removed", None)],
        [("state", "queued"), ("state", "cancelled")],  # read in between
    )


def test_silence_is_broken_by_comments(store, monkeypatch):
    monkeypatch.setattr(events, "KEEP_ALIVE_S", 0.05)
    job = new_job(store)

    async def listen(poller):
        chunks = []
        async for chunk in events._generate_events(poller, job, None, describe_job):
            chunks.append(chunk)
            if len(chunks) == 3:
                store.cancel(job.id)
        return chunks

    chunks = with_poller(store, listen)
    assert chunks[1:3] == [b": keep-alive\n\n"] * 2
    assert events_of(chunks[-1].decode())[0].final


@pytest.mark.slow
def test_listeners_wait_while_the_store_does_not_answer(store):
    job = new_job(store)
    summaries = store.load_summaries

    def out_of_reach(job_ids):
        store.load_summaries = summaries
        raise OSError("no store")

    async def listen(poller):
        store.load_summaries = out_of_reach
        following = await begun(poller, job)
        store.cancel(job.id)
        return await following

    assert states(with_poller(store, listen))[-1] == "cancelled"
