"""Files that clients send are read by processes of their own, a file each at a time, within bounded time and memory.

A reader that takes too long or too much is killed and replaced, so that no file can hold the server up or take it down
with it. Each process belongs to a thread of the server, which starts it when the first file comes.
"""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from queue import SimpleQueue
from typing import Any

import structlog

from service.imports import reader
from service.imports.limits import MEMORY_MB, READ_S
from service.jobs.orphans import tell_children
from service.logs import Format
from service.outlines.faults import Unsuitable

READERS = 2
"""Files that are read at once."""

MAX_WAIT_S = 20.0
"""How long a file waits for its turn."""

START_S = 120.0
"""A process imports its libraries in two seconds, on a very busy machine in twenty."""

_STOP_S = 1.0

log = structlog.get_logger(__name__)


class Busy(Exception):
    """Other files have kept this one from being begun in time."""


class ReaderLost(Exception):
    """The process has raised what no file should make it raise, or did not start."""


@dataclass(frozen=True)
class _Call:
    future: Future[bytes]
    door: reader.Door
    content: bytes
    asked: Mapping[str, Any]


class ImportDesk:
    """Has files read, each in its turn; ``memory_mb`` is what a file may take."""

    def __init__(self, log_level: str, log_format: Format, memory_mb: int = MEMORY_MB) -> None:
        self._calls: SimpleQueue[_Call | None] = SimpleQueue()
        self._settings = (os.getpid(), log_level, log_format, memory_mb)
        self._lock = threading.Lock()
        self._hands: list[_Hand] = []

    async def read(self, door: reader.Door, content: bytes, **asked: Any) -> bytes:
        """What a door of :mod:`service.imports.reader` answers to a file, as JSON.

        Raises
        ------
        DrawingError
            Why the file gives nothing; it may also have taken more than the time or the memory that a file has.
        Busy
            After :data:`MAX_WAIT_S`.
        """
        self._begin()
        call = _Call(Future(), door, content, asked)
        self._calls.put(call)
        waiting = asyncio.wrap_future(call.future)
        done, _ = await asyncio.wait([waiting], timeout=MAX_WAIT_S)
        if not done and call.future.cancel():
            raise Busy
        return await waiting

    def stop(self) -> None:
        """End the processes."""
        with self._lock:
            for hand in self._hands:
                self._calls.put(None)
                hand.stop()

    def _begin(self) -> None:
        with self._lock:
            if not self._hands:
                self._hands = [_Hand(n, self._calls, self._settings) for n in range(READERS)]
                for hand in self._hands:
                    hand.start()


class _Hand(threading.Thread):
    """A thread that has a process, and gives it one file after the other.

    The thread starts the process, which dies with it (:func:`service.jobs.orphans.die_with`).
    """

    def __init__(self, n: int, calls: SimpleQueue[_Call | None], settings: tuple[int, str, Format, int]) -> None:
        super().__init__(name=f"reader-{n}", daemon=True)
        self._calls = calls
        self._settings = settings
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None
        self._stopping = False

    def run(self) -> None:
        """Take files until told to stop."""
        while (call := self._calls.get()) is not None:
            if not call.future.set_running_or_notify_cancel():
                continue
            try:
                call.future.set_result(self._answer(call))
            except Exception as error:  # raised where the answer is awaited, as the future has it
                call.future.set_exception(error)
        self._end()

    def stop(self) -> None:
        """End the process, whatever it is at."""
        self._stopping = True
        if self._process is not None:
            self._process.kill()

    def _answer(self, call: _Call) -> bytes:
        pipe = self._ready()
        try:
            pipe.send((call.door, call.content, dict(call.asked)))
        except OSError:  # it has died idle, just now
            self._end()
            pipe = self._ready()
            pipe.send((call.door, call.content, dict(call.asked)))
        try:
            if not pipe.poll(READ_S):
                raise _beyond(f"takes longer than {READ_S:g} seconds to read")
            answer = pipe.recv()
        except (EOFError, OSError):
            # Native code that gets no memory ends its process.
            raise _beyond("takes more memory to read than a file has here") from None
        except Unsuitable as error:
            self._end()
            log.warning("a file was given up", reader=self.name, reason=str(error))
            raise
        finally:
            if self._process is not None and not self._process.is_alive():
                self._end()
        if isinstance(answer, bytes):
            return answer
        if answer == reader.OUT_OF_MEMORY:
            self._end()
            raise _beyond("takes more memory to read than a file has here")
        if isinstance(answer, reader.Fault):
            raise answer.error()
        raise ReaderLost(str(answer))

    def _ready(self) -> Connection:
        """The pipe to a process that waits for a file; a new one where there is none, or where it has died idle."""
        if self._process is not None and not self._process.is_alive():
            self._end()
        if self._pipe is not None:
            return self._pipe
        tell_children()
        # spawn: a forked child would inherit the server's threads' locks and open connections.
        context = get_context("spawn")
        ours, theirs = context.Pipe()
        self._process = context.Process(
            target=reader.serve, args=(theirs, *self._settings), name=self.name, daemon=True
        )
        self._process.start()
        theirs.close()
        self._pipe = ours
        try:
            ready = not self._stopping and ours.poll(START_S) and ours.recv() == reader.READY
        except (EOFError, OSError):
            ready = False
        if not ready:
            self._end()
            raise ReaderLost("the process that reads files did not start")
        log.info("reader ready", reader=self.name)
        return ours

    def _end(self) -> None:
        process, pipe = self._process, self._pipe
        self._process = self._pipe = None
        if pipe is not None:
            pipe.close()
        if process is not None:
            process.kill()
            process.join(_STOP_S)


def _beyond(what: str) -> Unsuitable:
    return Unsuitable(f"The file {what}; send a smaller or simpler one.")
