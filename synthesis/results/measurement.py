"""Measurement of forces, planes and yield, which are too expensive to measure on every candidate.

During the search, only the quantities that the problem limits are measured, and only on candidates that passed all
other checks. If the designs are ordered by one of these quantities, it is then measured on all designs that were found.
Finally the designs of the answer are measured for every block of the problem, whether they passed or not. No design is
measured twice.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple, TypeVar, cast

from synthesis.model.answer import AnyResult
from synthesis.model.linkage.problem import FORCE_NAMES, LinkageProblem
from synthesis.model.problem import ProblemBase
from synthesis.model.protocols import DrivenDesign, VerifiedDesign
from synthesis.results.buildability import check_pin_distance, is_buildable, measure_build
from synthesis.results.forces import add_forces, check_forces
from synthesis.results.layout import add_layout
from synthesis.results.manufacture import add_manufacture, check_yield
from synthesis.verification.shared_constraints import check_workspace_of_design

Design = TypeVar("Design", bound=VerifiedDesign)
Driven = TypeVar("Driven", bound=DrivenDesign)


class _Measurement(NamedTuple):
    """One measurement of a design.

    Attributes
    ----------
    orders : collection of str
        Values of ``rank_by`` that need the measurement.
    is_requested, is_limited : callable
        Whether the problem contains the block that requests it, and whether the problem limits its result.
    add : callable
        Returns a design of an answer with the result; unchanged if the design already has it.
    judge : callable
        Returns a candidate with the result and with the check of its limit.
    """

    orders: Collection[str]
    is_requested: Callable[[LinkageProblem], bool]
    is_limited: Callable[[LinkageProblem], bool]
    add: Callable[[LinkageProblem, DrivenDesign], DrivenDesign]
    judge: Callable[[LinkageProblem, DrivenDesign], DrivenDesign]


def _are_forces_limited(problem: LinkageProblem) -> bool:
    return problem.dynamics is not None and bool(problem.constraints.force_limits)


def _are_planes_limited(problem: LinkageProblem) -> bool:
    return problem.layout is not None and problem.layout.max_planes is not None


def _is_yield_limited(problem: LinkageProblem) -> bool:
    return problem.manufacture is not None and problem.manufacture.required_yield is not None


# Cheapest first: forces take milliseconds, planes a search, the yield thousands of samples.
_MEASUREMENTS = (
    _Measurement(
        FORCE_NAMES, lambda problem: problem.dynamics is not None, _are_forces_limited, add_forces, check_forces
    ),
    _Measurement(("planes",), lambda problem: problem.layout is not None, _are_planes_limited, add_layout, add_layout),
    _Measurement(
        ("yield",), lambda problem: problem.manufacture is not None, _is_yield_limited, add_manufacture, check_yield
    ),
)


def check_shared_constraints(problem: ProblemBase, design: Design) -> Design | None:
    """Return a verified design with the checks of its workspace and pins, and of forces, planes and yield if limited.

    A failed check ends the verification. Return None if no mechanism can be built from the dimensions of the design.
    """
    judged = check_workspace_of_design(problem, design)
    if judged is None or not isinstance(problem, LinkageProblem):
        return judged
    # Every design of a linkage problem is a driven linkage.
    driven = cast(DrivenDesign, judged)
    if driven.verification.passed:
        driven = check_pin_distance(problem, driven)
    for measurement in _MEASUREMENTS:
        if driven.verification.passed and measurement.is_limited(problem):
            driven = measurement.judge(problem, driven)
    return cast(Design, driven)


def measure_buildability(problem: LinkageProblem, design: Driven) -> Driven:
    """Return a design with the measures of whether it can be built, and with its layout if the problem has sizes."""
    return measure_build(problem, add_layout(problem, design))


def select_buildable_first(problem: LinkageProblem, designs: Sequence[Driven], count: int) -> list[Driven]:
    """Return designs in order, with those that cannot be built moved behind the others.

    Designs that fail a check stay last. Designs are measured until ``count`` can be built, or ``count`` cannot.
    """
    first: list[Driven] = []
    last: list[Driven] = []
    rest = list(designs)
    while rest and rest[0].verification.passed and len(first) < count and len(last) < count:
        design = measure_buildability(problem, rest.pop(0))
        (first if is_buildable(design) else last).append(design)
    # The rest is not measured here, because enough others precede it or too many cannot be built.
    passed = [design for design in rest if design.verification.passed]
    failed = [design for design in rest if not design.verification.passed]
    return [*first, *passed, *last, *failed]


def measure_designs(problem: LinkageProblem, result: AnyResult, order: str | None = None) -> AnyResult:
    """Measure all designs of an answer and its nearest miss for every block of the problem.

    With ``order``, a value of ``rank_by``, only the quantity that this order needs is measured.
    """
    wanted = [
        measurement
        for measurement in _MEASUREMENTS
        if measurement.is_requested(problem) and (order is None or order in measurement.orders)
    ]
    if not wanted:
        return result

    def measure_design(design: DrivenDesign) -> DrivenDesign:
        for measurement in wanted:
            design = measurement.add(problem, design)
        return design

    miss = result.nearest_miss
    if miss is not None:
        miss = miss.model_copy(update={"design": measure_design(miss.design)})
    designs = list(map(measure_design, result.designs))
    return result.model_copy(update={"designs": designs, "nearest_miss": miss})
