"""``/healthz`` and ``/readyz``: for monitoring the service."""

from __future__ import annotations

from fastapi import APIRouter, Request

from service.api.http import problem_details
from service.api.http.problem_details import Refusal
from service.api.http.schemas import Health, Kernels, Readiness

TAG = {"name": "health", "description": "Monitor the service."}

router = APIRouter(tags=["health"])


@router.get("/healthz", operation_id="healthz", summary="Check that the process is alive")
async def healthz() -> Health:
    """Report that the process answers."""
    return Health(status="ok")


@router.get(
    "/readyz",
    operation_id="readyz",
    summary="Check that the service takes jobs",
    responses=problem_details.describe_responses(e503="The store does not answer, or no worker has started yet."),
)
async def readyz(request: Request) -> Readiness:
    """Report that the store answers and at least one worker is ready.

    After an installation the numerical kernels are compiled in parallel with the first jobs; `kernels` has the
    progress.
    """
    progress = request.app.state.kernels.progress
    is_compiling = progress is not None and progress.compiled < progress.total
    missing = await request.app.state.desk.check_readiness(is_compiling)
    if missing is not None:
        raise Refusal(503, "not-ready", "service-title-not-ready", missing, headers={"Retry-After": "1"})
    kernels = None if progress is None else Kernels(compiled=progress.compiled, total=progress.total)
    return Readiness(status="ok", kernels=kernels)
