"""Answers of solvers, shared by all tests of a session."""

from __future__ import annotations

from hashlib import sha256
from time import process_time
from typing import Any

from synthesis import dispatch
from synthesis.model.problem import ProblemBase
from tests.support import cpu_time
from tests.support.session_folder import keep_pickle, read_pickle

_answers: dict[str, tuple[Any, float]] = {}
"""Answers by their requests, with the CPU seconds that each took. Answers are frozen models."""

MIN_SHARED_S = 0.1
"""CPU time from which an answer is kept for the other process of the session; to read one takes a hundredth of it."""


def solve(problem: ProblemBase) -> Any:
    """Return the answer to a problem, solved once in a session.

    A case is charged for every answer that it needs, whichever case came first: its mark `slow` does not depend on the
    order of the tests. Call `synthesis.dispatch.solve` to test that a repeated run gives the same answer.
    """
    key = f"{type(problem).__module__} {problem.model_dump_json()}"
    name = sha256(key.encode()).hexdigest()
    if key not in _answers and (kept := read_pickle(name)) is not None:
        _answers[key] = kept
    if key in _answers:
        answer, seconds = _answers[key]
        cpu_time.charge(seconds)
        return answer
    begun = process_time()
    answer = dispatch.solve(problem)
    seconds = process_time() - begun
    _answers[key] = answer, seconds
    if seconds >= MIN_SHARED_S:
        keep_pickle(name, _answers[key])
    return answer
