"""Error of fitted positions, and the ranking of designs."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.results.ranking import rank_designs


def get_rms_error(design: LinkageDesign) -> float:
    """Return the RMS over the positions of distance (share of the task's size) and angle (radians) together."""
    return design.metrics.rms_residual


def make_ranking(problem: MotionProblem) -> Callable[[list[LinkageDesign]], list[LinkageDesign]]:
    """Return the ranking function: a fit without tolerances ranks by error, other problems by quality."""
    return partial(
        rank_designs, rank_by=problem.rank_by, own={"quality": get_rms_error} if problem.is_least_squares else None
    )
