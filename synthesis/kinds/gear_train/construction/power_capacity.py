"""Selection of the trains that carry a given power: the order of their stages, their modules and their faces.

The search ranks trains by error or size without regard to strength. Strength is judged in that order, so that the first
trains that carry the power are the best ones. If all trains of the search were judged, there is no other. Trains that
rank lower are judged too, up to a limit, for the ties and the Pareto set. A train must carry the power at the speed of
each of its shafts; a mesh carries more power the faster it turns.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cmp_to_key
from typing import NamedTuple

from kinematics.gear.train import TrainStage
from synthesis.kinds.gear_train.construction.train import Known, assemble_mechanism, iterate_idler_choices, list_choices
from synthesis.kinds.gear_train.design import GearTrainMechanism, Idler, Stage
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search.search import Outcome, Train, order_trains
from synthesis.kinds.gear_train.search.task import Task, is_idler_needed
from synthesis.kinds.gear_train.statement.train import DEFAULT_TOLERANCE
from synthesis.model.dynamics.request import METRES_PER_UNIT
from synthesis.model.gears.strength import (
    EQUALITY_TOLERANCE,
    CarriedPower,
    LoadedPair,
    StressCalculator,
    build_stage_contact,
    find_common_width,
    mark_idlers,
)
from synthesis.results.exhaustive import select_pareto

INITIAL_JUDGED, MAX_JUDGED = 64, 1024
"""Number of trains judged at first, and at most."""

MAX_ARRANGEMENTS = 10_000
"""Total number of arrangements (stage orders, pairings, idlers) after which no further train is judged."""


class CarryingTrain(NamedTuple):
    """A train that carries the power: its stages, still without minimum faces, and its idlers."""

    train: Train
    stages: list[Stage]
    idlers: list[Idler]


class BuiltTrain(NamedTuple):
    """A train that carries the power, and its mechanism."""

    train: Train
    mechanism: GearTrainMechanism


class StrengthResult(NamedTuple):
    """Result of judging the trains of a search.

    ``borne`` are the best trains that carry the power, ``front`` is the Pareto set of all judged trains that do.
    ``failed`` counts the trains ranked above the last of ``borne`` that do not carry it. ``strongest`` is the maximum
    power in W that any train carries (0 if unknown, for trains with idlers). ``every`` is true if the ``judged`` trains
    are all trains of the search.
    """

    borne: list[BuiltTrain]
    front: list[BuiltTrain]
    failed: int
    strongest: float
    judged: int
    every: bool


@dataclass
class TrainJudge:
    """A cache of the power that the meshes of a problem carry, and the selection of trains by it."""

    problem: GearTrainProblem
    task: Task
    stated: CarriedPower
    tried: int = 0
    strongest: float = 0.0
    _judges: dict[_TurningMesh, StressCalculator] = field(default_factory=dict)
    _choices: Known = field(default_factory=dict)

    def find_arrangement(self, train: Train) -> CarryingTrain | None:
        """Return the first arrangement of a train that carries the power; None if none does."""
        for arranged in list_arrangements(self.problem, self.task, train):
            self.tried += 1
            idle = is_idler_needed(self.problem, len(arranged.drivers))
            found = self._try_with_idler(arranged) if idle else self._try_without_idler(arranged)
            if found is not None:
                return found
        return None

    def _try_without_idler(self, train: Train) -> CarryingTrain | None:
        stages, weakest = [], math.inf
        for choices, speed in self._list_loaded_stages(train):
            # The weakest stage limits the train; each stage may use its strongest module.
            weakest = min(weakest, max(self._compute_power(stage, (), speed) for stage in choices))
            stages.append(self._find_smallest(choices, (), speed))
        self.strongest = max(self.strongest, weakest)
        return self._check_faces(train, stages, [])

    def _try_with_idler(self, train: Train) -> CarryingTrain | None:
        """Put an idler into one stage, which then is not required to carry the power without it."""
        loaded = list(self._list_loaded_stages(train))
        plain = [self._find_smallest(choices, (), speed) for choices, speed in loaded]
        weak = {number for number, stage in enumerate(plain, 1) if stage is None}
        for idlers in iterate_idler_choices(self.problem, self.task, train):
            self.tried += 1
            place = idlers[0].stage
            # Every other stage must carry the power as it is.
            if weak <= {place}:
                choices, speed = loaded[place - 1]
                stage = self._find_smallest(choices, (idlers[0].teeth,), speed)
                found = self._check_faces(train, [*plain[: place - 1], stage, *plain[place:]], idlers)
                if found is not None:
                    return found
        return None

    def _list_loaded_stages(self, train: Train) -> Iterator[tuple[list[Stage], float]]:
        """Yield the possible forms of each stage, and the speed of its driving shaft, rad/s."""
        speed = self.stated.speed
        listed = list_choices(self.problem, self.task, train, self._choices)
        for choices, (driver, driven) in zip(listed, train.meshes, strict=True):
            yield choices, speed
            speed *= driver / driven

    def _find_smallest(self, choices: list[Stage], idlers: tuple[int, ...], speed: float) -> Stage | None:
        """Return the stage with its smallest module that carries the power."""
        return next((stage for stage in choices if self._is_enough(self._compute_power(stage, idlers, speed))), None)

    def _check_faces(self, train: Train, stages: list[Stage | None], idlers: list[Idler]) -> CarryingTrain | None:
        """Return the train if its stages have faces that carry the power; rounding cases are settled by the faces."""
        chosen = [stage for stage in stages if stage is not None]
        if len(chosen) < len(stages):
            return None
        borne = CarryingTrain(train, chosen, idlers)
        weakest = min(
            self._compute_power(stage, between, speed) for stage, between, speed in self._iterate_stages(borne)
        )
        # Within rounding of the required power only the computed face decides.
        if weakest < self.stated.power * (1.0 + EQUALITY_TOLERANCE) and None in self._compute_faces(borne):
            return None
        return borne

    def build_train(self, borne: CarryingTrain) -> BuiltTrain:
        """Build a train with the minimum faces of its stages."""
        faced = [
            stage.model_copy(update={"face_width": width})
            for stage, width in zip(borne.stages, self._compute_faces(borne), strict=True)
        ]
        return BuiltTrain(borne.train, assemble_mechanism(self.problem, borne.train, faced, borne.idlers))

    def _compute_faces(self, borne: CarryingTrain) -> list[float | None]:
        """Compute the minimum face of each stage; None for a stage that does not carry the power."""
        return [self._compute_width(stage, between, speed) for stage, between, speed in self._iterate_stages(borne)]

    def _iterate_stages(self, borne: CarryingTrain) -> Iterator[tuple[Stage, tuple[int, ...], float]]:
        """Yield each stage with the teeth of its idlers and the speed of its driving shaft, rad/s."""
        speed = self.stated.speed
        for number, stage in enumerate(borne.stages, 1):
            yield stage, tuple(idler.teeth for idler in borne.idlers if idler.stage == number), speed
            speed *= stage.driver / stage.driven

    def _is_enough(self, power: float) -> bool:
        return power >= self.stated.power * (1.0 - EQUALITY_TOLERANCE)

    def _compute_power(self, stage: Stage, idlers: tuple[int, ...], speed: float) -> float:
        """Return the maximum power that all meshes of a stage carry."""
        return min(
            self._get_judge(mesh).compute_max_power(turning) for mesh, turning in _list_meshes(stage, idlers, speed)
        )

    def _compute_width(self, stage: Stage, idlers: tuple[int, ...], speed: float) -> float | None:
        """Return the smallest face, in the problem's unit, at which all meshes of a stage carry the power."""
        # Idlers add meshes with their own loads.
        meshes = _list_meshes(stage, idlers, speed)
        # All meshes of a stage have the same face: compute their common minimum.
        loaded = [self._get_judge(mesh).replace_power(self.stated.power, turning) for mesh, turning in meshes]
        width = find_common_width(loaded, self.stated.required_safeties)
        return None if width is None else width / self._unit

    def _get_judge(self, mesh: _TurningMesh) -> StressCalculator:
        if mesh not in self._judges:
            contact = build_stage_contact(mesh.alone, 0, math.radians(self.problem.pressure_angle), self._unit)
            loaded = LoadedPair(
                contact, self.stated.power, self.stated.speed, mesh.both_ways, helix_angle=mesh.alone.helix_angle
            )
            self._judges[mesh] = StressCalculator(loaded, self.stated)
        return self._judges[mesh]

    @property
    def _unit(self) -> float:
        return 1000.0 * METRES_PER_UNIT[self.problem.length_unit]


class _TurningMesh(NamedTuple):
    """A mesh as a stage of its own, and the flags of its two gears for bending in both directions."""

    alone: TrainStage
    both_ways: tuple[bool, bool]


def _list_meshes(stage: Stage, idlers: tuple[int, ...], speed: float) -> Iterator[tuple[_TurningMesh, float]]:
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
        yield _TurningMesh(alone, mark_idlers(whole, place)), speed * stage.driver / one


def list_arrangements(problem: GearTrainProblem, task: Task, train: Train) -> list[Train]:
    """List a train with its stages in every order and its gears in every permitted pairing.

    Reverted trains keep their pairing. Trains are sorted by their largest stage ratio, smallest first; among equals the
    train itself comes first.
    """
    k = len(train.drivers)
    numbers = [(set(task.drivers[i].tolist()), set(task.driven[i].tolist()), task.stages(k, i)) for i in range(k)]
    found = set()
    # Gears change places only between stages of equal likeness.
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

    def key(one: Train) -> tuple[bool, float, bool, Train]:
        shared = problem.hunting_tooth == "prefer" and not has_hunting_teeth(one)
        return shared, max(max(mesh) / min(mesh) for mesh in one.meshes), one != train, one

    return sorted(found, key=key)


def has_hunting_teeth(train: Train) -> bool:
    """Return whether the teeth of every mesh have no common divisor."""
    return all(math.gcd(*mesh) == 1 for mesh in train.meshes)


def find_carrying_trains(
    problem: GearTrainProblem, task: Task, strength: CarriedPower, ranked: Callable[[int], Outcome]
) -> tuple[StrengthResult, Outcome]:
    """Find the best trains that carry a power, and the search result with the ties of those that do.

    Parameters
    ----------
    ranked : callable
        Returns the given number of best trains of the search.
    """
    bearing = TrainJudge(problem, task, strength)
    verdicts: dict[Train, CarryingTrain | None] = {}
    # Some trains will fail: judge more than are requested.
    wanted = max(INITIAL_JUDGED, problem.max_designs)
    while True:
        outcome = ranked(wanted)
        for train in outcome.trains:
            if train not in verdicts and bearing.tried < MAX_ARRANGEMENTS:
                verdicts[train] = bearing.find_arrangement(train)
        # Fewer trains than requested: the search has no others.
        every = len(outcome.trains) < wanted
        if every or bearing.tried >= MAX_ARRANGEMENTS or wanted >= MAX_JUDGED:
            break
        # Ask for more trains until enough carry the power or a limit is reached; judged ones are remembered.
        wanted *= 4
    met = [verdicts[train] for train in outcome.trains if train in verdicts]
    carry = {found.train: found for found in met if found is not None}
    hunting = {train for train in carry if has_hunting_teeth(train)} if problem.hunting_tooth == "prefer" else set()
    trains = order_trains(task, carry, hunting)
    answer = StrengthResult(
        [bearing.build_train(carry[train]) for train in trains[: problem.max_designs]],
        [bearing.build_train(carry[train]) for train in _select_pareto(problem, task, trains)],
        _count_failed(met, problem.max_designs),
        bearing.strongest,
        len(verdicts),
        every and all(train in verdicts for train in outcome.trains),
    )
    return answer, outcome._replace(trains=trains, ties=_count_ties(task, trains), pareto=[])


def _count_failed(met: list[CarryingTrain | None], wanted: int) -> int:
    """Count the trains ranked above the last requested one (or of all) that fail the strength check."""
    failed = 0
    for found in met:
        if wanted == 0:
            break
        failed, wanted = (failed + 1, wanted) if found is None else (failed, wanted - 1)
    return failed


def _count_ties(task: Task, trains: list[Train]) -> int:
    """Count the trains that are exactly as near as the nearest of them."""
    if not trains:
        return 0
    nearest = min(trains, key=lambda train: cmp_to_key(task.target.compare_distances)(train.ratio))
    return sum(task.target.compare_distances(train.ratio, nearest.ratio) == 0 for train in trains)


def _select_pareto(problem: GearTrainProblem, task: Task, trains: list[Train]) -> list[Train]:
    """Select the trains that no other train beats in both size and error."""
    near = cmp_to_key(task.target.compare_distances)
    within = problem.exact_tolerance or DEFAULT_TOLERANCE
    kept = [train for train in trains if task.target.is_within(train.ratio, within)]
    by_size = sorted(kept, key=lambda train: (train.size(task.largest), near(train.ratio)))
    return select_pareto(by_size, lambda train: near(train.ratio))
