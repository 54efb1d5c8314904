"""The executor for several machines: worker hosts (``mechsynth worker``) claim the jobs in the shared database.

This side announces queued jobs, hears of changed ones and recovers abandoned ones. The other side is
:mod:`service.jobs.cluster.worker_host`.
"""

from __future__ import annotations

from service.jobs.cluster.leases import LeaseStore
from service.jobs.cluster.listener import StoreListener
from service.jobs.cluster.notifier import CHANGES_CHANNEL, StoreNotifier, split_ids
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
        self._notifier = StoreNotifier(settings.store_url)
        self._listener: StoreListener | None = None
        self._workers = 0

    def start(self) -> None:
        """Do nothing: worker hosts are started on their own."""

    def resume(self) -> None:
        """Start to recover the jobs of all servers, to announce queued jobs and to listen for changes."""
        self._count_workers()
        self._recovery.start()
        self._notifier.start()
        if self._listener is not None:
            self._listener.start()

    def subscribe(self, changed: Changed) -> None:
        """Call ``changed`` with the id of each job that a host releases or another server cancels."""

        def hear(payload: str | None) -> None:
            for job_id in split_ids(payload):
                changed(job_id)

        self._listener = StoreListener(self._settings.store_url, CHANGES_CHANNEL, hear)

    def submit(self, job_id: str) -> None:
        """Wake a free worker of each host."""
        self._notifier.announce_work()

    def cancel(self, job_id: str) -> None:
        """Announce the end of the job; the host that runs it notices within half a second that its claim is invalid."""
        self._notifier.announce_change(job_id)

    def count_ready_workers(self) -> int:
        """Return the number of workers on all hosts, at most a second old."""
        return self._workers

    def stop(self) -> None:
        """Stop all threads; worker hosts continue."""
        threads: list[Recovery | StoreNotifier | StoreListener] = [self._recovery, self._notifier]
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
