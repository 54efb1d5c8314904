"""Work that a request waits for, done by processes of the server with limits on time and memory.

Equal requests share one call. Tenants take turns, and a call that turns out to be long cannot delay short ones
(:mod:`service.jobs.processes.request_queue`).

A *pool* has *hands*, which are threads. Each hand has a *process* that executes *calls*.
"""

from __future__ import annotations

import asyncio
import hashlib
import threading
import time
from collections.abc import Awaitable, Callable
from typing import Any, Protocol, TypeVar

from kinematics.message import SOURCE_LANGUAGE, get_language
from service.jobs.processes.request_process import call_in_language
from service.jobs.processes.request_queue import Call, RequestQueue
from service.jobs.processes.request_worker import ClientGone, GivenUp, Hand, Limits, ProcessLost, ProcessStart

__all__ = [
    "Busy",
    "ClientGone",
    "GivenUp",
    "Limits",
    "PoolMetrics",
    "ProcessLost",
    "ProcessStart",
    "RequestPool",
    "hash_call",
]

T = TypeVar("T")

MAX_WAIT_S = 20.0
"""Default time that a call waits for its turn, seconds."""

_CLIENT_CHECK_PERIOD_S, _STOP_S = 0.25, 5.0
"""Period of the check for a disconnected client, and time limit for the end of a thread, seconds."""


class Busy(Exception):
    """The call did not start in time because the pool was busy with others."""


_REASONS: dict[type[Exception], str] = {Busy: "busy", ClientGone: "gone", ProcessLost: "lost"}
"""Values of the metric's label `reason`; they stay the same when a class is renamed."""


class PoolMetrics(Protocol):
    """Counter of calls without an answer."""

    def count_given_up(self, pool: str, reason: str) -> None:
        """Count a call that ended without an answer."""
        ...


def hash_call(work: Callable[..., object], args: tuple[object, ...]) -> bytes:
    """Return a hash that is equal for calls of the same function with the same arguments."""
    return hashlib.sha256(repr((work.__module__, work.__qualname__, args)).encode()).digest()


class RequestPool:
    """Executes calls in processes. For use on one event loop only.

    Parameters
    ----------
    name : str
        Name of the threads and processes, and label in the metrics.
    start : ProcessStart
        How processes are started and prepared.
    hands : int
        Maximum number of concurrent calls, of which at most ``max_long`` may be long; by default all.
    wait_s : float
        Time that a call waits for its turn, seconds.
    """

    def __init__(
        self,
        name: str,
        start: ProcessStart,
        limits: Limits,
        *,
        hands: int = 1,
        max_long: int | None = None,
        wait_s: float = MAX_WAIT_S,
        metrics: PoolMetrics | None = None,
    ) -> None:
        self.name = name
        self._metrics, self._wait_s = metrics, wait_s
        self._beginning = threading.Lock()
        self._queue = RequestQueue(hands if max_long is None else max_long)
        self._asked: dict[bytes, tuple[Call, asyncio.Future[Any]]] = {}
        self.hands = [Hand(f"{name}-{n}", self._queue, start, limits) for n in range(hands)]

    def begin(self) -> None:
        """Start the threads unless they are running. Callable from any thread."""
        with self._beginning:
            for hand in self.hands:
                hand.begin()

    def count_calls(self) -> dict[str, int]:
        """Return the number of calls by state."""
        return self._queue.count_calls()

    async def call(self, gone: Callable[[], Awaitable[bool]], tenant: str, work: Callable[..., T], *args: object) -> T:
        """Call a function of a module in a process and return its answer.

        Parameters
        ----------
        gone : callable
            Returns whether the client has disconnected.
        tenant : str
            Tenant whose turn the call takes.

        Raises
        ------
        Busy, GivenUp, ClientGone, ProcessLost
            And the exceptions of the function.
        """
        try:
            answer: T = await self._wait_for(gone, tenant, work, args)
            return answer
        except GivenUp as error:
            self._count(error.of)
            raise
        except (Busy, ClientGone, ProcessLost) as error:
            self._count(_REASONS[type(error)])
            raise

    def stop(self) -> None:
        """End the processes and the threads within a second."""
        for hand in self.hands:
            hand.stopping.set()
        self._queue.close()
        for hand in self.hands:
            if hand.is_alive():
                hand.join(_STOP_S)

    def _count(self, reason: str) -> None:
        if self._metrics is not None:
            self._metrics.count_given_up(self.name, reason)

    async def _wait_for(
        self, gone: Callable[[], Awaitable[bool]], tenant: str, work: Callable[..., object], args: tuple[object, ...]
    ) -> Any:
        self.begin()
        if get_language() != SOURCE_LANGUAGE:
            work, args = call_in_language, (get_language(), work, *args)
        key = hash_call(work, args)
        # Equal requests share one call; the last of them to leave abandons it.
        if key not in self._asked:
            call = Call(work, args, tenant)
            self._asked[key] = call, asyncio.wrap_future(call.future)
            self._queue.add(call)
        call, answer = self._asked[key]
        call.waiting += 1
        latest = time.monotonic() + self._wait_s
        try:
            while not answer.done():
                await asyncio.wait([answer], timeout=_CLIENT_CHECK_PERIOD_S)
                if not answer.done() and await gone():
                    raise ClientGone
                if not answer.done() and not call.running and time.monotonic() > latest:
                    raise Busy
            return answer.result()
        finally:
            call.waiting -= 1
            if call.waiting == 0:
                call.abandoned.set()
                answer.cancel()
                del self._asked[key]
