"""Limits within which a cam is sound."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from synthesis.model.dimension import ACCELERATION, ANGLE, JERK, LENGTH, TORQUE, VELOCITY
from synthesis.model.statement import NonNegative, PositiveLength, PositiveNumber, Sizable, Statement

LimitAngle = Annotated[float, ANGLE, Field(strict=True, gt=0.0, le=85.0), Sizable]


class CamLimits(Statement):
    """What a sound cam keeps."""

    pressure_angle: LimitAngle = Field(
        default=30.0, description="Greatest pressure angle of a roller follower, degrees."
    )
    pressure_angle_fall: LimitAngle | None = Field(
        default=None, description="Another limit while falling, where a spring and not the cam drives; degrees."
    )
    curvature_ratio: NonNegative = Field(
        default=2.0, description="Least radius of curvature of the pitch curve over the roller radius (Norton: 2 to 3)."
    )
    min_radius: Annotated[NonNegative, LENGTH] = Field(
        default=0.0,
        description="Least radius of curvature of the cam under a flat face; a fiftieth of the travel at least.",
    )
    face_width: PositiveLength | None = Field(default=None, description="Length that the contact may sweep on a face.")
    hub_radius: Annotated[NonNegative, LENGTH] = Field(default=0.0, description="The base circle is at least as large.")
    size: PositiveLength | None = Field(
        default=None, description="Greatest prime radius (roller) or base radius (face)."
    )
    overturning_moment: Annotated[PositiveNumber, TORQUE] | None = Field(
        default=None,
        description="Greatest moment on the slide of a translating follower: contact force times the distance from the "
        "slide's axis under a face, lateral force times its lever to the guide of a roller.",
    )
    velocity: Annotated[PositiveNumber, VELOCITY] | None = Field(
        default=None,
        description="Peak of every optimal or automatic motion. Beside laws that are all stated by name it is refused.",
    )
    acceleration: Annotated[PositiveNumber, ACCELERATION] | None = Field(default=None, description="Likewise.")
    jerk: Annotated[PositiveNumber, JERK] | None = Field(default=None, description="Likewise.")

    @property
    def falling_pressure_angle(self) -> float:
        """The limit while falling, degrees: that of the rise where none is stated."""
        return self.pressure_angle_fall or self.pressure_angle
