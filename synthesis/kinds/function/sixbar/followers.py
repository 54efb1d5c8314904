"""Adapters that present sixbar function generators and their limits to the general descents."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.function.fourbar.constraints import LIMIT_MARGIN, GeneratorLimits
from synthesis.kinds.function.fourbar.structural_error import PARAMETER_COUNT
from synthesis.kinds.function.fourbar.task import FunctionTask
from synthesis.kinds.function.sixbar import kernels
from synthesis.kinds.function.sixbar.kernels import IS_LOGARITHMIC, ROW_SIZE, STEPHENSON_2, WATT_2
from synthesis.kinds.function.sixbar.link_lengths import MAX_LENGTHS, compute_log_lengths

ANGLE_MARGIN = math.radians(0.02)
"""Margin, radians, added to a required transmission angle at the samples, because it is smaller between them."""

ACTIVE_MARGIN = 0.25
"""Distance of a transmission cosine below its limit from which it is left out of a linear program as inactive."""

INFEASIBLE_VALUE = 1e3
"""Constraint violation assigned to a sixbar that cannot be assembled."""


class FollowedSixbar(NamedTuple):
    """Kernel output for one sixbar; see :func:`~synthesis.kinds.function.sixbar.kernels.follow`."""

    tau: float
    errors: Real
    slopes: Real
    cosines: Real
    by_cosine: Real


def follow_sixbar(
    kind: int, assembly: int, at: Real, inputs: Real, outputs: Real, felt: float = math.inf
) -> FollowedSixbar:
    """Follow a sixbar through inputs with the compiled kernel."""
    m = len(inputs)
    filled = np.empty(m), np.zeros((m, ROW_SIZE)), np.zeros((m, 2)), np.zeros((m, 2, ROW_SIZE))
    return FollowedSixbar(kernels.follow(kind, assembly, at, inputs, outputs, felt, *filled), *filled)


class SixbarFollower:
    """Sixbars of one type in one assembly, evaluated at common, monotonic inputs."""

    def __init__(self, kind: int, assembly: int, inputs: Real, outputs: Real) -> None:
        self.kind, self.assembly, self.inputs, self.outputs = kind, assembly, inputs, outputs

    def some(self, rows: NDArray[np.int64]) -> SixbarFollower:
        """Return the sixbars at selected inputs, including the first."""
        return SixbarFollower(self.kind, self.assembly, self.inputs[rows], self.outputs[rows])

    def errors(self, dimensions: Real, _signs: Real) -> Real:
        """Return errors of sixbars (k, ROW_SIZE): shape (k, inputs), NaN if not assembled."""
        return np.array(
            [follow_sixbar(self.kind, self.assembly, at, self.inputs, self.outputs).errors for at in dimensions]
        )

    def derivatives(self, dimensions: Real, _errors: Real, _sign: float) -> Real:
        """Return derivatives of one sixbar's errors by its steps: shape (inputs, ROW_SIZE)."""
        return follow_sixbar(self.kind, self.assembly, dimensions, self.inputs, self.outputs).slopes

    def apply_step(self, dimensions: Real, step: Real) -> Real:
        """Apply a step to a sixbar, and update the τ of a Stephenson II."""
        found = dimensions.copy()
        logs = IS_LOGARITHMIC[self.kind]
        found[logs] *= np.exp(step[logs])
        # Logarithmic numbers step by factors, so that lengths stay positive.
        found[~logs] += step[~logs]
        # τ follows the dimensions; without it the next evaluation would start far from its solution.
        if self.kind == STEPHENSON_2:
            tau = follow_sixbar(self.kind, self.assembly, found, self.inputs[:1], self.outputs[:1]).tau
            found[-1] = tau if math.isfinite(tau) else found[-1]
        return found


class SixbarLimits:
    """Inequalities g ≤ 0 of sixbars of one type in one assembly.

    Parameters
    ----------
    task : FunctionTask
        The task.
    kind, assembly : int
    inputs : float, shape (m,)
        Monotonic inputs at which transmission angles are constrained.
    least : float
        Minimum transmission angle, degrees.
    every : bool
        Whether inactive transmission angles are rows too, which keeps the number of rows constant.
    """

    def __init__(
        self, task: FunctionTask, kind: int, assembly: int, inputs: Real, least: float, *, every: bool = False
    ) -> None:
        # Regions depend on the placement, which is chosen later; the required angle includes the margin.
        free = {"fixed_pivot_region": None, "moving_pivot_region": None, "min_transmission_angle": least}
        constraints = task.problem.constraints.model_copy(update=free)
        alone = task.problem.model_copy(update={"constraints": constraints, "fixed_pivots": None})
        self.fourbar = GeneratorLimits(task._replace(problem=alone))
        self.kind, self.assembly, self.inputs = kind, assembly, inputs
        self.cosine = compute_max_cosine(least)
        self.logratio = math.log(self.fourbar.ratio)
        self.felt = 0.0 if every else self.cosine - ACTIVE_MARGIN
        self._rows = 1

    def choose_placement(self, generator: Real) -> Real:
        """Return the sixbar unchanged: its placement is chosen after the search."""
        return generator

    def values(self, generator: Real, *, derivatives: bool = False) -> tuple[Real, Real]:
        """Return g and, on request, its derivatives by the steps: shapes (m,) and (m, ROW_SIZE)."""
        felt = self.felt if derivatives else math.inf
        there = follow_sixbar(self.kind, self.assembly, generator, self.inputs, np.zeros_like(self.inputs), felt)
        if not math.isfinite(there.tau):
            # Clearly infeasible, with the usual number of rows.
            return np.full(self._rows, INFEASIBLE_VALUE), np.zeros((self._rows, ROW_SIZE))
        parts = [self._evaluate_ratios(generator)]
        # A Stephenson II contains no fourbar on the ground.
        if self.kind != STEPHENSON_2:
            g, slopes = self.fourbar.values(generator[:PARAMETER_COUNT], derivatives=derivatives)
            parts.append((g, np.pad(slopes, ((0, 0), (0, ROW_SIZE - PARAMETER_COUNT)))))
        cosines, by_cosine = there.cosines[:, 1], there.by_cosine[:, 1]
        near = np.abs(cosines) >= self.felt
        side = np.sign(cosines[near])
        # One row for the magnitude: the derivative takes the sign of the cosine.
        parts.append((np.abs(cosines[near]) - self.cosine, side[:, None] * by_cosine[near]))
        self._rows = sum(len(g) for g, _ in parts)
        return np.concatenate([g for g, _ in parts]), np.concatenate([slopes for _, slopes in parts])

    def _evaluate_ratios(self, at: Real) -> tuple[Real, Real]:
        """Return the rows of all length ratios; for a Watt II those of the second fourbar only."""
        logs, by = np.empty(MAX_LENGTHS), np.empty((MAX_LENGTHS, ROW_SIZE))
        count = compute_log_lengths(self.kind, at, logs, by)
        own = slice(count // 2 if self.kind == WATT_2 else 0, count)
        logs, by = logs[own], by[own]
        # All ordered pairs: their differences are smooth, unlike the ratio of longest to shortest.
        one, other = np.nonzero(~np.eye(len(logs), dtype=np.bool_))
        return logs[one] - logs[other] - self.logratio, by[one] - by[other]


def compute_max_cosine(least: float) -> float:
    """Return the maximum cosine for a minimum transmission angle, degrees, including the margin."""
    return math.cos(math.radians(least) + ANGLE_MARGIN) - LIMIT_MARGIN
