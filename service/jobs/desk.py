"""The operations on jobs that the API offers: store, executor and notifier behind one object."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from dataclasses import dataclass
from typing import Literal

import structlog
from sqlalchemy.exc import SQLAlchemyError
from starlette.concurrency import run_in_threadpool

from kinematics.message import compose
from service.jobs.events.notifier import ChangeNotifier
from service.jobs.executor import Executor
from service.jobs.job_store import JobStore
from service.jobs.store.admission import Repeatable
from service.jobs.store.database import is_unreachable
from service.jobs.store.finished_cache import FinishedJobs
from service.jobs.store.schema import JobRow, JobSummary, SampleRow
from service.jobs.store.states import Cost, Status
from service.observability.metrics import Metrics
from service.observability.telemetry import measure_span

POLL_PERIOD_S = 1.0
"""Period at which a waiting request reads its job, seconds: the notification of a change may be lost."""

log = structlog.get_logger(__name__)


class PartOfBatch(Exception):
    """The job is a sample of a batch and cannot be removed by itself; carries the id of the batch."""

    def __init__(self, batch: str) -> None:
        self.batch = batch
        super().__init__(f"the job is a sample of the batch {batch}")


@dataclass(frozen=True, slots=True)
class JobDesk:
    """Accepts, shows, cancels and removes jobs. Runs on the event loop; queries the store in a thread."""

    store: JobStore
    executor: Executor
    notifier: ChangeNotifier
    metrics: Metrics
    max_queued: int
    finished: FinishedJobs

    async def accept(
        self,
        *,
        tenant: str,
        kind: str,
        label: str | None,
        problem: str,
        cost: Cost,
        wait_s: float,
        repeatable: Repeatable | None,
    ) -> JobRow:
        """Store a job, submit it, wait up to ``wait_s`` seconds for its end, and return its state after that.

        A repeated request with the same key returns the job that the first request created.

        Raises
        ------
        KeyReused
            If the key was used with a different request before.
        QueueFull
            If the tenant's queue is full.
        """
        with measure_span("store"):
            job, new = await run_in_threadpool(self._store_job, tenant, kind, label, problem, cost, repeatable)
        if new:
            log.info("job accepted", job=job.id, kind=kind)
            self.metrics.count_job(kind)
        with self.notifier.watch(job.id) as changed:
            if new:
                self.executor.submit(job.id)
            if wait_s <= 0:
                return job
            # A free worker may have found the job in the store and ended it before the watch began.
            job = await self.get(job.tenant, job.id) or job
            with measure_span("job"):
                return await self._wait_for_end(job, changed, wait_s)

    def _store_job(
        self, tenant: str, kind: str, label: str | None, problem: str, cost: Cost, repeatable: Repeatable | None
    ) -> tuple[JobRow, bool]:
        if repeatable is None:
            job = self.store.create(
                tenant=tenant, kind=kind, label=label, problem=problem, cost=cost, max_queued=self.max_queued
            )
            return job, True
        return self.store.create_once(
            tenant=tenant,
            kind=kind,
            label=label,
            problem=problem,
            repeatable=repeatable,
            cost=cost,
            max_queued=self.max_queued,
        )

    async def _wait_for_end(self, job: JobRow, changed: asyncio.Event, wait_s: float) -> JobRow:
        try:
            async with asyncio.timeout(wait_s):
                while not job.status.finished and not self.notifier.closed:
                    with suppress(TimeoutError):
                        async with asyncio.timeout(POLL_PERIOD_S):
                            await changed.wait()
                    changed.clear()
                    job = await self._read_if_reachable(job)
        except TimeoutError:
            return await self.get(job.tenant, job.id) or job
        return job

    async def _read_if_reachable(self, job: JobRow) -> JobRow:
        try:
            return await self.get(job.tenant, job.id) or job
        except SQLAlchemyError as error:  # the job is accepted; the store may be back before the wait is over
            if not is_unreachable(error):
                raise
            return job

    async def get(self, tenant: str, job_id: str) -> JobRow | None:
        """Return the job; None if it does not exist or belongs to another tenant."""
        job = self.finished.get(job_id)
        if job is None:
            # Noted before the read: a removal during the read must not leave the job in the cache.
            removals = self.finished.removals
            job = await run_in_threadpool(self.store.get, job_id)
            if job is not None:
                self.finished.keep(job, removals)
        return job if job is not None and job.tenant == tenant else None

    async def list_page(
        self, *, tenant: str, limit: int, status: Status | None, kind: str | None, before: str | None
    ) -> list[JobSummary]:
        """Return at most ``limit`` jobs of the tenant, newest first."""
        return await run_in_threadpool(
            self.store.list_page, tenant=tenant, limit=limit, status=status, kind=kind, before=before
        )

    async def cancel_or_delete(self, tenant: str, job_id: str) -> JobRow | Literal["deleted"] | None:
        """Cancel an unfinished job and return it, or remove a finished one; None if the tenant has no such job.

        A job that ends by itself while it is being cancelled is returned and not removed: it was unfinished when the
        client sent the request, and the client must not lose a result that it has never seen.

        Raises
        ------
        PartOfBatch
            If the job is a sample of a batch, which is removed as a whole.
        """
        job = await self.get(tenant, job_id)
        if job is None:
            return None
        if isinstance(job, SampleRow):
            raise PartOfBatch(job.batch)
        if job.status.finished:
            try:
                return "deleted" if await run_in_threadpool(self.store.delete, job_id) else None
            finally:
                self.finished.note_removal(job_id)
        if await run_in_threadpool(self.store.cancel, job_id):
            log.info("job cancelled", job=job_id, was=job.status)
            self.executor.cancel(job_id)
            self.notifier.publish(job_id)
        return await self.get(tenant, job_id)

    async def check_readiness(self, is_compiling: bool) -> str | None:
        """Return None if jobs can be accepted and run, else a sentence that names the missing part.

        ``is_compiling`` says that kernels are missing, for which the first worker waits.
        """
        fault = await run_in_threadpool(self.store.find_fault)
        if fault is not None:
            return compose(fault)
        if self.executor.count_ready_workers() > 0:
            return None
        return compose("service-kernels-missing" if is_compiling else "service-no-worker-started")
