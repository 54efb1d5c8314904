"""The smallest drive that keeps all constraints.

Every margin of walls and of the pin force grows with the size. Each constraint therefore has a minimum size, and the
largest of these is the answer. Measurements that are only possible on the outlines behave alike: with a constant
clearance, a larger wheel has less play and is held for longer. If the smallest drive by its walls fails one of these
checks, the smallest size that passes is searched.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import cast

from kinematics.indexing.drag_link import CrankCourse
from kinematics.indexing.geneva import Geneva
from synthesis.kinds.indexing import plane, sphere
from synthesis.kinds.indexing.design import IndexingDesign, SizedBy
from synthesis.kinds.indexing.forces import Load, find_peaks
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.model.problem import MAX_MAGNITUDE

BISECTION_COUNT = 70
"""Number of bisections: enough to reach rounding from an interval a thousand times as wide as the minimum size."""


SIZE_DEPENDENT_CHECKS: dict[str, SizedBy] = {
    "play": "play",
    "locked_at_rest": "locked_rest",
    "roller_clears_wheel": "passing_roller",
}
"""Checks on outlines that a larger drive may pass, with their names as constraints that determine the size."""

MAX_GROWTH, SIZE_TOLERANCE = 256.0, 1e-6
"""Maximum enlargement over the minimum size by walls, and relative accuracy of the enlarged size."""


def find_smallest(problem: IndexingProblem, course: CrankCourse, load: Load) -> tuple[float, SizedBy] | None:
    """Find the minimum center distance or sphere radius, and the constraint that sets it; None if none up to 1e9."""
    drive = course.geneva
    least: dict[str, float] = {}
    for name in _compute_margins(problem, drive, MAX_MAGNITUDE):
        found = find_least_size(partial(_compute_margin, problem, drive, name), problem.roller)
        if found is None:
            return None
        least[name] = found
    limit = problem.constraints.pin_force
    if limit is not None:
        # At constant speed the force falls as the size grows.
        least["pin_force"] = find_peaks(course, load, problem.scale).pin_force / limit
    setting = max(least, key=lambda name: least[name])
    return least[setting], cast(SizedBy, setting)


def enlarge_until_verified(
    least: tuple[float, SizedBy], of_size: Callable[[float, SizedBy], IndexingDesign | str]
) -> IndexingDesign | str:
    """Find the smallest verified drive whose wheel is held and passed as required.

    Parameters
    ----------
    least : (float, str)
        The minimum size by walls and force, and the constraint that sets it.
    of_size : callable
        Returns the verified drive of a size, with the constraint that is reported to set it.

    Returns
    -------
    IndexingDesign or str
        The smallest drive that passes. The drive of minimum size if it fails another check as well, or if no size up to
        :data:`MAX_GROWTH` times as large helps.
    """
    design = of_size(*least)
    lacking = _list_failed_checks(design)
    if not lacking:
        return design
    low = high = least[0]
    sized_by = least[1]
    # Double the size until all checks pass, then bisect.
    while lacking:
        low, high, sized_by = high, 2.0 * high, SIZE_DEPENDENT_CHECKS[lacking[0]]
        if high > MAX_GROWTH * least[0]:
            return design
        lacking = _list_failed_checks(of_size(high, sized_by))
        if lacking is None:
            return design
    while high - low > SIZE_TOLERANCE * high:
        middle = 0.5 * (low + high)
        lacking = _list_failed_checks(of_size(middle, sized_by))
        if lacking == []:
            high = middle
        else:
            low, sized_by = middle, SIZE_DEPENDENT_CHECKS[lacking[0]] if lacking else sized_by
    return of_size(high, sized_by)


def _list_failed_checks(design: IndexingDesign | str) -> list[str] | None:
    """List the failed checks of a design; None if there is no design, or if size cannot repair one of them."""
    if isinstance(design, str):
        return None
    broken = [check.name for check in design.verification.checks if not check.passed]
    return broken if set(broken) <= SIZE_DEPENDENT_CHECKS.keys() else None


def _compute_margins(problem: IndexingProblem, drive: Geneva, size: float) -> dict[str, float]:
    return sphere.compute_margins(problem, size) if problem.spherical else plane.compute_margins(problem, drive, size)


def _compute_margin(problem: IndexingProblem, drive: Geneva, name: str, size: float) -> float:
    return _compute_margins(problem, drive, size)[name]


def find_least_size(margin: Callable[[float], float], first: float) -> float | None:
    """Find the minimum size with a positive margin, which grows with the size, by bisection; None if none up to 1e9.

    Parameters
    ----------
    margin : callable
        Margin of a size; NaN if the size is too small to have one.
    first : float
        Initial size.
    """
    # Double until the margin is positive, then bisect between the last two sizes.
    kept = low = first
    while not margin(kept) > 0.0:
        low, kept = kept, 2.0 * kept
        if kept > MAX_MAGNITUDE:
            return None
    if kept == low:
        low = 0.5 * kept
    for _ in range(BISECTION_COUNT):
        middle = 0.5 * (low + kept)
        if margin(middle) > 0.0:
            kept = middle
        else:
            low = middle
    return kept
