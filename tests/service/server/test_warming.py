"""Kernels that are not compiled yet: who compiles them, who waits for them, and what is said of it."""

import os
import subprocess
import sys
import threading
import time

import pytest
from numba import njit

from kinematics.kernel_marks import is_compiled
from kinematics.message import compose
from service.jobs.processes.stop_flag import Solving
from service.jobs.workers.compile_watch import COMPILING_ID, FirstUse
from service.kernels import KernelsState, Progress
from service.server.precompile import list_parts
from synthesis.registry import KINDS
from tests.support.service.running import ROOT, RunningServer, alive, until, workers_of

PROGRAM = """
from service.server.precompile import Compilation

if __name__ == "__main__":
    compilation = Compilation(lambda: ["gearbox", "no such part"], "warning", "text", ahead=True)
    compilation.run()
    print(compilation.missing, compilation.state.progress, compilation.state.has("gearbox"))
"""


def quick(x):
    return x + 1.0


def slow(x):
    total = 0.0
    for k in range(1000):
        total += x**k
    return total


@pytest.fixture
def heard():
    return []


def test_a_job_that_compiles_says_so_and_goes_on_with_what_it_said(heard):
    with FirstUse(Solving()).watch_progress(lambda fraction, message: heard.append((fraction, message))) as progress:
        progress(0.3, "searching")
        assert njit(quick)(1.0) == 2.0
        progress(0.6, "verifying")
    assert heard == [(0.3, "searching"), (0.3, compose(COMPILING_ID)), (0.3, "searching"), (0.6, "verifying")]


def test_what_is_compiled_inside_a_kernel_is_said_once_and_of_no_other_thread(heard):
    inner = njit(quick)
    outer = njit(lambda x: inner(x) + 1.0)
    with FirstUse(Solving()).watch_progress(lambda fraction, message: heard.append(message)):
        other = threading.Thread(target=lambda: njit(quick)(2.0))
        other.start()
        other.join()
        assert heard == []
        outer(1.0)
    njit(quick)(1.0)
    assert heard == [compose(COMPILING_ID)]


def test_compilation_is_not_the_solvers_time():
    solving = Solving()
    during = []
    with (
        solving.track_work(),
        FirstUse(solving).watch_progress(lambda fraction, message: during.append(solving.seconds)),
    ):
        time.sleep(0.05)
        before = solving.seconds
        began = time.monotonic()
        njit(slow)(1.0)
        compiling = time.monotonic() - began
        after = solving.seconds
    assert during == [0.0]
    assert before <= after < before + compiling


def test_what_is_compiled_is_known_once_somebody_has_looked():
    state = KernelsState()
    assert state.progress is None
    assert not state.has("analysis")
    state.look(3, ["analysis", "path"])
    assert state.progress == Progress(compiled=1, total=3)
    assert state.has("dwell")
    assert not state.has("analysis")
    state.note_compiled("analysis")
    assert state.progress == Progress(compiled=2, total=3)
    assert state.has("analysis")
    assert not state.has("path")
    assert not state.is_ended
    state.note_end()
    assert state.is_ended
    assert not state.has("path")


@pytest.mark.campaign
def test_what_cannot_be_compiled_keeps_nothing_else_from_it(tmp_path):
    script = tmp_path / "program.py"
    script.write_text(PROGRAM)
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "kernels"), "PYTHONPATH": str(ROOT)}
    ended = subprocess.run([sys.executable, script], env=environment, capture_output=True, text=True, check=True)
    assert "['no such part'] Progress(compiled=1, total=2) True" in ended.stdout
    assert "KeyError: 'no such part'" in ended.stdout + ended.stderr


def test_a_server_says_how_many_parts_are_compiled(server):
    kernels = until(lambda: server.client.get("/readyz").json()["kernels"], 30.0)
    assert kernels["total"] == len(KINDS) + 3
    assert kernels["compiled"] == sum(is_compiled(part) for part in list_parts())


@pytest.mark.campaign
@pytest.mark.timeout(600)
def test_a_first_start_takes_jobs_while_it_compiles_and_stops_in_good_order(tmp_path, monkeypatch):
    """A cache of kernels of its own, which is empty."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kernels"))
    running = RunningServer(tmp_path, workers=1, reserve=0, compile_ahead="true")
    try:
        client = running.client
        kernels = until(lambda: client.get("/readyz").json()["kernels"], 60.0)
        assert kernels["compiled"] < kernels["total"] == len(KINDS) + 3
        stated = next(kind for kind in client.get("/v1/problems").json()["problems"] if kind["kind"] == "gear_train")
        job = client.post("/v1/jobs", json={"problem": stated["example"]}).json()
        messages = set()

        def ended():
            shown = client.get(f"/v1/jobs/{job['id']}").json()
            messages.add(shown["progress"]["message"])
            return shown if shown["status"] in ("succeeded", "failed") else None

        assert until(ended, 300.0)["status"] == "succeeded"
        assert compose(COMPILING_ID) in messages
        assert "compiling kernels in the background" in running.log_path.read_text()
        children = workers_of(running.process.pid)
        assert len(children) > 1
    finally:
        running.stop()
    assert not [pid for pid in children if alive(pid)]
