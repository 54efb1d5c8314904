"""How near a fitted linkage comes to what it is to draw, at the points and between them, and the order that follows."""

from __future__ import annotations

import math
from collections.abc import Callable

from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.outcome.ranking import ranked

EQUALLY_NEAR, NEARER, ERROR_TOLERANCE = 1.1, 1.001, 1e-9
"""Errors within these factors are alike, and quality decides: where the best design is asked for, and where the most
accurate is. Errors below the last, a share of the points' size, are rounding."""

NEAREST_SHARE = 0.4
"""A linkage stays in the running while its error is below the best one's over this; demands may choose among them."""

FAR = "far_from_the_curve"
"""Reason of sound linkages that are not offered, as nearer ones are."""

TWICE = 2.0
"""Designs whose error is within this factor of the least are traded for what a designer looks at."""

SOUND, USABLE, MOST_UNEVEN = 30.0, 20.0, 10.0
"""Transmission angles, degrees, of a sound linkage and of one that can still be used, and the greatest link ratio of
either: where no such limits are stated, linkages that keep them stand first."""

STEP_ROUNDING = 1e-6
"""Share of a step of nearness that is rounding."""


def error_of(design: PathDesign, problem: PathProblem) -> float:
    """How far a design is from the curve: its rms distance from the points, and how far it goes astray between them."""
    return max(
        ERROR_TOLERANCE * problem.task_size, math.hypot(design.metrics.rms_distance, design.metrics.excursion or 0.0)
    )


def least_error(designs: list[PathDesign], problem: PathProblem) -> float:
    """The error of the nearest design; infinite where there is none."""
    return min((error_of(design, problem) for design in designs), default=math.inf)


def near_the_nearest(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Designs whose error is not beyond the least one over :data:`NEAREST_SHARE`."""
    least = least_error(designs, problem)
    return [design for design in designs if error_of(design, problem) <= least / NEAREST_SHARE]


def steady(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Designs without those that owe to an excursion that they are not near the nearest: good at the points alone."""
    least = least_error(designs, problem)
    return [
        design
        for design in designs
        if error_of(design, problem) <= least / NEAREST_SHARE
        or (design.metrics.excursion or 0.0) <= design.metrics.rms_distance
    ]


def ranked_by_nearness(designs: list[PathDesign], problem: PathProblem) -> list[PathDesign]:
    """Designs in the order asked for: the nearest first, and among those equally near by quality.

    For whole curves without a demanded transmission angle sound linkages stand before others, if their error is within
    twice the least, and usable ones before the rest. Where size or transmission angle are asked for, these decide among
    designs within twice the least. Within tolerances all are near enough, and what is asked for decides alone.
    """
    if problem.tolerances is not None and problem.rank_by != "accuracy":
        return ranked(designs, problem.rank_by)
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

    nearest_first = sorted(designs, key=lambda design: error_of(design, problem))
    own = {"quality": nearness, "accuracy": nearness}
    return ranked(nearest_first, problem.rank_by, own, group=unusable if chooses_usable(problem) else None)


def meets_the_points(design: PathDesign) -> bool:
    """Whether a design was to meet its points exactly, and not to come near: it is measured at the points alone."""
    return design.metrics.curve_distance is None


def order_of(problem: PathProblem) -> Callable[[list[PathDesign]], list[PathDesign]]:
    """How designs are ordered: what meets the points exactly first, as all kinds are, then fits by nearness.

    Both are in one answer where several types of linkages are looked for: some can meet more points than others.
    Designs that break a check stand last.
    """

    def ordered(designs: list[PathDesign]) -> list[PathDesign]:
        exact = ranked([design for design in designs if meets_the_points(design)], problem.rank_by)
        fits = ranked_by_nearness([design for design in designs if not meets_the_points(design)], problem)
        return sorted([*exact, *fits], key=lambda design: not design.verification.passed)

    return ordered


_GRADES = 2


def chooses_usable(problem: PathProblem) -> bool:
    """Whether linkages that can be used stand before nearer ones that cannot."""
    free = problem.constraints.min_transmission_angle is None
    return problem.matched and problem.rank_by == "quality" and free


def grade(design: PathDesign) -> int:
    """0 for a sound linkage, 1 for one that can be used, 2 for others."""
    metrics = design.metrics
    if metrics.link_ratio > MOST_UNEVEN * (1.0 + STEP_ROUNDING) or metrics.min_transmission_angle < USABLE * (
        1.0 - STEP_ROUNDING
    ):
        return _GRADES
    return 0 if metrics.min_transmission_angle >= SOUND * (1.0 - STEP_ROUNDING) else 1


def choice(designs: list[PathDesign], problem: PathProblem) -> str:
    """What the first of designs in order gives up, as a sentence of the summary; empty where nothing.

    What it lacks is said of every kind alike: see :mod:`synthesis.outcome.usable`.
    """
    if not designs or not chooses_usable(problem):
        return ""
    first, nearest = designs[0], min(designs, key=lambda design: error_of(design, problem))
    if error_of(first, problem) <= EQUALLY_NEAR * error_of(nearest, problem):
        return ""
    chosen, other, unit = first.metrics, nearest.metrics, problem.length_unit
    return (
        f" It stands first for its transmission angle of {chosen.min_transmission_angle:.1f}°; the nearest, with an "
        f"rms distance of {other.rms_distance:.3g} {unit}, has {other.min_transmission_angle:.1f}° and a link ratio of "
        f"{other.link_ratio:.3g}."
    )
