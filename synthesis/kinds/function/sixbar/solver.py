"""Search for sixbars and eightbars whose output follows a function or meets pairs.

1. Thousands of sixbars are drawn near the function (:mod:`~synthesis.kinds.function.sixbar.starts`).
2. The best descend a few steps at :data:`FEW_POINT_COUNT` of the points, with the constraints as penalties
   (:mod:`synthesis.fit.linkage`).
3. The best distinct ones are followed along their curved valleys (:mod:`synthesis.numerics.geodesic`), and the best of
   these farther, in the end at all points.
4. Approximations are optimised by the criterion under all constraints
   (:mod:`~synthesis.kinds.function.sixbar.criterion`).

The least-squares function of pairs has many minima, and most minima close to zero are not zero. Therefore small batches
of sixbars are drawn, and after each batch the best of all are perturbed along the directions in which the residuals
change least, and followed again (basin hopping, Wales & Doye 1997, doi:10.1021/jp970984n). The search ends when a
sixbar meets the pairs.

If only Watt II sixbars are requested for nine or more pairs, and none met them, all sixbars through nine of the pairs
are computed too (:mod:`~synthesis.kinds.function.sixbar.nine_pair_starts`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.fit.linkage.descent import (
    Fit,
    FitTask,
    descend_softly,
    follow_valleys,
    perturb_along_valley,
    sort_fits,
)
from synthesis.fit.linkage.setting import RATIO
from synthesis.fit.linkage.topology import FUNCTION_SIXBARS, Topology, list_generators
from synthesis.kinds.function.fourbar.task import FunctionTask
from synthesis.kinds.function.nine_pairs.system import PAIR_COUNT, SOLUTION_COUNT
from synthesis.kinds.function.sixbar.criterion import MAX_LAST_ROUNDS, MAX_ROUNDS, optimize_sixbar
from synthesis.kinds.function.sixbar.fits import (
    SixbarCandidate,
    build_fit_task,
    build_packer,
    compute_max_cosine,
    evaluate_errors,
)
from synthesis.kinds.function.sixbar.nine_pair_starts import find_sixbars_through_nine
from synthesis.kinds.function.sixbar.starts import draw_starts
from synthesis.kinds.function.statement.mechanism_types import Multiloop
from synthesis.model.kind import Progress, scale_progress
from synthesis.numerics.augmented_lagrangian import MIN_WEIGHT
from synthesis.results.ranking import select_distinct
from synthesis.results.simplest_type import SOUND_TRANSMISSION_ANGLE


class Effort(NamedTuple):
    """Effort of a batch: number of drawn sixbars; for each stage at few points, numbers of sixbars and of steps; the
    same at all points; and number of perturbations."""

    drawn: int
    descended: tuple[int, int]
    followed: tuple[int, int]
    followed_farther: tuple[int, int]
    followed_to_the_end: tuple[int, int]
    hops: int


PAIR_EFFORT = Effort(3000, (150, 20), (75, 100), (16, 400), (8, 300), 32)
"""Effort of a batch to meet pairs."""

FUNCTION_EFFORT = Effort(6000, (300, 40), (100, 60), (24, 150), (8, 200), 96)
"""Effort to approximate a function, or to meet a few pairs exactly, for which many sixbars exist."""

PLACED_EFFORT = FUNCTION_EFFORT._replace(followed_to_the_end=(40, 200))
"""The same if the place is limited, which is chosen after the search: many of the best linkages cannot be placed."""

MIN_BATCHES, MAX_BATCHES, PROMISING_ERROR = 4, 16, 1e-3
"""Batches for pairs: minimum number before the search gives up, maximum number, and RMS error of the nearest sixbar,
radians, above which it gives up after the minimum."""

FEW_POINT_COUNT = 15
"""Number of points in the first descents and valleys."""

START_ANGLE_SLACK = 8.0
"""Degrees by which the transmission angle of a start may be below its limit."""

FEW_STEPS, ALL_STEPS = 12, 24
"""Number of equal steps of the input at which the constraints are penalties, at few and at all points."""

BEST_COUNT = 2
"""Number of sixbars whose maximum error is decreased to the end."""

POOL_SIZE = 16
"""Number of sixbars from which the search goes on after a batch."""

HOP_GROUP, MAX_HOP_STEPS, HOP_SHARE = 8, 150, 0.35
"""Number of perturbations at a time, steps along the valley after each, and probability that the best sixbar is
perturbed. Otherwise the next one is chosen with the same probability, and so on."""

MIN_SEPARATION = 0.1
"""Minimum separation of distinct sixbars, in ground lengths."""

OPEN_SCALE_COUNT = 4
"""Number of values tried of a scale that is open between limits; the optimisation by the criterion moves them."""

SAMPLE_POINT_COUNT = 61
"""Number of samples of a function in the least squares, denser towards the ends of the range."""

MINIMAX_SAMPLE_COUNT, SQUARES_SAMPLE_COUNT = 401, 121
"""Numbers of samples at which the maximum error, or the mean square error, is minimised."""

MAX_EXACT_STEPS, EXACT_TOLERANCE = 200, 1e-13
"""Last descent to exact pairs: maximum number of steps, and relative decrease at which it ends."""

SEARCH_SHARE = 0.3
"""Share of the progress assigned to the search before all sixbars through nine pairs are computed."""

MAX_NEAR_ERROR, MAX_REFINABLE_ERROR = 0.1, 1e-6
"""RMS errors at all pairs, radians, of a sixbar through nine of them: below the first it is optimised under all
constraints, below the second it is refined to rounding."""

PAIR_TOLERANCE = math.radians(1e-6)
"""Maximum error at a pair, radians, of a sixbar that counts as meeting the given pairs."""

MAX_FOLLOWED, MAX_FOLLOWED_STEPS = 16, 2000
"""Maximum number of sixbars through nine pairs that are followed along their valleys, and number of steps."""

MET_ERROR = 5e-9
"""RMS error at few pairs, radians, that ends the perturbations, a third of :data:`PAIR_TOLERANCE`."""

NEAR_ERROR, NEAREST_COUNT, MAX_NEAREST_STEPS = 1e-7, 4, 1000
"""RMS error at few pairs, radians, below which the nearest sixbars are followed to the end of their valleys; their
number, and number of steps."""


class SamplePoints(NamedTuple):
    """Sample points of a task, in order of the input.

    ``inputs``, ``outputs`` and ``roots`` (m,), roots of weights whose sum is 1, are fitted; ``dense`` (2, n) are inputs
    and outputs at which the criterion measures the error.
    """

    inputs: Real
    outputs: Real
    roots: Real
    dense: Real

    @property
    def reference(self) -> float:
        """Input of the reference position."""
        return float(self.inputs[len(self.inputs) // 2])

    def select_few(self) -> SamplePoints:
        """Return evenly spread points, the ends among them."""
        m = len(self.inputs)
        rows = np.unique(np.round(np.linspace(0, m - 1, min(m, FEW_POINT_COUNT))).astype(int))
        return SamplePoints(
            self.inputs[rows], self.outputs[rows], np.full(len(rows), 1.0 / math.sqrt(len(rows))), self.dense
        )


def make_sample_points(task: FunctionTask) -> SamplePoints:
    """Make the sample points of a task."""
    function, exact = task.problem.function, task.problem.aim == "precision"
    if function is not None and not exact:
        # Denser towards the ends, where errors of approximations are largest.
        u = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, SAMPLE_POINT_COUNT))
        roots = np.full(SAMPLE_POINT_COUNT, 1.0 / math.sqrt(SAMPLE_POINT_COUNT))
        square = task.problem.aim == "least_squares"
        if square:
            # Weights equal to the spacing turn the sum into the mean over the range.
            roots = np.sqrt(np.gradient(u) / np.gradient(u).sum())
        dense = 0.5 - 0.5 * np.cos(np.linspace(0.0, math.pi, SQUARES_SAMPLE_COUNT if square else MINIMAX_SAMPLE_COUNT))
        along = function.share_along
        return SamplePoints(u, along(u), roots, np.stack([dense, along(dense)]))
    inputs, outputs = (task.inputs, task.outputs) if exact else (task.sample_inputs, task.sample_outputs)
    order = np.argsort(inputs)
    pairs = np.stack([inputs[order], outputs[order]])
    return SamplePoints(pairs[0], pairs[1], np.full(len(order), 1.0 / math.sqrt(len(order))), pairs)


class SixbarSearch:
    """Search for the sixbars of one task.

    Parameters
    ----------
    task : FunctionTask
        A task with open zeros.
    ratio : float
        Maximum link ratio.
    """

    def __init__(self, task: FunctionTask, ratio: float) -> None:
        problem = task.problem
        demanded = problem.constraints.min_transmission_angle
        self.least = SOUND_TRANSMISSION_ANGLE if demanded is None else demanded
        self.task, self.points = task, make_sample_points(task)
        self.few = self.points.select_few()
        self.pack_limits = build_packer(problem, self.least, ratio)
        self.exact = problem.aim == "precision"
        self.meets_pairs = problem.function is None and not self.exact
        self.weighed = 0
        self.remark = ""
        """Statement about all sixbars of a type, for the summary."""

    def find_sixbars(self, name: Multiloop, rng: np.random.Generator, progress: Progress) -> list[SixbarCandidate]:
        """Find the best sixbars of a type, best first."""
        follows = self.task.problem.follows_watts
        searching = scale_progress(progress, 0.0, SEARCH_SHARE) if follows else progress
        choices, reached = self._list_scales(rng), list[SixbarCandidate]()
        for n, scales in enumerate(choices):
            part = scale_progress(searching, n / len(choices), (n + 1) / len(choices))
            reached += self._search_scales(name, scales, len(choices), rng, part)
        reached.sort(key=lambda one: one.error)
        # All solutions through nine pairs are computed only if the search failed, since that takes many seconds.
        if follows and not (reached and reached[0].error < PAIR_TOLERANCE):
            reached = self._select_best([*self._solve_nine_pairs(rng, progress), *reached])
        improved = [self._optimize(one) for one in reached]
        improved.sort(key=lambda one: one.error)
        if self.task.problem.aim == "minimax" and improved and improved[0].error > PAIR_TOLERANCE:
            # The maximum error decreases slowly in the end, along a curved valley.
            improved[:BEST_COUNT] = [self._optimize(one, MAX_LAST_ROUNDS) for one in improved[:BEST_COUNT]]
            improved.sort(key=lambda one: one.error)
        return [one for one in improved if math.isfinite(one.error)]

    def _optimize(self, one: SixbarCandidate, rounds: int = MAX_ROUNDS) -> SixbarCandidate:
        """Optimise a sixbar by the criterion, with at most ``rounds`` linear programs."""
        return optimize_sixbar(self.task, one, self.points.dense, self.pack_limits, rounds)

    def _list_scales(self, rng: np.random.Generator) -> list[tuple[float, float]]:
        """Return pairs of scales: all given ones, or some of those within their limits."""
        sides = [
            [
                float(low + (high - low) * share)
                for low, high in choice
                for share in (rng.random(OPEN_SCALE_COUNT) if low < high else [0.0])
            ]
            for choice in self.task.scales
        ]
        chosen = [(k, l_) for k in sides[0] for l_ in sides[1]]
        most = OPEN_SCALE_COUNT * max(len(choice) for choice in self.task.scales)
        # Both scales open: a random selection, because all combinations would be too many.
        return chosen if len(chosen) <= most else [chosen[k] for k in rng.choice(len(chosen), most, replace=False)]

    def _search_scales(
        self, name: Multiloop, scales: tuple[float, float], shared: int, rng: np.random.Generator, progress: Progress
    ) -> list[SixbarCandidate]:
        """Search with given scales, for pairs until a sixbar meets them."""
        search = _ScaleSearch(list_generators(name), scales, self)
        effort, batches = (PAIR_EFFORT, MAX_BATCHES) if self.meets_pairs else (FUNCTION_EFFORT, 1)
        if effort is FUNCTION_EFFORT and self.task.problem.limits_place:
            effort = PLACED_EFFORT
        reached: list[Fit] = []
        for n in range(batches):
            part = scale_progress(progress, n / batches, (n + 1) / batches)
            search.run_batch(name, effort, shared, rng, part)
            hopeless = n + 1 >= MIN_BATCHES and search.nearest_error > PROMISING_ERROR
            if search.nearest_error < NEAR_ERROR or hopeless or n + 1 == batches:
                reached = search.follow_to_the_end(*effort.followed_to_the_end)
            # At few points a sixbar may meet pairs and constraints that it does not meet at all of them.
            if hopeless or (reached and self._meets_pairs(name, reached[0], scales)):
                break
        if self.exact:
            reached = search.meet_exactly(reached)
        return [self._build_candidate(name, fit, scales) for fit in reached]

    def _build_candidate(self, name: Multiloop, fit: Fit, scales: tuple[float, float]) -> SixbarCandidate:
        return SixbarCandidate(name, fit, self.points.inputs, self.points.reference, scales, measure_rms(fit))

    def _meets_pairs(self, name: Multiloop, fit: Fit, scales: tuple[float, float]) -> bool:
        """Return whether a fit meets all pairs."""
        one = self._build_candidate(name, fit, scales)
        return one.error < PAIR_TOLERANCE and compute_max_error(one, self.points.dense) < PAIR_TOLERANCE

    def _select_best(self, found: Sequence[SixbarCandidate]) -> list[SixbarCandidate]:
        return sorted(found, key=lambda one: one.error)[:MAX_FOLLOWED]

    def _solve_nine_pairs(self, rng: np.random.Generator, progress: Progress) -> list[SixbarCandidate]:
        """Fit the closest of all Watt II sixbars through nine of the pairs to all pairs."""

        def report_share(share: float) -> None:
            done = round(share * SOLUTION_COUNT)
            progress(
                SEARCH_SHARE + (1.0 - SEARCH_SHARE) * share,
                compose("function-paths-to-nine-followed", done=done, count=SOLUTION_COUNT),
            )

        scales = self.task.scales[0][0][0], self.task.scales[1][0][0]
        through = find_sixbars_through_nine(self.points.dense, *scales, rng, report_share)
        near = [one for one in through.found if one.error < MAX_NEAR_ERROR][:MAX_FOLLOWED]
        reached = []
        for one in near:
            task = self.build_task(one.topology, scales, self.points, one.reference, ALL_STEPS)
            # Almost exact ones converge quadratically; the others follow their valleys.
            if one.error < MAX_REFINABLE_ERROR:
                fits = descend_softly([one.fit], task, MAX_EXACT_STEPS, EXACT_TOLERANCE, MIN_WEIGHT)
            else:
                fits = follow_valleys([one.fit], task, MAX_FOLLOWED_STEPS)
            reached += [replace(one, fit=fit, error=measure_rms(fit)) for fit in sort_fits(fits)]
        if through.complete:
            met = sum(compute_max_error(one, self.points.dense) < PAIR_TOLERANCE for one in reached)
            self.remark = compose(
                # The list was cut off at this number, so more may exist.
                "function-many-watts-meet-pairs" if met == MAX_FOLLOWED else "function-watts-meet-pairs",
                count=SOLUTION_COUNT,
                pairs="nine" if self.points.dense.shape[1] == PAIR_COUNT else "more",
                met=met,
            )
        return reached

    def build_task(
        self, topology: Topology, scales: tuple[float, float], points: SamplePoints, reference: float, steps: int
    ) -> FitTask:
        """Build the fit of a topology to points with given scales."""
        rotations = scales[0] * (points.inputs - reference)
        return build_fit_task(topology, rotations, scales[1] * points.outputs, points.roots, self.pack_limits, steps)


class _ScaleSearch:
    """Search for linkages of some topologies with given scales.

    ``pool`` are the best distinct fits at few points, the nearest first, and ``unperturbed`` those before they were
    perturbed, which belong to more valleys.
    """

    def __init__(self, topologies: Sequence[Topology], scales: tuple[float, float], search: SixbarSearch) -> None:
        self.topologies, self.search, self.few, self.points = topologies, search, search.few, search.points
        self.scale, self.pool, self.unperturbed = scales[1], list[Fit](), list[Fit]()
        reference = self.points.reference
        self.few_rotations = scales[0] * (self.few.inputs - reference)
        self.rotations = scales[0] * (self.points.inputs - reference)
        # Several topologies are chains of dyads, whose tasks are the same.
        self.few_task = search.build_task(topologies[0], scales, self.few, reference, FEW_STEPS)
        self.task = search.build_task(topologies[0], scales, self.points, reference, ALL_STEPS)

    @property
    def nearest_error(self) -> float:
        """RMS error of the nearest fit at few points, radians."""
        return measure_rms(self.pool[0]) if self.pool else math.inf

    def run_batch(
        self, name: Multiloop, effort: Effort, shared: int, rng: np.random.Generator, progress: Progress
    ) -> None:
        """Draw, descend and follow sixbars into the pool, and perturb the pool."""
        search = self.search
        drawn, keep = math.ceil(effort.drawn / shared), math.ceil(effort.descended[0] / shared)
        starts: list[Fit] = []
        for topology in self.topologies:
            starts += draw_starts(
                topology,
                self.few_rotations,
                self.scale * self.few.outputs,
                compute_max_cosine(max(search.least - START_ANGLE_SLACK, 0.0)),
                float(search.pack_limits(topology)[RATIO]),
                math.ceil(drawn / len(self.topologies)),
                keep,
                int(rng.integers(2**31)),
            )
        starts = sort_fits(starts)[:keep]
        search.weighed += drawn
        linkages = compose("function-linkages-of-type", count=drawn, type=name)
        progress(0.1, linkages)
        found = descend_softly(starts, self.few_task, effort.descended[1])
        progress(0.3, compose("function-following-linkages", linkages=linkages))
        for count, steps in (effort.followed, effort.followed_farther):
            found = follow_valleys(select_distinct_fits(found, math.ceil(count / shared)), self.few_task, steps)
        self.pool = select_distinct_fits([*self.pool, *found], POOL_SIZE)
        progress(0.7, compose("function-improving-linkages", linkages=linkages))
        self.unperturbed = self.pool[: effort.followed_to_the_end[0]]
        self._perturb_pool(effort.hops, rng)
        if MET_ERROR < self.nearest_error < NEAR_ERROR:
            nearest = follow_valleys(self.pool[:NEAREST_COUNT], self.few_task, MAX_NEAREST_STEPS)
            self.pool = select_distinct_fits([*nearest, *self.pool[NEAREST_COUNT:]], POOL_SIZE)

    def _perturb_pool(self, hops: int, rng: np.random.Generator) -> None:
        """Improve the pool by random perturbations until a fit meets the points."""
        for _ in range(hops // HOP_GROUP):
            if not self.pool or self.nearest_error < MET_ERROR:
                break
            # Geometric choice: mostly the best, sometimes another to leave its basin.
            ranks = np.minimum(rng.geometric(HOP_SHARE, HOP_GROUP), len(self.pool)) - 1
            moved = [perturb_along_valley(self.pool[k], self.few_task, rng) for k in ranks]
            followed = follow_valleys(moved, self.few_task, MAX_HOP_STEPS)
            self.pool = select_distinct_fits([*self.pool, *followed], POOL_SIZE)

    def follow_to_the_end(self, count: int, steps: int) -> list[Fit]:
        """Follow the nearest fits at all points; return distinct ones, the nearest first."""
        near = [self._move_to_points(fit) for fit in [*self.pool[: count // 2], *self.unperturbed]]
        return select_distinct_fits(follow_valleys(near, self.task, steps), count)

    def _move_to_points(self, fit: Fit) -> Fit:
        """Return a fit at few points with the inputs at all points."""
        if not fit.topology.triad:
            return fit._replace(inputs=self.rotations)
        return fit._replace(inputs=np.interp(self.points.inputs, self.few.inputs, fit.inputs))

    def meet_exactly(self, fits: Sequence[Fit]) -> list[Fit]:
        """Meet the points without regard to limits, where sixbars do not meet them under the limits."""
        ended = descend_softly(fits, self.task, MAX_EXACT_STEPS, EXACT_TOLERANCE, MIN_WEIGHT)
        return sort_fits(ended)


def compute_max_error(one: SixbarCandidate, dense: Real) -> float:
    """Return a sixbar's maximum error, radians, at inputs and outputs (2, n); infinite if it does not reach one."""
    evaluated = evaluate_errors(one, *dense)
    return math.inf if evaluated is None else float(np.abs(evaluated[1]).max())


def measure_rms(fit: Fit) -> float:
    """Return the RMS error of a fit, radians, with the violations of its constraints."""
    return math.sqrt(2.0 * fit.cost)


def select_distinct_fits(fits: Sequence[Fit], count: int) -> list[Fit]:
    """Return distinct fits of one topology, the nearest first, at most ``count``."""
    ordered = sort_fits(fits)
    if not ordered:
        return []
    features = np.array([_compute_features(fit) for fit in ordered])
    return [ordered[k] for k in select_distinct(features, count, MIN_SEPARATION)]


def _compute_features(fit: Fit) -> Complex:
    """Return the joints in a frame in which equal linkages agree."""
    places, topology = fit.x[0::2] + 1j * fit.x[1::2], fit.topology
    pivots = places[list(topology.fixed_pivots)]
    at = (places[list(topology.pin_names)] - pivots[0]) / (pivots[1] - pivots[0])
    # The second fourbar of a Watt II turns and grows freely about O4.
    if topology is FUNCTION_SIXBARS["watt_2"]:
        own = slice(4, 7)
        at[own] = (at[own] - at[2]) / (at[5] - at[2])
    return np.asarray(at)
