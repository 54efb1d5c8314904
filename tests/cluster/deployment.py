"""Several servers and worker hosts on one store, each a process that can be killed and started again."""

import os
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import httpx
from prometheus_client.parser import text_string_to_metric_families

from tests.cluster.backend import CHOSEN
from tests.cluster.postgres import free_port
from tests.support.service.running import SCRIPTED, STACKS, START_S, STOP_S, environment, until, workers_of

OF_A_STACK = "Current thread 0x"
"""Stands once in what a process writes of its stacks."""


class Process:
    """A server or a worker host; ``port`` is kept over its deaths."""

    def __init__(self, folder: Path, name, act, **settings):
        self.name, self.act, self.folder = name, act, folder
        self.settings = {"reserve": 0, **settings, "log_level": "warning"}
        self.announced = folder / f"announced-{name}"
        self.port = 0
        self.start()

    def start(self):
        with self.announced.open("wb") as out, (self.folder / "log").open("ab") as log:
            self.process = subprocess.Popen(
                [sys.executable, *SCRIPTED, self.act], stdout=out, stderr=log, cwd=self.folder,
                env=environment(self.folder, **self.settings, port=self.port),
            )  # fmt: skip

    def ready(self):
        assert self.process.poll() is None, (self.folder / "log").read_text()[-5000:]
        words = self.announced.read_text().split()
        if words and self.act == "serve":
            self.port = int(words[-1].rpartition(":")[2])
        return bool(words)

    @property
    def url(self):
        return f"http://127.0.0.1:{self.port}"

    def metrics(self):
        """What a worker host tells Prometheus: values by names and labels."""
        text = httpx.get(f"http://127.0.0.1:{self.settings['worker_metrics_port']}/metrics").text
        samples = [sample for family in text_string_to_metric_families(text) for sample in family.samples]
        return {(sample.name, *sample.labels.values()): sample.value for sample in samples}

    def children(self):
        return workers_of(self.process.pid)

    def kill(self):
        self.process.kill()
        self.process.wait(STOP_S)

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(STOP_S)


class Deployment:
    """``servers`` servers and ``hosts`` worker hosts that share the database of the folder."""

    def __init__(self, folder: Path, servers=2, hosts=2, **settings):
        self.folder = folder
        self.hosts = [
            Process(folder, f"host-{n}", "worker", worker_metrics_port=free_port(), **settings) for n in range(hosts)
        ]
        self.servers = [Process(folder, f"server-{n}", "serve", **settings) for n in range(servers)]
        try:
            for process in (*self.hosts, *self.servers):
                # They start side by side, and share the processors.
                until(process.ready, START_S * (servers + hosts), f"the start of {process.name}")
        except BaseException:
            self.kill()
            raise
        self.clients = [httpx.Client(base_url=server.url, timeout=60.0) for server in self.servers]

    def complete(self):
        """Start again whatever does not run."""
        ended = [process for process in (*self.hosts, *self.servers) if process.process.poll() is not None]
        for process in ended:
            process.start()
        for process in ended:
            until(process.ready, 2 * START_S, f"{process.name} again")

    def log(self):
        return (self.folder / "log").read_text()

    def jobs(self):
        """What the store has of all jobs: id, label, status, result, crashes."""
        return CHOSEN.postgres.query(
            CHOSEN.mark(self.folder), "SELECT id, label, status, result, crashes, error FROM jobs ORDER BY id"
        )

    def unfinished(self):
        return [job for job in self.jobs() if job[2] in ("queued", "running")]

    def finish(self, within_s):
        """Wait for the end of all jobs. Where it does not come, the failure tells where all processes stand."""
        try:
            until(lambda: not self.unfinished(), within_s, "the end of all jobs")
        except AssertionError as late:
            before = self.log().count(OF_A_STACK)
            pids = [pid for each in (*self.hosts, *self.servers) for pid in (each.process.pid, *each.children())]
            asked = sum(signal_quietly(pid, STACKS) for pid in pids)
            with suppress(AssertionError):  # one that hangs in the kernel writes none
                until(lambda: self.log().count(OF_A_STACK) >= before + asked, 10.0, "all stacks")
            left = [(job[0], job[1], job[2], job[4]) for job in self.unfinished()]
            raise AssertionError(f"{late}; {len(left)} are left: {left[:20]}\n{self.log()[-60_000:]}") from None

    def stop(self):
        for client in self.clients:
            client.close()
        for process in (*self.servers, *self.hosts):
            if process.process.poll() is None:
                process.process.send_signal(signal.SIGTERM)
        return [process.process.wait(STOP_S) for process in (*self.servers, *self.hosts)]

    def kill(self):
        for client in getattr(self, "clients", ()):
            client.close()
        for process in (*getattr(self, "servers", ()), *self.hosts):
            process.kill()


def alive_now(pids):
    """Those of the processes that are there and not just waiting to be collected."""
    found = []
    for pid in pids:
        try:
            state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            continue
        if state not in "ZX":
            found.append(pid)
    return found


def signal_quietly(pid, how=signal.SIGKILL):
    """Send a signal to a process that may have ended meanwhile; tells whether it was there."""
    try:
        os.kill(pid, how)
    except ProcessLookupError:
        return False
    return True
