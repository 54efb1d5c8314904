"""Function generation: precision points, least squares and minimax."""

from __future__ import annotations

from synthesis.kinds.function.design import FunctionDesign, FunctionMechanism, FunctionResult
from synthesis.kinds.function.gallery import GALLERY
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.model.json_object import JsonObject
from synthesis.model.kind import Kind, Progress, TableColumns

__all__ = ["KIND"]


def _solve(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    from synthesis.kinds.function.solver import solve_function

    return solve_function(problem, progress)


def _verify_with_tolerance(
    problem: FunctionProblem, design: FunctionDesign, mechanism: FunctionMechanism
) -> FunctionDesign | None:
    from synthesis.kinds.function.verification.verify import verify_with_tolerance

    return verify_with_tolerance(problem, design, mechanism)


def _warm_up() -> None:
    from synthesis.kinds.function.solver import warm_up

    warm_up()


def _list_warm_up_problems() -> list[JsonObject]:
    from synthesis.kinds.function.warm_up_problems import list_warm_up_problems

    return list_warm_up_problems()


def _is_short(problem: FunctionProblem) -> bool:
    """Return whether a job is short: precision points on fourbars are solved directly, everything else by search."""
    return problem.aim == "precision" and not (problem.sixbars or problem.has_eightbars)


KIND = Kind(
    "function",
    FunctionProblem,
    FunctionResult,
    _solve,
    _warm_up,
    brief=_is_short,
    nearly=_verify_with_tolerance,
    list_warm_up_problems=_list_warm_up_problems,
    columns=TableColumns("pairs", ("input", "output")),
    gallery=GALLERY,
)
