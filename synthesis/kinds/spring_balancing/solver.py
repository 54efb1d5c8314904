"""Spring balancing: the best springs by programs or by search, each verified by driving the answer."""

from __future__ import annotations

from functools import partial

from synthesis.kinds.spring_balancing.branching import branch_and_bound
from synthesis.kinds.spring_balancing.design import SpringBalancingResult, SprungDesign
from synthesis.kinds.spring_balancing.effects import Setting
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.kinds.spring_balancing.search import search_springs
from synthesis.kinds.spring_balancing.verification import verify_springs
from synthesis.model.kind import Progress, scale_progress
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.ranking import select_best, sort_designs

MIN_POSITIONS = 5
"""Minimum number of positions with known forces for a motion to count."""

ZERO_TOLERANCE = 1e-12
"""Drive as a share of the magnitudes of its parts that counts as zero: rounding."""


def solve_spring_balancing(problem: SpringBalancingProblem, progress: Progress) -> SpringBalancingResult:
    """Solve a problem of spring balancing.

    Returns
    -------
    SpringBalancingResult
        Complete if the springs are proven to be the best, or none exist.
    """
    progress(0.0, "measuring the linkage")
    setting = Setting(problem)
    sifting = CandidateLog[SprungDesign](problem)
    if len(setting.at) < MIN_POSITIONS:
        return _build_result(sifting, "exact", "The mechanism cannot be held over this motion.", complete=False)
    if not setting.peak > ZERO_TOLERANCE * setting.parts:
        text = "The drive is zero without springs; there is nothing to balance."
        return _build_result(sifting, "exact", text, complete=True)
    report = scale_progress(progress, 0.1, 0.8)
    places = [setting.list_corners(spring) for spring in problem.springs]
    if all(spring.convex or spring.is_superposable for spring in problem.springs):
        method = "convex" if all(spring.convex for spring in problem.springs) else "branch_and_bound"
        best = branch_and_bound(setting, places, partial(_report_share, report))
        if best.status == "infeasible":
            text = "None exists: no such springs keep their limits over this motion."
            return _build_result(sifting, method, text, complete=True)
        found, bound, proved = [best.springs] if best.status == "solved" else [], best.bound, best.proved
    else:
        method, bound, proved = "search", None, False
        found = search_springs(setting, partial(_report_share, report))
    progress(0.8, "verifying")
    sifting.verify_candidates(found, partial(verify_springs, setting, bound=bound, proved=proved))
    progress(1.0, "verified")
    exact = bool(sifting.passed) and sifting.passed[0].metrics.exact
    return _build_result(
        sifting, method, _write_summary(sifting, proved or exact), complete=(proved or exact) and bool(sifting.passed)
    )


def _report_share(progress: Progress, share: float) -> None:
    progress(share, "finding springs")


def _build_result(
    sifting: CandidateLog[SprungDesign], method: str, summary: str, *, complete: bool
) -> SpringBalancingResult:
    return SpringBalancingResult(
        designs=sifting.select_designs(lambda designs: sort_designs(designs, _get_value)),
        search=sifting.build_search(method, complete=complete),
        summary=summary,
    )


def _get_value(design: SprungDesign) -> float:
    return design.metrics.value


def _write_summary(sifting: CandidateLog[SprungDesign], proved: bool) -> str:
    if not sifting.passed:
        return f"No design found.{sifting.describe_reasons()}"
    metrics = select_best(sifting.passed, _get_value).metrics
    if metrics.exact:
        energy = "" if metrics.energy_variation is None else " and the potential energy constant"
        return f"The springs balance the linkage exactly: the drive is zero{energy} over the motion."
    reduction = f"The springs reduce the drive to {metrics.value:.4g} of its unbalanced value"
    if metrics.bound is None:
        return f"{reduction}. This is the best found, not a proven minimum."
    known = f"no such springs reduce it below {metrics.bound:.4g}"
    return f"{reduction}; {known}." if proved else f"{reduction}; {known}. The values in between are undecided."
