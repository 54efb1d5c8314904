"""Function generators that approximate a whole range with the smallest maximum or mean square structural error.

Starts are linkages that meet the maximum number of precision points, spaced at random about Chebyshev spacing: the best
approximation is one of these for some spacing, because its error has a zero between any two of its extremes. Members of
the families through fewer points are added. All are evaluated at once; the errors of the best are levelled
(:mod:`synthesis.kinds.function.fourbar.error_levelling`), and the best distinct ones are optimised under all
constraints.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.kinds.function.fourbar.constraints import GeneratorLimits
from synthesis.kinds.function.fourbar.error_levelling import equalize_errors
from synthesis.kinds.function.fourbar.minimax_descent import Approximation, Descent
from synthesis.kinds.function.fourbar.precision_points import sample_family, solve_many_exact
from synthesis.kinds.function.fourbar.structural_error import MAX_ERROR, PARAMETER_COUNT, Generators
from synthesis.kinds.function.fourbar.task import FunctionTask
from synthesis.model.kind import Progress

SET_COUNT = 300
"""Number of sets of precision points, for each number of points and each direction of the output."""

JITTER_SHARE = 0.8
"""Maximum random shift of a precision point from Chebyshev spacing, in steps of the spacing angle."""

START_SEPARATION = 0.12
"""Minimum separation of starts, in the logarithm of some length or in some angle (radians)."""

RANDOM_COUNT, MAX_TURNING, MAX_RANDOM_RATIO = 40_000, 4000, 100.0
"""Random generators if a link must rotate fully: number sampled, maximum number kept, and maximum link ratio."""

LEVELLED_COUNT, CONTINUATION_COUNT = 60, 2
"""Number of best starts whose errors are levelled, and number of levelled linkages from which an optimum that has not
converged continues."""


class Effort(NamedTuple):
    """Effort of optimisation: number of starts and maximum steps, first for all, then for those that are continued."""

    starts: int
    first_rounds: int
    kept: int
    rounds: int


LOW_EFFORT, HIGH_EFFORT = Effort(6, 4, 3, 12), Effort(14, 6, 6, 60)
"""Effort if no constraint is active at the best start, and otherwise."""

DUPLICATE_TOLERANCE = 1e-3
"""Relative difference of the parameters below which two optima are duplicates."""

DENSE_SAMPLE_COUNT = 801
"""Number of inputs at which the extremes of an error are searched."""


class Approximations(NamedTuple):
    """Local optima, best first, and the numbers of starts evaluated and optimised."""

    optima: list[Approximation]
    judged: int
    improved: int


def find_approximations(
    task: FunctionTask, rng: np.random.Generator, progress: Progress, least: float | None = None
) -> Approximations:
    """Find the best approximations from many starts; ``least`` as for :class:`GeneratorLimits`."""
    limits = GeneratorLimits(task, least)
    descent = GeneratorDescent(task, limits)
    pool, signs = _find_starts(task, limits, rng)
    progress(0.2, compose("function-starts", count=len(pool)))
    if not len(pool):
        return Approximations([], 0, 0)
    nearest = np.argsort(descent.compute_errors(pool, signs))[:LEVELLED_COUNT]
    level, theirs = equalize_errors(task, pool[nearest], signs[nearest])
    judged = len(pool)
    pool, signs = limits.clip_lengths(np.concatenate([pool, level])), np.concatenate([signs, theirs])
    # The best levelled error is optimal if no constraint is active; further effort only finds alternatives.
    inside = (
        len(level) > 0 and float(limits.values(level[descent.compute_errors(level, theirs).argmin()])[0].max()) < 0.0
    )
    # That argument fails if scales are open or if the Grashof class is not among the inequalities.
    inside &= not task.free[5:].any() and task.problem.constraints.grashof in ("any", "crank_rocker", "double_crank")
    effort = LOW_EFFORT if inside else HIGH_EFFORT
    # Levelled linkages compete with the other starts, as their levelling can have violated constraints.
    chosen = descent.select_best_distinct(pool, signs, effort.starts)
    improve = descent.minimax if task.problem.aim == "minimax" else descent.least_squares
    rough = []
    for n, j in enumerate(chosen):
        progress(0.2 + 0.3 * n / len(chosen), compose("function-improving-start", number=n + 1, count=len(chosen)))
        rough.append(improve(pool[j], float(signs[j]), effort.first_rounds))
    # Only a few steps decide which starts are continued.
    rough.sort(key=lambda optimum: optimum.error)
    optima: list[Approximation] = []
    for n, start in enumerate(rough[: effort.kept]):
        progress(0.5 + 0.4 * n / effort.kept, compose("function-improving-candidate", number=n + 1))
        refined = improve(start.generator, start.sign, effort.rounds)
        if not any(_is_same(refined, other) for other in optima):
            optima.append(refined)
    optima.sort(key=lambda optimum: optimum.error)
    if optima and not optima[0].arrived:
        # The best has not converged: continue from it, and from its levelled variants.
        best = optima[0]
        level, theirs = equalize_errors(task, best.generator[None, :PARAMETER_COUNT], np.array([best.sign]))
        level = limits.clip_lengths(level)
        nearest = np.argsort(descent.compute_errors(level, theirs))[:CONTINUATION_COUNT]
        onward = [(best.generator, best.sign), *zip(level[nearest], theirs[nearest], strict=True)]
        again = [improve(generator, float(sign), HIGH_EFFORT.rounds) for generator, sign in onward]
        # The continuation can fail, so the best so far stays a candidate.
        optima[0] = min([best, *again], key=lambda optimum: optimum.error)
    return Approximations([optimum for optimum in optima if math.isfinite(optimum.error)], judged, len(chosen))


def _is_same(one: Approximation, other: Approximation) -> bool:
    """Return whether two optima are duplicates; angles modulo full turns (a slider's position is never near 2π)."""
    gaps = one.generator[:PARAMETER_COUNT] - other.generator[:PARAMETER_COUNT]
    gaps[3:5] -= math.tau * np.round(gaps[3:5] / math.tau)
    return one.sign == other.sign and bool(
        np.all(np.abs(gaps) <= DUPLICATE_TOLERANCE * (1.0 + np.abs(other.generator[:PARAMETER_COUNT])))
    )


def _find_starts(task: FunctionTask, limits: GeneratorLimits, rng: np.random.Generator) -> tuple[Real, Real]:
    """Find generators that meet some points exactly, with their assemblies."""
    most = 3 + sum(zero is None for zero in task.zeros)
    found = []
    for first in task.scales[0]:
        for second in task.scales[1]:
            # Fewer points leave families, which are sampled: the best approximation may meet fewer points than
            # possible.
            for count in range(most, 1, -1):
                inputs, outputs = _sample_points(task, min(count, len(task.sample_inputs)), rng)
                k, scale = (_sample_scales(choice, len(inputs), rng) for choice in (first, second))
                pairs = k[:, None] * inputs, scale[:, None] * outputs
                if inputs.shape[1] == most:
                    found.append(_with_scales(solve_many_exact(task.closure, *pairs, task.zeros), k, scale))
                else:
                    found.append(_with_scales(sample_family(task.closure, *pairs, task.zeros, rng), k, scale))
    if None not in task.zeros and task.problem.aim == "least_squares":
        # Import lazily: only problems with given zeros need the convex solver.
        from synthesis.kinds.function.fourbar.design_equation import minimize_design_error

        for first in task.scales[0]:
            for second in task.scales[1]:
                best = minimize_design_error(task, limits, sum(first) / 2.0, sum(second) / 2.0)
                if best is not None:
                    found.append(best[None])
    pool = np.concatenate(found)
    # Choose the assembly in which most samples lie.
    signs = np.where(task.samples().signs(pool).sum(axis=1) >= 0.0, 1.0, -1.0)
    if limits.shortest_link is None and not limits.turns_through:
        return pool, signs
    # Fully rotating linkages are rare among those that meet points exactly, so sample some separately.
    turning = _sample_turning(task, limits, rng)
    more = [_shift_to_mean(task, turning, sign) for sign in (1.0, -1.0)]
    return np.concatenate([pool, *more]), np.concatenate([signs, np.ones(len(turning)), -np.ones(len(turning))])


def _sample_turning(task: FunctionTask, limits: GeneratorLimits, rng: np.random.Generator) -> Real:
    """Sample random generators whose required link rotates fully."""
    # The range is that of a length's logarithm on both sides of the ground's.
    reach = 0.5 * math.log(min(limits.ratio, MAX_RANDOM_RATIO))
    drawn = np.ones((RANDOM_COUNT, PARAMETER_COUNT))
    drawn[:, :3] = np.exp(rng.uniform(-reach, reach, (RANDOM_COUNT, 3)))
    drawn[:, 3:5] = rng.uniform(-math.pi, math.pi, (RANDOM_COUNT, 2))
    for side, column in ((0, 5), (1, 6)):
        choice = rng.integers(len(task.scales[side]), size=RANDOM_COUNT)
        both = np.array([_sample_scales(choices, RANDOM_COUNT, rng) for choices in task.scales[side]])
        drawn[:, column] = both[choice, np.arange(RANDOM_COUNT)]
        # Given zeros replace random angles.
        if task.zeros[side] is not None:
            drawn[:, 3 + side] = task.zeros[side]
    return np.asarray(drawn[limits.check_rotation(drawn)][:MAX_TURNING])


def _shift_to_mean(task: FunctionTask, generators: Real, sign: float) -> Real:
    """Shift an open zero of the output so that the mean error vanishes."""
    centred = generators.copy()
    if task.zeros[1] is None:
        errors = task.samples().errors(generators, np.full(len(generators), sign))
        errors = np.where(np.isfinite(errors), errors, 0.0)
        # Angles have a mean direction, which does not depend on where they wrap.
        mean = errors.mean(axis=1) if task.problem.slides else np.angle(np.exp(1j * errors).mean(axis=1))
        centred[:, 4] += mean
    return centred


def _sample_points(task: FunctionTask, count: int, rng: np.random.Generator) -> tuple[Real, Real]:
    """Sample sets of precision points about Chebyshev spacing, or sets of pairs; shape (sets, count)."""
    function = task.problem.function
    if function is None:
        order = np.argsort(rng.random((SET_COUNT, len(task.sample_inputs))), axis=1)[:, :count]
        return task.sample_inputs[order], task.sample_outputs[order]
    moved = JITTER_SHARE * rng.uniform(-1.0, 1.0, (SET_COUNT, count))
    # One set keeps the exact Chebyshev spacing.
    moved[0] = 0.0
    shares = 0.5 - 0.5 * np.cos((2.0 * np.arange(count) + 1.0 + moved) * math.pi / (2.0 * count))
    return shares, function.share_along(shares)


def _sample_scales(limits: tuple[float, float], count: int, rng: np.random.Generator) -> Real:
    low, high = limits
    # Uniform in the logarithm, unless the interval contains zero.
    return np.asarray(low * (high / low) ** rng.random(count)) if low * high > 0.0 else rng.uniform(low, high, count)


def _with_scales(found: Real, k: Real, scale: Real) -> Real:
    index = found[:, 5].astype(np.int64)
    return np.column_stack([found[:, :5], k[index], scale[index]])


class GeneratorDescent(Descent):
    """Evaluation and local optimisation of fourbars and slider-cranks."""

    limits: GeneratorLimits

    def __init__(self, task: FunctionTask, limits: GeneratorLimits) -> None:
        exact = task.problem.aim == "precision"
        self.coarse = task.points() if exact else task.samples()
        function = task.problem.function
        if function is None or exact:
            # Pairs are the whole criterion; a function is followed between samples as well.
            dense = self.coarse
        else:
            shares = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, DENSE_SAMPLE_COUNT))
            dense = Generators(task.problem.slides, shares, function.share_along(shares))
        free = task.free
        if limits.regions is not None:
            free = np.concatenate([free, limits.regions.free])
        super().__init__(task, dense, limits, free)
        self.square = task.problem.aim == "least_squares"

    def compute_merits(self, pool: Real, signs: Real) -> Real:
        """Return error plus violation of the transmission angle of many generators; infinite for unusable ones."""
        size = self.compute_errors(pool, signs)
        if self.limits.cosine is not None:
            # Compare sines: a missing transmission angle is then of the order of the error in radians.
            short = math.sqrt(max(1.0 - self.limits.cosine**2, 0.0)) - self.limits.transmission(pool)
            size = size + np.maximum(short, 0.0)
        return np.asarray(size)

    def select_best_distinct(self, pool: Real, signs: Real, count: int) -> list[int]:
        """Select the distinct starts with the smallest errors.

        Half of them satisfy all constraints, if there are such: descents from infeasible starts do not always become
        feasible.
        """
        merit, lacking = self.compute_merits(pool, signs), self.limits.measure_violations(pool)
        inside = self.select_distinct(pool, np.where(lacking > 0.0, np.inf, merit), count // 2)
        return self.select_distinct(pool, merit, count, inside)

    def select_distinct(self, pool: Real, merit: Real, count: int, chosen: Sequence[int] = ()) -> list[int]:
        """Select the rows of a pool with the lowest merit that differ from each other and from those already chosen."""
        # The offset of a slider-crank may be zero.
        features = np.column_stack([np.log(np.abs(pool[:, :3]) + 1e-12), pool[:, 3:5], np.log(np.abs(pool[:, 5:]))])
        found = list(chosen)
        for j in np.argsort(merit):
            if not math.isfinite(merit[j]) or len(found) >= count:
                break
            # Features of different units share one tolerance, because logarithms and radians are of the same order.
            gaps = np.abs(features[found] - features[j]).max(axis=1) if found else np.array([np.inf])
            if gaps.min() > START_SEPARATION:
                found.append(int(j))
        return found

    def compute_errors(self, pool: Real, signs: Real) -> Real:
        """Return the criterion's error of many generators; infinite for unusable ones."""
        errors = np.abs(self.coarse.errors(pool, signs))
        errors = np.where(np.isfinite(errors), errors, np.inf)
        size = np.sqrt(np.mean(errors**2, axis=1)) if self.square else errors.max(axis=1)
        # Larger errors wrap and would look small.
        size = np.where(errors.max(axis=1) < MAX_ERROR, size, np.inf)
        if self.relative:
            size = size / np.abs(pool[:, 6])
        return np.asarray(size)
