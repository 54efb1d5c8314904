"""Balancing: corrections of rotors, and counterweights of linkages."""

from __future__ import annotations

from synthesis.kinds.balancing.design import BalancingResult
from synthesis.kinds.balancing.gallery import GALLERY
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: BalancingProblem, progress: Progress) -> BalancingResult:
    from synthesis.kinds.balancing.solver import solve_balancing

    return solve_balancing(problem, progress)


def _is_brief(problem: BalancingProblem) -> bool:
    """Return whether the answer is instant: only a choice among holes or stock weights needs a search."""
    correction = problem.correction
    return correction is None or (correction.holes is None and correction.stock is None)


KIND = Kind("balancing", BalancingProblem, BalancingResult, _solve, brief=_is_brief, gallery=GALLERY)
