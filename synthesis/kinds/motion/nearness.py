"""Error of fitted positions, and the ranking of designs."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.linkage_answer import LinkageDesign
from synthesis.outcome.ranking import ranked


def error_of(design: LinkageDesign) -> float:
    """Return the RMS over the positions of distance (share of the task's size) and angle (radians) together."""
    return design.metrics.rms_residual


def order_of(problem: MotionProblem) -> Callable[[list[LinkageDesign]], list[LinkageDesign]]:
    """Return the ranking function: a fit without tolerances ranks by error, other problems by quality."""
    return partial(ranked, rank_by=problem.rank_by, own={"quality": error_of} if problem.fitted else None)
