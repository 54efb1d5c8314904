"""``/v1/jobs/{id}/designs/{n}/parts``, ``.step`` and ``.glb``: a design as parts that can be made."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from pydantic_core import from_json
from starlette.concurrency import run_in_threadpool

from service.api import errors
from service.api.designs import design_index, solved
from service.api.errors import Refusal, busy, invalid_request, not_found
from service.api.guard import GuardedRoute, Tenant
from service.api.jobs import TAG
from service.api.state import Bench, Desk
from service.jobs.schema import JobRow
from service.parts.extra import installed
from service.parts.made import has_parts
from service.parts.sizes import NEEDS_CAD, AssemblyQuery, File, PartsQuery, Refused
from service.parts.workshop import MAX_PARTS_S, Busy, GivenUp, Gone, filled
from service.telemetry import span

router = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)

_BINARY = {"type": "string", "format": "binary"}
_MEDIA: dict[File, str] = {"zip": "application/zip", "step": "model/step", "glb": "model/gltf-binary"}


def _responses(file: File) -> dict[int | str, dict[str, Any]]:
    return {
        200: {"description": "The file.", "content": {_MEDIA[file]: {"schema": _BINARY}}},
        **errors.responses(
            e404="There is no such job or design, or no parts of its type of mechanism.",
            e409="The job has no result (yet), or the design cannot be built of parts; `detail` says why.",
            e422="A parameter is not valid, or leaves no room for the parts; `errors` says which, and what would.",
            e501="The service runs without its extra `cad`, which this file needs.",
            e503="Other parts have kept these from being begun.",
        ),
    }


@router.get(
    "/{job_id}/designs/{number}/parts",
    operation_id="make_parts",
    summary="Make the parts of a design",
    response_class=Response,
    responses=_responses("zip"),
)
async def make_parts(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str,
    query: Annotated[PartsQuery, Query()],
) -> Response:  # fmt: skip
    """Design ``number`` of the job's result as a zip of parts: plates, pins, washers, spacers and blocks.

    A DXF outline of each plate, an exploded side view, a bill of materials and the assembly as STEP; printed parts have
    STL and 3MF files besides, milled ones STEP files. All files are in millimetres. Links lie in planes that are found
    for these sizes, and nothing is given of which two parts would meet in the motion. `print` and `mill` need the
    service's extra `cad`; without it `laser` has no STEP file.
    """
    return await _answered(request, desk, bench, tenant, job_id, number, query, "zip")


@router.get(
    "/{job_id}/designs/{number}.step",
    operation_id="export_assembly_step",
    summary="Export a design's assembly as STEP",
    response_class=Response,
    responses=_responses("step"),
)
async def export_assembly_step(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str,
    query: Annotated[AssemblyQuery, Query()],
) -> Response:  # fmt: skip
    """The parts of design ``number`` at their places, in millimetres, with names and colours (AP242)."""
    return await _answered(request, desk, bench, tenant, job_id, number, query, "step")


@router.get(
    "/{job_id}/designs/{number}.glb",
    operation_id="export_assembly_glb",
    summary="Export a design's assembly as glTF",
    response_class=Response,
    responses=_responses("glb"),
)
async def export_assembly_glb(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str,
    query: Annotated[AssemblyQuery, Query()],
) -> Response:  # fmt: skip
    """The parts of design ``number`` at their places as binary glTF: in metres, with the shafts upwards along y."""
    return await _answered(request, desk, bench, tenant, job_id, number, query, "glb")


async def _answered(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str, query: PartsQuery, file: File
) -> Response:
    job, result = await solved(desk, tenant, job_id)
    n = await run_in_threadpool(_checked, result, number)
    if (file != "zip" or query.process in NEEDS_CAD) and not installed():
        raise Refusal(
            501, "no-cad", "No CAD",
            "The service runs without its extra `cad`, which makes solids; `process=laser` has outlines without it.",
        )  # fmt: skip
    stated = query.model_dump(exclude_unset=True)

    async def make() -> bytes:
        return await _made(request, bench, job, result, n, stated, file)

    with span("parts"):
        of = repr((job.kind, job.problem, job.label, result, n, sorted(stated.items()), file))
        content = await bench.kept(of, make)
    name = f"{job.kind}-{n}-parts.zip" if file == "zip" else f"{job.kind}-{n}.{file}"
    headers = {"X-Content-Type-Options": "nosniff", "Content-Disposition": f'attachment; filename="{name}"'}
    return Response(content, media_type=_MEDIA[file], headers=headers)


async def _made(
    request: Request, bench: Bench, job: JobRow, result: str, number: int, stated: dict[str, Any], file: File
) -> bytes:
    try:
        made = await bench.call(
            request.is_disconnected, filled, job.kind, job.problem, job.label, result, number, stated, file
        )
    except Busy:
        raise busy("parts") from None
    except Gone:
        raise Refusal(499, "gone", "Gone", "The client has gone away.") from None
    except GivenUp:
        raise _refused(
            f"The parts were given up: they took more than {MAX_PARTS_S:g} seconds, or more memory than a job may."
        ) from None
    if isinstance(made, Refused):
        raise invalid_request([(made.path, made.detail)]) if made.path else _refused(made.detail)
    assert isinstance(made, bytes)
    return made


def _checked(result: str, number: str) -> int:
    """The index of a design of a stored result that parts are made of."""
    designs = from_json(result)["designs"]
    n = design_index(number, len(designs))
    if not has_parts(designs[n]["mechanism"]):
        raise not_found("There are no parts of this type of mechanism.")
    return n


def _refused(detail: str) -> Refusal:
    return Refusal(409, "no-parts", "No parts", detail)
