"""Refusals of requests: the status, the type of the problem, and the faults by their places.

A refusal is an exception that a process can raise for the server: it is pickled by its fields. This module imports no
HTTP framework, so the processes that answer requests need not load one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from service.error_messages import MAX_FAULTS, explain_fault, locate_fault
from synthesis.model.counting import format_count

FieldFaults = Sequence[tuple[str, str]]
"""Pairs of JSON pointer and description of the fault."""


class Refusal(Exception):
    """A request that is answered with an error, caused by the client or by the state of the service.

    ``defect`` is the type of the internal error that led to the refusal, if there was one.
    """

    def __init__(
        self,
        status: int,
        type_: str,
        title: str,
        detail: str,
        *,
        errors: FieldFaults = (),
        headers: Mapping[str, str] | None = None,
        defect: str | None = None,
    ) -> None:
        super().__init__(detail)
        self.status = status
        self.type = f"/problems/{type_}"
        self.title = title
        self.detail = detail
        self.errors = errors
        self.headers = headers
        self.defect = defect

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle the fields: the default would call the constructor with the detail alone."""
        headers = None if self.headers is None else dict(self.headers)
        fields = self.type, self.title, self.detail, list(self.errors), headers, self.defect
        return _restore_refusal, (self.status, *fields)


def _restore_refusal(
    status: int,
    type_: str,
    title: str,
    detail: str,
    errors: FieldFaults,
    headers: dict[str, str] | None,
    defect: str | None,
) -> Refusal:
    name = type_.removeprefix("/problems/")
    return Refusal(status, name, title, detail, errors=errors, headers=headers, defect=defect)


def refuse_not_found(detail: str) -> Refusal:
    """Build the refusal for a missing resource."""
    return Refusal(404, "not-found", "Not found", detail)


def refuse_invalid_problem(errors: FieldFaults) -> Refusal:
    """Build the refusal of an invalid problem; ``errors`` are pairs of path and detail."""
    return Refusal(422, "invalid-problem", "Invalid problem", count_faults(len(errors)), errors=errors)


def refuse_invalid_mechanism(errors: FieldFaults, *, defect: str | None = None) -> Refusal:
    """Build the refusal of an invalid mechanism; ``errors`` are pairs of path and detail."""
    detail = count_faults(len(errors))
    return Refusal(422, "invalid-mechanism", "Invalid mechanism", detail, errors=errors, defect=defect)


def refuse_invalid_request(errors: FieldFaults) -> Refusal:
    """Build the refusal of another invalid part of a request; ``errors`` are pairs of path and detail."""
    return Refusal(422, "invalid-request", "Invalid request", count_faults(len(errors)), errors=errors)


def refuse_invalid_body(error: ValidationError, body: object) -> Refusal:
    """Build the refusal of a body that is validated by this code and not by the framework."""
    faults = error.errors(include_url=False, include_context=False)
    return refuse_faults([{**fault, "loc": ("body", *fault["loc"])} for fault in faults], body)


def refuse_faults(faults: Sequence[Mapping[str, Any]], body: object) -> Refusal:
    """Build the refusal for pydantic's faults: of a problem, a mechanism or the request, depending on their places."""
    # A union tries several models, which may report the same fault.
    placed = list(dict.fromkeys((locate_fault(fault, body), explain_fault(fault)) for fault in faults))
    if all(path.startswith("/problem/") for path, _ in placed):
        return refuse_invalid_problem(placed)
    if all(path.startswith("/mechanism/") for path, _ in placed):
        return refuse_invalid_mechanism(placed)
    return refuse_invalid_request(placed)


def count_faults(faults: int) -> str:
    """Return a sentence with the number of faults of a request."""
    if faults > MAX_FAULTS:
        return f"The request has more than {MAX_FAULTS} faults; the first {MAX_FAULTS} are listed."
    return f"The request has {format_count(faults, 'fault')}."


__all__ = [
    "FieldFaults",
    "Refusal",
    "count_faults",
    "refuse_faults",
    "refuse_invalid_body",
    "refuse_invalid_mechanism",
    "refuse_invalid_problem",
    "refuse_invalid_request",
    "refuse_not_found",
]
