"""Everything else of the HTTP contract: errors, documents, health."""

import base64
import hashlib
import json
import re
import socket

import pytest

from service.api.http.prefer import parse_wait_seconds
from synthesis.registry import KINDS
from tests.support.service.answers import finished


def test_health(client):
    answer = client.get("/healthz")
    assert (answer.status_code, answer.json()) == (200, {"status": "ok"})
    answer = client.get("/readyz")
    assert answer.status_code == 200
    assert answer.json().keys() == {"status", "kernels"}
    assert answer.json()["status"] == "ok"


@pytest.mark.parametrize(
    "path", ["/nope", "/v1", "/v1/jobs/", "/v1/jobs/a/b/c", "/docs/assets/nope.js", "/%ff", "/%00"]
)
def test_unknown_paths(client, path):
    answer = client.get(path)
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["instance"] == path
    assert set(answer.json()) == {"type", "title", "status", "detail", "instance", "messages"}


def test_other_methods_are_told_which_there_are(client):
    answer = client.put("/v1/jobs", json={})
    assert answer.status_code == 405
    assert answer.headers["allow"] == "GET, POST"
    assert answer.headers["content-type"] == "application/problem+json"
    assert client.request("PROPFIND", "/v1/jobs").status_code == 405


def test_a_query_is_not_repeated_in_an_error(client):
    assert "token" not in client.get("/nope?token=1").text


def test_headers_with_odd_bytes(server):
    host, port = server.url.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=10) as raw:
        raw.sendall(
            b"POST /v1/jobs HTTP/1.1\r\nHost: \xff\r\nPrefer: \xe9\x80wait\r\nContent-Type: \xff/\xfe\r\n"
            b"Content-Length: 2\r\nConnection: close\r\n\r\n{}"
        )
        answer = b"".join(iter(lambda: raw.recv(65536), b""))
    assert re.match(rb"HTTP/1.1 4\d\d ", answer)


@pytest.mark.parametrize(
    "host",
    [
        "localhost",
        "LOCALHOST:80",
        "127.0.0.1:8000",
        "10.0.0.1",
        "[::1]:8000",
        "api:8000",
        "testserver.",
        "api.internal",
    ],
)
def test_a_service_without_keys_answers_to_names_of_this_machine(client, host):
    assert client.get("/v1/jobs", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.com",
        "EVIL.com:8000",
        "evil.com.",
        "localhost.evil.com",
        "127.0.0.1.evil.com",
        "test.evil.com",
        "[",
        "",
        ".",
    ],
)
def test_a_service_without_keys_answers_to_no_other_name(client, host):
    for method, path in (("GET", "/v1/jobs"), ("POST", "/v1/jobs"), ("DELETE", "/v1/jobs/x"), ("GET", "/v1/problems")):
        answer = client.request(method, path, headers={"Host": host})
        assert answer.status_code == 403
        assert answer.json()["type"] == "/problems/foreign-host"
    assert client.get("/healthz", headers={"Host": host}).status_code == 200


@pytest.mark.slow
def test_every_kind_is_listed_with_an_example_that_runs(client):
    kinds = client.get("/v1/problems").json()["problems"]
    assert [kind["kind"] for kind in kinds] == list(KINDS)
    for kind in kinds:
        assert set(kind) == {"kind", "title", "description", "schema", "example", "examples", "files", "measures"}
        assert kind["schema"]["type"] == "object"
        assert kind["title"]
        job = finished(client, kind["example"])
        assert job["status"] == "succeeded"
        assert job["result"]["designs"]


def test_the_reference_may_run_its_own_scripts_only(client):
    answer = client.get("/docs")
    policy = answer.headers["content-security-policy"]
    (script,) = re.findall(r"<script>(.*?)</script>", answer.text, re.DOTALL)
    assert base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() in policy
    assert "default-src 'none'" in policy
    assert "frame-ancestors 'none'" in policy
    assert answer.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize(
    "path", ["/v1/problems", "/v1/problems/cam", "/v1/jobs", "/v1/jobs/01K6WM2B7Q3W9Z0V5N8XJ4R1TD", "/v1/batches"]
)
def test_an_unknown_parameter_is_refused(client, path):
    refused = client.get(path, params={"limitt": 3})
    assert (refused.status_code, refused.json()["type"]) == (422, "/problems/invalid-request")
    assert [fault["path"] for fault in refused.json()["errors"]] == ["/query/limitt"]


@pytest.mark.slow
def test_the_reference_needs_no_other_host(client):
    page = client.get("/docs").text
    links = re.findall(r'(?:src|href)="([^"]+)"', page)
    assert links
    for link in links:
        assert link.startswith("/docs/assets/")
        assert client.get(link).status_code == 200
    document = client.get(re.search(r"url: '([^']+)'", page)[1])
    assert document.json() == client.get("/openapi.json").json()
    assert client.get("/redoc").status_code == 404


@pytest.fixture(scope="module")
def openapi(server):
    return server.client.get("/openapi.json").json()


def operations(openapi):
    return [(path, method, op) for path, methods in openapi["paths"].items() for method, op in methods.items()]


def test_the_openapi_document_is_complete(openapi):
    assert openapi["openapi"].startswith("3.1")
    ids = [op["operationId"] for _, _, op in operations(openapi)]
    assert sorted(ids) == [
        "analyse", "analyse_forces_of_design", "animate_design", "create_batch", "create_job", "delete_batch",
        "delete_job", "draw_assembly", "draw_design", "export_assembly_glb", "export_assembly_step",
        "export_design_csv", "export_design_dxf", "export_design_mjcf", "export_design_modelica",
        "export_design_script", "export_design_urdf", "export_part_3mf", "export_part_dxf", "export_part_step",
        "export_part_stl", "follow_batch", "follow_job", "forces_of_design", "get_batch", "get_job", "get_me",
        "get_problem_kind",
        "get_result",
        "healthz",
        "import_curves", "list_batches", "list_jobs", "list_problems", "make_parts", "metrics", "move_design",
        "open_design_in_pmks", "read_outlines", "readyz", "report_job", "tabulate_batch",
        "tabulate_batch_as_csv", "view_assembly", "weigh_up_batch",
    ]  # fmt: skip
    schemas = openapi["components"]["schemas"]
    assert not {"HTTPValidationError", "ValidationError"} & set(schemas)
    assert not any("title" in schema for schema in schemas.values()), "generators name classes by titles"
    references = set(re.findall(r'"#/components/schemas/([^"]+)"', json.dumps(openapi)))
    assert references <= set(schemas)
    assert {
        "Analysis",
        "AnalysisRequest",
        "Job",
        "JobRequest",
        "JobList",
        "MotionResult",
        "ProblemDetails",
    } <= references
    for _, _, operation in operations(openapi):
        assert operation["tags"]
        assert operation["summary"]
        for status, response in operation["responses"].items():
            if int(status) >= 400:
                assert list(response["content"]) == ["application/problem+json"]


def test_the_examples_of_the_openapi_document_run(client, openapi):
    body = openapi["paths"]["/v1/jobs"]["post"]["requestBody"]["content"]["application/json"]
    kinds = client.get("/v1/problems").json()["problems"]
    # That each of these runs is tested above.
    listed = {kind["kind"]: kind["example"] for kind in kinds}
    assert {kind: example["value"]["problem"] for kind, example in body["examples"].items()} == listed
    answer = client.post("/v1/jobs", json=body["examples"]["motion"]["value"], headers={"Prefer": "wait=30"})
    assert answer.json()["status"] == "succeeded"
    body = openapi["paths"]["/v1/analyses"]["post"]["requestBody"]["content"]["application/json"]
    assert body["examples"]
    for example in body["examples"].values():
        assert client.post("/v1/analyses", json=example["value"]).status_code == 200


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_result_of_a_job_is_had_alone(client, language):
    headers = {"Accept-Language": language}
    body = {"problem": {"kind": "gear_train", "ratio": "22/7"}}
    job = client.post("/v1/jobs", json=body, headers={**headers, "Prefer": "wait=30"}).json()
    answer = client.get(f"/v1/jobs/{job['id']}/result", headers=headers)
    assert answer.json() == job["result"]
    again = client.get(answer.request.url, headers={**headers, "If-None-Match": answer.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")


def test_a_wait_has_a_longest():
    assert parse_wait_seconds(["wait=99999"], longest=30) == 30
    assert parse_wait_seconds(["wait=999999999999"], longest=30) == 0
    assert parse_wait_seconds([], longest=30) == 0


def test_no_request_here_was_met_with_a_defect(server):
    """Runs at the end of its module: the log of the session's server holds no traceback."""
    assert "Traceback" not in server.log()


@pytest.mark.parametrize("path", ["/healthz", "/readyz", "/docs", "/openapi.json", "/v1/problems", "/v1/jobs", "/nope"])
def test_head_is_get_without_the_body(client, path):
    asked, got = client.head(path), client.get(path)
    assert asked.status_code == got.status_code
    assert asked.headers["content-type"] == got.headers["content-type"]
    assert asked.content == b""


def test_a_client_that_leaves_is_no_defect(server):
    host, port = server.url.removeprefix("http://").split(":")
    before = server.log().count("Traceback")
    with socket.create_connection((host, int(port))) as connection:
        head = b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        connection.sendall(head + b"Content-Length: 500\r\n\r\n{")
    assert server.client.get("/healthz").status_code == 200
    assert server.client.get("/v1/jobs").status_code == 200
    assert server.log().count("Traceback") == before
