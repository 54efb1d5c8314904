"""What is stated, what is stored, and what a worker reads are one statement; so is the problem that a job shows."""

from __future__ import annotations

import json
from functools import cache
from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError

from service import requests
from synthesis.model.problem import ProblemBase
from synthesis.registry import KINDS, parse_problem
from tests.campaign import further
from tests.statements import drawn
from tests.support.service.answers import finished
from tests.support.service.stated import hashed

DRAWS, PATIENT = 40, 2000
"""Values that are drawn for a field until one of them is taken; most fields of a spring exclude others."""

STOCK = {
    "kind": "gear_train",
    "ratio": "8",
    "max_stages": 2,
    "stock": [20, 25, 30, 35, 40, 45, 50, 55, 60, 80, 100],
}


def explicit(value: Any) -> Any:
    """The names of the fields that were stated, all the way down."""
    if isinstance(value, BaseModel):
        return {name: explicit(getattr(value, name)) for name in sorted(value.model_fields_set)}
    if isinstance(value, dict):
        return {name: explicit(entry) for name, entry in value.items()}
    return [explicit(entry) for entry in value] if isinstance(value, list | tuple) else None


def keeps(statement: dict[str, Any]) -> ProblemBase:
    """What is stored of a statement is read as the same, with the same faults; so is what is shown of it."""
    problem = parse_problem(statement)
    stored = requests.dump_problem(problem)
    read = requests.load_stored_problem(problem.kind, stored)
    assert read == problem
    assert explicit(read) == explicit(problem)
    assert read.find_contradictions() == problem.find_contradictions()
    shown = json.loads(requests.fill_defaults(problem.kind, stored))
    again = parse_problem(shown)
    assert again == problem
    assert again.find_contradictions() == problem.find_contradictions(), (
        "a default that is written out states something"
    )
    assert hashed(shown) == hashed(statement)
    return problem


@cache
def schema_of(kind: str) -> dict[str, Any]:
    return KINDS[kind].problem.model_json_schema()


def taken(kind: str, statement: dict[str, Any], name: str, rng: Random, draws: int = DRAWS) -> dict[str, Any] | None:
    """The statement with a value drawn for one of its fields; None where it took none of them."""
    schema = schema_of(kind)
    for _ in range(draws):
        changed = {**statement, name: drawn(schema["properties"][name], schema, rng)}
        try:
            parse_problem(changed)
        except ValidationError:
            continue
        return changed
    return None


@pytest.mark.parametrize("kind", KINDS)
def test_every_field_alone_is_kept(kind: str) -> None:
    for seed, name in enumerate(KINDS[kind].problem.model_fields):
        if name == "kind":
            continue
        changed = taken(kind, KINDS[kind].examples[0], name, Random(seed), PATIENT)
        assert changed is not None, f"no value for {name}"
        keeps(changed)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@given(seed=st.integers(0, 2**32))
def test_fields_together_are_kept(kind: str, seed: int) -> None:
    rng = Random(seed)
    statement = rng.choice(KINDS[kind].examples)
    for name in KINDS[kind].problem.model_fields:
        if name != "kind" and rng.random() < 0.4:
            statement = taken(kind, statement, name, rng) or statement
    keeps(statement)


@pytest.mark.parametrize("kind", KINDS)
def test_examples_are_kept(kind: str) -> None:
    for example in KINDS[kind].examples:
        assert keeps(example).find_contradictions() == []


SPRINGS = (
    {"ends": [{"link": "ground", "point": [0.0, 250.0]}, {"link": "lever", "point": [100.0, 0.0]}], "rate": 20.0},
    {"torsion": 3.0, "links": ["ground", "lever"]},
)


@pytest.mark.parametrize("spring", SPRINGS, ids=["linear", "torsion"])
def test_a_spring_is_accepted_with_its_defaults(spring: dict[str, Any]) -> None:
    statement = KINDS["spring_balancing"].examples[0]
    keeps({**statement, "dynamics": {**statement["dynamics"], "springs": [spring]}})


def test_a_stock_is_a_statement() -> None:
    assert keeps(STOCK).find_contradictions() == []
    both = parse_problem({**STOCK, "teeth": {"max": 100}})
    assert [fault.path for fault in both.find_contradictions()] == ["/stock"]


def test_a_problem_of_an_earlier_version_is_shown_as_it_was_stated() -> None:
    stored = '{"kind":"motion","former":1}'
    assert requests.fill_defaults("motion", stored) == stored


QUICK = {name: kind.examples[name == "path"] for name, kind in KINDS.items()}
"""A problem of each kind that takes no long search."""


@pytest.mark.slow
@pytest.mark.parametrize(
    "problem", further([STOCK, *QUICK.values()], [STOCK, *list(QUICK.values())[::3]]), ids=["stock", *QUICK]
)
def test_the_problem_of_a_job_posted_again_has_the_same_answer(server: Any, client: Any, problem: Any) -> None:
    job = finished(client, problem)
    assert job["status"] == "succeeded", job["error"]
    assert job["result"]["designs"]
    stored = json.loads(server.stored(job["id"], "problem"))
    assert stored == problem, "the store has something else than what was stated"
    with server.solving_anew():
        again = finished(client, job["problem"], fresh=True)
    assert again["problem"] == job["problem"]
    assert again["result"] == job["result"]
