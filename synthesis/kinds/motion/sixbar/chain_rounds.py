"""Sixbars from 3R chains with two constraining cranks: sample chains and improve the best.

All sixbars of each sampled chain are evaluated, and the best chains are improved by random steps
(:mod:`synthesis.kinds.motion.sixbar.chain_kernels`). Two to four positions are completed to five by sampled poses
between them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar import chain_kernels as kernels
from synthesis.kinds.motion.sixbar.random_chains import sample_chains, sample_poses
from synthesis.kinds.motion.sixbar.topologies import SixbarCandidates
from synthesis.kinds.motion.statement.mechanism_types import Chain
from synthesis.kinds.motion.task.positions import MotionTask, compute_needed_motion
from synthesis.kinds.motion.task.target_poses import TargetPoses

CHAINS_PER_ROUND, CLIMBER_COUNT, MAX_STEPS = 1500, 40, 200
"""Number of chains sampled per round, number of those that are improved, and maximum number of steps of each."""

MAX_KEPT = 4000
"""Maximum number of candidates kept per round."""


class ChainSearch:
    """Rounds of chains for one problem.

    Attributes
    ----------
    weighed : int
        Number of sixbars evaluated so far.
    """

    def __init__(
        self, problem: MotionProblem, task: MotionTask, target: TargetPoses, requested: NDArray[np.bool_], limits: Real
    ) -> None:
        self.problem, self.task, self.target = problem, task, target
        self.requested, self.limits = requested, limits
        self.chain = Chain() if problem.chain is None else problem.chain
        self.weighed = 0

    def round(self, rng: np.random.Generator) -> SixbarCandidates:
        """Sample one set of chains and improve the best of them."""
        poses = sample_poses(self.task, self.target, rng, CHAINS_PER_ROUND)
        chains, free = sample_chains(self.task, poses, self.chain, self.problem.constraints.fixed_pivot_region, rng)
        given = kernels.ChainConstraints(
            poses.points, poses.turns, poses.demanded, compute_needed_motion(self.task), self.requested, self.limits
        )
        joints, makes, owners = (
            np.empty((MAX_KEPT, 7), np.complex128),
            np.empty(MAX_KEPT, np.int64),
            np.empty(MAX_KEPT, np.int64),
        )
        results = kernels.ChainResults(joints, makes, np.empty(MAX_KEPT), np.zeros(4), owners)
        kernels.search_chains(
            # Given values have no freedom, so their steps are 0.
            chains,
            rng.normal(size=(MAX_STEPS, 6)) * free,
            CLIMBER_COUNT,
            given,
            results,
            np.empty(CHAINS_PER_ROUND),
        )
        self.weighed += int(results.found[2])
        rows = int(results.found[1])
        # Each candidate keeps the sampled poses of its own chain.
        own = owners[:rows]
        return SixbarCandidates(
            makes[:rows], joints[:rows], poses.points[own, 0], poses.stands[own], results.scores[:rows]
        )
