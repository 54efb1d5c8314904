"""What is measured on which design beyond its motion: forces, planes and yield, too expensive for every candidate.

A candidate is measured during the search only for what the problem limits, and only after it passed everything else. A
design of the answer is measured for every block of the problem, whether it passed or not; before that, the designs of a
search that is ordered by one of these quantities are measured for this one. No design is measured twice.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import NamedTuple, TypeVar, cast

from synthesis.model.answer import AnyResult
from synthesis.model.linkage.problem import FORCE_NAMES, LinkageProblem
from synthesis.model.problem import ProblemBase
from synthesis.model.protocols import DrivenDesign, VerifiedDesign
from synthesis.results.forces import add_forces, check_forces
from synthesis.results.layout import add_layout
from synthesis.results.manufacture import add_manufacture, check_yield
from synthesis.verification.shared_constraints import check_workspace_of_design

Design = TypeVar("Design", bound=VerifiedDesign)


class _Measurement(NamedTuple):
    """One measurement of a design.

    Attributes
    ----------
    orders : collection of str
        Values of ``rank_by`` that need it.
    is_requested, is_limited : callable
        Whether the problem has the block for it, and whether it has a limit that designs must satisfy.
    add : callable
        Returns the design of an answer with the result, unchanged if it has it already.
    check : callable
        Returns a candidate with the result and its check.
    """

    orders: Collection[str]
    is_requested: Callable[[LinkageProblem], bool]
    is_limited: Callable[[LinkageProblem], bool]
    add: Callable[[LinkageProblem, DrivenDesign], DrivenDesign]
    check: Callable[[LinkageProblem, DrivenDesign], DrivenDesign]


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
    """Return a verified design with the checks of its workspace, forces, planes and yield, as far as limited.

    The first failed check ends the verification. None if no mechanism can be built from the dimensions of the design.
    """
    judged = check_workspace_of_design(problem, design)
    if judged is None or not isinstance(problem, LinkageProblem):
        return judged
    # Every design of a linkage problem is a driven linkage.
    driven = cast(DrivenDesign, judged)
    for measurement in _MEASUREMENTS:
        if driven.verification.passed and measurement.is_limited(problem):
            driven = measurement.check(problem, driven)
    return cast(Design, driven)


def measure_designs(problem: LinkageProblem, result: AnyResult, order: str | None = None) -> AnyResult:
    """Return an answer with the results that its blocks request, or that ``order`` needs, on all designs.

    The nearest miss is measured, too.
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
