"""Circuits and toggles of mechanisms whose input does not close them by dyads, by elimination from another link.

Nothing of the package is used. What configurations there are does not depend on which link is held and which drives.
From a link that closes all by dyads the configurations come as pieces (:mod:`tests.oracles.elimination`); two pieces
that end where a dyad folds flat, and differ in its assembly only, go over into each other there; so pieces make closed
curves, the circuits. The true input is stationary on a circuit where a determinant of the geometry vanishes: for a link
on three legs where their three lines meet in one point or are parallel,

    | x_i  y_i  x × y_i |,  i = 1, 2, 3,

for a slider-crank where crank and coupler are in line. Its product over all assemblies is rational in e^{iφ} again, so
that all places where it can vanish are roots of polynomials; which of them belong to a piece its sign says.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from tests.oracles.elimination import BRACKET, Elimination, Pair, Piece, Undecided

CLEARING = 3
"""Power of each dyad's d d̄ that clears the determinant of its denominators."""

SPREADS = (1e-3, 1e-5, 1e-7, 1e-9, 1e-11)
"""Distances from a candidate, radians, at which signs are looked at."""

GRID = 4001
"""Places on a piece at which signs are looked at as well."""

UPON = 1e-12
"""Radians within which changes of sign are of one root."""

SAMPLES = 48
"""Places on a part of a circuit between two stops, at first, at which the true input is unwrapped."""

LEAP = 0.5
"""Change of the true input between two of them, radians, above which there must be more."""

Leg = tuple[str, str]


class Between(NamedTuple):
    """What the true input moves through between two toggles: from ``low`` to ``high``; ``full`` where there is none."""

    low: float
    high: float
    full: bool


def three_legs(*legs: Leg) -> Callable[[Mapping[str, Pair]], Complex]:
    """The determinant of three lines, each through two joints."""

    def value(points: Mapping[str, Pair]) -> Complex:
        rows = []
        for one, other in legs:
            (a, a_), (b, b_) = points[one], points[other]
            rows.append((b - a, b_ - a_, a_ * b - a * b_))
        (x1, y1, m1), (x2, y2, m2), (x3, y3, m3) = rows
        return np.asarray(x1 * (y2 * m3 - y3 * m2) - y1 * (x2 * m3 - x3 * m2) + m1 * (x2 * y3 - x3 * y2)) / 4.0

    return value


def in_line(a: str, b: str, c: str) -> Callable[[Mapping[str, Pair]], Complex]:
    """Twice the area of the triangle of three joints."""

    def value(points: Mapping[str, Pair]) -> Complex:
        (a0, a1), (b0, b1), (c0, c1) = points[a], points[b], points[c]
        return np.asarray(((b1 - a1) * (c0 - a0) - (b0 - a0) * (c1 - a1)) / 2j)

    return value


class Turning:
    """One design, described from a link that closes it by dyads.

    Parameters
    ----------
    elimination : Elimination
        The mechanism from that link.
    stationary : callable
        From the joints the determinant that vanishes where the true input stands still.
    true_input : callable
        From the joints, complex, the true input in radians (or, along a slide, as a length of the unit mechanism).
    wraps : bool
        Whether the true input is an angle.
    """

    def __init__(
        self,
        elimination: Elimination,
        stationary: Callable[[Mapping[str, Pair]], Complex],
        true_input: Callable[[Mapping[str, Complex]], Real],
        wraps: bool = True,
    ) -> None:
        self.elimination, self.stationary, self.true_input, self.wraps = elimination, stationary, true_input, wraps
        self.pieces = elimination.pieces()
        near = np.sort(elimination.roots(self._product)) if self.pieces else np.empty(0)
        self.stops = [self._stops(piece, near) for piece in self.pieces]

    def circuits(self) -> list[list[Between]]:
        """Each circuit as what lies between its toggles, along it; the reference's circuit first."""
        partners = self._partners()
        waiting, found = set(range(len(self.pieces))), []
        held = self._reference()
        for first in (held, *range(len(self.pieces))):
            if first not in waiting:
                continue
            walk: list[tuple[int, bool]] = []
            n, rising = first, True
            while not walk or (n, rising) != (first, True):
                walk.append((n, rising))
                if self.pieces[n].full:
                    break
                n, high = partners[n, rising]
                rising = not high
            waiting -= {n for n, _ in walk}
            found.append(self._between(walk))
        return found

    # -- the determinant -----------------------------------------------------------------------------------------------

    def _product(self, theta: Real) -> Real:
        values = np.ones(theta.shape)
        for choice in itertools.product((1, -1), repeat=self.elimination.count):
            _, divisors, points = self.elimination.configurations(theta, choice)
            factor = self.stationary(points)
            for divisor in divisors:
                factor = factor * divisor**CLEARING
            values = values * factor
        return np.asarray(values.real)

    def _known(self, theta: Real, choice: Sequence[int]) -> Real:
        """The determinant of one assembly, NaN where it does not exist."""
        with np.errstate(invalid="ignore"):
            radicands, _, points = self.elimination.configurations(theta, choice)
            values = self.stationary(points).real.copy()
            for radicand in radicands:
                values[~(radicand.real > 0.0)] = np.nan
        return np.asarray(values)

    def _stops(self, piece: Piece, near: Real) -> list[float]:
        """Where on a piece the true input stands still, ascending."""
        turn = 2.0 * np.pi
        shifted = np.concatenate([near, near + turn]) if len(near) else near
        inside = shifted[(shifted > piece.low) & (shifted < piece.high)]
        points = np.concatenate([[piece.low], inside, [piece.high]])
        # Where several roots lie close together the polynomials' are far off; signs on a grid show those near them.
        grid = np.linspace(piece.low, piece.high, GRID)
        points = np.concatenate([0.5 * (points[:-1] + points[1:]), inside, grid])
        for spread in SPREADS:
            points = np.concatenate(
                [points, inside - spread, inside + spread, [piece.low + spread, piece.high - spread]]
            )
        points = np.unique(points[(points >= piece.low) & (points <= piece.high)])
        values = self._known(points, piece.choice)
        points, values = points[np.isfinite(values)], values[np.isfinite(values)]
        if piece.full:
            points, values = np.append(points, points[0] + turn), np.append(values, values[0])
        change = (values[:-1] > 0.0) != (values[1:] > 0.0)
        low, high, start = points[:-1][change], points[1:][change], values[:-1][change] > 0.0
        while len(low) and (high - low).max() > BRACKET:
            middle = 0.5 * (low + high)
            same = (self._known(middle, piece.choice) > 0.0) == start
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        stops = np.sort(0.5 * (low + high))
        # At a root the sign is a matter of rounding: changes upon one another are one, or none where they are even.
        groups = np.split(stops, np.flatnonzero(np.diff(stops) > UPON) + 1)
        return [float(group[0]) for group in groups if len(group) % 2]

    # -- circuits ------------------------------------------------------------------------------------------------------

    def _partners(self) -> dict[tuple[int, bool], tuple[int, bool]]:
        """Piece and end (whether the high one) that each end of a piece goes over into."""
        found: dict[tuple[int, bool], tuple[int, bool]] = {}
        for high in (False, True):
            ends = [
                (n, p.choice, p.high_fold if high else p.low_fold, p.high if high else p.low)
                for n, p in enumerate(self.pieces)
                if not p.full
            ]
            for n, choice, fold, at in ends:
                flipped = tuple(-s if k == fold else s for k, s in enumerate(choice))
                same = [
                    m
                    for m, other, folded, there in ends
                    if other == flipped and folded == fold and abs(np.sin((there - at) / 2.0)) < 1e-9
                ]
                if len(same) != 1:
                    raise Undecided("an end of an assembly without just one other")
                found[n, high] = same[0], high
        return found

    def _reference(self) -> int:
        """The piece that holds the reference."""
        at = float(np.mod(self.elimination.start, 2.0 * np.pi))
        held = []
        for n, piece in enumerate(self.pieces):
            if piece.full or np.mod(at - piece.low, 2.0 * np.pi) < piece.high - piece.low:
                points = self.elimination.configurations(np.array([at]), piece.choice)[2]
                off = max(abs(complex(z[0]) - self.elimination.joints[name]) for name, (z, _) in points.items())
                if off < 1e-6:
                    held.append(n)
        if len(held) != 1:
            raise Undecided("the reference stands on a fold")
        return held[0]

    def _between(self, walk: list[tuple[int, bool]]) -> list[Between]:
        """What lies between the stops of one circuit; the walk is its pieces, each with whether its driver rises."""
        value: list[Real] = []
        stops: list[int] = []
        count = 0
        closed = self.pieces[walk[0][0]].full
        for n, rising in walk:
            piece = self.pieces[n]
            for to_stop, part in self._parts(piece, self.stops[n], rising, closed):
                value.append(part)
                count += len(part)
                if to_stop:
                    stops.append(count - 1)
        along = np.concatenate(value)
        way = np.unwrap(along) if self.wraps else along
        if closed or not self.wraps:
            total = way[-1] - way[0]
        else:
            last = way[-1] + (way[0] - way[-1] + np.pi) % (2.0 * np.pi) - np.pi
            total = last - way[0]
        if len(stops) % 2 or not (stops or abs(total) > 1.0):
            raise Undecided("a stop that rounding hides beside a fold")
        if not stops:
            return [Between(0.0, abs(float(total)), True)]
        places = [float(way[k]) for k in stops]
        places.append(places[0] + float(total) if self.wraps else places[0])
        found = []
        for one, other in itertools.pairwise(places):
            low, high = sorted((one, other))
            base = float(np.mod(low, 2.0 * np.pi)) if self.wraps else low
            found.append(Between(base, base + high - low, False))
        return found

    def _parts(self, piece: Piece, stops: list[float], rising: bool, closed: bool) -> list[tuple[bool, Real]]:
        """The true input along a piece, part by part up to each stop, and whether a stop ends it."""
        half = 0.5 * (piece.high - piece.low)
        middle = piece.low + half
        hair = 0.0 if closed else 1e-7
        ends = np.array([piece.low, *stops, piece.high])
        own = [float(x) for x in (ends if closed else np.arccos(np.clip((middle - ends) / half, -1.0, 1.0)))]
        own[0], own[-1] = own[0] + hair, own[-1] - hair
        parts = []
        spans = list(itertools.pairwise(own))
        for n, (a, b) in enumerate(spans if rising else [(b, a) for a, b in reversed(spans)]):
            count = SAMPLES
            while True:
                v = np.linspace(a, b, count)
                theta = v if closed else middle - half * np.cos(v)
                if n < len(spans) - 1:
                    theta[-1] = stops[n] if rising else stops[-1 - n]
                points = self.elimination.configurations(theta, piece.choice)[2]
                value = self.true_input({name: z for name, (z, _) in points.items()})
                leap = np.abs(np.mod(np.diff(value) + np.pi, 2.0 * np.pi) - np.pi).max()
                if not self.wraps or leap < LEAP:
                    break
                if count > 100 * SAMPLES:
                    raise Undecided("the true input leaps")
                count *= 4
            parts.append((n < len(spans) - 1, np.asarray(value)))
        return parts
