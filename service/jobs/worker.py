"""What runs in a worker process: solve a job, store the answer.

This module is imported before the worker has set its number of threads, so it must not import numpy, directly or
through the solvers; :func:`start` does that when everything is in place.
"""

from __future__ import annotations

import importlib
import os
import resource
import signal
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, ParamSpec, TypeVar

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service import logs
from service.jobs import faults
from service.jobs.database import connect, unreachable
from service.jobs.orphans import die_with
from service.jobs.progress import ProgressWriter
from service.jobs.solving import Solving, Stopped
from service.jobs.store import Claim, JobStore

Outcome = Literal["succeeded", "failed", "out of memory", "superseded", "stopped"]
"""What became of a job as its worker knows it; ``superseded``: it has its answer, and was cancelled or given to another
attempt meanwhile; ``stopped``: it has none, because the lane has said so."""

RETRY_PERIOD_S = 0.5
"""Pause before a write to a store that is out of reach is tried again."""

LIBRARIES_MB = 400
"""What solvers load after the worker has started, beside what a job is allowed: convex optimization, kernels."""

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")

P = ParamSpec("P")
T = TypeVar("T")

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class Ran:
    """An attempt that the worker has ended: what became of it, the kind of its problem, and how long it took."""

    outcome: Outcome
    kind: str
    seconds: float


@dataclass(frozen=True, slots=True)
class WorkerSettings:
    """What a worker has to know; passed to it when it starts."""

    store_url: str
    server_pid: int
    memory_mb: int
    log_level: str
    log_format: logs.Format


@dataclass(frozen=True, slots=True)
class _Post:
    store: JobStore
    progress: ProgressWriter
    settings: WorkerSettings
    solving: Solving


_post: _Post | None = None


def start(settings: WorkerSettings, solving: Solving) -> None:
    """Prepare this process for its jobs: its end, its limits, the solvers. Called once, first of all."""
    global _post
    die_with(settings.server_pid)
    # Ctrl-C at a terminal reaches the whole group of processes; it is the server's to act on, and it stops its workers.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # The default action ends the process at once; a handler in Python would wait for native code to return.
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    # As many workers as processors run side by side, so threads inside them would only compete.
    for variable in _THREADS:
        os.environ[variable] = "1"
    logs.configure(settings.log_level, settings.log_format)
    dispatch = importlib.import_module("synthesis.dispatch")
    dispatch.warm_up()
    store = JobStore(connect(settings.store_url, durable=False))
    progress = ProgressWriter(store)
    _limit_memory(settings.memory_mb + LIBRARIES_MB)
    _post = _Post(store, progress, settings, solving)
    store.ping()
    # Beside the first jobs: they find what is not loaded yet a little slower, but the service is ready seconds sooner.
    threading.Thread(target=dispatch.warm_up_rest, name="warm-up", daemon=True).start()


def hello() -> int:
    """The process id of the worker; the answer shows that the worker has finished starting."""
    return os.getpid()


def run(job: Claim) -> Ran:
    """Run a claimed job to its end. The store has the answer when this returns.

    While the store is out of reach this waits for it. What else the store raises is raised: the executor then treats
    the worker as dead and the job is tried again.
    """
    assert _post is not None, "start() comes first"
    bound = log.bind(job=job.job_id, attempt=job.attempt)
    bound.info("job running")
    began = time.perf_counter()
    outcome = _attempt(_post, job)
    seconds = time.perf_counter() - began
    bound.info(f"job {outcome}", seconds=round(seconds, 4))
    return Ran(outcome, job.kind, seconds)


def _attempt(post: _Post, job: Claim) -> Outcome:
    try:
        with post.solving.at_work():
            result = _solve(post, job)
    except Stopped:
        return "stopped"
    except MemoryError:
        fault = faults.out_of_memory(post.settings.memory_mb)
        stored = _stored(post.store.fail, job.job_id, job.attempt, fault.as_json(job.job_id))
        return "out of memory" if stored else "superseded"
    except Exception:  # the boundary of the solvers: whatever defect they have ends this job only
        log.exception("the solver raised", job=job.job_id, attempt=job.attempt)
        stored = _stored(post.store.fail, job.job_id, job.attempt, faults.INTERNAL_ERROR.as_json(job.job_id))
        return "failed" if stored else "superseded"
    return "succeeded" if _stored(post.store.succeed, job.job_id, job.attempt, result) else "superseded"


def _stored(write: Callable[P, T], *args: P.args, **options: P.kwargs) -> T:
    """Write to the store, and wait for it while it is out of reach: the answer is there, and would be lost.

    Each write can be repeated where nobody knows whether it was done, since it names its claim or attempt.
    """
    while True:
        try:
            return write(*args, **options)
        except SQLAlchemyError as error:
            if not unreachable(error):
                raise
            log.warning("the store is out of reach", error=type(error).__name__)
            time.sleep(RETRY_PERIOD_S)  # the answer is kept; a store that is started again needs seconds


def _solve(post: _Post, job: Claim) -> str:
    from service.stated import read
    from synthesis import dispatch

    problem = read(job.kind, job.problem)
    with post.progress.attempt(job.job_id, job.attempt) as progress:
        return dispatch.solve(problem, post.solving.stoppable(progress)).model_dump_json()


def _limit_memory(beyond_mb: int) -> None:
    """Allow ``beyond_mb`` MiB on top of what the process has now.

    On Linux ``RLIMIT_DATA`` counts the private memory that can be written. ``RLIMIT_AS`` would count address space
    as well that allocators and compilers reserve and never touch, so no honest figure could be set with it.
    """
    kind = resource.RLIMIT_DATA if sys.platform == "linux" else resource.RLIMIT_AS
    limit = _memory_in_use() + (beyond_mb << 20)
    hard = resource.getrlimit(kind)[1]
    if hard != resource.RLIM_INFINITY:
        limit = min(limit, hard)
    resource.setrlimit(kind, (limit, hard))


def _memory_in_use() -> int:
    """The bytes that count against the limit; 0 where the system does not tell."""
    try:
        with open("/proc/self/status", encoding="ascii") as status:
            for line in status:
                if line.startswith("VmData:"):
                    return int(line.split()[1]) << 10
    except OSError:
        pass
    return 0
