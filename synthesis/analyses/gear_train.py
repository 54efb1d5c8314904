"""The analysis of an ordinary gear train: speeds, torques, mesh geometry, forces and losses.

Speeds are exact fractions of the input's. The torque on a shaft is the power that reaches it over its speed; each mesh
passes on a stated share of the power, or 1 − μ H with the friction coefficient μ and the loss factor H of its teeth. A
torque against the speed of the input takes power out there: the output drives, and has to bring the losses too. A worm
passes on what its own friction lets it, whatever is stated for the other meshes: its forces follow from that friction,
and so must the torques that they carry.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from fractions import Fraction
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field, ValidationInfo, field_validator

from kinematics.errors import DimensionError
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, FULL_DEPTH_DEDENDUM, Gear, Mesh
from kinematics.gear.train import USUAL_FRICTION, Axis, OrdinaryTrain, StageKind, TrainStage
from kinematics.gear.worm import WormDrive
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family, TurningPart
from synthesis.analyses.drift import WANTED, Drift, drifting
from synthesis.model.answer import Answer, optional
from synthesis.model.dynamics import METRES
from synthesis.model.gear_answer import Helix, MeshGeometry, OfGears, Ratio, mesh_geometries, rack_undercuts
from synthesis.model.gear_stages import MOST_THREADS, StageForm, train_stage
from synthesis.model.gear_statement import (
    FEWEST_TEETH,
    MOST_TEETH,
    Addendum,
    ExactRatio,
    PressureAngle,
    ShiftCoefficient,
    ToothNumber,
)
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


class GivenShifts(Statement):
    """Profile shifts of a stage, modules, positive outwards; the tips are shortened so that the clearance stays."""

    driver: ShiftCoefficient
    driven: ShiftCoefficient


class GivenAddenda(Statement):
    """Addenda of driver and driven gear of an internal stage, modules."""

    driver: Addendum
    driven: Addendum


class GivenStage(StageForm):
    """Two gears that mesh; the driven gear sits on the shaft of the next stage's driver."""

    driver: Annotated[int, Field(strict=True, ge=1, le=MOST_TEETH)] = Field(
        description=f"Teeth of the driving gear, at least {FEWEST_TEETH}; of a worm its threads."
    )
    driven: ToothNumber
    module: PositiveNumber = Field(
        default=1.0,
        description="Module in length units: of helical teeth in the normal plane, of bevel teeth at the large end, "
        "of a worm the axial one.",
    )
    shift: GivenShifts | None = None
    centre_distance: PositiveNumber | None = Field(
        default=None, description="As in a design: it has to be that of the teeth without play."
    )
    face_width: PositiveNumber | None = Field(
        default=None,
        description="For `strength`; of helical gears for the overlap, of bevel gears for the forces, which then "
        "stand in the middle of the face. That of bevel gears is less than the cone distance, where their teeth would "
        "reach the apex; in practice it is at most 0.3 of it, and 10 modules (Shigley's Mechanical Engineering Design, "
        "Tab. 13-3).",
    )
    addendum: GivenAddenda | None = Field(
        default=None,
        description="Of an internal stage; left out: the ring's is as long as the pinion's flank lets it be.",
    )

    @field_validator("driver")
    @classmethod
    def _teeth_or_threads(cls, driver: int, info: ValidationInfo) -> int:
        worm = info.data.get("type") == "worm"
        if not (1 <= driver <= MOST_THREADS if worm else driver >= FEWEST_TEETH):
            raise ValueError(
                f"expected 1 to {MOST_THREADS} threads" if worm else f"expected at least {FEWEST_TEETH} teeth"
            )
        return driver

    def faults_of_type(self) -> list[tuple[str, str]]:
        """Fields that another type has, gears that this type does not take, by their path below the stage."""
        faults = super().faults_of_type()
        if self.type not in ("external", "helical") and self.shift is not None:
            faults.append(("/shift", f"a stage that is {self.type} has no shift"))
        if self.type != "internal" and self.addendum is not None:
            faults.append(("/addendum", "only an internal stage has other addenda than a module"))
        if self.type == "internal" and self.driver == self.driven:
            faults.append(("/driven", "a ring has more teeth than its pinion"))
        return faults

    @classmethod
    def types_with(cls, name: str) -> tuple[StageKind, ...]:
        """Which types of stages have a field; a face width is asked of all that carry a force."""
        return ("external", "internal", "helical", "bevel") if name == "face_width" else super().types_with(name)


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
        angle = math.radians(self.pressure_angle)
        return OrdinaryTrain(tuple(train_stage(s, angle, idlers[k]) for k, s in enumerate(self.stages, 1)), angle)


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
        default=None,
        description="Share of the power that every mesh passes on, but those of worms, whose loss is always that of "
        "their own friction; from the friction where left out.",
    )
    friction: Annotated[float, Field(strict=True, ge=0.0, le=1.0)] = Field(
        default=USUAL_FRICTION, description="Friction coefficient between the teeth; of a worm it is the stage's own."
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
            faults += [(f"/mechanism/stages/{number}{path}", detail) for path, detail in stage.faults_of_type()]
            if stage.type != "external" and any(idler.stage == number + 1 for idler in self.mechanism.idlers):
                faults.append((f"/mechanism/stages/{number}/type", "only an external stage has idlers"))
            if stage.shift is not None and any(idler.stage == number + 1 for idler in self.mechanism.idlers):
                faults.append((f"/mechanism/stages/{number}/shift", "a stage with an idler has no shift"))
        faults += self._wrong_strength()
        if not faults:
            faults += self._wrong_distances() + self._wrong_faces()
        if not faults and self.mechanism.ratio is not None:
            faults += self.mechanism.ratio.faults(self.mechanism.train().ratio)
        if not faults:
            faults += self._holding()
        if self.mesh_efficiency is not None and all(stage.type == "worm" for stage in self.mechanism.stages):
            faults.append(("/mesh_efficiency", "the loss of a worm is that of its own friction; leave it out"))
        return faults

    @property
    def held_worms(self) -> list[int]:
        """Which stages, from 0, are worms that pass on no power, whether they drive or their gears."""
        shares = shares_of(self)
        return [k for k, stage in enumerate(self.mechanism.stages) if stage.type == "worm" and 0.0 in shares[k]]

    def _holding(self) -> list[tuple[str, str]]:
        """Where friction lets no power through although there is a torque."""
        if self.input_torque == 0.0:
            return []
        worms, back = self.held_worms, self.flows_back
        detail = "the gear cannot drive the worm" if back else "the worm cannot drive its gear, whatever the torque"
        faults = [(f"/mechanism/stages/{k}/friction", f"with so much of it {detail}") for k in worms]
        if back and not worms and any(0.0 in stage for stage in shares_of(self)):
            detail = "with so much of it a mesh loses all power, so that the output drives nothing"
            faults.append(("/friction", detail))
        return faults

    @classmethod
    def over_the_cycle(cls, mechanism: dict[str, Any], steps: int) -> dict[str, Any]:
        """As that of every mechanism, and without a load where friction holds a worm."""
        request = cls.model_validate({"mechanism": mechanism, "motion": {"steps": steps}})
        return request.model_copy(update={"input_torque": 0.0} if request.held_worms else {}).answer()

    @property
    def flows_back(self) -> bool:
        """Whether power leaves at the input, at the first position: the output drives."""
        return self.input_torque * float(self.motion.inputs()[1][0]) < 0.0

    def _wrong_strength(self) -> list[tuple[str, str]]:
        stated = self.strength
        if stated is None:
            return []
        wrong = stated.faults()
        if any(stage.type == "internal" for stage in self.mechanism.stages):
            wrong += stated.faults_of_ring()
        faults = [(f"/strength{path}", detail) for path, detail in wrong]
        faults += [
            (f"/mechanism/stages/{number}/type", f"the strength of a stage that is {stage.type} is not estimated")
            for number, stage in enumerate(self.mechanism.stages)
            if stage.type not in ("external", "internal")
        ]
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

    def _wrong_faces(self) -> list[tuple[str, str]]:
        """Faces of bevel gears that would reach over the apex of their cones."""
        angle = math.radians(self.mechanism.pressure_angle)
        faults = []
        for number, stage in enumerate(self.mechanism.stages):
            if stage.type == "bevel" and stage.face_width is not None:
                far = train_stage(stage, angle).cones(angle).cone_distance
                if not stage.face_width < far:
                    detail = f"expected less than the cone distance of these gears, {far:.6g}"
                    faults.append((f"/mechanism/stages/{number}/face_width", detail))
        return faults

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
    base_diameter: float | None = Field(description="Null of bevel gears and of a worm.")
    tooth_thickness: float = Field(description="On the pitch circle.")
    undercut: bool = Field(description="By a rack that cuts it.")


class LoadedMesh(MeshGeometry):
    """A mesh with its contact and its load."""

    path_of_contact: float
    approach: float = Field(description="Part of the path before the pitch point, with the driver driving.")
    recess: float
    clearance: float
    efficiency: float | None = Field(description="Null where fewer than one pair of teeth is in contact.")
    pitch_line_velocity: float = Field(
        description="At the first position, length units per second; of a worm that of its own threads."
    )
    tangential_force: float = Field(description="N; of a worm that on the gear, which is axial on the worm.")
    radial_force: float = Field(description="N, which pushes the gears apart; of bevel gears on the driver.")
    radial_forces: OfGears | None = optional(
        "N, of bevel gears: on the driver and on the driven gear, each towards its axis. Of all others both are "
        "`radial_force`."
    )
    axial_force: OfGears | None = optional(
        "N, of helical, bevel and worm gears: on the driver and on the driven gear. Of helical gears positive where "
        "it points along the axis about which the speed of their shafts is counted (of a train with bevel or worm "
        "stages the `axis` in `shafts`, otherwise the input's) while the input's speed is positive, and against it "
        "while that is negative; of bevel gears positive away from the apex; of a worm its size."
    )
    strength: PairStrength | None = optional("Stresses, where a method is stated.")


class Shaft(Answer):
    """A shaft that passes torque on, from the input shaft to the output shaft."""

    speed_ratio: float
    torque: float = Field(description="N m, with the losses between the input and it.")
    axis: tuple[float, float, float] | None = optional(
        "About which the speed is counted, the input's along z; left out where all shafts are parallel."
    )


class GearTrainAnalysis(DrivenAnalysis):
    """What the analysis core knows of a gear train; degrees, rad/s, length units."""

    valid: list[bool]
    ratio: Ratio
    efficiency: float | None = Field(description="Power that leaves over power that enters.")
    shafts: list[Shaft]
    gears: list[TurningGear]
    meshes: list[LoadedMesh]
    centre_distances: list[float] = Field(description="Of the shafts of each stage, idlers in line.")
    drift: Drift | None = optional("Where a ratio is wanted.")


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
        "shafts": [
            {"speed_ratio": w, "torque": t, **({} if train.is_parallel else {"axis": _told(axis)})}
            for w, t, axis in zip(speeds, torques, train.axes, strict=True)
        ],
        "gears": _gears(request, train, at, speed),
        "meshes": _meshes(request, train, shares, torques, float(speed[0])),
        "centre_distances": list(train.centre_distances),
        **drifting(train.ratio, request.wanted_ratio),
    }


def _told(axis: Axis) -> tuple[float, ...]:
    """An axis without what is left of a right angle in rounding."""
    return tuple(round(float(part), 15) + 0.0 for part in axis)


def shares_of(request: GearTrainAnalysisRequest) -> tuple[tuple[float | None, ...], ...]:
    """Share of the power that each mesh of each stage passes on; None of one that cannot run."""
    train = request.mechanism.train()
    return tuple(
        (_worm_share(request, stage, train),)
        if stage.kind == "worm"
        else tuple(_share(request, mesh) for mesh in meshes)
        for stage, meshes in zip(train.stages, train.meshes, strict=True)
    )


def _worm_share(request: GearTrainAnalysisRequest, stage: TrainStage, train: OrdinaryTrain) -> float:
    """Share of the power that a worm passes on, or its gear where that drives; 0 where friction holds it."""
    worm = stage.worm(train.pressure_angle)
    return worm.driven_back(stage.friction) if request.flows_back else worm.efficiency(stage.friction)


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
    for number, (stage, speeds) in enumerate(zip(train.stages, train.speeds, strict=True), 1):
        roles = ["driver", *("idler" for _ in stage.idlers), "driven"]
        for role, teeth, gear, share in zip(roles, stage.gears, _cut(stage, train), speeds, strict=True):
            turns = float(share)
            placed = {"stage": number, "role": role, "teeth": teeth}
            gears.append(placed | gear | {"speed_ratio": turns, **request.motion.geared(turns, at, speed)})
    return gears


def _cut(stage: TrainStage, train: OrdinaryTrain) -> list[dict[str, Any]]:
    """Dimensions of the gears of a stage, in the order in which they mesh."""
    cut, meshes = stage.cut_gears(train.pressure_angle), stage.meshes(train.pressure_angle)
    if stage.kind == "worm":
        return _worm_and_gear(stage.worm(train.pressure_angle))
    if stage.kind == "bevel":
        pair = stage.cones(train.pressure_angle)
        virtual = sorted((meshes[0].pinion, meshes[0].gear), key=lambda gear: gear.teeth)
        ordered = virtual if stage.driver <= stage.driven else virtual[::-1]
        return [
            _dimensions(gear, back.is_undercut, math.cos(cone)) | {"base_diameter": None}
            for gear, back, cone in zip(cut, ordered, pair.cones, strict=True)
        ]
    if stage.shifts != (0.0, 0.0):
        # As the mesh tells it: a shifted stage has one.
        helix = Helix(train.pressure_angle, stage.helix_angle) if stage.kind == "helical" else None
        undercut = list(rack_undercuts(meshes[0], helix))[:: 1 if stage.driver <= stage.driven else -1]
    elif stage.kind == "helical":
        undercut = [gear.is_undercut for gear in cut]
    else:
        undercut = [replace(gear, addendum=FULL_DEPTH_ADDENDUM).is_undercut for gear in cut]
    return [_dimensions(gear, taken) for gear, taken in zip(cut, undercut, strict=True)]


def _dimensions(gear: Gear, undercut: bool, slope: float = 1.0) -> dict[str, Any]:
    """Of a gear; the teeth of bevel gears rise from the axis by ``slope``, the cosine of the cone, of their height."""
    radii = gear.pitch_radius, gear.tip_radius, gear.root_radius
    tip, root = (radii[0] + slope * (radius - radii[0]) for radius in radii[1:])
    return {
        "module": gear.module,
        "pitch_diameter": 2.0 * gear.pitch_radius,
        "outside_diameter": 2.0 * (gear.tip_radius if slope == 1.0 else tip),
        "root_diameter": 2.0 * (gear.root_radius if slope == 1.0 else root),
        "base_diameter": 2.0 * gear.base_radius,
        "tooth_thickness": gear.tooth_thickness,
        "undercut": undercut,
    }


def _worm_and_gear(worm: WormDrive) -> list[dict[str, Any]]:
    """The worm, as thick along its axis, and its gear in the middle plane."""
    diameter, module = worm.dimensions.worm_diameter, worm.module
    threads = {
        "module": module,
        "pitch_diameter": diameter,
        "outside_diameter": diameter + 2.0 * FULL_DEPTH_ADDENDUM * module,
        "root_diameter": diameter - 2.0 * FULL_DEPTH_DEDENDUM * module,
        "base_diameter": None,
        "tooth_thickness": 0.5 * math.pi * module,
        "undercut": False,
    }
    return [threads, _dimensions(worm.gear, worm.gear.is_undercut)]


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
        if stage.kind == "worm":
            told = _worm_loaded(request, stage, train, torque, float(turns[0]) * speed)
            loaded.append({**next(geometries).model_dump(), **told, "efficiency": efficiencies[0]})
            continue
        # The tangential force passes through an idler; each mesh takes its losses from it. It is that of the gear that
        # drives: where the output does, a mesh has lost its share before its force reaches the driver.
        radius = _radius(stage, train)
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
                    * (
                        radius
                        if stage.shifts != (0.0, 0.0) or stage.kind != "external"
                        else 0.5 * stage.module * driver
                    ),
                    "tangential_force": force,
                    "radial_force": force * math.tan(mesh.pressure_angle),
                    **_sideways(stage, train, force, 1.0 if (turn > 0) != request.flows_back else -1.0),
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


def _radius(stage: TrainStage, train: OrdinaryTrain) -> float:
    """Radius of the driver at which the force of an unshifted stage stands."""
    if stage.kind == "helical":
        return 0.5 * stage.module * stage.driver / math.cos(stage.helix_angle)
    radius = 0.5 * stage.module * stage.driver
    if stage.kind == "bevel" and stage.face_width is not None:
        radius -= 0.5 * stage.face_width * math.sin(stage.cones(train.pressure_angle).cones[0])
    return radius


def _sideways(stage: TrainStage, train: OrdinaryTrain, force: float, way: float) -> dict[str, Any]:
    """Axial forces of helical and bevel gears, and the radial ones of the latter, at a tangential force."""
    if stage.kind == "helical":
        axial = force * math.tan(stage.helix_angle) * way
        return {"axial_force": {"driver": axial, "driven": -axial}}
    if stage.kind == "bevel":
        apart, (one, two) = force * math.tan(train.pressure_angle), stage.cones(train.pressure_angle).cones
        return {
            "radial_force": apart * math.cos(one),
            "radial_forces": {"driver": apart * math.cos(one), "driven": apart * math.cos(two)},
            "axial_force": {"driver": apart * math.sin(one), "driven": apart * math.sin(two)},
        }
    return {}


def _worm_loaded(
    request: GearTrainAnalysisRequest, stage: TrainStage, train: OrdinaryTrain, torque: float, turning: float
) -> dict[str, Any]:
    """Contact in the middle plane and forces of a worm and its gear."""
    worm, friction = stage.worm(train.pressure_angle), stage.friction
    # Where the gear drives, friction is against its way.
    sign = -1.0 if request.flows_back else 1.0
    forces = worm.forces(abs(torque) / METRES[request.length_unit], sign * friction)
    return {
        "path_of_contact": worm.approach + worm.recess,
        "approach": worm.approach,
        "recess": worm.recess,
        "clearance": (FULL_DEPTH_DEDENDUM - FULL_DEPTH_ADDENDUM) * worm.module,
        "pitch_line_velocity": abs(turning) * 0.5 * worm.dimensions.worm_diameter,
        "tangential_force": forces.gear,
        "radial_force": forces.radial,
        "axial_force": {"driver": forces.gear, "driven": forces.worm},
    }


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
