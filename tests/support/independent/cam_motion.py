"""The motion of a cam's follower, once around, in smooth pieces: by the laws of textbooks, or by the design's table.

Laws are those of the textbooks (:mod:`~tests.support.independent.cam_laws`); a polynomial is solved for in rational
numbers. A motion that was optimized has no law. Its jerk is constant, or goes evenly, between two angles of its table,
which has all angles where it bends: it follows from the jerk at the first and from what the acceleration gains. A jerk
that is continuous has bends of a millionth too, which the table leaves out, ten of them in a step: it is the parabola
through its values at both angles over which the acceleration gains what it does.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from kinematics.arrays import Real
from tests.support.independent.cam_laws import law

POINTS = 41
"""Angles of each piece, its ends among them."""

STEADY = 1e-4
"""Share of the greatest jerk by which its next value may differ from what the acceleration gains, and be the same."""

SHORTEST = 1e-5
"""Radians of a step of the table over which what the acceleration gains is known to enough digits."""

PIECES = 240
"""Pieces of a move by a law; where a law's parts meet, at sixteenths of its angle, two of them meet."""

SLOPE = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0
BEND = np.array([35.0, -104.0, 114.0, -56.0, 11.0]) / 12.0
"""First and second derivative at the first of five points a step of one apart (Abramowitz & Stegun, table 25.2)."""


class Move(NamedTuple):
    """A segment of the program in pieces, shapes (pieces, points); displacements are lengths, or radians of an arm.

    ``weight`` is what a mean over a piece counts, radians.
    """

    start: float
    angle: float
    at: Real
    s: Real
    v: Real
    a: Real
    j: Real

    def rates(self, order: int) -> Real:
        """s, v, a or j."""
        return (self.s, self.v, self.a, self.j)[order]


def by_law(name: str, start: float, angle: float, low: float, high: float) -> Move:
    """A move by a law, from one displacement to another."""
    u, part = _shares(np.linspace(0.0, 1.0, PIECES + 1))
    s, v, a, j = law(name, u, part)
    h = high - low
    return Move(start, angle, start + angle * u, low + h * s, h * v / angle, h * a / angle**2, h * j / angle**3)


def _shares(ends: Real) -> tuple[Real, Real]:
    """Places of pieces between some shares of an angle, and one place within each."""
    u = ends[:-1, None] + np.diff(ends)[:, None] * np.linspace(0.0, 1.0, POINTS)
    u[:, -1] = ends[1:]
    return u, np.broadcast_to(u[:, [POINTS // 2]], u.shape)


CLOSE = 1e-7
"""Share of an angle below which a turn is at the end of a piece."""

Condition = tuple[float, int, float]
"""Share of the angle, order, and value of the derivative by the radian."""


def by_polynomial(start: float, angle: float, conditions: Sequence[Condition]) -> Move:
    """The polynomial of least degree through conditions."""
    n = len(conditions)
    rows, right = [], []
    for share, order, value in conditions:
        at = Fraction(share)
        rows.append([math.perm(k, order) * at ** (k - order) if k >= order else Fraction(0) for k in range(n)])
        right.append(Fraction(value) * Fraction(angle) ** order)
    curve = np.polynomial.Polynomial([float(x) for x in _solved(rows, right)])
    turns = [float(x.real) for x in curve.deriv().roots() if abs(x.imag) < 1e-9 and 0.0 < x.real < 1.0]
    ends = np.linspace(0.0, 1.0, PIECES + 1)
    u, _ = _shares(np.sort([*ends, *(x for x in turns if np.abs(ends - x).min() > CLOSE)]))
    rates = [curve(u), *(curve.deriv(k)(u) / angle**k for k in (1, 2, 3))]
    return Move(start, angle, start + angle * u, *rates)


def _solved(rows: list[list[Fraction]], right: list[Fraction]) -> list[Fraction]:
    """Linear equations in rational numbers, by elimination."""
    table = [[*row, value] for row, value in zip(rows, right, strict=True)]
    for k in range(len(table)):
        pivot = next(n for n in range(k, len(table)) if table[n][k])
        table[k], table[pivot] = table[pivot], table[k]
        table[k] = [x / table[k][k] for x in table[k]]
        for n, row in enumerate(table):
            if n != k and row[k]:
                table[n] = [x - row[k] * y for x, y in zip(row, table[k], strict=True)]
    return [row[-1] for row in table]


def at_rest(start: float, angle: float, height: float) -> Move:
    """A dwell."""
    at = start + angle * np.linspace(0.0, 1.0, POINTS)[None]
    return Move(start, angle, at, np.full_like(at, height), *(np.zeros_like(at) for _ in range(3)))


def by_table(program: Any, start: float, angle: float, unit: float, steady: bool = False) -> Move:
    """A move by the table of the design; ``unit`` makes the table's displacements lengths or radians.

    ``steady``: the jerk is continuous, but for steps that the statement gives it.
    """
    table = np.radians(np.append(program.angle, program.angle[0] + 360.0))
    first, last = (int(np.abs(table - end).argmin()) for end in (start, start + angle))
    rows = np.arange(first, last)
    s, v, a, j = (np.array(getattr(program, name))[rows][:, None] for name in "svaj")
    wide = np.diff(table)[rows][:, None]
    after = np.append(program.a, program.a[0])[rows + 1][:, None]
    # Over a step of no length the quotient would be rounding.
    gained = np.where(wide > SHORTEST, 2.0 * (after - a) / wide - 2.0 * j, 0.0)
    arched = np.zeros_like(gained)
    if steady:
        following = np.append(program.j, program.j[0])[rows + 1][:, None]
        even = np.abs(j + gained - following) < STEADY * np.abs(j).max()
        # The mean of u (1 − u) is a sixth.
        arched = np.where(even & (wide > SHORTEST), 3.0 * (j + gained - following), arched)
        gained = np.where(even, following - j, gained)
    u = np.linspace(0.0, 1.0, POINTS)[None]
    t = wide * u
    place = unit * s + t * (v + t * (a / 2.0 + t * (j / 6.0 + u * (gained / 24.0 + arched * (1.0 / 24.0 - u / 60.0)))))
    rate = v + t * (a + t * (j / 2.0 + u * (gained / 6.0 + arched * (1.0 / 6.0 - u / 12.0))))
    bend = a + t * (j + u * (0.5 * gained + arched * (0.5 - u / 3.0)))
    return Move(start, angle, table[rows][:, None] + t, place, rate, bend, j + u * (gained + arched * (1.0 - u)))


def turned(move: Move) -> Move:
    """A move whose pieces are divided where the velocity changes its sign."""
    v = move.v
    size = np.abs(v).max()
    crossed = np.flatnonzero((v.min(axis=1) < -RESTING * size) & (v.max(axis=1) > RESTING * size))
    if not len(crossed):
        return move
    columns: list[list[Real]] = [[] for _ in range(5)]
    for row in range(len(v)):
        at = move.at[row]
        ends = [at[0], at[-1]]
        if row in crossed:
            k = int(np.flatnonzero(v[row, :-1] * v[row, 1:] <= 0.0)[0])
            low, high = at[k], at[k + 1]
            for _ in range(BISECTIONS):
                middle = 0.5 * (low + high)
                rising = motion_at([move], np.array([middle]), row)[1][0] * v[row, k] > 0.0
                low, high = (middle, high) if rising else (low, middle)
            ends.insert(1, low)
        for first, last in itertools.pairwise(ends):
            places = np.linspace(first, last, POINTS)
            found = motion_at([move], places, row) if len(ends) > 2 else [x[row] for x in move[3:]]
            for column, values in zip(columns, [places, *found], strict=True):
                column.append(np.asarray(values))
    return Move(move.start, move.angle, *(np.array(column) for column in columns))


RESTING = 1e-12
"""Share of the greatest velocity that is rounding."""

BISECTIONS = 50


def motion_at(moves: list[Move], angles: Real, row: int | None = None) -> list[Real]:
    """s, v, a, j at angles, after a step where there is one: by the polynomial through six neighbouring points.

    ``row`` is the piece of the only move that all angles lie in, if it is known.
    """
    columns = [np.concatenate([getattr(move, name) for move in moves]) for name in ("at", "s", "v", "a", "j")]
    at = columns[0]
    wide = at[:, -1] - at[:, 0]
    if row is None:
        rows = np.clip(np.searchsorted(at[:, 0], angles + SAME, side="right") - 1, 0, len(at) - 1)
    else:
        rows = np.full(len(angles), row)
    u = np.where(wide[rows] > 0.0, (angles - at[rows, 0]) / np.where(wide[rows] > 0.0, wide[rows], 1.0), 0.0)
    first = np.clip(np.floor(u * (POINTS - 1)).astype(int) - 2, 0, POINTS - 6)
    x = u * (POINTS - 1) - first
    weights = []
    for k in range(6):
        others = [n for n in range(6) if n != k]
        weights.append(np.prod([(x - n) / (k - n) for n in others], axis=0))
    return [
        np.asarray(sum(weight * values[rows, first + k] for k, weight in enumerate(weights))) for values in columns[1:]
    ]


SAME = 1e-10
"""Radians within which two angles are one."""


def greatest(values: Real) -> float:
    """The greatest of pieces, between their points by parabolas; −∞ where nothing counts.

    A piece that is greatest at a point within has the top of the parabola through it and its neighbours. One that is
    greatest at an end but rises from there has its top by the slope and the bend that the curve through five points
    has at the end.
    """
    rows = np.arange(len(values))
    k = np.clip(values.argmax(axis=1), 1, values.shape[1] - 2)
    before, at, after = values[rows, k - 1], values[rows, k], values[rows, k + 1]
    ends = np.concatenate([values[:, :5], values[:, :-6:-1]])
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        bend = before - 2.0 * at + after
        top = at - 0.125 * (after - before) ** 2 / bend
        slope_there, bend_there = ends @ SLOPE, ends @ BEND
        top_there = ends[:, 0] - 0.5 * slope_there**2 / bend_there
        beside = (bend_there < 0.0) & (slope_there > 0.0) & (slope_there <= -bend_there) & np.isfinite(top_there)
    peaked = (at >= before) & (at >= after) & (bend < 0.0) & np.isfinite(top)
    tops = np.append(np.where(peaked, top, -np.inf), np.where(beside, top_there, -np.inf))
    return float(max(values.max(), tops.max()))


def least(values: Real) -> float:
    """The least of pieces."""
    return -greatest(-values)


def mean(moves: list[Move], values: list[Real]) -> float:
    """The mean over the turn of values on all pieces: Boole's rule on each."""
    weights = np.full(POINTS, 1.0) * np.array([14.0, 32.0, 12.0, 32.0] * (POINTS // 4) + [14.0])
    weights[[0, -1]] = 7.0
    total = 0.0
    for move, of in zip(moves, values, strict=True):
        step = (move.at[:, -1] - move.at[:, 0]) / (POINTS - 1)
        total += float((step * (of @ weights)).sum()) * 2.0 / 45.0
    return total / math.tau
