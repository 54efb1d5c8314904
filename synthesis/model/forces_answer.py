"""Reported forces of a finished linkage: the peaks that are compared with its force limits."""

from __future__ import annotations

from typing import Annotated, Literal

from synthesis.model.answer import Answer, optional
from synthesis.model.dimension import FORCE, POWER, TORQUE, Angle, Length


class AtInput(Answer):
    """Input at which a peak occurs."""

    at: Angle | None = optional("Input angle; left out if the input slides.")
    at_place: Length | None = optional("Position of a sliding input along its line; left out if the input rotates.")


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
    """Peaks of a linkage's forces at constant speed, refined between 72 positions (docs/dynamics.md)."""

    units: Literal["si", "consistent"]
    over: Literal["cycle", "used"] | None = optional(
        "Motion over which forces were computed: a whole cycle if the input rotates fully, otherwise the used range."
    )
    drive_torque: TorquePeak | None = optional("Drive torque of a rotating input.")
    drive_force: ForcePeak | None = optional("Drive force of a sliding input.")
    joint_force: JointForcePeak | None = optional("Maximum over all pins and all of their links.")
    shaking_force: ForcePeak | None = optional("Force of the mechanism on its frame.")
    shaking_moment: TorquePeak | None = optional(
        "Moment of the mechanism on its frame about the first fixed pivot or `moment_about`."
    )
    power: PowerPeak | None = optional("Power of the drive.")
    joint_force_index: float | None = optional(
        "Maximum joint force divided by the first load, without masses (per metre if the load is a torque); left out "
        "without loads, or if a dead centre makes it infinite."
    )
    remark: str | None = optional("Reason why there are no peaks: what is undetermined, and at which input.")
