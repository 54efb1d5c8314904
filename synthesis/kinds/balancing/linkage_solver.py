"""Balancing of linkages: exact or optimal counterweights, each verified by driving the linkage of the answer."""

from __future__ import annotations

from functools import partial

from synthesis.analyses.linkages.requested_motion import Task, place_machine
from synthesis.kinds.balancing.design import BalancedDesign, BalancingResult
from synthesis.kinds.balancing.linkage.force_balance import (
    Weight,
    find_force_balances,
    is_balanceable,
    list_unpinned_links,
)
from synthesis.kinds.balancing.linkage.minimize import NothingToReduce, UndeterminedForces, build_setting, find_minimum
from synthesis.kinds.balancing.linkage.moment_balance import NoMomentBalance, find_moment_balance
from synthesis.kinds.balancing.linkage.motion import build_balancing_task
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.verification.linkage import verify_linkage
from synthesis.kinds.balancing.verification.minimum import verify_minimum
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog

MIN_POSITIONS = 5
"""Minimum number of positions at which a linkage must be assembled for its motion to count."""


def solve_linkage(problem: BalancingProblem, progress: Progress) -> BalancingResult:
    """Balance a linkage."""
    task = build_balancing_task(problem)
    sifting = CandidateLog[BalancedDesign](problem)
    if place_machine(task.machine, task.list_positions(72)).smooth.sum() < MIN_POSITIONS:
        return _build_result(problem, sifting, "The mechanism cannot be assembled over this motion.", complete=False)
    if problem.goal == "minimize":
        return _minimize_forces(problem, task, sifting, progress)
    if problem.goal == "force_and_moment":
        return _balance_moment(problem, task, sifting)
    progress(0.2, "finding sets of links")
    sets = find_force_balances(task, problem.counterweights)
    progress(0.7, "verifying")

    def verify_weights(weights: list[Weight]) -> BalancedDesign:
        return verify_linkage(problem, task, task.machine.mechanism, weights, {})

    sifting.verify_candidates(sets, verify_weights)
    progress(1.0, "verified")
    # The rank of the linear system proves that no weights balance the force.
    complete = not sifting.rejected
    return _build_result(problem, sifting, _write_summary(problem, task, sifting), complete=complete)


def _balance_moment(problem: BalancingProblem, task: Task, sifting: CandidateLog[BalancedDesign]) -> BalancingResult:
    try:
        geared = find_moment_balance(task.machine, problem.counterweights)
    except NoMomentBalance as error:
        return _build_result(problem, sifting, f"No such balance is known: {error}.", complete=False)
    verified = partial(verify_linkage, problem, task, geared.mechanism, inertias=geared.inertias)
    sifting.verify_candidates([geared.weights], verified)
    done = (
        "Neither a force nor a moment shakes the frame: the coupler acts like two masses at its pins, and gears turn "
        "an "
    )
    summary = f"{done}equal inertia against each crank." if sifting.passed else "No design found."
    return _build_result(problem, sifting, summary + sifting.describe_reasons(), complete=False)


def _minimize_forces(
    problem: BalancingProblem, task: Task, sifting: CandidateLog[BalancedDesign], progress: Progress
) -> BalancingResult:
    progress(0.1, "measuring the linkage")
    try:
        setting = build_setting(problem, task)
    except NothingToReduce as error:
        return _build_result(problem, sifting, f"The {error} is zero without counterweights; omit it.", complete=False)
    except UndeterminedForces:
        summary = "Joint forces that redundant constraints leave undetermined cannot be minimized or capped; omit them."
        return _build_result(problem, sifting, summary, complete=False)
    progress(0.4, "solving the conic programs")
    found = find_minimum(setting, task)
    if found.violated:
        share = 100.0 * next(iter(found.violated.values()))
        caps = _join_names([name.replace("_", " ") for name in found.violated])
        summary = f"None exists: the caps cannot be met together. Raised by {share:.3g} % they could; {caps} "
        return _build_result(problem, sifting, summary + "would then be reached.", complete=True)
    if not found.solved:
        return _build_result(problem, sifting, "No design found: the program was not solved.", complete=False)
    progress(0.8, "verifying")
    sifting.verify_candidates([found], partial(verify_minimum, problem, task))
    if not sifting.passed:
        return _build_result(problem, sifting, f"No design found.{sifting.describe_reasons()}", complete=False)
    metrics = sifting.passed[0].metrics
    summary = f"The objective is reduced to {metrics.value:.4g}; no counterweights reduce it below {metrics.bound:.4g}."
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
            return "The linkage is already balanced."
        # Balancing the force usually increases the moment.
        grown = first.metrics.shaking_moment, first.metrics.unbalanced_shaking_moment
        change = f" The shaking moment is {grown[0] / grown[1]:.3g} times the unbalanced one." if grown[1] > 0.0 else ""
        return f"Counterweights on {_join_names(links)} cancel the shaking force.{change}"
    if sifting.rejected:
        return f"No design found.{sifting.describe_reasons()}"
    loose = list_unpinned_links(task.machine.mechanism)
    theorem = "a linkage can be balanced if every link reaches the ground by a path of pins"
    if stated is not None and is_balanceable(task):
        return f"No weights of this size on {_join_names(stated)} balance the force; weights on other links do."
    if loose:
        return f"None exists: {theorem}, and {_join_names(loose)} {'has' if len(loose) == 1 else 'have'} none."
    return "None exists: no weights on the moving links balance the force."


def _join_names(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
