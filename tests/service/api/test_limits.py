"""What bounds a service: its queue, how long it keeps jobs, and how long a client may keep it waiting."""

import contextlib
import re
import socket
import time
from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest

from tests.support.service.raw_requests import HALVES, WHOLE
from tests.support.service.running import PROBLEM, REACHED_S, SCRIPTED, RunningServer, until
from tests.support.service.scripted_server import BRIEF, GATED, INSTANT

REQUEST_S = 10.0  # how long a connection may take up, whatever the code says


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    running = RunningServer(tmp_path_factory.mktemp("limits"), SCRIPTED, workers=1, max_queued=3, log_level="warning")
    yield running
    assert running.stop() == 0


def post(server, seed, **headers):
    return server.client.post("/v1/jobs", json={"problem": {**PROBLEM, "seed": seed}}, headers=headers)


@pytest.mark.slow
def test_a_full_queue_refuses_until_it_has_room(server):
    gate = server.folder / "open"
    gate.unlink(missing_ok=True)
    first = post(server, GATED, **{"Idempotency-Key": "first"}).json()
    server.reaches(first["id"], "running")
    waiting = [post(server, INSTANT, **{"Idempotency-Key": f"waiting-{n}"}) for n in range(3)]
    assert [answer.status_code for answer in waiting] == [202] * 3
    refused_before = server.sample("mechsynth_http_rejections_total", reason="queue-full")
    refused = post(server, INSTANT)
    assert refused.status_code == 503
    assert refused.json()["type"] == "/problems/queue-full"
    assert int(refused.headers["retry-after"]) >= 1
    again = post(server, INSTANT, **{"Idempotency-Key": "waiting-1"})
    assert again.json()["id"] == waiting[1].json()["id"], "a job that is accepted stays so"
    assert server.client.get("/readyz").status_code == 200
    gate.touch()
    server.reaches(waiting[-1].json()["id"], "succeeded")
    assert post(server, INSTANT).status_code == 202
    assert server.sample("mechsynth_http_rejections_total", reason="queue-full") == refused_before + 1


@pytest.mark.slow
def test_the_shares_of_a_batch_take_places_of_the_queue(server):
    """Of which there are three."""
    gate = server.folder / "open"
    gate.unlink(missing_ok=True)
    first = post(server, GATED).json()
    server.reaches(first["id"], "running")
    body = {"problem": PROBLEM, "vary": [{"field": "/seed", "values": [*range(INSTANT + BRIEF, INSTANT + BRIEF + 9)]}]}
    batch = server.client.post("/v1/batches", json=body)
    assert batch.status_code == 202
    for path, again in (("/v1/batches", body), ("/v1/jobs", {"problem": PROBLEM})):
        refused = server.client.post(path, json=again)
        assert (refused.status_code, refused.json()["type"]) == (503, "/problems/queue-full"), path
    assert len(server.client.get("/v1/batches").json()["batches"]) == 1
    gate.touch()
    ended = until(
        lambda: (now := server.client.get(batch.headers["location"]).json())["finished_at"] and now,
        REACHED_S,
        "the end",
    )
    assert (ended["status"], ended["succeeded"]) == ("succeeded", 9)
    assert post(server, INSTANT).status_code == 202


@pytest.mark.slow
@pytest.mark.campaign
def test_finished_jobs_are_removed_when_their_time_is_over(tmp_path):
    kept_s = 2.0
    server = RunningServer(tmp_path, SCRIPTED, workers=1, retention_days=kept_s / 86_400)
    try:
        unfinished = server.post(GATED)
        server.reaches(unfinished["id"], "running")
        (tmp_path / "open").touch()
        server.reaches(unfinished["id"], "succeeded")
        (tmp_path / "open").unlink()
        unfinished = server.post(GATED)
        finished = server.post(INSTANT)
        began = time.monotonic()
        server.client.delete(f"/v1/jobs/{finished['id']}")
        until(lambda: server.client.get(f"/v1/jobs/{finished['id']}").status_code == 404, 10.0, "the removal")
        assert time.monotonic() - began > 0.5 * kept_s
        assert server.job(unfinished["id"])["status"] == "running", "however old it is"
    finally:
        (tmp_path / "open").touch()
        assert server.stop() == 0


def connected(server):
    host, port = server.url.removeprefix("http://").split(":")
    return socket.create_connection((host, int(port)), timeout=30)


def is_healthy(connection):
    connection.sendall(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n")
    received = b""
    while not received.endswith(b'{"status":"ok"}'):
        received += connection.recv(65536)
    return received.startswith(b"HTTP/1.1 200")


def until_closed(connection, began):
    """Everything that the server sends until it closes, and how long that took."""
    received = b""
    with contextlib.suppress(ConnectionError):
        while chunk := connection.recv(65536):
            received += chunk
    return received, time.monotonic() - began


@pytest.mark.slow
@pytest.mark.campaign
def test_half_open_connections_end_while_honest_clients_are_served(server):
    """Nine hundred connections that send half a request, and one that sends a byte now and then."""
    (server.folder / "open").touch()
    began = time.monotonic()
    half_open = []
    for n in range(900):
        half_open.append(connected(server))
        half_open[-1].sendall(list(HALVES.values())[n % len(HALVES)])
    trickling = connected(server)
    slowest, served = 0.0, 0
    while time.monotonic() - began < REQUEST_S + 1.5:
        with contextlib.suppress(OSError):
            trickling.sendall(b"X")
        asked = time.monotonic()
        assert server.post(INSTANT, wait=20)["status"] == "succeeded"
        slowest, served = max(slowest, time.monotonic() - asked), served + 1
    print(f"{served} jobs served beside 901 half-open connections, the slowest in {1e3 * slowest:.0f} ms")
    assert slowest < 5.0
    for n, connection in enumerate(half_open):
        connection.settimeout(3.0)  # closed already; else this fails
        received, _ = until_closed(connection, began)
        if n % len(HALVES) == 0:
            assert received == b""
        elif n < len(HALVES):
            statuses = re.findall(rb"HTTP/1.1 (\d+)", received)
            name = list(HALVES)[n]
            expected = {"a request and a half": [b"200", b"408"], "a refused head and no body": [b"415"]}
            assert statuses == expected.get(name, [b"408"]), name
        connection.close()
    trickling.settimeout(3.0)
    until_closed(trickling, began)
    trickling.close()
    assert "Traceback" not in server.log()


@pytest.fixture(scope="module")
def unread(server):
    """How long the server keeps a client that does not read; found out beside the test that waits for other clients."""
    server.client.get("/openapi.json")  # made when it is first asked for, which takes its time
    with ThreadPoolExecutor(1) as beside:
        yield beside.submit(until_left, server)


@pytest.mark.slow
@pytest.mark.campaign
def test_each_sort_of_half_open_connection_ends_in_time(server, unread):
    before = server.sample("mechsynth_http_rejections_total", reason="request-timeout")
    connections = {name: connected(server) for name in HALVES}
    began = time.monotonic()
    for name, half in HALVES.items():
        connections[name].sendall(half)
    # Beside them: a client that comes back after a pause is not one of them, and one that waits for its job neither.
    idle = connected(server)
    assert is_healthy(idle)
    gate = server.folder / "open"
    gate.unlink(missing_ok=True)
    waiting = connected(server)
    waiting.sendall(
        WHOLE.replace(b'"seed": %d' % INSTANT, b'"seed": %d' % GATED).replace(
            b"Host: localhost", b"Host: localhost\r\nPrefer: wait=20"
        )
    )
    told = 0
    for name, connection in connections.items():
        received, seconds = until_closed(connection, began)
        assert seconds < REQUEST_S, name
        if b"408" in received:
            assert b'"/problems/request-timeout"' in received
            told += 1
        connection.close()
    assert server.sample("mechsynth_http_rejections_total", reason="request-timeout") - before == told >= 5
    time.sleep(max(0.0, REQUEST_S + 1.0 - (time.monotonic() - began)))  # a pause is what is tried
    assert is_healthy(idle)
    gate.touch()
    assert waiting.recv(65536).startswith(b"HTTP/1.1 200")
    idle.close()
    waiting.close()


def until_left(server):
    """Ask for more than the buffers hold and read nothing; how many seconds pass until the server is gone."""
    with connected(server) as connection:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        connection.sendall(b"GET /openapi.json HTTP/1.1\r\nHost: localhost\r\n\r\n" * 200)
        time.sleep(2.0)  # the buffers fill
        began = time.monotonic()

        def gone():
            try:
                connection.sendall(b"G")
                return False
            except ConnectionError:
                return True

        until(gone, REQUEST_S + 5.0, "the end of the connection")
        return time.monotonic() - began


@pytest.mark.slow
def test_a_client_that_does_not_read_is_left(server, unread):
    assert unread.result() < REQUEST_S + 5.0
    assert httpx.get(f"{server.url}/healthz").status_code == 200
