"""The one door to every solver."""

from __future__ import annotations

from collections.abc import Callable

from synthesis.designs import Result
from synthesis.motion import solve_motion
from synthesis.problems import Problem, example, parse_problem

Progress = Callable[[float, str], None]
"""Called with the fraction done, 0 to 1, and a short message."""


def solve(problem: Problem, progress: Progress) -> Result:
    """Solve a problem and verify every design.

    Parameters
    ----------
    problem : Problem
        A statement without contradictions.
    progress : callable
        Told from time to time how far the work is.

    Raises
    ------
    ContradictionError
        Where ``problem.contradictions()`` is not empty.
    """
    problem.require_consistent()
    return solve_motion(problem, progress)


def warm_up() -> None:
    """Compile the kernels, or load them from their cache, by solving a small example of each kind."""
    solve(parse_problem(example("motion")), lambda fraction, message: None)
