"""The one door to every solver."""

from __future__ import annotations

from kinematics import linkage
from synthesis.designs import Result
from synthesis.motion.solver import Progress, solve_motion
from synthesis.problems import Problem, example, parse_problem

__all__ = ["Progress", "solve", "warm_up"]


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
    """Compile the kernels, or load them from their cache: the analysis core's, then by an example of each kind."""
    linkage.warm_up()
    solve(parse_problem(example("motion")), lambda fraction, message: None)
