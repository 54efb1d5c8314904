"""``/v1/jobs/{id}/designs/{n}``: the files and the motion of a design."""

from __future__ import annotations

from typing import Annotated, NamedTuple

from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from service.answers.designs import draw_design
from service.answers.designs import move_design as compute_motion
from service.answers.job_result import SolvedJob
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.computation import answer_with_analysis, draw_in_turn
from service.api.http.dependencies import Answers, Desk
from service.api.http.problem_details import Refusal
from service.api.routes.analyses import analysis_responses
from service.api.routes.jobs import TAG, job_of
from service.jobs.desk import JobDesk
from service.jobs.store.schema import JobRow
from service.observability.telemetry import span
from service.render import Form

OTHER_DRAWINGS = "Other drawings have kept this one from being begun."

_TEXT = {"type": "string"}

router = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)


class Export(NamedTuple):
    """A form of file that a design can be had in, as the API describes it."""

    media_type: str
    operation_id: str
    summary: str
    description: str
    schema: dict[str, str] = _TEXT


_AS_IT_IS_SAID = {"X-Content-Type-Options": "nosniff"}
HEADERS: dict[Form, dict[str, str]] = {
    # A drawing is opened as a page of its own, too, and then it may do nothing.
    "svg": {**_AS_IT_IS_SAID, "Content-Security-Policy": "default-src 'none'; style-src 'unsafe-inline'; sandbox"},
}
"""With what a file of a form goes out, where it is more than its type and :data:`_AS_IT_IS_SAID`."""

EXPORTS: dict[Form, Export] = {
    "svg": Export(
        "image/svg+xml",
        "draw_design",
        "Draw a design",
        "A labelled drawing of design ``number`` of the job's result, counted from 0.",
    ),
    "gif": Export(
        "image/gif",
        "animate_design",
        "Animate a design",
        "Design ``number`` of the job's result going through its cycle, counted from 0: 60 frames, over and over.",
        {"type": "string", "format": "binary"},
    ),
    "dxf": Export(
        "image/vnd.dxf",
        "export_design_dxf",
        "Export a design to CAD",
        "A DXF file of design ``number`` of the job's result, in true dimensions and with units.",
    ),
    "csv": Export(
        "text/csv; charset=utf-8",
        "export_design_csv",
        "Export a design as a table",
        "A table of design ``number`` of the job's result, with units in its header.",
    ),
}


def _offer(form: Form, export: Export) -> None:
    """Add the operation that gives the files of one form."""

    async def file(
        request: Request, desk: Desk, answers: Answers, tenant: Tenant, job_id: str, number: str
    ) -> Response:
        job = await solved_job(desk, tenant, job_id)
        with span("drawing"):
            content = await draw_in_turn(request, answers, tenant, draw_design, job, number, form)
        return Response(content, media_type=export.media_type, headers=HEADERS.get(form, _AS_IT_IS_SAID))

    router.add_api_route(
        f"/{{job_id}}/designs/{{number}}.{form}",
        file,
        operation_id=export.operation_id,
        summary=export.summary,
        description=export.description,
        response_class=Response,
        responses={
            200: {"description": "The file.", "content": {export.media_type: {"schema": export.schema}}},
            **problem_details.responses(
                e404="There is no such job or design, or no such file of its type of mechanism.",
                e409="The job has no result (yet), or the design is of a size that is not drawn.",
                e503=OTHER_DRAWINGS,
            ),
        },
    )


for _form, _export in EXPORTS.items():
    _offer(_form, _export)


class MotionSteps(BaseModel):
    """How finely a cycle is divided."""

    model_config = ConfigDict(extra="forbid")

    steps: int = Field(default=360, ge=1, le=3600, description="Equal steps of the input, both ends included.")


@router.get(
    "/{job_id}/designs/{number}/motion",
    operation_id="move_design",
    summary="Move a design",
    response_class=Response,
    responses=analysis_responses(
        "The motion.",
        e404="There is no such job or design.",
        e409="The job has no result (yet), or the design is of a size that is not analysed.",
        e422="A parameter is not valid; `errors` says which.",
    ),
)
async def move_design(
    request: Request, desk: Desk, tenant: Tenant, answers: Answers, job_id: str, number: str,
    query: Annotated[MotionSteps, Query()],
) -> Response:  # fmt: skip
    """Design ``number`` of the job's result over its cycle, with the input at 1 rad/s (or 1 length unit/s).

    A crank turns from the input angle of the first target through a full turn, or as many as its gears need to come
    back; any other input goes from toggle to toggle of the branch that the targets lie on. The answer is that of
    `POST /v1/analyses`.
    """
    _, result = await solved(desk, tenant, job_id)
    return await answer_with_analysis(request, answers, tenant, compute_motion, result, number, query.steps)


async def solved(desk: JobDesk, tenant: str, job_id: str) -> tuple[JobRow, str]:
    """A job and its result.

    Raises
    ------
    Refusal
        404 where there is no such job, 409 where it has no result.
    """
    job = await job_of(desk, tenant, job_id)
    if job.result is None:
        what = "has no result yet" if not job.status.finished else f"is {job.status.value} and has no result"
        raise Refusal(409, "no-result", "No result", f"The job {what}.")
    return job, job.result


async def solved_job(desk: JobDesk, tenant: str, job_id: str) -> SolvedJob:
    """A job that has a result, as the processes that answer requests take it; errors as of :func:`solved`."""
    job, result = await solved(desk, tenant, job_id)
    return SolvedJob(job.id, job.kind, job.label, job.created_at, job.finished_at, job.problem, result)
