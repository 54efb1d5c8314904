"""Selection of the trains that carry a given power: the order of their stages, their modules and their faces.

The search ranks trains by error or size without regard to strength. They are judged in that order, so that the first
that carry the power are the best that do; if all trains of the search were judged there is no other. Trains behind
them are judged too, up to a limit, for the ties and the Pareto set. A train has to carry the power at the speed
of each of its shafts; a mesh carries more power the faster it turns.
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
"""Number of trains judged at first, and at most."""

MOST_TRIED = 10_000
"""Number of stage orders, pairings and idlers of all trains together after which no further train is judged."""


class Borne(NamedTuple):
    """A train that carries the power: its stages, whose minimum faces are yet to be computed, and its idlers."""

    train: Train
    stages: list[Stage]
    idlers: list[Idler]


class Made(NamedTuple):
    """A train that carries the power, and its mechanism."""

    train: Train
    mechanism: GearTrainMechanism


class Judged(NamedTuple):
    """Result of judging the trains of a search.

    ``borne`` are the best trains that carry the power, ``front`` the Pareto set of all judged ones that do. ``failed``
    counts the trains ranked above the last of them that do not; ``strongest`` is the greatest power in W that any train
    carries (0: unknown, for trains with idlers). ``every``: the search has no trains besides the ``judged``.
    """

    borne: list[Made]
    front: list[Made]
    failed: int
    strongest: float
    judged: int
    every: bool


@dataclass
class Bearing:
    """Judges the power that the meshes of a problem carry; each mesh is judged once."""

    problem: GearTrainProblem
    task: Task
    stated: CarriedPower
    tried: int = 0
    strongest: float = 0.0
    _judges: dict[_Turning, Judge] = field(default_factory=dict)
    _choices: Known = field(default_factory=dict)

    def carrying(self, train: Train) -> Borne | None:
        """Return the first arrangement of a train that carries the power; None if none does."""
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
            # The weakest stage limits the train; each stage may use its strongest module.
            weakest = min(weakest, max(self._power(stage, (), speed) for stage in choices))
            stages.append(self._smallest(choices, (), speed))
        self.strongest = max(self.strongest, weakest)
        return self._faced(train, stages, [])

    def _with_idler(self, train: Train) -> Borne | None:
        """Put an idler into one stage, which then need not carry the power without it."""
        loaded = list(self._loaded(train))
        plain = [self._smallest(choices, (), speed) for choices, speed in loaded]
        weak = {number for number, stage in enumerate(plain, 1) if stage is None}
        for idlers in idler_choices(self.problem, self.task, train):
            self.tried += 1
            place = idlers[0].stage
            # Every other stage must carry the power as it is.
            if weak <= {place}:
                choices, speed = loaded[place - 1]
                stage = self._smallest(choices, (idlers[0].teeth,), speed)
                found = self._faced(train, [*plain[: place - 1], stage, *plain[place:]], idlers)
                if found is not None:
                    return found
        return None

    def _loaded(self, train: Train) -> Iterator[tuple[list[Stage], float]]:
        """Yield the possible forms of each stage, and the speed of its driving shaft, rad/s."""
        speed = self.stated.speed
        listed = choices_of(self.problem, self.task, train, self._choices)
        for choices, (driver, driven) in zip(listed, train.meshes, strict=True):
            yield choices, speed
            speed *= driver / driven

    def _smallest(self, choices: list[Stage], idlers: tuple[int, ...], speed: float) -> Stage | None:
        """Return the stage with its smallest module that carries the power."""
        return next((stage for stage in choices if self._enough(self._power(stage, idlers, speed))), None)

    def _faced(self, train: Train, stages: list[Stage | None], idlers: list[Idler]) -> Borne | None:
        """Return the train if its stages have faces that carry the power; rounding cases are settled by the faces."""
        chosen = [stage for stage in stages if stage is not None]
        if len(chosen) < len(stages):
            return None
        borne = Borne(train, chosen, idlers)
        weakest = min(self._power(stage, between, speed) for stage, between, speed in self._driven(borne))
        # Within rounding of the required power only the computed face decides.
        if weakest < self.stated.power * (1.0 + EQUAL) and None in self._faces(borne):
            return None
        return borne

    def made(self, borne: Borne) -> Made:
        """Build a train with the minimum faces of its stages."""
        faced = [
            stage.model_copy(update={"face_width": width})
            for stage, width in zip(borne.stages, self._faces(borne), strict=True)
        ]
        return Made(borne.train, assembled(self.problem, borne.train, faced, borne.idlers))

    def _faces(self, borne: Borne) -> list[float | None]:
        """Compute the minimum face of each stage; None for a stage that does not carry the power."""
        return [self._width(stage, between, speed) for stage, between, speed in self._driven(borne)]

    def _driven(self, borne: Borne) -> Iterator[tuple[Stage, tuple[int, ...], float]]:
        """Yield each stage with the teeth of its idlers and the speed of its driving shaft, rad/s."""
        speed = self.stated.speed
        for number, stage in enumerate(borne.stages, 1):
            yield stage, tuple(idler.teeth for idler in borne.idlers if idler.stage == number), speed
            speed *= stage.driver / stage.driven

    def _enough(self, power: float) -> bool:
        return power >= self.stated.power * (1.0 - EQUAL)

    def _power(self, stage: Stage, idlers: tuple[int, ...], speed: float) -> float:
        """Return the greatest power that all meshes of a stage carry."""
        return min(self._judge(mesh).carried_power(turning) for mesh, turning in _meshes(stage, idlers, speed))

    def _width(self, stage: Stage, idlers: tuple[int, ...], speed: float) -> float | None:
        """Return the smallest face, in the problem's unit, at which all meshes of a stage carry the power."""
        # Idlers add meshes with their own loads.
        meshes = _meshes(stage, idlers, speed)
        # One face serves all meshes of a stage: their common minimum is what counts.
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
    """A mesh as a stage of its own, and the flags of its two gears for bending in both directions."""

    alone: TrainStage
    both_ways: tuple[bool, bool]


def _meshes(stage: Stage, idlers: tuple[int, ...], speed: float) -> Iterator[tuple[_Turning, float]]:
    """Yield the meshes of a stage, with the speed of each mesh's first gear, rad/s."""
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
    """List a train with its stages in every order and its gears in every permitted pairing.

    Reverted trains keep their pairing. The smallest largest stage ratio comes first, and the train itself among equals.
    """
    k = len(train.drivers)
    numbers = [(set(task.drivers[i].tolist()), set(task.driven[i].tolist()), task.stages(k, i)) for i in range(k)]
    found = set()
    # Gears change places only between stages of one likeness.
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
    """Return whether the teeth of every mesh have no common divisor."""
    return all(math.gcd(*mesh) == 1 for mesh in train.meshes)


def judged(
    problem: GearTrainProblem, task: Task, stated: CarriedPower, ranked: Callable[[int], Outcome]
) -> tuple[Judged, Outcome]:
    """Find the best trains that carry a power, and the search result with the ties of those that do.

    Parameters
    ----------
    ranked : callable
        Returns the given number of best trains of the search.
    """
    bearing = Bearing(problem, task, stated)
    verdicts: dict[Train, Borne | None] = {}
    # Some trains will fail: judge more than are requested.
    wanted = max(FIRST_JUDGED, problem.max_designs)
    while True:
        outcome = ranked(wanted)
        for train in outcome.trains:
            if train not in verdicts and bearing.tried < MOST_TRIED:
                verdicts[train] = bearing.carrying(train)
        # Fewer trains than requested: the search has no others.
        every = len(outcome.trains) < wanted
        if every or bearing.tried >= MOST_TRIED or wanted >= MOST_JUDGED:
            break
        # Ask for more trains until enough carry the power or a limit is reached; judged ones are remembered.
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
    """Count the trains ranked above the last requested one (or of all) that fail the strength check."""
    failed = 0
    for found in met:
        if wanted == 0:
            break
        failed, wanted = (failed + 1, wanted) if found is None else (failed, wanted - 1)
    return failed


def _ties(task: Task, trains: list[Train]) -> int:
    """Count the trains that are exactly as near as the nearest of them."""
    if not trains:
        return 0
    nearest = min(trains, key=lambda train: cmp_to_key(task.target.nearer)(train.ratio))
    return sum(task.target.nearer(train.ratio, nearest.ratio) == 0 for train in trains)


def _pareto(problem: GearTrainProblem, task: Task, trains: list[Train]) -> list[Train]:
    """Select the trains that no other train beats in both size and error."""
    near = cmp_to_key(task.target.nearer)
    within = problem.exact_tolerance or NEAR
    kept = [train for train in trains if task.target.within(train.ratio, within)]
    by_size = sorted(kept, key=lambda train: (train.size(task.largest), near(train.ratio)))
    return pareto(by_size, lambda train: near(train.ratio))
