"""The forces of a design of a solved job, with the loads of its problem or with those that a body states."""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError
from pydantic_core import to_json

from service.answers.job_result import SolvedJob, design_index
from service.answers.numerical import refuse_numerical_errors
from service.error_messages import sentence
from service.refusals import Refusal, invalid_body, invalid_request


def forces_of_design(job: SolvedJob, number: str, steps: int, body: Any) -> bytes:
    """The forces of a design, in JSON; by the problem's own block where ``body`` is None.

    Raises
    ------
    Refusal
        404, 409 or 422.
    """
    with refuse_numerical_errors("/dynamics"):
        return _forces(job, number, steps, body)


def _forces(job: SolvedJob, number: str, steps: int, body: Any) -> bytes:
    from synthesis.model.dynamics.request import DesignForcesRequest
    from synthesis.model.linkage.problem import LinkageProblem
    from synthesis.results.forces import ForcesUnknownError, compute_forces_over_motion

    designs = job.answer().designs
    design = designs[design_index(number, len(designs))]
    problem = job.statement()
    if body is None and getattr(design, "dynamics", None):
        return to_json(_with_its_own(problem, design, steps), inf_nan_mode="null")
    if not isinstance(problem, LinkageProblem):
        raise _no_forces("Only linkages have forces in their joints.")
    if body is None:
        if problem.dynamics is None:
            raise _no_forces("The problem states no dynamics; post a block of your own.")
        stated: Any = problem.dynamics
    else:
        try:
            stated = DesignForcesRequest.model_validate(body).dynamics
            stated.fill_from_layout(problem.layout)
        except ValidationError as error:
            raise invalid_body(error, body) from None
    try:
        return to_json(compute_forces_over_motion(stated, design, problem.length_unit, steps), inf_nan_mode="null")
    except ForcesUnknownError as error:
        if body is None or not error.path:
            raise _no_forces(sentence(str(error))) from None
        raise invalid_request([(error.path, sentence(error.detail))]) from None


def _with_its_own(problem: Any, design: Any, steps: int) -> dict[str, Any]:
    """The forces of a design that has a block of its own, over the motion that its problem states."""
    from synthesis.analyses import parse_request

    motion = problem.motion.model_copy(update={"steps": steps}).model_dump(exclude_unset=True, by_alias=True)
    if "speed_rpm" not in motion:
        motion["speed"] = problem.motion.rate  # that of the kind, where none is stated
    stated = {"mechanism": design.mechanism.model_dump(), "motion": motion, "dynamics": design.dynamics}
    return parse_request({**stated, "length_unit": problem.length_unit}).build_answer()


def _no_forces(detail: str) -> Refusal:
    return Refusal(409, "no-forces", "No forces", detail)
