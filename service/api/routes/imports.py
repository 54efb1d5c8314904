"""``/v1/imports``: the curves in a drawing, a table or a picture that another program made, as points."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response

from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.body import BoundedRequest, foreign
from service.api.http.dependencies import Readers
from service.api.http.problem_details import busy, gone, invalid_drawing, invalid_request, malformed_drawing
from service.api.http.replies import as_json
from service.error_messages import pointer
from service.imports import Imports
from service.imports.desk import ImportDesk
from service.imports.limits import DEFAULT_POINTS, FEWEST, MOST_ASKED, PNG
from service.imports.reader import Door
from service.jobs.processes.request_pool import Busy, Gone
from service.observability.telemetry import span
from service.outlines import DrawingUnit, ForeignFormat, MalformedDrawing, NoOutline, UnsuitableDrawing
from service.outlines.limits import DEFAULT_TOLERANCE, MAX_COORDINATE

TAG = {"name": "imports", "description": "Read a drawing, a table or a picture."}

SVG_TYPES = ("image/svg+xml",)
DXF_TYPES = ("image/vnd.dxf", "application/dxf", "application/x-dxf", "image/x-dxf")
TABLE_TYPES = ("text/csv",)
PICTURE_TYPES = ("image/png",)
OF_ANY_FORMAT = ("application/octet-stream",)
TYPES = (*SVG_TYPES, *DXF_TYPES, *TABLE_TYPES, *PICTURE_TYPES, *OF_ANY_FORMAT)

router = APIRouter(prefix="/v1/imports", tags=["imports"], route_class=GuardedRoute)


def file_of(types: tuple[str, ...], description: str) -> dict[str, Any]:
    """The body of an operation that takes a file, for OpenAPI."""
    content = {type_: {"schema": {"type": "string", "format": "binary"}} for type_ in types}
    return {"requestBody": {"required": True, "description": description, "content": content}}


async def taken(request: Request, types: tuple[str, ...]) -> tuple[bytes, str]:
    """The file that a request brings, and the type that it is announced as.

    Raises
    ------
    Refusal
        413, 415 or 400.
    """
    bounded = BoundedRequest(request.scope, request.receive)
    if bounded.media_type and bounded.media_type not in types:
        raise foreign(f"The body must be of one of these types: {', '.join(types)}.", *types)
    return await bounded.limited(request.app.state.settings.max_body_bytes), bounded.media_type


async def answered(
    request: Request, desk: ImportDesk, tenant: str, door: Door, types: tuple[str, ...], content: bytes, **asked: Any
) -> Response:
    """What a file gives, as the answer to a request.

    Raises
    ------
    Refusal
        400, 415, 422 or 503: what is wrong with the file, or that its turn has not come; 499 where nobody waits.
    """
    try:
        with span("drawing"):
            return as_json(await desk.read(request.is_disconnected, tenant, door, content, **asked))
    except Busy:
        raise busy("files") from None
    except Gone:
        raise gone() from None
    except ForeignFormat as error:
        raise foreign(str(error), *types) from None
    except MalformedDrawing as error:
        raise malformed_drawing(str(error)) from None
    except NoOutline as error:
        raise invalid_drawing(str(error), [(pointer((id_,)), reason) for id_, reason in error.reasons]) from None
    except UnsuitableDrawing as error:
        raise invalid_drawing(str(error)) from None


@router.post(
    "",
    operation_id="import_curves",
    summary="Read the curves in a file",
    response_model=Imports,
    responses=problem_details.responses(
        e400="The body cannot be read as what it begins as.",
        e413="The body is too large.",
        e415="The body is of another type, or is announced as one.",
        e422="The file has no curve, or is larger than is read; `errors` names its elements.",
        e503="Other files have kept this one from being begun.",
    ),
    openapi_extra=file_of(
        TYPES, "The file as it is. What it is is seen by its beginning; what begins as nothing else is a table."
    ),
)
async def import_curves(
    request: Request,
    desk: Readers,
    tenant: Tenant,
    length_unit: Annotated[
        DrawingUnit, Query(description="Unit of the answer, where the file states its own; else it is the file's.")
    ] = "mm",
    tolerance: Annotated[
        float | None,
        Query(
            gt=0.0,
            le=MAX_COORDINATE,
            description="Greatest distance of a drawn curve from the chords between its points, in the unit of the "
            f"answer. By default {DEFAULT_TOLERANCE:g} of the greater side of the box around each curve, while corners "
            "and points that the file states stay; of a picture a tenth of a pixel, or half of one where it has steps.",
        ),
    ] = None,
    max_points: Annotated[
        int,
        Query(
            ge=FEWEST,
            le=MOST_ASKED,
            description="Points of a curve at most: where it takes more, the tolerance is greater than asked for.",
        ),
    ] = DEFAULT_POINTS,
    pixel_size: Annotated[
        float | None,
        Query(
            gt=0.0,
            le=MAX_COORDINATE,
            description="Side of a pixel of a picture in `length_unit`, instead of what the picture states.",
        ),
    ] = None,
) -> Response:
    """The curves of an SVG or DXF drawing, a table of points or a PNG picture as points, with y upwards.

    Loose pieces are joined at their ends, points that are there twice are one, and curved pieces have as many points as
    the tolerance takes. What gives no curve is told with the reason.
    """
    content, media_type = await taken(request, TYPES)
    if pixel_size is not None and not content.startswith(PNG):
        raise invalid_request([("/query/pixel_size", "Only a PNG picture has pixels.")])
    return await answered(
        request,
        desk,
        tenant,
        "imports",
        TYPES,
        content,
        length_unit=length_unit,
        tolerance=tolerance,
        max_points=max_points,
        pixel_size=pixel_size,
        tables=media_type in ("", *TABLE_TYPES, *OF_ANY_FORMAT),
    )
