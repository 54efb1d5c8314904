"""Sixbars from 3R chains with two constraining cranks (:mod:`chain_kernels`): sample chains and improve the best.

All sixbars of each sampled chain are evaluated, and the best chains are improved by random steps. Two to four positions
are completed to five by sampled poses between them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.motion import chain_kernels as kernels
from synthesis.kinds.motion.chain_draws import drawn_chains, drawn_poses, needed
from synthesis.kinds.motion.demanded import Demanded, Real
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar_makes import Found
from synthesis.kinds.motion.stated_mechanisms import Chain
from synthesis.kinds.motion.task import MotionTask

CHAINS, CLIMBING, STEPS = 1500, 40, 200
"""Number of chains sampled per round, number of those that are improved, and maximum number of steps of each."""

KEPT = 4000
"""Maximum number of candidates kept per round."""


class ChainSearch:
    """Rounds of chains for one problem.

    Attributes
    ----------
    weighed : int
        Number of sixbars evaluated so far.
    """

    def __init__(
        self, problem: MotionProblem, task: MotionTask, target: Demanded, wanted: NDArray[np.bool_], limits: Real
    ) -> None:
        self.problem, self.task, self.target = problem, task, target
        self.wanted, self.limits = wanted, limits
        self.chain = Chain() if problem.chain is None else problem.chain
        self.weighed = 0

    def round(self, rng: np.random.Generator) -> Found:
        """Sample one set of chains and improve the best of them."""
        poses = drawn_poses(self.task, self.target, rng, CHAINS)
        chains, free = drawn_chains(self.task, poses, self.chain, self.problem.constraints.fixed_pivot_region, rng)
        given = kernels.Given(poses.points, poses.turns, poses.demanded, needed(self.task), self.wanted, self.limits)
        joints, makes, owners = np.empty((KEPT, 7), np.complex128), np.empty(KEPT, np.int64), np.empty(KEPT, np.int64)
        results = kernels.Results(joints, makes, np.empty(KEPT), np.zeros(4), owners)
        kernels.searched(chains, rng.normal(size=(STEPS, 6)) * free, CLIMBING, given, results, np.empty(CHAINS))
        self.weighed += int(results.found[2])
        rows = int(results.found[1])
        own = owners[:rows]
        return Found(makes[:rows], joints[:rows], poses.points[own, 0], poses.stands[own], results.scores[:rows])
