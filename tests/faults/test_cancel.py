"""How long a cancelled job goes on computing, whatever it is in: measured from the request to the end of the attempt.

``MECHSYNTH_FAULT_RUNS`` says how often each (20).
"""

import os
import time

import pytest

from tests.support.service.running import REACHED_S, SCRIPTED, RunningServer, until
from tests.support.service.scripted_server import CONVEX, INSTANT, LAPACK, NATIVE, NUMBA, PYTHON

RUNS = int(os.environ.get("MECHSYNTH_FAULT_RUNS", "20"))
CANCELLED_S = 2.0
NINE_POINTS = {
    "kind": "path",
    "points": [
        {"x": x, "y": y} for x, y in zip([5, 9, 14, 18, 20, 19, 15, 9, 5], [2, 0, 1, 4, 8, 12, 14, 12, 7], strict=True)
    ],
}
COMPUTATIONS = {"python": PYTHON, "numba": NUMBA, "lapack": LAPACK, "convex solver": CONVEX, "held interpreter": NATIVE}

pytestmark = [pytest.mark.faults, pytest.mark.timeout(1500)]


@pytest.fixture(scope="module")
def scripted(tmp_path_factory):
    running = RunningServer(tmp_path_factory.mktemp("cancel"), SCRIPTED, workers=1, log_level="warning")
    yield running
    running.kill()


@pytest.fixture(scope="module")
def real(tmp_path_factory):
    running = RunningServer(tmp_path_factory.mktemp("real"), workers=1, reserve=0, log_level="warning")
    yield running
    running.kill()


def cancelled(server):
    """How many attempts have been ended by a cancel: their computations are over."""
    return counted(server, 'mechsynth_job_attempts_total{outcome="cancelled"}')


def counted(server, sample):
    lines = [line for line in server.client.get("/metrics").text.splitlines() if line.startswith(sample)]
    return float(lines[0].rpartition(" ")[2]) if lines else 0.0


def cancelled_after(server, job):
    """Seconds from the request to the end of the computation."""
    before, began = cancelled(server), time.monotonic()
    assert server.client.delete(f"/v1/jobs/{job['id']}").json()["status"] == "cancelled"
    until(lambda: cancelled(server) > before, REACHED_S, "the end of the computation")
    return time.monotonic() - began


@pytest.mark.parametrize("seed", COMPUTATIONS.values(), ids=COMPUTATIONS)
def test_whatever_it_computes(scripted, seed):
    took, name = [], {number: name for name, number in COMPUTATIONS.items()}[seed]
    begun = scripted.folder / "begun"
    for _ in range(RUNS):
        begun.unlink(missing_ok=True)
        job = scripted.post(seed)
        if seed == NATIVE:
            scripted.reaches(job["id"], "running")
        else:
            until(begun.exists, REACHED_S, "the computation")
        time.sleep(0.1)  # well inside of it
        took.append(cancelled_after(scripted, job))
        scripted.reaches(scripted.post(INSTANT)["id"], "succeeded")
    print(f"\n{name}: {RUNS} jobs cancelled, {max(took):.2f} s at most; the next job was done each time")
    assert max(took) <= CANCELLED_S


def test_a_nine_point_search(real):
    """It reports its progress, so that its worker need not be killed."""
    took, (worker,) = [], real.workers()
    for _ in range(RUNS):
        job = real.post(problem=NINE_POINTS)
        until(lambda job=job: 0.0 < real.job(job["id"])["progress"]["fraction"] < 0.9, REACHED_S, "progress")
        took.append(cancelled_after(real, job))
    print(f"\nnine points: {RUNS} searches cancelled, {max(took):.2f} s at most")
    assert max(took) <= CANCELLED_S
    assert real.workers() == [worker]
    real.reaches(real.post()["id"], "succeeded")
