"""Several servers and worker hosts as one service; and what becomes of jobs when the store is gone."""

import signal
import threading
import time
from collections import Counter

import httpx
import psycopg
import pytest

from tests.cluster.backend import CHOSEN
from tests.cluster.deployment import Deployment, alive_now
from tests.support.service.running import PROBLEM, STOP_S, until
from tests.support.service.scripted_server import GATED, INSTANT, NATIVE

pytestmark = [pytest.mark.cluster, pytest.mark.timeout(600)]


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    deployment = Deployment(tmp_path_factory.mktemp("deployment"), servers=2, hosts=2, workers=1)
    yield deployment
    assert deployment.stop() == [0, 0, 0, 0]


@pytest.fixture
def deployed(shared):
    """The deployment with all its processes, whatever a test before has left."""
    (shared.folder / "open").touch()
    shared.complete()
    shared.finish(120.0)
    return shared


def post(client, seed, wait=None):
    headers = {"Prefer": f"wait={wait}"} if wait else {}
    answer = client.post("/v1/jobs", json={"problem": {**PROBLEM, "seed": seed}}, headers=headers)
    assert answer.status_code in (200, 202), answer.text
    return answer.json()


def reaches(client, job_id, status, seconds=60.0):
    def there():
        job = client.get(f"/v1/jobs/{job_id}").json()
        return job if job["status"] == status else None

    return until(there, seconds, f"job {status}")


def gated(deployed, jobs=1):
    """So many jobs that run until the gate is opened; they run now."""
    (deployed.folder / "open").unlink(missing_ok=True)
    client = deployed.clients[0]
    posted = [post(client, GATED) for _ in range(jobs)]
    for job in posted:
        reaches(client, job["id"], "running")
    return posted


def test_a_job_of_one_server_is_a_job_of_all(deployed):
    here, there = deployed.clients
    job = post(here, INSTANT, wait=30)
    assert job["status"] == "succeeded"
    assert there.get(f"/v1/jobs/{job['id']}").json() == job
    assert there.delete(f"/v1/jobs/{job['id']}").status_code == 204
    assert here.get(f"/v1/jobs/{job['id']}").status_code == 404


def test_who_waits_at_one_server_hears_of_a_cancel_at_another(deployed):
    here, there = deployed.clients
    answers = []
    waiting = threading.Thread(target=lambda: answers.append(post(here, NATIVE, wait=30)))
    waiting.start()
    job = until(lambda: there.get("/v1/jobs?status=running").json()["jobs"], 30.0, "the job running")[0]
    children = [pid for host in deployed.hosts for pid in host.children()]
    began = time.monotonic()
    assert there.delete(f"/v1/jobs/{job['id']}").json()["status"] == "cancelled"
    until(lambda: len(alive_now(children)) < len(children), 2.0, "the end of the computation")
    waiting.join(5.0)
    print(f"cancelled in {time.monotonic() - began:.2f} s")
    assert [answered["status"] for answered in answers] == ["cancelled"]
    assert post(here, INSTANT, wait=30)["status"] == "succeeded"


def test_events_are_heard_at_another_server(deployed):
    (deployed.folder / "open").unlink(missing_ok=True)
    here, there = deployed.clients
    job = post(here, GATED)
    with there.stream("GET", f"/v1/jobs/{job['id']}/events") as stream:
        reaches(here, job["id"], "running")
        (deployed.folder / "open").touch()
        text = stream.read().decode()
    assert text.count('"succeeded"') >= 1
    assert text.count("event: state") >= 2


def test_a_host_that_stops_gives_its_job_to_another(deployed):
    client = deployed.clients[0]
    [job] = gated(deployed)
    began = time.monotonic()
    for host in deployed.hosts:  # whichever has it
        host.process.send_signal(signal.SIGTERM)
        assert host.process.wait(STOP_S) == 0
    assert [row[2] for row in deployed.jobs() if row[0] == job["id"]] == ["queued"]
    deployed.complete()
    reaches(client, job["id"], "running")
    (deployed.folder / "open").touch()
    reaches(client, job["id"], "succeeded")
    print(f"both hosts stopped and started in {time.monotonic() - began:.1f} s")
    assert [row[4] for row in deployed.jobs() if row[0] == job["id"]] == [0], "nobody has died"


def test_a_host_that_is_killed_leaves_no_worker_and_its_job_runs_elsewhere(deployed):
    client = deployed.clients[0]
    jobs = gated(deployed, len(deployed.hosts))
    host = deployed.hosts[0]
    children = host.children()
    host.kill()
    until(lambda: not alive_now(children), 5.0, "the end of its workers")
    (deployed.folder / "open").touch()
    for job in jobs:
        reaches(client, job["id"], "succeeded")


def test_each_host_shows_what_its_workers_do(deployed):
    """Job times by kind, attempts, restarts of workers, and the jobs that it has: added up over the hosts."""

    def seen():
        added = Counter()
        for host in deployed.hosts:
            added.update(host.metrics())
        return added

    until(lambda: seen()["mechsynth_workers_ready",] == len(deployed.hosts), 60.0, "workers on all hosts")
    before = seen()
    here = deployed.clients[0]
    assert post(here, INSTANT, wait=30)["status"] == "succeeded"
    running = gated(deployed, len(deployed.hosts))
    assert all(host.metrics()["mechsynth_host_jobs", "running"] == 1 for host in deployed.hosts)
    assert here.delete(f"/v1/jobs/{running[0]['id']}").status_code == 202
    until(lambda: seen()["mechsynth_host_jobs", "running"] < len(running), 10.0, "the end of the cancelled job")
    (deployed.folder / "open").touch()
    for job in running[1:]:
        reaches(here, job["id"], "succeeded")
    until(lambda: seen()["mechsynth_host_jobs", "running"] == 0, 10.0, "the end of all jobs")
    growth = {key: value - before[key] for key, value in seen().items() if value != before[key]}
    assert growth["mechsynth_job_seconds_count", "motion"] == len(running)
    assert growth["mechsynth_job_attempts_total", "succeeded"] == len(running)
    assert growth["mechsynth_job_attempts_total", "cancelled"] == 1
    assert growth["mechsynth_worker_restarts_total", "cancelled"] == 1


def test_a_store_that_is_away_is_answered_503_and_found_again(deployed):
    here = deployed.clients[0]
    job = post(here, INSTANT, wait=30)
    CHOSEN.postgres.stop()
    try:
        for method, path, body in (
            ("POST", "/v1/jobs", {"problem": PROBLEM}),
            ("GET", f"/v1/jobs/{job['id']}", None),
            ("GET", "/v1/jobs", None),
            ("DELETE", f"/v1/jobs/{job['id']}", None),
        ):
            began = time.monotonic()
            answer = here.request(method, path, json=body)
            assert answer.status_code == 503, answer.text
            assert answer.headers["content-type"] == "application/problem+json"
            assert answer.json()["type"] == "/problems/store-unavailable"
            assert int(answer.headers["retry-after"]) >= 1
            assert time.monotonic() - began < 15.0
        assert here.get("/readyz").status_code == 503
        assert here.get("/healthz").status_code == 200
    finally:
        CHOSEN.postgres.start()
    until(lambda: here.get("/readyz").status_code == 200, 30.0, "readiness")
    assert here.get(f"/v1/jobs/{job['id']}").json() == job
    assert post(here, INSTANT, wait=30)["status"] == "succeeded"


def test_connections_that_break_in_a_commit_make_one_job_each(deployed):
    """PostgreSQL ends its connections at random moments while jobs without keys are posted: each answer 200 or 202 has
    its job, and there is none beside those but where the answer was 503 or none.
    """
    url = CHOSEN.postgres.url(CHOSEN.mark(deployed.folder))
    done = threading.Event()

    def cut():
        with psycopg.connect(url, autocommit=True) as connection:
            while not done.wait(0.3):  # often, and yet there is time for some to end
                connection.execute(
                    "SELECT pg_terminate_backend(pid) FROM pg_stat_activity "
                    "WHERE datname = current_database() AND pid <> pg_backend_pid()"
                )

    before = len(deployed.jobs())
    cutting = threading.Thread(target=cut)
    cutting.start()
    accepted, unknown = [], 0
    try:
        with httpx.Client(base_url=deployed.servers[1].url, timeout=60.0) as client:
            for _ in range(60):
                answer = client.post("/v1/jobs", json={"problem": {**PROBLEM, "seed": INSTANT}})
                assert answer.status_code in (202, 503), answer.text
                if answer.status_code == 202:
                    accepted.append(answer.json()["id"])
                else:
                    unknown += 1
    finally:
        done.set()
        cutting.join(10)
    deployed.finish(120.0)
    rows = deployed.jobs()
    assert set(accepted) <= {row[0] for row in rows}
    assert len(accepted) == len(set(accepted))
    assert len(accepted) <= len(rows) - before <= len(accepted) + unknown
    assert [row for row in rows if row[2] == "failed"] == []
    print(f"{len(accepted)} jobs accepted, {unknown} answered 503 while connections were cut")
