"""Quick return: mechanisms with a given time ratio."""

from __future__ import annotations

from synthesis.kinds.quick_return.design import QuickReturnResult
from synthesis.kinds.quick_return.gallery import GALLERY
from synthesis.kinds.quick_return.problem import QuickReturnProblem
from synthesis.model.kind import Kind, Progress, return_true

__all__ = ["KIND"]


def _solve(problem: QuickReturnProblem, progress: Progress) -> QuickReturnResult:
    from synthesis.kinds.quick_return.solver import solve_quick_return

    return solve_quick_return(problem, progress)


KIND = Kind("quick_return", QuickReturnProblem, QuickReturnResult, _solve, brief=return_true, gallery=GALLERY)
