"""Limits that a feasible cam keeps."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from synthesis.model.dimension import ACCELERATION, ANGLE, JERK, LENGTH, TORQUE, VELOCITY
from synthesis.model.problem import NonNegative, PositiveLength, PositiveNumber, Sizable, Statement

LimitAngle = Annotated[float, ANGLE, Field(strict=True, gt=0.0, le=85.0), Sizable]


class CamLimits(Statement):
    """Limits that a feasible cam keeps."""

    pressure_angle: LimitAngle = Field(
        default=30.0, description="Maximum pressure angle of a roller follower, degrees."
    )
    pressure_angle_fall: LimitAngle | None = Field(
        default=None,
        description="Maximum pressure angle during the fall, when a spring drives instead of the cam; degrees. "
        "Default: `pressure_angle`.",
    )
    curvature_ratio: NonNegative = Field(
        default=2.0,
        description="Minimum radius of curvature of the pitch curve over the roller radius (Norton: 2 to 3).",
    )
    min_radius: Annotated[NonNegative, LENGTH] = Field(
        default=0.0,
        description="Minimum radius of curvature of the cam under a flat face; never less than a fiftieth of the "
        "travel.",
    )
    face_width: PositiveLength | None = Field(
        default=None, description="Maximum length that the contact sweeps on a face."
    )
    hub_radius: Annotated[NonNegative, LENGTH] = Field(default=0.0, description="Minimum radius of the base circle.")
    size: PositiveLength | None = Field(
        default=None, description="Maximum prime radius (roller) or base radius (face)."
    )
    overturning_moment: Annotated[PositiveNumber, TORQUE] | None = Field(
        default=None,
        description="Maximum moment on the slide of a translating follower: contact force times the distance from the "
        "slide's axis for a face, lateral force times its lever to the guide for a roller.",
    )
    velocity: Annotated[PositiveNumber, VELOCITY] | None = Field(
        default=None,
        description="Maximum velocity of every optimal or automatic motion. Refused if all laws are given by name.",
    )
    acceleration: Annotated[PositiveNumber, ACCELERATION] | None = Field(
        default=None,
        description="Maximum acceleration of every optimal or automatic motion. Refused if all laws are given by name.",
    )
    jerk: Annotated[PositiveNumber, JERK] | None = Field(
        default=None,
        description="Maximum jerk of every optimal or automatic motion. Refused if all laws are given by name.",
    )

    @property
    def falling_pressure_angle(self) -> float:
        """The limit during the fall, degrees: by default the limit of the rise."""
        return self.pressure_angle_fall or self.pressure_angle
