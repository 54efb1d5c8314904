"""Answers that the processes of the answer desk compute, as replies or refusals."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from fastapi import Request, Response

from service.answers.desk import CPU_S, DRAWING_CPU_S, AnswerDesk
from service.answers.process import GZIP_MARK, compute_packed
from service.api.http.cached_representation import GZIP, takes_gzip
from service.api.http.problem_details import Refusal, busy, compiling, gone, invalid_mechanism
from service.jobs.processes.request_pool import Busy, GivenUp, Gone
from service.observability.telemetry import note_defect, span


async def answer_with_analysis(
    request: Request, answers: AnswerDesk, tenant: str, work: Callable[..., bytes], *args: Any
) -> Response:
    """Reply with the JSON that an analysis gives.

    Raises
    ------
    Refusal
        What the analysis refuses; 422 where it takes too much, 503 where its turn has not come, 499 where nobody waits.
    """
    try:
        with span("analysis"):
            if takes_gzip(request):
                work, args = compute_packed, (work, *args)
            content = await answers.analyse(request.is_disconnected, tenant, work, *args)
    except GivenUp as error:
        taken = f"{CPU_S:g} seconds of computation" if error.of == "time" else "more memory than an analysis has"
        detail = f"The analysis was given up after it took {taken}; are all sizes and counts meant so?"
        raise invalid_mechanism([("/mechanism", detail)]) from None
    except Busy:
        raise (busy("analyses") if answers.loaded else compiling()) from None
    except Gone:
        raise gone() from None
    except Refusal as refusal:
        raise _count_defect(refusal) from None
    packed = {"Content-Encoding": GZIP, "Vary": "Accept-Encoding"} if content.startswith(GZIP_MARK) else None
    return Response(content, headers=packed, media_type="application/json")


async def draw_in_turn(request: Request, answers: AnswerDesk, tenant: str, work: Callable[..., Any], *args: Any) -> Any:
    """Have something drawn, reported or exported.

    Raises
    ------
    Refusal
        As :func:`answer_with_analysis`; 409 where a design takes too much.
    """
    try:
        return await answers.draw(request.is_disconnected, tenant, work, *args)
    except GivenUp as error:
        taken = f"{DRAWING_CPU_S:g} seconds of computation" if error.of == "time" else "more memory than a drawing has"
        raise Refusal(409, "no-drawing", "No drawing", f"This was given up after it took {taken}.") from None
    except Busy:
        raise busy("drawings") from None
    except Gone:
        raise gone() from None
    except Refusal as refusal:
        raise _count_defect(refusal) from None


def _count_defect(refusal: Refusal) -> Refusal:
    """The refusal, which is counted where a defect of the service's own led to it."""
    if refusal.defect is not None:
        note_defect(refusal.defect)
    return refusal
