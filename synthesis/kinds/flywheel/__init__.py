"""Flywheels: the lightest disc or rim that keeps the speed of a shaft within a coefficient of fluctuation."""

from __future__ import annotations

from synthesis.kinds.flywheel.design import FlywheelResult
from synthesis.kinds.flywheel.gallery import GALLERY
from synthesis.kinds.flywheel.problem import FlywheelProblem
from synthesis.model.kind import Kind, Progress, return_true

__all__ = ["KIND"]


def _solve(problem: FlywheelProblem, progress: Progress) -> FlywheelResult:
    from synthesis.kinds.flywheel.solver import solve_flywheel

    return solve_flywheel(problem, progress)


KIND = Kind("flywheel", FlywheelProblem, FlywheelResult, _solve, brief=return_true, gallery=GALLERY)
