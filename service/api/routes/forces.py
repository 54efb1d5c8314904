"""``/v1/jobs/{id}/designs/{n}/forces``: forces in a design, with masses and loads of the problem or of the caller."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Body, Query, Request, Response

from service.answers.forces import compute_design_forces as compute_forces
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.body import JsonRoute
from service.api.http.computation import respond_with_analysis
from service.api.http.dependencies import Answers, Desk
from service.api.routes.analyses import describe_analysis_responses
from service.api.routes.designs import MotionSteps, get_solved_job
from service.api.routes.jobs import TAG

NO_DYNAMICS = "The job has no result (yet), its problem has no `dynamics`, or the design has no such forces."

reading = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)
stating = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=JsonRoute)


@reading.get(
    "/{job_id}/designs/{number}/forces",
    operation_id="forces_of_design",
    summary="Forces of a design",
    response_class=Response,
    responses=describe_analysis_responses(
        "The motion with its forces.",
        e404="No such job or design.",
        e409=NO_DYNAMICS,
        e422="A parameter is not valid; `errors` names it.",
    ),
)
async def forces_of_design(
    request: Request, desk: Desk, tenant: Tenant, answers: Answers, job_id: str, number: str,
    query: Annotated[MotionSteps, Query()],
) -> Response:  # fmt: skip
    """Compute the forces of design ``number`` of the job's result with the block `dynamics` of its problem.

    A fully rotating crank is driven through its cycle, any other input over the range of the verification, at constant
    speed. A design with its own block `dynamics` is driven over the motion of its problem. The answer has the form of
    `POST /v1/analyses`.
    """
    job = await get_solved_job(desk, tenant, job_id)
    return await respond_with_analysis(request, answers, tenant, compute_forces, job, number, query.steps, None)


@stating.post(
    "/{job_id}/designs/{number}/forces",
    operation_id="analyse_forces_of_design",
    summary="Forces of a design with the caller's masses and loads",
    response_class=Response,
    responses=describe_analysis_responses(
        "The motion with its forces.",
        e400="The body is not JSON.",
        e404="No such job or design.",
        e409=NO_DYNAMICS,
        e413="The body is too large.",
        e415="The body is not `application/json`.",
        e422="The body has no valid masses and loads for this design; `errors` has the places.",
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
    """Compute the forces with a block of the caller: that of a problem, plus `report`, `flywheel` and `drive`.

    Nothing is stored.
    """
    job = await get_solved_job(desk, tenant, job_id)
    # The process that computes also validates the body.
    return await respond_with_analysis(request, answers, tenant, compute_forces, job, number, query.steps, body)
