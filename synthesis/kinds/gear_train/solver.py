"""Ordinary gear trains: the search, the idlers, and the verification of the designs."""

from __future__ import annotations

from synthesis.kinds.gear_train.carrying import Judged, judged
from synthesis.kinds.gear_train.design import (
    GearTrainDesign,
    GearTrainResult,
    GearTrainSearch,
    Idler,
    ParetoTrain,
    Stage,
)
from synthesis.kinds.gear_train.making import mechanism_of, sign_of, stages_of
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search import Outcome, Train, order, search
from synthesis.kinds.gear_train.stated_stages import GEARS
from synthesis.kinds.gear_train.task import Task, gear_train_task
from synthesis.kinds.gear_train.verification import verify
from synthesis.model.counting import grouped
from synthesis.model.gear_answer import Ratio
from synthesis.model.gear_strength import carrying_words, too_weak_words
from synthesis.model.kind import Progress
from synthesis.outcome.sifting import Sifting

SEARCHED = "Feasible centre distances are searched in steps of the sum of shifts, so this is not proven."


def solve_gear_train(problem: GearTrainProblem, progress: Progress) -> GearTrainResult:
    """Find the best gear trains for a ratio, proven by an exhaustive search."""
    progress(0.0, "listing gears")
    task = gear_train_task(problem, coprime=problem.hunting_tooth == "require")
    sifting = Sifting[GearTrainDesign](problem, undriven="gears")
    borne: Judged | None = None
    if problem.strength is None:
        outcome = _ranked(problem, task, problem.max_designs, progress)
        made = [mechanism_of(problem, task, train) for train in outcome.trains]
    else:
        borne, outcome = judged(problem, task, problem.strength, lambda n: _ranked(problem, task, n, progress))
        made = [one.mechanism for one in borne.borne]
    for mechanism in made:
        sifting.add("idler" if mechanism is None else verify(problem, mechanism))
    # A rejected candidate could hide a better design than those returned.
    complete = not sifting.rejected and not problem.searches_distances
    if borne is not None:
        sifting.reject("strength", borne.failed)
        complete = complete and (borne.every or len(made) == problem.max_designs)
    progress(1.0, "verified")
    return GearTrainResult(
        designs=sifting.designs(list),
        search=GearTrainSearch(
            **dict(sifting.search("exhaustive", complete=complete)),
            combinations=outcome.combinations,
            ties=outcome.ties,
            least_error=_least_error(task, outcome),
            judged=None if borne is None else borne.judged,
            every_judged=None if borne is None else borne.every,
        ),
        summary=_summary(problem, task, outcome, sifting.passed, borne),
        pareto=_front(problem, task, outcome) if borne is None else _borne_front(problem, task, borne),
    )


def _front(problem: GearTrainProblem, task: Task, outcome: Outcome) -> list[ParetoTrain]:
    return [
        _pareto_train(
            task, train, stages_of(problem, task, train), Ratio.of(train.ratio * sign_of(problem, len(train.drivers)))
        )
        for train in outcome.pareto
    ]


def _borne_front(problem: GearTrainProblem, task: Task, borne: Judged) -> list[ParetoTrain]:
    """Build the Pareto set of the trains that carry the power, in the form that carries it."""
    return [
        _pareto_train(task, one.train, one.mechanism.stages, one.mechanism.ratio, one.mechanism.idlers)
        for one in borne.front
    ]


def _pareto_train(
    task: Task, train: Train, stages: list[Stage], ratio: Ratio, idlers: list[Idler] | None = None
) -> ParetoTrain:
    return ParetoTrain(
        size=train.size(task.largest),
        relative_error=task.target.relative_error(train.ratio),
        stages=stages,
        ratio=ratio,
        idlers=idlers or None,
    )


def _ranked(problem: GearTrainProblem, task: Task, wanted: int, progress: Progress) -> Outcome:
    """Return the best trains of the search; among equals those with hunting teeth come first if preferred."""
    outcome = search(task, problem.exact_tolerance, wanted, progress)
    if problem.hunting_tooth != "prefer" or not outcome.trains:
        return outcome
    progress(0.0, "searching trains with hunting teeth")
    hunting = search(gear_train_task(problem, coprime=True), problem.exact_tolerance, wanted, progress)
    # Two pairings of the same gears are represented by the one with hunting teeth.
    met = {_gears(task, train) for train in hunting.trains}
    trains = [train for train in outcome.trains if _gears(task, train) not in met]
    return outcome._replace(trains=order(task, [*trains, *hunting.trains], set(hunting.trains))[:wanted])


def _gears(task: Task, train: Train) -> tuple[object, ...]:
    """Return a train's identity: its meshes if the pairing is part of it, else its drivers and driven gears."""
    alike = task.likeness[: len(train.drivers)]
    if task.reverted:
        return tuple(sorted(zip(*train, alike, strict=True)))
    return tuple(tuple(sorted(zip(alike, gears, strict=True))) for gears in (train.drivers, train.driven))


def _least_error(task: Task, outcome: Outcome) -> float | None:
    trains = [*outcome.trains, *outcome.pareto, *([outcome.nearest] if outcome.nearest else [])]
    return min((abs(task.target.relative_error(train.ratio)) for train in trains), default=None)


def _summary(
    problem: GearTrainProblem, task: Task, outcome: Outcome, accepted: list[GearTrainDesign], borne: Judged | None
) -> str:
    """Write one or two sentences: the result, or the reason why there is none."""
    number = grouped(outcome.combinations)
    if accepted and not task.by_size:
        best = accepted[0]
        stages = ", ".join(f"{s.driver}:{s.driven}" for s in best.mechanism.stages)
        error = best.metrics.relative_error
        how = "exactly the requested ratio" if error == 0.0 else f"a relative error of {error:.3g}"
        tied = "no other train is as close" if outcome.ties == 1 else f"{grouped(outcome.ties)} trains are as close"
        if borne is not None:
            return f"{stages} has {how}. {carrying_words(borne.failed)} {_scope(problem, number)}"
        return f"{stages} has {how}; {tied}. {_scope(problem, number)}"
    if accepted:
        best = accepted[0]
        stages = ", ".join(f"{s.driver}:{s.driven}" for s in best.mechanism.stages)
        within = 100.0 * float(problem.exact_tolerance or 0)
        carrying = "" if borne is None else f" {carrying_words(borne.failed)}"
        return (
            f"{stages} is the smallest train within {within:.3g} %, with a relative error of "
            f"{best.metrics.relative_error:.3g}.{carrying} {_scope(problem, number)}"
        )
    if outcome.trains:
        return "No train passed the verification."
    if borne is not None and borne.failed and problem.strength is not None:
        return too_weak_words(problem.strength, borne.failed, borne.every, borne.strongest)
    if problem.searches_distances:
        return f"No train found: {_why_none(problem, task, outcome)}. {SEARCHED}"
    return f"No such train exists: {_why_none(problem, task, outcome)}."


def _scope(problem: GearTrainProblem, number: str) -> str:
    """Describe the scope of the answer: the trains among which it is the best, and whether that is proven."""
    if problem.searches_distances:
        return f"It is the best of all {number} trains with the given tooth numbers. {SEARCHED}"
    own = any(stage.limits(name) is not None for stage in problem.stages or [] for name in GEARS)
    besides = ", with the gears given by stages unchanged" if own and problem.teeth is not None else ""
    return f"Proven over all {number} trains with the given tooth numbers{besides}."


def _why_none(problem: GearTrainProblem, task: Task, outcome: Outcome) -> str:
    """Explain why the search is empty, as the end of a sentence."""
    if not task.stage_counts:
        if problem.reverted and problem.demanded_sign < 0 and problem.most_stages < 3:
            return "in a reverted train of two stages, input and output turn in the same direction; allow three stages"
        if problem.stock is not None:
            return f"a stock of {sum(problem.stocked().values())} gears is too small for such a train"
        return "no number of stages satisfies the constraints"
    if outcome.reach is None:
        return "no two gears form a stage that satisfies the constraints"
    low, high = outcome.reach
    if outcome.nearest is not None:
        error = task.target.relative_error(outcome.nearest.ratio)
        meshes = ", ".join(f"{a}:{b}" for a, b in outcome.nearest.meshes)
        return f"the nearest train, {meshes}, has a relative error of {error:.3g}, which exceeds the tolerance"
    if task.target.compared(high) > 0 or task.target.compared(low) < 0:
        return (
            f"the ratio {float(task.target):.6g} is out of reach; the permitted meshes give {float(low):.6g} to "
            f"{float(high):.6g} in {max(task.stage_counts)} stages"
        )
    return "no combination of gears satisfies all constraints"
