"""Balanced rotors and linkages as answers."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, Result, Verification, optional
from synthesis.model.dimension import INERTIA, Angle, Force, Grade, Length, Mass, Torque, Unbalance
from synthesis.model.linkage_answer import Skeleton

Inertia = Annotated[float, INERTIA]


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


class BalancedLinkage(Answer):
    """A linkage by its skeleton, with the links of geared inertias where it has them."""

    type: Literal["skeleton"] = "skeleton"
    skeleton: Skeleton


class Counterweight(Answer):
    """A weight that is fixed to a link."""

    link: str
    mass: Mass
    at: Point = Field(description="Its centre in the reference configuration.")
    joint: str = Field(description="About which its radius and angle are told: the link's fixed pivot or first joint.")
    radius: Length = Field(description="From that joint.")
    angle: Angle = Field(
        description="From the line of that joint to the link's next joint, counter-clockwise, degrees."
    )
    moment: Unbalance = Field(description="Mass times radius.")
    inertia: Inertia = Field(description="About its own centre; of a disc, or of an inertia without mass.")
    disc_radius: Length | None = optional("Of a disc of the stated density and thickness.")


class GearedInertia(Answer):
    """A link that gears turn against another one, on the same pivot."""

    link: str
    against: str
    ratio: float
    inertia: Inertia


class ForceLevel(Answer):
    """A quantity that counts in the objective or has a cap."""

    name: str
    norm: Literal["max", "rms"]
    weight: float
    cap: float | None = optional("Left out where it has none.")
    ratio: float = Field(description="What it is with the counterweights over what it was.")


class BalanceMetrics(Answer):
    """What shakes the frame before and after, and what that takes.

    Peaks over the motion: of what is balanced exactly, of the inertia of the links alone; of what is minimized, of all
    that acts.
    """

    value: float = Field(description="What is left, as a share of what was before; of several, with their weights.")
    bound: float = Field(description="No counterweights that are allowed leave less.")
    gap: float | None = optional("How far the value is above the bound, as a share of it, where it is minimized.")
    levels: list[ForceLevel] = Field(description="What counts where it is minimized; empty otherwise.")
    shaking_force: Force
    unbalanced_shaking_force: Force
    shaking_moment: Torque
    unbalanced_shaking_moment: Torque
    drive: Torque = Field(description="Greatest torque (force, where the input slides) of the drive.")
    unbalanced_drive: Torque
    added_mass: Mass


class BalancedDesign(Answer):
    """A linkage with its counterweights and the proof of what they do."""

    mechanism: BalancedLinkage
    dynamics: dict[str, Any] = Field(
        description="The whole block `dynamics` with the counterweights in it, as `POST /v1/analyses` takes it."
    )
    counterweights: list[Counterweight]
    geared: list[GearedInertia] = Field(description="Empty where none is needed.")
    verification: Verification
    metrics: BalanceMetrics


class BalancingResult(Result[RotorDesign | BalancedDesign]):
    """What balances a rotor or a linkage.

    Of a rotor the least residual comes first; where places are chosen, the designs are the Pareto set of the residual
    against the places that are used. Of a linkage each design is a set of links with counterweights, the lightest
    first.
    """
