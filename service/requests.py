"""What a client has stated: checked, written into the store, read from there, and shown.

The store has the fields that were stated and no others, so that what a client sends, what is stored and what a worker
solves are one statement. A job shows its problem with the defaults of all that was left out; a default that is written
out states nothing, so that this problem, posted again, is the same one.
"""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError

from service.error_messages import explain_fault, locate_fault, make_sentence
from synthesis.model.problem import ProblemBase
from synthesis.registry import KINDS

Faults = list[tuple[str, str]]
"""Pairs of the JSON pointer below the problem, and what is wrong there."""


def dump_problem(problem: ProblemBase) -> str:
    """A problem as the store has it: what was stated, in JSON."""
    return problem.model_dump_json(exclude_unset=True)


def load_stored_problem(kind: str, stored: str) -> Any:
    """The problem that :func:`dump_problem` has written; raises pydantic's ValidationError where it is none."""
    return KINDS[kind].problem.model_validate_json(stored)


def check_fields(kind: str, statement: Any) -> tuple[Any, Faults]:
    """The problem of a JSON-like statement, or None; and what is wrong with single fields of it."""
    try:
        return KINDS[kind].problem.model_validate(statement), []
    except ValidationError as error:
        faults = ({**fault, "loc": ("body", *fault["loc"])} for fault in error.errors())
        return None, list(dict.fromkeys((locate_fault(fault, statement), explain_fault(fault)) for fault in faults))


def check_consistency(problem: ProblemBase) -> Faults:
    """What is wrong with a problem as a whole; nothing where it can be solved."""
    return [(fault.path, make_sentence(fault.detail)) for fault in problem.find_contradictions()]


def fill_defaults(kind: str, stored: str) -> str:
    """The same with all defaults, in JSON.

    What an earlier version has taken and this one would refuse is shown as it was stated.
    """
    try:
        problem = load_stored_problem(kind, stored)
    except ValidationError:
        return stored
    return str(problem.model_dump_json())
