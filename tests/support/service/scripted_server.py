"""The service with a solver that does what a problem's seed says. Run like ``mechsynth``.

The worker processes import the main module of the server again, so this script is in force in them too.
"""

import ctypes
import faulthandler
import os
import signal
import sys
import threading
import time
from pathlib import Path

from service import warm_analysis
from service.command.cli import main
from synthesis.model.answer import Result, Search

INSTANT, NATIVE, GREEDY, BROKEN, DIES_ONCE, GATED, STEPS, PYTHON, NUMBA, LAPACK, CONVEX = range(100, 111)
BRIEF, TOLD = 10_000, 20_000
"""From these seeds on a job takes 20 ms; or until the store has its progress."""

faulthandler.register(signal.SIGUSR1)

progress_is_stored = threading.Event()

FOLDER = Path(os.environ.get("SCRIPTED_FOLDER", "."))


def solve(problem, progress):
    match problem.seed:
        case 101:  # native code that holds the interpreter: no Python handler can run
            ctypes.PyDLL(None).sleep(60)  # longer than any test waits; it is killed before
        case 102:
            import numpy as np

            hoard = []
            while True:
                hoard.append(np.empty(16 << 17))  # reserved, and not written to, which would take its time
        case 103:
            raise ValueError("a secret of the implementation")
        case 104:
            mark = FOLDER / "died"
            if not mark.exists():
                mark.touch()
                os.kill(os.getpid(), signal.SIGKILL)
        case 105:
            progress(0.0, "begun")
            progress(0.1, "waiting")
            while not (FOLDER / "open").exists():
                time.sleep(0.01)  # a file tells nobody that it is there
        case 106:
            while not (FOLDER / "open").exists():
                time.sleep(0.01)  # the same, but that it reports
                progress(0.25, "a quarter")
        case 107:
            begin()
            while True:
                pass
        case 108:
            spin = compiled_loop()
            begin()
            spin(1 << 62)
        case 109:
            import numpy as np

            matrix = np.random.default_rng(0).normal(size=(3000, 3000))
            begin()
            while True:
                np.linalg.svd(matrix)
        case 110:
            programme = large_programme()
            begin()
            programme.solve(solver="CLARABEL")
        case seed if seed >= TOLD:
            progress_is_stored.clear()
            progress(0.5, "half")
            progress_is_stored.wait()
        case seed if seed >= BRIEF:
            time.sleep(0.02)  # so long does the computation take
    search = Search(method="scripted", complete=True, candidates=0, accepted=0, rejected={}, seed=problem.seed)
    return Result(designs=[], search=search, summary="scripted")


def begin():
    """Say that the computation proper begins now."""
    (FOLDER / "begun").touch()


def compiled_loop():
    import numba
    import numpy as np

    @numba.njit
    def spin(n):
        total = 0.0
        for k in range(n):
            total += np.sin(k)
        return total

    spin(1)
    return spin


def large_programme():
    import cvxpy as cp
    import numpy as np

    rng = np.random.default_rng(0)
    x = cp.Variable(1500)
    rows = rng.normal(size=(3000, 1500))
    return cp.Problem(cp.Minimize(cp.sum_squares(rows @ x - 1) + cp.norm1(x)), [cp.norm2(x) <= 1, x >= -1])


def warm_up():
    if (FOLDER / "cannot-start").exists():
        raise RuntimeError("told not to start")


def crash_points():
    """Let the process die before or after a write to the store is committed, when a file says so."""
    from service.jobs.batches.store import BatchStore
    from service.jobs.job_store import JobStore

    def deadly(name, store=JobStore, called=""):
        write = getattr(store, name)

        def wrapped(self, *args, **kwargs):
            die_if_told(f"crash-before-{called}{name}")
            written = write(self, *args, **kwargs)
            if written is not None:  # a lane that asks and gets nothing has written nothing
                die_if_told(f"crash-after-{called}{name}")
            if name == "record_progress":
                progress_is_stored.set()
            return written

        setattr(store, name, wrapped)

    for name in (
        "create", "create_once", "take", "record_progress", "complete", "fail", "give_up", "cancel", "delete",
        "requeue",
        "requeue_unfinished", "record_crash",
    ):  # fmt: skip
        deadly(name)
    for name in ("create", "start_batch", "store", "record_crash", "give_up", "cancel"):
        deadly(name, BatchStore, "batch-")


def die_if_told(name):
    try:
        (FOLDER / name).unlink()
    except FileNotFoundError:
        return
    os.kill(os.getpid(), signal.SIGKILL)


# The tests import this module for its names only; the server runs it as __main__, its workers as __mp_main__.
if __name__ in ("__main__", "__mp_main__"):
    warm_analysis.warm_up = lambda: None
    crash_points()
if __name__ == "__mp_main__":
    from synthesis import dispatch  # in workers only: a server does not import solvers

    dispatch.solve = solve
    dispatch.warm_up = warm_up
    dispatch.warm_up_rest = lambda: None
if __name__ == "__mp_main__" and (FOLDER / "slow-start").exists():
    time.sleep(60)  # it is killed before


def break_lanes():
    """Let the server fail once where nothing foresees it, or take long jobs for short, when a file says so."""
    from pebble import ProcessPool
    from pebble.pool.base_pool import PoolStatus

    from service.jobs.workers import lane, worker

    call, get_context, schedule = lane.Lane._call, lane.get_context, ProcessPool.schedule
    check_stay = lane.Lane._check_stay

    def told(name):
        (FOLDER / name).unlink()
        return True

    def broken_call(self, function, *args, job=None):
        if job is not None and (FOLDER / "lane-fault").exists() and told("lane-fault"):
            raise TypeError("a defect of the lane")
        return call(self, function, *args, job=job)

    def broken_context(method):
        if (FOLDER / "no-process").exists() and told("no-process"):
            raise OSError("no process is to be had")
        return get_context(method)

    def late_schedule(pool, function, args=()):
        """The worker dies, and pebble finds it dead, between pebble's look at it and the taking of a call."""
        if function is worker.run and (FOLDER / "late-call").exists() and told("late-call"):
            (pid,) = pool._pool_manager.worker_manager.workers
            calls = pool._context.task_queue
            take = calls.put

            def take_late(call):
                calls.put = take
                os.kill(pid, signal.SIGKILL)
                while pool._context.status != PoolStatus.ERROR:
                    time.sleep(0.01)  # pebble looks ten times a second, and tells nobody
                take(call)

            calls.put = take_late
        return schedule(pool, function, args)

    def patient_check(self):
        if not (FOLDER / "patient").exists():
            check_stay(self)

    lane.Lane._call, lane.get_context = broken_call, broken_context
    lane.Lane._check_stay = patient_check
    ProcessPool.schedule = late_schedule


def analyse_on_demand():
    """Start the processes that analyse with the first request, and without a warm-up: few of these tests analyse."""
    from service.answers import desk

    start = desk.AnswerDesk.start

    def start_on_demand(self, after):
        start(self, lambda: self.is_awaited and after())

    desk.AnswerDesk.start = start_on_demand
    desk.TEMPLATE_MODULE = "tests.support.service.cold_template"


if __name__ == "__main__":
    break_lanes()
    analyse_on_demand()
    sys.exit(main())
