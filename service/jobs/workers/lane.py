"""A lane: a thread of the server or worker host with one worker process, to which it gives one job at a time.

Each lane has a pebble pool of a single worker, not a share in a pool of many, for two reasons. The workers of a pool
share a pipe under a lock, and a worker killed while it holds the lock blocks the others for a minute. And a worker
killed while idle makes pebble declare the whole pool broken, with the jobs of the other workers. With one pool per
worker both failures stay within a lane, and the remedy is always the same (for cancellation, timeout, memory, death):
stop the pool, which kills the worker, and start another.

A cancelled job is first given time to stop by itself (:mod:`service.jobs.processes.stop_flag`), since a new worker
takes seconds to start.

A *lane* runs *jobs* in its *worker*, which is a process. A lane is *ready* when its worker has finished starting.
"""

from __future__ import annotations

import signal
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from typing import Any, Literal, NamedTuple, ParamSpec, TypeVar

import pebble
import structlog
from sqlalchemy.exc import SQLAlchemyError
from ulid import ULID

from service.jobs import faults
from service.jobs.batches.store import BatchStore
from service.jobs.executor import Changed
from service.jobs.faults import Fault
from service.jobs.job_store import JobStore
from service.jobs.processes.parent_death import export_parent_pid
from service.jobs.processes.stop_flag import Solving
from service.jobs.store.database import is_unreachable
from service.jobs.store.schema import Claim
from service.jobs.store.states import Cost, Status
from service.jobs.workers import worker
from service.jobs.workers.scheduler import SHORT_S, Turns
from service.observability.metrics import WorkerMetrics

CHECK_PERIOD_S = 1.0
"""Period at which a lane checks that its worker is alive, seconds: while idle, so that a job seldom meets a dead
worker, and while it waits for a result, because pebble drops a call that arrives while it detects a dead worker."""

START_TIMEOUT_S = 300.0
"""Time limit for the start of a worker, seconds. The first start may compile all kernels, which takes a minute."""

MAX_CANCELLED = 1000
"""Number of cancelled jobs that a lane remembers. The job that it is about to receive is one of the last few."""

GRACE_S = 0.5
"""Time for a cancelled job to stop by itself before its worker is killed, seconds."""

RETRY_PERIOD_S = 1.0
"""Pause before a failed start of a worker, or a failed write to the store, is retried, seconds."""

# Seconds between pebble's request to a worker to end and its kill. Workers end at once on request unless they are
# suspended, and waiting does not help a suspended worker.
pebble.CONSTS.term_timeout = 0.3

Reason = Literal["cancelled", "outstayed", "the service stops"]
"""Reason for which a job is stopped early; ``outstayed``: it takes too long for a lane reserved for short jobs."""

P = ParamSpec("P")
T = TypeVar("T")

log = structlog.get_logger(__name__)


class WorkerLost(Exception):
    """The worker died or did not start; ``killed`` means from outside, probably not through the job's fault."""

    def __init__(self, reason: str, *, killed: bool = False) -> None:
        self.killed = killed
        super().__init__(reason)


class Stores(NamedTuple):
    """Stores that a lane writes to when its worker has died or was stopped."""

    jobs: JobStore
    batches: BatchStore


class Lane(threading.Thread):
    """Runs the jobs that the scheduler assigns to it, one at a time, in its own worker process.

    The thread lives as long as the lane. The thread starts the worker, so the worker dies with it
    (:func:`service.jobs.processes.parent_death.bind_to_parent`).
    """

    def __init__(
        self,
        name: str,
        turns: Turns,
        stores: Stores,
        settings: worker.WorkerSettings,
        timeout_s: float,
        changed: Changed,
        metrics: WorkerMetrics,
        after: Sequence[Lane],
    ) -> None:
        super().__init__(name=name, daemon=True)
        self._turns = turns
        self._store, self._batches = stores
        self._settings = settings
        self._timeout_s = timeout_s
        self._changed = changed
        self._metrics = metrics
        self._after = after
        self._lock = threading.Lock()
        self._stopping = threading.Event()
        self._pool: Any = None
        self._future: Any = None
        self._stirred = threading.Event()
        self._job: Claim | None = None
        # A job may be cancelled after it is claimed and before this lane has received it.
        self._cancelled: deque[str] = deque(maxlen=MAX_CANCELLED)
        self._why: Reason | None = None
        self._kill_at = float("inf")
        self._solving = Solving()
        self._free_since = time.monotonic()
        self.ready = False
        """Whether the worker has finished starting."""
        self.settled = threading.Event()
        """Set when the first worker has started, or has failed to."""

    @property
    def is_settled(self) -> bool:
        """Whether the first worker has started, or has failed to."""
        return self.settled.is_set()

    def cancel(self, job_id: str) -> None:
        """Stop the job if this lane runs it, by killing the worker if necessary. Callable from any thread."""
        with self._lock:
            if self._job is not None and self._job.job_id == job_id:
                self._stop_job("cancelled")
            else:
                self._cancelled.append(job_id)

    @property
    def current_claim(self) -> tuple[str, str] | None:
        """The mark and the job id of the current claim, until the last change of the job is stored."""
        with self._lock:
            return None if self._job is None else (self._job.mark, self._job.job_id)

    def drop(self, mark: str) -> None:
        """Stop the job if this lane runs it under this claim."""
        with self._lock:
            if self._job is not None and self._job.mark == mark:
                self._stop_job("cancelled")

    def stop(self) -> None:
        """Request the lane to end; a running job returns to the queue. The caller joins the thread."""
        with self._lock:
            self._stopping.set()
            self.settled.set()
            self._why, self._kill_at = "the service stops", float("-inf")
            self._stirred.set()

    def _stop_job(self, why: Reason) -> None:
        if self._why is None:
            self._why, self._kill_at = why, time.monotonic() + GRACE_S
            self._solving.stop()
            self._stirred.set()

    def run(self) -> None:
        """Take jobs until a stop is requested."""
        for lane in self._after:
            lane.settled.wait()
        while not self._stopping.is_set():
            try:
                self._ensure_worker()
                self.settled.set()
                job = self._turns.take(self, self._free_since)
            except WorkerLost as loss:
                self._handle_failed_start(str(loss))
                continue
            except Exception as error:  # the lane survives any error, because later jobs need it
                log.exception("the lane failed", lane=self.name)
                self._handle_failed_start(f"{type(error).__name__} in the server")
                continue
            if job is not None:
                self._serve(job)
        self._discard_worker()

    def _handle_failed_start(self, reason: str) -> None:
        log.error("worker could not be started", lane=self.name, reason=reason)
        self._replace_worker("start_failed")
        self.settled.set()
        self._stopping.wait(RETRY_PERIOD_S)

    def _serve(self, job: Claim) -> None:
        """Run a job and announce its change. A defect in this code fails the job and does not end the lane."""
        with self._lock:
            self._job = job
            if job.job_id in self._cancelled:
                self._stop_job("cancelled")
        if job.attempt == 1 and job.batch is None:
            # The id of a job has the time of its creation. The clocks of server and host may differ a little.
            self._metrics.observe_wait(job.cost, max(0.0, time.time() - ULID.from_str(job.job_id).timestamp))
        try:
            self._run_job(job)
        except Exception:  # a defect in this code fails this job only, not later ones
            log.exception("the lane failed", lane=self.name, job=job.job_id)
            self._replace_worker("defect")
            try:
                self._give_up(job, faults.INTERNAL_ERROR)
            except Exception:  # the next start of the service then requeues the job
                log.exception("a job could not be failed", lane=self.name, job=job.job_id)
        with self._lock:
            self._job = None
            if not self._stopping.is_set():
                self._why, self._kill_at = None, float("inf")
        self._turns.release(self)
        self._free_since = time.monotonic()
        try:
            self._changed(job.batch or job.job_id)
        except Exception:  # the store has the new state, which subscribers read when their wait ends
            log.exception("a change could not be announced", lane=self.name, job=job.job_id)

    def _ensure_worker(self) -> None:
        if self._pool is not None and self._pool.active:
            return
        if self._pool is not None:
            self._replace_worker("died_idle")
        export_parent_pid()
        # "spawn": a forked child would inherit the locks of the server's threads and its open connections.
        self._pool = pebble.ProcessPool(
            max_workers=1,
            initializer=worker.start,
            initargs=(self._settings, self._solving),
            context=get_context("spawn"),
        )
        try:
            pid = self._call(worker.report_pid)
        except TimeoutError:
            self._discard_worker()
            raise WorkerLost(f"it did not start within {START_TIMEOUT_S:g} s") from None
        except CancelledError:  # the lane stops
            return
        except WorkerLost:
            self._discard_worker()
            raise
        self.ready = True
        log.info("worker ready", lane=self.name, pid=pid)

    def _replace_worker(self, reason: str) -> None:
        """End the worker; the next check starts another one."""
        self._metrics.count_worker_restart(reason)
        self._discard_worker()

    def _discard_worker(self) -> None:
        self.ready = False
        pool, self._pool = self._pool, None
        if pool is None:
            return
        try:
            pool.stop()
            pool.join()
        except Exception:  # a worker that cannot be killed must not end the lane
            log.exception("the worker could not be stopped", lane=self.name)

    def _run_job(self, job: Claim) -> None:
        try:
            ran: worker.EndedAttempt = self._call(worker.run, job, job=job)
        except TimeoutError:
            self._metrics.count_attempt("timeout")
            self._replace_worker("timeout")
            if self._give_up(job, faults.make_timeout(self._timeout_s)):
                log.warning("job failed", job=job.job_id, reason="timeout")
        except CancelledError:
            if self._stopping.is_set():
                self._discard_worker()
            else:
                self._replace_worker(self._why or "cancelled")
            self._handle_stopped_job(job)
        except WorkerLost as loss:
            self._metrics.count_attempt("worker lost")
            self._replace_worker("lost")
            status = self._record_crash(job, killed=loss.killed)
            log.warning("worker lost", lane=self.name, job=job.job_id, reason=str(loss), job_is_now=status)
            if status == Status.QUEUED:
                self._turns.wake()
        else:
            if ran.outcome == "stopped":
                self._handle_stopped_job(job)
                return
            if job.batch is None:
                self._metrics.count_attempt(ran.outcome, ran.kind, ran.seconds)
            else:
                self._metrics.count_attempt(ran.outcome)
            if ran.outcome == "out of memory":
                # A library that was refused memory in the middle of a call may be left in any state.
                self._replace_worker("out_of_memory")

    def _give_up(self, job: Claim, fault: Fault) -> bool:
        """Fail the job or, in a share of a batch, the sample at work; return whether the claim was still valid."""
        if job.batch is None:
            return bool(self._write_with_retries(self._store.give_up, job.job_id, job.mark, fault.as_json(job.job_id)))
        at = self._solving.sample
        if self._write_with_retries(self._batches.give_up, job.job_id, job.mark, at, fault.as_json) is None:
            return False
        self._turns.wake()
        return True

    def _record_crash(self, job: Claim, *, killed: bool) -> Status | None:
        status: Status | None
        if job.batch is None:
            status = self._write_with_retries(self._store.record_crash, job.job_id, job.mark, killed=killed)
        else:
            at = self._solving.sample
            status = self._write_with_retries(self._batches.record_crash, job.job_id, job.mark, at, killed=killed)
        return status

    def _handle_stopped_job(self, job: Claim) -> None:
        if self._stopping.is_set():
            if self._write_with_retries(self._store.requeue, job.job_id, job.mark):
                log.info("job requeued", job=job.job_id, reason="the service stops")
            return
        self._metrics.count_attempt(self._why or "cancelled")
        if self._why == "outstayed" and self._write_with_retries(self._store.requeue_as_long, job.job_id, job.mark):
            log.info("job requeued", job=job.job_id, reason="it is longer than expected")
            self._turns.wake()

    def _call(self, function: Callable[..., T], *args: object, job: Claim | None = None) -> T:
        """Call a function in the worker and return its answer.

        Raises
        ------
        TimeoutError
            If the solver exceeds the time limit of the job or, without a job, the worker did not start in time; the
            call is still running.
        CancelledError
            If the job did not stop by itself after a request, or the lane stops; the call is still running.
        WorkerLost
            If the worker died or the function raised.
        """
        with self._lock:
            if self._stopping.is_set():
                raise CancelledError
            self._solving.reset()
            try:
                self._future = self._pool.schedule(function, args=args)
            except (RuntimeError, OSError) as error:  # the idle worker has died, or no process or pipe is available
                raise WorkerLost(str(error), killed=True) from None
            if self._why is not None:  # cancelled before the worker received it
                self._solving.stop()
        try:
            self._future.add_done_callback(lambda _: self._stirred.set())
            answer: T = self._wait_for_answer(job)
            return answer
        except (CancelledError, TimeoutError, WorkerLost):
            raise
        except pebble.ProcessExpired as error:
            # SIGKILL comes from outside: from the operator or from the system when memory runs out.
            killed = error.exitcode == -signal.SIGKILL
            raise WorkerLost(f"{error}; exit code {error.exitcode}", killed=killed) from None
        except BrokenProcessPool as error:  # the worker died before it started the job
            raise WorkerLost(str(error), killed=True) from None
        except Exception as error:  # the worker could neither store nor handle it: its state is unknown
            log.exception("the worker raised", lane=self.name, job=None if job is None else job.job_id)
            raise WorkerLost(f"{type(error).__name__} in the worker") from None
        finally:
            self._future = None

    def _wait_for_answer(self, job: Claim | None) -> Any:
        # Not pebble's own timeout, which would include the worker's waits for the store.
        began = time.monotonic()
        limit_s = START_TIMEOUT_S if job is None else self._timeout_s
        short = job is not None and job.cost == Cost.SHORT
        while not self._future.done():
            now = time.monotonic()
            if now >= self._kill_at:
                raise CancelledError
            spent = now - began if job is None else self._solving.seconds
            if spent >= limit_s:
                raise TimeoutError
            if short and spent >= SHORT_S:
                short = False
                self._check_stay()
            if not self._pool.active and not self._future.done():
                raise WorkerLost("the worker had died before", killed=True)
            self._stirred.wait(max(0.0, min(limit_s - spent, self._kill_at - time.monotonic(), CHECK_PERIOD_S)))
            self._stirred.clear()
        try:
            return self._future.result()
        except TimeoutError:
            raise WorkerLost("unexpected TimeoutError in the worker") from None

    def _check_stay(self) -> None:
        if self._turns.count_as_long(self):
            with self._lock:
                self._stop_job("outstayed")

    def _write_with_retries(self, write: Callable[P, T], *args: P.args, **options: P.kwargs) -> T | None:
        """Write to the store, retrying while it is unreachable: the job would be lost until a restart otherwise."""
        while True:
            try:
                return write(*args, **options)
            except SQLAlchemyError as error:
                if not is_unreachable(error):  # it would fail each time, and the lane would never end
                    raise
                log.exception("the store is out of reach", lane=self.name)
                if self._stopping.wait(RETRY_PERIOD_S):
                    return None
