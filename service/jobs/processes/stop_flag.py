"""State shared by a lane and its worker: the time that the solver has been running, and the request to stop.

The two processes share a few bytes of memory. A worker also waits for the store, which may be unavailable for any
length of time, so only the solver's time counts towards the time limit of a job. After a request to stop, a solver
stops at its next progress report, and its worker stays alive. That is nearly always soon enough, and it avoids the
start of a new worker, which takes seconds.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.sharedctypes import RawValue

_NO_SAMPLE = -1


class SolverStopped(BaseException):
    """A stop was requested. It is derived from BaseException, so that no solver catches it as an error."""


class Solving:
    """State of the solver at work. Created by the lane and passed to the worker at its start.

    It uses the monotonic clock, which all processes of a machine share.
    """

    def __init__(self) -> None:
        self._since = RawValue("d", 0.0)
        self._stop = RawValue("b", 0)
        self._sample = RawValue("q", _NO_SAMPLE)
        self._paused_after = 0.0

    @contextmanager
    def track_work(self, sample: int | None = None) -> Iterator[None]:
        """Mark the solver as working inside, on this sample if the job is a share of a batch. For the worker."""
        self._sample.value = _NO_SAMPLE if sample is None else sample
        self._since.value = time.monotonic()
        try:
            yield
        finally:
            self._since.value = 0.0

    def pause(self) -> None:
        """Stop the clock, for work that is not the solver's, such as compiling its kernels. For the worker."""
        self._paused_after, self._since.value = self.seconds, 0.0

    def resume(self) -> None:
        """Restart the clock after :meth:`pause`. For the worker."""
        self._since.value = time.monotonic() - self._paused_after

    def make_stoppable(self, progress: Callable[[float, str], None]) -> Callable[[float, str], None]:
        """Wrap a progress callback to raise :class:`SolverStopped` once a stop is requested. For the worker."""

        def report(fraction: float, message: str) -> None:
            if self.should_stop:
                raise SolverStopped
            progress(fraction, message)

        return report

    @property
    def seconds(self) -> float:
        """Time the solver has been at work, seconds; 0 if it is not working. For the lane."""
        since: float = self._since.value
        return time.monotonic() - since if since > 0.0 else 0.0

    @property
    def sample(self) -> int | None:
        """The last sample of a batch that was started; None if there is none. For the lane."""
        sample: int = self._sample.value
        return None if sample == _NO_SAMPLE else sample

    @property
    def should_stop(self) -> bool:
        """Whether a stop is requested. For the worker."""
        return bool(self._stop.value)

    def stop(self) -> None:
        """Request the solver to stop. For the lane."""
        self._stop.value = 1

    def reset(self) -> None:
        """Clear the state of the previous job, whose worker may have died at work. For the lane, before each job."""
        self._since.value = 0.0
        self._stop.value = 0
        self._sample.value = _NO_SAMPLE
