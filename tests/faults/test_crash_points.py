"""The process dies right before or right after each write to the store, by name, many times over.

``MECHSYNTH_FAULT_RUNS`` says how often each (20).
"""

import contextlib
import os
import signal

import httpx
import pytest

from tests.support.service.running import PROBLEM, REACHED_S, SCRIPTED, SOON_S, RunningServer, until
from tests.support.service.scripted_server import BRIEF, BROKEN, DIES_ONCE, GATED, INSTANT, NATIVE, TOLD

RUNS = int(os.environ.get("MECHSYNTH_FAULT_RUNS", "20"))
WORKER_POINTS = {"record_progress": TOLD, "complete": BRIEF, "fail": BROKEN}
SERVER_POINTS = (
    "create", "create_once", "take", "cancel", "delete", "requeue", "requeue_unfinished", "record_crash", "give_up"
)  # fmt: skip

pytestmark = [pytest.mark.faults, pytest.mark.timeout(1500)]


class Folder:
    """A server in a folder, started again when it has died."""

    def __init__(self, path):
        self.path = path
        self.server = self.started()

    def started(self):
        return RunningServer(self.path, SCRIPTED, workers=1, job_timeout_s=3.0, log_level="error")

    def arm(self, moment, point):
        self.mark = self.path / f"crash-{moment}-{point}"
        self.mark.touch()

    def post(self, seed, key=None):
        """Post until it is acknowledged; a client does the same."""
        headers = {} if key is None else {"Idempotency-Key": key}
        while True:
            body = {"problem": {**PROBLEM, "seed": seed}}
            with contextlib.suppress(httpx.TransportError):
                return self.server.client.post("/v1/jobs", json=body, headers=headers).json()
            self.again()

    def again(self):
        """A server after one that has died."""
        self.server.client.close()
        assert self.server.process.wait(REACHED_S) == -signal.SIGKILL
        assert not self.mark.exists()
        self.server = self.started()

    def jobs(self):
        return self.server.client.get("/v1/jobs?limit=100").json()["jobs"]


@pytest.fixture
def folder(tmp_path):
    folder = Folder(tmp_path)
    yield folder
    folder.server.kill()


@pytest.mark.parametrize("moment", ["before", "after"])
@pytest.mark.parametrize("point", WORKER_POINTS)
def test_a_worker_dies_at(folder, point, moment):
    seed = WORKER_POINTS[point]
    for run in range(RUNS):
        folder.arm(moment, point)
        job = folder.post(seed + run if seed >= BRIEF else seed)
        ended = until(
            lambda job=job: (now := folder.server.job(job["id"]))["finished_at"] and now, REACHED_S, "the end"
        )
        until(lambda: not folder.mark.exists(), SOON_S, "its death there")  # what it has written is there before
        if seed == BROKEN:
            assert (ended["status"], ended["error"]["type"]) == ("failed", "/problems/internal-error")
        else:
            assert (ended["status"], ended["result"]["search"]["seed"]) == ("succeeded", seed + run)
    assert len(folder.jobs()) == min(RUNS, 100)
    print(f"\nworker died {moment} {point}: {RUNS} of {RUNS} jobs ended once and rightly")


@pytest.mark.parametrize("moment", ["before", "after"])
@pytest.mark.parametrize("point", SERVER_POINTS)
def test_a_server_dies_at(folder, point, moment):
    for run in range(RUNS):
        globals()[f"dies_at_{point}"](folder, moment, run)
    print(f"\nserver died {moment} {point}: {RUNS} of {RUNS} times nothing was lost")


def dies_at_create(folder, moment, run):
    before = len(folder.jobs())
    folder.arm(moment, "create")
    with contextlib.suppress(httpx.TransportError):
        folder.server.client.post("/v1/jobs", json={"problem": {**PROBLEM, "seed": BRIEF + run}})
        raise AssertionError("acknowledged although the server died")
    folder.again()
    jobs = folder.jobs()
    assert len(jobs) == before + (moment == "after")
    if moment == "after":  # never acknowledged, but stored: it runs
        assert folder.server.reaches(jobs[0]["id"], "succeeded")["result"]["search"]["seed"] == BRIEF + run


def dies_at_create_once(folder, moment, run):
    folder.arm(moment, "create_once")
    before = len(folder.jobs())
    job = folder.post(BRIEF + run, key=f"key-{run}")
    assert folder.server.reaches(job["id"], "succeeded")["result"]["search"]["seed"] == BRIEF + run
    assert len(folder.jobs()) == before + 1


def dies_at_take(folder, moment, run):
    """A lane claims the job, or is about to ask for one."""
    deadly = folder.server
    folder.arm(moment, "take")
    job = folder.post(BRIEF + run)
    until(lambda: not folder.mark.exists(), REACHED_S, "the death of the server")
    if folder.server is deadly:  # it died after it had acknowledged the job
        folder.again()
    ended = folder.server.reaches(job["id"], "succeeded")
    assert ended["result"]["search"]["seed"] == BRIEF + run
    assert folder.server.stored(job["id"], "crashes") == 0


def dies_at_cancel(folder, moment, run):
    gate = folder.path / "open"
    gate.unlink(missing_ok=True)
    job = folder.post(GATED)
    folder.server.reaches(job["id"], "running")
    folder.arm(moment, "cancel")
    with contextlib.suppress(httpx.TransportError):
        folder.server.client.delete(f"/v1/jobs/{job['id']}")
        raise AssertionError("acknowledged although the server died")
    folder.again()
    if moment == "before":
        folder.server.reaches(job["id"], "running")
        assert folder.server.client.delete(f"/v1/jobs/{job['id']}").status_code == 202
    assert folder.server.job(job["id"])["status"] == "cancelled"
    gate.touch()
    folder.server.reaches(folder.post(INSTANT)["id"], "succeeded")


def dies_at_delete(folder, moment, run):
    job = folder.post(INSTANT)
    folder.server.reaches(job["id"], "succeeded")
    folder.arm(moment, "delete")
    with contextlib.suppress(httpx.TransportError):
        folder.server.client.delete(f"/v1/jobs/{job['id']}")
        raise AssertionError("acknowledged although the server died")
    folder.again()
    there = folder.server.client.get(f"/v1/jobs/{job['id']}").status_code
    assert there == (200 if moment == "before" else 404)


def dies_at_requeue(folder, moment, run):
    gate = folder.path / "open"
    gate.unlink(missing_ok=True)
    job = folder.post(GATED)
    folder.server.reaches(job["id"], "running")
    folder.arm(moment, "requeue")
    folder.server.process.send_signal(signal.SIGTERM)
    folder.again()
    gate.touch()
    folder.server.reaches(job["id"], "succeeded")


def dies_at_requeue_unfinished(folder, moment, run):
    gate = folder.path / "open"
    gate.unlink(missing_ok=True)
    running, queued = folder.post(GATED), folder.post(BRIEF + run)
    folder.server.reaches(running["id"], "running")
    folder.server.kill()
    folder.arm(moment, "requeue_unfinished")
    with contextlib.suppress(AssertionError):  # it dies while it starts
        folder.started()
        raise RuntimeError("the server has not died")
    gate.touch()
    folder.server = folder.started()
    for job in (running, queued):
        folder.server.reaches(job["id"], "succeeded")


def dies_at_record_crash(folder, moment, run):
    (folder.path / "died").unlink(missing_ok=True)
    folder.arm(moment, "record_crash")
    job = folder.post(DIES_ONCE)
    until(lambda: folder.server.process.poll() is not None, REACHED_S, "the death of the server")
    folder.again()
    folder.server.reaches(job["id"], "succeeded")


def dies_at_give_up(folder, moment, run):
    folder.arm(moment, "give_up")
    job = folder.post(NATIVE)
    until(lambda: folder.server.process.poll() is not None, REACHED_S, "the death of the server")
    folder.again()
    failed = folder.server.reaches(job["id"], "failed")
    assert failed["error"]["type"] == "/problems/timeout"
