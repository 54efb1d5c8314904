"""A real server process for tests, and what tests ask of it."""

import os
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import httpx
from prometheus_client.parser import text_string_to_metric_families

from tests.cluster.backend import CHOSEN
from tests.support import cpu_time
from tests.support.answers import ANEW

ROOT = Path(__file__).parents[3]
REAL = ("-m", "service.command.cli")
LEAN = (str(Path(__file__).with_name("lean_server.py")),)
SCRIPTED = (str(Path(__file__).with_name("scripted_server.py")),)
STACKS = signal.SIGUSR1
"""A scripted process writes the stacks of its threads to its log when it gets this signal."""
START_S = 240.0  # the first start ever compiles the kernels, and a machine may be very busy
STOP_S = 60.0  # how long it takes in good health is for the tests of that; a machine may be ten times as busy
REACHED_S = 120.0  # a worker may have to be started first
SOON_S = 20.0  # a hang is longer; how soon it is on a machine in good health is for the tests of faults
PROBLEM = {
    "kind": "motion",
    "positions": [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 10.0, "y": 5.0, "angle": 30.0}],
}


def until(condition, seconds=10.0, what="the condition"):
    """The first true value of ``condition()``."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if value := condition():
            return value
        time.sleep(0.01)  # what is waited for is of any sort, and tells nobody
    raise AssertionError(f"{what} did not come about within {seconds} s")


def environment(folder: Path, **settings) -> dict[str, str]:
    clean = {key: value for key, value in os.environ.items() if not key.startswith("MECHSYNTH_")}
    settings = {**CHOSEN.settings(folder), **settings}
    settings = {"compile_ahead": "false", **settings}  # what no test calls
    ours = {"MECHSYNTH_PORT": "0", "MECHSYNTH_DATA_DIR": str(folder / "data"), "SCRIPTED_FOLDER": str(folder)}
    return {**clean, "PYTHONPATH": str(ROOT), **ours, **{f"MECHSYNTH_{k.upper()}": str(v) for k, v in settings.items()}}


class RunningServer:
    """Starts ``mechsynth serve`` in ``folder``, and a worker host where it needs one, and waits until it is ready."""

    def __init__(self, folder: Path, program=REAL, **settings):
        self.folder = folder
        settings = {"reserve": 0, **settings} if program is SCRIPTED else settings  # workers that can be counted
        self.log_path = folder / "log"
        announced = folder / "announced"
        env = environment(folder, **settings)
        with announced.open("wb") as out, self.log_path.open("ab") as log:
            self.process = subprocess.Popen(
                [sys.executable, *program, "serve"], stdout=out, stderr=log, env=env, cwd=folder
            )
            cpu_time.own_servers.add(self.process.pid)
            self.host = self.process
            if CHOSEN.distributed:
                self.host = subprocess.Popen(
                    [sys.executable, *program, "worker"], stdout=log, stderr=log, env=env, cwd=folder
                )
        try:
            self.url = until(lambda: self._url(announced), START_S, "the announcement").strip()
        except BaseException:
            self.kill()
            raise
        self.client = httpx.Client(base_url=self.url, timeout=60.0)
        assert self.client.get("/readyz").status_code == 200

    def _url(self, announced):
        assert self.process.poll() is None, self.log()
        assert self.host.poll() is None, self.log()
        words = announced.read_text().split()
        return words[-1] if words else ""

    def log(self) -> str:
        return self.log_path.read_text()

    def post(self, seed=None, wait=None, problem=PROBLEM, **fields):
        headers = {} if wait is None else {"Prefer": f"wait={wait}"}
        stated = problem if seed is None else {**problem, "seed": seed}
        answer = self.client.post("/v1/jobs", json={"problem": stated, **fields}, headers=headers)
        assert answer.status_code in (200, 202), answer.text
        return answer.json()

    def job(self, job_id):
        answer = self.client.get(f"/v1/jobs/{job_id}")
        assert answer.status_code == 200, answer.text
        return answer.json()

    def reaches(self, job_id, status, seconds=REACHED_S):
        """The job once it has the status."""

        def there():
            job = self.job(job_id)
            return job if job["status"] == status else None

        return until(there, seconds, f"job {status}")

    def samples(self):
        """What the service measures of itself, by name and labels."""
        families = text_string_to_metric_families(self.client.get("/metrics").text)
        samples = [sample for family in families for sample in family.samples]
        return {(sample.name, *sorted(sample.labels.items())): sample.value for sample in samples}

    def sample(self, name, **labels):
        """One sample; 0 where there is none. Tests that share a server compare it with what it was before."""
        return self.samples().get((name, *sorted(labels.items())), 0.0)

    @contextmanager
    def solving_anew(self):
        """Let the workers of a lean server solve also what the session knows the answer to."""
        mark = self.folder / ANEW
        mark.touch()
        try:
            yield
        finally:
            mark.unlink()

    def workers(self):
        return workers_of(self.host.pid)

    def stored(self, job_id, column):
        """What the store has of a job, past the service."""
        return stored(self.folder, job_id, column)

    def stop(self):
        """Ask the server to end; gives its exit status."""
        self.client.close()
        cpu_time.own_servers.discard(self.process.pid)
        self.process.send_signal(signal.SIGTERM)
        if self.host is not self.process:
            self.host.send_signal(signal.SIGTERM)
        return self.process.wait(STOP_S) or self.host.wait(STOP_S)

    def kill(self):
        if hasattr(self, "client"):
            self.client.close()
        cpu_time.own_servers.discard(self.process.pid)
        for process in (self.process, self.host):
            process.kill()
            process.wait(STOP_S)


def stored(folder, job_id, column):
    """What the store of the service in a folder has of a job."""
    if CHOSEN.distributed:
        rows = CHOSEN.postgres.query(CHOSEN.mark(folder), f"SELECT {column} FROM jobs WHERE id = %s", job_id)
        return rows[0][0]
    raw = sqlite3.connect(folder / "data" / "mechsynth.sqlite3")
    try:
        return raw.execute(f"SELECT {column} FROM jobs WHERE id = ?", (job_id,)).fetchone()[0]
    finally:
        raw.close()


@contextmanager
def store_away(folder):
    """No process can write to the store of the service in a folder: PostgreSQL is down, or SQLite's file is locked."""
    if CHOSEN.distributed:
        CHOSEN.postgres.stop()
        try:
            yield
        finally:
            CHOSEN.postgres.start()
        return
    raw = sqlite3.connect(folder / "data" / "mechsynth.sqlite3", isolation_level=None)
    try:
        raw.execute("BEGIN IMMEDIATE")
        yield
    finally:
        raw.close()


def workers_of(server_pid):
    """Process ids of the living workers of a server."""
    return [pid for pid, parent, command in _processes() if parent == server_pid and "spawn_main" in command]


def alive(pid):
    """Whether the process exists and is not just waiting to be collected."""
    return any(pid == other for other, _, _ in _processes())


def _processes():
    for entry in Path("/proc").iterdir():
        if not entry.name.isdecimal():
            continue
        try:
            state, parent = (entry / "stat").read_text().rpartition(")")[2].split()[:2]
            command = (entry / "cmdline").read_text()
        except OSError:  # it ended just now
            continue
        if state not in "ZX":
            yield int(entry.name), int(parent), command
