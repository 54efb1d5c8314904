"""Every row of the literature's tables is compared with what is computed: no kind of them is left out."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.cases import load

ASKED = re.compile(r'\bcases\("(\w+)"(?:, "(\w+)")?\)')

FIGURES_ONLY = {
    "linkage": {"ch2-mobility-app-2-3", "ch2-mobility-app-2-10", "ch2-mobility-app-2-24", "ch5-P5-15"},
    "gear": {"norton-p9-26c"},
}
"""Rows without inputs: the source has a figure without dimensions, or one that is lost."""


@pytest.mark.parametrize(
    "file", ["linkage", "quick_return", "straight_line", "steering_hooke", "gear", "cam", "dynamics"]
)
def test_every_kind_of_row_has_its_test(file: str) -> None:
    """The tests ask for rows by kind, and get all of that kind."""
    texts = [path.read_text(encoding="utf-8") for path in Path(__file__).parent.rglob("test_*.py")]
    asked = {kind for text in texts for kind, where in ASKED.findall(text) if (where or "linkage") == file}
    assert {case.kind for case in load(file) if case.inputs is not None} - asked == set()
    assert {case.id for case in load(file) if case.inputs is None} == FIGURES_ONLY.get(file, set())
    assert all(case.expected for case in load(file))


def test_no_row_is_lost() -> None:
    """Tables are only ever added to."""
    least = {"linkage": 164, "gear": 167, "cam": 127, "dynamics": 90}
    least |= {"quick_return": 2, "straight_line": 8, "steering_hooke": 16}
    assert all(len(load(file)) >= count for file, count in least.items())
