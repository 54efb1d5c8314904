"""Trains in series as answers: the units, the overall ratio, and the measurements."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field

from synthesis.kinds.gear_train.design import GearTrainMechanism, GearTrainMetrics
from synthesis.kinds.planetary_train.design import PlanetaryMechanism, PlanetaryMetrics
from synthesis.model.answer import Answer, Result, Search, Verification
from synthesis.model.gears.answer import Ratio

UnitMechanism = Annotated[PlanetaryMechanism | GearTrainMechanism, Discriminator("type")]


class TrainSeriesMechanism(Answer):
    """Trains that drive one another, from the input to the output."""

    type: Literal["train_series"] = "train_series"
    units: list[UnitMechanism]
    ratio: Ratio


class TrainSeriesMetrics(Answer):
    """Measured properties of a series; those of its units are relative to the unit's own input."""

    error: float = Field(description="Relative error of the ratio, with its sign.")
    total_teeth: int = Field(description="Teeth of one copy of every gear, without idlers.")
    speeds: list[float] = Field(
        description="Speeds of the shafts relative to the input: the input, the shafts between units, the output."
    )
    efficiency: float | None = Field(
        description="Efficiency of all units, with the given efficiency of each mesh; null with ordinary gears, whose "
        "losses are reported by their analysis."
    )
    self_locking: bool = Field(description="Whether no input torque can drive the output.")
    units: list[PlanetaryMetrics | GearTrainMetrics]


class TrainSeriesDesign(Answer):
    """Trains in series with their verification."""

    mechanism: TrainSeriesMechanism
    verification: Verification
    metrics: TrainSeriesMetrics


class ParetoSeries(Answer):
    """A series that no other series beats in both size and error."""

    total_teeth: int
    error: float = Field(description="Relative error of the ratio, with its sign.")
    ratio: Ratio
    units: list[UnitMechanism]


class TrainSeriesSearch(Search):
    """The search of a finite set of series.

    ``candidates`` counts the designs and the series that verification refused. ``combinations`` is
    the number of series that the search covers, most of them by bounds.
    """

    combinations: int
    ties: int = Field(description="Number of series of any size whose error equals that of the nearest one.")
    least_error: float | None = Field(description="Relative error of the nearest series; null if there is none.")


class TrainSeriesResult(Result[TrainSeriesDesign]):
    """Trains in series, best first."""

    search: TrainSeriesSearch
    pareto: list[ParetoSeries] = Field(
        description="Pareto set of error against the number of teeth, smallest first, of the series within the "
        "tolerance (within 1 % by default)."
    )
