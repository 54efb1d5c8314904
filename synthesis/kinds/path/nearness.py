"""Measure how near a fitted linkage is to its target, at the points and between them, and rank linkages by it."""

from __future__ import annotations

import math
from collections.abc import Callable

from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.outcome.ranking import ranked

EQUALLY_NEAR, NEARER, ERROR_TOLERANCE = 1.1, 1.001, 1e-9
"""Errors within these factors count as equal, and quality decides: for the best design, and for the most accurate one.
Errors below the last value, a share of the points' size, are rounding."""

NEAREST_SHARE = 0.4
"""A linkage stays a candidate while its error is at most the minimum error over this; constraints may choose among
them."""

FAR = "far_from_the_curve"
"""Reason for rejecting sound linkages that are dropped because nearer ones exist."""

TWICE = 2.0
"""Designs whose error is within this factor of the minimum may be ranked by other criteria."""

SOUND, USABLE, MOST_UNEVEN = 30.0, 20.0, 10.0
"""Transmission angles, degrees, of a sound linkage and of a usable one, and the maximum link ratio of either: without
such limits in the problem, linkages that satisfy them come first."""

STEP_ROUNDING = 1e-6
"""Share of a step of nearness that is rounding."""


def error_of(design: PathDesign, problem: PathProblem) -> float:
    """Return a design's error: its rms distance from the points combined with its excursion between them, length
    units."""
    return max(
        ERROR_TOLERANCE * problem.task_size, math.hypot(design.metrics.rms_distance, design.metrics.excursion or 0.0)
    )


def least_error(designs: list[PathDesign], problem: PathProblem) -> float:
    """Return the minimum error of the designs; infinite if there are none."""
    return min((error_of(design, problem) for design in designs), default=math.inf)


def near_the_nearest(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Return the designs whose error is at most the minimum over :data:`NEAREST_SHARE`."""
    least = least_error(designs, problem)
    return [design for design in designs if error_of(design, problem) <= least / NEAREST_SHARE]


def steady(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Drop the designs that are far from the nearest because of an excursion: those good at the points alone."""
    least = least_error(designs, problem)
    return [
        design
        for design in designs
        if error_of(design, problem) <= least / NEAREST_SHARE
        or (design.metrics.excursion or 0.0) <= design.metrics.rms_distance
    ]


def ranked_by_nearness(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Rank designs in the requested order: the nearest first, and by quality among those equally near.

    For whole curves without a required transmission angle, sound linkages come before others if their error is within
    twice the minimum, and usable ones before the rest. If size or transmission angle is requested, it decides among
    designs within twice the minimum. Within tolerances all are near enough, and the requested criterion decides alone.
    """
    # Within tolerances the error does not matter unless it is requested.
    if problem.tolerances is not None and problem.rank_by != "accuracy":
        return ranked(designs, problem.rank_by)
    # Errors are sorted into logarithmic classes; within a class the other criteria decide.
    factor = math.log(NEARER if problem.rank_by == "accuracy" else EQUALLY_NEAR)
    least = least_error(designs, problem)

    def nearness(design: PathDesign) -> int:
        return math.floor(math.log(error_of(design, problem) / least) / factor + STEP_ROUNDING)

    def far(design: PathDesign) -> bool:
        return error_of(design, problem) > TWICE * least

    if problem.rank_by in ("size", "transmission_angle"):
        return ranked(designs, problem.rank_by, group=far)

    def unusable(design: PathDesign) -> int:
        return _GRADES if far(design) else grade(design)

    # Ranking is stable: equal grades and classes stay in the order of their errors.
    nearest_first = sorted(designs, key=lambda design: error_of(design, problem))
    own = {"quality": nearness, "accuracy": nearness}
    return ranked(nearest_first, problem.rank_by, own, group=unusable if chooses_usable(problem) else None)


def meets_the_points(design: PathDesign) -> bool:
    """Return whether a design was meant to meet its points exactly: such a design is measured at the points alone."""
    return design.metrics.curve_distance is None


def order_of(problem: PathProblem) -> Callable[[list[PathDesign]], list[PathDesign]]:
    """Return the ordering of designs: exact designs first, ranked like those of all kinds, then fits by nearness.

    Both kinds are in one result if several types of linkages are searched: some can meet more points than others.
    Designs that fail a check come last.
    """

    def ordered(designs: list[PathDesign]) -> list[PathDesign]:
        exact = ranked([design for design in designs if meets_the_points(design)], problem.rank_by)
        fits = ranked_by_nearness([design for design in designs if not meets_the_points(design)], problem)
        return sorted([*exact, *fits], key=lambda design: not design.verification.passed)

    return ordered


_GRADES = 2


def chooses_usable(problem: PathProblem) -> bool:
    """Return whether usable linkages come before nearer ones that are not usable."""
    free = problem.constraints.min_transmission_angle is None
    return problem.matched and problem.rank_by == "quality" and free


def grade(design: PathDesign) -> int:
    """Return 0 for a sound linkage, 1 for a usable one, 2 for others."""
    metrics = design.metrics
    if metrics.link_ratio > MOST_UNEVEN * (1.0 + STEP_ROUNDING) or metrics.min_transmission_angle < USABLE * (
        1.0 - STEP_ROUNDING
    ):
        return _GRADES
    return 0 if metrics.min_transmission_angle >= SOUND * (1.0 - STEP_ROUNDING) else 1


def choice(designs: list[PathDesign], problem: PathProblem) -> str:
    """Explain in a sentence what the first of the ordered designs gives up; empty if nothing.

    Its defects are described for all kinds alike: see :mod:`synthesis.outcome.usable`.
    """
    if not designs or not chooses_usable(problem):
        return ""
    first, nearest = designs[0], min(designs, key=lambda design: error_of(design, problem))
    # The first is practically the nearest: there is nothing to explain.
    if error_of(first, problem) <= EQUALLY_NEAR * error_of(nearest, problem):
        return ""
    chosen, other, unit = first.metrics, nearest.metrics, problem.length_unit
    return (
        f" It comes first because of its transmission angle of {chosen.min_transmission_angle:.1f}°. The nearest "
        f"design, with an rms distance of {other.rms_distance:.3g} {unit}, has only "
        f"{other.min_transmission_angle:.1f}° and a link ratio of {other.link_ratio:.3g}."
    )
