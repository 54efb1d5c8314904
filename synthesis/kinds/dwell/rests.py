"""Find the rests of an output over a turn of its crank: where it moves least while the crank turns by a given angle.

A grid of the turn shows where a rest may lie. Between the grid's places the output is driven: all places at which it
turns back are known, so that the output's movement from any place on follows from these and from its two ends; the
place of minimum movement is then refined step by step.
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
"""Half-width, in steps of the grid, of the interval around the best grid place that contains the minimum."""

PLACES = 9
"""Number of places first evaluated in this interval."""

CANDIDATES = 3
"""Maximum number of grid places that are refined: the best that are no neighbours."""

WIDER = 5.0
"""Steps of the grid by which a width may differ from its value on the grid: one at each end, and three for its
middle."""

KNOTS = 4
"""Number of knots per grid step of the spline on which a width is found."""

EXACT = 1e-7
"""Share of a grid step to which the width is found, far below the accuracy of any measurement of an output."""

PANELS, NODES = 8, 12
"""Number of panels of a rest over which the output's mean is taken, and of Gauss nodes in each."""


class Resting(NamedTuple):
    """A rest: begin (radians), middle and size of the output's movement, width (radians), and place.

    ``off_end`` is the distance of the output's mean from the nearer end of its range, ``share`` its place in the range
    from the minimum output, both as shares of the range.
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
        Equal steps of a full turn, radians, and the output there.
    whole : float
        A full turn of the output, in its unit; infinite for one that slides.
    """

    def __init__(self, output: Callable[[Real], Real], inputs: Real, values: Real, whole: float = math.inf) -> None:
        self._output, self._whole = output, whole
        self.first, self.step, self.values = float(inputs[0]), float(inputs[1] - inputs[0]), values[:-1]
        # A reversal lies where the sign of the difference changes between two steps, around the seam too.
        rising = np.diff(values) > 0.0
        turning = np.flatnonzero(rising != np.roll(rising, 1))
        upward = np.where(rising[turning - 1], 1.0, -1.0)
        self.places, self.heights = self._extremes(inputs[turning], upward)

    def at(self, inputs: Real) -> Real:
        """Return the output at inputs of any turn, shape (n,)."""
        found = self._output(inputs)
        if math.isinf(self._whole):
            return found
        # The nearest grid value selects the branch of an angle that is known only modulo a full turn.
        near = self.values[np.rint((inputs - self.first) / self.step).astype(np.int64) % len(self.values)]
        return np.asarray(found - self._whole * np.round((found - near) / self._whole))

    def between(self, first: float, last: float) -> Turn:
        """Return a copy whose output between two inputs is a cubic spline, which makes root finding faster.

        Its knots are separated by a quarter of a step; its error is (step/4)⁴/384 of the output's fourth derivative.
        """
        knots = np.linspace(first, last, KNOTS * math.ceil((last - first) / self.step) + 1)
        alike = copy(self)
        alike._output, alike._whole = CubicSpline(knots, self.at(knots)), math.inf
        return alike

    def _extremes(self, places: Real, upward: Real) -> tuple[Real, Real]:
        """Refine the places at which the output turns back, and the output there, from places of the grid."""
        step, heights = self.step, self.at(places)
        for _ in range(REFINEMENTS):
            closer = places[:, None] + step * np.linspace(-1.0, 1.0, SAMPLES)
            values = self.at(closer.ravel()).reshape(closer.shape)
            best = (upward[:, None] * values).argmax(axis=1)[:, None]
            places = np.take_along_axis(closer, best, 1)[:, 0]
            heights = np.take_along_axis(values, best, 1)[:, 0]
            # The next interval spans the two steps around the best sample.
            step *= 2.0 / (SAMPLES - 1)
        return places, heights

    def ends(self, begin: Real, wide: float) -> tuple[Real, Real]:
        """Return the minimum and maximum output while the crank turns by ``wide`` from each place, shapes (n,)."""
        first, last = self.at(np.concatenate([begin, begin + wide])).reshape(2, -1)
        low, high = np.minimum(first, last), np.maximum(first, last)
        for place, height in zip(self.places, self.heights, strict=True):
            within = np.mod(place - begin, 2.0 * math.pi) <= wide
            low = np.where(within, np.minimum(low, height), low)
            high = np.where(within, np.maximum(high, height), high)
        return low, high

    def spread(self, begin: Real, wide: float) -> Real:
        """Return the output's movement while the crank turns by ``wide`` from each place, shape (n,)."""
        low, high = self.ends(begin, wide)
        return high - low

    def mean(self, begin: float, wide: float) -> float:
        """Return the output's mean while the crank turns by ``wide`` from a place."""
        nodes, weights = np.polynomial.legendre.leggauss(NODES)
        middles = (np.arange(PANELS) + 0.5)[:, None] / PANELS
        values = self.at(begin + wide * (middles + 0.5 * nodes / PANELS).ravel())
        return float((values.reshape(PANELS, NODES) @ weights).mean()) / 2.0


def rests(turn: Turn, wide: float, count: int, allowed: float, way: tuple[float, float]) -> list[Resting]:
    """Find the rests of a turn: one, or one near each end of the range, the one that begins first at the front.

    Parameters
    ----------
    turn : Turn
    wide : float
        Rotation of the crank during which the output should rest, radians.
    count : int
        Number of rests, 1 or 2.
    allowed : float
        Maximum movement of the output that defines the width of a rest.
    way : pair of float
        Minimum and maximum output.

    Returns
    -------
    list of Resting
        Empty if the output has no rest near one of two ends.
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
    """Find the rests of a turn nearest to given places of the range, in the order of these.

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
        For each dwell the one that moves least among those with a mean within ``END`` of its place; if there is none,
        at the nearest place.
    """
    low, high = way
    found = []
    for angle, place in wanted:
        wide = math.radians(angle)
        jitter, mean = _windows(turn, wide)
        share = (mean - low) / (high - low)
        off = np.minimum(share, 1.0 - share) if place is None else np.abs(share - place)
        # At least the nearest place always remains.
        near = off <= max(END, float(off.min()))
        found.append(_rest(turn, np.where(near, jitter, np.inf), wide, allowed, way))
    return found


def _windows(turn: Turn, wide: float) -> tuple[Real, Real]:
    """Return the output's movement from each place of the grid on, and its mean there."""
    window = math.ceil(wide / turn.step - WHOLE_STEP) + 1
    return _ranges(turn.values, window), _means(turn.values, window)


def _rest(turn: Turn, jitter: Real, wide: float, allowed: float, way: tuple[float, float]) -> Resting:
    """Find the rest that moves least, from the movements on the grid."""
    low, high = way
    begin = _least(turn, jitter, wide)
    least, most = (float(end[0]) for end in turn.ends(np.array([begin]), wide))
    at = turn.mean(begin, wide)
    off = min(high - at, at - low) / (high - low)
    width = _width(turn, begin + 0.5 * wide, allowed)
    return Resting(begin, 0.5 * (least + most), most - least, width, off, (at - low) / (high - low))


def _least(turn: Turn, jitter: Real, wide: float) -> float:
    """Find the place of minimum movement, from the movements on the grid; a rest at the grid's seam begins just before
    it."""
    best: list[int] = []
    count = len(jitter)
    # Neighbours of a chosen place lead to the same minimum.
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
    """Return maximum minus minimum of ``window`` values from each index on, around the turn."""
    top, foot = (f(values, window, mode="wrap") for f in (maximum_filter1d, minimum_filter1d))
    return np.asarray(np.roll(top - foot, -(window // 2)))


def _means(values: Real, window: int) -> Real:
    return np.asarray(np.roll(uniform_filter1d(values, window, mode="wrap"), -(window // 2)))


def _width(turn: Turn, middle: float, allowed: float) -> float:
    """Return the maximum rotation, radians, around a rest's middle over which the output moves no more than allowed."""
    count = len(turn.values)
    at = round((middle - turn.first) / turn.step)

    def starts(width: int) -> Real:
        return np.asarray(np.take(_ranges(turn.values, width), np.arange(at - width + 1, at + 1), mode="wrap"))

    shortest, longest = 1, count
    # Bisect on the grid first: a wider window never moves less.
    while longest - shortest > 1:
        tried = (shortest + longest) // 2
        holds = starts(tried).min() <= allowed
        shortest, longest = (tried, longest) if holds else (shortest, tried)
    begin = turn.first + turn.step * (at - shortest + 1 + int(starts(shortest).argmin()))
    low = max((shortest - 1 - WIDER) * turn.step, 0.0)
    high = min((shortest - 1 + WIDER) * turn.step, 2.0 * math.pi)
    aside = 1.5 * WIDER * turn.step * np.linspace(-1.0, 1.0, 2 * PLACES - 1)
    # The root search evaluates the output many times; a local spline is as accurate and far faster.
    about = turn.between(begin + 1.2 * aside[0], begin + high + 1.2 * aside[-1])

    def beyond(wide: float) -> float:
        begins = np.unique(np.clip(begin + aside, middle - wide, middle))
        spreads = about.spread(begins, wide)
        if len(begins) == 1:
            return float(spreads[0]) - allowed
        return least_near(partial(about.spread, wide=wide), begins, spreads)[1] - allowed

    # The movement never decreases with the width, so that the root is unique.
    if beyond(high) <= 0.0:
        return high
    return float(brentq(beyond, low, high, xtol=EXACT * turn.step)) if beyond(low) < 0.0 else low
