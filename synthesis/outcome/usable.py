"""Which design of an answer stands first where the client sets no limits: one that somebody would build.

Practice wants a transmission angle of 30 to 40 degrees at least and links of which none is more than about ten times
as long as another (Norton, *Design of Machinery*, Sec. 3.3 and 4.10), and a link that is many times as long as the task
is wide finds no room. What is a little nearer to the task and cannot be
built is no better answer.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.statement import Statement
from synthesis.outcome.front import error_of
from synthesis.outcome.ranking import ROUNDING

TRANSMISSION_ANGLE = 30.0
"""Degrees."""

LINK_RATIO = 10.0

REACH = 5.0
"""Greatest distance between two joints of one link, in sizes of the task."""

HELD = 1e-6
"""Relative rounding of designs that a fit holds at one of these."""

BAND = 2.0
"""Errors up to this many times the least are alike for who builds a linkage."""


class Ordered(NamedTuple):
    """Designs in their order, and what has to be said of it; empty where the first design is usable as it is."""

    designs: list[Any]
    remark: str


def even(design: Any) -> bool:
    """Whether a design that passed transmits force well and has links of like lengths."""
    measured = design.metrics
    transmits = measured.min_transmission_angle >= TRANSMISSION_ANGLE * (1.0 - HELD)
    return bool(transmits and measured.link_ratio <= LINK_RATIO * (1.0 + HELD))


def usable(design: Any) -> bool:
    """Whether it is, and has no link that is far longer than its task is wide."""
    reach = getattr(design.metrics, "reach", None)
    return even(design) and (reach is None or reach <= REACH * (1.0 + HELD))


def usable_first(problem: LinkageProblem, designs: Sequence[Any]) -> Ordered:
    """The designs of an answer, the usable ones that are nearly as near to the task as the nearest before all others.

    The order stays as it is where the client has stated a limit of transmission angle or link ratio, or another order.
    """
    limited = not all(_by_default(problem.constraints, name) for name in ("min_transmission_angle", "max_link_ratio"))
    passed = [design for design in designs if design.verification.passed]
    if limited or not _by_default(problem, "rank_by") or not passed or usable(passed[0]):
        return Ordered(list(designs), "")

    def error(design: Any) -> float:
        measure = problem.error_measure
        return error_of(design) if measure is None else float(getattr(design.metrics, measure))

    least = min(map(error, passed))
    near = [design for design in passed if error(design) <= BAND * max(least, ROUNDING)]
    missing = (
        "No design that was found" if len(near) == len(passed) else f"No design within {BAND:g} times the least error"
    )
    practice = f"a least transmission angle of {TRANSMISSION_ANGLE:.0f}° and a link ratio of {LINK_RATIO:.0f} or less"
    compact = f"no link longer than {REACH:.0f} times the task's size"
    first = [design for design in near if usable(design)]
    if first:
        return Ordered(
            _before(first, designs), f" First stand those that have {practice} and {compact}, then the others."
        )
    told = f" {missing} has {practice} and {compact}"
    if even(passed[0]):
        return Ordered(list(designs), f"{told}.")
    first = [design for design in near if even(design)]
    if not first:
        return Ordered(list(designs), f" {missing} has {practice}.")
    return Ordered(_before(first, designs), f"{told}; first stand those with such an angle and ratio.")


def _before(first: Sequence[Any], designs: Sequence[Any]) -> list[Any]:
    """Designs with some of them before all others."""
    chosen = {id(design) for design in first}
    return [*first, *(design for design in designs if id(design) not in chosen)]


def _by_default(statement: Statement, name: str) -> bool:
    return bool(getattr(statement, name) == type(statement).model_fields[name].default)
