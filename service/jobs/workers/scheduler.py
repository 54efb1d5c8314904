"""The scheduler: chooses the job that the next free lane gets. Lanes ask it, and it asks the store.

The store decides whose turn it is among the tenants (:func:`service.jobs.store.statements.build_turn`). The scheduler
decides which *cost* a lane may take, so that short jobs never wait for long ones to end. Fewer long jobs may run than
there are lanes, so a lane is reserved for short jobs, and a job estimated as short that takes long counts as long from
then on. If lanes are free for both, short and long jobs alternate. The reserved lanes are not given to a tenant who
already has a short job running: a tenant who floods the queue leaves them to the others.

The store is queried when a job has been queued (:meth:`Turns.wake`), when a lane becomes free, and once a second,
because another server or host may have requeued a job, or a notification may have been lost.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import structlog
from sqlalchemy.exc import SQLAlchemyError
from ulid import ULID

from service.jobs.job_store import JobStore
from service.jobs.store.database import is_unreachable
from service.jobs.store.schema import Claim
from service.jobs.store.states import Cost

ASK_PERIOD_S = 1.0
"""Period at which a free lane asks for a job by itself, seconds. In between, lanes check their workers."""

PATIENCE_S = 10.0
"""Idle time after which a lane takes a long job although no other worker is ready for short ones, seconds. After this
time it is assumed that no other worker can be started."""

SHORT_S = 2.0
"""Time after which a job estimated as short counts as long, seconds."""

log = structlog.get_logger(__name__)


class Seat(Protocol):
    """The attributes of a lane that the scheduler needs."""

    @property
    def ready(self) -> bool:
        """Whether the worker has finished starting."""
        ...

    @property
    def is_settled(self) -> bool:
        """Whether the first worker has started or failed to start. A lane that is not settled will be ready soon."""
        ...


@dataclass(frozen=True, slots=True)
class _RunningJob:
    """The job that a lane runs."""

    tenant: str
    cost: Cost


class Turns:
    """Gives jobs to the lanes of one process, of which ``most_long`` may run long jobs. Safe to use from all lanes."""

    def __init__(self, store: JobStore, seats: Sequence[Seat], most_long: int) -> None:
        self._store = store
        self._seats = seats
        self._most_long = most_long
        self._asking = threading.Lock()
        self._news = threading.Condition()
        self._calls = 0
        self._open = False
        self._busy: dict[Seat, _RunningJob] = {}
        self._doubtful: str | None = None
        self._before = Cost.LONG

    def open(self) -> None:
        """Start to give out jobs: the store has its tables, and its running jobs have owners."""
        with self._news:
            self._open = True
            self._news.notify_all()

    def close(self) -> None:
        """Give out no more jobs, and end all waits."""
        with self._news:
            self._open = False
            self._calls += 1
            self._news.notify_all()

    def wake(self, jobs: int = 1) -> None:
        """Wake waiting lanes, one for each of ``jobs`` jobs that may have been queued. Callable from any thread."""
        with self._news:
            self._calls += jobs
            self._news.notify(jobs)

    def take(self, seat: Seat, free_since: float) -> Claim | None:
        """Claim a job for a lane that has been free since ``free_since`` (monotonic clock, seconds).

        Wait up to :data:`ASK_PERIOD_S` for one; return None if there is none. The lane reports the end by
        :meth:`release`.
        """
        with self._news:
            calls, claim = self._calls, None
            was_open = self._open
        if was_open:
            claim = self._request_claim(seat, free_since)
        with self._news:
            # An empty answer settles all calls made before the question; a claim settles one of them.
            self._calls = max(0, self._calls - (calls if claim is None else 1))
            if claim is None:
                self._news.wait_for(lambda: self._calls > 0 or self._open != was_open, ASK_PERIOD_S)
        return claim

    def release(self, seat: Seat) -> None:
        """Note that the lane is free again."""
        with self._news:
            self._busy.pop(seat, None)

    def count_as_long(self, seat: Seat) -> bool:
        """Count the job of a lane as long from now on; return whether it must release the lane.

        It must if no lane is left for short jobs.
        """
        with self._news:
            self._busy[seat] = replace(self._busy[seat], cost=Cost.LONG)
            if not self._reserved_count or any(not self._is_long(other) for other in self._seats):
                return False
            del self._busy[seat]
            return True

    @property
    def _reserved_count(self) -> int:
        """Number of lanes reserved for short jobs."""
        return len(self._seats) - self._most_long

    def _is_long(self, seat: Seat) -> bool:
        claim = self._busy.get(seat)
        return claim is not None and claim.cost == Cost.LONG

    def _request_claim(self, seat: Seat, free_since: float) -> Claim | None:
        with self._asking:
            try:
                claim = self._claim_next(self._order_costs(seat, free_since), self._list_excluded_tenants(seat))
            except SQLAlchemyError as error:
                if not is_unreachable(error):
                    log.exception("the store could not be asked for a job")
                return None
            if claim is not None:
                self._before = claim.cost
                with self._news:
                    self._busy[seat] = _RunningJob(claim.tenant, claim.cost)
            return claim

    def _claim_next(self, costs: Sequence[Cost], passed_over: Collection[str]) -> Claim | None:
        if self._doubtful is not None:  # the connection broke during a claim, which may have succeeded
            claim = self._store.find_claim(self._doubtful)
            self._doubtful = None
            if claim is not None:
                return claim
        self._doubtful = mark = str(ULID())
        claim = self._store.take(mark, costs, passed_over)
        self._doubtful = None
        return claim

    def _order_costs(self, seat: Seat, free_since: float) -> Sequence[Cost]:
        if not self._is_long_allowed(seat, free_since):
            return (Cost.SHORT,)
        # Alternate: the cost that was not served last comes first.
        return (Cost.SHORT, Cost.LONG) if self._before == Cost.LONG else (Cost.LONG, Cost.SHORT)

    def _list_excluded_tenants(self, seat: Seat) -> Collection[str]:
        """Return the tenants whose short jobs the lane must skip.

        If only reserved lanes are free, these are the tenants with a short job running.
        """
        with self._news:
            free = sum(other is not seat and other not in self._busy for other in self._seats)
            if free >= self._reserved_count:
                return ()
            return {claim.tenant for claim in self._busy.values() if claim.cost == Cost.SHORT}

    def _is_long_allowed(self, seat: Seat, free_since: float) -> bool:
        with self._news:
            free = [other for other in self._seats if other is not seat and not self._is_long(other)]
        if len(self._seats) - 1 - len(free) >= self._most_long:
            return False
        if not self._reserved_count or time.monotonic() > free_since + PATIENCE_S:
            return True
        return any(other.ready or not other.is_settled for other in free)
