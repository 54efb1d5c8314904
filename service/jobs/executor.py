"""The protocol of executors, which run the jobs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

Changed = Callable[[str | None], None]
"""Callback with the id of a job that a worker has released, or None if it may be any job; called from any thread."""


class Executor(Protocol):
    """Runs stored jobs by their ids. Only the store holds their outcome."""

    def start(self) -> None:
        """Start to take jobs; repeated calls do nothing. The workers may still be starting on return."""
        ...

    def resume(self) -> None:
        """Resume stored jobs that no process is running. Called once, when the store has its tables."""
        ...

    def subscribe(self, changed: Changed) -> None:
        """Notify one subscriber of each job that a worker releases: it has ended or is queued again.

        Claims and progress are not notified; the store holds them.
        """
        ...

    def submit(self, job_id: str) -> None:
        """Submit a queued job."""
        ...

    def cancel(self, job_id: str) -> None:
        """Stop the computation of a job already cancelled in the store, even inside native code."""
        ...

    def count_ready_workers(self) -> int:
        """Return the number of workers that have finished starting."""
        ...

    def stop(self) -> None:
        """Stop within a few seconds; running jobs return to the queue."""
        ...
