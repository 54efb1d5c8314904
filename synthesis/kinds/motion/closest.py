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

SAME_MISS = 1e-10
"""Misses, in units of the limits or the task's size, that differ by less are equal: what rounding leaves."""

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
    """Whether the body is as near to target ``k`` at one input as at another, to rounding and by what decides there.

    It is to be within its tolerances too, unless it is not at the other either.
    """
    offsets = target.offsets(*motion(np.tile([one, other], (len(target.points), 1))))
    here, there = missed_by(target, offsets * _deciding(target)[:, None, :])[k]
    within, instead = missed_by(target, offsets / target.units[:, None, :])[k]
    return bool(here <= there + SAME_MISS and within <= max(1.0, instead + SAME_MISS))


def _deciding(target: Demanded) -> Real:
    """Weights of what decides between places that are near to one another, shape (n, 3): what is held, if anything."""
    held, units = target.held, target.units
    return np.asarray(np.where(np.any(held, axis=1)[:, None], held / units, 1.0 / units))


def missed_by(target: Demanded, shares: Real) -> Real:
    """How far poses are from the demanded ones, by their deviations in units of what each is measured by.

    ``shares`` has the shape (n, ..., 3). Infinite where there is no pose.
    """
    tolerated = np.all(np.isfinite(target.limits) & ~target.held, axis=1)
    greatest, root = np.abs(shares).max(axis=-1), np.sqrt(np.einsum("...c,...c->...", shares, shares))
    missed = np.where(tolerated.reshape(-1, *[1] * (shares.ndim - 2)), greatest, root)
    return np.asarray(np.where(np.isfinite(missed), missed, np.inf))
