"""Construction of a train found by the search: modules, profile shifts, and an idler if the direction requires one."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator

from synthesis.kinds.gear_train.design import GearTrainMechanism, Idler, Stage
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search.profile_shift_fits import FittedStage
from synthesis.kinds.gear_train.search.search import Train
from synthesis.kinds.gear_train.search.task import Task, is_idler_needed
from synthesis.model.gears.answer import GearNumbers, Ratio
from synthesis.model.gears.stages import FIELD_STAGE_TYPES, compute_ring_addenda

Known = dict[tuple[int, tuple[int, int]], list[Stage]]
"""Stages with every module that fits, by the row of a stage and its teeth."""


def build_stages(problem: GearTrainProblem, task: Task, train: Train) -> list[Stage]:
    """Build the stages with their modules, and with their shifts if teeth are fitted."""
    if task.fit is not None:
        fitted = task.fit.fit_train(*train)
        return [
            _build_fitted_stage(problem, task, number, mesh, made)
            for number, (mesh, made) in enumerate(zip(train.meshes, fitted, strict=True))
        ]
    stages = []
    for number, ((driver, driven), mark) in enumerate(zip(train.meshes, train.marks, strict=True)):
        # In a reverted train the mark selects the module of each stage. Otherwise the list gives one module per stage.
        place = mark if problem.reverted else min(number, len(task.modules) - 1)
        plain = Stage(driver=driver, driven=driven, module=float(task.modules[place]))
        stages.append(_add_type(problem, task, number, plain))
    return stages


def _add_type(problem: GearTrainProblem, task: Task, number: int, stage: Stage) -> Stage:
    """Add the requested type and its values to a stage, counted from 0, if stages are given one by one."""
    if not task.stated:
        return stage
    stated = task.stated[number]
    values = {
        name: stated.get_or_default(name) for name in FIELD_STAGE_TYPES if stated.get_or_default(name) is not None
    }
    values["type"] = stated.type
    if stated.type == "internal":
        one, two = compute_ring_addenda(stage.driver, stage.driven, math.radians(problem.pressure_angle))
        values["addendum"] = GearNumbers(driver=one, driven=two)
    return stage.model_copy(update=values)


def list_choices(problem: GearTrainProblem, task: Task, train: Train, known: Known) -> list[list[Stage]]:
    """List the meshes with every module that is compatible with the other meshes, the smallest module first.

    ``known`` is a cache of the stages with a distance of their own, to which this function adds entries.
    """
    fit = task.fit
    if fit is None or fit.shares_distance:
        return [[stage] for stage in build_stages(problem, task, train)]
    choices = []
    for number, mesh in enumerate(train.meshes):
        key = fit.stage(number), mesh
        if key not in known:
            made = (fit.fit_mesh(number, *mesh, place) for place in fit.list_module_places(number, *mesh))
            known[key] = [_build_fitted_stage(problem, task, number, mesh, one) for one in made]
        choices.append(known[key])
    return choices


def _build_fitted_stage(
    problem: GearTrainProblem, task: Task, number: int, mesh: tuple[int, int], made: FittedStage
) -> Stage:
    assert task.fit is not None
    stage = Stage(
        driver=mesh[0],
        driven=mesh[1],
        module=task.fit.modules[made.module],
        shift=GearNumbers(driver=made.shifts[0], driven=made.shifts[1]),
        centre_distance=made.distance,
    )
    return _add_type(problem, task, number, stage)


def build_mechanism(problem: GearTrainProblem, task: Task, train: Train) -> GearTrainMechanism | None:
    """Build the mechanism, with an idler if the train turns in the wrong direction; None if no idler is feasible."""
    idlers = next(iterate_idler_choices(problem, task, train), None)
    return None if idlers is None else assemble_mechanism(problem, train, build_stages(problem, task, train), idlers)


def assemble_mechanism(
    problem: GearTrainProblem, train: Train, stages: list[Stage], idlers: list[Idler]
) -> GearTrainMechanism:
    """Assemble the mechanism of a train's stages and idlers."""
    return GearTrainMechanism(
        stages=stages,
        idlers=idlers,
        ratio=Ratio.from_fraction(train.ratio * compute_sign(problem, len(stages) + len(idlers))),
        pressure_angle=problem.pressure_angle,
    )


def compute_sign(problem: GearTrainProblem, meshes: int) -> int:
    """Return the sign of the ratio of a train with this number of meshes, or of the given stages.

    If the shafts are not parallel, the sign refers to rotations about their axes as a mechanism reports them.
    """
    if problem.stages is None:
        return int((-1) ** meshes)
    # A left-handed worm reverses the axis of its gear.
    opposite = sum(stage.sense < 0 or stage.hand == "left" for stage in problem.stages)
    return int((-1) ** opposite)


def iterate_idler_choices(problem: GearTrainProblem, task: Task, train: Train) -> Iterator[list[Idler]]:
    """Yield the idlers that a train may have, the best first: none if it turns as required, else one of them."""
    if not is_idler_needed(problem, len(train.drivers)):
        yield []
        return
    demands = {"any": [False], "prefer": [True, False], "require": [True]}[problem.hunting_tooth]
    for coprime in demands:
        yield from ([idler] for idler in _iterate_idlers(problem, task, train, coprime))


def _iterate_idlers(problem: GearTrainProblem, task: Task, train: Train, coprime: bool) -> Iterator[Idler]:
    """Yield idlers that keep the constraints on meshes, the best first.

    If the two gears of a stage do not interfere with each other, an idler of intermediate size interferes with neither:
    it is no larger than the larger gear as a mate of the smaller one, and no smaller than the smaller gear as a mate of
    the larger one. The gears of the idler's stage are not required to mesh with each other; those of the other stages
    are. With ``coprime``, no mesh may have a common divisor of its tooth numbers.
    """
    # Gears of the stock that the train does not use.
    spare = Counter(problem.count_stock()) - Counter(train.drivers + train.driven)
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
