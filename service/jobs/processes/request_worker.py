"""The threads of a pool, each with a process that executes one call at a time within limits.

A process is killed if its call exceeds its limits of time or memory, or if the call is abandoned: native code cannot be
stopped otherwise. The next call gets another process.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Literal

import structlog

from service.jobs.processes.parent_death import export_parent_pid
from service.jobs.processes.request_process import read_cpu_seconds, serve_calls
from service.jobs.processes.request_queue import Call, RequestQueue

START_TIMEOUT_S = 300.0
"""Time limit for the start of a process, seconds; with no kernel compiled yet it takes a minute."""

COMPILE_S = 120.0
"""Extra time for a call, once, if it compiles kernels that were never needed before, seconds."""

IDLE_S = 600.0
"""Idle time after which a spawned process ends, seconds: unlike a forked one it shares no memory with others."""

LONG_PRIORITY = 5
"""Increase of a process's niceness during a long call, which lets short calls have the processors first."""

_PERIOD_S, _STOP_S = 0.02, 5.0
"""Period of the check of a call's limits, and time limit for the end of a process, seconds."""

Limit = Literal["time", "memory"]

log = structlog.get_logger(__name__)


class ProcessLost(Exception):
    """No process could execute the call, for a reason other than the call itself."""


class ClientGone(Exception):
    """The client has disconnected."""


class GivenUp(Exception):
    """The call exceeded its limit of time or memory; ``of`` is the name of that limit."""

    def __init__(self, of: Limit) -> None:
        super().__init__(f"the call exceeds its limit of {of}")
        self.of = of


class _LongCallRefused(Exception):
    """The call turned out to be long while the maximum number of long calls run."""


@dataclass(frozen=True)
class Limits:
    """Limits of a call.

    ``wall_s`` bounds its duration, ``cpu_s`` the processor time of its process, which does not depend on the load of
    the machine. A call with more than ``short_s`` seconds of processor time is long; None makes no distinction.
    """

    wall_s: float
    cpu_s: float | None = None
    short_s: float | None = None


def _return_false() -> bool:
    return False


@dataclass(frozen=True)
class ProcessStart:
    """Start of the processes of a pool.

    ``prepare`` is the first call in a process, with ``settings``; it restricts the process and limits its memory.
    ``forks`` returns whether they are forked from a process that has loaded the libraries
    (:mod:`multiprocessing.forkserver`), which takes some hundredths of a second; else they are spawned.
    """

    prepare: Callable[..., object]
    settings: tuple[object, ...]
    forks: Callable[[], bool] = _return_false

    def start_process(self, name: str) -> tuple[BaseProcess, Connection]:
        """Start a process, which prepares itself after the return, and return it with the pipe to it."""
        export_parent_pid()
        # A child forked from the server itself would inherit the locks of its threads and its open connections.
        context = get_context("forkserver") if self.forks() else get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(
            target=serve_calls, args=(theirs, self.prepare, self.settings), name=name, daemon=True
        )
        process.start()
        # With this end closed here, the death of the process shows as the end of the pipe.
        theirs.close()
        return process, ours


class _Clock:
    """Time that a call has used of its limits."""

    def __init__(self, pid: int, limits: Limits) -> None:
        self._pid, self._limits = pid, limits
        self._began, self._spent = time.monotonic(), read_cpu_seconds(pid)
        self._granted = 0.0

    def extend_for_compilation(self) -> None:
        """Extend the limits by the time for compilation, once."""
        self._granted = COMPILE_S

    @property
    def compiles(self) -> bool:
        """Whether the call has begun to compile something."""
        return self._granted > 0.0

    @property
    def over(self) -> bool:
        """Whether a limit is exceeded."""
        if time.monotonic() - self._began > self._limits.wall_s + self._granted:
            return True
        return self._limits.cpu_s is not None and self.seconds > self._limits.cpu_s + self._granted

    @property
    def long(self) -> bool:
        """Whether the call exceeds the time of a short call."""
        return self._limits.short_s is not None and self.seconds > self._limits.short_s

    @property
    def seconds(self) -> float:
        """Processor time of the call, seconds."""
        return read_cpu_seconds(self._pid) - self._spent


class Hand(threading.Thread):
    """A thread with a process that ends with it (:func:`service.jobs.processes.parent_death.bind_to_parent`)."""

    def __init__(self, name: str, queue: RequestQueue, start: ProcessStart, limits: Limits) -> None:
        super().__init__(name=name, daemon=True)
        self.stopping = threading.Event()
        self.process: BaseProcess | None = None
        self._pipe: Connection | None = None
        self._queue, self._process_start, self._limits = queue, start, limits

    def begin(self) -> None:
        """Start the thread unless it is running."""
        if self.ident is None:
            self.start()

    def run(self) -> None:
        """Execute calls until a stop is requested."""
        while not self.stopping.is_set():
            self._start_ahead()
            call = self._queue.take(IDLE_S)
            if call is None:
                if not self._process_start.forks():
                    self._terminate_process()
            elif self._begin_call(call):
                self._execute_call(call)
            else:
                self._queue.finish(call)
        self._terminate_process()

    def _begin_call(self, call: Call) -> bool:
        """Mark the call as running; return False if it is abandoned. The future of a restarted call runs already."""
        if call.abandoned.is_set():
            return False
        call.running = call.future.running() or call.future.set_running_or_notify_cancel()
        return call.running

    def _execute_call(self, call: Call) -> None:
        try:
            answer = self._compute_answer(call)
        except _LongCallRefused:
            self._queue.put_back(call)
            return
        except Exception as error:  # the future raises any error in the request, and the thread goes on
            self._queue.finish(call)
            _settle(call.future, error=error)
            return
        self._queue.finish(call)
        _settle(call.future, answer=answer)

    def _compute_answer(self, call: Call) -> object:
        # A second try, because the process may have died idle just before the first.
        pipe = self._send_call(call) or self._send_call(call)
        if pipe is None or self.process is None or self.process.pid is None:
            raise ProcessLost(f"the process {self.name} takes no call")
        clock = _Clock(self.process.pid, self._limits)
        slowed = False
        try:
            if call.long:
                slowed = self._reduce_priority()
            while True:
                slowed = self._wait(pipe, call, clock) or slowed
                kind, answer = _receive(pipe)
                if kind == "compiling":
                    clock.extend_for_compilation()
                    continue
                if kind == "bytes":
                    answer = pipe.recv_bytes()
                break
        except (EOFError, OSError):
            # Native code that is refused memory ends its process.
            kind, answer = "raised", MemoryError()
        except (ClientGone, GivenUp, _LongCallRefused):
            self._terminate_process()
            raise
        if isinstance(answer, MemoryError):
            self._terminate_process()
            log.warning("a call was given up", of="memory", work=call.work.__name__)
            raise GivenUp("memory")
        if slowed:
            # Only a privileged server could raise its priority again.
            self._terminate_process()
        if kind == "raised":
            raise answer
        return answer

    def _wait(self, pipe: Connection, call: Call, clock: _Clock) -> bool:
        """Wait within the limits for a message of a call; return whether its priority was reduced as a long call."""
        slowed = False
        while not wait([pipe], timeout=_PERIOD_S):
            self._require_wanted(call)
            if clock.over:
                log.warning("a call was given up", of="time", work=call.work.__name__)
                raise GivenUp("time")
            if not call.long and clock.long:
                if not self._queue.admit_as_long(call):
                    raise _LongCallRefused
                # A compilation is not slowed down: it would only occupy the process longer.
                slowed = not clock.compiles and self._reduce_priority()
        return slowed

    def _reduce_priority(self) -> bool:
        """Reduce the priority of the process in favour of short calls."""
        assert self.process is not None
        assert self.process.pid is not None
        with suppress(OSError):  # the process may just have ended
            os.setpriority(os.PRIO_PROCESS, self.process.pid, os.getpriority(os.PRIO_PROCESS, 0) + LONG_PRIORITY)
        return True

    def _require_wanted(self, call: Call | None) -> None:
        if self.stopping.is_set() or (call is not None and call.abandoned.is_set()):
            raise ClientGone

    def _start_ahead(self) -> None:
        """Fork a process ahead of the next call: it costs little, and the call need not wait for it."""
        if not self._process_start.forks():
            return
        try:
            self._ensure_pipe(None)
        except ClientGone:  # the pool stops
            pass
        except (ProcessLost, OSError):
            log.exception("a process could not be started ahead", process=self.name)

    def _send_call(self, call: Call) -> Connection | None:
        """Send a call and return the pipe of the process that took it; None if the process had died idle."""
        pipe = self._ensure_pipe(call)
        try:
            pipe.send((call.work, call.args))
            self._expect(pipe, call, self._limits.wall_s)
        except (EOFError, OSError):
            self._terminate_process()
            return None
        except (ClientGone, GivenUp):
            self._terminate_process()
            raise
        return pipe

    def _expect(self, pipe: Connection, call: Call | None, limit_s: float) -> None:
        """Wait for the message that a process is ready or has taken the call; ``EOFError`` if it has ended."""
        latest = time.monotonic() + limit_s
        while not wait([pipe], timeout=_PERIOD_S):
            self._require_wanted(call)
            if time.monotonic() > latest:
                raise GivenUp("time")
        _receive(pipe)

    def _ensure_pipe(self, call: Call | None) -> Connection:
        """Return the pipe of a process that waits for calls; start a process if there is none or it died idle."""
        if self.process is not None and not self.process.is_alive():
            self._terminate_process()
        if self._pipe is not None:
            return self._pipe
        self.process, self._pipe = self._process_start.start_process(self.name)
        try:
            self._expect(self._pipe, call, START_TIMEOUT_S)
        except ClientGone:
            self._terminate_process()
            raise
        except (EOFError, GivenUp) as error:
            self._terminate_process()
            raise ProcessLost(f"the process {self.name} did not start") from error
        return self._pipe

    def _terminate_process(self) -> None:
        process, pipe = self.process, self._pipe
        self.process = self._pipe = None
        if pipe is not None:
            pipe.close()
        if process is not None:
            process.kill()
            process.join(_STOP_S)


def _receive(pipe: Connection) -> Any:
    try:
        return pipe.recv()
    except OSError as error:
        raise EOFError from error


def _settle(future: Future[Any], *, answer: object = None, error: Exception | None = None) -> None:
    """Set the outcome of a running future."""
    if error is not None:
        future.set_exception(error)
    else:
        future.set_result(answer)
