"""Optimisation of a sixbar by the criterion of the task.

Adapters to :mod:`~synthesis.kinds.function.fourbar.minimax_descent`.

A generator is the vector (z, k, l) of the sixbar's unknowns and scales. Steps add to z and to the logarithms of the
scales. Coordinates that only place the linkage are held.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers, Mask, Real
from synthesis.fit.linkage.topology import Topology
from synthesis.kinds.function.fourbar.constraints import GeneratorLimits
from synthesis.kinds.function.fourbar.minimax_descent import Descent
from synthesis.kinds.function.fourbar.structural_error import PARAMETER_COUNT
from synthesis.kinds.function.fourbar.task import FunctionTask
from synthesis.kinds.function.sixbar.fits import SixbarCandidate, evaluate_errors, evaluate_margins

CONVERGED_ERROR = 5e-9
"""Maximum error, radians, that counts as zero: 0.3 millionths of a degree. No further improvement is useful."""

MAX_ROUNDS, MAX_LAST_ROUNDS, MAX_SQUARE_ROUNDS = 25, 300, 15
"""Maximum numbers of linear programs for each sixbar and for the best two, and a third of that of quadratic programs
for least squares."""

LIMIT_STEPS = 49
"""Number of equal steps of the input at which the constraints are limits."""

ACTIVE_MARGIN = 0.25
"""Margin above which a limit is left out of a linear program as inactive."""

INFEASIBLE_VALUE = 1e3
"""Constraint violation assigned to a sixbar that cannot be assembled."""

SCALE_STEP = 1e-6
"""Relative difference of k by which the errors are differentiated."""


def optimize_sixbar(
    task: FunctionTask,
    one: SixbarCandidate,
    dense: Real,
    pack_limits: Callable[[Topology], Real],
    rounds: int = MAX_ROUNDS,
) -> SixbarCandidate:
    """Optimise a sixbar by the criterion under all constraints, at inputs and outputs ``dense`` (2, n).

    ``rounds`` is the maximum number of linear programs.
    """
    evaluated = evaluate_errors(one, *dense)
    if evaluated is None:
        return replace(one, error=math.inf)
    greatest = float(np.abs(evaluated[1]).max())
    # Exact pairs, or a rounding error: nothing is left to optimize.
    if task.problem.aim == "precision" or greatest < CONVERGED_ERROR:
        return replace(one, error=greatest)
    one = replace(one, inputs=dense[0], fit=evaluated[0])
    square = task.problem.aim == "least_squares"
    columns = len(one.fit.x), len(one.fit.x) + 1
    free = np.concatenate([list_free_coordinates(one), task.free[5:]])
    follower = SixbarFollower(one, *dense, scales_input=bool(task.free[5]))
    descent = Descent(task, follower, SixbarLimits(task, one, dense[0], pack_limits, every=square), free, columns)
    improve = descent.least_squares if square else descent.minimax
    done = improve(_encode(one), 1.0, MAX_SQUARE_ROUNDS if square else rounds)
    return replace(_decode(one, done.generator), error=done.error)


def list_free_coordinates(one: SixbarCandidate) -> Mask:
    """Return which unknowns change the function: not those that only place the linkage."""
    topology, x = one.topology, one.fit.x
    free = np.full(len(x), True)
    first, second, *others = topology.fixed_pivots
    # Place and size: the first pivot, and the larger distance from it to the second.
    free[2 * first : 2 * first + 2] = False
    axis = int(np.abs(x[2 * second : 2 * second + 2] - x[2 * first : 2 * first + 2]).argmax())
    free[2 * second + axis] = False
    # The second fourbar of a Watt II turns and grows freely about the second pivot.
    if one.type == "watt_2":
        free[2 * others[0] : 2 * others[0] + 2] = False
    return np.asarray(free)


def _encode(one: SixbarCandidate) -> Real:
    return np.concatenate([one.fit.x, one.scales])


def _decode(one: SixbarCandidate, generator: Real) -> SixbarCandidate:
    x, k, l_ = generator[:-2].copy(), float(generator[-2]), float(generator[-1])
    return replace(one, fit=one.fit._replace(x=x), scales=(k, l_))


class SixbarFollower:
    """Sixbars of one type in one assembly, evaluated at common, increasing inputs.

    ``scales_input`` states whether steps change the scale of the input.
    """

    def __init__(self, one: SixbarCandidate, inputs: Real, outputs: Real, *, scales_input: bool = True) -> None:
        self.one, self.inputs, self.outputs, self.scales_input = one, inputs, outputs, scales_input

    def some(self, rows: NDArray[np.int64]) -> SixbarFollower:
        """Return the sixbars at selected inputs."""
        return SixbarFollower(self.one, self.inputs[rows], self.outputs[rows], scales_input=self.scales_input)

    def errors(self, dimensions: Real, _signs: Real) -> Real:
        """Return errors of sixbars (k, n): shape (k, inputs), NaN if not assembled."""
        return np.array([self._evaluate(generator)[0] for generator in dimensions])

    def derivatives(self, dimensions: Real, _errors: Real, _sign: float) -> Real:
        """Return derivatives of one sixbar's errors by its steps: shape (inputs, n)."""
        _, slopes = self._evaluate(dimensions)
        by_k, (k, l_) = np.zeros(len(self.inputs)), dimensions[-2:]
        if self.scales_input:
            ends = [dimensions.copy(), dimensions.copy()]
            for end, side in zip(ends, (1.0, -1.0), strict=True):
                end[-2] = k * (1.0 + side * SCALE_STEP)
            above, below = (self._evaluate(end)[0] for end in ends)
            by_k = (above - below) / (2.0 * SCALE_STEP)
        return np.column_stack([slopes, np.where(np.isfinite(by_k), by_k, 0.0), -l_ * self.outputs])

    def _evaluate(self, generator: Real) -> tuple[Real, Real]:
        evaluated = evaluate_errors(_decode(self.one, generator), self.inputs, self.outputs)
        if evaluated is None:
            return np.full(len(self.inputs), math.nan), np.zeros((len(self.inputs), len(generator) - 2))
        return evaluated[1], evaluated[2]

    def apply_step(self, dimensions: Real, step: Real) -> Real:
        """Apply a step to a sixbar."""
        found = dimensions.copy()
        found[:-2] += step[:-2]
        # Scales step by factors, so that they keep their signs.
        found[-2:] *= np.exp(step[-2:])
        return found


class SixbarLimits:
    """Inequalities g ≤ 0 of sixbars of one type in one assembly.

    Parameters
    ----------
    task : FunctionTask
    one : SixbarCandidate
    inputs : float, shape (m,)
        Increasing inputs between whose ends the constraints hold.
    pack_limits : callable
        Returns the setting of a topology with the limits on its linkages.
    every : bool
        Whether inactive limits are rows too, which keeps the number of rows constant.
    """

    def __init__(
        self,
        task: FunctionTask,
        one: SixbarCandidate,
        inputs: Real,
        pack_limits: Callable[[Topology], Real],
        *,
        every: bool,
    ) -> None:
        self.one, self.ends, self.every, self.pack_limits = one, inputs[[0, -1]], every, pack_limits
        constraints = task.problem.constraints
        self.first_fourbar: GeneratorLimits | None = None
        if one.topology.families and (constraints.grashof != "any" or constraints.full_rotation):
            # Regions depend on the placement, which is chosen later.
            free = {"fixed_pivot_region": None, "moving_pivot_region": None, "min_transmission_angle": None}
            alone = {"constraints": constraints.model_copy(update=free), "fixed_pivots": None}
            self.first_fourbar = GeneratorLimits(task._replace(problem=task.problem.model_copy(update=alone)))
        self._rows = 1

    def choose_placement(self, generator: Real) -> Real:
        """Return the sixbar unchanged: its placement is chosen after the search."""
        return generator

    def values(self, generator: Real, *, derivatives: bool = False) -> tuple[Real, Real]:
        """Return g and, on request, its derivatives by the steps: shapes (m,) and (m, n)."""
        one = _decode(self.one, generator)
        rows = evaluate_margins(one, self.ends, self.pack_limits, LIMIT_STEPS)
        if rows is None:
            # Clearly infeasible, with the usual number of rows.
            return np.full(self._rows, INFEASIBLE_VALUE), np.zeros((self._rows, len(generator)))
        near = np.full(len(rows.margins), True) if self.every else rows.margins < ACTIVE_MARGIN
        g, slopes = -rows.margins[near], -np.pad(rows.gradients[near], ((0, 0), (0, 2)))
        if self.first_fourbar is not None:
            parameters, by = _measure_first_fourbar(one)
            more, more_slopes = self.first_fourbar.values(parameters, derivatives=derivatives)
            g, slopes = np.concatenate([g, more]), np.concatenate([slopes, more_slopes @ by])
        self._rows = len(g)
        return g, slopes


def _measure_first_fourbar(one: SixbarCandidate) -> tuple[Real, Real]:
    """Return the parameters of the fourbar O2 A B O4 with ground 1, and their derivatives by the steps (7, n).

    Lengths are differentiated logarithmically.
    """
    x, count = one.fit.x, len(one.fit.x) + 2
    pairs: Integers = one.topology.pairs[list(one.topology.families)]
    logs, by = np.empty(4), np.zeros((4, count))
    for row, (i, j) in enumerate(pairs):
        across = x[2 * j : 2 * j + 2] - x[2 * i : 2 * i + 2]
        square = float(across @ across)
        logs[row] = 0.5 * math.log(square)
        by[row, 2 * j : 2 * j + 2] += across / square
        by[row, 2 * i : 2 * i + 2] -= across / square
    parameters, slopes = np.zeros(PARAMETER_COUNT), np.zeros((PARAMETER_COUNT, count))
    parameters[:3], slopes[:3] = np.exp(logs[1:] - logs[0]), by[1:] - by[0]
    parameters[3] = one.start
    parameters[5:] = one.scales
    slopes[5, -2] = slopes[6, -1] = 1.0
    return parameters, slopes
