"""Search for sixbars whose output follows a function or meets pairs.

1. Several thousand sixbars of each type are sampled and composed (:mod:`~synthesis.kinds.function.sixbar_starts`).
2. The best distinct ones are fitted by least squares under constraints with the Levenberg-Marquardt method, a few
   milliseconds each. The best of these continue along the curved valleys that contain the minima
   (:mod:`synthesis.numerics.geodesic`).
3. The best results are optimised by the criterion under all constraints, as fourbars are
   (:mod:`~synthesis.kinds.function.descent`).

For the approximation of given pairs more sixbars are sampled and selected in more stages
(:mod:`~synthesis.kinds.function.sixbar_pairs`). If only Watt II sixbars are requested for nine or more pairs, and none
met them, all sixbars through nine of the pairs are computed too
(:mod:`~synthesis.kinds.function.nine_pair_sixbars`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.function.descent import Descent
from synthesis.kinds.function.nine_pair_sixbars import through_nine
from synthesis.kinds.function.nine_pair_system import PAIRS, SOLUTIONS
from synthesis.kinds.function.sixbar_descents import KINDS, Descents, Found, best, best_starts
from synthesis.kinds.function.sixbar_followers import SixbarFollower, SixbarLimits, followed
from synthesis.kinds.function.sixbar_kernels import OWN, K, L
from synthesis.kinds.function.sixbar_pairs import EFFORTS as FOR_PAIRS
from synthesis.kinds.function.sixbar_pairs import PairSearch
from synthesis.kinds.function.sixbar_starts import Starts, starts
from synthesis.kinds.function.stated_mechanisms import Sixbar
from synthesis.kinds.function.task import FunctionTask
from synthesis.model.counting import agreeing, grouped
from synthesis.model.kind import Progress, part_of
from synthesis.outcome.simplest import SOUND

Real = NDArray[np.float64]

DRAWN: dict[Sixbar, int] = {"watt_2": 4000, "stephenson_3": 6000, "stephenson_2": 40_000}
"""Number of sampled sixbars by type."""


class Effort(NamedTuple):
    """Effort for one type: number of least-squares descents for a function, and for exact pairs; and number of those
    that continue along valleys."""

    descended: int
    for_exact: int
    valleys: int


MUCH = Effort(150, 400, 40)

EFFORTS: dict[Sixbar, Effort] = {"watt_2": MUCH, "stephenson_3": MUCH, "stephenson_2": Effort(100, 120, 16)}
"""Effort by type. A Stephenson II, whose configuration must be solved iteratively, takes three times as long."""

IMPROVED, ALONG = 8, 150
"""Number of sixbars that are optimised until convergence, and number of steps along a valley."""

PLACES = 61
"""Number of samples of a function in the least squares, denser towards the ends of the range."""

DENSE, DENSE_OF_SQUARES = 401, 121
"""Numbers of samples at which the maximum error, or the mean square error, is minimised."""

BETWEEN = 49
"""Minimum number of inputs over the range of pairs at which limits are checked."""

WEIGHTS = (0.1, 1.0)
"""Weights of limits relative to errors in successive descents."""

STEPS, TOLERANCE = 80, 1e-7
"""Descent: maximum number of steps, and relative decrease at which it ends."""

EXACT_STEPS, EXACT_TOLERANCE = 200, 1e-13
"""The same for the last descent to exact pairs."""

ROUNDS, ROUNDS_OF_SQUARES = 60, 15
"""Maximum number of steps in the final optimisation: linear programs, and a third of the number of quadratic ones."""

BEFORE_NINE = 0.3
"""Share of the progress assigned to the search before all sixbars through nine pairs are computed."""

NEAR, NEARLY_MET = 0.1, 1e-6
"""RMS errors at all pairs, radians, of a sixbar through nine of them: below the first it is optimised under all
constraints, below the second it is refined to rounding."""

MET_AS_STATED = math.radians(1e-6)
"""Maximum error at a pair, radians, of a sixbar that counts as meeting the given pairs."""

FOLLOWED, FOLLOWED_STEPS = 16, 2000
"""Maximum number of these that are followed along their valleys, and number of steps."""

SEARCHES, NEARLY = 2, 1e-3
"""Maximum number of consecutive searches for pairs, and RMS error, radians, above which no other search follows."""

MET = 1e-10
"""Maximum error, radians, that counts as rounding: no further improvement is possible."""


class Places(NamedTuple):
    """Sample points of a task, in order of the input.

    ``points`` (4, m) as for :func:`~synthesis.kinds.function.sixbar_rows.rows`; ``dense`` (2, n): inputs and outputs at
    which the criterion measures the error.
    """

    points: Real
    dense: Real


def places_of(task: FunctionTask) -> Places:
    """Make the sample points of a task."""
    function, exact = task.problem.function, task.problem.aim == "precision"
    if function is not None and not exact:
        u = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, PLACES))
        weights = np.full(PLACES, 1.0 / math.sqrt(PLACES))
        square = task.problem.aim == "least_squares"
        if square:
            weights = np.sqrt(np.gradient(u) / np.gradient(u).sum())
        limited = np.full(PLACES, 1.0 / math.sqrt(PLACES))
        dense = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, DENSE_OF_SQUARES if square else DENSE))
        along = function.share_along
        return Places(np.stack([u, along(u), weights, limited]), np.stack([dense, along(dense)]))
    inputs, outputs = (task.inputs, task.outputs) if exact else (task.sample_inputs, task.sample_outputs)
    order = np.argsort(inputs)
    pairs = np.stack([inputs[order], outputs[order]])
    low, high = (0.0, 1.0) if function is not None else (pairs[0, 0], pairs[0, -1])
    between = np.setdiff1d(np.linspace(low, high, BETWEEN), pairs[0])
    u = np.concatenate([pairs[0], between])
    v = np.concatenate([pairs[1], np.interp(between, *pairs)])
    weights = np.concatenate([np.full(pairs.shape[1], 1.0 / math.sqrt(pairs.shape[1])), np.zeros(len(between))])
    points = np.stack([u, v, weights, np.full(len(u), 1.0 / math.sqrt(len(u)))])
    return Places(np.ascontiguousarray(points[:, np.argsort(u)]), pairs)


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
        self.least = least if least is not None else SOUND if demanded is None else demanded
        self.task, self.places = task, places_of(task)
        self.exact, self.square = task.problem.aim == "precision", task.problem.aim == "least_squares"
        limits = self.least, task.problem.constraints.max_link_ratio
        self._descents = Descents(self.places.points, *limits)
        self._pairs = PairSearch(self.places.points, *limits, MET)
        self.weighed = 0
        self.told = ""
        """Statement about all sixbars of a type, for the summary."""

    def of_type(self, name: Sixbar, rng: np.random.Generator, progress: Progress) -> list[Found]:
        """Find the best sixbars of a type, best first."""
        if self.task.problem.function is None and not self.exact:
            reached = self._towards_pairs(name, rng, progress)
        else:
            reached = self._descended(name, self._drawn(name, DRAWN[name], rng, progress), progress)
        improved = [self._improved(one) for one in reached]
        improved.sort(key=lambda one: one.error)
        return [one for one in improved if math.isfinite(one.error)]

    def _drawn(
        self, name: Sixbar, count: int, rng: np.random.Generator, progress: Progress, *, wider: bool = False
    ) -> Starts:
        drawn = starts(KINDS[name], self.task, self.places.points[0], self.places.points[1], count, rng, wider=wider)
        self.weighed += len(drawn.at)
        progress(0.1, f"{len(drawn.at)} sixbars of type {name}")
        return drawn

    def _towards_pairs(self, name: Sixbar, rng: np.random.Generator, progress: Progress) -> list[Found]:
        """Search for sixbars that meet pairs; repeat with new samples if the pairs are almost met."""
        follows = self.task.problem.follows_watts
        searching = part_of(progress, 0.0, BEFORE_NINE) if follows else progress
        reached: list[Found] = []
        for n in range(SEARCHES):
            if reached and not MET < reached[0].error < NEARLY:
                break
            part = part_of(searching, n / SEARCHES, (n + 1) / SEARCHES)
            drawn = self._drawn(name, FOR_PAIRS[name].drawn, rng, part, wider=True)
            reached = best([*reached, *self._pairs.arrived(name, drawn, IMPROVED, rng, part)], IMPROVED)
        if follows and not (reached and reached[0].error < MET):
            reached = best([*self._through_nine(rng, progress), *reached], IMPROVED)
        return reached

    def _through_nine(self, rng: np.random.Generator, progress: Progress) -> list[Found]:
        """Fit the closest of all Watt II sixbars through nine of the pairs to all pairs."""

        def tell(share: float) -> None:
            done = f"{grouped(round(share * SOLUTIONS))} of {grouped(SOLUTIONS)} paths to nine of the pairs followed"
            progress(BEFORE_NINE + (1.0 - BEFORE_NINE) * share, done)

        (k, _), (l_, _) = (choices[0] for choices in self.task.scales)
        through = through_nine(self.places.dense, k, l_, rng, tell)
        near = [one for one in through.found if one.error < NEAR][:FOLLOWED]
        reached = best(
            (
                self._descents.descended(one, 0.0, EXACT_STEPS, EXACT_TOLERANCE)
                if one.error < NEARLY_MET
                else self._descents.along(one, WEIGHTS[-1], FOLLOWED_STEPS)
                for one in near
            ),
            FOLLOWED,
        )
        if through.complete:
            nine = "the nine pairs" if self.places.dense.shape[1] == PAIRS else "nine of the pairs"
            met = sum(self._greatest_error(one) < MET_AS_STATED for one in reached)
            at_least = "at least " if met == FOLLOWED else ""
            which = f"{at_least}{met} of them {agreeing(met, 'meets', 'meet')}" if met else "none of them meets"
            self.told = (
                f" All {grouped(SOLUTIONS)} Watt II solutions for {nine}, real and complex, were computed; {which} "
                "all pairs to a millionth of a degree in one assembly."
            )
        return reached

    def _descended(self, name: Sixbar, drawn: Starts, progress: Progress) -> list[Found]:
        """Fit starts by least squares to a function, or to exact pairs."""
        effort, descents = EFFORTS[name], self._descents
        begun = best_starts(
            name, drawn, descents.costs(name, drawn), effort.for_exact if self.exact else effort.descended
        )
        found = []
        for one in begun:
            for weight in WEIGHTS:
                one = descents.descended(one, weight, STEPS, TOLERANCE)
            found.append(descents.descended(one, 0.0, EXACT_STEPS, EXACT_TOLERANCE) if self.exact else one)
        reached = best(found, effort.valleys)
        progress(0.6, f"improving the best of {len(begun)} sixbars of type {name}")
        if self.exact:
            # With zero weight the valley is followed only by fits that have not met the pairs yet.
            return best([descents.along(one, 0.0, 2 * ALONG) for one in reached], effort.valleys)
        return best([descents.along(one, WEIGHTS[-1], ALONG) for one in reached], IMPROVED)

    def _greatest_error(self, one: Found) -> float:
        """Return a sixbar's maximum error, radians, at the dense samples; NaN if it cannot be assembled at one."""
        return float(np.abs(followed(KINDS[one.type], one.assembly, one.at, *self.places.dense).errors).max())

    def _improved(self, one: Found) -> Found:
        """Optimise a sixbar by the criterion under all constraints."""
        kind, greatest = KINDS[one.type], self._greatest_error(one)
        if self.exact or greatest < MET:
            return one._replace(error=greatest)
        follower = SixbarFollower(kind, one.assembly, *self.places.dense)
        limits = SixbarLimits(self.task, kind, one.assembly, self.places.points[0], self.least, every=self.square)
        free = OWN[kind].copy()
        free[[K, L]] = self.task.free[5:]
        descent = Descent(self.task, follower, limits, free)
        improve = descent.least_squares if self.square else descent.minimax
        done = improve(one.at, 1.0, ROUNDS_OF_SQUARES if self.square else ROUNDS)
        return one._replace(at=done.generator, error=done.error)
