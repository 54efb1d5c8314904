"""The finite sets of trains that a search covers, ready for the compiled loops.

:class:`Halves` lists all choices of drivers and all choices of driven gears, whose products meet in the middle: k gears
of n tooth numbers are only C(n+k−1, k) multisets, and the ratio does not depend on the pairing. :class:`Meshes` lists
all meshes a:b. They form groups of equal centre distance for reverted trains. They form one group if the constraints
leave so few meshes that this list is shorter than the choices of drivers and driven gears.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers, Real
from synthesis.kinds.gear_train.search import kernels
from synthesis.kinds.gear_train.search.kernels import Gears
from synthesis.kinds.gear_train.search.pairing_rules import Rule
from synthesis.kinds.gear_train.search.shortlist import Shortlist
from synthesis.kinds.gear_train.search.task import Task
from synthesis.kinds.gear_train.statement.search_size import MAX_ENUMERATED_TRAINS

WINDOW_MARGIN = 1e-9
"""Relative widening of a window of ratios, so that the rounding of powers excludes no train."""

MIN_SORTED_TRAINS = 10_000_000
"""Number of trains of two halves above which sorting the halves by product as well saves time."""

_NO_TIES = np.zeros((0, 2), np.int64)


class Candidates(Protocol):
    """A finite set of trains in ``steps`` parts, with sizes that do not decrease from part to part."""

    @property
    def combinations(self) -> int:
        """Number of trains in the set."""

    @property
    def steps(self) -> int:
        """Number of parts."""

    def search(self, first: int, last: int, rule: Rule, shortlist: Shortlist) -> None:
        """Search the parts from ``first`` up to and without ``last``."""

    def bound_size(self, part: int) -> int:
        """Return a lower bound of the sizes in a part and all later ones."""

    def finish(self, first: int, rule: Rule, shortlist: Shortlist) -> bool:
        """Search all parts from ``first`` on at once if this takes little work; return whether it was done."""

    def ties(self, ratios: list[Fraction], rule: Rule, shortlist: Shortlist) -> int:
        """Count the trains with exactly one of these ratios; ``shortlist`` holds a search's result."""


class _Half(NamedTuple):
    """Choices of a gear for each stage; rows of size u are ``starts[u]`` to ``starts[u + 1]``, sorted by product."""

    teeth: Gears
    products: Integers
    starts: Integers
    sizes: Integers


class Halves:
    """All trains of k stages as drivers × driven gears."""

    def __init__(self, task: Task, k: int) -> None:
        self.k = k
        self.drivers = _build_half(task, task.drivers[:k])
        # Equal ranges on both sides share one list: half the memory and time.
        same = all(np.array_equal(a, b) for a, b in zip(task.drivers[:k], task.driven[:k], strict=True))
        self.driven = self.drivers if same else _build_half(task, task.driven[:k])
        # Every choice of drivers is combined with every choice of driven gears.
        self.combinations = len(self.drivers.products) * len(self.driven.products)
        join = max if task.largest else sum
        sizes = [(half.sizes.min(), half.sizes.max()) for half in (self.drivers, self.driven)]
        self.least_size, most = (int(join(ends)) for ends in zip(*sizes, strict=True)) if self.combinations else (0, -1)
        if task.most_total is not None:
            most = min(most, task.most_total)
        # One part per size, so that small trains come first and the search can stop early.
        self.steps = max(0, most - self.least_size + 1)

    def search(self, first: int, last: int, rule: Rule, shortlist: Shortlist) -> None:
        """Search a range of sizes."""
        start = self.least_size
        drivers, driven = self.drivers, self.driven
        kernels.match(
            self.k,
            drivers.teeth,
            drivers.products,
            drivers.starts,
            driven.teeth,
            driven.products,
            driven.starts,
            start + first,
            start + last,
            rule,
            shortlist,
        )

    def bound_size(self, part: int) -> int:
        """Return the size of a part."""
        return self.least_size + part

    def finish(self, first: int, rule: Rule, shortlist: Shortlist) -> bool:
        """Search both lists in one pass by product, if too few trains are near for separate passes by size."""
        size = self.bound_size(first)
        # Until the shortlist is full, and for sizes that still rank, one pass would find too many trains.
        settled = shortlist.kept[0] == len(shortlist.error) and (not rule.by_size or size > shortlist.size[-1])
        if not settled or self.combinations < MIN_SORTED_TRAINS:
            return False
        near = max(
            float(shortlist.least_error[:size].min(initial=math.inf)), 0.0 if rule.by_size else shortlist.error[-1]
        )
        # The products span a few powers of e, so that about combinations · near pairs are as near as ``near``.
        if self.combinations * near > MAX_ENUMERATED_TRAINS:
            return False
        orders = [np.argsort(half.products, kind="stable") for half in (self.drivers, self.driven)]
        kernels.match_all(
            self.k,
            self.drivers.teeth,
            self.drivers.products,
            self.drivers.sizes,
            orders[0],
            self.driven.teeth,
            self.driven.products,
            self.driven.sizes,
            orders[1],
            size,
            rule,
            shortlist,
        )
        return True

    def ties(self, ratios: list[Fraction], rule: Rule, shortlist: Shortlist) -> int:
        """Count the products in exactly one of the ratios."""
        order = np.argsort(self.driven.products, kind="stable")
        driven, products = self.driven.teeth[order], self.driven.products[order]
        # Exact fractions: a train ties if its reduced ratio is one of the given.
        count, drivers = 0, (self.drivers.teeth, self.drivers.products)
        for ratio in ratios:
            fraction = ratio.numerator, ratio.denominator
            count += int(kernels.count_products(self.k, *drivers, driven, products, *fraction, rule))
        return count


def _build_half(task: Task, values: tuple[Integers, ...]) -> _Half:
    flat = np.concatenate(values)
    starts = np.concatenate([[0], np.cumsum([len(v) for v in values])])
    rows = np.empty((0, len(values)), np.int16)
    # The first pass only counts, so that the second can write into an array of the right size.
    number = kernels.enumerate_tuples(flat, starts, task.stock, task.ordered, rows)
    rows = np.empty((number, len(values)), np.int16)
    kernels.enumerate_tuples(flat, starts, task.stock, task.ordered, rows)
    products, sizes = np.ones(number, np.int64), np.zeros(number, np.int64)
    for column in rows.T:
        products *= column
        sizes = np.maximum(sizes, column) if task.largest else sizes + column
    order = np.lexsort((products, sizes))
    bounds = np.searchsorted(sizes[order], np.arange(int(sizes.max(initial=0)) + 2))
    return _Half(rows[order], products[order], bounds, sizes[order])


@dataclass(frozen=True, eq=False)
class Meshes:
    """Trains of one mesh for each of k stages, all from one group.

    ``distances[row]`` are the intervals of distances that a mesh can have, for coaxial meshes that must agree.
    """

    k: int
    a: Integers
    b: Integers
    mark: Integers
    ratio: Real
    groups: Integers
    least_size: Integers
    distances: Real
    coaxial: bool
    combinations: int

    @property
    def steps(self) -> int:
        """Number of groups."""
        return len(self.groups)

    def search(self, first: int, last: int, rule: Rule, shortlist: Shortlist) -> None:
        """Search a range of groups."""
        self._combine(first, last, rule, shortlist, _NO_TIES)

    def bound_size(self, part: int) -> int:
        """Return the bound of a group."""
        return int(self.least_size[part])

    def finish(self, first: int, rule: Rule, shortlist: Shortlist) -> bool:
        """Return False: groups are searched one by one."""
        return False

    def ties(self, ratios: list[Fraction], rule: Rule, shortlist: Shortlist) -> int:
        """Count the trains of the ratios in a second pass over all groups."""
        shortlist.ties[0] = 0
        fractions = np.array([(ratio.numerator, ratio.denominator) for ratio in ratios], np.int64)
        self._combine(0, self.steps, rule, shortlist, fractions)
        return int(shortlist.ties[0])

    def _combine(self, first: int, last: int, rule: Rule, shortlist: Shortlist, tied: Integers) -> None:
        lists = self.a, self.b, self.mark, self.ratio, self.groups, self.least_size, self.distances
        kernels.combine(self.k, *lists, first, last, self.coaxial, rule, shortlist, tied)


def list_coaxial_meshes(task: Task, k: int) -> Meshes:
    """List reverted trains: groups of equal pitch × (a + b), thus equal distance; one group of fitted meshes."""
    pitches = len(task.pitches) if task.fit is None or task.fit.shares_distance else 1
    return _group_meshes(task, k, [_list_meshes(task, i, pitches, task.meshes(i)) for i in range(k)], coaxial=True)


def list_few_meshes(task: Task, k: int, reach: tuple[float, float], tolerance: float) -> Meshes | None:
    """List trains of the meshes that can still reach the target, if they are few; None if they are many.

    If every stage ratio is within ``reach``, each stage of a train that is near enough has a ratio of at least
    T (1 − t) / reach₁^(k−1).
    """
    if task.fit is not None:
        return _list_few_fitted(task, k)
    if not task.by_mesh or task.ordered or k in task.idler_counts:
        return None
    low, high = reach
    ratio = float(task.target)
    # The other k − 1 stages contribute at most their maximum and at least their minimum ratios.
    least = ratio * (1.0 - tolerance) / high ** (k - 1) * (1.0 - WINDOW_MARGIN)
    most = ratio * (1.0 + tolerance) / low ** (k - 1) * (1.0 + WINDOW_MARGIN)
    a, b, mark = _list_meshes(task, 0, 1, task.allowed)
    kept = (b / a >= least) & (b / a <= most)
    if not math.comb(int(np.count_nonzero(kept)) + k - 1, k) <= MAX_ENUMERATED_TRAINS:
        return None
    return _group_meshes(task, k, [(a[kept], b[kept], mark[kept])] * k, coaxial=False)


def _list_few_fitted(task: Task, k: int) -> Meshes | None:
    """List trains of fitted meshes, if all stages except one have few choices."""
    stages = [_list_meshes(task, i, 1, task.meshes(i)) for i in range(k)]
    counts = [len(stage[0]) for stage in stages]
    # Only the choices of all stages but the last are enumerated; the last is found by bisection.
    choices = math.prod(counts[:-1]) if task.ordered else math.comb(counts[0] + k - 2, k - 1)
    return _group_meshes(task, k, stages, coaxial=False) if choices <= MAX_ENUMERATED_TRAINS else None


def compute_stage_reach(task: Task, k: int) -> list[tuple[Fraction, Fraction]]:
    """Return the minimum and maximum ratio of each stage's allowed meshes; empty if a stage has none."""
    reaches = []
    for i in range(k):
        a, b, _ = _list_meshes(task, i, 1, task.stages(k, i))
        if not len(a):
            return []
        ratio = b / a
        ends = (int(np.argmin(ratio)), int(np.argmax(ratio)))
        low, high = (Fraction(int(b[end]), int(a[end])) for end in ends)
        reaches.append((low, high))
    return reaches


def _list_meshes(
    task: Task, stage: int, pitches: int, allowed: NDArray[np.bool_]
) -> tuple[Integers, Integers, Integers]:
    """List the allowed meshes of a stage, each with each of the first ``pitches`` pitches."""
    drivers, driven = task.drivers[stage], task.driven[stage]
    at = np.argwhere(allowed[np.ix_(drivers, driven)])
    a, b = drivers[at[:, 0]], driven[at[:, 1]]
    return np.tile(a, pitches), np.tile(b, pitches), np.repeat(np.arange(pitches), len(a))


def _group_meshes(task: Task, k: int, stages: list[tuple[Integers, Integers, Integers]], coaxial: bool) -> Meshes:
    """Sort the meshes of the stages by group, stage and ratio."""
    # Interchangeable stages share one list.
    listed = stages if task.ordered else stages[:1]
    a, b, mark = (np.concatenate([stage[column] for stage in listed]) for column in range(3))
    stage = np.repeat(np.arange(len(listed)), [len(one[0]) for one in listed])
    ends: Real = np.tile(np.array([[0.0, np.inf]]), (len(a), 1, 1))
    if coaxial and task.fit is not None and task.fit.shares_distance:
        ends = task.fit.ends[np.minimum(stage, len(task.fit.ends) - 1), mark, a, b]
        fits = np.isfinite(ends[:, 0, 0])
        a, b, mark, stage, ends = a[fits], b[fits], mark[fits], stage[fits], ends[fits]
    key = task.compute_distance_keys(mark, stage, a, b) if coaxial else np.zeros(len(a), np.int64)
    order = np.lexsort((b / a, stage, key))
    a, b, mark, stage, key = (column[order] for column in (a, b, mark, stage, key))
    distances = np.ascontiguousarray(ends[order])
    ratio = b / a
    # One group per distance.
    keys = np.unique(key)
    places = np.arange(len(listed) + 1)
    # Rows are sorted by (key, stage): one search over both finds the start of each stage of each group.
    joined = np.searchsorted(key * (len(listed) + 1) + stage, keys[:, None] * (len(listed) + 1) + places[None, :])
    # A group without a mesh for every stage holds no train.
    complete = (np.diff(joined, axis=1) > 0).all(axis=1)
    joined = joined[complete]
    size = np.maximum(a, b) if task.largest else a + b
    least = np.array([_compute_least_size(size, group, task.largest, k) for group in joined], np.int64)
    if task.most_total is not None and not task.largest:
        joined, least = joined[least <= task.most_total], least[least <= task.most_total]
    # Groups in rising order of their smallest train let the search stop as soon as no smaller train can follow.
    rising = np.argsort(least, kind="stable")
    groups = np.ascontiguousarray(joined[rising], np.int64)
    counts = np.diff(groups, axis=1)
    if task.ordered:
        combinations = sum(math.prod(int(n) for n in row) for row in counts)
    else:
        combinations = sum(math.comb(int(n) + k - 1, k) for n in counts[:, 0])
    return Meshes(k, a, b, mark, ratio, groups, least[rising], distances, coaxial, combinations)


def _compute_least_size(size: Integers, group: Integers, largest: bool, k: int) -> int:
    """Return a lower bound of the sizes of a group's trains."""
    least = [int(size[start:end].min()) for start, end in itertools.pairwise(group)]
    if largest:
        return max(least)
    return sum(least) if len(least) > 1 else k * least[0]
