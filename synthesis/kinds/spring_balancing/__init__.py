"""Spring balancing: springs that minimize the drive against gravity and steady loads."""

from __future__ import annotations

from synthesis.kinds.spring_balancing.design import SpringBalancingResult
from synthesis.kinds.spring_balancing.gallery import GALLERY
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: SpringBalancingProblem, progress: Progress) -> SpringBalancingResult:
    from synthesis.kinds.spring_balancing.solver import solve_spring_balancing

    return solve_spring_balancing(problem, progress)


def _is_brief(problem: SpringBalancingProblem) -> bool:
    """Return whether the program is convex for all springs, so that no ends are searched."""
    return all(spring.convex for spring in problem.springs)


KIND = Kind("spring_balancing", SpringBalancingProblem, SpringBalancingResult, _solve, brief=_is_brief, gallery=GALLERY)
