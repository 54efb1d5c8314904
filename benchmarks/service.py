"""The service as its clients meet it: how long a small job takes, what a server bears, and how soon it is ready.

    python -m benchmarks.service [--jobs 200] [--analyses-only]

A real server is started on a free loopback port, and left alone until its workers have loaded everything. The jobs are
Norton's Problem 5-26, solved and verified, stated with ``Prefer: wait``; the time runs from the request to the last
byte of the answer. First over one connection, then over eight. Then analyses in 360 steps of a mechanism of every type:
their bodies are large, and are received to the end. A second server shows what it bears: reads of a job over four
connections, a thousand queued jobs worked off, two hundred listeners, a flood of five times its queue, nine hundred
half-open connections, and every hostile body of the tests.

Beside the times stands the processor time of the server and of its workers: on a machine that is busy with other things
the times say how busy, the processor time what the work costs.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import os
import selectors
import signal
import socket
import statistics
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar
from urllib.parse import urlsplit

import httpx

from benchmarks import http_load
from benchmarks.http_load import Load
from synthesis.analyses import list_families
from synthesis.registry import KINDS
from tests.support.problems.given_mechanisms import STATED
from tests.support.service import hostile
from tests.support.service.hostile_bodies import ENORMOUS, INVALID, MALFORMED
from tests.support.service.raw_requests import HALVES
from tests.support.service.running import START_S, RunningServer, alive, until

PROBLEM_5_26 = {
    "kind": "motion",
    "positions": [
        {"x": 0.0, "y": 0.0, "angle": 0.0},
        {"x": 184.0, "y": -17.0, "angle": -45.0},
        {"x": 211.0, "y": -180.0, "angle": -90.0},
    ],
    "input_side": {"fixed_pivot": [86.0, -132.0]},
    "output_side": {"fixed_pivot": [104.0, -155.0]},
}
POSITIONS_ALONE = {key: PROBLEM_5_26[key] for key in ("kind", "positions")}


def job_time(client: httpx.Client, problem: dict[str, object]) -> float:
    start = time.perf_counter()
    answer = client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": "wait=20"})
    job = answer.json()
    elapsed = time.perf_counter() - start
    assert answer.status_code == 200
    assert job["result"]["designs"]
    return elapsed


def row(name: str, times: list[float]) -> None:
    milliseconds = [1e3 * t for t in times]
    print(f"{name:<52}{statistics.median(milliseconds):>10.1f}{statistics.quantiles(milliseconds, n=20)[-1]:>10.1f}")


STEPS = 360
ANALYSES = 60
QUEUE = 1000
LISTENERS = 200
HALF_OPEN = 900
BODY = json.dumps({"problem": PROBLEM_5_26}).encode()
QUEUED_JOB = http_load.request("POST", "/v1/jobs", BODY)
AWAITED_JOB = http_load.request("POST", "/v1/jobs", BODY, {"Prefer": "wait=20"})


T = TypeVar("T")


@dataclass(frozen=True)
class Spent:
    """Seconds of a piece of work: by the clock, and of the processors in the server and in its workers."""

    clock: float
    server: float
    workers: float

    def each(self, count: int) -> str:
        """The processor time of one of so many."""
        return f"{1e3 * self.server / count:.2f} ms of processor in the server" + (
            f" and {1e3 * self.workers / count:.2f} ms in a worker" if self.workers > 0.02 * self.server else ""
        )


def spent(server: RunningServer, work: Callable[[], T]) -> tuple[T, Spent]:
    """What the work gives, and what it took."""
    workers = server.workers()
    before = processor_s(server.process.pid), sum(map(processor_s, workers))
    start = time.perf_counter()
    given = work()
    clock = time.perf_counter() - start
    return given, Spent(clock, processor_s(server.process.pid) - before[0], sum(map(processor_s, workers)) - before[1])


def processor_s(pid: int) -> float:
    """Seconds of the processor that a process has had, by the system's clock of 10 ms."""
    times = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13]
    return sum(map(int, times)) / os.sysconf("SC_CLK_TCK")


def until_settled(server: RunningServer, workers: int = 3) -> None:
    """Wait until the workers have loaded what they load beside their first jobs, and are idle for some seconds."""
    until(lambda: len(server.workers()) == workers, 60.0, f"{workers} workers")
    deadline = time.monotonic() + START_S
    used = [sum(map(processor_s, server.workers()))]
    while len(used) < 4 or used[-1] > used[-4] + 0.03:
        assert time.monotonic() < deadline, f"the workers are not idle {START_S:.0f} s after they were started"
        time.sleep(1.0)  # the span over which their processor time is looked at
        used.append(sum(map(processor_s, server.workers())))


def awaited(server: RunningServer, jobs: int, connections: int) -> Load:
    """So many jobs, each waited for; every answer must be a solved one."""
    load = http_load.run(server.url, [AWAITED_JOB] * jobs, connections, keep_bodies=True)
    assert set(load.statuses) == {200}
    assert all(json.loads(body)["result"]["designs"] for body in load.bodies)
    return load


def fill(server: RunningServer, jobs: int) -> list[int]:
    """The statuses of so many jobs posted over four connections."""
    return http_load.run(server.url, [QUEUED_JOB] * jobs, 4).statuses


def waiting_or_running(server: RunningServer) -> bool:
    def some(status: str) -> bool:
        return bool(server.client.get(f"/v1/jobs?limit=1&status={status}").json()["jobs"])

    return some("queued") or some("running")


def drain(server: RunningServer) -> None:
    suspend(server, signal.SIGCONT)
    deadline = time.monotonic() + 120.0
    while waiting_or_running(server):
        assert time.monotonic() < deadline
        time.sleep(0.1)  # a closer look would take the processor from what is measured


def suspend(server: RunningServer, signal_: signal.Signals) -> None:
    for pid in server.workers():
        os.kill(pid, signal_)


def listeners(server: RunningServer) -> tuple[int, float]:
    """How many of the listeners to one job see exactly one end, and the seconds from the first of them to the last."""
    address = urlsplit(server.url)
    begun = []

    async def follow(request: bytes) -> tuple[int, float]:
        reader, writer = await asyncio.open_connection(address.hostname, address.port)
        writer.write(request)
        text = b""
        while not text.endswith(b"\r\n0\r\n\r\n"):
            chunk = await reader.read(1 << 16)
            if not text:
                begun.append(chunk)
                if len(begun) == LISTENERS:
                    suspend(server, signal.SIGCONT)
            text += chunk
            if not chunk:
                break
        writer.close()
        return text.count(b'"status":"succeeded"'), time.perf_counter()

    async def all_of_them(request: bytes) -> list[tuple[int, float]]:
        async with asyncio.timeout(60.0):
            return await asyncio.gather(*(follow(request) for _ in range(LISTENERS)))

    suspend(server, signal.SIGSTOP)
    job = server.post(problem=PROBLEM_5_26)
    seen = asyncio.run(all_of_them(http_load.request("GET", f"/v1/jobs/{job['id']}/events")))
    ends = [end for _, end in seen]
    return sum(count == 1 for count, _ in seen), max(ends) - min(ends)


def flood(server: RunningServer) -> tuple[int, float]:
    """Refusals of a flood of five times the queue, and the growth of the server's memory by it, MB."""
    suspend(server, signal.SIGSTOP)
    before = resident_mb(server.process.pid)
    statuses = fill(server, 5 * QUEUE)
    assert set(statuses) == {202, 503}
    drain(server)
    return statuses.count(503), resident_mb(server.process.pid) - before


def resident_mb(pid: int) -> float:
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def half_open(server: RunningServer) -> tuple[float, list[float]]:
    """Seconds until the last of many connections with half a request is closed; and the times of honest jobs beside."""
    address = urlsplit(server.url)
    halves = list(HALVES.values())
    waiting = selectors.DefaultSelector()
    start = time.perf_counter()
    for n in range(HALF_OPEN):
        connection = socket.create_connection((address.hostname, address.port), timeout=30)
        connection.sendall(halves[n % len(halves)])
        connection.setblocking(False)
        waiting.register(connection, selectors.EVENT_READ, time.perf_counter())
    longest, honest = 0.0, []
    while waiting.get_map():
        honest += awaited(server, 1, 1).times
        for key, _ in waiting.select(timeout=0.05):
            connection = key.fileobj
            assert isinstance(connection, socket.socket)
            with contextlib.suppress(ConnectionError):
                if connection.recv(65536):
                    continue
            longest = max(longest, time.perf_counter() - key.data)
            waiting.unregister(connection)
            connection.close()
        assert time.perf_counter() < start + 60.0
    return longest, honest


def hostile_times(server: RunningServer) -> list[tuple[float, float, str]]:
    """Seconds to each refusal by the clock and of the server's processor, with the body's name."""
    bodies = {name: body for name, (body, _) in INVALID.items()}
    bodies |= MALFORMED | ENORMOUS
    for kind in KINDS:
        bodies |= dict(hostile.of_kind(kind))
    asked = {name: http_load.request("POST", "/v1/jobs", body) for name, body in bodies.items()}
    times = []
    for name, request in asked.items():
        load, effort = spent(server, lambda request=request: http_load.run(server.url, [request], 1, keep_bodies=True))
        assert 400 <= load.statuses[0] < 500, name
        problem = json.loads(load.bodies[0])
        assert problem["status"] == load.statuses[0], name
        assert problem["type"].startswith("/problems/"), name
        times.append((load.times[0], effort.server, name))
    return times


def bearing() -> None:
    """What a server bears, and the end of its workers when it is killed."""
    with tempfile.TemporaryDirectory() as folder:
        server = RunningServer(Path(folder), log_level="warning", max_queued=QUEUE)
        try:
            until_settled(server)
            job = server.post(problem=PROBLEM_5_26, wait=20)
            read = [http_load.request("GET", f"/v1/jobs/{job['id']}")] * 4000
            http_load.run(server.url, read[:400], 4)
            _, effort = spent(server, lambda: http_load.run(server.url, read, 4))
            print(f"\nGET of a job, four connections: {len(read) / effort.clock:.0f}/s, {effort.each(len(read))}")
            suspend(server, signal.SIGSTOP)
            waiting = server.post(problem=PROBLEM_5_26)
            read = [http_load.request("GET", f"/v1/jobs/{waiting['id']}")] * 2000
            _, effort = spent(server, lambda: http_load.run(server.url, read, 4))
            print(f"GET of a queued job: {len(read) / effort.clock:.0f}/s, {effort.each(len(read))}")
            drain(server)
            suspend(server, signal.SIGSTOP)
            assert set(fill(server, QUEUE)) == {202}
            _, effort = spent(server, lambda: drain(server))
            print(f"queue of {QUEUE} drained: {QUEUE / effort.clock:.0f} jobs/s, {effort.each(QUEUE)}")
            seen, spread = listeners(server)
            print(f"listeners that saw exactly one end: {seen} of {LISTENERS}, all within {1e3 * spread:.0f} ms")
            refusals, growth = flood(server)
            print(f"flood of {5 * QUEUE} jobs: {refusals} refused, memory grew by {growth:.0f} MB")
            longest, honest = half_open(server)
            print(
                f"half-open connections, {HALF_OPEN} at once: the last was closed after {longest:.1f} s; "
                f"{len(honest)} jobs meanwhile, median {1e3 * statistics.median(honest):.0f} ms, "
                f"slowest {1e3 * max(honest):.0f} ms"
            )
            times = hostile_times(server)
            by_clock, by_processor = max(times), max(times, key=lambda entry: entry[1])
            print(
                f"hostile bodies refused: {len(times)}, median {1e3 * sorted(times)[len(times) // 2][0]:.1f} ms, "
                f"worst {1e3 * by_clock[0]:.0f} ms ({by_clock[2]}), {sum(entry[0] > 0.2 for entry in times)} above 200 "
                f"ms; most processor time {1e3 * by_processor[1]:.0f} ms ({by_processor[2]})"
            )
            workers = server.workers()
            server.kill()
            start = time.perf_counter()
            until(lambda: not any(map(alive, workers)), 5.0)
            print(f"workers gone after the server was killed: {1e3 * (time.perf_counter() - start):.0f} ms")
        finally:
            if server.process.poll() is None:
                suspend(server, signal.SIGCONT)
                server.stop()


def stated() -> dict[str, dict[str, Any]]:
    """Requests for 360 steps of every type of linkage, and of the examples of all else that moves."""
    motion = {"from": 0.0, "to": 360.0, "steps": STEPS, "speed_rpm": 60.0}
    found = {}
    for name, mechanism in STATED.items():
        slide = mechanism.get("driven_by") == "slider"
        found[name] = {"mechanism": mechanism} | ({} if slide else {"motion": motion})
    for family in list_families()[1:]:
        body = family.request.get_example()
        if "steps" in body.get("motion", {}):
            body = {**body, "motion": {**body["motion"], "from": 0.0, "to": 360.0, "steps": STEPS}}
        found[body["mechanism"]["type"]] = body
    return found


def analyses(server: RunningServer) -> None:
    """Times of analyses by type: by the clock, from the request to the last byte, and of the server's processor."""
    print(
        f"\n{f'analysis of {STEPS} steps through HTTP':<44}{'median ms':>10}{'worst ms':>10}{'server ms':>10}{'kB':>8}"
    )
    medians = {}
    for name, body in stated().items():
        request = http_load.request("POST", "/v1/analyses", json.dumps(body).encode())
        first = http_load.run(server.url, [request] * 3, 1, keep_bodies=True)
        assert set(first.statuses) == {200}, (name, first.bodies[0])
        load, effort = spent(server, lambda request=request: http_load.run(server.url, [request] * ANALYSES, 1))
        medians[name] = 1e3 * statistics.median(load.times)
        print(
            f"{name:<44}{medians[name]:>10.1f}{1e3 * max(load.times):>10.1f}{1e3 * effort.server / ANALYSES:>10.1f}"
            f"{len(first.bodies[0]) / 1e3:>8.0f}"
        )
    slowest = max(medians, key=lambda name: medians[name])
    print(f"slowest: {slowest}, {medians[slowest]:.1f} ms; {sum(t > 50.0 for t in medians.values())} types above 50 ms")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("--jobs", type=int, default=200)
    parser.add_argument("--analyses-only", action="store_true", help="only the analyses, type by type")
    given = parser.parse_args()
    if given.analyses_only:
        with tempfile.TemporaryDirectory() as folder:
            server = RunningServer(Path(folder), log_level="warning")
            try:
                until_settled(server)
                analyses(server)
            finally:
                server.stop()
        return
    jobs = given.jobs
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        server = RunningServer(Path(folder), log_level="warning")
        print(f"server start to ready: {time.perf_counter() - start:.2f} s\n")
        try:
            until_settled(server)
            awaited(server, 20, 1)
            print(f"{'job through HTTP with Prefer: wait':<52}{'median ms':>10}{'p95 ms':>10}")
            alone, effort = spent(server, lambda: awaited(server, jobs, 1))
            row("exact, one client", alone.times)
            print(f"    {effort.each(jobs)}")
            row(
                "search over 1.4 million pairs, one client",
                [job_time(server.client, POSITIONS_ALONE) for _ in range(10)],
            )
            eight, effort = spent(server, lambda: awaited(server, 2 * jobs, 8))
            row("exact, eight clients", eight.times)
            print(f"\neight clients: {eight.rate:.0f} jobs/s, {effort.each(2 * jobs)}")
            analyses(server)
        finally:
            server.stop()
    bearing()


if __name__ == "__main__":
    main()
