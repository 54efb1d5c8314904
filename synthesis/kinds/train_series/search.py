"""The search for the series nearest to a ratio, exhaustive by meeting in the middle.

The ratio of a series is the product of those of its units. The products of some units are sorted; for every
product p of the others, those that are near enough lie around T/p, where T is the target, and are found by bisection.
Errors in double precision select the series that may matter, slightly widened; these are sorted in exact arithmetic.

Equal units may change places. Only the series with its entries in non-increasing order is examined.
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

from kinematics.arrays import Integers, Real
from synthesis.kinds.train_series.catalogue import Catalogue
from synthesis.model.gears.ratio_target import RatioTarget
from synthesis.results.exhaustive import select_pareto

MAX_STORED_PRODUCTS = 1 << 21
"""Maximum number of sorted products in memory; the others are processed in blocks."""

BLOCK_SIZE = 1 << 18
"""Number of products that are looked up at once."""

WINDOW_MARGIN = 1e-13
"""Error by which a window is widened, since products of a few floats have relative errors of some 1e-15."""

WINDOW_GROWTH = 10.0
"""Growth factor of the window of errors from one step of the Pareto search to the next."""


class Series(NamedTuple):
    """A series by the entry of each unit, with its ranking criteria."""

    entries: tuple[int, ...]
    ratio: Fraction
    total: int


@dataclass(frozen=True)
class SearchResult:
    """Result of a search: the best series in the order of the ranking, the Pareto set, and the number of ties.

    ``nearest`` is the nearest series of all, within the tolerance or not; None if no series has the direction.
    """

    best: list[Series]
    front: list[Series]
    ties: int
    nearest: Series | None


class _Half(NamedTuple):
    """Products of some units' ratios: their values, teeth, and the entry of each unit, one row per unit."""

    value: Real
    total: Integers
    entries: Integers


class SeriesSearch:
    """A search of all series of some units.

    Parameters
    ----------
    catalogues : sequence of Catalogue
    alike : sequence of int
        For every unit the first unit that is equal to it.
    target : RatioTarget
        Magnitude of the requested ratio.
    sign : int
        Its direction.
    """

    def __init__(self, catalogues: Sequence[Catalogue], alike: Sequence[int], target: RatioTarget, sign: int) -> None:
        self._catalogues, self._alike = catalogues, alike
        self._target, self._sign = target, sign
        # Number of orders of equal units in which one series can occur.
        self._swaps = math.prod(math.factorial(alike.count(first)) for first in set(alike))
        self._wanted = sign * float(target)
        self._near = cmp_to_key(target.compare_distances)

    @property
    def combinations(self) -> int:
        """Number of series; those that only differ in the places of equal units count once."""
        counts = [len(catalogue.trains) for catalogue in self._catalogues]
        return math.prod(
            math.comb(counts[first] + self._alike.count(first) - 1, self._alike.count(first))
            for first in set(self._alike)
        )

    def find_best(self, tolerance: Fraction | None, near: Fraction, count: int, by_size: bool) -> SearchResult:
        """Find the ``count`` best series within the tolerance, and the Pareto set with errors up to ``near``."""
        if any(len(catalogue.value) == 0 for catalogue in self._catalogues):
            return SearchResult([], [], 0, None)
        # First an error bound by bisection, then all series within it.
        limit = self._bound_error(count)
        if limit is None:
            return SearchResult([], [], 0, None)
        ranked = self._rank_series(self._list_within(limit, None))
        nearest = ranked[0]
        ties = sum(
            self._count_trains(one) for one in ranked if self._target.compare_distances(one.ratio, nearest.ratio) == 0
        )
        front = self._search_front(nearest, near)
        if by_size:
            assert tolerance is not None
            ranked = self._find_smallest(tolerance, count)
        best = [one for one in ranked if tolerance is None or self._target.is_within(abs(one.ratio), tolerance)]
        return SearchResult(best[:count], front, ties, nearest)

    def list_rows(self, one: Series) -> Iterator[tuple[int, ...]]:
        """Yield the trains of a series, by their rows in the catalogues: every choice of trains of its entries."""
        choices = [
            range(int(catalogue.starts[e]), int(catalogue.starts[e + 1]))
            for catalogue, e in zip(self._catalogues, one.entries, strict=True)
        ]
        for rows in itertools.product(*choices):
            if all(rows[a] >= rows[b] for a, b in self._neighbours):
                yield rows

    @property
    def _neighbours(self) -> list[tuple[int, int]]:
        """Pairs of consecutive equal units."""
        places: dict[int, int] = {}
        pairs = []
        for k, first in enumerate(self._alike):
            if first in places:
                pairs.append((places[first], k))
            places[first] = k
        return pairs

    def _count_trains(self, one: Series) -> int:
        """Count the series of trains with these entries."""
        count = 1
        for first in set(self._alike):
            own = [e for e, same in zip(one.entries, self._alike, strict=True) if same == first]
            for entry in set(own):
                repeated = own.count(entry)
                trains = int(self._catalogues[first].counts[entry])
                # Equal units in the same entry: multisets of its trains.
                count *= math.comb(trains + repeated - 1, repeated)
        return count

    def _split_units(self, most_total: int | None) -> tuple[list[int], Iterator[_Half], list[int], _Half]:
        """Split the units: those processed in blocks with their products, and those held with their sorted products.

        ``most_total`` bounds the teeth of all units together.
        """
        allowed = [np.arange(len(catalogue.value)) for catalogue in self._catalogues]
        if most_total is not None:
            least = [int(catalogue.total.min()) for catalogue in self._catalogues]
            # Each unit may only have the teeth that the minimum of the others leaves.
            rest = most_total - sum(least)
            allowed = [
                np.flatnonzero(catalogue.total <= own + rest)
                for catalogue, own in zip(self._catalogues, least, strict=True)
            ]
        n = len(allowed)
        sizes = [len(one) for one in allowed]
        choices = [[k for k in range(n) if chosen >> k & 1] for chosen in range(1, (1 << n) - 1)]
        products = [math.prod(sizes[k] for k in units) for units in choices]
        # Hold the largest set of units that fits into memory, so that the fewest products are processed.
        fitting = [place for place, product in enumerate(products) if product <= MAX_STORED_PRODUCTS]
        place = (
            max(fitting, key=products.__getitem__) if fitting else min(range(len(products)), key=products.__getitem__)
        )
        held = choices[place]
        through = [k for k in range(n) if k not in held]
        whole = self._list_products(held, allowed, 0, products[place])
        order = np.argsort(whole.value, kind="stable")
        ordered = _Half(whole.value[order], whole.total[order], whole.entries[:, order])
        every = math.prod(sizes[k] for k in through)
        blocks = (
            self._list_products(through, allowed, start, min(start + BLOCK_SIZE, every))
            for start in range(0, every, BLOCK_SIZE)
        )
        return through, blocks, held, ordered

    def _list_products(self, units: list[int], allowed: list[Integers], start: int, end: int) -> _Half:
        """Compute the products of a range of choices, with the last unit's entries varying fastest."""
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

    def _bound_error(self, count: int) -> float | None:
        """Return an error that at least ``count`` series do not exceed, infinite if there are fewer; None: no series.

        For every processed product the neighbours of its ideal partner on both sides are evaluated.
        """
        # Equal units are met in every order: each series may be counted that many times.
        needed, width = count * self._swaps, 1
        while True:
            _, blocks, _, held = self._split_units(None)
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
            # Too few partners with the right sign: widen the neighbourhood.
            width = min(2 * width, len(held.value))

    def _list_within(self, error: float, most_total: int | None) -> Integers:
        """List the entries of all series with errors up to a limit and at most this many teeth, one column each."""
        through, blocks, held_units, held = self._split_units(most_total)
        found = [np.zeros((len(self._catalogues), 0), np.int64)]
        low, high = max(0.0, 1.0 - error - WINDOW_MARGIN), 1.0 + error + WINDOW_MARGIN
        for block in blocks:
            wanted = self._wanted / block.value
            # A negative product reverses the window.
            ends = np.sort(np.stack([low * wanted, high * wanted]), axis=0)
            first = np.searchsorted(held.value, ends[0], side="left")
            last = np.searchsorted(held.value, ends[1], side="right")
            near = np.maximum(last - first, 0)
            which = np.repeat(np.arange(len(near)), near)
            # Expand the ranges first..last of all products into one flat list of places.
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

    def _rank_series(self, entries: Integers) -> list[Series]:
        """Sort series by error and size, exactly; among equal ones those with the larger ratios first come first."""
        listed = self._build_series(entries)
        return sorted(listed, key=lambda one: (self._near(abs(one.ratio)), one.total, [-e for e in one.entries]))

    def _build_series(self, entries: Integers) -> list[Series]:
        """Build the series of entries with their exact ratios and teeth."""
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

    def _search_front(self, nearest: Series, near: Fraction) -> list[Series]:
        """Search the Pareto set of error against size, with errors up to ``near``, by rising size.

        It begins at the nearest series of fewest teeth. Then follow larger errors with fewer teeth: a window that has
        grown tenfold is searched for series with fewer teeth than all before.
        """
        if not self._target.is_within(abs(nearest.ratio), near):
            return []
        met, fewest = [nearest], nearest.total
        error = max(abs(self._target.compute_relative_error(abs(nearest.ratio))), WINDOW_MARGIN)
        while True:
            error = min(WINDOW_GROWTH * error, float(near))
            listed = self._build_series(self._list_within(error, fewest - 1))
            met += [one for one in listed if self._target.is_within(abs(one.ratio), near)]
            fewest = min([fewest, *(one.total for one in met)])
            if error >= float(near):
                break
        rising = sorted(met, key=lambda one: (one.total, self._near(abs(one.ratio)), [-e for e in one.entries]))
        return select_pareto(rising, lambda one: self._near(abs(one.ratio)))

    def _find_smallest(self, tolerance: Fraction, count: int) -> list[Series]:
        """Find the series of fewest teeth within a tolerance, the nearest of equally small ones first."""
        least, most = (sum(int(end(catalogue.total)) for catalogue in self._catalogues) for end in (np.min, np.max))
        reach = 1
        while True:
            bound = min(least + reach, most)
            listed = [
                one
                for one in self._build_series(self._list_within(float(tolerance), bound))
                if self._target.is_within(abs(one.ratio), tolerance)
            ]
            if sum(self._count_trains(one) for one in listed) >= count or bound >= most:
                return sorted(
                    listed, key=lambda one: (one.total, self._near(abs(one.ratio)), [-e for e in one.entries])
                )
            # Double the bound on the teeth until enough series are found.
            reach *= 2
