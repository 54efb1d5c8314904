"""Balanced rotors and linkages as answers."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, Result, Verification, optional_field
from synthesis.model.dimension import INERTIA, Angle, Force, Grade, Length, Mass, Torque, Unbalance
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.answer import Skeleton

Inertia = Annotated[float, INERTIA]


class RotorUnbalance(Answer):
    """An unbalance of the rotor before its correction."""

    unbalance: Unbalance = Field(description="Mass times radius.")
    angle: Angle
    z: Length


class RotorCorrection(Answer):
    """A mass that is added to the rotor at a place, or removed there."""

    plane: int = Field(description="Number of the plane, from 0.")
    z: Length
    angle: Angle = Field(description="Angle of the mass, degrees.")
    unbalance: Unbalance = Field(description="Mass times radius.")
    mass: Mass | None = optional_field("Omitted if no correction is given.")
    radius: Length | None = optional_field("Omitted if no correction is given.")
    removed: bool = Field(description="Whether the mass is removed.")


class RotorMechanism(Answer):
    """A rotor with its corrections, in the form of `POST /v1/analyses`."""

    type: Literal["rotor"] = "rotor"
    unbalances: list[RotorUnbalance]
    corrections: list[RotorCorrection]
    planes: list[Length]
    bearings: tuple[Length, Length] | None = optional_field("Omitted if the problem does not give them.")


class PlaneBalance(Answer):
    """Residual unbalance in a plane of correction."""

    z: Length
    needed: Unbalance = Field(description="Unbalance that must be added there.")
    needed_angle: Angle
    residual: Unbalance = Field(description="Remaining unbalance.")
    bound: Unbalance = Field(description="Lower bound for any choice of any number of the given places.")
    places: int = Field(description="Number of masses or holes in the plane.")


class BearingForces(Answer):
    """The rotating force on a bearing at the given speed."""

    z: Length
    before: Force
    after: Force


class RotorMetrics(Answer):
    """Measured properties of a balanced rotor."""

    residual_unbalance: Unbalance = Field(description="Sum of the residual unbalances of the planes.")
    bound: Unbalance = Field(description="Lower bound for any choice of any number of the given places.")
    optimal: bool = Field(description="Whether the residual is proven minimal for this number of places in each plane.")
    places: int = Field(description="Number of masses or holes in all planes.")
    initial_unbalance: Unbalance = Field(description="Vector sum of the unbalances before the correction.")
    residual_couple: Torque | None = optional_field(
        "Remaining couple about the plane at the given speed, if a single plane balances only the force."
    )
    grade: Grade | None = optional_field(
        "Balance quality grade after the correction; omitted without speed and rotor mass."
    )
    initial_grade: Grade | None = optional_field("Balance quality grade before the correction.")
    shaking_force: Force | None = optional_field("Shaking force before the correction, at the given speed.")
    shaking_moment: Torque | None = optional_field(
        "Shaking moment before the correction, about the first plane, at the given speed."
    )
    residual_vibration: list[float] | None = optional_field(
        "Amplitudes at the sensors predicted by the influence coefficients, in the unit of the readings."
    )
    planes: list[PlaneBalance]
    bearings: list[BearingForces] | None = optional_field("Omitted without speed or bearings.")


class RotorDesign(Answer):
    """A balanced rotor with its verification."""

    mechanism: RotorMechanism
    verification: Verification
    metrics: RotorMetrics


class BalancedLinkage(Answer):
    """A linkage by its skeleton, including the links of geared inertias."""

    type: Literal["skeleton"] = "skeleton"
    skeleton: Skeleton


class Counterweight(Answer):
    """A weight fixed to a link."""

    link: str
    mass: Mass
    at: Point = Field(description="Centre of the weight in the reference configuration.")
    joint: str = Field(
        description="Joint from which radius and angle are measured: the link's fixed pivot or first joint."
    )
    radius: Length = Field(description="Distance from that joint.")
    angle: Angle = Field(
        description="Angle from the line of that joint to the link's next joint, counter-clockwise, degrees."
    )
    moment: Unbalance = Field(description="Mass times radius.")
    inertia: Inertia = Field(
        description="Moment of inertia about its own centre; for a disc, or for an inertia without mass."
    )
    disc_radius: Length | None = optional_field("Radius of a disc of the given density and thickness.")


class GearedInertia(Answer):
    """A link on the same pivot as another one and geared to it."""

    link: str
    against: str
    ratio: float
    inertia: Inertia


class ForceLevel(Answer):
    """A quantity in the objective or with a cap."""

    name: str
    norm: Literal["max", "rms"]
    weight: float
    cap: float | None = optional_field("Omitted if there is none.")
    ratio: float = Field(description="Value with the counterweights over the value without.")


class BalanceMetrics(Answer):
    """Shaking force, shaking moment and drive before and after, and the added mass.

    Peaks over the motion: for exact balancing from the inertia of the links alone; for a minimum from all forces.
    """

    value: float = Field(
        description="Remaining share of the unbalanced value; with several quantities, their weighted sum."
    )
    bound: float = Field(description="Lower bound for all permitted counterweights.")
    gap: float | None = optional_field("Excess of the value over the bound, as a share of the value, if minimized.")
    levels: list[ForceLevel] = Field(
        description="Quantities in the objective or with a cap, if minimized; empty otherwise."
    )
    shaking_force: Force
    unbalanced_shaking_force: Force
    shaking_moment: Torque
    unbalanced_shaking_moment: Torque
    drive: Torque = Field(description="Peak torque of the drive (force, for a sliding input).")
    unbalanced_drive: Torque
    added_mass: Mass


class BalancedDesign(Answer):
    """A linkage with its counterweights and its verification."""

    mechanism: BalancedLinkage
    dynamics: JsonObject = Field(
        description="The whole block `dynamics` including the counterweights, in the form of `POST /v1/analyses`."
    )
    counterweights: list[Counterweight]
    geared: list[GearedInertia] = Field(description="Geared inertias; empty if none is needed.")
    verification: Verification
    metrics: BalanceMetrics


class BalancingResult(Result[RotorDesign | BalancedDesign]):
    """Corrections of a rotor, or counterweights of a linkage.

    For a rotor the smallest residual comes first; with a choice of places, the designs are the Pareto set of residual
    against number of places. For a linkage each design is a set of links with counterweights, the lightest
    first.
    """
