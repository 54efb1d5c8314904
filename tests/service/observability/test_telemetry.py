"""What the service tells about itself: metrics, timings, and a log that knows which request and which job."""

import json
import re
import socket
import threading
from importlib.metadata import version

import httpx
import pytest

from service.jobs.cluster import worker_host
from service.jobs.cluster.worker_host import HostError, serve_metrics
from service.observability.metrics import HostMetrics, Metrics
from service.settings import Settings
from tests.support.service.running import PROBLEM, SCRIPTED, SOON_S, RunningServer, until
from tests.support.service.scripted_server import BROKEN, DIES_ONCE, GATED, INSTANT, NATIVE

SECRET = "a-word-that-nobody-must-log"


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    running = RunningServer(
        tmp_path_factory.mktemp("telemetry"), SCRIPTED, workers=1, job_timeout_s=2.0, log_format="json"
    )
    yield running
    assert running.stop() == 0


def grown(server, act):
    """By how much the samples have grown over an act; those that have not are left out."""
    before = server.samples()
    act()
    after = server.samples()
    return {key: value - before.get(key, 0.0) for key, value in after.items() if value != before.get(key, 0.0)}


@pytest.mark.slow
def test_requests_are_counted_by_operation_method_and_status(server):
    def act():
        server.client.get("/healthz")
        server.client.head("/healthz")
        server.client.get("/v1/jobs/nope")
        server.client.get(f"/{SECRET}")
        server.client.request(SECRET.upper(), "/v1/jobs")

    growth = grown(server, act)
    name = "mechsynth_http_requests_total"
    assert growth[(name, ("method", "GET"), ("operation", "healthz"), ("status", "200"))] == 1
    assert growth[(name, ("method", "HEAD"), ("operation", "healthz"), ("status", "200"))] == 1
    assert growth[(name, ("method", "GET"), ("operation", "get_job"), ("status", "404"))] == 1
    assert growth[(name, ("method", "GET"), ("operation", "none"), ("status", "404"))] == 1
    assert growth[("mechsynth_http_request_seconds_count", ("operation", "healthz"))] == 2
    assert growth[("mechsynth_http_rejections_total", ("reason", "not-found"))] == 2
    assert SECRET.lower() not in str(growth).lower(), "what a client chooses is no label"


@pytest.mark.slow
def test_rejections_are_counted_by_reason(server):
    def act():
        headers = {"Content-Type": "application/json"}
        server.client.post("/v1/jobs", content=b"{", headers=headers)
        server.client.post("/v1/jobs", content=b"{}", headers=headers)
        server.client.post("/v1/jobs", json={"problem": {**PROBLEM, "positions": []}})
        server.client.post("/v1/jobs", content=b" " * (2 << 20), headers=headers)
        server.client.put("/v1/jobs")

    growth = grown(server, act)
    reasons = {dict(key[1:])["reason"]: n for key, n in growth.items() if key[0] == "mechsynth_http_rejections_total"}
    assert reasons == {
        "malformed-json": 1,
        "invalid-request": 1,
        "invalid-problem": 1,
        "body-too-large": 1,
        "method-not-allowed": 1,
    }


@pytest.mark.slow
def test_jobs_are_measured_by_kind_and_outcome(server):
    def act():
        (server.folder / "died").unlink(missing_ok=True)
        for seed in (INSTANT, BROKEN, DIES_ONCE, NATIVE):  # the last one until its timeout
            server.post(seed, wait=20)

    growth = grown(server, act)
    attempts = {dict(key[1:])["outcome"]: n for key, n in growth.items() if key[0] == "mechsynth_job_attempts_total"}
    assert attempts == {"succeeded": 2, "failed": 1, "worker_lost": 1, "timeout": 1}
    assert growth[("mechsynth_job_seconds_count", ("kind", "motion"))] == 3
    assert growth[("mechsynth_queue_seconds_count", ("cost", "short"))] == 4, (
        "a job that is tried again has waited once"
    )
    assert 0.0 < growth[("mechsynth_queue_seconds_sum", ("cost", "short"))] < 60.0
    assert growth[("mechsynth_jobs_accepted_total", ("kind", "motion"))] == 4
    restarts = {dict(key[1:])["reason"]: n for key, n in growth.items() if key[0] == "mechsynth_worker_restarts_total"}
    assert restarts == {"lost": 1, "timeout": 1}


@pytest.mark.slow
def test_the_queue_and_the_workers_are_seen(server):
    gate = server.folder / "open"
    gate.unlink(missing_ok=True)
    running = server.post(GATED)
    server.reaches(running["id"], "running")
    server.post(INSTANT)
    server.post(INSTANT)
    seen = server.samples()
    gate.touch()
    until(lambda: server.samples()[("mechsynth_jobs_unfinished", ("status", "queued"))] == 0)
    assert seen[("mechsynth_jobs_unfinished", ("status", "queued"))] == 2
    assert seen[("mechsynth_jobs_unfinished", ("status", "running"))] == 1
    assert seen[("mechsynth_workers_ready",)] == 1
    assert 0.0 < seen[("mechsynth_oldest_job_seconds",)] < 600.0
    assert server.sample("mechsynth_oldest_job_seconds") == 0.0
    assert seen[("mechsynth_store_bytes",)] > 1e4
    assert seen[("mechsynth_store_free_bytes",)] > 1e6
    assert server.sample("mechsynth_build_info", version=version("mechsynth")) == 1.0
    assert seen[("process_resident_memory_bytes",)] > 1e6


@pytest.mark.slow
def test_listeners_are_counted_until_they_leave(server):
    gate = server.folder / "open"
    gate.unlink(missing_ok=True)
    job = server.post(GATED)
    with httpx.Client(base_url=server.url, timeout=20.0) as other:
        with other.stream("GET", f"/v1/jobs/{job['id']}/events") as stream:
            texts = stream.iter_text()
            next(texts)
            assert server.samples()[("mechsynth_event_listeners",)] == 1
        until(lambda: server.samples()[("mechsynth_event_listeners",)] == 0, what="the end of the listening")
    gate.touch()


@pytest.mark.slow
def test_openmetrics_where_it_is_accepted(server):
    accept = {"Accept": "application/openmetrics-text; version=1.0.0"}
    answer = server.client.get("/metrics", headers=accept)
    assert answer.headers["content-type"].startswith("application/openmetrics-text")
    assert answer.text.endswith("# EOF\n")
    assert server.client.get("/metrics").headers["content-type"].startswith("text/plain")


def test_a_store_that_does_not_answer_costs_only_the_queue():
    def no_store():
        raise OSError("no store")

    from prometheus_client import generate_latest

    metrics = Metrics()
    metrics.watch(lambda: 3, lambda: 1, no_store)
    text = generate_latest(metrics.registry).decode()
    assert "mechsynth_event_listeners 3.0" in text
    assert "mechsynth_jobs_unfinished{" not in text


def test_a_worker_host_shows_its_metrics_where_it_is_told_to():
    metrics = HostMetrics()
    metrics.watch(lambda: 2, lambda: 1)
    metrics.count_attempt("succeeded", "motion", 0.25)
    metrics.count_worker_restart("timeout")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    serve_metrics(metrics, Settings(worker_metrics_port=port))
    text = httpx.get(f"http://127.0.0.1:{port}/metrics").text
    for line in (
        "mechsynth_workers_ready 2.0",
        'mechsynth_host_jobs{status="running"} 1.0',
        'mechsynth_job_seconds_sum{kind="motion"} 0.25',
        'mechsynth_job_attempts_total{outcome="succeeded"} 1.0',
        'mechsynth_worker_restarts_total{reason="timeout"} 1.0',
    ):
        assert f"\n{line}\n" in text
    assert "process_resident_memory_bytes" in text
    assert "mechsynth_http" not in text
    with pytest.raises(HostError, match=f"port {port}.*MECHSYNTH_WORKER_METRICS_PORT"):
        serve_metrics(metrics, Settings(worker_metrics_port=port))


def test_a_worker_host_that_is_not_told_to_shows_nothing(monkeypatch):
    monkeypatch.setattr(worker_host, "start_http_server", lambda *_: pytest.fail("it listens"))
    serve_metrics(HostMetrics(), Settings())


def durations(answer):
    return dict(
        re.fullmatch(r"(\w+);dur=([0-9.]+)", part).groups() for part in answer.headers["server-timing"].split(", ")
    )


@pytest.mark.slow
def test_an_answer_says_where_its_time_went(server):
    body = {"problem": {**PROBLEM, "seed": INSTANT}}
    answer = server.client.post("/v1/jobs", json=body, headers={"Prefer": "wait=20"})
    parts = {name: float(ms) for name, ms in durations(answer).items()}
    assert set(parts) == {"store", "job", "total"}
    assert parts["store"] + parts["job"] <= parts["total"] + 0.02
    assert set(durations(server.client.get("/nope"))) == {"total"}


@pytest.mark.slow
def test_a_request_has_the_id_that_it_came_with_or_a_new_one(server):
    given = server.client.get("/healthz", headers={"X-Request-ID": "abc-1"})
    assert given.headers["x-request-id"] == "abc-1"
    made = {server.client.get("/healthz").headers["x-request-id"] for _ in range(3)}
    assert len(made) == 3
    for strange in ("x" * 101, "a b", 'a"b', "é".encode("latin-1")):
        answer = server.client.get("/healthz", headers={"X-Request-ID": strange})
        assert re.fullmatch("[0-9A-Z]{26}", answer.headers["x-request-id"])


@pytest.mark.slow
def test_the_log_leads_from_a_request_to_its_job(server):
    body = {"problem": {**PROBLEM, "seed": BROKEN}}
    job = server.client.post("/v1/jobs", json=body, headers={"Prefer": "wait=20", "X-Request-ID": "lead"}).json()

    def lines():
        return [json.loads(line) for line in server.log().splitlines()]

    def says(line):
        return line.get("request") == "lead" or line.get("job") == job["id"]

    for event in ("request", "job failed"):  # server and worker write after the answer
        until(lambda event=event: any(line["event"] == event and says(line) for line in lines()), SOON_S, event)
    of_request = [line for line in lines() if line.get("request") == "lead"]
    assert [line["event"] for line in of_request] == ["job accepted", "request"]
    assert of_request[0]["job"] == job["id"]
    assert {"method": "POST", "path": "/v1/jobs", "status": 200}.items() <= of_request[1].items()
    of_job = [line for line in lines() if line.get("job") == job["id"]]
    assert [line["event"] for line in of_job] == ["job accepted", "job running", "the solver raised", "job failed"]
    assert "a secret of the implementation" in of_job[2]["exception"]
    assert all("request" not in line for line in of_job[1:])


@pytest.mark.slow
@pytest.mark.campaign
def test_concurrent_requests_keep_their_ids(server):
    def ask(n):
        for _ in range(20):
            answer = httpx.get(f"{server.url}/v1/jobs/nope", headers={"X-Request-ID": f"client-{n}"})
            assert answer.headers["x-request-id"] == f"client-{n}"

    threads = [threading.Thread(target=ask, args=(n,)) for n in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30)

    def logged(n):
        return sum(f'"client-{n}"' in line for line in server.log().splitlines())

    for n in range(4):  # a line is written after the answer has gone
        until(lambda n=n: logged(n) >= 20, SOON_S, "20 lines of the log")
        assert logged(n) == 20


@pytest.mark.slow
def test_a_query_is_not_logged(server):
    server.client.get(f"/healthz?key=another-{SECRET}")
    assert f"another-{SECRET}" not in server.log()
