"""Fields beside sixbars, through HTTP: with another value the mechanisms that are answered are others."""

from __future__ import annotations

from typing import Any

import pytest

from tests.service.answers import finished
from tests.service.stated.row import Row, changed
from tests.service.stated.sixbars import TABLES, TOLD

ROWS = [
    pytest.param(kind, name, marks=pytest.mark.campaign, id=f"{kind}: {name}")
    for kind, (_, rows) in TABLES.items()
    for name in rows
]


@pytest.fixture(scope="module")
def known() -> list[tuple[dict[str, Any], list[dict[str, Any]]]]:
    """What was answered to each problem: many rows begin from one."""
    return []


def designs(client, known, problem) -> list[dict[str, Any]]:
    for stated, answer in known:
        if stated == problem:
            return answer
    job = finished(client, problem)
    assert job["status"] == "succeeded", job
    known.append((problem, job["result"]["designs"]))
    return known[-1][1]


def made(answer: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [design["mechanism"] for design in answer if design["verification"]["passed"]]


@pytest.mark.timeout(300)
@pytest.mark.parametrize(("kind", "name"), ROWS)
def test_a_field_makes_other_sixbars(client, known, kind, name):
    problem, rows = TABLES[kind]
    row = rows[name] if isinstance(rows[name], Row) else Row(rows[name])
    base = changed(problem, row.base)
    before, after = (designs(client, known, stated) for stated in (base, changed(base, {row.at or name: row.value})))
    if name in TOLD:
        assert before != after, "the field is ignored"
        return
    assert made(before), "nothing to be changed"
    assert made(before) != made(after), "the field is ignored"
