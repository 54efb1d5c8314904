"""The local executor: worker processes of the server itself, one to a lane."""

from __future__ import annotations

import os

import structlog

from service.jobs.batches.store import BatchStore
from service.jobs.executor import Changed
from service.jobs.job_store import JobStore
from service.jobs.store.database import connect
from service.jobs.workers.lane import Lane
from service.jobs.workers.scheduler import Turns
from service.jobs.workers.worker import WorkerSettings
from service.observability.metrics import WorkerMetrics
from service.settings import Settings

STOP_TIMEOUT_S = 5.0
"""A lane stops within half a second; one that does not is left to the end of the process, which kills its worker."""


log = structlog.get_logger(__name__)


class LocalExecutor:
    """Runs jobs in ``settings.workers`` processes, and some in reserve, that end with the server.

    Raises
    ------
    SQLAlchemyError, OSError, ImportError
        When the store cannot be reached.
    """

    def __init__(self, settings: Settings, metrics: WorkerMetrics) -> None:
        self._settings = settings
        self._metrics = metrics
        # What the executor writes is found out anew if it is lost, like what the workers write.
        self._engine = connect(settings.store_url, durable=False)
        self._store = JobStore(self._engine)
        # Besides, this makes the file of a new SQLite store before several processes come to do it at once.
        self._store.ping()
        self._subscriber: Changed | None = None
        self._lanes: list[Lane] = []
        self._turns = Turns(self._store, self._lanes, settings.workers)

    def start(self) -> None:
        """Start the lanes; their workers start while this returns."""
        if self._lanes:
            return
        for_workers = WorkerSettings(
            store_url=self._settings.store_url,
            server_pid=os.getpid(),
            memory_mb=self._settings.job_memory_mb,
            log_level=self._settings.log_level,
            log_format=self._settings.log_format,
        )
        # The first worker has the machine to itself until it is ready, so that the service is ready soon. And when it
        # is the first ever and compiles the kernels, the others find them compiled. The reserve comes last.
        workers = self._settings.workers
        for n in range(workers + self._settings.reserve):
            lane = Lane(
                f"lane-{n}",
                self._turns,
                self._store,
                BatchStore(self._engine),
                for_workers,
                self._settings.job_timeout_s,
                self._changed,
                self._metrics,
                after=self._lanes[: 0 if n == 0 else 1 if n < workers else workers],
            )
            self._lanes.append(lane)
        for lane in self._lanes:
            lane.start()

    def resume(self) -> None:
        """Take up what the server before this one has left; nobody else runs jobs of this store."""
        unfinished = self._store.requeue_unfinished()
        if unfinished:
            log.info("unfinished jobs taken up again", jobs=unfinished)
        self.open()

    def open(self) -> None:
        """Begin to give jobs to the lanes: the store has its tables, and what runs in it is somebody's."""
        self._turns.open()

    def subscribe(self, changed: Changed) -> None:
        """Tell ``changed`` from now on of each job that a worker is done with."""
        self._subscriber = changed

    def submit(self, job_id: str) -> None:
        """Have the queued job run when its turn comes."""
        self.wake()

    def wake(self) -> None:
        """Have a free lane ask for a job, where there is one."""
        self._turns.wake()

    def cancel(self, job_id: str) -> None:
        """Stop the job where a lane runs it; one that waits cannot be claimed when its turn comes."""
        for lane in self._lanes:
            lane.cancel(job_id)

    def claims(self) -> dict[str, str]:
        """The jobs that the lanes see to now, by their claims."""
        return dict(held for lane in self._lanes if (held := lane.held) is not None)

    def drop(self, claim: str) -> None:
        """Stop the job that a lane runs under a claim that is of no use any more."""
        for lane in self._lanes:
            lane.drop(claim)

    def ready(self) -> int:
        """How many workers have finished starting."""
        return sum(lane.ready and lane.is_alive() for lane in self._lanes)

    def stop(self) -> None:
        """Stop all lanes at once and wait for them."""
        for lane in self._lanes:
            lane.stop()
        self._turns.close()
        for lane in self._lanes:
            lane.join(STOP_TIMEOUT_S)
        self._engine.dispose()

    def _changed(self, job_id: str | None) -> None:
        if self._subscriber is not None:
            self._subscriber(job_id)
