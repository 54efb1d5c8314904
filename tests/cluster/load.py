"""Clients that submit jobs for as long as they are told to, whatever happens, and remember what was accepted."""

import itertools
import threading
import time

import httpx
from sqlalchemy import text

from tests.support.service.running import PROBLEM
from tests.support.service.scripted_server import BRIEF


class Load:
    """``clients`` clients that send jobs to servers in turn, each with its key, until one of them takes it."""

    def __init__(self, urls, clients=4, at_least=0):
        self.urls = urls
        self.accepted = {}  # seeds by the ids of the jobs
        self.refused = 0
        self.failure = None
        self._at_least = at_least
        self._numbers = itertools.count()
        self._lock = threading.Lock()
        self._stopping = threading.Event()
        self._threads = [threading.Thread(target=self._submit, args=(n,), daemon=True) for n in range(clients)]

    def __enter__(self):
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *_):
        self.finish()

    def finish(self):
        self._stopping.set()
        for thread in self._threads:
            thread.join(120)
        assert self.failure is None, self.failure

    def _submit(self, turn):
        try:
            with httpx.Client(timeout=30.0) as client:
                while not self._stopping.is_set() or len(self.accepted) < self._at_least:
                    with self._lock:
                        n = next(self._numbers)
                    self._send(client, n, turn)
                    time.sleep(0.02)  # load, not a flood: the queue must have room
        except BaseException as error:
            self.failure = error

    def _send(self, client, n, turn):
        seed = BRIEF + n % 9_000
        body = {"problem": {**PROBLEM, "seed": seed}, "label": f"job {n}"}
        give_up = time.monotonic() + 120
        for attempt in itertools.count(turn):
            assert time.monotonic() < give_up, "no server takes a job for two minutes"
            url = self.urls[attempt % len(self.urls)]
            try:
                answer = client.post(f"{url}/v1/jobs", json=body, headers={"Idempotency-Key": f"key-{n}"})
            except httpx.TransportError:
                time.sleep(0.05)  # that server is being started again
                continue
            assert answer.status_code in (200, 202, 503), answer.text
            if answer.status_code != 503:
                self.accepted[answer.json()["id"]] = seed
                return
            assert answer.headers["retry-after"]
            assert answer.headers["content-type"] == "application/problem+json"
            self.refused += 1
            time.sleep(0.2)  # refused: Retry-After is seconds, and the load should find the first moment


def fill_queue(connection, jobs, tenants, cost="long"):
    """Store so many queued jobs, one of each tenant in each turn, and have PostgreSQL count them."""
    connection.execute(
        text(
            "INSERT INTO jobs (id, tenant, kind, status, created_at, progress_fraction, progress_message, problem, "
            "attempt, crashes, revision, cost, turn) "
            "SELECT lpad(n::text, 26, '0'), 't' || n % :tenants, 'motion', 'queued', '', 0, 'queued', '{}', 0, 0, 1, "
            ":cost, n / :tenants + 1 FROM generate_series(0, :jobs - 1) AS n"
        ),
        {"jobs": jobs, "tenants": tenants, "cost": cost},
    )
    connection.execute(text("ANALYZE jobs"))


def verdict(accepted, jobs):
    """What became of accepted jobs: how many were lost, doubled, wrong, failed."""
    found = {job[0]: job for job in jobs}
    labels = [job[1] for job in jobs if job[1]]
    return {
        "lost": [job_id for job_id in accepted if job_id not in found],
        "doubled": sorted({label for label in labels if labels.count(label) > 1}),
        "wrong": [
            job_id
            for job_id, seed in accepted.items()
            if job_id in found and found[job_id][2] == "succeeded" and f'"seed":{seed}' not in found[job_id][3]
        ],
        "failed": [job[0] for job in jobs if job[2] != "succeeded"],
    }


WELL = {"lost": [], "doubled": [], "wrong": [], "failed": []}
