"""Layshaft gearboxes of vehicles as answers."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Result, Verification
from synthesis.model.dimension import Angle, Length
from synthesis.model.gears.answer import GearPairTeeth, Ratio


class LayshaftGear(Answer):
    """A forward gear; without teeth it is the direct drive."""

    layshaft: int | None
    mainshaft: int | None
    ratio: Ratio


class ReverseGear(Answer):
    """The reverse gear with its idler."""

    layshaft: int
    idler: int
    mainshaft: int
    ratio: Ratio


class LayshaftMechanism(Answer):
    """A layshaft gearbox of a vehicle."""

    type: Literal["layshaft_gearbox"] = "layshaft_gearbox"
    head: GearPairTeeth = Field(description="Pair from the input shaft to the layshaft.")
    gears: list[LayshaftGear]
    reverse: ReverseGear | None
    module: Length
    pressure_angle: Angle = Field(description="Pressure angle, degrees.")
    centre_distance: Length


class LayshaftMetrics(Answer):
    """Measured properties of a layshaft gearbox."""

    max_error: float = Field(description="Largest relative error of a gear.")
    errors: list[float] = Field(description="Relative error of each forward gear, with its sign; reverse comes last.")
    tooth_sum: int
    interfering: list[GearPairTeeth] = Field(
        description="Pairs whose standard teeth interfere; they need a profile shift."
    )
    contact_ratios: list[float] = Field(
        description="Contact ratios of the head pair, the forward gears with teeth, and the two meshes of reverse."
    )


class LayshaftDesign(Answer):
    """A layshaft gearbox with the verification of its ratios."""

    mechanism: LayshaftMechanism
    verification: Verification
    metrics: LayshaftMetrics


class ParetoLayshaft(Answer):
    """The minimum error at a tooth sum, if no smaller sum reaches it."""

    tooth_sum: int
    max_error: float
    head: GearPairTeeth


class LayshaftResult(Result[LayshaftDesign]):
    """Layshaft gearboxes, best first."""

    pareto: list[ParetoLayshaft] = Field(description="The Pareto set of error against tooth sum, smallest first.")
