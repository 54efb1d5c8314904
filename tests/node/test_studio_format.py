"""The studio's modules look as Prettier leaves them, and no line of code is wider than a window."""

import re
import subprocess
from pathlib import Path

import pytest

from tests.support.service.running import ROOT
from tools.studio.messages import studio_modules

MODULES = Path(__file__).parent / "node_modules"
STUDIO = ROOT / "service" / "studio"
WIDTH = 120

# A text that is looked up stands in one piece.
TEXT = re.compile(r".*t`[^`$]*(\$\{\w+\}[^`$]*)*`\S*")

pytestmark = [pytest.mark.browser, pytest.mark.timeout(200)]


def test_the_studio_is_formatted():
    done = subprocess.run(
        [str(MODULES / ".bin" / "prettier"), "--print-width", str(WIDTH), "--check", "**/*.js", "!vendor/**"],
        cwd=STUDIO,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, f"{done.stderr}make format mends it"


def test_no_line_is_wider_but_for_a_text():
    for module in studio_modules():
        for line in module.read_text().splitlines():
            assert len(line) <= WIDTH or TEXT.fullmatch(line), f"{module.name}: {line}"
