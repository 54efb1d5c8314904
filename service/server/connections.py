"""Limits of connections: how long a client may keep the server waiting, and how much data is kept in memory.

The web server itself closes only idle connections. A client that sends part of a request, or does not read its answer,
would keep its connection forever; nine hundred such clients would lock out all others. The web server also accepts
heads of any length and any number of pipelined requests: a few seconds of either fill the memory.

A request refused here reaches no operation. It is answered with problem details, like any refusal, and counted.

An idle connection is closed late and carefully. A client that reuses a connection while it is being closed sees a reset
and cannot know whether its request was processed. Common clients drop a connection after 5 to 60 idle seconds, so the
server waits longer. Before it closes a connection it checks for a request that has arrived but is still unread, because
the event loop runs timers before it reads.
"""

from __future__ import annotations

import asyncio
import json
import resource
import select
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any, ClassVar, cast

import structlog
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

from service.observability.metrics import Metrics
from service.observability.telemetry import CUT_SHORT

REQUEST_TIMEOUT_S = 8.0
"""Time limit from the first byte of a request, or the opening of the connection, to the last byte of its body, seconds.
The target is ten seconds; a busy event loop runs its timers late."""

READING_TIMEOUT_S = 10.0
"""Time for which a client may leave an answer unread that does not fit into the buffers, seconds."""

IDLE_TIMEOUT_S = 75
"""Time for which a connection may wait for its next request, seconds."""

MAX_HEAD_BYTES = 64 << 10
"""Maximum total size of the address and headers of a request, and of any other data outside its body, bytes."""

MAX_PIPELINED = 500
"""Maximum number of pipelined requests before the first answer. Hardly any client sends a second one."""

_EXTRA_WAIT_S = 1.0
_SPARE_FILE_COUNT = 128

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault of a connection: status and type of the problem details that answer it."""

    status: int
    type: str
    title: str
    detail: str

    def format_response(self) -> bytes:
        """Return the complete response, after which the connection is closed."""
        problem = {"type": self.type, "title": self.title, "status": self.status, "detail": self.detail, "instance": ""}
        body = json.dumps(problem).encode()
        return (
            b"HTTP/1.1 %d %b\r\ncontent-type: application/problem+json\r\nconnection: close\r\n"
            b"content-length: %d\r\n\r\n%b" % (self.status, HTTPStatus(self.status).phrase.encode(), len(body), body)
        )


TOO_SLOW = Fault(
    408, "/problems/request-timeout", "Request timeout",
    f"The request was not complete within {REQUEST_TIMEOUT_S:g} seconds.",
)  # fmt: skip
NOT_HTTP = Fault(400, "/problems/malformed-request", "Malformed request", "The data received is not HTTP.")
AMBIGUOUS_HOST = Fault(
    400, "/problems/malformed-request", "Malformed request", "A request must have exactly one `Host` header."
)
HEAD_TOO_LARGE = Fault(
    431, "/problems/head-too-large", "Head too large",
    f"The address and the headers of a request exceed {MAX_HEAD_BYTES} bytes.",
)  # fmt: skip


class Unacceptable(Exception):
    """Ends the parsing of a connection whose fault has been recorded."""


def raise_file_limit() -> int:
    """Raise the limit on open files as far as the system allows; return the number of connections it permits."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft < hard:
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    return max(hard - _SPARE_FILE_COUNT, hard // 2) if hard != resource.RLIM_INFINITY else 1 << 20


class ImpatientProtocol(HttpToolsProtocol):
    """HTTP/1.1 with a limit on every wait for the client and on all that it may send."""

    most: ClassVar[int] = 1 << 20
    """Maximum number of open connections; further ones are closed at once, since the store needs open files, too."""

    metrics: ClassVar[Metrics | None] = None
    """Counts the requests that are refused before they reach an operation."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._request_due: asyncio.TimerHandle | None = None
        self._reading_due: asyncio.TimerHandle | None = None
        self._fault = NOT_HTTP
        self._head = 0
        self._hosts = 0
        self._unread = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Start to wait for the first request."""
        super().connection_made(cast(asyncio.Transport, transport))  # the base class promises less than the loop does
        if len(self.connections) > self.most:
            self.transport.abort()
            return
        self._start_request_timer(REQUEST_TIMEOUT_S)

    def connection_lost(self, exc: Exception | None) -> None:
        """End all waits."""
        self._cancel(self._request_due)
        self._cancel(self._reading_due)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Process received bytes. The parser buffers them until they complete a part of a request."""
        self._unread += len(data)
        super().data_received(data)
        if self._unread > MAX_HEAD_BYTES:
            self._refuse(HEAD_TOO_LARGE)

    def on_message_begin(self) -> None:
        """Handle the beginning of a request."""
        if self._request_due is None:
            self._start_request_timer(REQUEST_TIMEOUT_S)
        self._head = self._hosts = self._unread = 0
        super().on_message_begin()

    def on_url(self, url: bytes) -> None:
        """Handle a part of the address."""
        self._add_to_head(len(url))
        super().on_url(url)

    def on_header(self, name: bytes, value: bytes) -> None:
        """Handle a header, or a trailer after the body."""
        self._add_to_head(len(name) + len(value))
        self._hosts += name.lower() == b"host"
        if self._hosts > 1:  # a proxy in front may have used the other one (RFC 9112, 3.2)
            self._fault = AMBIGUOUS_HOST
            raise Unacceptable
        super().on_header(name, value)

    def on_headers_complete(self) -> None:
        """Handle the end of the headers."""
        if len(self.pipeline) >= MAX_PIPELINED:
            self.transport.abort()
            raise Unacceptable
        super().on_headers_complete()

    def on_body(self, body: bytes) -> None:
        """Handle a part of the body, whose size the application limits."""
        self._unread = 0
        super().on_body(body)

    def on_message_complete(self) -> None:
        """Handle the end of a request."""
        self._unread = 0
        self._cancel(self._request_due)
        self._request_due = None
        super().on_message_complete()

    def on_response_complete(self) -> None:
        """Handle the end of an answer. Reading pauses while further requests wait for theirs."""
        super().on_response_complete()
        if self.pipeline:
            self.flow.pause_reading()

    def send_400_response(self, msg: str) -> None:
        """Refuse the data that the parser has rejected."""
        self._refuse(self._fault)

    def pause_writing(self) -> None:
        """Start the timer for a client that reads too slowly."""
        self._reading_due = self.loop.call_later(READING_TIMEOUT_S, self.transport.abort)
        super().pause_writing()

    def resume_writing(self) -> None:
        """Stop the timer: the client has read."""
        self._cancel(self._reading_due)
        super().resume_writing()

    def timeout_keep_alive_handler(self) -> None:
        """Close an idle connection unless its next request has already arrived."""
        if _has_arrived(self.transport):
            self.timeout_keep_alive_task = self.loop.call_later(_EXTRA_WAIT_S, self.timeout_keep_alive_handler)
            return
        super().timeout_keep_alive_handler()

    def _start_request_timer(self, seconds: float) -> None:
        self._request_due = self.loop.call_later(seconds, self._handle_timeout)

    def _handle_timeout(self) -> None:
        if self.transport.is_closing():
            return
        cycle = self.cycle
        of_an_earlier_request = cycle is not None and cycle.scope is not self.scope
        if (
            self.flow.read_paused
            or _has_arrived(self.transport)
            or (of_an_earlier_request and not cycle.response_complete)
        ):
            # The server itself causes the delay: the client gets more time.
            self._start_request_timer(_EXTRA_WAIT_S)
            return
        if self.scope is None:  # a connection without a request is closed without an answer
            self.transport.close()
        else:
            self._refuse(TOO_SLOW)

    def _add_to_head(self, size: int) -> None:
        self._unread = 0
        self._head += size
        if self._head > MAX_HEAD_BYTES:
            self._fault = HEAD_TOO_LARGE
            raise Unacceptable

    def _refuse(self, fault: Fault) -> None:
        """Answer the incoming request unless its answer has begun, and close the connection."""
        if self.transport.is_closing():
            return
        cycle = self.cycle
        seen = cycle is not None and cycle.scope is self.scope and self._request_due is not None
        if seen and not cycle.response_started:
            self.transport.write(fault.format_response())
            # The operation stops waiting for the rest of the body; telemetry records this status as its answer.
            cycle.scope["state"][CUT_SHORT] = (fault.status, fault.type)
            cycle.disconnected = True
            cycle.message_event.set()
        elif not seen and (cycle is None or cycle.response_complete):
            self.transport.write(fault.format_response())
            log.info("request refused", status=fault.status, problem=fault.type)
            if self.metrics is not None:
                self.metrics.count_unread_refusal(fault.status, fault.type)
        self.transport.close()

    @staticmethod
    def _cancel(timer: asyncio.TimerHandle | None) -> None:
        if timer is not None:
            timer.cancel()


def _has_arrived(transport: asyncio.Transport) -> bool:
    """Return whether the socket has data that the event loop has not read yet."""
    connection = transport.get_extra_info("socket")
    if connection is None or connection.fileno() < 0:
        return False
    waiting = select.poll()
    waiting.register(connection.fileno(), select.POLLIN)
    return bool(waiting.poll(0))
