"""Improves a function generator step by step, under limits, from where it stands.

Minimax: sequential linear programs. With the errors e and limits g linearized in a step δ of the generator,

    minimize E + w t   over   |e_j + e_j′ δ| ≤ E,   g_i + g_i′ δ ≤ t,   |δ| ≤ trust region,

at the extremes of the error and between them; the step is taken where E + w t has become less. Where n numbers are open
and n + 1 extremes share the error, as Chebyshev's theorem has it, the steps become Newton's (Remez' exchange; Madsen,
BIT 15 (1975) 295, doi:10.1007/BF01933675).

Least squares: sequential quadratic programs (SLSQP) on the mean square of the same errors, under the same limits. Where
both zeros are given, the design equation's convex least squares in K gives a start.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from synthesis.kinds.function.task import FunctionTask
from synthesis.numerics.linear_program import least

Real = NDArray[np.float64]

TRUST = 0.3
"""First bound on a step: a third in length, 17 degrees."""

SETTLED = 1e-8
"""Relative improvement of the merit below which a descent has converged."""

MIN_TRUST = 1e-11
"""Bound on a step below which rounding decides whether it is an improvement: the descent has converged."""

UNREACHABLE_COST = 1e6
"""Relative cost of a generator that does not reach all of the range; the start's is 1."""

COST_TOLERANCE = 1e-13
"""Relative change of the cost at which sequential quadratic programming has converged: nearly rounding."""

LIMIT_TOLERANCE = 1e-9
"""Violation of a limit with which a generator still counts as within all."""

PENALTY = 10.0
"""What breaking a limit costs, radians of error for a unit of it."""

SCALES = (5, 6)
"""Where a generator has its scales."""


class Approximation(NamedTuple):
    """A generator, its assembly, its error in the criterion's norm (radians or units), and how it was come by."""

    generator: Real
    sign: float
    error: float
    arrived: bool


class Followers(Protocol):
    """Generators of a type at common places of the input."""

    inputs: Real

    def some(self, rows: NDArray[np.int64]) -> Self:
        """The same at some of the places."""

    def errors(self, dimensions: Real, signs: Real) -> Real:
        """Structural errors of generators (k, n) in their assemblies (k,): shape (k, places), NaN where none is."""

    def derivatives(self, dimensions: Real, errors: Real, sign: float) -> Real:
        """Of the errors of one generator by its steps: shape (places, n), or fewer columns than steps that it has."""

    def stepped(self, dimensions: Real, step: Real) -> Real:
        """A generator after a step."""


class Limits(Protocol):
    """Inequalities g ≤ 0 of a generator."""

    def values(self, generator: Real, *, derivatives: bool = False) -> tuple[Real, Real]:
        """g and, where asked for, its derivatives by the steps: shapes (m,) and (m, n)."""

    def put(self, generator: Real) -> Real:
        """A generator with the place that fits it best, where there are regions to be kept; else as it is."""


class Descent:
    """Improves one generator at a time.

    Parameters
    ----------
    task : FunctionTask
        The task, with what the scales may be.
    dense : Followers
        At the places at which the error is made small.
    limits : Limits
    free : bool, shape (n,)
        Which of a generator's numbers are open.
    """

    def __init__(self, task: FunctionTask, dense: Followers, limits: Limits, free: NDArray[np.bool_]) -> None:
        self.task, self.dense, self.limits, self.free = task, dense, limits, free
        # With the output's range open its errors are shares of it; else the least range would be the best.
        self.relative = bool(free[6])

    def _errors(self, generators: Followers, at: Real, sign: float) -> Real:
        errors = generators.errors(at[None], np.array([sign]))[0]
        return np.asarray(errors / abs(at[6]) if self.relative else errors)

    def _slopes(self, generators: Followers, at: Real, sign: float, errors: Real) -> Real:
        unit = abs(at[6]) if self.relative else 1.0
        slopes = generators.derivatives(at, errors * unit, sign) / unit
        if self.relative:
            slopes[:, 6] -= errors
        return np.pad(slopes, ((0, 0), (0, len(at) - slopes.shape[1])))  # wherever it stands

    def _scale_rows(self, at: Real) -> tuple[Real, Real]:
        """How far ln of each scale may still go down and up, shapes (2,)."""
        low, high = np.zeros(len(at)), np.zeros(len(at))
        for side, column in ((0, 5), (1, 6)):
            choice = [limits for limits in self.task.scales[side] if limits[0] * at[column] > 0.0]
            ends = sorted(abs(x) for x in choice[0])
            low[column], high[column] = (math.log(end / abs(at[column])) for end in ends)
        return low, high

    def minimax(self, at: Real, sign: float, rounds: int, enough: float = 0.0) -> Approximation:
        """Sequential linear programs from one generator, until error and violation are ``enough`` or settled."""
        trust, at = TRUST, self.limits.put(at)
        errors = self._errors(self.dense, at, sign)
        greatest = float(np.abs(errors).max()) if np.isfinite(errors).all() else math.inf
        if not math.isfinite(greatest):
            return Approximation(at, sign, math.inf, False)
        merit = greatest + PENALTY * max(float(self.limits.values(at)[0].max(initial=0.0)), 0.0)
        arrived = False
        for _ in range(rounds):
            step, promised = self._program(at, sign, errors, trust)
            if step is None or not merit - promised > SETTLED * merit:
                arrived = step is not None
                break
            tried = self.dense_step(at, step)
            new = self._errors(self.dense, tried, sign)
            reached = math.inf
            if np.isfinite(new).all():
                reached = float(np.abs(new).max())
                reached += PENALTY * max(float(self.limits.values(tried)[0].max(initial=0.0)), 0.0)
            share = (merit - reached) / (merit - promised)
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
        """The generator after a step."""
        return self.dense.stepped(at, step)

    def _program(self, at: Real, sign: float, errors: Real, trust: float) -> tuple[Real | None, float]:
        """The step of one linear program, and the merit that it promises."""
        rows = _telling(errors)
        slopes = self._slopes(self.dense.some(rows), at, sign, errors[rows])
        g, g_slopes = self.limits.values(at, derivatives=True)
        free = np.flatnonzero(self.free)
        # Errors are far below 1, and the program's own tolerances are not relative.
        unit = float(np.abs(errors).max()) or 1.0
        ones = np.ones((len(rows), 1))
        zero = np.zeros((len(rows), 1))
        upper = np.hstack([slopes[:, free] / unit, -ones, zero])
        lower = np.hstack([-slopes[:, free] / unit, -ones, zero])
        limited = np.hstack([g_slopes[:, free], np.zeros((len(g), 1)), -np.ones((len(g), 1))])
        low, high = self._scale_rows(at)
        bounded = np.isin(np.arange(len(at)), SCALES)
        floors = [max(-trust, low[j]) if bounded[j] else -trust for j in free]
        ceilings = [min(trust, high[j]) if bounded[j] else trust for j in free]
        done = least(
            np.concatenate([np.zeros(len(free)), [1.0, PENALTY / unit]]),
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
        """Sequential quadratic programs from one generator."""
        free, at = np.flatnonzero(self.free), self.limits.put(at)
        weights = self._weights()

        def whole(x: Real) -> Real:
            step = np.zeros(len(at))
            step[free] = x
            return self.dense.stepped(at, step)

        begun = self._errors(self.dense, at, sign)
        if not np.isfinite(begun).all():
            return Approximation(at, sign, math.inf, False)
        unit = float(weights @ begun**2) or 1.0

        def cost(x: Real) -> tuple[float, Real]:
            here = whole(x)
            errors = self._errors(self.dense, here, sign)
            known = np.isfinite(errors)
            if not known.all():
                return UNREACHABLE_COST, np.zeros(len(free))
            slopes = self._slopes(self.dense, here, sign, errors)[:, free]
            return float(weights @ errors**2) / unit, 2.0 * (weights * errors) @ slopes / unit

        low, high = self._scale_rows(at)
        bounds = [(low[j], high[j]) if j in SCALES else (-1.5, 1.5) for j in free]
        limits = {
            "type": "ineq",
            "fun": lambda x: -self.limits.values(whole(x))[0],
            "jac": lambda x: -self.limits.values(whole(x), derivatives=True)[1][:, free],
        }
        done = minimize(
            cost,
            np.zeros(len(free)),
            jac=True,
            method="SLSQP",
            bounds=bounds,
            constraints=[limits],
            options={"maxiter": 3 * rounds, "ftol": COST_TOLERANCE},
        )
        found = whole(done.x)
        errors = self._errors(self.dense, found, sign)
        broken = float(self.limits.values(found)[0].max(initial=0.0))
        if not np.isfinite(errors).all() or (done.fun > 1.0 and broken > LIMIT_TOLERANCE):
            found, errors, broken = at, begun, float(self.limits.values(at)[0].max(initial=0.0))
        error = math.sqrt(float(weights @ errors**2)) + PENALTY * max(broken, 0.0)
        return Approximation(found, sign, error, bool(done.success))

    def _weights(self) -> Real:
        """Of the places, so that a mean over them is one over the range."""
        if self.task.problem.function is None:
            return np.full(len(self.dense.inputs), 1.0 / len(self.dense.inputs))
        return np.asarray(np.gradient(self.dense.inputs) / np.gradient(self.dense.inputs).sum())


def _telling(errors: Real) -> NDArray[np.int64]:
    """Places that a linear program looks at: the ends, every extreme of the error, and some between them."""
    n = len(errors)
    if n <= 60:
        return np.arange(n)
    steps = np.diff(errors)
    turns = np.flatnonzero(steps[:-1] * steps[1:] <= 0.0) + 1
    return np.unique(np.concatenate([np.linspace(0, n - 1, 31).astype(np.int64), turns]))
