"""``/v1/jobs/{id}/report.html``: a printable report of a job."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from service.answers.reports import report_job as write_report
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.computation import draw_in_turn
from service.api.http.dependencies import Answers, Bench, Desk
from service.api.routes.designs import get_solved_job
from service.api.routes.jobs import NO_JOB, TAG
from service.api.routes.parts import draw_assemblies
from service.observability.telemetry import measure_span

_TEXT = {"type": "string"}

router = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)


class ReportScope(BaseModel):
    """Extent of a report."""

    model_config = ConfigDict(extra="forbid")

    designs: int = Field(
        default=5, ge=0, le=20, description="Number of designs shown in full, best first; all designs are listed."
    )
    assemblies: bool = Field(
        default=False,
        description="Whether each of these is also shown as an assembly of parts, or the reason if there is none.",
    )


@router.get(
    "/{job_id}/report.html",
    operation_id="report_job",
    summary="Report a job",
    response_class=Response,
    responses={
        200: {
            "description": "The page.",
            "content": {"text/html; charset=utf-8": {"schema": _TEXT}},
            "headers": {
                "Content-Security-Policy": {
                    "description": "Allows only the page's own style sheet, by its hash.",
                    "schema": _TEXT,
                }
            },
        },
        **problem_details.describe_responses(
            e404=NO_JOB,
            e409="The job has no result (yet).",
            e422="A parameter is not valid; `errors` names it.",
            e503="The service is busy with other drawings or parts.",
        ),
    },
)
async def report_job(
    request: Request, desk: Desk, answers: Answers, bench: Bench, tenant: Tenant, job_id: str,
    query: Annotated[ReportScope, Query()],
) -> Response:  # fmt: skip
    """Return a self-contained printable report of the job.

    It shows the problem, the search and its completeness, and the designs with drawings, checks and dimensions.
    """
    job = await get_solved_job(desk, tenant, job_id)
    with measure_span("report"):
        # Parts come from another process, so they are made first and passed on.
        built = {}
        if query.assemblies:
            built = await draw_assemblies(request, bench, tenant, job, query.designs)
        page, policy = await draw_in_turn(request, answers, tenant, write_report, job, query.designs, built)
    headers = {
        "Content-Security-Policy": policy,
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
        "Content-Disposition": f'inline; filename="{job.kind}-{job.id}.html"',
    }
    return Response(page, media_type="text/html", headers=headers)
