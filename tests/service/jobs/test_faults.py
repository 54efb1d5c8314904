"""What happens to jobs when things die, hang, or eat memory: real servers, real signals."""

import asyncio
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from service.jobs.events.notifier import ChangeNotifier
from service.jobs.workers.progress_writer import PERIOD_S
from tests.campaign import further
from tests.support.service import late_server
from tests.support.service.running import (
    PROBLEM,
    REACHED_S,
    SCRIPTED,
    SOON_S,
    RunningServer,
    alive,
    environment,
    store_away,
    stored,
    until,
    workers_of,
)
from tests.support.service.scripted_server import (
    BROKEN,
    CONVEX,
    DIES_ONCE,
    GATED,
    GREEDY,
    INSTANT,
    LAPACK,
    NATIVE,
    NUMBA,
    PYTHON,
    STEPS,
)

TIMEOUT_S = 8.0
LATE = (str(late_server.__file__),)


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    running = RunningServer(
        tmp_path_factory.mktemp("faults"), SCRIPTED, workers=1, job_timeout_s=TIMEOUT_S, job_memory_mb=200
    )
    yield running
    assert running.stop() == 0


@pytest.fixture(scope="module")
def patient(tmp_path_factory):
    running = RunningServer(tmp_path_factory.mktemp("patient"), SCRIPTED, workers=1)
    yield running
    assert running.stop() == 0


@pytest.fixture
def restarting(tmp_path):
    """Starts servers in one folder, so on one store; ends what is left of them."""
    started = []

    def start():
        started.append(RunningServer(tmp_path, SCRIPTED, workers=1))
        return started[-1]

    yield start
    for running in started:
        running.kill()


@pytest.mark.slow
@pytest.mark.campaign
def test_a_job_in_native_code_is_cancelled(server):
    job = server.post(NATIVE)
    server.reaches(job["id"], "running")
    (worker,) = server.workers()
    answer = server.client.delete(f"/v1/jobs/{job['id']}")
    assert answer.status_code == 202
    until(lambda: not alive(worker), SOON_S, "the end of the computation")
    cancelled = server.reaches(job["id"], "cancelled", SOON_S)
    assert cancelled["result"] is None
    assert cancelled["finished_at"] is not None
    assert server.post(INSTANT, wait=20)["status"] == "succeeded"
    assert server.job(job["id"]) == cancelled
    assert server.client.delete(f"/v1/jobs/{job['id']}").status_code == 204
    assert server.client.get(f"/v1/jobs/{job['id']}").status_code == 404


@pytest.mark.slow
@pytest.mark.parametrize(
    "seed",
    further([PYTHON, NUMBA, LAPACK, CONVEX], [PYTHON, CONVEX]),
    ids=["python", "numba", "lapack", "convex solver"],
)
def test_a_job_is_cancelled_whatever_it_computes(patient, seed):
    begun = patient.folder / "begun"
    begun.unlink(missing_ok=True)
    job = patient.post(seed)
    until(begun.exists, 60.0, "the computation")
    time.sleep(0.2)  # well inside of it
    assert patient.job(job["id"])["status"] == "running"
    (worker,) = patient.workers()
    assert patient.client.delete(f"/v1/jobs/{job['id']}").json()["status"] == "cancelled"
    until(lambda: not alive(worker), SOON_S, "the end of the computation")
    assert patient.post(INSTANT, wait=30)["status"] == "succeeded"


@pytest.mark.slow
def test_a_job_whose_worker_is_suspended_is_cancelled(server):
    job = server.post(NATIVE)
    server.reaches(job["id"], "running")
    (worker,) = server.workers()
    os.kill(worker, signal.SIGSTOP)
    assert server.client.delete(f"/v1/jobs/{job['id']}").json()["status"] == "cancelled"
    until(lambda: not alive(worker), SOON_S, "the end of the computation")


@pytest.mark.slow
def test_a_queued_job_is_cancelled_and_never_runs(server):
    gate = server.folder / "open"
    gate.unlink(missing_ok=True)
    first = server.post(GATED)
    server.reaches(first["id"], "running")
    second = server.post(INSTANT)
    assert second["status"] == "queued"
    assert server.client.delete(f"/v1/jobs/{second['id']}").json()["status"] == "cancelled"
    gate.touch()
    server.reaches(first["id"], "succeeded")
    assert server.post(INSTANT, wait=20)["status"] == "succeeded"
    assert server.job(second["id"])["status"] == "cancelled"
    assert server.job(second["id"])["started_at"] is None


@pytest.mark.slow
def test_a_job_whose_worker_dies_is_tried_again(server):
    job = server.post(DIES_ONCE, wait=20)
    assert job["status"] == "succeeded"
    assert stored(server.folder, job["id"], "crashes") == 1
    assert stored(server.folder, job["id"], "attempt") == 2


@pytest.mark.slow
def test_a_worker_that_dies_idle_harms_nobody(server):
    server.post(INSTANT, wait=20)
    (worker,) = server.workers()
    os.kill(worker, signal.SIGKILL)
    until(lambda: not alive(worker), SOON_S)
    server.reaches(server.post(INSTANT)["id"], "succeeded", 60.0)


@pytest.mark.slow
def test_a_job_that_takes_too_long_fails(server):
    job = server.post(NATIVE, wait=20)
    assert job["status"] == "failed"
    assert job["error"]["type"] == "/problems/timeout"
    assert job["error"]["instance"] == f"/v1/jobs/{job['id']}"
    assert server.post(INSTANT, wait=20)["status"] == "succeeded"


@pytest.mark.slow
def test_a_sample_that_takes_too_long_fails_by_itself(server):
    body = {"problem": PROBLEM, "vary": [{"field": "/seed", "values": [INSTANT, NATIVE, INSTANT]}], "reuse": False}
    place = server.client.post("/v1/batches", json=body).raise_for_status().headers["location"]
    assert server.post(INSTANT, wait=20)["status"] == "succeeded"
    ended = until(lambda: (now := server.client.get(place).json())["finished_at"] and now, REACHED_S, "the end")
    assert (ended["status"], ended["succeeded"], ended["failed"]) == ("succeeded", 2, 1)
    table = server.client.get(f"{place}/table.json").json()
    rows = [dict(zip(table["columns"], row, strict=True)) for row in table["rows"]]
    assert [row["status"] for row in rows] == ["succeeded", "failed", "succeeded"]
    error = server.job(rows[1]["job"])["error"]
    assert (error["type"], error["instance"]) == ("/problems/timeout", f"/v1/jobs/{rows[1]['job']}")


@pytest.mark.slow
def test_only_the_time_of_the_solver_counts_against_a_job(server):
    """The store is away for longer than a job may take, from before the solver ends."""
    gate = server.folder / "open"
    gate.unlink(missing_ok=True)
    job = server.post(GATED)
    until(lambda: server.job(job["id"])["progress"]["message"] == "waiting", SOON_S, "the solver at work")
    with store_away(server.folder):
        gate.touch()
        time.sleep(TIMEOUT_S + 2.0)  # the worker has its answer, and cannot store it
    ended = until(lambda: (now := server.job(job["id"]))["finished_at"] and now, REACHED_S, "the end")
    assert (ended["status"], ended["error"]) == ("succeeded", None)
    assert stored(server.folder, job["id"], "attempt") == 1


@pytest.mark.slow
def test_a_job_that_takes_too_much_memory_fails(server):
    job = server.post(GREEDY, wait=20)
    assert (job["status"], job["error"]["type"]) == ("failed", "/problems/out-of-memory")
    assert stored(server.folder, job["id"], "attempt") == 1
    assert server.post(INSTANT, wait=20)["status"] == "succeeded"


def test_a_defect_of_the_solver_fails_the_job_and_is_not_shown(scripted):
    job = scripted.post(BROKEN, wait=20)
    assert (job["status"], job["error"]["type"]) == ("failed", "/problems/internal-error")
    assert "secret" not in str(job)
    assert "secret" in scripted.log(), "the log is where the defect must be found"


@pytest.mark.slow
def test_a_lane_survives_what_nobody_foresaw(server):
    (server.folder / "lane-fault").touch()
    job = server.post(INSTANT, wait=20)
    assert (job["status"], job["error"]["type"]) == ("failed", "/problems/internal-error")
    assert "a defect of the lane" in server.log()
    assert server.post(INSTANT, wait=20)["status"] == "succeeded"


@pytest.mark.slow
def test_a_lane_survives_that_no_process_can_be_had(server):
    server.post(INSTANT, wait=20)
    (worker,) = server.workers()
    (server.folder / "no-process").touch()
    os.kill(worker, signal.SIGKILL)
    assert server.post(INSTANT, wait=20)["status"] == "succeeded"
    assert not (server.folder / "no-process").exists()


@pytest.mark.slow
def test_a_job_that_comes_while_an_idle_worker_dies_runs_in_the_next_one(server):
    (server.folder / "late-call").touch()
    job = server.post(INSTANT, wait=20)
    assert (job["status"], job["error"]) == ("succeeded", None)
    assert not (server.folder / "late-call").exists()


def test_a_change_for_a_closed_loop_is_dropped():
    loop = asyncio.new_event_loop()
    notifier = ChangeNotifier(loop)
    loop.close()
    notifier.publish("job")


@pytest.mark.slow
def test_progress_is_seen_while_the_job_runs(scripted):
    gate = scripted.folder / "open"
    gate.unlink(missing_ok=True)
    job = scripted.post(STEPS)
    until(lambda: scripted.job(job["id"])["progress"] == {"fraction": 0.25, "message": "a quarter"}, 5.0)
    began, writes = time.monotonic(), stored(scripted.folder, job["id"], "revision")
    time.sleep(1.0)  # a rate is measured over a time
    writes = stored(scripted.folder, job["id"], "revision") - writes
    assert writes <= 1 + (time.monotonic() - began) / PERIOD_S
    gate.touch()
    assert scripted.reaches(job["id"], "succeeded")["progress"]["fraction"] == 1.0


def test_the_last_report_before_a_long_time_is_told(scripted):
    """However soon it came after the start, or after another report."""
    gate = scripted.folder / "open"
    gate.unlink(missing_ok=True)
    job = scripted.post(GATED)
    until(lambda: scripted.job(job["id"])["progress"] == {"fraction": 0.1, "message": "waiting"}, SOON_S)
    gate.touch()
    scripted.reaches(job["id"], "succeeded")


def test_cancelling_at_any_moment_leaves_one_end(scripted):
    """Jobs that end by themselves while they are being cancelled: each ends once, as one or the other."""
    for pause in (0.0, 0.001, 0.002, 0.003, 0.005, 0.008):
        job = scripted.post(INSTANT)
        time.sleep(pause)  # the moment is what is varied
        answer = scripted.client.delete(f"/v1/jobs/{job['id']}")
        assert answer.status_code in (202, 204)
        if answer.status_code == 204:
            assert scripted.client.get(f"/v1/jobs/{job['id']}").status_code == 404
        else:
            assert answer.json()["status"] in ("cancelled", "succeeded")
            assert scripted.job(job["id"]) == answer.json()
    assert scripted.post(INSTANT, wait=20)["status"] == "succeeded"


@pytest.mark.slow
@pytest.mark.campaign
def test_a_killed_server_leaves_no_worker_and_loses_no_job(restarting, tmp_path):
    server = restarting()
    running, queued = server.post(GATED), server.post(INSTANT)
    server.reaches(running["id"], "running")
    (worker,) = server.workers()
    os.kill(worker, signal.SIGSTOP)  # not even a suspended worker may stay behind
    server.kill()
    until(lambda: not alive(worker), 2.0, "the end of the worker")
    assert stored(tmp_path, running["id"], "status") == "running"

    (tmp_path / "open").touch()
    server = restarting()
    assert server.reaches(running["id"], "succeeded")["id"] == running["id"]
    server.reaches(queued["id"], "succeeded")
    assert stored(tmp_path, running["id"], "attempt") == 2
    assert server.stop() == 0


@pytest.mark.slow
@pytest.mark.embedded
@pytest.mark.campaign
@pytest.mark.parametrize("begun", [True, False], ids=["in our lines", "before our lines"])
def test_a_server_that_is_killed_leaves_no_worker_that_was_starting(tmp_path, begun):
    (tmp_path / "slow-start").touch()
    program = SCRIPTED if begun else LATE
    with (
        (tmp_path / "log").open("wb") as log,
        subprocess.Popen(
            [sys.executable, *program, "serve"], env=environment(tmp_path, workers=1), stdout=log, stderr=log
        ) as server,
    ):
        (worker,) = until(lambda: workers_of(server.pid), 60.0, "the worker")
        if begun:
            time.sleep(2.0)  # it has come to the first of our own lines, and is held up in the next ones
        server.kill()
        server.wait(10)
        until(lambda: not alive(worker), SOON_S, "the end of the worker")


@pytest.mark.slow
@pytest.mark.campaign
def test_a_stopped_server_puts_its_running_job_back(restarting, tmp_path):
    server = restarting()
    job = server.post(NATIVE)
    server.reaches(job["id"], "running")
    (worker,) = server.workers()
    began = time.monotonic()
    assert server.stop() == 0
    assert time.monotonic() - began < SOON_S
    assert not alive(worker)
    assert stored(tmp_path, job["id"], "status") == "queued"
    assert stored(tmp_path, job["id"], "crashes") == 0


@pytest.mark.slow
@pytest.mark.campaign
def test_a_stopping_server_answers_those_who_wait(restarting):
    server = restarting()
    answers = []
    waiting = threading.Thread(target=lambda: answers.append(server.post(NATIVE, wait=30)))
    waiting.start()
    until(lambda: server.client.get("/v1/jobs?status=running").json()["jobs"])
    server.process.send_signal(signal.SIGINT)
    waiting.join(5.0)
    assert [job["status"] for job in answers] == ["running"]
    assert server.process.wait(5.0) == 0


@pytest.mark.slow
@pytest.mark.campaign
@pytest.mark.embedded
def test_a_service_whose_workers_cannot_start_is_not_ready(tmp_path):
    (tmp_path / "cannot-start").touch()
    with subprocess.Popen(
        [sys.executable, *SCRIPTED, "serve"],
        env=environment(tmp_path, port=0),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            for line in process.stderr:
                if "worker could not be started" in line:
                    break
            else:
                raise AssertionError("the server ended")
        finally:
            process.terminate()
            out, _ = process.communicate(timeout=10)
    assert "ready" not in out, "announced although no worker can start"
    assert process.returncode == 0
