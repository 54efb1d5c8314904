"""Answers of solvers, shared by all tests of a session and by the workers of their lean servers."""

from __future__ import annotations

import os
from hashlib import sha256
from pathlib import Path
from time import process_time
from typing import Any

from kinematics.message import compose
from synthesis import dispatch
from synthesis.model.kind import Progress
from synthesis.model.problem import ProblemBase
from tests.support import cpu_time
from tests.support.session_folder import keep_pickle, read_pickle

ANEW = "solve-anew"
"""File in the folder of a lean server; while it exists, the workers of the server solve every problem themselves."""

_solve = dispatch.solve

_answers: dict[str, tuple[Any, float]] = {}
"""Answers by their requests, with the CPU seconds that each took. Answers are frozen models."""

MIN_SHARED_S = 0.1
"""CPU time from which an answer is kept for the other processes of the session; to read one takes a hundredth of it."""


def solve(problem: ProblemBase) -> Any:
    """Return the answer to a problem, solved once in a session.

    A case is charged for every answer that it needs, whichever case came first: its mark `slow` does not depend on the
    order of the tests. Call `synthesis.dispatch.solve` to test that a repeated run gives the same answer.
    """
    answer, seconds, is_known = _find_or_solve(problem, None)
    if is_known:
        cpu_time.charge(seconds)
    return answer


def share_with_worker(folder: Path) -> None:
    """Let this worker of the server in `folder` take answers from the session, and keep its own for others."""

    def solve_once(problem: ProblemBase, progress: Progress | None = None) -> Any:
        if (folder / ANEW).exists():
            return _solve(problem, progress)
        answer, seconds, is_known = _find_or_solve(problem, progress)
        if is_known:
            cpu_time.charge_server(os.getppid(), seconds)
            if progress is not None:
                progress(1.0, compose("results-verified"))
        return answer

    dispatch.solve = solve_once


def _find_or_solve(problem: ProblemBase, progress: Progress | None) -> tuple[Any, float, bool]:
    """Return an answer, the CPU seconds that it took, and whether it was known."""
    key = f"{type(problem).__module__} {problem.model_dump_json()}"
    name = sha256(key.encode()).hexdigest()
    if key not in _answers and (kept := read_pickle(name)) is not None:
        _answers[key] = kept
    if key in _answers:
        return *_answers[key], True
    begun = process_time()
    answer = _solve(problem, progress)
    seconds = process_time() - begun
    _answers[key] = answer, seconds
    if seconds >= MIN_SHARED_S:
        keep_pickle(name, _answers[key])
    return answer, seconds, False
