"""``/v1/outlines``: the closed outlines in a drawing that another program made."""

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
        e400="The body cannot be read as the drawing that it begins as.",
        e413="The body is too large.",
        e415="The body is neither SVG nor the text form of DXF, or is announced as another type.",
        e422="The drawing has no closed outline, or is larger than is read; `errors` names its elements.",
        e503="Other files have kept this one from being begun.",
    ),
    openapi_extra=file_of(TYPES, "The drawing as it is in its file. What it is is seen by its beginning."),
)
async def read_outlines(
    request: Request,
    desk: Readers,
    tenant: Tenant,
    length_unit: Annotated[
        DrawingUnit | None,
        Query(description="Unit of the answer, where the drawing states its own; else it is the drawing's."),
    ] = None,
    tolerance: Annotated[
        float | None,
        Query(
            gt=0.0,
            le=MAX_COORDINATE,
            description="Greatest distance of a curve from its polygon, in the unit of the answer; "
            f"by default {DEFAULT_TOLERANCE:g} of the greater side of the box around the drawing.",
        ),
    ] = None,
) -> Response:
    """The closed outlines of an SVG or DXF drawing as polygons and circles, with y upwards.

    Paths, polygons, polylines with bulges, circles, ellipses and splines; lines and arcs are joined at their ends, and
    blocks and uses are read where they stand. What gives no outline is told with the reason.
    """
    content, _ = await taken(request, TYPES)
    return await answered(
        request, desk, tenant, "outlines", TYPES, content, tolerance=tolerance, length_unit=length_unit
    )
