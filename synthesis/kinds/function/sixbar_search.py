"""A search for sixbars whose output follows a function or meets pairs.

1. Sixbars are drawn and composed (:mod:`~synthesis.kinds.function.sixbar_starts`), some thousand of each type.
2. Those with the least errors that differ descend towards the least squares of errors under limits, by Levenberg and
   Marquardt's method: a few milliseconds each. The best of them go on along the curved valleys in which the least
   squares lie (:mod:`synthesis.numerics.geodesic`).
3. The best of them are improved by the criterion under all limits, as fourbars are
   (:mod:`~synthesis.kinds.function.descent`).

Of stated pairs that are to be followed, more are drawn and chosen in more steps
(:mod:`~synthesis.kinds.function.sixbar_pairs`). Where only Watt II sixbars are to follow nine pairs or more, and none
has met them, all through nine of the pairs are computed besides
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
"""Sixbars that are drawn of each type."""


class Effort(NamedTuple):
    """Of a type: sixbars that descend by least squares, of a function and of pairs that are to be met exactly, and
    those of them that go on along valleys."""

    descended: int
    for_exact: int
    valleys: int


MUCH = Effort(150, 400, 40)

EFFORTS: dict[Sixbar, Effort] = {"watt_2": MUCH, "stephenson_3": MUCH, "stephenson_2": Effort(100, 120, 16)}
"""A Stephenson II, whose place is a root, takes three times as long as the others."""

IMPROVED, ALONG = 8, 150
"""Sixbars that are improved to the end, and steps along a valley of those that go along one."""

PLACES = 61
"""Places of a function that least squares look at, closer together at the ends of the range."""

DENSE, DENSE_OF_SQUARES = 401, 121
"""Places at which the greatest error is made small, and its mean square."""

BETWEEN = 49
"""Places between pairs at which limits are kept, at least."""

WEIGHTS = (0.1, 1.0)
"""Of limits beside errors, one descent after the other."""

STEPS, TOLERANCE = 80, 1e-7
"""Of a descent: steps at most, and the relative decrease at which it ends."""

EXACT_STEPS, EXACT_TOLERANCE = 200, 1e-13
"""The same of the last descent to pairs that are to be met."""

ROUNDS, ROUNDS_OF_SQUARES = 60, 15
"""Steps by the criterion at most: linear programs, and as many times three quadratic ones."""

BEFORE_NINE = 0.3
"""Share of the progress before all sixbars through nine pairs are computed."""

NEAR, NEARLY_MET = 0.1, 1e-6
"""Root mean square errors at all pairs of a sixbar through nine, radians: below the first it is followed farther under
all limits, below the second it is brought to rounding."""

MET_AS_STATED = math.radians(1e-6)
"""Greatest error at a pair, radians, of what meets pairs as they are stated."""

FOLLOWED, FOLLOWED_STEPS = 16, 2000
"""So many of these at most are followed, and for so many steps along their valley."""

SEARCHES, NEARLY = 2, 1e-3
"""Searches towards pairs at most, one after the other, and the root mean square error, radians, from which on there is
no other."""

MET = 1e-10
"""Greatest error, radians, that is rounding: nothing is left to improve."""


class Places(NamedTuple):
    """Where sixbars are looked at, in the order of the input.

    ``points`` (4, m) as :func:`~synthesis.kinds.function.sixbar_rows.rows` takes them; ``dense`` (2, n): inputs and
    outputs at which the criterion measures the error.
    """

    points: Real
    dense: Real


def places_of(task: FunctionTask) -> Places:
    """The places of a task."""
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
    """A search of one task.

    Parameters
    ----------
    task : FunctionTask
        Its zeros are open.
    least : float
        Transmission angle, degrees, that is aimed at.
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
        """What is known of all sixbars of a type, in a sentence."""

    def of_type(self, name: Sixbar, rng: np.random.Generator, progress: Progress) -> list[Found]:
        """The best sixbars of a type that were found, the best first."""
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
        """Sixbars towards pairs; where they nearly meet them, so that others might, others are drawn."""
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
        """What the nearest of all Watt II sixbars through nine pairs lead to."""

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
                f" All {grouped(SOLUTIONS)} Watt II sixbars through {nine} were computed, real and complex; {which} "
                "all pairs to a millionth of a degree, without a change of assembly."
            )
        return reached

    def _descended(self, name: Sixbar, drawn: Starts, progress: Progress) -> list[Found]:
        """The least squares that starts lead to: of a function, or of pairs that are to be met exactly."""
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
            # Those that have arrived are left as they are.
            return best([descents.along(one, 0.0, 2 * ALONG) for one in reached], effort.valleys)
        return best([descents.along(one, WEIGHTS[-1], ALONG) for one in reached], IMPROVED)

    def _greatest_error(self, one: Found) -> float:
        """Of a sixbar at the places where the criterion measures, radians; NaN where it does not close at one."""
        return float(np.abs(followed(KINDS[one.type], one.assembly, one.at, *self.places.dense).errors).max())

    def _improved(self, one: Found) -> Found:
        """A sixbar improved by the criterion, under all limits."""
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
