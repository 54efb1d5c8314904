"""The service as one client meets it: how long a small job takes through HTTP, and how soon the service is ready.

    python -m benchmarks.service [--jobs 200]

A real server is started on a free loopback port. The jobs are Norton's Problem 5-26, solved and verified, stated
with ``Prefer: wait``; the time runs from the request to the parsed answer. Then the same over eight clients, and
analyses of given mechanisms in 360 steps.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx

from tests.service.running import RunningServer

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


if __name__ == "__main__":
    main()
