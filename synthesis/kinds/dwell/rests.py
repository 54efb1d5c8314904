"""The rests of an output over a turn of its crank: where it moves least while the crank turns by a given angle.

A grid of the turn shows where a rest may lie. Between the grid's places the output is driven: all places where it
turns back are known, so that what it moves from any place on follows from these and from its two ends, and the place
where that is least is looked for more and more closely.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import copy
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.ndimage import maximum_filter1d, minimum_filter1d, uniform_filter1d
from scipy.optimize import brentq

from synthesis.kinds.dwell.problem import END, Wanted
from synthesis.proof.closer import REFINEMENTS, SAMPLES, least_near

Real = NDArray[np.float64]

WHOLE_STEP = 1e-9
"""Steps of the grid by which rounding may put an angle above a whole number of them."""

ASIDE = 2.0
"""Steps of the grid to either side of its best place between which the best lies, and the width of its rest."""

PLACES = 9
"""Places between these that are looked at first."""

CANDIDATES = 3
"""Places of the grid that are looked at more closely: the best that are no neighbours."""

WIDER = 5.0
"""Steps of the grid by which a width may differ from that by the grid: one at each end, and where the middle lies."""

KNOTS = 4
"""Knots in each step of the grid of the spline by which a width is found."""

EXACT = 1e-7
"""Share of a step of the grid to which the width is found, far below what any output can be measured to."""

PANELS, NODES = 8, 12
"""Panels of a rest over which the output's mean is taken, and nodes of Gauss's quadrature in each."""


class Resting(NamedTuple):
    """A rest: where it begins (radians), middle and size of what the output moves, width (radians), and where it lies.

    ``off_end`` is the distance of the output's mean from the nearer end of its way, ``share`` its place in the way from
    the least output, both as shares of the way.
    """

    begin: float
    level: float
    jitter: float
    width: float
    off_end: float
    share: float


class Turn:
    """The output over a turn of the crank.

    Parameters
    ----------
    output : callable
        The output at inputs (n,), shape (n,).
    inputs, values : float, shape (m + 1,)
        Even steps of a whole turn, radians, and the output there.
    whole : float
        A turn of the output, in its unit; infinite for one that slides.
    """

    def __init__(self, output: Callable[[Real], Real], inputs: Real, values: Real, whole: float = math.inf) -> None:
        self._output, self._whole = output, whole
        self.first, self.step, self.values = float(inputs[0]), float(inputs[1] - inputs[0]), values[:-1]
        rising = np.diff(values) > 0.0
        turning = np.flatnonzero(rising != np.roll(rising, 1))
        upward = np.where(rising[turning - 1], 1.0, -1.0)
        self.places, self.heights = self._extremes(inputs[turning], upward)

    def at(self, inputs: Real) -> Real:
        """The output at inputs of any turn, shape (n,)."""
        found = self._output(inputs)
        if math.isinf(self._whole):
            return found
        near = self.values[np.rint((inputs - self.first) / self.step).astype(np.int64) % len(self.values)]
        return np.asarray(found - self._whole * np.round((found - near) / self._whole))

    def between(self, first: float, last: float) -> Turn:
        """The same turn with its output between two inputs by a cubic spline, which a root is found on in less time.

        Its knots lie a quarter of a step apart; it errs by (step/4)⁴/384 of the output's fourth derivative.
        """
        knots = np.linspace(first, last, KNOTS * math.ceil((last - first) / self.step) + 1)
        alike = copy(self)
        alike._output, alike._whole = CubicSpline(knots, self.at(knots)), math.inf
        return alike

    def _extremes(self, places: Real, upward: Real) -> tuple[Real, Real]:
        """Where the output turns back, and the output there, from places of the grid."""
        step, heights = self.step, self.at(places)
        for _ in range(REFINEMENTS):
            closer = places[:, None] + step * np.linspace(-1.0, 1.0, SAMPLES)
            values = self.at(closer.ravel()).reshape(closer.shape)
            best = (upward[:, None] * values).argmax(axis=1)[:, None]
            places = np.take_along_axis(closer, best, 1)[:, 0]
            heights = np.take_along_axis(values, best, 1)[:, 0]
            step *= 2.0 / (SAMPLES - 1)
        return places, heights

    def ends(self, begin: Real, wide: float) -> tuple[Real, Real]:
        """The least and the greatest output while the crank turns on from each place, shapes (n,)."""
        first, last = self.at(np.concatenate([begin, begin + wide])).reshape(2, -1)
        low, high = np.minimum(first, last), np.maximum(first, last)
        for place, height in zip(self.places, self.heights, strict=True):
            within = np.mod(place - begin, 2.0 * math.pi) <= wide
            low = np.where(within, np.minimum(low, height), low)
            high = np.where(within, np.maximum(high, height), high)
        return low, high

    def spread(self, begin: Real, wide: float) -> Real:
        """What the output moves while the crank turns on from each place, shape (n,)."""
        low, high = self.ends(begin, wide)
        return high - low

    def mean(self, begin: float, wide: float) -> float:
        """The output's mean while the crank turns on from a place."""
        nodes, weights = np.polynomial.legendre.leggauss(NODES)
        middles = (np.arange(PANELS) + 0.5)[:, None] / PANELS
        values = self.at(begin + wide * (middles + 0.5 * nodes / PANELS).ravel())
        return float((values.reshape(PANELS, NODES) @ weights).mean()) / 2.0


def rests(turn: Turn, wide: float, count: int, allowed: float, way: tuple[float, float]) -> list[Resting]:
    """The rests of a turn: one, or one near each end of the way, the one that begins first at the front.

    Parameters
    ----------
    turn : Turn
    wide : float
        Rotation of the crank in which the output is to rest, radians.
    count : int
        Rests that are looked for, 1 or 2.
    allowed : float
        How far the output may move in the rotation that is given as the width.
    way : pair of float
        Least and greatest output.

    Returns
    -------
    list of Resting
        Empty where the output has no rest near one of two ends.
    """
    jitter, mean = _windows(turn, wide)
    middle = 0.5 * (way[0] + way[1])
    found = [
        _rest(turn, np.where(near, jitter, np.inf), wide, allowed, way)
        for near in (mean > middle, mean <= middle)
        if near.any()
    ]
    if count == 1:
        return [min(found, key=lambda rest: rest.jitter)]
    return sorted(found, key=lambda rest: rest.begin) if len(found) == 2 else []


def placed_rests(turn: Turn, wanted: Sequence[Wanted], allowed: float, way: tuple[float, float]) -> list[Resting]:
    """The rests of a turn that lie nearest to stated places of the way, in the order in which these are stated.

    Parameters
    ----------
    turn : Turn
    wanted : sequence of Wanted
        The crank's rotation in each rest, degrees, and its place.
    allowed, way
        As for :func:`rests`.

    Returns
    -------
    list of Resting
        Of each the one that moves least of those with a mean within ``END`` of its place; where there is none, at the
        place that comes nearest.
    """
    low, high = way
    found = []
    for angle, place in wanted:
        wide = math.radians(angle)
        jitter, mean = _windows(turn, wide)
        share = (mean - low) / (high - low)
        off = np.minimum(share, 1.0 - share) if place is None else np.abs(share - place)
        near = off <= max(END, float(off.min()))
        found.append(_rest(turn, np.where(near, jitter, np.inf), wide, allowed, way))
    return found


def _windows(turn: Turn, wide: float) -> tuple[Real, Real]:
    """What the output moves from each place of the grid on, and its mean there."""
    window = math.ceil(wide / turn.step - WHOLE_STEP) + 1
    return _ranges(turn.values, window), _means(turn.values, window)


def _rest(turn: Turn, jitter: Real, wide: float, allowed: float, way: tuple[float, float]) -> Resting:
    """The rest that moves least, from what is moved by the grid."""
    low, high = way
    begin = _least(turn, jitter, wide)
    least, most = (float(end[0]) for end in turn.ends(np.array([begin]), wide))
    at = turn.mean(begin, wide)
    off = min(high - at, at - low) / (high - low)
    width = _width(turn, begin + 0.5 * wide, allowed)
    return Resting(begin, 0.5 * (least + most), most - least, width, off, (at - low) / (high - low))


def _least(turn: Turn, jitter: Real, wide: float) -> float:
    """Where the output moves least, from what it moves by the grid; of a rest at the grid's seam just before it."""
    best: list[int] = []
    count = len(jitter)
    for k in np.argsort(jitter).tolist():
        if all(ASIDE < (k - other) % count < count - ASIDE for other in best):
            best.append(k)
        if len(best) == CANDIDATES or not math.isfinite(jitter[k]):
            break
    found = []
    for k in best:
        begins = turn.first + turn.step * (k + ASIDE * np.linspace(-1.0, 1.0, PLACES))
        found.append(least_near(lambda begin: turn.spread(begin, wide), begins, turn.spread(begins, wide)))
    begin = min(found, key=lambda place: place[1])[0]
    beyond = begin - turn.first > 2.0 * math.pi - 2.0 * ASIDE * turn.step
    return begin - 2.0 * math.pi if beyond else begin


def _ranges(values: Real, window: int) -> Real:
    """Greatest less least of each ``window`` values from an index on, around the turn."""
    top, foot = (f(values, window, mode="wrap") for f in (maximum_filter1d, minimum_filter1d))
    return np.asarray(np.roll(top - foot, -(window // 2)))


def _means(values: Real, window: int) -> Real:
    return np.asarray(np.roll(uniform_filter1d(values, window, mode="wrap"), -(window // 2)))


def _width(turn: Turn, middle: float, allowed: float) -> float:
    """The greatest rotation, radians, about a rest's middle over which the output moves no more than is allowed."""
    count = len(turn.values)
    at = round((middle - turn.first) / turn.step)

    def starts(width: int) -> Real:
        return np.asarray(np.take(_ranges(turn.values, width), np.arange(at - width + 1, at + 1), mode="wrap"))

    shortest, longest = 1, count
    while longest - shortest > 1:
        tried = (shortest + longest) // 2
        holds = starts(tried).min() <= allowed
        shortest, longest = (tried, longest) if holds else (shortest, tried)
    begin = turn.first + turn.step * (at - shortest + 1 + int(starts(shortest).argmin()))
    low = max((shortest - 1 - WIDER) * turn.step, 0.0)
    high = min((shortest - 1 + WIDER) * turn.step, 2.0 * math.pi)
    aside = 1.5 * WIDER * turn.step * np.linspace(-1.0, 1.0, 2 * PLACES - 1)
    about = turn.between(begin + 1.2 * aside[0], begin + high + 1.2 * aside[-1])

    def beyond(wide: float) -> float:
        begins = np.unique(np.clip(begin + aside, middle - wide, middle))
        spreads = about.spread(begins, wide)
        if len(begins) == 1:
            return float(spreads[0]) - allowed
        return least_near(partial(about.spread, wide=wide), begins, spreads)[1] - allowed

    # What is wider moves no less.
    if beyond(high) <= 0.0:
        return high
    return float(brentq(beyond, low, high, xtol=EXACT * turn.step)) if beyond(low) < 0.0 else low
