"""A client that costs little: keeps a few connections busy with prepared requests, so that it is the server that is
measured.

Each connection sends a request, reads the answer to its end, and sends the next one; nothing is parsed but the status
and the length of the body.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import cast
from urllib.parse import urlsplit

import uvloop

GIVE_UP_S = 120.0


@dataclass
class Load:
    """What came of it: a status and a time for each request, and the seconds that all of them took together."""

    statuses: list[int] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    bodies: list[bytes] = field(default_factory=list)
    seconds: float = 0.0

    @property
    def rate(self) -> float:
        """Requests by the second."""
        return len(self.statuses) / self.seconds


class _Connection(asyncio.Protocol):
    def __init__(self, next_request: Callable[[], bytes | None], load: Load, keep_bodies: bool) -> None:
        self._next_request = next_request
        self._load = load
        self._keep_bodies = keep_bodies
        self._received = bytearray()
        self._due = 0
        self.ended = asyncio.get_running_loop().create_future()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = cast(asyncio.Transport, transport)
        self._ask()

    def data_received(self, data: bytes) -> None:
        self._received += data
        if not self._due:
            head = self._received.find(b"\r\n\r\n")
            if head < 0:
                return
            names = bytes(self._received[:head]).lower()
            self._head = head + 4
            self._due = self._head + int(names.split(b"content-length:")[1].split(b"\r\n")[0])
        if len(self._received) < self._due:
            return
        self._load.times.append(time.perf_counter() - self._began)
        self._load.statuses.append(int(self._received[9:12]))
        if self._keep_bodies:
            self._load.bodies.append(bytes(self._received[self._head :]))
        self._received.clear()
        self._due = 0
        self._ask()

    def connection_lost(self, exc: Exception | None) -> None:
        if not self.ended.done():
            self.ended.set_exception(exc or ConnectionError("the server has closed the connection"))

    def _ask(self) -> None:
        request = self._next_request()
        if request is None:
            self.ended.set_result(None)
            self._transport.close()
            return
        self._began = time.perf_counter()
        self._transport.write(request)


def request(method: str, path: str, body: bytes = b"", headers: Mapping[str, str] | None = None) -> bytes:
    """A request as it goes over the wire."""
    lines = [f"{method} {path} HTTP/1.1", "host: localhost"]
    lines += [f"{name}: {value}" for name, value in (headers or {}).items()]
    if body:
        lines += ["content-type: application/json", f"content-length: {len(body)}"]
    return "\r\n".join([*lines, "", ""]).encode() + body


def run(url: str, requests: list[bytes], connections: int, *, keep_bodies: bool = False) -> Load:
    """Send the requests, dealt out over so many connections."""
    load = Load()
    waiting = iter(requests)

    async def all_of_them() -> None:
        loop = asyncio.get_running_loop()
        address = urlsplit(url)
        opened = [
            await loop.create_connection(
                lambda: _Connection(lambda: next(waiting, None), load, keep_bodies), address.hostname, address.port
            )
            for _ in range(connections)
        ]
        async with asyncio.timeout(GIVE_UP_S):
            await asyncio.gather(*(connection.ended for _, connection in opened))

    start = time.perf_counter()
    uvloop.run(all_of_them())
    load.seconds = time.perf_counter() - start
    return load
