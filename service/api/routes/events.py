"""``/v1/jobs/{id}/events``: the progress of a job as server-sent events.

An event's id consists of the job's revision and state, for example ``7-running``. That is all a client needs to resume:
the newest state is sent if the client does not have it, and events missed in between are obsolete.
"""

from __future__ import annotations

import re
from collections.abc import AsyncIterator, Callable
from typing import Annotated

from fastapi import APIRouter, Header, Request, Response
from fastapi.sse import EventSourceResponse, format_sse_event
from pydantic_core import to_json

from kinematics.message import compose
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.dependencies import Poller
from service.api.http.ids import ULID_PATTERN
from service.api.http.problem_details import Refusal, refuse_not_found, refuse_without_store
from service.api.http.schemas import describe_job
from service.api.routes.jobs import NO_JOB, TAG
from service.jobs.events.poller import F, Follower, JobPoller
from service.jobs.store.states import Status
from service.observability.head import is_head_request
from synthesis.model.json_object import JsonObject

KEEP_ALIVE_S = 15.0
"""Silence after which a comment is sent, seconds, so that proxies do not take the connection for dead."""

MAX_LISTENERS = 1000
"""Maximum number of concurrent streams of a tenant; each is a connection and a task of the server."""

STORE_TIMEOUT_S = 10.0
"""Time limit for the first query of the store, seconds."""

_RECONNECT_MS = 1000
_HEADERS = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}
_EVENT_ID = re.compile(f"([0-9]{{1,9}})-({'|'.join(Status)})")


def describe_events(item: str) -> JsonObject:
    """Return the media type object of a stream of events whose state is the component ``item``.

    OpenAPI has a keyword for the items of a stream, `itemSchema`, only since version 3.2. A `schema` would be taken for
    that of the whole stream by some programs and for that of an event by others, so there is none.
    """
    return {"x-item-schema": _build_event_schema(item)}


def _build_event_schema(item: str) -> JsonObject:
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
            "description": "Events until the job has ended: `state` (the job as in a list) first and at each change of "
            "its state, and `progress` in between. The event of the final state is the last one, or `removed` if the "
            "job is removed before its end was sent.",
            "content": {"text/event-stream": describe_events("JobListItem")},
        },
        204: {"description": "The client already has the event of the final state and need not reconnect."},
        **problem_details.describe_responses(e404=NO_JOB, e503="Too many clients of the tenant are listening."),
    },
)
async def follow_job(
    request: Request,
    poller: Poller,
    tenant: Tenant,
    job_id: str,
    last_event_id: Annotated[
        str | None,
        Header(description="`id` of the last event that the client has; browsers send it automatically."),
    ] = None,
) -> Response:
    """Stream the progress of the job as server-sent events.

    A broken stream can be resumed with `Last-Event-ID`; events that the client has are not repeated.
    """
    return await stream_events(request, poller, tenant, job_id, last_event_id, describe_job, "service-job-unknown")


async def stream_events(
    request: Request,
    poller: JobPoller[F],
    tenant: str,
    id_: str,
    last_event_id: str | None,
    shown: Callable[[F], JsonObject],
    unknown_id: str,
) -> Response:
    """Return the event stream of a job or batch; ``shown`` converts it to JSON-like data with its ``progress``.

    Raises
    ------
    Refusal
        503 if too many clients of the tenant listen or the store does not answer; 404 if the tenant has no such job.
    """
    # Every stream keeps a connection open; one tenant must not use up those of all.
    if poller.count_listeners(tenant) >= MAX_LISTENERS:
        raise Refusal(
            503, "too-many-listeners", "service-title-too-many-listeners", compose("service-too-many-listeners"),
            headers={"Retry-After": "5"},
        )  # fmt: skip
    job = await _read_current(poller, id_, tenant) if ULID_PATTERN.fullmatch(id_) else None
    if job is None or job.tenant != tenant:
        raise refuse_not_found(compose(unknown_id))
    seen = _parse_event_id(last_event_id)
    # The client has the last event; a stream without events would make browsers reconnect for ever.
    if job.status.finished and seen == (job.revision, job.status):
        return Response(status_code=204)
    # HEAD gets the headers at once; the stream would end only with the job.
    if is_head_request(request.scope):
        return EventSourceResponse(_generate_nothing(), headers=_HEADERS)
    return EventSourceResponse(_generate_events(poller, job, seen, shown), headers=_HEADERS)


async def _read_current(poller: JobPoller[F], job_id: str, tenant: str) -> F | None:
    with poller.follow(job_id, tenant) as follower:
        # The poller reads the jobs of all listeners in one query.
        await follower.wait_for_change(STORE_TIMEOUT_S)
        if not follower.read:
            raise refuse_without_store()
        return follower.job


async def _generate_events(
    poller: JobPoller[F], job: F, seen: tuple[int, Status] | None, shown: Callable[[F], JsonObject]
) -> AsyncIterator[bytes]:
    """Generate the events of a job. The stream ends with the job, or without an event when the service stops."""
    with poller.follow(job.id, job.tenant) as follower:
        # The state just read is the first event; the poller must not read it again.
        follower.update(job)
        while not poller.closed:
            if not await follower.wait_for_change(KEEP_ALIVE_S):
                # Proxies close connections on which nothing is sent.
                yield format_sse_event(comment="keep-alive")
                continue
            event = _format_event(follower, seen, shown)
            if event is not None:
                yield event
            if follower.job is None or follower.job.status.finished:
                return
            seen = (follower.job.revision, follower.job.status)


def _format_event(
    follower: Follower[F], seen: tuple[int, Status] | None, shown: Callable[[F], JsonObject]
) -> bytes | None:
    """Return the event for a client that has the state ``seen``; None if nothing is new."""
    job = follower.job
    if job is None:
        return format_sse_event(event="removed", data_str="{}")
    # The client may have received a newer state from another server than the one that this server read last.
    if seen is not None and job.revision <= seen[0]:
        return None
    state = seen is None or seen[1] != job.status
    return format_sse_event(
        event="state" if state else "progress",
        data_str=to_json(shown(job) if state else shown(job)["progress"]).decode(),
        id=f"{job.revision}-{job.status.value}",
        # Once is enough: browsers keep the time for the whole stream.
        retry=_RECONNECT_MS if seen is None else None,
    )


# The unreachable yield makes it a generator.
async def _generate_nothing() -> AsyncIterator[bytes]:
    return
    yield b""


def _parse_event_id(last_event_id: str | None) -> tuple[int, Status] | None:
    # An unknown id is ignored, as if the client connected for the first time.
    match = _EVENT_ID.fullmatch(last_event_id or "")
    return None if match is None else (int(match[1]), Status(match[2]))
