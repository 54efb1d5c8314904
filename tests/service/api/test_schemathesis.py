"""schemathesis reads the service's own OpenAPI document and asks every operation whatever that allows, and more."""

import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from synthesis.registry import get_first_example
from tests.support.service.access import client_with, made
from tests.support.service.api_document import read_api_document
from tests.support.service.running import LEAN, RunningServer

QUICKLY_SOLVED = ("motion", "gear_train", "planetary_train", "cam", "function", "straight_line")
SOLIDS = ("make_parts", "export_assembly_step", "export_assembly_glb")
"""Operations that say 501 where the extra ``cad`` is not installed."""

FINE = ["2xx", "3xx", "4xx", "501"]
"""Statuses that are no fault of the service's in these."""

COSTLY = ("animate_design", "report_job", *SOLIDS)
"""Operations that take a second of CPU where there is something to show; so most are asked for what there is not."""

CHECKS = (
    "not_a_server_error", "status_code_conformance", "content_type_conformance", "response_headers_conformance",
    "response_schema_conformance", "negative_data_rejection", "missing_required_header", "allow_header_conformance",
    "ignored_auth",
)  # fmt: skip


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """A service with a key, jobs that end soon whatever is asked, and a finished job of some kinds."""
    folder = tmp_path_factory.mktemp("schemathesis")
    key = made(folder, "acme")
    server = RunningServer(
        folder, LEAN, workers=1, rate_limit="off", job_timeout_s=60, max_wait_s=1, log_level="warning"
    )
    server.key = key
    try:
        with client_with(server, key) as client:
            # The first reader of the document waits for it to be made.
            assert client.get("/openapi.json", timeout=300.0).status_code == 200
            server.jobs = [solved(client, kind) for kind in QUICKLY_SOLVED]
        yield server
    finally:
        status = server.stop()
    assert status == 0
    assert "Traceback" not in server.log()


def solved(client, kind):
    body = {"problem": get_first_example(kind), "label": kind}
    job = client.post("/v1/jobs", json=body, headers={"Idempotency-Key": f"of-{kind}"}).json()
    # The first job of a kind compiles its kernels, where that has not been done before.
    for _ in range(300):
        if job["status"] not in ("queued", "running"):
            break
        job = client.post("/v1/jobs", json=body, headers={"Idempotency-Key": f"of-{kind}", "Prefer": "wait=1"}).json()
    assert job["status"] == "succeeded", job
    return job["id"]


def asked(server, folder: Path, examples: int, phases: str, *more: str) -> Counter:
    """Runs schemathesis, which must find nothing; gives the number of cases by operation."""
    folder.mkdir(exist_ok=True)
    ids = "\n".join(f'    "{job}",' for job in server.jobs)
    (folder / "schemathesis.toml").write_text(
        f"[dictionaries.jobs]\nvalues = [\n{ids}\n]\n"
        '[dictionaries.designs]\nvalues = ["0", "1", "2"]\n'
        "[parameters]\n"
        '"path.job_id" = { dictionary = "jobs", probability = 0.8 }\n'
        '"path.number" = { dictionary = "designs", probability = 0.8 }\n'
        + "".join(
            f'[[operations]]\ninclude-operation-id = "{costly}"\n'
            'parameters = { "path.job_id" = { dictionary = "jobs", probability = 0.1 } }\n'
            + (f"checks = {{ not_a_server_error = {{ expected-statuses = {FINE} }} }}\n" if costly in SOLIDS else "")
            for costly in COSTLY
        )
    )
    report = folder / "events.ndjson"
    done = subprocess.run(
        [
            sys.executable, "-m", "schemathesis.cli", "run", f"{server.url}/openapi.json",
            "--header", f"Authorization: Bearer {server.key}",
            "--checks", ",".join(CHECKS), "--max-examples", str(examples), "--phases", phases, "--seed", "1",
            "--continue-on-failure", "--request-timeout", "60", "--suppress-health-check", "all",
            "--report", "ndjson", "--report-ndjson-path", str(report), "--generation-database", "none", *more,
        ],
        cwd=folder,
        env={**os.environ, "NO_COLOR": "1"},
        capture_output=True,
        text=True,
        check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-20_000:] + done.stderr[-5_000:]
    return cases(report)


def cases(report: Path) -> Counter:
    counted = Counter()
    with report.open() as lines:
        for line in lines:
            finished = json.loads(line).get("ScenarioFinished")
            if finished is not None:
                recorder = finished["recorder"]
                counted[recorder["label"]] += len(recorder.get("cases", ()))
    return counted


READING = ("--exclude-method", "DELETE")
REMOVING = ("--include-method", "DELETE")


@pytest.fixture(scope="module")
def operations():
    paths = read_api_document()["paths"]
    return sum(len(methods) for methods in paths.values())


@pytest.mark.fuzz
@pytest.mark.timeout(2400)
def test_five_hundred_requests_of_each_operation_are_answered_as_documented(kept, operations, tmp_path):
    counted = asked(kept, tmp_path / "reading", 500, "examples,coverage,fuzzing", *READING)
    counted += asked(kept, tmp_path / "removing", 500, "coverage,fuzzing", *REMOVING)
    print(*(f"{n:6d}  {operation}" for operation, n in sorted(counted.items())), sep="\n")
    assert len(counted) == operations
    assert all(n >= 500 for operation, n in counted.items() if "{" in operation or operation.startswith("POST"))
