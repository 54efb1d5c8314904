"""Watt II sixbars for nine pairs or precision points: compute all of them and verify each.

Most real solutions (:mod:`synthesis.kinds.function.nine_pairs`) have a branch defect: their dyads are assembled
differently at different pairs, so no motion of the linkage connects these. The solutions that keep their assembly at
the pairs and between them are driven by the analysis core.
"""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.function.design import FunctionDesign, FunctionResult
from synthesis.kinds.function.nine_pair_sixbars import sixbar_of
from synthesis.kinds.function.nine_pair_system import SOLUTIONS
from synthesis.kinds.function.nine_pairs import all_watts
from synthesis.kinds.function.order import ordered
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.sixbar_build import built
from synthesis.kinds.function.sixbar_descents import Descents, Found
from synthesis.kinds.function.sixbar_followers import followed
from synthesis.kinds.function.sixbar_kernels import WATT_2, A, B, C
from synthesis.kinds.function.sixbar_search import EXACT_STEPS, EXACT_TOLERANCE, places_of
from synthesis.kinds.function.task import FunctionTask, function_task
from synthesis.kinds.function.verification import verify_function
from synthesis.model.counting import agreeing, grouped
from synthesis.model.kind import Progress
from synthesis.outcome.sifting import Sifting, reported

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

FOLLOWED = 0.9
"""Share of the progress assigned to the continuation."""

NO_LENGTH = 1e-9
"""Minimum length of a link, relative to its ground."""

MET = 1e-6
"""Maximum error at a pair, radians, of a solution that meets it in the assembly of the first pair."""

DENSE = 181
"""Number of inputs over the range at which linkages are screened before they are driven."""

MARGIN = 1e-3
"""Excess of a transmission cosine, or relative excess of a link ratio, beyond which a limit is certainly violated."""

PROVING = {"branch_defect", "circuit_defect", "order_defect", "transmission_angle"}
"""Rejection reasons of driven linkages that do not depend on the placement or size of the fourbars."""


class _Judged(NamedTuple):
    """Screening of the solutions for one pair of scales: linkages to be driven, and rejection reasons of the others."""

    kept: list[Found]
    reasons: list[str]


def solve_nine_pairs(problem: FunctionProblem, reasons: dict[str, str], progress: Progress) -> FunctionResult:
    """Solve for all Watt II sixbars through nine pairs.

    Parameters
    ----------
    problem : FunctionProblem
        A problem with open zeros and given scales.
    reasons : dict
        Rejection reasons by failed check.
    progress : callable
        Progress callback.
    """
    task = function_task(problem)
    rng = np.random.default_rng(problem.seed)
    sifting = Sifting[FunctionDesign](problem, reasons)
    choices = [(k, l_) for k, _ in task.scales[0] for l_, _ in task.scales[1]]
    complete, computed, real = True, 0, 0
    kept: list[Found] = []
    reasons_before: list[str] = []
    for n, (k, l_) in enumerate(choices):

        def tell(share: float, n: int = n) -> None:
            done = round(share * SOLUTIONS)
            progress(FOLLOWED * (n + share) / len(choices), f"{grouped(done)} of {grouped(SOLUTIONS)} paths followed")

        watts = all_watts(k * task.inputs, l_ * task.outputs, rng, tell)
        complete, computed, real = complete and watts.complete, computed + watts.found, real + len(watts.real)
        judged = _judged(task, watts.real, k, l_)
        kept += judged.kept
        reasons_before += judged.reasons
    # Order by transmission at the pairs, so that the order of equal designs is reproducible.
    kept.sort(key=lambda one: _greatest_cosine(task, one))

    def verified(one: Found) -> FunctionDesign | None:
        try:
            return verify_function(problem, *built(task, one))
        except (ValueError, ZeroDivisionError, OverflowError):
            return None  # at a toggle no position can be computed

    sifting.sift(reported(kept, progress, (FOLLOWED, 1.0), "verifying {next} of {all} sixbars"), verified)
    progress(1.0, "verified")
    complete = complete and sifting.rejected.keys() <= PROVING
    for reason in reasons_before:
        sifting.reject(reason)
    counts = f"{grouped(computed)} of {grouped(SOLUTIONS * len(choices))}"
    text = (
        f"{counts} Watt II solutions for the nine pairs were computed, real and complex; {grouped(real)} "
        f"{agreeing(real, 'is', 'are')} real, and {grouped(sifting.accepted)} of these "
        f"{agreeing(sifting.accepted, 'satisfies', 'satisfy')} all constraints.{sifting.reasons()}"
    )
    if not sifting.passed:
        text += " These are all, so no design of this type exists." if complete else " Others may exist."
    return FunctionResult(
        designs=sifting.designs(partial(ordered, problem)),
        search=sifting.search("nine_pair_continuation", complete=complete),
        summary=text,
    )


def _judged(task: FunctionTask, real: Complex, k: float, l_: float) -> _Judged:
    """Select the solutions that keep their assembly and satisfy simple limits, and refine them to rounding."""
    constraints, places = task.problem.constraints, places_of(task)
    descents = Descents(places.points, 0.0, None)
    low, high = places.dense[0].min(), places.dense[0].max()
    dense = np.union1d(np.linspace(low, high, DENSE), places.dense[0])
    demanded = constraints.min_transmission_angle
    greatest = 1.0 if demanded is None else math.cos(math.radians(demanded)) + MARGIN
    widest = constraints.max_link_ratio or math.inf
    kept, reasons = [], []
    for vectors in real:
        one = sixbar_of(vectors, k, l_, float(task.inputs[0]), float(task.outputs[0]))
        if one.at[[A, B, C, 7, 8, 9]].min() < NO_LENGTH:
            reasons.append("degenerate_link")
            continue
        if _link_ratio(one) > widest * (1.0 + MARGIN):
            reasons.append("link_ratio")
            continue
        errors = followed(WATT_2, one.assembly, one.at, *places.dense).errors
        # Written as "not <", so that NaN (not assembled at some pair) is rejected too.
        if not np.abs(errors).max() < MET:
            reasons.append("branch_defect")
            continue
        one = descents.descended(one, 0.0, EXACT_STEPS, EXACT_TOLERANCE)
        between = followed(WATT_2, one.assembly, one.at, dense, np.zeros_like(dense))
        if not np.isfinite(between.errors).all():
            reasons.append("branch_defect")
        elif np.abs(between.cosines).max() > greatest:
            reasons.append("transmission_angle")
        else:
            kept.append(one)
    return _Judged(kept, reasons)


def _link_ratio(one: Found) -> float:
    """Return the larger link ratio of the two fourbars, which does not depend on their free relative size."""
    fourbars = np.array([[1.0, *one.at[[A, B, C]]], [1.0, *one.at[[7, 8, 9]]]])
    return float((fourbars.max(axis=1) / fourbars.min(axis=1)).max())


def _greatest_cosine(task: FunctionTask, one: Found) -> float:
    """Return the largest cosine of the transmission angles at the pairs."""
    return float(np.abs(followed(WATT_2, one.assembly, one.at, *places_of(task).dense).cosines).max())
