"""``/v1/batches``: many problems at once, stated as one whose fields are varied."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Body, Header, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import to_json
from starlette.concurrency import run_in_threadpool
from starlette.responses import StreamingResponse

from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.body import JsonRoute
from service.api.http.dependencies import Batches, BatchPoller
from service.api.http.idempotency import KEY, key_reused, repeatable
from service.api.http.ids import ULID, cursor_of, id_of_cursor
from service.api.http.problem_details import invalid_request, not_found, queue_full
from service.api.http.replies import as_json, unless_known
from service.api.routes.batch_plans import MORE_IS_BETTER, by_default, plan_of
from service.api.routes.batch_schemas import (
    EXAMPLE,
    Batch,
    BatchFront,
    BatchList,
    BatchRequest,
    BatchTable,
    batch_item,
    whole_batch,
)
from service.api.routes.events import event_schema, followed
from service.jobs.batches.desk import BatchDesk
from service.jobs.batches.plan import Plan
from service.jobs.batches.rows import BatchRow
from service.jobs.batches.table import Table
from service.jobs.store.admission import KeyReused, QueueFull

TAG = {"name": "batches", "description": "Vary the fields of a problem, and read the answers as a table."}

NO_BATCH = "There is no batch with this id."

RETRY_AFTER_S = 1

router = APIRouter(prefix="/v1/batches", tags=[TAG["name"]], route_class=JsonRoute)
following = APIRouter(prefix="/v1/batches", tags=[TAG["name"]], route_class=GuardedRoute)

_BODY = Body(openapi_examples={"motion": {"summary": "A grid of motion problems", "value": EXAMPLE}})
_LOCATION = {"Location": {"description": "The path of the batch.", "schema": {"type": "string"}}}
_RETRY_AFTER = {"Retry-After": {"description": "Look again after so many seconds.", "schema": {"type": "integer"}}}
_ETAG = {"ETag": {"description": "Changes whenever the batch does.", "schema": {"type": "string"}}}


@router.post(
    "",
    operation_id="create_batch",
    summary="State many problems",
    response_class=Response,
    status_code=202,
    responses={
        200: {"model": Batch, "description": "The finished batch of an earlier equal request.", "headers": _LOCATION},
        202: {
            "model": Batch,
            "description": "The batch is accepted and will be run.",
            "headers": {**_LOCATION, **_RETRY_AFTER},
        },
        **problem_details.responses(
            e400="The body is not JSON.",
            e409="The `Idempotency-Key` came with another body before.",
            e413="The body is too large.",
            e415="The body is not `application/json`.",
            e422="The body does not state problems; `errors` says where.",
            e503="The queue is full.",
        ),
    },
)
async def create_batch(
    request: Request,
    desk: Batches,
    tenant: Tenant,
    body: Annotated[BatchRequest, _BODY],
    idempotency_key: Annotated[
        str | None,
        Header(
            pattern=KEY,
            description="A name for this request, as of a job: sent again with it, the request is answered with the "
            "first batch.",
            examples=["7f9c24e8"],
        ),
    ] = None,
) -> Response:
    """Accept a problem whose fields are varied. Once this is answered the batch is stored, and each problem ends."""
    keys = request.headers.getlist("idempotency-key")
    kind, plan, cost = await run_in_threadpool(plan_of, body)
    try:
        batch = await desk.accept(
            tenant=tenant,
            kind=kind,
            label=body.label,
            plan=plan,
            cost=cost,
            repeatable=await run_in_threadpool(repeatable, keys, body),
        )
    except KeyReused:
        raise key_reused() from None
    except QueueFull:
        raise queue_full() from None
    headers = {"Location": f"/v1/batches/{batch.id}"}
    if batch.status.finished:
        return as_json(whole_batch(batch), 200, headers)
    return as_json(whole_batch(batch), 202, {**headers, "Retry-After": str(RETRY_AFTER_S)})


class BatchFilter(BaseModel):
    """Which batches to list."""

    model_config = ConfigDict(extra="forbid")

    limit: int = Field(default=20, ge=1, le=100, description="Batches on a page, at most.")
    cursor: str | None = Field(default=None, max_length=100, description="`next_cursor` of the page before.")


@router.get(
    "",
    operation_id="list_batches",
    summary="List batches",
    response_class=Response,
    responses={
        200: {"model": BatchList},
        **problem_details.responses(e422="A parameter is not valid; `errors` says which."),
    },
)
async def list_batches(desk: Batches, tenant: Tenant, filter_: Annotated[BatchFilter, Query()]) -> Response:
    """The batches, newest first, a page at a time."""
    before = None if filter_.cursor is None else id_of_cursor(filter_.cursor)
    page = await desk.page(tenant=tenant, limit=filter_.limit + 1, before=before)
    shown = page[: filter_.limit]
    cursor = cursor_of(shown[-1].id) if len(page) > filter_.limit else None
    return as_json(to_json({"batches": [batch_item(batch) for batch in shown], "next_cursor": cursor}))


@router.get(
    "/{batch_id}",
    operation_id="get_batch",
    summary="Read a batch",
    response_class=Response,
    responses={
        200: {"model": Batch, "headers": _ETAG},
        304: {"description": "The batch is as the client knows it.", "headers": _ETAG},
        **problem_details.responses(e404=NO_BATCH),
    },
)
async def get_batch(
    request: Request,
    desk: Batches,
    tenant: Tenant,
    batch_id: str,
    if_none_match: Annotated[
        str | None, Header(description="The `ETag` of the state that the client has.", examples=['"3"'])
    ] = None,
) -> Response:
    """The batch as it stands."""
    batch = await _batch_of(desk, tenant, batch_id)
    return unless_known(request, batch.revision, lambda: whole_batch(batch))


@router.delete(
    "/{batch_id}",
    operation_id="delete_batch",
    summary="Cancel or remove a batch",
    response_class=Response,
    status_code=202,
    responses={
        202: {"model": Batch, "description": "The batch was unfinished and is cancelled; what has ended of it stays."},
        204: {"description": "The batch was finished and is removed, with the jobs of its problems."},
        **problem_details.responses(e404=NO_BATCH),
    },
)
async def delete_batch(desk: Batches, tenant: Tenant, batch_id: str) -> Response:
    """Cancel an unfinished batch; remove a finished one."""
    batch = await desk.cancel_or_delete(tenant, batch_id) if ULID.fullmatch(batch_id) else None
    if batch is None:
        raise not_found(NO_BATCH)
    return Response(status_code=204) if batch == "deleted" else as_json(whole_batch(batch), 202)


@router.get(
    "/{batch_id}/table.json",
    operation_id="tabulate_batch",
    summary="Read the table of a batch",
    response_class=Response,
    responses={200: {"model": BatchTable}, **problem_details.responses(e404=NO_BATCH)},
)
async def tabulate_batch(desk: Batches, tenant: Tenant, batch_id: str) -> Response:
    """A row for each problem, in the order of the samples, ended or not."""
    _, table = await _tabulated(desk, tenant, batch_id)
    return StreamingResponse(table.as_json(), media_type="application/json")


@router.get(
    "/{batch_id}/table.csv",
    operation_id="tabulate_batch_as_csv",
    summary="Read the table of a batch as CSV",
    response_class=Response,
    responses={
        200: {"description": "The table.", "content": {"text/csv": {"schema": {"type": "string"}}}},
        **problem_details.responses(e404=NO_BATCH),
    },
)
async def tabulate_batch_as_csv(desk: Batches, tenant: Tenant, batch_id: str) -> Response:
    """The same as CSV; numbers have all their digits."""
    _, table = await _tabulated(desk, tenant, batch_id)
    return StreamingResponse(table.as_csv(), media_type="text/csv; charset=utf-8")


class Weighed(BaseModel):
    """What the rows are weighed up by."""

    model_config = ConfigDict(extra="forbid")

    least: list[str] = Field(
        default=[], max_length=10, description="Metrics of the batch of which less is better; may be repeated."
    )
    greatest: list[str] = Field(
        default=[], max_length=10, description="Metrics of which more is better; may be repeated."
    )


@router.get(
    "/{batch_id}/front",
    operation_id="weigh_up_batch",
    summary="Read the front of a batch",
    response_class=Response,
    responses={
        200: {"model": BatchFront},
        **problem_details.responses(
            e404=NO_BATCH, e422="A metric is none of the batch, or named twice; `errors` says which."
        ),
    },
)
async def weigh_up_batch(
    desk: Batches, tenant: Tenant, batch_id: str, weighed: Annotated[Weighed, Query()]
) -> Response:
    """The rows of the table that no other beats (Pareto).

    Without parameters: by error and size (of gears the sum of the teeth), of which less is better, and the least
    transmission angle, as far as the table has them. Of errors with a sign the size counts.
    """
    plan, table = await _tabulated(desk, tenant, batch_id)
    least, greatest = _quantities(weighed, plan.metrics)
    front = await run_in_threadpool(table.front, least, greatest)
    return StreamingResponse(front.as_json(least=least, greatest=greatest), media_type="application/json")


@following.get(
    "/{batch_id}/events",
    operation_id="follow_batch",
    summary="Follow a batch",
    response_class=Response,
    responses={
        200: {
            "description": "Events until the batch has ended, as of a job: `state` (the batch as in a list) and "
            "`progress`; `removed` where it is removed before its end was seen.",
            "content": {"text/event-stream": {"itemSchema": event_schema("BatchListItem")}},
        },
        204: {"description": "The client has the event of the final state already; it need not come again."},
        **problem_details.responses(e404=NO_BATCH, e503="Too many clients of the tenant listen at once."),
    },
)
async def follow_batch(
    request: Request,
    poller: BatchPoller,
    tenant: Tenant,
    batch_id: str,
    last_event_id: Annotated[
        str | None,
        Header(description="The `id` of the last event that the client has; browsers send it by themselves."),
    ] = None,
) -> Response:
    """The batch as it goes on, as server-sent events."""
    return await followed(request, poller, tenant, batch_id, last_event_id, batch_item, NO_BATCH)


async def _batch_of(desk: BatchDesk, tenant: str, batch_id: str) -> BatchRow:
    batch = await desk.get(tenant, batch_id) if ULID.fullmatch(batch_id) else None
    if batch is None:
        raise not_found(NO_BATCH)
    return batch


async def _tabulated(desk: BatchDesk, tenant: str, batch_id: str) -> tuple[Plan, Table]:
    tabulated = await desk.table(await _batch_of(desk, tenant, batch_id))
    if tabulated is None:
        raise not_found(NO_BATCH)
    return tabulated


def _quantities(weighed: Weighed, metrics: Sequence[str]) -> tuple[list[str], list[str]]:
    """What is to be least and what greatest, by their names; raises a refusal for what cannot be meant."""
    faults = []
    for k, name in enumerate([*weighed.least, *weighed.greatest]):
        place = "/query/least" if k < len(weighed.least) else "/query/greatest"
        if name not in metrics:
            faults.append((place, f"The metrics of the batch are {', '.join(metrics) or 'none'}."))
        elif name in [*weighed.least, *weighed.greatest][:k]:
            faults.append((place, f"{name} is named already; it can be weighed up once, one way."))
    usual = [] if weighed.least or weighed.greatest else by_default(metrics)
    if not (weighed.least or weighed.greatest or usual):
        faults.append(("/query/least", "Name what is to be least, or greatest."))
    if faults:
        raise invalid_request(faults)
    if usual:
        return [n for n in usual if n not in MORE_IS_BETTER], [n for n in usual if n in MORE_IS_BETTER]
    return weighed.least, weighed.greatest
