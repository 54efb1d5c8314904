"""Cams: the best motion program for a criterion, the smallest cam that follows it, and the verification of both."""

from __future__ import annotations

from synthesis.kinds.cam.design import CamResult
from synthesis.kinds.cam.gallery import GALLERY
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.statement.segments import Move
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: CamProblem, progress: Progress) -> CamResult:
    from synthesis.kinds.cam.solver import solve_cam

    return solve_cam(problem, progress)


def _warm_up() -> None:
    """Load the kernels and the convex optimizer by the first two examples: given laws, and an optimal motion."""
    for example in KIND.examples[:2]:
        _solve(CamProblem.model_validate(example), lambda fraction, message: None)


def _is_brief(problem: CamProblem) -> bool:
    """Return whether every law is given: the motion is then only drawn and measured, not optimized."""
    return not any(isinstance(segment, Move) and segment.law in ("auto", "optimal") for segment in problem.segments)


KIND = Kind("cam", CamProblem, CamResult, _solve, _warm_up, brief=_is_brief, gallery=GALLERY)
