"""The analysis of trains in series: each unit as its own family tells it, and the shafts between them."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Discriminator, Field

from kinematics.gear.planetary import speed_ratio
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family, TurningPart
from synthesis.analyses.drift import WANTED, Drift, drifting
from synthesis.analyses.gear_train import GearTrainAnalysis, GearTrainAnalysisRequest, GivenGearTrain
from synthesis.analyses.planetary_train import GivenPlanetaryTrain, PlanetaryAnalysis, PlanetaryAnalysisRequest
from synthesis.model.answer import optional
from synthesis.model.gear_answer import Ratio
from synthesis.model.gear_statement import ExactRatio
from synthesis.model.statement import Number, Statement

GivenUnit = Annotated[GivenPlanetaryTrain | GivenGearTrain, Discriminator("type")]


class GivenTrainSeries(Statement):
    """Trains that drive one another, as in a design; planetary units with their input, output and fixed member."""

    type: Literal["train_series"]
    units: list[GivenUnit] = Field(min_length=1, max_length=8)
    ratio: Any = None


class TrainSeriesAnalysisRequest(DrivenRequest[GivenTrainSeries]):
    """Trains in series, how their input turns, and what it carries."""

    model_config = ConfigDict(
        title="Trains in series, how they are driven",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "train_series",
                        "units": [
                            {
                                "type": "planetary_train",
                                "arrangement": "simple",
                                "teeth": {"sun": 18, "planet": 27, "ring": 72},
                                "input": "sun",
                                "output": "carrier",
                                "fixed": "ring",
                            },
                            {"type": "gear_train", "stages": [{"driver": 20, "driven": 60, "module": 2.0}]},
                        ],
                    },
                    "motion": {"at": 0.0, "speed_rpm": 1500.0},
                    "input_torque": 20.0,
                }
            ]
        },
    )

    length_unit: Literal["mm", "cm", "m", "in"] = "mm"
    input_torque: Number = Field(default=1.0, description="Torque on the first input, N m.")
    mesh_efficiency: Annotated[float, Field(strict=True, gt=0.5, le=1.0)] = Field(
        default=0.99, description="Of every mesh as an ordinary pair."
    )
    wanted_ratio: ExactRatio | None = Field(default=None, description=WANTED)

    def faults(self) -> list[tuple[str, str]]:
        """What no single field shows; faults of a unit are told at it."""
        faults = super().faults()
        if faults:
            return faults
        for k, unit in enumerate(self.mechanism.units):
            if isinstance(unit, GivenPlanetaryTrain):
                own = unit.faults()
                named = [part for part in ("input", "output", "fixed") if getattr(unit, part) is None]
                own += [(f"/mechanism/{part}", "state it") for part in named]
                if not own:
                    own = PlanetaryAnalysisRequest(mechanism=unit).faults()
                if not own and _planetary_ratio(unit) is None:
                    own = [("/mechanism", "with these members the train does not pass its motion on")]
            else:
                own = GearTrainAnalysisRequest(mechanism=unit).faults()
            faults += [(f"/mechanism/units/{k}{path.removeprefix('/mechanism')}", detail) for path, detail in own]
        return faults

    def answer(self) -> dict[str, Any]:
        """Everything about the series, in the shape of :class:`TrainSeriesAnalysis`."""
        return _analysis(self)


class SeriesShaft(TurningPart):
    """The input, a shaft between two units, or the output."""

    torque: float | None = Field(description="N m that it passes on; null where losses before it are not known.")


class TrainSeriesAnalysis(DrivenAnalysis):
    """What the analysis core knows of trains in series.

    Every unit is told by its own family for its own input at speed 1 and torque 1; multiplied by the speed ratio and
    the torque of the shaft that drives it, its speeds and torques are those in the series.
    """

    valid: list[bool]
    ratio: Ratio
    efficiency: float | None = Field(description="Output power over input power.")
    self_locking: bool = Field(description="The input cannot drive the output, whatever its torque.")
    shafts: list[SeriesShaft] = Field(description="The input, the shafts between the units, the output.")
    units: list[PlanetaryAnalysis | GearTrainAnalysis] = Field(
        description="In the order of the power, for one position of the own input."
    )
    drift: Drift | None = optional("Where a ratio is wanted, and the series turns its way.")


def _planetary_ratio(unit: GivenPlanetaryTrain) -> Fraction | None:
    return speed_ratio(unit.train(), str(unit.input), str(unit.output), [str(unit.fixed)])


def _analysis(request: TrainSeriesAnalysisRequest) -> dict[str, Any]:
    at, speed, time = request.motion.inputs()
    share, torque = Fraction(1), request.input_torque
    shafts = [{"speed_ratio": 1.0, "torque": torque, **request.motion.geared(1.0, at, speed)}]
    units: list[dict[str, Any]] = []
    efficiencies: list[float | None] = []
    for unit in request.mechanism.units:
        stated = {"mechanism": unit, "motion": {"at": 0.0}, "mesh_efficiency": request.mesh_efficiency}
        if isinstance(unit, GivenPlanetaryTrain):
            told = PlanetaryAnalysisRequest.model_validate(stated).answer()
            ratio = _planetary_ratio(unit)
            assert ratio is not None
        else:
            told = GearTrainAnalysisRequest.model_validate({**stated, "length_unit": request.length_unit}).answer()
            ratio = unit.train().ratio
        units.append(told)
        efficiencies.append(told["efficiency"])
        share /= ratio
        turning = float(share)
        known = all(one is not None for one in efficiencies)
        passed = math.prod(one for one in efficiencies if one is not None)
        shafts.append(
            {
                "speed_ratio": turning,
                "torque": request.input_torque * passed / turning if known else None,
                **request.motion.geared(turning, at, speed),
            }
        )
    known = all(one is not None for one in efficiencies)
    return {
        "input_angle": at.tolist(),
        "time": None if time is None else time.tolist(),
        "valid": [True] * len(at),
        "ratio": Ratio.of(1 / share).model_dump(),
        "efficiency": math.prod(one for one in efficiencies if one is not None) if known else None,
        "self_locking": any(told.get("self_locking") for told in units),
        "shafts": shafts,
        "units": units,
        **drifting(1 / share, request.wanted_ratio),
    }


FAMILY = Family(TrainSeriesAnalysisRequest, TrainSeriesAnalysis)
