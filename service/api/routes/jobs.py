"""``/v1/jobs``: state a problem, list, read, cancel and remove jobs."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Body, Header, Query, Request, Response
from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import to_json

from service.api.http import problem_details
from service.api.http.auth import Tenant
from service.api.http.body import JsonRoute
from service.api.http.dependencies import Desk
from service.api.http.idempotency import KEY, key_reused, repeatable
from service.api.http.ids import ULID, cursor_of, id_of_cursor
from service.api.http.prefer import wait_seconds
from service.api.http.problem_details import Refusal, invalid_problem, not_found, queue_full
from service.api.http.replies import as_json, unless_known
from service.api.http.schemas import Job, JobList, JobRequest, list_item, whole_job
from service.jobs.desk import JobDesk, PartOfBatch
from service.jobs.store.admission import KeyReused, QueueFull
from service.jobs.store.schema import JobRow
from service.jobs.store.states import Cost, Status
from service.requests import consistent, written
from synthesis.registry import KINDS, get_first_example

TAG = {"name": "jobs", "description": "State a problem, follow the job, read the answer."}

RETRY_AFTER_S = 1
"""When a client that does not wait should look again; most jobs are done by then."""

NO_JOB = "There is no job with this id."

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
            "value": {"problem": get_first_example(name), "label": name},
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
        **problem_details.responses(
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
    faults = consistent(body.problem)
    if faults:
        raise invalid_problem([(f"/problem{path}", detail) for path, detail in faults])
    # All lines of the header; the parameter is there for the documentation and holds only one of them.
    wait_s = wait_seconds(request.headers.getlist("prefer"), request.app.state.settings.max_wait_s)
    try:
        job = await desk.accept(
            tenant=tenant,
            kind=body.problem.kind,
            label=body.label,
            problem=written(body.problem),
            cost=Cost.SHORT if KINDS[body.problem.kind].brief(body.problem) else Cost.LONG,
            wait_s=wait_s,
            repeatable=repeatable(request.headers.getlist("idempotency-key"), body),
        )
    except KeyReused:
        raise key_reused() from None
    except QueueFull:
        raise queue_full() from None
    headers = {"Location": f"/v1/jobs/{job.id}"}
    if not job.status.finished:
        return as_json(whole_job(job), 202, {**headers, "Retry-After": str(RETRY_AFTER_S)})
    return as_json(whole_job(job), 200, {**headers, "Preference-Applied": "wait"} if wait_s > 0 else headers)


@router.get(
    "",
    operation_id="list_jobs",
    summary="List jobs",
    response_class=Response,
    responses={
        200: {"model": JobList},
        **problem_details.responses(e422="A parameter is not valid; `errors` says which."),
    },
)
async def list_jobs(desk: Desk, tenant: Tenant, filter_: Annotated[JobFilter, Query()]) -> Response:
    """The jobs, newest first, a page at a time, without their problems and results."""
    page = await desk.page(
        tenant=tenant,
        limit=filter_.limit + 1,
        status=None if filter_.status is None else Status(filter_.status),
        kind=filter_.kind,
        before=None if filter_.cursor is None else id_of_cursor(filter_.cursor),
    )
    shown = page[: filter_.limit]
    more = len(page) > filter_.limit
    listed = {"jobs": [list_item(job) for job in shown], "next_cursor": cursor_of(shown[-1].id) if more else None}
    return as_json(to_json(listed))


@router.get(
    "/{job_id}",
    operation_id="get_job",
    summary="Read a job",
    response_class=Response,
    responses={
        200: {"model": Job, "headers": _ETAG},
        304: {"description": "The job is as the client knows it.", "headers": _ETAG},
        **problem_details.responses(e404=NO_JOB),
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
    job = await job_of(desk, tenant, job_id)
    return unless_known(request, job.revision, lambda: whole_job(job))


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
        **problem_details.responses(e404=NO_JOB, e409="The job is one of a batch, which is removed as a whole."),
    },
)
async def delete_job(desk: Desk, tenant: Tenant, job_id: str) -> Response:
    """Cancel a queued or running job; remove a finished one."""
    try:
        job = await desk.cancel_or_delete(tenant, job_id) if ULID.fullmatch(job_id) else None
    except PartOfBatch as part:
        raise Refusal(
            409, "part-of-batch", "Part of a batch", f"The job is one of a batch; remove /v1/batches/{part.batch}."
        ) from None
    if job is None:
        raise not_found(NO_JOB)
    return Response(status_code=204) if job == "deleted" else as_json(whole_job(job), 202)


async def job_of(desk: JobDesk, tenant: str, job_id: str) -> JobRow:
    """The job of a tenant.

    Raises
    ------
    Refusal
        404 where the tenant has none such.
    """
    job = await desk.get(tenant, job_id) if ULID.fullmatch(job_id) else None
    if job is None:
        raise not_found(NO_JOB)
    return job
