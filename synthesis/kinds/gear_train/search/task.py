"""A gear-train problem in the form of the search: tooth numbers by position, allowed meshes, exact modules."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers
from kinematics.gear.teeth import find_largest_gear
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search.pairing_rules import MAX_STAGES, Rule
from synthesis.kinds.gear_train.search.profile_shift_fits import Fit, fit_meshes
from synthesis.kinds.gear_train.search.stage_meshes import compute_distance_keys, find_sound_meshes
from synthesis.kinds.gear_train.statement.stages import RequestedStage
from synthesis.kinds.gear_train.statement.train import MAX_PITCH_MULTIPLE
from synthesis.model.gears.ratio_target import RatioTarget, parse_decimal
from synthesis.model.gears.request import MAX_TEETH

UNLIMITED_TOLERANCE = 1e9
"""A tolerance that every train meets: ratios and targets are within a factor of 1e9 of 1."""


@dataclass(frozen=True, eq=False)
class Task:
    """Input of the search.

    ``drivers[i]`` and ``driven[i]`` are the tooth numbers of stage i in rising order. With ``ordered``, each stage has
    its own numbers; otherwise all stages have the same. ``stock[t]`` is the number of gears with t teeth, empty without
    a stock. ``pitches`` are the modules in a unit in which all are whole numbers. ``fit`` holds the meshes with teeth
    that are fitted to their distances.

    For stages that are given one by one (``stated``), ``own[i]`` are the permitted meshes of stage i, unless all are
    alike. Gears change places only between stages of equal ``likeness``.

    Trains of ``idler_counts`` stages need one of the ``idlers`` in one stage. The driver and the driven gear of this
    stage only mesh with the idler, not with each other. ``sound[a, b]`` are the permitted meshes, ``idled[a, b]`` the
    pairs between which an idler can be placed, and ``allowed[a, b]`` the pairs that form a stage without an idler.
    """

    target: RatioTarget
    drivers: tuple[Integers, ...]
    driven: tuple[Integers, ...]
    ordered: bool
    allowed: NDArray[np.bool_]
    by_mesh: bool
    sound: NDArray[np.bool_]
    idled: NDArray[np.bool_]
    idlers: Integers
    idler_counts: tuple[int, ...]
    stock: Integers
    reverted: bool
    modules: tuple[Fraction, ...]
    pitches: Integers
    stage_counts: tuple[int, ...]
    most_total: int | None
    by_size: bool
    largest: bool
    fit: Fit | None
    stated: tuple[RequestedStage, ...]
    own: tuple[NDArray[np.bool_], ...]
    likeness: tuple[int, ...]

    @property
    def most_teeth(self) -> int:
        """The largest tooth number."""
        return len(self.allowed) - 1

    def meshes(self, stage: int) -> NDArray[np.bool_]:
        """Return the permitted meshes of a stage, counted from 0."""
        sound = self.own[stage] if self.own else self.allowed
        return sound if self.fit is None else np.asarray(sound & (self.fit.module[self.fit.stage(stage)] >= 0))

    def compute_distance_keys(self, mark: Integers, stage: Integers, a: Integers, b: Integers) -> Integers:
        """Compute whole numbers that are equal for meshes a:b of equal distance; ``mark``: the module's place."""
        if not self.stated:
            return np.asarray(self.pitches[mark] * (a + b))
        return compute_distance_keys(self.stated, self.pitches[mark], stage, a, b)

    def stages(self, k: int, stage: int) -> NDArray[np.bool_]:
        """Return the permitted pairs of driver and driven gear of a stage, counted from 0, in a train of k stages."""
        return self.allowed | self.idled if k in self.idler_counts else self.meshes(stage)

    def build_rule(self, tolerance: float, k: int) -> Rule:
        """Build the rule of the compiled loops over trains of k stages."""
        head, rest = self.target.split_parts()
        stocked = len(self.stock) > 0
        by_stage = (self.fit is not None and self.fit.by_stage) or bool(self.own)
        of_stage = [self.meshes(stage) for stage in range(len(self.drivers))] if by_stage else [np.zeros((1, 1), bool)]
        return Rule(
            target=head,
            target_rest=rest,
            tolerance=tolerance,
            by_size=self.by_size,
            largest=self.largest,
            ordered=self.ordered,
            least=_place_numbers([values.min(initial=MAX_TEETH) for values in (*self.drivers, *self.driven)]),
            most=_place_numbers([values.max(initial=0) for values in (*self.drivers, *self.driven)]),
            by_mesh=self.by_mesh,
            allowed=self.allowed,
            by_stage=by_stage,
            of_stage=np.array(of_stage),
            with_idler=k in self.idler_counts,
            sound=self.sound,
            idled=self.idled,
            by_stock=stocked,
            stock=self.stock if stocked else np.zeros(1, np.int64),
            most_total=2 * len(self.drivers) * self.most_teeth if self.most_total is None else self.most_total,
            likeness=np.array(self.likeness, np.int64),
        )


def _place_numbers(numbers: list[int]) -> Integers:
    """Place one number for each driver and driven gear in the order of the compiled loops."""
    placed = np.zeros(2 * MAX_STAGES, np.int64)
    k = len(numbers) // 2
    placed[:k], placed[MAX_STAGES : MAX_STAGES + k] = numbers[:k], numbers[k:]
    return placed


def _list_positions(problem: GearTrainProblem, counts: Mapping[int, int]) -> list[Integers]:
    """Return the tooth numbers of each position, drivers and driven gears by turns."""
    if counts:
        # With a stock all positions choose from the same gears.
        return [np.array(sorted(counts), np.int64)] * (2 * problem.most_stages)
    return [np.arange(low, high + 1, dtype=np.int64) for low, high in problem.list_position_ranges()]


def _find_idled_meshes(sound: NDArray[np.bool_], idlers: Integers) -> NDArray[np.bool_]:
    """Return the pairs between which an idler can stand: some idler meshes soundly with both."""
    # In floats, because the matrix product of integers is slow.
    before, after = sound[:, idlers].astype(np.float32), sound[idlers].astype(np.float32)
    return np.asarray(before @ after > 0.0)


def build_task(problem: GearTrainProblem, coprime: bool) -> Task:
    """Build the task of a problem; ``coprime``: only meshes without a common divisor."""
    counts = problem.count_stock()
    positions = _list_positions(problem, counts)
    most = int(max(values[-1] for values in positions))
    stock = np.zeros(most + 1 if counts else 0, np.int64)
    for teeth, count in counts.items():
        stock[teeth] = count
    drivers, driven = tuple(positions[0::2]), tuple(positions[1::2])
    fit = fit_meshes(problem, np.unique(np.concatenate(positions))) if problem.is_fitted else None
    # Without any constraint on meshes the compiled loops need no table look-ups.
    demanding = problem.max_stage_ratio is not None or problem.interference == "refuse"
    by_mesh = coprime or demanding or fit is not None or problem.stages is not None
    sound = _find_sound_meshes(problem, most, coprime)
    if fit is not None:
        sound &= fit.fitting_pairs
    limited = _limit_stage_ratio(problem, most)
    stage_counts = _list_stage_counts(problem, sum(counts.values()) if counts else None)
    idler_counts = tuple(k for k in stage_counts if is_idler_needed(problem, k))
    idlers = np.unique(np.concatenate(positions)) if counts else np.arange(min(v[0] for v in positions), most + 1)
    allowed, idled = sound & limited, np.zeros_like(sound)
    if idler_counts:
        idled = _find_idled_meshes(sound, idlers) & limited
    own = _find_own_meshes(problem, most, sound, limited)
    stages = [allowed | idled] * len(drivers)
    if own:
        allowed = np.asarray(np.logical_or.reduce(own))
        stages = list(own)
    modules = tuple(problem.list_exact_modules())
    apart = any(not np.array_equal(v, positions[k % 2]) for k, v in enumerate(positions))
    if not apart and not any(_compute_likeness(problem)):
        own = ()
    return Task(
        target=problem.target,
        drivers=tuple(
            _select_usable(values, ok.T, mates) for values, ok, mates in zip(drivers, stages, driven, strict=True)
        ),
        driven=tuple(
            _select_usable(values, ok, mates) for values, ok, mates in zip(driven, stages, drivers, strict=True)
        ),
        ordered=apart or (fit is not None and fit.by_stage) or bool(own),
        allowed=allowed,
        by_mesh=by_mesh,
        sound=sound,
        idled=idled,
        idlers=idlers,
        idler_counts=idler_counts,
        stock=stock,
        reverted=problem.reverted,
        modules=modules,
        # Pitch circles do not distinguish shifted meshes: all are in one group.
        pitches=np.array(problem.pitches() if _is_on_pitch_circles(problem) else [0] * len(modules), np.int64),
        stage_counts=stage_counts,
        most_total=problem.max_total_teeth,
        by_size=problem.rank_by == "size",
        largest=problem.size == "largest_gear",
        fit=fit,
        stated=tuple(problem.stages or ()),
        own=own,
        likeness=_compute_likeness(problem),
    )


def _find_own_meshes(
    problem: GearTrainProblem, most: int, sound: NDArray[np.bool_], limited: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], ...]:
    """Return the permitted meshes of each stage that is given one by one; ``sound`` as for spur gears."""
    rows: dict[RequestedStage, NDArray[np.bool_]] = {}
    for stage in problem.stages or []:
        if stage not in rows:
            meshing = sound & find_sound_meshes(problem, stage, most)
            # The stage ratio limit does not apply: the threads of a worm are not teeth.
            rows[stage] = meshing if stage.type == "worm" else meshing & limited
    return tuple(rows[stage] for stage in problem.stages or [])


def _compute_likeness(problem: GearTrainProblem) -> tuple[int, ...]:
    """Return a number for each stage, equal for those whose gears may change places."""
    known = [stage.likeness for stage in problem.stages or []]
    numbers = [known.index(one) for one in known]
    return (*numbers, *([0] * (MAX_STAGES - len(numbers))))


def _is_on_pitch_circles(problem: GearTrainProblem) -> bool:
    """Return whether coaxial meshes agree on a distance if and only if their pitch circles do."""
    if not problem.is_fitted:
        return True
    return (
        problem.shares_distance and problem.shift_limits == (0.0, 0.0) and max(problem.pitches()) <= MAX_PITCH_MULTIPLE
    )


def is_idler_needed(problem: GearTrainProblem, stages: int) -> bool:
    """Return whether an external train of this many stages needs an idler; stages given one by one never do."""
    return problem.stages is None and problem.required_sign == (1 if stages % 2 else -1)


def _list_stage_counts(problem: GearTrainProblem, stocked: int | None) -> tuple[int, ...]:
    """List the numbers of stages that the direction and the stock permit."""
    counts = []
    fewest = 2 if problem.reverted else 1
    for k in range(fewest if problem.stages is None else problem.most_stages, problem.most_stages + 1):
        idler = is_idler_needed(problem, k)
        # An idler would spread the shafts of a reverted train, and stages with a distance have no space for it.
        if (idler and (problem.reverted or problem.is_fitted)) or (stocked is not None and stocked < 2 * k + idler):
            continue
        counts.append(k)
    return tuple(counts)


def _find_sound_meshes(problem: GearTrainProblem, most: int, coprime: bool) -> NDArray[np.bool_]:
    """Return the permitted meshes."""
    a, b = np.ogrid[: most + 1, : most + 1]
    sound = np.minimum(a, b) > 0
    if coprime:
        sound &= np.gcd(a, b) == 1
    if problem.interference == "refuse" and not problem.is_fitted and problem.stages is None:
        largest = [find_largest_gear(n, math.radians(problem.pressure_angle)) if n else 0 for n in range(most + 1)]
        bound = np.array([most if n is None else n for n in largest])
        sound &= np.maximum(a, b) <= bound[np.minimum(a, b)]
    return sound


def _limit_stage_ratio(problem: GearTrainProblem, most: int) -> NDArray[np.bool_]:
    """Return the pairs of driver and driven gear within the limit of the stage ratio."""
    a, b = np.ogrid[: most + 1, : most + 1]
    if problem.max_stage_ratio is None:
        return np.minimum(a, b) >= 0
    # Exact fractions: a ratio exactly at the limit is allowed.
    limit = parse_decimal(problem.max_stage_ratio)
    mate = np.array([min(most, math.floor(n * limit)) for n in range(most + 1)])
    return np.asarray(np.maximum(a, b) <= mate[np.minimum(a, b)], np.bool_)


def _select_usable(values: Integers, allowed: NDArray[np.bool_], mates: Integers) -> Integers:
    """Return the tooth numbers that have an allowed mate."""
    return values[allowed[mates][:, values].any(axis=0)]
