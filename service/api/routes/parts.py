"""``/v1/jobs/{id}/designs/{n}/parts``, ``/assembly``, ``.step``, ``.glb``: a design as parts for manufacture."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, NamedTuple, get_args

from fastapi import APIRouter, Query, Request, Response
from pydantic_core import from_json
from starlette.concurrency import run_in_threadpool

from kinematics.message import compose, join_messages
from service.answers.job_result import SolvedJob, parse_design_index
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.dependencies import Bench, Desk
from service.api.http.problem_details import Refusal, refuse_busy, refuse_gone, refuse_invalid_request, refuse_not_found
from service.api.routes.designs import HEADERS, get_solved_job
from service.api.routes.jobs import TAG
from service.jobs.processes.request_pool import Busy, ClientGone, GivenUp
from service.observability.telemetry import measure_span
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
from synthesis.model.json_object import JsonObject

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


def _describe_responses(file: File | PartFile) -> dict[int | str, JsonObject]:
    schema = _TEXT if file in _TEXTS else _BINARY
    given: JsonObject = {"content": {_MEDIA[file]: {"schema": schema}}}
    if file == "json":
        given = {"model": AssemblyView}
    solid = file == "zip" or file in SOLID_FORMATS
    cad = {"e501": "This file needs the extra `cad`, which the service does not have."} if solid else {}
    return {
        200: {"description": "The assembly." if file == "json" else "The file.", **given},
        **problem_details.describe_responses(
            e404="No such job or design, or its type of mechanism has no parts.",
            e409="The job has no result (yet), or the design cannot be built of parts; `detail` has the reason.",
            e422="A parameter is not valid or makes parts collide; `errors` names it, with values that work.",
            **cad,
            e503="The service is busy with other parts.",
        ),
    }


@router.get(
    "/{job_id}/designs/{number}/parts",
    operation_id="make_parts",
    summary="Make the parts of a design",
    response_class=Response,
    responses=_describe_responses("zip"),
)
async def make_parts(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str,
    query: Annotated[PartsQuery, Query()],
) -> Response:  # fmt: skip
    """Return design ``number`` of the job's result as a zip of parts: plates, pins, washers, spacers and blocks.

    The zip has a DXF outline of each plate, an exploded side view, a bill of materials and the assembly as STEP;
    printed parts also have STL and 3MF files, milled ones STEP files. All files are in millimetres. The links are
    arranged in planes for these sizes, and a design whose parts would collide in the motion is refused. `print` and
    `mill` need the service's extra `cad`; without it `laser` has no STEP file.
    """
    return await _respond_with_file(request, desk, bench, tenant, job_id, _FileOrder(number, query, "zip"))


@router.get(
    "/{job_id}/designs/{number}.step",
    operation_id="export_assembly_step",
    summary="Export a design's assembly as STEP",
    response_class=Response,
    responses=_describe_responses("step"),
)
async def export_assembly_step(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str,
    query: Annotated[AssemblyQuery, Query()],
) -> Response:  # fmt: skip
    """Return the assembled parts of design ``number``, in millimetres, with names and colours (AP242)."""
    return await _respond_with_file(request, desk, bench, tenant, job_id, _FileOrder(number, query, "step"))


@router.get(
    "/{job_id}/designs/{number}.glb",
    operation_id="export_assembly_glb",
    summary="Export a design's assembly as glTF",
    response_class=Response,
    responses=_describe_responses("glb"),
)
async def export_assembly_glb(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str,
    query: Annotated[AssemblyQuery, Query()],
) -> Response:  # fmt: skip
    """Return the assembled parts of design ``number`` as binary glTF: in metres, with the shafts upwards along y."""
    return await _respond_with_file(request, desk, bench, tenant, job_id, _FileOrder(number, query, "glb"))


@router.get(
    "/{job_id}/designs/{number}/assembly",
    operation_id="view_assembly",
    summary="Show a design's assembly in three dimensions",
    response_class=Response,
    responses=_describe_responses("json"),
)
async def view_assembly(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str,
    query: Annotated[ViewQuery, Query()],
) -> Response:  # fmt: skip
    """Return the parts of design ``number`` as stacks of prisms in millimetres, and their positions over the motion.

    The motion of each moving body is given once, as a rotation about a pivot and the position of the pivot. `lift` is
    the displacement of a part in the exploded view. No CAD is needed; the refusals are those of `parts`.
    """
    return await _respond_with_file(request, desk, bench, tenant, job_id, _FileOrder(number, query, "json"))


@router.get(
    "/{job_id}/designs/{number}/assembly.svg",
    operation_id="draw_assembly",
    summary="Draw a design's assembly",
    response_class=Response,
    responses=_describe_responses("svg"),
)
async def draw_assembly(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str,
    query: Annotated[AssemblyQuery, Query()],
) -> Response:  # fmt: skip
    """Return an isometric picture of the parts of design ``number``, assembled and exploded."""
    return await _respond_with_file(request, desk, bench, tenant, job_id, _FileOrder(number, query, "svg"))


_FORMS: dict[PartFile, str] = {
    "dxf": "Return the outline of one plate or block with its holes, for cutting.",
    "stl": "Return one part as a mesh, in the position for printing.",
    "step": "Return one part as a solid (AP242), in the position for printing.",
    "3mf": "Return one part as a mesh with its unit, in the position for printing.",
}


def _add_part_route(form: PartFile) -> None:
    """Add the operation that returns files of single parts in one format."""

    async def send_part(
        request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, number: str, name: str,
        query: Annotated[PartsQuery, Query()],
    ) -> Response:  # fmt: skip
        return await _respond_with_file(request, desk, bench, tenant, job_id, _FileOrder(number, query, form, name))

    router.add_api_route(
        f"/{{job_id}}/designs/{{number}}/parts/{{name}}.{form}",
        send_part,
        operation_id=f"export_part_{form}",
        summary=f"Export a part of a design as {form.upper()}",
        description=f"{_FORMS[form]} ``name`` is the name in the bill of materials, or the `item` in the assembly.",
        response_class=Response,
        responses=_describe_responses(form),
    )


for _form in get_args(PartFile):
    _add_part_route(_form)


async def draw_assemblies(request: Request, bench: Workshop, tenant: str, job: SolvedJob, most: int) -> dict[int, str]:
    """Return pictures of the assemblies of the first ``most`` designs as SVG, or a sentence with the reason for none.

    Raises
    ------
    Refusal
        503 or 499, for reasons other than the design.
    """
    designs = from_json(job.result)["designs"][:most]
    found = {}
    for n in range(len(designs)):
        try:
            found[n] = (
                await _make_content(request, bench, tenant, make_file, _build_arguments(job, n, {}), "svg")
            ).decode()
        except Refusal as refusal:
            # A design without parts does not prevent a report.
            if refusal.status not in (409, 422):
                raise
            found[n] = join_messages(detail for _, detail in refusal.errors) or refusal.detail
    return found


def _build_arguments(job: SolvedJob, number: int, query: JsonObject) -> JsonObject:
    """Return the arguments for the process that makes the parts."""
    stored = {"kind": job.kind, "problem": job.problem, "label": job.label, "result": job.result}
    return stored | {"number": number, "query": query}


class _FileOrder(NamedTuple):
    """Order for a file: the design number in the path, the options, the format, and the part for a single-part file."""

    number: str
    query: PartsQuery
    file: File | PartFile
    part: str | None = None


async def _respond_with_file(
    request: Request, desk: Desk, bench: Bench, tenant: Tenant, job_id: str, order: _FileOrder
) -> Response:
    number, query, file, part = order
    job = await get_solved_job(desk, tenant, job_id)
    n = await run_in_threadpool(_check_design_number, job.result, number)
    if (file in SOLID_FORMATS or (file == "zip" and query.process in CAD_PROCESSES)) and not is_installed():
        # 501: another installation of the service can do it, and no change of this design helps.
        raise Refusal(
            501, "no-cad", "service-title-no-cad",
            compose("service-solids-unavailable"),
        )  # fmt: skip
    arguments = _build_arguments(job, n, query.model_dump(exclude_unset=True))
    with measure_span("parts"):
        if part is None:
            content = await _make_content(request, bench, tenant, make_file, arguments, file)
        else:
            content = await _make_content(request, bench, tenant, make_item_file, arguments, part, file)
    names = {"zip": f"{job.kind}-{n + 1}-parts.zip", "svg": f"{job.kind}-{n + 1}-assembly.svg"}
    name = names.get(file, f"{job.kind}-{n + 1}.{file}") if part is None else f"{part}.{file}"
    headers = {"X-Content-Type-Options": "nosniff"}
    if file == "svg":
        headers |= HEADERS["svg"]
    # Pictures and views are shown in a page, all other files are saved.
    elif file != "json":
        headers["Content-Disposition"] = f'attachment; filename="{name}"'
    return Response(content, media_type=_MEDIA[file], headers=headers)


async def _make_content(
    request: Request, bench: Workshop, tenant: str, work: Callable[..., bytes | FileRefusal], *args: object
) -> bytes:
    """Return the file that the process makes, from the cache if it has made the same before."""
    try:
        made = await bench.run_cached(request.is_disconnected, tenant, work, *args)
    except Busy:
        raise refuse_busy("service-busy-with-parts") from None
    except ClientGone:
        raise refuse_gone() from None
    except GivenUp:
        raise _refuse_parts(compose("service-parts-exceed-limits", seconds=f"{MAX_PARTS_S:g}")) from None
    if isinstance(made, FileRefusal):
        if not made.known:
            raise refuse_not_found(made.detail)
        raise refuse_invalid_request([(made.path, made.detail)]) if made.path else _refuse_parts(made.detail)
    assert isinstance(made, bytes)
    return made


def _check_design_number(result: str, number: str) -> int:
    """Return the index of a design in a stored result."""
    designs = from_json(result)["designs"]
    return parse_design_index(number, len(designs))


def _refuse_parts(detail: str) -> Refusal:
    return Refusal(409, "no-parts", "service-title-no-parts", detail)
