"""Which design of an answer stands first where the client sets no limits: one that somebody would build.

Practice wants a transmission angle of 30 to 40 degrees at least and links of which none is more than about ten times
as long as another (Norton, *Design of Machinery*, Sec. 3.3 and 4.10). What is a little nearer to the task and cannot be
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

HELD = 1e-6
"""Relative rounding of designs that a fit holds at one of these."""

BAND = 2.0
"""Errors up to this many times the least are alike for who builds a linkage."""


class Ordered(NamedTuple):
    """Designs in their order, and what has to be said of it; empty where the first design is usable as it is."""

    designs: list[Any]
    remark: str


def usable(design: Any) -> bool:
    """Whether a design that passed transmits force well and has links of like lengths."""
    measured = design.metrics
    transmits = measured.min_transmission_angle >= TRANSMISSION_ANGLE * (1.0 - HELD)
    return bool(transmits and measured.link_ratio <= LINK_RATIO * (1.0 + HELD))


def usable_first(problem: LinkageProblem, designs: Sequence[Any]) -> Ordered:
    """The designs of an answer, the usable ones that are nearly as near to the task as the nearest before all others.

    The order stays as it is where the client has stated a limit of transmission angle or link ratio, or another order.
    """
    limited = not all(_by_default(problem.constraints, name) for name in ("min_transmission_angle", "max_link_ratio"))
    passed = [design for design in designs if design.verification.passed]
    if limited or not _by_default(problem, "rank_by") or not passed or usable(passed[0]):
        return Ordered(list(designs), "")
    least = min((error_of(design) for design in passed), default=0.0)
    near = [design for design in passed if error_of(design) <= BAND * max(least, ROUNDING)]
    first = [design for design in near if usable(design)]
    practice = f"a least transmission angle of {TRANSMISSION_ANGLE:.0f}° and a link ratio of {LINK_RATIO:.0f} or less"
    if not first:
        what = (
            "No design that was found"
            if len(near) == len(passed)
            else f"No design within {BAND:g} times the least error"
        )
        return Ordered(list(designs), f" {what} has {practice}.")
    kept = {id(design) for design in first}
    others = [design for design in designs if id(design) not in kept]
    return Ordered([*first, *others], f" First stand those that have {practice}, then the others.")


def _by_default(statement: Statement, name: str) -> bool:
    return bool(getattr(statement, name) == type(statement).model_fields[name].default)
