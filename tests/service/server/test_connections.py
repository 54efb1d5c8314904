"""A connection that is idle for long is closed, and never in the face of its next request; one that floods at once."""

import asyncio
import json
import re
import socket
import threading
import time

import httpx
import pytest
import uvicorn

from service.observability.metrics import Metrics
from service.observability.telemetry import Telemetry
from service.server import connections
from service.server.connections import IDLE_TIMEOUT_S, MAX_HEAD_BYTES, MAX_PIPELINED, ImpatientProtocol

IDLE_HERE_S = 1
REQUEST = b"GET / HTTP/1.1\r\nHost: x\r\n\r\n"
is_blocked, has_sent = threading.Event(), threading.Event()


async def app(scope, receive, send):
    """Answers, and blocks the event loop over the moment at which the idle connection would be closed."""
    assert scope["type"] == "http"
    if scope["path"] == "/reads":
        more = {"more_body": True}
        while more.get("more_body"):
            more = await receive()
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]})
    await send({"type": "http.response.body", "body": b"ok"})
    if scope["path"] == "/":
        loop = asyncio.get_running_loop()
        ours, others = socket.socketpair()

        def block():
            # Among the readers, like a callback that waits for an interpreter that another thread holds: the loop
            # looks at its timers after this, and only then for what has arrived.
            loop.remove_reader(ours)
            is_blocked.set()
            has_sent.wait(10)
            time.sleep(IDLE_HERE_S + 0.1)  # the block itself, past the moment
            ours.close()

        loop.add_reader(ours, block)
        others.close()


def is_answered(connection):
    received = b""
    while chunk := connection.recv(65536):
        received += chunk
        if received.endswith(b"ok"):
            return True
    return False


@pytest.fixture
def metrics(monkeypatch):
    metrics = Metrics()
    monkeypatch.setattr(ImpatientProtocol, "metrics", metrics)
    return metrics


@pytest.fixture
def url(metrics):
    listener = socket.create_server(("127.0.0.1", 0))
    config = uvicorn.Config(
        Telemetry(app, metrics),
        http=ImpatientProtocol,
        ws="none",
        lifespan="off",
        log_config=None,
        timeout_keep_alive=IDLE_HERE_S,
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
            is_blocked.clear()
            has_sent.clear()
            connection.sendall(REQUEST)
            assert is_answered(connection)
            assert is_blocked.wait(10)
            connection.sendall(REQUEST.replace(b"/ ", b"/again "))
            has_sent.set()
            assert is_answered(connection)


def test_an_idle_connection_is_closed(url):
    with socket.create_connection(url, timeout=10) as connection:
        began = time.monotonic()
        connection.sendall(REQUEST.replace(b"/ ", b"/again "))
        assert is_answered(connection)
        assert connection.recv(65536) == b""
        assert IDLE_HERE_S - 0.1 < time.monotonic() - began < IDLE_HERE_S + 3.0


def test_clients_let_go_of_idle_connections_before_the_server_does():
    usual = httpx.Limits().keepalive_expiry
    assert usual is not None
    assert usual < IDLE_TIMEOUT_S


def received(connection):
    """All that comes until the server closes."""
    answer = b""
    try:
        while chunk := connection.recv(65536):
            answer += chunk
    except ConnectionError:  # what was still to be sent is reset
        pass
    return answer


def sent_until_closed(url, beginning, more, pieces):
    """Send a beginning and then a piece again and again; everything that is answered."""
    with socket.create_connection(url, timeout=10) as connection:
        try:
            connection.sendall(beginning)
            for _ in range(pieces):
                connection.sendall(more)
            connection.shutdown(socket.SHUT_WR)
        except ConnectionError:
            pass
        return received(connection)


def counted(metrics, status, reason):
    """Requests that were answered with a status, and rejections for a reason."""
    samples = [sample for family in metrics.registry.collect() for sample in family.samples]
    return (
        sum(s.value for s in samples if s.name == "mechsynth_http_requests_total" and s.labels["status"] == status),
        sum(s.value for s in samples if s.name == "mechsynth_http_rejections_total" and s.labels["reason"] == reason),
    )


CHUNKED = b"POST /reads HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n"
FLOODS = {
    "an address without end": (b"GET /", b"a" * 4096),
    "a header without end": (b"GET /again HTTP/1.1\r\nHost: x\r\nX: ", b"a" * 4096),
    "a name of a header without end": (b"GET /again HTTP/1.1\r\nHost: x\r\n", b"a" * 4096),
    "headers without end": (b"GET /again HTTP/1.1\r\nHost: x\r\n", b"X: a\r\n" * 512),
    "a chunk's extension without end": (CHUNKED + b"1;", b"a" * 4096),
    "trailers without end": (CHUNKED + b"1\r\nx\r\n0\r\n", b"X: a\r\n" * 512),
}


@pytest.mark.parametrize("flood", FLOODS)
def test_a_head_without_end_is_refused(url, metrics, flood):
    answer = sent_until_closed(url, *FLOODS[flood], pieces=1000)
    head, _, body = answer.partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 431 ")
    assert b"application/problem+json" in head
    assert json.loads(body)["type"] == "/problems/head-too-large"
    assert counted(metrics, "431", "head-too-large") == (1, 1)
    assert httpx.get(f"http://127.0.0.1:{url[1]}/again").text == "ok"


def test_a_head_that_is_just_small_enough_is_taken(url):
    spent = len("/again") + sum(map(len, ("Host", "x", "Connection", "close", "X")))
    begun = b"GET /again HTTP/1.1\r\nHost: x\r\nConnection: close\r\nX: "
    for room, status in ((MAX_HEAD_BYTES - spent, b"200"), (MAX_HEAD_BYTES - spent + 1, b"431")):
        assert sent_until_closed(url, begun + b"a" * room + b"\r\n\r\n", b"", 0).startswith(b"HTTP/1.1 " + status)


@pytest.mark.parametrize(
    "noise", [b"\x16\x03\x01\x02\x00\x01\x00", b"hello\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"\x00"]
)
def test_what_is_no_http_is_told_so(url, metrics, noise):
    head, _, body = sent_until_closed(url, noise, b"", 0).partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 400 ")
    assert json.loads(body)["type"] == "/problems/malformed-request"
    assert counted(metrics, "400", "malformed-request") == (1, 1)


@pytest.mark.parametrize("second", [b"Host: x", b"hOsT: mechanisms.com", b"Host:"])
def test_a_request_names_its_host_once(url, metrics, second):
    request = REQUEST.replace(b"/ ", b"/again ")
    head, _, body = sent_until_closed(url, request[:-2] + second + b"\r\n\r\n", b"", 0).partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 400 ")
    assert "Host" in json.loads(body)["detail"]
    assert counted(metrics, "400", "malformed-request") == (1, 1)
    with socket.create_connection(url, timeout=10) as connection:
        for _ in range(2):  # each request of a connection has a host of its own
            connection.sendall(request)
            assert is_answered(connection)


def test_noise_behind_a_request_is_told_so_too(url):
    with socket.create_connection(url, timeout=10) as connection:
        connection.sendall(REQUEST.replace(b"/ ", b"/again "))
        assert is_answered(connection)
        connection.sendall(b"\x16\x03\x01\x02\x00\x01\x00")
        assert received(connection).startswith(b"HTTP/1.1 400 ")


@pytest.mark.parametrize(
    "half", [b"GET /again", b"GET /again HTTP/1.1\r\nX", CHUNKED, REQUEST.replace(b"/ ", b"/again ") + b"GET /a"]
)
def test_a_request_that_is_not_complete_in_time_is_counted_once(url, metrics, monkeypatch, half):
    monkeypatch.setattr(connections, "REQUEST_TIMEOUT_S", 0.3)
    with socket.create_connection(url, timeout=10) as connection:
        connection.sendall(half)
        answer = received(connection)
    assert re.findall(rb"HTTP/1.1 (\d+)", answer)[-1] == b"408"
    assert json.loads(answer.rpartition(b"\r\n\r\n")[2])["type"] == "/problems/request-timeout"
    assert counted(metrics, "408", "request-timeout") == (1, 1)
    assert counted(metrics, "400", "incomplete-body") == (0, 0)


def test_requests_ahead_of_their_answers_are_answered_in_turn(url):
    request = REQUEST.replace(b"/ ", b"/again ")
    with socket.create_connection(url, timeout=10) as connection:
        connection.sendall(request * (MAX_PIPELINED - 1) + request.replace(b"Host: x", b"Host: x\r\nConnection: close"))
        assert received(connection).count(b"HTTP/1.1 200") == MAX_PIPELINED


def test_a_flood_of_requests_ends_with_its_connection(url, monkeypatch):
    ahead = []
    complete = ImpatientProtocol.on_response_complete

    def watched(self):
        ahead.append(len(self.pipeline))
        complete(self)

    monkeypatch.setattr(ImpatientProtocol, "on_response_complete", watched)
    answer = sent_until_closed(url, b"", b"GET /again HTTP/1.1\r\n\r\n" * 100, pieces=2000)
    assert answer.count(b"HTTP/1.1 200") < 200_000
    assert max(ahead, default=0) <= MAX_PIPELINED
    assert httpx.get(f"http://127.0.0.1:{url[1]}/again").text == "ok"
