"""Motion generation by sixbars that contain a given chain of three links, completed by two constraining cranks.

Chains with random values for what is open are sampled and improved
(:mod:`synthesis.kinds.motion.sixbar.chain_rounds`), for at most five positions.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar import candidate_value
from synthesis.kinds.motion.sixbar.chain_rounds import ChainSearch
from synthesis.kinds.motion.sixbar.limits import MAX_RATIO, MAX_REACH
from synthesis.kinds.motion.sixbar.summary import describe_sixbars
from synthesis.kinds.motion.sixbar.topologies import TOPOLOGIES, SixbarCandidates
from synthesis.kinds.motion.statement.mechanism_types import Sixbar
from synthesis.kinds.motion.task.positions import MotionTask, make_motion_task
from synthesis.kinds.motion.task.ranking import make_ranking
from synthesis.kinds.motion.task.target_poses import make_target_poses
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.answer import LinkageDesign, SixbarMechanism
from synthesis.model.linkage.problem import Region
from synthesis.model.linkage.sixbars import build_sixbar
from synthesis.results.candidate_log import DEFECT_REASONS, CandidateLog
from synthesis.results.ranking import select_distinct
from synthesis.results.simplest_type import SOUND_TRANSMISSION_ANGLE

MAX_ROUNDS, MIN_ROUNDS = 16, 2
"""Maximum and minimum number of rounds."""

EXTENSION_FACTOR = 4
"""Bound of the rounds once a sixbar is feasible, relative to those until then, since one shows how hard the problem is.
"""

CHAIN_REACH_FACTOR = 2.0
"""Minimum of the default reach, relative to the longest given length or distance of the chain."""

ANGLE_MARGIN = 0.5
"""Margin, degrees, added to a required transmission angle, because the angle is smaller between the sampled steps."""

MIN_SEPARATION = 0.1
"""Minimum separation of distinct sixbars: the largest distance between corresponding joints, in task sizes."""

ATTEMPTS_PER_DESIGN, MIN_ATTEMPTS, WORKSPACE_ATTEMPTS = 4, 20, 150
"""Maximum number of verified sixbars: per requested design, its lower bound, and that if obstacles, planes or forces
matter, which the search ignores."""

GRASHOF_CLASSES = "any", "crank_rocker", "double_crank", "double_rocker", "non_grashof"
"""Grashof classes in the kernel's numbering."""

UNBOUNDED_BOX = np.array([-np.inf, np.inf, -np.inf, np.inf])


class ChainSolver:
    """Search for the sixbars of one problem that contain its chain."""

    def __init__(self, problem: MotionProblem, types: tuple[Sixbar, ...]) -> None:
        self.problem = problem
        self.task, self.target = make_motion_task(problem), make_target_poses(problem)
        requested = np.array([make.type in types for make in TOPOLOGIES])
        self.chains = ChainSearch(problem, self.task, self.target, requested, _pack_limits(problem, self.task))

    def run(self, progress: Progress) -> SixbarCandidates:
        """Run rounds until there are enough distinct feasible sixbars, or the effort is used up."""
        rng = np.random.default_rng(self.problem.seed)
        found, rounds, number = SixbarCandidates.make_empty(), MAX_ROUNDS, 0
        while number < rounds:
            found = self._select_distinct(found.merge(self.chains.round(rng)))
            number += 1
            feasible = int(np.count_nonzero(found.values >= 1.0))
            if feasible and rounds == MAX_ROUNDS:
                rounds = min(MAX_ROUNDS, EXTENSION_FACTOR * number + MIN_ROUNDS)
            # At least two rounds are made, so that not all sixbars come from one lucky round.
            if number >= MIN_ROUNDS and feasible >= self.problem.max_designs:
                break
            progress(number / MAX_ROUNDS, compose("motion-sixbars-examined", count=self.chains.weighed))
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

    def build_mechanism(self, found: SixbarCandidates, n: int) -> SixbarMechanism:
        """Build a sixbar of the search in the problem's coordinates."""
        make, row = TOPOLOGIES[found.makes[n]], found.joints[n]
        joints = {name: self.task.to_problem(complex(row[k])) for name, k in make.joints.items()}
        joints["P"] = self.task.to_problem(complex(found.bodies[n]))
        # A body angle within a tolerance differs from the requested one.
        angle = None
        if not self.target.exact_mask[0, 2]:
            angle = self.problem.positions[0].angle + math.degrees(float(found.stands[n]))
        return build_sixbar(make.type, joints, make.links, body_angle=angle)


def solve_by_chains(problem: MotionProblem, types: tuple[Sixbar, ...], progress: Progress) -> MotionResult:
    """Solve for sixbars of the given types that contain the problem's chain."""
    search = ChainSolver(problem, types)
    found = search.run(scale_progress(progress, 0.0, 0.9))
    log = CandidateLog[LinkageDesign](problem, DEFECT_REASONS)
    progress(0.9, compose("motion-verifying-best-sixbars", count=search.chains.weighed))
    # Feasible ones come first. The others may violate only default limits, so the verification decides about them.
    rows = np.flatnonzero(found.values >= 0.0)

    def verify_sixbar(n: int) -> LinkageDesign | None:
        return verify(problem, search.build_mechanism(found, n), search.target)

    tried = log.verify_candidates(rows.tolist(), verify_sixbar, enough=problem.max_designs)
    # All others were examined, but not verified.
    log.reject("unsound", search.chains.weighed - tried)
    progress(1.0, compose("motion-verified"))
    return MotionResult(
        designs=log.select_designs(make_ranking(problem)),
        search=log.build_search("constrained_chains"),
        summary=describe_sixbars(problem, log, compose("motion-sixbars-from-chains", count=search.chains.weighed)),
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
