"""What an answer has is taken wherever a mechanism is asked for, or refused in one sentence that says why not."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import pytest
from pydantic import ValidationError

from synthesis.analyses import list_families, parse_request
from synthesis.registry import KINDS, parse_problem
from tests.campaign import further
from tests.statements import Schema, choices, fields
from tests.support.answers import solve

CASES = [(kind, number) for kind in KINDS for number in range(len(KINDS[kind].examples))]

SLOW = {
    *(("path", n) for n in (0, 3)),
    *(("dwell", n) for n in (1, 2)),
    *(("motion", n) for n in (2, 4, 5, 6, 10)),
    ("function", 3),
    ("indexing", 4),
}
"""Examples whose search takes more than a second."""

EXAMPLES = further(CASES, [case for case in CASES if case not in SLOW and (case[1] == 0 or case[1] % 3 == 2)])


def mechanisms_in(value: Any) -> Iterator[dict[str, Any]]:
    """Every mechanism of an answer: those of designs, and of what stands beside them."""
    if isinstance(value, dict):
        if isinstance(value.get("mechanism"), dict):
            yield value["mechanism"]
        for entry in value.values():
            yield from mechanisms_in(entry)
    elif isinstance(value, list):
        for entry in value:
            yield from mechanisms_in(entry)


@cache
def answered(kind: str, number: int) -> list[dict[str, Any]]:
    """The mechanisms of the answer to an example."""
    stated = parse_problem({**KINDS[kind].examples[number], "max_designs": 3, "include_failed": True})
    found = list(mechanisms_in(solve(stated).model_dump(mode="json")))
    assert found
    return found


def analysed(mechanism: dict[str, Any]) -> None:
    request = parse_request({"mechanism": mechanism})
    assert request.find_errors() == []
    answer = request.build_answer()
    assert any(answer.get("valid", [True])), "it stands nowhere"


def carried(mechanism: dict[str, Any]) -> None:
    """A fourbar has its curve followed, unless its point runs on a circle; another mechanism is told what to state."""
    try:
        problem = parse_problem({"kind": "parallel_motion", "linkage": mechanism, "max_designs": 1})
    except ValidationError as refused:
        (fault,) = refused.errors()
        assert mechanism["type"] != "fourbar", fault
        assert (fault["loc"], fault["type"]) == (("<parallel_motion>", "linkage"), "no_fourbar")
        return
    assert mechanism["type"] == "fourbar"
    faults = problem.find_contradictions()
    if faults:
        assert [fault.path for fault in faults] == ["/linkage/coupler_point"]
        assert "on a pin" in faults[0].detail
        return
    assert solve(problem).search.candidates > 0


def on_a_shaft(mechanism: dict[str, Any]) -> None:
    cam = {"type": "camshaft", "cams": [{"cam": mechanism, "load": {"mass": 1.0}}]}
    try:
        request = parse_request({"mechanism": cam, "motion": {"steps": 8}})
    except ValidationError as refused:
        (fault,) = refused.errors()
        assert mechanism["type"] != "cam", fault
        assert (fault["loc"][-1], fault["type"]) == ("cam", "no_plate_cam")
        return
    assert mechanism["type"] == "cam"
    assert request.find_errors() == []
    assert request.build_answer()["input_angle"]


TAKERS = {
    "parallel_motion.linkage": carried,
    "Camshaft: mechanism.cams[].cam": on_a_shaft,
    "analysis": analysed,
}
"""What takes a mechanism: fields of problems, parts of analyses, and the analysis of each type itself."""


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "number"), EXAMPLES)
def test_every_mechanism_of_an_answer_is_taken_or_refused_in_a_sentence(kind: str, number: int) -> None:
    for mechanism in answered(kind, number):
        for take in TAKERS.values():
            take(mechanism)


def test_cognates_of_an_analysis_are_taken() -> None:
    example = KINDS["parallel_motion"].examples[0]["linkage"]
    asked = {"mechanism": {"type": "fourbar", **example}, "motion": {"at": 30.0}, "include": ["cognates"]}
    cognates = parse_request(asked).build_answer()["fourbar"]["cognates"]
    found = [value for value in cognates.values() if isinstance(value, dict) and "type" in value]
    found = found or list(mechanisms_in(cognates))
    assert len(found) >= 4
    for mechanism in found:
        analysed(mechanism)
        carried(mechanism)


def taking(schema: Schema) -> list[str]:
    """The fields that hold a model whose ``type`` is one of mechanisms."""
    known = {name for kind in KINDS.values() for name in kind.mechanisms}
    found = []
    for field, value in fields(schema).items():
        types = [one.get("properties", {}).get("type", {}) for _, one in choices(value, schema)]
        if known & {name for one in types for name in [one.get("const"), *one.get("enum", [])]}:
            found.append(field)
    return found


@pytest.mark.slow
def test_no_field_that_takes_a_mechanism_is_left_out() -> None:
    found = {f"{name}.{field}" for name, kind in KINDS.items() for field in taking(kind.problem.model_json_schema())}
    for family in list_families():
        for field in taking(family.request.model_json_schema()):
            found.add("analysis" if field == "mechanism" else f"{family.request.model_config['title']}: {field}")
    assert found == set(TAKERS)
