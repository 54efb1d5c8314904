"""Indexing drives: Geneva drives and ratchets, sized, drawn, and verified by driving their geometry."""

from __future__ import annotations

from synthesis.kinds.indexing.design import IndexingResult
from synthesis.kinds.indexing.gallery import GALLERY
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]


def _solve(problem: IndexingProblem, progress: Progress) -> IndexingResult:
    from synthesis.kinds.indexing.solver import solve_indexing

    return solve_indexing(problem, progress)


def _is_brief(problem: IndexingProblem) -> bool:
    """Return whether the answer is in closed form: all drives except those with drag links."""
    return problem.driver == "crank"


KIND = Kind("indexing", IndexingProblem, IndexingResult, _solve, brief=_is_brief, gallery=GALLERY)
