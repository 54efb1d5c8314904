"""Gearboxes of machine tools as answers."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Result, Verification
from synthesis.model.dimension import Angle, Length, RotationalSpeed
from synthesis.model.gears.answer import GearPairTeeth


class GearboxStage(Answer):
    """The pairs between two neighbouring shafts, slowest first; all have the same tooth sum."""

    characteristic: int = Field(description="Steps of the progression from one pair to the next.")
    pairs: list[GearPairTeeth]
    centre_distance: Length


class GearboxMechanism(Answer):
    """A machine-tool gearbox: one pair of every stage is engaged at a time."""

    type: Literal["gearbox"] = "gearbox"
    formula: str = Field(description="Structural formula, stages in the order of the shafts, e.g. 3(1) 2(3).")
    input_speed: RotationalSpeed
    stages: list[GearboxStage]
    module: Length
    pressure_angle: Angle = Field(description="Pressure angle, degrees.")


class SpindleSpeed(Answer):
    """A speed of the spindle and its nominal value."""

    speed: RotationalSpeed
    nominal: RotationalSpeed
    error: float = Field(description="speed/nominal − 1.")
    standard: RotationalSpeed | None = Field(
        description="The rounded preferred number, if the speeds belong to a series."
    )
    engaged: list[int] = Field(description="The engaged pair of each stage, counted from 0.")


class ShaftSpeeds(Answer):
    """All speeds of one shaft, lowest first; the first shaft is the input."""

    shaft: int
    speeds: list[RotationalSpeed]


class GearboxMetrics(Answer):
    """Measured properties of a gearbox."""

    max_error: float = Field(description="Largest |ln(speed/nominal)|.")
    tooth_sum: int = Field(description="Sum of the tooth sums of all stages.")
    torque: float = Field(
        description="Input speed over lowest speed, summed over the shafts between input and spindle: a measure of "
        "their loads."
    )
    speeds: list[SpindleSpeed]
    shafts: list[ShaftSpeeds] = Field(description="Speeds of every shaft: the nodes of the ray diagram.")


class GearboxDesign(Answer):
    """A gearbox with the verification of its speeds."""

    mechanism: GearboxMechanism
    verification: Verification
    metrics: GearboxMetrics


class StructureVerdict(Answer):
    """A structure that was tried: its minimum error, or null if no teeth within the limits are feasible."""

    formula: str
    max_error: float | None
    tooth_sum: int | None = Field(description="The smallest tooth sum with that error.")


class GearboxResult(Result[GearboxDesign]):
    """Machine-tool gearboxes.

    The designs are the Pareto sets of error against tooth sum of all structures, in the order of the ranking.
    """

    progression_ratio: float
    structures: list[StructureVerdict]
