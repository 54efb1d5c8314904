"""Problems of clients: validation, storage, and display.

The store has exactly the fields that the client sent, so the client's, the stored and the solved problem are the same.
A job shows its problem with the defaults of all omitted fields. An explicitly written default has no effect, so this
problem, posted again, counts as the same one.
"""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError

from kinematics.message import make_sentence
from service.error_messages import describe_faults
from synthesis.model.problem import ProblemBase
from synthesis.registry import KINDS

Faults = list[tuple[str, str]]
"""Pairs of JSON pointer, relative to the problem, and description of the fault."""


def dump_problem(problem: ProblemBase) -> str:
    """Return a problem in its stored form: the given fields as JSON."""
    return problem.model_dump_json(exclude_unset=True)


def load_stored_problem(kind: str, stored: str) -> ProblemBase:
    """Parse a problem from the stored form that :func:`dump_problem` returns.

    Raises
    ------
    pydantic.ValidationError
        If this version does not accept the text as a problem of the kind.
    """
    problem: ProblemBase = KINDS[kind].problem.model_validate_json(stored)
    return problem


def check_fields(kind: str, statement: object) -> tuple[Any, Faults]:
    """Validate a problem field by field; return it, or None, and the faults of its fields."""
    model = KINDS[kind].problem
    try:
        return model.model_validate(statement), []
    except ValidationError as error:
        faults = ({**fault, "loc": ("body", *fault["loc"])} for fault in error.errors())
        return None, describe_faults(faults, statement, {"body": model})


def check_consistency(problem: ProblemBase) -> Faults:
    """Return the contradictions in a problem; an empty list if it can be solved."""
    return [(fault.path, make_sentence(fault.detail)) for fault in problem.find_contradictions()]


def fill_defaults(kind: str, stored: str) -> str:
    """Return a stored problem with all defaults as JSON.

    A problem that an earlier version accepted and this one would refuse is returned unchanged.
    """
    try:
        problem = load_stored_problem(kind, stored)
    except ValidationError:
        return stored
    return str(problem.model_dump_json())
