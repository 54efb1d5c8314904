"""What becomes of requests that nobody means: thousands of spoilt analyses and jobs, posted to a real server.

    python -m benchmarks.request_fuzz [--analyses 5000] [--jobs 250] [--clients 4] [--seed 1] [--memory-mb 6144]

A server is started on a free loopback port with a limit of memory for itself and each of its processes. First it solves
the example of each quick kind, whose designs are analysed too. Then so many analyses and jobs are posted over a few
connections. What counts is 0 answers of 5xx but 503 with ``Retry-After``, none that takes longer than 5 s, no refusal
that names no field, no job that fails by a defect, and a memory that does not grow by more than 100 MB between a third
of the way and the end. The bodies of what offends are written to a folder.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import sys
import tempfile
import threading
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx

from synthesis.registry import get_first_example
from tests.support.problems.fuzz_bodies import BLOCKS, analysis_corpus, job_corpus, spoil
from tests.support.service.running import RunningServer

SLOW_S = 5.0
"""An answer that takes longer is an offence."""

GROWTH_MB = 100
"""By how much the memory of the server and its processes may grow."""

QUICK_KINDS = ("motion", "path", "function", "gear_train", "planetary_train", "cam", "dwell", "straight_line")
"""Kinds whose examples are solved for their designs."""

JOB_WAIT_S = 30
"""How long a job is waited for before it is cancelled."""

PERIOD_S = 5.0
"""How often the memory is looked at."""

SHOWN = 12
"""Offences that are printed in full."""


@dataclass
class Tally:
    """What was answered. Filled by several threads."""

    statuses: Counter[str] = field(default_factory=Counter)
    offences: list[dict[str, Any]] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    memory_mb: list[float] = field(default_factory=list)
    lock: threading.Lock = field(default_factory=threading.Lock)

    def add(self, what: str, number: int, body: bytes, answer: httpx.Response | None, seconds: float) -> None:
        """Count an answer, and keep what offends."""
        faults = _faults(answer, seconds)
        status = "none" if answer is None else str(answer.status_code)
        with self.lock:
            self.statuses[f"{what} {status}"] += 1
            self.times.append(seconds)
            for fault in faults:
                text = "" if answer is None else answer.text[:2000]
                self.offences.append(
                    {"fault": fault, "what": what, "number": number, "seconds": seconds, "answer": text,
                     "body": body.decode()}
                )  # fmt: skip


def _faults(answer: httpx.Response | None, seconds: float) -> list[str]:
    if answer is None:
        return ["no answer"]
    faults = [f"took more than {SLOW_S:g} s"] if seconds > SLOW_S else []
    if answer.status_code >= 500 and not (answer.status_code == 503 and "retry-after" in answer.headers):
        faults.append(f"answered {answer.status_code}")
    if answer.status_code in (400, 422) and not answer.json().get("errors"):
        faults.append("refused without a field")
    return faults


def run(analyses: int, jobs: int, clients: int, seed: int, memory_mb: int, folder: Path) -> Tally:
    """Post so many analyses and jobs to a server of its own."""
    tally = Tally()
    before = resource.getrlimit(resource.RLIMIT_DATA)
    # The server inherits it; this process has its own back at once.
    resource.setrlimit(resource.RLIMIT_DATA, (memory_mb << 20, before[1]))
    try:
        server = RunningServer(folder, workers=1, reserve=1, rate_limit="off", log_level="warning", job_timeout_s=60)
    finally:
        resource.setrlimit(resource.RLIMIT_DATA, before)
    try:
        corpus = analysis_corpus(_solve_examples(server))
        print(f"{len(corpus)} sound analyses, of which the others are made", flush=True)
        _warm(server, corpus)
        work = [("analysis", n) for n in range(analyses)] + [("job", n) for n in range(jobs)]
        if analyses and jobs:  # jobs among analyses, evenly
            work.sort(key=lambda item: item[1] / (analyses if item[0] == "analysis" else jobs))
        _post_all(server, work, corpus, clients, seed, tally)
        tally.statuses["defects"] = round(_defects(server))
    finally:
        status = server.stop()
    if status != 0:
        tally.offences.append({"fault": f"the server ended with {status}", "what": "server", "body": "", "answer": ""})
    return tally


def _solve_examples(server: RunningServer) -> list[dict[str, Any]]:
    """Mechanisms of the designs of quick examples."""
    found = []
    for kind in QUICK_KINDS:
        job = server.post(problem=get_first_example(kind), wait=30)
        designs = (job.get("result") or {}).get("designs", [])
        found += [design["mechanism"] for design in designs[:2]]
    return found


def _warm(server: RunningServer, corpus: list[dict[str, Any]]) -> None:
    """Post all that is sound once: what is compiled now is no fault of a later case."""
    for body in corpus:
        for block in ({}, *BLOCKS):
            server.client.post("/v1/analyses", json={**body, **block}, timeout=300.0)


JSON = {"Content-Type": "application/json"}


def _post_all(
    server: RunningServer,
    work: list[tuple[str, int]],
    corpus: list[dict[str, Any]],
    clients: int,
    seed: int,
    tally: Tally,
) -> None:
    problems = job_corpus()
    taken = iter(work)
    lock = threading.Lock()
    began = time.monotonic()

    def post() -> None:
        with httpx.Client(base_url=server.url, timeout=120.0) as client:
            while True:
                with lock:
                    item = next(taken, None)
                if item is None:
                    return
                what, number = item
                if what == "analysis":
                    _post_analysis(client, number, spoil(corpus, number, seed), tally)
                else:
                    _post_job(client, number, spoil(problems, number, seed, blocks=False), tally)

    threads = [threading.Thread(target=post, daemon=True) for _ in range(clients)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        tally.memory_mb.append(_memory_mb(server.process.pid))
        done, load = len(tally.times), os.getloadavg()[0]
        print(f"{time.monotonic() - began:7.0f} s  {done:7d} of {len(work)}  {tally.memory_mb[-1]:6.0f} MB  "
              f"{len(tally.offences)} offences  load {load:.1f}", flush=True)  # fmt: skip
        time.sleep(PERIOD_S)


def _post_analysis(client: httpx.Client, number: int, body: bytes, tally: Tally) -> None:
    began = time.monotonic()
    try:
        answer: httpx.Response | None = client.post("/v1/analyses", content=body, headers=JSON)
    except httpx.HTTPError:
        answer = None
    tally.add("analysis", number, body, answer, time.monotonic() - began)


def _post_job(client: httpx.Client, number: int, body: bytes, tally: Tally) -> None:
    """Post a job, wait for it, and remove it."""
    began = time.monotonic()
    try:
        answer: httpx.Response | None = client.post("/v1/jobs", content=body, headers=JSON)
    except httpx.HTTPError:
        answer = None
    tally.add("job", number, body, answer, time.monotonic() - began)
    if answer is None or answer.status_code not in (200, 201, 202):
        return
    job = answer.json()
    latest = time.monotonic() + JOB_WAIT_S
    while job["status"] in ("queued", "running") and time.monotonic() < latest:
        time.sleep(0.2)
        job = client.get(f"/v1/jobs/{job['id']}").json()
    error = job.get("error") or {}
    if error.get("type", "").endswith("internal-error") or error.get("status", 0) == 500:
        with tally.lock:
            tally.offences.append(
                {"fault": "the job failed by a defect", "what": "job", "number": number, "seconds": 0.0,
                 "answer": json.dumps(error), "body": body.decode()}
            )  # fmt: skip
    with tally.lock:
        tally.statuses[f"job {job['status']}"] += 1
    client.post(f"/v1/jobs/{job['id']}/cancel")
    client.delete(f"/v1/jobs/{job['id']}")


def _memory_mb(pid: int) -> float:
    """Memory of a process and all that it has started; what they share is counted once (PSS)."""
    total, pending = 0, [pid]
    while pending:
        one = pending.pop()
        try:
            rollup = Path(f"/proc/{one}/smaps_rollup").read_text()
            tasks = Path(f"/proc/{one}/task").iterdir()
            pending += [int(child) for task in tasks for child in (task / "children").read_text().split()]
        except OSError:  # it has ended just now
            continue
        total += next(int(line.split()[1]) for line in rollup.splitlines() if line.startswith("Pss:"))
    return total / 1024.0


def _defects(server: RunningServer) -> float:
    return sum(value for (name, *_), value in server.samples().items() if name == "mechsynth_defects_total")


def report(tally: Tally, folder: Path) -> bool:
    """Print what became of all, write what offends; whether nothing does."""
    print(*(f"{n:7d}  {what}" for what, n in sorted(tally.statuses.items())), sep="\n")
    if tally.times:
        times = sorted(tally.times)
        print(f"median {1e3 * times[len(times) // 2]:.0f} ms, 99 of 100 within {times[int(0.99 * len(times))]:.2f} s, "
              f"longest {times[-1]:.2f} s")  # fmt: skip
    memory = tally.memory_mb
    if len(memory) >= 6:
        third = sorted(memory[len(memory) // 3 : len(memory) // 2])
        growth = sorted(memory[-max(len(memory) // 6, 1) :])[0] - third[len(third) // 2]
        print(f"memory {memory[0]:.0f} MB at first, {memory[-1]:.0f} MB at last, {max(memory):.0f} MB at most; "
              f"grown by {growth:.0f} MB since a third of the way")  # fmt: skip
        if growth > GROWTH_MB:
            tally.offences.append(
                {"fault": f"memory grew by {growth:.0f} MB", "what": "server", "body": "", "answer": ""}
            )
    print(*(f"{n:7d}  {fault}" for fault, n in Counter(each["fault"] for each in tally.offences).items()), sep="\n")
    for offence in tally.offences[:SHOWN]:
        print(json.dumps({**offence, "body": offence["body"][:600], "answer": offence["answer"][:300]}))
    if tally.offences:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "offences.json").write_text(json.dumps(tally.offences, indent=1))
        print(f"all of them are in {folder / 'offences.json'}")
    return not tally.offences


def main() -> int:
    """Run the command; 1 where something offends."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--analyses", type=int, default=5000)
    parser.add_argument("--jobs", type=int, default=250)
    parser.add_argument("--clients", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--memory-mb", type=int, default=6144, help="of the server and of each of its processes")
    parser.add_argument("--output", type=Path, default=Path("var/fuzz"))
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        began = time.monotonic()
        tally = run(asked.analyses, asked.jobs, asked.clients, asked.seed, asked.memory_mb, Path(folder))
        print(f"{time.monotonic() - began:.0f} s in all, load {os.getloadavg()[0]:.1f}")
        if tally.offences:
            asked.output.mkdir(parents=True, exist_ok=True)
            (asked.output / "server.log").write_text((Path(folder) / "log").read_text()[-2_000_000:])
        return 0 if report(tally, asked.output) else 1


if __name__ == "__main__":
    sys.exit(main())
