"""Spring balancing: the best springs by programs or by search, each verified by driving the answer."""

from __future__ import annotations

from functools import partial

from kinematics.message import compose
from synthesis.kinds.spring_balancing.branching import branch_and_bound
from synthesis.kinds.spring_balancing.design import SpringBalancingResult, SprungDesign
from synthesis.kinds.spring_balancing.effects import Setting
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.kinds.spring_balancing.search import search_springs
from synthesis.kinds.spring_balancing.verification import verify_springs
from synthesis.model.kind import Progress, scale_progress
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.ranking import select_best, sort_designs
from synthesis.results.remarks import append_remark

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
    progress(0.0, compose("spring_balancing-measuring-linkage"))
    setting = Setting(problem)
    sifting = CandidateLog[SprungDesign](problem)
    if len(setting.at) < MIN_POSITIONS:
        return _build_result(sifting, "exact", compose("spring_balancing-mechanism-not-held"), complete=False)
    if not setting.peak > ZERO_TOLERANCE * setting.parts:
        text = compose("spring_balancing-drive-zero-already")
        return _build_result(sifting, "exact", text, complete=True)
    report = scale_progress(progress, 0.1, 0.8)
    places = [setting.list_corners(spring) for spring in problem.springs]
    if all(spring.convex or spring.is_superposable for spring in problem.springs):
        method = "convex" if all(spring.convex for spring in problem.springs) else "branch_and_bound"
        best = branch_and_bound(setting, places, partial(_report_share, report))
        if best.status == "infeasible":
            text = compose("spring_balancing-no-springs-within-limits")
            return _build_result(sifting, method, text, complete=True)
        found, bound, proved = [best.springs] if best.status == "solved" else [], best.bound, best.proved
    else:
        method, bound, proved = "search", None, False
        found = search_springs(setting, partial(_report_share, report))
    progress(0.8, compose("results-verifying"))
    sifting.verify_candidates(found, partial(verify_springs, setting, bound=bound, proved=proved))
    progress(1.0, compose("results-verified"))
    exact = bool(sifting.passed) and sifting.passed[0].metrics.exact
    return _build_result(
        sifting, method, _write_summary(sifting, proved or exact), complete=(proved or exact) and bool(sifting.passed)
    )


def _report_share(progress: Progress, share: float) -> None:
    progress(share, compose("spring_balancing-finding-springs"))


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
        return append_remark(compose("spring_balancing-none-found"), sifting.describe_reasons())
    metrics = select_best(sifting.passed, _get_value).metrics
    if metrics.exact:
        constant = metrics.energy_variation is not None
        return compose("spring_balancing-exact-with-constant-energy" if constant else "spring_balancing-exact")
    value = f"{metrics.value:.4g}"
    if metrics.bound is None:
        return compose("spring_balancing-best-found", value=value)
    known = "spring_balancing-proven-minimum" if proved else "spring_balancing-bounded-minimum"
    return compose(known, value=value, bound=f"{metrics.bound:.4g}")
