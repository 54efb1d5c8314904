"""Forces of a finished linkage as a part of its answer: the peaks that demands are held against."""

from __future__ import annotations

from typing import Annotated, Literal

from synthesis.model.answer import Answer, optional
from synthesis.model.dimension import FORCE, POWER, TORQUE, Angle, Length


class AtInput(Answer):
    """The input at which a peak stands."""

    at: Angle | None = optional("Input angle; left out where the input slides.")
    at_place: Length | None = optional("Place of an input that slides, along its line; left out where it turns.")


class TorquePeak(AtInput):
    """The greatest magnitude of a torque, and the input at which it stands."""

    max: Annotated[float, TORQUE]


class ForcePeak(AtInput):
    """The greatest magnitude of a force, and the input at which it stands."""

    max: Annotated[float, FORCE]


class JointForcePeak(ForcePeak):
    """The same of the joint that bears most."""

    joint: str


class PowerPeak(AtInput):
    """The greatest power of the drive, either way, and the input at which it stands."""

    max: Annotated[float, POWER]


class DesignForces(Answer):
    """Peaks of a linkage's forces at constant speed, refined between 72 positions (docs/dynamics.md)."""

    units: Literal["si", "consistent"]
    over: Literal["cycle", "used"] | None = optional(
        "The motion that was looked at: a whole cycle where the input turns through, else the used range."
    )
    drive_torque: TorquePeak | None = optional("Of an input that turns.")
    drive_force: ForcePeak | None = optional("Of an input that slides.")
    joint_force: JointForcePeak | None = optional("Of all pins on all of their links.")
    shaking_force: ForcePeak | None = optional("Of the mechanism on its frame.")
    shaking_moment: TorquePeak | None = optional("The same, about the first fixed pivot or `moment_about`.")
    power: PowerPeak | None = optional("Of the drive.")
    joint_force_index: float | None = optional(
        "Largest force in any joint over the first of the loads, without masses (per metre of a torque); left out "
        "where there is no load, or a dead centre makes it infinite."
    )
    remark: str | None = optional("Why there are no peaks: what is not determined, and where.")
