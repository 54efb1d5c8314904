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

_NONE = -1


class Stopped(BaseException):
    """The solver was told to stop. Not an error that a solver could take for one of its own."""


class Solving:
    """The work of one solver after the other. Made by the lane, handed to the worker when it starts.

    The clock is the monotonic one, which all processes of a machine share.
    """

    def __init__(self) -> None:
        self._since = RawValue("d", 0.0)
        self._stop = RawValue("b", 0)
        self._sample = RawValue("q", _NONE)
        self._paused_after = 0.0

    @contextmanager
    def at_work(self, sample: int | None = None) -> Iterator[None]:
        """The solver is at work inside, on this sample where the job is a share of a batch. For the worker."""
        self._sample.value = _NONE if sample is None else sample
        self._since.value = time.monotonic()
        try:
            yield
        finally:
            self._since.value = 0.0

    def pause(self) -> None:
        """What follows is none of the solver's work, such as the compilation of what it calls. For the worker."""
        self._paused_after, self._since.value = self.seconds, 0.0

    def go_on(self) -> None:
        """The solver is at work again. For the worker."""
        self._since.value = time.monotonic() - self._paused_after

    def stoppable(self, progress: Callable[[float, str], None]) -> Callable[[float, str], None]:
        """A progress callback that raises :class:`Stopped` when the solver is to stop. For the worker."""

        def report(fraction: float, message: str) -> None:
            if self.told_to_stop:
                raise Stopped
            progress(fraction, message)

        return report

    @property
    def seconds(self) -> float:
        """How long the solver has been at work; 0 where it is not. For the lane."""
        since: float = self._since.value
        return time.monotonic() - since if since > 0.0 else 0.0

    @property
    def sample(self) -> int | None:
        """The sample of a batch that was begun last; None where none was. For the lane."""
        sample: int = self._sample.value
        return None if sample == _NONE else sample

    @property
    def told_to_stop(self) -> bool:
        """Whether the solver is to stop. For the worker."""
        return bool(self._stop.value)

    def stop(self) -> None:
        """Tell the solver to stop. For the lane."""
        self._stop.value = 1

    def reset(self) -> None:
        """Forget the job before, whose worker may have died at work. For the lane, before each job."""
        self._since.value = 0.0
        self._stop.value = 0
        self._sample.value = _NONE
