"""How soon a plain analysis is answered while four tenants post the heaviest ones that there are.

    python -m benchmarks.heavy_neighbours [--seconds 30] [--tenants 4]

A server with keys is started on a free loopback port. Each of the tenants posts heavy analyses over two connections,
one after the other: ten thousand positions of a class III linkage, a camshaft of 24 cams with a thousand points each, a
cutter's path that no tolerance ends, a layout over fifty turns of gears. A fifth tenant asks for a fourbar in 360 steps
all the while. The goal is an answer within a second on a quiet machine; the load stands beside the figures.
"""

from __future__ import annotations

import argparse
import math
import os
import statistics
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx

from synthesis.analyses.cams.cam import EXAMPLE
from tests.support.problems.fuzz_bodies import LAYOUT
from tests.support.problems.given_mechanisms import STATED
from tests.support.service.access import made
from tests.support.service.running import RunningServer

POINTS = 1000
"""Of a heavy cam's profile."""

PLAIN = {"mechanism": STATED["fourbar, crank"]}


def _cam(n: int) -> dict[str, Any]:
    turn = [2.0 * math.pi * k / POINTS for k in range(POINTS)]
    radius = 30.0 + 1e-3 * n
    profile = {"x": [5.0 + radius * math.cos(t) for t in turn], "y": [radius * math.sin(t) for t in turn]}
    return {**EXAMPLE, "profile": profile}


def _long_motion(n: int) -> dict[str, Any]:
    mechanism = next(one for name, one in STATED.items() if "stephenson_2" in name.lower() or "II" in name)
    return {"mechanism": mechanism, "motion": {"from": 0.0, "to": 360.0 + 1e-3 * n, "steps": 9_999}, "dynamics": {}}


def _camshaft(n: int) -> dict[str, Any]:
    cams = [
        {"cam": _cam(n), "load": {"mass": 0.5, "spring_rate": 4.0, "preload": 30.0}, "phase": 15.0 * k}
        for k in range(9)
    ]
    return {"mechanism": {"type": "camshaft", "cams": cams}, "motion": {"steps": 72, "speed_rpm": 60.0}}


def _cutter(n: int) -> dict[str, Any]:
    return {"mechanism": _cam(n), "cutter": {"radius": 12.0, "chordal_tolerance": 1e-9}}


def _geared_layout(n: int) -> dict[str, Any]:
    geared = next(one for one in STATED.values() if one["type"] == "geared_fivebar")
    return {"mechanism": {**geared, "gear_ratio": 2.02 + 1e-6 * n}, "layout": {**LAYOUT, "over": "cycle"}}


HEAVY: tuple[Callable[[int], dict[str, Any]], ...] = (_long_motion, _camshaft, _cutter, _geared_layout)


def run(seconds: float, tenants: int, folder: Path) -> None:
    """Measure, and print the figures."""
    keys = [made(folder, f"tenant-{n}") for n in range(tenants + 1)]
    server = RunningServer(folder, workers=1, reserve=0, rate_limit="off", log_level="warning")
    try:
        with _client(server, keys[-1]) as client:
            for make in HEAVY:
                began = time.monotonic()
                answer = client.post("/v1/analyses", json=make(-1))
                print(f"{make.__name__:16s}{answer.status_code}  {len(answer.content):9d} bytes  "
                      f"{time.monotonic() - began:.2f} s alone")  # fmt: skip
            quiet = [_time(client, n)[1] for n in range(20)]
            print(f"alone: median {statistics.median(quiet):.3f} s")
            statuses: Counter[int] = Counter()
            ended = threading.Event()
            threads = [
                threading.Thread(target=_flood, args=(server, key, 1000 * n + 500 * k, ended, statuses), daemon=True)
                for n, key in enumerate(keys[:-1])
                for k in range(2)
            ]
            for thread in threads:
                thread.start()
            time.sleep(2.0)  # all of them are at it
            until, answered = time.monotonic() + seconds, Counter[int]()
            times: list[float] = []
            while time.monotonic() < until:
                status, took = _time(client, 1000 + len(times))
                answered[status] += 1
                times.append(took)
                time.sleep(0.1)
            ended.set()
            times.sort()
            print(f"beside {tenants} tenants: {len(times)} plain analyses {dict(answered)}, median "
                  f"{statistics.median(times):.3f} s, 95 of 100 within {times[int(0.95 * len(times))]:.3f} s, "
                  f"longest {times[-1]:.3f} s; heavy ones {dict(statuses)}; load {os.getloadavg()[0]:.1f}")  # fmt: skip
            for thread in threads:
                thread.join(60.0)
    finally:
        server.stop()


def _client(server: RunningServer, key: str) -> httpx.Client:
    return httpx.Client(base_url=server.url, headers={"Authorization": f"Bearer {key}"}, timeout=60.0)


def _time(client: httpx.Client, n: int) -> tuple[int, float]:
    began = time.monotonic()
    answer = client.post("/v1/analyses", json={**PLAIN, "motion": {"from": 0.0, "to": 360.0 + 1e-6 * n, "steps": 360}})
    return answer.status_code, time.monotonic() - began


def _flood(server: RunningServer, key: str, first: int, ended: threading.Event, statuses: Counter[int]) -> None:
    with _client(server, key) as client:
        n = first
        while not ended.is_set():
            statuses[client.post("/v1/analyses", json=HEAVY[n % len(HEAVY)](n)).status_code] += 1
            n += 1


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--tenants", type=int, default=4)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        run(asked.seconds, asked.tenants, Path(folder))


if __name__ == "__main__":
    main()
