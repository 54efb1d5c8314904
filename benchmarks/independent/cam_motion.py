"""The motion of a cam's follower, once around, in smooth pieces: by the laws of textbooks, or by the design's table.

Laws are those of Norton, §8.3, written out. A motion that was optimized has no law. Its jerk is constant, or goes
evenly, between two angles of its table, which has all angles where it bends: it follows from the jerk at the first and
from what the acceleration gains.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]

POINTS = 41
"""Angles of each piece, its ends among them."""

SHORTEST = 1e-5
"""Radians of a step of the table over which what the acceleration gains is known to enough digits."""

PIECES = 200
"""Pieces of a move by a law."""

SLOPE = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0
BEND = np.array([35.0, -104.0, 114.0, -56.0, 11.0]) / 12.0
"""First and second derivative at the first of five points a step of one apart (Abramowitz & Stegun, table 25.2)."""


def law(name: str, u: Real) -> tuple[Real, Real, Real, Real]:
    """s, s′, s″, s‴ of unit lift over unit angle (Norton, §8.3)."""
    if name == "cycloidal":
        turn = math.tau * u
        return u - np.sin(turn) / math.tau, 1.0 - np.cos(turn), math.tau * np.sin(turn), math.tau**2 * np.cos(turn)
    if name == "modified_sine":
        k, fast, slow = math.pi / (4.0 + math.pi), 4.0 * math.pi * u, (4.0 * u + 1.0) * math.pi / 3.0
        middle, last = (u >= 0.125) & (u <= 0.875), u > 0.875
        s = np.where(middle, 2.0 / math.pi + u - 2.25 / math.pi * np.sin(slow), u - np.sin(fast) / (4.0 * math.pi))
        s = np.where(last, s + 4.0 / math.pi, s)
        v = np.where(middle, 1.0 - 3.0 * np.cos(slow), 1.0 - np.cos(fast))
        a = 4.0 * math.pi * k * np.where(middle, np.sin(slow), np.sin(fast))
        return k * s, k * v, a, 16.0 * math.pi**2 * k * np.where(middle, np.cos(slow) / 3.0, np.cos(fast))
    curve = np.polynomial.Polynomial(POLYNOMIALS[name])
    return curve(u), curve.deriv()(u), curve.deriv(2)(u), curve.deriv(3)(u)


POLYNOMIALS = {"polynomial_345": (0, 0, 0, 10, -15, 6), "polynomial_4567": (0, 0, 0, 0, 35, -84, 70, -20)}
LAWS = ("cycloidal", "modified_sine", *POLYNOMIALS)


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
    u = np.linspace(0.0, 1.0, PIECES + 1)
    u = u[:-1, None] + np.diff(u)[:, None] * np.linspace(0.0, 1.0, POINTS)
    s, v, a, j = law(name, u)
    h = high - low
    return Move(start, angle, start + angle * u, low + h * s, h * v / angle, h * a / angle**2, h * j / angle**3)


def at_rest(start: float, angle: float, height: float) -> Move:
    """A dwell."""
    at = start + angle * np.linspace(0.0, 1.0, POINTS)[None]
    return Move(start, angle, at, np.full_like(at, height), *(np.zeros_like(at) for _ in range(3)))


def by_table(program: Any, start: float, angle: float, unit: float) -> Move:
    """A move by the table of the design; ``unit`` makes the table's displacements lengths or radians."""
    table = np.radians(np.append(program.angle, program.angle[0] + 360.0))
    first, last = (int(np.abs(table - end).argmin()) for end in (start, start + angle))
    rows = np.arange(first, last)
    s, v, a, j = (np.array(getattr(program, name))[rows][:, None] for name in "svaj")
    wide = np.diff(table)[rows][:, None]
    after = np.append(program.a, program.a[0])[rows + 1][:, None]
    # Over a step of no length the quotient would be rounding.
    gained = np.where(wide > SHORTEST, 2.0 * (after - a) / wide - 2.0 * j, 0.0)
    u = np.linspace(0.0, 1.0, POINTS)[None]
    t = wide * u
    place = unit * s + t * (v + t * (a / 2.0 + t * (j / 6.0 + u * gained / 24.0)))
    rate = v + t * (a + t * (j / 2.0 + u * gained / 6.0))
    return Move(start, angle, table[rows][:, None] + t, place, rate, a + t * (j + 0.5 * u * gained), j + u * gained)


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
