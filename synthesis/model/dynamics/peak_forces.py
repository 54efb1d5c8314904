"""Models of the forces of a finished linkage: the peaks that are compared with force limits."""

from __future__ import annotations

from typing import Annotated, Literal

from synthesis.model.answer import Answer, optional_field
from synthesis.model.dimension import FORCE, POWER, TORQUE, Angle, Length


class AtInput(Answer):
    """Input at which a peak occurs."""

    at: Angle | None = optional_field("Input angle; left out if the input slides.")
    at_place: Length | None = optional_field(
        "Position of a sliding input along its line; left out if the input rotates."
    )


class TorquePeak(AtInput):
    """Maximum magnitude of a torque, and the input at which it occurs."""

    max: Annotated[float, TORQUE]


class ForcePeak(AtInput):
    """Maximum magnitude of a force, and the input at which it occurs."""

    max: Annotated[float, FORCE]


class JointForcePeak(ForcePeak):
    """Maximum joint force: its joint, magnitude and input."""

    joint: str


class PowerPeak(AtInput):
    """Maximum power of the drive in either direction, and the input at which it occurs."""

    max: Annotated[float, POWER]


class DesignForces(Answer):
    """Peaks of a linkage's forces at constant speed, refined between 72 positions (docs/mechanisms/dynamics.md)."""

    units: Literal["si", "consistent"]
    over: Literal["cycle", "used"] | None = optional_field(
        "Motion over which forces were computed: a whole cycle if the input rotates fully, otherwise the used range."
    )
    drive_torque: TorquePeak | None = optional_field("Drive torque of a rotating input.")
    drive_force: ForcePeak | None = optional_field("Drive force of a sliding input.")
    joint_force: JointForcePeak | None = optional_field("Maximum over all pins and all of their links.")
    shaking_force: ForcePeak | None = optional_field("Force of the mechanism on its frame.")
    shaking_moment: TorquePeak | None = optional_field(
        "Moment of the mechanism on its frame about the first fixed pivot or `moment_about`."
    )
    power: PowerPeak | None = optional_field("Power of the drive.")
    joint_force_index: float | None = optional_field(
        "Maximum joint force divided by the first load, without masses (per metre if the load is a torque); left out "
        "without loads, or if a dead centre makes it infinite."
    )
    remark: str | None = optional_field("Reason why there are no peaks: what is undetermined, and at which input.")
