"""``/v1/jobs/{id}/designs/{n}/parts``, ``/assembly``, ``.step``, ``.glb``: a design as parts that can be made."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, get_args

from fastapi import APIRouter, Query, Request, Response
from pydantic_core import from_json
from starlette.concurrency import run_in_threadpool

from service.answers.job_result import SolvedJob, design_index
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.dependencies import Bench, Desk
from service.api.http.problem_details import Refusal, busy, gone, invalid_request, not_found
from service.api.routes.designs import HEADERS, solved_job
from service.api.routes.jobs import TAG
from service.jobs.processes.request_pool import Busy, GivenUp, Gone
from service.observability.telemetry import span
from service.parts.assembly.sizes import (
    CAD_PROCESSES,
    SOLID_FORMATS,
    AssemblyQuery,
    File,
    FileRefusal,
    PartFile,
    PartsQuery,
    ViewQuery,
)
from service.parts.export.cad_available import is_installed
from service.parts.export.viewer_schema import AssemblyView
from service.parts.export.worker import MAX_PARTS_S, Workshop, make_file, make_item_file

router = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)

_BINARY = {"type": "string", "format": "binary"}
_TEXT = {"type": "string"}
_MEDIA: dict[File | PartFile, str] = {
    "zip": "application/zip",
    "step": "model/step",
    "glb": "model/gltf-binary",
    "json": "application/json",
    "svg": "image/svg+xml",
    "dxf": "image/vnd.dxf",
    "stl": "model/stl",
    "3mf": "model/3mf",
}
_TEXTS = ("svg", "dxf")


def _responses(file: File | PartFile) -> dict[int | str, dict[str, Any]]:
    schema = _TEXT if file in _TEXTS else _BINARY
    given: dict[str, Any] = {"content": {_MEDIA[file]: {"schema": schema}}}
    if file == "json":
        given = {"model": AssemblyView}
    solid = file == "zip" or file in SOLID_FORMATS
    cad = {"e501": "The service runs without its extra `cad`, which this file needs."} if solid else {}
    return {
        200: {"description": "The assembly." if file == "json" else "The file.", **given},
        **problem_details.responses(
            e404="There is no such job or design, or no parts of its type of mechanism.",
            e409="The job has no result (yet), or the design cannot be built of parts; `detail` says why.",
            e422="A parameter is not valid, or leaves no room for the parts; `errors` says which, and what would.",
            **cad,
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


@router.get(
    "/{job_id}/designs/{number}/assembly",
    operation_id="view_assembly",
    summary="Show a design's assembly in three dimensions",
    response_class=Response,
    responses=_responses("json"),
)
async def view_assembly(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str,
    query: Annotated[ViewQuery, Query()],
) -> Response:  # fmt: skip
    """The parts of design ``number`` as stacks of prisms in millimetres, and where they are at inputs of the motion.

    What each part moves with is told once, as a turn about a pivot and the place of that. `lift` says how far a part
    goes up where the planes are drawn apart. It needs no CAD, and is refused for the same reasons as `parts`.
    """
    return await _answered(request, desk, bench, tenant, job_id, number, query, "json")


@router.get(
    "/{job_id}/designs/{number}/assembly.svg",
    operation_id="draw_assembly",
    summary="Draw a design's assembly",
    response_class=Response,
    responses=_responses("svg"),
)
async def draw_assembly(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str,
    query: Annotated[AssemblyQuery, Query()],
) -> Response:  # fmt: skip
    """A picture of the parts of design ``number``, isometric, as they are built and with their planes drawn apart."""
    return await _answered(request, desk, bench, tenant, job_id, number, query, "svg")


_FORMS: dict[PartFile, str] = {
    "dxf": "The outline of one plate or block with its holes, as it is cut.",
    "stl": "One part as a mesh, lying as it is printed.",
    "step": "One part as a solid (AP242), lying as it is printed.",
    "3mf": "One part as a mesh with its unit, lying as it is printed.",
}


def _offer(form: PartFile) -> None:
    """Add the operation that gives the files of one form of single parts."""

    async def part(
        request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str, name: str,
        query: Annotated[PartsQuery, Query()],
    ) -> Response:  # fmt: skip
        return await _answered(request, desk, bench, tenant, job_id, number, query, form, name)

    router.add_api_route(
        f"/{{job_id}}/designs/{{number}}/parts/{{name}}.{form}",
        part,
        operation_id=f"export_part_{form}",
        summary=f"Export a part of a design as {form.upper()}",
        description=f"{_FORMS[form]} ``name`` is its name in the bill, or the `item` of a part of the assembly.",
        response_class=Response,
        responses=_responses(form),
    )


for _form in get_args(PartFile):
    _offer(_form)


async def assemblies_of(request: Request, bench: Workshop, tenant: str, job: SolvedJob, most: int) -> dict[int, str]:
    """Pictures of the first designs that parts are made of, as SVG; or a sentence that says why there is none.

    Raises
    ------
    Refusal
        503 or 499, where that is no fault of the parts.
    """
    designs = from_json(job.result)["designs"][:most]
    found = {}
    for n in range(len(designs)):
        try:
            found[n] = (await _made(request, bench, tenant, make_file, _order(job, n, {}), "svg")).decode()
        except Refusal as refusal:
            if refusal.status not in (409, 422):
                raise
            found[n] = " ".join(detail for _, detail in refusal.errors) or refusal.detail
    return found


def _order(job: SolvedJob, number: int, query: dict[str, Any]) -> dict[str, Any]:
    """What the process is asked for."""
    stored = {"kind": job.kind, "problem": job.problem, "label": job.label, "result": job.result}
    return stored | {"number": number, "query": query}


async def _answered(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str, query: PartsQuery,
    file: File | PartFile, part: str | None = None,
) -> Response:  # fmt: skip
    job = await solved_job(desk, tenant, job_id)
    n = await run_in_threadpool(_checked, job.result, number)
    if (file in SOLID_FORMATS or (file == "zip" and query.process in CAD_PROCESSES)) and not is_installed():
        raise Refusal(
            501, "no-cad", "No CAD",
            "The service runs without its extra `cad`, which makes solids; `process=laser` has outlines without it.",
        )  # fmt: skip
    order = _order(job, n, query.model_dump(exclude_unset=True))
    with span("parts"):
        if part is None:
            content = await _made(request, bench, tenant, make_file, order, file)
        else:
            content = await _made(request, bench, tenant, make_item_file, order, part, file)
    names = {"zip": f"{job.kind}-{n + 1}-parts.zip", "svg": f"{job.kind}-{n + 1}-assembly.svg"}
    name = names.get(file, f"{job.kind}-{n + 1}.{file}") if part is None else f"{part}.{file}"
    headers = {"X-Content-Type-Options": "nosniff"}
    if file == "svg":
        headers |= HEADERS["svg"]
    elif file != "json":
        headers["Content-Disposition"] = f'attachment; filename="{name}"'
    return Response(content, media_type=_MEDIA[file], headers=headers)


async def _made(request: Request, bench: Workshop, tenant: str, work: Callable[..., Any], *args: Any) -> bytes:
    """What the process makes, or has made of the same."""
    try:
        made = await bench.run_cached(request.is_disconnected, tenant, work, *args)
    except Busy:
        raise busy("parts") from None
    except Gone:
        raise gone() from None
    except GivenUp:
        raise _refused(
            f"The parts were given up: they took more than {MAX_PARTS_S:g} seconds, or more memory than a job may."
        ) from None
    if isinstance(made, FileRefusal):
        if not made.known:
            raise not_found(made.detail)
        raise invalid_request([(made.path, made.detail)]) if made.path else _refused(made.detail)
    assert isinstance(made, bytes)
    return made


def _checked(result: str, number: str) -> int:
    """The index of a design of a stored result that parts are made of."""
    designs = from_json(result)["designs"]
    return design_index(number, len(designs))


def _refused(detail: str) -> Refusal:
    return Refusal(409, "no-parts", "No parts", detail)
