"""Function generators that follow a whole range with the least greatest or least mean square structural error.

Starts are linkages that meet as many precision points as they can, spaced at random about Chebyshev's spacing: the best
approximation is one of these for some spacing, as its error has a zero between any two of its extremes. Members of the
families through fewer points are added. All are judged at once; the errors of the best are levelled
(:mod:`synthesis.kinds.function.levelling`), and the best that differ are improved under all limits.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.function.descent import Approximation, Descent
from synthesis.kinds.function.levelling import levelled
from synthesis.kinds.function.limits import GeneratorLimits
from synthesis.kinds.function.precision import family, many_exact
from synthesis.kinds.function.structural_error import ERROR, STEPS, Generators
from synthesis.kinds.function.task import FunctionTask
from synthesis.model.kind import Progress

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

SAME = 1e-3
"""Optima whose numbers differ by less are one."""

DENSE = 801
"""Places at which an error is looked at for its extremes."""


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
    descent = GeneratorDescent(task, limits)
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


class GeneratorDescent(Descent):
    """Judges and improves fourbars and slider-cranks."""

    limits: GeneratorLimits

    def __init__(self, task: FunctionTask, limits: GeneratorLimits) -> None:
        exact = task.problem.aim == "precision"
        self.coarse = task.points() if exact else task.samples()
        function = task.problem.function
        if function is None or exact:
            dense = self.coarse
        else:
            shares = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, DENSE))
            dense = Generators(task.problem.slides, shares, function.share_along(shares))
        free = task.free
        if limits.regions is not None:
            free = np.concatenate([free, limits.regions.free])
        super().__init__(task, dense, limits, free)
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
