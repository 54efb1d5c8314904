"""Steering: linkages and gears between two stub axles."""

from __future__ import annotations

from synthesis.kinds.steering.design import SteeringResult
from synthesis.kinds.steering.gallery import GALLERY
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: SteeringProblem, progress: Progress) -> SteeringResult:
    from synthesis.kinds.steering.solver import solve_steering

    return solve_steering(problem, progress)


KIND = Kind("steering", SteeringProblem, SteeringResult, _solve, gallery=GALLERY)
