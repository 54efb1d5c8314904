"""``/v1/jobs``: state a problem, follow the job, read and draw the answer."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable
from importlib.metadata import version
from typing import Annotated, Any, Literal, ParamSpec, TypeVar

from fastapi import APIRouter, Body, Depends, Header, Query, Request, Response
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError
from pydantic_core import from_json, to_json

from service.api import errors, etag
from service.api.analyses import ANALYSIS, Core, answered
from service.api.body import JsonRoute
from service.api.errors import Refusal, busy, invalid_problem, invalid_request, not_found, sentence
from service.api.guard import Tenant
from service.api.idempotency import KEY, key_reused, repeatable
from service.api.prefer import wait_seconds
from service.api.schemas import Job, JobList, JobRequest, list_item, whole_job
from service.drawings import Busy, Drawings
from service.jobs.desk import JobDesk
from service.jobs.schema import JobRow
from service.jobs.states import Status
from service.jobs.store import KeyReused, QueueFull
from service.loading import IMPORTS
from service.render import Form
from service.telemetry import span
from synthesis.registry import KINDS, example

TAG = {"name": "jobs", "description": "State a problem, follow the job, read the answer."}

RETRY_AFTER_S = 1
"""When a client that does not wait should look again; most jobs are done by then."""

QUEUE_RETRY_AFTER_S = 5
"""When a client whose job found no place in the queue should send it again."""

ULID = re.compile("[0-7][0-9A-HJKMNP-TV-Z]{25}")
"""What can be the id of a job. Only that reaches the database, which need not stand every string."""

NO_JOB = "There is no job with this id."

OTHER_DRAWINGS = "Other drawings have kept this one from being begun."

P = ParamSpec("P")
T = TypeVar("T")

_DESIGN_NUMBER = re.compile("[0-9]{1,4}")


async def _desk(request: Request) -> JobDesk:
    desk = request.app.state.desk
    assert isinstance(desk, JobDesk)
    return desk


Desk = Annotated[JobDesk, Depends(_desk)]


async def _drawings(request: Request) -> Drawings:
    drawings = request.app.state.drawings
    assert isinstance(drawings, Drawings)
    return drawings


Board = Annotated[Drawings, Depends(_drawings)]

router = APIRouter(prefix="/v1/jobs", tags=["jobs"], route_class=JsonRoute)


def _known_kind(kind: str) -> str:
    if kind not in KINDS:
        raise ValueError(f"there is no such kind; the kinds are {', '.join(KINDS)}")
    return kind


class JobFilter(BaseModel):
    """Which jobs to list."""

    model_config = ConfigDict(extra="forbid")

    status: Literal["queued", "running", "succeeded", "failed", "cancelled"] | None = Field(
        default=None, description="Only jobs in this state."
    )
    kind: Annotated[str, AfterValidator(_known_kind), Field(json_schema_extra={"enum": list(KINDS)})] | None = Field(
        default=None, description="Only jobs of this kind of problem."
    )
    limit: int = Field(default=20, ge=1, le=100, description="Jobs on a page, at most.")
    cursor: str | None = Field(default=None, max_length=100, description="`next_cursor` of the page before.")


_BODY = Body(
    openapi_examples={
        name: {
            "summary": kind.problem.model_config.get("title", name),
            "value": {"problem": example(name), "label": name},
        }
        for name, kind in KINDS.items()
    }
)
_LOCATION = {"Location": {"description": "The path of the job.", "schema": {"type": "string"}}}
_RETRY_AFTER = {"Retry-After": {"description": "Look again after so many seconds.", "schema": {"type": "integer"}}}
_ETAG = {"ETag": {"description": "Changes whenever the job does.", "schema": {"type": "string"}}}
_APPLIED = {"Preference-Applied": {"description": "`wait`: the job was waited for.", "schema": {"type": "string"}}}


@router.post(
    "",
    operation_id="create_job",
    summary="State a problem",
    response_class=Response,
    status_code=202,
    responses={
        200: {
            "model": Job,
            "description": "The finished job: in time for `Prefer: wait`, or the one of an earlier equal request.",
            "headers": {**_LOCATION, **_APPLIED},
        },
        202: {
            "model": Job,
            "description": "The job is accepted and will be run.",
            "headers": {**_LOCATION, **_RETRY_AFTER},
        },
        **errors.responses(
            e400="The body is not JSON.",
            e409="The `Idempotency-Key` came with another body before.",
            e413="The body is too large.",
            e415="The body is not `application/json`.",
            e422="The body does not state a problem; `errors` says where.",
            e503="The queue is full.",
        ),
    },
)
async def create_job(
    request: Request,
    desk: Desk,
    tenant: Tenant,
    body: Annotated[JobRequest, _BODY],
    prefer: Annotated[
        str | None,
        Header(
            description="`wait=10` waits up to so many seconds (30 at most) for the job to end.", examples=["wait=10"]
        ),
    ] = None,
    idempotency_key: Annotated[
        str | None,
        Header(
            pattern=KEY,
            description="A name for this request, 1 to 200 visible ASCII characters. The same request sent again with "
            "the same key is answered with the first job, as long as that is not removed.",
            examples=["7f9c24e8"],
        ),
    ] = None,
) -> Response:
    """Accept a problem as a job. Once this is answered the job is stored, and it ends, whatever process dies."""
    contradictions = body.problem.contradictions()
    if contradictions:
        raise invalid_problem([(f"/problem{fault.path}", sentence(fault.detail)) for fault in contradictions])
    # All lines of the header; the parameter is there for the documentation and holds only one of them.
    wait_s = wait_seconds(request.headers.getlist("prefer"), request.app.state.settings.max_wait_s)
    try:
        job = await desk.accept(
            tenant=tenant,
            kind=body.problem.kind,
            label=body.label,
            problem=body.problem.model_dump_json(),
            wait_s=wait_s,
            repeatable=repeatable(request.headers.getlist("idempotency-key"), body),
        )
    except KeyReused:
        raise key_reused() from None
    except QueueFull:
        raise Refusal(
            503, "queue-full", "Queue full", "As many jobs wait as may; send this one again later.",
            headers={"Retry-After": str(QUEUE_RETRY_AFTER_S)},
        ) from None  # fmt: skip
    headers = {"Location": f"/v1/jobs/{job.id}"}
    if not job.status.finished:
        return _json(whole_job(job), 202, {**headers, "Retry-After": str(RETRY_AFTER_S)})
    return _json(whole_job(job), 200, {**headers, "Preference-Applied": "wait"} if wait_s > 0 else headers)


@router.get(
    "",
    operation_id="list_jobs",
    summary="List jobs",
    response_class=Response,
    responses={200: {"model": JobList}, **errors.responses(e422="A parameter is not valid; `errors` says which.")},
)
async def list_jobs(desk: Desk, tenant: Tenant, filter_: Annotated[JobFilter, Query()]) -> Response:
    """The jobs, newest first, a page at a time, without their problems and results."""
    page = await desk.page(
        tenant=tenant,
        limit=filter_.limit + 1,
        status=None if filter_.status is None else Status(filter_.status),
        kind=filter_.kind,
        before=None if filter_.cursor is None else _job_of_cursor(filter_.cursor),
    )
    shown = page[: filter_.limit]
    more = len(page) > filter_.limit
    listed = {"jobs": [list_item(job) for job in shown], "next_cursor": _cursor(shown[-1].id) if more else None}
    return _json(to_json(listed))


@router.get(
    "/{job_id}",
    operation_id="get_job",
    summary="Read a job",
    response_class=Response,
    responses={
        200: {"model": Job, "headers": _ETAG},
        304: {"description": "The job is as the client knows it.", "headers": _ETAG},
        **errors.responses(e404=NO_JOB),
    },
)
async def get_job(
    request: Request,
    desk: Desk,
    tenant: Tenant,
    job_id: str,
    if_none_match: Annotated[
        str | None, Header(description="The `ETag` of the state that the client has.", examples=['"3"'])
    ] = None,
) -> Response:
    """The job as it stands."""
    job = await _job(desk, tenant, job_id)
    current = etag.tag(job.revision)
    if etag.matches(request.headers.getlist("if-none-match"), current):
        return Response(status_code=304, headers={"ETag": current})
    return _json(whole_job(job), headers={"ETag": current})


@router.delete(
    "/{job_id}",
    operation_id="delete_job",
    summary="Cancel or remove a job",
    response_class=Response,
    status_code=202,
    responses={
        202: {
            "model": Job,
            "description": "The job was unfinished and is cancelled; its computation is being stopped.",
        },
        204: {"description": "The job was finished and is removed."},
        **errors.responses(e404=NO_JOB),
    },
)
async def delete_job(desk: Desk, tenant: Tenant, job_id: str) -> Response:
    """Cancel a queued or running job; remove a finished one."""
    job = await desk.cancel_or_delete(tenant, job_id) if ULID.fullmatch(job_id) else None
    if job is None:
        raise not_found(NO_JOB)
    return Response(status_code=204) if job == "deleted" else _json(whole_job(job), 202)


_TEXT = {"type": "string"}
_FILE_SCHEMAS = {"gif": {"type": "string", "format": "binary"}}
_MEDIA_TYPES = {"svg": "image/svg+xml", "gif": "image/gif", "dxf": "image/vnd.dxf", "csv": "text/csv; charset=utf-8"}


def _exported(form: Form) -> dict[int | str, dict[str, Any]]:
    return {
        200: {"description": "The file.", "content": {_MEDIA_TYPES[form]: {"schema": _FILE_SCHEMAS.get(form, _TEXT)}}},
        **errors.responses(
            e404="There is no such job or design, or no such file of its type of mechanism.",
            e409="The job has no result (yet), or the design is of a size that is not drawn.",
            e503=OTHER_DRAWINGS,
        ),
    }


@router.get(
    "/{job_id}/designs/{number}.svg",
    operation_id="draw_design",
    summary="Draw a design",
    response_class=Response,
    responses=_exported("svg"),
)
async def draw_design(desk: Desk, board: Board, tenant: Tenant, job_id: str, number: str) -> Response:
    """A labelled drawing of design ``number`` of the job's result, counted from 0."""
    return await _file(desk, board, tenant, job_id, number, "svg")


@router.get(
    "/{job_id}/designs/{number}.gif",
    operation_id="animate_design",
    summary="Animate a design",
    response_class=Response,
    responses=_exported("gif"),
)
async def animate_design(desk: Desk, board: Board, tenant: Tenant, job_id: str, number: str) -> Response:
    """Design ``number`` of the job's result going through its cycle, counted from 0: 60 frames, over and over."""
    return await _file(desk, board, tenant, job_id, number, "gif")


@router.get(
    "/{job_id}/designs/{number}.dxf",
    operation_id="export_design_dxf",
    summary="Export a design to CAD",
    response_class=Response,
    responses=_exported("dxf"),
)
async def export_design_dxf(desk: Desk, board: Board, tenant: Tenant, job_id: str, number: str) -> Response:
    """A DXF file of design ``number`` of the job's result, in true dimensions and with units."""
    return await _file(desk, board, tenant, job_id, number, "dxf")


@router.get(
    "/{job_id}/designs/{number}.csv",
    operation_id="export_design_csv",
    summary="Export a design as a table",
    response_class=Response,
    responses=_exported("csv"),
)
async def export_design_csv(desk: Desk, board: Board, tenant: Tenant, job_id: str, number: str) -> Response:
    """A table of design ``number`` of the job's result, with units in its header."""
    return await _file(desk, board, tenant, job_id, number, "csv")


async def _file(desk: JobDesk, board: Drawings, tenant: str, job_id: str, number: str, form: Form) -> Response:
    job, result = await _solved(desk, tenant, job_id)
    with span("drawing"):
        drawn = await _made(board, _rendered, job, result, number, form)
    return Response(drawn, media_type=_MEDIA_TYPES[form])


async def _made(board: Drawings, draw: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    try:
        return await board.made(draw, *args, **kwargs)
    except Busy:
        raise busy("drawings") from None


def _rendered(job: JobRow, result: str, number: str, form: Form) -> str | bytes:
    # Drawing is for those who ask for it; the other requests do not wait for its import.
    from service import render

    kind = KINDS[job.kind]
    designs = kind.result.model_validate_json(result).designs
    n = _design_index(number, len(designs))
    problem = kind.problem.model_validate_json(job.problem)
    title = f"{job.label or problem.model_config.get('title') or job.kind}, design {n}"
    try:
        return render.exported(designs[n], problem, title, form)
    except render.NoSuchExport:
        raise not_found(f"There is no .{form} file of this type of mechanism.") from None
    except render.NotBuilt:
        raise Refusal(409, "no-drawing", "No drawing", "This design is of a size that is not drawn.") from None


class ReportScope(BaseModel):
    """How much of a job is reported."""

    model_config = ConfigDict(extra="forbid")

    designs: int = Field(
        default=5, ge=0, le=20, description="Designs shown in full, the best first; all of them are listed."
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
                    "description": "Nothing but the page's own style sheet, by its hash.",
                    "schema": _TEXT,
                }
            },
        },
        **errors.responses(
            e404=NO_JOB,
            e409="The job has no result (yet).",
            e422="A parameter is not valid; `errors` says which.",
            e503=OTHER_DRAWINGS,
        ),
    },
)
async def report_job(
    desk: Desk, board: Board, tenant: Tenant, job_id: str, query: Annotated[ReportScope, Query()]
) -> Response:
    """The job as one self-contained page for paper.

    The problem, what was searched and what is proven; the designs with drawings, checks, and dimensions with units.
    """
    job, result = await _solved(desk, tenant, job_id)
    with span("report"):
        page, policy = await _made(board, _reported, job, result, query.designs)
    headers = {
        "Content-Security-Policy": policy,
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
        "Content-Disposition": f'inline; filename="{job.kind}-{job.id}.html"',
    }
    return Response(page, media_type="text/html", headers=headers)


def _reported(job: JobRow, result: str, most: int) -> tuple[str, str]:
    with IMPORTS:
        from service.render.report import POLICY, Occasion, report

    kind = KINDS[job.kind]
    occasion = Occasion(job.id, job.kind, job.label, job.created_at, job.finished_at, version("mechsynth"))
    problem = kind.problem.model_validate_json(job.problem)
    return report(problem, kind.result.model_validate_json(result), occasion, most), POLICY


class MotionSteps(BaseModel):
    """How finely a cycle is divided."""

    model_config = ConfigDict(extra="forbid")

    steps: int = Field(default=360, ge=1, le=3600, description="Equal steps of the input, both ends included.")


@router.get(
    "/{job_id}/designs/{number}/motion",
    operation_id="move_design",
    summary="Move a design",
    response_class=Response,
    responses={
        200: {"description": "The motion.", "content": {"application/json": {"schema": ANALYSIS}}},
        **errors.responses(
            e404="There is no such job or design.",
            e409="The job has no result (yet), or the design is of a size that is not analysed.",
            e422="A parameter is not valid; `errors` says which.",
            e503="Other analyses have kept this one from being begun.",
        ),
    },
)
async def move_design(
    desk: Desk, tenant: Tenant, analyst: Core, job_id: str, number: str, query: Annotated[MotionSteps, Query()]
) -> Response:
    """Design ``number`` of the job's result over its cycle, with the input at 1 rad/s (or 1 length unit/s).

    A crank turns from the input angle of the first target through a full turn, or as many as its gears need to come
    back; any other input goes from toggle to toggle of the branch that the targets lie on. The answer is that of
    `POST /v1/analyses`.
    """
    _, result = await _solved(desk, tenant, job_id)
    return await answered(analyst, motion, result, number, query.steps)


def motion(result: str, number: str, steps: int) -> bytes:
    """The motion of design ``number`` of a stored result, in JSON.

    Raises
    ------
    Refusal
        404 where there is no such design, 409 where it is no mechanism that the analysis core would be given.
    """
    from kinematics import errors as kinematics
    from synthesis.analyses import family
    from synthesis.mechanisms import MechanismError

    designs = from_json(result)["designs"]
    mechanism = designs[_design_index(number, len(designs))]["mechanism"]
    try:
        answer = family(mechanism).request.over_the_cycle(mechanism, steps)
    except (ValidationError, MechanismError, kinematics.MechanismError):
        # A design for lengths at the end of what can be stated may itself lie beyond that.
        raise Refusal(409, "no-motion", "No motion", "This design is of a size that is not analysed.") from None
    return to_json(answer, inf_nan_mode="null")


async def _solved(desk: JobDesk, tenant: str, job_id: str) -> tuple[JobRow, str]:
    job = await _job(desk, tenant, job_id)
    if job.result is None:
        what = "has no result yet" if not job.status.finished else f"is {job.status.value} and has no result"
        raise Refusal(409, "no-result", "No result", f"The job {what}.")
    return job, job.result


def _design_index(number: str, designs: int) -> int:
    if not _DESIGN_NUMBER.fullmatch(number) or int(number) >= designs:
        raise not_found(f"The job has {designs} designs, counted from 0; this is none of them.")
    return int(number)


async def _job(desk: JobDesk, tenant: str, job_id: str) -> JobRow:
    job = await desk.get(tenant, job_id) if ULID.fullmatch(job_id) else None
    if job is None:
        raise not_found(NO_JOB)
    return job


def _cursor(job_id: str) -> str:
    return base64.urlsafe_b64encode(job_id.encode()).decode().rstrip("=")


def _job_of_cursor(cursor: str) -> str:
    try:
        job_id = base64.b64decode(cursor + "=" * (-len(cursor) % 4), altchars=b"-_", validate=True).decode()
    except ValueError:
        job_id = ""
    if not ULID.fullmatch(job_id):
        raise invalid_request([("/query/cursor", "This is not a cursor that the service has given out.")])
    return job_id


def _json(content: bytes, status: int = 200, headers: dict[str, str] | None = None) -> Response:
    return Response(content, status_code=status, headers=headers, media_type="application/json")
