"""The operations on batches that the API offers: store, executor and notifier behind one object."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import structlog
from starlette.concurrency import run_in_threadpool

from service.jobs.batches.plan import Plan
from service.jobs.batches.rows import BatchRow, BatchSummary
from service.jobs.batches.store import BatchStore
from service.jobs.batches.table import Table, build_table
from service.jobs.events.notifier import ChangeNotifier
from service.jobs.executor import Executor
from service.jobs.store.admission import Repeatable
from service.jobs.store.finished_cache import FinishedJobs
from service.jobs.store.states import Cost
from service.observability.metrics import Metrics
from service.observability.telemetry import measure_span

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class BatchDesk:
    """Accepts, shows, cancels and removes batches. Runs on the event loop; queries the store in a thread."""

    store: BatchStore
    executor: Executor
    notifier: ChangeNotifier
    metrics: Metrics
    max_queued: int
    finished: FinishedJobs

    async def accept(
        self, *, tenant: str, kind: str, label: str | None, plan: Plan, cost: Cost, repeatable: Repeatable | None
    ) -> BatchRow:
        """Store a batch and submit it.

        A repeated request with the same key returns the batch that the first request created.

        Raises
        ------
        KeyReused
            If the key was used with a different request before.
        QueueFull
            If the tenant's queue is full.
        """
        with measure_span("store"):
            batch, shares = await run_in_threadpool(
                self.store.create,
                tenant=tenant,
                kind=kind,
                label=label,
                plan=plan,
                cost=cost,
                max_queued=self.max_queued,
                repeatable=repeatable,
            )
        if shares:
            log.info("batch accepted", batch=batch.id, kind=kind, samples=batch.total)
            self.metrics.count_batch(kind)
        for share in shares:
            self.executor.submit(share)
        return batch

    async def get(self, tenant: str, batch_id: str) -> BatchRow | None:
        """Return the batch; None if it does not exist or belongs to another tenant."""
        batch = await run_in_threadpool(self.store.get, batch_id)
        return batch if batch is not None and batch.tenant == tenant else None

    async def list_page(self, *, tenant: str, limit: int, before: str | None) -> list[BatchSummary]:
        """Return at most ``limit`` batches of the tenant, newest first."""
        return await run_in_threadpool(self.store.list_page, tenant=tenant, limit=limit, before=before)

    async def load_table(self, batch: BatchRow) -> tuple[Plan, Table] | None:
        """Return the plan and the table of a batch; None if it has been removed since it was read."""
        return await run_in_threadpool(self._load_table, batch)

    def _load_table(self, batch: BatchRow) -> tuple[Plan, Table] | None:
        plan = self.store.load_plan(batch)
        return None if plan is None else (plan, build_table(batch, plan, self.store.load_rows(batch)))

    async def cancel_or_delete(self, tenant: str, batch_id: str) -> BatchRow | Literal["deleted"] | None:
        """Cancel an unfinished batch and return it, or remove a finished one; None if the tenant has no such batch.

        The samples of a cancelled batch that have ended are kept. A batch that ends by itself while it is being
        cancelled is returned and not removed.
        """
        batch = await self.get(tenant, batch_id)
        if batch is None:
            return None
        if batch.status.finished:
            try:
                return "deleted" if await run_in_threadpool(self.store.delete, batch_id) else None
            finally:
                # The cache holds samples by their own ids, which are not listed here: drop all of them.
                self.finished.note_removal()
        shares = await run_in_threadpool(self.store.cancel, batch_id)
        if shares is not None:
            log.info("batch cancelled", batch=batch_id)
            for share in shares:
                self.executor.cancel(share)
            self.notifier.publish(batch_id)
        return await self.get(tenant, batch_id)
