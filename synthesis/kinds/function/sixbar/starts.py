"""Starting sixbars, composed of generators that meet some points exactly.

Watt II: the function is split into two steps. The first is a random fourbar; the second is a fourbar through five
points of the remaining function (:func:`~synthesis.kinds.function.fourbar.precision_points.solve_many_exact`).
Stephenson III: for a random fourbar with coupler point C and a random pivot O6, the dyad C–D–O6 is the least-squares
solution of the equation

    |C − O6|² = 2 Re((C − O6) w̄ e^{−iψ}) + const,        w = |O6 D| e^{iψ₀},

which is linear in w and const. Stephenson II: all dimensions are random.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.function.fourbar.precision_points import solve_many_exact
from synthesis.kinds.function.fourbar.structural_error import Generators
from synthesis.kinds.function.fourbar.task import FunctionTask
from synthesis.kinds.function.sixbar import kernels

LOG_LENGTH_RANGE, WIDE_LOG_LENGTH_RANGE, WIDE_SHARE = 1.3, 2.1, 0.3
"""Half-width of the sampled logarithms of lengths, in ground lengths; the wider value, and the share of samples that
use it on request."""

DISTANCES_FROM_A, DISTANCES_FROM_MIDDLE = (0.15, 3.0), (0.1, 4.0)
"""Ranges of sampled distances for a Stephenson III, in sizes of the fourbar: C from A, and O6 from the midpoint of
O2 O4."""

DISTANCES_FROM_O2, DISTANCES_FROM_B = (0.15, 3.0), (0.15, 3.0)
"""Ranges of sampled distances for a Stephenson II: C from O2, in sizes of the fourbar, and E from B, in lengths of B D.
"""

MIN_SWING_RATIO, MAX_SWING = 0.15, math.radians(170.0)
"""Swing of a Watt II's rocker, the first step: minimum relative to the input's rotation, and maximum in radians."""

EXACT_POINT_COUNT = 5
"""Number of points that the second fourbar of a Watt II meets exactly."""


class Starts(NamedTuple):
    """Starting sixbars: rows (k, ROW_SIZE), and the assembly of each."""

    at: Real
    assemblies: NDArray[np.int64]


def sample_starts(
    kind: int,
    task: FunctionTask,
    inputs: Real,
    outputs: Real,
    count: int,
    rng: np.random.Generator,
    *,
    wider: bool = False,
) -> Starts:
    """Sample starting sixbars of a type, from ``count`` random ones.

    ``inputs``, ``outputs`` (m,): target points in order of the input; ``wider``: whether some first fourbars have a
    very short or very long ground.
    """
    at = np.zeros((count, kernels.ROW_SIZE))
    logs = rng.uniform(-LOG_LENGTH_RANGE, LOG_LENGTH_RANGE, (count, 3))
    if wider:
        # A share of samples with very short or long links, which some pairs need.
        logs[rng.random(count) < WIDE_SHARE] *= WIDE_LOG_LENGTH_RANGE / LOG_LENGTH_RANGE
    at[:, :3] = np.exp(logs)
    at[:, kernels.START] = rng.uniform(-math.pi, math.pi, count)
    for side, column in ((0, kernels.K), (1, kernels.L)):
        choices = task.scales[side]
        picked = rng.integers(len(choices), size=count)
        low, high = np.array(choices)[picked].T
        at[:, column] = low + (high - low) * rng.random(count)
    if kind == kernels.STEPHENSON_2:
        return _sample_stephenson_2(at, rng)
    signs = rng.choice([-1.0, 1.0], count)
    # With zero output the structural error is the rocker's angle itself.
    still = np.concatenate([at[:, :4], np.zeros((count, 1)), at[:, 5:6], np.zeros((count, 1))], axis=1)
    angles = Generators(False, inputs, outputs).errors(still, signs)
    # Fourbars that do not reach all inputs are useless as a first step.
    known = np.isfinite(angles).all(axis=1)
    at, signs, angles = at[known], signs[known], np.unwrap(angles[known], axis=1)
    if kind == kernels.WATT_2:
        swing = np.ptp(angles, axis=1)
        turned = np.abs(at[:, kernels.K]) * np.ptp(inputs)
        # The first step must turn enough to drive the second, and must not pass a toggle.
        kept = (swing > MIN_SWING_RATIO * turned) & (swing < MAX_SWING)
        return _compose_watt_2(task, at[kept], signs[kept], angles[kept], outputs, rng)
    return _compose_stephenson_3(at, signs, angles, inputs, outputs, rng)


def _encode_assemblies(first: Real, second: Real) -> NDArray[np.int64]:
    """Encode assemblies by the signs of both dyads; the dyad A B O4 is open if its sign is +1."""
    return np.asarray((first > 0.0) + 2 * (second > 0.0), np.int64)


def _compose_watt_2(
    task: FunctionTask, at: Real, signs: Real, angles: Real, outputs: Real, rng: np.random.Generator
) -> Starts:
    m, count = len(outputs), len(at)
    shifts = rng.uniform(-0.8, 0.8, (count, EXACT_POINT_COUNT))
    spaced = 0.5 - 0.5 * np.cos((2.0 * np.arange(EXACT_POINT_COUNT) + 1.0 + shifts) * math.pi
                                / (2.0 * EXACT_POINT_COUNT))  # fmt: skip
    columns = np.clip(np.round(spaced * (m - 1)), 0, m - 1).astype(np.int64)
    # Rounding to samples may merge two points.
    distinct = (np.diff(columns, axis=1) > 0).all(axis=1)
    at, signs, angles, columns = at[distinct], signs[distinct], angles[distinct], columns[distinct]
    turned = np.take_along_axis(angles, columns, axis=1) - angles[:, :1]
    wanted = at[:, kernels.L, None] * outputs[columns]
    found = solve_many_exact(task.closure, turned, wanted, (None, None))
    own = found[:, 5].astype(np.int64)
    rows = at[own]
    rows[:, kernels.ZERO] = found[:, 4]
    rows[:, 7:10] = found[:, :3]
    rows[:, 10] = found[:, 3] - angles[own, 0]
    ones = np.ones((len(rows), 1))
    second = np.concatenate([found[:, :5], ones, ones], axis=1)
    there = Generators(False, turned[own], wanted[own]).signs(second)
    # All signs equal: the second fourbar meets its points in one assembly.
    same = np.abs(there.sum(axis=1)) > EXACT_POINT_COUNT - 0.5
    return Starts(rows[same], _encode_assemblies(signs[own[same]], there[same, 0]))


def _compose_stephenson_3(
    at: Real, signs: Real, angles: Real, inputs: Real, outputs: Real, rng: np.random.Generator
) -> Starts:
    size = _measure_sizes(at)
    at[:, 7:9] = _sample_around(size, DISTANCES_FROM_A, rng)
    at[:, 9:11] = _sample_around(size, DISTANCES_FROM_MIDDLE, rng)
    # Around the midpoint of O2 and O4.
    at[:, 9] += 0.5
    theta = at[:, kernels.START, None] + at[:, kernels.K, None] * inputs
    pin = at[:, :1] * np.exp(1j * theta)
    unit = (1.0 + at[:, 2:3] * np.exp(1j * angles) - pin) / at[:, 1:2]
    away = pin + (at[:, 7] + 1j * at[:, 8])[:, None] * unit - (at[:, 9] + 1j * at[:, 10])[:, None]
    seen = away * np.exp(-1j * at[:, kernels.L, None] * outputs)
    # Solve |away|² = 2 Re(seen w̄) + const by least squares in Re w, Im w and const.
    table = np.stack([2.0 * seen.real, 2.0 * seen.imag, np.ones_like(seen.real)], axis=2)
    normal = np.einsum("kmi,kmj->kij", table, table)
    right = np.einsum("kmi,km->ki", table, np.abs(away) ** 2)
    # Drop starts whose least squares are numerically singular; their dyads would be arbitrary.
    sound = np.linalg.cond(normal) < 1e12
    at, signs, seen, normal, right = at[sound], signs[sound], seen[sound], normal[sound], right[sound]
    x = np.linalg.solve(normal, right[..., None])[..., 0]
    w = x[:, 0] + 1j * x[:, 1]
    square = x[:, 2] + np.abs(w) ** 2
    at[:, kernels.ZERO] = np.angle(w)
    at[:, 11], at[:, 12] = np.sqrt(np.maximum(square, 0.0)), np.abs(w)
    # D is left of C → O6 exactly if it is right of O6 → C, hence the sign below.
    sides = np.sign((w[:, None] * seen.conj()).imag)
    # Nine tenths on one side suffice for a start; the descent does the rest.
    closes = (square > 0.0) & (np.abs(w) > 0.0) & (np.abs(sides.sum(axis=1)) > 0.9 * seen.shape[1])
    return Starts(at[closes], _encode_assemblies(signs[closes], -sides[closes].sum(axis=1)))


def _sample_stephenson_2(at: Real, rng: np.random.Generator) -> Starts:
    count = len(at)
    size = _measure_sizes(at)
    at[:, kernels.ZERO] = rng.uniform(-math.pi, math.pi, count)
    at[:, 7:9] = _sample_around(size, DISTANCES_FROM_O2, rng)
    at[:, 9:11] = size[:, None] * np.exp(rng.uniform(-1.0, 1.0, (count, 2)))
    at[:, 11:13] = _sample_around(at[:, 9], DISTANCES_FROM_B, rng)
    at[:, 13] = rng.uniform(-math.pi, math.pi, count)
    return Starts(at, rng.integers(4, size=count))


def _measure_sizes(at: Real) -> Real:
    """Return the geometric means of the links of fourbars, including the ground."""
    return np.asarray(np.exp(0.25 * np.log(at[:, :3]).sum(axis=1)))


def _sample_around(size: Real, ends: tuple[float, float], rng: np.random.Generator) -> Real:
    """Sample points in random directions at log-uniform distances, between shares of a size: (n, 2)."""
    away = size * np.exp(rng.uniform(math.log(ends[0]), math.log(ends[1]), len(size)))
    angle = rng.uniform(-math.pi, math.pi, len(size))
    return np.asarray((away * np.array([np.cos(angle), np.sin(angle)])).T)
