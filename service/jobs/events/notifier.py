"""Wakes the coroutines of this server that wait for a job when it changes.

A change becomes known in a thread: a lane is done with a job, or :mod:`service.jobs.cluster.listener` hears of it.
Nothing is read here; whoever is woken reads the store, directly or through :mod:`service.jobs.events.poller`.
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
        """True once nobody should wait any longer, because the service stops."""

    def publish(self, job_id: str | None) -> None:
        """Wake the watchers of a job, or of all jobs where it may be any. Callable from any thread."""
        # A job may end while the service stops. The loop may close between a check and the call, so there is no check;
        # when the loop is gone, so are the watchers.
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self._wake, job_id)

    @contextmanager
    def watch(self, job_id: str) -> Iterator[asyncio.Event]:
        """An event that is set at every change of the job. To be used on the event loop only."""
        event = asyncio.Event()
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
        """Call ``callback`` with the id of every job that changes, and with None where it may be any, as at the end.

        On the event loop only.
        """
        self._callbacks.add(callback)
        try:
            yield
        finally:
            self._callbacks.discard(callback)

    def close(self) -> None:
        """Wake everybody for the last time, so that no request is kept waiting by a service that stops."""
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
