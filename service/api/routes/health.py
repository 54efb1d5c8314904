"""``/healthz`` and ``/readyz``: for those who watch over the service."""

from __future__ import annotations

from fastapi import APIRouter, Request

from service.api.http import problem_details
from service.api.http.problem_details import Refusal
from service.api.http.schemas import Health, Kernels, Readiness

TAG = {"name": "health", "description": "For those who watch over the service."}

router = APIRouter(tags=["health"])


@router.get("/healthz", operation_id="healthz", summary="Is it alive?")
async def healthz() -> Health:
    """The process answers."""
    return Health(status="ok")


@router.get(
    "/readyz",
    operation_id="readyz",
    summary="Does it take jobs?",
    responses=problem_details.responses(e503="The store does not answer, or no worker has started yet."),
)
async def readyz(request: Request) -> Readiness:
    """The store answers and at least one worker is ready.

    After an installation the numeric kernels are compiled beside the first jobs; `kernels` says how far that is.
    """
    missing = await request.app.state.desk.ready()
    if missing is not None:
        raise Refusal(503, "not-ready", "Not ready", missing, headers={"Retry-After": "1"})
    progress = request.app.state.kernels.progress
    kernels = None if progress is None else Kernels(compiled=progress.compiled, total=progress.total)
    return Readiness(status="ok", kernels=kernels)
