"""Where the body is to be carried: its positions, and how far each may be missed."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from synthesis.model.dimension import ANGLE
from synthesis.model.statement import Coordinate, Degrees, Flag, PositiveLength, Sizable, Statement

MOST_HELD = 5
"""Positions that a linkage of two dyads can take exactly, in general (Norton, Table 5-3)."""

MOST_OF_SIXBARS = 60
"""Positions of a sixbar at most. In general it can meet eight: its fourteen numbers, and the three of the body's place
on it, are what these state beyond the turns of the input."""


class Tolerance(Statement):
    """How far a position may be missed, coordinate by coordinate; what is left out is met exactly."""

    x: PositiveLength | None = Field(default=None, description="Length units, either way.")
    y: PositiveLength | None = Field(default=None, description="Length units, either way.")
    angle: Annotated[float, ANGLE, Field(strict=True, gt=0.0, le=180.0), Sizable] | None = Field(
        default=None, description="Degrees, either way."
    )

    @model_validator(mode="after")
    def _not_empty(self) -> Self:
        if self.x is None and self.y is None and self.angle is None:
            raise ValueError("give a tolerance of x, y or angle; a position without tolerance is met exactly")
        return self


class Position(Statement):
    """Where the body is: its reference point P and the angle of a line fixed in it."""

    x: Coordinate
    y: Coordinate
    angle: Degrees = Field(description="Angle of the body's line, degrees, counter-clockwise from +x.")
    tolerance: PositiveLength | Tolerance | None = Field(
        default=None,
        description="How far the position may be missed: by coordinate, or a length for x and y, the angle then being "
        "allowed to move a point one task size away by as much.",
    )
    exact: Flag = Field(default=False, description="Met exactly, although positions are fitted by least squares.")

    @property
    def point(self) -> complex:
        """The reference point as a complex number, in length units."""
        return complex(self.x, self.y)
