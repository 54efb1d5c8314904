"""Who runs the jobs: the protocol that the rest of the service knows."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

Changed = Callable[[str | None], None]
"""Called with the id of a job that a worker is done with, or None where any job may be it; from any thread."""


class Executor(Protocol):
    """Runs stored jobs by their ids. What became of a job stands in the store alone."""

    def start(self) -> None:
        """Begin to take jobs; nothing happens when it has begun already. The workers may still be starting after."""
        ...

    def resume(self) -> None:
        """Take up the jobs of the store that nobody runs. Called once, when the store has its tables."""
        ...

    def subscribe(self, changed: Changed) -> None:
        """Tell one subscriber from now on of each job that a worker is done with: it has ended, or is queued again.

        Nobody is told of a claim or of progress; that stands in the store.
        """
        ...

    def submit(self, job_id: str) -> None:
        """Have the queued job run."""
        ...

    def cancel(self, job_id: str) -> None:
        """Stop the computation of a job that is cancelled in the store already; native code included."""
        ...

    def ready(self) -> int:
        """How many workers have finished starting."""
        ...

    def stop(self) -> None:
        """Stop within a few seconds. Jobs under way go back into the queue of the store."""
        ...
