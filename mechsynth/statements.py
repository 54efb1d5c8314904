"""Validation of problems, and their JSON form for a service."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import cast

from kinematics.message import join_messages
from service.error_messages import explain_kind
from service.requests import Faults, check_consistency, check_fields
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import ProblemBase
from synthesis.registry import KINDS

Problem = ProblemBase | Mapping[str, object]
"""A problem: one of the classes of :mod:`mechsynth.kinds`, or the JSON object that a client would post."""


class InvalidProblem(ValueError):
    """An invalid or contradictory problem.

    ``errors`` maps JSON pointers relative to the problem, such as ``/positions/1/x``, to messages.
    """

    def __init__(self, errors: Mapping[str, str]) -> None:
        self.errors = dict(errors)
        super().__init__("\n".join(f"{path or '/'}: {detail}" for path, detail in self.errors.items()))


def build_statement(problem: Problem) -> JsonObject:
    """Return a problem as a JSON object."""
    if isinstance(problem, ProblemBase):
        # `kind` is a default of its class and would be left out with the other unset fields.
        return {**json.loads(problem.model_dump_json(exclude_unset=True)), "kind": problem.kind}
    return dict(problem)


def check_problem(problem: Problem) -> ProblemBase:
    """Validate a problem and return it as a model.

    Raises
    ------
    InvalidProblem
        With the faults that a service would report.
    """
    statement = build_statement(problem)
    kind = statement.get("kind")
    if kind not in KINDS:
        raise InvalidProblem({"/kind": explain_kind(kind, KINDS)})
    read, faults = check_fields(kind, statement)
    # Only valid fields can be checked for contradictions.
    faults = faults or check_consistency(read)
    if faults:
        raise InvalidProblem(_merge_by_path(faults))
    return cast(ProblemBase, read)


def _merge_by_path(faults: Faults) -> dict[str, str]:
    errors: dict[str, str] = {}
    for path, detail in faults:
        # One field may contradict several others.
        errors[path] = join_messages([errors[path], detail]) if path in errors else detail
    return errors
