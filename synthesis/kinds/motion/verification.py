"""The proof of a design: it is driven by the analysis core and measured, from its dimensions alone.

Nothing that a solver computed on the way is taken over. One module drives the fourbar in closed form, one drives any
other linkage by its closures, and one states what is checked, the same for both.
"""

from __future__ import annotations

import numpy as np

from synthesis.kinds.motion.demanded import Demanded, demanded
from synthesis.kinds.motion.first_target import at_first_target
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.verify_fourbar import verify_fourbar
from synthesis.kinds.motion.verify_mechanism import verify_mechanism
from synthesis.model.linkage_answer import FourbarMechanism, LinkageDesign, LinkageMechanism

__all__ = ["Demanded", "demanded", "verify", "verify_nearly"]


def verify(problem: MotionProblem, mechanism: LinkageMechanism, target: Demanded | None = None) -> LinkageDesign | None:
    """Drive a mechanism through a problem's targets and measure it.

    Parameters
    ----------
    problem : MotionProblem
        What was asked.
    mechanism : LinkageMechanism
        Dimensions only; the skeleton is looked at where it is the dimensions, as for sixbars.
    target : Demanded, optional
        What the problem demands, ``demanded(problem)``, from a caller that verifies many mechanisms.

    Returns
    -------
    LinkageDesign or None
        The mechanism with its checks and metrics; ``verification.passed`` tells whether it may be used. Where the first
        position may be missed its reference is the first target, whatever it was. None where the dimensions do not
        make a linkage that can be assembled and driven at all.
    """
    target = demanded(problem) if target is None else target
    design = _driven(problem, mechanism, target)
    if design is None or target.held[0].all():
        return design
    moved = at_first_target(problem, design)
    again = None if moved is None else _driven(problem, moved, target)
    # At a toggle rounding may put the first target on the other assembly.
    return design if again is None or again.verification.passed < design.verification.passed else again


def verify_nearly(problem: MotionProblem, mechanism: LinkageMechanism) -> LinkageDesign | None:
    """The same where what is to be met exactly is met as nearly as can be: of linkages on a grid."""
    target = demanded(problem)
    return verify(problem, mechanism, target._replace(limits=np.where(target.held, np.inf, target.limits)))


def _driven(problem: MotionProblem, mechanism: LinkageMechanism, target: Demanded) -> LinkageDesign | None:
    if isinstance(mechanism, FourbarMechanism):
        return verify_fourbar(problem, mechanism, target)
    return verify_mechanism(problem, mechanism, target)
