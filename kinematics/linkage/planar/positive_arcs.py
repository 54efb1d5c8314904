"""Positive arcs of smooth functions of one variable: all their zeros, including close pairs.

Each function has a domain, a circle or a segment, and is evaluated with its rate. Samples are refined until the
function between neighbours agrees with the cubic through their values and rates, up to a small part of its change. Then
no cell hides more than the cubic shows: a zero where the sign changes, an extreme where the rate points towards zero.
Such an extreme is found as a root of the rate, and decides whether the function has two zeros there, none, or touches
zero. Many functions are treated at once, as rows, because one evaluation costs hardly less than a hundred of them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers, Real
from kinematics.linkage.planar.roots import find_roots

CELL_ERROR = 0.01
"""Maximum deviation from the cubic, as a share of the function's change in a cell or of its distance from zero."""

MIN_CELL_WIDTH = 1e-7
"""Minimum width of a cell, as a share of the domain: next to a fold the input changes only by the square of it."""

FIRST_SAMPLE = 0.37
"""Position of the first sample in its cell, away from the ends: functions are often even about these, and their rates
may be infinite there."""

END_OFFSET = 1e-6
"""Distance of the outermost samples from the ends of a segment, as a share of it: the function may not exist there."""

TOUCH_TOLERANCE = 1e-12
"""Share of the function's maximum below which an extreme touches zero: a change point, to rounding."""

ZERO_TOLERANCE = 1e-13
"""Value below which a function is zero everywhere if all of its first samples are that small. Close to the ends, where
roots of small differences are taken, rounding may be larger."""

NOISE_LEVEL = 1e-12
"""Share of a function's maximum below which a cell is not divided: its shape is rounding."""

MAX_CROWDING = 4
"""Multiple of the initial number of cells that, when pending at once, marks a function as rounding noise and stops its
refinement: a function that is smooth except in a few places has only a few such cells at a time."""

Function = Callable[[Integers, Real], tuple[Real, Real]]
"""Value and rate of the functions ``rows`` at the places given, shape (n,) each; a rate may be NaN."""


class Domain(NamedTuple):
    """A segment, or a circle of that length, and its initial number of cells."""

    low: float
    high: float
    closed: bool
    cells: int


class Arc(NamedTuple):
    """An arc on which a function is positive, from ``low`` to ``high``, which on a circle may exceed its end.

    ``at_low`` and ``at_high`` name the kind of end: a ``zero`` where the sign changes, a place where the function only
    ``touches`` zero, or the ``end`` of the domain; ``whole`` for a circle without ends.
    """

    low: float
    high: float
    at_low: Literal["zero", "touches", "end", "whole"]
    at_high: Literal["zero", "touches", "end", "whole"]


class Samples(NamedTuple):
    """Rows, places, values and rates, sorted by row and place; on a circle the first sample is repeated at the end."""

    row: Integers
    at: Real
    value: Real
    rate: Real

    def merge(self, *others: Samples) -> Samples:
        """Merge these samples with others, sorted."""
        every = [self, *others]
        row, at = np.concatenate([s.row for s in every]), np.concatenate([s.at for s in every])
        value, rate = np.concatenate([s.value for s in every]), np.concatenate([s.rate for s in every])
        order = np.lexsort((at, row))
        return Samples(row[order], at[order], value[order], rate[order])

    def part(self, index: NDArray[np.bool_] | Integers) -> Samples:
        """Select some samples."""
        return Samples(self.row[index], self.at[index], self.value[index], self.rate[index])

    def cells(self) -> tuple[Samples, Samples]:
        """Return the left and right ends of the cells."""
        left = np.flatnonzero(self.row[:-1] == self.row[1:])
        return self.part(left), self.part(left + 1)


def find_positive_arcs(function: Function, domains: Sequence[Domain]) -> list[list[Arc]]:
    """Find the arcs on which each of the functions is positive, by rows, ascending."""
    if not domains:
        return []
    samples, vanishes = _resolve_samples(function, domains)
    samples = samples.merge(_find_extremes(function, samples))
    scale = np.full(len(domains), 0.0)
    np.maximum.at(scale, samples.row, samples.value)
    starts = np.searchsorted(samples.row, np.arange(len(domains) + 1))
    pending: list[tuple[int, list[_Boundary], bool]] = []
    changes: list[tuple[int, float, float, float, float]] = []
    for row, domain in enumerate(domains):
        at, value = (column[starts[row] : starts[row + 1]] for column in (samples.at, samples.value))
        sure = np.flatnonzero(np.abs(value) > TOUCH_TOLERANCE * scale[row])
        if vanishes[row] or not len(sure):
            pending.append((row, [], False))
            continue
        if domain.closed:  # start from a sample that is certainly not zero
            turn = int(sure[0])
            at = np.concatenate([at[turn:], at[1 : turn + 1] + (domain.high - domain.low)])
            value = np.concatenate([value[turn:], value[1 : turn + 1]])
            sure = np.flatnonzero(np.abs(value) > TOUCH_TOLERANCE * scale[row])
        boundaries: list[_Boundary] = []
        positive = value[sure] > 0.0
        for n in np.flatnonzero((positive[:-1] != positive[1:]) | (positive[:-1] & (np.diff(sure) > 1))):
            one, other = sure[n], sure[n + 1]
            # Positive on both sides of a near-zero sample: the function touches zero.
            if positive[n] == positive[n + 1]:
                least = one + 1 + int(np.argmin(np.abs(value[one + 1 : other])))
                boundaries.append(_Boundary(float(at[least]), None, None))
            else:
                boundaries.append(_Boundary(np.nan, len(changes), bool(positive[n + 1])))
                changes.append((row, float(at[one]), float(at[other]), float(value[one]), float(value[other])))
        pending.append((row, boundaries, bool(positive[0])))
    zeros = _find_zeros(function, changes)
    return [
        _collect_arcs(
            domains[row],
            [b if b.change is None else b._replace(at=zeros[b.change]) for b in boundaries],
            positive_first,
        )
        for row, boundaries, positive_first in pending
    ]


class _Boundary(NamedTuple):
    """An end of arcs: its place, the number of its sign change (None if the function only touches zero), and whether
    the sign rises."""

    at: float
    change: int | None
    rises: bool | None


def _resolve_samples(function: Function, domains: Sequence[Domain]) -> tuple[Samples, NDArray[np.bool_]]:
    """Resolve functions into samples between which they agree with cubics; also mark functions that vanish."""
    places = []
    for domain in domains:
        cell = (domain.high - domain.low) / domain.cells
        if domain.closed:
            places.append(domain.low + cell * (np.arange(domain.cells) + FIRST_SAMPLE))
        else:
            inner = domain.low + cell * (np.arange(domain.cells - 1) + 1.0 + FIRST_SAMPLE / 2.0)
            hair = END_OFFSET * (domain.high - domain.low)
            places.append(np.concatenate([[domain.low + hair], inner, [domain.high - hair]]))
    row = np.repeat(np.arange(len(domains)), [len(p) for p in places])
    at = np.concatenate(places)
    samples = Samples(row, at, *_evaluate_known(function, row, at))
    changes = np.diff(row) != 0
    inner = ~(np.append(True, changes) | np.append(changes, True)) | np.array([d.closed for d in domains])[row]
    largest = np.zeros(len(domains))
    np.maximum.at(largest, row[inner], np.abs(samples.value[inner]))
    closing = np.array([n for n, domain in enumerate(domains) if domain.closed], np.int64)
    begins = np.searchsorted(row, closing)
    length = np.array([domain.high - domain.low for domain in domains])
    again = Samples(closing, at[begins] + length[closing], samples.value[begins], samples.rate[begins])
    samples = samples.merge(again)
    first = np.array([domain.cells for domain in domains])
    narrow = MIN_CELL_WIDTH * length
    noise = np.full(len(domains), ZERO_TOLERANCE)
    np.maximum.at(noise, samples.row, NOISE_LEVEL * np.abs(samples.value))
    noise[largest <= ZERO_TOLERANCE] = np.inf
    left, right = samples.cells()
    rounds = [samples]
    while len(left.row):
        width = right.at - left.at
        at = left.at + 0.5 * width
        middle = Samples(left.row, at, *_evaluate_known(function, left.row, at))
        rounds.append(middle)
        # Deviation of the midpoint's value and rate from those of the Hermite cubic.
        off = np.abs(middle.value - 0.5 * (left.value + right.value) - width * (left.rate - right.rate) / 8.0)
        slope = 1.5 * (right.value - left.value) - 0.25 * width * (left.rate + right.rate)
        off = np.maximum(off, 0.25 * np.abs(width * middle.rate - slope))
        values = np.abs([left.value, middle.value, right.value])
        change = np.maximum(np.abs(middle.value - left.value), np.abs(middle.value - right.value))
        change = np.maximum(change, width * np.abs([left.rate, middle.rate, right.rate]).max(axis=0))
        same = (left.value > 0.0) == (right.value > 0.0)
        # Far from zero a larger deviation is harmless, since no zero can hide there.
        allowed = np.maximum(change, np.where(same, values.min(axis=0), 0.0))
        rough = ~(off <= CELL_ERROR * allowed) & (width > narrow[left.row]) & (values.max(axis=0) > noise[left.row])
        crowded = np.bincount(left.row[rough], minlength=len(domains)) > MAX_CROWDING * first
        rough &= ~crowded[left.row]
        half = [samples.part(rough) for samples in (left, middle, right)]
        left, right = half[0].merge(half[1]), half[1].merge(half[2])
    return rounds[0].merge(*rounds[1:]), largest <= ZERO_TOLERANCE


def _evaluate_known(function: Function, row: Integers, at: Real) -> tuple[Real, Real]:
    """Evaluate value and rate; an unknown value becomes zero."""
    value, rate = function(row, at)
    return np.nan_to_num(value, nan=0.0), rate


def _find_extremes(function: Function, samples: Samples) -> Samples:
    """Find minima above zero and maxima below it, between samples, that may come close to zero."""
    left, right = samples.cells()
    width, side = right.at - left.at, np.sign(left.value)
    falls, rises = side * left.rate, side * right.rate
    with np.errstate(divide="ignore", invalid="ignore"):
        # Where the tangents at both ends meet: lower than the function, which is convex around a minimum.
        meet = left.value + left.rate * (right.value - left.value - right.rate * width) / (left.rate - right.rate)
        low = ~(side * meet > 0.5 * np.minimum(np.abs(left.value), np.abs(right.value)))
    # The function falls towards zero at the left end and recedes from it at the right one.
    turns = (side == np.sign(right.value)) & (falls <= 0.0) & (rises >= 0.0) & (falls < rises) & low
    row = left.row[turns]
    if not len(row):
        return Samples(row, np.empty(0), np.empty(0), np.empty(0))

    def evaluate_rate(at: Real) -> Real:
        return np.nan_to_num(function(row, at)[1], nan=0.0)

    at = find_roots(evaluate_rate, left.at[turns], right.at[turns], left.rate[turns], right.rate[turns])[0]
    return Samples(row, at, _evaluate_known(function, row, at)[0], np.zeros(len(row)))


def _find_zeros(function: Function, changes: list[tuple[int, float, float, float, float]]) -> Real:
    """Find sign changes of functions, each between two places, at the last point that is not negative."""
    if not changes:
        return np.empty(0)
    row, low, high, at_low, at_high = (np.array(column) for column in zip(*changes, strict=True))
    return find_roots(lambda at: _evaluate_known(function, row, at)[0], low, high, at_low, at_high)[0]


def _collect_arcs(domain: Domain, boundaries: list[_Boundary], positive_first: bool) -> list[Arc]:
    """Collect the positive arcs between boundaries in their order."""
    if not boundaries:
        kind: Literal["whole", "end"] = "whole" if domain.closed else "end"
        return [Arc(domain.low, domain.high, kind, kind)] if positive_first else []
    arcs = []
    if domain.closed:
        length = domain.high - domain.low
        boundaries = [*boundaries, boundaries[0]._replace(at=boundaries[0].at + length)]
    elif positive_first:
        arcs.append(Arc(domain.low, float(boundaries[0].at), "end", _name_kind(boundaries[0])))
    for n, boundary in enumerate(boundaries):
        if boundary.rises is False or (n + 1 == len(boundaries) and domain.closed):
            continue
        if n + 1 == len(boundaries):
            arcs.append(Arc(float(boundary.at), domain.high, _name_kind(boundary), "end"))
        else:
            after = boundaries[n + 1]
            arcs.append(Arc(float(boundary.at), float(after.at), _name_kind(boundary), _name_kind(after)))
    return arcs


def _name_kind(boundary: _Boundary) -> Literal["zero", "touches"]:
    return "touches" if boundary.change is None else "zero"
