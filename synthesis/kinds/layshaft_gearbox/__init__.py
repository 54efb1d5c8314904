"""Layshaft gearboxes of vehicles: tooth numbers for given gears with one tooth sum."""

from __future__ import annotations

from synthesis.kinds.layshaft_gearbox.design import LayshaftResult
from synthesis.kinds.layshaft_gearbox.gallery import GALLERY
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem
from synthesis.model.kind import Kind, Progress, RatioCheck, return_true

__all__ = ["KIND"]


def _solve(problem: LayshaftProblem, progress: Progress) -> LayshaftResult:
    from synthesis.kinds.layshaft_gearbox.solver import solve_layshaft_gearbox

    return solve_layshaft_gearbox(problem, progress)


KIND = Kind(
    "layshaft_gearbox",
    LayshaftProblem,
    LayshaftResult,
    _solve,
    brief=return_true,
    ratio_check=RatioCheck("ratios", "max_error"),
    gallery=GALLERY,
)
