"""Ordinary gear trains: the search, the idlers, and the verification of what is returned."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator

from synthesis.kinds.gear_train.design import (
    GearTrainDesign,
    GearTrainMechanism,
    GearTrainResult,
    GearTrainSearch,
    Idler,
    ParetoTrain,
    Stage,
)
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search import Outcome, Train, order, search
from synthesis.kinds.gear_train.task import Task, gear_train_task, needs_idler
from synthesis.kinds.gear_train.verification import verify
from synthesis.model.gear_answer import OfGears, Ratio
from synthesis.model.kind import Progress
from synthesis.outcome.sifting import Sifting

SEARCHED = "Which distances suit a pair is searched in steps of the sum of shifts, not proven."


def solve_gear_train(problem: GearTrainProblem, progress: Progress) -> GearTrainResult:
    """The best gear trains for a ratio, proven by an exhaustive search."""
    progress(0.0, "listing gears")
    task = gear_train_task(problem, coprime=problem.hunting_tooth == "require")
    outcome = search(task, problem.exact_tolerance, problem.max_designs, progress)
    trains = outcome.trains
    if problem.hunting_tooth == "prefer" and trains:
        progress(0.0, "searching trains with hunting teeth")
        hunting = search(gear_train_task(problem, coprime=True), problem.exact_tolerance, problem.max_designs, progress)
        # Of the same gears in another pairing, the one with hunting teeth stands for both.
        met = {_gears(task, train) for train in hunting.trains}
        trains = [train for train in trains if _gears(task, train) not in met]
        trains = order(task, [*trains, *hunting.trains], set(hunting.trains))[: problem.max_designs]
    sifting = Sifting[GearTrainDesign](problem, undriven="gears")
    for train in trains:
        mechanism = mechanism_of(problem, task, train)
        sifting.add("idler" if mechanism is None else verify(problem, mechanism))
    progress(1.0, "verified")
    return GearTrainResult(
        designs=sifting.designs(list),
        search=GearTrainSearch(
            **dict(sifting.search("exhaustive", complete=not sifting.rejected and not problem.searches_distances)),
            combinations=outcome.combinations,
            ties=outcome.ties,
            least_error=_least_error(task, outcome),
        ),
        summary=_summary(problem, task, outcome, sifting.passed),
        pareto=[
            ParetoTrain(
                size=train.size(task.largest),
                relative_error=task.target.relative_error(train.ratio),
                stages=_stages(problem, task, train),
                ratio=Ratio.of(train.ratio * (-1) ** len(train.drivers)),
            )
            for train in outcome.pareto
        ],
    )


def _gears(task: Task, train: Train) -> tuple[object, ...]:
    """What tells a train from others: its meshes where the pairing is part of it, else its drivers and driven gears."""
    if task.reverted:
        return tuple(sorted(zip(*train, strict=True)))
    return tuple(sorted(train.drivers)), tuple(sorted(train.driven))


def _least_error(task: Task, outcome: Outcome) -> float | None:
    trains = [*outcome.trains, *outcome.pareto, *([outcome.nearest] if outcome.nearest else [])]
    return min((abs(task.target.relative_error(train.ratio)) for train in trains), default=None)


def _stages(problem: GearTrainProblem, task: Task, train: Train) -> list[Stage]:
    """The meshes with their modules, and with their shifts where teeth are fitted."""
    if task.fit is not None:
        return [
            Stage(
                driver=driver,
                driven=driven,
                module=task.fit.modules[made.module],
                shift=OfGears(driver=made.shifts[0], driven=made.shifts[1]),
                centre_distance=made.distance,
            )
            for (driver, driven), made in zip(train.meshes, task.fit.fitted(*train), strict=True)
        ]
    stages = []
    for number, ((driver, driven), mark) in enumerate(zip(train.meshes, train.marks, strict=True)):
        place = mark if problem.reverted else min(number, len(task.modules) - 1)
        stages.append(Stage(driver=driver, driven=driven, module=float(task.modules[place])))
    return stages


def mechanism_of(problem: GearTrainProblem, task: Task, train: Train) -> GearTrainMechanism | None:
    """The train with an idler where it turns the wrong way; None where no idler keeps the demands."""
    ratio, idlers = train.ratio * (-1) ** len(train.drivers), []
    if needs_idler(problem, len(train.drivers)):
        demands = {"any": [False], "prefer": [True, False], "require": [True]}[problem.hunting_tooth]
        idler = next((idler for coprime in demands for idler in _idlers(problem, task, train, coprime)), None)
        if idler is None:
            return None
        ratio, idlers = -ratio, [idler]
    return GearTrainMechanism(
        stages=_stages(problem, task, train),
        idlers=idlers,
        ratio=Ratio.of(ratio),
        pressure_angle=problem.pressure_angle,
    )


def _idlers(problem: GearTrainProblem, task: Task, train: Train, coprime: bool) -> Iterator[Idler]:
    """Idlers that keep the demands on meshes, from the most fitting.

    Between the sizes of the two gears of a stage an idler never interferes if they do not with one another: it is no
    larger a mate of the smaller and no smaller a mate of the larger. The gears of its stage need not be fit to mesh
    with one another, those of the other stages have to. ``coprime``: all meshes without a common divisor.
    """
    spare = Counter(problem.stocked()) - Counter(train.drivers + train.driven)
    for number, (driver, driven) in enumerate(train.meshes, 1):
        others = [mesh for place, mesh in enumerate(train.meshes, 1) if place != number]
        if not all(task.allowed[mesh] and (not coprime or math.gcd(*mesh) == 1) for mesh in others):
            continue
        small, large = min(driver, driven), max(driver, driven)
        choices = [int(n) for n in task.idlers if problem.stock is None or n in spare]
        for teeth in sorted(choices, key=lambda n: (not small <= n <= large, n)):
            pairs = [(driver, teeth), (teeth, driven)]
            if all(task.sound[pair] and (not coprime or math.gcd(*pair) == 1) for pair in pairs):
                yield Idler(stage=number, teeth=teeth)


def _summary(problem: GearTrainProblem, task: Task, outcome: Outcome, accepted: list[GearTrainDesign]) -> str:
    """One or two sentences: what was found, or why there is nothing."""
    number = f"{outcome.combinations:,}".replace(",", " ")
    if accepted and not task.by_size:
        best = accepted[0]
        stages = ", ".join(f"{s.driver}:{s.driven}" for s in best.mechanism.stages)
        error = best.metrics.relative_error
        how = "exactly the ratio" if error == 0.0 else f"a relative error of {error:.3g}"
        tied = "no other train is as near" if outcome.ties == 1 else f"{outcome.ties} trains are as near"
        return f"{stages} has {how}; {tied}. {_scope(problem, number)}"
    if accepted:
        best = accepted[0]
        stages = ", ".join(f"{s.driver}:{s.driven}" for s in best.mechanism.stages)
        within = 100.0 * float(problem.exact_tolerance or 0)
        return (
            f"{stages} is the smallest train within {within:.3g} %, with a relative error of "
            f"{best.metrics.relative_error:.3g}. {_scope(problem, number)}"
        )
    if outcome.trains:
        return "No train passed the verification."
    if problem.searches_distances:
        return f"No such train was found: {_why_none(problem, task, outcome)}. {SEARCHED}"
    return f"There is no such train: {_why_none(problem, task, outcome)}."


def _scope(problem: GearTrainProblem, number: str) -> str:
    """What the answer is the best of, and whether that is proven."""
    if problem.searches_distances:
        return f"It is the best of all {number} trains of the tooth numbers stated. {SEARCHED}"
    return f"Proven over all {number} trains of the tooth numbers stated."


def _why_none(problem: GearTrainProblem, task: Task, outcome: Outcome) -> str:
    """The reason why the search is empty, as the end of a sentence."""
    if not task.stage_counts:
        if problem.reverted and problem.demanded_sign < 0 and problem.max_stages < 3:
            return "a reverted train of two stages turns input and output alike; allow three stages"
        if problem.stock is not None:
            return f"a stock of {sum(problem.stocked().values())} gears is too small for a train of the kind asked"
        return "no number of stages fits the demands"
    if outcome.reach is None:
        return "no two gears make a stage that keeps the demands"
    low, high = outcome.reach
    if outcome.nearest is not None:
        error = task.target.relative_error(outcome.nearest.ratio)
        meshes = ", ".join(f"{a}:{b}" for a, b in outcome.nearest.meshes)
        return f"the nearest of all, {meshes}, has a relative error of {error:.3g}, beyond the tolerance"
    if task.target.compared(high) > 0 or task.target.compared(low) < 0:
        return (
            f"the ratio {float(task.target):.6g} is out of reach, the meshes allowed give {float(low):.6g} to "
            f"{float(high):.6g} in {max(task.stage_counts)} stages"
        )
    return "no gears keep all demands together"
