"""The linter Redocly finds no error in the OpenAPI document, with or without keys."""

import json
import os
import subprocess
from pathlib import Path

import pytest

from service.api.routes.docs import remove_keys
from tests.support.service.api_document import read_api_document

LINTER = Path(__file__).parent / "node_modules" / ".bin" / "redocly"
QUIET = {"REDOCLY_TELEMETRY": "off", "REDOCLY_SUPPRESS_UPDATE_NOTICE": "true"}

pytestmark = pytest.mark.browser


def lint(folder, document):
    """Return the rules that a document breaks, and where, of those that the linter recommends."""
    (folder / "openapi.json").write_text(json.dumps(document), encoding="utf-8")
    done = subprocess.run(
        [LINTER, "lint", "--extends", "recommended", "--format", "json", "openapi.json"],
        cwd=folder, capture_output=True, text=True, timeout=100, env={**os.environ, **QUIET},
    )  # fmt: skip
    problems = json.loads(done.stdout)["problems"]
    return {(each["ruleId"], each["location"][0].get("pointer")) for each in problems if each["severity"] == "error"}


def test_the_linter_finds_no_error(tmp_path):
    document = read_api_document()
    assert lint(tmp_path, document) == set()
    assert lint(tmp_path, remove_keys(document)) == set()


def test_the_linter_finds_what_is_wrong(tmp_path):
    document = read_api_document()
    document["paths"] = {"/healthz": document["paths"]["/healthz"]}
    document["components"]["schemas"]["Progress"]["lt"] = 1
    del document["servers"]
    assert lint(tmp_path, document) == {
        ("struct", "#/components/schemas/Progress/lt"),
        ("no-empty-servers", "#/openapi"),
    }
