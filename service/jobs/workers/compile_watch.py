"""Jobs that come before their kernels have been compiled: they compile them, wait for no others, and say so.

What is compiled stays on the disk, so that this happens once for each kernel, on a machine whose kernels have not been
compiled ahead (:mod:`service.server.precompile`). The time that it takes is not the job's: it counts neither against
the time that a job may take nor against that of a short one.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from numba.core import event

from service.jobs.processes.stop_flag import Solving

SAID = "compiling what this is the first job to need"
"""The message of a job's progress meanwhile."""

_COMPILES = "numba:compile"


class FirstUse(event.Listener):
    """Watches the compiler in a worker process. One job runs at a time."""

    def __init__(self, solving: Solving) -> None:
        self._solving = solving
        self._thread: int | None = None
        self._progress: Callable[[float, str], None] = lambda fraction, message: None
        self._last = (0.0, "")
        self._depth = 0
        event.register(_COMPILES, self)

    @contextmanager
    def told(self, progress: Callable[[float, str], None]) -> Iterator[Callable[[float, str], None]]:
        """The progress of a job, which is told of each kernel that is compiled inside, by this thread."""

        def report(fraction: float, message: str) -> None:
            self._last = fraction, message
            progress(fraction, message)

        self._progress, self._last, self._depth = progress, (0.0, ""), 0
        self._thread = threading.get_ident()
        try:
            yield report
        finally:
            self._thread = None

    def on_start(self, event: Any) -> None:
        """A kernel is to be compiled; those that it calls are compiled inside."""
        if self._thread == threading.get_ident():
            self._depth += 1
            if self._depth == 1:
                self._solving.pause()
                self._progress(self._last[0], SAID)

    def on_end(self, event: Any) -> None:
        """It is compiled, or cannot be."""
        if self._thread == threading.get_ident():
            self._depth -= 1
            if self._depth == 0:
                self._solving.go_on()
                if self._last[1]:
                    self._progress(*self._last)
