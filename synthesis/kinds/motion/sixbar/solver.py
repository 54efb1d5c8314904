"""Motion generation by sixbars and eightbars, fitted to the positions by the engine of :mod:`synthesis.fit.linkage`.

A round, for all topologies of the requested types together:

1. random linkages that close at one input for each position descend on all of their dimensions, with the constraints
   as penalties;
2. those that miss form a pool, whose members hop from basin to basin;
3. those that meet the positions leave the pool. They have freedoms left, which serve a larger transmission angle and
   smaller links as long as the positions stay met.

A linkage that does not close between the positions is refused, and inputs out of order are a violated constraint, so
that fits stay on one branch. If positions are fitted without tolerances, the pool itself converges under enforced
constraints. Given chains are completed by :mod:`synthesis.kinds.motion.sixbar.chain_rounds` instead. All returned
designs are driven and verified like any linkage.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.fit.linkage.closure import trace_linkage
from synthesis.fit.linkage.descent import (
    Fit,
    FitTask,
    build_pose_targets,
    descend_softly,
    fit_constrained,
    hop_basins,
    perturb_evenly,
    settle_inputs,
    sort_fits,
)
from synthesis.fit.linkage.mechanism import build_fitted_linkage
from synthesis.fit.linkage.residuals import SLOT, TARGET_SIZE
from synthesis.fit.linkage.setting import pack_unlimited
from synthesis.fit.linkage.topology import Topology, list_forms
from synthesis.fit.triad_slant import find_min_slant
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar.chain_solver import solve_by_chains
from synthesis.kinds.motion.sixbar.limits import Aims, Limits
from synthesis.kinds.motion.sixbar.starts import draw_starts
from synthesis.kinds.motion.sixbar.summary import describe_sixbars
from synthesis.kinds.motion.statement.mechanism_types import Multiloop
from synthesis.kinds.motion.task.positions import compute_needed_motion, make_motion_task
from synthesis.kinds.motion.task.ranking import make_ranking
from synthesis.kinds.motion.task.target_poses import make_target_poses
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.answer import EightbarMechanism, LinkageDesign, SixbarMechanism
from synthesis.results.candidate_log import DEFECT_REASONS, CandidateLog
from synthesis.results.ranking import select_distinct
from synthesis.verification.body_motion import SMALL_BODY_TURN, compute_ease
from synthesis.verification.measures import compute_quality

STARTS_PER_ROUND, FIRST_STEPS = 240, 60
"""Number of random linkages in a round, over all topologies, and of steps of their descents."""

SAMPLING_WEIGHTS = {
    "watt_1": (4.0, 1.0, 4.0, 1.0),
    "stephenson_1": (1.0, 1.0),
    "stephenson_2": (2.0, 0.5, 0.5),
    "stephenson_3": (3.0,),
    "eightbar": len(list_forms("eightbar", guides=True)) * (1.0,),
}
"""Relative number of random linkages of each topology: largest for those that carry a body through most positions."""

POOL_SIZE, HOPS, HOP_STEPS, GENERATION_COUNT = 30, 30, 60, 16
"""Number of linkages in the pool; of perturbed copies in a generation; of steps of their descents; of generations in a
round. Most of the time is spent near the best linkages."""

HOP_RANK, HOP_SIZE = 8.0, 0.1
"""Mean rank of the linkages that hop, and median size of a hop, task sizes and natural logarithms of steps."""

HALVINGS = 3
"""Number of times that another perturbation of half the size is tried if a linkage does not close."""

SOFT_WEIGHT = 0.2
"""Weight of constraints in the search: with a larger one descents end at the constraints, far from the positions."""

SEARCH_STEP_COUNT, STEP_COUNT, FINAL_STEP_COUNT = 16, 24, 72
"""Numbers of steps of the input at which constraints are penalties in the search and in improvements, and at which they
are enforced in fits and linkages are evaluated."""

COARSE_TOLERANCE, FINE_TOLERANCE, FINAL_DESCENTS = 1e-2, 1e-10, 6
"""Tolerances of descents in the search, where a slow one is left to basin hopping, and of those to the end; and number
of the latter in succession."""

MET_COST = 1e-22
"""Half the sum of squares below which a linkage meets all positions and constraints, up to rounding."""

MAX_ROUNDS, EXTENSION_FACTOR, MIN_ROUNDS = 24, 2, 3
"""Maximum number of rounds. After the first success in round n, at most EXTENSION_FACTOR · n + MIN_ROUNDS rounds are
run, because n shows how hard the problem is. At least MIN_ROUNDS are run, so that not all designs come from one lucky
start."""

RELAXATION_START, RELAXATION_PERIOD = 0.5, 3
"""Share of the rounds after which, without a linkage that meets the positions, every third drops the default limits."""

MET_PER_DESIGN, MIN_MET, MIN_MET_CONSTRAINED = 4, 40, 120
"""Number of linkages that meet the positions at which the search ends: per requested design, and its minimum; and the
same if obstacles, planes or forces matter, which the search ignores."""

IMPROVEMENT_COUNT, IMPROVEMENT_HOP, IMPROVEMENT_DECAY = 14, 0.12, 0.8
"""Improvement of linkages that meet the positions: number of hops, size of the first, and its factor after a failure.
"""

FIT_ROUNDS, STALE_ROUNDS, MIN_COST_RATIO = 14, 2, 0.97
"""Fits: maximum number of rounds; a pool has converged if this many do not lower its least cost below this share."""

TARGET_ERROR, PROMISING_ERROR, FIT_EXTENSION_FACTOR = 1e-6, 1e-4, 2
"""Errors of fits, in task sizes and radians: the search ends when the requested number of fits is below the first, and
is extended by the factor when one fit is below the second, because an exact solution may exist."""

EXACT_ROOT = 3.0
"""Factor of the root of an exact position's weight in a fit, nine in the weight itself."""

PROJECTION_STEPS, PROJECTION_TOLERANCE = 60, 1e-14
"""Number of steps that move a fit onto its exact positions, and their tolerance."""

TOLERANCE_SHARE = 0.98
"""Share of a tolerance that is used; the rest covers rounding and the steps of the drive."""

MIN_SEPARATION = 0.1
"""Minimum separation of distinct sixbars: the largest distance between corresponding joints, in task sizes."""

ATTEMPTS_PER_DESIGN, MIN_ATTEMPTS, CONSTRAINED_ATTEMPTS = 4, 20, 150
"""Maximum number of verified sixbars: per requested design, its lower bound, and that if obstacles, planes or forces
matter."""


class Family(NamedTuple):
    """Linkages of one number of links, which are searched together.

    Attributes
    ----------
    method : str
        Name of the search in answers.
    examined, verifying : str
        Messages of progress.
    fitted : str
        Message with the number of fits, the beginning of the summary.
    """

    method: str
    examined: str
    verifying: str
    fitted: str


SIXBAR_FAMILY = Family(
    method="sixbar_descents",
    examined="motion-sixbars-examined",
    verifying="motion-verifying-best-sixbars",
    fitted="motion-sixbars-fitted",
)

EIGHTBAR_FAMILY = Family(
    method="eightbar_descents",
    examined="motion-eightbars-examined",
    verifying="motion-verifying-best-eightbars",
    fitted="motion-eightbars-fitted",
)


class Candidate(NamedTuple):
    """A fit that meets the positions, the aims that it satisfies, and its value, the larger the better."""

    fit: Fit
    aims: Aims
    value: float


class LinkageSearch:
    """Search for the linkages of one problem and family."""

    def __init__(self, problem: MotionProblem, family: Family, types: tuple[Multiloop, ...]) -> None:
        self.problem, self.family = problem, family
        self.task, self.target = make_motion_task(problem), make_target_poses(problem)
        self.kinds: dict[Topology, str] = {form: kind for kind in types for form in list_forms(kind, guides=True)}
        self.places = {form: (np.array(list(form.pin_names)), 1e6 * n) for n, form in enumerate(self.kinds)}
        self.limits = Limits(problem, self.task)
        self.exact: Real = np.all(self.target.exact_mask, axis=1)
        self.needed = compute_needed_motion(self.task)
        constraints = problem.constraints
        # Constraints that the fits do not know reject many linkages: keep more of them.
        self.has_unfitted_constraints = bool(
            problem.space is not None or problem.layout is not None or constraints.force_limits
        )
        self.descents = 0

    def build_task(self, aims: Aims, steps: int = SEARCH_STEP_COUNT) -> FitTask:
        """Return the fit to all positions with some aims."""
        unit = np.array([self.target.size, self.target.size, 1.0])
        # Infinite tolerances mark fitted coordinates, which aim at the target.
        limits = np.where(np.isfinite(self.target.limits), self.target.limits, 0.0)
        n = len(self.exact)
        roots = np.full(n, 1.0 / math.sqrt(n))
        if self.problem.is_least_squares:
            roots = np.where(self.exact, EXACT_ROOT * roots, roots)
        targets = build_pose_targets(
            self.task.points, np.angle(self.task.turns), TOLERANCE_SHARE * limits / unit, roots
        )
        full_turn = self.problem.constraints.full_rotation
        return FitTask(targets, self.limits.build_packer(aims), full_turn=full_turn, steps=steps, ordered=True)

    def run(self, progress: Progress) -> list[Fit]:
        """Return linkages that meet all positions, the best first."""
        rng = np.random.default_rng(self.problem.seed)
        aims = self.limits.aims, self.limits.relaxed_aims
        tasks, pools = tuple(map(self.build_task, aims)), [list[Fit](), list[Fit]()]
        found: list[Candidate] = []
        enough = MIN_MET_CONSTRAINED if self.has_unfitted_constraints else MIN_MET
        enough = max(enough, MET_PER_DESIGN * self.problem.max_designs)
        rounds, number = MAX_ROUNDS, 0
        while number < rounds and (number < MIN_ROUNDS or len(found) < enough):
            relaxed = number >= RELAXATION_START * MAX_ROUNDS and not found and number % RELAXATION_PERIOD == 0
            met, pools[relaxed] = self._run_round(tasks[relaxed], pools[relaxed], rng)
            number += 1
            if met and not found and not relaxed:
                rounds = min(rounds, EXTENSION_FACTOR * number + MIN_ROUNDS)
            found += [Candidate(fit, aims[relaxed], 0.0) for fit in met]
            found = self._select_distinct(found, enough)
            progress(number / MAX_ROUNDS, compose(self.family.examined, count=self.descents))
        return [one.fit for one in self._improve(found, rng)]

    def _run_round(self, task: FitTask, pool: list[Fit], rng: np.random.Generator) -> tuple[list[Fit], list[Fit]]:
        """Run a round on a pool; return the linkages that meet the positions, and the new pool."""
        starts = self._draw_starts(task, rng)
        fits = descend_softly(starts, task, FIRST_STEPS, COARSE_TOLERANCE, SOFT_WEIGHT)
        met, pool = _take_met([*pool, *fits])
        pool = self._drop_near(pool, met)
        for _ in range(GENERATION_COUNT):
            pool = hop_basins(
                pool[:POOL_SIZE], task, HOPS, HOP_STEPS, rng, HALVINGS, SOFT_WEIGHT, tolerance=COARSE_TOLERANCE,
                goal=MET_COST, rank=HOP_RANK, size=HOP_SIZE, perturb=perturb_evenly,
            )  # fmt: skip
            self.descents += HOPS
            more, pool = _take_met(pool)
            pool = self._drop_near(pool, more)
            met += more
        return met, pool

    def _drop_near(self, pool: Sequence[Fit], met: Sequence[Fit]) -> list[Fit]:
        """Return the fits of a pool that are not near one that meets the positions: they would lead to the same one."""
        if not (pool and met):
            return list(pool)
        ours, theirs = (np.array([self._list_joints(fit) for fit in fits]) for fits in (pool, met))
        distances = np.abs(ours[:, None] - theirs).max(axis=2).min(axis=1)
        return [fit for fit, distance in zip(pool, distances, strict=True) if distance >= MIN_SEPARATION]

    def _draw_starts(self, task: FitTask, rng: np.random.Generator) -> list[Fit]:
        weights = [weight for kind in dict.fromkeys(self.kinds.values()) for weight in SAMPLING_WEIGHTS[kind]]
        starts: list[Fit] = []
        for topology, weight in zip(self.kinds, weights, strict=True):
            starts += draw_starts(topology, task, math.ceil(STARTS_PER_ROUND * weight / sum(weights)), rng)
        self.descents += len(starts)
        return starts

    def _select_distinct(self, found: Sequence[Candidate], most: int) -> list[Candidate]:
        """Return the best distinct candidates."""
        evaluated = map(self._evaluate, found)
        ordered = sorted((one for one in evaluated if one.value > 0.0), key=lambda one: -one.value)
        if not ordered:
            return []
        chosen = select_distinct([self._list_joints(one.fit) for one in ordered], most, MIN_SEPARATION)
        return [ordered[k] for k in chosen]

    def _list_joints(self, fit: Fit) -> Complex:
        """Return the joints of a fit, and a place of its topology far from those of all others."""
        nodes, place = self.places[fit.topology]
        return np.append(fit.x[2 * nodes] + 1j * fit.x[2 * nodes + 1], place)

    def _evaluate(self, one: Candidate) -> Candidate:
        """Return a candidate with its value, the quality of its motion."""
        if one.value:
            return one
        fit, steps = one.fit, np.linspace(0.0, one.fit.inputs[-1], FINAL_STEP_COUNT)
        topology, nodes = fit.topology, fit.topology.nodes
        places, cosines = np.empty((len(steps), len(nodes), 2)), np.zeros((len(steps), len(nodes)))
        trace_linkage(nodes, fit.x, steps, places, cosines)
        z = places[..., 0] + 1j * places[..., 1]
        max_cosine = np.abs(cosines).max()
        # The linkage passes a toggle between the steps of the search.
        if not max_cosine < 1.0:
            return one._replace(value=-1.0)
        if topology.triad:
            max_cosine = max(abs(find_min_slant(*row[list(topology.triad)])[0]) for row in z)
        point = z[:, topology.point]
        heading = np.unwrap(np.angle(z[:, topology.heading] - point))
        first, second = topology.get_direction("input")
        turned = np.unwrap(np.angle(z[:, second] - z[:, first]))
        # Denominators have a floor, so that short motions do not exaggerate the excess.
        excess = max(
            (np.abs(np.diff(point)).sum() - self.needed[0]) / max(self.needed[0], 1.0),
            (np.abs(np.diff(heading)).sum() - self.needed[1]) / max(self.needed[1], SMALL_BODY_TURN),
            0.0,
        )
        pins, arms = (np.abs(np.diff(z[0][pairs], axis=1)) for pairs in (topology.pairs, topology.arms))
        sine = math.sqrt(max(1.0 - float(max_cosine) ** 2, 0.0))
        quality = compute_quality(sine, float(max(pins.max(), arms.max())), float(pins.max() / pins.min()))
        return one._replace(value=quality * float(compute_ease(abs(turned[-1] - turned[0]), float(excess))))

    def _improve(self, found: Sequence[Candidate], rng: np.random.Generator) -> list[Candidate]:
        """Return the candidates after hops that return to the positions, for a larger value; the best first."""
        best, spreads = list(found), [IMPROVEMENT_HOP] * len(found)
        for number in range(IMPROVEMENT_COUNT):
            starts: dict[Aims, list[int]] = {}
            for k, one in enumerate(best):
                # Every third hop keeps the aims, so that the input's rotation and the body's path may improve instead.
                starts.setdefault(one.aims.tighten() if number % 3 else one.aims, []).append(k)
            for aims, rows in starts.items():
                copies = [perturb_evenly(best[k].fit, spreads[k], rng) for k in rows]
                ends = descend_softly(
                    copies, self.build_task(aims, STEP_COUNT), HOP_STEPS, COARSE_TOLERANCE, SOFT_WEIGHT
                )
                self.descents += len(rows)
                for k, end in zip(rows, ends, strict=True):
                    new = self._evaluate(Candidate(end, aims, 0.0)) if end.cost < MET_COST else best[k]
                    if new.value > best[k].value:
                        best[k] = new
                    else:
                        # The next hop stays nearer.
                        spreads[k] *= IMPROVEMENT_DECAY
        return sorted(best, key=lambda one: -one.value)

    def fit(self, progress: Progress) -> list[Fit]:
        """Return linkages that miss the positions least, the nearest first."""
        rng = np.random.default_rng(self.problem.seed)
        task = self.build_task(self.limits.aims)
        found: list[Fit] = []
        pool: list[Fit] = []
        stale, least, most, share = 0, math.inf, FIT_ROUNDS, 0.0
        number = 0
        while number < most:
            met, pool = self._run_round(task, pool, rng)
            number += 1
            found += met
            good = [fit for fit in [*found, *pool] if fit.cost <= 0.5 * TARGET_ERROR**2]
            if len(self._select_fits(good, self.problem.max_designs)) == self.problem.max_designs:
                break
            stale = 0 if pool and pool[0].cost < MIN_COST_RATIO * least else stale + 1
            least = min(least, pool[0].cost) if pool else least
            if stale >= STALE_ROUNDS:
                found += self.converge_fits(pool)
                pool, stale, least = [], 0, math.inf
                if any(fit.cost <= 0.5 * PROMISING_ERROR**2 for fit in found):
                    most = FIT_EXTENSION_FACTOR * FIT_ROUNDS
            # The budget may be extended, but reported progress must not decrease.
            share = max(share, number / most)
            progress(share, compose(self.family.examined, count=self.descents))
        return sort_fits([*found, *self.converge_fits(pool)])

    def converge_fits(self, pool: Sequence[Fit]) -> list[Fit]:
        """Return the fits of a pool at their least squares under enforced constraints, on their exact positions."""
        task = self.build_task(self.limits.bare_aims, FINAL_STEP_COUNT)
        fits = list(pool)
        for _ in range(FINAL_DESCENTS):
            starts = [normalize_heading(fit) for fit in fits]
            fits = sort_fits(descend_softly(starts, task, HOP_STEPS, FINE_TOLERANCE, SOFT_WEIGHT))
        # These descents meet the positions if that is possible at the limits; the other fits violate limits a little.
        met, missed = _take_met(fits)
        ends = [*met, *sort_fits(fit_constrained(missed, task))]
        return self._project_on_exact(ends, task) if self.exact.any() else ends

    def _project_on_exact(self, fits: Sequence[Fit], task: FitTask) -> list[Fit]:
        """Move fits onto their exact positions, which a larger weight alone misses by a little."""
        chosen = np.flatnonzero(self.exact)
        targets = task.targets.reshape(-1, 2, TARGET_SIZE)[chosen].reshape(-1, TARGET_SIZE)
        targets[:, SLOT] = np.repeat(np.arange(len(chosen)), 2)
        # Without limits, because the step is tiny; the verification measures them again.
        exact_task = replace(task, targets=targets, pack_limits=pack_unlimited, steps=0, ordered=False)
        parts = [fit._replace(inputs=fit.inputs[chosen]) for fit in fits]
        ends = descend_softly(parts, exact_task, PROJECTION_STEPS, PROJECTION_TOLERANCE)
        moved = [
            # The cost is that at the old inputs; the verification settles them.
            settle_inputs(fit._replace(x=end.x), task)
            for fit, end in zip(fits, ends, strict=True)
            if end.cost < MET_COST
        ]
        return sort_fits(moved)

    def build_mechanism(self, fit: Fit) -> SixbarMechanism | EightbarMechanism | None:
        """Return the linkage of a fit in the problem's coordinates."""
        angle = None
        # A body angle within a tolerance differs from the requested one.
        if not self.target.exact_mask[0, 2]:
            point, heading = (fit.topology.get_source(node) for node in (fit.topology.point, fit.topology.heading))
            along = fit.x[2 * heading : 2 * heading + 2] - fit.x[2 * point : 2 * point + 2]
            angle = self.problem.positions[0].angle + math.degrees(math.atan2(along[1], along[0]))
        return build_fitted_linkage(self.kinds[fit.topology], fit, self.task.origin, self.task.size, angle)

    def list_mechanisms(self, fits: Sequence[Fit]) -> list[SixbarMechanism | EightbarMechanism]:
        """Return the linkages of distinct fits, in the problem's coordinates, as many as are worth driving."""
        most = max(ATTEMPTS_PER_DESIGN * self.problem.max_designs, MIN_ATTEMPTS)
        most = max(most, CONSTRAINED_ATTEMPTS) if self.has_unfitted_constraints else most
        mechanisms = [self.build_mechanism(fit) for fit in self._select_fits(fits, most)]
        return [mechanism for mechanism in mechanisms if mechanism is not None]

    def _select_fits(self, fits: Sequence[Fit], count: int) -> list[Fit]:
        """Return distinct fits in their order, at most ``count``."""
        if not fits:
            return []
        return [fits[k] for k in select_distinct([self._list_joints(fit) for fit in fits], count, MIN_SEPARATION)]


def normalize_heading(fit: Fit) -> Fit:
    """Return a fit whose heading is at a distance of 1 from the traced point.

    Descents change this distance at random, because nothing depends on it; near 0 they would stop.
    """
    point, heading = (2 * fit.topology.get_source(node) for node in (fit.topology.point, fit.topology.heading))
    x = fit.x.copy()
    along = x[heading : heading + 2] - x[point : point + 2]
    x[heading : heading + 2] = x[point : point + 2] + along / np.hypot(*along)
    return fit._replace(x=x)


def _take_met(fits: Sequence[Fit]) -> tuple[list[Fit], list[Fit]]:
    """Return the fits that meet the positions, and the others, the nearest first."""
    ordered = sort_fits(fits)
    met = sum(fit.cost < MET_COST for fit in ordered)
    return ordered[:met], ordered[met:]


def solve_sixbars(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for sixbars of the requested types that carry the body through two to sixty positions."""
    if problem.chain is not None:
        return solve_by_chains(problem, problem.sixbars, progress)
    return _solve_by_family(problem, SIXBAR_FAMILY, problem.sixbars, progress)


def solve_eightbars(problem: MotionProblem, progress: Progress) -> MotionResult:
    """Solve for eightbars that carry the body through two to sixty positions."""
    return _solve_by_family(problem, EIGHTBAR_FAMILY, ("eightbar",), progress)


def _solve_by_family(
    problem: MotionProblem, family: Family, types: tuple[Multiloop, ...], progress: Progress
) -> MotionResult:  # fmt: skip
    """Solve for linkages of the given types of a family, which are searched together."""
    search = LinkageSearch(problem, family, types)
    search_progress = scale_progress(progress, 0.0, 0.9)
    fits = search.fit(search_progress) if problem.is_least_squares else search.run(search_progress)
    log = CandidateLog[LinkageDesign](problem, DEFECT_REASONS)
    progress(0.9, compose(family.verifying, count=search.descents))
    mechanisms = search.list_mechanisms(fits)

    def verify_linkage(mechanism: SixbarMechanism | EightbarMechanism) -> LinkageDesign | None:
        return verify(problem, mechanism, search.target)

    tried = log.verify_candidates(mechanisms, verify_linkage, enough=problem.max_designs)
    # All others were examined, but not verified.
    log.reject("unsound", max(search.descents - tried, 0))
    progress(1.0, compose("motion-verified"))
    return MotionResult(
        designs=log.select_designs(make_ranking(problem)),
        search=log.build_search(family.method),
        summary=describe_sixbars(problem, log, compose(family.fitted, count=search.descents)),
    )
