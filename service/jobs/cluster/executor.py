"""The executor for several machines: jobs go through a broker to worker hosts (``mechsynth worker``).

This side sends ids and receives notifications of changed jobs; :mod:`service.jobs.cluster.worker_host` is the other
side.
"""

from __future__ import annotations

import threading
from queue import SimpleQueue

import structlog

from service.jobs.cluster.broker import BrokerUnreachable, Publisher
from service.jobs.cluster.leases import LeaseStore
from service.jobs.cluster.listener import CHANGES_CHANNEL, StoreListener
from service.jobs.cluster.recovery import Recovery
from service.jobs.executor import Changed
from service.jobs.job_store import JobStore
from service.jobs.store.database import connect
from service.settings import Settings

STOP_TIMEOUT_S = 2.0

log = structlog.get_logger(__name__)


class CeleryExecutor:
    """Runs jobs on the available worker hosts.

    Raises
    ------
    SQLAlchemyError, OSError, ImportError
        If the store cannot be reached.
    """

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._engine = connect(settings.store_url, durable=False)
        JobStore(self._engine).ping()
        self._leases = LeaseStore(self._engine)
        self._publisher = Publisher(settings)
        self._queue: SimpleQueue[str | None] = SimpleQueue()
        self._sender = threading.Thread(target=self._send, name="sender", daemon=True)
        self._recovery = Recovery(self._leases, self._publisher, self._count_workers)
        self._listener: StoreListener | None = None
        self._workers = 0

    def start(self) -> None:
        """Start to send jobs."""
        if not self._sender.is_alive():
            self._sender.start()

    def resume(self) -> None:
        """Start to recover the jobs of all servers and to listen for changes."""
        self._count_workers()
        self._recovery.start()
        if self._listener is not None:
            self._listener.start()

    def subscribe(self, changed: Changed) -> None:
        """Call ``changed`` with the id of each job whose state changes from now on."""
        self._listener = StoreListener(self._settings.store_url, CHANGES_CHANNEL, changed)

    def submit(self, job_id: str) -> None:
        """Wake a free worker host for the job."""
        self._queue.put(job_id)

    def cancel(self, job_id: str) -> None:
        """Do nothing: the host that runs the job notices within half a second that its claim is no longer valid."""

    def count_ready_workers(self) -> int:
        """Return the number of workers on all hosts; 0 while the broker does not answer."""
        return self._workers if self._publisher.reachable else 0

    def stop(self) -> None:
        """Stop sending; worker hosts find the unsent jobs in the store."""
        self._queue.put(None)
        threads = [self._sender, self._recovery, *([] if self._listener is None else [self._listener])]
        self._recovery.stop()
        if self._listener is not None:
            self._listener.stop()
        for thread in threads:
            if thread.is_alive():
                thread.join(STOP_TIMEOUT_S)
        self._publisher.close()
        self._engine.dispose()

    def _count_workers(self) -> None:
        self._workers = self._leases.count_workers()

    def _send(self) -> None:
        while (job_id := self._queue.get()) is not None:
            try:
                self._publisher.send(job_id)
            except BrokerUnreachable:
                log.warning("job not sent", job=job_id, next="worker hosts see it in the store")
