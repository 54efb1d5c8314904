"""``/v1/outlines``: the closed outlines in a drawing made by another program."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.dependencies import Readers
from service.api.routes.imports import (
    ANY_FORMAT_TYPES,
    DXF_TYPES,
    SVG_TYPES,
    describe_file_body,
    read_file,
    respond_with_reading,
)
from service.outlines import DrawingUnit, Outlines
from service.outlines.limits import DEFAULT_TOLERANCE, MAX_COORDINATE

TAG = {"name": "outlines", "description": "Read a drawing."}

ACCEPTED_TYPES = (*SVG_TYPES, *DXF_TYPES, *ANY_FORMAT_TYPES)

router = APIRouter(prefix="/v1/outlines", tags=["outlines"], route_class=GuardedRoute)


@router.post(
    "",
    operation_id="read_outlines",
    summary="Read the outlines in a drawing",
    response_model=Outlines,
    responses=problem_details.describe_responses(
        e400="The body cannot be read in the format that its first bytes announce.",
        e413="The body is too large.",
        e415="The body is neither SVG nor the text form of DXF, or is announced as another type.",
        e422="The drawing has no closed outline, or exceeds the size limits; `errors` names its elements.",
        e503="The service is busy with other files.",
    ),
    openapi_extra=describe_file_body(
        ACCEPTED_TYPES, "The unchanged drawing file. Its first bytes determine the format."
    ),
)
async def read_outlines(
    request: Request,
    desk: Readers,
    tenant: Tenant,
    length_unit: Annotated[
        DrawingUnit | None,
        Query(description="Unit of the answer if the drawing has a unit; otherwise its numbers are unchanged."),
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
    content, _ = await read_file(request, ACCEPTED_TYPES)
    return await respond_with_reading(
        request, desk, tenant, "outlines", ACCEPTED_TYPES, content, tolerance=tolerance, length_unit=length_unit
    )
