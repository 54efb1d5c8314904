"""Inputs at which a driven body is nearest to the target poses: a grid search, refined without derivatives."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from synthesis.kinds.motion.demanded import HELD_WEIGHT, Complex, Demanded, Real

GRID = 720
"""Number of steps of the first grid: half a degree each for a full turn."""

SAMPLES = 33
"""Number of inputs in each refinement, over two steps around the previous best one: 16 times finer."""

REFINEMENTS = 10
"""Number of refinements: 16¹⁰ times finer than the grid, that is, 1e-14 radians."""

SAME_MISS = 1e-10
"""Tolerance for equal misses, in units of the tolerances or the task's size; it covers rounding."""

Motion = Callable[[Real], tuple[Complex, Real]]
"""Map from inputs of shape (n, m) to P and the body's rotation from the first target pose; NaN if not assembled."""


def closest_inputs(motion: Motion, target: Demanded, low: float, high: float) -> tuple[Real, Real]:
    """Find the input at which the body is nearest to each target pose, between two inputs.

    If a pose has exact coordinates, these alone decide the refinement, after the first grid has selected one of several
    minima. If all coordinates have a tolerance, the nearest input minimises the largest deviation relative to its
    tolerance.

    Returns
    -------
    inputs : float, shape (n,)
        NaN if the mechanism has no position in the range.
    misses : float, shape (n,)
        Deviations at these inputs in units of their tolerances (or the task's size): the root of the sum of squares, or
        the maximum if all coordinates have a tolerance.
    """
    n = len(target.points)
    held = target.held
    units = target.units
    weights = np.where(held, HELD_WEIGHT, 1.0) / units
    alone = _deciding(target)

    def missed(points: Complex, turns: Real, by: Real) -> Real:
        return missed_by(target, target.offsets(points, turns) * by[:, None, :])

    grid = np.linspace(low, high, GRID + 1)
    best = grid[missed(*motion(grid[None]), weights).argmin(axis=1)]
    rows = np.arange(n)
    step = (high - low) / GRID
    spread = np.linspace(-1.0, 1.0, SAMPLES)
    for _ in range(REFINEMENTS):
        inputs = np.clip(best[:, None] + step * spread, low, high)
        inputs[:, SAMPLES // 2] = best
        best = inputs[rows, missed(*motion(inputs), alone).argmin(axis=1)]
        step *= 2.0 / (SAMPLES - 1)
    misses = missed(*motion(best[:, None]), 1.0 / units)[:, 0]
    return np.where(np.isfinite(misses), best, np.nan), misses


def as_near(motion: Motion, target: Demanded, k: int, one: float, other: float) -> bool:
    """Return whether the body is as near to target ``k`` at one input as at another, by the deciding coordinates.

    It must also be within its tolerances, unless it is outside them at the other input too.
    """
    offsets = target.offsets(*motion(np.tile([one, other], (len(target.points), 1))))
    here, there = missed_by(target, offsets * _deciding(target)[:, None, :])[k]
    within, instead = missed_by(target, offsets / target.units[:, None, :])[k]
    return bool(here <= there + SAME_MISS and within <= max(1.0, instead + SAME_MISS))


def _deciding(target: Demanded) -> Real:
    """Return the weights that decide between neighbouring inputs, shape (n, 3): exact coordinates only, if any."""
    held, units = target.held, target.units
    return np.asarray(np.where(np.any(held, axis=1)[:, None], held / units, 1.0 / units))


def missed_by(target: Demanded, shares: Real) -> Real:
    """Return the distances of poses from their targets, given their scaled deviations.

    ``shares`` has shape (n, ..., 3). The distance is infinite if there is no pose.
    """
    tolerated = np.all(np.isfinite(target.limits) & ~target.held, axis=1)
    greatest, root = np.abs(shares).max(axis=-1), np.sqrt(np.einsum("...c,...c->...", shares, shares))
    missed = np.where(tolerated.reshape(-1, *[1] * (shares.ndim - 2)), greatest, root)
    return np.asarray(np.where(np.isfinite(missed), missed, np.inf))
