"""Trains in series as answers: the units, the ratio of all of them, and what was measured."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field

from synthesis.kinds.gear_train.design import GearTrainMechanism, GearTrainMetrics
from synthesis.kinds.planetary_train.design import PlanetaryMechanism, PlanetaryMetrics
from synthesis.model.answer import Answer, Result, Search, Verification
from synthesis.model.gear_answer import Ratio

UnitMechanism = Annotated[PlanetaryMechanism | GearTrainMechanism, Discriminator("type")]


class TrainSeriesMechanism(Answer):
    """Trains that drive one another, from the input to the output."""

    type: Literal["train_series"] = "train_series"
    units: list[UnitMechanism]
    ratio: Ratio


class TrainSeriesMetrics(Answer):
    """Measured properties of a series; those of its units have the unit's own input for 1."""

    error: float = Field(description="Relative error of the ratio, with its sign.")
    total_teeth: int = Field(description="Of one copy of every gear; idlers not counted.")
    speeds: list[float] = Field(
        description="Of the shafts where the input has 1: the input, between units, the output."
    )
    efficiency: float | None = Field(
        description="Of all units, with the stated efficiency of each mesh; null with ordinary gears, whose losses are "
        "told by their analysis."
    )
    self_locking: bool = Field(description="The input cannot drive the output, whatever its torque.")
    units: list[PlanetaryMetrics | GearTrainMetrics]


class TrainSeriesDesign(Answer):
    """Trains in series with the proof of what they do."""

    mechanism: TrainSeriesMechanism
    verification: Verification
    metrics: TrainSeriesMetrics


class ParetoSeries(Answer):
    """A series that none is both smaller and nearer than."""

    total_teeth: int
    error: float = Field(description="Relative error of the ratio, with its sign.")
    ratio: Ratio
    units: list[UnitMechanism]


class TrainSeriesSearch(Search):
    """The search of a finite set of series.

    ``candidates`` are the series that stand out: the designs and those that verification refused. ``combinations`` is
    the number of series that the search covers, most of them by bounds.
    """

    combinations: int
    ties: int = Field(description="Series whose error is exactly that of the nearest one, whatever their size.")
    least_error: float | None = Field(description="Relative error of the nearest series; null where there is none.")


class TrainSeriesResult(Result[TrainSeriesDesign]):
    """Trains in series, best first."""

    search: TrainSeriesSearch
    pareto: list[ParetoSeries] = Field(
        description="The Pareto set of error against the number of teeth, smallest first, of the series within the "
        "tolerance (within 1 % where none is stated)."
    )
