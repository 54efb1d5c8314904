"""Parallel motion: a link that a sixbar carries along a coupler curve without turning it."""

from __future__ import annotations

from synthesis.kinds.parallel_motion.design import ParallelMotionResult
from synthesis.kinds.parallel_motion.gallery import GALLERY
from synthesis.kinds.parallel_motion.problem import ParallelMotionProblem
from synthesis.model.kind import Kind, Progress, return_true

__all__ = ["KIND"]


def _solve(problem: ParallelMotionProblem, progress: Progress) -> ParallelMotionResult:
    from synthesis.kinds.parallel_motion.solver import solve_parallel_motion

    return solve_parallel_motion(problem, progress)


def _warm_up() -> None:
    from synthesis.kinds.parallel_motion.solver import warm_up

    warm_up()


KIND = Kind(
    "parallel_motion", ParallelMotionProblem, ParallelMotionResult, _solve, _warm_up, brief=return_true, gallery=GALLERY
)
