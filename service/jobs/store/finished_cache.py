"""Finished jobs at hand. They never change, so what was read of them once need not be read again.

Only for a store that no other server writes to: there a job is removed by this process alone, which says so here.
"""

from __future__ import annotations

from collections import OrderedDict

from service.jobs.store.schema import JobRow

CAPACITY_BYTES = 8 << 20
"""Some hundreds of jobs with their results."""

_SHARE = 8
"""A job is kept if at least so many of its size find room."""

_BESIDES = 1000
"""What a job takes besides its problem, result and error, bytes, about."""


class FinishedJobs:
    """The finished jobs that were asked for last. To be used on one event loop only."""

    def __init__(self, capacity_bytes: int) -> None:
        self._capacity = capacity_bytes
        self._held = 0
        self._jobs: OrderedDict[str, JobRow] = OrderedDict()
        self._removals = 0

    @property
    def removals(self) -> int:
        """How often jobs have been removed; to be noted before a job is read from the store, for :meth:`keep`."""
        return self._removals

    def get(self, job_id: str) -> JobRow | None:
        """The job, where it is at hand."""
        job = self._jobs.get(job_id)
        if job is not None:
            self._jobs.move_to_end(job_id)
        return job

    def keep(self, job: JobRow, removals: int) -> None:
        """Keep a job if it is finished, and if nothing was removed since it was read: it might have been this one."""
        size = _size(job)
        if not job.status.finished or removals != self._removals or size * _SHARE > self._capacity:
            return
        self._drop(job.id)
        self._jobs[job.id] = job
        self._held += size
        while self._held > self._capacity:
            self._drop(next(iter(self._jobs)))

    def removed(self, job_id: str | None = None) -> None:
        """A job was removed from the store, or some that are not known by name."""
        self._removals += 1
        if job_id is not None:
            self._drop(job_id)
        else:
            self._jobs.clear()
            self._held = 0

    def _drop(self, job_id: str) -> None:
        job = self._jobs.pop(job_id, None)
        if job is not None:
            self._held -= _size(job)


def _size(job: JobRow) -> int:
    return len(job.problem) + len(job.result or "") + len(job.error or "") + _BESIDES
