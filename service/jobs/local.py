"""The local executor: worker processes of the server itself, one to a lane."""

from __future__ import annotations

import os
from queue import SimpleQueue

import structlog

from service.jobs.database import connect
from service.jobs.executor import Changed
from service.jobs.lane import Lane
from service.jobs.store import JobStore
from service.jobs.worker import WorkerSettings
from service.metrics import WorkerMetrics
from service.settings import Settings

STOP_TIMEOUT_S = 5.0
"""A lane stops within half a second; one that does not is left to the end of the process, which kills its worker."""


log = structlog.get_logger(__name__)


class LocalExecutor:
    """Runs jobs in ``settings.workers`` processes that end with the server, one after the other in each.

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
        self._queue: SimpleQueue[str | None] = SimpleQueue()
        self._lanes: list[Lane] = []

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
        # is the first ever and compiles the kernels, the others find them compiled.
        first: Lane | None = None
        for n in range(self._settings.workers):
            lane = Lane(
                f"lane-{n}",
                self._queue,
                self._store,
                for_workers,
                self._settings.job_timeout_s,
                self._changed,
                self._metrics,
                after=first,
            )
            first = first or lane
            self._lanes.append(lane)
        for lane in self._lanes:
            lane.start()

    def resume(self) -> None:
        """Take up what the server before this one has left; nobody else runs jobs of this store."""
        unfinished = self._store.requeue_unfinished()
        for job_id in unfinished:
            self.submit(job_id)
        if unfinished:
            log.info("unfinished jobs taken up again", jobs=len(unfinished))

    def subscribe(self, changed: Changed) -> None:
        """Tell ``changed`` from now on of each job that a worker is done with."""
        self._subscriber = changed

    def submit(self, job_id: str) -> None:
        """Have the queued job run by the next free lane."""
        self._queue.put(job_id)

    def cancel(self, job_id: str) -> None:
        """Kill the worker that runs the job; one that no lane has begun cannot be claimed when its turn comes."""
        for lane in self._lanes:
            lane.cancel(job_id)

    def claims(self) -> dict[str, str]:
        """The jobs that the lanes see to now, by their claims."""
        return dict(held for lane in self._lanes if (held := lane.held) is not None)

    def drop(self, claim: str) -> None:
        """Kill the worker that runs a job under a claim that is of no use any more."""
        for lane in self._lanes:
            lane.drop(claim)

    def ready(self) -> int:
        """How many workers have finished starting."""
        return sum(lane.ready and lane.is_alive() for lane in self._lanes)

    def stop(self) -> None:
        """Stop all lanes at once and wait for them."""
        for lane in self._lanes:
            lane.stop()
        for _ in self._lanes:
            self._queue.put(None)
        for lane in self._lanes:
            lane.join(STOP_TIMEOUT_S)
        self._engine.dispose()

    def _changed(self, job_id: str | None) -> None:
        if self._subscriber is not None:
            self._subscriber(job_id)
