"""Parts are made in a process of their own, one request after the other, with the limits of jobs.

The process is started by the first request, which waits some seconds for it, and ends when nobody has asked for a
while. It is killed, and the next request starts another, where a request takes too long or its client has gone away:
native code cannot be stopped otherwise.
"""

from __future__ import annotations

import asyncio
import hashlib
import os
import queue
import threading
import time
from collections import OrderedDict
from collections.abc import Awaitable, Callable
from concurrent.futures import CancelledError, Future, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from importlib import import_module
from multiprocessing import get_context
from typing import Any

import pebble
import structlog

from service.jobs.confined import confine, limit_memory
from service.jobs.orphans import tell_children
from service.jobs.worker import LIBRARIES_MB
from service.logs import Format
from service.parts.extra import installed

MAX_PARTS_S = 60.0
"""How long parts may be made; no longer than a job."""

MAX_WAIT_S = 20.0
"""How long a request waits for its turn."""

START_TIMEOUT_S = 300.0
"""How long the process may take to start: where nothing is compiled yet, that is a minute."""

IDLE_S = 600.0
"""After how long without a request the process ends."""

KEPT_BYTES = 64 << 20
"""Files that are kept for those who ask for the same again."""

CAD_MB = 800
"""What the libraries of solids take beside what a job is allowed."""

_PERIOD_S, _GONE_PERIOD_S = 0.02, 0.25
"""How often it is looked whether a result is there, and whether the client is."""

log = structlog.get_logger(__name__)


class Busy(Exception):
    """Other parts have kept these from being begun in time."""


class Lost(Exception):
    """There is no process to make parts, for a reason that is not theirs."""


class GivenUp(Exception):
    """The parts took too long, or more memory than they may."""


class Gone(Exception):
    """The client has gone away."""


@dataclass
class _Call:
    work: Callable[..., Any]
    args: tuple[Any, ...]
    future: Future[Any] = field(default_factory=Future)
    abandoned: threading.Event = field(default_factory=threading.Event)


class Workshop:
    """Has parts made. To be used on one event loop only.

    Parameters
    ----------
    memory_mb : int
        What one request may take beyond the idle process, MiB.
    timeout_s : float
        How long a job may take.
    log_level, log_format : str
        Of the process.
    """

    def __init__(self, memory_mb: int, timeout_s: float, log_level: str = "info", log_format: Format = "text") -> None:
        self._settings = os.getpid(), log_level, log_format, memory_mb
        self._timeout_s = min(timeout_s, MAX_PARTS_S)
        self._calls: queue.SimpleQueue[_Call | None] = queue.SimpleQueue()
        self._kept: OrderedDict[bytes, bytes] = OrderedDict()
        self._thread: threading.Thread | None = None
        self._stopping = threading.Event()
        self._pool: Any = None

    async def call(self, gone: Callable[[], Awaitable[bool]], work: Callable[..., Any], *args: Any) -> Any:
        """Call a function of a module in the process, and have its answer.

        Parameters
        ----------
        gone : callable
            Whether nobody waits any more.

        Raises
        ------
        Busy, GivenUp, Gone, Lost
            And what the function raises.
        """
        if self._thread is None:
            # The process dies with the thread that starts it, so this one lives as long as the workshop.
            self._thread = threading.Thread(target=self._serve, name="workshop", daemon=True)
            self._thread.start()
        call = _Call(work, args)
        self._calls.put(call)
        answer = asyncio.wrap_future(call.future)
        latest = time.monotonic() + MAX_WAIT_S
        try:
            while not answer.done():
                await asyncio.wait([answer], timeout=_GONE_PERIOD_S)
                if not answer.done() and await gone():
                    raise Gone
                if not answer.done() and not call.future.running() and time.monotonic() > latest:
                    raise Busy
            return answer.result()
        finally:
            call.abandoned.set()
            answer.cancel()

    async def kept(self, key: str, make: Callable[[], Awaitable[bytes]]) -> bytes:
        """What was made of the same before, or is made now."""
        digest = hashlib.sha256(key.encode()).digest()
        if digest in self._kept:
            self._kept.move_to_end(digest)
            return self._kept[digest]
        made = await make()
        self._kept[digest] = made
        while sum(map(len, self._kept.values())) > KEPT_BYTES:
            self._kept.popitem(last=False)
        return made

    def stop(self) -> None:
        """End the process and the thread, within a second."""
        self._stopping.set()
        self._calls.put(None)
        if self._thread is not None:
            self._thread.join(5.0)

    def _serve(self) -> None:
        while not self._stopping.is_set():
            try:
                call = self._calls.get(timeout=IDLE_S)
            except queue.Empty:
                self._end()
                continue
            if call is None or call.abandoned.is_set() or not call.future.set_running_or_notify_cancel():
                continue
            try:
                call.future.set_result(self._answer(call))
            except Exception as error:  # raised where the answer is awaited, as the future has it
                call.future.set_exception(error)
        self._end()

    def _answer(self, call: _Call) -> Any:
        if self._pool is None or not self._pool.active:
            self._end()
            tell_children()
            self._pool = pebble.ProcessPool(
                max_workers=1,
                initializer=_start,
                initargs=self._settings,
                context=get_context("spawn"),
            )
            self._waited(call, _hello, (), START_TIMEOUT_S)
        return self._waited(call, call.work, call.args, self._timeout_s)

    def _waited(self, call: _Call, work: Callable[..., Any], args: tuple[Any, ...], limit_s: float) -> Any:
        try:
            running = self._pool.schedule(work, args=args)
        except RuntimeError as error:  # the pool has broken since it was looked at
            self._end()
            raise Lost from error
        latest = time.monotonic() + limit_s
        while not wait([running], timeout=_PERIOD_S).done:
            if call.abandoned.is_set() or self._stopping.is_set():
                self._end()
                raise Gone
            if time.monotonic() > latest:
                self._end()
                raise GivenUp
        try:
            return running.result()
        except (CancelledError, BrokenProcessPool) as error:  # the pool has no process
            self._end()
            raise Lost from error
        except (MemoryError, pebble.ProcessExpired) as error:
            log.warning("parts were given up", error=type(error).__name__)
            self._end()
            raise GivenUp from None

    def _end(self) -> None:
        pool, self._pool = self._pool, None
        if pool is not None:
            pool.stop()
            pool.join()


def _start(server_pid: int, log_level: str, log_format: Format, memory_mb: int) -> None:
    """Prepare the process: its end, its limits, its libraries."""
    confine(server_pid, log_level, log_format)
    import_module("service.parts.orders")
    if installed():
        import_module("build123d")
    limit_memory(memory_mb + LIBRARIES_MB + CAD_MB)


def filled(*args: Any) -> Any:
    """:func:`service.parts.orders.filled`, which is imported in the process alone."""
    from service.parts import orders

    return orders.filled(*args)


def part_filled(*args: Any) -> Any:
    """:func:`service.parts.orders.part_filled`, likewise."""
    from service.parts import orders

    return orders.part_filled(*args)


def _hello() -> int:
    """The answer shows that the process has started."""
    return os.getpid()
