"""Pairs of an input and an output dyad: from clouds of dyads to the fourbars that are worth verifying.

A side whose dyads are determined has a few; a side with remaining freedom is a cloud, sampled from its families
(:mod:`synthesis.kinds.motion.dyads.candidates`). All pairs are screened
(:mod:`synthesis.kinds.motion.exact.screening`), and the best distinct ones are driven and verified.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.motion.dyads.candidates import Cloud, find_side_dyads
from synthesis.kinds.motion.dyads.equations import Dyads
from synthesis.kinds.motion.dyads.finite_sets import SliderDyad
from synthesis.kinds.motion.exact.clearance_filter import check_fourbar_clearance, limit_batches
from synthesis.kinds.motion.exact.force_filter import can_check_forces, check_force_limits
from synthesis.kinds.motion.exact.screening import MIN_LINK_SHARE, Screening, make_screening_constraints, screen
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices
from synthesis.kinds.motion.task.pivot_regions import list_side_areas
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.kinds.motion.task.target_poses import TargetPoses, make_target_poses
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.model.linkage.problem import Constraints
from synthesis.results.ranking import select_most_distinct

PAIRED_CLOUD_SIZE = 1200
"""Number of dyads per side if both sides are open: 1.4 million pairs."""

SINGLE_CLOUD_SIZE = 40_000
"""Number of dyads of an open side if the other is determined."""

PAIRED_CURVE_SIZE, SINGLE_CURVE_SIZE = 1600, 8000
"""Number of dyads on Burmester's curve if both sides are open, and if only one is. The curve has only one dimension to
fill but extends far."""

SHORTLIST_SIZE = 4000
"""Number of best-scored pairs from which distinct ones are selected."""

CLEARANCE_POOL_SIZE = 10_000
"""Maximum number of the best pairs, and of the others, that are tested for collisions."""

CLEARANCE_BATCH_SIZE, ENOUGH_CLEAR_PAIRS = 1000, 500
"""Batch size of the collision test, of the best pairs and of the others, and the number of clear pairs that ends it."""

FORCE_POOL_SIZE, FORCE_BATCH_SIZE, ENOUGH_LIGHT_PAIRS = 8000, 500, 500
"""Force check: maximum number of the best pairs (and the same number of the others), batch size of each, and the number
of pairs within the limits that ends it."""

MIN_SEPARATIONS = 0.25 * 0.5 ** np.arange(6)
"""Minimum separations of distinct designs, tried in turn: the largest distance between corresponding joints, in task
sizes. The first value that yields enough designs is used."""

MIN_SCORE_SHARE = 0.6
"""Minimum score, relative to the best, of a design that is returned for variety."""

MAX_GOOD_PAIRS = 20_000
"""Maximum number of good pairs considered for variety; more are thinned out evenly, since they lie densely."""

WIDE_SEPARATIONS = 2.0 * 0.5 ** (0.5 * np.arange(12))
"""Separations of designs returned for variety, in task sizes, tried in turn until enough good designs are found."""

ATTEMPTS_PER_DESIGN = 5
"""Maximum number of verified pairs per requested design: verification rarely rejects a pair that passed screening."""

MIN_ATTEMPTS = 100
"""Minimum number of pairs tried before a search gives up."""


@dataclass(frozen=True)
class DyadPairs:
    """The pairs of input and output dyads of one problem."""

    problem: MotionProblem
    task: MotionTask
    target: TargetPoses
    clouds: tuple[Cloud, Cloud]

    @property
    def inputs(self) -> Dyads:
        """Dyads of the input side."""
        return self.clouds[0].dyads

    @property
    def outputs(self) -> Dyads:
        """Dyads of the output side."""
        return self.clouds[1].dyads

    @property
    def same_dyads(self) -> bool:
        """Whether both sides have the same dyads, each of which may be the input."""
        return self.clouds[0] is self.clouds[1]

    @property
    def is_sampled(self) -> bool:
        """Whether some dyads are sampled from families."""
        return any(cloud.sampled for cloud in self.clouds)

    @property
    def sliders(self) -> tuple[SliderDyad, ...]:
        """Sliders among the dyads of determined sides."""
        return self.clouds[0].sliders + self.clouds[1].sliders

    @property
    def missing_side(self) -> tuple[str, Cloud] | None:
        """Name (as a message) and cloud of the first side without any dyad; None if both sides have some."""
        named = zip(("motion-input-side", "motion-output-side"), self.clouds, strict=True)
        return next(((name, cloud) for name, cloud in named if not len(cloud.dyads.fixed)), None)

    def verify_pair(self, pair: tuple[int, int]) -> LinkageDesign | str | None:
        """Build and verify the linkage of an input and an output dyad."""
        o2, a = self._resolve_pivots(self.problem.input_side, self.inputs, pair[0])
        o4, b = self._resolve_pivots(self.problem.output_side, self.outputs, pair[1])
        # Too short a link cannot be built.
        joints = FourbarConfiguration(o2, a, b, o4, self.task.origin)
        if not joints.has_no_link_below(MIN_LINK_SHARE):
            return "degenerate"
        return verify(self.problem, build_fourbar(joints), self.target)

    def _resolve_pivots(self, side: DyadChoices, dyads: Dyads, n: int) -> tuple[complex, complex]:
        """Return both pivots of a dyad in the problem's coordinates; given pivots keep their exact values."""
        fixed = self.task.pivot(side.fixed_pivot, complex(dyads.fixed[n]))
        return fixed, self.task.pivot(side.moving_pivot, complex(dyads.moving[n]))

    def screen_pairs(self, constraints: Constraints, least_transmission_angle: float) -> Screening:
        """Screen all pairs against the constraints and a minimum transmission angle in degrees."""
        wanted = make_screening_constraints(constraints, self.task, least_transmission_angle, self.problem.rank_by)
        return screen(self.task, self.inputs, self.outputs, wanted)

    def select_best(self, screening: Screening) -> list[tuple[int, int]]:
        """Select the pairs to verify: first the best one and good ones that differ widely, for variety.

        The best-scored distinct pairs follow, as replacements for those that verification rejects. If the ranking is
        not by quality, only these are returned, because the client wants the first in that order.
        """
        screening = self._filter_by_forces(self._filter_by_clearance(screening))
        score = screening.score.ravel()
        # Most pairs are infeasible: searching only the feasible ones takes a tenth of the time.
        shortlist = np.flatnonzero(score > 0.0)
        if len(shortlist) > SHORTLIST_SIZE:
            shortlist = shortlist[np.argpartition(-score[shortlist], SHORTLIST_SIZE)[:SHORTLIST_SIZE]]
        best = self._select_distinct(
            screening, shortlist, max(ATTEMPTS_PER_DESIGN * self.problem.max_designs, MIN_ATTEMPTS), MIN_SEPARATIONS
        )
        if self.problem.rank_by != "quality" or not best:
            return best
        good = np.flatnonzero(score >= MIN_SCORE_SHARE * score.max())
        # Thin evenly by index, and always keep the best pair itself.
        good = np.union1d(good[:: -(-len(good) // MAX_GOOD_PAIRS)], shortlist[score[shortlist].argmax()])
        offered = self._select_distinct(screening, good, self.problem.max_designs, WIDE_SEPARATIONS)
        return list(dict.fromkeys([*offered, *best]))

    def _filter_by_clearance(self, screening: Screening) -> Screening:
        """Drop the pairs that hit an obstacle, and those outside the pool that is tested for collisions."""
        if self.problem.space is None or not self.problem.space.has_swept_constraints:
            return screening
        score = screening.score.ravel()
        sound = np.flatnonzero(score > 0.0)
        best = sound[np.argsort(-score[sound], kind="stable")]
        # The best pairs lie close together and may all hit the same obstacle, so test some of the others too.
        # Negative floor division rounds up: a stride that covers all of the rest.
        rest = best[CLEARANCE_POOL_SIZE :: -(-len(best) // CLEARANCE_POOL_SIZE) or 1]
        fitting, portions = np.zeros_like(score), CLEARANCE_POOL_SIZE // CLEARANCE_BATCH_SIZE
        for k in range(limit_batches(self.problem.space, portions)):
            looked = np.concatenate(
                [best[:CLEARANCE_POOL_SIZE][k * CLEARANCE_BATCH_SIZE :][:CLEARANCE_BATCH_SIZE], rest[k::portions]]
            )
            i, j = np.unravel_index(looked, screening.score.shape)
            joints = [self.inputs.fixed[i], self.inputs.moving[i], self.outputs.moving[j], self.outputs.fixed[j]]
            kept = (
                looked[check_fourbar_clearance(self.problem, self.task, np.stack(joints, axis=1))]
                if len(looked)
                else looked
            )
            fitting[kept] = score[kept]
            # If forces are limited too, the force check will drop some of these: test the whole pool.
            if np.count_nonzero(fitting) >= ENOUGH_CLEAR_PAIRS and not can_check_forces(self.problem):
                break
        return screening._replace(score=fitting.reshape(screening.score.shape))

    def _filter_by_forces(self, screening: Screening) -> Screening:
        """Drop the pairs that violate a force limit, or are outside the tested pool, as in
        :meth:`_filter_by_clearance`."""
        if not can_check_forces(self.problem):
            return screening
        score = screening.score.ravel()
        sound = np.flatnonzero(score > 0.0)
        best = sound[np.argsort(-score[sound], kind="stable")]
        light = np.zeros_like(score)
        portions = FORCE_POOL_SIZE // FORCE_BATCH_SIZE
        rest = best[FORCE_POOL_SIZE :: -(-len(best) // FORCE_POOL_SIZE) or 1]
        for k in range(portions):
            weighed = np.concatenate([best[:FORCE_POOL_SIZE][k::portions], rest[k::portions]])
            i, j = np.unravel_index(weighed, screening.score.shape)
            joints = [self.inputs.fixed[i], self.inputs.moving[i], self.outputs.moving[j], self.outputs.fixed[j]]
            kept = weighed[check_force_limits(self.problem, self.task, np.stack(joints, axis=1))]
            light[kept] = score[kept]
            if np.count_nonzero(light) >= ENOUGH_LIGHT_PAIRS:
                break
        return screening._replace(score=light.reshape(screening.score.shape))

    def _select_distinct(
        self, screening: Screening, pool: NDArray[np.int64], count: int, aparts: Iterable[float]
    ) -> list[tuple[int, int]]:
        """Select the best-scored pairs of a pool (flat indices) that are far enough apart, best first."""
        score = screening.score.ravel()
        # The index breaks ties, so that the selection is reproducible.
        pool = pool[np.lexsort((pool, -score[pool]))]
        i, j = np.unravel_index(pool, screening.score.shape)
        joints = np.stack(
            [self.inputs.fixed[i], self.inputs.moving[i], self.outputs.moving[j], self.outputs.fixed[j]], axis=1
        )
        return [(int(i[k]), int(j[k])) for k in select_most_distinct(joints, count, aparts)]


def make_pairs(problem: MotionProblem) -> DyadPairs:
    """Find the dyads of both sides; if only one side is open, it gets a larger cloud."""
    task = make_motion_task(problem)
    rng = np.random.default_rng(problem.seed)
    pair, single = (
        (PAIRED_CURVE_SIZE, SINGLE_CURVE_SIZE) if len(task.points) == 4 else (PAIRED_CLOUD_SIZE, SINGLE_CLOUD_SIZE)
    )
    areas = list_side_areas(problem)
    clouds = [find_side_dyads(task, problem, 0, areas[0], rng, pair)]
    alike = problem.input_side == problem.output_side and areas[0] == areas[1]
    # A sampled cloud differs for each side, so that the pairs are more varied.
    clouds.append(
        clouds[0] if alike and not clouds[0].sampled else find_side_dyads(task, problem, 1, areas[1], rng, pair)
    )
    for k in (0, 1):
        if clouds[k].sampled and not clouds[1 - k].sampled:
            # With one determined side the product of both numbers stays the same for a larger cloud.
            clouds[k] = find_side_dyads(task, problem, k, areas[k], rng, single)
    return DyadPairs(problem, task, make_target_poses(problem), (clouds[0], clouds[1]))
