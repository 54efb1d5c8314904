"""Ranking of fitted linkages by their distance from the target, at the points and between them."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.results.ranking import rank_designs, sort_designs

EQUAL_ERROR_RATIO, ACCURATE_ERROR_RATIO, ERROR_TOLERANCE = 1.1, 1.001, 1e-9
"""Factors within which errors count as equal, so that quality decides: in the default order, and in the order by
accuracy. The last value is the error, as a share of the points' size, that counts as rounding."""

MIN_NEAREST_SHARE = 0.4
"""Minimum ratio of the smallest error to that of a linkage which remains a candidate; constraints decide among these.
"""

FAR_REASON = "far_from_the_curve"
"""Reason for rejecting sound linkages that are dropped because nearer ones exist."""

TRADE_ERROR_RATIO = 2.0
"""Designs whose error is within this factor of the minimum may be ranked by other criteria."""

STEP_ROUNDING = 1e-6
"""Allowance for rounding, as a share of the width of an error class."""


def compute_error(design: PathDesign, problem: PathProblem) -> float:
    """Return a design's error in length units: its RMS distance from the points and its excursion between them."""
    return max(
        ERROR_TOLERANCE * problem.task_size, math.hypot(design.metrics.rms_distance, design.metrics.excursion or 0.0)
    )


def find_min_error(designs: list[PathDesign], problem: PathProblem) -> float:
    """Return the minimum error of the designs; infinite if there are none."""
    return min((compute_error(design, problem) for design in designs), default=math.inf)


def select_near(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Return the designs whose error is at most the minimum over :data:`MIN_NEAREST_SHARE`."""
    least = find_min_error(designs, problem)
    return [design for design in designs if compute_error(design, problem) <= least / MIN_NEAREST_SHARE]


def drop_straying(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Drop the designs that are near at the points but whose excursion between them makes their error large."""
    least = find_min_error(designs, problem)
    return [
        design
        for design in designs
        if compute_error(design, problem) <= least / MIN_NEAREST_SHARE
        or (design.metrics.excursion or 0.0) <= design.metrics.rms_distance
    ]


def rank_by_nearness(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Rank designs in the requested order: the nearest first, and by quality among those equally near.

    Practicality is compared with nearness in :mod:`synthesis.results.practicality`, as for all kinds. If size or
    transmission angle is requested, it decides among designs within twice the minimum. Within tolerances all are near
    enough, and the requested criterion decides alone.
    """
    # Within tolerances the error does not matter unless it is requested.
    if problem.tolerances is not None and problem.rank_by != "accuracy":
        return rank_designs(designs, problem.rank_by)
    # Errors are sorted into logarithmic classes; within a class the other criteria decide.
    factor = math.log(ACCURATE_ERROR_RATIO if problem.rank_by == "accuracy" else EQUAL_ERROR_RATIO)
    least = find_min_error(designs, problem)

    def classify_error(design: PathDesign) -> int:
        return math.floor(math.log(compute_error(design, problem) / least) / factor + STEP_ROUNDING)

    def is_far(design: PathDesign) -> bool:
        return compute_error(design, problem) > TRADE_ERROR_RATIO * least

    if problem.rank_by in ("size", "transmission_angle"):
        return rank_designs(designs, problem.rank_by, group=is_far)

    # Ranking is stable: equal classes and qualities stay in the order of their errors.
    nearest_first = sort_designs(designs, partial(compute_error, problem=problem))
    own = {"quality": classify_error, "accuracy": classify_error}
    return rank_designs(nearest_first, problem.rank_by, own)


def is_exact(design: PathDesign) -> bool:
    """Return whether a design was meant to meet its points exactly: such a design is measured at the points alone."""
    return design.metrics.curve_distance is None


def build_ordering(problem: PathProblem) -> Callable[[list[PathDesign]], list[PathDesign]]:
    """Return the ordering of designs: exact designs first, ranked like those of all kinds, then fits by nearness.

    Both kinds are in one result if several types of linkages are searched: some can meet more points than others.
    Designs that fail a check come last.
    """

    def sort_exact_first(designs: list[PathDesign]) -> list[PathDesign]:
        exact = rank_designs([design for design in designs if is_exact(design)], problem.rank_by)
        fits = rank_by_nearness([design for design in designs if not is_exact(design)], problem)
        return sort_designs([*exact, *fits])

    return sort_exact_first
