"""A search for sixbars whose output follows a function or meets pairs.

1. Sixbars are drawn and composed (:mod:`~synthesis.kinds.function.sixbar_starts`), some thousand of each type.
2. Those with the least errors that differ descend towards the least squares of errors under limits, by Levenberg and
   Marquardt's method: a few milliseconds each. The best of them go on along the curved valleys in which the least
   squares lie (:mod:`synthesis.numerics.geodesic`).
3. The best of them are improved by the criterion under all limits, as fourbars are
   (:mod:`~synthesis.kinds.function.descent`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.function import sixbar_rows as fit
from synthesis.kinds.function.descent import Descent
from synthesis.kinds.function.sixbar_followers import SixbarFollower, SixbarLimits, followed, greatest_cosine
from synthesis.kinds.function.sixbar_kernels import LOGARITHMIC, NUMBERS, OWN, STEPHENSON_2, STEPHENSON_3, WATT_2, K, L
from synthesis.kinds.function.sixbar_starts import starts
from synthesis.kinds.function.stated_mechanisms import Sixbar
from synthesis.kinds.function.task import FunctionTask
from synthesis.model.kind import Progress
from synthesis.numerics.geodesic import follow_valley
from synthesis.numerics.levenberg import descend
from synthesis.outcome.ranking import distinct
from synthesis.outcome.simplest import SOUND

Real = NDArray[np.float64]

KINDS: dict[Sixbar, int] = {"watt_2": WATT_2, "stephenson_3": STEPHENSON_3, "stephenson_2": STEPHENSON_2}

DRAWN: dict[Sixbar, int] = {"watt_2": 4000, "stephenson_3": 6000, "stephenson_2": 40_000}
"""Sixbars that are drawn of each type."""


class Effort(NamedTuple):
    """Of a type: sixbars that descend by least squares, of a function and of pairs, those of them that go on along
    valleys, and steps of the last ones where pairs may be met by nothing but them."""

    descended: int
    for_pairs: int
    valleys: int
    to_the_end: int


MUCH = Effort(150, 400, 40, 1500)

EFFORTS: dict[Sixbar, Effort] = {"watt_2": MUCH, "stephenson_3": MUCH, "stephenson_2": Effort(100, 120, 16, 500)}
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

APART = 0.05
"""Sixbars differ by this much in the logarithm of a length, an angle or a coordinate."""

MET = 1e-10
"""Greatest error, radians, that is rounding: nothing is left to improve."""


class Found(NamedTuple):
    """A sixbar of the search: its type, assembly and numbers, and its error in the criterion's norm, radians."""

    type: Sixbar
    assembly: int
    at: Real
    error: float


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
        self.weighed = 0

    def of_type(self, name: Sixbar, rng: np.random.Generator, progress: Progress) -> list[Found]:
        """The best sixbars of a type that were found, the best first."""
        kind, points = KINDS[name], self.places.points
        drawn = starts(kind, self.task, points[0], points[1], DRAWN[name], rng)
        costs = np.empty(len(drawn.at))
        fit.weigh(kind, drawn.assemblies, drawn.at, points, greatest_cosine(self.least), costs)
        self.weighed += len(costs)
        order = np.argsort(costs, kind="stable")
        order = order[np.isfinite(costs[order])]
        effort, few = EFFORTS[name], self.task.problem.function is not None and not self.exact
        chosen = order[distinct(_features(kind, drawn.at[order]), effort.descended if few else effort.for_pairs, APART)]
        progress(0.2, f"{len(costs)} sixbars of type {name}")
        begun = [Found(name, int(drawn.assemblies[j]), drawn.at[j], math.inf) for j in chosen]
        reached = _best([self._descended(one) for one in begun], effort.valleys)
        progress(0.6, f"improving the best of {len(begun)} sixbars of type {name}")
        if self.exact:
            # Those that have arrived are left as they are.
            reached = _best([self._along(one, 2 * ALONG) for one in reached], effort.valleys)
        else:
            reached = _best([self._along(one, ALONG) for one in reached], IMPROVED)
        if not few and not self.exact:
            reached = _best([self._along(one, effort.to_the_end) for one in reached], IMPROVED)
        improved = [self._improved(one) for one in reached]
        improved.sort(key=lambda one: one.error)
        return [one for one in improved if math.isfinite(one.error)]

    def _setting(self, one: Found, weight: float) -> tuple[Real, Real]:
        """The unknowns of a sixbar and the setting of its rows, limits having this weight beside errors."""
        kind = KINDS[one.type]
        logs = LOGARITHMIC[kind]
        x = one.at.copy()
        x[logs] = np.log(np.abs(x[logs]))
        setting = np.zeros(fit.SETTING)
        setting[[fit.KIND, fit.ASSEMBLY, fit.SIGN_K, fit.SIGN_L]] = kind, one.assembly, *np.sign(one.at[[K, L]])
        setting[[fit.COSINE, fit.STRICT]] = greatest_cosine(self.least), weight
        ratio = self.task.problem.constraints.max_link_ratio
        setting[fit.RATIO] = math.log(fit.WIDEST if ratio is None else ratio) - fit.INSIDE
        setting[fit.FREE :] = OWN[kind]
        setting[[fit.FREE + K, fit.FREE + L]] = 0.0
        return x, setting

    def _descended(self, one: Found) -> Found:
        """The least squares from a start, with its error and what is lacking of the limits."""
        x, setting = self._setting(one, 0.0)
        state, none, points = one.at[-1:].copy(), np.zeros(1), self.places.points
        most = fit.most_rows(points.shape[1])
        cost = math.inf
        for weight in WEIGHTS:
            setting[fit.STRICT] = weight
            cost, _ = descend(fit.rows, x, points, setting, none, state, most, STEPS, TOLERANCE)
        if self.exact:
            setting[fit.STRICT] = 0.0
            cost, _ = descend(fit.rows, x, points, setting, none, state, most, EXACT_STEPS, EXACT_TOLERANCE)
        return self._reached(one, x, setting, state, cost)

    def _along(self, one: Found, steps: int) -> Found:
        """A sixbar farther along the valley that it is in."""
        x, setting = self._setting(one, 0.0 if self.exact else WEIGHTS[-1])
        state, points = one.at[-1:].copy(), self.places.points
        most = fit.most_rows(points.shape[1])
        cost = follow_valley(fit.rows, x, points, setting, np.zeros(1), state, most, steps)
        return self._reached(one, x, setting, state, cost)

    def _reached(self, one: Found, x: Real, setting: Real, state: Real, cost: float) -> Found:
        at = np.empty(NUMBERS)
        fit.unlogged(KINDS[one.type], x, setting, state, at)
        return one._replace(at=at, error=math.sqrt(2.0 * cost))

    def _improved(self, one: Found) -> Found:
        """A sixbar improved by the criterion, under all limits."""
        kind = KINDS[one.type]
        errors = followed(kind, one.assembly, one.at, *self.places.dense).errors
        if self.exact or np.abs(errors).max() < MET:
            return one._replace(error=float(np.abs(errors).max()))
        follower = SixbarFollower(kind, one.assembly, *self.places.dense)
        limits = SixbarLimits(self.task, kind, one.assembly, self.places.points[0], self.least, every=self.square)
        free = OWN[kind].copy()
        free[[K, L]] = self.task.free[5:]
        descent = Descent(self.task, follower, limits, free)
        improve = descent.least_squares if self.square else descent.minimax
        done = improve(one.at, 1.0, ROUNDS_OF_SQUARES if self.square else ROUNDS)
        return one._replace(at=done.generator, error=done.error)


def _best(found: list[Found], most: int) -> list[Found]:
    """The best of some that differ, of one type."""
    ordered = sorted((one for one in found if math.isfinite(one.error)), key=lambda one: one.error)
    if not ordered:
        return []
    table = np.array([one.at for one in ordered])
    return [ordered[n] for n in distinct(_features(KINDS[ordered[0].type], table), most, APART)]


def _features(kind: int, at: Real) -> NDArray[np.complex128]:
    """What tells sixbars of a type apart, as :func:`~synthesis.outcome.ranking.distinct` takes it."""
    logs = LOGARITHMIC[kind]
    features = at[:, :-1].copy()
    features[:, logs[:-1]] = np.log(np.abs(features[:, logs[:-1]]))
    return features.astype(np.complex128)
