"""Watt II sixbars for nine pairs or precision points: compute all of them and verify each.

Most real solutions (:mod:`synthesis.kinds.function.nine_pairs.continuation`) have a branch defect: their dyads are
assembled differently at different pairs, so no motion of the linkage connects these. The solutions that keep their
assembly at the pairs and between them are driven by the analysis core.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.message import compose, join_messages
from synthesis.fit.linkage.descent import descend_softly
from synthesis.fit.linkage.setting import pack_topology
from synthesis.kinds.function.design import FunctionDesign, FunctionResult
from synthesis.kinds.function.fourbar.task import FunctionTask, make_function_task
from synthesis.kinds.function.nine_pairs.continuation import find_all_watts
from synthesis.kinds.function.nine_pairs.system import SOLUTION_COUNT
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.ranking import rank_by_error
from synthesis.kinds.function.sixbar.fits import SixbarCandidate, build_fit_task, measure_motion
from synthesis.kinds.function.sixbar.mechanism import build_function_linkage
from synthesis.kinds.function.sixbar.nine_pair_starts import make_sixbar
from synthesis.kinds.function.sixbar.solver import (
    EXACT_TOLERANCE,
    MAX_EXACT_STEPS,
    compute_max_error,
    make_sample_points,
)
from synthesis.kinds.function.verification.verify import verify_function
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog, report_candidates

CONTINUATION_SHARE = 0.9
"""Share of the progress assigned to the continuation."""

MIN_LENGTH_SHARE = 1e-9
"""Minimum length of a link, relative to its ground."""

PAIR_TOLERANCE = 1e-6
"""Maximum error at a pair, radians, of a solution that meets it in the assembly of the first pair."""

SAMPLE_COUNT = 181
"""Number of inputs over the range at which linkages are screened before they are driven."""

LIMIT_MARGIN = 1e-3
"""Excess of a transmission cosine, or relative excess of a link ratio, beyond which a limit is certainly violated."""

PROVING_REASONS = {"branch_defect", "circuit_defect", "order_defect", "transmission_angle"}
"""Rejection reasons of driven linkages that do not depend on the placement or size of the fourbars."""


class _ScreeningResult(NamedTuple):
    """Screening of the solutions for one pair of scales: linkages to be driven, and rejection reasons of the others."""

    kept: list[SixbarCandidate]
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
    task = make_function_task(problem)
    rng = np.random.default_rng(problem.seed)
    sifting = CandidateLog[FunctionDesign](problem, reasons)
    # Given scales: each choice is an interval of one value.
    choices = [(k, l_) for k, _ in task.scales[0] for l_, _ in task.scales[1]]
    complete, computed, real = True, 0, 0
    kept: list[SixbarCandidate] = []
    reasons_before: list[str] = []
    for n, (k, l_) in enumerate(choices):

        def report_share(share: float, n: int = n) -> None:
            done = round(share * SOLUTION_COUNT)
            progress(
                CONTINUATION_SHARE * (n + share) / len(choices),
                compose("function-paths-followed", done=done, count=SOLUTION_COUNT),
            )

        watts = find_all_watts(k * task.inputs, l_ * task.outputs, rng, report_share)
        complete, computed, real = complete and watts.complete, computed + watts.found, real + len(watts.real)
        judged = _screen_solutions(task, watts.real, k, l_)
        kept += judged.kept
        reasons_before += judged.reasons
    # Order by transmission at the pairs, so that the order of equal designs is reproducible.
    kept.sort(key=lambda one: _compute_max_cosine(task, one))

    def verify_sixbar(one: SixbarCandidate) -> FunctionDesign | None:
        try:
            return verify_function(problem, *build_function_linkage(task, one))
        except (ValueError, ZeroDivisionError, OverflowError):
            return None  # at a toggle no position can be computed

    sifting.verify_candidates(
        report_candidates(kept, progress, (CONTINUATION_SHARE, 1.0), "function-progress-sixbars"),
        verify_sixbar,
    )
    progress(1.0, compose("function-verified"))
    # Rejections by size or placement could be avoided by other placements, which were not searched.
    complete = complete and sifting.rejected.keys() <= PROVING_REASONS
    # Added after the check of completeness: the reasons of the screening are proofs of their own.
    for reason in reasons_before:
        sifting.reject(reason)
    text = [
        compose(
            "function-watts-computed",
            computed=computed,
            count=SOLUTION_COUNT * len(choices),
            real=real,
            accepted=sifting.accepted,
        ),
        sifting.describe_reasons().strip(),
    ]
    if not sifting.passed:
        text.append(compose("function-no-such-type-exists" if complete else "function-others-may-exist"))
    return FunctionResult(
        designs=sifting.select_designs(partial(rank_by_error, problem)),
        search=sifting.build_search("nine_pair_continuation", complete=complete),
        summary=join_messages(text),
    )


def _screen_solutions(task: FunctionTask, real: Complex, k: float, l_: float) -> _ScreeningResult:
    """Select the solutions that keep their assembly and satisfy simple limits, and refine them to rounding."""
    constraints, points = task.problem.constraints, make_sample_points(task)
    dense = np.union1d(np.linspace(points.inputs[0], points.inputs[-1], SAMPLE_COUNT), points.inputs)
    demanded = constraints.min_transmission_angle
    # A margin, because the driven linkage is measured more accurately than here.
    greatest = 1.0 if demanded is None else math.cos(math.radians(demanded)) + LIMIT_MARGIN
    widest = constraints.max_link_ratio or math.inf
    kept, reasons = [], []
    for vectors in real:
        one = make_sixbar(vectors, (k, l_), points.inputs, float(task.inputs[0]), float(task.outputs[0]))
        if _measure_fourbars(one).min() < MIN_LENGTH_SHARE:
            reasons.append("degenerate_link")
            continue
        if _compute_link_ratio(one) > widest * (1.0 + LIMIT_MARGIN):
            reasons.append("link_ratio")
            continue
        if not compute_max_error(one, points.dense) < PAIR_TOLERANCE:
            reasons.append("branch_defect")
            continue
        # Continuation ends at single precision of the path; refine before driving between the pairs.
        rotations = one.compute_rotations(points.inputs)
        fit_task = build_fit_task(one.topology, rotations, l_ * points.outputs, points.roots, pack_topology, 0)
        (fit,) = descend_softly([one.fit], fit_task, MAX_EXACT_STEPS, EXACT_TOLERANCE)
        one = replace(one, fit=fit)
        between = measure_motion(one, dense)
        if between is None:
            reasons.append("branch_defect")
        elif np.abs(between.cosines).max() > greatest:
            reasons.append("transmission_angle")
        else:
            kept.append(one)
    return _ScreeningResult(kept, reasons)


def _compute_link_ratio(one: SixbarCandidate) -> float:
    """Return the larger link ratio of the two fourbars, which does not depend on their free relative size."""
    fourbars = _measure_fourbars(one)
    return float((fourbars.max(axis=1) / fourbars.min(axis=1)).max())


def _measure_fourbars(one: SixbarCandidate) -> Real:
    """Return the lengths of both fourbars, which have the same ground: shape (2, 4)."""
    at = dict(zip(one.topology.joints, one.fit.x[0::2] + 1j * one.fit.x[1::2], strict=True))
    fourbars = (("O2", "O4", "B", "A"), ("O4", "O6", "D", "C"))
    return np.array(
        [[abs(at[a] - at[b]) for a, b in zip(loop, (*loop[1:], loop[0]), strict=True)] for loop in fourbars]
    )


def _compute_max_cosine(task: FunctionTask, one: SixbarCandidate) -> float:
    """Return the largest cosine of the transmission angles at the pairs."""
    there = measure_motion(one, make_sample_points(task).inputs)
    return math.inf if there is None else float(np.abs(there.cosines).max())
