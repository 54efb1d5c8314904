"""A connection that is idle for long is closed, and never in the face of its next request."""

import asyncio
import os
import socket
import threading
import time

import httpx
import pytest
import uvicorn

from service.connections import IDLE_S, ImpatientProtocol

IDLE_HERE_S = 1
REQUEST = b"GET / HTTP/1.1\r\nHost: x\r\n\r\n"


async def app(scope, receive, send):
    """Answers, and blocks the event loop over the moment at which the idle connection would be closed."""
    assert scope["type"] == "http"
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]})
    await send({"type": "http.response.body", "body": b"ok"})
    if scope["path"] == "/":
        loop = asyncio.get_running_loop()
        end, begin = os.pipe()

        def block():
            # Among the readers, like a callback that waits for an interpreter that another thread holds: the loop
            # looks at its timers after this, and only then for what has arrived.
            os.read(end, 1)
            time.sleep(0.6)  # the block itself, well past the moment
            loop.remove_reader(end)
            os.close(end)
            os.close(begin)

        loop.add_reader(end, block)
        loop.call_later(IDLE_HERE_S - 0.3, os.write, begin, b"x")


def is_answered(connection):
    received = b""
    while chunk := connection.recv(65536):
        received += chunk
        if received.endswith(b"ok"):
            return True
    return False


@pytest.fixture
def url():
    listener = socket.create_server(("127.0.0.1", 0))
    config = uvicorn.Config(
        app, http=ImpatientProtocol, ws="none", lifespan="off", log_config=None, timeout_keep_alive=IDLE_HERE_S
    )
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    thread.start()
    yield listener.getsockname()
    server.should_exit = True
    thread.join(10)


def test_a_request_that_has_arrived_is_answered_before_the_connection_is_closed(url):
    for _ in range(3):
        with socket.create_connection(url, timeout=10) as connection:
            connection.sendall(REQUEST)
            assert is_answered(connection)
            time.sleep(IDLE_HERE_S - 0.1)  # the loop is blocked now, and its timer will be due when it goes on
            connection.sendall(REQUEST.replace(b"/ ", b"/again "))
            assert is_answered(connection)


def test_an_idle_connection_is_closed(url):
    with socket.create_connection(url, timeout=10) as connection:
        connection.sendall(REQUEST.replace(b"/ ", b"/again "))
        assert is_answered(connection)
        began = time.monotonic()
        assert connection.recv(65536) == b""
        assert IDLE_HERE_S - 0.2 < time.monotonic() - began < IDLE_HERE_S + 3.0


def test_clients_let_go_of_idle_connections_before_the_server_does():
    usual = httpx.Limits().keepalive_expiry
    assert usual is not None
    assert usual < IDLE_S
