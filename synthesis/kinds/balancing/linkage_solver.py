"""Balancing of linkages: exact or optimal counterweights, each verified by driving the linkage of the answer."""

from __future__ import annotations

from functools import partial

from kinematics.message import compose
from synthesis.analyses.linkages.requested_motion import Task, place_machine
from synthesis.kinds.balancing.design import BalancedDesign, BalancingResult
from synthesis.kinds.balancing.linkage.force_balance import (
    Weight,
    find_force_balances,
    is_balanceable,
    list_unpinned_links,
)
from synthesis.kinds.balancing.linkage.minimize import (
    NothingToReduce,
    UndeterminedForces,
    build_setting,
    find_minimum,
    write_quantity_name,
)
from synthesis.kinds.balancing.linkage.moment_balance import NoMomentBalance, find_moment_balance
from synthesis.kinds.balancing.linkage.motion import build_balancing_task
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.verification.linkage import verify_linkage
from synthesis.kinds.balancing.verification.minimum import verify_minimum
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.remarks import append_remark, list_with_and

MIN_POSITIONS = 5
"""Minimum number of positions at which a linkage must be assembled for its motion to count."""


def solve_linkage(problem: BalancingProblem, progress: Progress) -> BalancingResult:
    """Balance a linkage."""
    task = build_balancing_task(problem)
    sifting = CandidateLog[BalancedDesign](problem)
    if place_machine(task.machine, task.list_positions(72)).smooth.sum() < MIN_POSITIONS:
        return _build_result(problem, sifting, compose("balancing-mechanism-not-assembled"), complete=False)
    if problem.goal == "minimize":
        return _minimize_forces(problem, task, sifting, progress)
    if problem.goal == "force_and_moment":
        return _balance_moment(problem, task, sifting)
    progress(0.2, compose("balancing-finding-links"))
    sets = find_force_balances(task, problem.counterweights)
    progress(0.7, compose("results-verifying"))

    def verify_weights(weights: list[Weight]) -> BalancedDesign:
        return verify_linkage(problem, task, task.machine.mechanism, weights, {})

    sifting.verify_candidates(sets, verify_weights)
    progress(1.0, compose("results-verified"))
    # The rank of the linear system proves that no weights balance the force.
    complete = not sifting.rejected
    return _build_result(problem, sifting, _write_summary(problem, task, sifting), complete=complete)


def _balance_moment(problem: BalancingProblem, task: Task, sifting: CandidateLog[BalancedDesign]) -> BalancingResult:
    try:
        geared = find_moment_balance(task.machine, problem.counterweights)
    except NoMomentBalance as error:
        return _build_result(
            problem, sifting, compose("balancing-no-moment-balance-known", reason=str(error)), complete=False
        )
    verified = partial(verify_linkage, problem, task, geared.mechanism, inertias=geared.inertias)
    sifting.verify_candidates([geared.weights], verified)
    summary = compose("balancing-moment-balanced" if sifting.passed else "balancing-none-found")
    return _build_result(problem, sifting, append_remark(summary, sifting.describe_reasons()), complete=False)


def _minimize_forces(
    problem: BalancingProblem, task: Task, sifting: CandidateLog[BalancedDesign], progress: Progress
) -> BalancingResult:
    progress(0.1, compose("balancing-measuring-linkage"))
    try:
        setting = build_setting(problem, task)
    except NothingToReduce as error:
        return _build_result(
            problem, sifting, compose("balancing-objective-zero-already", quantity=str(error)), complete=False
        )
    except UndeterminedForces:
        summary = compose("balancing-joint-forces-undetermined")
        return _build_result(problem, sifting, summary, complete=False)
    progress(0.4, compose("balancing-solving-programs"))
    found = find_minimum(setting, task)
    if found.violated:
        share = 100.0 * next(iter(found.violated.values()))
        caps = list_with_and([write_quantity_name(name) for name in found.violated])
        summary = compose("balancing-caps-not-met", share=f"{share:.3g}", caps=caps)
        return _build_result(problem, sifting, summary, complete=True)
    if not found.solved:
        return _build_result(problem, sifting, compose("balancing-program-not-solved"), complete=False)
    progress(0.8, compose("results-verifying"))
    sifting.verify_candidates([found], partial(verify_minimum, problem, task))
    if not sifting.passed:
        return _build_result(problem, sifting, _describe_failure(sifting), complete=False)
    metrics = sifting.passed[0].metrics
    summary = compose("balancing-objective-reduced", value=f"{metrics.value:.4g}", bound=f"{metrics.bound:.4g}")
    return _build_result(problem, sifting, summary, complete=True)


def _build_result(
    problem: BalancingProblem, sifting: CandidateLog[BalancedDesign], summary: str, *, complete: bool
) -> BalancingResult:
    return BalancingResult(
        designs=sifting.select_designs(list),
        search=sifting.build_search(problem.goal, complete=complete),
        summary=summary,
    )


def _write_summary(problem: BalancingProblem, task: Task, sifting: CandidateLog[BalancedDesign]) -> str:
    stated = problem.counterweights.links
    if sifting.passed:
        first = sifting.passed[0]
        links = [weight.link for weight in first.counterweights]
        if not links:
            return compose("balancing-balanced-already")
        # Balancing the force usually increases the moment.
        grown = first.metrics.shaking_moment, first.metrics.unbalanced_shaking_moment
        change = ""
        if grown[1] > 0.0:
            change = compose("balancing-moment-changed", ratio=f"{grown[0] / grown[1]:.3g}")
        return append_remark(compose("balancing-force-balanced", links=list_with_and(links)), change)
    if sifting.rejected:
        return _describe_failure(sifting)
    loose = list_unpinned_links(task.machine.mechanism)
    if stated is not None and is_balanceable(task):
        return compose("balancing-weights-on-other-links", links=list_with_and(stated))
    if loose:
        # A linkage can be balanced if every link reaches the ground by a path of pins.
        return compose("balancing-links-without-pins", links=list_with_and(loose), count=len(loose))
    return compose("balancing-no-weights-balance-force")


def _describe_failure(sifting: CandidateLog[BalancedDesign]) -> str:
    return append_remark(compose("balancing-none-found"), sifting.describe_reasons())
