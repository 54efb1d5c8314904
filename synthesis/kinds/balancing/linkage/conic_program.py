"""The conic program for the best counterweights at selected positions of the motion.

The variables, in units of the linkage's mass and size, are the mass μ, first moment s and inertia J of each weight, and
the level t that each counted quantity reaches. The set of feasible weights is convex:

    J ≥ |s|²/μ + μ²/(2πρt)    a disc of density ρ and thickness t; with more inertia, a ring of the same mass,
    |s| ≤ R μ                 its centre within reach,

two rotated second-order cones and an ordinary one. Every objective is convex too: a maximum magnitude over positions,
or a root mean square. The dual value of the program is a lower bound for all weights, because further positions can
only raise it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.balancing.linkage.effects import PARAMETER_COUNT, LinearQuantity
from synthesis.numerics.conic import ConeRows, Solution, solve_conic_program


@dataclass(frozen=True)
class Level:
    """A counted quantity: its values relative to the unbalanced one, its weight in the cost, and its cap.

    ``mean`` selects the root mean square instead of the maximum magnitude.
    """

    name: str
    values: Sequence[LinearQuantity]
    weight: float
    cap: float | None
    mean: bool = False

    def evaluate_positions(self, parameters: Real) -> Real:
        """Return the level at each position, shape (..., N); for a mean it is the same at all positions."""
        reached = np.stack([np.abs(part.evaluate(parameters)) for part in self.values])
        if self.mean:
            return np.asarray(np.sqrt((reached**2).mean(axis=-1, keepdims=True)).max(axis=0))
        return np.asarray(reached.max(axis=0))

    def evaluate_level(self, parameters: Real) -> Real:
        """Return the level, shape (...)."""
        return np.asarray(self.evaluate_positions(parameters).max(axis=-1))


class Limits(NamedTuple):
    """Limits of each weight: maximum mass, reach, 2πρt (infinite for a point mass), and radius of gyration.

    ``total`` is the maximum total mass. ``turning`` marks the weights whose inertia counts, ``carried`` those whose
    mass counts.
    """

    mass: Real
    reach: Real
    disc: Real
    gyration: Real
    total: float
    turning: NDArray[np.bool_]
    carried: NDArray[np.bool_]

    def has_inertia(self, n: int) -> bool:
        """Return whether the inertia of weight n counts or is limited."""
        return bool(self.turning[n]) or math.isfinite(self.gyration[n])


class Answer(NamedTuple):
    """Parameters of all weights, the levels by quantity, and the solution of the program."""

    parameters: Real
    levels: Real
    solution: Solution
    excess: float


def find_best_weights(
    levels: Sequence[Level], limits: Limits, at: Mapping[str, Sequence[int]], *, relaxed: bool
) -> Answer:
    """Find the best weights for the positions ``at`` of each quantity.

    With ``relaxed``, all caps may be exceeded by a common share, and the program minimizes that share instead.
    """
    links = len(limits.mass)
    count = PARAMETER_COUNT * links
    discs = [n for n in range(links) if limits.has_inertia(n) and np.isfinite(limits.disc[n])]
    total = count + len(levels) + len(discs) + 1
    excess = total - 1
    rows = [
        *_build_size_rows(limits, total),
        *_build_inertia_rows(limits, total, {n: count + len(levels) + k for k, n in enumerate(discs)}),
    ]
    for k, level in enumerate(levels):
        column = count + k
        if level.mean:
            rows += [_build_mean_rows(part, total, column) for part in level.values]
        else:
            rows += _build_peak_rows(level, total, column, at[level.name])
        if level.cap is not None:
            matrix = np.zeros((1, total))
            matrix[0, column] = 1.0
            matrix[0, excess] = -level.cap
            rows.append(ConeRows("nonnegative", matrix, np.array([level.cap])))
    cost = np.zeros(total)
    ends = np.zeros((1, total))
    ends[0, excess] = -1.0
    if relaxed:
        cost[excess] = 1.0
        rows.append(ConeRows("nonnegative", ends, np.zeros(1)))
    else:
        cost[count : count + len(levels)] = [level.weight for level in levels]
        rows.append(ConeRows("zero", ends, np.zeros(1)))
    solution = solve_conic_program(cost, rows)
    x = solution.x
    return Answer(x[:count], x[count : count + len(levels)], solution, float(x[excess]))


def _build_size_rows(limits: Limits, total: int) -> list[ConeRows]:
    """Build the constraint rows that keep masses within their bounds and centres within reach."""
    links = len(limits.mass)
    bounds, offsets = [], []
    for n in range(links):
        for sign, bound in ((-1.0, 0.0), (1.0, float(limits.mass[n]))):
            if math.isfinite(bound):
                row = np.zeros(total)
                row[PARAMETER_COUNT * n] = sign
                bounds.append(row)
                offsets.append(bound)
    if math.isfinite(limits.total):
        row = np.zeros(total)
        row[0 : PARAMETER_COUNT * links : PARAMETER_COUNT] = 1.0
        bounds.append(row)
        offsets.append(limits.total)
    reach = np.zeros((3 * links, total))
    for n in range(links):
        reach[3 * n, PARAMETER_COUNT * n] = -limits.reach[n]
        reach[3 * n + 1, PARAMETER_COUNT * n + 1] = reach[3 * n + 2, PARAMETER_COUNT * n + 2] = -1.0
    return [
        ConeRows("nonnegative", np.array(bounds), np.array(offsets)),
        ConeRows("second_order", reach, np.zeros(3 * links), 3),
    ]


def _build_inertia_rows(limits: Limits, total: int, own: Mapping[int, int]) -> list[ConeRows]:
    """Build J − j ≥ |s|²/μ and j ≥ μ²/(2πρt), with j the disc's own inertia in columns ``own``.

    A weight whose inertia does not count gets J = 0.
    """
    rows = []
    for n in range(len(limits.mass)):
        mass, inertia = PARAMETER_COUNT * n, PARAMETER_COUNT * n + 3
        if not limits.has_inertia(n):
            matrix = np.zeros((1, total))
            matrix[0, inertia] = 1.0
            rows.append(ConeRows("zero", matrix, np.zeros(1)))
            continue
        if math.isfinite(limits.gyration[n]):
            matrix = np.zeros((1, total))
            matrix[0, mass], matrix[0, inertia] = -(limits.gyration[n] ** 2), 1.0
            rows.append(ConeRows("nonnegative", matrix, np.zeros(1)))
        # |2 s|² + (J − j − μ)² ≤ (J − j + μ)²
        cone = np.zeros((4, total))
        cone[0, [inertia, mass]] = -1.0
        cone[1, mass + 1] = cone[2, mass + 2] = -2.0
        cone[3, inertia], cone[3, mass] = -1.0, 1.0
        if n in own:
            # (j c + 1)² ≥ (j c − 1)² + 4 μ² with c = 2πρt, which is j ≥ μ²/c.
            cone[0, own[n]] = cone[3, own[n]] = 1.0
            disc = np.zeros((3, total))
            disc[0, own[n]] = disc[2, own[n]] = -limits.disc[n]
            disc[1, mass] = -2.0
            rows.append(ConeRows("second_order", disc, np.array([1.0, 0.0, -1.0]), 3))
        rows.append(ConeRows("second_order", cone, np.zeros(4), 4))
    return rows


def _build_peak_rows(level: Level, total: int, column: int, at: Sequence[int]) -> list[ConeRows]:
    """Build |q| ≤ t at the given positions: cones for a force, pairs of inequalities for a real quantity."""
    rows = []
    listed = list(at)
    for part in level.values:
        fixed, by = np.take(part.fixed, listed), np.take(part.by, listed, axis=1)
        if np.any(part.by.imag) or np.any(part.fixed.imag):
            matrix = np.zeros((3 * len(listed), total))
            offset = np.zeros(3 * len(listed))
            matrix[0::3, column] = -1.0
            matrix[1::3, : len(by)], offset[1::3] = -by.real.T, fixed.real
            matrix[2::3, : len(by)], offset[2::3] = -by.imag.T, fixed.imag
            rows.append(ConeRows("second_order", matrix, offset, 3))
        else:
            matrix = np.zeros((2 * len(listed), total))
            matrix[:, column] = -1.0
            matrix[: len(listed), : len(by)], matrix[len(listed) :, : len(by)] = by.real.T, -by.real.T
            rows.append(ConeRows("nonnegative", matrix, np.concatenate([-fixed.real, fixed.real])))
    return rows


def _build_mean_rows(part: LinearQuantity, total: int, column: int) -> ConeRows:
    """Build the root mean square ≤ t as one cone, from the triangular factor of the rows of all positions."""
    count = len(part.fixed)
    stacked = np.concatenate([part.by, part.fixed[None]]).T
    # The factor R has the same norm as the stacked rows: 2N rows shrink to K + 1.
    triangle = np.asarray(np.linalg.qr(np.concatenate([stacked.real, stacked.imag]) / math.sqrt(count), mode="r"))
    matrix = np.zeros((1 + len(triangle), total))
    matrix[0, column] = -1.0
    matrix[1:, : len(part.by)] = -triangle[:, :-1]
    return ConeRows("second_order", matrix, np.concatenate([[0.0], triangle[:, -1]]), 1 + len(triangle))
