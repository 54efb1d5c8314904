"""``/problems/{type}``: a page about each type of problem details, at the address that is its type (RFC 9457)."""

from __future__ import annotations

from html import escape
from typing import NamedTuple

from fastapi import APIRouter
from fastapi.responses import HTMLResponse

from kinematics.message import compose, get_language
from service.api.http.problem_details import refuse_not_found


class ProblemType(NamedTuple):
    """The usual HTTP status of a type of problem, and the ids of the messages that are its title and explanation."""

    status: int
    title_id: str
    about_id: str


PROBLEM_TYPES = {
    "malformed-request": ProblemType(400, "service-title-malformed-request", "service-about-malformed-request"),
    "incomplete-body": ProblemType(400, "service-title-incomplete-body", "service-about-incomplete-body"),
    "malformed-json": ProblemType(400, "service-title-malformed-json", "service-about-malformed-json"),
    "malformed-drawing": ProblemType(400, "service-title-malformed-drawing", "service-about-malformed-drawing"),
    "http-error": ProblemType(400, "service-title-http-error", "service-about-http-error"),
    "unauthorized": ProblemType(401, "service-title-unauthorized", "service-about-unauthorized"),
    "foreign-host": ProblemType(403, "service-title-foreign-host", "service-about-foreign-host"),
    "not-found": ProblemType(404, "service-title-not-found", "service-about-not-found"),
    "method-not-allowed": ProblemType(405, "service-title-method-not-allowed", "service-about-method-not-allowed"),
    "request-timeout": ProblemType(408, "service-title-request-timeout", "service-about-request-timeout"),
    "idempotency-key-reused": ProblemType(
        409, "service-title-idempotency-key-reused", "service-about-idempotency-key-reused"
    ),
    "part-of-batch": ProblemType(409, "service-title-part-of-batch", "service-about-part-of-batch"),
    "no-result": ProblemType(409, "service-title-no-result", "service-about-no-result"),
    "no-drawing": ProblemType(409, "service-title-no-drawing", "service-about-no-drawing"),
    "no-motion": ProblemType(409, "service-title-no-motion", "service-about-no-motion"),
    "no-forces": ProblemType(409, "service-title-no-forces", "service-about-no-forces"),
    "no-simulation": ProblemType(409, "service-title-no-simulation", "service-about-no-simulation"),
    "no-parts": ProblemType(409, "service-title-no-parts", "service-about-no-parts"),
    "body-too-large": ProblemType(413, "service-title-body-too-large", "service-about-body-too-large"),
    "unsupported-media-type": ProblemType(
        415, "service-title-unsupported-media-type", "service-about-unsupported-media-type"
    ),
    "invalid-request": ProblemType(422, "service-title-invalid-request", "service-about-invalid-request"),
    "invalid-problem": ProblemType(422, "service-title-invalid-problem", "service-about-invalid-problem"),
    "invalid-mechanism": ProblemType(422, "service-title-invalid-mechanism", "service-about-invalid-mechanism"),
    "invalid-drawing": ProblemType(422, "service-title-invalid-drawing", "service-about-invalid-drawing"),
    "rate-limited": ProblemType(429, "service-title-rate-limited", "service-about-rate-limited"),
    "head-too-large": ProblemType(431, "service-title-head-too-large", "service-about-head-too-large"),
    "gone": ProblemType(499, "service-title-gone", "service-about-gone"),
    "internal-error": ProblemType(500, "service-title-internal-error", "service-about-internal-error"),
    "worker-died": ProblemType(500, "service-title-worker-died", "service-about-worker-died"),
    "no-cad": ProblemType(501, "service-title-no-cad", "service-about-no-cad"),
    "busy": ProblemType(503, "service-title-busy", "service-about-busy"),
    "queue-full": ProblemType(503, "service-title-queue-full", "service-about-queue-full"),
    "too-many-listeners": ProblemType(503, "service-title-too-many-listeners", "service-about-too-many-listeners"),
    "store-unavailable": ProblemType(503, "service-title-store-unavailable", "service-about-store-unavailable"),
    "not-ready": ProblemType(503, "service-title-not-ready", "service-about-not-ready"),
    "timeout": ProblemType(504, "service-title-timeout", "service-about-timeout"),
    "out-of-memory": ProblemType(507, "service-title-out-of-memory", "service-about-out-of-memory"),
}
"""All types of problems by their names, the last part of their addresses."""

_HEADERS = {
    "Content-Security-Policy": "default-src 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
}

router = APIRouter(include_in_schema=False)


@router.get("/problems/{name}", name="describe_problem_type")
async def describe_problem_type(name: str) -> HTMLResponse:
    """Return a page with the title, the status and the explanation of a type."""
    type_ = PROBLEM_TYPES.get(name)
    if type_ is None:
        raise refuse_not_found(compose("service-path-unknown"))
    title, about = escape(compose(type_.title_id)), escape(compose(type_.about_id))
    return HTMLResponse(
        f'<!doctype html>\n<html lang="{get_language()}">\n<meta charset="utf-8">\n<title>{title}</title>\n'
        f"<h1>{title}</h1>\n<p>HTTP {type_.status}</p>\n<p>{about}</p>\n</html>\n",
        headers=_HEADERS,
    )
