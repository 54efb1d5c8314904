"""Motion generation by sixbars: descents that stay on their branch, and constrained chains if a chain is given.

Descents from random linkages (:mod:`~synthesis.kinds.motion.sixbar.descent_rounds`) find sixbars for almost all
problems, including many that random chains (:mod:`~synthesis.kinds.motion.sixbar.chain_rounds`) do not solve in hours.
Chains are sampled if one is given. They alternate with descents if a Grashof class, a full rotation, a region or a box
is required, which a descent ignores or reaches with difficulty. Chains support at most five positions. If positions are
fitted without tolerances, the candidates with the smallest errors are fitted by least squares until convergence
(:mod:`~synthesis.kinds.motion.sixbar.least_squares`). All returned designs are driven and verified like any linkage.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose, join_messages
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar import candidate_value
from synthesis.kinds.motion.sixbar.chain_rounds import ChainSearch
from synthesis.kinds.motion.sixbar.descent_rounds import BranchSearch
from synthesis.kinds.motion.sixbar.least_squares import compute_fit_value
from synthesis.kinds.motion.sixbar.topologies import TOPOLOGIES, SixbarCandidates
from synthesis.kinds.motion.statement.mechanism_types import Sixbar
from synthesis.kinds.motion.statement.positions import MAX_EXACT_POSITIONS
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.kinds.motion.task.ranking import get_rms_error, make_ranking
from synthesis.kinds.motion.task.target_poses import make_target_poses
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.answer import LinkageDesign, SixbarMechanism
from synthesis.model.linkage.problem import Region
from synthesis.model.linkage.sixbars import build_sixbar
from synthesis.model.linkage.type_choice import UNCLASSED_SIXBAR
from synthesis.results.candidate_log import DEFECT_REASONS, CandidateLog
from synthesis.results.ranking import select_distinct
from synthesis.results.simplest_type import SOUND_TRANSMISSION_ANGLE

CHAIN_ROUND_SHARE, BRANCH_ROUND_SHARE = 1.0 / 16.0, 1.0 / 72.0
"""Share of the search budget that a round of chains, or of branches, uses; the search ends when all is used."""

MIN_ROUNDS = 2
"""Minimum number of rounds."""

EXTENSION_FACTOR, EXTENSION_SHARE = 3.0, 0.1
"""Extension of a search that has feasible sixbars, but too few: this factor of the budget used for the first one, plus
this share."""

MAX_STALE_ROUNDS, MIN_COST_RATIO = 8, 0.97
"""A fit restarts if this many rounds do not lower the cost below this share of its minimum."""

FIT_BUDGET, EXTENDED_FIT_BUDGET = 0.5, 1.1
"""Search budget for fits; and the extended budget if positions are almost met, because an exact solution may exist."""

TARGET_ERROR, PROMISING_ERROR = 1e-6, 1e-4
"""Errors of fits, in task sizes and radians: the search ends when the requested number of fits is below the first, and
is extended when one fit is below the second."""

RELAXATION_START, RELAXATION_PERIOD = 0.5, 3
"""Share of the budget after which, without a feasible sixbar, every third round drops the default limits."""

MAX_REACH, MAX_RATIO = 5.0, 20.0
"""Default limits: maximum distance of two joints of a link, in task sizes, and maximum link ratio."""

CHAIN_REACH_FACTOR = 2.0
"""Minimum of the first limit, relative to the longest given length or distance of the chain."""

ANGLE_MARGIN = 0.5
"""Margin, degrees, added to a required transmission angle, because the angle is smaller between the sampled steps."""

MIN_SEPARATION = 0.1
"""Minimum separation of distinct sixbars: the largest distance between corresponding joints, in task sizes."""

ATTEMPTS_PER_DESIGN, MIN_ATTEMPTS = 4, 20
"""Maximum number of verified sixbars: per requested design, and its lower bound."""

WORKSPACE_ATTEMPTS = 150
"""Minimum number of verified sixbars if obstacles, planes or forces matter, which the search ignores."""

GRASHOF_CLASSES = "any", "crank_rocker", "double_crank", "double_rocker", "non_grashof"
"""Grashof classes in the kernel's numbering."""

UNBOUNDED_BOX = np.array([-np.inf, np.inf, -np.inf, np.inf])


class SixbarSearch:
    """Search for the sixbars of one problem."""

    def __init__(self, problem: MotionProblem, types: tuple[Sixbar, ...]) -> None:
        self.problem, self.types = problem, types
        self.task, self.target = make_motion_task(problem), make_target_poses(problem)
        requested = np.array([make.type in types for make in TOPOLOGIES])
        limits = _pack_limits(problem, self.task)
        self.chains = ChainSearch(problem, self.task, self.target, requested, limits)
        self.branches = BranchSearch(problem, self.task, self.target, requested, limits)

    @property
    def candidate_count(self) -> int:
        """Number of sixbars examined so far."""
        return self.chains.weighed + self.branches.descents

    @property
    def method(self) -> str:
        """Names of the search methods used."""
        counts = (self.branches.descents, "held_branches"), (self.chains.weighed, "constrained_chains")
        return ", ".join(name for count, name in counts if count) or "held_branches"

    def run(self, progress: Progress) -> SixbarCandidates:
        """Run rounds until there are enough distinct feasible sixbars, or the budget is used up."""
        rng = np.random.default_rng(self.problem.seed)
        constraints = self.problem.constraints
        regions = constraints.fixed_pivot_region, constraints.moving_pivot_region, self.problem.space
        mixed = (
            constraints.full_rotation or constraints.grashof != "any" or any(region is not None for region in regions)
        )
        # A Stephenson II contains no chain, so chains cannot help it.
        mixed = mixed and len(self.problem.positions) <= MAX_EXACT_POSITIONS and self.types != (UNCLASSED_SIXBAR,)
        found = SixbarCandidates.make_empty()
        spent, until, n = 0.0, 1.0, 0
        while spent < until:
            # Alternate, because neither search dominates for these constraints.
            if self.problem.chain is not None or (mixed and n % 2):
                found, spent = self._select_distinct(found.merge(self.chains.round(rng))), spent + CHAIN_ROUND_SHARE
            else:
                sound = bool(np.any(found.values >= 1.0))
                relaxed = spent >= RELAXATION_START and not sound and n % RELAXATION_PERIOD == 0
                found = self._select_distinct(found.merge(self.branches.round(rng, relaxed=relaxed)))
                spent += BRANCH_ROUND_SHARE
            n += 1
            sound_ones = int(np.count_nonzero(found.values >= 1.0))
            # One feasible sixbar shows how hard the problem is: bound the rest of the search by that effort.
            if sound_ones and until == 1.0:
                until = min(1.0, (1.0 + EXTENSION_FACTOR) * spent + EXTENSION_SHARE)
            # At least two rounds are made, so that not all sixbars come from one lucky round.
            if n >= MIN_ROUNDS and sound_ones >= self.problem.max_designs:
                break
            progress(min(spent, 1.0), compose("motion-sixbars-examined", count=self.candidate_count))
        return found

    def fit(self, progress: Progress) -> SixbarCandidates:
        """Run rounds until enough feasible sixbars meet all positions or the budget is used; smallest errors first."""
        rng = np.random.default_rng(self.problem.seed)
        found = SixbarCandidates.make_empty()
        least, since, n, share = math.inf, 0, 0, 0.0
        until, enough, nearly = FIT_BUDGET, compute_fit_value(TARGET_ERROR), compute_fit_value(PROMISING_ERROR)
        while n * BRANCH_ROUND_SHARE < until:
            relaxed = n * BRANCH_ROUND_SHARE >= RELAXATION_START * FIT_BUDGET and not bool(np.any(found.values >= 1.0))
            met = self.branches.round(rng, relaxed=relaxed)
            # Candidates that meet all positions (values of 2 and more) rank before those that miss any.
            values = np.where(met.values >= 1.0, 1.0 + met.values, met.values)
            found = self._select_distinct(found.merge(met._replace(values=values)))
            n += 1
            if np.count_nonzero(found.values >= 2.0) >= self.problem.max_designs:
                return found
            since = 0 if self.branches.min_cost < MIN_COST_RATIO * least else since + 1
            least = min(least, self.branches.min_cost)
            # The pools no longer improve: converge what they contain and start afresh.
            if since >= MAX_STALE_ROUNDS or n * BRANCH_ROUND_SHARE >= until:
                found = self._select_distinct(found.merge(self.branches.fit_pools()))
                if np.count_nonzero(found.values >= enough) >= self.problem.max_designs:
                    return found
                least, since = math.inf, 0
                # A nearly exact fit suggests that an exact solution exists, so search on.
                if np.any(found.values >= nearly):
                    until = EXTENDED_FIT_BUDGET
            # The budget may be extended, but reported progress must not decrease.
            share = max(share, min(n * BRANCH_ROUND_SHARE / until, 1.0))
            progress(share, compose("motion-sixbars-examined", count=self.candidate_count))
        return found

    def _select_distinct(self, found: SixbarCandidates) -> SixbarCandidates:
        """Select the best distinct candidates, feasible ones first."""
        ordered = found.select_rows(np.argsort(-found.values, kind="stable"))
        # A large offset per topology makes candidates of different topologies distinct.
        apart = np.concatenate([ordered.joints, 1e6 * ordered.makes[:, None].astype(np.complex128)], axis=1)
        most = max(ATTEMPTS_PER_DESIGN * self.problem.max_designs, MIN_ATTEMPTS)
        if self.problem.space is not None or self.problem.constraints.force_limits or self.problem.layout is not None:
            most = max(most, WORKSPACE_ATTEMPTS)
        return ordered.select_rows(np.array(select_distinct(apart, most, MIN_SEPARATION), np.int64))

    def mechanism(self, found: SixbarCandidates, n: int) -> SixbarMechanism:
        """Build a sixbar of the search in the problem's coordinates."""
        make, row = TOPOLOGIES[found.makes[n]], found.joints[n]
        joints = {name: self.task.to_problem(complex(row[k])) for name, k in make.joints.items()}
        joints["P"] = self.task.to_problem(complex(found.bodies[n]))
        # A body angle within a tolerance differs from the requested one.
        angle = None
        if not self.target.exact_mask[0, 2]:
            angle = self.problem.positions[0].angle + math.degrees(float(found.stands[n]))
        return build_sixbar(make.type, joints, make.links, body_angle=angle)


def solve_sixbars(problem: MotionProblem, types: tuple[Sixbar, ...], progress: Progress) -> MotionResult:
    """Solve for sixbars of the given types that carry the body through two to sixty positions."""
    search = SixbarSearch(problem, types)
    looked = scale_progress(progress, 0.0, 0.9)
    found = search.fit(looked) if problem.is_least_squares else search.run(looked)
    sifting = CandidateLog[LinkageDesign](problem, DEFECT_REASONS)
    progress(0.9, compose("motion-verifying-best-sixbars", count=search.candidate_count))
    # Feasible ones come first. The others may violate only default limits, so the verification decides about them.
    rows = np.flatnonzero(found.values >= 0.0)

    def verify_sixbar(n: int) -> LinkageDesign | None:
        return verify(problem, search.mechanism(found, n), search.target)

    tried = sifting.verify_candidates(rows.tolist(), verify_sixbar, enough=problem.max_designs)
    # All others were examined, but not verified.
    sifting.reject("unsound", search.candidate_count - tried)
    progress(1.0, compose("motion-verified"))
    return MotionResult(
        designs=sifting.select_designs(make_ranking(problem)),
        search=sifting.build_search(search.method),
        summary=_describe_result(sifting, search),
    )


def _pack_limits(problem: MotionProblem, task: MotionTask) -> Real:
    """Pack the limits of a problem for the kernel, as :data:`~synthesis.kinds.motion.sixbar.candidate_value.LIMITS`."""
    constraints = problem.constraints
    angle = (
        SOUND_TRANSMISSION_ANGLE
        if constraints.min_transmission_angle is None
        # Below 90°, where the cosine would demand perfection.
        else min(constraints.min_transmission_angle + ANGLE_MARGIN, 89.9)
    )
    lengths = constraints.link_length
    shortest = 0.0 if lengths is None else lengths.min / task.size
    longest = np.inf if lengths is None or lengths.max is None else lengths.max / task.size
    ratio = MAX_RATIO if constraints.max_link_ratio is None else constraints.max_link_ratio
    # A given chain sets the scale of the mechanism; the default limit must not exclude it.
    reach = max(MAX_REACH, CHAIN_REACH_FACTOR * problem.chain_size / task.size)
    room = None if problem.space is None else problem.space.shrink_box_for_joints()
    limits = np.empty(candidate_value.LIMITS.size)
    limits[candidate_value.MIN_SINE] = math.sin(math.radians(angle))
    limits[candidate_value.MAX_REACH], limits[candidate_value.MAX_RATIO] = reach, ratio
    limits[candidate_value.MIN_LENGTH], limits[candidate_value.MAX_LENGTH] = shortest, longest
    limits[candidate_value.GRASHOF_CLASS] = GRASHOF_CLASSES.index(constraints.grashof)
    limits[candidate_value.FULL_TURN] = constraints.full_rotation
    limits[candidate_value.FIXED_BOX] = _make_box(constraints.fixed_pivot_region, task)
    limits[candidate_value.MOVING_BOX] = _make_box(constraints.moving_pivot_region, task)
    limits[candidate_value.JOINT_BOX] = UNBOUNDED_BOX if room is None else _scale_box(room, task)
    return limits


def _make_box(region: Region | None, task: MotionTask) -> Real:
    return UNBOUNDED_BOX if region is None else _scale_box((*region.x, *region.y), task)


def _scale_box(sides: tuple[float, float, float, float], task: MotionTask) -> Real:
    """Convert a box (x min, x max, y min, y max) to task coordinates."""
    left, right, low, high = sides
    corners = task.to_task(complex(left, low)), task.to_task(complex(right, high))
    return np.array([corners[0].real, corners[1].real, corners[0].imag, corners[1].imag])


def _describe_result(sifting: CandidateLog[LinkageDesign], search: SixbarSearch) -> str:
    effort = _describe_effort(search)
    if not sifting.passed:
        return join_messages(
            [
                compose("motion-no-sixbar-feasible", effort=effort),
                sifting.describe_reasons().strip(),
                compose("motion-unproven"),
            ]
        )
    found = [compose("motion-sixbars-verified", effort=effort, designs=len(sifting.passed))]
    if search.problem.is_least_squares:
        share = 100.0 * min(map(get_rms_error, sifting.passed))
        found.append(compose("motion-best-error", error=f"{share:.3g}"))
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    return join_messages([*found, compose("motion-best-transmission-angle", angle=f"{best:.1f}")])


def _describe_effort(search: SixbarSearch) -> str:
    """Return the beginning of a sentence: the numbers of sixbars that each method examined."""
    descents, weighed = search.branches.descents, search.chains.weighed
    fitted = compose("motion-sixbars-fitted", count=descents)
    from_chains = compose("motion-sixbars-from-chains", count=weighed)
    if descents and weighed:
        return compose("motion-both-sixbar-searches", first=fitted, second=from_chains)
    if descents or weighed:
        return fitted if descents else from_chains
    # Only Stephenson II sixbars need a crank before they can be examined.
    return compose("motion-stephenson-2-without-crank")
