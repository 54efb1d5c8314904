"""Every row of the literature table of cams is compared with what is computed: no task of it is left out."""

from __future__ import annotations

import re
from pathlib import Path

from tests.cases import load


def test_every_task_of_the_table_has_its_test() -> None:
    texts = [path.read_text(encoding="utf-8") for path in Path(__file__).parent.glob("test_*.py")]
    tested = {task for text in texts for task in re.findall(r'cases\("(\w+)", "cam"\)', text)}
    assert {case.kind for case in load("cam")} == tested
    assert len(load("cam")) == 127
    assert all(case.inputs is not None and case.expected for case in load("cam"))
