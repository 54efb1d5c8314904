"""Compilation inside jobs: a job that arrives before its kernels are compiled compiles them itself and reports it.

Compiled kernels are kept on disk, so this happens once for each kernel, on a machine without compilation ahead of time
(:mod:`service.server.precompile`). The time for it counts neither towards the time limit of the job nor towards that of
a short job.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from numba.core import event

from kinematics.message import compose
from service.jobs.processes.stop_flag import Solving

COMPILING_ID = "service-compiling"
"""Id of the progress message of a job during compilation."""

_COMPILE_EVENT = "numba:compile"


class FirstUse(event.Listener):
    """Watches the compiler in a worker process, which runs one job at a time."""

    def __init__(self, solving: Solving) -> None:
        self._solving = solving
        self._thread: int | None = None
        self._progress: Callable[[float, str], None] = lambda fraction, message: None
        self._last = (0.0, "")
        self._depth = 0
        event.register(_COMPILE_EVENT, self)

    @contextmanager
    def watch_progress(self, progress: Callable[[float, str], None]) -> Iterator[Callable[[float, str], None]]:
        """Yield a progress callback; compilations by this thread inside the block are reported through it too."""

        def report(fraction: float, message: str) -> None:
            self._last = fraction, message
            progress(fraction, message)

        self._progress, self._last, self._depth = progress, (0.0, ""), 0
        self._thread = threading.get_ident()
        try:
            yield report
        finally:
            self._thread = None

    def on_start(self, event: event.Event) -> None:
        """Note the start of a compilation; the kernels that it calls are compiled inside."""
        # Other threads, such as the warm-up, compile too; they do not hold the job up.
        if self._thread == threading.get_ident():
            self._depth += 1
            if self._depth == 1:
                self._solving.pause()
                self._progress(self._last[0], compose(COMPILING_ID))

    def on_end(self, event: event.Event) -> None:
        """Note the end of a compilation, successful or not."""
        if self._thread == threading.get_ident():
            self._depth -= 1
            if self._depth == 0:
                self._solving.resume()
                if self._last[1]:
                    self._progress(*self._last)
