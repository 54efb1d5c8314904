"""Find the rests of an output over a turn of its crank: the intervals of given crank rotation in which it moves least.

A grid of crank angles shows where a rest may lie. Between the grid's angles the output is driven. All its reversals are
known, so that its movement in any interval follows from the reversals in it and from its two ends. The interval of
minimum movement is then refined step by step.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import copy
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import maximum_filter1d, minimum_filter1d, uniform_filter1d
from scipy.optimize import brentq

from kinematics.arrays import Real
from kinematics.linkage.refined_extremes import REFINEMENT_COUNT, SAMPLE_COUNT, find_minimum_near
from synthesis.kinds.dwell.problem import PLACE_TOLERANCE, RequestedDwell

STEP_ROUNDING = 1e-9
"""Rounding of an angle that is a whole number of grid steps, in steps."""

REFINEMENT_MARGIN = 2.0
"""Half-width, in steps of the grid, of the interval around the best grid place that contains the minimum."""

PLACE_COUNT = 9
"""Number of angles first evaluated in this interval."""

MAX_CANDIDATES = 3
"""Maximum number of grid angles that are refined: the best ones that are not neighbours."""

MAX_WIDTH_CHANGE = 5.0
"""Maximum difference, in grid steps, of a width from its value on the grid: one step for each end and three for the
middle."""

KNOTS_PER_STEP = 4
"""Number of knots per grid step of the spline on which a width is found."""

WIDTH_TOLERANCE = 1e-7
"""Tolerance of the width, in grid steps, far below the accuracy of any measurement of an output."""

PANEL_COUNT, NODE_COUNT = 8, 12
"""Number of panels of a rest over which the output's mean is taken, and of Gauss nodes in each."""


class MeasuredRest(NamedTuple):
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


class OutputCycle:
    """The output over a turn of the crank.

    Parameters
    ----------
    output : callable
        The output at inputs (n,), shape (n,).
    inputs, values : float, shape (m + 1,)
        Crank angles in equal steps over a full turn, radians, and the output there.
    whole : float
        A full turn of the output, in its unit; infinite for an output that slides.
    """

    def __init__(self, output: Callable[[Real], Real], inputs: Real, values: Real, whole: float = math.inf) -> None:
        self._output, self._whole = output, whole
        self.first, self.step, self.values = float(inputs[0]), float(inputs[1] - inputs[0]), values[:-1]
        # A reversal lies where the sign of the difference changes between two steps, around the seam too.
        rising = np.diff(values) > 0.0
        turning = np.flatnonzero(rising != np.roll(rising, 1))
        upward = np.where(rising[turning - 1], 1.0, -1.0)
        self.places, self.heights = self._refine_extremes(inputs[turning], upward)

    def evaluate(self, inputs: Real) -> Real:
        """Return the output at inputs of any turn, shape (n,)."""
        found = self._output(inputs)
        if math.isinf(self._whole):
            return found
        # The nearest grid value selects the branch of an angle that is known only modulo a full turn.
        near = self.values[np.rint((inputs - self.first) / self.step).astype(np.int64) % len(self.values)]
        return np.asarray(found - self._whole * np.round((found - near) / self._whole))

    def interpolate_between(self, first: float, last: float) -> OutputCycle:
        """Return a copy whose output between two inputs is a cubic spline, which makes root finding faster.

        Its knots are separated by a quarter of a step; its error is (step/4)⁴/384 of the output's fourth derivative.
        """
        knots = np.linspace(first, last, KNOTS_PER_STEP * math.ceil((last - first) / self.step) + 1)
        alike = copy(self)
        alike._output, alike._whole = CubicSpline(knots, self.evaluate(knots)), math.inf
        return alike

    def _refine_extremes(self, places: Real, upward: Real) -> tuple[Real, Real]:
        """Refine the crank angles of reversals found on the grid; return them and the output there."""
        step, heights = self.step, self.evaluate(places)
        for _ in range(REFINEMENT_COUNT):
            closer = places[:, None] + step * np.linspace(-1.0, 1.0, SAMPLE_COUNT)
            values = self.evaluate(closer.ravel()).reshape(closer.shape)
            best = (upward[:, None] * values).argmax(axis=1)[:, None]
            places = np.take_along_axis(closer, best, 1)[:, 0]
            heights = np.take_along_axis(values, best, 1)[:, 0]
            # The next interval spans the two steps around the best sample.
            step *= 2.0 / (SAMPLE_COUNT - 1)
        return places, heights

    def find_bounds(self, begin: Real, wide: float) -> tuple[Real, Real]:
        """Return the minimum and maximum output while the crank turns by ``wide`` from each place, shapes (n,)."""
        first, last = self.evaluate(np.concatenate([begin, begin + wide])).reshape(2, -1)
        low, high = np.minimum(first, last), np.maximum(first, last)
        for place, height in zip(self.places, self.heights, strict=True):
            within = np.mod(place - begin, 2.0 * math.pi) <= wide
            low = np.where(within, np.minimum(low, height), low)
            high = np.where(within, np.maximum(high, height), high)
        return low, high

    def measure_spread(self, begin: Real, wide: float) -> Real:
        """Return the output's movement while the crank turns by ``wide`` from each place, shape (n,)."""
        low, high = self.find_bounds(begin, wide)
        return high - low

    def integrate_mean(self, begin: float, wide: float) -> float:
        """Return the output's mean while the crank turns by ``wide`` from a place."""
        nodes, weights = np.polynomial.legendre.leggauss(NODE_COUNT)
        middles = (np.arange(PANEL_COUNT) + 0.5)[:, None] / PANEL_COUNT
        values = self.evaluate(begin + wide * (middles + 0.5 * nodes / PANEL_COUNT).ravel())
        return float((values.reshape(PANEL_COUNT, NODE_COUNT) @ weights).mean()) / 2.0


def find_rests(
    turn: OutputCycle, wide: float, count: int, allowed: float, way: tuple[float, float]
) -> list[MeasuredRest]:
    """Find one rest of a turn, or one near each end of the output's range in the order in which they begin.

    Parameters
    ----------
    turn : OutputCycle
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
    list of MeasuredRest
        Empty if two rests are requested and there is none near one of the ends.
    """
    jitter, mean = _measure_windows(turn, wide)
    middle = 0.5 * (way[0] + way[1])
    found = [
        _measure_rest(turn, np.where(near, jitter, np.inf), wide, allowed, way)
        for near in (mean > middle, mean <= middle)
        if near.any()
    ]
    if count == 1:
        return [min(found, key=lambda rest: rest.jitter)]
    return sorted(found, key=lambda rest: rest.begin) if len(found) == 2 else []


def find_placed_rests(
    turn: OutputCycle, requested: Sequence[RequestedDwell], allowed: float, way: tuple[float, float]
) -> list[MeasuredRest]:
    """Find the rests of a turn nearest to given places of the range, in the order of the requests.

    Parameters
    ----------
    turn : OutputCycle
    requested : sequence of RequestedDwell
        The crank's rotation in each rest, degrees, and its place.
    allowed, way
        As for :func:`find_rests`.

    Returns
    -------
    list of MeasuredRest
        For each dwell the rest of minimum movement among those whose mean is within :data:`PLACE_TOLERANCE` of the
        requested place; if there is none, the rest whose mean is nearest to it.
    """
    low, high = way
    found = []
    for angle, place in requested:
        wide = math.radians(angle)
        jitter, mean = _measure_windows(turn, wide)
        share = (mean - low) / (high - low)
        off = np.minimum(share, 1.0 - share) if place is None else np.abs(share - place)
        # At least the nearest place always remains.
        near = off <= max(PLACE_TOLERANCE, float(off.min()))
        found.append(_measure_rest(turn, np.where(near, jitter, np.inf), wide, allowed, way))
    return found


def _measure_windows(turn: OutputCycle, wide: float) -> tuple[Real, Real]:
    """Return the output's movement and its mean in the interval that begins at each angle of the grid."""
    window = math.ceil(wide / turn.step - STEP_ROUNDING) + 1
    return _measure_ranges(turn.values, window), _average_windows(turn.values, window)


def _measure_rest(
    turn: OutputCycle, jitter: Real, wide: float, allowed: float, way: tuple[float, float]
) -> MeasuredRest:
    """Find the rest of minimum movement from the movements on the grid, and measure it."""
    low, high = way
    begin = _find_stillest(turn, jitter, wide)
    least, most = (float(end[0]) for end in turn.find_bounds(np.array([begin]), wide))
    at = turn.integrate_mean(begin, wide)
    off = min(high - at, at - low) / (high - low)
    width = _measure_width(turn, begin + 0.5 * wide, allowed)
    return MeasuredRest(begin, 0.5 * (least + most), most - least, width, off, (at - low) / (high - low))


def _find_stillest(turn: OutputCycle, jitter: Real, wide: float) -> float:
    """Find the crank angle at which the rest of minimum movement begins, from the movements on the grid.

    A rest at the grid's seam begins just before the seam.
    """
    best: list[int] = []
    count = len(jitter)
    # Neighbours of a chosen place lead to the same minimum.
    for k in np.argsort(jitter).tolist():
        if all(REFINEMENT_MARGIN < (k - other) % count < count - REFINEMENT_MARGIN for other in best):
            best.append(k)
        if len(best) == MAX_CANDIDATES or not math.isfinite(jitter[k]):
            break
    found = []
    for k in best:
        begins = turn.first + turn.step * (k + REFINEMENT_MARGIN * np.linspace(-1.0, 1.0, PLACE_COUNT))
        found.append(
            find_minimum_near(lambda begin: turn.measure_spread(begin, wide), begins, turn.measure_spread(begins, wide))
        )
    begin = min(found, key=lambda place: place[1])[0]
    beyond = begin - turn.first > 2.0 * math.pi - 2.0 * REFINEMENT_MARGIN * turn.step
    return begin - 2.0 * math.pi if beyond else begin


def _measure_ranges(values: Real, window: int) -> Real:
    """Return maximum minus minimum of the ``window`` values that start at each index, around the turn."""
    top, foot = (f(values, window, mode="wrap") for f in (maximum_filter1d, minimum_filter1d))
    return np.asarray(np.roll(top - foot, -(window // 2)))


def _average_windows(values: Real, window: int) -> Real:
    return np.asarray(np.roll(uniform_filter1d(values, window, mode="wrap"), -(window // 2)))


def _measure_width(turn: OutputCycle, middle: float, allowed: float) -> float:
    """Return the maximum rotation, radians, around a rest's middle over which the output moves no more than allowed."""
    count = len(turn.values)
    at = round((middle - turn.first) / turn.step)

    def list_starts(width: int) -> Real:
        return np.asarray(np.take(_measure_ranges(turn.values, width), np.arange(at - width + 1, at + 1), mode="wrap"))

    shortest, longest = 1, count
    # Bisect on the grid first: a wider window never moves less.
    while longest - shortest > 1:
        tried = (shortest + longest) // 2
        holds = list_starts(tried).min() <= allowed
        shortest, longest = (tried, longest) if holds else (shortest, tried)
    begin = turn.first + turn.step * (at - shortest + 1 + int(list_starts(shortest).argmin()))
    low = max((shortest - 1 - MAX_WIDTH_CHANGE) * turn.step, 0.0)
    high = min((shortest - 1 + MAX_WIDTH_CHANGE) * turn.step, 2.0 * math.pi)
    aside = 1.5 * MAX_WIDTH_CHANGE * turn.step * np.linspace(-1.0, 1.0, 2 * PLACE_COUNT - 1)
    # The root search evaluates the output many times; a local spline is as accurate and far faster.
    about = turn.interpolate_between(begin + 1.2 * aside[0], begin + high + 1.2 * aside[-1])

    def measure_excess(wide: float) -> float:
        begins = np.unique(np.clip(begin + aside, middle - wide, middle))
        spreads = about.measure_spread(begins, wide)
        if len(begins) == 1:
            return float(spreads[0]) - allowed
        return find_minimum_near(partial(about.measure_spread, wide=wide), begins, spreads)[1] - allowed

    # The movement never decreases with the width, so that the root is unique.
    if measure_excess(high) <= 0.0:
        return high
    return (
        float(brentq(measure_excess, low, high, xtol=WIDTH_TOLERANCE * turn.step)) if measure_excess(low) < 0.0 else low
    )
