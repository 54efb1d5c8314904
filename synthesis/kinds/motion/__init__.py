"""Motion generation: carry a body through given positions."""

from __future__ import annotations

from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: MotionProblem, progress: Progress) -> MotionResult:
    from synthesis.kinds.motion.solver import solve_motion

    return solve_motion(problem, progress)


def _warm_up() -> None:
    """Load the kernels of exact positions by the first examples; the fits share theirs with those of paths."""
    for example in KIND.examples[:4]:
        _solve(MotionProblem.model_validate(example), lambda fraction, message: None)


def _brief(problem: MotionProblem) -> bool:
    """Positions that are met exactly, by fourbars and without a driver, are not searched for by fits."""
    return not problem.approximate and problem.driver is None and problem.slider is None


KIND = Kind("motion", MotionProblem, MotionResult, _solve, _warm_up, brief=_brief)
