"""The analysis of an ordinary gear train: speeds, torques, mesh geometry, forces and losses.

Speeds are exact fractions of the input's. The torque on a shaft is the power that reaches it over its speed; each mesh
passes on a stated share of the power, or 1 − μ H with the friction coefficient μ and the loss factor H of its teeth. A
torque against the speed of the input takes power out there: the output drives, and has to bring the losses too.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from fractions import Fraction
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field

from kinematics.errors import DimensionError
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, Mesh
from kinematics.gear.train import OrdinaryTrain, TrainStage
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family, TurningPart
from synthesis.analyses.drift import WANTED, Drift, drifting
from synthesis.model.answer import Answer, optional
from synthesis.model.dynamics import METRES
from synthesis.model.gear_answer import MeshGeometry, Ratio, mesh_geometries, rack_undercuts
from synthesis.model.gear_statement import ExactRatio, PressureAngle, ShiftCoefficient, ToothNumber
from synthesis.model.gear_strength import (
    Loaded,
    PairStrength,
    StrengthMethod,
    bent_both_ways,
    stage_contact,
    told,
)
from synthesis.model.statement import Number, PositiveNumber, Statement

SAME_DISTANCE = 1e-6
"""Share of a centre distance by which a stated one may differ from that of the teeth."""

SAME_RATIO = 1e-9
"""Share by which the number that is stated beside a ratio's numerator and denominator may differ from them."""

FRICTION = 0.05
"""Friction coefficient of lubricated steel teeth, where none is stated."""


class GivenShifts(Statement):
    """Profile shifts of a stage, modules, positive outwards; the tips are shortened so that the clearance stays."""

    driver: ShiftCoefficient
    driven: ShiftCoefficient


class GivenStage(Statement):
    """Two gears that mesh; the driven gear sits on the shaft of the next stage's driver."""

    driver: ToothNumber
    driven: ToothNumber
    module: PositiveNumber = Field(default=1.0, description="Module in length units.")
    shift: GivenShifts | None = None
    centre_distance: PositiveNumber | None = Field(
        default=None, description="As in a design: it has to be that of the teeth without play."
    )

    face_width: PositiveNumber | None = Field(default=None, description="For `strength`.")

    @property
    def shifts(self) -> tuple[float, float]:
        """Profile shifts of driver and driven gear."""
        return (0.0, 0.0) if self.shift is None else (self.shift.driver, self.shift.driven)


class GivenIdler(Statement):
    """A gear between driver and driven gear of a stage; several of one stage stand in the order of the list."""

    stage: Annotated[int, Field(strict=True, ge=1, le=16)]
    teeth: ToothNumber


class GivenRatio(Statement):
    """A ratio as in a design; it is compared with that of the teeth."""

    numerator: Annotated[int, Field(strict=True)]
    denominator: Annotated[int, Field(strict=True, ge=1)]
    value: Number

    def faults(self, ratio: Fraction) -> list[tuple[str, str]]:
        """What is wrong where the teeth have another ratio."""
        same = self.numerator == ratio * self.denominator
        if same and math.isclose(self.value, float(ratio), rel_tol=SAME_RATIO):
            return []
        return [("/mechanism/ratio", f"the teeth have the ratio {ratio}; leave the ratio out")]


class GivenGearTrain(Statement):
    """An ordinary gear train as in a design."""

    type: Literal["gear_train"]
    stages: list[GivenStage] = Field(min_length=1, max_length=16)
    idlers: list[GivenIdler] = Field(default=[], max_length=64)
    ratio: GivenRatio | None = None
    pressure_angle: PressureAngle = 20.0

    def train(self) -> OrdinaryTrain:
        """The train for the analysis core."""
        idlers = {k: tuple(i.teeth for i in self.idlers if i.stage == k) for k in range(1, len(self.stages) + 1)}
        stages = tuple(
            TrainStage(s.driver, s.driven, s.module, idlers[k], s.shifts) for k, s in enumerate(self.stages, 1)
        )
        return OrdinaryTrain(stages, math.radians(self.pressure_angle))


class GearTrainAnalysisRequest(DrivenRequest[GivenGearTrain]):
    """A gear train, how its input turns, and what it carries."""

    model_config = ConfigDict(
        title="Gear train, how it is driven",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "gear_train",
                        "stages": [
                            {"driver": 25, "driven": 51, "module": 2.0},
                            {"driver": 50, "driven": 77, "module": 2.0},
                        ],
                    },
                    "motion": {"at": 0.0, "speed_rpm": 1500.0},
                    "input_torque": 20.0,
                    "mesh_efficiency": 0.98,
                }
            ]
        },
    )

    length_unit: Literal["mm", "cm", "m", "in"] = "mm"
    input_torque: Number = Field(
        default=1.0,
        description="Torque on the input shaft, N m; against its speed at the first position the output drives.",
    )
    mesh_efficiency: Annotated[float, Field(strict=True, gt=0.0, le=1.0)] | None = Field(
        default=None, description="Share of the power that every mesh passes on; from the friction where left out."
    )
    friction: Annotated[float, Field(strict=True, ge=0.0, le=1.0)] = Field(
        default=FRICTION, description="Friction coefficient between the teeth."
    )
    wanted_ratio: ExactRatio | None = Field(default=None, description=WANTED)
    strength: StrengthMethod | None = Field(
        default=None,
        description="Stresses of every mesh under the torque at the first position, over the stage's face width or "
        "over the least that keeps the allowable stresses; pairs are of the driving gear and the driven one.",
    )

    def faults(self) -> list[tuple[str, str]]:
        """What no single field shows."""
        faults = super().faults()
        for number, idler in enumerate(self.mechanism.idlers):
            if idler.stage > len(self.mechanism.stages):
                faults.append((f"/mechanism/idlers/{number}/stage", "there is no such stage"))
        for number, stage in enumerate(self.mechanism.stages):
            if stage.shift is not None and any(idler.stage == number + 1 for idler in self.mechanism.idlers):
                faults.append((f"/mechanism/stages/{number}/shift", "a stage with an idler has no shift"))
        faults += self._wrong_strength()
        if not faults:
            faults += self._wrong_distances()
        if not faults and self.mechanism.ratio is not None:
            faults += self.mechanism.ratio.faults(self.mechanism.train().ratio)
        if not faults and self.flows_back and any(0.0 in stage for stage in shares_of(self)):
            faults.append(("/friction", "with so much of it a mesh loses all power, so that the output drives nothing"))
        return faults

    @property
    def flows_back(self) -> bool:
        """Whether power leaves at the input, at the first position: the output drives."""
        return self.input_torque * float(self.motion.inputs()[1][0]) < 0.0

    def _wrong_strength(self) -> list[tuple[str, str]]:
        stated = self.strength
        if stated is None:
            return []
        faults = [(f"/strength{path}", detail) for path, detail in stated.faults()]
        if self.input_torque == 0.0 or float(self.motion.inputs()[1][0]) == 0.0:
            faults.append(("/strength", "state a torque and a speed; no power is carried without"))
        if stated.allowable_bending is None and stated.allowable_contact is None:
            faults += [
                (f"/mechanism/stages/{number}/face_width", "state it, or the allowable stresses that it follows from")
                for number, stage in enumerate(self.mechanism.stages)
                if stage.face_width is None
            ]
        return faults

    def _wrong_distances(self) -> list[tuple[str, str]]:
        try:
            distances = self.mechanism.train().centre_distances
        except DimensionError:
            return []
        return [
            (f"/mechanism/stages/{number}/centre_distance", f"the teeth have the distance {has:.9g}; leave it out")
            for number, (stage, has) in enumerate(zip(self.mechanism.stages, distances, strict=True))
            if stage.centre_distance is not None and abs(stage.centre_distance - has) > SAME_DISTANCE * has
        ]

    def answer(self) -> dict[str, Any]:
        """Everything about the train, in the shape of :class:`GearTrainAnalysis`."""
        return _analysis(self)


class TurningGear(TurningPart):
    """A gear and its motion; gears of one shaft turn alike."""

    stage: int
    role: Literal["driver", "idler", "driven"]
    teeth: int
    module: float
    pitch_diameter: float
    outside_diameter: float
    root_diameter: float
    base_diameter: float
    tooth_thickness: float = Field(description="On the pitch circle.")
    undercut: bool = Field(description="By a rack that cuts it.")


class LoadedMesh(MeshGeometry):
    """A mesh with its contact and its load."""

    path_of_contact: float
    approach: float = Field(description="Part of the path before the pitch point, with the driver driving.")
    recess: float
    clearance: float
    efficiency: float | None = Field(description="Null where fewer than one pair of teeth is in contact.")
    pitch_line_velocity: float = Field(description="At the first position, length units per second.")
    tangential_force: float = Field(description="N")
    radial_force: float = Field(description="N")
    strength: PairStrength | None = optional("Stresses, where a method is stated.")


class Shaft(Answer):
    """A shaft that passes torque on, from the input shaft to the output shaft."""

    speed_ratio: float
    torque: float = Field(description="N m, with the losses between the input and it.")


class GearTrainAnalysis(DrivenAnalysis):
    """What the analysis core knows of a gear train; degrees, rad/s, length units."""

    valid: list[bool]
    ratio: Ratio
    efficiency: float | None = Field(description="Power that leaves over power that enters.")
    shafts: list[Shaft]
    gears: list[TurningGear]
    meshes: list[LoadedMesh]
    centre_distances: list[float] = Field(description="Of the shafts of each stage, idlers in line.")
    drift: Drift | None = optional("Where a ratio is wanted, and the train turns its way.")


def _analysis(request: GearTrainAnalysisRequest) -> dict[str, Any]:
    """Speeds, torques, gears and meshes of a train over the motion."""
    at, speed, time = request.motion.inputs()
    train = request.mechanism.train()
    shares = shares_of(request)
    passed = tuple(tuple(1.0 if share is None else share for share in stage) for stage in shares)
    known = all(share is not None for stage in shares for share in stage)
    gained = tuple(tuple(1.0 / share for share in stage) for stage in passed) if request.flows_back else passed
    torques = train.torques(request.input_torque, gained)
    speeds = [1.0, *(float(stage[-1]) for stage in train.speeds)]
    return {
        "input_angle": at.tolist(),
        "time": None if time is None else time.tolist(),
        "valid": [True] * len(at),
        "ratio": Ratio.of(train.ratio).model_dump(),
        "efficiency": math.prod(share for stage in passed for share in stage) if known else None,
        "shafts": [{"speed_ratio": w, "torque": t} for w, t in zip(speeds, torques, strict=True)],
        "gears": _gears(request, train, at, speed),
        "meshes": _meshes(request, train, shares, torques, float(speed[0])),
        "centre_distances": list(train.centre_distances),
        **drifting(train.ratio, request.wanted_ratio),
    }


def shares_of(request: GearTrainAnalysisRequest) -> tuple[tuple[float | None, ...], ...]:
    """Share of the power that each mesh of each stage passes on."""
    return tuple(tuple(_share(request, mesh) for mesh in stage) for stage in request.mechanism.train().meshes)


def _share(request: GearTrainAnalysisRequest, mesh: Mesh) -> float | None:
    """Share of the power that a mesh passes on; None where it cannot run."""
    if mesh.contact_ratio < 1.0:
        return None
    if request.mesh_efficiency is not None:
        return request.mesh_efficiency
    return max(0.0, 1.0 - request.friction * mesh.loss_factor)


def _gears(
    request: GearTrainAnalysisRequest, train: OrdinaryTrain, at: NDArray[np.float64], speed: NDArray[np.float64]
) -> list[dict[str, Any]]:
    """Every gear with its dimensions and its motion, from the input to the output."""
    gears = []
    for number, (stage, meshes, speeds) in enumerate(zip(train.stages, train.meshes, train.speeds, strict=True), 1):
        roles = ["driver", *("idler" for _ in stage.idlers), "driven"]
        cut = stage.cut_gears(train.pressure_angle)
        if stage.shifts == (0.0, 0.0):
            undercut = [replace(gear, addendum=FULL_DEPTH_ADDENDUM).is_undercut for gear in cut]
        else:
            # As the mesh tells it: a shifted stage has one.
            undercut = list(rack_undercuts(meshes[0]))[:: 1 if stage.driver <= stage.driven else -1]
        for role, teeth, gear, share, taken in zip(roles, stage.gears, cut, speeds, undercut, strict=True):
            turns = float(share)
            gears.append(
                {
                    "stage": number,
                    "role": role,
                    "teeth": teeth,
                    "module": gear.module,
                    "pitch_diameter": 2.0 * gear.pitch_radius,
                    "outside_diameter": 2.0 * gear.tip_radius,
                    "root_diameter": 2.0 * gear.root_radius,
                    "base_diameter": 2.0 * gear.base_radius,
                    "tooth_thickness": gear.tooth_thickness,
                    "undercut": taken,
                    "speed_ratio": turns,
                    **request.motion.geared(turns, at, speed),
                }
            )
    return gears


def _meshes(
    request: GearTrainAnalysisRequest,
    train: OrdinaryTrain,
    shares: tuple[tuple[float | None, ...], ...],
    torques: tuple[float, ...],
    speed: float,
) -> list[dict[str, Any]]:
    """Every mesh with its contact and its forces at the first position."""
    geometries = iter(mesh_geometries(train))
    loaded: list[dict[str, Any]] = []
    for number, (stage, meshes, efficiencies, turns, torque) in enumerate(
        zip(train.stages, train.meshes, shares, train.speeds, torques[:-1], strict=True)
    ):
        begin = len(loaded)
        # The tangential force passes through an idler; each mesh takes its losses from it. It is that of the gear that
        # drives: where the output does, a mesh has lost its share before its force reaches the driver.
        radius = 0.5 * stage.module * stage.driver
        if stage.shifts != (0.0, 0.0):
            radius *= meshes[0].centre_distance / meshes[0].standard_distance
        force = abs(torque) / (radius * METRES[request.length_unit])
        for (driver, driven), mesh, share, turn in zip(
            itertools.pairwise(stage.gears), meshes, efficiencies, turns[:-1], strict=True
        ):
            passed = 1.0 if share is None else share
            if request.flows_back:
                force /= passed
            parts = mesh.approach, mesh.recess
            approach, recess = parts if driver <= driven else parts[::-1]
            loaded.append(
                {
                    **next(geometries).model_dump(),
                    "path_of_contact": mesh.path_of_contact,
                    "approach": approach,
                    "recess": recess,
                    "clearance": mesh.clearance,
                    "efficiency": share,
                    "pitch_line_velocity": abs(float(turn) * speed)
                    * (radius if stage.shifts != (0.0, 0.0) else 0.5 * stage.module * driver),
                    "tangential_force": force,
                    "radial_force": force * math.tan(mesh.pressure_angle),
                }
            )
            if request.strength is not None:
                place = len(loaded) - begin - 1
                power = force * abs(float(turn) * speed) * METRES[request.length_unit] * 0.5 * stage.module * driver
                if stage.shifts != (0.0, 0.0):
                    power *= mesh.centre_distance / mesh.standard_distance
                turning = abs(float(turn) * speed)
                loaded[-1]["strength"] = _strength(request, stage, place, number, power, turning)
            if not request.flows_back:
                force *= passed
    return loaded


def _strength(
    request: GearTrainAnalysisRequest, stage: TrainStage, place: int, number: int, power: float, turning: float
) -> dict[str, Any]:
    """Stresses of one mesh of a stage, its gears as they stand in the order of the power, in millimetres."""
    assert request.strength is not None
    unit = 1000.0 * METRES[request.length_unit]
    contact = stage_contact(stage, place, math.radians(request.mechanism.pressure_angle), unit)
    width = request.mechanism.stages[number].face_width
    return told(Loaded(contact, power, turning, bent_both_ways(stage, place)), request.strength, width, unit)


FAMILY = Family(GearTrainAnalysisRequest, GearTrainAnalysis)
