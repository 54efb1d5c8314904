"""The smallest drive: every wall and the pin force grow kinder with the size, so that the largest least size is it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import cast

from kinematics.indexing.drag_link import Course
from kinematics.indexing.geneva import Geneva
from synthesis.kinds.indexing import plane, sphere
from synthesis.kinds.indexing.design import SizedBy
from synthesis.kinds.indexing.forces import Load, peaks
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.model.statement import ABSURD

HALVINGS = 70
"""Of an interval that is a thousand times as wide as the least size: to rounding."""


def smallest(problem: IndexingProblem, course: Course, load: Load) -> tuple[float, SizedBy] | None:
    """The least center distance or sphere radius, and the demand that sets it; None where none up to 1e9 will do."""
    drive = course.geneva
    least: dict[str, float] = {}
    for name in _margins(problem, drive, ABSURD):
        found = least_size(partial(_margin, problem, drive, name), problem.roller)
        if found is None:
            return None
        least[name] = found
    limit = problem.constraints.pin_force
    if limit is not None:
        # At steady speed the force falls as the size grows.
        least["pin_force"] = peaks(course, load, problem.scale).pin_force / limit
    setting = max(least, key=lambda name: least[name])
    return least[setting], cast(SizedBy, setting)


def _margins(problem: IndexingProblem, drive: Geneva, size: float) -> dict[str, float]:
    return sphere.margins(problem, size) if problem.spherical else plane.margins(problem, drive, size)


def _margin(problem: IndexingProblem, drive: Geneva, name: str, size: float) -> float:
    return _margins(problem, drive, size)[name]


def least_size(margin: Callable[[float], float], first: float) -> float | None:
    """The least size with a positive margin, which grows with the size, by halving; None where none up to 1e9 has one.

    Parameters
    ----------
    margin : callable
        Of a size; not a number where it is too small to have one.
    first : float
        A size to begin with.
    """
    kept = low = first
    while not margin(kept) > 0.0:
        low, kept = kept, 2.0 * kept
        if kept > ABSURD:
            return None
    if kept == low:
        low = 0.5 * kept
    for _ in range(HALVINGS):
        middle = 0.5 * (low + kept)
        if margin(middle) > 0.0:
            kept = middle
        else:
            low = middle
    return kept
