"""Planetary trains for a speed ratio: every combination of tooth numbers, in exact integers."""

from __future__ import annotations

from synthesis.kinds.planetary_train.design import PlanetaryResult
from synthesis.kinds.planetary_train.gallery import GALLERY
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.model.kind import Kind, Progress, RatioCheck, return_true

__all__ = ["KIND"]


def _solve(problem: PlanetaryProblem, progress: Progress) -> PlanetaryResult:
    from synthesis.kinds.planetary_train.solver import solve_planetary_train

    return solve_planetary_train(problem, progress)


KIND = Kind(
    "planetary_train",
    PlanetaryProblem,
    PlanetaryResult,
    _solve,
    brief=return_true,
    ratio_check=RatioCheck("ratio", "error"),
    gallery=GALLERY,
)
