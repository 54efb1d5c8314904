"""All configurations of a mechanism that closes by dyads, as curves along which its motion is smooth.

Take the closures in their order. Before the first one, configurations are the input's circle. Each closure has a margin
m on the current curves: a smooth function that is positive where the closure exists. Where m is positive all along
a closed curve there are two closed curves of configurations, one for each assembly. An arc a < u < b at whose ends m
vanishes gives one closed curve: there the two assemblies meet, and with

    u = (a + b)/2 − (b − a)/2 · cos v,    assembly + for 0 < v < π, − for π < v < 2π

everything is smooth in v, including the square root of the margin. So curves are built from curves, closure by closure.
No fold can be missed by one assembly or between two closures, because each margin is searched alone, on a curve where
it has no corner.

Where m only touches zero two motions cross, a *change point*. Arcs end there openly: a curve between two change points
has two ends, and so has one between a change point and a fold, with u = a + (b − a) v² for −1 < v < 1.

The *turns* of a curve are the places where the input reverses: where its own closure is folded flat, and the turns of
the curves below it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Integers, Real
from kinematics.compiling import njit
from kinematics.linkage.planar.closures import Decomposition, Step
from kinematics.linkage.planar.drive import compute_margins, drive_one
from kinematics.linkage.planar.mechanism import Mechanism, TopologyError
from kinematics.linkage.planar.positive_arcs import TOUCH_TOLERANCE, Arc, Domain, find_positive_arcs

CELL_COUNT = 64
"""Initial number of cells of a curve, per turn of its fastest link."""

END_TOLERANCE = 1e-7
"""Distance, as a share of an arc, within which a turn coincides with the arc's folded end: the inputs differ only by
rounding."""

MIN_SWING = 0.1
"""Difference, radians, of a link's directions in the two assemblies at a change point above which it swings freely."""


SHAPES = ("straight", "round", "bend")
STRAIGHT, ROUND, BEND = range(3)
"""Codes of the maps from the parameter of a curve to that of the curve below."""


class Turn(NamedTuple):
    """Reversal of the input on a curve: parameter, input, and number of the closure that folds flat."""

    at: float
    theta: float
    level: int


@dataclass(frozen=True, eq=False)
class ChangePoint:
    """Crossing of curves of one closure, whose number is ``level``.

    If it ``swings``, a link is free to rotate there, since its pins coincide.
    """

    level: int
    swings: bool


class End(NamedTuple):
    """Open end of a curve: its input, its change point, and the closures whose assemblies meet there."""

    theta: float
    point: ChangePoint
    folded: frozenset[int]


class Place(NamedTuple):
    """Places on a curve: the input, its first two derivatives by the parameter, and signs (closures, n)."""

    theta: Real
    rate: Real
    second: Real
    signs: Integers


@dataclass(frozen=True, eq=False)
class Curve:
    """Curve of configurations over a parameter from ``low`` to ``high``, on a circle if ``closed``.

    ``shape`` is the map from the parameter v to that of the curve ``below``, u: identity (``straight``), a cosine
    between two folds (``round``), or v² from the fold ``a`` to the open end ``b`` (``bend``).
    """

    below: Curve | None
    shape: Literal["straight", "round", "bend"]
    a: float
    b: float
    sign: int
    low: float
    high: float
    closed: bool
    turns: tuple[Turn, ...]
    ends: tuple[End, ...]

    @cached_property
    def chain(self) -> Real:
        """This curve and those below it except the input's circle, shape (closures, 4): shape, a, b − a and sign."""
        if self.below is None:
            return np.empty((0, 4))
        own = np.array([[SHAPES.index(self.shape), self.a, self.b - self.a, self.sign]])
        return np.concatenate([own, self.below.chain])

    def place(self, v: Real) -> Place:
        """Return input and signs along the curve."""
        return evaluate_places(self.chain[None], np.zeros(len(v), np.int64), v)

    def evaluate_input(self, v: float) -> float:
        """Return the input at one place."""
        return float(self.place(np.array([v])).theta[0])


class Closures:
    """Margins of a mechanism's closures with two assemblies, by their numbers."""

    def __init__(self, mechanism: Mechanism, decomposition: Decomposition) -> None:
        self.mechanism, self.steps = mechanism, decomposition.steps
        self.position = [n for n, step in enumerate(self.steps) if step.has_two_solutions]
        self.links = [self.steps[n].link for n in self.position]

    def signs(self, chosen: Integers) -> Integers:
        """Return signs for every step from those of the first closures with two assemblies, shape (closures, n)."""
        every = np.ones((len(self.steps), chosen.shape[1]), np.int64)
        every[self.position[: len(chosen)]] = chosen
        return every

    def margin(self, level: int, place: Place) -> tuple[Real, Real]:
        """Return the margin of a closure and its rate by the curve's parameter."""
        margin = compute_margins(self.mechanism, place.theta, self.signs(place.signs))[level]
        return margin[0], margin[1] * place.rate

    def is_always_folded(self, level: int, curve: Curve) -> bool:
        """Return whether a closure exists but is folded flat all along a curve; False if its pins coincide."""
        # Four irregular places: a margin that vanishes at all of them vanishes everywhere.
        place = curve.place(curve.low + (curve.high - curve.low) * np.array([0.13, 0.31, 0.57, 0.77]))
        if not np.all(np.abs(self.margin(level, place)[0]) <= TOUCH_TOLERANCE):
            return False
        signs = self.signs(np.vstack([place.signs, np.ones(len(place.theta), np.int64)]))
        motion = drive_one(self.mechanism, place.theta[:, None], signs, 0)
        if level + 1 == len(self.links):
            return bool(motion.valid.any())
        return bool(np.isfinite(motion.margins[self.links[level + 1]]).any())

    def swings(self, level: int, curve: Curve, v: float) -> bool:
        """Return whether the assemblies do not meet at a change point: the pins coincide and a link is free."""
        place = curve.place(np.array([v - 1e-7, v - 1e-7, v + 1e-7, v + 1e-7]))
        signs = np.vstack([place.signs, [1, -1, 1, -1]])
        motion = drive_one(self.mechanism, place.theta[:, None], self.signs(signs), 0)
        angle = motion.angles[self.links[level]][0, :, 0]
        apart = np.abs(np.angle(np.exp(1j * (angle[::2] - angle[1::2]))))
        return bool(np.nanmax(apart, initial=0.0) > MIN_SWING)


def find_configuration_curves(mechanism: Mechanism, closures: Closures, period: float) -> list[Curve]:
    """Find all curves of configurations of one design, in the parameters of its last closure.

    Raises
    ------
    TopologyError
        If a link swings freely at a change point while others depend on it, or a dyad is always folded flat.
    """
    # Faster geared links need proportionally more cells.
    waves = max(map(abs, compute_gear_rotations(mechanism, closures.steps).values()))
    curves = [Curve(None, "straight", 0.0, 0.0, 1, 0.0, period, True, (), ())]
    for level in range(len(closures.links)):
        below = stack_chains(curves) if curves else np.empty((0, 0, 4))

        def evaluate_margin(row: Integers, at: Real, level: int = level, below: Real = below) -> tuple[Real, Real]:
            return closures.margin(level, evaluate_places(below, row, at))

        turns = [waves * _measure_input_travel(curve, period) / (2.0 * np.pi) for curve in curves]
        domains = [
            Domain(c.low, c.high, c.closed, int(CELL_COUNT * max(n, 1.0))) for c, n in zip(curves, turns, strict=True)
        ]
        arcs = find_positive_arcs(evaluate_margin, domains)
        curves = [
            new
            for curve, own in zip(curves, arcs, strict=True)
            for new in _build_next_curves(closures, level, curve, own)
        ]
    return curves


def compute_gear_rotations(mechanism: Mechanism, steps: Sequence[Step]) -> dict[str, float]:
    """Compute rotations of the input and of all links geared directly to it, per rotation of the input."""
    turned = {mechanism.input: 1.0}
    for step in steps:
        if step.kind == "gear":
            turned[step.link] = step.ratio * turned.get(step.other, 0.0)
    return turned


def stack_chains(curves: Sequence[Curve]) -> Real:
    """Stack the chains of curves of one closure, for :func:`evaluate_places`; shape (curves, closures, 4)."""
    return np.stack([curve.chain for curve in curves])


def evaluate_places(chains: Real, row: Integers, at: Real) -> Place:
    """Evaluate places on many curves: at parameters ``at``, each on the curve of its ``row`` of chains."""
    place = np.empty((3, len(at)))
    signs = np.empty((chains.shape[1], len(at)), np.int64)
    _fill_places(chains, row, at, place, signs)
    return Place(place[0], place[1], place[2], signs)


@njit(cache=True, nogil=True)
def _fill_places(chains: Real, row: Integers, at: Real, place: Real, signs: Integers) -> None:
    """Fill input, rate and second derivative into ``place`` (3, n), and the assemblies into ``signs``."""
    closures = chains.shape[1]
    for n in range(len(at)):
        u, rate, second = at[n], 1.0, 0.0
        for link in range(closures):
            shape, a, half, sign = chains[row[n], link]
            if shape == STRAIGHT:
                signs[closures - 1 - link, n] = int(sign)
                continue
            if shape == ROUND:
                half *= 0.5
                sign, cosine = math.sin(u), math.cos(u)
                u, first, bend = a + half * (1.0 - cosine), half * sign, half * cosine
            else:
                sign = u
                u, first, bend = a + half * u * u, 2.0 * half * u, 2.0 * half
            signs[closures - 1 - link, n] = 1 if sign >= 0.0 else -1
            # Chain rule for the second derivative, from the top curve down to the input.
            second = bend * rate * rate + first * second
            rate *= first
        place[0, n], place[1, n], place[2, n] = u, rate, second


def _measure_input_travel(curve: Curve, period: float) -> float:
    """Measure the input's total travel along a curve, back and forth."""
    if curve.closed and not curve.turns:
        return period
    cuts = [turn.theta for turn in curve.turns]
    cuts = [*cuts, cuts[0]] if curve.closed else [curve.ends[0].theta, *cuts, curve.ends[1].theta]
    return float(np.abs(np.diff(cuts)).sum())


def _build_next_curves(closures: Closures, level: int, curve: Curve, arcs: list[Arc]) -> list[Curve]:
    """Build the curves of the next closure over a curve's arcs."""
    if not arcs and closures.is_always_folded(level, curve):
        raise TopologyError("kinematics-link-always-folded", link=repr(closures.links[level]))
    curves: list[Curve] = []
    points: dict[float, ChangePoint] = {}
    length = curve.high - curve.low

    def build_end(at: float, kind: str, side: int) -> End:
        if kind == "end":
            own = curve.ends[side]
            margin = closures.margin(level, curve.place(np.array([at + (1e-6 - 2e-6 * side) * length])))[0][0]
            return own._replace(folded=own.folded | {level}) if margin < 1e-9 else own
        # Rounded, so that both arcs that end at a change point of a closed curve share it.
        around = round(float(np.mod(at - curve.low, length)), 9) if curve.closed else at
        if around not in points:
            points[around] = ChangePoint(level, closures.swings(level, curve, at))
            if points[around].swings and level + 1 < len(closures.links):
                raise TopologyError("kinematics-link-swings-freely", link=repr(closures.links[level]))
        return End(curve.evaluate_input(at), points[around], frozenset({level}))

    for arc in arcs:
        shift = length * np.floor((arc.low - curve.low) / length) if curve.closed and arc.at_low != "whole" else 0.0
        low, high = float(arc.low - shift), float(arc.high - shift)
        turns = [
            turn._replace(at=turn.at + k * length)
            for k in ((0, 1) if curve.closed else (0,))
            for turn in curve.turns
            if arc.at_low == "whole" or low < turn.at + k * length < high
        ]
        if arc.at_low == "whole":
            # The margin is positive all around: one closed curve per assembly.
            curves += [replace(curve, below=curve, shape="straight", sign=sign, turns=curve.turns) for sign in (1, -1)]
        elif arc.at_low == arc.at_high == "zero":
            curves.append(_build_round_curve(curve, level, low, high, turns))
        elif "zero" not in (arc.at_low, arc.at_high):
            ends = build_end(low, arc.at_low, 0), build_end(high, arc.at_high, 1)
            inner = tuple(t for t in turns if END_TOLERANCE < (t.at - low) / (high - low) < 1.0 - END_TOLERANCE)
            curves += [Curve(curve, "straight", low, high, sign, low, high, False, inner, ends) for sign in (1, -1)]
        elif arc.at_low == "zero":
            curves.append(_build_bend_curve(curve, level, low, high, turns, build_end(high, arc.at_high, 1)))
        else:
            curves.append(_build_bend_curve(curve, level, high, low, turns, build_end(low, arc.at_low, 0)))
    return curves


def _build_round_curve(curve: Curve, level: int, a: float, b: float, turns: list[Turn]) -> Curve:
    """Build the closed curve over an arc between two folds."""
    # Both folds, plus two images of each turn of the curve below.
    own = [Turn(0.0, curve.evaluate_input(a), level), Turn(np.pi, curve.evaluate_input(b), level)]
    for turn in turns:
        part = (turn.at - a) / (b - a)
        if END_TOLERANCE < part < 1.0 - END_TOLERANCE:
            v = float(np.arccos(1.0 - 2.0 * part))
            own += [turn._replace(at=v), turn._replace(at=2.0 * np.pi - v)]
    return Curve(curve, "round", a, b, 1, 0.0, 2.0 * np.pi, True, tuple(sorted(own)), ())


def _build_bend_curve(curve: Curve, level: int, fold: float, opening: float, turns: list[Turn], end: End) -> Curve:
    """Build the open curve over an arc between a fold and a change point."""
    own = [Turn(0.0, curve.evaluate_input(fold), level)]
    for turn in turns:
        part = (turn.at - fold) / (opening - fold)
        if END_TOLERANCE < part < 1.0 - END_TOLERANCE:
            own += [turn._replace(at=float(np.sqrt(part))), turn._replace(at=-float(np.sqrt(part)))]
    return Curve(curve, "bend", fold, opening, 1, -1.0, 1.0, False, tuple(sorted(own)), (end, end))


def number_circuits(curves: Sequence[Curve]) -> list[int]:
    """Number the circuit of each curve: curves that meet at a change point belong together."""
    parent = list(range(len(curves)))

    def find_root(n: int) -> int:
        while parent[n] != n:
            n = parent[n]
        return n

    ends = [
        (n, end, curve.place(np.array([at])).signs[:, 0])
        for n, curve in enumerate(curves)
        if not curve.closed
        for end, at in zip(curve.ends, _offset_ends(curve), strict=True)
    ]
    for (n, one, mine), (m, other, theirs) in itertools.combinations(ends, 2):
        # Identity, not equality: both ends must stem from the same crossing.
        if one.point is other.point:
            later = set(range(one.point.level + 1, len(mine)))
            if all(mine[k] == theirs[k] for k in later - one.folded - other.folded):
                parent[find_root(n)] = find_root(m)
    return [find_root(n) for n in range(len(curves))]


def _offset_ends(curve: Curve) -> tuple[float, float]:
    hair = 1e-6 * (curve.high - curve.low)
    return curve.low + hair, curve.high - hair
