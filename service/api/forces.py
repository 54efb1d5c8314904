"""``/v1/jobs/{id}/designs/{n}/forces``: what a design bears, with masses and loads of the problem or the caller."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body, Query, Response
from pydantic import ValidationError
from pydantic_core import to_json

from service.api.analyses import analysis_responses, answered, invalid_body
from service.api.body import JsonRoute
from service.api.designs import MotionSteps, design_index, solved
from service.api.errors import Refusal, invalid_request
from service.api.guard import GuardedRoute, Tenant
from service.api.jobs import TAG
from service.api.state import Core, Desk
from service.explained import sentence
from service.jobs.schema import JobRow
from service.stated import read
from synthesis.registry import KINDS

NO_DYNAMICS = "The job has no result (yet), its problem states no `dynamics`, or the design has no such forces."

reading = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)
stating = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=JsonRoute)


@reading.get(
    "/{job_id}/designs/{number}/forces",
    operation_id="forces_of_design",
    summary="Forces of a design",
    response_class=Response,
    responses=analysis_responses(
        "The motion with its forces.",
        e404="There is no such job or design.",
        e409=NO_DYNAMICS,
        e422="A parameter is not valid; `errors` says which.",
    ),
)
async def forces_of_design(
    desk: Desk, tenant: Tenant, analyst: Core, job_id: str, number: str, query: Annotated[MotionSteps, Query()]
) -> Response:
    """Forces of design ``number`` of the job's result with the block `dynamics` of its problem.

    A crank that turns through is driven through its cycle, any other input over the range that the design was verified
    along, at constant speed; a design that has a block `dynamics` of its own, over the motion of its problem. The
    answer is that of `POST /v1/analyses`.
    """
    job, result = await solved(desk, tenant, job_id)
    return await answered(analyst, _forces, job, result, number, query.steps, None)


@stating.post(
    "/{job_id}/designs/{number}/forces",
    operation_id="analyse_forces_of_design",
    summary="Forces of a design with masses and loads of the caller's",
    response_class=Response,
    responses=analysis_responses(
        "The motion with its forces.",
        e400="The body is not JSON.",
        e404="There is no such job or design.",
        e409=NO_DYNAMICS,
        e413="The body is too large.",
        e415="The body is not `application/json`.",
        e422="The body does not state what this design weighs and carries; `errors` says where.",
    ),
    openapi_extra={
        "requestBody": {
            "required": True,
            "content": {"application/json": {"schema": {"$ref": "#/components/schemas/DesignForcesRequest"}}},
        }
    },
)
async def analyse_forces_of_design(
    desk: Desk,
    tenant: Tenant,
    analyst: Core,
    job_id: str,
    number: str,
    query: Annotated[MotionSteps, Query()],
    body: Annotated[Any, Body()],
) -> Response:
    """The same with a block of the caller's: that of a problem, with the fields `report`, `flywheel` and `drive`.

    Nothing is stored.
    """
    job, result = await solved(desk, tenant, job_id)
    return await answered(analyst, _forces, job, result, number, query.steps, body)


def _forces(job: JobRow, result: str, number: str, steps: int, body: Any) -> bytes:
    """The forces of a design of a stored result, in JSON; by the problem's own block where ``body`` is None."""
    from synthesis.model.dynamics import DesignForcesRequest
    from synthesis.model.linkage_statement import LinkageProblem
    from synthesis.outcome.forces import NoForces, forces_over_motion

    kind = KINDS[job.kind]
    designs = kind.result.model_validate_json(result).designs
    design = designs[design_index(number, len(designs))]
    problem = read(job.kind, job.problem)
    if body is None and getattr(design, "dynamics", None):
        return to_json(_with_its_own(problem, design, steps), inf_nan_mode="null")
    if not isinstance(problem, LinkageProblem):
        raise _refused("Only linkages have forces in their joints.")
    if body is None:
        if problem.dynamics is None:
            raise _refused("The problem states no dynamics; post a block of your own.")
        stated: Any = problem.dynamics
    else:
        try:
            stated = DesignForcesRequest.model_validate(body).dynamics
            stated.laid_out(problem.layout)
        except ValidationError as error:
            raise invalid_body(error, body) from None
    try:
        return to_json(forces_over_motion(stated, design, problem.length_unit, steps), inf_nan_mode="null")
    except NoForces as error:
        if body is None or not error.path:
            raise _refused(sentence(str(error))) from None
        raise invalid_request([(error.path, sentence(error.detail))]) from None


def _with_its_own(problem: Any, design: Any, steps: int) -> dict[str, Any]:
    """The forces of a design that has a block of its own, over the motion that its problem states."""
    from synthesis.analyses import parse_request

    motion = problem.motion.model_copy(update={"steps": steps}).model_dump(exclude_unset=True, by_alias=True)
    if "speed_rpm" not in motion:
        motion["speed"] = problem.motion.rate  # that of the kind, where none is stated
    stated = {"mechanism": design.mechanism.model_dump(), "motion": motion, "dynamics": design.dynamics}
    return parse_request({**stated, "length_unit": problem.length_unit}).answer()


def _refused(detail: str) -> Refusal:
    return Refusal(409, "no-forces", "No forces", detail)
