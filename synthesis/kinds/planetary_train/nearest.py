"""Search for the trains of an arrangement with the ratio nearest to a target, overall and for every size.

Numerator and denominator of every ratio are integers that double precision holds exactly; only their quotient is
rounded, by 1e-16 of itself. Errors that differ by less than :data:`ERROR_TOLERANCE` are compared as exact fractions, so
that rounding never decides the order.

Trains of one planet set are ranked over all its sound tooth numbers. If two sets are coupled, each enters the ratio
by one number, its train value x, and for a fixed x₁ the ratio is a quotient of two linear functions of x₂. On the
projective line such a function is one-to-one, so that the error grows monotonically to both sides of the x₂ that would
meet the target: the k nearest values of x₂ on each side contain the k best partners of x₁.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache, cached_property
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Integers, Real
from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from synthesis.kinds.planetary_train.ratio_form import (
    Polynomial,
    RatioForm,
    build_mesh_row,
    build_set_rows,
    derive_arrangement_form,
    derive_ratio_form,
    evaluate_polynomial,
)

Roles = tuple[str, str, str]
"""Input, output and fixed member."""

ERROR_TOLERANCE = 1e-12
"""Difference of errors below which they are compared exactly; quotients of integers are rounded by 2e-16."""


class Candidate(NamedTuple):
    """A sound train, with the exact ratio and its ranking criteria."""

    error: Fraction
    size: int
    total: int
    arrangement: str
    roles: Roles
    teeth: tuple[tuple[str, int], ...]
    ratio: Fraction


@dataclass
class NearestTrains:
    """The best trains of one arrangement and choice of members.

    ``best`` are the best trains in the order of error, size and number of teeth. ``by_size`` are the trains of minimum
    error for each size. ``ties`` is the number of trains with the overall minimum error.
    """

    best: list[Candidate] = field(default_factory=list)
    by_size: dict[int, Candidate] = field(default_factory=dict)
    ties: int = 0


@dataclass(frozen=True)
class SetTable:
    """Sound tooth numbers of one planet set, with size and number of teeth of each.

    ``value`` is the set's train value, for sets that are coupled to another.
    """

    teeth: dict[str, Integers]
    size: Integers
    value: RatioForm | None = None

    @cached_property
    def values(self) -> dict[str, Real]:
        """Teeth as floating-point numbers."""
        return {gear: array.astype(np.float64) for gear, array in self.teeth.items()}

    @cached_property
    def total(self) -> Integers:
        """Sum of all teeth of one copy."""
        return np.asarray(np.sum(np.stack(list(self.teeth.values())), axis=0), np.int64)

    @cached_property
    def train_values(self) -> TrainValues:
        """Train values in rising order."""
        assert self.value is not None
        return TrainValues(self, self.value)

    @cached_property
    def by_size(self) -> tuple[Integers, Integers, Integers]:
        """Order by size, the start of each size in it, and the sizes."""
        order = np.argsort(self.size, kind="stable")
        sizes, starts = np.unique(self.size[order], return_index=True)
        return order, starts, sizes

    def read_row(self, at: int) -> tuple[tuple[str, int], ...]:
        """Return the teeth of one row."""
        return tuple((gear, int(array[at])) for gear, array in self.teeth.items())


def find_nearest(
    arrangement: Arrangement, tables: Sequence[SetTable], roles: Roles, target: Fraction, count: int
) -> NearestTrains | None:
    """Find the ``count`` best trains, and the best of each size; None if a planet set does not affect the ratio."""
    if any(len(table.size) == 0 for table in tables):
        return NearestTrains()
    if len(tables) == 1:
        form = derive_arrangement_form(arrangement.name, *roles)
        return _search_one_set(arrangement.name, tables[0], roles, form, target, count)
    coupling = Coupling.from_arrangement(arrangement, roles)
    return (
        None
        if coupling is None
        else _TwoSetSearch(arrangement.name, tables, roles, coupling, target).find_nearest(count)
    )


def _compute_errors(over: Real, under: Real, target: Fraction) -> Real:
    """Compute relative errors; infinite if the ratio has the other direction or does not exist."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = over / under / float(target)
    return np.where(np.isfinite(share) & (share > 0.0), np.abs(share - 1.0), np.inf)


def _compute_exact_errors(over: Real, under: Real, target: Fraction) -> tuple[list[Fraction], list[Fraction], Integers]:
    """Return distinct ratios and their errors, and the index of each quotient among them."""
    whole = over.astype(np.int64), under.astype(np.int64)
    common = np.gcd(*whole)
    reduced = np.stack([part // common for part in whole], axis=-1)
    distinct, which = np.unique(reduced, axis=0, return_inverse=True)
    # Few distinct ratios occur among many trains: fractions are built once for each.
    ratios = [Fraction(int(a), int(b)) for a, b in distinct]
    return ratios, [abs(ratio / target - 1) for ratio in ratios], which.reshape(-1)


def _rank_errors(errors: list[Fraction]) -> Integers:
    order = {error: rank for rank, error in enumerate(sorted(set(errors)))}
    return np.array([order[error] for error in errors], np.int64)


def _search_one_set(
    name: str, table: SetTable, roles: Roles, form: RatioForm, target: Fraction, count: int
) -> NearestTrains:
    """Find the nearest trains if one planet set determines the ratio, by evaluating all its tooth numbers."""
    nearest_trains = NearestTrains()
    if not form.over:
        return nearest_trains
    size = len(table.size)
    over, under = (
        evaluate_polynomial(form.over, table.values, size),
        evaluate_polynomial(form.under, table.values, size),
    )
    errors = _compute_errors(over, under, target)
    possible = int(np.count_nonzero(np.isfinite(errors)))
    if not possible:
        return nearest_trains

    def list_candidates(rows: Integers, first_by: str, most: int) -> tuple[list[Candidate], int]:
        ratios, exact, which = _compute_exact_errors(over[rows], under[rows], target)
        rank = _rank_errors(exact)[which]
        gears = [table.teeth[gear][rows] for gear in reversed(table.teeth)]
        keys = [*gears, table.total[rows]]
        keys += [table.size[rows], rank] if first_by == "error" else [rank, table.size[rows]]
        order = np.lexsort(keys)
        chosen = order[:most]
        if first_by == "size":
            _, first = np.unique(table.size[rows][order], return_index=True)
            chosen = order[first]
        listed = [
            Candidate(
                exact[which[k]],
                int(table.size[rows[k]]),
                int(table.total[rows[k]]),
                name,
                roles,
                table.read_row(int(rows[k])),
                ratios[which[k]],
            )
            for k in chosen
        ]
        return listed, int(np.count_nonzero(rank == rank.min()))

    # Everything within rounding of the last place is ranked exactly, so that the cut is exact.
    most = min(count, possible)
    limit = np.partition(errors, most - 1)[most - 1]
    nearest_trains.best, nearest_trains.ties = list_candidates(
        np.flatnonzero(errors <= limit + ERROR_TOLERANCE), "error", most
    )
    order, starts, sizes = table.by_size
    # Smallest error of each size; everything within rounding of it is ranked exactly.
    least = np.minimum.reduceat(errors[order], starts)
    close = errors[order] <= np.repeat(least, np.diff([*starts, size])) + ERROR_TOLERANCE
    listed, _ = list_candidates(order[close & np.isfinite(errors[order])], "size", len(sizes))
    nearest_trains.by_size = {candidate.size: candidate for candidate in listed}
    return nearest_trains


class TrainValue(NamedTuple):
    """The train value of a planet set: its carrier, its two other members, and ω_one/ω_other relative to it as n/d."""

    one: str
    other: str
    carrier: str
    form: RatioForm


@cache
def compute_train_value(name: str, planets: tuple[str, ...]) -> TrainValue:
    """Compute the train value of a planet set with two members besides its carrier."""
    arrangement = ARRANGEMENTS[name]
    lines = build_set_rows(arrangement, planets)
    carrier = arrangement.carriers[planets[0]]
    bodies = dict.fromkeys(body for line in lines for body in line)
    one, other = (body for body in bodies if body not in (*planets, carrier))
    return TrainValue(one, other, carrier, derive_ratio_form(lines, one, other, carrier))


class TrainValues:
    """The train values n/d of a set's rows in rising order; equal ones are adjacent, those of fewest teeth first.

    ``rows`` is the order, ``over``, ``under`` and ``value`` are n, d and n/d in it, and ``starts`` the start of each
    distinct value.
    """

    def __init__(self, table: SetTable, form: RatioForm) -> None:
        size = len(table.size)
        whole = [evaluate_polynomial(part, table.values, size).astype(np.int64) for part in form]
        # A positive denominator makes equal values equal pairs.
        common = np.gcd(*whole) * np.where(whole[1] < 0, -1, 1)
        over, under = (part // common for part in whole)
        value = over / under
        self.rows = np.lexsort((table.total, table.size, value))
        self.over, self.under = (part[self.rows].astype(np.float64) for part in (over, under))
        self.value = value[self.rows]
        self.size = table.size[self.rows]
        self.starts = np.flatnonzero(np.concatenate(([True], np.diff(self.value) != 0.0)))

    def read_values(self, at: Integers) -> tuple[Real, Real]:
        """Return n and d at places of the order."""
        return self.over[at], self.under[at]

    def list_rows(self, start: int) -> Integers:
        """Return the rows with the value that begins at a place."""
        after = np.searchsorted(self.starts, start, side="right")
        end = self.starts[after] if after < len(self.starts) else len(self.rows)
        return self.rows[start:end]


@dataclass(frozen=True)
class Coupling:
    """The ratio as a function of two sets' train values; coefficients of d₁d₂, n₁d₂, d₁n₂, n₁n₂ for x = n/d."""

    over: tuple[int, int, int, int]
    under: tuple[int, int, int, int]

    @classmethod
    def from_arrangement(cls, arrangement: Arrangement, roles: Roles) -> Coupling | None:
        """Derive the coupling of an arrangement of two sets; None if the ratio does not depend on one of them."""
        rows = []
        for k, planets in enumerate(arrangement.planet_sets):
            value = compute_train_value(arrangement.name, planets)
            # ω_one/ω_other relative to the carrier is n/d: d (ω_one − ω_c) = n (ω_other − ω_c).
            rows.append(build_mesh_row(value.one, value.other, value.carrier, (f"d{k}", f"n{k}"), 1))
        form = derive_ratio_form(rows, *roles)
        if not (form.over and form.under) or not any(len(term) == 2 for term in (*form.over, *form.under)):
            return None
        coupling = cls(_read_coefficients(form.over), _read_coefficients(form.under))
        return coupling if coupling.depends_on_second and coupling.swap_sets().depends_on_second else None

    @property
    def depends_on_second(self) -> bool:
        """True if the ratio (a + b x₁ + (c + d x₁) x₂)/(e + f x₁ + (g + h x₁) x₂) changes with x₂.

        It does not if (a + b x₁)(g + h x₁) = (c + d x₁)(e + f x₁) for all x₁: then the factor with x₂ cancels.
        """
        (a, b, c, d), (e, f, g, h) = self.over, self.under
        return (a * g, a * h + b * g, b * h) != (c * e, c * f + d * e, d * f)

    def compute_quotient(self, one: tuple[Real, Real], other: tuple[Real, Real]) -> tuple[Real, Real]:
        """Return numerator and denominator of the ratio for train values n/d of both sets."""
        products = (one[1] * other[1], one[0] * other[1], one[1] * other[0], one[0] * other[0])
        over, under = (sum(c * p for c, p in zip(side, products, strict=True)) for side in (self.over, self.under))
        return np.asarray(over, np.float64), np.asarray(under, np.float64)

    def solve_partner(self, one: tuple[Real, Real], target: float) -> Real:
        """Return the x₂ that would give the target with each x₁."""
        a, b, c, d = (o - target * u for o, u in zip(self.over, self.under, strict=True))
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.nan_to_num(-(a * one[1] + b * one[0]) / (c * one[1] + d * one[0]))

    def swap_sets(self) -> Coupling:
        """Return the same coupling with the sets in the other order."""

        def swap_terms(side: tuple[int, int, int, int]) -> tuple[int, int, int, int]:
            return side[0], side[2], side[1], side[3]

        return Coupling(swap_terms(self.over), swap_terms(self.under))


def _read_coefficients(polynomial: Polynomial) -> tuple[int, int, int, int]:
    terms = [("d0", "d1"), ("d1", "n0"), ("d0", "n1"), ("n0", "n1")]
    if not polynomial.keys() <= set(terms):
        raise ValueError(f"expected one train value from each set in every term, got {sorted(polynomial)}")
    first, second, third, fourth = (polynomial.get(term, 0) for term in terms)
    return first, second, third, fourth


class _TwoSetSearch:
    """The search over pairs of rows of two coupled sets."""

    def __init__(
        self, name: str, tables: Sequence[SetTable], roles: Roles, coupling: Coupling, target: Fraction
    ) -> None:
        self._name, self._tables, self._roles = name, tables, roles
        self._coupling, self._target = coupling, target
        self._sides = [table.train_values for table in tables]

    def find_nearest(self, count: int) -> NearestTrains:
        """Find the best trains and the best of each size."""
        nearest_trains = NearestTrains()
        pairs, errors = self._list_near_pairs(count)
        if not len(errors):
            return nearest_trains
        limit = np.partition(errors, min(count, len(errors)) - 1)[min(count, len(errors)) - 1]
        kept = pairs[:, errors <= limit + ERROR_TOLERANCE]
        one, other = (side.read_values(at) for side, at in zip(self._sides, kept, strict=True))
        ratios, exact, which = _compute_exact_errors(*self._coupling.compute_quotient(one, other), self._target)
        ranked = sorted(
            (exact[w], *self._find_smallest(a, b), a, b, w)
            for a, b, w in zip(kept[0].tolist(), kept[1].tolist(), which.tolist(), strict=True)
        )
        # Each pair of values gives at least one train, and none better than the pair's own minimum size and teeth.
        nearest_trains.best = sorted(
            candidate
            for error, _, _, a, b, w in ranked[:count]
            for candidate in self._list_members(a, b, error, ratios[w], count)
        )[:count]
        nearest_trains.ties = sum(
            len(self._sides[0].list_rows(a)) * len(self._sides[1].list_rows(b))
            for error, _, _, a, b, _ in ranked
            if error == ranked[0][0]
        )
        for size in np.unique(np.concatenate([table.size for table in self._tables])).tolist():
            best = [c for swap in (False, True) if (c := self._find_best_of_size(size, swap)) is not None]
            if best:
                nearest_trains.by_size[size] = min(best)
        return nearest_trains

    def _list_near_pairs(self, count: int) -> tuple[Integers, Real]:
        """Return pairs of distinct train values that include the ``count`` best, and their errors."""
        one, other = self._sides
        firsts, values = one.starts, other.value[other.starts]
        at = np.searchsorted(values, self._coupling.solve_partner(one.read_values(firsts), float(self._target)))
        # Take one more on each side, because rounding may put a neighbour on the wrong side.
        width = count + 1
        steps = range(-width, width) if 2 * width <= len(values) else range(len(values))
        # The projective line is closed: neighbours beyond one end continue at the other.
        chosen = np.concatenate([(at + step) % len(values) for step in steps])
        pairs = np.stack([np.tile(firsts, len(steps)), other.starts[chosen]])
        errors = _compute_errors(
            *self._coupling.compute_quotient(one.read_values(pairs[0]), other.read_values(pairs[1])), self._target
        )
        kept = np.isfinite(errors)
        return pairs[:, kept], errors[kept]

    def _find_smallest(self, a: int, b: int) -> tuple[int, int]:
        """Return size and teeth of the smallest train with a pair of train values."""
        rows = [side.list_rows(at) for side, at in zip(self._sides, (a, b), strict=True)]
        size = max(int(table.size[row[0]]) for table, row in zip(self._tables, rows, strict=True))
        total = 0
        for table, row in zip(self._tables, rows, strict=True):
            total += int(table.total[row[table.size[row] <= size]].min())
        return size, total

    def _list_members(self, a: int, b: int, error: Fraction, ratio: Fraction, count: int) -> list[Candidate]:
        """List the smallest trains with a pair of train values."""
        rows = [side.list_rows(at).tolist() for side, at in zip(self._sides, (a, b), strict=True)]
        candidates = [self._build_candidate(one, other, error, ratio) for one, other in itertools.product(*rows)]
        return sorted(candidates)[:count]

    def _build_candidate(self, one: int, other: int, error: Fraction, ratio: Fraction) -> Candidate:
        first, second = self._tables
        return Candidate(
            error,
            int(max(first.size[one], second.size[other])),
            int(first.total[one] + second.total[other]),
            self._name,
            self._roles,
            (*first.read_row(one), *second.read_row(other)),
            ratio,
        )

    def _find_best_of_size(self, size: int, swap: bool) -> Candidate | None:
        """Find the train of minimum error with this size in one set and at most this size in the other."""
        first, second = reversed(self._sides) if swap else self._sides
        coupling = self._coupling.swap_sets() if swap else self._coupling
        large, small = np.flatnonzero(first.size == size), np.flatnonzero(second.size <= size)
        if not len(large) or not len(small):
            return None
        values, count = second.value[small], len(small)
        at = np.searchsorted(values, coupling.solve_partner(first.read_values(large), float(self._target)))
        # Both neighbours, and one more on each side for rounding; of equal values the first has the fewest teeth.
        near = [np.searchsorted(values, values[(at + step) % count]) for step in (-2, -1, 0, 1)]
        pairs = np.stack([np.tile(large, len(near)), small[np.concatenate(near)]])
        over, under = coupling.compute_quotient(first.read_values(pairs[0]), second.read_values(pairs[1]))
        errors = _compute_errors(over, under, self._target)
        if not np.isfinite(errors).any():
            return None
        kept = np.flatnonzero(errors <= errors.min() + ERROR_TOLERANCE)
        ratios, exact, which = _compute_exact_errors(over[kept], under[kept], self._target)
        best: Candidate | None = None
        for k, w in zip(kept.tolist(), which.tolist(), strict=True):
            rows = [int(first.rows[pairs[0, k]]), int(second.rows[pairs[1, k]])]
            one, other = rows[::-1] if swap else rows
            candidate = self._build_candidate(one, other, exact[w], ratios[w])
            best = candidate if best is None or candidate < best else best
        return best
