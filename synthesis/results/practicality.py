"""Order of the designs of an answer: first those that a shop can build, then the sound and near ones.

This is the only place that compares accuracy with practicality, for linkages of all kinds (docs/methods/ranking.md).
Practice requires a minimum transmission angle of 30 to 40 degrees and a link ratio of at most about ten (Norton,
*Design of Machinery*, Sec. 3.3 and 4.10). A link that is many times longer than the task rarely fits. A design that is
slightly more accurate but cannot be built is not a better answer, nor is one whose error is smaller than what a shop's
tolerances make of it.

Designs of equal grade are ordered by their merit

    merit = quality · √(e₀ / e) · √½ ^ (n − n₀)

with the error e, at least :data:`NEGLIGIBLE_ERROR`, the number n of loops (two links each), and the smallest values e₀
and n₀ of the designs: half the error and two links fewer are each worth √2 of the quality.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Generic, NamedTuple, TypeVar

from kinematics.message import compose, join_messages
from synthesis.model.linkage.answer import BuildMetrics, LinkageMetrics, MotionMetrics
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import Statement
from synthesis.model.protocols import DrivenDesign
from synthesis.results.buildability import MIN_RELATIVE_WIDTH, is_buildable
from synthesis.results.ranking import RESIDUAL_ROUNDING, sort_designs
from synthesis.verification.measures import compute_quality

Design = TypeVar("Design", bound=DrivenDesign)

MIN_TRANSMISSION_ANGLE = 30.0
"""Minimum transmission angle of a practical design, degrees."""

MIN_USABLE_ANGLE = 20.0
"""Minimum transmission angle of a design that is preferred to worse ones if none is practical, degrees."""

MAX_LINK_RATIO = 10.0
"""Maximum ratio of the longest link to the shortest in a practical design."""

MAX_REACH = 5.0
"""Maximum distance between two joints of one link in a practical design, in sizes of the task."""

JAMMING_ANGLE, EXTREME_LINK_RATIO = 5.0, 100.0
"""Transmission angle, degrees, below which friction jams a linkage, and link ratio above which it is impractical.
Without limits of the client such designs are listed last, in every order."""

CONSTRAINT_TOLERANCE = 1e-6
"""Relative tolerance for designs that a fit placed exactly at one of these limits."""

ERROR_BAND = 2.0
"""Errors up to this multiple of the smallest one make no practical difference."""

NEGLIGIBLE_ERROR = 2e-4
"""Error, as a share of the task's size or in radians, up to which errors are equal: 0.02 mm in 100 mm, and 0.011
degrees, are finer than the tolerances of usual links and pins."""

MIN_NEARER_RATIO = 1.1
"""Minimum ratio of the errors of all listed designs to a smaller one that is worth a place among them."""

NOTABLE_ERROR_RATIO = 1.2
"""Ratio of two errors above which the summary explains why the larger one comes first."""

_WORST_GRADE = 3
"""Grade of a design with an angle below the usable one, or an uneven link ratio."""


class OrderedDesigns(NamedTuple, Generic[Design]):
    """Sorted designs and remarks on their order.

    The remarks are empty if the first design is practical and the most accurate, no design has extra links worth a
    remark, and all can be built.
    """

    designs: list[Design]
    remark: str


def is_sound(design: DrivenDesign) -> bool:
    """Return whether a design transmits force well and has a moderate link ratio."""
    return _transmits(design, MIN_TRANSMISSION_ANGLE) and _has_moderate_ratio(design)


def is_practical(design: DrivenDesign) -> bool:
    """Return whether a design is practical: :func:`has_even_links`, and no link is far longer than the task."""
    metrics = design.metrics
    reach = metrics.reach if isinstance(metrics, MotionMetrics) else None
    return is_sound(design) and (reach is None or reach <= MAX_REACH * (1.0 + CONSTRAINT_TOLERANCE))


def grade_design(design: DrivenDesign) -> int:
    """Return 0 for a practical design, 1 if only a link is too long, 2 for at least a usable angle, 3 for others."""
    if is_sound(design):
        return 0 if is_practical(design) else 1
    return 2 if _transmits(design, MIN_USABLE_ANGLE) and _has_moderate_ratio(design) else _WORST_GRADE


def is_workable(problem: LinkageProblem, design: DrivenDesign) -> bool:
    """Return whether a measured design can be built and does not jam; limits of the client replace the usual ones."""
    given, metrics = problem.constraints, design.metrics
    jams = _is_default(given, "min_transmission_angle") and not _transmits(design, JAMMING_ANGLE)
    uneven = _is_default(given, "max_link_ratio") and metrics.link_ratio > EXTREME_LINK_RATIO * (
        1.0 + CONSTRAINT_TOLERANCE
    )
    return is_buildable(design) and not jams and not uneven


def is_judged(problem: LinkageProblem) -> bool:
    """Return whether practicality decides the order: the client gives neither an order nor limits of practicality."""
    limited = not all(_is_default(problem.constraints, name) for name in ("min_transmission_angle", "max_link_ratio"))
    return _is_default(problem, "rank_by") and not limited


def sort_by_practice(problem: LinkageProblem, designs: Sequence[Design]) -> list[Design]:
    """Return designs in order of practicality, and those that fail a check last.

    Designs that are not measured yet count as buildable; :func:`order_designs` sorts again.

    Parameters
    ----------
    problem : LinkageProblem
    designs : sequence
        Designs in the order of their kind, which is kept for equal ones and for those far from the task.
    """
    passed = [design for design in designs if design.verification.passed]
    if is_judged(problem):
        # Classes of the kind, such as linkages without a slide before others, are never mixed.
        classes = sorted({problem.classify_design(design) for design in passed})
        passed = [
            design
            for number in classes
            for design in _sort_class(problem, [one for one in passed if problem.classify_design(one) == number])
        ]
    # What leaves the task between its targets is no answer, however well it is built.
    passed = sort_designs(passed, problem.is_astray, lambda design: not is_workable(problem, design))
    return [*passed, *(design for design in designs if not design.verification.passed)]


def keep_nearest(designs: Sequence[Design], count: int) -> list[Design]:
    """Return the first designs, the last of them replaced by the nearest at the targets if all of them are farther.

    A client may want that one most, even if it cannot be built or strays between the targets.
    """
    shown, passed = list(designs[:count]), [design for design in designs if design.verification.passed]
    if count < 2 or len(passed) <= count:
        return shown
    nearest = min(passed, key=measure_target_error)
    least = max(measure_target_error(nearest), NEGLIGIBLE_ERROR)
    if min(map(measure_target_error, shown)) > MIN_NEARER_RATIO * least:
        shown[-1] = nearest
    return shown


def measure_target_error(design: DrivenDesign) -> float:
    """Return the error of a design at its targets alone, as a share of the task's size; 0 if it has no residuals."""
    metrics = design.metrics
    return metrics.rms_residual if isinstance(metrics, LinkageMetrics) else 0.0


def order_designs(
    problem: LinkageProblem, designs: Sequence[Design], *, searched: bool = True
) -> OrderedDesigns[Design]:
    """Sort measured designs by :func:`sort_by_practice`, and explain in remarks what decides the order.

    Parameters
    ----------
    problem : LinkageProblem
    designs : sequence
        Designs in the order of their kind.
    searched : bool
        Whether sound designs were searched for, so that a remark may say that none was found.
    """
    ordered = sort_by_practice(problem, designs)
    passed = [design for design in ordered if design.verification.passed]
    if not passed:
        return OrderedDesigns(ordered, "")
    remarks = [_describe_unbuildable(problem, passed)]
    if is_judged(problem):
        number = problem.classify_design(passed[0])
        # Classes precede accuracy, so that only designs of the first one are compared.
        compared = {n: design for n, design in enumerate(passed, 1) if problem.classify_design(design) == number}
        remarks += [
            _describe_grade(problem, list(compared.values()), searched),
            _describe_error(problem, compared),
            _describe_extra_links(problem, compared),
        ]
    return OrderedDesigns(ordered, join_messages([remark for remark in remarks if remark]))


def _sort_class(problem: LinkageProblem, designs: Sequence[Design]) -> list[Design]:
    """Sort designs of one class: those near the task by grade and merit, the others in their given order."""
    least, fewest = _find_least_error(problem, designs), min(map(count_loops, designs))

    def get_sort_key(design: Design) -> tuple[bool, int, float]:
        error = _measure_error(problem, design)
        if error > ERROR_BAND * least:
            return True, 0, 0.0
        gain = math.sqrt(least / error) * math.sqrt(0.5) ** (count_loops(design) - fewest)
        return False, grade_design(design), -_get_quality(design) * gain

    return sorted(designs, key=get_sort_key)


def _find_least_error(problem: LinkageProblem, designs: Sequence[DrivenDesign]) -> float:
    """Return the smallest error of the workable designs, or of all if none is workable."""
    workable = [design for design in designs if is_workable(problem, design)]
    return min(_measure_error(problem, design) for design in workable or designs)


def _measure_error(problem: LinkageProblem, design: DrivenDesign) -> float:
    """Return the error of a design, at least that which the tolerances of manufacture make meaningless."""
    return max(problem.measure_error(design), NEGLIGIBLE_ERROR, _get_tolerance(problem))


def _get_tolerance(problem: LinkageProblem) -> float:
    """Return the tolerance of the shop as a share of the task's size; 0 if none is given or the task has no size."""
    stated, size = problem.manufacture, problem.task_size
    if stated is None or stated.tolerances is None or size is None:
        return 0.0
    return max(stated.tolerances.length, stated.tolerances.pivot) / size


def count_loops(design: DrivenDesign) -> int:
    """Count the loops of a linkage: one of a fourbar or a slider-crank, two of a sixbar."""
    skeleton = design.mechanism.skeleton
    return max((len(skeleton.links) - 2 + len(skeleton.slides) - len(skeleton.gears)) // 2, 1)


def _get_quality(design: DrivenDesign) -> float:
    metrics = design.metrics
    if isinstance(metrics, MotionMetrics):
        return metrics.quality
    # Steering has no size with which a reach could be compared.
    return float(compute_quality(math.sin(math.radians(metrics.min_transmission_angle)), 0.0, metrics.link_ratio))


def _transmits(design: DrivenDesign, angle: float) -> bool:
    return bool(design.metrics.min_transmission_angle >= angle * (1.0 - CONSTRAINT_TOLERANCE))


def _has_moderate_ratio(design: DrivenDesign) -> bool:
    return bool(design.metrics.link_ratio <= MAX_LINK_RATIO * (1.0 + CONSTRAINT_TOLERANCE))


def _describe_unbuildable(problem: LinkageProblem, passed: Sequence[DrivenDesign]) -> str:
    """Describe the designs that cannot be built."""
    lacking = [design for design in passed if not is_buildable(design)]
    if not lacking:
        return ""
    share = f"{100.0 * MIN_RELATIVE_WIDTH:g}"
    count, all_lack = len(lacking), len(lacking) == len(passed)
    if problem.layout is not None:
        if all_lack:
            return compose("results-none-buildable-in-layout")
        return compose("results-unbuildable-in-layout", count=count)
    if not all_lack:
        return compose("results-unbuildable-last", count=count, share=share)
    metrics = lacking[0].metrics
    widest = metrics.max_link_width if isinstance(metrics, BuildMetrics) else None
    if not widest:
        return compose("results-none-buildable-in-planes")
    return compose("results-none-buildable", share=share, width=f"{widest:.3g}", unit=problem.length_unit)


def _describe_grade(problem: LinkageProblem, passed: Sequence[DrivenDesign], searched: bool) -> str:
    """Describe what the first design lacks, and whether another one was searched for."""
    grade = grade_design(passed[0])
    if grade == 0:
        return ""
    least = _find_least_error(problem, passed)
    # If all designs have small errors, the remark need not mention the errors.
    near = [design for design in passed if _measure_error(problem, design) <= ERROR_BAND * least]
    all_near = len(near) == len(passed)
    if grade == 1:
        message_id = "results-no-design-practical" if all_near else "results-no-near-design-practical"
    else:
        message_id = "results-no-design-with-even-links" if all_near else "results-no-near-design-with-even-links"
    among = "found" if searched else "listed"
    # A near design that has what the first one lacks, and yet follows it, cannot be built.
    if any(map(is_practical if grade == 1 else is_sound, near)):
        among = "buildable"
    return compose(
        message_id,
        among=among,
        angle=f"{MIN_TRANSMISSION_ANGLE:.0f}",
        ratio=f"{MAX_LINK_RATIO:.0f}",
        reach=f"{MAX_REACH:.0f}",
        band=f"{ERROR_BAND:g}",
    )


def _describe_error(problem: LinkageProblem, numbered: Mapping[int, DrivenDesign]) -> str:
    """Explain why the first design is not the most accurate one; empty if they are equally accurate."""
    first = numbered[1]
    # What cannot be built is described apart.
    compared = [n for n, design in numbered.items() if n == 1 or is_workable(problem, design)]
    nearest = min(compared, key=lambda n: problem.measure_error(numbered[n]))
    other = numbered[nearest]
    ratio = _measure_error(problem, first) / _measure_error(problem, other)
    if ratio <= NOTABLE_ERROR_RATIO:
        return ""
    ours, theirs = first.metrics, other.metrics
    # A factor would say nothing where the smaller error is a rounding error.
    errors = {"error": problem.measure_error(first), "nearest": problem.measure_error(other)}
    given = {"number": str(nearest), **{name: write_error(problem, error) for name, error in errors.items()}}
    if ours.min_transmission_angle <= theirs.min_transmission_angle and ours.link_ratio >= theirs.link_ratio:
        return compose("results-first-less-accurate", **given)
    return compose(
        "results-first-for-soundness",
        **given,
        angle=f"{ours.min_transmission_angle:.1f}",
        nearest_angle=f"{theirs.min_transmission_angle:.1f}",
        ratio=f"{ours.link_ratio:.3g}",
        nearest_ratio=f"{theirs.link_ratio:.3g}",
    )


def _describe_extra_links(problem: LinkageProblem, numbered: Mapping[int, DrivenDesign]) -> str:
    """Describe what the additional links of a design buy, compared with the best of the simplest designs.

    It is empty if all have equally many links, or if the additional links of a later design buy nothing.
    """
    fewest = min(map(count_loops, numbered.values()))
    number = next((n for n, design in numbered.items() if count_loops(design) > fewest), None)
    if number is None:
        return ""
    other = next(n for n, design in numbered.items() if count_loops(design) == fewest)
    simple, more = numbered[other], numbered[number]
    errors = problem.measure_error(simple), problem.measure_error(more)
    gains = errors[1] < errors[0] or more.metrics.min_transmission_angle > simple.metrics.min_transmission_angle
    if number > 1 and not gains:
        return ""
    message_id = "results-extra-links"
    if max(errors) > 0.0:
        message_id = "results-extra-links-and-error"
        if max(errors) <= NEGLIGIBLE_ERROR:
            message_id = "results-extra-links-and-negligible-error"
    return compose(
        message_id,
        number=number,
        links=2 * (count_loops(more) - fewest),
        simple=other,
        **{name: write_error(problem, error) for name, error in zip(("error", "other"), errors, strict=True)},
        angle=f"{simple.metrics.min_transmission_angle:.1f}",
        changed=f"{more.metrics.min_transmission_angle:.1f}",
    )


def write_error(problem: LinkageProblem, error: float) -> str:
    """Write an error with its unit; 0 at the level of rounding."""
    scale, unit = problem.error_unit
    return f"{scale * error if error > RESIDUAL_ROUNDING else 0.0:.2g}{unit}"


def _is_default(statement: Statement, name: str) -> bool:
    return bool(getattr(statement, name) == type(statement).model_fields[name].default)
