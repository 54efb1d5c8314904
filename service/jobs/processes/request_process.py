"""What runs in a process that answers requests: one call after the other, from a pipe.

Messages to the server: ``READY`` once, ``TAKEN`` for each call, ``COMPILING`` where a call compiles kernels that no
process has needed before, and at last how the call has ended. An answer of bytes follows its message as it is, so that
a large one is not copied to be pickled.
"""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any, Literal

import structlog

Message = tuple[Literal["ready", "taken", "compiling", "bytes", "returned", "raised"], Any]

READY: Message = ("ready", None)
TAKEN: Message = ("taken", None)
COMPILING: Message = ("compiling", None)

CALLS_BEFORE_RENEWAL = 2000
"""After so many calls a process ends, and another takes its place: what libraries keep for ever stays bounded."""

_TICKS = os.sysconf("SC_CLK_TCK")

log = structlog.get_logger(__name__)


def serve_calls(pipe: Connection, prepare: Callable[..., Any], settings: tuple[Any, ...]) -> None:
    """Do what a pipe asks for until it is closed.

    Parameters
    ----------
    prepare : callable
        Called first of all, with ``settings``; it confines the process and limits its memory.
    """
    prepare(*settings)
    _report_compilations(pipe)
    pipe.send(READY)
    for _ in range(CALLS_BEFORE_RENEWAL):
        try:
            work, args = pipe.recv()
        except EOFError:
            return
        pipe.send(TAKEN)
        _send_answer(pipe, *_call(work, args))


def spent_seconds(pid: int) -> float:
    """Processor time of a process so far; 0 where the system does not tell."""
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as stat:
            fields = stat.read().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / _TICKS


def _call(work: Callable[..., Any], args: tuple[Any, ...]) -> tuple[bool, Any]:
    """Whether a call has raised, and what it has returned or raised."""
    try:
        return False, work(*args)
    except MemoryError:
        return True, MemoryError()
    except Exception as error:  # whatever it is, the server raises it in the request
        if not getattr(error, "status", None):  # a refusal is no defect; anything else is told with its trace here
            log.exception("a call has failed", work=work.__name__)
        return True, _make_sendable(error)


def _send_answer(pipe: Connection, raised: bool, answer: Any) -> None:
    if raised:
        pipe.send(("raised", answer))
    elif isinstance(answer, bytes):
        pipe.send(("bytes", len(answer)))
        pipe.send_bytes(answer)
    else:
        pipe.send(("returned", answer))


def _make_sendable(error: Exception) -> Exception:
    """An exception as it is, or its words where a pipe cannot carry it: the process would end, as without memory.

    No future takes a ``StopIteration``: whoever waits for it would wait for ever.
    """
    if isinstance(error, StopIteration):
        return RuntimeError("StopIteration")
    try:
        pickle.loads(pickle.dumps(error))
    except (TypeError, AttributeError, ValueError, pickle.PickleError):
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _report_compilations(pipe: Connection) -> None:
    """Tell the server of each kernel that is compiled from now on; nothing where the process has no compiler."""
    if "numba" not in sys.modules:
        return
    from numba.core import event

    class Reporter(event.Listener):
        """Sends a message for each compilation that is begun."""

        def on_start(self, event: Any) -> None:
            pipe.send(COMPILING)

        def on_end(self, event: Any) -> None:
            """The end of the call tells enough."""

    event.register("numba:compile", Reporter())
