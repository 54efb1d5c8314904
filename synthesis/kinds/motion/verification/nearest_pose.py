"""Inputs at which a driven body is nearest to the target poses: a grid search, refined without derivatives."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.task.target_poses import EXACT_WEIGHT, TargetPoses

GRID_STEP_COUNT = 720
"""Number of steps of the first grid: half a degree each for a full turn."""

SAMPLE_COUNT = 33
"""Number of inputs in each refinement, over two steps around the previous best one: 16 times finer."""

REFINEMENT_COUNT = 10
"""Number of refinements: 16¹⁰ times finer than the grid, that is, 1e-14 radians."""

MISS_TOLERANCE = 1e-10
"""Tolerance for equal misses, in units of the tolerances or the task's size; it covers rounding."""

Motion = Callable[[Real], tuple[Complex, Real]]
"""Map from inputs of shape (n, m) to P and the body's rotation from the first target pose; NaN if not assembled."""


def find_closest_inputs(motion: Motion, target: TargetPoses, low: float, high: float) -> tuple[Real, Real]:
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
    held = target.exact_mask
    units = target.units
    weights = np.where(held, EXACT_WEIGHT, 1.0) / units
    alone = _select_weights(target)

    def measure_miss(points: Complex, turns: Real, by: Real) -> Real:
        return measure_misses(target, target.offsets(points, turns) * by[:, None, :])

    # The grid uses all coordinates, to choose among several minima.
    grid = np.linspace(low, high, GRID_STEP_COUNT + 1)
    best = grid[measure_miss(*motion(grid[None]), weights).argmin(axis=1)]
    rows = np.arange(n)
    step = (high - low) / GRID_STEP_COUNT
    spread = np.linspace(-1.0, 1.0, SAMPLE_COUNT)
    for _ in range(REFINEMENT_COUNT):
        # Clip to the branch, beyond which the linkage does not close.
        inputs = np.clip(best[:, None] + step * spread, low, high)
        # Keep the best input itself among the samples, so that a refinement never gets worse.
        inputs[:, SAMPLE_COUNT // 2] = best
        best = inputs[rows, measure_miss(*motion(inputs), alone).argmin(axis=1)]
        step *= 2.0 / (SAMPLE_COUNT - 1)
    misses = measure_miss(*motion(best[:, None]), 1.0 / units)[:, 0]
    return np.where(np.isfinite(misses), best, np.nan), misses


def is_as_near(motion: Motion, target: TargetPoses, k: int, one: float, other: float) -> bool:
    """Return whether the body is as near to target ``k`` at one input as at another, by the deciding coordinates.

    It must also be within its tolerances, unless it is outside them at the other input too.
    """
    offsets = target.offsets(*motion(np.tile([one, other], (len(target.points), 1))))
    here, there = measure_misses(target, offsets * _select_weights(target)[:, None, :])[k]
    within, instead = measure_misses(target, offsets / target.units[:, None, :])[k]
    return bool(here <= there + MISS_TOLERANCE and within <= max(1.0, instead + MISS_TOLERANCE))


def _select_weights(target: TargetPoses) -> Real:
    """Return the weights that decide between neighbouring inputs, shape (n, 3): exact coordinates only, if any."""
    held, units = target.exact_mask, target.units
    return np.asarray(np.where(np.any(held, axis=1)[:, None], held / units, 1.0 / units))


def measure_misses(target: TargetPoses, shares: Real) -> Real:
    """Return the distances of poses from their targets, given their scaled deviations.

    ``shares`` has shape (n, ..., 3). The distance is infinite if there is no pose.
    """
    tolerated = np.all(np.isfinite(target.limits) & ~target.exact_mask, axis=1)
    greatest, root = np.abs(shares).max(axis=-1), np.sqrt(np.einsum("...c,...c->...", shares, shares))
    missed = np.where(tolerated.reshape(-1, *[1] * (shares.ndim - 2)), greatest, root)
    return np.asarray(np.where(np.isfinite(missed), missed, np.inf))
