"""Motion generation: carry a body through given positions."""

from __future__ import annotations

from collections.abc import Sequence

from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.gallery import GALLERY
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.model.json_object import JsonObject
from synthesis.model.kind import Kind, Progress, TableColumns
from synthesis.model.linkage.answer import LinkageDesign, LinkageMechanism

__all__ = ["KIND"]


def _solve(problem: MotionProblem, progress: Progress) -> MotionResult:
    from synthesis.kinds.motion.solver import solve_motion

    return solve_motion(problem, progress)


def _continue_designs(
    problem: MotionProblem, designs: Sequence[LinkageDesign], progress: Progress
) -> list[LinkageDesign] | None:
    from synthesis.kinds.motion.solver import continue_from_designs

    return continue_from_designs(problem, designs, progress)


def _verify_with_tolerance(
    problem: MotionProblem, _design: LinkageDesign, mechanism: LinkageMechanism
) -> LinkageDesign | None:
    from synthesis.kinds.motion.verification.verify import verify_with_tolerance

    return verify_with_tolerance(problem, mechanism)


def _request_usable(problem: MotionProblem) -> MotionProblem | None:
    """Return the statement of a search for sound fourbars and slider-cranks; sixbars would take too long."""
    return problem if problem.mechanisms is None else problem.two_dyad_problem


def _warm_up() -> None:
    """Compile the kernels of the exact methods by solving the first examples: users wait for these short jobs."""
    # The first examples cover three, four and five exact positions; fits are compiled in the background.
    for example in KIND.examples[:4]:
        _solve(MotionProblem.model_validate(example), lambda fraction, message: None)


def _list_warm_up_problems() -> list[JsonObject]:
    from synthesis.kinds.motion.warm_up_problems import list_warm_up_problems

    return list_warm_up_problems(KIND.examples)


def _is_short(problem: MotionProblem) -> bool:
    """Return whether a job is short: exact positions, fourbars only, no driver dyad, hence no iterative fit."""
    fitted = problem.approximate or problem.driver is not None or problem.slider is not None
    return not (fitted or problem.sixbars or problem.has_eightbars)


KIND = Kind(
    "motion",
    MotionProblem,
    MotionResult,
    _solve,
    _warm_up,
    brief=_is_short,
    nearer=_continue_designs,
    nearly=_verify_with_tolerance,
    usable=_request_usable,
    is_first_loaded=True,
    list_warm_up_problems=_list_warm_up_problems,
    columns=TableColumns("positions", ("x", "y", "angle")),
    gallery=GALLERY,
)
