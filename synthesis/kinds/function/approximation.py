"""Function generators that follow a whole range with the least greatest or least mean square structural error.

Starts are linkages that meet as many precision points as they can, spaced at random about Chebyshev's spacing: the best
approximation is one of these for some spacing, as its error has a zero between any two of its extremes. Members of the
families through fewer points are added. All are judged at once; the errors of the best are levelled
(:mod:`synthesis.kinds.function.levelling`), and the best that differ are improved under all limits.

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
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from synthesis.kinds.function.levelling import levelled
from synthesis.kinds.function.limits import GeneratorLimits
from synthesis.kinds.function.precision import family, many_exact
from synthesis.kinds.function.structural_error import ERROR, STEPS, Generators
from synthesis.kinds.function.task import FunctionTask
from synthesis.model.kind import Progress
from synthesis.numerics.linear_program import least

Real = NDArray[np.float64]

SETS = 300
"""Sets of precision points for each number of them and each direction of the output."""

JITTER = 0.8
"""How far a precision point moves from Chebyshev's spacing, in steps of the angle that spaces them."""

SAME_START = 0.12
"""Starts differ by this much in the logarithm of some length, or in some angle."""

DRAWN, TURNING_KEPT, WIDEST = 40_000, 4000, 100.0
"""Random lengths where a link must turn through, those kept of them, and their widest link ratio."""

LEVELLED, ONWARD = 60, 2
"""Starts whose errors are levelled, the best ones; and level ones from which a best that has not arrived goes on."""


class Effort(NamedTuple):
    """How many starts are improved a little and how many of them to the end, and steps for both at most."""

    starts: int
    first_rounds: int
    kept: int
    rounds: int


FEW, MANY = Effort(6, 4, 3, 12), Effort(14, 6, 6, 60)
"""Where no limit is in the way of the best, and where one is."""

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

SAME = 1e-3
"""Optima whose numbers differ by less are one."""

SCALES = (5, 6)
"""Where a generator has its scales."""

DENSE = 801
"""Places at which an error is looked at for its extremes."""


class Approximation(NamedTuple):
    """A generator, its assembly, its error in the criterion's norm (radians or units), and how it was come by."""

    generator: Real
    sign: float
    error: float
    arrived: bool


class Approximations(NamedTuple):
    """Local optima, best first, and how many starts were judged and improved."""

    optima: list[Approximation]
    judged: int
    improved: int


def approximations(
    task: FunctionTask, rng: np.random.Generator, progress: Progress, least: float | None = None
) -> Approximations:
    """The best approximations that are reached from many starts; ``least`` as for :class:`GeneratorLimits`."""
    limits = GeneratorLimits(task, least)
    descent = Descent(task, limits)
    pool, signs = _starts(task, limits, rng)
    progress(0.2, f"{len(pool)} starts")
    if not len(pool):
        return Approximations([], 0, 0)
    nearest = np.argsort(descent.sizes(pool, signs))[:LEVELLED]
    level, theirs = levelled(task, pool[nearest], signs[nearest])
    judged = len(pool)
    pool, signs = limits.contained(np.concatenate([pool, level])), np.concatenate([signs, theirs])
    # The best level error, if no limit touches it, is the answer already; the rest is for others beside it.
    inside = len(level) > 0 and float(limits.values(level[descent.sizes(level, theirs).argmin()])[0].max()) < 0.0
    # What is not levelled, or not among the inequalities, may have its best elsewhere.
    inside &= not task.free[5:].any() and task.problem.constraints.grashof in ("any", "crank_rocker", "double_crank")
    effort = FEW if inside else MANY
    chosen = descent.best_apart(pool, signs, effort.starts)
    improve = descent.minimax if task.problem.aim == "minimax" else descent.least_squares
    rough = []
    for n, j in enumerate(chosen):
        progress(0.2 + 0.3 * n / len(chosen), f"start {n + 1} of {len(chosen)}")
        rough.append(improve(pool[j], float(signs[j]), effort.first_rounds))
    rough.sort(key=lambda optimum: optimum.error)
    optima: list[Approximation] = []
    for n, start in enumerate(rough[: effort.kept]):
        progress(0.5 + 0.4 * n / effort.kept, f"candidate {n + 1}")
        refined = improve(start.generator, start.sign, effort.rounds)
        if not any(_same(refined, other) for other in optima):
            optima.append(refined)
    optima.sort(key=lambda optimum: optimum.error)
    if optima and not optima[0].arrived:
        # The best is on its way still: on to the end, and from where its errors are level if that is better.
        best = optima[0]
        level, theirs = levelled(task, best.generator[None, :STEPS], np.array([best.sign]))
        level = limits.contained(level)
        nearest = np.argsort(descent.sizes(level, theirs))[:ONWARD]
        onward = [(best.generator, best.sign), *zip(level[nearest], theirs[nearest], strict=True)]
        again = [improve(generator, float(sign), MANY.rounds) for generator, sign in onward]
        optima[0] = min([best, *again], key=lambda optimum: optimum.error)
    return Approximations([optimum for optimum in optima if math.isfinite(optimum.error)], judged, len(chosen))


def _same(one: Approximation, other: Approximation) -> bool:
    """Whether two optima are one; angles without full turns, which a slider's position is never near to."""
    gaps = one.generator[:STEPS] - other.generator[:STEPS]
    gaps[3:5] -= math.tau * np.round(gaps[3:5] / math.tau)
    return one.sign == other.sign and bool(np.all(np.abs(gaps) <= SAME * (1.0 + np.abs(other.generator[:STEPS]))))


def _starts(task: FunctionTask, limits: GeneratorLimits, rng: np.random.Generator) -> tuple[Real, Real]:
    """Generators that meet some places exactly, with their assemblies."""
    most = 3 + sum(zero is None for zero in task.zeros)
    found = []
    for first in task.scales[0]:
        for second in task.scales[1]:
            for count in range(most, 1, -1):
                inputs, outputs = _places(task, min(count, len(task.sample_inputs)), rng)
                k, scale = (_drawn(choice, len(inputs), rng) for choice in (first, second))
                pairs = k[:, None] * inputs, scale[:, None] * outputs
                if inputs.shape[1] == most:
                    found.append(_with_scales(many_exact(task.closure, *pairs, task.zeros), k, scale))
                else:
                    found.append(_with_scales(family(task.closure, *pairs, task.zeros, rng), k, scale))
    if None not in task.zeros and task.problem.aim == "least_squares":
        # Only who states zeros waits for the import.
        from synthesis.kinds.function.design_equation import least_design_error

        for first in task.scales[0]:
            for second in task.scales[1]:
                best = least_design_error(task, limits, sum(first) / 2.0, sum(second) / 2.0)
                if best is not None:
                    found.append(best[None])
    pool = np.concatenate(found)
    # The assembly that the sampled function lies in, by most of its places.
    signs = np.where(task.samples().signs(pool).sum(axis=1) >= 0.0, 1.0, -1.0)
    if limits.shortest_link is None and not limits.turns_through:
        return pool, signs
    # Linkages that turn through are rare among those that meet points.
    turning = _turning(task, limits, rng)
    more = [_centred(task, turning, sign) for sign in (1.0, -1.0)]
    return np.concatenate([pool, *more]), np.concatenate([signs, np.ones(len(turning)), -np.ones(len(turning))])


def _turning(task: FunctionTask, limits: GeneratorLimits, rng: np.random.Generator) -> Real:
    """Random generators whose link turns through that is to."""
    reach = 0.5 * math.log(min(limits.ratio, WIDEST))
    drawn = np.ones((DRAWN, STEPS))
    drawn[:, :3] = np.exp(rng.uniform(-reach, reach, (DRAWN, 3)))
    drawn[:, 3:5] = rng.uniform(-math.pi, math.pi, (DRAWN, 2))
    for side, column in ((0, 5), (1, 6)):
        choice = rng.integers(len(task.scales[side]), size=DRAWN)
        both = np.array([_drawn(choices, DRAWN, rng) for choices in task.scales[side]])
        drawn[:, column] = both[choice, np.arange(DRAWN)]
        if task.zeros[side] is not None:
            drawn[:, 3 + side] = task.zeros[side]
    return np.asarray(drawn[limits.turning(drawn)][:TURNING_KEPT])


def _centred(task: FunctionTask, generators: Real, sign: float) -> Real:
    """Generators with the output's zero, where it is open, moved to where their mean error vanishes."""
    centred = generators.copy()
    if task.zeros[1] is None:
        errors = task.samples().errors(generators, np.full(len(generators), sign))
        errors = np.where(np.isfinite(errors), errors, 0.0)
        mean = errors.mean(axis=1) if task.problem.slides else np.angle(np.exp(1j * errors).mean(axis=1))
        centred[:, 4] += mean
    return centred


def _places(task: FunctionTask, count: int, rng: np.random.Generator) -> tuple[Real, Real]:
    """Sets of places about Chebyshev's spacing, or sets of pairs; shape (sets, count)."""
    function = task.problem.function
    if function is None:
        order = np.argsort(rng.random((SETS, len(task.sample_inputs))), axis=1)[:, :count]
        return task.sample_inputs[order], task.sample_outputs[order]
    moved = JITTER * rng.uniform(-1.0, 1.0, (SETS, count))
    moved[0] = 0.0
    shares = 0.5 - 0.5 * np.cos((2.0 * np.arange(count) + 1.0 + moved) * math.pi / (2.0 * count))
    return shares, function.share_along(shares)


def _drawn(limits: tuple[float, float], count: int, rng: np.random.Generator) -> Real:
    low, high = limits
    return np.asarray(low * (high / low) ** rng.random(count)) if low * high > 0.0 else rng.uniform(low, high, count)


def _with_scales(found: Real, k: Real, scale: Real) -> Real:
    index = found[:, 5].astype(np.int64)
    return np.column_stack([found[:, :5], k[index], scale[index]])


class Descent:
    """Improves one generator at a time."""

    def __init__(self, task: FunctionTask, limits: GeneratorLimits) -> None:
        self.task, self.limits = task, limits
        exact = task.problem.aim == "precision"
        self.coarse = task.points() if exact else task.samples()
        function = task.problem.function
        if function is None or exact:
            self.dense = self.coarse
        else:
            shares = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, DENSE))
            self.dense = Generators(task.problem.slides, shares, function.share_along(shares))
        self.free = task.free
        if limits.regions is not None:
            self.free = np.concatenate([self.free, limits.regions.free])
        # With the output's range open its errors are shares of it; else the least range would be the best.
        self.relative = bool(self.free[6])
        self.square = task.problem.aim == "least_squares"

    def merits(self, pool: Real, signs: Real) -> Real:
        """The criterion's error and what the transmission angle lacks, of many generators; infinite beyond use."""
        size = self.sizes(pool, signs)
        if self.limits.cosine is not None:
            short = math.sqrt(max(1.0 - self.limits.cosine**2, 0.0)) - self.limits.transmission(pool)
            size = size + np.maximum(short, 0.0)
        return np.asarray(size)

    def best_apart(self, pool: Real, signs: Real, count: int) -> list[int]:
        """Starts with the least errors that differ from one another.

        Half of them are from within all limits, if there are such: a descent comes into them, but not from everywhere.
        """
        merit, lacking = self.merits(pool, signs), self.limits.lacking(pool)
        inside = self.apart(pool, np.where(lacking > 0.0, np.inf, merit), count // 2)
        return self.apart(pool, merit, count, inside)

    def apart(self, pool: Real, merit: Real, count: int, chosen: Sequence[int] = ()) -> list[int]:
        """The rows of a pool with the least merit that differ from one another and from those chosen before."""
        features = np.column_stack([np.log(np.abs(pool[:, :3]) + 1e-12), pool[:, 3:5], np.log(np.abs(pool[:, 5:]))])
        found = list(chosen)
        for j in np.argsort(merit):
            if not math.isfinite(merit[j]) or len(found) >= count:
                break
            gaps = np.abs(features[found] - features[j]).max(axis=1) if found else np.array([np.inf])
            if gaps.min() > SAME_START:
                found.append(int(j))
        return found

    def sizes(self, pool: Real, signs: Real) -> Real:
        """The criterion's error of many generators; infinite beyond use."""
        errors = np.abs(self.coarse.errors(pool, signs))
        errors = np.where(np.isfinite(errors), errors, np.inf)
        size = np.sqrt(np.mean(errors**2, axis=1)) if self.square else errors.max(axis=1)
        size = np.where(errors.max(axis=1) < ERROR, size, np.inf)
        if self.relative:
            size = size / np.abs(pool[:, 6])
        return np.asarray(size)

    def _errors(self, generators: Generators, at: Real, sign: float) -> Real:
        errors = generators.errors(at[None], np.array([sign]))[0]
        return np.asarray(errors / abs(at[6]) if self.relative else errors)

    def _slopes(self, generators: Generators, at: Real, errors: Real) -> Real:
        unit = abs(at[6]) if self.relative else 1.0
        slopes = generators.derivatives(at, errors * unit) / unit
        if self.relative:
            slopes[:, 6] -= errors
        return np.pad(slopes, ((0, 0), (0, len(at) - STEPS)))  # wherever it stands

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
            step, promised = self._program(at, errors, trust)
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

    def _program(self, at: Real, errors: Real, trust: float) -> tuple[Real | None, float]:
        """The step of one linear program, and the merit that it promises."""
        rows = _telling(errors)
        some = Generators(self.dense.slides, self.dense.inputs[rows], self.dense.outputs[rows])
        slopes = self._slopes(some, at, errors[rows])
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
            slopes = self._slopes(self.dense, here, errors)[:, free]
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
