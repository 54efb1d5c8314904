"""Verification of a design: the analysis core drives it and measures it, from its dimensions alone.

No intermediate result of a solver is used. One module drives the fourbar in closed form, another drives any other
linkage by its closures, and a third performs the checks for both.
"""

from __future__ import annotations

import numpy as np

from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.target_poses import TargetPoses, make_target_poses
from synthesis.kinds.motion.verification.fourbar import verify_fourbar
from synthesis.kinds.motion.verification.linkage import verify_mechanism
from synthesis.kinds.motion.verification.reference_pose import move_to_first_target
from synthesis.model.linkage.answer import FourbarMechanism, LinkageDesign, LinkageMechanism

__all__ = ["TargetPoses", "make_target_poses", "verify", "verify_with_tolerance"]


def verify(
    problem: MotionProblem, mechanism: LinkageMechanism, target: TargetPoses | None = None
) -> LinkageDesign | None:
    """Drive a mechanism through a problem's targets and measure it.

    Parameters
    ----------
    problem : MotionProblem
        The problem.
    mechanism : LinkageMechanism
        Only the dimensions are used; the skeleton is used if it defines the dimensions, as for sixbars.
    target : TargetPoses, optional
        Target poses of the problem, from a caller that verifies many mechanisms.

    Returns
    -------
    LinkageDesign or None
        The mechanism with its checks and metrics; ``verification.passed`` states whether it may be used. If the first
        position has a tolerance, the reference is moved to the first target. None if the dimensions do not make a
        linkage that can be assembled and driven.
    """
    target = make_target_poses(problem) if target is None else target
    design = _drive_mechanism(problem, mechanism, target)
    # An exact first position is the reference already.
    if design is None or target.exact_mask[0].all():
        return design
    moved = move_to_first_target(problem, design)
    again = None if moved is None else _drive_mechanism(problem, moved, target)
    # At a toggle rounding may put the first target on the other assembly.
    return design if again is None or again.verification.passed < design.verification.passed else again


def verify_with_tolerance(problem: MotionProblem, mechanism: LinkageMechanism) -> LinkageDesign | None:
    """Verify a linkage whose exact targets are treated as fitted without a limit: for dimensions rounded to a grid."""
    target = make_target_poses(problem)
    return verify(problem, mechanism, target._replace(limits=np.where(target.exact_mask, np.inf, target.limits)))


def _drive_mechanism(problem: MotionProblem, mechanism: LinkageMechanism, target: TargetPoses) -> LinkageDesign | None:
    if isinstance(mechanism, FourbarMechanism):
        return verify_fourbar(problem, mechanism, target)
    return verify_mechanism(problem, mechanism, target)
