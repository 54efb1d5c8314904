"""Cache of finished jobs, which never change and so need not be read twice.

Only for a store without other servers: there only this process removes jobs, and it notifies the cache.
"""

from __future__ import annotations

from collections import OrderedDict

from service.jobs.store.schema import JobRow

CAPACITY_BYTES = 8 << 20
"""Size of the cache, bytes; enough for some hundreds of jobs with their results."""

_MIN_CAPACITY_RATIO = 8
"""Minimum ratio of the capacity to the size of a cached job, so that one large job cannot displace all others."""

_OVERHEAD_BYTES = 1000
"""Approximate size of a job without its problem, result and error, bytes."""


class FinishedJobs:
    """The finished jobs that were requested last. For use on one event loop only."""

    def __init__(self, capacity_bytes: int) -> None:
        self._capacity = capacity_bytes
        self._held = 0
        self._jobs: OrderedDict[str, JobRow] = OrderedDict()
        self._removals = 0

    @property
    def removals(self) -> int:
        """Number of removals so far; callers note it before they read a job from the store, for :meth:`keep`."""
        return self._removals

    def get(self, job_id: str) -> JobRow | None:
        """Return the job if it is cached."""
        job = self._jobs.get(job_id)
        if job is not None:
            self._jobs.move_to_end(job_id)
        return job

    def keep(self, job: JobRow, removals: int) -> None:
        """Cache a finished job, unless a job was removed since it was read: that might have been this job."""
        size = _size(job)
        if not job.status.finished or removals != self._removals or size * _MIN_CAPACITY_RATIO > self._capacity:
            return
        self._drop(job.id)
        self._jobs[job.id] = job
        self._held += size
        while self._held > self._capacity:
            self._drop(next(iter(self._jobs)))

    def note_removal(self, job_id: str | None = None) -> None:
        """Note that a job was removed from the store; None stands for unknown jobs and clears the cache."""
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
    return len(job.problem) + len(job.result or "") + len(job.error or "") + _OVERHEAD_BYTES
