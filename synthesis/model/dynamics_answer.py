"""Forces of a linkage in motion, as an answer has them: arrays over the positions, null where there are none."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from synthesis.model.answer import Answer, optional
from synthesis.model.dimension import ANGLE, FORCE, LENGTH, OUTPUT, Dimension

Series = list[float | None]


class ForceSeries(Answer):
    """Components of a force over the positions."""

    x: Annotated[Series, FORCE]
    y: Annotated[Series, FORCE]


class SlideForces(Answer):
    """What the line of a slide does to the pin on it."""

    joint: str
    normal: Annotated[Series, FORCE] = Field(
        description="Along the slide's direction turned by +90°; the opposite acts on the line's link."
    )
    friction: Annotated[Series, FORCE] = Field(description="Along the slide's direction.")


class GearTorques(Answer):
    """The torque that a gear pair puts on its second link; −ratio times that acts on the first."""

    torque: Annotated[Series, Dimension.TORQUE]


class Rubbing(Answer):
    """Friction of the pins, and what all friction takes."""

    pins: dict[str, dict[str, Annotated[Series, Dimension.TORQUE]]] = Field(
        description="Moment of each pin's friction on each of its links; a slide's block hands it to the line's link."
    )
    power: Series = Field(description="Power lost, never negative.")


class Shaking(Answer):
    """Sum of the forces of the mechanism on the frame, and their moment about a point less the drive's torque."""

    force: ForceSeries
    moment: Annotated[Series, Dimension.TORQUE]
    about: Annotated[tuple[float, float], LENGTH]


class DriveExtremes(Answer):
    """Greatest and least drive, refined between the positions; mean and rms over a closed cycle, else null."""

    max: float | None
    at: Annotated[float | None, OUTPUT] = Field(description="Input angle (degrees) or place of the input slide.")
    min: float | None
    at_min: Annotated[float | None, OUTPUT]
    mean: float | None
    rms: float | None


class Peak(Answer):
    """The greatest magnitude, refined between the positions, and the input at which it stands."""

    max: float | None
    at: Annotated[float | None, OUTPUT]


class Extremes(Answer):
    """Extremes over the motion."""

    drive: DriveExtremes
    joints: dict[str, Peak] = Field(description="Of the largest force of each joint's pin on one of its links.")
    shaking_force: Peak
    shaking_moment: Peak


class Power(Answer):
    """Drive times speed of the input: greatest magnitude, and mean over a closed cycle."""

    peak: float | None
    mean: float | None


class Pulse(Answer):
    """Where the torque stays above its mean, or below, and the area between both."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    start: Annotated[float, ANGLE] = Field(alias="from")
    end: Annotated[float, ANGLE] = Field(alias="to")
    area: float


class Flywheel(Answer):
    """Fluctuation of the drive over a cycle, and the flywheel that evens the speed; null without a closed cycle."""

    energy: float | None = Field(description="Largest less smallest energy taken from the flywheel.")
    mean_torque: Annotated[float | None, Dimension.TORQUE]
    inertia: float | None = optional("E/(k ω²), less what the shaft has; to first order in the coefficient.")
    inertia_exact: float | None = optional("Of which the coefficient is exact, by the speed's mean over time.")
    coefficient_exact: float | None = optional("That of `inertia`.")
    pulses: list[Pulse]


class Turning(Answer):
    """A harmonic of a vector: magnitudes of the parts that turn with the input and against it."""

    forward: Annotated[float, FORCE]
    backward: Annotated[float, FORCE]


class Wave(Answer):
    """A harmonic of a torque (or of the drive): amplitude · cos(order · input − phase)."""

    amplitude: float
    phase: Annotated[float, ANGLE]


class Harmonics(Answer):
    """Harmonics over a closed cycle by their order, in periods a turn of the input; null without a closed cycle."""

    shaking_force: dict[str, Turning] | None
    shaking_moment: dict[str, Wave] | None
    drive: dict[str, Wave] | None


class BalanceChecks(Answer):
    """Largest disagreement of the reactions with balances that know none, as shares of the peaks."""

    virtual_work: float | None = Field(description="Drive by reactions against the balance of energy.")
    momentum: float | None = Field(
        description="Shaking force and moment by reactions against the balances of momentum and angular momentum."
    )


Status = Literal[
    "ok", "not_assembled", "dead_centre", "load_undetermined", "stick", "friction_jam", "statically_indeterminate"
]


class DynamicsAnswer(Answer):
    """Forces over the motion, in the units of the request; null where `status` is neither `ok` nor `stick`.

    Where it is `statically_indeterminate` constraints are redundant: null are the forces in joints that are not unique,
    unless `minimum_norm` is stated; all others stand.
    """

    units: Literal["si", "consistent"]
    length_unit: Literal["mm", "cm", "m", "in"] = Field(
        description="Of the request's lengths; forces of `si` were formed in metres."
    )
    drive: Series | None = optional("Torque of the ground on the input link, or force along the input slide.")
    virtual_work_drive: Series | None = optional("The same from the balance of energy.")
    joints: dict[str, dict[str, ForceSeries]] | None = optional("Force of each joint's pin on each of its links.")
    slides: list[SlideForces] | None = optional()
    gears: list[GearTorques] | None = optional()
    friction: Rubbing | None = optional("If the request states `friction`.")
    shaking: Shaking | None = optional()
    extremes: Extremes
    power: Power
    flywheel: Flywheel | None = optional("If the request states a `flywheel` or wants it reported.")
    harmonics: Harmonics | None = optional()
    joint_force_index: Series | None = optional(
        "Largest force in a joint over the first load, without masses, springs and friction; per length of a torque."
    )
    max_joint_force_index: float | None = optional("Its largest value; left out where a dead centre makes it infinite.")
    status: list[Status]
    checks: BalanceChecks
    warnings: list[str]
