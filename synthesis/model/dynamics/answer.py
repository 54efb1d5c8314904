"""Models of the forces of a linkage in motion: arrays over the positions, with null where a force is unknown."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from synthesis.model.answer import Answer, optional_field
from synthesis.model.dimension import ANGLE, FORCE, LENGTH, OUTPUT, Dimension

Series = list[float | None]


class ForceSeries(Answer):
    """Components of a force over the positions."""

    x: Annotated[Series, FORCE]
    y: Annotated[Series, FORCE]


class SlideForces(Answer):
    """Force of a slide's line on the pin that moves along it."""

    joint: str
    normal: Annotated[Series, FORCE] = Field(
        description="Component along the slide's direction rotated by +90°; the opposite force acts on the line's link."
    )
    friction: Annotated[Series, FORCE] = Field(description="Component along the slide's direction.")


class GearTorques(Answer):
    """Torque of a gear pair on its second link; −ratio times this torque acts on the first link."""

    torque: Annotated[Series, Dimension.TORQUE]


class FrictionLosses(Answer):
    """Friction moments of the pins, and the power lost to all friction."""

    pins: dict[str, dict[str, Annotated[Series, Dimension.TORQUE]]] = Field(
        description="Friction moment of each pin on each of its links; a slide's block passes it to the line's link."
    )
    power: Series = Field(description="Power lost, never negative.")


class Shaking(Answer):
    """Sum of the mechanism's forces on the frame, and their moment about a point minus the drive's torque."""

    force: ForceSeries
    moment: Annotated[Series, Dimension.TORQUE]
    about: Annotated[tuple[float, float], LENGTH]


class DriveExtremes(Answer):
    """Maximum and minimum drive, refined between the positions; mean and rms over a closed cycle, otherwise null."""

    max: float | None
    at: Annotated[float | None, OUTPUT] = Field(description="Input angle (degrees) or position of the input slide.")
    min: float | None
    at_min: Annotated[float | None, OUTPUT]
    mean: float | None
    rms: float | None


class Peak(Answer):
    """Maximum magnitude, refined between the positions, and the input at which it occurs."""

    max: float | None
    at: Annotated[float | None, OUTPUT]


class Extremes(Answer):
    """Extremes over the motion."""

    drive: DriveExtremes
    joints: dict[str, Peak] = Field(description="Maximum force of each joint's pin on any of its links.")
    shaking_force: Peak
    shaking_moment: Peak


class Power(Answer):
    """Power of the drive: maximum magnitude, and mean over a closed cycle."""

    peak: float | None
    mean: float | None


class Pulse(Answer):
    """Range of the input over which the torque stays above or below its mean, and the area between both."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    start: Annotated[float, ANGLE] = Field(alias="from")
    end: Annotated[float, ANGLE] = Field(alias="to")
    area: float


class Flywheel(Answer):
    """Fluctuation of the drive over a cycle, and the flywheel that limits it; null without a closed cycle."""

    energy: float | None = Field(description="Maximum minus minimum energy drawn from the flywheel.")
    mean_torque: Annotated[float | None, Dimension.TORQUE]
    inertia: float | None = optional_field(
        "Required moment of inertia E/(k ω²) minus that of the shaft, to first order in the coefficient."
    )
    inertia_exact: float | None = optional_field(
        "Moment of inertia with exactly the requested coefficient, referred to the mean speed over time."
    )
    coefficient_exact: float | None = optional_field("Exact coefficient of fluctuation with `inertia`.")
    pulses: list[Pulse]


class Turning(Answer):
    """Harmonic of a vector: magnitudes of the parts that rotate with the input and against it."""

    forward: Annotated[float, FORCE]
    backward: Annotated[float, FORCE]


class Wave(Answer):
    """Harmonic of a torque or of the drive: amplitude · cos(order · input − phase)."""

    amplitude: float
    phase: Annotated[float, ANGLE]


class Harmonics(Answer):
    """Harmonics over a closed cycle by order, in periods per turn of the input; null without a closed cycle."""

    shaking_force: dict[str, Turning] | None
    shaking_moment: dict[str, Wave] | None
    drive: dict[str, Wave] | None


class BalanceChecks(Answer):
    """Maximum difference between results from reactions and from balances without reactions, as shares of the peaks."""

    virtual_work: float | None = Field(description="Drive from the reactions compared with the balance of energy.")
    momentum: float | None = Field(
        description="Shaking force and moment from the reactions compared with the balances of linear and angular "
        "momentum."
    )


Status = Literal[
    "ok", "not_assembled", "dead_centre", "load_undetermined", "stick", "friction_jam", "statically_indeterminate"
]


class DynamicsAnswer(Answer):
    """Forces over the motion, in the units of the request; null at positions whose `status` is not `ok` or `stick`.

    If the status is `statically_indeterminate`, constraints are redundant. Joint forces that are not unique are then
    null unless `minimum_norm` is requested; all others are given.
    """

    units: Literal["si", "consistent"]
    length_unit: Literal["mm", "cm", "m", "in"] = Field(
        description="Length unit of the request; with `si` units forces were computed in metres."
    )
    drive: Series | None = optional_field("Torque of the ground on the input link, or force along the input slide.")
    virtual_work_drive: Series | None = optional_field("The drive computed from the balance of energy.")
    joints: dict[str, dict[str, ForceSeries]] | None = optional_field("Force of each joint's pin on each of its links.")
    slides: list[SlideForces] | None = optional_field()
    gears: list[GearTorques] | None = optional_field()
    friction: FrictionLosses | None = optional_field("Given if the request contains `friction`.")
    shaking: Shaking | None = optional_field()
    extremes: Extremes
    power: Power
    flywheel: Flywheel | None = optional_field("Given if the request contains a `flywheel` or reports it.")
    harmonics: Harmonics | None = optional_field()
    joint_force_index: Series | None = optional_field(
        "Maximum joint force divided by the first load, without masses, springs and friction; per unit length if the "
        "load is a torque."
    )
    max_joint_force_index: float | None = optional_field(
        "Maximum joint force index over the motion; left out if a dead centre makes it infinite."
    )
    status: list[Status]
    checks: BalanceChecks
    warnings: list[str]
