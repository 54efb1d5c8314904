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

from service.client import Client, ClientError, Job

START_TIMEOUT_S = 120.0
"""The very first start compiles the numeric kernels."""

STOP_TIMEOUT_S = 10.0
_POLL_S = 0.05
"""Period at which the file is read into which the service announces itself; a file tells nobody."""


class DemoFailure(Exception):
    """The demonstration did not come to its end; the message says where."""


def run_demo(output: Path) -> None:
    """Run the demonstration and write the drawing of the best design to ``output``.

    Raises
    ------
    DemoFailure
        When the service does not start, does not answer as documented, or finds no design.
    """
    with _start_service() as url, Client(url) as client:
        try:
            first, *_ = client.problems().values()
            job = client.solve(first["example"], label="demo")
            drawing = client.file(job.id, 0, "svg")
        except ClientError as error:
            raise DemoFailure(str(error)) from None
    if drawing is None:
        raise DemoFailure("no design was found")
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_bytes(drawing)
    print(report(job))
    print(f"\nDrawing: {output}")


def report(job: Job) -> str:
    """The problem, the best design and its checks as a text for people."""
    assert job.result is not None
    problem, result = job.problem, job.result
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
def _start_service() -> Iterator[str]:
    """A service of the demonstration's own; gives its URL."""
    Path("var").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="demo-", dir="var") as folder:
        environment = {
            **os.environ,
            "MECHSYNTH_HOST": "127.0.0.1",
            "MECHSYNTH_PORT": "0",
            "MECHSYNTH_DATA_DIR": folder,
            "MECHSYNTH_LOG_LEVEL": "warning",
            # It solves one problem and ends.
            "MECHSYNTH_WORKERS": "1",
            "MECHSYNTH_RESERVE": "0",
            "MECHSYNTH_COMPILE_AHEAD": "false",
        }
        environment.pop("MECHSYNTH_DATABASE_URL", None)
        announced = Path(folder) / "announced"
        with announced.open("wb") as stdout:
            server = subprocess.Popen(
                [sys.executable, "-m", "service.command.cli", "serve"], env=environment, stdout=stdout
            )
        try:
            yield _wait_for_url(server, announced)
        finally:
            server.terminate()
            try:
                server.wait(STOP_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()


def _wait_for_url(server: subprocess.Popen[bytes], announced: Path) -> str:
    deadline = time.monotonic() + START_TIMEOUT_S
    while time.monotonic() < deadline:
        words = announced.read_text().split()
        if words and words[-1].startswith("http"):
            return words[-1]
        if server.poll() is not None:
            raise DemoFailure(f"the service ended at its start with status {server.returncode}")
        time.sleep(_POLL_S)
    raise DemoFailure(f"the service was not ready after {START_TIMEOUT_S:g} s")
