"""Balancing: corrections of rotors."""

from __future__ import annotations

from synthesis.kinds.balancing.design import BalancingResult
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.model.kind import Kind, Progress, always

__all__ = ["KIND"]


def _solve(problem: BalancingProblem, progress: Progress) -> BalancingResult:
    from synthesis.kinds.balancing.solver import solve_balancing

    return solve_balancing(problem, progress)


KIND = Kind("balancing", BalancingProblem, BalancingResult, _solve, brief=always)
