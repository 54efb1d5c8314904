"""The outlines of a drawing as the API returns them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from kinematics.message import Message
from service.outlines.curves import Source
from service.outlines.faults import describe_reason
from service.outlines.limits import MAX_LISTED, MAX_NAME_LENGTH

DrawingUnit = Literal["mm", "cm", "m", "in"]


class DrawingElement(BaseModel):
    """An element of the drawing."""

    element: str = Field(description="The element or entity, as the format calls it.", examples=["path", "LWPOLYLINE"])
    id: str | None = Field(description="The id of an SVG element, or the handle of a DXF entity; null without one.")
    name: str | None = Field(description="The label or title of an SVG element, or the block of a DXF entity.")
    layer: str | None = Field(description="The layer that it lies on.")


class DrawnCircle(BaseModel):
    """A circle, filled."""

    model_config = ConfigDict(title="Drawn circle")

    center: tuple[float, float]
    radius: float


class Outline(DrawingElement):
    """A closed outline: a polygon, or a circle."""

    polygon: list[tuple[float, float]] | None = Field(
        default=None,
        description="Corners of a simple polygon, counter-clockwise; the first is not repeated. Null for a circle.",
    )
    circle: DrawnCircle | None = None
    area: float = Field(description="Enclosed area, in squares of the unit.")
    joined: int = Field(
        description="Number of open elements joined at their ends; 1 if the element is closed by itself."
    )


class LeftOut(DrawingElement):
    """An element without an outline."""

    model_config = ConfigDict(title="Element left out")

    reason: str = Field(description="Reason, as a sentence.")


class Outlines(BaseModel):
    """The closed outlines of a drawing, with y upwards."""

    format: Literal["svg", "dxf"]
    millimetres_per_unit: float | None = Field(
        description="Millimetres in a unit of the drawing; null if the file does not give it."
    )
    length_unit: DrawingUnit | None = Field(
        description="Unit of all numbers here; null for the drawing's own, "
        "because no other was requested or the file gives none."
    )
    scale: float = Field(description="Units of the numbers here in a unit of the drawing.")
    tolerance: float = Field(description="Maximum distance of a curve from its polygon.")
    outlines: list[Outline]
    left_out: list[LeftOut] = Field(description=f"Elements without an outline, at most {MAX_LISTED}.")
    left_out_count: int = Field(description="Number of elements without an outline.")


def describe_source(source: Source) -> dict[str, str | None]:
    """Return the fields of an element that the API reports."""
    return {name: truncate_text(getattr(source, name)) for name in ("element", "id", "name", "layer")}


def list_left_out(left_out: Sequence[tuple[Source, Message]]) -> list[LeftOut]:
    """Return the first elements without an outline, at most ``MAX_LISTED``, with their reasons."""
    return [
        LeftOut(**describe_source(source), reason=describe_reason(reason)) for source, reason in left_out[:MAX_LISTED]
    ]


def truncate_text(text: str | None) -> str | None:
    """Return a text from the drawing as valid UTF-8, truncated to ``MAX_NAME_LENGTH`` characters."""
    if text is None:
        return None
    spelt = text.encode("utf-8", "replace").decode()
    return spelt if len(spelt) <= MAX_NAME_LENGTH else f"{spelt[: MAX_NAME_LENGTH - 1]}…"


def list_reasons(left_out: Sequence[tuple[Source, Message]]) -> list[tuple[str, str]]:
    """Return the ids of the first elements without an outline, at most ``MAX_LISTED``, with their reasons."""
    return [
        (truncate_text(source.id or source.element) or "", describe_reason(reason))
        for source, reason in left_out[:MAX_LISTED]
    ]
