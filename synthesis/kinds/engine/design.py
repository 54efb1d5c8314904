"""Answers to problems of piston engines."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from synthesis.model.answer import Answer, Result, Verification, optional_field
from synthesis.model.dimension import (
    ENERGY,
    FORCE,
    INERTIA,
    MASS,
    ROTATIONAL_SPEED,
    Angle,
    Force,
    Length,
    Percent,
    Torque,
)


class EngineCylinder(Answer):
    """A cylinder, numbered from the front."""

    number: int
    throw: int = Field(description="Number of its throw, from 1.")
    axis: Angle = Field(description="Direction of its axis from the engine's own, positive to the left, degrees.")
    phase: Angle = Field(description="Lag of its throw behind the first, degrees.")
    place: float = Field(description="Place along the shaft, in spacings of the throws.")


class EngineMechanism(Answer):
    """A crankshaft with its cylinders."""

    type: Literal["engine"] = "engine"
    layout: Literal["inline", "vee", "opposed", "radial", "w"]
    crank: Length = Field(description="Radius of the throws: half the stroke.")
    rod: Length
    throws: list[Angle] = Field(description="Phases of the throws along the shaft, degrees.")
    cylinders: list[EngineCylinder]


class FiringOrder(Answer):
    """An order in which cylinders fire, with the crank angles of firing."""

    order: list[int]
    reversed: list[int] = Field(description="The same order for the opposite rotation.")
    angles: list[Angle] = Field(description="Firing angles in that order, after the first, degrees.")
    adjacent: int = Field(description="Number of times that neighbours in one bank fire in succession.")


class EngineFiring(Answer):
    """The most even firing orders; orders that only differ by their direction count as one."""

    unevenness: Angle = Field(description="Largest minus smallest interval between firings, degrees.")
    orders: list[FiringOrder] = Field(
        description="At most 64 orders, those with the fewest successive neighbours first."
    )
    even_choices: int = Field(description="Number of equally even choices of the cylinders' firing angles.")
    choices: int = Field(description="Number of all choices.")
    stated_unevenness: Angle | None = optional_field("Unevenness of the given firing angles.")


class VectorHarmonic(Answer):
    """A harmonic of a force or moment, an ellipse, in units of one cylinder's."""

    forward: float = Field(description="The part that rotates with the crank.")
    backward: float
    major: float = Field(description="Major half axis of the ellipse.")
    minor: float


class EngineHarmonic(Answer):
    """A harmonic of the engine: forces in units of m_B r ω² A_k, moments of that times the spacing."""

    order: int
    coefficient: float | None = Field(description="A_k of the piston's acceleration; null if it has no such part.")
    force: VectorHarmonic
    moment: VectorHarmonic
    torque: float = Field(description="|Σ exp(−jk τ)|, in units of one cylinder's torque of that order.")
    cos: float = Field(description="Sums over the cylinders, at their top dead centres: Σ cos kτ,")
    sin: float = Field(description="Σ sin kτ,")
    place_cos: float = Field(description="Σ z cos kτ,")
    place_sin: float = Field(description="and Σ z sin kτ.")


class Balancer(Answer):
    """Rotating weights that cancel a harmonic: mass times radius in units of m_B r, for couples also times spacing."""

    against: Literal["force", "moment"]
    order: int
    form: Literal["crankshaft_weights", "counter_shaft", "lanchester_pair", "shafts"]
    forward: float = Field(description="The weight, or couple of weights, that rotates with the crank.")
    forward_angle: Angle = Field(description="Its angle with the first throw at 0, degrees.")
    backward: float = Field(description="The weight, or couple of weights, that rotates opposite to the crank.")
    backward_angle: Angle
    height_difference: Length | None = optional_field(
        "For a pair of shafts: with the forward one higher by the rod's length, the second harmonic of the "
        "inertia torque is cancelled too (Nakamura); with 0.7 of it if gas forces count."
    )


class Overbalance(Answer):
    """For one cylinder: the share of m_B carried by a counterweight opposite the crank pin for the minimum peak."""

    share: float
    peak: Force
    unbalanced_peak: Force = Field(description="Peak without any counterweight, including rotating masses.")
    exact_balance_peak: Force = Field(description="Peak with only the rotating masses balanced.")


class EngineForces(Answer):
    """Peak forces at the given speed."""

    shaking_force: Force
    shaking_moment: Torque | None = optional_field("Given if the spacing is given.")
    mean_torque: Torque
    max_torque: Torque
    min_torque: Torque
    side_force: Force = Field(description="Force of a piston on its wall.")
    wrist_pin_force: Force
    crank_pin_force: Force = Field(description="Crank pin force of one rod.")
    two_mass_torque_difference: Torque = Field(
        description="Difference of the torque if the rod is modelled as two masses."
    )


class EngineFlywheel(Answer):
    """The flywheel that evens the speed."""

    speed: Annotated[float, ROTATIONAL_SPEED]
    energy: Annotated[float, ENERGY]
    inertia: Annotated[float, INERTIA] = Field(
        description="Inertia for exactly the requested coefficient, minus the existing inertia."
    )
    first_order_inertia: Annotated[float, INERTIA]
    coefficient: float = Field(description="Coefficient with this inertia.")


class EngineCourse(Answer):
    """Curves over a cycle: torques of the engine, forces on its frame, and the pins of the first cylinder.

    The pins' x is along the cylinder, away from the crank; y is to the left of it.
    """

    angle: list[Angle]
    gas_torque: list[Torque]
    inertia_torque: list[Torque]
    shaking_x: Annotated[list[float], FORCE]
    shaking_y: Annotated[list[float], FORCE]
    side: Annotated[list[float], FORCE] = Field(description="Force of the piston on the wall.")
    wrist_x: Annotated[list[float], FORCE] = Field(description="Force of the rod on the piston.")
    wrist_y: Annotated[list[float], FORCE]
    crank_pin_x: Annotated[list[float], FORCE] = Field(description="Force of the rod on the crank.")
    crank_pin_y: Annotated[list[float], FORCE]
    main_x: Annotated[list[float], FORCE] = Field(description="Force of the crank with this rod alone on its bearings.")
    main_y: Annotated[list[float], FORCE]


class LumpedMasses(Answer):
    """Equivalent masses of the rod and the throw of one cylinder (Norton, eq. 13.9-13.11)."""

    rod_crank_pin: Annotated[float, MASS] = Field(
        description="Mass at the crank pin of the rod as two masses at its pins."
    )
    rod_wrist_pin: Annotated[float, MASS]
    rod_inertia: Annotated[float, INERTIA] = Field(description="Moment of inertia of these two about their centre.")
    rod_inertia_error: Percent | None = optional_field("Excess of that over the rod's inertia, percent.")
    percussion_distance: Length | None = optional_field(
        "Distance from the rod's centre to the exact model's other mass."
    )
    percussion_mass: Annotated[float, MASS] | None = optional_field(
        "The exact model's other mass, which gives the correct inertia."
    )
    percussion_wrist_pin: Annotated[float, MASS] | None = optional_field("The exact model's mass at the wrist pin.")
    throw_crank_pin: Annotated[float, MASS] | None = optional_field("Mass of the throw as one mass at the crank pin.")
    throw_inertia: Annotated[float, INERTIA] | None = optional_field("Moment of inertia of that mass about the shaft.")
    throw_inertia_error: Percent | None = optional_field("Excess of that over the throw's inertia, percent.")


class EngineMetrics(Answer):
    """Ranking criteria of engines: parts that no weight on the crankshaft balances, moments about the middle."""

    unevenness: Angle
    primary_force: float = Field(description="The part that rotates opposite to the crank, in units of m_B r ω².")
    primary_moment: float
    secondary_force: float = Field(description="Greatest magnitude, in units of m_B r ω² A₂.")
    secondary_moment: float
    torque: float = Field(description="Greatest of the first three harmonics, in units of one cylinder's.")
    binomial_terms: list[float] = Field(
        description="Binomial terms of the root in the piston's position: λ²/2, λ⁴/8, λ⁶/16."
    )
    forces: EngineForces | None = optional_field("Given if masses or pressure are given.")
    masses: LumpedMasses | None = optional_field("Given if masses are given.")


class EngineDesign(Answer):
    """An engine with the verification of its harmonics and its firing."""

    mechanism: EngineMechanism
    verification: Verification
    metrics: EngineMetrics
    firing: EngineFiring
    harmonics: list[EngineHarmonic]
    balancers: list[Balancer]
    overbalance: Overbalance | None = optional_field("Given for one cylinder with masses.")
    flywheel: EngineFlywheel | None = optional_field("Given if a flywheel is requested.")
    course: EngineCourse | None = optional_field("Given if masses or pressure are given.")


class EngineResult(Result[EngineDesign]):
    """Engines, the smoothest first."""

    count: int = Field(description="Number of arrangements of throws; equivalent ones count once.")
