"""The search for the series nearest to a ratio, exhaustive by meeting in the middle.

The ratio of a series is the product of those of its units. The products of some units stand in rising order; for every
product p of the others, those that are near enough lie around T/p, where T is the target, and are found by bisection.
Errors in double precision say which series may matter, a little wide; what they leave is ordered in exact arithmetic.

Units that are stated alike may change places: of their series the one counts whose entries do not rise.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cmp_to_key
from typing import NamedTuple

import numpy as np

from synthesis.kinds.train_series.catalogue import Catalogue, Real, Whole
from synthesis.model.ratio_target import Target
from synthesis.outcome.exhaustive import pareto

STORED = 1 << 21
"""Products that are held in order at most; the others are gone through in blocks."""

BLOCK = 1 << 18
"""Products that are looked up at once."""

MARGIN = 1e-13
"""Error by which a window is widened: the products of a few floats are off by some 1e-15 of themselves."""

WIDER = 10.0
"""By how much the window of errors grows from one step of the Pareto set to the next."""


class Series(NamedTuple):
    """A series by the entry of each unit, with what it is ranked by."""

    entries: tuple[int, ...]
    ratio: Fraction
    total: int


@dataclass(frozen=True)
class Found:
    """What a search met: the best in the order of the ranking, the Pareto set, and how many are as near as the nearest.

    ``nearest`` is the nearest of all, whatever the tolerance; None where no series turns the right way.
    """

    best: list[Series]
    front: list[Series]
    ties: int
    nearest: Series | None


class _Half(NamedTuple):
    """Products of some units' ratios: their values, teeth, and the entry of each unit, a row a unit."""

    value: Real
    total: Whole
    entries: Whole


class Search:
    """A search of all series of some units.

    Parameters
    ----------
    catalogues : sequence of Catalogue
    alike : sequence of int
        For every unit the first that is stated like it.
    target : Target
        Size of the demanded ratio.
    sign : int
        Its direction.
    """

    def __init__(self, catalogues: Sequence[Catalogue], alike: Sequence[int], target: Target, sign: int) -> None:
        self._catalogues, self._alike = catalogues, alike
        self._target, self._sign = target, sign
        self._swaps = math.prod(math.factorial(alike.count(first)) for first in set(alike))
        self._wanted = sign * float(target)
        self._near = cmp_to_key(target.nearer)

    @property
    def combinations(self) -> int:
        """How many series there are; those that differ in the places of units that are stated alike are one."""
        counts = [len(catalogue.trains) for catalogue in self._catalogues]
        return math.prod(
            math.comb(counts[first] + self._alike.count(first) - 1, self._alike.count(first))
            for first in set(self._alike)
        )

    def found(self, tolerance: Fraction | None, near: Fraction, count: int, by_size: bool) -> Found:
        """The ``count`` best series within the tolerance, and the Pareto set of those with errors up to ``near``."""
        if any(len(catalogue.value) == 0 for catalogue in self._catalogues):
            return Found([], [], 0, None)
        limit = self._error_of_nearest(count)
        if limit is None:
            return Found([], [], 0, None)
        ranked = self._ranked(self._within(limit, None))
        nearest = ranked[0]
        ties = sum(self._trains(one) for one in ranked if self._target.nearer(one.ratio, nearest.ratio) == 0)
        front = self._front(nearest, near)
        if by_size:
            assert tolerance is not None
            ranked = self._smallest(tolerance, count)
        best = [one for one in ranked if tolerance is None or self._target.within(abs(one.ratio), tolerance)]
        return Found(best[:count], front, ties, nearest)

    def rows(self, one: Series) -> Iterator[tuple[int, ...]]:
        """The trains of a series, by their rows in the catalogues: every choice of trains of its entries."""
        choices = [
            range(int(catalogue.starts[e]), int(catalogue.starts[e + 1]))
            for catalogue, e in zip(self._catalogues, one.entries, strict=True)
        ]
        for rows in itertools.product(*choices):
            if all(rows[a] >= rows[b] for a, b in self._neighbours):
                yield rows

    @property
    def _neighbours(self) -> list[tuple[int, int]]:
        """Pairs of units that are stated alike, with no such one between."""
        places: dict[int, int] = {}
        pairs = []
        for k, first in enumerate(self._alike):
            if first in places:
                pairs.append((places[first], k))
            places[first] = k
        return pairs

    def _trains(self, one: Series) -> int:
        """How many series of trains have these entries."""
        count = 1
        for first in set(self._alike):
            own = [e for e, same in zip(one.entries, self._alike, strict=True) if same == first]
            for entry in set(own):
                repeated = own.count(entry)
                trains = int(self._catalogues[first].counts[entry])
                count *= math.comb(trains + repeated - 1, repeated)
        return count

    def _halves(self, most_total: int | None) -> tuple[list[int], Iterator[_Half], list[int], _Half]:
        """The units that are gone through, their products in blocks, those that are held, and their products in order.

        ``most_total`` bounds the teeth of all units together.
        """
        allowed = [np.arange(len(catalogue.value)) for catalogue in self._catalogues]
        if most_total is not None:
            least = [int(catalogue.total.min()) for catalogue in self._catalogues]
            rest = most_total - sum(least)
            allowed = [
                np.flatnonzero(catalogue.total <= own + rest)
                for catalogue, own in zip(self._catalogues, least, strict=True)
            ]
        n = len(allowed)
        sizes = [len(one) for one in allowed]
        choices = [[k for k in range(n) if chosen >> k & 1] for chosen in range(1, (1 << n) - 1)]
        products = [math.prod(sizes[k] for k in units) for units in choices]
        fitting = [place for place, product in enumerate(products) if product <= STORED]
        place = (
            max(fitting, key=products.__getitem__) if fitting else min(range(len(products)), key=products.__getitem__)
        )
        held = choices[place]
        through = [k for k in range(n) if k not in held]
        whole = self._products(held, allowed, 0, products[place])
        order = np.argsort(whole.value, kind="stable")
        ordered = _Half(whole.value[order], whole.total[order], whole.entries[:, order])
        every = math.prod(sizes[k] for k in through)
        blocks = (
            self._products(through, allowed, start, min(start + BLOCK, every)) for start in range(0, every, BLOCK)
        )
        return through, blocks, held, ordered

    def _products(self, units: list[int], allowed: list[Whole], start: int, end: int) -> _Half:
        """The products of a range of choices, the last unit's entries running fastest."""
        rest = np.arange(start, end)
        entries = np.zeros((len(units), end - start), np.int64)
        for place in range(len(units) - 1, -1, -1):
            rest, at = np.divmod(rest, len(allowed[units[place]]))
            entries[place] = allowed[units[place]][at]
        kept = np.ones(end - start, np.bool_)
        for a, b in self._neighbours:
            if a in units and b in units:
                kept &= entries[units.index(a)] >= entries[units.index(b)]
        entries = entries[:, kept]
        value, total = np.ones(entries.shape[1]), np.zeros(entries.shape[1], np.int64)
        for unit, own in zip(units, entries, strict=True):
            value = value * self._catalogues[unit].value[own]
            total = total + self._catalogues[unit].total[own]
        return _Half(value, total, entries)

    def _error_of_nearest(self, count: int) -> float | None:
        """An error that at least ``count`` series do not exceed, infinite where there are not so many; None: no series.

        Of every product that is gone through the neighbours of its wanted partner on both sides are looked at.
        """
        needed, width = count * self._swaps, 1
        while True:
            _, blocks, _, held = self._halves(None)
            least = np.zeros(0)
            for block in blocks:
                at = np.searchsorted(held.value, self._wanted / block.value)
                for step in range(-width, width):
                    place = at + step
                    inside = (place >= 0) & (place < len(held.value))
                    share = block.value[inside] * held.value[place[inside]] / self._wanted
                    least = np.concatenate([least, np.abs(share[share > 0.0] - 1.0)])
                    if len(least) > needed:
                        least = np.partition(least, needed - 1)[:needed]
            if len(least) >= needed:
                return float(least.max())
            if width >= len(held.value):
                return math.inf if len(least) else None
            width = min(2 * width, len(held.value))

    def _within(self, error: float, most_total: int | None) -> Whole:
        """The entries of all series with errors up to a limit and with so many teeth at most, a column a series."""
        through, blocks, held_units, held = self._halves(most_total)
        found = [np.zeros((len(self._catalogues), 0), np.int64)]
        low, high = max(0.0, 1.0 - error - MARGIN), 1.0 + error + MARGIN
        for block in blocks:
            wanted = self._wanted / block.value
            ends = np.sort(np.stack([low * wanted, high * wanted]), axis=0)
            first = np.searchsorted(held.value, ends[0], side="left")
            last = np.searchsorted(held.value, ends[1], side="right")
            near = np.maximum(last - first, 0)
            which = np.repeat(np.arange(len(near)), near)
            place = np.arange(len(which)) - np.repeat(np.cumsum(near) - near, near) + first[which]
            entries = np.zeros((len(self._catalogues), len(which)), np.int64)
            entries[through], entries[held_units] = block.entries[:, which], held.entries[:, place]
            kept = np.ones(len(which), np.bool_)
            if most_total is not None:
                kept &= block.total[which] + held.total[place] <= most_total
            for a, b in self._neighbours:
                kept &= entries[a] >= entries[b]
            found.append(entries[:, kept])
        return np.concatenate(found, axis=1)

    def _ranked(self, entries: Whole) -> list[Series]:
        """Series in the order of error and size, exact; of equal ones those of the larger ratios first come first."""
        listed = self._measured(entries)
        return sorted(listed, key=lambda one: (self._near(abs(one.ratio)), one.total, [-e for e in one.entries]))

    def _measured(self, entries: Whole) -> list[Series]:
        """Series of entries with their exact ratios and teeth."""
        total = np.zeros(entries.shape[1], np.int64)
        for catalogue, own in zip(self._catalogues, entries, strict=True):
            total += catalogue.total[own]
        parts = [
            [catalogue.over[own].tolist(), catalogue.under[own].tolist()]
            for catalogue, own in zip(self._catalogues, entries, strict=True)
        ]
        known: dict[tuple[int, int], Fraction] = {}
        listed = []
        for k, (own, teeth) in enumerate(zip(entries.T.tolist(), total.tolist(), strict=True)):
            fraction = math.prod(over[k] for over, _ in parts), math.prod(under[k] for _, under in parts)
            ratio = known.get(fraction)
            if ratio is None:
                ratio = known[fraction] = Fraction(*fraction)
            listed.append(Series(tuple(own), ratio, teeth))
        return listed

    def _front(self, nearest: Series, near: Fraction) -> list[Series]:
        """The Pareto set of error against size, with errors up to ``near``, by rising size.

        It is found from its end: beyond the nearest series of fewest teeth there is nothing. Then come larger errors
        with fewer teeth, and a window that has grown tenfold is searched for what has fewer teeth than all before.
        """
        if not self._target.within(abs(nearest.ratio), near):
            return []
        met, fewest = [nearest], nearest.total
        error = max(abs(self._target.relative_error(abs(nearest.ratio))), MARGIN)
        while True:
            error = min(WIDER * error, float(near))
            listed = self._measured(self._within(error, fewest - 1))
            met += [one for one in listed if self._target.within(abs(one.ratio), near)]
            fewest = min([fewest, *(one.total for one in met)])
            if error >= float(near):
                break
        rising = sorted(met, key=lambda one: (one.total, self._near(abs(one.ratio)), [-e for e in one.entries]))
        return pareto(rising, lambda one: self._near(abs(one.ratio)))

    def _smallest(self, tolerance: Fraction, count: int) -> list[Series]:
        """The series of fewest teeth within a tolerance, of equally small ones the nearest first."""
        least, most = (sum(int(end(catalogue.total)) for catalogue in self._catalogues) for end in (np.min, np.max))
        reach = 1
        while True:
            bound = min(least + reach, most)
            listed = [
                one
                for one in self._measured(self._within(float(tolerance), bound))
                if self._target.within(abs(one.ratio), tolerance)
            ]
            if sum(self._trains(one) for one in listed) >= count or bound >= most:
                return sorted(
                    listed, key=lambda one: (one.total, self._near(abs(one.ratio)), [-e for e in one.entries])
                )
            reach *= 2
