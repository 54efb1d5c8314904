"""Ranking of function generators: by the error of the criterion, with designs on the pairs' own scales first."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from synthesis.kinds.function.design import FunctionDesign
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.results.ranking import rank_designs


def get_error(problem: FunctionProblem, design: FunctionDesign) -> float:
    """Return the error by the problem's criterion, relative to the output's range if that is open."""
    error = design.structural_error.rms if problem.aim == "least_squares" else design.structural_error.max
    # With an open range a smaller output would otherwise always look more accurate.
    return error / abs(design.metrics.output_range) if problem.is_output_open else error


def rank_by_error(problem: FunctionProblem, designs: list[FunctionDesign]) -> list[FunctionDesign]:
    """Rank designs in the requested order; designs on the pairs' own scales come before rescaled ones."""
    approximates = problem.aim != "precision"
    error = partial(get_error, problem)
    own: dict[str, Callable[[FunctionDesign], float]] = {"accuracy": error}
    # Approximations have one purpose, so even the default order is by error.
    if approximates or problem.function is not None:
        own["quality"] = error
    if problem.pairs is not None and not approximates:
        own["accuracy"] = lambda design: 0.0  # all of them meet the pairs to rounding
    return rank_designs(designs, problem.rank_by, own, group=problem.classify_design)
