"""Which meshes of a train can be fitted to its centre distances by a profile shift, with which module and which shifts.

What a pair of tooth numbers can take up is known in modules, whatever train it is part of
(:mod:`kinematics.gear.shifting`). Stages that have a distance of their own choose for every pair the module whose pitch
circles are nearest to it, of equally near ones the smallest; the search then meets every pair of gears once. Coaxial
stages that have to agree on a distance keep the intervals of distances of every pair with every module.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.gear import shifting
from kinematics.gear.flanks import least_shift_of_rack, straight_depth
from kinematics.gear.shifting import Demands
from kinematics.gear.teeth import FULL_DEPTH_DEDENDUM
from synthesis.kinds.gear_train.kernels import AGREED
from synthesis.kinds.gear_train.pairing import Integers
from synthesis.kinds.gear_train.problem import GearTrainProblem


class FittedStage(NamedTuple):
    """A mesh as it is made; the module by its place in the list, shifts in modules."""

    module: int
    shifts: tuple[float, float]
    distance: float


@dataclass(frozen=True, eq=False)
class Fit:
    """The meshes that can be fitted.

    ``module[s, a, b]`` is the place of the module that a pair has in stage s (one row for all stages where they are
    alike), −1 where none fits. ``ends[m, a, b]`` are the intervals of distances of a pair with module m,
    least and greatest, filled with nan, where stages have to agree on one; empty otherwise. ``fits[s, m, a, b]`` tells
    of stages with a distance of their own which modules fit a pair. ``modules`` are lengths.
    """

    demands: Demands
    modules: tuple[float, ...]
    limits: tuple[tuple[float, float], ...]
    module: NDArray[np.int8]
    ends: NDArray[np.float64]
    fits: NDArray[np.bool_]

    @property
    def by_stage(self) -> bool:
        """Whether stages differ in the meshes that they may have."""
        return len(self.module) > 1

    @property
    def shares_distance(self) -> bool:
        """Whether the meshes of a train have to agree on a distance."""
        return len(self.ends) > 0

    @property
    def allowed(self) -> NDArray[np.bool_]:
        """Which pairs some stage may have."""
        return np.asarray((self.module >= 0).any(axis=0))

    def stage(self, number: int) -> int:
        """The row of a stage, counted from 0."""
        return min(number, len(self.module) - 1)

    def fitted(self, drivers: tuple[int, ...], driven: tuple[int, ...], marks: tuple[int, ...]) -> list[FittedStage]:
        """The stages of a train: modules, shifts nearest to balanced specific sliding, and distances.

        Within a range of distances it is the one nearest to that of the pitch circles, of coaxial stages to their mean.
        """
        meshes = list(zip(drivers, driven, strict=True))
        if self.shares_distance:
            wanted = sum(0.5 * self.modules[m] * (a + b) for (a, b), m in zip(meshes, marks, strict=True)) / len(meshes)
            shared = _nearest(
                _common([self.ends[mark, a, b] for (a, b), mark in zip(meshes, marks, strict=True)]), wanted
            )
            return [self._fitted(a, b, mark, shared) for (a, b), mark in zip(meshes, marks, strict=True)]
        return [
            self.made(number, a, b, int(self.module[self.stage(number), a, b])) for number, (a, b) in enumerate(meshes)
        ]

    def made(self, number: int, a: int, b: int, place: int) -> FittedStage:
        """A mesh in a stage, counted from 0, that has a distance of its own, with one of the modules that fit it."""
        return self._fitted(a, b, place, self._own_distance(a, b, place, self.limits[self.stage(number)]))

    def places(self, number: int, a: int, b: int) -> list[int]:
        """Places of the modules that fit a mesh in such a stage, the smallest module first."""
        fits = np.flatnonzero(self.fits[self.stage(number), :, a, b])
        return sorted((int(place) for place in fits), key=self.modules.__getitem__)

    def _own_distance(self, a: int, b: int, place: int, limits: tuple[float, float]) -> float:
        if limits[0] == limits[1]:
            return limits[0]
        module = self.modules[place]
        pair, standard = (min(a, b), max(a, b)), 0.5 * (a + b)
        low = max(2.0 * self.demands.least_shift, self._sum_at(pair, limits[0] / module, -math.inf))
        high = min(2.0 * self.demands.most_shift, self._sum_at(pair, limits[1] / module, math.inf))
        sums = shifting.sums_that_suit(*pair, low, high, self.demands)
        if any(least <= 0.0 <= most for least, most in sums):
            return module * standard
        spans = [
            [module * float(shifting.with_sum(*pair, total, self.demands).distance) for total in span] for span in sums
        ]
        distance = _nearest([(least, most) for least, most in spans], module * standard)
        return min(max(distance, limits[0]), limits[1])

    def _sum_at(self, pair: tuple[int, int], distance: float, beyond: float) -> float:
        """The sum of shifts at a distance in modules, ``beyond`` where there is none."""
        total = float(shifting.at_distance(*pair, distance, self.demands).total) if math.isfinite(distance) else beyond
        return total if math.isfinite(total) else beyond

    def _fitted(self, a: int, b: int, place: int, distance: float) -> FittedStage:
        """A mesh at its distance; the smaller gear is looked at first, whichever drives."""
        small, large = min(a, b), max(a, b)
        working = shifting.at_distance(small, large, distance / self.modules[place], self.demands)
        shift = float(shifting.balanced_split(small, large, working, self.demands))
        shifts = self._within(shift), self._within(float(working.total) - shift)
        return FittedStage(place, shifts if a <= b else shifts[::-1], distance)

    def _within(self, shift: float) -> float:
        """A shift without what rounding took it beyond its limits."""
        return min(max(shift, self.demands.least_shift), self.demands.most_shift)


def _common(meshes: list[NDArray[np.float64]]) -> list[tuple[float, float]]:
    """The intervals that lists of them, filled with nan, have in common; ends that rounding parts meet."""
    common = [(0.0, math.inf)]
    for spans in meshes:
        known = spans[np.isfinite(spans[:, 0])].tolist()
        pairs = [(max(low, near), min(high, far)) for low, high in common for near, far in known]
        common = [(low, high) for low, high in pairs if low <= high * (1.0 + AGREED)]
    return common


def _nearest(spans: list[tuple[float, float]], wanted: float) -> float:
    """The distance in one of the intervals that is nearest to a wanted one."""
    within = (
        wanted if low * (1.0 - AGREED) <= wanted <= high * (1.0 + AGREED) else min(max(wanted, low), high)
        for low, high in spans
    )
    return min(within, key=lambda distance: abs(distance - wanted))


def fit_meshes(problem: GearTrainProblem, numbers: Integers) -> Fit:
    """The meshes of a problem whose teeth are fitted; ``numbers`` are the tooth numbers that there are."""
    demands = demands_of(problem)
    modules = tuple(float(module) for module in problem.exact_modules())
    n = int(numbers.max()) + 1
    present = np.zeros(n, np.bool_)
    present[numbers] = True
    asked = present[:, None] & present[None, :]
    # Gears that a rack undercuts at every shift are not asked for.
    least = [least_shift_of_rack(z, demands.pressure_angle, demands.depth) for z in range(n)]
    makeable = np.array(least) <= demands.most_shift + shifting.KEPT
    asked &= makeable[:, None] & makeable[None, :]
    standard = 0.5 * np.add.outer(np.arange(n), np.arange(n))
    if problem.shares_distance:
        low, high = problem.distance_limits(0)
        if math.isfinite(high):
            spans = [_between(asked, low / m, high / m, True, demands) for m in modules]
        else:
            spans = [_between(asked, 0.0, math.inf, True, demands)] * len(modules)
        ends = np.full((len(modules), n, n, max(span.shape[2] for span in spans), 2), math.nan)
        for place, (module, span) in enumerate(zip(modules, spans, strict=True)):
            ends[place, :, :, : span.shape[2]] = module * span
        found = np.isfinite(ends[..., 0, 0])
        chosen = np.where(found.any(axis=0), found.argmax(axis=0), -1).astype(np.int8)
        return Fit(demands, modules, ((low, high),), chosen[None], ends, np.zeros((1, 0, n, n), np.bool_))
    rows = _stages_apart(problem)
    limits = tuple(problem.distance_limits(stage) for stage in range(rows))
    chosen = np.full((rows, n, n), -1, np.int8)
    every = np.zeros((rows, len(modules), n, n), np.bool_)
    for row, (low, high) in enumerate(limits):
        nearest = np.full((n, n), math.inf)
        # Of equally near modules the smallest: they are tried in rising order.
        for place in sorted(_choices(problem, row, modules), key=modules.__getitem__):
            module = modules[place]
            fits = np.isfinite(_between(asked, low / module, high / module, False, demands)[..., 0, 0])
            every[row, place] = fits
            apart = np.maximum(0.0, np.maximum(low - module * standard, module * standard - high))
            better = fits & (apart < nearest)
            chosen[row][better], nearest[better] = place, apart[better]
    return Fit(demands, modules, limits, chosen, np.zeros((0, 0, 0, 0, 2)), every)


def demands_of(problem: GearTrainProblem) -> Demands:
    """What every mesh of a problem has to keep."""
    phi = math.radians(problem.pressure_angle)
    depth = straight_depth(phi, FULL_DEPTH_DEDENDUM)
    return Demands(phi, depth, *problem.shift_limits, problem.least_contact_ratio, problem.least_tip_thickness)


def _between(asked: NDArray[np.bool_], low: float, high: float, ends: bool, demands: Demands) -> NDArray[np.float64]:
    """Between which distances, in modules, pairs suit that are asked for."""
    return _sound_between(asked.tobytes(), len(asked), low, high, ends, demands)


@lru_cache(maxsize=8)
def _sound_between(asked: bytes, n: int, low: float, high: float, ends: bool, demands: Demands) -> NDArray[np.float64]:
    """What pairs can take up depends on no ratio: who tries one ratio after another has it found once."""
    pairs = np.frombuffer(asked, np.bool_).reshape(n, n)
    least, most = (np.where(pairs, end, math.nan) for end in (low, high))
    found = np.asarray(shifting.sound_between(least, most, ends, demands))
    found.flags.writeable = False
    return found


def _stages_apart(problem: GearTrainProblem) -> int:
    """How many stages have meshes of their own: one stands for all where they are alike."""
    return problem.most_stages if isinstance(problem.centre_distance, list) or problem.has_own_modules else 1


def _choices(problem: GearTrainProblem, stage: int, modules: tuple[float, ...]) -> list[int]:
    """Places of the modules from which a stage chooses."""
    if problem.has_own_modules:
        return [stage]
    return list(range(len(modules)))
