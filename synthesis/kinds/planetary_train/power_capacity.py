"""Selection of the planetary trains that carry a given power, with their modules and face widths.

The search ranks trains by error or size without regard to strength. Strength is judged in that order, so that the first
trains that carry the power are the best ones. If all trains of the search were judged, there is no other.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from kinematics.gear.teeth import Gear
from synthesis.kinds.planetary_train.build import build_demands, build_mechanism
from synthesis.kinds.planetary_train.design import PlanetaryMechanism
from synthesis.kinds.planetary_train.nearest import Candidate, Roles, SetTable, find_nearest
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.planetary_train.tooth_numbers import ToothNumbers
from synthesis.model.dynamics.request import METRES_PER_UNIT
from synthesis.model.gears.planet_strength import (
    MeshLoad,
    PlanetPower,
    build_planetary_contact,
    compute_powers,
    count_planes,
    find_plane,
    mark_bent_both_ways,
)
from synthesis.model.gears.ratio_target import parse_decimal
from synthesis.model.gears.strength import EQUALITY_TOLERANCE, LoadedPair, StressCalculator, find_common_width
from synthesis.results.exhaustive import select_pareto, select_within_tolerance

MAX_JUDGED = 1024
"""Maximum number of trains that are judged."""


class CarryingTrain(NamedTuple):
    """A train that carries the power with its module; ``size`` in the problem's unit, exact."""

    candidate: Candidate
    mechanism: PlanetaryMechanism
    size: Fraction

    @property
    def error(self) -> Fraction:
        """Relative error of the ratio."""
        return self.candidate.error


class StrengthResult(NamedTuple):
    """Result of judging the trains of a search.

    ``best`` are the best trains that carry the power, ``front`` is the Pareto set of all judged trains that do, and
    ``ties`` of them have the minimum error. ``failed`` counts the trains ranked above the last of ``best`` that do not
    carry it. ``strongest`` is the maximum power in W that any train carries. ``every`` is true if the ``judged`` trains
    are all trains of the search, ``proven`` if no train is better than ``best``.
    """

    best: list[CarryingTrain]
    front: list[CarryingTrain]
    ties: int
    failed: int
    strongest: float
    judged: int
    every: bool
    proven: bool


@dataclass
class TrainListing:
    """The trains of a problem: tables of tooth numbers with their input, output and fixed members."""

    problem: PlanetaryProblem
    _searches: list[tuple[Arrangement, list[SetTable], Roles]] = field(default_factory=list)

    def add(self, arrangement: Arrangement, tables: list[SetTable], roles: Roles) -> None:
        """Add the trains of one choice of members."""
        self._searches.append((arrangement, tables, roles))

    def list_nearest(self, largest: int | None = None) -> list[Candidate]:
        """List the nearest trains within the tolerance, at most :data:`MAX_JUDGED`, up to a size in half modules."""
        found: list[Candidate] = []
        for arrangement, tables, roles in self._searches:
            kept = tables if largest is None else [_limit_size(table, largest) for table in tables]
            some = find_nearest(arrangement, kept, roles, self.problem.target, MAX_JUDGED)
            found += [] if some is None else some.best
        return select_within_tolerance(sorted(found), self.problem.tolerance, MAX_JUDGED)

    def list_smallest(self) -> tuple[list[Candidate], int]:
        """List the smallest trains within the tolerance, complete up to the returned size."""
        sizes = sorted({int(size) for _, tables, _ in self._searches for table in tables for size in table.size})
        low, high, found = 0, len(sizes), list[Candidate]()
        # Bisect for the largest size up to which the list is complete.
        while low < high:
            middle = (low + high) // 2
            some = self.list_nearest(sizes[middle])
            if len(some) < MAX_JUDGED:
                low, found = middle + 1, some
            else:
                high = middle
        # If even the first size with any train has more of them, use its nearest ones.
        found = found or self.list_nearest(sizes[low])
        return sorted(found, key=lambda candidate: (candidate.size, candidate)), sizes[low - 1] if low else 0


def _limit_size(table: SetTable, largest: int) -> SetTable:
    kept = table.size <= largest
    return SetTable({gear: array[kept] for gear, array in table.teeth.items()}, table.size[kept], table.value)


def compute_mesh_loads(arrangement: Arrangement, candidate: Candidate, torque: float, speed: float) -> list[MeshLoad]:
    """Compute the loads of all meshes without losses, N m and rad/s, for a torque and a speed of the input.

    With A the coefficients of the speed equations, A ω = 0, forces f of the meshes turn the bodies by Aᵀ f.
    """
    train = arrangement.build_train(dict(candidate.teeth))
    place = {body: k for k, body in enumerate(train.bodies)}
    turning = np.zeros((len(train.meshes), len(place)))
    for row, mesh in zip(turning, train.meshes, strict=True):
        for body, coefficient in mesh.build_equation().items():
            row[place[body]] = coefficient
    # Unit rows complete the system: one body driven, one held; for the forces, one driven out and one held.
    driving, driven, held = (np.eye(len(place))[place[body]] for body in candidate.roles)
    stated = np.zeros(len(place))
    stated[-2] = speed
    rates = np.linalg.solve(np.vstack([turning, driving, held]), stated)
    forces = np.linalg.solve(np.vstack([turning, driven, held]).T, -torque * driving)
    return [
        MeshLoad(
            (float(force) * mesh.first_teeth, -mesh.sense * float(force) * mesh.second_teeth),
            float(rates[place[mesh.first]] - rates[place[mesh.carrier]]),
        )
        for mesh, force in zip(train.meshes, forces, strict=False)
    ]


class _MeshTeeth(NamedTuple):
    """A mesh by its teeth: numbers, addenda, whether the second is a ring, module, and bending in both directions."""

    teeth: tuple[int, int]
    addenda: tuple[float, float]
    internal: bool
    module: float
    ways: tuple[bool, bool]


@dataclass
class TrainJudge:
    """A cache of the power that the meshes of a problem carry, and the selection of modules and faces by it."""

    problem: PlanetaryProblem
    stated: PlanetPower
    strongest: float = 0.0
    _judges: dict[_MeshTeeth, StressCalculator] = field(default_factory=dict)

    def find_module(self, candidate: Candidate) -> CarryingTrain | None:
        """Return a train with its smallest module that carries the power, without faces yet; None if none does."""
        arrangement = ARRANGEMENTS[candidate.arrangement]
        loads = self._compute_loads(candidate)
        for module in self.problem.module_choices:
            if not self._is_feasible(arrangement, candidate, module):
                continue
            # Modules come in rising order, so that the first that carries is the smallest.
            mechanism = build_mechanism(self.problem, candidate, module)
            judges = list(self._list_judges(arrangement, mechanism, loads))
            share = min(judge.compute_max_power(speed) / power for _, judge, power, speed in judges)
            self.strongest = max(self.strongest, share * self.stated.power)
            # Within rounding of the required power the computed faces decide.
            sure = share >= 1.0 + EQUALITY_TOLERANCE or (
                share >= 1.0 - EQUALITY_TOLERANCE and self._compute_faces(arrangement, judges) is not None
            )
            if sure:
                return CarryingTrain(candidate, mechanism, candidate.size * parse_decimal(module))
        return None

    def add_faces(self, borne: CarryingTrain) -> CarryingTrain:
        """Return the same train with the minimum faces of its planes."""
        arrangement = ARRANGEMENTS[borne.candidate.arrangement]
        judges = list(self._list_judges(arrangement, borne.mechanism, self._compute_loads(borne.candidate)))
        faces = {"face_widths": self._compute_faces(arrangement, judges)}
        return borne._replace(mechanism=borne.mechanism.model_copy(update=faces))

    def _compute_loads(self, candidate: Candidate) -> list[MeshLoad]:
        arrangement = ARRANGEMENTS[candidate.arrangement]
        return compute_mesh_loads(arrangement, candidate, self.stated.power / self.stated.speed, self.stated.speed)

    def _is_feasible(self, arrangement: Arrangement, candidate: Candidate, module: float) -> bool:
        """Return whether a module keeps size and clearance; the search only checked the most favourable ones."""
        problem = self.problem
        if len(problem.module_choices) == 1 or (problem.max_size is None and problem.min_clearance == 0.0):
            return True
        demands = build_demands(problem, arrangement, module)
        exact = {gear: (count, count) for gear, count in candidate.teeth}
        numbers = (
            ToothNumbers(arrangement, planets, demands._replace(limits=exact)) for planets in arrangement.planet_sets
        )
        return all(each.count for each in numbers)

    def _list_judges(
        self, arrangement: Arrangement, mechanism: PlanetaryMechanism, loads: Sequence[MeshLoad]
    ) -> Iterator[tuple[int, StressCalculator, float, float]]:
        """Yield plane, stresses, power of one copy and speed of every loaded mesh."""
        teeth = [(mechanism.teeth[one], mechanism.teeth[other]) for one, other in arrangement.meshes]
        # The most loaded copy carries more than its equal share.
        share = self.stated.get_sharing_factor(self.problem.planets) / self.problem.planets
        rows = (
            arrangement.meshes,
            teeth,
            loads,
            compute_powers(loads, teeth, share),
            mark_bent_both_ways(arrangement, loads),
        )
        for mesh, pair, load, power, ways in zip(*rows, strict=True):
            if power > 0.0:
                addenda = mechanism.addendum[mesh[0]], mechanism.addendum[mesh[1]]
                toothed = _MeshTeeth(pair, addenda, arrangement.places[mesh[1]].internal, mechanism.module, ways)
                yield find_plane(arrangement, mesh), self._get_judge(toothed), power, abs(load.speed)

    def _get_judge(self, mesh: _MeshTeeth) -> StressCalculator:
        if mesh not in self._judges:
            angle, module = math.radians(self.problem.pressure_angle), mesh.module * self._unit
            one, other = (
                Gear(count, module, angle, addendum, internal=internal)
                for count, addendum, internal in zip(mesh.teeth, mesh.addenda, (False, mesh.internal), strict=True)
            )
            loaded = LoadedPair(build_planetary_contact((one, other)), 1.0, 1.0, mesh.ways, spares_rings=True)
            self._judges[mesh] = StressCalculator(loaded, self.stated)
        return self._judges[mesh]

    def _compute_faces(
        self, arrangement: Arrangement, judges: list[tuple[int, StressCalculator, float, float]]
    ) -> list[float | None] | None:
        """Compute the minimum face of each plane (None if unloaded), in the problem's unit; None if one has none."""
        faces: list[float | None] = []
        for plane in range(count_planes(arrangement)):
            meshes = [judge.replace_power(power, speed) for at, judge, power, speed in judges if at == plane]
            width = find_common_width(meshes, self.stated.required_safeties) if meshes else None
            if meshes and width is None:
                return None
            faces.append(None if width is None else width / self._unit)
        return faces

    @property
    def _unit(self) -> float:
        return 1000.0 * METRES_PER_UNIT[self.problem.length_unit]


def find_carrying_trains(problem: PlanetaryProblem, strength: PlanetPower, listing: TrainListing) -> StrengthResult:
    """Find the best trains of a listing that carry a power."""
    bearing = TrainJudge(problem, strength)
    listed, by_size = listing.list_nearest(), problem.rank_by == "size"
    every, reached = len(listed) < MAX_JUDGED, 0
    if by_size and every:
        listed.sort(key=lambda candidate: (candidate.size, candidate))
    elif by_size:
        listed, reached = listing.list_smallest()
    verdicts = [bearing.find_module(candidate) for candidate in listed]
    carry = [found for found in verdicts if found is not None]
    ranked = sorted(
        carry, key=lambda one: (one.size, one.candidate) if by_size else (one.error, one.size, one.candidate)
    )
    smallest = sorted(carry, key=lambda one: (one.size, one.candidate))
    best = (_select_first_of_size(ranked) if by_size else ranked)[: problem.max_designs]
    whole = len(best) == problem.max_designs
    last = max((listed.index(one.candidate) for one in best), default=-1) if whole else len(listed) - 1
    # With one module, size and error do not depend on strength: the first that carry are surely the best.
    if len(problem.module_choices) == 1:
        settled = True
    elif by_size:
        # With several, a smaller module could make an unlisted train smaller than the last of the best.
        settled = whole and best[-1].size <= reached * parse_decimal(problem.module_choices[0])
    else:
        settled = whole and best[-1].error < listed[-1].error
    least = min((one.error for one in carry), default=None)
    return StrengthResult(
        [bearing.add_faces(one) for one in best],
        [bearing.add_faces(one) for one in select_pareto(smallest, lambda one: one.error)],
        sum(one.error == least for one in carry),
        sum(found is None for found in verdicts[: last + 1]),
        bearing.strongest,
        len(listed),
        every,
        every or (whole and settled),
    )


def _select_first_of_size(ranked: list[CarryingTrain]) -> list[CarryingTrain]:
    """Return the first train of each size."""
    return [one for k, one in enumerate(ranked) if k == 0 or one.size != ranked[k - 1].size]
