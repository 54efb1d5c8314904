"""The code of the tutorials, run while another process makes the site."""

from __future__ import annotations

import doctest
from pathlib import Path

import pytest

TUTORIALS = sorted((Path(__file__).parents[2] / "docs" / "tutorials").glob("*-*.md"))


@pytest.mark.site
@pytest.mark.timeout(900)
@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.stem)
def test_tutorials_run(path: Path) -> None:
    outcome = doctest.testfile(str(path), module_relative=False)
    assert outcome.attempted > 5
    assert outcome.failed == 0
