"""The examples in the docstrings of the libraries and of the oracles give what they show."""

from __future__ import annotations

import doctest
import importlib
from pathlib import Path

from tests.support.loops import check_each

ROOT = Path(__file__).parents[1]
MIN_EXAMPLES = 35
"""Examples that there are at least; a search that finds fewer looks in the wrong place."""


def test_examples_in_docstrings() -> None:
    """Only modules with examples are imported."""
    folders = ("kinematics", "synthesis", "tests/oracles")
    files = [path for package in folders for path in sorted((ROOT / package).rglob("*.py"))]
    modules = [
        ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for path in files
        if ">>> " in path.read_text(encoding="utf-8")
    ]
    attempted = 0

    def check(name: str) -> None:
        nonlocal attempted
        outcome = doctest.testmod(importlib.import_module(name), report=True)
        attempted += outcome.attempted
        assert outcome.failed == 0, f"{outcome.failed} of {outcome.attempted} examples fail"

    check_each(modules, check)
    assert attempted >= MIN_EXAMPLES
