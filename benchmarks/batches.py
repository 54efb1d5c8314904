"""How fast a batch is solved, what others wait for meanwhile, and what becomes of it when it is killed.

    python -m benchmarks.batches [--samples 2000] [--jobs 60] [--at-once]

First what a problem costs in one process. Then a real server with two workers and one in reserve is started on a free
loopback port, with the keys of two tenants. One posts a batch of Norton's Problem 5-26 with a position varied, none of
them like another and none reused. First alone: jobs a second by the clock and, which other work of the machine changes
less, processor time of the server and of its workers. Then again, while the other tenant posts single jobs, one after
the other, and waits for each; so does the first one, beside its own batch. Then again, with a worker killed twice and
the server once in the middle; every sample has to be there once in the end.
"""

from __future__ import annotations

import argparse
import os
import signal
import tempfile
import time
from pathlib import Path
from typing import Any

import httpx

from benchmarks.fairness import RESERVE, WORKERS, Tenant, key_of, row, short_jobs
from benchmarks.service import PROBLEM_5_26, spent, until_settled
from service.jobs import faults
from service.jobs.batches.plan import Plan
from service.jobs.batches.sampling import sample_evenly
from service.jobs.batches.slices import SliceSolver
from service.jobs.batches.store import BatchStore
from service.jobs.job_store import JobStore
from service.jobs.processes.stop_flag import Solving
from service.jobs.store.database import connect, upgrade
from service.jobs.store.states import Cost
from synthesis import dispatch
from tests.support.service.running import RunningServer, until

TARGET_PER_S = 300.0
PROCESSORS = 2
LONGEST_S = 900.0


class Batches:
    """The batches of a tenant."""

    def __init__(self, server: RunningServer, key: str) -> None:
        self._client = httpx.Client(base_url=server.url, timeout=60.0, headers={"Authorization": f"Bearer {key}"})

    def post(self, samples: int, begin: float) -> str:
        varied = {"field": "/positions/1/x", "from": begin, "to": begin + 10.0, "count": samples}
        body = {"problem": PROBLEM_5_26, "vary": [varied], "reuse": False}
        answer = self._client.post("/v1/batches", json=body)
        assert answer.status_code == 202, answer.text
        return str(answer.json()["id"])

    def get(self, batch_id: str) -> dict[str, Any]:
        batch: dict[str, Any] = self._client.get(f"/v1/batches/{batch_id}").raise_for_status().json()
        return batch

    def finished(self, batch_id: str) -> dict[str, Any]:
        """The batch at its end; asked for seldom, as a client would."""
        until_s = time.monotonic() + LONGEST_S
        while (batch := self.get(batch_id))["status"] in ("queued", "running"):
            assert time.monotonic() < until_s, batch
            time.sleep(0.25)  # between two questions, whose answers cost the server what is measured
        return batch

    def jobs(self, batch_id: str) -> list[str]:
        table = self._client.get(f"/v1/batches/{batch_id}/table.json").raise_for_status().json()
        return [row[table["columns"].index("job")] for row in table["rows"]]


def alone(server: RunningServer, batches: Batches, samples: int) -> None:
    batch, took = spent(server, lambda: batches.finished(batches.post(samples, 180.0)))
    assert batch["succeeded"] == samples, batch
    each = (took.server + took.workers) / samples
    print(
        f"{samples} problems: {samples / took.clock:.0f} a second by the clock; {took.each(samples)}, which two "
        f"processors do {PROCESSORS / each:.0f} times a second (at least {TARGET_PER_S:.0f} wanted)",
        flush=True,
    )


def beside(batches: Batches, samples: int, tenants: dict[str, Tenant], jobs: int) -> None:
    for n, (name, tenant) in enumerate(tenants.items()):
        batch_id = batches.post(samples, 191.0 + n)
        times = short_jobs(tenant, jobs)
        batch = batches.get(batch_id)
        row(f"single jobs {name} beside a batch", times, f"; then {batch['done']} of {samples} were done")
        batches.finished(batch_id)


def killed(folder: Path, server: RunningServer, key: str, samples: int, settings: dict[str, Any]) -> None:
    batches = Batches(server, key)
    batch_id = batches.post(samples, 170.0)
    for share in (0.2, 0.4):
        until(lambda share=share: batches.get(batch_id)["done"] > share * samples, LONGEST_S, "a part of the batch")
        os.kill(server.workers()[0], signal.SIGKILL)
    until(lambda: batches.get(batch_id)["done"] > 0.6 * samples, LONGEST_S, "most of the batch")
    done = batches.get(batch_id)["done"]
    server.kill()
    again = RunningServer(folder, **settings)
    try:
        batches = Batches(again, key)
        batch = batches.finished(batch_id)
        jobs = batches.jobs(batch_id)
        assert (batch["succeeded"], batch["failed"]) == (samples, 0), batch
        assert len(set(jobs)) == samples
        print(
            f"killed: two workers, and the server with {done} of {samples} done; all are there, each once", flush=True
        )
    finally:
        again.stop()


def in_one_process(samples: int) -> None:
    """What claiming, solving and storing cost without servers and other processes: once anew, once from the store."""
    dispatch.warm_up()
    with tempfile.TemporaryDirectory() as folder:
        engine = connect(f"sqlite:///{folder}/store.sqlite3", durable=False)
        upgrade(engine)
        store, jobs = BatchStore(engine), JobStore(engine)
        slices = SliceSolver(store, Solving(), faults.make_out_of_memory(1))
        spent_s = []
        for reuse in (False, False, True):  # what is loaded at first use counts for the first one only
            plan = Plan(PROBLEM_5_26, ["/positions/1/x"], [sample_evenly(170.0, 180.0, samples)], True, ["size"], reuse)
            began = time.process_time()
            batch, _ = store.create(
                tenant="", kind="motion", label=None, plan=plan, cost=Cost.SHORT, max_queued=1000, repeatable=None
            )
            while (claim := jobs.take(str(len(spent_s)), [Cost.SHORT])) is not None:
                slices.run(claim, batch.id)
            spent_s.append(time.process_time() - began)
            done = store.get(batch.id)
            assert done is not None
            assert (done.succeeded, done.cached) == (samples, samples if reuse else 0), done
        engine.dispose()
    print(
        f"{samples} problems in one process: {1e3 * spent_s[1] / samples:.2f} ms of processor each, claimed, solved "
        f"and stored; {1e3 * spent_s[2] / samples:.2f} ms where the store has the answer",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("--samples", type=int, default=2000)
    parser.add_argument("--jobs", type=int, default=60, help="single jobs of each tenant beside a batch")
    parser.add_argument(
        "--at-once", action="store_true", help="do not wait until the workers have loaded all kinds, which counts then"
    )
    given = parser.parse_args()
    settings = {"log_level": "warning", "rate_limit": "off", "workers": WORKERS, "reserve": RESERVE}
    in_one_process(given.samples)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        keys = {tenant: key_of(folder, tenant) for tenant in ("guest", "other")}
        server = RunningServer(folder, **settings)
        try:
            if not given.at_once:
                until_settled(server, WORKERS + RESERVE)
            batches = Batches(server, keys["other"])
            tenants = {
                "of another tenant": Tenant(server.url, keys["guest"]),
                "of the same tenant": Tenant(server.url, keys["other"]),
            }
            for tenant in tenants.values():
                short_jobs(tenant, 5)
            print(f"load {os.getloadavg()[0]:.1f}")
            alone(server, batches, given.samples)
            print(f"{'milliseconds':<52}{'jobs':>6}{'median':>11}{'p99':>9}{'worst':>9}")
            row("single jobs alone", short_jobs(tenants["of another tenant"], given.jobs))
            beside(batches, given.samples, tenants, given.jobs)
            killed(folder, server, keys["other"], given.samples, settings)
        finally:
            server.kill()


if __name__ == "__main__":
    main()
