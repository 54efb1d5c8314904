"""Piston engines: arrangements of cranks and cylinders, analysed or found, with firing orders and balancers."""

from __future__ import annotations

from synthesis.kinds.engine.design import EngineResult
from synthesis.kinds.engine.gallery import GALLERY
from synthesis.kinds.engine.problem import EngineProblem
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: EngineProblem, progress: Progress) -> EngineResult:
    from synthesis.kinds.engine.solver import solve_engine

    return solve_engine(problem, progress)


def _is_brief(problem: EngineProblem) -> bool:
    """Return whether the throws are given, so that the engine is only analysed."""
    return problem.layout.throws is not None


KIND = Kind("engine", EngineProblem, EngineResult, _solve, brief=_is_brief, gallery=GALLERY)
