"""Preference for practical designs in answers to problems that state no limits of practicality.

Practice requires a minimum transmission angle of 30 to 40 degrees and a link ratio of at most about ten (Norton,
*Design of Machinery*, Sec. 3.3 and 4.10). A link that is many times longer than the task rarely fits. A design that is
slightly more accurate but cannot be built is not a better answer.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Generic, NamedTuple, TypeVar

from kinematics.message import compose
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
"""Errors up to this multiple of the smallest one make no practical difference."""


class OrderedDesigns(NamedTuple, Generic[Design]):
    """Sorted designs and a remark on their order.

    The remark is empty if the first design is practical anyway, or if the client gave limits or an order.
    """

    designs: list[Design]
    remark: str


def has_even_links(design: DrivenDesign) -> bool:
    """Return whether a design transmits force well and has a moderate link ratio."""
    measured = design.metrics
    transmits = measured.min_transmission_angle >= MIN_TRANSMISSION_ANGLE * (1.0 - CONSTRAINT_TOLERANCE)
    return bool(transmits and measured.link_ratio <= MAX_LINK_RATIO * (1.0 + CONSTRAINT_TOLERANCE))


def is_usable(design: DrivenDesign) -> bool:
    """Return whether a design is practical: :func:`has_even_links`, and no link is far longer than the task."""
    metrics = design.metrics
    reach = metrics.reach if isinstance(metrics, MotionMetrics) else None
    return has_even_links(design) and (reach is None or reach <= MAX_REACH * (1.0 + CONSTRAINT_TOLERANCE))


def sort_usable_first(problem: LinkageProblem, designs: Sequence[Design]) -> OrderedDesigns[Design]:
    """Move practical designs whose error is close to the smallest one to the front.

    The order is kept if the problem limits the transmission angle or the link ratio, or requests another order.
    """
    limited = not all(_is_default(problem.constraints, name) for name in ("min_transmission_angle", "max_link_ratio"))
    passed = [design for design in designs if design.verification.passed]
    # Given limits or a given order express the client's own preference.
    if limited or not _is_default(problem, "rank_by") or not passed or is_usable(passed[0]):
        return OrderedDesigns(list(designs), "")

    def measure_design_error(design: Design) -> float:
        # Each kind names its own error; otherwise use the error of the Pareto front.
        measure = problem.error_measure
        return measure_error(design) if measure is None else float(getattr(design.metrics, measure))

    least = min(map(measure_design_error, passed))
    # Exact designs differ by rounding only, so compare with at least the rounding level.
    near = [design for design in passed if measure_design_error(design) <= ERROR_BAND * max(least, RESIDUAL_ROUNDING)]
    bounds = {
        "angle": f"{MIN_TRANSMISSION_ANGLE:.0f}",
        "ratio": f"{MAX_LINK_RATIO:.0f}",
        "reach": f"{MAX_REACH:.0f}",
        "band": f"{ERROR_BAND:g}",
    }
    first = [design for design in near if is_usable(design)]
    if first:
        return OrderedDesigns(move_to_front(first, designs), compose("results-practical-first", **bounds))
    # If all designs have small errors, the remark need not mention the errors.
    all_near = len(near) == len(passed)
    # Without a fully practical design, accept a long link rather than a poor transmission angle.
    if has_even_links(passed[0]):
        message_id = "results-no-design-practical" if all_near else "results-no-near-design-practical"
        return OrderedDesigns(list(designs), compose(message_id, **bounds))
    first = [design for design in near if has_even_links(design)]
    if not first:
        message_id = "results-no-design-with-even-links" if all_near else "results-no-near-design-with-even-links"
        return OrderedDesigns(list(designs), compose(message_id, **bounds))
    message_id = "results-even-links-first" if all_near else "results-near-even-links-first"
    return OrderedDesigns(move_to_front(first, designs), compose(message_id, **bounds))


def _is_default(statement: Statement, name: str) -> bool:
    return bool(getattr(statement, name) == type(statement).model_fields[name].default)
