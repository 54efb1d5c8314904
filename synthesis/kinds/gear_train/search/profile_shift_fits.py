"""Meshes of a train that a profile shift can fit to its centre distances, with their modules and shifts.

The sums of shifts that a pair of tooth numbers permits are known in modules, independent of the train
(:mod:`kinematics.gear.shifting`). Stages that have a distance of their own choose for every pair the module whose pitch
circles are nearest to it, and the smallest of equally near ones; the search then considers every pair of gears once.
Coaxial stages, which must agree on a distance, keep the intervals of distances of every pair with every module.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers
from kinematics.gear import shift_sums, shifting
from kinematics.gear.shifting import PairConstraints
from kinematics.gear.teeth import FULL_DEPTH_DEDENDUM, compute_min_shift, compute_straight_depth
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search.kernels import DISTANCE_TOLERANCE
from synthesis.kinds.gear_train.statement.stages import RequestedStage


class FittedStage(NamedTuple):
    """A mesh with its module, by its place in the list, its shifts in modules, and its distance."""

    module: int
    shifts: tuple[float, float]
    distance: float


@dataclass(frozen=True, eq=False)
class Fit:
    """The meshes that can be fitted.

    ``module[s, a, b]`` is the index of the module that a pair has in stage s (one row for all stages if they are
    alike), −1 if none fits. ``ends[s, m, a, b]`` are the intervals of distances of a pair with module m in stage s, as
    minimum and maximum, padded with nan, if stages must agree on a distance; empty otherwise. ``fits[s, m, a, b]`` is
    true if module m fits a pair in a stage with a distance of its own. ``modules`` are lengths. ``demands[s]`` are the
    constraints of a stage in the plane of rotation, to which all modules here refer. Modules are ``stretch[s]`` times
    as long there as in the normal plane.
    """

    demands: tuple[PairConstraints, ...]
    stretch: tuple[float, ...]
    modules: tuple[float, ...]
    limits: tuple[tuple[float, float], ...]
    module: NDArray[np.int8]
    ends: NDArray[np.float64]
    fits: NDArray[np.bool_]

    @property
    def by_stage(self) -> bool:
        """True if stages differ in their permitted meshes."""
        return len(self.module) > 1

    @property
    def shares_distance(self) -> bool:
        """True if the meshes of a train must agree on a distance."""
        return len(self.ends) > 0

    @property
    def fitting_pairs(self) -> NDArray[np.bool_]:
        """Pairs that at least one stage may have."""
        return np.asarray((self.module >= 0).any(axis=0))

    def stage(self, number: int) -> int:
        """Return the row of a stage, counted from 0."""
        return min(number, len(self.module) - 1)

    def fit_train(self, drivers: tuple[int, ...], driven: tuple[int, ...], marks: tuple[int, ...]) -> list[FittedStage]:
        """Fit the stages of a train: modules, shifts nearest to balanced specific sliding, and distances.

        Within a range of distances, the distance nearest to the sum of the pitch radii is chosen; for coaxial stages,
        nearest to the mean of these sums.
        """
        meshes = list(zip(drivers, driven, strict=True))
        if self.shares_distance:
            rows = [self.stage(number) for number in range(len(meshes))]
            listed = list(zip(rows, meshes, marks, strict=True))
            wanted = sum(0.5 * self._get_module(row, m) * (a + b) for row, (a, b), m in listed) / len(meshes)
            shared = _find_nearest(
                _intersect_intervals([self.ends[row, mark, a, b] for row, (a, b), mark in listed]), wanted
            )
            return [self._fit_at_distance(row, a, b, mark, shared) for row, (a, b), mark in listed]
        return [
            self.fit_mesh(number, a, b, int(self.module[self.stage(number), a, b]))
            for number, (a, b) in enumerate(meshes)
        ]

    def fit_mesh(self, number: int, a: int, b: int, place: int) -> FittedStage:
        """Fit a mesh in a stage, counted from 0, with a distance of its own and one of the modules that fit it."""
        row = self.stage(number)
        return self._fit_at_distance(row, a, b, place, self._choose_distance(row, a, b, place))

    def list_module_places(self, number: int, a: int, b: int) -> list[int]:
        """List the places of the modules that fit a mesh in such a stage, the smallest module first."""
        fits = np.flatnonzero(self.fits[self.stage(number), :, a, b])
        return sorted((int(place) for place in fits), key=self.modules.__getitem__)

    def _get_module(self, row: int, place: int) -> float:
        """Return a module in the plane of rotation."""
        return self.modules[place] * self.stretch[row]

    def _choose_distance(self, row: int, a: int, b: int, place: int) -> float:
        limits, demands = self.limits[row], self.demands[row]
        # A given distance leaves no choice.
        if limits[0] == limits[1]:
            return limits[0]
        module = self._get_module(row, place)
        pair, standard = (min(a, b), max(a, b)), 0.5 * (a + b)
        low = max(2.0 * demands.least_shift, self._find_sum(row, pair, limits[0] / module, -math.inf))
        high = min(2.0 * demands.most_shift, self._find_sum(row, pair, limits[1] / module, math.inf))
        sums = shift_sums.find_suitable_sums(*pair, low, high, demands)
        # Without a sum of shifts the pair runs at its standard distance, the best choice if permitted.
        if any(least <= 0.0 <= most for least, most in sums):
            return module * standard
        spans = [[module * float(shifting.from_sum(*pair, total, demands).distance) for total in span] for span in sums]
        distance = _find_nearest([(least, most) for least, most in spans], module * standard)
        return min(max(distance, limits[0]), limits[1])

    def _find_sum(self, row: int, pair: tuple[int, int], distance: float, beyond: float) -> float:
        """Return the sum of shifts at a distance in modules, ``beyond`` if there is none."""
        if not math.isfinite(distance):
            return beyond
        total = float(shifting.from_distance(*pair, distance, self.demands[row]).total)
        return total if math.isfinite(total) else beyond

    def _fit_at_distance(self, row: int, a: int, b: int, place: int, distance: float) -> FittedStage:
        """Fit a mesh at its distance; the smaller gear is treated first, whether it drives or not."""
        small, large, demands = min(a, b), max(a, b), self.demands[row]
        # The distance determines the sum of shifts; the split balances specific sliding.
        working = shifting.from_distance(small, large, distance / self._get_module(row, place), demands)
        first = float(shifting.find_balanced_split(small, large, working, demands))
        # Clip shifts that exceed their limits by rounding.
        one, two = (
            min(max(shift, demands.least_shift), demands.most_shift) * self.stretch[row]
            for shift in (first, float(working.total) - first)
        )
        return FittedStage(place, (one, two) if a <= b else (two, one), distance)


def _intersect_intervals(meshes: list[NDArray[np.float64]]) -> list[tuple[float, float]]:
    """Intersect lists of intervals, padded with nan; ends that differ only by rounding count as touching."""
    common = [(0.0, math.inf)]
    for spans in meshes:
        known = spans[np.isfinite(spans[:, 0])].tolist()
        pairs = [(max(low, near), min(high, far)) for low, high in common for near, far in known]
        common = [(low, high) for low, high in pairs if low <= high * (1.0 + DISTANCE_TOLERANCE)]
    return common


def _find_nearest(spans: list[tuple[float, float]], wanted: float) -> float:
    """Return the distance in one of the intervals that is nearest to a given one."""
    within = (
        wanted
        if low * (1.0 - DISTANCE_TOLERANCE) <= wanted <= high * (1.0 + DISTANCE_TOLERANCE)
        else min(max(wanted, low), high)
        for low, high in spans
    )
    return min(within, key=lambda distance: abs(distance - wanted))


def fit_meshes(problem: GearTrainProblem, numbers: Integers) -> Fit:
    """Fit the meshes of a problem; ``numbers`` are the available tooth numbers."""
    rows = _count_stage_rows(problem)
    stages: list[RequestedStage | None] = [None] * rows if problem.stages is None else [*problem.stages[:rows]]
    demands = tuple(build_demands(problem, stage) for stage in stages)
    stretch = tuple(1.0 / math.cos(math.radians(_get_helix_angle(stage))) for stage in stages)
    modules = tuple(float(module) for module in problem.list_exact_modules())
    n = int(numbers.max()) + 1
    present = np.zeros(n, np.bool_)
    present[numbers] = True
    makeable = [_mask_makeable(one, present) for one in demands]
    standard = 0.5 * np.add.outer(np.arange(n), np.arange(n))
    limits = tuple(problem.get_distance_limits(stage) for stage in range(rows))
    if problem.shares_distance:
        spans = [
            [
                module * wide * _find_intervals(pairs, *_convert_to_modules(limits[0], module * wide), True, one)
                for module in modules
            ]
            for pairs, wide, one in zip(makeable, stretch, demands, strict=True)
        ]
        # Longest list of intervals.
        most = max(span.shape[2] for row in spans for span in row)
        ends = np.full((rows, len(modules), n, n, most, 2), math.nan)
        for row, own in enumerate(spans):
            for place, span in enumerate(own):
                # Intervals of different pairs differ in number; the rest stays nan.
                ends[row, place, :, :, : span.shape[2]] = span
        found = np.isfinite(ends[..., 0, 0])
        chosen = np.where(found.any(axis=1), found.argmax(axis=1), -1).astype(np.int8)
        return Fit(demands, stretch, modules, limits, chosen, ends, np.zeros((rows, 0, n, n), np.bool_))
    chosen = np.full((rows, n, n), -1, np.int8)
    every = np.zeros((rows, len(modules), n, n), np.bool_)
    for row, (low, high) in enumerate(limits):
        nearest = np.full((n, n), math.inf)
        # Modules are tried in rising order, so that the smallest of equally near ones is chosen.
        for place in sorted(_list_choices(problem, row, modules), key=modules.__getitem__):
            module = modules[place] * stretch[row]
            fits = np.isfinite(
                _find_intervals(makeable[row], low / module, high / module, False, demands[row])[..., 0, 0]
            )
            every[row, place] = fits
            apart = np.maximum(0.0, np.maximum(low - module * standard, module * standard - high))
            # Strictly nearer: among equals the earlier, smaller module stays.
            better = fits & (apart < nearest)
            chosen[row][better], nearest[better] = place, apart[better]
    return Fit(demands, stretch, modules, limits, chosen, np.zeros((0, 0, 0, 0, 0, 2)), every)


def _convert_to_modules(limits: tuple[float, float], module: float) -> tuple[float, float]:
    """Convert limits of a distance to modules; no limits if there is no maximum."""
    low, high = limits
    return (low / module, high / module) if math.isfinite(high) else (0.0, math.inf)


def _mask_makeable(demands: PairConstraints, present: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the pairs of available gears, without those that a rack undercuts at every shift."""
    # A gear that needs more shift than permitted is undercut in every mesh.
    least = [compute_min_shift(z, demands.pressure_angle, demands.depth) for z in range(len(present))]
    made = present & (np.array(least) <= demands.most_shift + shifting.MARGIN_TOLERANCE)
    return np.asarray(made[:, None] & made[None, :])


def _get_helix_angle(stage: RequestedStage | None) -> float:
    """Return the helix angle, degrees."""
    return 0.0 if stage is None else abs(stage.helix_angle or 0.0)


def build_demands(problem: GearTrainProblem, stage: RequestedStage | None = None) -> PairConstraints:
    """Build the constraints on every mesh of a stage, in modules of the plane of rotation."""
    phi, beta = math.radians(problem.pressure_angle), math.radians(_get_helix_angle(stage))
    depth = compute_straight_depth(phi, FULL_DEPTH_DEDENDUM)
    least, most = problem.shift_limits
    plain = PairConstraints(phi, depth, least, most, problem.least_contact_ratio, problem.least_tip_thickness)
    if not beta:
        return plain
    # A helical gear is cut by a rack in its normal plane: in the plane of rotation all is shortened by cos β.
    shrunk = math.cos(beta)
    return plain._replace(
        pressure_angle=math.atan(math.tan(phi) / shrunk),
        depth=shrunk * depth,
        least_shift=shrunk * least,
        most_shift=shrunk * most,
        tip_thickness=shrunk * problem.least_tip_thickness,
        addendum=shrunk,
    )


def _find_intervals(
    pairs: NDArray[np.bool_], low: float, high: float, ends: bool, demands: PairConstraints
) -> NDArray[np.float64]:
    """Find the distances, in modules, between which the given pairs are sound."""
    return _compute_intervals(pairs.tobytes(), len(pairs), low, high, ends, demands)


@lru_cache(maxsize=8)
def _compute_intervals(
    packed_pairs: bytes, n: int, low: float, high: float, ends: bool, demands: PairConstraints
) -> NDArray[np.float64]:
    """Find the intervals and cache them: they depend on no ratio, and callers try one ratio after another."""
    pairs = np.frombuffer(packed_pairs, np.bool_).reshape(n, n)
    least, most = (np.where(pairs, end, math.nan) for end in (low, high))
    found = np.asarray(shift_sums.find_sound_distances(least, most, ends, demands))
    found.flags.writeable = False
    return found


def _count_stage_rows(problem: GearTrainProblem) -> int:
    """Return the number of stages with meshes of their own: 1 represents all if they are alike."""
    helical = any(_get_helix_angle(stage) for stage in problem.stages or [])
    apart = isinstance(problem.centre_distance, list) or problem.has_own_modules or helical
    return problem.most_stages if apart else 1


def _list_choices(problem: GearTrainProblem, stage: int, modules: tuple[float, ...]) -> list[int]:
    """List the places of the modules from which a stage chooses."""
    if problem.has_own_modules:
        return [stage]
    return list(range(len(modules)))
