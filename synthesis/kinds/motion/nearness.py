"""How near a linkage comes to positions that are fitted, and the order of designs."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.linkage_answer import LinkageDesign
from synthesis.outcome.ranking import ranked


def error_of(design: LinkageDesign) -> float:
    """The root mean square over the positions of distance (share of the task's size) and angle (radians) together."""
    return design.metrics.rms_residual


def order_of(problem: MotionProblem) -> Callable[[list[LinkageDesign]], list[LinkageDesign]]:
    """The order of designs: a fit without limits is asked to be near; among equally near ones quality decides."""
    return partial(ranked, rank_by=problem.rank_by, own={"quality": error_of} if problem.fitted else None)
