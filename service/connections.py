"""How long a connection may keep the server waiting.

The web server itself closes idle connections only. A client that sends a request by halves, or does not read its
answer, would keep its connection for ever; nine hundred of them would keep everybody else out.

An idle connection is closed late and with care. A client that uses it again at the moment of its end sees a reset, and
cannot know whether its request was seen. The usual clients drop a connection that has been idle for 5 to 60 seconds by
themselves, so the server waits longer than they do; and it looks first whether a request has just arrived that the
event loop has not come to yet, since the loop runs timers before it reads.
"""

from __future__ import annotations

import asyncio
import json
import resource
import select
from typing import Any, cast

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

REQUEST_S = 8.0
"""From the first byte of a request, or the opening of the connection, to the last byte of its body. Ten seconds are the
most that a connection may take up; a busy event loop comes to its timers late."""

READING_S = 10.0
"""How long a client may leave an answer unread that no longer fits into the buffers."""

IDLE_S = 75
"""How long a connection may wait for its next request."""

_MORE_S = 1.0
_SPARE_FILES = 128
_TIMEOUT = json.dumps(
    {
        "type": "/problems/request-timeout",
        "title": "Request timeout",
        "status": 408,
        "detail": f"The request was not complete within {REQUEST_S:g} seconds.",
        "instance": "",
    }
).encode()
_TOO_SLOW = (
    b"HTTP/1.1 408 Request Timeout\r\ncontent-type: application/problem+json\r\nconnection: close\r\n"
    b"content-length: %d\r\n\r\n%b" % (len(_TIMEOUT), _TIMEOUT)
)


def raise_file_limit() -> int:
    """Allow as many open files as the system lets us have; gives how many connections that is good for."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft < hard:
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    return max(hard - _SPARE_FILES, hard // 2) if hard != resource.RLIM_INFINITY else 1 << 20


class ImpatientProtocol(HttpToolsProtocol):
    """HTTP/1.1 with an end to every wait for the client."""

    most = 1 << 20
    """Connections at once; one more is closed at once, since files that run out would hit the store as well."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._request_due: asyncio.TimerHandle | None = None
        self._reading_due: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Begin to wait for the first request."""
        super().connection_made(cast(asyncio.Transport, transport))  # the base class promises less than the loop does
        if len(self.connections) > self.most:
            self.transport.abort()
            return
        self._await_request(REQUEST_S)

    def connection_lost(self, exc: Exception | None) -> None:
        """End all waits."""
        self._cancel(self._request_due)
        self._cancel(self._reading_due)
        super().connection_lost(exc)

    def on_message_begin(self) -> None:
        """A request begins."""
        if self._request_due is None:
            self._await_request(REQUEST_S)
        super().on_message_begin()

    def on_message_complete(self) -> None:
        """A request is there, whole."""
        self._cancel(self._request_due)
        self._request_due = None
        super().on_message_complete()

    def pause_writing(self) -> None:
        """The client does not read as fast as it is answered."""
        self._reading_due = self.loop.call_later(READING_S, self.transport.abort)
        super().pause_writing()

    def resume_writing(self) -> None:
        """The client has read."""
        self._cancel(self._reading_due)
        super().resume_writing()

    def timeout_keep_alive_handler(self) -> None:
        """Close an idle connection, unless its next request has arrived already."""
        if _has_arrived(self.transport):
            self.timeout_keep_alive_task = self.loop.call_later(_MORE_S, self.timeout_keep_alive_handler)
            return
        super().timeout_keep_alive_handler()

    def _await_request(self, seconds: float) -> None:
        self._request_due = self.loop.call_later(seconds, self._too_slow)

    def _too_slow(self) -> None:
        if self.transport.is_closing():
            return
        cycle = self.cycle
        of_an_earlier_request = cycle is not None and cycle.scope is not self.scope
        if (
            self.flow.read_paused
            or _has_arrived(self.transport)
            or (of_an_earlier_request and not cycle.response_complete)
        ):
            # It is the server that has not come to it.
            self._await_request(_MORE_S)
            return
        begun = self.scope is not None
        if begun and (cycle is None or of_an_earlier_request or not cycle.response_started):
            self.transport.write(_TOO_SLOW)
            if cycle is not None:
                cycle.disconnected = True
                cycle.message_event.set()
        self.transport.close()

    @staticmethod
    def _cancel(timer: asyncio.TimerHandle | None) -> None:
        if timer is not None:
            timer.cancel()


def _has_arrived(transport: asyncio.Transport) -> bool:
    """Whether there is something to read that nobody has read yet."""
    connection = transport.get_extra_info("socket")
    if connection is None or connection.fileno() < 0:
        return False
    waiting = select.poll()
    waiting.register(connection.fileno(), select.POLLIN)
    return bool(waiting.poll(0))
