"""Answers to problems of ordinary gear trains."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from kinematics.gear.train import StageKind
from synthesis.model.answer import Answer, Result, Search, Verification, optional_field
from synthesis.model.dimension import Angle, Length
from synthesis.model.gears.answer import GearNumbers, MeshGeometry, Ratio
from synthesis.model.gears.stages import Hand
from synthesis.model.gears.strength import PairStrength


class Stage(Answer):
    """Two gears that mesh; the driven gear sits on the shaft of the next stage's driver."""

    driver: int = Field(description="Teeth of the driving gear.")
    driven: int = Field(description="Teeth of the driven gear.")
    module: Length = Field(description="Module in length units.")
    shift: GearNumbers | None = optional_field("Profile shift of both gears in modules, if teeth are fitted.")
    centre_distance: Length | None = optional_field("Distance of the shafts without play, if teeth are fitted.")
    face_width: Length | None = optional_field("Smallest face width that carries the given power, or the given one.")
    type: StageKind | None = optional_field("Type of the stage, if the stages are given by type.")
    helix_angle: Angle | None = optional_field("Helix angle of a helical driver, positive for a right-handed one.")
    addendum: GearNumbers | None = optional_field(
        "Addenda of an internal pair in modules: the ring's teeth are shortened for the pinion."
    )
    shaft_angle: Angle | None = optional_field("Angle between the shafts of bevel gears.")
    diameter_quotient: float | None = optional_field("Pitch diameter of a worm over its axial module.")
    hand: Hand | None = optional_field("Hand of a worm.")
    friction: float | None = optional_field("Coefficient of friction between a worm and its gear.")


class Idler(Answer):
    """A gear between driver and driven gear of a stage: it reverses the direction and does not change the ratio."""

    stage: int = Field(description="Number of the stage, from 1.")
    teeth: int


class GearTrainMechanism(Answer):
    """An ordinary train on fixed shafts; of external spur gears if its stages have no types."""

    type: Literal["gear_train"] = "gear_train"
    stages: list[Stage]
    idlers: list[Idler] = Field(default=[])
    ratio: Ratio
    pressure_angle: Angle = Field(default=20.0, description="Pressure angle, degrees.")


class TurningShaft(Answer):
    """A shaft, counted from the input's on, and its rotation.

    If the shafts are not parallel the sign is that of the rotation about ``axis``, which points in the direction of the
    power flow. A bevel stage leads the axis away from the apex. The axis of a worm gear is d × w, with d the direction
    from the worm to the gear and w the axis of the worm. Placing a bevel or worm gear on the other side reverses the
    axis, and with it the sign.
    """

    speed: Ratio = Field(description="Speed over the input's; negative: opposite to it.")
    turns: Literal["same", "opposite"] | None = Field(
        description="Rotation relative to the input's; null if the shaft is not parallel to the input's."
    )
    axis: tuple[float, float, float] | None = optional_field(
        "Axis about which the speed is counted, the input's along z; omitted if all shafts are parallel."
    )


class GearTrainMetrics(Answer):
    """Measured properties of a train."""

    error: float = Field(description="Size of the ratio minus size of the requested ratio.")
    relative_error: float = Field(description="Error over the size of the requested ratio.")
    total_teeth: int = Field(description="Teeth of drivers and driven gears, without idlers.")
    largest_gear: int
    largest_stage_ratio: float = Field(
        description="Greatest ratio of larger over smaller gear of any stage; for a worm stage gear teeth over threads."
    )
    hunting_tooth: bool = Field(description="Whether the teeth of every mesh have no common divisor.")
    centre_distances: list[Length] = Field(description="Distance of the shafts of each stage, with idlers in line.")
    meshes: list[MeshGeometry]
    strength: list[PairStrength] | None = optional_field("Stresses of every mesh in order, under the given power.")
    shafts: list[TurningShaft] | None = optional_field("Rotation of the shafts, if the stages are given by type.")


class GearTrainDesign(Answer):
    """A gear train with the verification of its ratio."""

    mechanism: GearTrainMechanism
    verification: Verification
    metrics: GearTrainMetrics


class ParetoTrain(Answer):
    """A train that no other train beats in both size and error; with `strength`, in the form that carries the power."""

    size: int = Field(description="Sum of the teeth or largest gear, as chosen by the problem's `size`.")
    relative_error: float
    stages: list[Stage]
    ratio: Ratio
    idlers: list[Idler] | None = optional_field("With `strength`, if the ratio requires an idler.")


class GearTrainSearch(Search):
    """The search of a finite set of trains.

    ``complete``: the ranking of the designs is proven, and an empty answer is a proof. It is false if an idler could
    not be found, if the distances that a mesh can have were searched in steps, and with `strength` if fewer
    trains than requested carry the power and not every train was judged.
    ``candidates`` counts the designs and the trains that verification refused. ``combinations`` is
    the number of trains that the search covers, most of them by bounds.
    """

    combinations: int
    ties: int = Field(
        description="Number of trains of any size whose error equals that of the nearest one; with `strength`, among "
        "the judged trains that carry the power."
    )
    least_error: float | None = Field(description="Relative error of the nearest train; null if there is none.")
    judged: int | None = optional_field(
        "With `strength`: number of trains judged, in the order of the ranking; at most about 1000."
    )
    every_judged: bool | None = optional_field(
        "With `strength`: true if all trains were judged, so that `ties` and `pareto` refer to all trains that carry "
        "the power; otherwise they refer to the judged ones only."
    )


class GearTrainResult(Result[GearTrainDesign]):
    """Gear trains for a speed ratio."""

    search: GearTrainSearch
    pareto: list[ParetoTrain] = Field(
        description="Pareto set of error against size, smallest first, of the trains within the tolerance (within 1 % "
        "by default); with `strength`, of the judged trains that carry the power."
    )
