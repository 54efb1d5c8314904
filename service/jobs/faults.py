"""Faults of failed jobs, as problem-details objects for the client."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

from kinematics.message import Message, compose, find_message, remember
from service.error_messages import MAX_FAULTS
from synthesis.model.json_object import JsonObject
from synthesis.model.text_messages import list_messages


@dataclass(frozen=True, slots=True)
class Fault:
    """A problem-details object (RFC 9457) without the field ``instance``; its texts are composed when it is used."""

    type: str
    title_id: str
    status: int
    message: Message
    errors: Sequence[tuple[str, str]] | None = None

    @property
    def detail(self) -> str:
        """Description of the fault."""
        return remember(self.message)

    def as_json(self, job_id: str) -> str:
        """Return the object as JSON for the row of the job."""
        details: JsonObject = {
            "type": self.type,
            "title": compose(self.title_id),
            "status": self.status,
            "detail": self.detail,
            "instance": f"/v1/jobs/{job_id}",
        }
        if self.errors is not None:
            details["errors"] = [{"path": path, "detail": detail} for path, detail in self.errors]
        details["messages"] = [message.model_dump() for message in list_messages(details)]
        return json.dumps(details)


INTERNAL_ERROR = Fault(
    "/problems/internal-error",
    "service-title-internal-error",
    500,
    Message("service-computation-failed", {}),
)
WORKER_DIED = Fault(
    "/problems/worker-died",
    "service-title-worker-died",
    500,
    Message("service-worker-died", {}),
)


def make_timeout(limit_s: float) -> Fault:
    """Build the fault of a job that took longer than ``limit_s`` seconds."""
    return Fault(
        "/problems/timeout",
        "service-title-timeout",
        504,
        Message("service-time-limit-exceeded", {"seconds": f"{limit_s:g}"}),
    )


def make_out_of_memory(limit_mb: int) -> Fault:
    """Build the fault of a job that needed more than ``limit_mb`` MiB."""
    return Fault(
        "/problems/out-of-memory",
        "service-title-out-of-memory",
        507,
        Message("service-memory-limit-exceeded", {"size": str(limit_mb)}),
    )


def make_invalid_problem(errors: Sequence[tuple[str, str]]) -> Fault:
    """Build the fault of a sample with an invalid problem; ``errors`` are pairs of JSON pointer and detail.

    At most :data:`~service.error_messages.MAX_FAULTS` errors are reported, as for a refused job.
    """
    path, reason = errors[0]
    return Fault(
        "/problems/invalid-problem",
        "service-title-invalid-problem",
        422,
        Message(
            "service-sample-invalid",
            {"path": path, "reason": find_message(reason) or reason},
        ),
        errors[:MAX_FAULTS],
    )
