"""``/v1/outlines``: the closed outlines in a drawing that another program made."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from service.api import errors
from service.api.body import BoundedRequest, foreign
from service.api.errors import busy, invalid_drawing, malformed_drawing
from service.api.guard import GuardedRoute
from service.api.state import Board
from service.drawings import Busy
from service.explained import pointer
from service.loading import IMPORTS
from service.outlines import DrawingUnit, ForeignFormat, Malformed, NoOutline, Outlines, Unsuitable
from service.outlines.limits import DEFAULT_TOLERANCE, FARTHEST
from service.telemetry import span

TAG = {"name": "outlines", "description": "Read a drawing."}

SVG_TYPES = ("image/svg+xml",)
DXF_TYPES = ("image/vnd.dxf", "application/dxf", "application/x-dxf", "image/x-dxf")
OF_ANY_FORMAT = ("application/octet-stream",)
TYPES = (*SVG_TYPES, *DXF_TYPES, *OF_ANY_FORMAT)

router = APIRouter(prefix="/v1/outlines", tags=["outlines"], route_class=GuardedRoute)


@router.post(
    "",
    operation_id="read_outlines",
    summary="Read the outlines in a drawing",
    response_model=Outlines,
    responses=errors.responses(
        e400="The body cannot be read as the drawing that it begins as.",
        e413="The body is too large.",
        e415="The body is neither SVG nor the text form of DXF, or is announced as another type.",
        e422="The drawing has no closed outline, or is larger than is read; `errors` names its elements.",
        e503="Drawings, animations and reports have kept this one from being begun.",
    ),
    openapi_extra={
        "requestBody": {
            "required": True,
            "description": "The drawing as it is in its file. What it is is seen by its beginning.",
            "content": {type_: {"schema": {"type": "string", "format": "binary"}} for type_ in TYPES},
        }
    },
)
async def read_outlines(
    request: Request,
    board: Board,
    length_unit: Annotated[
        DrawingUnit | None,
        Query(description="Unit of the answer, where the drawing states its own; else it is the drawing's."),
    ] = None,
    tolerance: Annotated[
        float | None,
        Query(
            gt=0.0,
            le=FARTHEST,
            description="Greatest distance of a curve from its polygon, in the unit of the answer; "
            f"by default {DEFAULT_TOLERANCE:g} of the greater side of the box around the drawing.",
        ),
    ] = None,
) -> Response:
    """The closed outlines of an SVG or DXF drawing as polygons and circles, with y upwards.

    Paths, polygons, polylines with bulges, circles, ellipses and splines; lines and arcs are joined at their ends, and
    blocks and uses are read where they stand. What gives no outline is told with the reason.
    """
    bounded = BoundedRequest(request.scope, request.receive)
    if bounded.media_type and bounded.media_type not in TYPES:
        raise foreign("The body must be a drawing, SVG or DXF.", *TYPES)
    content = await bounded.limited(request.app.state.settings.max_body_bytes)
    try:
        with span("drawing"):
            answer = await board.call(_read, content, tolerance, length_unit)
    except Busy:
        raise busy("drawings") from None
    except ForeignFormat as error:
        raise foreign(str(error), *TYPES) from None
    except Malformed as error:
        raise malformed_drawing(str(error)) from None
    except NoOutline as error:
        raise invalid_drawing(str(error), [(pointer((id_,)), reason) for id_, reason in error.reasons]) from None
    except Unsuitable as error:
        raise invalid_drawing(str(error)) from None
    return Response(answer, media_type="application/json")


def _read(content: bytes, tolerance: float | None, length_unit: DrawingUnit | None) -> bytes:
    with IMPORTS:
        from service.outlines.reading import outlines_of
    return outlines_of(content, tolerance=tolerance, length_unit=length_unit).model_dump_json().encode()
