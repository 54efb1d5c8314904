"""Answers to problems of ordinary gear trains."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from kinematics.gear.train import StageKind
from synthesis.model.answer import Answer, Result, Search, Verification, optional
from synthesis.model.dimension import Angle, Length
from synthesis.model.gear_answer import MeshGeometry, OfGears, Ratio
from synthesis.model.gear_stages import Hand
from synthesis.model.gear_strength import PairStrength


class Stage(Answer):
    """Two gears that mesh; the driven gear sits on the shaft of the next stage's driver."""

    driver: int = Field(description="Teeth of the driving gear.")
    driven: int = Field(description="Teeth of the driven gear.")
    module: Length = Field(description="Module in length units.")
    shift: OfGears | None = optional("Profile shift of both gears in modules, where teeth are fitted.")
    centre_distance: Length | None = optional("Distance of the shafts without play, where teeth are fitted.")
    face_width: Length | None = optional("The least with which the stage carries a stated power, or as stated.")
    type: StageKind | None = optional("Where the stages are stated by their types.")
    helix_angle: Angle | None = optional("Of a helical driver, positive for a right-handed one.")
    addendum: OfGears | None = optional("Of an internal pair, modules: the ring's teeth are shortened for the pinion.")
    shaft_angle: Angle | None = optional("Of bevel gears.")
    diameter_quotient: float | None = optional("Of a worm: its pitch diameter over its axial module.")
    hand: Hand | None = optional("Of a worm.")
    friction: float | None = optional("Between a worm and its gear.")


class Idler(Answer):
    """A gear between driver and driven gear of a stage: it turns the direction round and leaves the ratio as it is."""

    stage: int = Field(description="Number of the stage, from 1.")
    teeth: int


class GearTrainMechanism(Answer):
    """An ordinary train on fixed shafts, of external spur gears where its stages have no types."""

    type: Literal["gear_train"] = "gear_train"
    stages: list[Stage]
    idlers: list[Idler] = Field(default=[])
    ratio: Ratio
    pressure_angle: Angle = Field(default=20.0, description="Degrees.")


class TurningShaft(Answer):
    """A shaft from the input's on, and how it turns.

    Where shafts are not parallel the sign is that of the rotation about ``axis``, which points the way of the power; a
    bevel stage leads it away from the apex, and the axis of a worm gear is d × w, d the direction from the worm to the
    gear and w the axis of the worm. Another side of a bevel or worm gear turns the axis round, and with it the sign.
    """

    speed: Ratio = Field(description="Over the input's; negative: against it.")
    turns: Literal["same", "opposite"] | None = Field(
        description="As the input turns, or the other way; null where the shaft is not parallel with the input's."
    )
    axis: tuple[float, float, float] | None = optional(
        "About which the speed is counted, the input's along z; left out where all shafts are parallel."
    )


class GearTrainMetrics(Answer):
    """Measured properties of a train."""

    error: float = Field(description="Size of the ratio minus size of the demanded ratio.")
    relative_error: float = Field(description="The error over the size of the demanded ratio.")
    total_teeth: int = Field(description="Of drivers and driven gears, idlers not counted.")
    largest_gear: int
    largest_stage_ratio: float = Field(
        description="Larger over smaller gear, the greatest of all stages; of a worm stage gear teeth over threads."
    )
    hunting_tooth: bool = Field(description="The teeth of every mesh have no common divisor.")
    centre_distances: list[Length] = Field(description="Of the shafts of each stage, idlers in line.")
    meshes: list[MeshGeometry]
    strength: list[PairStrength] | None = optional("Stresses of every mesh, in their order, under a stated power.")
    shafts: list[TurningShaft] | None = optional("Where the stages are stated by their types.")


class GearTrainDesign(Answer):
    """A gear train with the proof of its ratio."""

    mechanism: GearTrainMechanism
    verification: Verification
    metrics: GearTrainMetrics


class ParetoTrain(Answer):
    """A train that none is both smaller and nearer than; with `strength` made as it carries the power."""

    size: int = Field(description="Sum of the teeth or largest gear, as the problem measures it.")
    relative_error: float
    stages: list[Stage]
    ratio: Ratio
    idlers: list[Idler] | None = optional("With `strength`, where the ratio takes one.")


class GearTrainSearch(Search):
    """The search of a finite set of trains.

    ``complete``: the ranking of the designs is proven, and an empty answer is a proof. It is false where an idler could
    not be found, where the distances that a mesh can have were searched in steps, and with `strength` where fewer
    trains than asked for carry the power and not every train was judged.
    ``candidates`` are the trains that stand out: the designs and those that verification refused. ``combinations`` is
    the number of trains that the search covers, most of them by bounds.
    """

    combinations: int
    ties: int = Field(
        description="Trains whose error is exactly that of the nearest one, of whatever size; with `strength` of "
        "the judged that carry the power."
    )
    least_error: float | None = Field(description="Relative error of the nearest train; null where there is none.")
    judged: int | None = optional(
        "With `strength`: how many trains were judged, the first of the ranking, about 1000 at most."
    )
    every_judged: bool | None = optional(
        "Whether there are no others: `ties` and `pareto` are then those of all trains that carry the power, otherwise "
        "of the judged that do."
    )


class GearTrainResult(Result[GearTrainDesign]):
    """Gear trains for a speed ratio."""

    search: GearTrainSearch
    pareto: list[ParetoTrain] = Field(
        description="The Pareto set of error against size, smallest first, of the trains within the tolerance "
        "(within 1 % where none is stated); with `strength` of the trains judged that carry the power."
    )
