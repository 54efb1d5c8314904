"""Search for the best gear trains, with a proof that none is better.

Every number of stages is searched in turn, with its own
:class:`~synthesis.kinds.gear_train.search.candidates.Candidates`. The compiled loops keep a few more trains than
requested, and these are sorted in exact arithmetic. If two errors differ by less than double precision resolves,
the loops may have dropped a train that belongs to the answer; then the search is repeated with a larger capacity.

Without a given tolerance the search begins within
:data:`~synthesis.kinds.gear_train.statement.train.DEFAULT_TOLERANCE`, which leaves the loops the fewest trains. All
errors are searched only if that finds fewer trains than requested and the ratio is within reach.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Container, Iterable
from dataclasses import replace
from fractions import Fraction
from functools import cmp_to_key, partial
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Integers
from kinematics.message import compose
from synthesis.kinds.gear_train.search.candidates import (
    Candidates,
    Halves,
    compute_stage_reach,
    list_coaxial_meshes,
    list_few_meshes,
)
from synthesis.kinds.gear_train.search.kernels import WINDOW_MARGIN
from synthesis.kinds.gear_train.search.pairing_rules import MAX_STAGES
from synthesis.kinds.gear_train.search.shortlist import ERROR_NOISE, Shortlist
from synthesis.kinds.gear_train.search.task import UNLIMITED_TOLERANCE, Task
from synthesis.kinds.gear_train.statement.train import DEFAULT_TOLERANCE
from synthesis.model.gears.ratio_target import RatioTarget
from synthesis.results.exhaustive import select_pareto

ZERO_WINDOW = 1e-15
"""Amount added to a tolerance, so that rounding excludes no exact train at a tolerance of zero."""

SPARE_COUNT = 54
"""Number of trains that the loops keep in addition to the requested ones."""

ORDER_TOLERANCE = 1e-11
"""Relative difference of errors above which the order of the compiled loops is certainly correct."""

PROGRESS_PARTS = 25
"""Number of parts of a search between which progress is reported."""

Progress = Callable[[float, str], None]


class Train(NamedTuple):
    """Tooth numbers of drivers and driven gears, and the mark of each stage's module."""

    drivers: tuple[int, ...]
    driven: tuple[int, ...]
    marks: tuple[int, ...]

    @property
    def ratio(self) -> Fraction:
        """Magnitude of input speed over output speed."""
        return Fraction(math.prod(self.driven), math.prod(self.drivers))

    @property
    def meshes(self) -> list[tuple[int, int]]:
        """Driver and driven gear of each stage."""
        return list(zip(self.drivers, self.driven, strict=True))

    def size(self, largest: bool) -> int:
        """Return the largest gear, or the sum of all teeth."""
        gears = self.drivers + self.driven
        return max(gears) if largest else sum(gears)


class Outcome(NamedTuple):
    """Result of a search: ``trains`` in the order of the ranking, ``pareto`` by rising size."""

    trains: list[Train]
    pareto: list[Train]
    ties: int
    combinations: int
    reach: tuple[Fraction, Fraction] | None
    nearest: Train | None


def search(task: Task, tolerance: Fraction | None, wanted: int, progress: Progress) -> Outcome:
    """Find the ``wanted`` best trains of a task.

    Parameters
    ----------
    tolerance : Fraction or None
        Largest relative error; None: any error, for a target within reach.

    Returns
    -------
    Outcome
        ``reach`` are bounds of the ratios that the meshes permit, None if there is no train at all. ``nearest`` is the
        nearest train of all, if none is within the tolerance but the target is within reach.
    """
    # Numbers of stages without any train have no reach.
    reach = {k: _compute_reach(task, k) for k in task.stage_counts}
    spans = [span for span in reach.values() if span is not None]
    whole = (min(low for low, _ in spans), max(high for _, high in spans)) if spans else None
    near = float(DEFAULT_TOLERANCE) if tolerance is None else float(tolerance) * (1.0 + WINDOW_MARGIN) + ZERO_WINDOW
    # Numbers of stages that cannot come near the target are not searched.
    counts = tuple(k for k, span in reach.items() if span is not None and _is_within_reach(task.target, span, near))
    outcome = _search_counts(task, counts, near, tolerance, wanted, progress)
    nearest = None
    # Without a given tolerance too few trains also justify a wider search.
    few = not outcome.trains or (tolerance is None and len(outcome.trains) < wanted)
    if few and whole is not None and _is_within_reach(task.target, whole, 0.0):
        every = tuple(k for k, span in reach.items() if span is not None)
        progress(0.5, compose("gear_train-searching-nearest"))
        anyhow = _search_counts(task, every, UNLIMITED_TOLERANCE, None, wanted, _ignore_progress)
        if tolerance is not None:
            nearest = anyhow.trains[0] if anyhow.trains else None
        elif outcome.trains:
            outcome = outcome._replace(trains=anyhow.trains)
        elif anyhow.trains:
            # For a target outside the attainable ratios, the nearest train would only be an extreme one: return none.
            whole = _tighten_reach(task, every, whole, [train.ratio for train in anyhow.trains])
            outcome = anyhow if _is_within_reach(task.target, whole, 0.0) else outcome
    combinations = sum(_count_covered(task, k) for k in task.stage_counts)
    return Outcome(outcome.trains, outcome.pareto, outcome.ties, combinations, whole, nearest)


class _Pass(NamedTuple):
    trains: list[Train]
    pareto: list[Train]
    ties: int


def _search_counts(
    task: Task, counts: tuple[int, ...], near: float, tolerance: Fraction | None, wanted: int, progress: Progress
) -> _Pass:
    """Search all trains with errors up to ``near``."""
    capacity = wanted + SPARE_COUNT
    rules = [task.build_rule(near, k) for k in counts]
    listed = [_build_candidates(task, k, near) for k in counts]
    while True:
        size = task.most_teeth if task.largest else 2 * max(counts, default=0) * task.most_teeth
        if task.most_total is not None and not task.largest:
            size = min(size, task.most_total)
        shortlist = Shortlist.empty(capacity, size)
        done, work = 0, sum(candidates.combinations for candidates in listed) or 1
        for k, candidates, rule in zip(counts, listed, rules, strict=True):
            parts = np.linspace(0, candidates.steps, min(PROGRESS_PARTS, candidates.steps) + 1).astype(int)
            for first, last in itertools.pairwise(parts):
                # Later parts only hold larger trains: stop once none of them can enter.
                if candidates.bound_size(int(first)) > _find_last_size(task, shortlist) or candidates.finish(
                    int(first), rule, shortlist
                ):
                    break
                candidates.search(int(first), int(last), rule, shortlist)
                share = (done + candidates.combinations * float(last) / candidates.steps) / work
                progress(
                    0.95 * share,
                    compose("gear_train-searching-stages", stages=k, trains=f"{candidates.combinations:.3g}"),
                )
            done += candidates.combinations
        trains = [_decode_train(row) for row in shortlist.teeth[: shortlist.kept[0]]]
        kept = [train for train in trains if tolerance is None or task.target.is_within(train.ratio, tolerance)]
        # Trains admitted only by the rounded tolerance may have displaced others.
        crowded = len(kept) < len(trains) == capacity
        trains = order_trains(task, kept)
        if not crowded and not _may_have_dropped(task, trains, shortlist, wanted):
            break
        # A larger shortlist surely contains the trains in doubt.
        capacity *= 4
    ties = 0
    if trains:
        rows = (
            [_decode_train(row) for row in shortlist.least_teeth[np.isfinite(shortlist.least_error)]]
            if task.by_size
            else []
        )
        best = min((train.ratio for train in [*trains, *rows]), key=cmp_to_key(task.target.compare_distances))
        equal = _list_equally_near(task, best)
        shortlist.error[0] = abs(task.target.compute_relative_error(best))
        ties = sum(candidates.ties(equal, rule, shortlist) for candidates, rule in zip(listed, rules, strict=True))
    return _Pass(trains[:wanted], _select_pareto(task, shortlist, tolerance), ties)


def _find_last_size(task: Task, shortlist: Shortlist) -> float:
    """Return the size beyond which no train can enter: infinite until the shortlist is full of exact trains."""
    full = shortlist.kept[0] == len(shortlist.error)
    exact = task.target.rational
    if not full or exact is None or shortlist.least_error.min() > ERROR_NOISE:
        return math.inf
    rows = shortlist.teeth if not task.by_size else shortlist.least_teeth[shortlist.least_error <= ERROR_NOISE]
    # Ranked by size, one exact train suffices; ranked by error, all kept trains must be exact.
    settled = (all if not task.by_size else any)(_decode_train(row).ratio == exact for row in rows)
    return float(shortlist.size.max()) if settled else math.inf


def _build_candidates(task: Task, k: int, near: float) -> Candidates:
    if task.reverted:
        return list_coaxial_meshes(task, k)
    spans = compute_stage_reach(task, k)
    few = list_few_meshes(task, k, (float(spans[0][0]), float(spans[0][1])), near)
    return few or Halves(task, k)


def _count_covered(task: Task, k: int) -> int:
    """Return the number of trains of k stages that the search covers, including those excluded by bounds."""
    if task.reverted:
        return list_coaxial_meshes(task, k).combinations
    return math.prod(_count_choices(task, values[:k], k) for values in (task.drivers, task.driven))


def _count_choices(task: Task, values: tuple[Integers, ...], k: int) -> int:
    if task.ordered:
        return math.prod(len(teeth) for teeth in values)
    return math.comb(len(values[0]) + k - 1, k)


def _compute_reach(task: Task, k: int) -> tuple[Fraction, Fraction] | None:
    """Return bounds of the ratios of k stages; None if there is no train."""
    if task.reverted:
        meshes = list_coaxial_meshes(task, k)
        if not meshes.steps:
            return None
    spans = compute_stage_reach(task, k)
    if not spans:
        return None
    low, high = (math.prod(ends, start=Fraction(1)) for ends in zip(*spans, strict=True))
    if len(task.stock):
        # The gears of the stock in rising order.
        gears = np.repeat(np.arange(len(task.stock)), task.stock).tolist()
        # The extreme products of k gears bound the ratio of a stock, apart from the pairing rules.
        most = Fraction(math.prod(gears[-k:]), math.prod(gears[:k]))
        low, high = max(low, 1 / most), min(high, most)
    return low, high


def _tighten_reach(
    task: Task, counts: tuple[int, ...], bounds: tuple[Fraction, Fraction], met: list[Fraction]
) -> tuple[Fraction, Fraction]:
    """Tighten the bounds of the ratios by a train's own ratio, at an end beyond which the target may lie.

    Meshes may be allowed individually although no train has all of them together, because of a stock, a common
    distance, or the total number of teeth. The train nearest to a bound then gives the attainable end. It is only
    searched if no train lies beyond the target.
    """
    low, high = bounds
    extreme = partial(
        _search_counts, counts=counts, near=UNLIMITED_TOLERANCE, tolerance=None, wanted=1, progress=_ignore_progress
    )
    if all(task.target.compare(ratio) > 0 for ratio in met):
        high = extreme(replace(task, target=RatioTarget(high), by_size=False)).trains[0].ratio
    if all(task.target.compare(ratio) < 0 for ratio in met):
        low = extreme(replace(task, target=RatioTarget(low), by_size=False)).trains[0].ratio
    return low, high


def _ignore_progress(fraction: float, message: str) -> None:
    """Ignore the progress of a secondary search."""


def _is_within_reach(target: RatioTarget, span: tuple[Fraction, Fraction], near: float) -> bool:
    slack = Fraction(near)
    over = near >= 1.0 or target.compare(span[1] / (1 - slack)) <= 0
    return over and target.compare(span[0] / (1 + slack)) >= 0


def _decode_train(row: Integers) -> Train:
    k = int(np.count_nonzero(row[:MAX_STAGES]))
    parts = (row[start : start + k] for start in (0, MAX_STAGES, 2 * MAX_STAGES))
    return Train(*(tuple(int(n) for n in part) for part in parts))


def order_trains(task: Task, trains: Iterable[Train], hunting: Container[Train] = ()) -> list[Train]:
    """Sort trains in the order of the ranking, by exact arithmetic.

    After error and size, fewer stages, a smaller largest gear and the tooth numbers make the order unique.
    Among trains of equal error (ranked by size: of equal size and error) those of ``hunting`` come first.
    """
    near = cmp_to_key(task.target.compare_distances)

    def key(train: Train) -> tuple[object, ...]:
        size, error = train.size(task.largest), near(train.ratio)
        other = train not in hunting
        first = (size, error, other) if task.by_size else (error, other, size)
        return (*first, len(train.drivers), max(train.drivers + train.driven), train)

    return sorted(trains, key=key)


def _may_have_dropped(task: Task, trains: list[Train], shortlist: Shortlist, wanted: int) -> bool:
    """Return whether a dropped train could belong among the first ``wanted``."""
    if shortlist.kept[0] < len(shortlist.error) or not trains:
        return False
    last = trains[min(wanted, len(trains)) - 1]
    dropped = _decode_train(shortlist.teeth[-1])
    if task.by_size and last.size(task.largest) != dropped.size(task.largest):
        return False
    if task.target.compare_distances(last.ratio, dropped.ratio) == 0:
        # Exactly tied in error: the loops sort such trains by size, which is exact; equal in both, either may stay.
        return False
    error, limit = (abs(task.target.compute_relative_error(train.ratio)) for train in (last, dropped))
    return abs(limit - error) <= ORDER_TOLERANCE * limit


def _list_equally_near(task: Task, ratio: Fraction) -> list[Fraction]:
    """List the ratio, and its mirror image at a rational target if its numbers are within reach of the trains."""
    target = task.target.rational
    if target is None or target == ratio:
        return [ratio]
    # Equal error on the other side of the target.
    mirrored = 2 * target - ratio
    possible = mirrored > 0 and max(mirrored.numerator, mirrored.denominator) <= task.most_teeth**MAX_STAGES
    return [ratio, mirrored] if possible else [ratio]


def _select_pareto(task: Task, shortlist: Shortlist, tolerance: Fraction | None) -> list[Train]:
    """Select the nearest train of each size that is nearer than all smaller ones."""
    near = cmp_to_key(task.target.compare_distances)
    trains = (_decode_train(row) for row in shortlist.least_teeth[np.isfinite(shortlist.least_error)])
    within = DEFAULT_TOLERANCE if tolerance is None else tolerance
    kept = (train for train in trains if task.target.is_within(train.ratio, within))
    return select_pareto(kept, lambda train: near(train.ratio))
