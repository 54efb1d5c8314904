"""Balanced rotors as answers."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Result, Verification, optional
from synthesis.model.dimension import Angle, Force, Grade, Length, Mass, Torque, Unbalance


class RotorUnbalance(Answer):
    """An unbalance of the rotor before it is corrected."""

    unbalance: Unbalance = Field(description="Mass times radius.")
    angle: Angle
    z: Length


class RotorCorrection(Answer):
    """A mass that is added to the rotor at a place, or taken from it there."""

    plane: int = Field(description="From 0.")
    z: Length
    angle: Angle = Field(description="Where the mass is, degrees.")
    unbalance: Unbalance = Field(description="Mass times radius.")
    mass: Mass | None = optional("Left out where no correction is stated.")
    radius: Length | None = optional("Left out where no correction is stated.")
    removed: bool = Field(description="Whether the mass is taken away.")


class RotorMechanism(Answer):
    """A rotor with all that balances it, as `POST /v1/analyses` takes it."""

    type: Literal["rotor"] = "rotor"
    unbalances: list[RotorUnbalance]
    corrections: list[RotorCorrection]
    planes: list[Length]
    bearings: tuple[Length, Length] | None = optional("Left out where the statement does not tell them.")


class PlaneBalance(Answer):
    """What is left in a plane of correction."""

    z: Length
    needed: Unbalance = Field(description="What has to be added there.")
    needed_angle: Angle
    residual: Unbalance = Field(description="What is left of it.")
    bound: Unbalance = Field(description="No choice of the stated places leaves less, of however many.")
    places: int = Field(description="Masses or holes of the plane.")


class BearingForces(Answer):
    """The turning force on a bearing at the stated speed."""

    z: Length
    before: Force
    after: Force


class RotorMetrics(Answer):
    """Measured properties of a balanced rotor."""

    residual_unbalance: Unbalance = Field(description="Sum of what is left in the planes.")
    bound: Unbalance = Field(description="No choice of the stated places leaves less, of however many.")
    optimal: bool = Field(description="Whether it is proved that as few places in each plane cannot leave less.")
    places: int = Field(description="Masses or holes of all planes.")
    initial_unbalance: Unbalance = Field(description="The sum of the unbalances as vectors, before.")
    residual_couple: Torque | None = optional(
        "That stays at the stated speed where one plane balances the force alone, about the plane."
    )
    grade: Grade | None = optional("Balance quality grade that is left; left out without speed and rotor mass.")
    initial_grade: Grade | None = optional("The same of the rotor before.")
    shaking_force: Force | None = optional("Before, at the stated speed.")
    shaking_moment: Torque | None = optional("Before, about the first plane, at the stated speed.")
    residual_vibration: list[float] | None = optional(
        "Amplitudes at the sensors that the influence coefficients foretell, in the unit of the readings."
    )
    planes: list[PlaneBalance]
    bearings: list[BearingForces] | None = optional("Left out without speed or bearings.")


class RotorDesign(Answer):
    """A balanced rotor with the proof that it is."""

    mechanism: RotorMechanism
    verification: Verification
    metrics: RotorMetrics


class BalancingResult(Result[RotorDesign]):
    """Balanced rotors, the least residual first.

    Where places are chosen, the designs are the Pareto set of the residual against the places that are used.
    """
