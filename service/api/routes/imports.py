"""``/v1/imports``: the curves in a drawing, table or picture made by another program, as points."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response

from kinematics.message import compose
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.body import BoundedRequest, refuse_media_type
from service.api.http.dependencies import Readers
from service.api.http.problem_details import (
    refuse_busy,
    refuse_gone,
    refuse_invalid_drawing,
    refuse_invalid_request,
    refuse_malformed_drawing,
)
from service.api.http.replies import as_json
from service.error_messages import format_pointer
from service.imports import Imports
from service.imports.desk import ImportDesk
from service.imports.limits import DEFAULT_POINTS, MAX_REQUESTED_POINTS, MIN_POINTS, PNG_SIGNATURE
from service.imports.reader import Door
from service.jobs.processes.request_pool import Busy, ClientGone
from service.observability.telemetry import measure_span
from service.outlines import DrawingUnit, ForeignFormat, MalformedDrawing, NoOutline, UnsuitableDrawing
from service.outlines.limits import DEFAULT_TOLERANCE, MAX_COORDINATE

TAG = {"name": "imports", "description": "Read a drawing, a table or a picture."}

SVG_TYPES = ("image/svg+xml",)
DXF_TYPES = ("image/vnd.dxf", "application/dxf", "application/x-dxf", "image/x-dxf")
TABLE_TYPES = ("text/csv",)
PICTURE_TYPES = ("image/png",)
ANY_FORMAT_TYPES = ("application/octet-stream",)
ACCEPTED_TYPES = (*SVG_TYPES, *DXF_TYPES, *TABLE_TYPES, *PICTURE_TYPES, *ANY_FORMAT_TYPES)

router = APIRouter(prefix="/v1/imports", tags=["imports"], route_class=GuardedRoute)


def describe_file_body(types: tuple[str, ...], description: str) -> dict[str, Any]:
    """Return the OpenAPI description of a request body that is a file."""
    content = {type_: {"schema": {"type": "string", "format": "binary"}} for type_ in types}
    return {"requestBody": {"required": True, "description": description, "content": content}}


async def read_file(request: Request, types: tuple[str, ...]) -> tuple[bytes, str]:
    """Read the file in a request; return it with its announced media type.

    Raises
    ------
    Refusal
        413, 415 or 400.
    """
    bounded = BoundedRequest(request.scope, request.receive)
    if bounded.media_type and bounded.media_type not in types:
        raise refuse_media_type(compose("service-file-type-foreign", types=", ".join(types)), *types)
    return await bounded.read_limited(request.app.state.settings.max_body_bytes), bounded.media_type


async def respond_with_reading(
    request: Request, desk: ImportDesk, tenant: str, door: Door, types: tuple[str, ...], content: bytes, **asked: Any
) -> Response:
    """Respond with the content read from a file.

    Raises
    ------
    Refusal
        400, 415 or 422 for a fault of the file, 503 if the service is busy, 499 if the client has disconnected.
    """
    try:
        with measure_span("drawing"):
            return as_json(await desk.read(request.is_disconnected, tenant, door, content, **asked))
    except Busy:
        raise refuse_busy("service-busy-with-files") from None
    except ClientGone:
        raise refuse_gone() from None
    except ForeignFormat as error:
        raise refuse_media_type(str(error), *types) from None
    except MalformedDrawing as error:
        raise refuse_malformed_drawing(str(error)) from None
    except NoOutline as error:
        raise refuse_invalid_drawing(
            str(error), [(format_pointer((id_,)), reason) for id_, reason in error.reasons]
        ) from None
    except UnsuitableDrawing as error:
        raise refuse_invalid_drawing(str(error)) from None


@router.post(
    "",
    operation_id="import_curves",
    summary="Read the curves in a file",
    response_model=Imports,
    responses=problem_details.describe_responses(
        e400="The body cannot be read in the format that its first bytes announce.",
        e413="The body is too large.",
        e415="The body has another type, or is announced as one.",
        e422="The file has no curve, or exceeds the size limits; `errors` names its elements.",
        e503="The service is busy with other files.",
    ),
    openapi_extra=describe_file_body(
        ACCEPTED_TYPES, "The unchanged file. Its first bytes determine the format; any other beginning means a table."
    ),
)
async def import_curves(
    request: Request,
    desk: Readers,
    tenant: Tenant,
    length_unit: Annotated[
        DrawingUnit,
        Query(description="Unit of the answer if the file has a unit; otherwise the numbers stay as in the file."),
    ] = "mm",
    tolerance: Annotated[
        float | None,
        Query(
            gt=0.0,
            le=MAX_COORDINATE,
            description="Maximum distance of a drawn curve from the chords between its points, in the unit of the "
            f"answer. By default {DEFAULT_TOLERANCE:g} of the longer side of each curve's bounding box, with corners "
            "and points of the file kept; for a picture a tenth of a pixel, or half a pixel for stepped edges.",
        ),
    ] = None,
    max_points: Annotated[
        int,
        Query(
            ge=MIN_POINTS,
            le=MAX_REQUESTED_POINTS,
            description="Maximum number of points of a curve; if the tolerance needs more, it is increased.",
        ),
    ] = DEFAULT_POINTS,
    pixel_size: Annotated[
        float | None,
        Query(
            gt=0.0,
            le=MAX_COORDINATE,
            description="Side of a pixel of a picture in `length_unit`, instead of the value in the picture.",
        ),
    ] = None,
) -> Response:
    """Return the curves of an SVG or DXF drawing, a table of points or a PNG picture as points, with y upwards.

    Loose pieces are joined at their ends, duplicate points are merged, and curved pieces get the number of points that
    the tolerance requires. Elements without a curve are listed with the reason.
    """
    content, media_type = await read_file(request, ACCEPTED_TYPES)
    # An option without effect is refused, so that no mistake passes unnoticed.
    if pixel_size is not None and not content.startswith(PNG_SIGNATURE):
        raise refuse_invalid_request([("/query/pixel_size", compose("service-pixels-without-picture"))])
    return await respond_with_reading(
        request,
        desk,
        tenant,
        "imports",
        ACCEPTED_TYPES,
        content,
        length_unit=length_unit,
        tolerance=tolerance,
        max_points=max_points,
        pixel_size=pixel_size,
        # Nearly any text is a table, so only bodies announced as one, or as nothing in particular, are read as tables.
        tables=media_type in ("", *TABLE_TYPES, *ANY_FORMAT_TYPES),
    )
