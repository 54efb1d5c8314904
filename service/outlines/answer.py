"""What was found in a drawing, as the API says it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from service.outlines.curves import Source
from service.outlines.limits import LONGEST_NAME, MOST_TOLD

DrawingUnit = Literal["mm", "cm", "m", "in"]


class Drawn(BaseModel):
    """An element of the drawing."""

    element: str = Field(description="The element or entity, as the format calls it.", examples=["path", "LWPOLYLINE"])
    id: str | None = Field(description="The id of an SVG element, or the handle of a DXF entity; null without one.")
    name: str | None = Field(description="The label or title of an SVG element, or the block of a DXF entity.")
    layer: str | None = Field(description="The layer that it lies on.")


class DrawnCircle(BaseModel):
    """A circle with what it encloses."""

    model_config = ConfigDict(title="Drawn circle")

    center: tuple[float, float]
    radius: float


class Outline(Drawn):
    """A closed outline: a polygon, or a circle."""

    polygon: list[tuple[float, float]] | None = Field(
        default=None,
        description="Corners of a simple polygon, counter-clockwise; the first is not repeated. Null of a circle.",
    )
    circle: DrawnCircle | None = None
    area: float = Field(description="Enclosed area, in squares of the unit.")
    joined: int = Field(
        description="How many open elements were joined to it at their ends; 1 where it is closed by itself."
    )


class LeftOut(Drawn):
    """An element that gives no outline."""

    model_config = ConfigDict(title="Element left out")

    reason: str = Field(description="Why, in a sentence.")


class Outlines(BaseModel):
    """The closed outlines of a drawing, with y upwards."""

    format: Literal["svg", "dxf"]
    millimetres_per_unit: float | None = Field(
        description="Millimetres in a unit of the drawing; null where the file does not state it."
    )
    length_unit: DrawingUnit | None = Field(
        description="The unit of all numbers here; null: the drawing's own, "
        "because no other was asked for or because the file states none."
    )
    scale: float = Field(description="Units of the numbers here in a unit of the drawing.")
    tolerance: float = Field(description="Greatest distance of a curve from the polygon that stands for it.")
    outlines: list[Outline]
    left_out: list[LeftOut] = Field(description=f"What gives no outline, {MOST_TOLD} elements at most.")
    left_out_count: int = Field(description="How many elements give no outline.")


def told(source: Source) -> dict[str, str | None]:
    """What an answer says of where a curve comes from."""
    return {name: short(getattr(source, name)) for name in ("element", "id", "name", "layer")}


def told_left_out(left_out: Sequence[tuple[Source, str]]) -> list[LeftOut]:
    """The first of the elements that were left out, with their reasons."""
    return [LeftOut(**told(source), reason=sentence(reason)) for source, reason in left_out[:MOST_TOLD]]


def short(text: str | None) -> str | None:
    """A text of the drawing, which may have anything in it, as one that can be told."""
    if text is None:
        return None
    spelt = text.encode("utf-8", "replace").decode()
    return spelt if len(spelt) <= LONGEST_NAME else f"{spelt[: LONGEST_NAME - 1]}…"


def sentence(reason: str) -> str:
    """A reason as a sentence of its own."""
    return f"{reason[:1].upper()}{reason[1:]}."
