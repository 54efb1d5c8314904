"""Extremes of quantities of a driven mechanism, found on a grid and then refined without derivatives."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import Mechanism

Quantity = Callable[[MechanismMotion], Real]

GRID_SIZE = 1441
"""Number of inputs of the first grid: a quarter of a degree over a full turn."""

SAMPLE_COUNT, REFINEMENT_COUNT = 17, 6
"""Number of inputs in each refinement around a local minimum, and number of refinements. Each divides the step by 8, so
that the last step is 8⁶ times finer than the grid."""

MAX_VALLEYS = 8
"""Maximum number of local minima to refine: an error with equal extremes has several minima of nearly equal depth."""


def find_minimum_near(of: Callable[[Real], Real], inputs: Real, values: Real) -> tuple[float, float]:
    """Find the minimum of a quantity by successively finer grids around the lowest points of a given grid.

    Parameters
    ----------
    of : callable
        Returns the quantity, shape (n,), at inputs of shape (n,). It is not finite where the mechanism cannot be
        assembled (by rounding also at a toggle) or the quantity has no value.
    inputs, values : ndarray, shape (m,), m >= 2
        The grid of inputs, increasing or decreasing, in the unit of the input (radians or a length), and the quantity
        there. The ends of the grid limit the search.

    Returns
    -------
    tuple of float
        The input at which the minimum occurs, and the minimum; both are NaN if the grid has no finite value.
    """
    if not np.isfinite(values).any():
        return math.nan, math.nan
    # Infinity sorts behind all values, so inputs without a value are never minima.
    known = np.where(np.isfinite(values), values, np.inf)
    n = int(np.argmin(known))
    best = float(inputs[n]), float(known[n])
    # The grid point itself stays a candidate: refinement may find only NaN around a toggle.
    for at, least in zip(*_refine_minimum(of, inputs, _find_valleys(known)), strict=True):
        if least < best[1]:
            best = float(at), float(least)
    return best


def _find_valleys(values: Real) -> NDArray[np.int64]:
    """Return the grid points near which the minimum may lie, lowest first.

    Near a local minimum of the grid, a smooth quantity falls below it by less than the rise to the higher neighbour. So
    a point is kept only if its value minus this rise is at most the minimum of the grid.
    """
    # The missing neighbour of an end counts as equal to the end.
    left, right = np.append(values[:1], values[:-1]), np.append(values[1:], values[-1:])
    known = np.isfinite(values)
    # Replace infinities before subtracting, because ∞ − ∞ is NaN.
    rise = np.where(known, np.maximum(left, right), 0.0) - np.where(known, values, 0.0)
    low = np.flatnonzero(known & (values <= left) & (values <= right) & (values - rise <= values.min()))
    return low[np.argsort(values[low], kind="stable")][:MAX_VALLEYS]


def _refine_minimum(of: Callable[[Real], Real], inputs: Real, places: NDArray[np.int64]) -> tuple[Real, Real]:
    """Refine the minima around several grid points at once; return inputs and values, infinite if none is finite."""
    at, place, least = inputs[places], np.full(len(places), np.nan), np.full(len(places), np.inf)
    gaps = np.abs(np.diff(inputs))
    # The half-width of the first refinement is the larger neighbouring gap, so that uneven grids are covered.
    step = np.maximum(gaps[np.maximum(places - 1, 0)], gaps[np.minimum(places, len(gaps) - 1)])
    low, high = sorted((inputs[0], inputs[-1]))
    row = np.arange(len(places))
    for _ in range(REFINEMENT_COUNT):
        # Inputs outside the given range do not belong to the motion.
        closer = np.clip(np.linspace(at - step, at + step, SAMPLE_COUNT, axis=1), low, high)
        refined = np.asarray(of(closer.ravel())).reshape(closer.shape)
        # A quantity without a value never wins the minimum.
        refined = np.where(np.isfinite(refined), refined, np.inf)
        k = refined.argmin(axis=1)
        tried = refined[row, k]
        # Move the centre only to an input with a finite value.
        at = np.where(np.isfinite(tried), closer[row, k], at)
        nearer = tried < least
        place, least = np.where(nearer, at, place), np.where(nearer, tried, least)
        # The next grid spans the two neighbours of the best point.
        step = step * (2.0 / (SAMPLE_COUNT - 1))
    return place, least


def find_minimum(mechanism: Mechanism, inputs: Real, values: Real, of: Quantity) -> float:
    """Find the minimum of a quantity of a mechanism between the first and the last input of a grid.

    ``values`` are those of the quantity ``of`` at ``inputs``.
    """
    return find_minimum_near(lambda closer: of(drive(mechanism, closer, order=1)), inputs, values)[1]


def find_extremes(mechanism: Mechanism, inputs: Real, values: Real, of: Quantity) -> tuple[float, float]:
    """Find the minimum and the maximum of a quantity; parameters are those of :func:`find_minimum`."""
    least = find_minimum(mechanism, inputs, values, of)
    # The maximum is the minimum of the negative.
    return least, -find_minimum(mechanism, inputs, -values, lambda motion: -of(motion))


def find_min_transmission_angles(
    at: Callable[[Real], MechanismMotion], inputs: Real, motion: MechanismMotion | None = None
) -> dict[str, float]:
    """Find the minimum transmission angle at each closure between the first and the last input.

    It is 0 if the closure cannot be assembled at any input, or if it cannot be somewhere between the grid points.

    Parameters
    ----------
    at : callable
        Drives the mechanism to inputs of shape (n,).
    inputs : ndarray, shape (m,), m >= 2
        Grid of inputs; :data:`GRID_SIZE` inputs suffice for a turn.
    motion : MechanismMotion, optional
        The motion at these inputs, if the caller already has it.

    Returns
    -------
    dict of str to float
        Angles in radians, by the name of the closure's first link or of a triad's leg.
    """
    angles = {}
    for link, sines in (at(inputs) if motion is None else motion).sines.items():

        def evaluate_sine(closer: Real, link: str = link) -> Real:
            there = at(closer)
            # Beyond its limit a closure has no sine, and at the limit the sine is 0. A triad has no margin of its own.
            beyond = there.margins[link][0] < 0.0 if link in there.margins else ~there.valid
            return np.where(beyond, 0.0, np.abs(there.sines[link]))

        _, least = find_minimum_near(evaluate_sine, inputs, np.abs(sines))
        # Rounding may give a sine slightly above 1.
        angles[link] = 0.0 if math.isnan(least) else math.asin(min(least, 1.0))
    return angles


def list_full_turn(start: float) -> Real:
    """Return the grid of inputs of a whole turn, radians."""
    return np.asarray(start + np.linspace(0.0, 2.0 * np.pi, GRID_SIZE))
