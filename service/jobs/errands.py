"""Errands: work that a request waits for itself, done by processes of the server's with the limits of jobs.

Each process belongs to a thread, a *hand*, and has one errand after the other. It is started by the first of them, and
ends when there has been none for a while. It is killed, and the next errand starts another, where one takes too long or
too much memory, or nobody waits for it any more: native code cannot be stopped otherwise. Requests for the same wait
for one errand.
"""

from __future__ import annotations

import asyncio
import hashlib
import pickle
import queue
import threading
import time
from collections.abc import Awaitable, Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import cached_property
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Literal

import structlog

from service.jobs.orphans import tell_children

MAX_WAIT_S = 20.0
"""How long an errand waits for its turn."""

START_S = 300.0
"""How long a process may take to start: where nothing is compiled yet, that is a minute."""

IDLE_S = 600.0
"""After how long without an errand a process ends."""

_PERIOD_S, _GONE_PERIOD_S, _STOP_S = 0.02, 0.25, 5.0
"""How often it is looked whether an errand is left, and whether a client is gone; how long the end may take."""

log = structlog.get_logger(__name__)


class Busy(Exception):
    """Others have kept this errand from being begun in time."""


class Lost(Exception):
    """There is no process to do it, for a reason that is not its own."""


class Gone(Exception):
    """The client has gone away."""


class GivenUp(Exception):
    """The errand took more ``of`` something than it may."""

    def __init__(self, of: Literal["time", "memory"]) -> None:
        super().__init__(f"it takes more {of} than it may")
        self.of = of


def digest(work: Callable[..., Any], args: tuple[Any, ...]) -> bytes:
    """What tells errands apart."""
    return hashlib.sha256(repr((work.__module__, work.__qualname__, args)).encode()).digest()


@dataclass
class _Errand:
    work: Callable[..., Any]
    args: tuple[Any, ...]
    future: Future[Any] = field(default_factory=Future)
    left: threading.Event = field(default_factory=threading.Event)
    waiting: int = 0

    @cached_property
    def answer(self) -> asyncio.Future[Any]:
        """For all who wait on the event loop."""
        return asyncio.wrap_future(self.future)


class Errands:
    """Has errands done. To be used on one event loop only.

    Parameters
    ----------
    name : str
        Of threads and processes.
    prepare : callable
        Called first of all in a process, with ``settings``; it confines the process and limits its memory.
    limit_s : float
        How long an errand may take.
    hands : int
        Errands that are done at once.
    """

    def __init__(
        self, name: str, prepare: Callable[..., None], settings: tuple[Any, ...], *, limit_s: float, hands: int = 1
    ) -> None:
        self._queue: queue.SimpleQueue[_Errand | None] = queue.SimpleQueue()
        self._asked: dict[bytes, _Errand] = {}
        self.hands = [_Hand(f"{name}-{n}", self._queue, prepare, settings, limit_s) for n in range(hands)]

    async def call(self, gone: Callable[[], Awaitable[bool]], work: Callable[..., Any], *args: Any) -> Any:
        """Call a function of a module in a process, and have its answer.

        Parameters
        ----------
        gone : callable
            Whether the client waits no more.

        Raises
        ------
        Busy, GivenUp, Gone, Lost
            And what the function raises.
        """
        for hand in self.hands:
            hand.begin()
        key = digest(work, args)
        errand = self._asked.get(key)
        if errand is None:
            errand = self._asked[key] = _Errand(work, args)
            self._queue.put(errand)
        errand.waiting += 1
        latest = time.monotonic() + MAX_WAIT_S
        try:
            while not errand.answer.done():
                await asyncio.wait([errand.answer], timeout=_GONE_PERIOD_S)
                if not errand.answer.done() and await gone():
                    raise Gone
                if not errand.answer.done() and not errand.future.running() and time.monotonic() > latest:
                    raise Busy
            return errand.answer.result()
        finally:
            errand.waiting -= 1
            if errand.waiting == 0:
                errand.left.set()
                errand.answer.cancel()
                del self._asked[key]

    def stop(self) -> None:
        """End the processes and the threads, within a second."""
        for hand in self.hands:
            hand.stopping.set()
            self._queue.put(None)
        for hand in self.hands:
            if hand.is_alive():
                hand.join(_STOP_S)


class _Hand(threading.Thread):
    """A thread that has a process, which dies with it (:func:`service.jobs.orphans.die_with`)."""

    def __init__(
        self,
        name: str,
        errands: queue.SimpleQueue[_Errand | None],
        prepare: Callable[..., None],
        settings: tuple[Any, ...],
        limit_s: float,
    ) -> None:
        super().__init__(name=name, daemon=True)
        self.stopping = threading.Event()
        self.process: BaseProcess | None = None
        self._pipe: Connection | None = None
        self._errands, self._prepare, self._settings, self._limit_s = errands, prepare, settings, limit_s

    def begin(self) -> None:
        """Start the thread, if that has not been done."""
        if self.ident is None:
            self.start()

    def run(self) -> None:
        """Do errands until told to stop."""
        while not self.stopping.is_set():
            try:
                errand = self._errands.get(timeout=IDLE_S)
            except queue.Empty:
                self._end()
                continue
            if errand is None or errand.left.is_set() or not errand.future.set_running_or_notify_cancel():
                continue
            try:
                errand.future.set_result(self._done(errand))
            except Exception as error:  # whatever it is: the future raises it in the request, and the thread goes on
                errand.future.set_exception(error)
        self._end()

    def _done(self, errand: _Errand) -> Any:
        pipe = self._begun(errand) or self._begun(errand)
        if pipe is None:
            raise Lost(f"the process {self.name} takes no errand")
        try:
            raised, answer = self._received(pipe, errand, self._limit_s)
        except EOFError:
            # Native code that gets no memory ends its process.
            raised, answer = True, MemoryError()
        except (Gone, GivenUp):
            self._end()
            raise
        if isinstance(answer, MemoryError):
            self._end()
            log.warning("an errand was given up", of="memory", work=errand.work.__name__)
            raise GivenUp("memory")
        if raised:
            raise answer
        return answer

    def _begun(self, errand: _Errand) -> Connection | None:
        """The pipe to the process that has taken the errand; none where it has died idle, just now."""
        pipe = self._ready(errand)
        try:
            pipe.send((errand.work, errand.args))
            self._received(pipe, errand, self._limit_s)
        except (EOFError, OSError):
            self._end()
            return None
        except (Gone, GivenUp):
            self._end()
            raise
        return pipe

    def _received(self, pipe: Connection, errand: _Errand, limit_s: float) -> Any:
        """What the process sends; ``EOFError`` where it has ended instead."""
        latest = time.monotonic() + limit_s
        while not wait([pipe], timeout=_PERIOD_S):
            if errand.left.is_set() or self.stopping.is_set():
                raise Gone
            if time.monotonic() > latest:
                log.warning("an errand was given up", of="time", work=errand.work.__name__)
                raise GivenUp("time")
        try:
            return pipe.recv()
        except OSError as error:
            raise EOFError from error

    def _ready(self, errand: _Errand) -> Connection:
        """The pipe to a process that waits for errands; a new one where there is none, or where it has died idle."""
        if self.process is not None and not self.process.is_alive():
            self._end()
        if self._pipe is not None:
            return self._pipe
        tell_children()
        # spawn: a forked child would inherit the server's threads' locks and open connections.
        context = get_context("spawn")
        ours, theirs = context.Pipe()
        self.process = context.Process(
            target=_serve, args=(theirs, self._prepare, self._settings), name=self.name, daemon=True
        )
        self.process.start()
        theirs.close()
        self._pipe = ours
        try:
            self._received(ours, errand, START_S)
        except Gone:
            self._end()
            raise
        except (EOFError, GivenUp) as error:
            self._end()
            raise Lost(f"the process {self.name} did not start") from error
        return ours

    def _end(self) -> None:
        process, pipe = self.process, self._pipe
        self.process = self._pipe = None
        if pipe is not None:
            pipe.close()
        if process is not None:
            process.kill()
            process.join(_STOP_S)


def _serve(pipe: Connection, prepare: Callable[..., None], settings: tuple[Any, ...]) -> None:
    """Do errands from a pipe until it is closed.

    Each is answered twice: when it has been taken; and by whether it has raised, and its answer or what it has raised.
    """
    prepare(*settings)
    pipe.send(None)
    while True:
        try:
            work, args = pipe.recv()
        except EOFError:
            return
        pipe.send(None)
        try:
            answer = False, work(*args)
        except MemoryError:
            answer = True, MemoryError()
        except Exception as error:  # whatever it is: told with its trace here, and raised in the server, a 500 there
            log.exception("an errand has failed", work=work.__name__)
            answer = True, _sendable(error)
        pipe.send(answer)


def _sendable(error: Exception) -> Exception:
    """An exception as it is, or by its words where a pipe cannot carry it: the process would end, as without memory."""
    try:
        pickle.loads(pickle.dumps(error))
    except (TypeError, AttributeError, ValueError, pickle.PickleError):
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error
