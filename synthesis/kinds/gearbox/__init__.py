"""Gearboxes of several speeds: structures, tooth numbers, and the proof that they are optimal."""

from __future__ import annotations

from synthesis.kinds.gearbox.design import GearboxResult
from synthesis.kinds.gearbox.gallery import GALLERY
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.model.kind import Kind, Progress, RatioCheck, return_true

__all__ = ["KIND"]


def _solve(problem: GearboxProblem, progress: Progress) -> GearboxResult:
    from synthesis.kinds.gearbox.solver import solve_gearbox

    return solve_gearbox(problem, progress)


KIND = Kind(
    "gearbox",
    GearboxProblem,
    GearboxResult,
    _solve,
    brief=return_true,
    ratio_check=RatioCheck("speeds", "max_error"),
    gallery=GALLERY,
)
