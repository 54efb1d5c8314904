"""Preference for practical designs in answers to problems without limits of their own.

Practice requires a minimum transmission angle of 30 to 40 degrees and a link ratio of at most about ten (Norton,
*Design of Machinery*, Sec. 3.3 and 4.10). A link that is many times longer than the task rarely fits. A design that is
slightly closer to the task but cannot be built is no better answer.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Generic, NamedTuple, TypeVar

from synthesis.model.linkage.answer import MotionMetrics
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import Statement
from synthesis.model.protocols import DrivenDesign
from synthesis.results.pareto import measure_error
from synthesis.results.ranking import RESIDUAL_ROUNDING, move_to_front

Design = TypeVar("Design", bound=DrivenDesign)

MIN_TRANSMISSION_ANGLE = 30.0
"""Minimum transmission angle of a practical design, degrees."""

MAX_LINK_RATIO = 10.0
"""Maximum ratio of the longest link to the shortest in a practical design."""

MAX_REACH = 5.0
"""Maximum distance between two joints of one link in a practical design, in sizes of the task."""

CONSTRAINT_TOLERANCE = 1e-6
"""Relative tolerance for designs that a fit placed exactly at one of these limits."""

ERROR_BAND = 2.0
"""Factor of the smallest error up to which errors make no practical difference."""


class OrderedDesigns(NamedTuple, Generic[Design]):
    """Sorted designs and a remark on their order; empty if the first design is practical anyway."""

    designs: list[Design]
    remark: str


def has_even_links(design: DrivenDesign) -> bool:
    """Return whether a passed design transmits force well and has a moderate link ratio."""
    measured = design.metrics
    transmits = measured.min_transmission_angle >= MIN_TRANSMISSION_ANGLE * (1.0 - CONSTRAINT_TOLERANCE)
    return bool(transmits and measured.link_ratio <= MAX_LINK_RATIO * (1.0 + CONSTRAINT_TOLERANCE))


def is_usable(design: DrivenDesign) -> bool:
    """Return whether a design is practical: also without a link that is far longer than the task."""
    metrics = design.metrics
    reach = metrics.reach if isinstance(metrics, MotionMetrics) else None
    return has_even_links(design) and (reach is None or reach <= MAX_REACH * (1.0 + CONSTRAINT_TOLERANCE))


def sort_usable_first(problem: LinkageProblem, designs: Sequence[Design]) -> OrderedDesigns[Design]:
    """Move the practical designs whose error is close to the smallest one before all others.

    The order is kept if the client gave a limit of transmission angle or link ratio, or another order.
    """
    limited = not all(_is_default(problem.constraints, name) for name in ("min_transmission_angle", "max_link_ratio"))
    passed = [design for design in designs if design.verification.passed]
    # A client who set limits or an order has decided what matters.
    if limited or not _is_default(problem, "rank_by") or not passed or is_usable(passed[0]):
        return OrderedDesigns(list(designs), "")

    def measure_design_error(design: Design) -> float:
        # Each kind names its own error; otherwise use the error of the Pareto front.
        measure = problem.error_measure
        return measure_error(design) if measure is None else float(getattr(design.metrics, measure))

    least = min(map(measure_design_error, passed))
    # Exact designs differ by rounding only: compare with at least the rounding level.
    near = [design for design in passed if measure_design_error(design) <= ERROR_BAND * max(least, RESIDUAL_ROUNDING)]
    missing = (
        "No design found" if len(near) == len(passed) else f"No design within {ERROR_BAND:g} times the smallest error"
    )
    practice = (
        f"a transmission angle of {MIN_TRANSMISSION_ANGLE:.0f}° or more and a link ratio of {MAX_LINK_RATIO:.0f} or "
        "less"
    )
    compact = f"no link longer than {MAX_REACH:.0f} times the task's size"
    first = [design for design in near if is_usable(design)]
    if first:
        return OrderedDesigns(
            move_to_front(first, designs),
            f" Designs with {practice} and {compact} are listed first.",
            # Without a fully practical design, accept a long link before a poor transmission angle.
        )
    told = f" {missing} has {practice} and {compact}"
    if has_even_links(passed[0]):
        return OrderedDesigns(list(designs), f"{told}.")
    first = [design for design in near if has_even_links(design)]
    if not first:
        return OrderedDesigns(list(designs), f" {missing} has {practice}.")
    return OrderedDesigns(
        move_to_front(first, designs), f"{told}; designs with such an angle and ratio are listed first."
    )


def _is_default(statement: Statement, name: str) -> bool:
    return bool(getattr(statement, name) == type(statement).model_fields[name].default)
