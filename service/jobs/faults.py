"""Why a job failed, as the problem-details object that its client reads."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from service.error_messages import MAX_FAULTS


@dataclass(frozen=True, slots=True)
class Fault:
    """A problem-details object (RFC 9457) without its instance."""

    type: str
    title: str
    status: int
    detail: str
    errors: Sequence[tuple[str, str]] | None = None

    def as_json(self, job_id: str) -> str:
        """The object as stored with the job that it is about."""
        told = {**asdict(self), "instance": f"/v1/jobs/{job_id}"}
        if self.errors is None:
            del told["errors"]
        else:
            told["errors"] = [{"path": path, "detail": detail} for path, detail in self.errors]
        return json.dumps(told)


INTERNAL_ERROR = Fault(
    "/problems/internal-error",
    "Internal error",
    500,
    "The computation failed by a defect of the service; the log of the service has the details.",
)
WORKER_DIED = Fault(
    "/problems/worker-died",
    "Worker died",
    500,
    "The process that computed the job died at every attempt, so the job was given up.",
)


def timeout(limit_s: float) -> Fault:
    """The job took longer than ``limit_s`` seconds."""
    return Fault(
        "/problems/timeout",
        "Timeout",
        504,
        f"The computation was stopped after the {limit_s:g} seconds that a job may take.",
    )


def out_of_memory(limit_mb: int) -> Fault:
    """The job asked for more than ``limit_mb`` MiB."""
    return Fault(
        "/problems/out-of-memory",
        "Out of memory",
        507,
        f"The computation needed more than the {limit_mb} MiB of memory that a job may take.",
    )


def invalid_problem(errors: Sequence[tuple[str, str]]) -> Fault:
    """A sample of a batch states no problem; ``errors`` are pairs of the place in it and what is wrong there.

    Some of them are told, as of a job that is refused.
    """
    return Fault(
        "/problems/invalid-problem",
        "Invalid problem",
        422,
        f"With these values the problem cannot be meant: {errors[0][0]}: {errors[0][1]}",
        errors[:MAX_FAULTS],
    )
