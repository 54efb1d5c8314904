"""``/v1/jobs``: submit a problem; list, read, cancel and remove jobs."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Body, Header, Query, Request, Response
from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import to_json

from kinematics.message import compose
from service.api.http import problem_details
from service.api.http.auth import Tenant
from service.api.http.body import JsonRoute
from service.api.http.dependencies import Desk
from service.api.http.idempotency import KEY_PATTERN, read_repeatable, refuse_reused_key
from service.api.http.ids import ULID_PATTERN, decode_cursor, encode_cursor
from service.api.http.prefer import parse_wait_seconds
from service.api.http.problem_details import Refusal, refuse_full_queue, refuse_invalid_problem, refuse_not_found
from service.api.http.replies import as_json, respond_unless_known
from service.api.http.schemas import Job, JobList, JobRequest, describe_job, dump_job
from service.jobs.desk import JobDesk, PartOfBatch
from service.jobs.store.admission import KeyReused, QueueFull
from service.jobs.store.schema import JobRow
from service.jobs.store.states import Cost, Status
from service.requests import check_consistency, dump_problem
from synthesis.registry import KINDS, get_first_example

TAG = {"name": "jobs", "description": "Submit a problem, follow the job, read the answer."}

RETRY_AFTER_S = 1
"""Value of ``Retry-After`` for a client that does not wait, seconds; most jobs have ended by then."""

NO_JOB = "No job has this id."

router = APIRouter(prefix="/v1/jobs", tags=["jobs"], route_class=JsonRoute)


def _check_kind(kind: str) -> str:
    if kind not in KINDS:
        raise ValueError(compose("service-filter-kind-unknown", kinds=", ".join(KINDS)))
    return kind


class JobFilter(BaseModel):
    """Filter of the list of jobs."""

    model_config = ConfigDict(extra="forbid")

    status: Literal["queued", "running", "succeeded", "failed", "cancelled"] | None = Field(
        default=None, description="Only jobs in this state."
    )
    kind: Annotated[str, AfterValidator(_check_kind), Field(json_schema_extra={"enum": list(KINDS)})] | None = Field(
        default=None, description="Only jobs of this kind of problem."
    )
    limit: int = Field(default=20, ge=1, le=100, description="Maximum number of jobs on a page.")
    cursor: str | None = Field(default=None, max_length=100, description="`next_cursor` of the previous page.")


_BODY = Body(
    openapi_examples={
        name: {
            "summary": kind.problem.model_config.get("title", name),
            "value": {"problem": get_first_example(name), "label": name},
        }
        for name, kind in KINDS.items()
    }
)
_LOCATION = {"Location": {"description": "Path of the job.", "schema": {"type": "string"}}}
_RETRY_AFTER = {"Retry-After": {"description": "Seconds until the next request.", "schema": {"type": "integer"}}}
_ETAG = {"ETag": {"description": "Changes whenever the job does.", "schema": {"type": "string"}}}
_PREFERENCE_APPLIED = {
    "Preference-Applied": {"description": "`wait`: the service has waited.", "schema": {"type": "string"}}
}


@router.post(
    "",
    operation_id="create_job",
    summary="Submit a problem",
    response_class=Response,
    status_code=202,
    responses={
        200: {
            "model": Job,
            "description": "The finished job: within the time of `Prefer: wait`, or that of an earlier equal request.",
            "headers": {**_LOCATION, **_PREFERENCE_APPLIED},
        },
        202: {
            "model": Job,
            "description": "The job is accepted and will be run.",
            "headers": {**_LOCATION, **_RETRY_AFTER},
        },
        **problem_details.describe_responses(
            e400="The body is not JSON.",
            e409="The `Idempotency-Key` was used with a different body before.",
            e413="The body is too large.",
            e415="The body is not `application/json`.",
            e422="The body is not a valid problem; `errors` has the places.",
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
            description="`wait=10` waits up to 10 seconds (at most 30) for the end of the job.", examples=["wait=10"]
        ),
    ] = None,
    idempotency_key: Annotated[
        str | None,
        Header(
            pattern=KEY_PATTERN,
            description="Key of this request, 1 to 200 visible ASCII characters. The same request sent again with the "
            "same key is answered with the first job, until that is removed.",
            examples=["7f9c24e8"],
        ),
    ] = None,
) -> Response:
    """Accept a problem as a job. With the answer the job is stored and will end, even if processes die meanwhile."""
    faults = check_consistency(body.problem)
    if faults:
        raise refuse_invalid_problem([(f"/problem{path}", detail) for path, detail in faults])
    # Reads all lines of the header; the parameter serves the documentation and holds only one line.
    wait_s = parse_wait_seconds(request.headers.getlist("prefer"), request.app.state.settings.max_wait_s)
    try:
        job = await desk.accept(
            tenant=tenant,
            kind=body.problem.kind,
            label=body.label,
            problem=dump_problem(body.problem),
            # Brief problems run next to long searches and do not wait for them.
            cost=Cost.SHORT if KINDS[body.problem.kind].brief(body.problem) else Cost.LONG,
            wait_s=wait_s,
            repeatable=read_repeatable(request.headers.getlist("idempotency-key"), body),
        )
    except KeyReused:
        raise refuse_reused_key() from None
    except QueueFull:
        raise refuse_full_queue() from None
    headers = {"Location": f"/v1/jobs/{job.id}"}
    if not job.status.finished:
        return as_json(dump_job(job), 202, {**headers, "Retry-After": str(RETRY_AFTER_S)})
    # Without a wait the job is that of an earlier request with the same key.
    return as_json(dump_job(job), 200, {**headers, "Preference-Applied": "wait"} if wait_s > 0 else headers)


@router.get(
    "",
    operation_id="list_jobs",
    summary="List jobs",
    response_class=Response,
    responses={
        200: {"model": JobList},
        **problem_details.describe_responses(e422="A parameter is not valid; `errors` names it."),
    },
)
async def list_jobs(desk: Desk, tenant: Tenant, filter_: Annotated[JobFilter, Query()]) -> Response:
    """Return a page of the jobs, newest first, without their problems and results."""
    page = await desk.list_page(
        tenant=tenant,
        # One more than requested shows whether there is a next page.
        limit=filter_.limit + 1,
        status=None if filter_.status is None else Status(filter_.status),
        kind=filter_.kind,
        before=None if filter_.cursor is None else decode_cursor(filter_.cursor),
    )
    shown = page[: filter_.limit]
    more = len(page) > filter_.limit
    listed = {
        "jobs": [describe_job(job) for job in shown],
        "next_cursor": encode_cursor(shown[-1].id) if more else None,
    }
    return as_json(to_json(listed))


@router.get(
    "/{job_id}",
    operation_id="get_job",
    summary="Read a job",
    response_class=Response,
    responses={
        200: {"model": Job, "headers": _ETAG},
        304: {"description": "The job is unchanged since the state that the client has.", "headers": _ETAG},
        **problem_details.describe_responses(e404=NO_JOB),
    },
)
async def get_job(
    request: Request,
    desk: Desk,
    tenant: Tenant,
    job_id: str,
    if_none_match: Annotated[
        str | None, Header(description="`ETag` of the state that the client has.", examples=['"3"'])
    ] = None,
) -> Response:
    """Return the present state of the job."""
    job = await find_job(desk, tenant, job_id)
    return respond_unless_known(request, job.revision, lambda: dump_job(job))


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
        **problem_details.describe_responses(
            e404=NO_JOB, e409="The job belongs to a batch, which is removed as a whole."
        ),
    },
)
async def delete_job(desk: Desk, tenant: Tenant, job_id: str) -> Response:
    """Cancel a queued or running job; remove a finished one."""
    try:
        job = await desk.cancel_or_delete(tenant, job_id) if ULID_PATTERN.fullmatch(job_id) else None
    except PartOfBatch as part:
        raise Refusal(
            409, "part-of-batch", "service-title-part-of-batch", compose("service-job-part-of-batch", batch=part.batch)
        ) from None
    if job is None:
        raise refuse_not_found(compose("service-job-unknown"))
    # A running job is only stopped by its worker after this answer, hence 202.
    return Response(status_code=204) if job == "deleted" else as_json(dump_job(job), 202)


async def find_job(desk: JobDesk, tenant: str, job_id: str) -> JobRow:
    """Return the job of a tenant.

    Raises
    ------
    Refusal
        404 if the tenant has no such job.
    """
    # The job of another tenant is answered like one that never existed.
    job = await desk.get(tenant, job_id) if ULID_PATTERN.fullmatch(job_id) else None
    if job is None:
        raise refuse_not_found(compose("service-job-unknown"))
    return job
