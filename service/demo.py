"""One real problem through the real service: states it over HTTP, prints the verified answer, draws it."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx

START_TIMEOUT_S = 120.0
"""The very first start compiles the numeric kernels."""

STOP_TIMEOUT_S = 10.0
_POLL_S = 0.05


class DemoFailure(Exception):
    """The demonstration did not come to its end; the message says where."""


def demo(output: Path) -> None:
    """Run the demonstration and write the drawing of the best design to ``output``.

    Raises
    ------
    DemoFailure
        When the service does not start, does not answer as documented, or finds no design.
    """
    with _service() as url, httpx.Client(base_url=url, timeout=60.0) as client:
        problem = _example(client, "motion")
        answer = client.post("/v1/jobs", json={"problem": problem, "label": "demo"}, headers={"Prefer": "wait=10"})
        if answer.status_code != 200:
            raise DemoFailure(f"the job was not finished in time: {answer.status_code} {answer.text[:500]}")
        job = answer.json()
        if job["status"] != "succeeded" or not job["result"]["designs"]:
            raise DemoFailure(f"no design: {job['status']}, {job['error'] or job['result']['summary']}")
        drawing = client.get(f"/v1/jobs/{job['id']}/designs/0.svg")
        if drawing.status_code != 200:
            raise DemoFailure(f"no drawing: {drawing.status_code} {drawing.text[:500]}")
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_bytes(drawing.content)
    print(report(job))
    print(f"\nDrawing: {output}")


def _example(client: httpx.Client, kind: str) -> Any:
    """The example that the service gives for a kind of problem."""
    answer = client.get("/v1/problems")
    if answer.status_code != 200:
        raise DemoFailure(f"no list of problems: {answer.status_code} {answer.text[:500]}")
    return next(listed["example"] for listed in answer.json()["problems"] if listed["kind"] == kind)


def report(job: dict[str, Any]) -> str:
    """The problem, the best design and its checks as a text for people."""
    problem, result = job["problem"], job["result"]
    unit = problem["length_unit"]
    design = result["designs"][0]
    mechanism, metrics = design["mechanism"], design["metrics"]
    pivots, point = mechanism["fixed_pivots"], mechanism["coupler_point"]
    lines = ["Problem: carry a body through"]
    lines += [
        f"  position {k}:  x {p['x']:8.3f} {unit}   y {p['y']:8.3f} {unit}   angle {p['angle']:8.3f}°"
        for k, p in enumerate(problem["positions"])
    ]
    lines += ["", result["summary"], "", f"Best design: {mechanism['type']}, {mechanism['assembly']}"]
    for side in ("input", "output"):
        x, y = pivots[side]
        lines.append(f"  {'fixed pivot, ' + side:<22} {x:10.4f} {unit}, {y:.4f} {unit}")
    lines += [f"  {name + ' link':<22} {length:10.4f} {unit}" for name, length in mechanism["links"].items()]
    lines += [
        f"  {'coupler point':<22} {point['distance']:10.4f} {unit} at {point['angle']:.4f}° from the coupler",
        f"  {'reference input angle':<22} {mechanism['reference_input_angle']:10.4f}°",
        f"  {'class':<26} {metrics['grashof']} ({metrics['barker']})",
        f"  {'transmission angle':<22} {metrics['min_transmission_angle']:10.4f}° at least",
        "",
        "Reached when driven (residuals are shares of the task's size, or radians):",
    ]
    lines += [
        f"  target {t['index']}:  input angle {t['input_angle']:10.4f}°   residual {t['residual']:.1e}"
        for t in design["targets"]
    ]
    lines += ["", "Checks:"]
    lines += [f"  {_check(check)}" for check in design["verification"]["checks"]]
    return "\n".join(lines)


def _check(check: dict[str, Any]) -> str:
    measured = "".join(f"   {key} {check[key]:.3g}" for key in ("value", "limit") if key in check)
    return f"{'passed' if check['passed'] else 'FAILED'}  {check['name']:<22}{measured}".rstrip()


@contextmanager
def _service() -> Iterator[str]:
    """A service of the demonstration's own; gives its URL."""
    Path("var").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="demo-", dir="var") as folder:
        environment = {
            **os.environ,
            "MECHSYNTH_HOST": "127.0.0.1",
            "MECHSYNTH_PORT": "0",
            "MECHSYNTH_DATA_DIR": folder,
            "MECHSYNTH_LOG_LEVEL": "warning",
        }
        environment.pop("MECHSYNTH_DATABASE_URL", None)
        announced = Path(folder) / "announced"
        with announced.open("wb") as stdout:
            server = subprocess.Popen([sys.executable, "-m", "service.cli", "serve"], env=environment, stdout=stdout)
        try:
            url = _announced_url(server, announced)
            _await_ready(url)
            yield url
        finally:
            server.terminate()
            try:
                server.wait(STOP_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()


def _announced_url(server: subprocess.Popen[bytes], announced: Path) -> str:
    deadline = time.monotonic() + START_TIMEOUT_S
    while time.monotonic() < deadline:
        words = announced.read_text().split()
        if words and words[-1].startswith("http"):
            return words[-1]
        if server.poll() is not None:
            raise DemoFailure(f"the service ended at its start with status {server.returncode}")
        time.sleep(_POLL_S)
    raise DemoFailure(f"the service was not ready after {START_TIMEOUT_S:g} s")


def _await_ready(url: str) -> None:
    try:
        answer = httpx.get(f"{url}/readyz")
    except httpx.TransportError as error:
        raise DemoFailure(f"the service does not answer: {error}") from None
    if answer.status_code != 200:
        raise DemoFailure(f"the service is not ready: {answer.text}")
