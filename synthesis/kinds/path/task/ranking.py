"""Ranking of fitted linkages by their distance from the target, at the points and between them."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from kinematics.message import compose
from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.results.ranking import rank_designs, select_best, sort_designs

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

SOUND_ANGLE, USABLE_ANGLE, MAX_LINK_RATIO = 30.0, 20.0, 10.0
"""Minimum transmission angles, degrees, of a sound and of a usable linkage, and the maximum link ratio of both. If the
problem sets no such limits, linkages that satisfy these come first."""

STEP_ROUNDING = 1e-6
"""Allowance for rounding: a share of the width of an error class, and relative to the limits of usability."""


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

    For whole curves without a required transmission angle, sound linkages come before others if their error is within
    twice the minimum, and usable ones before the rest. If size or transmission angle is requested, it decides among
    designs within twice the minimum. Within tolerances all are near enough, and the requested criterion decides alone.
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

    def rank_usability(design: PathDesign) -> int:
        return _GRADE_COUNT if is_far(design) else classify_usability(design)

    # Ranking is stable: equal grades and classes stay in the order of their errors.
    nearest_first = sort_designs(designs, partial(compute_error, problem=problem))
    own = {"quality": classify_error, "accuracy": classify_error}
    return rank_designs(
        nearest_first, problem.rank_by, own, group=rank_usability if is_usable_preferred(problem) else None
    )


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


_GRADE_COUNT = 2


def is_usable_preferred(problem: PathProblem) -> bool:
    """Return whether usable linkages come before nearer ones that are not usable."""
    free = problem.constraints.min_transmission_angle is None
    return problem.is_matched and problem.rank_by == "quality" and free


def classify_usability(design: PathDesign) -> int:
    """Return 0 for a sound linkage, 1 for a usable one, 2 for others."""
    metrics = design.metrics
    if metrics.link_ratio > MAX_LINK_RATIO * (1.0 + STEP_ROUNDING) or metrics.min_transmission_angle < USABLE_ANGLE * (
        1.0 - STEP_ROUNDING
    ):
        return _GRADE_COUNT
    return 0 if metrics.min_transmission_angle >= SOUND_ANGLE * (1.0 - STEP_ROUNDING) else 1


def explain_choice(designs: list[PathDesign], problem: PathProblem) -> str:
    """Explain in a sentence why the first design is not the nearest one; empty if they are equally near.

    Other defects of the design are described in the same way for all kinds: see
    :mod:`synthesis.results.practicality`.
    """
    if not designs or not is_usable_preferred(problem):
        return ""
    first, nearest = designs[0], select_best(designs, partial(compute_error, problem=problem))
    # The first is practically the nearest: there is nothing to explain.
    if compute_error(first, problem) <= EQUAL_ERROR_RATIO * compute_error(nearest, problem):
        return ""
    chosen, other = first.metrics, nearest.metrics
    return compose(
        "path-first-for-transmission",
        transmission_angle=f"{chosen.min_transmission_angle:.1f}",
        rms_distance=f"{other.rms_distance:.3g}",
        unit=problem.length_unit,
        nearest_angle=f"{other.min_transmission_angle:.1f}",
        link_ratio=f"{other.link_ratio:.3g}",
    )
