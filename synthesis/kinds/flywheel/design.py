"""Answers to problems of flywheels."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from synthesis.model.answer import Answer, Result, Verification
from synthesis.model.dimension import DENSITY, ENERGY, INERTIA, MASS, SPEED, Angle, Length, RotationalSpeed, Torque
from synthesis.model.dynamics_answer import Pulse


class FlywheelMechanism(Answer):
    """A wheel of one thickness about the shaft: a full disc, or a ring."""

    type: Literal["flywheel"] = "flywheel"
    form: Literal["disc", "rim"]
    radius: Length = Field(description="Of the outside.")
    inner_radius: Length = Field(description="0 of a disc.")
    thickness: Length = Field(description="Along the axis.")
    density: Annotated[float, DENSITY]


class Fluctuation(Answer):
    """What the torque asks of any flywheel on its shaft."""

    mean_torque: Torque
    energy: Annotated[float, ENERGY] = Field(description="Largest less smallest energy taken from the flywheel.")
    inertia: Annotated[float, INERTIA] = Field(
        description="With which the coefficient is exactly as stated, less what the shaft has."
    )
    first_order_inertia: Annotated[float, INERTIA] = Field(description="E/(k ω²), less what the shaft has.")
    first_order_coefficient: float = Field(description="That which this inertia has in truth.")
    pulses: list[Pulse] = Field(description="Where the torque stays above its mean, or below.")


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
    coefficient: float = Field(description="(ω_max − ω_min)/ω_mean of the shaft with it.")
    least_speed: RotationalSpeed
    greatest_speed: RotationalSpeed
    rim_speed: Annotated[float, SPEED] = Field(description="At the greatest speed.")
    at_limits: list[Limit] = Field(description="The limits at which it stands: without them it would be lighter.")


class FlywheelDesign(Answer):
    """A flywheel with the proof of the speed that it keeps."""

    mechanism: FlywheelMechanism
    verification: Verification
    metrics: FlywheelMetrics
    course: SpeedCurve


class FlywheelResult(Result[FlywheelDesign]):
    """Flywheels, the lightest first."""

    fluctuation: Fluctuation | None = Field(description="Null where the torque is not known all round the cycle.")
