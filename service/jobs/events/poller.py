"""Polls the store for the jobs or batches with open event streams, one reader for all streams.

"Jobs" below stands for jobs or batches.

A worker stores its progress without a notification, so the store has to be polled. All followed jobs are read in one
query, every :data:`PERIOD_S` and whenever :mod:`service.jobs.events.notifier` reports a change of one of them; the load
on the store does not depend on the number of streams. Jobs without a follower are not read, finished ones not again.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Generic, Protocol, TypeVar

import structlog
from starlette.concurrency import run_in_threadpool

from service.jobs.events.notifier import ChangeNotifier
from service.jobs.store.states import Status

PERIOD_S = 0.25
"""Maximum age of the state that a stream shows, seconds. Workers store their progress at most five times a second."""

log = structlog.get_logger(__name__)


class FollowedItem(Protocol):
    """The attributes of a job that the poller needs."""

    @property
    def id(self) -> str:
        """Id of the job."""
        ...

    @property
    def tenant(self) -> str:
        """Tenant that owns the job."""
        ...

    @property
    def status(self) -> Status:
        """State of the job."""
        ...

    @property
    def revision(self) -> int:
        """Number of the revision, which increases with each change."""
        ...


F = TypeVar("F", bound=FollowedItem)
F_co = TypeVar("F_co", bound=FollowedItem, covariant=True)


class SummaryStore(Protocol[F_co]):
    """The query of a store that the poller needs."""

    def load_summaries(self, ids: Sequence[str], /) -> Mapping[str, F_co]:
        """Return the existing jobs among these ids, by id."""
        ...


@dataclass(slots=True, eq=False)
class Follower(Generic[F]):
    """One listener's view of a job: only its newest state, without a queue of older ones."""

    job: F | None = None
    """The job as last read; None before the first read, and for a job that does not exist (any more)."""
    read: bool = False
    """Whether the store has been queried for the job."""
    _changed: asyncio.Event = field(default_factory=asyncio.Event)

    async def wait_for_change(self, within_s: float) -> bool:
        """Wait for a change of the job; return False if there is none in time."""
        try:
            async with asyncio.timeout(within_s):
                await self._changed.wait()
        except TimeoutError:
            return False
        self._changed.clear()
        return True

    def update(self, job: F | None) -> None:
        """Set the state that the store holds of the job, and wake the listener if it is new."""
        if not self.read or job != self.job:
            self.job, self.read = job, True
            self._changed.set()

    def wake(self) -> None:
        """End a wait without a change."""
        self._changed.set()


class JobPoller(Generic[F]):
    """Keeps followers up to date with their jobs. For use on the event loop only."""

    def __init__(self, store: SummaryStore[F], notifier: ChangeNotifier) -> None:
        self._store = store
        self._notifier = notifier
        self._followers: dict[str, set[Follower[F]]] = {}
        self._listeners: Counter[str] = Counter()
        self._nudged = asyncio.Event()

    @property
    def listeners(self) -> int:
        """Number of followers."""
        return sum(map(len, self._followers.values()))

    def count_listeners(self, tenant: str) -> int:
        """Return the number of the tenant's followers."""
        return self._listeners[tenant]

    @property
    def closed(self) -> bool:
        """Whether the service is stopping, so that streams must end."""
        return self._notifier.closed

    @contextmanager
    def follow(self, job_id: str, tenant: str) -> Iterator[Follower[F]]:
        """Follow a job for a tenant; the first change reports its present state."""
        follower: Follower[F] = Follower()
        self._listeners[tenant] += 1
        followers = self._followers.setdefault(job_id, set())
        followers.add(follower)
        self._nudged.set()
        try:
            yield follower
        finally:
            self._listeners[tenant] -= 1
            if not self._listeners[tenant]:
                del self._listeners[tenant]
            followers.discard(follower)
            if not followers:
                self._followers.pop(job_id, None)

    async def run(self) -> None:
        """Poll the store for the followers until the service stops, then wake all of them."""
        with self._notifier.watch_all(self._handle_change):
            while not self.closed:
                await self._wait()
                self._nudged.clear()
                await self._read()
        for followers in self._followers.values():
            for follower in followers:
                follower.wake()

    def _handle_change(self, job_id: str | None) -> None:
        if job_id is None or job_id in self._followers:
            self._nudged.set()

    async def _wait(self) -> None:
        try:
            # Without an unfinished job there is nothing to poll: sleep until a follower arrives or the service stops.
            async with asyncio.timeout(PERIOD_S if self._list_unfinished() else None):
                await self._nudged.wait()
        except TimeoutError:
            pass

    async def _read(self) -> None:
        unfinished = self._list_unfinished()
        if not unfinished:
            return
        # Followers that arrive during the query wait for the next one: this answer may predate them.
        asked = [(job_id, follower) for job_id in unfinished for follower in self._followers[job_id]]
        try:
            summaries = await run_in_threadpool(self._store.load_summaries, unfinished)
        except Exception:  # any error of the database driver: the streams wait until it answers again
            log.exception("the store could not be read for the event streams")
            await asyncio.sleep(PERIOD_S)
            return
        for job_id, follower in asked:
            follower.update(summaries.get(job_id))

    def _list_unfinished(self) -> list[str]:
        """Return the ids of followed jobs that can still change."""
        return [job_id for job_id, followers in self._followers.items() if not all(map(_is_done, followers))]


def _is_done(follower: Follower[Any]) -> bool:
    return follower.read and (follower.job is None or follower.job.status.finished)
