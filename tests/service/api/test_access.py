"""Keys and tenants: nobody sees another's jobs, and nobody asks too often."""

import re
import socket
import time

import httpx
import pytest

from service.access.gate import Gate, NoKey
from service.access.keys import KeyStore, TenantExists, hash_key
from service.jobs.store.database import connect, upgrade
from tests.campaign import further
from tests.support.service.access import client_with, keys, made, post
from tests.support.service.running import PROBLEM, SCRIPTED, RunningServer, until
from tests.support.service.scripted_server import GATED, INSTANT

NOWHERE = "01K6WM2B7Q3W9Z0V5N8XJ4R1TD"
ORIGIN = "https://studio.example"
QUEUE = 20


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    """A service with two tenants and a loose limit, and their keys."""
    folder = tmp_path_factory.mktemp("access")
    held = {name: made(folder, name) for name in ("acme", "globex")}
    server = RunningServer(
        folder, SCRIPTED, workers=1, max_queued=QUEUE, rate_limit="100000/minute", cors_origins=f"{ORIGIN},http://x.y"
    )
    server.clients = {name: client_with(server, key) for name, key in held.items()}
    server.keys = held
    yield server
    for client in server.clients.values():
        client.close()
    assert server.stop() == 0


def operations(server):
    """Every operation under /v1, as the service itself lists them."""
    paths = server.client.get("/openapi.json").json()["paths"]
    return [(method, path) for path, methods in paths.items() if path.startswith("/v1") for method in methods]


def ask(client, method, path, job_id, headers=None):
    body = {"json": {"problem": {**PROBLEM, "seed": INSTANT}}} if method == "post" else {}
    url = path.replace("{job_id}", job_id).replace("{number}", "0")
    return client.request(method.upper(), url, headers=headers, **body)


@pytest.mark.slow
def test_every_operation_needs_a_key(shared):
    assert len(operations(shared)) >= 10
    for method, path in operations(shared):
        for authorization, challenge in (
            (None, "Bearer"),
            ("Bearer", "Bearer"),
            ("Basic eDp5", "Bearer"),
            ("Bearer mechsynth_wrong", 'Bearer error="invalid_token"'),
            (f"Bearer {hash_key(shared.keys['acme'])}", 'Bearer error="invalid_token"'),
            (b"Bearer \xff\xfe", 'Bearer error="invalid_token"'),
        ):
            headers = {} if authorization is None else {"Authorization": authorization}
            answer = ask(shared.client, method, path, NOWHERE, headers)
            if authorization == "Bearer":
                challenge = answer.headers["www-authenticate"]  # a bearer of nothing: either is right
            assert (answer.status_code, answer.headers["www-authenticate"]) == (401, challenge), (method, path)
            assert answer.json()["type"] == "/problems/unauthorized"


@pytest.mark.slow
def test_a_body_is_not_read_for_nobody(shared):
    host, port = shared.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=10) as raw:
        raw.sendall(
            b"POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: 900000\r\n\r\n"
        )
        assert raw.recv(65536).startswith(b"HTTP/1.1 401 ")


@pytest.mark.slow
def test_with_a_key_any_host_is_right(shared):
    assert shared.clients["acme"].get("/v1/jobs", headers={"Host": "mechanisms.com"}).status_code == 200


@pytest.mark.slow
def test_the_document_asks_for_keys_where_there_are_some(shared):
    document = shared.client.get("/openapi.json").json()
    assert document["components"]["securitySchemes"]["bearer"]["type"] == "http"
    for path, methods in document["paths"].items():
        asked = [{"bearer": []}] if path.startswith("/v1/") else []
        assert [operation.get("security") for operation in methods.values()] == [asked] * len(methods)


@pytest.mark.slow
def test_what_is_open_stays_open(shared):
    for path in ("/healthz", "/readyz", "/metrics", "/docs", "/openapi.json"):
        assert httpx.get(shared.url + path).status_code == 200


@pytest.mark.slow
def test_another_tenants_job_is_like_none(shared):
    ours, theirs = shared.clients["acme"], shared.clients["globex"]
    about_jobs = [(method, path) for method, path in operations(shared) if "{job_id}" in path]
    assert len(about_jobs) >= 7
    for method, path in about_jobs:
        job_id = post(ours).json()["id"]
        other = ask(theirs, method, path, job_id)
        unknown = ask(theirs, method, path, NOWHERE)
        assert (other.status_code, unknown.status_code) == (404, 404), (method, path)
        told = [{**answer.json(), "instance": ""} for answer in (other, unknown)]
        assert told[0] == told[1]
        assert ours.get(f"/v1/jobs/{job_id}").status_code == 200, "untouched by what the other one did"
        own = ask(ours, method, path, job_id)
        no_design = own.status_code == 404 and "designs" in own.json()["detail"]  # the scripted solver finds none
        assert own.status_code in (200, 202, 204) or no_design, (method, path)


@pytest.mark.slow
def test_another_tenants_running_job_is_not_cancelled(shared):
    gate = shared.folder / "open"
    gate.unlink(missing_ok=True)
    ours, theirs = shared.clients["acme"], shared.clients["globex"]
    job = post(ours, GATED, wait=None).json()
    until(lambda: ours.get(f"/v1/jobs/{job['id']}").json()["status"] == "running")
    assert theirs.delete(f"/v1/jobs/{job['id']}").status_code == 404
    assert theirs.get(f"/v1/jobs/{job['id']}/events").status_code == 404
    gate.touch()
    until(lambda: ours.get(f"/v1/jobs/{job['id']}").json()["status"] == "succeeded")


@pytest.mark.slow
def test_limits_and_use_are_ones_own(shared):
    gate = shared.folder / "open"
    gate.unlink(missing_ok=True)
    ours, theirs = shared.clients["acme"], shared.clients["globex"]
    job = post(ours, GATED, wait=None).json()
    until(lambda: ours.get("/v1/me").json()["use"] == {"queued_jobs": 0, "running_jobs": 1})
    assert theirs.get("/v1/me").json()["use"] == {"queued_jobs": 0, "running_jobs": 0}
    gate.touch()
    until(lambda: ours.get("/v1/me").json()["use"]["running_jobs"] == 0)
    assert ours.get(f"/v1/jobs/{job['id']}").json()["status"] == "succeeded"
    told = ours.get("/v1/me").json()
    assert told["tenant"] == "acme"
    assert told["limits"]["body_bytes"] == 1 << 20
    assert (told["limits"]["queued_jobs"], told["limits"]["rate"]) == (QUEUE, "100000/minute")


@pytest.mark.slow
def test_lists_are_of_ones_own_jobs(shared):
    created = {name: {post(client).json()["id"] for _ in range(3)} for name, client in shared.clients.items()}
    for name, client in shared.clients.items():
        for query in ("", "status=succeeded", "kind=motion"):
            listed, cursor = set(), None
            while True:
                page = client.get(f"/v1/jobs?limit=2&{query}" + (f"&cursor={cursor}" if cursor else "")).json()
                listed |= {job["id"] for job in page["jobs"]}
                cursor = page["next_cursor"]
                if cursor is None:
                    break
            assert created[name] <= listed
            for other in set(created) - {name}:
                assert not created[other] & listed


@pytest.mark.slow
def test_a_cursor_of_another_tenant_shows_nothing_of_it(shared):
    ours, theirs = shared.clients["acme"], shared.clients["globex"]
    for client in (ours, theirs, ours, theirs):
        post(client)
    cursor = ours.get("/v1/jobs?limit=1").json()["next_cursor"]
    with_ours = {job["id"] for job in theirs.get(f"/v1/jobs?limit=100&cursor={cursor}").json()["jobs"]}
    own = {job["id"] for job in theirs.get("/v1/jobs?limit=100").json()["jobs"]}
    assert with_ours <= own


@pytest.mark.slow
def test_idempotency_keys_are_ones_own(shared):
    ours, theirs = shared.clients["acme"], shared.clients["globex"]
    first = post(ours, **{"Idempotency-Key": "same"}).json()
    second = post(theirs, **{"Idempotency-Key": "same"}).json()
    assert first["id"] != second["id"]
    assert post(theirs, GATED, **{"Idempotency-Key": "other-problem"}, wait=None).status_code == 202
    (shared.folder / "open").touch()
    assert post(ours, **{"Idempotency-Key": "other-problem"}).status_code == 200, "no conflict with the other's"
    assert post(ours, **{"Idempotency-Key": "same"}).json()["id"] == first["id"]


@pytest.mark.slow
def test_a_key_is_in_no_log_no_metric_and_no_file(shared):
    for key in shared.keys.values():
        for where in (shared.log(), httpx.get(f"{shared.url}/metrics").text):
            assert key not in where
            assert hash_key(key) not in where
        for file in shared.folder.rglob("*"):
            assert not file.is_file() or key.encode() not in file.read_bytes()
    assert "acme" not in httpx.get(f"{shared.url}/metrics").text


@pytest.mark.slow
def test_a_further_key_is_of_the_same_tenant_and_a_revoked_one_is_refused(shared):
    assert "exists" in keys(shared.folder, "create", "acme").stderr
    further = made(shared.folder, "acme", "--further")
    job = post(shared.clients["acme"]).json()
    with client_with(shared, further) as client:
        until(lambda: client.get("/v1/jobs").status_code == 200, 3.0, "the new key")
        assert client.get(f"/v1/jobs/{job['id']}").status_code == 200
        listed = keys(shared.folder, "list").stdout
        assert further not in listed
        key_id = [line.split()[0] for line in listed.splitlines() if line.endswith("  acme")][-1]
        assert keys(shared.folder, "revoke", key_id).returncode == 0
        until(lambda: client.get("/v1/jobs").status_code == 401, 3.0, "the end of the key")
    assert f"{key_id}  revoked" in keys(shared.folder, "list").stdout
    assert keys(shared.folder, "revoke", key_id).returncode == 1
    assert shared.clients["acme"].get("/v1/jobs").status_code == 200


@pytest.mark.slow
@pytest.mark.parametrize("tenant", further(["", "a b", "x" * 101, "a\nb", "é"], ["a b", "é"]))
def test_a_tenant_has_a_plain_name(tmp_path, tenant):
    done = keys(tmp_path, "create", tenant)
    assert (done.returncode, done.stdout) == (1, "")
    assert "Traceback" not in done.stderr


@pytest.mark.slow
@pytest.mark.campaign
def test_a_key_has_its_rate(tmp_path):
    key, other = made(tmp_path, "acme"), made(tmp_path, "globex")
    server = RunningServer(tmp_path, SCRIPTED, workers=1, rate_limit="5/hour")
    try:
        with client_with(server, key) as client, client_with(server, other) as another:
            answers = [client.get("/v1/jobs") for _ in range(4)]
            answers.append(client.get(f"/v1/jobs/{NOWHERE}"))  # an error counts, and says what is left, as well
            assert [answer.status_code for answer in answers] == [200] * 4 + [404]
            for left, answer in zip((4, 3, 2, 1, 0), answers, strict=True):
                assert re.fullmatch(rf'"key";r={left};t=\d+', answer.headers["ratelimit"])
                assert answer.headers["ratelimit-policy"] == '"key";q=5;w=3600'
            refused = client.get("/v1/jobs")
            assert refused.status_code == 429
            assert refused.json()["type"] == "/problems/rate-limited"
            assert 1 <= int(refused.headers["retry-after"]) <= 7200
            assert refused.headers["ratelimit"].startswith('"key";r=0;')
            assert another.get("/v1/jobs").status_code == 200, "each key has its own"
            assert client.get("/healthz").status_code == 200
        assert 'mechsynth_http_rejections_total{reason="rate-limited"} 1.0' in server.client.get("/metrics").text
    finally:
        assert server.stop() == 0


@pytest.mark.slow
def test_web_pages_of_named_origins_may_use_it(shared):
    asked = {
        "Origin": ORIGIN,
        "Access-Control-Request-Method": "POST",
        "Access-Control-Request-Headers": "authorization, content-type, idempotency-key",
    }
    preflight = httpx.options(f"{shared.url}/v1/jobs", headers=asked)
    assert preflight.status_code == 200
    assert preflight.headers["access-control-allow-origin"] == ORIGIN
    answer = httpx.get(f"{shared.url}/v1/jobs", headers={"Origin": ORIGIN})
    assert answer.status_code == 401
    assert answer.headers["access-control-allow-origin"] == ORIGIN, "a page can read the error"
    assert "RateLimit" in answer.headers["access-control-expose-headers"]
    for origin in ("https://evil.example", "null", f"{ORIGIN}.evil.example"):
        answer = httpx.get(f"{shared.url}/v1/jobs", headers={"Origin": origin})
        assert "access-control-allow-origin" not in answer.headers


def test_web_pages_may_not_use_it_unless_told(scripted):
    answer = scripted.client.get("/v1/jobs", headers={"Origin": ORIGIN})
    assert "access-control-allow-origin" not in answer.headers
    assert scripted.client.options("/v1/jobs", headers={"Origin": ORIGIN}).status_code == 405


@pytest.mark.slow
@pytest.mark.campaign
def test_without_keys_it_listens_on_this_machine_only(tmp_path):
    server = RunningServer(tmp_path, SCRIPTED, workers=1, host="0.0.0.0", cors_origins="*")
    try:
        assert server.url.startswith("http://127.0.0.1:")
        assert "there are no API keys" in server.log()
        assert "CORS_ORIGINS admits every web page" in server.log()
        assert "bearer" not in str(server.client.get("/openapi.json").json())
        assert listening_on(server.url.rpartition(":")[2]) == {"0100007F"}
        # The first key closes what was open, without a restart.
        assert server.client.get("/v1/jobs").status_code == 200
        key = made(tmp_path, "acme")
        until(lambda: server.client.get("/v1/jobs").status_code == 401, 3.0, "the closing")
        with client_with(server, key) as client:
            assert client.get("/v1/jobs").json() == {"jobs": [], "next_cursor": None}
    finally:
        assert server.stop() == 0


@pytest.mark.slow
@pytest.mark.campaign
def test_with_keys_it_listens_where_it_is_told_even_when_all_are_revoked(tmp_path):
    made(tmp_path, "acme")
    key_id = keys(tmp_path, "list").stdout.split()[0]
    assert keys(tmp_path, "revoke", key_id).returncode == 0
    server = RunningServer(tmp_path, SCRIPTED, workers=1, host="0.0.0.0")
    try:
        assert listening_on(server.url.rpartition(":")[2]) == {"00000000"}
        assert server.client.get("/v1/jobs").status_code == 401, "without a key in force it is closed, not open"
    finally:
        assert server.stop() == 0


def listening_on(port):
    """The addresses that this machine listens on at a port, in the kernel's notation."""
    with open("/proc/net/tcp") as table:
        rows = [line.split() for line in table.readlines()[1:]]
    return {
        row[1].partition(":")[0] for row in rows if row[3] == "0A" and int(row[1].partition(":")[2], 16) == int(port)
    }


@pytest.fixture
def engine(tmp_path):
    engine = connect(f"sqlite:///{tmp_path / 'jobs.sqlite3'}", durable=False)
    yield engine
    engine.dispose()


def test_keys_in_the_store(engine):
    store = KeyStore(engine)
    assert not store.has_keys(), "not even tables"
    upgrade(engine)
    assert not store.has_keys()
    assert store.load_holders() is None
    key, secret = store.create("acme")
    assert re.fullmatch(r"mechsynth_[A-Za-z0-9_-]{43}", secret)
    assert store.load_holders() == {hash_key(secret): key}
    with pytest.raises(TenantExists):
        store.create("acme")
    assert store.revoke(key.id)
    assert not store.revoke(key.id)
    with pytest.raises(TenantExists):  # its jobs are still there
        store.create("acme")
    assert store.load_holders() == {}
    assert store.has_keys()
    assert [(k.id, k.revoked_at is None) for k in store.list_keys()] == [(key.id, False)]


def test_the_keys_are_read_once_a_second(engine):
    import asyncio

    upgrade(engine)
    store = KeyStore(engine)
    _, secret = store.create("acme")
    reads = []
    holders = store.load_holders
    store.load_holders = lambda: reads.append(time.monotonic()) or holders()

    async def ask():
        gate = Gate(store, None)
        admitted = await asyncio.gather(*(gate.admit(secret) for _ in range(200)))
        for _ in range(50):
            with pytest.raises(NoKey):
                await gate.admit("mechsynth_guess")
        return admitted

    assert {tenant for tenant, _ in asyncio.run(ask())} == {"acme"}
    assert len(reads) <= 2


@pytest.mark.slow
def test_a_queue_that_one_tenant_has_filled_is_full_for_no_other(shared):
    acme, globex = shared.clients["acme"], shared.clients["globex"]
    gate = shared.folder / "open"
    gate.unlink(missing_ok=True)
    try:
        first = post(acme, GATED, wait=0).json()
        until(lambda: acme.get(f"/v1/jobs/{first['id']}").json()["status"] == "running", what="the job running")
        flood = [post(acme, wait=0) for _ in range(QUEUE + 3)]
        assert [answer.status_code for answer in flood] == [202] * QUEUE + [503] * 3
        guest = post(globex, wait=0)
        assert guest.status_code == 202
    finally:
        gate.touch()
    until(lambda: globex.get(f"/v1/jobs/{guest.json()['id']}").json()["finished_at"], what="the guest's job")
    started = [acme.get(f"/v1/jobs/{answer.json()['id']}").json()["started_at"] for answer in flood[1:QUEUE]]
    mine = globex.get(f"/v1/jobs/{guest.json()['id']}").json()["started_at"]
    assert all(other is None or other > mine for other in started), "it was the second, after one of the flood's"
