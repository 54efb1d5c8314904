"""Analysis of trains in series: each unit by the analysis of its own family, and the shafts between the units."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import ConfigDict, Discriminator, Field

from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family, TurningPart
from synthesis.analyses.gears.drift import WANTED_DESCRIPTION, Drift, describe_drift
from synthesis.analyses.gears.gear_train import GearTrainAnalysis, GearTrainAnalysisRequest
from synthesis.analyses.gears.given_planetary_train import GivenPlanetaryTrain
from synthesis.analyses.gears.given_train import GivenGearTrain, GivenRatio
from synthesis.analyses.gears.planetary_train import PlanetaryAnalysis, PlanetaryAnalysisRequest
from synthesis.model.answer import optional_field
from synthesis.model.gears.answer import Ratio
from synthesis.model.gears.request import ExactRatio
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Number, Statement

MISSING_MEMBERS = {
    "input": "analyses-unit-needs-input",
    "output": "analyses-unit-needs-output",
    "fixed": "analyses-unit-needs-fixed-member",
}
"""Ids of the messages about members that a planetary unit lacks, by the fields of the members."""

GivenUnit = Annotated[GivenPlanetaryTrain | GivenGearTrain, Discriminator("type")]


class GivenTrainSeries(Statement):
    """Trains that drive one another, as in a design; planetary units with their input, output and fixed member."""

    type: Literal["train_series"]
    units: list[GivenUnit] = Field(min_length=1, max_length=8)
    ratio: GivenRatio | None = Field(
        default=None, description="Ratio, as in a design; compared with the ratio of the teeth."
    )

    def compute_ratio(self) -> Fraction:
        """Compute the ratio of the input speed of the first unit to the output speed of the last, for valid units."""
        return math.prod((compute_unit_ratio(unit) for unit in self.units), start=Fraction(1))


def compute_unit_ratio(unit: GivenGearTrain | GivenPlanetaryTrain) -> Fraction:
    """Compute the ratio of input speed to output speed of a unit that transmits motion."""
    ratio = unit.compute_ratio() if isinstance(unit, GivenPlanetaryTrain) else unit.build_train().ratio
    assert ratio is not None
    return ratio


class TrainSeriesAnalysisRequest(DrivenRequest[GivenTrainSeries]):
    """Trains in series, the motion of their input, and their load."""

    model_config = ConfigDict(
        title="Trains in series: speeds and torques",
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
    input_torque: Number = Field(
        default=1.0,
        description="Torque on the first input, N·m. If it is opposite to the speed at the first position, the output "
        "drives.",
    )
    mesh_efficiency: Annotated[float, Field(strict=True, gt=0.5, le=1.0)] = Field(
        default=0.99,
        description="Efficiency of every mesh as an ordinary pair, except worms, which have their own friction.",
    )
    wanted_ratio: ExactRatio | None = Field(default=None, description=WANTED_DESCRIPTION)

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find. Errors of a unit have the unit's path."""
        faults = super().find_errors()
        if faults:
            return faults
        for k, unit in enumerate(self.mechanism.units):
            if isinstance(unit, GivenPlanetaryTrain):
                own = unit.find_errors()
                named = [part for part in MISSING_MEMBERS if getattr(unit, part) is None]
                own += [(f"/mechanism/{part}", compose(MISSING_MEMBERS[part])) for part in named]
                if not own:
                    # Examine speeds only after the fields, because the equations need valid members.
                    own = PlanetaryAnalysisRequest(mechanism=unit).find_errors()
                if not own and unit.compute_ratio() is None:
                    own = [("/mechanism", compose("analyses-unit-transmits-no-motion"))]
            else:
                # Worms lose power by their own friction; other meshes by the given efficiency.
                driving = GearTrainAnalysisRequest(
                    mechanism=unit, input_torque=_choose_torque(self.has_backward_flow), friction=0.0
                )
                own = driving.find_errors()
            faults += [(f"/mechanism/units/{k}{path.removeprefix('/mechanism')}", detail) for path, detail in own]
        if not faults and self.mechanism.ratio is not None:
            faults += self.mechanism.ratio.find_errors(self.mechanism.compute_ratio())
        return faults

    @property
    def has_backward_flow(self) -> bool:
        """Whether power leaves at the input at the first position, so that the output drives."""
        return self.input_torque * float(self.motion.list_inputs()[1][0]) < 0.0

    def build_answer(self) -> JsonObject:
        """Build the answer for the series, in the form of :class:`TrainSeriesAnalysis`."""
        return _analyze_series(self)


class SeriesShaft(TurningPart):
    """The input, a shaft between two units, or the output."""

    torque: float | None = Field(
        description="Torque, N·m, including the losses between the input and this shaft; null if the losses are "
        "unknown, or if no torque on the output can drive the input.",
    )


class TrainSeriesAnalysis(DrivenAnalysis):
    """Analysis of trains in series.

    Every unit is analysed by its own family, with its own input at speed 1 and torque 1 (−1 if the output drives). In
    the series, multiply its speeds by the speed ratio of its input, and its torques by the torque at its input divided
    by the torque of its own analysis there.
    """

    valid: list[bool]
    ratio: Ratio
    efficiency: float | None = Field(description="Output power over input power.")
    self_locking: bool = Field(description="Whether the driving end cannot turn the other end at any torque.")
    shafts: list[SeriesShaft] = Field(description="The input, the shafts between the units, the output.")
    units: list[PlanetaryAnalysis | GearTrainAnalysis] = Field(
        description="Units in the order of the power flow, each for one position of its own input."
    )
    drift: Drift | None = optional_field("Given if a required ratio is given.")


def _analyze_series(request: TrainSeriesAnalysisRequest) -> JsonObject:
    at, speed, time = request.motion.list_inputs()
    share, power = Fraction(1), 1.0
    back = request.has_backward_flow
    shafts = [{"speed_ratio": 1.0, "torque": request.input_torque, **request.motion.drive_geared(1.0, at, speed)}]
    units: list[JsonObject] = []
    known = True
    for unit in request.mechanism.units:
        unit_answer = _analyze_unit(request, unit, back)
        units.append(unit_answer)
        # The ratio of a unit is input speed over output speed; the speed ratio of a shaft is the inverse.
        share /= compute_unit_ratio(unit)
        passed = unit_answer["efficiency"]
        # If the output drives, more power enters there than leaves at the input.
        known = known and passed is not None and not (back and passed == 0.0)
        # Once a unit's efficiency is unknown, so are the torques on all later shafts.
        if known:
            power *= 1.0 / passed if back else passed
        turning = float(share)
        shafts.append(
            {
                "speed_ratio": turning,
                # Torque is power over speed, with the power in units of the input's.
                "torque": request.input_torque * power / turning if known else None,
                **request.motion.drive_geared(turning, at, speed),
            }
        )
    efficiencies = [unit_answer["efficiency"] for unit_answer in units]
    return {
        "input_angle": at.tolist(),
        "time": None if time is None else time.tolist(),
        "valid": [True] * len(at),
        "ratio": Ratio.from_fraction(1 / share).model_dump(),
        "efficiency": None if None in efficiencies else math.prod(efficiencies),
        "self_locking": any(unit_answer.get("self_locking") for unit_answer in units),
        "shafts": shafts,
        "units": units,
        **describe_drift(1 / share, request.wanted_ratio),
    }


def _choose_torque(back: bool) -> float:
    """Return the torque on the input of a unit that is analyzed alone: 1, or −1 if the output drives."""
    return -1.0 if back else 1.0


def _analyze_unit(
    request: TrainSeriesAnalysisRequest, unit: GivenGearTrain | GivenPlanetaryTrain, back: bool
) -> JsonObject:
    """Analyze a unit alone, with its input at speed 1 and torque 1, or −1 if the output drives."""
    torque = _choose_torque(back)
    stated: JsonObject = {
        "mechanism": unit, "motion": {"at": 0.0}, "mesh_efficiency": request.mesh_efficiency,
    }  # fmt: skip
    if isinstance(unit, GivenPlanetaryTrain):
        stated["torques"] = {str(unit.input): torque}
        return PlanetaryAnalysisRequest.model_validate(stated).build_answer()
    stated |= {"length_unit": request.length_unit, "input_torque": torque}
    return GearTrainAnalysisRequest.model_validate(stated).build_answer()


FAMILY = Family(TrainSeriesAnalysisRequest, TrainSeriesAnalysis)
