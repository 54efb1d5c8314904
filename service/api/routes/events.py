"""``/v1/jobs/{id}/events``: a job as it goes on, as server-sent events.

An event's id is the job's revision and state, ``7-running``. That is all that a client's resumption needs: the newest
state is sent where the client does not have it, and what it has missed in between is of no interest any more.
"""

from __future__ import annotations

import re
from collections.abc import AsyncIterator, Callable
from typing import Annotated, Any

from fastapi import APIRouter, Header, Request, Response
from fastapi.sse import EventSourceResponse, format_sse_event
from pydantic_core import to_json

from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.dependencies import Poller
from service.api.http.ids import ULID
from service.api.http.problem_details import Refusal, not_found, store_unavailable
from service.api.http.schemas import list_item
from service.api.routes.jobs import NO_JOB, TAG
from service.jobs.events.poller import F, Follower, JobPoller
from service.jobs.store.states import Status
from service.observability.head import asked_for_head

KEEP_ALIVE_S = 15.0
"""After so much silence a comment is sent, so that nobody between takes the connection for dead."""

MAX_LISTENERS = 1000
"""Streams of a tenant at once; each is a connection and a task of the server."""

STORE_ANSWERS_S = 10.0
"""How long a client is kept waiting for the first look into the store."""

_RECONNECT_MS = 1000
_HEADERS = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}
_EVENT_ID = re.compile(f"([0-9]{{1,9}})-({'|'.join(Status)})")


def event_schema(item: str) -> dict[str, Any]:
    """The schema of an event whose state is shown as the component ``item``."""
    return {
        "type": "object",
        "required": ["event", "data"],
        "properties": {
            "event": {"type": "string", "enum": ["state", "progress", "removed"]},
            "data": {
                "type": "string",
                "contentMediaType": "application/json",
                "contentSchema": {
                    "anyOf": [
                        {"$ref": f"#/components/schemas/{item}"},
                        {"$ref": "#/components/schemas/Progress"},
                        {"type": "object", "maxProperties": 0},
                    ]
                },
            },
            "id": {"type": "string", "pattern": f"^{_EVENT_ID.pattern}$", "examples": ["7-running"]},
            "retry": {"type": "integer"},
        },
    }


router = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)


@router.get(
    "/{job_id}/events",
    operation_id="follow_job",
    summary="Follow a job",
    response_class=Response,
    responses={
        200: {
            "description": "Events until the job has ended: `state` (the job as in a list) whenever its state changes, "
            "first of all the present one, and `progress` in between. The event of the final state is the last one; "
            "a job that is removed before anybody has seen it end ends with `removed`.",
            "content": {"text/event-stream": {"itemSchema": event_schema("JobListItem")}},
        },
        204: {"description": "The client has the event of the final state already; it need not come again."},
        **problem_details.responses(e404=NO_JOB, e503="Too many clients of the tenant listen at once."),
    },
)
async def follow_job(
    request: Request,
    poller: Poller,
    tenant: Tenant,
    job_id: str,
    last_event_id: Annotated[
        str | None,
        Header(description="The `id` of the last event that the client has; browsers send it by themselves."),
    ] = None,
) -> Response:
    """The job as it goes on, as server-sent events.

    A stream that breaks can be resumed with `Last-Event-ID`: nothing that the client has seen is repeated.
    """
    return await followed(request, poller, tenant, job_id, last_event_id, list_item, NO_JOB)


async def followed(
    request: Request,
    poller: JobPoller[F],
    tenant: str,
    id_: str,
    last_event_id: str | None,
    shown: Callable[[F], dict[str, Any]],
    none_such: str,
) -> Response:
    """The stream of what a poller follows, as ``shown``, which has its progress too.

    Raises
    ------
    Refusal
        503 where too many of the tenant listen or the store does not answer; 404 where the tenant has none such.
    """
    if poller.listeners_of(tenant) >= MAX_LISTENERS:
        raise Refusal(
            503, "too-many-listeners", "Too many listeners", "Too many of your clients listen at once; ask again.",
            headers={"Retry-After": "5"},
        )  # fmt: skip
    job = await _present(poller, id_, tenant) if ULID.fullmatch(id_) else None
    if job is None or job.tenant != tenant:
        raise not_found(none_such)
    seen = _seen(last_event_id)
    if job.status.finished and seen == (job.revision, job.status):
        return Response(status_code=204)
    if asked_for_head(request.scope):
        return EventSourceResponse(_nothing(), headers=_HEADERS)
    return EventSourceResponse(_events(poller, job, seen, shown), headers=_HEADERS)


async def _present(poller: JobPoller[F], job_id: str, tenant: str) -> F | None:
    with poller.follow(job_id, tenant) as follower:
        await follower.changed(STORE_ANSWERS_S)
        if not follower.read:
            raise store_unavailable()
        return follower.job


async def _events(
    poller: JobPoller[F], job: F, seen: tuple[int, Status] | None, shown: Callable[[F], dict[str, Any]]
) -> AsyncIterator[bytes]:
    """The stream of a job. It ends with the job, or without an event when the service stops."""
    with poller.follow(job.id, job.tenant) as follower:
        follower.update(job)
        while not poller.closed:
            if not await follower.changed(KEEP_ALIVE_S):
                yield format_sse_event(comment="keep-alive")
                continue
            event = _event(follower, seen, shown)
            if event is not None:
                yield event
            if follower.job is None or follower.job.status.finished:
                return
            seen = (follower.job.revision, follower.job.status)


def _event(
    follower: Follower[F], seen: tuple[int, Status] | None, shown: Callable[[F], dict[str, Any]]
) -> bytes | None:
    """What a client that has seen ``seen`` is to be told; None where there is nothing new."""
    job = follower.job
    if job is None:
        return format_sse_event(event="removed", data_str="{}")
    if seen is not None and job.revision <= seen[0]:
        return None
    state = seen is None or seen[1] != job.status
    return format_sse_event(
        event="state" if state else "progress",
        data_str=to_json(shown(job) if state else shown(job)["progress"]).decode(),
        id=f"{job.revision}-{job.status.value}",
        retry=_RECONNECT_MS if seen is None else None,
    )


async def _nothing() -> AsyncIterator[bytes]:
    return
    yield b""


def _seen(last_event_id: str | None) -> tuple[int, Status] | None:
    # An id that is none of ours is ignored, as if the client came for the first time.
    match = _EVENT_ID.fullmatch(last_event_id or "")
    return None if match is None else (int(match[1]), Status(match[2]))
