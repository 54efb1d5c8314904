"""Ordinary gear trains for a speed ratio: exhaustive search in exact arithmetic."""

from __future__ import annotations

from synthesis.kinds.gear_train.design import GearTrainResult
from synthesis.kinds.gear_train.gallery import GALLERY
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.model.kind import Kind, Progress, RatioCheck

__all__ = ["KIND"]


def _solve(problem: GearTrainProblem, progress: Progress) -> GearTrainResult:
    from synthesis.kinds.gear_train.solver import solve_gear_train

    return solve_gear_train(problem, progress)


def _is_brief(problem: GearTrainProblem) -> bool:
    """Return whether the search is instant: at most two stages, without a stock and without a strength."""
    return problem.most_stages <= 2 and problem.stock is None and problem.strength is None


KIND = Kind(
    "gear_train",
    GearTrainProblem,
    GearTrainResult,
    _solve,
    brief=_is_brief,
    ratio_check=RatioCheck("ratio_error", "relative_error"),
    gallery=GALLERY,
)
