"""Values and exceptions of the clients.

ClientError
+-- Unreachable     no answer after several attempts
+-- Refused         error answer of the service, with type, status and details
+-- JobFailed       the job ended without a result
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, Literal

Json = dict[str, Any]
Status = Literal["queued", "running", "succeeded", "failed", "cancelled"]


class ClientError(Exception):
    """Base class of the clients' errors; see the tree above."""


class Unreachable(ClientError):
    """The service does not answer at this URL."""


class Refused(ClientError):
    """The service has answered with an error (problem details, RFC 9457)."""

    def __init__(self, status: int, problem: Json) -> None:
        self.status = status
        self.type = str(problem.get("type", "about:blank"))
        self.detail = str(problem.get("detail", ""))
        # The keys are unique paths: of several faults at one place the last one is kept.
        self.errors = {str(fault["path"]): str(fault["detail"]) for fault in problem.get("errors") or ()}
        lines = [f"{status}: {self.detail}", *(f"  {path or '/'}: {detail}" for path, detail in self.errors.items())]
        super().__init__("\n".join(lines))


class JobFailed(ClientError):
    """The job ended without a result."""

    def __init__(self, job: Job) -> None:
        self.job = job
        super().__init__(f"the job is {job.status}: {(job.error or {}).get('detail', 'it was cancelled')}")


@dataclass(frozen=True, slots=True)
class Progress:
    """Progress of a job: the completed share, and the present step."""

    fraction: float
    message: str


@dataclass(frozen=True, slots=True)
class JobSummary:
    """A job as in a list."""

    id: str
    kind: str
    label: str | None
    status: Status
    created_at: str
    started_at: str | None
    finished_at: str | None
    progress: Progress

    @property
    def finished(self) -> bool:
        """Whether the state of the job is final."""
        return self.status not in ("queued", "running")


@dataclass(frozen=True, slots=True)
class Job(JobSummary):
    """A job with its problem and, once it has one, its answer."""

    problem: Json
    result: Json | None
    error: Json | None

    def with_result(self) -> Job:
        """Return the job itself; raise :class:`JobFailed` if it ended without a result."""
        if self.result is None:
            raise JobFailed(self)
        return self


def build_job(shown: Json) -> Job:
    """Build a job from an answer."""
    return Job(**_extract_values(shown, _JOB_FIELDS))


def build_summary(listed: Json) -> JobSummary:
    """Build a job summary from a list or an event."""
    return JobSummary(**_extract_values(listed, _SUMMARY_FIELDS))


_JOB_FIELDS = [field.name for field in fields(Job)]
_SUMMARY_FIELDS = [field.name for field in fields(JobSummary)]


def _extract_values(listed: Json, names: Sequence[str]) -> Json:
    # Additional fields of a newer service are ignored.
    return {**{name: listed[name] for name in names}, "progress": Progress(**listed["progress"])}
