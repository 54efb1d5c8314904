"""Function generation: precision points, least squares and minimax."""

from __future__ import annotations

from synthesis.kinds.function.design import FunctionDesign, FunctionMechanism, FunctionResult
from synthesis.kinds.function.gallery import GALLERY
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    from synthesis.kinds.function.solver import solve_function

    return solve_function(problem, progress)


def _nearly(problem: FunctionProblem, design: FunctionDesign, mechanism: FunctionMechanism) -> FunctionDesign | None:
    from synthesis.kinds.function.verification import verify_nearly

    return verify_nearly(problem, design, mechanism)


def _warm_up() -> None:
    from synthesis.kinds.function.solver import warm_up

    warm_up()


def _brief(problem: FunctionProblem) -> bool:
    """Return whether a job is short: precision points on fourbars are solved directly, everything else by search."""
    return problem.aim == "precision" and not problem.sixbars


KIND = Kind(
    "function", FunctionProblem, FunctionResult, _solve, _warm_up, brief=_brief, nearly=_nearly, gallery=GALLERY
)
