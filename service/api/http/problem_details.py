"""Errors as problem details (RFC 9457), with the place of each fault as a JSON pointer (RFC 6901)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import Response
from fastapi.routing import APIRoute
from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import to_json
from sqlalchemy.exc import SQLAlchemyError
from starlette.exceptions import HTTPException
from starlette.routing import Match

from kinematics.message import compose
from service.error_messages import MAX_FAULTS, Models
from service.jobs.store.database import is_unreachable
from service.observability import telemetry
from service.refusals import (
    Refusal,
    refuse_faults,
    refuse_invalid_body,
    refuse_invalid_mechanism,
    refuse_invalid_problem,
    refuse_invalid_request,
    refuse_not_found,
)
from synthesis.model.json_object import JsonObject
from synthesis.model.text_messages import TextMessage, list_messages

__all__ = [
    "FieldError",
    "ProblemDetails",
    "Refusal",
    "describe_responses",
    "install",
    "refuse_busy",
    "refuse_compiling",
    "refuse_full_queue",
    "refuse_gone",
    "refuse_invalid_body",
    "refuse_invalid_drawing",
    "refuse_invalid_mechanism",
    "refuse_invalid_problem",
    "refuse_invalid_request",
    "refuse_malformed_drawing",
    "refuse_malformed_json",
    "refuse_not_found",
    "refuse_without_store",
]

PROBLEM_JSON = "application/problem+json"

STORE_RETRY_AFTER_S = 2
"""Value of ``Retry-After`` while the store is unreachable, seconds; PostgreSQL restarts within a second or two."""

QUEUE_RETRY_AFTER_S = 5
"""Value of ``Retry-After`` for a full queue, seconds."""

log = structlog.get_logger(__name__)


class FieldError(BaseModel):
    """A fault at one place of the request."""

    model_config = ConfigDict(title="Field error")

    path: str = Field(
        description="JSON pointer into the request body; a query parameter is at /query/name, "
        "a header at /header/name, an element of a drawing at /its-id.",
        examples=["/problem/positions/1/x"],
    )
    detail: str = Field(description="Description of the fault, a sentence.")


class ProblemDetails(BaseModel):
    """Details of an error (RFC 9457)."""

    model_config = ConfigDict(title="Problem details")

    type: str = Field(description="URI path that identifies the type of error.", examples=["/problems/not-found"])
    title: str = Field(description="Name of the type of error.", examples=["Not found"])
    status: int = Field(description="HTTP status.", examples=[404])
    detail: str = Field(description="Description of this error.")
    instance: str = Field(description="Path of the request.", examples=["/v1/jobs"])
    errors: list[FieldError] | None = Field(
        default=None, description=f"At most {MAX_FAULTS} faults of an invalid request, each with its place."
    )
    messages: list[TextMessage] = Field(
        default=[],
        description="Ids and values of the texts in this object, which clients may compare or translate.",
    )


def refuse_malformed_json(detail: str, errors: Sequence[tuple[str, str]] = ()) -> Refusal:
    """Build the refusal of a body that cannot be parsed as JSON; ``errors`` are pairs of path and detail."""
    return Refusal(400, "malformed-json", "service-title-malformed-json", detail, errors=errors)


def refuse_malformed_drawing(detail: str) -> Refusal:
    """Build the refusal of a body that cannot be read as a drawing."""
    return Refusal(400, "malformed-drawing", "service-title-malformed-drawing", detail)


def refuse_invalid_drawing(detail: str, errors: Sequence[tuple[str, str]] = ()) -> Refusal:
    """Build the refusal of a drawing without usable outlines; ``errors`` are pairs of element and detail."""
    return Refusal(422, "invalid-drawing", "service-title-invalid-drawing", detail, errors=errors)


def refuse_without_store() -> Refusal:
    """Build the refusal for a job store that does not answer."""
    return Refusal(
        503, "store-unavailable", "service-title-store-unavailable",
        compose("service-store-unavailable"),
        headers={"Retry-After": str(STORE_RETRY_AFTER_S)},
    )  # fmt: skip


def refuse_full_queue() -> Refusal:
    """Build the refusal for a full queue."""
    return Refusal(
        503, "queue-full", "service-title-queue-full",
        compose("service-queue-full"),
        headers={"Retry-After": str(QUEUE_RETRY_AFTER_S)},
    )  # fmt: skip


def refuse_busy(message_id: str) -> Refusal:
    """Build the refusal of a request that did not get its turn because of others, which the message names."""
    return Refusal(
        503, "busy", "service-title-busy", compose(message_id),
        headers={"Retry-After": "5"},
    )  # fmt: skip


def refuse_gone() -> Refusal:
    """Build the refusal for a client that has disconnected; it appears only in the log and the metrics."""
    # HTTP has no status for this; 499 is nginx's.
    return Refusal(499, "gone", "service-title-gone", compose("service-client-gone"))


def refuse_compiling() -> Refusal:
    """Build the refusal for the time after an installation when the kernels of analyses are compiled."""
    return Refusal(
        503, "busy", "service-title-busy",
        compose("service-kernels-compiling"),
        headers={"Retry-After": "5"},
    )  # fmt: skip


def describe_responses(**described: str) -> dict[int | str, JsonObject]:
    """Return the error responses of an endpoint for OpenAPI: ``describe_responses(e404="There is no such job.")``."""
    content = {PROBLEM_JSON: {"schema": {"$ref": "#/components/schemas/ProblemDetails"}}}
    again = {"Retry-After": {"description": "Seconds to wait before the next attempt.", "schema": {"type": "integer"}}}
    return {
        int(name[1:]): {"description": text, "content": content}
        # Only these two errors are temporary, so only they have the header `Retry-After`.
        | ({"headers": again} if name in ("e429", "e503") else {})
        for name, text in described.items()
    }


def install(app: FastAPI) -> None:
    """Make ``app`` answer every error in this format."""
    app.add_exception_handler(Refusal, _respond_to_refusal)
    app.add_exception_handler(RequestValidationError, _respond_to_invalid)
    app.add_exception_handler(HTTPException, _respond_to_http_error)
    app.add_exception_handler(SQLAlchemyError, _respond_to_store_error)
    app.add_exception_handler(Exception, _respond_to_defect)


async def _respond_to_refusal(request: Request, refusal: Exception) -> Response:
    assert isinstance(refusal, Refusal)
    return _build_response(
        request, refusal.status, refusal.type, refusal.title, refusal.detail, refusal.errors, refusal.headers
    )


async def _respond_to_invalid(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    return await _respond_to_refusal(request, refuse_faults(error.errors(), error.body, _get_models(request)))


def _get_models(request: Request) -> Models:
    """Return the models of the body and of the query that the operation of a request declares."""
    route = request.scope.get("route")
    if not isinstance(route, APIRoute):
        return {}
    models: dict[str, object] = {}
    if route.body_field is not None:
        models["body"] = route.body_field.field_info.annotation
    # A query with a model has no other parameters, and only such a query refuses unknown ones.
    for parameter in route.dependant.query_params:
        models["query"] = parameter.field_info.annotation
    return models


async def _respond_to_http_error(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    # The framework's own errors: no route has this path, or none has this method.
    if error.status_code == 404:
        return _build_response(
            request, 404, "/problems/not-found", compose("service-title-not-found"), compose("service-path-unknown")
        )
    if error.status_code == 405:
        allowed = _list_allowed_methods(request)
        detail = _describe_methods(request, ", ".join(allowed))
        headers = {"Allow": ", ".join(allowed)}
        return _build_response(
            request,
            405,
            "/problems/method-not-allowed",
            compose("service-title-method-not-allowed"),
            detail,
            headers=headers,
        )
    return _build_response(
        request, error.status_code, "/problems/http-error", compose("service-title-http-error"),
        compose("service-request-not-served"), headers=error.headers,
    )  # fmt: skip


async def _respond_to_store_error(request: Request, error: Exception) -> Response:
    # A wrong statement is a defect of the service and becomes a 500.
    if not is_unreachable(error):
        raise error
    log.warning("the store does not answer", error=type(error).__name__)
    return await _respond_to_refusal(request, refuse_without_store())


async def _respond_to_defect(request: Request, _error: Exception) -> Response:
    # The server logs the exception with its traceback afterwards; the client must not see it.
    detail = compose("service-request-failed")
    return _build_response(request, 500, "/problems/internal-error", compose("service-title-internal-error"), detail)


def _build_response(
    request: Request,
    status: int,
    type_: str,
    title: str,
    detail: str,
    errors: Sequence[tuple[str, str]] = (),
    headers: Mapping[str, str] | None = None,
) -> Response:
    telemetry.note_refusal(type_)
    content: JsonObject = {
        "type": type_,
        "title": title,
        "status": status,
        "detail": detail,
        "instance": request.scope.get("raw_path", b"").decode("ascii", "replace"),
    }
    if errors:
        content["errors"] = [{"path": path, "detail": text} for path, text in errors[:MAX_FAULTS]]
    content["messages"] = list_messages(content)
    return Response(to_json(content), status_code=status, headers=dict(headers or {}), media_type=PROBLEM_JSON)


def _describe_methods(request: Request, allowed: str) -> str:
    # An unknown method is text from the client and must not be repeated.
    known = {"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}
    if request.method in known:
        return compose("service-method-not-allowed", method=request.method, methods=allowed)
    return compose("service-unknown-method-not-allowed", methods=allowed)


def _list_allowed_methods(request: Request) -> list[str]:
    # The framework names the methods of a single route, but several routes may share the path.
    matching = (route for route in request.app.state.routes if route.matches(request.scope)[0] is not Match.NONE)
    return sorted({method for route in matching for method in getattr(route, "methods", None) or ()})
