"""The executor for several machines: worker hosts (``mechsynth worker``) claim the jobs in the shared database.

This side receives notifications of changed jobs and recovers abandoned ones; :mod:`service.jobs.cluster.worker_host` is
the other side.
"""

from __future__ import annotations

from service.jobs.cluster.leases import LeaseStore
from service.jobs.cluster.listener import CHANGES_CHANNEL, StoreListener
from service.jobs.cluster.recovery import Recovery
from service.jobs.executor import Changed
from service.jobs.job_store import JobStore
from service.jobs.store.database import connect
from service.settings import Settings

STOP_TIMEOUT_S = 2.0


class ClusterExecutor:
    """Leaves jobs to the worker hosts that share the database.

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
        self._recovery = Recovery(self._leases, self._count_workers)
        self._listener: StoreListener | None = None
        self._workers = 0

    def start(self) -> None:
        """Do nothing: worker hosts are started on their own."""

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
        """Do nothing: the database has notified the worker hosts of the queued job."""

    def cancel(self, job_id: str) -> None:
        """Do nothing: the host that runs the job notices within half a second that its claim is no longer valid."""

    def count_ready_workers(self) -> int:
        """Return the number of workers on all hosts, at most a second old."""
        return self._workers

    def stop(self) -> None:
        """Stop to recover and to listen; worker hosts continue."""
        threads: list[Recovery | StoreListener] = [self._recovery]
        if self._listener is not None:
            threads.append(self._listener)
        for thread in threads:
            thread.stop()
        for thread in threads:
            if thread.is_alive():
                thread.join(STOP_TIMEOUT_S)
        self._engine.dispose()

    def _count_workers(self) -> None:
        self._workers = self._leases.count_workers()
