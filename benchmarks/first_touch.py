"""How soon a server answers after its start, and how much memory it takes when idle.

    python -m benchmarks.first_touch [--runs 3] [--idle 20]

A real server is started on a free loopback port. The times run from the start of its process to the first answer of
``/healthz`` and to the announcement that it is ready. Then each kind of request is sent once, and its time runs from
the request to the last byte of the answer. *Cold* means that no document of the API is in the cache, so that the
server writes them; *warm* that an earlier start has written them. Kernels are compiled in either case. After some idle
seconds the resident memory of the processes is read: of the server, of one worker, and of all processes together, where
shared memory counts once. On a machine that is busy with other things the times say how busy; the processor time of
the server says what its start costs.
"""

from __future__ import annotations

import argparse
import os
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx

from synthesis.registry import get_first_example
from tests.support.service.running import REAL, STOP_S, until

GOALS = {
    "/healthz": 1.5,
    "ready": 3.0,
    "/v1/problems": 0.05,
    "/v1/problems/cam": 0.05,
    "/openapi.json": 0.05,
    "first drawing": 0.3,
    "first import": 2.0,
    "server, MB": 300.0,
    "worker, MB": 350.0,
}
DRAWING = b'<svg xmlns="http://www.w3.org/2000/svg"><path d="M 0 0 C 10 20 30 20 40 0"/></svg>'


@contextmanager
def started(folder: Path, cache: Path) -> Iterator[tuple[str, int, dict[str, float]]]:
    """Start a server and yield its address, its process id, and the times until it answered and was ready."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    kept = {name: value for name, value in os.environ.items() if not name.startswith("MECHSYNTH_")}
    settings = {"MECHSYNTH_PORT": str(port), "MECHSYNTH_DATA_DIR": str(folder), "MECHSYNTH_LOG_LEVEL": "warning"}
    announced = folder / "announced"
    began = time.monotonic()
    with announced.open("wb") as out:
        process = subprocess.Popen(
            [sys.executable, *REAL, "serve"], stdout=out, env={**kept, **settings, "XDG_CACHE_HOME": str(cache)}
        )
    try:
        url = f"http://127.0.0.1:{port}"
        until(lambda: _answers(url), 120.0, "an answer")
        alive_s = time.monotonic() - began
        until(lambda: b"ready" in announced.read_bytes(), 120.0, "readiness")
        times = {"/healthz": alive_s, "ready": time.monotonic() - began, "server until ready, CPU s": _cpu(process.pid)}
        yield url, process.pid, times
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait(STOP_S)


def measure(cache: Path, idle_s: float) -> dict[str, float]:
    """Return the figures of one start, seconds and megabytes."""
    with tempfile.TemporaryDirectory() as folder, started(Path(folder), cache) as (url, pid, figures):
        with httpx.Client(base_url=url, timeout=120.0) as client:
            for path in ("/v1/problems", "/v1/problems/cam", "/openapi.json"):
                figures[path] = _time(client, "GET", path)
            body = {"problem": get_first_example("gear_train")}
            job = client.post("/v1/jobs", json=body, headers={"Prefer": "wait=30"}).json()
            figures["first drawing"] = _time(client, "GET", f"/v1/jobs/{job['id']}/designs/0.svg")
            figures["first import"] = _time(client, "POST", "/v1/imports", content=DRAWING)
        # Memory is compared after background work has ended, as an idle server has it.
        time.sleep(idle_s)
        processes = {pid: "server", **_children(pid)}
        figures["server, MB"] = _memory(pid, "Rss")
        figures["worker, MB"] = max(_memory(each, "Rss") for each, name in processes.items() if name == "worker")
        figures["all processes, MB"] = sum(_memory(each, "Pss") for each in processes)
        return figures


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--idle", type=float, default=20.0, help="idle seconds before the memory is read")
    options = parser.parse_args()
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}; medians of {options.runs} (s, MB)")
    print(f"{'':26} {'goal':>8} {'cold':>8} {'warm':>8}")
    runs: dict[bool, list[dict[str, float]]] = {True: [], False: []}
    for _ in range(options.runs):
        with tempfile.TemporaryDirectory() as cache:
            for cold in (True, False):
                runs[cold].append(measure(Path(cache), options.idle))
    for name in runs[True][0]:
        cold, warm = (statistics.median(figures[name] for figures in runs[which]) for which in (True, False))
        goal = f"{GOALS[name]:g}" if name in GOALS else ""
        print(f"{name:26} {goal:>8} {cold:8.3f} {warm:8.3f}")
    print(f"load {os.getloadavg()[0]:.1f}")


def _answers(url: str) -> bool:
    try:
        return httpx.get(f"{url}/healthz", timeout=10.0).status_code == 200
    except httpx.TransportError:
        return False


def _time(client: httpx.Client, method: str, path: str, content: bytes | None = None) -> float:
    headers = {} if content is None else {"Content-Type": "image/svg+xml"}
    began = time.monotonic()
    answer = client.request(method, path, content=content, headers=headers)
    if answer.is_error:
        print(f"{method} {path}: {answer.status_code} {answer.text[:200]}", file=sys.stderr)
    return time.monotonic() - began


def _children(pid: int) -> dict[int, str]:
    """Return the processes below a server, by whether they are workers, of which the jobs are."""
    found: dict[int, str] = {}
    for child in Path(f"/proc/{pid}/task").glob("*/children"):
        for each in map(int, child.read_text().split()):
            command = Path(f"/proc/{each}/cmdline").read_text()
            found |= {each: "worker" if "spawn_main" in command else "other", **_children(each)}
    return found


def _cpu(pid: int) -> float:
    """Return the processor time of a process without its children, seconds."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _memory(pid: int, kind: str) -> float:
    """Return the resident (Rss) or the proportional (Pss) memory of a process, megabytes."""
    lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(f"{kind}:")) / 1e3


if __name__ == "__main__":
    main()
