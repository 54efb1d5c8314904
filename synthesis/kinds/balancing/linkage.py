"""Linkages: exact or optimal counterweights, each verified by driving the answered linkage."""

from __future__ import annotations

from functools import partial

from synthesis.analyses.driven import Task, placed
from synthesis.kinds.balancing.design import BalancedDesign, BalancingResult
from synthesis.kinds.balancing.driven import task_of
from synthesis.kinds.balancing.force_balance import Weight, balanceable, force_balances, unpinned
from synthesis.kinds.balancing.minimize import NothingToReduce, Undetermined, minimum, setting_of
from synthesis.kinds.balancing.moment_balance import NoMomentBalance, moment_balance
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.verify_linkage import verify_linkage
from synthesis.kinds.balancing.verify_minimum import verify_minimum
from synthesis.model.kind import Progress
from synthesis.outcome.sifting import Sifting

LEAST_POSITIONS = 5
"""Minimum number of positions at which a linkage must be assembled for its motion to count."""


def solve_linkage(problem: BalancingProblem, progress: Progress) -> BalancingResult:
    """Balance a linkage."""
    task = task_of(problem)
    sifting = Sifting[BalancedDesign](problem)
    if placed(task.machine, task.positions(72)).smooth.sum() < LEAST_POSITIONS:
        return _answer(problem, sifting, "The mechanism cannot be assembled over this motion.", complete=False)
    if problem.goal == "minimize":
        return _least(problem, task, sifting, progress)
    if problem.goal == "force_and_moment":
        return _without_moment(problem, task, sifting)
    progress(0.2, "finding sets of links")
    sets = force_balances(task, problem.counterweights)
    progress(0.7, "verifying")

    def verified(weights: list[Weight]) -> BalancedDesign:
        return verify_linkage(problem, task, task.machine.mechanism, weights, {})

    sifting.sift(sets, verified)
    progress(1.0, "verified")
    # The rank of a linear system proves that no weights balance the force; listed sets are limited in number.
    complete = not sifting.rejected
    return _answer(problem, sifting, _summary(problem, task, sifting), complete=complete)


def _without_moment(problem: BalancingProblem, task: Task, sifting: Sifting[BalancedDesign]) -> BalancingResult:
    try:
        geared = moment_balance(task.machine, problem.counterweights)
    except NoMomentBalance as error:
        return _answer(problem, sifting, f"No such balance is known: {error}.", complete=False)
    verified = partial(verify_linkage, problem, task, geared.mechanism, inertias=geared.inertias)
    sifting.sift([geared.weights], verified)
    done = (
        "Neither a force nor a moment shakes the frame: the coupler acts like two masses at its pins, and gears turn "
        "an "
    )
    summary = f"{done}equal inertia against each crank." if sifting.passed else "No design found."
    return _answer(problem, sifting, summary + sifting.reasons(), complete=False)


def _least(
    problem: BalancingProblem, task: Task, sifting: Sifting[BalancedDesign], progress: Progress
) -> BalancingResult:
    progress(0.1, "measuring the linkage")
    try:
        setting = setting_of(problem, task)
    except NothingToReduce as error:
        return _answer(problem, sifting, f"The {error} is zero without counterweights; omit it.", complete=False)
    except Undetermined:
        summary = "Joint forces that redundant constraints leave undetermined cannot be minimized or capped; omit them."
        return _answer(problem, sifting, summary, complete=False)
    progress(0.4, "solving the conic programs")
    found = minimum(setting, task)
    if found.violated:
        share = 100.0 * next(iter(found.violated.values()))
        caps = _listed([name.replace("_", " ") for name in found.violated])
        summary = f"None exists: the caps cannot be met together. Raised by {share:.3g} % they could; {caps} "
        return _answer(problem, sifting, summary + "would then be reached.", complete=True)
    if not found.solved:
        return _answer(problem, sifting, "No design found: the program was not solved.", complete=False)
    progress(0.8, "verifying")
    sifting.sift([found], partial(verify_minimum, problem, task))
    if not sifting.passed:
        return _answer(problem, sifting, f"No design found.{sifting.reasons()}", complete=False)
    metrics = sifting.passed[0].metrics
    summary = f"The objective is reduced to {metrics.value:.4g}; no counterweights reduce it below {metrics.bound:.4g}."
    return _answer(problem, sifting, summary, complete=True)


def _answer(
    problem: BalancingProblem, sifting: Sifting[BalancedDesign], summary: str, *, complete: bool
) -> BalancingResult:
    return BalancingResult(
        designs=sifting.designs(list),
        search=sifting.search(problem.goal, complete=complete),
        summary=summary,
    )


def _summary(problem: BalancingProblem, task: Task, sifting: Sifting[BalancedDesign]) -> str:
    stated = problem.counterweights.links
    if sifting.passed:
        first = sifting.passed[0]
        links = [weight.link for weight in first.counterweights]
        if not links:
            return "The linkage is already balanced."
        # Balancing the force usually increases the moment.
        grown = first.metrics.shaking_moment, first.metrics.unbalanced_shaking_moment
        change = f" The shaking moment is {grown[0] / grown[1]:.3g} times the unbalanced one." if grown[1] > 0.0 else ""
        return f"Counterweights on {_listed(links)} cancel the shaking force.{change}"
    if sifting.rejected:
        return f"No design found.{sifting.reasons()}"
    loose = unpinned(task.machine.mechanism)
    theorem = "a linkage can be balanced if every link reaches the ground by a path of pins"
    if stated is not None and balanceable(task):
        return f"No weights of this size on {_listed(stated)} balance the force; weights on other links do."
    if loose:
        return f"None exists: {theorem}, and {_listed(loose)} {'has' if len(loose) == 1 else 'have'} none."
    return "None exists: no weights on the moving links balance the force."


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
