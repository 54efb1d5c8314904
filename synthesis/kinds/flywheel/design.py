"""Answers to problems of flywheels."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from synthesis.model.answer import Answer, Result, Verification
from synthesis.model.dimension import DENSITY, ENERGY, INERTIA, MASS, SPEED, Angle, Length, RotationalSpeed, Torque
from synthesis.model.dynamics.answer import Pulse


class FlywheelMechanism(Answer):
    """A wheel of one thickness about the shaft: a full disc, or a ring."""

    type: Literal["flywheel"] = "flywheel"
    form: Literal["disc", "rim"]
    radius: Length = Field(description="Outer radius.")
    inner_radius: Length = Field(description="Inner radius; 0 for a disc.")
    thickness: Length = Field(description="Thickness along the axis.")
    density: Annotated[float, DENSITY]


class Fluctuation(Answer):
    """Requirements of the torque on any flywheel of its shaft."""

    mean_torque: Torque
    energy: Annotated[float, ENERGY] = Field(description="Largest minus smallest energy taken from the flywheel.")
    inertia: Annotated[float, INERTIA] = Field(
        description="Inertia for exactly the requested coefficient, minus the existing inertia."
    )
    first_order_inertia: Annotated[float, INERTIA] = Field(
        description="First-order inertia E/(k ω²), minus the existing inertia."
    )
    first_order_coefficient: float = Field(description="Actual coefficient with the first-order inertia.")
    pulses: list[Pulse] = Field(description="Intervals in which the torque stays above its mean, or below it.")


class SpeedCurve(Answer):
    """Torque and speed over a cycle, as integrated with the finished wheel."""

    angle: list[Angle]
    torque: list[Torque]
    speed: list[RotationalSpeed]


Limit = Literal["radius", "min_thickness", "max_thickness", "wall", "rim_speed", "radius_to_thickness"]


class FlywheelMetrics(Answer):
    """Measured properties of a flywheel and of its shaft's motion."""

    mass: Annotated[float, MASS]
    inertia: Annotated[float, INERTIA]
    coefficient: float = Field(description="(ω_max − ω_min)/ω_mean of the shaft with this flywheel.")
    least_speed: RotationalSpeed
    greatest_speed: RotationalSpeed
    rim_speed: Annotated[float, SPEED] = Field(description="Rim speed at the greatest shaft speed.")
    at_limits: list[Limit] = Field(description="Active limits: without them the wheel would be lighter.")


class FlywheelDesign(Answer):
    """A flywheel with the verification of its speed."""

    mechanism: FlywheelMechanism
    verification: Verification
    metrics: FlywheelMetrics
    course: SpeedCurve


class FlywheelResult(Result[FlywheelDesign]):
    """Flywheels, the lightest first."""

    fluctuation: Fluctuation | None = Field(description="Null if the torque is not known over the whole cycle.")
