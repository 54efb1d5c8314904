"""The files of a design do not depend on the process that makes them: names in sets have another order in each."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Any

import pytest

from synthesis.dispatch import solve
from synthesis.registry import parse_problem

STATEMENTS: list[dict[str, Any]] = [
    {
        "kind": "motion",
        "positions": [{"x": 0, "y": 0, "angle": 0}, {"x": 40, "y": 15, "angle": -25}, {"x": 75, "y": 5, "angle": -60}],
        "max_designs": 1,
    },
    {"kind": "gear_train", "ratio": 3, "max_stages": 1},
    {
        "kind": "cam",
        "segments": [{"motion": "rise", "angle": 180, "lift": 10}, {"motion": "fall", "angle": 180, "lift": 10}],
        "follower": {"type": "translating_flat"},
    },
]

SEEDS = ("0", "7", "12345")
"""Of the hashes of strings: with the last two the library's own order of a DXF's classes is not that with the first."""

DIGESTS = """
import hashlib, json, sys
from service.render import export_design, list_forms
from synthesis.registry import KINDS, parse_problem
for statement, answer in json.load(sys.stdin):
    problem = parse_problem(statement)
    design = KINDS[problem.kind].result.model_validate(answer, strict=False).designs[0]
    for form in list_forms(design.mechanism.type):
        file = export_design(design, problem, "A design", form)
        print(problem.kind, form, hashlib.sha256(file if isinstance(file, bytes) else file.encode()).hexdigest())
"""


@pytest.fixture(scope="module")
def answers() -> str:
    """Statements with their answers as JSON."""
    solved = [solve(parse_problem(s), lambda _fraction, _message: None).model_dump(mode="json") for s in STATEMENTS]
    return json.dumps(list(zip(STATEMENTS, solved, strict=True)))


@pytest.mark.campaign
def test_files_do_not_depend_on_the_hashes_of_strings(answers: str) -> None:
    digests = [
        subprocess.run(
            [sys.executable, "-c", DIGESTS],
            input=answers,
            env=os.environ | {"PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
            timeout=100.0,
        ).stdout
        for seed in SEEDS
    ]
    assert len(digests[0].splitlines()) == 4 * len(STATEMENTS)
    assert set(digests) == {digests[0]}
