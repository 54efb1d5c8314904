"""Wakes the coroutines of this server that wait for changes of a job.

A change becomes known in a thread: a lane has finished a job, or :mod:`service.jobs.cluster.listener` is notified.
Nothing is read here; the woken coroutines read the store, directly or through :mod:`service.jobs.events.poller`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress


class ChangeNotifier:
    """Passes the ids of changed jobs from any thread to coroutines on one event loop."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._watches: dict[str, set[asyncio.Event]] = {}
        self._callbacks: set[Callable[[str | None], None]] = set()
        self.closed = False
        """Whether the service is stopping, so that waits must end."""

    def publish(self, job_id: str | None) -> None:
        """Wake the watchers of a job, or of all jobs if ``job_id`` is None. Callable from any thread."""
        # A job may end while the service stops. The loop may close between a check and the call, so there is no check;
        # when the loop is closed there are no watchers left.
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self._wake, job_id)

    @contextmanager
    def watch(self, job_id: str) -> Iterator[asyncio.Event]:
        """Yield an event that is set at every change of the job. For use on the event loop only."""
        event = asyncio.Event()
        # After close() no change is published any more, so a new watcher must not wait at all.
        if self.closed:
            event.set()
        self._watches.setdefault(job_id, set()).add(event)
        try:
            yield event
        finally:
            watchers = self._watches[job_id]
            watchers.discard(event)
            if not watchers:
                del self._watches[job_id]

    @contextmanager
    def watch_all(self, callback: Callable[[str | None], None]) -> Iterator[None]:
        """Call ``callback`` with the id of each job that changes.

        It is called with None if any job may have changed, and when the notifier is closed. For use on the event loop
        only.
        """
        self._callbacks.add(callback)
        try:
            yield
        finally:
            self._callbacks.discard(callback)

    def close(self) -> None:
        """Wake all watchers for the last time, so that no request delays the stop of the service."""
        self.closed = True
        for job_id in list(self._watches):
            self._wake(job_id)
        for callback in list(self._callbacks):
            callback(None)

    def _wake(self, job_id: str | None) -> None:
        job_ids = self._watches if job_id is None else [job_id]
        for watched_id in job_ids:
            for event in self._watches.get(watched_id, ()):
                event.set()
        for callback in self._callbacks:
            callback(job_id)
