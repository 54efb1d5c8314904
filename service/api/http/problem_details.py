"""Every error as problem details (RFC 9457), with the place of each fault as a JSON pointer (RFC 6901)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import Response
from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import to_json
from sqlalchemy.exc import SQLAlchemyError
from starlette.exceptions import HTTPException
from starlette.routing import Match

from service.error_messages import MAX_FAULTS
from service.jobs.store.database import unreachable
from service.observability import telemetry
from service.refusals import (
    Refusal,
    invalid_body,
    invalid_mechanism,
    invalid_problem,
    invalid_request,
    not_found,
    refuse_faults,
)

__all__ = [
    "FieldError",
    "ProblemDetails",
    "Refusal",
    "busy",
    "compiling",
    "gone",
    "install",
    "invalid_body",
    "invalid_drawing",
    "invalid_mechanism",
    "invalid_problem",
    "invalid_request",
    "malformed_drawing",
    "malformed_json",
    "not_found",
    "queue_full",
    "responses",
    "store_unavailable",
]

PROBLEM_JSON = "application/problem+json"

STORE_RETRY_AFTER_S = 2
"""When to ask again while the store is out of reach; PostgreSQL restarts within a second or two."""

QUEUE_RETRY_AFTER_S = 5
"""When a client who found no place in the queue should send its job again."""

log = structlog.get_logger(__name__)


class FieldError(BaseModel):
    """A fault at one place of the request."""

    model_config = ConfigDict(title="Field error")

    path: str = Field(
        description="JSON pointer into the request body; a query parameter is at /query/name, "
        "a header at /header/name, an element of a drawing at /its-id.",
        examples=["/problem/positions/1/x"],
    )
    detail: str = Field(description="What is wrong there, in a sentence.")


class ProblemDetails(BaseModel):
    """What went wrong (RFC 9457)."""

    model_config = ConfigDict(title="Problem details")

    type: str = Field(description="A stable URI path that names the kind of error.", examples=["/problems/not-found"])
    title: str = Field(description="The kind of error in words.", examples=["Not found"])
    status: int = Field(description="The HTTP status.", examples=[404])
    detail: str = Field(description="What went wrong this time.")
    instance: str = Field(description="The path of the request.", examples=["/v1/jobs"])
    errors: list[FieldError] | None = Field(
        default=None, description=f"The faults of an invalid request by place, {MAX_FAULTS} at most."
    )


def malformed_json(detail: str, errors: Sequence[tuple[str, str]] = ()) -> Refusal:
    """The body is not JSON, or not such as is parsed; ``errors`` are pairs of path and detail."""
    return Refusal(400, "malformed-json", "Malformed JSON", detail, errors=errors)


def malformed_drawing(detail: str) -> Refusal:
    """The body is no drawing that can be read."""
    return Refusal(400, "malformed-drawing", "Malformed drawing", detail)


def invalid_drawing(detail: str, errors: Sequence[tuple[str, str]] = ()) -> Refusal:
    """The drawing has no outlines to be had; ``errors`` are pairs of an element's place and detail."""
    return Refusal(422, "invalid-drawing", "Invalid drawing", detail, errors=errors)


def store_unavailable() -> Refusal:
    """The store does not answer, so that nothing is known."""
    return Refusal(
        503, "store-unavailable", "Store unavailable",
        "The job store does not answer; send this again later. With an Idempotency-Key that makes one job at most.",
        headers={"Retry-After": str(STORE_RETRY_AFTER_S)},
    )  # fmt: skip


def queue_full() -> Refusal:
    """There is no place for more in the queue."""
    return Refusal(
        503, "queue-full", "Queue full", "As many of your jobs wait as may; send this one again later.",
        headers={"Retry-After": str(QUEUE_RETRY_AFTER_S)},
    )  # fmt: skip


def busy(with_what: str) -> Refusal:
    """Others of the same sort have kept this request from its turn."""
    return Refusal(
        503, "busy", "Busy", f"The service is busy with other {with_what}; ask again.", headers={"Retry-After": "5"}
    )


def gone() -> Refusal:
    """Nobody waits for the answer, which the log has all the same."""
    return Refusal(499, "gone", "Gone", "The client has gone away.")


def compiling() -> Refusal:
    """The first start after an installation is not at its end."""
    return Refusal(
        503, "busy", "Busy",
        "What analyses call is being compiled, once after an installation; `/readyz` says how far that is.",
        headers={"Retry-After": "5"},
    )  # fmt: skip


def responses(**described: str) -> dict[int | str, dict[str, Any]]:
    """The error responses of an endpoint for OpenAPI: ``responses(e404="There is no such job.")``."""
    content = {PROBLEM_JSON: {"schema": {"$ref": "#/components/schemas/ProblemDetails"}}}
    again = {"Retry-After": {"description": "Ask again after so many seconds.", "schema": {"type": "integer"}}}
    return {
        int(name[1:]): {"description": text, "content": content}
        | ({"headers": again} if name in ("e429", "e503") else {})
        for name, text in described.items()
    }


def install(app: FastAPI) -> None:
    """Make ``app`` answer every error in this form."""
    app.add_exception_handler(Refusal, _refused)
    app.add_exception_handler(RequestValidationError, _invalid)
    app.add_exception_handler(HTTPException, _http_error)
    app.add_exception_handler(SQLAlchemyError, _store_error)
    app.add_exception_handler(Exception, _defect)


async def _refused(request: Request, refusal: Exception) -> Response:
    assert isinstance(refusal, Refusal)
    return _answer(
        request, refusal.status, refusal.type, refusal.title, refusal.detail, refusal.errors, refusal.headers
    )


async def _invalid(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    return await _refused(request, refuse_faults(error.errors(), error.body))


async def _http_error(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    if error.status_code == 404:
        return _answer(request, 404, "/problems/not-found", "Not found", "There is nothing at this path.")
    if error.status_code == 405:
        allowed = _allowed_methods(request)
        detail = f"This path does not take {_method(request)}; it takes {', '.join(allowed)}."
        headers = {"Allow": ", ".join(allowed)}
        return _answer(request, 405, "/problems/method-not-allowed", "Method not allowed", detail, headers=headers)
    return _answer(
        request, error.status_code, "/problems/http-error", "HTTP error", "The request cannot be served.",
        headers=error.headers,
    )  # fmt: skip


async def _store_error(request: Request, error: Exception) -> Response:
    if not unreachable(error):
        raise error
    log.warning("the store does not answer", error=type(error).__name__)
    return await _refused(request, store_unavailable())


async def _defect(request: Request, _error: Exception) -> Response:
    # The server logs the exception with its traceback after this; the client gets none of it.
    detail = "The service failed on this request by a defect of its own; its log has the details."
    return _answer(request, 500, "/problems/internal-error", "Internal error", detail)


def _answer(
    request: Request,
    status: int,
    type_: str,
    title: str,
    detail: str,
    errors: Sequence[tuple[str, str]] = (),
    headers: Mapping[str, str] | None = None,
) -> Response:
    telemetry.refused(type_)
    content: dict[str, Any] = {
        "type": type_,
        "title": title,
        "status": status,
        "detail": detail,
        "instance": request.scope.get("raw_path", b"").decode("ascii", "replace"),
    }
    if errors:
        content["errors"] = [{"path": path, "detail": text} for path, text in errors[:MAX_FAULTS]]
    return Response(to_json(content), status_code=status, headers=dict(headers or {}), media_type=PROBLEM_JSON)


def _method(request: Request) -> str:
    # An unknown method is text from the client and is not repeated.
    known = {"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}
    return request.method if request.method in known else "this method"


def _allowed_methods(request: Request) -> list[str]:
    # The framework names the methods of a single route, but several may share the path.
    matching = (route for route in request.app.state.routes if route.matches(request.scope)[0] is not Match.NONE)
    return sorted({method for route in matching for method in getattr(route, "methods", None) or ()})
