"""Motion generation: carry a body through given positions."""

from __future__ import annotations

from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: MotionProblem, progress: Progress) -> MotionResult:
    from synthesis.kinds.motion.solver import solve_motion

    return solve_motion(problem, progress)


def _brief(problem: MotionProblem) -> bool:
    """Positions that are met exactly, by fourbars and without a driver, are not searched for by fits."""
    return not problem.approximate and problem.driver is None and problem.slider is None


KIND = Kind("motion", MotionProblem, MotionResult, _solve, brief=_brief)
