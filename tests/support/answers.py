"""Answers of solvers, shared by all tests of a session."""

from __future__ import annotations

from time import process_time
from typing import Any

from synthesis import dispatch
from synthesis.model.problem import ProblemBase
from tests.support import cpu_time

_answers: dict[str, tuple[Any, float]] = {}
"""Answers by their requests, with the CPU seconds that each took. Answers are frozen models."""


def solve(problem: ProblemBase) -> Any:
    """Return the answer to a problem, solved once in a session.

    A case is charged for every answer that it needs, whichever case came first: its mark `slow` does not depend on the
    order of the tests. Call `synthesis.dispatch.solve` to test that a repeated run gives the same answer.
    """
    key = f"{type(problem).__module__} {problem.model_dump_json()}"
    if key in _answers:
        answer, seconds = _answers[key]
        cpu_time.charge(seconds)
        return answer
    begun = process_time()
    answer = dispatch.solve(problem)
    _answers[key] = answer, process_time() - begun
    return answer
