"""``/v1/me``: who the client is for the service, its limits and what it uses."""

from __future__ import annotations

from fastapi import APIRouter, Request
from pydantic import BaseModel, ConfigDict, Field
from starlette.concurrency import run_in_threadpool

from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.dependencies import Desk
from service.settings import Settings

TAG = {"name": "me", "description": "Limits of the client, and what it uses."}

router = APIRouter(prefix="/v1/me", tags=[TAG["name"]], route_class=GuardedRoute)


class ClientLimits(BaseModel):
    """Limits that the operator has set."""

    model_config = ConfigDict(title="Client limits")

    queued_jobs: int = Field(description="Maximum number of queued jobs of the tenant.")
    rate: str | None = Field(
        description="Requests allowed per key and time; null if there is no limit.", examples=["1200/minute"]
    )
    body_bytes: int = Field(description="Largest request body, bytes.")
    wait_s: int = Field(description="Longest wait granted to `Prefer: wait`, seconds.")
    job_s: float = Field(description="Time limit of a job, seconds.")
    job_memory_mb: int = Field(description="Memory limit of a job, MiB.")
    retention_days: float | None = Field(description="Days for which finished jobs are kept; null for ever.")


class ClientUse(BaseModel):
    """Present use of the limits."""

    model_config = ConfigDict(title="Client use")

    queued_jobs: int = Field(description="Queued jobs of the tenant, shares of batches included.")
    running_jobs: int = Field(description="Running jobs of the tenant, shares of batches included.")


class Me(BaseModel):
    """The client as the service sees it."""

    model_config = ConfigDict(title="Me")

    tenant: str = Field(description="Name of the tenant of the key; empty in a service without keys.")
    limits: ClientLimits
    use: ClientUse


@router.get("", operation_id="get_me", summary="Read limits and use")
async def get_me(request: Request, desk: Desk, tenant: Tenant) -> Me:
    """Return the tenant of the key, the limits of its jobs and requests, and the number of its unfinished jobs."""
    settings = request.app.state.settings
    assert isinstance(settings, Settings)
    unfinished = await run_in_threadpool(desk.store.count_unfinished, tenant)
    return Me(
        tenant=tenant,
        limits=ClientLimits(
            queued_jobs=settings.max_queued,
            rate=settings.rate_limit_rule if tenant else None,
            body_bytes=settings.max_body_bytes,
            wait_s=settings.max_wait_s,
            job_s=settings.job_timeout_s,
            job_memory_mb=settings.job_memory_mb,
            retention_days=settings.retention_days,
        ),
        use=ClientUse(queued_jobs=unfinished["queued"], running_jobs=unfinished["running"]),
    )
