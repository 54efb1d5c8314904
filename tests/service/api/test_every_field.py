"""Every field of every statement, through HTTP: the answer is another one where the field is."""

from __future__ import annotations

import json
from typing import Any

import httpx
import pytest

from synthesis.registry import KINDS
from tests.service.stated.row import Row, changed
from tests.service.stated.tables import ELSEWHERE, NO_EFFECT, TABLES
from tests.statements import fields
from tests.support.loops import check_each
from tests.support.service.answers import finished
from tests.support.service.stated import hashed

Statement = dict[str, Any]


def row_of(kind: str, name: str) -> Row:
    stated = TABLES[kind][1][name]
    return stated if isinstance(stated, Row) else Row(stated)


def pair(kind: str, name: str) -> tuple[Statement, Statement]:
    """The problem without the change, and with it."""
    row = row_of(kind, name)
    base = changed(TABLES[kind][0], row.base)
    return base, changed(base, {row.at or name: row.value})


ROWS = [
    pytest.param(kind, name, marks=pytest.mark.campaign, id=f"{kind}: {name}")
    for kind, (_, rows) in TABLES.items()
    for name in rows
]


@pytest.fixture(scope="module")
def answers() -> dict[str, Any]:
    """What was answered to each problem: many rows begin from one."""
    return {}


def answer(client: httpx.Client, answers: dict[str, Any], problem: Statement, file: str | None) -> Any:
    """The result, or a file of the first design; or the faults of a refused statement."""
    key = json.dumps([problem, file], sort_keys=True)
    if key not in answers:
        posted = client.post("/v1/jobs", json={"problem": problem}, headers={"Prefer": "wait=30"})
        if posted.status_code == 422:
            answers[key] = posted.json()["errors"]
        else:
            job = posted.json() if posted.status_code == 200 else finished(client, problem)
            assert job["status"] == "succeeded", job["error"]
            answers[key] = job["result"]
            if file is not None:
                answers[key] = client.get(f"/v1/jobs/{job['id']}/designs/0.{file}").raise_for_status().text
    return answers[key]


@pytest.mark.parametrize(("kind", "name"), ROWS)
def test_a_field_makes_another_answer(client: httpx.Client, answers: dict[str, Any], kind: str, name: str) -> None:
    base, other = pair(kind, name)
    file = row_of(kind, name).file
    before, after = answer(client, answers, base, file), answer(client, answers, other, file)
    assert before != after, "the field is ignored"
    assert not (isinstance(before, list) and isinstance(after, list)), "both are refused"


@pytest.mark.parametrize("kind", TABLES)
def test_every_field_has_a_row(kind: str) -> None:
    known = fields(KINDS[kind].problem.model_json_schema(), ELSEWHERE).keys() - {"kind"}
    without = {name for of, name in NO_EFFECT if of == kind}
    assert known - without == TABLES[kind][1].keys()


def test_every_kind_has_a_table() -> None:
    assert TABLES.keys() == KINDS.keys()


def test_another_field_is_another_request() -> None:
    """By an idempotency key a statement is known by what it means."""

    def check(kind: str, name: str) -> None:
        base, other = pair(kind, name)
        try:
            first, second = hashed(base), hashed(other)
        except ValueError:
            return  # one of them is ill-formed and refused
        assert first != second

    check_each([case.values for case in ROWS], check)
