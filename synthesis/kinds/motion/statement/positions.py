"""Target positions of the body and their tolerances."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from kinematics.message import compose
from synthesis.model.dimension import ANGLE
from synthesis.model.problem import Coordinate, Degrees, Flag, PositiveLength, Sizable, Statement

MAX_EXACT_POSITIONS = 5
"""Maximum number of positions that two dyads can meet exactly, in general (Norton, Table 5-3)."""

MAX_SIXBAR_POSITIONS = 60
"""Maximum number of positions for a sixbar. In general it can meet eight exactly: these fix its fourteen dimensions and
the three coordinates of the body on it, apart from the input angles."""


class Tolerance(Statement):
    """Tolerance of a position, by coordinate; a coordinate that is left out is met exactly."""

    x: PositiveLength | None = Field(default=None, description="Permitted error in either direction, length units.")
    y: PositiveLength | None = Field(default=None, description="Permitted error in either direction, length units.")
    angle: Annotated[float, ANGLE, Field(strict=True, gt=0.0, le=180.0), Sizable] | None = Field(
        default=None, description="Permitted error in either direction, degrees."
    )

    @model_validator(mode="after")
    def _check_not_empty(self) -> Self:
        if self.x is None and self.y is None and self.angle is None:
            raise ValueError(compose("motion-tolerance-empty"))
        return self


class Position(Statement):
    """A position of the body: its reference point P and the angle of a line fixed in it."""

    x: Coordinate
    y: Coordinate
    angle: Degrees = Field(description="Angle of the body's line, degrees, counter-clockwise from +x.")
    tolerance: PositiveLength | Tolerance | None = Field(
        default=None,
        description="Permitted deviation of the position, by coordinate, or one length for x and y. The angle may then "
        "move a point one task size away by that length.",
    )
    exact: Flag = Field(
        default=False, description="Meet this position exactly although the others are fitted by least squares."
    )

    @property
    def point(self) -> complex:
        """The reference point as a complex number, in length units."""
        return complex(self.x, self.y)
