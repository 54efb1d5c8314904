"""Answers to problems of piston engines."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from synthesis.model.answer import Answer, Result, Verification, optional
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
    """A cylinder, as counted from the front."""

    number: int
    throw: int = Field(description="The throw that it is on, from 1.")
    axis: Angle = Field(description="Its direction from the engine's own, positive to the left, degrees.")
    phase: Angle = Field(description="By how much its throw lags behind the first, degrees.")
    place: float = Field(description="Along the shaft, in spacings of the throws.")


class EngineMechanism(Answer):
    """A crankshaft with its cylinders."""

    type: Literal["engine"] = "engine"
    layout: Literal["inline", "vee", "opposed", "radial", "w"]
    crank: Length = Field(description="Radius of the throws: half the stroke.")
    rod: Length
    throws: list[Angle] = Field(description="Phases of the throws along the shaft, degrees.")
    cylinders: list[EngineCylinder]


class FiringOrder(Answer):
    """An order in which cylinders fire, with the crank angles at which they do."""

    order: list[int]
    reversed: list[int] = Field(description="The same, turning the other way.")
    angles: list[Angle] = Field(description="In that order, after the first, degrees.")
    adjacent: int = Field(description="How often neighbours of one bank fire after each other.")


class EngineFiring(Answer):
    """The most even firing orders; orders that differ by their direction only are one."""

    unevenness: Angle = Field(description="Largest less smallest gap between firings, degrees.")
    orders: list[FiringOrder] = Field(description="At most 64, those with the fewest neighbours first.")
    even_choices: int = Field(description="Choices of where each cylinder fires that are as even.")
    choices: int = Field(description="All choices.")
    stated_unevenness: Angle | None = optional("Of the firing angles that are stated.")


class VectorHarmonic(Answer):
    """A harmonic of a force or moment, an ellipse, in units of one cylinder's."""

    forward: float = Field(description="The part that turns with the crank.")
    backward: float
    major: float = Field(description="Half axes of the ellipse.")
    minor: float


class EngineHarmonic(Answer):
    """A harmonic of the engine: forces in units of m_B r ω² A_k, moments of that times the spacing."""

    order: int
    coefficient: float | None = Field(description="A_k of the piston's acceleration; null where it has no such part.")
    force: VectorHarmonic
    moment: VectorHarmonic
    torque: float = Field(description="|Σ exp(−jk τ)|, in units of one cylinder's torque of that order.")
    cos: float = Field(description="Sums over the cylinders, at their top dead centres: Σ cos kτ,")
    sin: float = Field(description="Σ sin kτ,")
    place_cos: float = Field(description="Σ z cos kτ,")
    place_sin: float = Field(description="and Σ z sin kτ.")


class Balancer(Answer):
    """Turning weights that take a harmonic away: mass times radius in units of m_B r, of couples also times spacing."""

    against: Literal["force", "moment"]
    order: int
    form: Literal["crankshaft_weights", "counter_shaft", "lanchester_pair", "shafts"]
    forward: float = Field(description="Of the weight, or couple of weights, that turns with the crank.")
    forward_angle: Angle = Field(description="Its angle with the first throw at 0, degrees.")
    backward: float = Field(description="Of that which turns against it.")
    backward_angle: Angle
    height_difference: Length | None = optional(
        "Of a pair of shafts: with the one that turns forward higher by the rod's length, the second harmonic of the "
        "inertia torque goes too (Nakamura); 0.7 of it where gas counts."
    )


class Overbalance(Answer):
    """Of one cylinder: the share of m_B that a counterweight opposite the crank pin carries for the least peak."""

    share: float
    peak: Force
    unbalanced_peak: Force = Field(description="Without any counterweight, what turns included.")
    exact_balance_peak: Force = Field(description="With what turns balanced alone.")


class EngineForces(Answer):
    """Greatest forces at the stated speed."""

    shaking_force: Force
    shaking_moment: Torque | None = optional("If the spacing is stated.")
    mean_torque: Torque
    max_torque: Torque
    min_torque: Torque
    side_force: Force = Field(description="Of a piston on its wall.")
    wrist_pin_force: Force
    crank_pin_force: Force = Field(description="Of one rod.")
    two_mass_torque_difference: Torque = Field(
        description="By how much the torque is off where the rod is taken as two masses."
    )


class EngineFlywheel(Answer):
    """The flywheel that evens the speed."""

    speed: Annotated[float, ROTATIONAL_SPEED]
    energy: Annotated[float, ENERGY]
    inertia: Annotated[float, INERTIA] = Field(description="With which the coefficient is exact, less what there is.")
    first_order_inertia: Annotated[float, INERTIA]
    coefficient: float = Field(description="With this inertia.")


class EngineCourse(Answer):
    """Over a cycle: torques that the engine gives, what shakes its frame, and the pins of the first cylinder.

    The pins' x is along the cylinder, away from the crank; y is to the left of it.
    """

    angle: list[Angle]
    gas_torque: list[Torque]
    inertia_torque: list[Torque]
    shaking_x: Annotated[list[float], FORCE]
    shaking_y: Annotated[list[float], FORCE]
    side: Annotated[list[float], FORCE] = Field(description="Of the piston on the wall.")
    wrist_x: Annotated[list[float], FORCE] = Field(description="Of the rod on the piston.")
    wrist_y: Annotated[list[float], FORCE]
    crank_pin_x: Annotated[list[float], FORCE] = Field(description="Of the rod on the crank.")
    crank_pin_y: Annotated[list[float], FORCE]
    main_x: Annotated[list[float], FORCE] = Field(description="Of the crank with this rod alone on its bearings.")
    main_y: Annotated[list[float], FORCE]


class LumpedMasses(Answer):
    """Masses that stand for the rod and the throw of one cylinder (Norton, eq. 13.9-13.11)."""

    rod_crank_pin: Annotated[float, MASS] = Field(description="Of the rod as two masses at its pins.")
    rod_wrist_pin: Annotated[float, MASS]
    rod_inertia: Annotated[float, INERTIA] = Field(description="Moment of inertia of these two about their centre.")
    rod_inertia_error: Percent | None = optional("By how much that is more than the rod's, in percent of it.")
    percussion_distance: Length | None = optional("From the rod's centre to where the exact model's other mass is.")
    percussion_mass: Annotated[float, MASS] | None = optional("That mass, with which the inertia is right.")
    percussion_wrist_pin: Annotated[float, MASS] | None = optional("The exact model's mass at the wrist pin.")
    throw_crank_pin: Annotated[float, MASS] | None = optional("Of the throw as one mass at the crank pin.")
    throw_inertia: Annotated[float, INERTIA] | None = optional("Moment of inertia of that about the shaft.")
    throw_inertia_error: Percent | None = optional("By how much that is more than the throw's, in percent of it.")


class EngineMetrics(Answer):
    """What engines are ordered by: parts that no weight on the crankshaft balances, moments about the middle."""

    unevenness: Angle
    primary_force: float = Field(description="The part that turns against the crank, in units of m_B r ω².")
    primary_moment: float
    secondary_force: float = Field(description="Its greatest size, in units of m_B r ω² A₂.")
    secondary_moment: float
    torque: float = Field(description="The greatest of the first three harmonics, in units of one cylinder's.")
    binomial_terms: list[float] = Field(description="Of the root in the piston's place: λ²/2, λ⁴/8, λ⁶/16.")
    forces: EngineForces | None = optional("If masses or pressure are stated.")
    masses: LumpedMasses | None = optional("If masses are stated.")


class EngineDesign(Answer):
    """An engine with the proof of its harmonics and its firing."""

    mechanism: EngineMechanism
    verification: Verification
    metrics: EngineMetrics
    firing: EngineFiring
    harmonics: list[EngineHarmonic]
    balancers: list[Balancer]
    overbalance: Overbalance | None = optional("Of one cylinder with masses.")
    flywheel: EngineFlywheel | None = optional("If one is asked for.")
    course: EngineCourse | None = optional("If masses or pressure are stated.")


class EngineResult(Result[EngineDesign]):
    """Engines, the smoothest first."""

    count: int = Field(description="Arrangements of throws that there are; those that are alike count once.")
