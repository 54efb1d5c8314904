"""Straight lines: linkages whose coupler point follows a straight line, approximately or exactly."""

from __future__ import annotations

from synthesis.kinds.straight_line.design import StraightLineResult
from synthesis.kinds.straight_line.gallery import GALLERY
from synthesis.kinds.straight_line.problem import StraightLineProblem
from synthesis.model.kind import Kind, Progress, return_true

__all__ = ["KIND"]


def _solve(problem: StraightLineProblem, progress: Progress) -> StraightLineResult:
    from synthesis.kinds.straight_line.solver import solve_straight_line

    return solve_straight_line(problem, progress)


def _warm_up() -> None:
    from synthesis.kinds.straight_line.solver import warm_up

    warm_up()


KIND = Kind(
    "straight_line", StraightLineProblem, StraightLineResult, _solve, _warm_up, brief=return_true, gallery=GALLERY
)
