"""The smallest drive: every wall and the pin force grow kinder with the size, so that the largest least size is it.

So does what is measured on outlines alone: beside a clearance that stays, a larger wheel has less play and is held for
longer. Where the smallest drive by its walls breaks one of these, the size is found at which it no longer does.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import cast

from kinematics.indexing.drag_link import Course
from kinematics.indexing.geneva import Geneva
from synthesis.kinds.indexing import plane, sphere
from synthesis.kinds.indexing.design import IndexingDesign, SizedBy
from synthesis.kinds.indexing.forces import Load, peaks
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.model.statement import ABSURD

HALVINGS = 70
"""Of an interval that is a thousand times as wide as the least size: to rounding."""


OUTGROWN: dict[str, SizedBy] = {
    "play": "play",
    "locked_at_rest": "locked_rest",
    "roller_clears_wheel": "passing_roller",
}
"""Checks on outlines that a larger drive may keep, and what they are called as demands that set a size."""

LARGEST, GROWN_TO = 256.0, 1e-6
"""Times the least size by walls up to which a drive is made larger for these; and the share to which that is known."""


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


def outgrown(
    least: tuple[float, SizedBy], of_size: Callable[[float, SizedBy], IndexingDesign | str]
) -> IndexingDesign | str:
    """The smallest verified drive whose wheel is held and passed as is demanded.

    Parameters
    ----------
    least : (float, str)
        The least size by walls and force, and what sets it.
    of_size : callable
        The verified drive of a size, and of what is told to set it.

    Returns
    -------
    IndexingDesign or str
        That of the least size where it has nothing else to complain of, or where no size up to ``LARGEST`` times as
        large mends it.
    """
    design = of_size(*least)
    lacking = _lacking(design)
    if not lacking:
        return design
    low = high = least[0]
    sized_by = least[1]
    while lacking:
        low, high, sized_by = high, 2.0 * high, OUTGROWN[lacking[0]]
        if high > LARGEST * least[0]:
            return design
        lacking = _lacking(of_size(high, sized_by))
        if lacking is None:
            return design
    while high - low > GROWN_TO * high:
        middle = 0.5 * (low + high)
        lacking = _lacking(of_size(middle, sized_by))
        if lacking == []:
            high = middle
        else:
            low, sized_by = middle, OUTGROWN[lacking[0]] if lacking else sized_by
    return of_size(high, sized_by)


def _lacking(design: IndexingDesign | str) -> list[str] | None:
    """The checks that a design breaks; None where there is none, or one that no larger drive keeps is among them."""
    if isinstance(design, str):
        return None
    broken = [check.name for check in design.verification.checks if not check.passed]
    return broken if set(broken) <= OUTGROWN.keys() else None


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
