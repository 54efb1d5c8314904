"""Removes finished jobs and batches after their retention time, and ends lost batches."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable
from datetime import UTC, datetime, timedelta

import structlog
from starlette.concurrency import run_in_threadpool

from service.jobs.batches.store import BatchStore
from service.jobs.job_store import JobStore
from service.jobs.store.finished_cache import FinishedJobs

MAX_REMOVED_AT_ONCE = 200
"""Maximum number of jobs that one statement removes, so that concurrent writers wait only briefly."""

MAX_PERIOD_S = 600.0
MIN_PERIOD_S = 0.5
_PAUSE_S = 0.05
"""Pause between two such statements, seconds, in which other writers get their turn."""

log = structlog.get_logger(__name__)


async def keep_tidy(store: JobStore, batches: BatchStore, finished: FinishedJobs, days: float | None) -> None:
    """End lost batches and remove jobs and batches that finished more than ``days`` ago, periodically.

    If ``days`` is None they are kept. A step that fails does not affect the others and is repeated the next time.
    """
    kept = None if days is None else timedelta(days=days)
    period_s = MAX_PERIOD_S if kept is None else min(max(kept.total_seconds() / 10, MIN_PERIOD_S), MAX_PERIOD_S)
    while True:
        await _run_logged(_settle_lost_batches(batches), "lost batches could not be ended")
        if kept is not None:
            await _run_logged(_remove_old_jobs(store, finished, kept), "old jobs could not be removed")
            await _run_logged(_remove_old_batches(batches, finished, kept), "old batches could not be removed")
        await asyncio.sleep(period_s)


async def _run_logged(work: Awaitable[None], failure: str) -> None:
    try:
        await work
    except Exception:  # any error of the database driver: the next round does the same work
        log.exception(failure)


async def _settle_lost_batches(batches: BatchStore) -> None:
    lost = await run_in_threadpool(batches.tidy)
    if lost:
        log.warning("lost batches ended", batches=lost)


async def _remove_old_jobs(store: JobStore, finished: FinishedJobs, kept: timedelta) -> None:
    removed = 0
    while gone := await run_in_threadpool(store.delete_finished, datetime.now(UTC) - kept, MAX_REMOVED_AT_ONCE):
        removed += gone
        finished.note_removal()
        await asyncio.sleep(_PAUSE_S)
    if removed:
        log.info("old jobs removed", jobs=removed)


async def _remove_old_batches(batches: BatchStore, finished: FinishedJobs, kept: timedelta) -> None:
    while await run_in_threadpool(batches.delete_finished, datetime.now(UTC) - kept):
        log.info("old batch removed")
        finished.note_removal()
        await asyncio.sleep(_PAUSE_S)
