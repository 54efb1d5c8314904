"""Turns: which job the next free lane gets. The lanes of a server or worker host ask here, and this asks the store.

Whose turn it is among the tenants stands in the store (:func:`service.jobs.store.statements.turn_of`). What is decided
here is which *cost* a lane may take, so that short jobs never wait for long ones to end: there are more lanes than long
jobs may run, so that one is left for short jobs, and what is expected to be short and takes long counts as long from
then on. Where lanes are free for both, short and long jobs go by turns too. And the lanes that are left for short jobs
are not given to a tenant who has one running: whoever floods the queue leaves them free for the others.

The store is asked when a job has been queued (:meth:`Turns.wake`), when a lane becomes free, and once a second: another
server or host may have put a job back, or the news may have been lost.
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
from service.jobs.store.database import unreachable
from service.jobs.store.schema import Claim
from service.jobs.store.states import Cost

ASK_PERIOD_S = 1.0
"""Period at which a free lane asks by itself. Lanes look after their workers in between."""

PATIENCE_S = 10.0
"""A free lane takes a long job after so long, although no other worker is ready for short ones: none can be started."""

SHORT_S = 2.0
"""A job that takes longer counts as long, whatever was expected of it."""

log = structlog.get_logger(__name__)


class Seat(Protocol):
    """What is asked of a lane."""

    @property
    def ready(self) -> bool:
        """Whether its worker has finished starting."""
        ...

    @property
    def is_settled(self) -> bool:
        """Whether its first worker has started, or has failed to. A lane that has not begun soon will be ready."""
        ...


@dataclass(frozen=True, slots=True)
class _Held:
    """What a lane is busy with."""

    tenant: str
    cost: Cost


class Turns:
    """Gives jobs to the lanes of one process; ``most_long`` of them may run long jobs. Safe to use from all lanes."""

    def __init__(self, store: JobStore, seats: Sequence[Seat], most_long: int) -> None:
        self._store = store
        self._seats = seats
        self._most_long = most_long
        self._asking = threading.Lock()
        self._news = threading.Condition()
        self._calls = 0
        self._open = False
        self._busy: dict[Seat, _Held] = {}
        self._doubtful: str | None = None
        self._before = Cost.LONG

    def open(self) -> None:
        """Begin to give out jobs: the store has its tables, and whatever is running in it is somebody's."""
        with self._news:
            self._open = True
            self._news.notify_all()

    def close(self) -> None:
        """Give out no more jobs, and let nobody wait for one."""
        with self._news:
            self._open = False
            self._calls += 1
            self._news.notify_all()

    def wake(self) -> None:
        """A job has been queued, or may have been. Callable from any thread."""
        with self._news:
            self._calls += 1
            self._news.notify()

    def take(self, seat: Seat, free_since: float) -> Claim | None:
        """A job for a lane that is free since then (monotonic seconds), claimed; None where there is none for a while.

        Waits up to :data:`ASK_PERIOD_S` for a job. The lane says when it is done with it (:meth:`done`).
        """
        with self._news:
            calls, claim = self._calls, None
            asked = self._open
        if asked:
            claim = self._asked(seat, free_since)
        with self._news:
            # What was called for before the question is answered by it, if there is no more.
            self._calls = max(0, self._calls - (calls if claim is None else 1))
            if claim is None:
                self._news.wait_for(lambda: self._calls > 0 or self._open != asked, ASK_PERIOD_S)
        return claim

    def done(self, seat: Seat) -> None:
        """The lane is free again."""
        with self._news:
            self._busy.pop(seat, None)

    def outstayed(self, seat: Seat) -> bool:
        """Count the job of a lane as long from now on; whether it is to give the lane back.

        That is where no lane is left that short jobs are kept.
        """
        with self._news:
            self._busy[seat] = replace(self._busy[seat], cost=Cost.LONG)
            if not self._kept or any(not self._is_long(other) for other in self._seats):
                return False
            del self._busy[seat]
            return True

    @property
    def _kept(self) -> int:
        """How many lanes are kept for short jobs."""
        return len(self._seats) - self._most_long

    def _is_long(self, seat: Seat) -> bool:
        held = self._busy.get(seat)
        return held is not None and held.cost == Cost.LONG

    def _asked(self, seat: Seat, free_since: float) -> Claim | None:
        with self._asking:
            try:
                claim = self._given(self._costs(seat, free_since), self._passed_over(seat))
            except SQLAlchemyError as error:
                if not unreachable(error):
                    log.exception("the store could not be asked for a job")
                return None
            if claim is not None:
                self._before = claim.cost
                with self._news:
                    self._busy[seat] = _Held(claim.tenant, claim.cost)
            return claim

    def _given(self, costs: Sequence[Cost], passed_over: Collection[str]) -> Claim | None:
        if self._doubtful is not None:  # the store may have given a job, and not have come to say so
            claim = self._store.claimed(self._doubtful)
            self._doubtful = None
            if claim is not None:
                return claim
        self._doubtful = mark = str(ULID())
        claim = self._store.take(mark, costs, passed_over)
        self._doubtful = None
        return claim

    def _costs(self, seat: Seat, free_since: float) -> Sequence[Cost]:
        if not self._may_take_long(seat, free_since):
            return (Cost.SHORT,)
        return (Cost.SHORT, Cost.LONG) if self._before == Cost.LONG else (Cost.LONG, Cost.SHORT)

    def _passed_over(self, seat: Seat) -> Collection[str]:
        """Tenants whose short jobs the lane leaves: where only kept lanes are free, those who have one running."""
        with self._news:
            free = sum(other is not seat and other not in self._busy for other in self._seats)
            if free >= self._kept:
                return ()
            return {held.tenant for held in self._busy.values() if held.cost == Cost.SHORT}

    def _may_take_long(self, seat: Seat, free_since: float) -> bool:
        with self._news:
            free = [other for other in self._seats if other is not seat and not self._is_long(other)]
        if len(self._seats) - 1 - len(free) >= self._most_long:
            return False
        if not self._kept or time.monotonic() > free_since + PATIENCE_S:
            return True
        return any(other.ready or not other.is_settled for other in free)
