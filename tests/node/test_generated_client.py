"""A TypeScript client is generated from the OpenAPI document, type-checked, and used against the service."""

import json
import subprocess
from pathlib import Path

import pytest

from synthesis.registry import KINDS, list_examples
from tests.support.service.api_document import read_api_document
from tests.support.service.running import LEAN, RunningServer

HERE = Path(__file__).parent
MODULES = HERE / "node_modules"
STRICT = ("--strict", "--exactOptionalPropertyTypes", "--target", "es2022", "--module", "nodenext", "--skipLibCheck",
          "false", "--lib", "es2022,dom,dom.iterable", "--types", "node")  # fmt: skip

# The compiler takes its time with a schema of this size where it has a busy machine.
pytestmark = [pytest.mark.browser, pytest.mark.timeout(400)]


def run(folder, *command):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=180)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """A folder with the generated types and with programs that use them, checked and compiled."""
    assert (MODULES / ".installed").exists(), "make test-browser installs what this needs of node"
    folder = tmp_path_factory.mktemp("client")
    (folder / "node_modules").symlink_to(MODULES)
    (folder / "package.json").write_text('{"type": "module"}')
    (folder / "client.ts").write_text((HERE / "client.ts").read_text())
    stated = [one for kind in KINDS for one in list_examples(kind)]
    (folder / "examples.ts").write_text(
        'import type { components } from "./api.js";\n'
        f'export const examples: components["schemas"]["JobRequest"]["problem"][] = {json.dumps(stated, indent=1)};\n'
    )
    generator = str(MODULES / ".bin" / "openapi-typescript")
    # What has a default may be left out of a request.
    (folder / "openapi.json").write_text(json.dumps(read_api_document()), encoding="utf-8")
    run(folder, generator, "openapi.json", "--default-non-nullable=false", "-o", "api.ts")
    run(folder, str(MODULES / ".bin" / "tsc"), *STRICT, "client.ts", "examples.ts")
    return folder


def test_every_example_has_the_generated_type(compiled):
    assert (compiled / "examples.js").exists()


def test_the_generated_client_solves_a_problem(compiled, tmp_path):
    server = RunningServer(tmp_path, LEAN, workers=1)
    try:
        said = json.loads(run(compiled, "node", "client.js", server.url))
    finally:
        assert server.stop() == 0
    assert said.pop("kinds") == list(KINDS)
    assert said.pop("designs") > 0
    assert said == {
        "status": "succeeded",
        "label": "generated",
        "positions": 3,
        "complete": False,
        "drawn": True,
        "moved": True,
        "listed": True,
        "refusal": ["/problem/positions"],
        "refused_with": 422,
    }
