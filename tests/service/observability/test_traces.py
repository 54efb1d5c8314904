"""Traces to an OpenTelemetry collector: sent when they are asked for, and nothing otherwise."""

import subprocess
import sys
import threading
from collections import defaultdict
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
from opentelemetry.proto.collector.trace.v1.trace_service_pb2 import ExportTraceServiceRequest

from tests.support.service.access import client_with, made, post
from tests.support.service.running import SCRIPTED, RunningServer, until
from tests.support.service.scripted_server import INSTANT

PARENT = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"
SECRET = "a-word-that-nobody-must-trace"


class Collector(ThreadingHTTPServer):
    """Takes what an exporter sends by OTLP over HTTP."""

    daemon_threads = True

    def __init__(self):
        super().__init__(("127.0.0.1", 0), _Receiver)
        self.received = defaultdict(list)
        self.url = f"http://127.0.0.1:{self.server_address[1]}"

    def spans(self):
        """The spans so far, each with its attributes."""
        spans = []
        for body in list(self.received["/v1/traces"]):
            for resource in ExportTraceServiceRequest.FromString(body).resource_spans:
                service = {a.key: a.value.string_value for a in resource.resource.attributes}["service.name"]
                for scope in resource.scope_spans:
                    spans += [(service, span, _plain(span.attributes)) for span in scope.spans]
        return spans


def _plain(attributes):
    return {a.key: getattr(a.value, a.value.WhichOneof("value")) for a in attributes}


class _Receiver(BaseHTTPRequestHandler):
    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.send_response(200)
        self.send_header("Content-Length", "0")
        self.end_headers()
        self.server.received[self.path].append(body)

    def log_message(self, *_):
        pass


@pytest.fixture
def collector():
    receiver = Collector()
    thread = threading.Thread(target=receiver.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    yield receiver
    receiver.shutdown()
    thread.join(10)
    receiver.server_close()


@contextmanager
def running(folder, monkeypatch, **telemetry):
    for name, value in {"OTEL_BSP_SCHEDULE_DELAY": "50", **telemetry}.items():
        monkeypatch.setenv(name, value)
    server = RunningServer(folder, SCRIPTED, workers=1)
    try:
        yield server
    finally:
        status = server.stop()
    assert status == 0


@pytest.mark.slow
@pytest.mark.campaign
def test_a_collector_gets_each_request_with_its_route(tmp_path, monkeypatch, collector):
    key = made(tmp_path, "acme")
    with (
        running(
            tmp_path,
            monkeypatch,
            FASTAPI_OTEL_AUTO_CONFIGURE="true",
            OTEL_EXPORTER_OTLP_ENDPOINT=collector.url,
        ) as server,
        client_with(server, key) as client,
    ):
        job = post(client, INSTANT, traceparent=PARENT).json()
        client.get(f"/v1/jobs/{job['id']}", headers={"Idempotency-Key": SECRET})
        client.get("/v1/jobs/nope")
        client.post("/v1/jobs", json={"problem": {"kind": SECRET}})

        def routes():
            found = [
                (span.name, attributes["http.response.status_code"])
                for _, span, attributes in collector.spans()
                if "http.response.status_code" in attributes
            ]
            return found if len(found) >= 5 else None

        seen = until(routes, 20.0, "the spans")
    assert ("POST /v1/jobs", 200) in seen
    assert ("GET /v1/jobs/{job_id}", 200) in seen
    assert ("GET /v1/jobs/{job_id}", 404) in seen
    assert ("POST /v1/jobs", 422) in seen
    assert {service for service, _, _ in collector.spans()} == {"mechsynth"}
    of_job = next(span for _, span, _ in collector.spans() if span.name == "POST /v1/jobs")
    assert of_job.trace_id.hex() == PARENT.split("-")[1], "a client's trace goes on through the service"
    sent = b"".join(body for bodies in collector.received.values() for body in bodies)
    assert key.encode() not in sent
    assert SECRET.encode() not in sent


@pytest.mark.slow
@pytest.mark.campaign
def test_nothing_is_sent_unless_it_is_asked_for(tmp_path, monkeypatch, collector):
    with running(tmp_path, monkeypatch, OTEL_EXPORTER_OTLP_ENDPOINT=collector.url) as server:
        server.post(INSTANT, wait=20)
    assert not collector.received


@pytest.mark.slow
@pytest.mark.campaign
def test_a_collector_that_is_not_there_holds_nobody_up(tmp_path, monkeypatch):
    with running(
        tmp_path,
        monkeypatch,
        FASTAPI_OTEL_AUTO_CONFIGURE="true",
        OTEL_EXPORTER_OTLP_ENDPOINT="http://127.0.0.1:9",
    ) as server:
        assert server.post(INSTANT, wait=20)["status"] == "succeeded"


@pytest.mark.slow
def test_the_exporters_are_not_imported_by_a_service_without_them():
    program = (
        "import sys, service.server.web, service.server.run; "
        "print([name for name in sys.modules if name.startswith(('opentelemetry.sdk', 'opentelemetry.exporter', "
        "'google.protobuf', 'requests'))])"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.strip() == "[]"
