"""Polls the store for the jobs or batches whose event streams are open: one reader for all streams together.

What is said of jobs here holds for batches too.

A worker writes its progress into the store without a notification, so the store has to be polled. All followed jobs are
read at once, every :data:`PERIOD_S` and whenever :mod:`service.jobs.events.notifier` says that one of them has changed;
the number of streams makes no difference to the store. A job that nobody follows is not read, a finished one not again.
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
"""Greatest age of what a stream shows. Workers store their progress at most five times a second."""

log = structlog.get_logger(__name__)


class Followed(Protocol):
    """What is asked of a job."""

    @property
    def id(self) -> str:
        """Its id."""
        ...

    @property
    def tenant(self) -> str:
        """Whose it is."""
        ...

    @property
    def status(self) -> Status:
        """Where it stands."""
        ...

    @property
    def revision(self) -> int:
        """Greater after each change."""
        ...


F = TypeVar("F", bound=Followed)
F_co = TypeVar("F_co", bound=Followed, covariant=True)


class Summaries(Protocol[F_co]):
    """What is asked of a store."""

    def summaries(self, ids: Sequence[str], /) -> Mapping[str, F_co]:
        """The jobs of these ids that there are, by id."""
        ...


@dataclass(slots=True, eq=False)
class Follower(Generic[F]):
    """One listener's view of a job: always its newest state, never a queue of older ones."""

    job: F | None = None
    """The job as it was read last; None before the first reading, and of a job that is not there (any more)."""
    read: bool = False
    """Whether the job was looked for in the store."""
    _changed: asyncio.Event = field(default_factory=asyncio.Event)

    async def changed(self, within_s: float) -> bool:
        """Wait for a change of the job; False when there is none in time."""
        try:
            async with asyncio.timeout(within_s):
                await self._changed.wait()
        except TimeoutError:
            return False
        self._changed.clear()
        return True

    def update(self, job: F | None) -> None:
        """Take what the store says of the job."""
        if not self.read or job != self.job:
            self.job, self.read = job, True
            self._changed.set()

    def wake(self) -> None:
        """End a wait without a change."""
        self._changed.set()


class JobPoller(Generic[F]):
    """Keeps followers up to date with their jobs. To be used on the event loop only."""

    def __init__(self, store: Summaries[F], notifier: ChangeNotifier) -> None:
        self._store = store
        self._notifier = notifier
        self._followers: dict[str, set[Follower[F]]] = {}
        self._listeners: Counter[str] = Counter()
        self._nudged = asyncio.Event()

    @property
    def listeners(self) -> int:
        """How many follow a job now."""
        return sum(map(len, self._followers.values()))

    def listeners_of(self, tenant: str) -> int:
        """How many of them are the tenant's."""
        return self._listeners[tenant]

    @property
    def closed(self) -> bool:
        """Whether nobody should listen any longer, because the service stops."""
        return self._notifier.closed

    @contextmanager
    def follow(self, job_id: str, tenant: str) -> Iterator[Follower[F]]:
        """Follow a job for a tenant; the first change is the state that it has now."""
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
        """Read for the followers until the service stops, then wake them all."""
        with self._notifier.watch_all(self._nudge):
            while not self.closed:
                await self._wait()
                self._nudged.clear()
                await self._read()
        for followers in self._followers.values():
            for follower in followers:
                follower.wake()

    def _nudge(self, job_id: str | None) -> None:
        if job_id is None or job_id in self._followers:
            self._nudged.set()

    async def _wait(self) -> None:
        try:
            async with asyncio.timeout(PERIOD_S if self._unfinished() else None):
                await self._nudged.wait()
        except TimeoutError:
            pass

    async def _read(self) -> None:
        wanted = self._unfinished()
        if not wanted:
            return
        # Whoever begins to follow during the query is left to the next one: its answer may be older than they are.
        asked = [(job_id, follower) for job_id in wanted for follower in self._followers[job_id]]
        try:
            summaries = await run_in_threadpool(self._store.summaries, wanted)
        except Exception:  # whatever a database driver raises: the streams wait until it answers again
            log.exception("the store could not be read for the event streams")
            await asyncio.sleep(PERIOD_S)
            return
        for job_id, follower in asked:
            follower.update(summaries.get(job_id))

    def _unfinished(self) -> list[str]:
        """The followed jobs that can still change."""
        return [job_id for job_id, followers in self._followers.items() if not all(map(_done, followers))]


def _done(follower: Follower[Any]) -> bool:
    return follower.read and (follower.job is None or follower.job.status.finished)
