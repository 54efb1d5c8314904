"""The loop of a process that answers requests: it executes the calls that arrive on a pipe, one at a time.

Messages to the server: "ready" once; then for each call "taken", "compiling" if it compiles kernels that no process has
needed before, and finally the outcome. An answer of bytes follows its message unchanged, so that a large one is not
copied for pickling.
"""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Literal

import structlog

from kinematics.message import use_language

Message = tuple[Literal["ready", "taken", "compiling", "bytes", "returned", "raised"], object]

READY_MESSAGE: Message = ("ready", None)
TAKEN_MESSAGE: Message = ("taken", None)
COMPILING_MESSAGE: Message = ("compiling", None)

CALLS_BEFORE_RENEWAL = 2000
"""Number of calls after which a process is replaced, which bounds the memory that libraries never free."""

_TICKS = os.sysconf("SC_CLK_TCK")

log = structlog.get_logger(__name__)


def serve_calls(pipe: Connection, prepare: Callable[..., object], settings: tuple[object, ...]) -> None:
    """Execute the calls from a pipe until it is closed.

    Parameters
    ----------
    prepare : callable
        First call, with ``settings``; it restricts the process and limits its memory.
    """
    prepare(*settings)
    _report_compilations(pipe)
    pipe.send(READY_MESSAGE)
    for _ in range(CALLS_BEFORE_RENEWAL):
        try:
            work, args = pipe.recv()
        except EOFError:
            return
        pipe.send(TAKEN_MESSAGE)
        _send_answer(pipe, *_call(work, args))


def call_in_language(language: str, work: Callable[..., object], *args: object) -> object:
    """Call a function that composes its messages in a language."""
    with use_language(language):
        return work(*args)


def read_cpu_seconds(pid: int) -> float:
    """Return the processor time of a process so far, seconds; 0 if the system does not report it."""
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as stat:
            # The name of the process, in parentheses, may contain blanks and parentheses itself.
            fields = stat.read().rpartition(")")[2].split()
    except OSError:
        return 0.0
    # utime and stime, fields 14 and 15 in proc(5); the first two have been cut off.
    return (int(fields[11]) + int(fields[12])) / _TICKS


def _call(work: Callable[..., object], args: tuple[object, ...]) -> tuple[bool, object]:
    """Execute a call; return whether it raised, and the value returned or raised."""
    try:
        return False, work(*args)
    except MemoryError:
        return True, MemoryError()
    except Exception as error:  # the server raises any error in the request
        if not getattr(error, "status", None):  # a refusal is no defect; others are logged here, with their traceback
            log.exception("a call has failed", work=work.__name__)
        return True, _make_sendable(error)


def _send_answer(pipe: Connection, raised: bool, answer: object) -> None:
    if raised:
        pipe.send(("raised", answer))
    elif isinstance(answer, bytes):
        pipe.send(("bytes", len(answer)))
        pipe.send_bytes(answer)
    else:
        pipe.send(("returned", answer))


def _make_sendable(error: Exception) -> Exception:
    """Return the exception, or its text if it cannot be pickled: sending it would end the process.

    A future does not accept a ``StopIteration``: its waiters would wait forever.
    """
    if isinstance(error, StopIteration):
        return RuntimeError("StopIteration")
    try:
        pickle.loads(pickle.dumps(error))
    except (TypeError, AttributeError, ValueError, pickle.PickleError):
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _report_compilations(pipe: Connection) -> None:
    """Report each kernel compilation to the server from now on; do nothing if the process has no compiler."""
    if "numba" not in sys.modules:
        return
    from numba.core import event

    class Reporter(event.Listener):
        """Sends a message at the start of each compilation."""

        def on_start(self, event: event.Event) -> None:
            pipe.send(COMPILING_MESSAGE)

        def on_end(self, event: event.Event) -> None:
            """Do nothing: the outcome of the call also marks the end of its compilations."""

    event.register("numba:compile", Reporter())
