"""What a lane sees of its worker without asking: since when the solver is at work.

The two processes share a few bytes of memory. A worker also waits for the store, which can be away for any time, and
only what the solver takes counts against the time that a job may take.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.sharedctypes import RawValue


class Solving:
    """Since when the solver of a worker is at work. Made by the lane, handed to the worker when it starts.

    The clock is the monotonic one, which all processes of a machine share.
    """

    def __init__(self) -> None:
        self._since = RawValue("d", 0.0)

    @contextmanager
    def at_work(self) -> Iterator[None]:
        """The solver is at work inside. For the worker."""
        self._since.value = time.monotonic()
        try:
            yield
        finally:
            self._since.value = 0.0

    @property
    def seconds(self) -> float | None:
        """How long the solver has been at work; None where it is not. For the lane."""
        since: float = self._since.value
        return time.monotonic() - since if since > 0.0 else None

    def reset(self) -> None:
        """Forget a worker that has died at work. For the lane."""
        self._since.value = 0.0
