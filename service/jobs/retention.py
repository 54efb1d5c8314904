"""Removes finished jobs and batches when their time is over."""

from __future__ import annotations

import asyncio
from datetime import UTC, datetime, timedelta

import structlog
from starlette.concurrency import run_in_threadpool

from service.jobs.batches.store import BatchStore
from service.jobs.finished import FinishedJobs
from service.jobs.store import JobStore

MAX_REMOVED_AT_ONCE = 200
"""Jobs removed by one statement, so that nobody who writes meanwhile waits for long."""

MAX_PERIOD_S = 3600.0
MIN_PERIOD_S = 0.5
_PAUSE_S = 0.05
"""Between two such statements, so that others get to write."""

log = structlog.get_logger(__name__)


async def keep_tidy(store: JobStore, batches: BatchStore, finished: FinishedJobs, days: float | None) -> None:
    """Remove jobs and batches that finished more than ``days`` ago, now and again and again.

    Nothing where ``days`` is None.
    """
    if days is None:
        return
    kept = timedelta(days=days)
    period_s = min(max(kept.total_seconds() / 10, MIN_PERIOD_S), MAX_PERIOD_S)
    while True:
        removed = 0
        try:
            while gone := await run_in_threadpool(store.delete_finished, datetime.now(UTC) - kept, MAX_REMOVED_AT_ONCE):
                removed += gone
                finished.removed()
                await asyncio.sleep(_PAUSE_S)
            while await run_in_threadpool(batches.delete_finished, datetime.now(UTC) - kept):
                log.info("old batch removed")
                finished.removed()
                await asyncio.sleep(_PAUSE_S)
        except Exception:  # whatever a database driver raises: the jobs are still there the next time
            log.exception("old jobs could not be removed")
        if removed:
            log.info("old jobs removed", jobs=removed)
        await asyncio.sleep(period_s)
