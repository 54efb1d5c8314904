"""``/v1/jobs/{id}/designs/{n}``: files and motion of a design."""

from __future__ import annotations

from typing import Annotated, NamedTuple

from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from kinematics.message import compose
from service.answers.designs import draw_design
from service.answers.designs import move_design as compute_motion
from service.answers.job_result import SolvedJob
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.computation import draw_in_turn, respond_with_analysis
from service.api.http.dependencies import Answers, Desk
from service.api.http.problem_details import Refusal
from service.api.routes.analyses import describe_analysis_responses
from service.api.routes.jobs import TAG, find_job
from service.jobs.desk import JobDesk
from service.jobs.store.schema import JobRow
from service.observability.telemetry import measure_span
from service.render import Form

OTHER_DRAWINGS = "The service is busy with other drawings."

_TEXT = {"type": "string"}

router = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)


class Export(NamedTuple):
    """A file format of designs, with its description in the API."""

    media_type: str
    operation_id: str
    summary: str
    description: str
    schema: dict[str, str] = _TEXT


_NOSNIFF_HEADERS = {"X-Content-Type-Options": "nosniff"}
HEADERS: dict[Form, dict[str, str]] = {
    # A browser may open a drawing as a page of its own, which must not run or load anything.
    "svg": {**_NOSNIFF_HEADERS, "Content-Security-Policy": "default-src 'none'; style-src 'unsafe-inline'; sandbox"},
}
"""Headers of the files of a format; the default is :data:`_NOSNIFF_HEADERS`."""

EXPORTS: dict[Form, Export] = {
    "svg": Export(
        "image/svg+xml",
        "draw_design",
        "Draw a design",
        "Return a labelled drawing of design ``number`` of the job's result, counted from 0.",
    ),
    "gif": Export(
        "image/gif",
        "animate_design",
        "Animate a design",
        "Return an animation of design ``number`` of the job's result, counted from 0: 60 frames of its cycle, in a "
        "loop.",
        {"type": "string", "format": "binary"},
    ),
    "dxf": Export(
        "image/vnd.dxf",
        "export_design_dxf",
        "Export a design to CAD",
        "Return a DXF file of design ``number`` of the job's result, in true dimensions and with units.",
    ),
    "csv": Export(
        "text/csv; charset=utf-8",
        "export_design_csv",
        "Export a design as a table",
        "Return a table of design ``number`` of the job's result, with units in its header.",
    ),
}


def _add_route(form: Form, export: Export) -> None:
    """Add the operation that returns the files of one format."""

    async def send_file(
        request: Request, desk: Desk, answers: Answers, tenant: Tenant, job_id: str, number: str
    ) -> Response:
        job = await get_solved_job(desk, tenant, job_id)
        with measure_span("drawing"):
            content = await draw_in_turn(request, answers, tenant, draw_design, job, number, form)
        # Browsers show pictures, and save other files under this name.
        shown = "inline" if export.media_type.startswith("image/") and form != "dxf" else "attachment"
        headers = {
            **HEADERS.get(form, _NOSNIFF_HEADERS),
            "Content-Disposition": f'{shown}; filename="{job.kind}-{int(number) + 1}.{form}"',
        }
        return Response(content, media_type=export.media_type, headers=headers)

    router.add_api_route(
        f"/{{job_id}}/designs/{{number}}.{form}",
        send_file,
        operation_id=export.operation_id,
        summary=export.summary,
        description=export.description,
        response_class=Response,
        responses={
            200: {"description": "The file.", "content": {export.media_type: {"schema": export.schema}}},
            **problem_details.describe_responses(
                e404="No such job or design, or its type of mechanism has no such file.",
                e409="The job has no result (yet), or the size of the design is beyond the range for drawings.",
                e503=OTHER_DRAWINGS,
            ),
        },
    )


for _form, _export in EXPORTS.items():
    _add_route(_form, _export)


class MotionSteps(BaseModel):
    """Number of steps of a cycle."""

    model_config = ConfigDict(extra="forbid")

    steps: int = Field(
        default=360, ge=1, le=3600, description="Number of equal steps of the input; both ends are included."
    )


@router.get(
    "/{job_id}/designs/{number}/motion",
    operation_id="move_design",
    summary="Move a design",
    response_class=Response,
    responses=describe_analysis_responses(
        "The motion.",
        e404="No such job or design.",
        e409="The job has no result (yet), or the size of the design is beyond the range for analyses.",
        e422="A parameter is not valid; `errors` names it.",
    ),
)
async def move_design(
    request: Request, desk: Desk, tenant: Tenant, answers: Answers, job_id: str, number: str,
    query: Annotated[MotionSteps, Query()],
) -> Response:  # fmt: skip
    """Analyse design ``number`` of the job's result over its cycle, with the input at 1 rad/s (or 1 length unit/s).

    A crank turns from the input angle of the first target through a full turn, or as many turns as its gears need to
    return; any other input moves from toggle to toggle of the branch that contains the targets. The answer has the form
    of `POST /v1/analyses`.
    """
    _, result = await get_job_with_result(desk, tenant, job_id)
    return await respond_with_analysis(request, answers, tenant, compute_motion, result, number, query.steps)


async def get_job_with_result(desk: JobDesk, tenant: str, job_id: str) -> tuple[JobRow, str]:
    """Return a job and its result.

    Raises
    ------
    Refusal
        404 if there is no such job, 409 if it has no result.
    """
    job = await find_job(desk, tenant, job_id)
    if job.result is None:
        detail = (
            compose("service-job-ended-without-result", status=job.status.value)
            if job.status.finished
            else compose("service-job-without-result-yet")
        )
        # Not 404: the job exists, and while it runs it may still get a result.
        raise Refusal(409, "no-result", "service-title-no-result", detail)
    return job, job.result


async def get_solved_job(desk: JobDesk, tenant: str, job_id: str) -> SolvedJob:
    """Return a job with a result for the processes that answer requests; errors as for :func:`get_job_with_result`."""
    job, result = await get_job_with_result(desk, tenant, job_id)
    return SolvedJob(job.id, job.kind, job.label, job.created_at, job.finished_at, job.problem, result)
