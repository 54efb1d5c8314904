"""Search for sixbars whose output follows a function or meets pairs.

1. Several thousand sixbars of each type are sampled and composed (:mod:`~synthesis.kinds.function.sixbar.starts`).
2. The best distinct ones are fitted by least squares under constraints with the Levenberg-Marquardt method, a few
   milliseconds each. The best of these continue along the curved valleys that contain the minima
   (:mod:`synthesis.numerics.geodesic`).
3. The best results are optimised by the criterion under all constraints, as fourbars are
   (:mod:`~synthesis.kinds.function.fourbar.minimax_descent`).

For the approximation of given pairs more sixbars are sampled and selected in more stages
(:mod:`~synthesis.kinds.function.sixbar.exact_pairs`). If only Watt II sixbars are requested for nine or more pairs, and
none met them, all sixbars through nine of the pairs are computed too
(:mod:`~synthesis.kinds.function.sixbar.nine_pair_starts`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.kinds.function.fourbar.minimax_descent import Descent
from synthesis.kinds.function.fourbar.task import FunctionTask
from synthesis.kinds.function.nine_pairs.system import PAIR_COUNT, SOLUTION_COUNT
from synthesis.kinds.function.sixbar.descents import (
    TYPE_NUMBERS,
    Descents,
    SixbarCandidate,
    select_best,
    select_best_starts,
)
from synthesis.kinds.function.sixbar.exact_pairs import EFFORTS as FOR_PAIRS
from synthesis.kinds.function.sixbar.exact_pairs import PairSearch
from synthesis.kinds.function.sixbar.followers import SixbarFollower, SixbarLimits, follow_sixbar
from synthesis.kinds.function.sixbar.kernels import IS_USED, K, L
from synthesis.kinds.function.sixbar.nine_pair_starts import find_sixbars_through_nine
from synthesis.kinds.function.sixbar.starts import Starts, sample_starts
from synthesis.kinds.function.statement.mechanism_types import Sixbar
from synthesis.model.kind import Progress, scale_progress
from synthesis.results.simplest_type import SOUND_TRANSMISSION_ANGLE

SAMPLE_COUNTS: dict[Sixbar, int] = {"watt_2": 4000, "stephenson_3": 6000, "stephenson_2": 40_000}
"""Number of sampled sixbars by type."""


class Effort(NamedTuple):
    """Effort for one type: number of least-squares descents for a function, and for exact pairs; and number of those
    that continue along valleys."""

    descended: int
    for_exact: int
    valleys: int


FULL_EFFORT = Effort(150, 400, 40)

EFFORTS: dict[Sixbar, Effort] = {
    "watt_2": FULL_EFFORT,
    "stephenson_3": FULL_EFFORT,
    "stephenson_2": Effort(100, 120, 16),
}
"""Effort by type. A Stephenson II, whose configuration must be solved iteratively, takes three times as long."""

MAX_IMPROVED, VALLEY_STEPS = 8, 150
"""Number of sixbars that are optimised until convergence, and number of steps along a valley."""

SAMPLE_POINT_COUNT = 61
"""Number of samples of a function in the least squares, denser towards the ends of the range."""

MINIMAX_SAMPLE_COUNT, SQUARES_SAMPLE_COUNT = 401, 121
"""Numbers of samples at which the maximum error, or the mean square error, is minimised."""

MIN_LIMIT_POINTS = 49
"""Minimum number of inputs over the range of pairs at which limits are checked."""

LIMIT_WEIGHTS = (0.1, 1.0)
"""Weights of limits relative to errors in successive descents."""

MAX_STEPS, DECREASE_TOLERANCE = 80, 1e-7
"""Descent: maximum number of steps, and relative decrease at which it ends."""

MAX_EXACT_STEPS, EXACT_TOLERANCE = 200, 1e-13
"""Last descent to exact pairs: maximum number of steps, and relative decrease at which it ends."""

MAX_ROUNDS, MAX_SQUARE_ROUNDS = 60, 15
"""Maximum number of steps in the final optimisation: linear programs, and a third of the number of quadratic ones."""

SEARCH_SHARE = 0.3
"""Share of the progress assigned to the search before all sixbars through nine pairs are computed."""

MAX_NEAR_ERROR, MAX_REFINABLE_ERROR = 0.1, 1e-6
"""RMS errors at all pairs, radians, of a sixbar through nine of them: below the first it is optimised under all
constraints, below the second it is refined to rounding."""

PAIR_TOLERANCE = math.radians(1e-6)
"""Maximum error at a pair, radians, of a sixbar that counts as meeting the given pairs."""

MAX_FOLLOWED, MAX_FOLLOWED_STEPS = 16, 2000
"""Maximum number of sixbars through nine pairs that are followed along their valleys, and number of steps."""

MAX_SEARCHES, PROMISING_ERROR = 2, 1e-3
"""Maximum number of consecutive searches for pairs, and RMS error, radians, above which no other search follows."""

CONVERGED_ERROR = 1e-10
"""Maximum error, radians, that counts as rounding: no further improvement is possible."""


class SamplePoints(NamedTuple):
    """Sample points of a task, in order of the input.

    ``points`` (4, m) as for :func:`~synthesis.kinds.function.sixbar.residuals.evaluate_rows`; ``dense`` (2, n): inputs
    and outputs at which the criterion measures the error.
    """

    points: Real
    dense: Real


def make_sample_points(task: FunctionTask) -> SamplePoints:
    """Make the sample points of a task."""
    function, exact = task.problem.function, task.problem.aim == "precision"
    if function is not None and not exact:
        # Denser towards the ends, where errors of approximations are largest.
        u = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, SAMPLE_POINT_COUNT))
        weights = np.full(SAMPLE_POINT_COUNT, 1.0 / math.sqrt(SAMPLE_POINT_COUNT))
        square = task.problem.aim == "least_squares"
        if square:
            # Weights equal to the spacing turn the sum into the mean over the range.
            weights = np.sqrt(np.gradient(u) / np.gradient(u).sum())
        limited = np.full(SAMPLE_POINT_COUNT, 1.0 / math.sqrt(SAMPLE_POINT_COUNT))
        dense = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, SQUARES_SAMPLE_COUNT if square else MINIMAX_SAMPLE_COUNT))
        along = function.share_along
        return SamplePoints(np.stack([u, along(u), weights, limited]), np.stack([dense, along(dense)]))
    inputs, outputs = (task.inputs, task.outputs) if exact else (task.sample_inputs, task.sample_outputs)
    order = np.argsort(inputs)
    pairs = np.stack([inputs[order], outputs[order]])
    low, high = (0.0, 1.0) if function is not None else (pairs[0, 0], pairs[0, -1])
    # Limits hold between the pairs, too, at points without an error.
    between = np.setdiff1d(np.linspace(low, high, MIN_LIMIT_POINTS), pairs[0])
    u = np.concatenate([pairs[0], between])
    v = np.concatenate([pairs[1], np.interp(between, *pairs)])
    # Zero weight marks points that have no target.
    weights = np.concatenate([np.full(pairs.shape[1], 1.0 / math.sqrt(pairs.shape[1])), np.zeros(len(between))])
    points = np.stack([u, v, weights, np.full(len(u), 1.0 / math.sqrt(len(u)))])
    return SamplePoints(np.ascontiguousarray(points[:, np.argsort(u)]), pairs)


class SixbarSearch:
    """Search for the sixbars of one task.

    Parameters
    ----------
    task : FunctionTask
        A task with open zeros.
    least : float
        Minimum transmission angle, degrees.
    """

    def __init__(self, task: FunctionTask, least: float | None = None) -> None:
        demanded = task.problem.constraints.min_transmission_angle
        self.least = least if least is not None else SOUND_TRANSMISSION_ANGLE if demanded is None else demanded
        self.task, self.places = task, make_sample_points(task)
        self.exact, self.square = task.problem.aim == "precision", task.problem.aim == "least_squares"
        limits = self.least, task.problem.constraints.max_link_ratio
        self._descents = Descents(self.places.points, *limits)
        self._pairs = PairSearch(self.places.points, *limits, CONVERGED_ERROR)
        self.weighed = 0
        self.remark = ""
        """Statement about all sixbars of a type, for the summary."""

    def find_sixbars(self, name: Sixbar, rng: np.random.Generator, progress: Progress) -> list[SixbarCandidate]:
        """Find the best sixbars of a type, best first."""
        if self.task.problem.function is None and not self.exact:
            reached = self._search_pairs(name, rng, progress)
        else:
            reached = self._descend_starts(
                name, self._sample_starts(name, SAMPLE_COUNTS[name], rng, progress), progress
            )
        improved = [self._optimize_sixbar(one) for one in reached]
        improved.sort(key=lambda one: one.error)
        return [one for one in improved if math.isfinite(one.error)]

    def _sample_starts(
        self, name: Sixbar, count: int, rng: np.random.Generator, progress: Progress, *, wider: bool = False
    ) -> Starts:
        drawn = sample_starts(
            TYPE_NUMBERS[name], self.task, self.places.points[0], self.places.points[1], count, rng, wider=wider
        )
        self.weighed += len(drawn.at)
        progress(0.1, compose("function-sixbars-of-type", count=len(drawn.at), type=name))
        return drawn

    def _search_pairs(self, name: Sixbar, rng: np.random.Generator, progress: Progress) -> list[SixbarCandidate]:
        """Search for sixbars that meet pairs; repeat with new samples if the pairs are almost met."""
        follows = self.task.problem.follows_watts
        searching = scale_progress(progress, 0.0, SEARCH_SHARE) if follows else progress
        reached: list[SixbarCandidate] = []
        for n in range(MAX_SEARCHES):
            # Repeat only if the best is close to exact but not exact.
            if reached and not CONVERGED_ERROR < reached[0].error < PROMISING_ERROR:
                break
            part = scale_progress(searching, n / MAX_SEARCHES, (n + 1) / MAX_SEARCHES)
            drawn = self._sample_starts(name, FOR_PAIRS[name].drawn, rng, part, wider=True)
            reached = select_best(
                [*reached, *self._pairs.find_sixbars(name, drawn, MAX_IMPROVED, rng, part)], MAX_IMPROVED
            )
        # All solutions through nine pairs are computed only if the search failed, since that takes many seconds.
        if follows and not (reached and reached[0].error < CONVERGED_ERROR):
            reached = select_best([*self._solve_nine_pairs(rng, progress), *reached], MAX_IMPROVED)
        return reached

    def _solve_nine_pairs(self, rng: np.random.Generator, progress: Progress) -> list[SixbarCandidate]:
        """Fit the closest of all Watt II sixbars through nine of the pairs to all pairs."""

        def report_share(share: float) -> None:
            done = round(share * SOLUTION_COUNT)
            progress(
                SEARCH_SHARE + (1.0 - SEARCH_SHARE) * share,
                compose("function-paths-to-nine-followed", done=done, count=SOLUTION_COUNT),
            )

        (k, _), (l_, _) = (choices[0] for choices in self.task.scales)
        through = find_sixbars_through_nine(self.places.dense, k, l_, rng, report_share)
        near = [one for one in through.found if one.error < MAX_NEAR_ERROR][:MAX_FOLLOWED]
        reached = select_best(
            (
                self._descents.descend_one(one, 0.0, MAX_EXACT_STEPS, EXACT_TOLERANCE)
                if one.error < MAX_REFINABLE_ERROR
                # Almost exact ones converge quadratically; the others follow their valleys.
                else self._descents.follow_from(one, LIMIT_WEIGHTS[-1], MAX_FOLLOWED_STEPS)
                for one in near
            ),
            MAX_FOLLOWED,
        )
        if through.complete:
            met = sum(self._compute_max_error(one) < PAIR_TOLERANCE for one in reached)
            self.remark = compose(
                # The list was cut off at this number, so more may exist.
                "function-many-watts-meet-pairs" if met == MAX_FOLLOWED else "function-watts-meet-pairs",
                count=SOLUTION_COUNT,
                pairs="nine" if self.places.dense.shape[1] == PAIR_COUNT else "more",
                met=met,
            )
        return reached

    def _descend_starts(self, name: Sixbar, drawn: Starts, progress: Progress) -> list[SixbarCandidate]:
        """Fit starts by least squares to a function, or to exact pairs."""
        effort, descents = EFFORTS[name], self._descents
        begun = select_best_starts(
            name, drawn, descents.costs(name, drawn), effort.for_exact if self.exact else effort.descended
        )
        found = []
        for one in begun:
            for weight in LIMIT_WEIGHTS:
                # A small weight first lets the descent pass through infeasible sixbars.
                one = descents.descend_one(one, weight, MAX_STEPS, DECREASE_TOLERANCE)
            found.append(descents.descend_one(one, 0.0, MAX_EXACT_STEPS, EXACT_TOLERANCE) if self.exact else one)
        reached = select_best(found, effort.valleys)
        progress(0.6, compose("function-improving-sixbars", count=len(begun), type=name))
        if self.exact:
            # With zero weight the valley is followed only by fits that have not met the pairs yet.
            return select_best([descents.follow_from(one, 0.0, 2 * VALLEY_STEPS) for one in reached], effort.valleys)
        return select_best(
            [descents.follow_from(one, LIMIT_WEIGHTS[-1], VALLEY_STEPS) for one in reached], MAX_IMPROVED
        )

    def _compute_max_error(self, one: SixbarCandidate) -> float:
        """Return a sixbar's maximum error, radians, at the dense samples; NaN if it cannot be assembled at one."""
        return float(
            np.abs(follow_sixbar(TYPE_NUMBERS[one.type], one.assembly, one.at, *self.places.dense).errors).max()
        )

    def _optimize_sixbar(self, one: SixbarCandidate) -> SixbarCandidate:
        """Optimise a sixbar by the criterion under all constraints."""
        kind, greatest = TYPE_NUMBERS[one.type], self._compute_max_error(one)
        # Exact pairs, or a rounding error: nothing is left to optimize.
        if self.exact or greatest < CONVERGED_ERROR:
            return one._replace(error=greatest)
        follower = SixbarFollower(kind, one.assembly, *self.places.dense)
        limits = SixbarLimits(self.task, kind, one.assembly, self.places.points[0], self.least, every=self.square)
        free = IS_USED[kind].copy()
        # The final optimization may move open scales.
        free[[K, L]] = self.task.free[5:]
        descent = Descent(self.task, follower, limits, free)
        improve = descent.least_squares if self.square else descent.minimax
        done = improve(one.at, 1.0, MAX_SQUARE_ROUNDS if self.square else MAX_ROUNDS)
        return one._replace(at=done.generator, error=done.error)
