"""Faults of failed jobs, as problem-details objects for the client."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from service.error_messages import MAX_FAULTS
from synthesis.model.text_messages import list_messages


@dataclass(frozen=True, slots=True)
class Fault:
    """A problem-details object (RFC 9457) without the field ``instance``."""

    type: str
    title: str
    status: int
    detail: str
    errors: Sequence[tuple[str, str]] | None = None

    def as_json(self, job_id: str) -> str:
        """Return the object as JSON for the row of the job."""
        details = {**asdict(self), "instance": f"/v1/jobs/{job_id}"}
        if self.errors is None:
            del details["errors"]
        else:
            details["errors"] = [{"path": path, "detail": detail} for path, detail in self.errors]
        details["messages"] = [message.model_dump() for message in list_messages(details)]
        return json.dumps(details)


INTERNAL_ERROR = Fault(
    "/problems/internal-error",
    "Internal error",
    500,
    "The computation failed because of a defect of the service; its log has the details.",
)
WORKER_DIED = Fault(
    "/problems/worker-died",
    "Worker died",
    500,
    "The job was given up because its worker process died in every attempt.",
)


def make_timeout(limit_s: float) -> Fault:
    """Build the fault of a job that took longer than ``limit_s`` seconds."""
    return Fault(
        "/problems/timeout",
        "Timeout",
        504,
        f"The computation was stopped at the time limit of {limit_s:g} s.",
    )


def make_out_of_memory(limit_mb: int) -> Fault:
    """Build the fault of a job that needed more than ``limit_mb`` MiB."""
    return Fault(
        "/problems/out-of-memory",
        "Out of memory",
        507,
        f"The computation exceeded the memory limit of {limit_mb} MiB.",
    )


def make_invalid_problem(errors: Sequence[tuple[str, str]]) -> Fault:
    """Build the fault of a sample with an invalid problem; ``errors`` are pairs of JSON pointer and detail.

    At most :data:`~service.error_messages.MAX_FAULTS` errors are reported, as for a refused job.
    """
    return Fault(
        "/problems/invalid-problem",
        "Invalid problem",
        422,
        f"With these values the problem is invalid: {errors[0][0]}: {errors[0][1]}",
        errors[:MAX_FAULTS],
    )
