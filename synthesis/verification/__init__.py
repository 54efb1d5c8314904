"""The proof of a design: it is driven by the analysis core and measured, from its dimensions alone.

Nothing that a solver computed on the way is taken over. One module drives the fourbar in closed form, one drives any
other linkage by its closures, and one states what is checked, the same for both.
"""

from __future__ import annotations

from synthesis.designs import FourbarMechanism, LinkageDesign, LinkageMechanism
from synthesis.problems import MotionProblem
from synthesis.verification.fourbar import verify_fourbar
from synthesis.verification.mechanism import verify_mechanism

__all__ = ["verify"]


def verify(problem: MotionProblem, mechanism: LinkageMechanism) -> LinkageDesign | None:
    """Drive a mechanism through a problem's targets and measure it.

    Parameters
    ----------
    problem : MotionProblem
        What was asked.
    mechanism : LinkageMechanism
        Dimensions only; the skeleton is looked at where it is the dimensions, as for sixbars.

    Returns
    -------
    LinkageDesign or None
        The mechanism with its checks and metrics; ``verification.passed`` tells whether it may be used. None where the
        dimensions do not make a linkage that can be assembled and driven at all.
    """
    if isinstance(mechanism, FourbarMechanism):
        return verify_fourbar(problem, mechanism)
    return verify_mechanism(problem, mechanism)
