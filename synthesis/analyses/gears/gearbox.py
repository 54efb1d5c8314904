"""Analyses of gearboxes: speeds of all shafts with the given pairs engaged, and all possible output speeds."""

from __future__ import annotations

from fractions import Fraction
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.arrays import Real
from kinematics.gear.gearbox import compute_layshaft_ratios, list_spindle_speeds
from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family, TurningPart
from synthesis.model.answer import Answer
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Statement

ToothCount = Annotated[int, Field(strict=True, ge=1, le=10_000)]
Place = Annotated[int, Field(strict=True, ge=0, le=20)]


class GivenPair(Statement):
    """Teeth of a pair of gears."""

    driver: ToothCount
    driven: ToothCount


class GivenGearboxStage(Statement):
    """The pairs between two neighbouring shafts."""

    pairs: list[GivenPair] = Field(min_length=1, max_length=6)
    characteristic: object = None
    centre_distance: object = None


class GivenGearbox(Statement):
    """A machine-tool gearbox; the other fields of a design are optional."""

    type: Literal["gearbox"]
    stages: list[GivenGearboxStage] = Field(min_length=1, max_length=6)
    formula: object = None
    input_speed: object = None
    module: object = None
    pressure_angle: object = None

    def list_teeth(self) -> list[list[tuple[int, int]]]:
        """List tooth numbers by stage and pair."""
        return [[(pair.driver, pair.driven) for pair in stage.pairs] for stage in self.stages]


class GivenLayshaftGear(Statement):
    """A forward gear; without teeth it is direct drive."""

    layshaft: ToothCount | None = None
    mainshaft: ToothCount | None = None
    ratio: object = None


class GivenReverseGear(Statement):
    """The reverse gear with its idler."""

    layshaft: ToothCount
    idler: ToothCount
    mainshaft: ToothCount
    ratio: object = None


class GivenLayshaftGearbox(Statement):
    """A layshaft gearbox of a vehicle."""

    type: Literal["layshaft_gearbox"]
    head: GivenPair
    gears: list[GivenLayshaftGear] = Field(min_length=1, max_length=12)
    reverse: GivenReverseGear | None = None
    module: object = None
    pressure_angle: object = None
    centre_distance: object = None


class TurningShaft(TurningPart):
    """A shaft and its motion."""

    name: str


class EngagedSpeed(Answer):
    """A choice of engaged pairs, or a gear by its number from 0 with reverse last, and the output speed it gives."""

    engaged: list[int]
    speed_ratio: float = Field(description="Output speed over input speed.")
    exact_speed_ratio: str


class GearboxAnalysis(DrivenAnalysis):
    """Analysis of a gearbox with given pairs engaged."""

    valid: list[bool]
    engaged: list[int]
    shafts: list[TurningShaft]
    speeds: list[EngagedSpeed] = Field(description="All combinations that can be engaged, slowest output first.")


class GearboxAnalysisRequest(DrivenRequest[GivenGearbox]):
    """A machine-tool gearbox, the pairs that are engaged, and how the input turns."""

    model_config = ConfigDict(
        title="Gearbox: speeds and torques",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "gearbox",
                        "stages": [
                            {"pairs": [{"driver": 24, "driven": 96}, {"driver": 80, "driven": 40}]},
                            {"pairs": [{"driver": 30, "driven": 60}, {"driver": 45, "driven": 45}]},
                        ],
                    },
                    "engaged": [1, 0],
                    "motion": {"at": 0.0, "speed_rpm": 200.0},
                }
            ]
        },
    )

    engaged: list[Place] | None = Field(
        default=None, max_length=6, description="Engaged pair of each stage, from 0; null: the first pair of each."
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults = super().find_errors()
        stages = self.mechanism.stages
        if self.engaged is not None and len(self.engaged) != len(stages):
            faults.append(("/engaged", compose("analyses-one-pair-per-stage", count=len(stages))))
        for k, (at, stage) in enumerate(zip(self.engaged or (), stages, strict=False)):
            if at >= len(stage.pairs):
                faults.append(
                    (f"/engaged/{k}", compose("analyses-stage-has-fewer-pairs", number=k + 1, count=len(stage.pairs)))
                )
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer for the gearbox, in the form of :class:`GearboxAnalysis`."""
        at, speed, time = self.motion.list_inputs()
        stages = self.mechanism.list_teeth()
        engaged = self.engaged or [0] * len(stages)
        ratios, total = [("input", Fraction(1))], Fraction(1)
        for k, (pairs, place) in enumerate(zip(stages, engaged, strict=True), 2):
            total *= -Fraction(*pairs[place])
            ratios.append((f"shaft {k}" if k <= len(stages) else "spindle", total))
        sign = (-1) ** len(stages)
        speeds = [(list(box_speeds.engaged), sign * box_speeds.speed) for box_speeds in list_spindle_speeds(1, stages)]
        return _build_answer(self, at, speed, time, engaged, ratios, speeds)


class LayshaftAnalysisRequest(DrivenRequest[GivenLayshaftGearbox]):
    """A layshaft gearbox, the gear that is engaged, and how the input turns."""

    model_config = ConfigDict(
        title="Layshaft gearbox: speeds and torques",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "layshaft_gearbox",
                        "head": {"driver": 24, "driven": 36},
                        "gears": [{"layshaft": 18, "mainshaft": 42}, {"layshaft": 25, "mainshaft": 35}, {}],
                        "reverse": {"layshaft": 15, "idler": 14, "mainshaft": 33},
                    },
                    "gear": 1,
                    "motion": {"at": 0.0, "speed_rpm": 2000.0},
                }
            ]
        },
    )

    gear: Annotated[int, Field(strict=True, ge=1, le=12)] | Literal["reverse"] = 1

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults = super().find_errors()
        for k, gear in enumerate(self.mechanism.gears):
            if (gear.layshaft is None) != (gear.mainshaft is None):
                faults.append((f"/mechanism/gears/{k}", compose("analyses-one-gear-of-pair")))
        if self.gear == "reverse" and self.mechanism.reverse is None:
            faults.append(("/gear", compose("analyses-reverse-gear-missing")))
        elif self.gear != "reverse" and self.gear > len(self.mechanism.gears):
            faults.append(("/gear", compose("analyses-forward-gears", count=len(self.mechanism.gears))))
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer for the gearbox, in the form of :class:`GearboxAnalysis`."""
        at, speed, time = self.motion.list_inputs()
        box, back = self.mechanism, self.mechanism.reverse
        gears = [
            None if gear.layshaft is None or gear.mainshaft is None else (gear.layshaft, gear.mainshaft)
            for gear in box.gears
        ]
        reverse = None if back is None else (back.layshaft, back.idler, back.mainshaft)
        box_speeds = compute_layshaft_ratios((box.head.driver, box.head.driven), gears, reverse)
        every = [*box_speeds.forward, *([] if box_speeds.reverse is None else [box_speeds.reverse])]
        engaged = len(every) - 1 if self.gear == "reverse" else self.gear - 1
        layshaft = -Fraction(box.head.driver, box.head.driven)
        ratios = [("input", Fraction(1)), ("layshaft", layshaft)]
        if self.gear == "reverse" and back is not None:
            ratios.append(("idler", -layshaft * Fraction(back.layshaft, back.idler)))
        ratios.append(("main shaft", 1 / every[engaged]))
        speeds = sorted((([k], 1 / ratio) for k, ratio in enumerate(every)), key=lambda row: abs(row[1]))
        return _build_answer(self, at, speed, time, [engaged], ratios, speeds)


def _build_answer(
    request: GearboxAnalysisRequest | LayshaftAnalysisRequest,
    at: Real,
    speed: Real,
    time: Real | None,
    engaged: list[int],
    ratios: list[tuple[str, Fraction]],
    speeds: list[tuple[list[int], Fraction]],
) -> JsonObject:
    """Build the answer, which has the same form for both kinds of gearbox.

    ``ratios`` are the speeds of the shafts over that of the input, by name; ``speeds`` are the choices of engaged pairs
    with their output speeds.
    """
    return {
        "input_angle": at.tolist(),
        "time": None if time is None else time.tolist(),
        "valid": [True] * len(at),
        "engaged": engaged,
        "shafts": [
            {
                "name": name,
                "speed_ratio": float(ratio),
                **request.motion.drive_geared(float(ratio), at, speed),
            }
            for name, ratio in ratios
        ],
        "speeds": [
            {"engaged": chosen, "speed_ratio": float(ratio), "exact_speed_ratio": str(ratio)}
            for chosen, ratio in speeds
        ],
    }


FAMILY = Family(GearboxAnalysisRequest, GearboxAnalysis)
LAYSHAFT_FAMILY = Family(LayshaftAnalysisRequest, GearboxAnalysis)
