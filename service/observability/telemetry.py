"""Telemetry of requests: a log line, metrics, the request id, and the time spent in its parts.

Each request has a record in a context variable, to which all parts of the answer contribute. The middleware is
outermost, so that the answer to a defect is covered, too.
"""

from __future__ import annotations

import re
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field

import structlog
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from ulid import ULID

from service.observability.head import is_head_request
from service.observability.metrics import Metrics

CUT_SHORT = "mechsynth.cut_short"
"""Key in the state of a request for the status and problem with which the connection answered it while its operation
was still waiting for the rest of the body."""

_CLIENT_ID_PATTERN = re.compile("[A-Za-z0-9._:/+=@-]{1,100}")

log = structlog.get_logger(__name__)


@dataclass(slots=True)
class _Record:
    spans: dict[str, float] = field(default_factory=dict)
    headers: dict[str, str] = field(default_factory=dict)
    refused: str | None = None
    defect: str | None = None
    status: int = 0


_record: ContextVar[_Record | None] = ContextVar("record", default=None)


@contextmanager
def measure_span(name: str) -> Iterator[None]:
    """Measure the time of a part of the present request for ``Server-Timing``; equal names add up."""
    began = time.perf_counter()
    try:
        yield
    finally:
        record = _record.get()
        if record is not None:
            record.spans[name] = record.spans.get(name, 0.0) + time.perf_counter() - began


def note_refusal(type_: str) -> None:
    """Record the type of the problem with which the present request is answered."""
    record = _record.get()
    if record is not None:
        record.refused = type_


def note_defect(error: str) -> None:
    """Record that the present request has hit a defect of the service, by the type of the error."""
    record = _record.get()
    if record is not None:
        record.defect = error


def add_headers(headers: Mapping[str, str]) -> None:
    """Add headers to any answer to the present request."""
    record = _record.get()
    if record is not None:
        record.headers.update(headers)


class Telemetry:
    """Middleware around the application that observes every request."""

    def __init__(self, app: ASGIApp, metrics: Metrics) -> None:
        self._app = app
        self._metrics = metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, and add its id and timing to the answer."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        began = time.perf_counter()
        record = _Record()
        _record.set(record)
        request_id = _get_request_id(scope)
        structlog.contextvars.clear_contextvars()
        structlog.contextvars.bind_contextvars(request=request_id)

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                record.status = message["status"]
                headers = MutableHeaders(raw=message["headers"])
                headers.update(record.headers)
                headers["X-Request-ID"] = request_id
                headers["Server-Timing"] = _format_server_timing(record.spans, time.perf_counter() - began)
            await send(message)

        try:
            await self._app(scope, receive, send_with_headers)
        finally:
            self._record_request(scope, record, time.perf_counter() - began)

    def _record_request(self, scope: Scope, record: _Record, seconds: float) -> None:
        if CUT_SHORT in scope.get("state", ()):
            record.status, record.refused = scope["state"][CUT_SHORT]
        route = scope.get("route")
        operation = getattr(route, "operation_id", None) or getattr(route, "name", None) or "none"
        method = "HEAD" if is_head_request(scope) else scope["method"]
        self._metrics.count_request(operation, method, record.status, seconds)
        if record.refused is not None:
            self._metrics.count_rejection(record.refused)
        if record.defect is not None:
            self._metrics.count_defect(operation)
        # The query is omitted, since it may contain a secret, and long paths are cut.
        log.info(
            "request",
            method=method[:20],
            path=scope["path"][:200],
            status=record.status or "none",
            ms=round(1e3 * seconds, 2),
            **({} if record.refused is None else {"problem": record.refused}),
            **({} if record.defect is None else {"defect": record.defect}),
        )


def _get_request_id(scope: Scope) -> str:
    # A proxy or client may have assigned an id already; then both logs use the same one.
    given = Headers(scope=scope).get("x-request-id", "")
    return given if _CLIENT_ID_PATTERN.fullmatch(given) else str(ULID())


def _format_server_timing(spans: dict[str, float], total: float) -> str:
    return ", ".join(f"{name};dur={1e3 * seconds:.2f}" for name, seconds in [*spans.items(), ("total", total)])
