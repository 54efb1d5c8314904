"""The local executor: worker processes of the server, one for each lane."""

from __future__ import annotations

import os

import structlog

from service.jobs.batches.store import BatchStore
from service.jobs.executor import Changed
from service.jobs.job_store import JobStore
from service.jobs.store.database import connect
from service.jobs.workers.lane import Lane, Stores
from service.jobs.workers.scheduler import Turns
from service.jobs.workers.worker import WorkerSettings
from service.observability.metrics import WorkerMetrics
from service.settings import Settings

STOP_TIMEOUT_S = 5.0
"""Time limit for the end of a lane, seconds; normally it takes half a second. The end of the process kills the rest."""


log = structlog.get_logger(__name__)


class LocalExecutor:
    """Runs jobs in ``settings.workers`` processes and some reserve processes, all of which end with the server.

    Raises
    ------
    SQLAlchemyError, OSError, ImportError
        If the store cannot be reached.
    """

    def __init__(self, settings: Settings, metrics: WorkerMetrics) -> None:
        self._settings = settings
        self._metrics = metrics
        # Not durable: a lost write of the executor is repeated after the restart, like those of the workers.
        self._engine = connect(settings.store_url, durable=False)
        self._store = JobStore(self._engine)
        # This also creates the file of a new SQLite store before several processes do so at once.
        self._store.ping()
        self._subscriber: Changed | None = None
        self._lanes: list[Lane] = []
        self._turns = Turns(self._store, self._lanes, settings.workers)

    def start(self) -> None:
        """Start the lanes; their workers may still be starting on return."""
        if self._lanes:
            return
        for_workers = WorkerSettings(
            store_url=self._settings.store_url,
            server_pid=os.getpid(),
            memory_mb=self._settings.job_memory_mb,
            log_level=self._settings.log_level,
            log_format=self._settings.log_format,
        )
        # The first worker starts alone, so that the service is ready soon. If it is the first one ever, it compiles the
        # kernels, and the others find them compiled. The reserve comes last.
        workers = self._settings.workers
        for n in range(workers + self._settings.reserve):
            lane = Lane(
                f"lane-{n}",
                self._turns,
                Stores(self._store, BatchStore(self._engine)),
                for_workers,
                self._settings.job_timeout_s,
                self._notify_subscriber,
                self._metrics,
                after=self._lanes[: 0 if n == 0 else 1 if n < workers else workers],
            )
            self._lanes.append(lane)
        for lane in self._lanes:
            lane.start()

    def resume(self) -> None:
        """Take up the jobs left by the previous server; no other process runs jobs of this store."""
        unfinished = self._store.requeue_unfinished()
        if unfinished:
            log.info("unfinished jobs taken up again", jobs=unfinished)
        self.open()

    def open(self) -> None:
        """Start to give jobs to the lanes: the store has its tables, and its running jobs have owners."""
        self._turns.open()

    def subscribe(self, changed: Changed) -> None:
        """Call ``changed`` with the id of each job that a worker releases from now on."""
        self._subscriber = changed

    def submit(self, job_id: str) -> None:
        """Submit a queued job; it runs when its turn comes."""
        self.wake()

    def wake(self, jobs: int = 1) -> None:
        """Wake free lanes, one for each new job as far as there are any, to ask for a job."""
        self._turns.wake(jobs)

    def cancel(self, job_id: str) -> None:
        """Stop the job if a lane runs it; a waiting job, already cancelled in the store, cannot be claimed any more."""
        for lane in self._lanes:
            lane.cancel(job_id)

    def list_claims(self) -> dict[str, str]:
        """Return the ids of the jobs that the lanes run, by their claims."""
        return dict(claim for lane in self._lanes if (claim := lane.current_claim) is not None)

    def drop(self, claim: str) -> None:
        """Stop the job that a lane runs under a claim that is no longer valid."""
        for lane in self._lanes:
            lane.drop(claim)

    def count_ready_workers(self) -> int:
        """Return the number of workers that have finished starting."""
        return sum(lane.ready and lane.is_alive() for lane in self._lanes)

    def stop(self) -> None:
        """Stop all lanes at the same time and wait for them."""
        for lane in self._lanes:
            lane.stop()
        self._turns.close()
        for lane in self._lanes:
            lane.join(STOP_TIMEOUT_S)
        self._engine.dispose()

    def _notify_subscriber(self, job_id: str | None) -> None:
        if self._subscriber is not None:
            self._subscriber(job_id)
