"""How a train of the search is made: its modules and shifts, and an idler where it turns the wrong way."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator

from synthesis.kinds.gear_train.design import GearTrainMechanism, Idler, Stage
from synthesis.kinds.gear_train.fitting import FittedStage
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search import Train
from synthesis.kinds.gear_train.task import Task, needs_idler
from synthesis.model.gear_answer import OfGears, Ratio
from synthesis.model.gear_stages import OF_TYPES, ring_addenda

Known = dict[tuple[int, tuple[int, int]], list[Stage]]
"""By the row of a stage and its teeth: the stage with every module that fits it."""


def stages_of(problem: GearTrainProblem, task: Task, train: Train) -> list[Stage]:
    """The meshes with their modules, and with their shifts where teeth are fitted."""
    if task.fit is not None:
        fitted = task.fit.fitted(*train)
        return [
            _fitted(problem, task, number, mesh, made)
            for number, (mesh, made) in enumerate(zip(train.meshes, fitted, strict=True))
        ]
    stages = []
    for number, ((driver, driven), mark) in enumerate(zip(train.meshes, train.marks, strict=True)):
        place = mark if problem.reverted else min(number, len(task.modules) - 1)
        plain = Stage(driver=driver, driven=driven, module=float(task.modules[place]))
        stages.append(_typed(problem, task, number, plain))
    return stages


def _typed(problem: GearTrainProblem, task: Task, number: int, stage: Stage) -> Stage:
    """A stage, counted from 0, with what its statement tells of it, where stages are stated one by one."""
    if not task.stated:
        return stage
    stated = task.stated[number]
    told = {name: stated.or_usual(name) for name in OF_TYPES if stated.or_usual(name) is not None}
    told["type"] = stated.type
    if stated.type == "internal":
        one, two = ring_addenda(stage.driver, stage.driven, math.radians(problem.pressure_angle))
        told["addendum"] = OfGears(driver=one, driven=two)
    return stage.model_copy(update=told)


def choices_of(problem: GearTrainProblem, task: Task, train: Train, known: Known) -> list[list[Stage]]:
    """The meshes with every module that each may have beside the others', the smallest module first.

    ``known`` are those of stages with a distance of their own that were asked for before; it is written to.
    """
    fit = task.fit
    if fit is None or fit.shares_distance:
        return [[stage] for stage in stages_of(problem, task, train)]
    choices = []
    for number, mesh in enumerate(train.meshes):
        key = fit.stage(number), mesh
        if key not in known:
            made = (fit.made(number, *mesh, place) for place in fit.places(number, *mesh))
            known[key] = [_fitted(problem, task, number, mesh, one) for one in made]
        choices.append(known[key])
    return choices


def _fitted(problem: GearTrainProblem, task: Task, number: int, mesh: tuple[int, int], made: FittedStage) -> Stage:
    assert task.fit is not None
    stage = Stage(
        driver=mesh[0],
        driven=mesh[1],
        module=task.fit.modules[made.module],
        shift=OfGears(driver=made.shifts[0], driven=made.shifts[1]),
        centre_distance=made.distance,
    )
    return _typed(problem, task, number, stage)


def mechanism_of(problem: GearTrainProblem, task: Task, train: Train) -> GearTrainMechanism | None:
    """The train with an idler where it turns the wrong way; None where no idler keeps the demands."""
    idlers = next(idler_choices(problem, task, train), None)
    return None if idlers is None else assembled(problem, train, stages_of(problem, task, train), idlers)


def assembled(problem: GearTrainProblem, train: Train, stages: list[Stage], idlers: list[Idler]) -> GearTrainMechanism:
    """The mechanism of a train's stages and idlers."""
    return GearTrainMechanism(
        stages=stages,
        idlers=idlers,
        ratio=Ratio.of(train.ratio * sign_of(problem, len(stages) + len(idlers))),
        pressure_angle=problem.pressure_angle,
    )


def sign_of(problem: GearTrainProblem, meshes: int) -> int:
    """Sign of the ratio of a train of so many meshes, or of the stages that are stated.

    Where shafts are not parallel it is that of rotations about their axes, as a mechanism tells them.
    """
    if problem.stages is None:
        return int((-1) ** meshes)
    opposite = sum(stage.sense < 0 or stage.hand == "left" for stage in problem.stages)
    return int((-1) ** opposite)


def idler_choices(problem: GearTrainProblem, task: Task, train: Train) -> Iterator[list[Idler]]:
    """The idlers that a train may have, the most fitting first: none where it turns as demanded, else one of them."""
    if not needs_idler(problem, len(train.drivers)):
        yield []
        return
    demands = {"any": [False], "prefer": [True, False], "require": [True]}[problem.hunting_tooth]
    for coprime in demands:
        yield from ([idler] for idler in _idlers(problem, task, train, coprime))


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
