"""Analysis of a flywheel: its mass, moment of inertia, rotation and kinetic energy."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family
from synthesis.model.dimension import DENSITY, LENGTH
from synthesis.model.dynamics.request import METRES_PER_UNIT, LengthUnit
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import NonNegative, PositiveLength, PositiveNumber, Statement


class GivenFlywheel(Statement):
    """A wheel of one thickness about its shaft."""

    type: Literal["flywheel"]
    form: object = None
    radius: PositiveLength
    inner_radius: Annotated[NonNegative, LENGTH] = 0.0
    thickness: PositiveLength
    density: Annotated[PositiveNumber, DENSITY]


class FlywheelAnalysis(DrivenAnalysis):
    """Analysis of a flywheel in motion."""

    valid: list[bool]
    angle: list[float]
    omega: list[float] = Field(description="rad/s")
    alpha: list[float] = Field(description="rad/s²")
    mass: float
    inertia: float
    kinetic_energy: list[float]


class FlywheelAnalysisRequest(DrivenRequest[GivenFlywheel]):
    """A flywheel and how it turns."""

    model_config = ConfigDict(
        title="Flywheel: energy and stress",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "flywheel",
                        "radius": 250.0,
                        "inner_radius": 150.0,
                        "thickness": 60.0,
                        "density": 7800.0,
                    },
                    "motion": {"at": 0.0, "speed_rpm": 300.0},
                }
            ]
        },
    )

    length_unit: LengthUnit = "mm"
    units: Literal["si", "consistent"] = Field(
        default="si", description="`si`: lengths are converted to metres; `consistent`: nothing is converted."
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults = super().find_errors()
        if self.mechanism.inner_radius >= self.mechanism.radius:
            faults.append(("/mechanism/inner_radius", compose("analyses-inner-radius-too-large")))
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer for the flywheel, in the form of :class:`FlywheelAnalysis`."""
        at, speed, time = self.motion.list_inputs()
        scale = METRES_PER_UNIT[self.length_unit] if self.units == "si" else 1.0
        wheel = self.mechanism
        outer, inner = scale * wheel.radius, scale * wheel.inner_radius
        mass = math.pi * wheel.density * scale * wheel.thickness * (outer**2 - inner**2)
        inertia = 0.5 * mass * (outer**2 + inner**2)
        return {
            "input_angle": at.tolist(),
            "time": None if time is None else time.tolist(),
            "valid": [True] * len(at),
            **self.motion.drive_geared(1.0, at, speed),
            "mass": mass,
            "inertia": inertia,
            "kinetic_energy": (0.5 * inertia * speed**2).tolist(),
        }


FAMILY = Family(FlywheelAnalysisRequest, FlywheelAnalysis)
