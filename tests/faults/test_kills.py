"""Jobs while processes are killed at random: every accepted job ends, once, rightly; nothing is left behind.

``MECHSYNTH_FAULT_KILLS`` and ``MECHSYNTH_FAULT_JOBS`` say how many (100 and 300).
"""

import contextlib
import os
import random
import signal
import subprocess
import sys
import threading
import time

import httpx
import pytest

from tests.support.service.running import PROBLEM, SCRIPTED, RunningServer, alive, until
from tests.support.service.scripted_server import BRIEF, INSTANT

KILLS = int(os.environ.get("MECHSYNTH_FAULT_KILLS", "100"))
JOBS = int(os.environ.get("MECHSYNTH_FAULT_JOBS", "300"))
CLIENTS = 4
ORPHAN_S = 5.0


class Killer(threading.Thread):
    """Kills workers and servers by SIGKILL, and starts a server again when it was that one."""

    def __init__(self, server, start, seed):
        super().__init__(daemon=True)
        self.server, self._start, self._rng = server, start, random.Random(seed)
        self.worker_kills = self.server_kills = 0
        self.longest_orphan_s = 0.0
        self.failure = None

    def run(self):
        try:
            while self.worker_kills + self.server_kills < KILLS:
                time.sleep(self._rng.uniform(0.0, 0.4))  # the moment is what is varied
                if self._rng.random() < 0.3:
                    self._kill_the_server()
                else:
                    self._kill_a_worker()
        except BaseException as error:
            self.failure = error
            raise

    def _kill_a_worker(self):
        workers = self.server.workers()
        if workers:
            with contextlib.suppress(ProcessLookupError):  # it has ended meanwhile
                os.kill(self._rng.choice(workers), signal.SIGKILL)
                self.worker_kills += 1

    def _kill_the_server(self):
        workers = self.server.workers()
        self.server.kill()
        died = time.monotonic()
        until(lambda: not any(map(alive, workers)), 60.0, "the end of the orphans")
        self.longest_orphan_s = max(self.longest_orphan_s, time.monotonic() - died)
        self.server_kills += 1
        self.server = self._start()


@pytest.mark.faults
@pytest.mark.timeout(1500)
@pytest.mark.parametrize("busy", [False, True], ids=["idle machine", "all cores busy"])
def test_no_job_is_lost_or_doubled_or_wrong(tmp_path, busy):
    first = RunningServer(tmp_path, SCRIPTED, workers=2, log_level="warning")
    url, port = first.url, first.url.rpartition(":")[2]

    def start():
        return RunningServer(tmp_path, SCRIPTED, workers=2, port=port, log_level="warning")

    killer = Killer(first, start, seed=int(busy))
    accepted = {}
    numbers = iter(range(JOBS))
    lock = threading.Lock()

    def submit():
        with httpx.Client(base_url=url, timeout=30.0) as client:
            while True:
                with lock:
                    n = next(numbers, None)
                # Jobs go on for as long as there are kills to come, so that all of those fall among jobs.
                if n is None:
                    if not killer.is_alive():
                        return
                    with lock:
                        n = len(accepted) + 1_000_000 + random.getrandbits(40)
                body = {"problem": {**PROBLEM, "seed": BRIEF + n % 9_000}, "label": f"job {n}"}
                while n is not None:
                    assert killer.failure is None
                    try:
                        answer = client.post("/v1/jobs", json=body, headers={"Idempotency-Key": f"key-{n}"})
                    except httpx.TransportError:
                        time.sleep(0.05)  # the server is being started again
                        continue
                    assert answer.status_code in (200, 202, 503), answer.text
                    if answer.status_code != 503:
                        accepted[answer.json()["id"]] = body
                        n = None

    began = time.monotonic()
    burning = [sys.executable, "-c", "while True: pass"]
    burners = [subprocess.Popen(burning) for _ in range(os.cpu_count() or 1)] if busy else []
    threads = [threading.Thread(target=submit) for _ in range(CLIENTS)]
    try:
        killer.start()
        for thread in threads:
            thread.start()
        for thread in (*threads, killer):
            thread.join()
        assert killer.failure is None
        server = killer.server
        until(lambda: not listed(server, "queued") and not listed(server, "running"), 300.0, "the end of all jobs")
        assert server.post(INSTANT, wait=30)["status"] == "succeeded", "the workers are there again"
        found = every_job(server)
    finally:
        for burner in burners:
            burner.kill()
            burner.wait()
        killer.server.kill()
    lost = [job_id for job_id in accepted if job_id not in found]
    labels = [job["label"] for job in found.values() if job["label"]]
    doubled = len(labels) - len(set(labels))
    failed = [job for job in found.values() if job["status"] != "succeeded"]
    wrong = [
        job_id
        for job_id, body in accepted.items()
        if job_id in found
        and found[job_id]["status"] == "succeeded"
        and found[job_id]["result"]["search"]["seed"] != body["problem"]["seed"]
    ]
    print(
        f"\n{'all cores busy' if busy else 'machine as it is'}: {len(accepted)} jobs accepted from {CLIENTS} clients, "
        f"{killer.worker_kills} workers and {killer.server_kills} servers killed in {time.monotonic() - began:.0f} s: "
        f"{len(lost)} lost, {doubled} doubled, {len(wrong)} wrong, {len(failed)} failed; "
        f"the last worker of a killed server was gone after {killer.longest_orphan_s:.2f} s at most"
    )
    assert len(accepted) >= JOBS
    assert (lost, doubled, wrong, failed) == ([], 0, [], [])
    assert killer.longest_orphan_s < ORPHAN_S


def listed(server, status):
    return server.client.get(f"/v1/jobs?limit=1&status={status}").json()["jobs"]


def every_job(server):
    found, cursor = {}, ""
    while cursor is not None:
        page = server.client.get("/v1/jobs?limit=100" + (f"&cursor={cursor}" if cursor else "")).json()
        for job in page["jobs"]:
            found[job["id"]] = server.job(job["id"])
        cursor = page["next_cursor"]
    return found
