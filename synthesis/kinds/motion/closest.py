"""Where a driven body comes nearest to demanded poses: a grid of inputs, refined without derivatives."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from synthesis.kinds.motion.demanded import HELD_WEIGHT, Complex, Demanded, Real

GRID = 720
"""Steps of the first grid: half a degree of a full turn."""

SAMPLES = 33
"""Inputs in each refinement, over the two steps around the best of the last: 16 times finer."""

REFINEMENTS = 10
"""Their number: 16¹⁰ times finer than the grid, 1e-14 radians."""

Motion = Callable[[Real], tuple[Complex, Real]]
"""P and the body's rotation from the first demanded pose, at inputs of shape (n, m); NaN where there is no position."""


def closest_inputs(motion: Motion, target: Demanded, low: float, high: float) -> tuple[Real, Real]:
    """The input at which the body is nearest to each demanded pose, between two inputs.

    Where coordinates of a pose are held these alone decide, once it is known which of several places is meant. Where
    all have a tolerance the nearest is the place at which the greatest share of a tolerance that is used is least.

    Returns
    -------
    inputs : float, shape (n,)
        NaN where the mechanism has no position at all in the range.
    misses : float, shape (n,)
        Deviations at these inputs in units of their limits (or the task's size): the root of the sum of squares, or the
        greatest where all have a tolerance.
    """
    n = len(target.points)
    held = target.held
    units = target.units
    tolerated = np.all(np.isfinite(target.limits) & ~held, axis=1)
    weights = np.where(held, HELD_WEIGHT, 1.0) / units
    alone = np.where(np.any(held, axis=1)[:, None], held / units, 1.0 / units)

    def missed_by(points: Complex, turns: Real, by: Real) -> Real:
        offsets = target.offsets(points, turns) * by[:, None, :]
        missed = np.where(
            tolerated[:, None], np.abs(offsets).max(axis=-1), np.sqrt(np.einsum("...c,...c->...", offsets, offsets))
        )
        return np.where(np.isfinite(missed), missed, np.inf)

    grid = np.linspace(low, high, GRID + 1)
    best = grid[missed_by(*motion(grid[None]), weights).argmin(axis=1)]
    rows = np.arange(n)
    step = (high - low) / GRID
    spread = np.linspace(-1.0, 1.0, SAMPLES)
    for _ in range(REFINEMENTS):
        inputs = np.clip(best[:, None] + step * spread, low, high)
        inputs[:, SAMPLES // 2] = best
        best = inputs[rows, missed_by(*motion(inputs), alone).argmin(axis=1)]
        step *= 2.0 / (SAMPLES - 1)
    missed = missed_by(*motion(best[:, None]), 1.0 / units)[:, 0]
    return np.where(np.isfinite(missed), best, np.nan), missed
