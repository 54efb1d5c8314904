"""Motion generation: carry a body through given positions."""

from __future__ import annotations

from collections.abc import Sequence

from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.gallery import GALLERY
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.kind import Kind, Progress
from synthesis.model.linkage_answer import LinkageDesign, LinkageMechanism

__all__ = ["KIND"]


def _solve(problem: MotionProblem, progress: Progress) -> MotionResult:
    from synthesis.kinds.motion.solver import solve_motion

    return solve_motion(problem, progress)


def _nearer(problem: MotionProblem, designs: Sequence[LinkageDesign], progress: Progress) -> list[LinkageDesign] | None:
    from synthesis.kinds.motion.solver import continued

    return continued(problem, designs, progress)


def _nearly(problem: MotionProblem, _design: LinkageDesign, mechanism: LinkageMechanism) -> LinkageDesign | None:
    from synthesis.kinds.motion.verification import verify_nearly

    return verify_nearly(problem, mechanism)


def _warm_up() -> None:
    """Compile the kernels of the exact methods by solving the first examples: users wait for these short jobs."""
    for example in KIND.examples[:4]:
        _solve(MotionProblem.model_validate(example), lambda fraction, message: None)


def _brief(problem: MotionProblem) -> bool:
    """Return whether a job is short: exact positions, fourbars only, no driver dyad, hence no iterative fit."""
    fitted = problem.approximate or problem.driver is not None or problem.slider is not None
    return not (fitted or problem.sixbars)


KIND = Kind(
    "motion",
    MotionProblem,
    MotionResult,
    _solve,
    _warm_up,
    brief=_brief,
    nearer=_nearer,
    nearly=_nearly,
    gallery=GALLERY,
)
