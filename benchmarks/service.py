"""The service as one client meets it: how long a small job takes through HTTP, and how soon the service is ready.

    python -m benchmarks.service [--jobs 200]

A real server is started on a free loopback port. The jobs are Norton's Problem 5-26, solved and verified, stated
with ``Prefer: wait``; the time runs from the request to the parsed answer. Then the same over eight clients, and
analyses of given mechanisms in 360 steps. A second server shows what it bears: reads of one job over four connections,
a thousand queued jobs worked off, two hundred listeners, a flood of five times its queue, and every hostile body of the
tests.
"""

from __future__ import annotations

import argparse
import asyncio
import http.client
import os
import signal
import statistics
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx

from synthesis.kinds import KINDS
from tests.service import hostile, test_hostile_bodies
from tests.service.running import RunningServer, alive, until

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


FOURBAR = {
    "type": "fourbar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
}
SLIDER_CRANK = {
    "type": "slider_crank",
    "fixed_pivot": [0.0, 0.0],
    "links": {"crank": 1.4, "coupler": 4.0},
    "slide": {"point": [0.0, 1.0], "angle": 0.0},
}
GEARED_FIVEBAR = {
    "type": "geared_fivebar",
    "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
    "links": {"input": 1.0, "coupler_1": 7.0, "coupler_2": 9.0, "output": 4.0},
    "gear_ratio": 2.0,
    "phase": 30.0,
}
STEPHENSON_2 = {
    "type": "stephenson_2",
    "skeleton": {
        "joints": {
            "O2": [0.0, 0.0], "O4": [4.0, 0.0], "A": [0.3, 1.0], "C": [0.8, 0.6],
            "B": [1.5, 3.0], "D": [3.0, 2.2], "E": [4.2, 2.0],
        },
        "links": [
            {"name": "ground", "joints": ["O2", "O4"]},
            {"name": "input", "joints": ["O2", "A", "C"]},
            {"name": "link_3", "joints": ["A", "B"]},
            {"name": "link_4", "joints": ["B", "D", "E"]},
            {"name": "link_5", "joints": ["C", "D"]},
            {"name": "output", "joints": ["O4", "E"]},
        ],
        "input_link": "input",
    },
}  # fmt: skip


def analysis_time(client: httpx.Client, mechanism: dict[str, object]) -> float:
    start = time.perf_counter()
    answer = client.post("/v1/analyses", json={"mechanism": mechanism, "motion": {"steps": 360}})
    answer.json()
    elapsed = time.perf_counter() - start
    assert answer.status_code == 200
    return elapsed


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


QUEUE = 1000
LISTENERS = 200


def read_rate(server: RunningServer, job_id: str, reads: int = 2000, connections: int = 4) -> tuple[float, float]:
    """Reads of a job by the second, and by the second of the server's processor time; a plain client."""

    def read(count: int) -> None:
        connection = http.client.HTTPConnection(server.url.removeprefix("http://"))
        for _ in range(count):
            connection.request("GET", f"/v1/jobs/{job_id}")
            answer = connection.getresponse()
            assert answer.status == 200
            answer.read()
        connection.close()

    start, start_of_processor = time.perf_counter(), processor_s(server.process.pid)
    with ThreadPoolExecutor(connections) as pool:
        list(pool.map(read, [reads // connections] * connections))
    return reads / (time.perf_counter() - start), reads / (processor_s(server.process.pid) - start_of_processor)


def processor_s(pid: int) -> float:
    times = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13]
    return sum(map(int, times)) / os.sysconf("SC_CLK_TCK")


def fill(server: RunningServer, jobs: int) -> list[int]:
    """The statuses of so many jobs posted over four connections."""

    def post(count: int) -> list[int]:
        with httpx.Client(base_url=server.url, timeout=60.0) as client:
            return [client.post("/v1/jobs", json={"problem": PROBLEM_5_26}).status_code for _ in range(count)]

    with ThreadPoolExecutor(4) as pool:
        return [status for statuses in pool.map(post, [jobs // 4] * 4) for status in statuses]


def unfinished(server: RunningServer) -> int:
    lines = server.client.get("/metrics").text.splitlines()
    return sum(int(float(line.split()[-1])) for line in lines if line.startswith("mechsynth_jobs_unfinished{"))


def suspend(server: RunningServer, signal_: signal.Signals) -> None:
    for pid in server.workers():
        os.kill(pid, signal_)


def drain_rate(server: RunningServer) -> float:
    """Jobs by the second of a queue that was filled while the workers were suspended."""
    suspend(server, signal.SIGSTOP)
    assert set(fill(server, QUEUE)) == {202}
    waiting = unfinished(server)
    start = time.perf_counter()
    suspend(server, signal.SIGCONT)
    until(lambda: unfinished(server) == 0, 120.0)
    return waiting / (time.perf_counter() - start)


def listeners(server: RunningServer) -> tuple[int, float]:
    """How many of the listeners to one job see exactly one end, and the seconds from the end to the last of them."""

    async def follow(client: httpx.AsyncClient, job_id: str, begun: list[int]) -> tuple[int, float]:
        text = ""
        async with client.stream("GET", f"/v1/jobs/{job_id}/events") as stream:
            async for chunk in stream.aiter_text():
                if not text:
                    begun.append(1)
                    if len(begun) == LISTENERS:
                        suspend(server, signal.SIGCONT)
                text += chunk
        return text.count('"status":"succeeded"'), time.perf_counter()

    async def all_of_them() -> tuple[int, float]:
        limits = httpx.Limits(max_connections=LISTENERS)
        async with httpx.AsyncClient(base_url=server.url, timeout=60.0, limits=limits) as client:
            begun: list[int] = []
            seen = await asyncio.gather(*(follow(client, job["id"], begun) for _ in range(LISTENERS)))
        ends = [end for _, end in seen]
        return sum(count == 1 for count, _ in seen), max(ends) - min(ends)

    suspend(server, signal.SIGSTOP)
    job = server.post(problem=PROBLEM_5_26)
    return asyncio.run(all_of_them())


def flood(server: RunningServer) -> tuple[int, float]:
    """Refusals of a flood of five times the queue, and the growth of the server's memory by it, MB."""
    suspend(server, signal.SIGSTOP)
    before = resident_mb(server.process.pid)
    statuses = fill(server, 5 * QUEUE)
    assert set(statuses) == {202, 503}
    suspend(server, signal.SIGCONT)
    until(lambda: unfinished(server) == 0, 120.0)
    return statuses.count(503), resident_mb(server.process.pid) - before


def resident_mb(pid: int) -> float:
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def hostile_times(server: RunningServer) -> list[tuple[float, str]]:
    """Seconds to each refusal, with the body's name; every answer must be a 4xx problem."""
    bodies = {name: body for name, (body, _) in test_hostile_bodies.INVALID.items()}
    bodies |= test_hostile_bodies.MALFORMED | test_hostile_bodies.ENORMOUS
    for kind in KINDS:
        bodies |= dict(hostile.of_kind(kind))
    times = []
    for name, body in bodies.items():
        start = time.perf_counter()
        answer = server.client.post("/v1/jobs", content=body, headers={"Content-Type": "application/json"})
        times.append((time.perf_counter() - start, name))
        assert 400 <= answer.status_code < 500, name
        assert answer.headers["content-type"] == "application/problem+json", name
    return sorted(times)


def bearing() -> None:
    """What a server bears, and the end of its workers when it is killed."""
    with tempfile.TemporaryDirectory() as folder:
        server = RunningServer(Path(folder), log_level="warning", max_queued=QUEUE)
        try:
            job = server.post(problem=PROBLEM_5_26, wait=20)
            read_rate(server, job["id"], 200)
            rate, by_processor = read_rate(server, job["id"])
            print(
                f"\nGET of a job, four connections: {rate:.0f}/s, {by_processor:.0f} by the server's processor second"
            )
            print(f"queue of {QUEUE} drained: {drain_rate(server):.0f} jobs/s")
            seen, spread = listeners(server)
            print(f"listeners that saw exactly one end: {seen} of {LISTENERS}, all within {1e3 * spread:.0f} ms")
            refusals, growth = flood(server)
            print(f"flood of {5 * QUEUE} jobs: {refusals} refused, memory grew by {growth:.0f} MB")
            times = hostile_times(server)
            median, (worst, name) = times[len(times) // 2][0], times[-1]
            print(
                f"hostile bodies refused: {len(times)}, median {1e3 * median:.1f} ms, "
                f"worst {1e3 * worst:.0f} ms ({name}), {sum(t > 0.2 for t, _ in times)} above 200 ms"
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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("--jobs", type=int, default=200)
    jobs = parser.parse_args().jobs
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        server = RunningServer(Path(folder), log_level="warning")
        print(f"server start to ready: {time.perf_counter() - start:.2f} s\n")
        try:
            for _ in range(20):
                job_time(server.client, PROBLEM_5_26)
            print(f"{'job through HTTP with Prefer: wait':<52}{'median ms':>10}{'p95 ms':>10}")
            row("exact, one client", [job_time(server.client, PROBLEM_5_26) for _ in range(jobs)])
            row(
                "search over 1.4 million pairs, one client",
                [job_time(server.client, POSITIONS_ALONE) for _ in range(10)],
            )
            clients = [httpx.Client(base_url=server.url, timeout=60.0) for _ in range(8)]
            start = time.perf_counter()
            with ThreadPoolExecutor(len(clients)) as pool:
                times = list(pool.map(lambda k: job_time(clients[k % 8], PROBLEM_5_26), range(2 * jobs)))
            row("exact, eight clients", times)
            print(f"\neight clients: {2 * jobs / (time.perf_counter() - start):.0f} jobs/s")
            for client in clients:
                client.close()
            print(f"\n{'analysis of 360 steps through HTTP':<52}{'median ms':>10}{'p95 ms':>10}")
            for name, mechanism in (
                ("fourbar", FOURBAR),
                ("slider-crank", SLIDER_CRANK),
                ("geared fivebar, ratio 2", GEARED_FIVEBAR),
                ("Stephenson II sixbar, class III", STEPHENSON_2),
            ):
                analysis_time(server.client, mechanism)
                row(name, [analysis_time(server.client, mechanism) for _ in range(40)])
        finally:
            server.stop()
    bearing()


if __name__ == "__main__":
    main()
