"""Schemas of the curves read from a file."""

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
    """A curve as points, usable as `points` of a path, corners of an outline or obstacle, or a table of y over x."""

    model_config = ConfigDict(title="Imported curve")

    points: list[ImportedPoint] = Field(
        description="Points in order along the curve; a closed curve does not repeat the first point."
    )
    closed: bool = Field(description="Whether the curve continues from the last point to the first.")
    length: float = Field(description="Length of the drawn curve, not of its chords.")
    tolerance: float = Field(
        description="Maximum distance of the drawn curve from the chords between the points; 0 if the points are those "
        "of the file. It exceeds the requested tolerance if `max_points` requires it."
    )
    joined: int = Field(description="Number of open elements joined at their ends to form the curve.")


class Imports(BaseModel):
    """The curves of a file, with y upwards."""

    format: Format
    millimetres_per_unit: float | None = Field(
        description="Millimetres in a unit of the file (for a picture: in a pixel); null if the file has no unit."
    )
    length_unit: DrawingUnit | None = Field(
        description="Unit of all numbers here; null means the units of a file without a known unit."
    )
    scale: float = Field(description="Units of the numbers here per unit of the file.")
    curves: list[ImportedCurve] = Field(description="Curves in the order of the file; for a picture, longest first.")
    left_out: list[LeftOut] = Field(description=f"Elements without a curve, at most {MAX_LISTED}.")
    left_out_count: int = Field(description="Number of all elements without a curve.")
