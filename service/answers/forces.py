"""Forces in a design of a solved job, with the loads of its problem or of a request body."""

from __future__ import annotations

from typing import Any

from pydantic import ValidationError
from pydantic_core import to_json

from kinematics.message import compose, make_sentence
from service.answers.job_result import SolvedJob, parse_design_index
from service.answers.numerical import refuse_numerical_errors
from service.refusals import Refusal, refuse_invalid_body, refuse_invalid_request
from synthesis.model.json_object import JsonObject


def compute_design_forces(job: SolvedJob, number: str, steps: int, body: object) -> bytes:
    """Return the forces in a design as JSON; if ``body`` is None, with the problem's own block.

    Raises
    ------
    Refusal
        404, 409 or 422.
    """
    with refuse_numerical_errors("/dynamics"):
        return _compute_forces(job, number, steps, body)


def _compute_forces(job: SolvedJob, number: str, steps: int, body: object) -> bytes:
    from synthesis.model.dynamics.request import DesignForcesRequest
    from synthesis.model.linkage.problem import LinkageProblem
    from synthesis.results.forces import ForcesUnknownError, compute_forces_over_motion

    designs = job.load_result().designs
    design = designs[parse_design_index(number, len(designs))]
    problem = job.load_problem()
    if body is None and getattr(design, "dynamics", None):
        return to_json(_compute_own_forces(problem, design, steps), inf_nan_mode="null")
    if not isinstance(problem, LinkageProblem):
        raise _refuse_forces(compose("service-forces-for-linkages-only"))
    if body is None:
        if problem.dynamics is None:
            raise _refuse_forces(compose("service-problem-without-dynamics"))
        block: Any = problem.dynamics
    else:
        try:
            block = DesignForcesRequest.model_validate(body).dynamics
            block.fill_from_layout(problem.layout)
        except ValidationError as error:
            raise refuse_invalid_body(error, body, DesignForcesRequest) from None
    try:
        return to_json(compute_forces_over_motion(block, design, problem.length_unit, steps), inf_nan_mode="null")
    except ForcesUnknownError as error:
        if body is None or not error.path:
            raise _refuse_forces(make_sentence(str(error))) from None
        raise refuse_invalid_request([(error.path, make_sentence(error.detail))]) from None


def _compute_own_forces(problem: Any, design: Any, steps: int) -> JsonObject:
    """Return the forces in a design with its own block, over the motion given in its problem."""
    from synthesis.analyses import parse_request

    motion = problem.motion.model_copy(update={"steps": steps}).model_dump(exclude_unset=True, by_alias=True)
    if "speed_rpm" not in motion:
        motion["speed"] = problem.motion.rate  # the default of the kind
    body = {"mechanism": design.mechanism.model_dump(), "motion": motion, "dynamics": design.dynamics}
    return parse_request({**body, "length_unit": problem.length_unit}).build_answer()


def _refuse_forces(detail: str) -> Refusal:
    return Refusal(409, "no-forces", "service-title-no-forces", detail)
