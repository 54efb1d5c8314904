"""Writes the progress of a worker's job to the store."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import structlog

from service.jobs.job_store import JobStore
from service.jobs.store.database import is_unreachable

PERIOD_S = 0.2
"""Minimum period between two stored reports, seconds: each is a write to the disk that all workers share."""

log = structlog.get_logger(__name__)


class ProgressWriter:
    """Stores the newest report of a job, at most every :data:`PERIOD_S`, in its own thread.

    A report that follows another one closely, or arrives while the store is unreachable, is stored late and not lost:
    it may be the last one for minutes. The solver never waits for the store. A report not stored when its job ends is
    dropped.
    """

    def __init__(self, store: JobStore) -> None:
        self._store = store
        self._condition = threading.Condition()
        self._attempt: tuple[str, int] | None = None
        self._report: tuple[str, int, float, str] | None = None
        self._due = 0.0
        self._idle = False
        threading.Thread(target=self._run, name="progress", daemon=True).start()

    @contextmanager
    def track_attempt(self, job_id: str, attempt: int) -> Iterator[Callable[[float, str], None]]:
        """Yield the progress callback of an attempt, one attempt at a time; the first write comes after one period."""

        def record_progress(fraction: float, message: str) -> None:
            with self._condition:
                self._report = (job_id, attempt, fraction, message)
                if self._idle:
                    self._condition.notify()

        with self._condition:
            self._attempt = job_id, attempt
            self._due = time.monotonic() + PERIOD_S
        try:
            yield record_progress
        finally:
            with self._condition:
                self._attempt = self._report = None

    def _wait_for_report(self) -> tuple[str, int, float, str]:
        with self._condition:
            while True:
                left = self._due - time.monotonic()
                if self._report is None:
                    self._idle = True
                    self._condition.wait()
                    self._idle = False
                elif left > 0.0:
                    self._condition.wait(left)
                else:
                    report, self._report = self._report, None
                    self._due = time.monotonic() + PERIOD_S
                    return report

    def _retry(self, report: tuple[str, int, float, str]) -> None:
        with self._condition:
            # A newer report supersedes the failed one, and after the attempt there is nothing to report.
            if self._report is None and self._attempt == report[:2]:
                self._report = report

    def _run(self) -> None:
        while True:
            report = self._wait_for_report()
            try:
                self._store.record_progress(*report)  # changes nothing once the attempt has ended
            except Exception as error:  # the thread survives any error, because later jobs need it
                if is_unreachable(error):
                    self._retry(report)
                else:
                    log.exception("progress could not be stored", job=report[0], attempt=report[1])
