"""The code of a worker process: solve a job, store the answer.

This module is imported before the worker has set its number of threads, so it must not import numpy, directly or
through the solvers; :func:`start` imports them after that.
"""

from __future__ import annotations

import importlib
import os
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import structlog

from service.jobs import faults
from service.jobs.batches.identity import hash_problem
from service.jobs.batches.slices import SliceSolver
from service.jobs.batches.store import BatchStore
from service.jobs.job_store import JobStore
from service.jobs.processes.limits import limit_memory, restrict_process
from service.jobs.processes.stop_flag import SolverStopped, Solving
from service.jobs.store.database import connect, write_when_reachable
from service.jobs.store.schema import Claim
from service.jobs.workers.progress_writer import ProgressWriter
from service.observability import logs

if TYPE_CHECKING:
    from service.jobs.workers.compile_watch import FirstUse

Outcome = Literal["succeeded", "failed", "out of memory", "superseded", "stopped", "slice"]
"""Outcome of an attempt as its worker knows it. ``superseded``: solved, but cancelled or given to another attempt
meanwhile; ``stopped``: ended without an answer on request of the lane; ``slice``: part of a share of a batch, which is
queued again or has ended."""

LIBRARIES_MB = 400
"""Memory for code that solvers load after the start (convex optimization, kernels), added to a job's limit, MiB."""

LOADING_NICENESS = 5
"""Niceness of the thread that loads the kernels of all kinds after the start. It takes ten seconds of processor time in
each worker, while a document, a drawing or an analysis that a client waits for needs one or two."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class EndedAttempt:
    """An attempt that the worker has ended: its outcome, the kind of the problem and the duration in seconds."""

    outcome: Outcome
    kind: str
    seconds: float


@dataclass(frozen=True, slots=True)
class WorkerSettings:
    """Settings of a worker, passed to it at its start."""

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
    slices: SliceSolver
    first_use: FirstUse


_post: _Post | None = None


def start(settings: WorkerSettings, solving: Solving) -> None:
    """Prepare this process for jobs: end with the server, limits, solvers. Called once, before anything else."""
    global _post
    restrict_process(settings.server_pid, settings.log_level, settings.log_format)
    dispatch = importlib.import_module("synthesis.dispatch")
    dispatch.warm_up()
    engine = connect(settings.store_url, durable=False)
    store = JobStore(engine)
    progress = ProgressWriter(store)
    limit_memory(settings.memory_mb + LIBRARIES_MB)
    first_use: FirstUse = importlib.import_module("service.jobs.workers.compile_watch").FirstUse(solving)
    slices = SliceSolver(BatchStore(engine), solving, faults.make_out_of_memory(settings.memory_mb))
    _post = _Post(store, progress, settings, solving, slices, first_use)
    store.ping()
    # In parallel with the first jobs, which may run a little slower; but the service is ready seconds sooner.
    threading.Thread(target=_load_rest, args=(dispatch.warm_up_rest,), name="warm-up", daemon=True).start()


def _load_rest(load: Callable[[], None]) -> None:
    """Load the kernels of all other kinds, after what the first requests to the server wait for."""
    if sys.platform == "linux":  # elsewhere threads have no priority of their own
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), LOADING_NICENESS)
    load()


def report_pid() -> int:
    """Return the worker's process id; the answer shows that the worker has finished starting."""
    return os.getpid()


def run(job: Claim) -> EndedAttempt:
    """Run a claimed job to its end; on return the store has the answer.

    While the store is unreachable this waits. Other errors of the store propagate: the executor then treats the worker
    as dead, and the job is retried.
    """
    assert _post is not None, "start() comes first"
    if job.batch is not None:
        return _run_slice(_post, job, job.batch)
    bound = log.bind(job=job.job_id, attempt=job.attempt)
    bound.info("job running")
    began = time.perf_counter()
    outcome = _run_attempt(_post, job)
    seconds = time.perf_counter() - began
    bound.info(f"job {outcome}", seconds=round(seconds, 4))
    return EndedAttempt(outcome, job.kind, seconds)


def _run_slice(post: _Post, share: Claim, batch_id: str) -> EndedAttempt:
    began = time.perf_counter()
    with post.first_use.watch_progress(lambda fraction, message: None):
        outcome = post.slices.run(share, batch_id)
    seconds = time.perf_counter() - began
    log.debug(f"batch {outcome}", batch=batch_id, share=share.job_id, seconds=round(seconds, 4))
    return EndedAttempt(outcome, share.kind, seconds)


def _run_attempt(post: _Post, job: Claim) -> Outcome:
    try:
        with post.solving.track_work():
            result, known_by = _solve(post, job)
    except SolverStopped:
        return "stopped"
    except MemoryError:
        fault = faults.make_out_of_memory(post.settings.memory_mb)
        stored = write_when_reachable(post.store.fail, job.job_id, job.attempt, fault.as_json(job.job_id))
        return "out of memory" if stored else "superseded"
    except Exception:  # the boundary of the solvers: a defect of theirs ends this job only
        log.exception("the solver raised", job=job.job_id, attempt=job.attempt)
        stored = write_when_reachable(
            post.store.fail, job.job_id, job.attempt, faults.INTERNAL_ERROR.as_json(job.job_id)
        )
        return "failed" if stored else "superseded"
    return (
        "succeeded"
        if write_when_reachable(post.store.complete, job.job_id, job.attempt, result, known_by)
        else "superseded"
    )


def _solve(post: _Post, job: Claim) -> tuple[str, str]:
    """Solve a job; return the answer as JSON, and the digest by which equal problems find it."""
    from service.requests import load_stored_problem
    from synthesis import dispatch

    problem = load_stored_problem(job.kind, job.problem)
    with (
        post.progress.track_attempt(job.job_id, job.attempt) as progress,
        post.first_use.watch_progress(progress) as report,
    ):
        result = dispatch.solve(problem, post.solving.make_stoppable(report)).model_dump_json()
    return result, hash_problem(problem)
