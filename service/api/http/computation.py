"""Responses computed by the processes of the answer desk, or the refusals of these requests."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from fastapi import Request, Response

from kinematics.message import compose
from service.answers.desk import CPU_S, DRAWING_CPU_S, AnswerDesk
from service.answers.process import GZIP_MARK, compute_packed
from service.api.http.cached_representation import GZIP, is_gzip_accepted
from service.api.http.problem_details import (
    Refusal,
    refuse_busy,
    refuse_compiling,
    refuse_gone,
    refuse_invalid_mechanism,
)
from service.jobs.processes.request_pool import Busy, ClientGone, GivenUp
from service.observability.telemetry import measure_span, note_defect

T = TypeVar("T")


async def respond_with_analysis(
    request: Request, answers: AnswerDesk, tenant: str, work: Callable[..., bytes], *args: object
) -> Response:
    """Respond with the JSON answer of an analysis.

    Raises
    ------
    Refusal
        By the analysis; 422 if it exceeds its limits, 503 if the service is busy, 499 if the client has disconnected.
    """
    try:
        with measure_span("analysis"):
            # Large answers are compressed by the process that computes them; here this would block the event loop.
            if is_gzip_accepted(request):
                work, args = compute_packed, (work, *args)
            content = await answers.analyse(request.is_disconnected, tenant, work, *args)
    except GivenUp as error:
        # 422: the client has sent this mechanism and can make it smaller.
        detail = (
            compose("service-analysis-exceeds-time", seconds=f"{CPU_S:g}")
            if error.of == "time"
            else compose("service-analysis-exceeds-memory")
        )
        raise refuse_invalid_mechanism([("/mechanism", detail)]) from None
    except Busy:
        raise (refuse_busy("service-busy-with-analyses") if answers.is_loaded else refuse_compiling()) from None
    except ClientGone:
        raise refuse_gone() from None
    except Refusal as refusal:
        raise _count_defect(refusal) from None
    packed = {"Content-Encoding": GZIP, "Vary": "Accept-Encoding"} if content.startswith(GZIP_MARK) else None
    return Response(content, headers=packed, media_type="application/json")


async def draw_in_turn(request: Request, answers: AnswerDesk, tenant: str, work: Callable[..., T], *args: object) -> T:
    """Compute a drawing, a report or an export.

    Raises
    ------
    Refusal
        As :func:`respond_with_analysis`, but 409 if a design exceeds the limits.
    """
    try:
        return await answers.draw(request.is_disconnected, tenant, work, *args)
    except GivenUp as error:
        # 409: the design is stored, and no change of the request makes it smaller.
        detail = (
            compose("service-drawing-exceeds-time", seconds=f"{DRAWING_CPU_S:g}")
            if error.of == "time"
            else compose("service-drawing-exceeds-memory")
        )
        raise Refusal(409, "no-drawing", "service-title-no-drawing", detail) from None
    except Busy:
        raise refuse_busy("service-busy-with-drawings") from None
    except ClientGone:
        raise refuse_gone() from None
    except Refusal as refusal:
        raise _count_defect(refusal) from None


def _count_defect(refusal: Refusal) -> Refusal:
    """Return the refusal, after counting it if a defect of the service caused it."""
    if refusal.defect is not None:
        note_defect(refusal.defect)
    return refusal
