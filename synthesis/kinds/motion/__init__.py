"""Motion generation: carry a body through given positions."""

from __future__ import annotations

from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: MotionProblem, progress: Progress) -> MotionResult:
    from synthesis.kinds.motion.solver import solve_motion

    return solve_motion(problem, progress)


KIND = Kind("motion", MotionProblem, MotionResult, _solve)
