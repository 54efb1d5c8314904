"""The studio's modules keep the types that their comments state, and those of the current API."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from tools.studio.messages import STUDIO
from tools.studio.types import write_types

HERE = Path(__file__).parent
MODULES = HERE / "node_modules"

# What the page has of three.js, with the types that are published beside it.
VENDORED = {"three.module.min.d.ts": "three", "OrbitControls.d.ts": "three/addons/controls/OrbitControls.js"}

pytestmark = [pytest.mark.browser, pytest.mark.timeout(400)]


def test_the_studio_is_well_typed(tmp_path):
    assert (MODULES / ".installed").exists(), "make test-browser installs what this needs of node"
    shutil.copytree(STUDIO, tmp_path, ignore=shutil.ignore_patterns("vendor"), dirs_exist_ok=True)
    write_types(tmp_path / "types" / "api.d.ts")
    (tmp_path / "vendor").mkdir()
    (tmp_path / "node_modules").symlink_to(MODULES)
    for name, module in VENDORED.items():
        (tmp_path / "vendor" / name).write_text(f'export * from "{module}";\n')
    # What must be refused, so that nothing passes because nothing is looked at.
    (tmp_path / "mistaken.js").write_text(
        'import { View } from "./core/view.js";\n'
        '/** @param {View} view */\nexport const wrong = (view) => view.toPicture("one");\n'
        '/** @param {import("./types/values.js").Design} one */\nexport const no = (one) => one.mechanism.cranc;\n'
    )
    settings = json.loads((HERE / "studio.json").read_text())
    (tmp_path / "tsconfig.json").write_text(
        json.dumps({**settings, "include": ["**/*.js", "types/*.d.ts"], "exclude": ["node_modules", "vendor"]})
    )
    done = subprocess.run(
        [str(MODULES / ".bin" / "tsc"), "-p", "."], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert [line for line in done.stdout.splitlines() if not line.startswith(("mistaken.js", " "))] == []
    assert "mistaken.js(3,37): error TS2554" in done.stdout, done.stdout
    assert "mistaken.js(5,42): error TS2551: Property 'cranc'" in done.stdout, done.stdout
