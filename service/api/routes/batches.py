"""``/v1/batches``: many problems at once, given as one problem whose fields are varied."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Body, Header, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import to_json
from starlette.concurrency import run_in_threadpool
from starlette.responses import StreamingResponse

from kinematics.message import compose
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.body import JsonRoute
from service.api.http.dependencies import Batches, BatchPoller
from service.api.http.idempotency import KEY_PATTERN, read_repeatable, refuse_reused_key
from service.api.http.ids import ULID_PATTERN, decode_cursor, encode_cursor
from service.api.http.problem_details import refuse_full_queue, refuse_invalid_request, refuse_not_found
from service.api.http.replies import as_json, respond_unless_known
from service.api.routes.batch_plans import MAXIMIZED_METRICS, build_plan, select_default_metrics
from service.api.routes.batch_schemas import (
    EXAMPLE,
    Batch,
    BatchFront,
    BatchList,
    BatchRequest,
    BatchTable,
    describe_batch,
    dump_batch,
)
from service.api.routes.events import describe_events, stream_events
from service.jobs.batches.desk import BatchDesk
from service.jobs.batches.plan import Plan
from service.jobs.batches.rows import BatchRow
from service.jobs.batches.table import Table
from service.jobs.store.admission import KeyReused, QueueFull

TAG = {"name": "batches", "description": "Vary the fields of a problem and read the answers as a table."}

NO_BATCH = "No batch has this id."

RETRY_AFTER_S = 1

router = APIRouter(prefix="/v1/batches", tags=[TAG["name"]], route_class=JsonRoute)
following = APIRouter(prefix="/v1/batches", tags=[TAG["name"]], route_class=GuardedRoute)

_BODY = Body(openapi_examples={"motion": {"summary": "A grid of motion problems", "value": EXAMPLE}})
_LOCATION = {"Location": {"description": "Path of the batch.", "schema": {"type": "string"}}}
_RETRY_AFTER = {"Retry-After": {"description": "Seconds until the next request.", "schema": {"type": "integer"}}}
_ETAG = {"ETag": {"description": "Changes whenever the batch does.", "schema": {"type": "string"}}}


@router.post(
    "",
    operation_id="create_batch",
    summary="Submit many problems",
    response_class=Response,
    status_code=202,
    responses={
        200: {"model": Batch, "description": "The finished batch of an earlier equal request.", "headers": _LOCATION},
        202: {
            "model": Batch,
            "description": "The batch is accepted and will be run.",
            "headers": {**_LOCATION, **_RETRY_AFTER},
        },
        **problem_details.describe_responses(
            e400="The body is not JSON.",
            e409="The `Idempotency-Key` was used with a different body before.",
            e413="The body is too large.",
            e415="The body is not `application/json`.",
            e422="The body does not define valid problems; `errors` has the places.",
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
            pattern=KEY_PATTERN,
            description="Key of this request, as for a job: the same request sent again with the same key is answered "
            "with the first batch.",
            examples=["7f9c24e8"],
        ),
    ] = None,
) -> Response:
    """Accept a problem with varied fields. With the answer the batch is stored, and each of its problems will end."""
    keys = request.headers.getlist("idempotency-key")
    # Trying the values of a large batch takes long and must not block the event loop.
    kind, plan, cost = await run_in_threadpool(build_plan, body)
    try:
        batch = await desk.accept(
            tenant=tenant,
            kind=kind,
            label=body.label,
            plan=plan,
            cost=cost,
            repeatable=await run_in_threadpool(read_repeatable, keys, body),
        )
    except KeyReused:
        raise refuse_reused_key() from None
    except QueueFull:
        raise refuse_full_queue() from None
    headers = {"Location": f"/v1/batches/{batch.id}"}
    if batch.status.finished:
        return as_json(dump_batch(batch), 200, headers)
    return as_json(dump_batch(batch), 202, {**headers, "Retry-After": str(RETRY_AFTER_S)})


class BatchFilter(BaseModel):
    """Filter of the list of batches."""

    model_config = ConfigDict(extra="forbid")

    limit: int = Field(default=20, ge=1, le=100, description="Maximum number of batches on a page.")
    cursor: str | None = Field(default=None, max_length=100, description="`next_cursor` of the previous page.")


@router.get(
    "",
    operation_id="list_batches",
    summary="List batches",
    response_class=Response,
    responses={
        200: {"model": BatchList},
        **problem_details.describe_responses(e422="A parameter is not valid; `errors` names it."),
    },
)
async def list_batches(desk: Batches, tenant: Tenant, filter_: Annotated[BatchFilter, Query()]) -> Response:
    """Return a page of the batches, newest first."""
    before = None if filter_.cursor is None else decode_cursor(filter_.cursor)
    # One more than requested shows whether there is a next page.
    page = await desk.list_page(tenant=tenant, limit=filter_.limit + 1, before=before)
    shown = page[: filter_.limit]
    cursor = encode_cursor(shown[-1].id) if len(page) > filter_.limit else None
    return as_json(to_json({"batches": [describe_batch(batch) for batch in shown], "next_cursor": cursor}))


@router.get(
    "/{batch_id}",
    operation_id="get_batch",
    summary="Read a batch",
    response_class=Response,
    responses={
        200: {"model": Batch, "headers": _ETAG},
        304: {"description": "The batch is unchanged since the state that the client has.", "headers": _ETAG},
        **problem_details.describe_responses(e404=NO_BATCH),
    },
)
async def get_batch(
    request: Request,
    desk: Batches,
    tenant: Tenant,
    batch_id: str,
    if_none_match: Annotated[
        str | None, Header(description="`ETag` of the state that the client has.", examples=['"3"'])
    ] = None,
) -> Response:
    """Return the present state of the batch."""
    batch = await _find_batch(desk, tenant, batch_id)
    return respond_unless_known(request, batch.revision, lambda: dump_batch(batch))


@router.delete(
    "/{batch_id}",
    operation_id="delete_batch",
    summary="Cancel or remove a batch",
    response_class=Response,
    status_code=202,
    responses={
        202: {"model": Batch, "description": "The batch was unfinished and is cancelled; ended problems are kept."},
        204: {"description": "The batch was finished and is removed, with the jobs of its problems."},
        **problem_details.describe_responses(e404=NO_BATCH),
    },
)
async def delete_batch(desk: Batches, tenant: Tenant, batch_id: str) -> Response:
    """Cancel an unfinished batch; remove a finished one."""
    batch = await desk.cancel_or_delete(tenant, batch_id) if ULID_PATTERN.fullmatch(batch_id) else None
    if batch is None:
        raise refuse_not_found(compose("service-batch-unknown"))
    return Response(status_code=204) if batch == "deleted" else as_json(dump_batch(batch), 202)


@router.get(
    "/{batch_id}/table.json",
    operation_id="tabulate_batch",
    summary="Read the table of a batch",
    response_class=Response,
    responses={200: {"model": BatchTable}, **problem_details.describe_responses(e404=NO_BATCH)},
)
async def tabulate_batch(desk: Batches, tenant: Tenant, batch_id: str) -> Response:
    """Return a row for each problem, ended or not, in the order of the samples."""
    _, table = await _load_table(desk, tenant, batch_id)
    return StreamingResponse(table.as_json(), media_type="application/json")


@router.get(
    "/{batch_id}/table.csv",
    operation_id="tabulate_batch_as_csv",
    summary="Read the table of a batch as CSV",
    response_class=Response,
    responses={
        200: {"description": "The table.", "content": {"text/csv": {"schema": {"type": "string"}}}},
        **problem_details.describe_responses(e404=NO_BATCH),
    },
)
async def tabulate_batch_as_csv(desk: Batches, tenant: Tenant, batch_id: str) -> Response:
    """Return the table as CSV; numbers have all their digits."""
    _, table = await _load_table(desk, tenant, batch_id)
    headers = {"Content-Disposition": f'attachment; filename="batch-{batch_id}.csv"'}
    return StreamingResponse(table.as_csv(), media_type="text/csv; charset=utf-8", headers=headers)


class FrontQuery(BaseModel):
    """Metrics that define a front."""

    model_config = ConfigDict(extra="forbid")

    least: list[str] = Field(
        default=[], max_length=10, description="Metrics of the batch to minimize; may be repeated."
    )
    greatest: list[str] = Field(
        default=[], max_length=10, description="Metrics of the batch to maximize; may be repeated."
    )


@router.get(
    "/{batch_id}/front",
    operation_id="weigh_up_batch",
    summary="Read the front of a batch",
    response_class=Response,
    responses={
        200: {"model": BatchFront},
        **problem_details.describe_responses(
            e404=NO_BATCH, e422="A metric does not belong to the batch or is named twice; `errors` names it."
        ),
    },
)
async def weigh_up_batch(
    desk: Batches, tenant: Tenant, batch_id: str, weighed: Annotated[FrontQuery, Query()]
) -> Response:
    """Return the Pareto front of the table: the rows that no other row dominates.

    By default error and size (for gears the sum of the teeth) are minimized and the minimum transmission angle is
    maximized, as far as the table has them. Signed errors count by their absolute values.
    """
    plan, table = await _load_table(desk, tenant, batch_id)
    least, greatest = _select_quantities(weighed, plan.metrics)
    front = await run_in_threadpool(table.select_front, least, greatest)
    return StreamingResponse(front.as_json(least=least, greatest=greatest), media_type="application/json")


@following.get(
    "/{batch_id}/events",
    operation_id="follow_batch",
    summary="Follow a batch",
    response_class=Response,
    responses={
        200: {
            "description": "Events until the batch has ended, as for a job: `state` (the batch as in a list) and "
            "`progress`; `removed` if it is removed before its end was sent.",
            "content": {"text/event-stream": describe_events("BatchListItem")},
        },
        204: {"description": "The client already has the event of the final state and need not reconnect."},
        **problem_details.describe_responses(e404=NO_BATCH, e503="Too many clients of the tenant are listening."),
    },
)
async def follow_batch(
    request: Request,
    poller: BatchPoller,
    tenant: Tenant,
    batch_id: str,
    last_event_id: Annotated[
        str | None,
        Header(description="`id` of the last event that the client has; browsers send it automatically."),
    ] = None,
) -> Response:
    """Stream the progress of the batch as server-sent events."""
    return await stream_events(
        request, poller, tenant, batch_id, last_event_id, describe_batch, "service-batch-unknown"
    )


async def _find_batch(desk: BatchDesk, tenant: str, batch_id: str) -> BatchRow:
    batch = await desk.get(tenant, batch_id) if ULID_PATTERN.fullmatch(batch_id) else None
    if batch is None:
        raise refuse_not_found(compose("service-batch-unknown"))
    return batch


async def _load_table(desk: BatchDesk, tenant: str, batch_id: str) -> tuple[Plan, Table]:
    tabulated = await desk.load_table(await _find_batch(desk, tenant, batch_id))
    if tabulated is None:
        raise refuse_not_found(compose("service-batch-unknown"))
    return tabulated


def _select_quantities(weighed: FrontQuery, metrics: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return the names of the metrics to minimize and to maximize; raise a refusal if the request is invalid."""
    faults = []
    unknown = (
        compose("service-batch-metric-unknown", metrics=", ".join(metrics))
        if metrics
        else compose("service-batch-without-metrics")
    )
    for k, name in enumerate([*weighed.least, *weighed.greatest]):
        place = "/query/least" if k < len(weighed.least) else "/query/greatest"
        if name not in metrics:
            faults.append((place, unknown))
        elif name in [*weighed.least, *weighed.greatest][:k]:
            faults.append((place, compose("service-metric-weighed-twice", metric=name)))
    usual = [] if weighed.least or weighed.greatest else select_default_metrics(metrics)
    if not (weighed.least or weighed.greatest or usual):
        faults.append(("/query/least", compose("service-metric-missing")))
    if faults:
        raise refuse_invalid_request(faults)
    if usual:
        return [n for n in usual if n not in MAXIMIZED_METRICS], [n for n in usual if n in MAXIMIZED_METRICS]
    return weighed.least, weighed.greatest
