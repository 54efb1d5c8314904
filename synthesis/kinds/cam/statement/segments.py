"""Segments of a requested motion program: dwells, moves by a law, stretches of constant velocity, polynomials.

Angles are degrees of cam rotation. Displacements are lengths, or degrees of an oscillating follower's arm; their
derivatives are by the radian of cam rotation (length/rad, length/rad², …; rad/rad, … for an arm).
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field

from synthesis.model.dimension import ACCELERATION, ANGLE, DISPLACEMENT, JERK, VELOCITY
from synthesis.model.problem import NonNegative, Number, PositiveNumber, Statement

Span = Annotated[float, ANGLE, Field(strict=True, ge=1e-4, le=360.0, allow_inf_nan=False)]
"""Angle of a segment, degrees. Shorter segments are finer than any shaft can be set, and their rates would be
rounding."""


Law = Literal[
    "auto",
    "optimal",
    "constant_velocity",
    "constant_acceleration",
    "simple_harmonic",
    "cycloidal",
    "trapezoidal",
    "modified_trapezoid",
    "modified_sine",
    "modified_constant_velocity",
    "polynomial_23",
    "polynomial_345",
    "polynomial_4567",
    "polynomial_456789",
    "eighth_power",
    "eighth_power_reversed",
    "double_harmonic",
    "double_harmonic_reversed",
    "half_harmonic_start",
    "half_harmonic_end",
    "half_cycloidal_start",
    "half_cycloidal_end",
]
"""Names of the laws; ``auto`` selects the best of them by the criterion, ``optimal`` the best of all motions."""


class ProgramCondition(Statement):
    """Conditions at one angle; omitted quantities are free."""

    angle: Annotated[NonNegative, ANGLE] = Field(description="Angle from the segment's start, degrees.")
    s: Annotated[Number, DISPLACEMENT] | None = Field(default=None, description="Displacement from the program's zero.")
    v: Annotated[Number, VELOCITY] | None = Field(default=None, description="Velocity, per radian of cam rotation.")
    a: Annotated[Number, ACCELERATION] | None = Field(default=None, description="Acceleration, per radian squared.")
    j: Annotated[Number, JERK] | None = Field(default=None, description="Jerk, per radian cubed.")

    def values(self) -> list[tuple[int, float]]:
        """Return (order, value) of every given quantity."""
        return [(k, x) for k, x in enumerate((self.s, self.v, self.a, self.j)) if x is not None]


class DisplacementBand(Statement):
    """A stretch in which the displacement stays between two values."""

    start: Annotated[NonNegative, ANGLE] = Field(description="Angle from the segment's start, degrees.")
    end: Span = Field(description="Angle from the segment's start, degrees.")
    lower: Annotated[Number, DISPLACEMENT] | None = None
    upper: Annotated[Number, DISPLACEMENT] | None = None


class Dwell(Statement):
    """A rest at the displacement at which the previous segment ends."""

    motion: Literal["dwell"]
    angle: Span


class Move(Statement):
    """A rise, or a fall (``return`` is a synonym), by a law."""

    motion: Literal["rise", "fall", "return"]
    angle: Span
    lift: Annotated[PositiveNumber, DISPLACEMENT] | None = Field(
        default=None, description="Travel, also positive for a fall; a return without it goes back to zero."
    )
    law: Law = "auto"
    conditions: list[ProgramCondition] = Field(default=[], description="Interior conditions of an optimal motion.")
    bands: list[DisplacementBand] = Field(default=[], description="Bands of an optimal motion.")

    @property
    def follows_criterion(self) -> bool:
        """True if no law is given, so that the criterion chooses the motion, within the limits."""
        return self.law in ("auto", "optimal")


class ConstantVelocity(Statement):
    """A stretch of constant velocity."""

    motion: Literal["constant_velocity"]
    angle: Span
    lift: Annotated[Number, DISPLACEMENT] = Field(description="Travel, with its sign.")


class Polynomial(Statement):
    """The polynomial of lowest degree through conditions anywhere in the segment.

    Without a displacement at its start it continues from the end of the previous segment.
    """

    motion: Literal["polynomial"]
    angle: Span
    conditions: list[ProgramCondition] = Field(min_length=1, max_length=40)


Segment = Annotated[Dwell | Move | ConstantVelocity | Polynomial, Discriminator("motion")]
