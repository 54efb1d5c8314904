"""Which trains carry a stated power: in which order of their stages, with which modules and over which faces.

The search orders trains by error or size whatever they carry. They are judged in that order, so that the first that
carry the power are the best that do, and where all trains of the search were judged there is no other. Those behind
them are judged too, up to a limit, for the ties and the Pareto set. What a train has to carry is the power at the speed
of each of its shafts; a mesh carries more of it the faster it turns.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cmp_to_key
from typing import Any, NamedTuple

from kinematics.gear.train import TrainStage
from synthesis.kinds.gear_train.design import GearTrainMechanism, Idler, Stage
from synthesis.kinds.gear_train.making import Known, assembled, choices_of, idler_choices
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search import Outcome, Train, order
from synthesis.kinds.gear_train.stated_train import NEAR
from synthesis.kinds.gear_train.task import Task, needs_idler
from synthesis.model.dynamics import METRES
from synthesis.model.gear_strength import (
    EQUAL,
    CarriedPower,
    Judge,
    Loaded,
    bent_both_ways,
    common_width,
    stage_contact,
)
from synthesis.outcome.exhaustive import pareto

FIRST_JUDGED, MOST_JUDGED = 64, 1024
"""Trains that are judged at first, and at most."""

MOST_TRIED = 10_000
"""Orders of stages, pairings and idlers of all trains together after which no further train is judged."""


class Borne(NamedTuple):
    """A train as it carries the power: its stages, whose least faces are yet to be found, and its idlers."""

    train: Train
    stages: list[Stage]
    idlers: list[Idler]


class Made(NamedTuple):
    """A train that carries the power, and how it is made."""

    train: Train
    mechanism: GearTrainMechanism


class Judged(NamedTuple):
    """What became of the trains of a search.

    ``borne`` are the best that carry the power, ``front`` the Pareto set of all judged that do. ``failed`` of those
    that rank before the last of them do not; the ``strongest`` of all carries so many W (0: not known, of trains with
    idlers). ``every``: the search has no trains but the ``judged``.
    """

    borne: list[Made]
    front: list[Made]
    failed: int
    strongest: float
    judged: int
    every: bool


@dataclass
class Bearing:
    """What the meshes of a problem carry; each is judged once."""

    problem: GearTrainProblem
    task: Task
    stated: CarriedPower
    tried: int = 0
    strongest: float = 0.0
    _judges: dict[_Turning, Judge] = field(default_factory=dict)
    _choices: Known = field(default_factory=dict)

    def carrying(self, train: Train) -> Borne | None:
        """The first arrangement of a train that carries the power; None where none does."""
        for arranged in arrangements(self.problem, self.task, train):
            self.tried += 1
            idle = needs_idler(self.problem, len(arranged.drivers))
            found = self._with_idler(arranged) if idle else self._without(arranged)
            if found is not None:
                return found
        return None

    def _without(self, train: Train) -> Borne | None:
        stages, weakest = [], math.inf
        for choices, speed in self._loaded(train):
            weakest = min(weakest, max(self._power(stage, (), speed) for stage in choices))
            stages.append(self._smallest(choices, (), speed))
        self.strongest = max(self.strongest, weakest)
        return self._faced(train, stages, [])

    def _with_idler(self, train: Train) -> Borne | None:
        """One stage has an idler, and needs not carry the power without."""
        loaded = list(self._loaded(train))
        plain = [self._smallest(choices, (), speed) for choices, speed in loaded]
        weak = {number for number, stage in enumerate(plain, 1) if stage is None}
        for idlers in idler_choices(self.problem, self.task, train):
            self.tried += 1
            place = idlers[0].stage
            if weak <= {place}:
                choices, speed = loaded[place - 1]
                stage = self._smallest(choices, (idlers[0].teeth,), speed)
                found = self._faced(train, [*plain[: place - 1], stage, *plain[place:]], idlers)
                if found is not None:
                    return found
        return None

    def _loaded(self, train: Train) -> Iterator[tuple[list[Stage], float]]:
        """The stages that a train may have in each place, and the speed of the shaft that drives them, rad/s."""
        speed = self.stated.speed
        listed = choices_of(self.problem, self.task, train, self._choices)
        for choices, (driver, driven) in zip(listed, train.meshes, strict=True):
            yield choices, speed
            speed *= driver / driven

    def _smallest(self, choices: list[Stage], idlers: tuple[int, ...], speed: float) -> Stage | None:
        """A stage with its least module that carries the power."""
        return next((stage for stage in choices if self._enough(self._power(stage, idlers, speed))), None)

    def _faced(self, train: Train, stages: list[Stage | None], idlers: list[Idler]) -> Borne | None:
        """The train, if its stages have faces that carry the power; those are looked for where rounding decides."""
        chosen = [stage for stage in stages if stage is not None]
        if len(chosen) < len(stages):
            return None
        borne = Borne(train, chosen, idlers)
        weakest = min(self._power(stage, between, speed) for stage, between, speed in self._driven(borne))
        if weakest < self.stated.power * (1.0 + EQUAL) and None in self._faces(borne):
            return None
        return borne

    def made(self, borne: Borne) -> Made:
        """A train with the least faces of its stages."""
        faced = [
            stage.model_copy(update={"face_width": width})
            for stage, width in zip(borne.stages, self._faces(borne), strict=True)
        ]
        return Made(borne.train, assembled(self.problem, borne.train, faced, borne.idlers))

    def _faces(self, borne: Borne) -> list[float | None]:
        """The least face of each stage; None of one that does not carry the power."""
        return [self._width(stage, between, speed) for stage, between, speed in self._driven(borne)]

    def _driven(self, borne: Borne) -> Iterator[tuple[Stage, tuple[int, ...], float]]:
        """Each stage with the teeth of its idlers and the speed of the shaft that drives it, rad/s."""
        speed = self.stated.speed
        for number, stage in enumerate(borne.stages, 1):
            yield stage, tuple(idler.teeth for idler in borne.idlers if idler.stage == number), speed
            speed *= stage.driver / stage.driven

    def _enough(self, power: float) -> bool:
        return power >= self.stated.power * (1.0 - EQUAL)

    def _power(self, stage: Stage, idlers: tuple[int, ...], speed: float) -> float:
        """The greatest power that all meshes of a stage carry."""
        return min(self._judge(mesh).carried_power(turning) for mesh, turning in _meshes(stage, idlers, speed))

    def _width(self, stage: Stage, idlers: tuple[int, ...], speed: float) -> float | None:
        """The least face, in the problem's unit, over which all meshes of a stage carry the power."""
        meshes = _meshes(stage, idlers, speed)
        loaded = [self._judge(mesh).under(self.stated.power, turning) for mesh, turning in meshes]
        width = common_width(loaded, self.stated.kept)
        return None if width is None else width / self._unit

    def _judge(self, mesh: _Turning) -> Judge:
        if mesh not in self._judges:
            contact = stage_contact(mesh.alone, 0, math.radians(self.problem.pressure_angle), self._unit)
            loaded = Loaded(
                contact, self.stated.power, self.stated.speed, mesh.both_ways, helix_angle=mesh.alone.helix_angle
            )
            self._judges[mesh] = Judge(loaded, self.stated)
        return self._judges[mesh]

    @property
    def _unit(self) -> float:
        return 1000.0 * METRES[self.problem.length_unit]


class _Turning(NamedTuple):
    """A mesh as a stage of its own, and which of its two gears are bent both ways."""

    alone: TrainStage
    both_ways: tuple[bool, bool]


def _meshes(stage: Stage, idlers: tuple[int, ...], speed: float) -> Iterator[tuple[_Turning, float]]:
    """The meshes of a stage, and how fast the first gear of each turns, rad/s."""
    gears = (stage.driver, *idlers, stage.driven)
    shifts = (0.0, 0.0) if stage.shift is None else (stage.shift.driver, stage.shift.driven)
    whole = TrainStage(stage.driver, stage.driven, stage.module, idlers)
    for place, (one, other) in enumerate(itertools.pairwise(gears)):
        alone = TrainStage(one, other, stage.module, (), shifts)
        if stage.type == "internal" and stage.addendum is not None:
            alone = replace(alone, kind="internal", addenda=(stage.addendum.driver, stage.addendum.driven))
        if stage.type == "helical" and stage.helix_angle is not None:
            alone = replace(alone, kind="helical", helix_angle=math.radians(stage.helix_angle))
        yield _Turning(alone, bent_both_ways(whole, place)), speed * stage.driver / one


def arrangements(problem: GearTrainProblem, task: Task, train: Train) -> list[Train]:
    """A train with its stages in every order and its gears in every pairing that the demands allow.

    Reverted trains keep their pairing. Those of the smallest largest stage ratio come first, of them the train itself.
    """
    k = len(train.drivers)
    numbers = [(set(task.drivers[i].tolist()), set(task.driven[i].tolist()), task.stages(k, i)) for i in range(k)]
    found = set()
    orders = [
        places
        for places in itertools.permutations(range(k))
        if all(task.likeness[i] == task.likeness[j] for i, j in enumerate(places))
    ]
    for places in orders:
        for mates in [places] if task.reverted else orders:
            meshes = [(train.drivers[i], train.driven[j]) for i, j in zip(places, mates, strict=True)]
            if all(
                a in own and b in others and ok[a, b] for (a, b), (own, others, ok) in zip(meshes, numbers, strict=True)
            ):
                drivers, driven = zip(*meshes, strict=True)
                found.add(Train(drivers, driven, tuple(train.marks[i] for i in places)))

    def key(one: Train) -> tuple[Any, ...]:
        shared = problem.hunting_tooth == "prefer" and not hunts(one)
        return shared, max(max(mesh) / min(mesh) for mesh in one.meshes), one != train, one

    return sorted(found, key=key)


def hunts(train: Train) -> bool:
    """Whether the teeth of every mesh have no common divisor."""
    return all(math.gcd(*mesh) == 1 for mesh in train.meshes)


def judged(
    problem: GearTrainProblem, task: Task, stated: CarriedPower, ranked: Callable[[int], Outcome]
) -> tuple[Judged, Outcome]:
    """The best trains that carry a power, and the search with the ties of those that do.

    Parameters
    ----------
    ranked : callable
        The best so many trains of the search.
    """
    bearing = Bearing(problem, task, stated)
    verdicts: dict[Train, Borne | None] = {}
    wanted = max(FIRST_JUDGED, problem.max_designs)
    while True:
        outcome = ranked(wanted)
        for train in outcome.trains:
            if train not in verdicts and bearing.tried < MOST_TRIED:
                verdicts[train] = bearing.carrying(train)
        every = len(outcome.trains) < wanted
        if every or bearing.tried >= MOST_TRIED or wanted >= MOST_JUDGED:
            break
        wanted *= 4
    met = [verdicts[train] for train in outcome.trains if train in verdicts]
    carry = {found.train: found for found in met if found is not None}
    hunting = {train for train in carry if hunts(train)} if problem.hunting_tooth == "prefer" else set()
    trains = order(task, carry, hunting)
    answer = Judged(
        [bearing.made(carry[train]) for train in trains[: problem.max_designs]],
        [bearing.made(carry[train]) for train in _pareto(problem, task, trains)],
        _failed(met, problem.max_designs),
        bearing.strongest,
        len(verdicts),
        every and all(train in verdicts for train in outcome.trains),
    )
    return answer, outcome._replace(trains=trains, ties=_ties(task, trains), pareto=[])


def _failed(met: list[Borne | None], wanted: int) -> int:
    """How many do not carry the power of those that stand before the last one wanted, or of all."""
    failed = 0
    for found in met:
        if wanted == 0:
            break
        failed, wanted = (failed + 1, wanted) if found is None else (failed, wanted - 1)
    return failed


def _ties(task: Task, trains: list[Train]) -> int:
    """How many of the trains are exactly as near as the nearest of them."""
    if not trains:
        return 0
    nearest = min(trains, key=lambda train: cmp_to_key(task.target.nearer)(train.ratio))
    return sum(task.target.nearer(train.ratio, nearest.ratio) == 0 for train in trains)


def _pareto(problem: GearTrainProblem, task: Task, trains: list[Train]) -> list[Train]:
    """Of the trains those that none is both smaller and nearer than."""
    near = cmp_to_key(task.target.nearer)
    within = problem.exact_tolerance or NEAR
    kept = [train for train in trains if task.target.within(train.ratio, within)]
    by_size = sorted(kept, key=lambda train: (train.size(task.largest), near(train.ratio)))
    return pareto(by_size, lambda train: near(train.ratio))
