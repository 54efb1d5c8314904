"""Local optimisation of a function generator under constraints.

Minimax: sequential linear programs. With the errors e and limits g linearised in a step δ of the generator,

    minimize E + w t   over   |e_j + e_j′ δ| ≤ E,   g_i + g_i′ δ ≤ t,   |δ| ≤ trust region,

at the extremes of the error and between them; a step is accepted if it decreases E + w t. If n parameters are open and
n + 1 extremes share the error, as in Chebyshev's theorem, the steps become Newton steps (Remez exchange; Madsen, BIT 15
(1975) 295, doi:10.1007/BF01933675).

Least squares: sequential quadratic programs (SLSQP) on the mean square of the same errors, under the same limits. If
both zeros are given, the convex least-squares problem of the design equation in K provides a start.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from kinematics.arrays import Real
from synthesis.kinds.function.fourbar.task import FunctionTask
from synthesis.numerics.linear_program import solve_linear_program

INITIAL_TRUST = 0.3
"""Initial trust radius: a factor of about 1.35 in length, or 17 degrees."""

MERIT_TOLERANCE = 1e-8
"""Relative improvement of the merit below which a descent has converged."""

MIN_TRUST = 1e-11
"""Minimum trust radius; below it rounding decides whether a step is an improvement, so the descent has converged."""

UNREACHABLE_COST = 1e6
"""Relative cost of a generator that cannot be assembled over the whole range; that of the start is 1."""

COST_TOLERANCE = 1e-13
"""Relative change of the cost at which sequential quadratic programming has converged; close to rounding."""

LIMIT_TOLERANCE = 1e-9
"""Tolerance for constraint violations of a feasible generator."""

PENALTY_FACTOR = 10.0
"""Penalty of a constraint violation, radians of error per unit of violation."""

SCALE_COLUMNS = (5, 6)
"""Columns of the scales of a fourbar or slider-crank."""


class Approximation(NamedTuple):
    """A generator, its assembly, its error in the criterion's norm (radians or units), and whether it converged."""

    generator: Real
    sign: float
    error: float
    arrived: bool


class Followers(Protocol):
    """Interface of generators of one type, evaluated at common inputs."""

    inputs: Real

    def some(self, rows: NDArray[np.int64]) -> Self:
        """Return the generators at selected inputs."""

    def errors(self, dimensions: Real, signs: Real) -> Real:
        """Return structural errors of generators (k, n) in assemblies (k,): shape (k, inputs), NaN if not assembled."""

    def derivatives(self, dimensions: Real, errors: Real, sign: float) -> Real:
        """Return derivatives of one generator's errors by its steps: shape (inputs, n), or fewer columns."""

    def apply_step(self, dimensions: Real, step: Real) -> Real:
        """Apply a step to a generator."""


class Limits(Protocol):
    """Interface of the inequalities g ≤ 0 of a generator."""

    def values(self, generator: Real, *, derivatives: bool = False) -> tuple[Real, Real]:
        """Return g and, on request, its derivatives by the steps: shapes (m,) and (m, n)."""

    def choose_placement(self, generator: Real) -> Real:
        """Append the best placement to a generator if there are pivot regions; otherwise return it unchanged."""


class Descent:
    """Local optimiser for one generator at a time.

    Parameters
    ----------
    task : FunctionTask
        The task, with the permitted scales.
    dense : Followers
        Generators at the inputs at which the error is minimised.
    limits : Limits
        The constraints.
    free : bool, shape (n,)
        Mask of a generator's open parameters.
    scale_columns : pair of int
        Columns of a generator's scales of input and output.
    """

    def __init__(
        self,
        task: FunctionTask,
        dense: Followers,
        limits: Limits,
        free: NDArray[np.bool_],
        scale_columns: tuple[int, int] = SCALE_COLUMNS,
    ) -> None:
        self.task, self.dense, self.limits, self.free = task, dense, limits, free
        self.scale_columns = scale_columns
        # With an open output range, errors are relative to it; otherwise the smallest range would always win.
        self.relative = bool(free[scale_columns[1]])

    def _compute_errors(self, generators: Followers, at: Real, sign: float) -> Real:
        errors = generators.errors(at[None], np.array([sign]))[0]
        return np.asarray(errors / abs(at[self.scale_columns[1]]) if self.relative else errors)

    def _compute_slopes(self, generators: Followers, at: Real, sign: float, errors: Real) -> Real:
        column = self.scale_columns[1]
        unit = abs(at[column]) if self.relative else 1.0
        slopes = generators.derivatives(at, errors * unit, sign) / unit
        if self.relative:
            # The quotient's second part: errors are divided by the scale, and steps change its logarithm.
            slopes[:, column] -= errors
        return np.pad(slopes, ((0, 0), (0, len(at) - slopes.shape[1])))  # the placement does not affect errors

    def _scale_rows(self, at: Real) -> tuple[Real, Real]:
        """Scale limits: return the permitted decrease and increase of ln of each scale, shapes (n,)."""
        low, high = np.zeros(len(at)), np.zeros(len(at))
        for side, column in enumerate(self.scale_columns):
            # A step keeps the sign of a scale, so exactly one of the intervals applies.
            choice = [limits for limits in self.task.scales[side] if limits[0] * at[column] > 0.0]
            ends = sorted(abs(x) for x in choice[0])
            low[column], high[column] = (math.log(end / abs(at[column])) for end in ends)
        return low, high

    def minimax(self, at: Real, sign: float, rounds: int, enough: float = 0.0) -> Approximation:
        """Minimize the maximum error by sequential linear programs, until the merit reaches ``enough`` or converges."""
        trust, at = INITIAL_TRUST, self.limits.choose_placement(at)
        errors = self._compute_errors(self.dense, at, sign)
        greatest = float(np.abs(errors).max()) if np.isfinite(errors).all() else math.inf
        if not math.isfinite(greatest):
            return Approximation(at, sign, math.inf, False)
        merit = greatest + PENALTY_FACTOR * max(float(self.limits.values(at)[0].max(initial=0.0)), 0.0)
        arrived = False
        for _ in range(rounds):
            step, promised = self._solve_program(at, sign, errors, trust)
            # Negated, so that NaN ends the descent as well.
            if step is None or not merit - promised > MERIT_TOLERANCE * merit:
                arrived = step is not None
                break
            tried = self.dense_step(at, step)
            new = self._compute_errors(self.dense, tried, sign)
            # A generator that cannot be assembled has an infinite merit, which shrinks the trust region.
            reached = math.inf
            if np.isfinite(new).all():
                reached = float(np.abs(new).max())
                reached += PENALTY_FACTOR * max(float(self.limits.values(tried)[0].max(initial=0.0)), 0.0)
            # Trust-region update by the ratio of actual to predicted decrease.
            share = (merit - reached) / (merit - promised)
            # Accept any real decrease, and judge the trust region separately.
            if share > 0.05:
                at, errors, merit = tried, new, reached
            if share > 0.75:
                trust *= 2.0
            elif share < 0.25:
                trust *= 0.25
            if trust < MIN_TRUST or merit <= enough:
                arrived = True
                break
        return Approximation(at, sign, merit, arrived)

    def dense_step(self, at: Real, step: Real) -> Real:
        """Return the generator after a step."""
        return self.dense.apply_step(at, step)

    def _solve_program(self, at: Real, sign: float, errors: Real, trust: float) -> tuple[Real | None, float]:
        """Solve one linear program: return its step and the predicted merit; None if it is infeasible."""
        rows = _select_points(errors)
        slopes = self._compute_slopes(self.dense.some(rows), at, sign, errors[rows])
        g, g_slopes = self.limits.values(at, derivatives=True)
        free = np.flatnonzero(self.free)
        # Scale errors to order 1: they are small, and the linear program's tolerances are absolute.
        unit = float(np.abs(errors).max()) or 1.0
        ones = np.ones((len(rows), 1))
        zero = np.zeros((len(rows), 1))
        # Two additional variables: the largest error, and the largest violation of a limit.
        upper = np.hstack([slopes[:, free] / unit, -ones, zero])
        lower = np.hstack([-slopes[:, free] / unit, -ones, zero])
        limited = np.hstack([g_slopes[:, free], np.zeros((len(g), 1)), -np.ones((len(g), 1))])
        # Scales have hard bounds; all other limits are soft, by the penalty, so that the program is always feasible.
        low, high = self._scale_rows(at)
        bounded = np.isin(np.arange(len(at)), self.scale_columns)
        floors = [max(-trust, low[j]) if bounded[j] else -trust for j in free]
        ceilings = [min(trust, high[j]) if bounded[j] else trust for j in free]
        done = solve_linear_program(
            np.concatenate([np.zeros(len(free)), [1.0, PENALTY_FACTOR / unit]]),
            np.vstack([upper, lower, limited]),
            np.concatenate([-errors[rows] / unit, errors[rows] / unit, -g]),
            np.array([*floors, 0.0, 0.0]),
            np.array([*ceilings, np.inf, np.inf]),
        )
        if done is None:
            return None, math.inf
        step = np.zeros(len(at))
        step[free] = done.at[: len(free)]
        return step, done.value * unit

    def least_squares(self, at: Real, sign: float, rounds: int) -> Approximation:
        """Minimize the mean square error by sequential quadratic programs from one generator."""
        free, at = np.flatnonzero(self.free), self.limits.choose_placement(at)
        weights = self._compute_weights()

        def take_step(x: Real) -> Real:
            step = np.zeros(len(at))
            step[free] = x
            return self.dense.apply_step(at, step)

        begun = self._compute_errors(self.dense, at, sign)
        if not np.isfinite(begun).all():
            return Approximation(at, sign, math.inf, False)
        unit = float(weights @ begun**2) or 1.0

        def evaluate_cost(x: Real) -> tuple[float, Real]:
            here = take_step(x)
            errors = self._compute_errors(self.dense, here, sign)
            known = np.isfinite(errors)
            if not known.all():
                return UNREACHABLE_COST, np.zeros(len(free))
            slopes = self._compute_slopes(self.dense, here, sign, errors)[:, free]
            return float(weights @ errors**2) / unit, 2.0 * (weights * errors) @ slopes / unit

        low, high = self._scale_rows(at)
        bounds = [(low[j], high[j]) if j in self.scale_columns else (-1.5, 1.5) for j in free]
        limits = {
            "type": "ineq",
            "fun": lambda x: -self.limits.values(take_step(x))[0],
            "jac": lambda x: -self.limits.values(take_step(x), derivatives=True)[1][:, free],
        }
        done = minimize(
            evaluate_cost,
            np.zeros(len(free)),
            jac=True,
            method="SLSQP",
            bounds=bounds,
            constraints=[limits],
            options={"maxiter": 3 * rounds, "ftol": COST_TOLERANCE},
        )
        found = take_step(done.x)
        errors = self._compute_errors(self.dense, found, sign)
        broken = float(self.limits.values(found)[0].max(initial=0.0))
        # SLSQP may end at a worse, infeasible point; keep the start then.
        if not np.isfinite(errors).all() or (done.fun > 1.0 and broken > LIMIT_TOLERANCE):
            found, errors, broken = at, begun, float(self.limits.values(at)[0].max(initial=0.0))
        error = math.sqrt(float(weights @ errors**2)) + PENALTY_FACTOR * max(broken, 0.0)
        return Approximation(found, sign, error, bool(done.success))

    def _compute_weights(self) -> Real:
        """Return weights of the inputs, shape (m,), for which a weighted sum approximates the mean over the range."""
        if self.task.problem.function is None:
            return np.full(len(self.dense.inputs), 1.0 / len(self.dense.inputs))
        return np.asarray(np.gradient(self.dense.inputs) / np.gradient(self.dense.inputs).sum())


def _select_points(errors: Real) -> NDArray[np.int64]:
    """Select the points of a linear program: the ends, every extreme of the error, and some between them."""
    n = len(errors)
    if n <= 60:
        return np.arange(n)
    steps = np.diff(errors)
    turns = np.flatnonzero(steps[:-1] * steps[1:] <= 0.0) + 1
    return np.unique(np.concatenate([np.linspace(0, n - 1, 31).astype(np.int64), turns]))
