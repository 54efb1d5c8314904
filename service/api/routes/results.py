"""``/v1/jobs/{id}/result``: the answer of a job without the job."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Header, Request, Response

from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.dependencies import Desk
from service.api.http.replies import respond_unless_known
from service.api.http.schemas import translate_stored
from service.api.routes.designs import get_job_with_result
from service.api.routes.jobs import NO_JOB, TAG
from synthesis.registry import KINDS

_ETAG = {"ETag": {"description": "Changes whenever the job does.", "schema": {"type": "string"}}}
# References and no model: the validator of all answers would delay the start of the service.
_SCHEMA = {"anyOf": [{"$ref": f"#/components/schemas/{kind.result.__name__}"} for kind in KINDS.values()]}

router = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)


@router.get(
    "/{job_id}/result",
    operation_id="get_result",
    summary="Read the result of a job",
    response_class=Response,
    responses={
        200: {
            "description": "The `result` of the job.",
            "content": {"application/json": {"schema": _SCHEMA}},
            "headers": _ETAG,
        },
        304: {"description": "The client has the result already.", "headers": _ETAG},
        **problem_details.describe_responses(e404=NO_JOB, e409="The job has no result, or none yet."),
    },
)
async def get_result(
    request: Request,
    desk: Desk,
    tenant: Tenant,
    job_id: str,
    if_none_match: Annotated[str | None, Header(description="`ETag` of the result that the client has.")] = None,
) -> Response:
    """Return the answer to the problem of a job that has succeeded, without the problem and the state."""
    job, result = await get_job_with_result(desk, tenant, job_id)
    return respond_unless_known(request, job.revision, lambda: translate_stored(result).encode())
