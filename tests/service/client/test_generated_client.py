"""A Python client is generated from the OpenAPI document and used against the service."""

import importlib
import json
import os
import subprocess
import sys

import pytest

from synthesis.registry import KINDS, get_first_example
from tests.support.service.api_document import read_api_document

pytestmark = pytest.mark.slow

PACKAGE = "mechsynth_client"
SETTINGS = {
    # They only format the generated code.
    "post_hooks": [],
    # The generator knows these two types of content, and returns the content of any other as one of them.
    "content_type_overrides": {
        **dict.fromkeys(("image/svg+xml", "image/vnd.dxf", "text/csv"), "text/html"),
        **dict.fromkeys(("image/gif", "image/png", "application/zip"), "application/octet-stream"),
    },
}


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """The folder of the generated package and what the generator has said of it."""
    folder = tmp_path_factory.mktemp("generated")
    (folder / "openapi.json").write_text(json.dumps(read_api_document()), encoding="utf-8")
    (folder / "settings.json").write_text(json.dumps(SETTINGS), encoding="utf-8")
    done = subprocess.run(
        [
            sys.executable, "-m", "openapi_python_client", "generate", "--path", "openapi.json",
            "--config", "settings.json", "--meta", "none", "--output-path", PACKAGE,
        ],
        cwd=folder, capture_output=True, text=True, timeout=100, env={**os.environ, "NO_COLOR": "1"},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return folder, done.stdout + done.stderr


@pytest.fixture(scope="module")
def generated(package):
    """Import a module of the generated package by its name."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(package[0])
        yield lambda name: importlib.import_module(f"{PACKAGE}.{name}")


def test_no_schema_and_no_operation_is_left_out(package):
    folder, said = package
    assert "Unable to" not in said
    assert "Endpoint will not be generated" not in said
    operations = {
        operation["operationId"] for methods in read_api_document()["paths"].values() for operation in methods.values()
    }
    assert {file.stem for file in (folder / PACKAGE / "api").glob("*/*.py")} - {"__init__"} == operations


def test_the_generated_client_creates_a_job_and_reads_it(generated, server):
    models, jobs = generated("models"), generated("api.jobs")
    create_job, get_job = (importlib.import_module(f"{jobs.__name__}.{name}") for name in ("create_job", "get_job"))

    def state(ratio):
        problem = models.GearTrainProblem(kind="gear_train", ratio=ratio)
        return models.JobRequest(problem=problem, label="generated")

    with generated("client").Client(base_url=server.url) as client:
        answer = create_job.sync_detailed(client=client, body=state("22/7"), prefer="wait=20")
        assert (answer.status_code, answer.parsed.status, answer.parsed.label) == (200, "succeeded", "generated")
        job = get_job.sync(job_id=answer.parsed.id, client=client)
        refused = create_job.sync(client=client, body=state("none"))
    assert isinstance(job.problem, models.GearTrainProblem)
    assert isinstance(job.result, models.GearTrainResult)
    assert [design.verification for design in job.result.designs]
    assert (refused.status, refused.errors[0].path) == (422, "/problem/ratio")


def test_every_example_passes_through_the_generated_classes(generated):
    model = generated("models").JobRequest
    for kind in KINDS:
        request = {"problem": get_first_example(kind), "label": None}
        assert model.from_dict(request).to_dict() == request
