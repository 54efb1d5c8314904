"""``/v1/jobs/{id}/designs/{n}/forces``: what a design bears, with masses and loads of the problem or the caller."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body, Query, Request, Response

from service.answers.forces import forces_of_design as compute_forces
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.body import JsonRoute
from service.api.http.computation import answer_with_analysis
from service.api.http.dependencies import Answers, Desk
from service.api.routes.analyses import analysis_responses
from service.api.routes.designs import MotionSteps, solved_job
from service.api.routes.jobs import TAG

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
    request: Request, desk: Desk, tenant: Tenant, answers: Answers, job_id: str, number: str,
    query: Annotated[MotionSteps, Query()],
) -> Response:  # fmt: skip
    """Forces of design ``number`` of the job's result with the block `dynamics` of its problem.

    A crank that turns through is driven through its cycle, any other input over the range that the design was verified
    along, at constant speed; a design that has a block `dynamics` of its own, over the motion of its problem. The
    answer is that of `POST /v1/analyses`.
    """
    job = await solved_job(desk, tenant, job_id)
    return await answer_with_analysis(request, answers, tenant, compute_forces, job, number, query.steps, None)


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
    request: Request,
    desk: Desk,
    tenant: Tenant,
    answers: Answers,
    job_id: str,
    number: str,
    query: Annotated[MotionSteps, Query()],
    body: Annotated[Any, Body()],
) -> Response:
    """The same with a block of the caller's: that of a problem, with the fields `report`, `flywheel` and `drive`.

    Nothing is stored.
    """
    job = await solved_job(desk, tenant, job_id)
    return await answer_with_analysis(request, answers, tenant, compute_forces, job, number, query.steps, body)
