"""Answers of the command line without a service: problems are solved and mechanisms analysed in this process."""

from __future__ import annotations

import datetime
import json
import socket
import sys
import uuid
from collections.abc import Callable
from typing import TYPE_CHECKING, cast
from urllib.parse import urlsplit

from service import client as service
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import ProblemBase

if TYPE_CHECKING:
    from service.render import Form

DEFAULT_URL = "http://127.0.0.1:8000"
"""Address of a service on this machine."""

INVALID = 422
"""Status with which a service refuses an invalid body."""

CONNECTION_TIMEOUT_S = 0.5
"""Time limit for a connection to a service on this machine, seconds."""


def find_service(url: str | None) -> str | None:
    """Return the URL of the service to use: the given one, or a service on this machine; None if there is none."""
    if url is not None:
        return url
    at = urlsplit(DEFAULT_URL)
    try:
        with socket.create_connection((at.hostname, at.port), CONNECTION_TIMEOUT_S):
            return DEFAULT_URL
    except OSError:
        sys.stderr.write(f"no service at {DEFAULT_URL}: this process computes the answer\n")
        return None


def solve_here(
    statement: JsonObject, label: str | None, report: Callable[[float, str], None]
) -> tuple[service.Job, ProblemBase]:
    """Solve a problem in this process; return the job that a service would show, and the problem.

    Raises
    ------
    service.Refused
        With the faults that a service would report.
    """
    from service.error_messages import explain_kind
    from service.requests import check_consistency, check_fields
    from synthesis.dispatch import solve
    from synthesis.registry import KINDS

    kind = statement.get("kind")
    if kind not in KINDS:
        raise _refuse([("/problem/kind", explain_kind(kind, KINDS))])
    problem, faults = check_fields(kind, statement)
    faults = faults or check_consistency(problem)
    if faults:
        raise _refuse([(f"/problem{path}", detail) for path, detail in faults])
    begun = _write_time()
    result = solve(problem, report)
    job = service.Job(
        id=str(uuid.uuid4()),
        kind=kind,
        label=label,
        status="succeeded",
        created_at=begun,
        started_at=begun,
        finished_at=_write_time(),
        progress=service.Progress(1.0, ""),
        problem=json.loads(problem.model_dump_json()),
        result=json.loads(result.model_dump_json()),
        error=None,
    )
    return job, problem


def draw_here(job: service.Job, problem: ProblemBase, number: int, form: str) -> bytes | None:
    """Draw a design of a job in a format; None if the design has no such file."""
    from service.render import NoSuchExport, NotBuilt, export_design, make_heading
    from synthesis.registry import KINDS

    result = KINDS[problem.kind].result.model_validate_json(json.dumps(job.result))
    try:
        content = export_design(
            result.designs[number],
            problem,
            make_heading(problem, job.label, number),
            # The command line accepts these formats only.
            cast("Form", form),
        )
    except (NoSuchExport, NotBuilt):
        return None
    return content if isinstance(content, bytes) else content.encode()


def analyze_here(request: JsonObject) -> JsonObject:
    """Analyse a mechanism in this process.

    Raises
    ------
    service.Refused
        With the faults that a service would report.
    """
    from service.answers.analysis import analyse
    from service.refusals import Refusal

    try:
        answer: JsonObject = json.loads(analyse(request))
    except Refusal as refusal:
        raise _refuse(list(refusal.errors)) from None
    return answer


def _refuse(faults: list[tuple[str, str]]) -> service.Refused:
    """Return the refusal of a service with these faults."""
    listed = [{"path": path, "detail": detail} for path, detail in faults]
    return service.Refused(INVALID, {"detail": faults[0][1] if faults else "", "errors": listed})


def _write_time() -> str:
    return datetime.datetime.now(datetime.UTC).isoformat()
