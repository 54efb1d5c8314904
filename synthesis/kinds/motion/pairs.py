"""Pairs of an input and an output dyad: from clouds of dyads to the fourbars that are worth verifying.

A side whose dyads are determined has a few; a side with remaining freedom is a cloud, sampled from its families
(:mod:`synthesis.kinds.motion.choices`). All pairs are screened (:mod:`synthesis.kinds.motion.screening`), and the best
distinct ones are driven and verified.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.motion.areas import side_areas
from synthesis.kinds.motion.choices import Cloud, side_dyads
from synthesis.kinds.motion.demanded import Demanded
from synthesis.kinds.motion.dyads import Dyads
from synthesis.kinds.motion.forces import bearable, looked_at
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.room import affordable, fits
from synthesis.kinds.motion.screening import SHORTEST_LINK, Screening, demands, screen
from synthesis.kinds.motion.sections import SliderDyad
from synthesis.kinds.motion.stated_dyads import DyadChoices
from synthesis.kinds.motion.task import MotionTask, motion_task
from synthesis.kinds.motion.verification import verify
from synthesis.model.linkage_answer import LinkageDesign
from synthesis.model.linkage_statement import Constraints
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.outcome.ranking import widest_apart

CLOUD_PAIR = 1200
"""Number of dyads per side if both sides are open: 1.4 million pairs."""

CLOUD_SINGLE = 40_000
"""Number of dyads of an open side if the other is determined."""

CURVE_PAIR, CURVE_SINGLE = 1600, 8000
"""The same two numbers for Burmester's curve, which has only one dimension to fill but extends far."""

SHORTLIST = 4000
"""Number of best-scored pairs from which distinct ones are selected."""

SWEPT_POOL = 10_000
"""Collision-test at most this many of the best pairs and the same number of the others."""

SWEPT_AT_ONCE, FITTING = 1000, 500
"""Batch size of the collision test, of the best pairs and of the others, and the number of clear pairs that ends it."""

WEIGHED_POOL, WEIGHED_AT_ONCE, ENOUGH = 8000, 500, 500
"""Force check: maximum number of the best pairs (and the same number of the others), batch size of each, and the number
of pairs within the limits that ends it."""

APART = 0.25 * 0.5 ** np.arange(6)
"""Minimum separations of distinct designs, tried in turn: the largest distance between corresponding joints, in task
sizes. The first value that yields enough designs is used."""

GOOD = 0.6
"""Minimum score, relative to the best, of a design that is returned for variety."""

GOOD_POOL = 20_000
"""Maximum number of good pairs considered for variety; more are thinned out evenly, since they lie densely."""

FAR_APART = 2.0 * 0.5 ** (0.5 * np.arange(12))
"""Separations of designs returned for variety, in task sizes, tried in turn until enough good designs are found."""

ATTEMPTS = 5
"""Maximum number of verified pairs per requested design: verification rarely rejects a pair that passed screening."""

LEAST_ATTEMPTS = 100
"""Minimum number of pairs tried before a search gives up."""


@dataclass(frozen=True)
class Pairs:
    """The pairs of input and output dyads of one problem."""

    problem: MotionProblem
    task: MotionTask
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
    def alike(self) -> bool:
        """Whether both sides have the same dyads, each of which may be the input."""
        return self.clouds[0] is self.clouds[1]

    @property
    def sampled(self) -> bool:
        """Whether some dyads are sampled from families."""
        return any(cloud.sampled for cloud in self.clouds)

    @property
    def sliders(self) -> tuple[SliderDyad, ...]:
        """Sliders among the dyads of determined sides."""
        return self.clouds[0].sliders + self.clouds[1].sliders

    @property
    def lacking(self) -> tuple[str, Cloud] | None:
        """Name and cloud of the first side without any dyad; None if both sides have some."""
        named = zip(("input", "output"), self.clouds, strict=True)
        return next(((name, cloud) for name, cloud in named if not len(cloud.dyads.fixed)), None)

    def verified(self, target: Demanded, pair: tuple[int, int]) -> LinkageDesign | str | None:
        """Build and verify the linkage of an input and an output dyad."""
        o2, a = self._pivots(self.problem.input_side, self.inputs, pair[0])
        o4, b = self._pivots(self.problem.output_side, self.outputs, pair[1])
        joints = FourbarConfiguration(o2, a, b, o4, self.task.origin)
        if not joints.has_no_link_below(SHORTEST_LINK):
            return "degenerate"
        return verify(self.problem, fourbar_mechanism(joints), target)

    def _pivots(self, side: DyadChoices, dyads: Dyads, n: int) -> tuple[complex, complex]:
        """Return both pivots of a dyad in the problem's coordinates; given pivots keep their exact values."""
        fixed = self.task.pivot(side.fixed_pivot, complex(dyads.fixed[n]))
        return fixed, self.task.pivot(side.moving_pivot, complex(dyads.moving[n]))

    def screened(self, constraints: Constraints, least_transmission_angle: float) -> Screening:
        """Screen all pairs against the constraints and a minimum transmission angle in degrees."""
        wanted = demands(constraints, self.task, least_transmission_angle, self.problem.rank_by)
        return screen(self.task, self.inputs, self.outputs, wanted)

    def best(self, screening: Screening) -> list[tuple[int, int]]:
        """Select the pairs to verify: first the best one and good ones that differ widely, for variety.

        The best-scored distinct pairs follow, as replacements for those that verification rejects. If the ranking is
        not by quality, only these are returned, because the client wants the first in that order.
        """
        screening = self._bearable(self._with_room(screening))
        score = screening.score.ravel()
        # Most pairs are infeasible: searching only the feasible ones takes a tenth of the time.
        shortlist = np.flatnonzero(score > 0.0)
        if len(shortlist) > SHORTLIST:
            shortlist = shortlist[np.argpartition(-score[shortlist], SHORTLIST)[:SHORTLIST]]
        best = self._apart(screening, shortlist, max(ATTEMPTS * self.problem.max_designs, LEAST_ATTEMPTS), APART)
        if self.problem.rank_by != "quality" or not best:
            return best
        good = np.flatnonzero(score >= GOOD * score.max())
        good = np.union1d(good[:: -(-len(good) // GOOD_POOL)], shortlist[score[shortlist].argmax()])
        offered = self._apart(screening, good, self.problem.max_designs, FAR_APART)
        return list(dict.fromkeys([*offered, *best]))

    def _with_room(self, screening: Screening) -> Screening:
        """Drop the pairs that hit an obstacle, and those outside the pool that is tested for collisions."""
        if self.problem.space is None or not self.problem.space.swept:
            return screening
        score = screening.score.ravel()
        sound = np.flatnonzero(score > 0.0)
        best = sound[np.argsort(-score[sound], kind="stable")]
        # The best pairs lie close together and may all hit the same obstacle, so test some of the others too.
        rest = best[SWEPT_POOL :: -(-len(best) // SWEPT_POOL) or 1]
        fitting, portions = np.zeros_like(score), SWEPT_POOL // SWEPT_AT_ONCE
        for k in range(affordable(self.problem.space, portions)):
            looked = np.concatenate([best[:SWEPT_POOL][k * SWEPT_AT_ONCE :][:SWEPT_AT_ONCE], rest[k::portions]])
            i, j = np.unravel_index(looked, screening.score.shape)
            joints = [self.inputs.fixed[i], self.inputs.moving[i], self.outputs.moving[j], self.outputs.fixed[j]]
            kept = looked[fits(self.problem, self.task, np.stack(joints, axis=1))] if len(looked) else looked
            fitting[kept] = score[kept]
            # If forces are limited too, the force check will drop some of these: test the whole pool.
            if np.count_nonzero(fitting) >= FITTING and not looked_at(self.problem):
                break
        return screening._replace(score=fitting.reshape(screening.score.shape))

    def _bearable(self, screening: Screening) -> Screening:
        """Drop the pairs that violate a force limit, or are outside the tested pool, as in :meth:`_with_room`."""
        if not looked_at(self.problem):
            return screening
        score = screening.score.ravel()
        sound = np.flatnonzero(score > 0.0)
        best = sound[np.argsort(-score[sound], kind="stable")]
        light = np.zeros_like(score)
        portions = WEIGHED_POOL // WEIGHED_AT_ONCE
        rest = best[WEIGHED_POOL :: -(-len(best) // WEIGHED_POOL) or 1]
        for k in range(portions):
            weighed = np.concatenate([best[:WEIGHED_POOL][k::portions], rest[k::portions]])
            i, j = np.unravel_index(weighed, screening.score.shape)
            joints = [self.inputs.fixed[i], self.inputs.moving[i], self.outputs.moving[j], self.outputs.fixed[j]]
            kept = weighed[bearable(self.problem, self.task, np.stack(joints, axis=1))]
            light[kept] = score[kept]
            if np.count_nonzero(light) >= ENOUGH:
                break
        return screening._replace(score=light.reshape(screening.score.shape))

    def _apart(
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
        return [(int(i[k]), int(j[k])) for k in widest_apart(joints, count, aparts)]


def pairs_of_dyads(problem: MotionProblem) -> Pairs:
    """Find the dyads of both sides; if only one side is open, it gets a larger cloud."""
    task = motion_task(problem)
    rng = np.random.default_rng(problem.seed)
    pair, single = (CURVE_PAIR, CURVE_SINGLE) if len(task.points) == 4 else (CLOUD_PAIR, CLOUD_SINGLE)
    clouds = [side_dyads(task, problem, 0, rng, pair)]
    areas = side_areas(problem)
    alike = problem.input_side == problem.output_side and areas[0] == areas[1]
    clouds.append(clouds[0] if alike and not clouds[0].sampled else side_dyads(task, problem, 1, rng, pair))
    for k in (0, 1):
        if clouds[k].sampled and not clouds[1 - k].sampled:
            clouds[k] = side_dyads(task, problem, k, rng, single)
    return Pairs(problem, task, (clouds[0], clouds[1]))
