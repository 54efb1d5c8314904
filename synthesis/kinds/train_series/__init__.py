"""Trains in series for a speed ratio: the output of one is the input of the next."""

from __future__ import annotations

from synthesis.kinds.train_series.design import TrainSeriesResult
from synthesis.kinds.train_series.gallery import GALLERY
from synthesis.kinds.train_series.problem import TrainSeriesProblem
from synthesis.model.kind import Kind, Progress

__all__ = ["KIND"]

MAX_BRIEF_SERIES = 5_000_000
"""Number of series of trains that are searched in a fraction of a second."""


def _solve(problem: TrainSeriesProblem, progress: Progress) -> TrainSeriesResult:
    from synthesis.kinds.train_series.solver import solve_train_series

    return solve_train_series(problem, progress)


def _is_brief(problem: TrainSeriesProblem) -> bool:
    """Return whether the search is instant: the series are few."""
    return problem.combinations <= MAX_BRIEF_SERIES


KIND = Kind("train_series", TrainSeriesProblem, TrainSeriesResult, _solve, brief=_is_brief, gallery=GALLERY)
