"""What was found in a file, as the API says it."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from service.outlines.answer import DrawingElement, DrawingUnit, LeftOut
from service.outlines.limits import MAX_LISTED

Format = Literal["svg", "dxf", "csv", "png"]


class ImportedPoint(BaseModel):
    """A point of a curve."""

    model_config = ConfigDict(title="Imported point")

    x: float
    y: float


class ImportedCurve(DrawingElement):
    """A curve as points: as `points` of a path, corners of an outline or an obstacle, or a table of y over x."""

    model_config = ConfigDict(title="Imported curve")

    points: list[ImportedPoint] = Field(
        description="In the order in which the curve runs; of a closed curve the first is not repeated."
    )
    closed: bool = Field(description="Whether it goes on from the last point to the first.")
    length: float = Field(description="Length of the curve as it is drawn, not of its chords.")
    tolerance: float = Field(
        description="Greatest distance of the drawn curve from the chords between the points; 0 where the points are "
        "those of the file. Above the one that was asked for where `max_points` takes more."
    )
    joined: int = Field(description="How many open elements were joined to it at their ends; 1 where there was one.")


class Imports(BaseModel):
    """The curves of a file, with y upwards."""

    format: Format
    millimetres_per_unit: float | None = Field(
        description="Millimetres in a unit of the file (of a picture: in a pixel); null where it states none."
    )
    length_unit: DrawingUnit | None = Field(
        description="The unit of all numbers here; null: the file's own, because it states none."
    )
    scale: float = Field(description="Units of the numbers here in a unit of the file.")
    curves: list[ImportedCurve] = Field(description="In the order of the file; of a picture the longest first.")
    left_out: list[LeftOut] = Field(description=f"What gives no curve, {MAX_LISTED} elements at most.")
    left_out_count: int = Field(description="How many elements give no curve.")
