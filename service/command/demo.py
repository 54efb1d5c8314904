"""``mechsynth demo``: submits one real problem to a real service, prints the verified answer and draws it."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from service.client import Client, ClientError, Job
from synthesis.model.json_object import JsonObject

START_TIMEOUT_S = 120.0
"""Time limit for the start, seconds; the very first start compiles the numerical kernels."""

STOP_TIMEOUT_S = 10.0
_POLL_S = 0.05
"""Period at which the file with the announcement of the service is read, seconds."""


class DemoFailure(Exception):
    """The demonstration failed; the message has the reason."""


def run_demo(output: Path) -> None:
    """Run the demonstration and write the drawing of the best design to ``output``.

    Raises
    ------
    DemoFailure
        If the service does not start, does not answer as documented, or finds no design.
    """
    with _start_service() as url, Client(url) as client:
        try:
            first, *_ = client.problems().values()
            job = client.solve(first["example"], label="demo")
            drawing = client.file(job.id, 0, "svg")
        except ClientError as error:
            raise DemoFailure(str(error)) from None
    if drawing is None:
        raise DemoFailure("the service found no design")
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_bytes(drawing)
    print(report(job))
    print(f"\nDrawing: {output}")


def report(job: Job) -> str:
    """Format the problem, the best design and its checks as text."""
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
        f"  {'transmission angle':<22} {metrics['min_transmission_angle']:10.4f}° minimum",
        "",
        "Targets reached (residuals relative to the size of the task, or in radians):",
    ]
    lines += [
        f"  target {t['index']}:  input angle {t['input_angle']:10.4f}°   residual {t['residual']:.1e}"
        for t in design["targets"]
    ]
    lines += ["", "Checks:"]
    lines += [f"  {_check(check)}" for check in design["verification"]["checks"]]
    return "\n".join(lines)


def _check(check: JsonObject) -> str:
    measured = "".join(f"   {key} {check[key]:.3g}" for key in ("value", "limit") if key in check)
    return f"{'passed' if check['passed'] else 'FAILED'}  {check['name']:<22}{measured}".rstrip()


@contextmanager
def _start_service() -> Iterator[str]:
    """Run a service for the demonstration and yield its URL."""
    Path("var").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="demo-", dir="var") as folder:
        environment = {
            **os.environ,
            "MECHSYNTH_HOST": "127.0.0.1",
            "MECHSYNTH_PORT": "0",
            "MECHSYNTH_DATA_DIR": folder,
            "MECHSYNTH_LOG_LEVEL": "warning",
            # One problem needs no more than one worker.
            "MECHSYNTH_WORKERS": "1",
            "MECHSYNTH_RESERVE": "0",
            "MECHSYNTH_COMPILE_AHEAD": "false",
        }
        # The demonstration must never write into the operator's store.
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
            # The service must not outlive the demonstration.
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()


def _wait_for_url(server: subprocess.Popen[bytes], announced: Path) -> str:
    deadline = time.monotonic() + START_TIMEOUT_S
    while time.monotonic() < deadline:
        # The port is chosen by the system, so only the announcement has it.
        words = announced.read_text().split()
        if words and words[-1].startswith("http"):
            return words[-1]
        if server.poll() is not None:
            raise DemoFailure(f"the service ended during its start with status {server.returncode}")
        time.sleep(_POLL_S)
    raise DemoFailure(f"the service was not ready after {START_TIMEOUT_S:g} s")
