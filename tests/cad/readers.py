"""Files of solids as those read them who made the formats: glTF-Validator of Khronos, lib3mf of the 3MF Consortium."""

from __future__ import annotations

import json
import subprocess
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from tests.support.service.running import ROOT

if TYPE_CHECKING:
    from lib3mf.Lib3MF import Wrapper

VALIDATED = """
const {validateBytes} = require("gltf-validator");
const content = new Uint8Array(require("fs").readFileSync(0));
validateBytes(content, {maxIssues: 0}).then((told) => console.log(JSON.stringify(told)));
"""

WARNING = 1
"""Severity of a warning; errors are 0, and above are hints."""


def assert_valid_glb(content: bytes) -> None:
    """The validator finds triangles, no error and no warning; node and it are as tests/node has them."""
    folder = ROOT / "tests" / "node"
    assert (folder / "node_modules" / "gltf-validator").exists(), "make test-cad installs what this needs of node"
    command = ["node", "-e", VALIDATED]
    ran = subprocess.run(command, cwd=folder, input=content, capture_output=True, timeout=120, check=True)
    told = json.loads(ran.stdout)
    faults = [message for message in told["issues"]["messages"] if message["severity"] <= WARNING]
    assert not faults, faults[:5]
    assert (told["issues"]["numErrors"], told["issues"]["numWarnings"]) == (0, 0)
    assert told["mimeType"] == "model/gltf-binary"
    assert told["info"]["version"] == "2.0"
    assert told["info"]["totalTriangleCount"] > 0


def assert_valid_3mf(content: bytes) -> None:
    """The library reads it strictly without a warning, and finds one closed mesh."""
    model = _load_lib3mf().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromBuffer(content)
    assert reader.GetWarningCount() == 0, [reader.GetWarning(n) for n in range(reader.GetWarningCount())]
    meshes = model.GetMeshObjects()
    assert meshes.MoveNext()
    assert meshes.GetCurrentMeshObject().IsManifoldAndOriented()
    assert not meshes.MoveNext()


@cache
def _load_lib3mf() -> Wrapper:
    from lib3mf import Lib3MF

    return Lib3MF.Wrapper(str(Path(Lib3MF.__file__).with_name("lib3mf")))
