"""What a lane and its worker tell each other without asking: since when the solver is at work, and that it is to stop.

The two processes share a few bytes of memory. A worker also waits for the store, which can be away for any time, and
only what the solver takes counts against the time that a job may take. A solver that is told to stop does so at its
next report of progress, and its worker lives on; that is nearly always soon enough, and a new worker takes seconds.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.sharedctypes import RawValue


class Stopped(BaseException):
    """The solver was told to stop. Not an error that a solver could take for one of its own."""


class Solving:
    """The work of one solver after the other. Made by the lane, handed to the worker when it starts.

    The clock is the monotonic one, which all processes of a machine share.
    """

    def __init__(self) -> None:
        self._since = RawValue("d", 0.0)
        self._stop = RawValue("b", 0)

    @contextmanager
    def at_work(self) -> Iterator[None]:
        """The solver is at work inside. For the worker."""
        self._since.value = time.monotonic()
        try:
            yield
        finally:
            self._since.value = 0.0

    def stoppable(self, progress: Callable[[float, str], None]) -> Callable[[float, str], None]:
        """A progress callback that raises :class:`Stopped` when the solver is to stop. For the worker."""

        def report(fraction: float, message: str) -> None:
            if self._stop.value:
                raise Stopped
            progress(fraction, message)

        return report

    @property
    def seconds(self) -> float:
        """How long the solver has been at work; 0 where it is not. For the lane."""
        since: float = self._since.value
        return time.monotonic() - since if since > 0.0 else 0.0

    def stop(self) -> None:
        """Tell the solver to stop. For the lane."""
        self._stop.value = 1

    def reset(self) -> None:
        """Forget the job before, whose worker may have died at work. For the lane, before each job."""
        self._since.value = 0.0
        self._stop.value = 0
