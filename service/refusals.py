"""Refusals of requests: the status, the type of the problem, and the faults by their places.

A refusal is an exception that a process can raise for the server: it is pickled by its fields. This module imports no
HTTP framework, so the processes that answer requests need not load one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

from kinematics.message import Message, compose, find_message, join_messages, remember_text
from service.error_messages import MAX_FAULTS, Models, describe_faults

FieldFaults = Sequence[tuple[str, str]]
"""Pairs of JSON pointer and description of the fault."""


class Refusal(Exception):
    """A request that is answered with an error, caused by the client or by the state of the service.

    ``title_id`` is the id of the message that is the title. ``defect`` is the type of the internal error that led to
    the refusal, if there was one.
    """

    def __init__(
        self,
        status: int,
        type_: str,
        title_id: str,
        detail: str,
        *,
        errors: FieldFaults = (),
        headers: Mapping[str, str] | None = None,
        defect: str | None = None,
    ) -> None:
        super().__init__(detail)
        self.status = status
        self.type = f"/problems/{type_}"
        self.title_id = title_id
        self.detail = detail
        self.errors = errors
        self.headers = headers
        self.defect = defect

    @property
    def title(self) -> str:
        """Name of the type of error, in the language of the request that is answered."""
        return compose(self.title_id)

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle the fields and the messages of the texts: the default would call the constructor with the detail."""
        headers = None if self.headers is None else dict(self.headers)
        fields = self.type, self.title_id, self.detail, list(self.errors), headers, self.defect
        texts = [self.detail, *(text for _, text in self.errors)]
        messages = [(text, message) for text in texts if (message := find_message(text)) is not None]
        return _restore_refusal, (self.status, *fields, messages)


def _restore_refusal(
    status: int,
    type_: str,
    title_id: str,
    detail: str,
    errors: FieldFaults,
    headers: dict[str, str] | None,
    defect: str | None,
    messages: Sequence[tuple[str, Message]],
) -> Refusal:
    for text, message in messages:
        remember_text(text, message)
    name = type_.removeprefix("/problems/")
    return Refusal(status, name, title_id, detail, errors=errors, headers=headers, defect=defect)


def refuse_not_found(detail: str) -> Refusal:
    """Build the refusal for a missing resource."""
    return Refusal(404, "not-found", "service-title-not-found", detail)


def refuse_invalid_problem(errors: FieldFaults) -> Refusal:
    """Build the refusal of an invalid problem; ``errors`` are pairs of path and detail."""
    return Refusal(422, "invalid-problem", "service-title-invalid-problem", describe_first_fault(errors), errors=errors)


def refuse_invalid_mechanism(errors: FieldFaults, *, defect: str | None = None) -> Refusal:
    """Build the refusal of an invalid mechanism; ``errors`` are pairs of path and detail."""
    detail = describe_first_fault(errors)
    return Refusal(422, "invalid-mechanism", "service-title-invalid-mechanism", detail, errors=errors, defect=defect)


def refuse_invalid_request(errors: FieldFaults) -> Refusal:
    """Build the refusal of another invalid part of a request; ``errors`` are pairs of path and detail."""
    return Refusal(422, "invalid-request", "service-title-invalid-request", describe_first_fault(errors), errors=errors)


def refuse_invalid_body(error: ValidationError, body: object, model: type[BaseModel]) -> Refusal:
    """Build the refusal of a body that is validated by this code, against ``model``, and not by the framework."""
    faults = error.errors(include_url=False)
    return refuse_faults([{**fault, "loc": ("body", *fault["loc"])} for fault in faults], body, {"body": model})


def refuse_faults(faults: Sequence[Mapping[str, Any]], body: object, models: Models) -> Refusal:
    """Build the refusal for pydantic's faults: of a problem, a mechanism or the request, depending on their places."""
    placed = describe_faults(faults, body, models)
    if all(path.startswith("/problem/") for path, _ in placed):
        return refuse_invalid_problem(placed)
    if all(path.startswith("/mechanism/") for path, _ in placed):
        return refuse_invalid_mechanism(placed)
    return refuse_invalid_request(placed)


def describe_first_fault(errors: FieldFaults) -> str:
    """Return the first fault of a request in words, with its place and the number of other invalid fields."""
    path, reason = errors[0]
    first = compose("service-fault-at-place", path=path, reason=reason) if path else reason
    # Several faults may be reported for one field.
    count = len({path for path, _ in errors})
    if count > MAX_FAULTS:
        return join_messages([first, compose("service-many-fields-invalid", count=MAX_FAULTS)])
    return join_messages([first, compose("service-other-fields-invalid", count=count - 1)]) if count > 1 else first


__all__ = [
    "FieldFaults",
    "Refusal",
    "describe_first_fault",
    "refuse_faults",
    "refuse_invalid_body",
    "refuse_invalid_mechanism",
    "refuse_invalid_problem",
    "refuse_invalid_request",
    "refuse_not_found",
]
