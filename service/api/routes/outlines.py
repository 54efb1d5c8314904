"""``/v1/outlines``: the closed outlines in a drawing made by another program."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.dependencies import Readers
from service.api.routes.imports import DXF_TYPES, OF_ANY_FORMAT, SVG_TYPES, answered, file_of, taken
from service.outlines import DrawingUnit, Outlines
from service.outlines.limits import DEFAULT_TOLERANCE, MAX_COORDINATE

TAG = {"name": "outlines", "description": "Read a drawing."}

TYPES = (*SVG_TYPES, *DXF_TYPES, *OF_ANY_FORMAT)

router = APIRouter(prefix="/v1/outlines", tags=["outlines"], route_class=GuardedRoute)


@router.post(
    "",
    operation_id="read_outlines",
    summary="Read the outlines in a drawing",
    response_model=Outlines,
    responses=problem_details.responses(
        e400="The body cannot be read in the format that its first bytes announce.",
        e413="The body is too large.",
        e415="The body is neither SVG nor the text form of DXF, or is announced as another type.",
        e422="The drawing has no closed outline, or exceeds the size limits; `errors` names its elements.",
        e503="The service is busy with other files.",
    ),
    openapi_extra=file_of(TYPES, "The unchanged drawing file. Its first bytes determine the format."),
)
async def read_outlines(
    request: Request,
    desk: Readers,
    tenant: Tenant,
    length_unit: Annotated[
        DrawingUnit | None,
        Query(description="Unit of the answer if the drawing has a unit; otherwise the numbers stay as in the drawing."),
    ] = None,
    tolerance: Annotated[
        float | None,
        Query(
            gt=0.0,
            le=MAX_COORDINATE,
            description="Maximum distance of a curve from its polygon, in the unit of the answer; "
            f"by default {DEFAULT_TOLERANCE:g} of the longer side of the drawing's bounding box.",
        ),
    ] = None,
) -> Response:
    """Return the closed outlines of an SVG or DXF drawing as polygons and circles, with y upwards.

    Reads paths, polygons, polylines with bulges, circles, ellipses and splines; joins lines and arcs at their ends, and
    inserts blocks and `use` elements in their places. Elements without an outline are listed with the reason.
    """
    content, _ = await taken(request, TYPES)
    return await answered(
        request, desk, tenant, "outlines", TYPES, content, tolerance=tolerance, length_unit=length_unit
    )
