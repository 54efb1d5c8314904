"""Analysis of an ordinary gear train: speeds, torques, mesh geometry, forces and losses.

Speeds are exact fractions of the input speed. The torque on a shaft is the power that reaches it, divided by its speed.
Each mesh transmits a given share of the power, or 1 − μ H with the coefficient of friction μ and the loss factor H of
its teeth. If the input torque opposes the input speed, power leaves at the input: the output drives and also supplies
the losses. A worm always transmits the share that follows from its own friction, because its forces follow from that
friction, and its torques must be consistent with them.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field

from kinematics.arrays import Real
from kinematics.errors import DimensionError
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, FULL_DEPTH_DEDENDUM, Gear, Mesh
from kinematics.gear.train import USUAL_FRICTION, OrdinaryTrain, TrainStage
from kinematics.gear.worm import WormDrive
from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family, TurningPart
from synthesis.analyses.gears.drift import WANTED_DESCRIPTION, Drift, describe_drift
from synthesis.analyses.gears.given_train import GivenGearTrain
from synthesis.analyses.gears.loaded_meshes import Flow, LoadedMesh, list_loaded_meshes
from synthesis.model.answer import Answer, optional_field
from synthesis.model.dynamics.request import METRES_PER_UNIT
from synthesis.model.gears.answer import Ratio
from synthesis.model.gears.request import ExactRatio
from synthesis.model.gears.stages import build_train_stage
from synthesis.model.gears.strength import RATED_STAGE_TYPES, StrengthMethod
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Number

DISTANCE_TOLERANCE = 1e-6
"""Relative tolerance for the comparison of a given centre distance with that of the teeth."""


class GearTrainAnalysisRequest(DrivenRequest[GivenGearTrain]):
    """A gear train, the motion of its input, and its load."""

    model_config = ConfigDict(
        title="Gear train: speeds and torques",
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
        description="Torque on the input shaft, N·m. If it is opposite to the speed at the first position, the output "
        "drives.",
    )
    mesh_efficiency: Annotated[float, Field(strict=True, gt=0.0, le=1.0)] | None = Field(
        default=None,
        description="Share of the power that every mesh transmits. The losses of worms always follow from their own "
        "friction. Default: computed from `friction`.",
    )
    friction: Annotated[float, Field(strict=True, ge=0.0, le=1.0)] = Field(
        default=USUAL_FRICTION,
        description="Coefficient of friction between the teeth; a worm has its own, given by its stage.",
    )
    wanted_ratio: ExactRatio | None = Field(default=None, description=WANTED_DESCRIPTION)
    strength: StrengthMethod | None = Field(
        default=None,
        description="Stresses of every mesh under the torque at the first position, at the stage's face width or at "
        "the minimum that keeps within the allowable stresses; pairs are for the driving and the driven gear.",
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults = super().find_errors()
        for number, idler in enumerate(self.mechanism.idlers):
            if idler.stage > len(self.mechanism.stages):
                faults.append((f"/mechanism/idlers/{number}/stage", compose("analyses-stage-unknown")))
        for number, stage in enumerate(self.mechanism.stages):
            faults += [(f"/mechanism/stages/{number}{path}", detail) for path, detail in stage.find_type_errors()]
            if stage.type != "external" and any(idler.stage == number + 1 for idler in self.mechanism.idlers):
                faults.append((f"/mechanism/stages/{number}/type", compose("analyses-idlers-need-external-stage")))
            if stage.shift is not None and any(idler.stage == number + 1 for idler in self.mechanism.idlers):
                faults.append((f"/mechanism/stages/{number}/shift", compose("analyses-idlers-exclude-shift")))
        faults += self._find_strength_errors()
        if not faults:
            faults += self._find_distance_errors() + self._find_face_errors()
        if not faults and self.mechanism.ratio is not None:
            faults += self.mechanism.ratio.find_errors(self.mechanism.build_train().ratio)
        if not faults:
            faults += self._find_locking_errors()
        if self.mesh_efficiency is not None and all(stage.type == "worm" for stage in self.mechanism.stages):
            faults.append(("/mesh_efficiency", compose("analyses-worm-has-own-loss")))
        return faults

    @property
    def list_locked_worms(self) -> list[int]:
        """Indices, from 0, of the stages whose worms transmit no power in the direction of the power flow."""
        shares = list_power_shares(self)
        return [k for k, stage in enumerate(self.mechanism.stages) if stage.type == "worm" and 0.0 in shares[k]]

    def _find_locking_errors(self) -> list[tuple[str, str]]:
        """Return errors of meshes that friction locks although there is a torque."""
        if self.input_torque == 0.0:
            # Without a torque, friction locks nothing, and the speeds can still be analyzed.
            return []
        worms, back = self.list_locked_worms, self.has_backward_flow
        message = "analyses-gear-cannot-drive-worm" if back else "analyses-worm-cannot-drive-gear"
        faults = [(f"/mechanism/stages/{k}/friction", compose(message)) for k in worms]
        # Only a reversed power flow divides by the shares. In forward flow, a share of 0 gives an output torque of 0.
        if back and not worms and any(0.0 in stage for stage in list_power_shares(self)):
            faults.append(("/friction", compose("analyses-output-cannot-drive")))
        return faults

    @classmethod
    def analyze_cycle(cls, mechanism: JsonObject, steps: int) -> JsonObject:
        """Build the answer over a cycle, without a torque if friction locks a worm."""
        request = cls.model_validate({"mechanism": mechanism, "motion": {"steps": steps}})
        # With the default torque of 1 a train with a locked worm would be rejected, so analyze it without a torque.
        return request.model_copy(update={"input_torque": 0.0} if request.list_locked_worms else {}).build_answer()

    @property
    def has_backward_flow(self) -> bool:
        """Whether power leaves at the input at the first position, so that the output drives."""
        return self.input_torque * float(self.motion.list_inputs()[1][0]) < 0.0

    def _find_strength_errors(self) -> list[tuple[str, str]]:
        stated = self.strength
        if stated is None:
            return []
        wrong = stated.find_errors()
        if any(stage.type == "internal" for stage in self.mechanism.stages):
            wrong += stated.find_ring_errors()
        if any(stage.type == "helical" for stage in self.mechanism.stages):
            wrong += stated.find_helix_errors()
        faults = [(f"/strength{path}", detail) for path, detail in wrong]
        faults += [
            (f"/mechanism/stages/{number}/type", compose("analyses-stage-not-rated", type=stage.type))
            for number, stage in enumerate(self.mechanism.stages)
            if stage.type not in RATED_STAGE_TYPES
        ]
        # The faces are sized by the power; without power any face would suffice.
        if self.input_torque == 0.0 or float(self.motion.list_inputs()[1][0]) == 0.0:
            faults.append(("/strength", compose("analyses-torque-and-speed-missing")))
        if stated.allowable_bending is None and stated.allowable_contact is None:
            faults += [
                (
                    f"/mechanism/stages/{number}/face_width",
                    compose("analyses-face-width-missing"),
                )
                for number, stage in enumerate(self.mechanism.stages)
                if stage.face_width is None
            ]
        return faults

    def _find_distance_errors(self) -> list[tuple[str, str]]:
        try:
            distances = self.mechanism.build_train().centre_distances
        # Errors of the stages are reported by the mechanism itself.
        except DimensionError:
            return []
        return [
            (
                f"/mechanism/stages/{number}/centre_distance",
                compose("analyses-distance-of-teeth-differs", distance=f"{has:.9g}"),
            )
            for number, (stage, has) in enumerate(zip(self.mechanism.stages, distances, strict=True))
            if stage.centre_distance is not None and abs(stage.centre_distance - has) > DISTANCE_TOLERANCE * has
        ]

    def _find_face_errors(self) -> list[tuple[str, str]]:
        """Return errors of bevel gears whose faces would extend to the apex of their cones or beyond."""
        angle = math.radians(self.mechanism.pressure_angle)
        faults = []
        for number, stage in enumerate(self.mechanism.stages):
            if stage.type == "bevel" and stage.face_width is not None:
                far = build_train_stage(stage, angle).cones(angle).cone_distance
                # A face as wide as the cone distance is refused, too, because its teeth would end in a point.
                if not stage.face_width < far:
                    detail = compose("analyses-face-reaches-apex", distance=f"{far:.6g}")
                    faults.append((f"/mechanism/stages/{number}/face_width", detail))
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer for the train, in the form of :class:`GearTrainAnalysis`."""
        return _analyze_train(self)


class TurningGear(TurningPart):
    """A gear and its motion; gears of one shaft turn alike."""

    stage: int
    role: Literal["driver", "idler", "driven"]
    teeth: int
    module: float
    pitch_diameter: float
    outside_diameter: float
    root_diameter: float
    base_diameter: float | None = Field(description="Base diameter; null for bevel gears and for a worm.")
    tooth_thickness: float = Field(description="Value on the pitch circle.")
    undercut: bool = Field(description="Whether a rack that cuts the gear undercuts it.")


class Shaft(Answer):
    """A shaft that passes torque on, from the input shaft to the output shaft."""

    speed_ratio: float
    torque: float = Field(description="Torque, N·m, including the losses between the input and this shaft.")
    axis: tuple[float, float, float] | None = optional_field(
        "Axis about which the speed is counted; the input's axis is z. Left out if all shafts are parallel."
    )


class GearTrainAnalysis(DrivenAnalysis):
    """Analysis of a gear train; degrees, rad/s, length units."""

    valid: list[bool]
    ratio: Ratio
    efficiency: float | None = Field(description="Output power over input power.")
    shafts: list[Shaft]
    gears: list[TurningGear]
    meshes: list[LoadedMesh]
    centre_distances: list[float] = Field(description="Distance of the shafts of each stage, with idlers in line.")
    drift: Drift | None = optional_field("Given if a required ratio is given.")


def _analyze_train(request: GearTrainAnalysisRequest) -> JsonObject:
    """Compute speeds, torques, gears and meshes of a train over the motion."""
    at, speed, time = request.motion.list_inputs()
    train = request.mechanism.build_train()
    shares = list_power_shares(request)
    # A mesh that cannot run passes torque without loss, so that the answer still contains torques; the efficiency is
    # then None.
    passed = tuple(tuple(1.0 if share is None else share for share in stage) for stage in shares)
    known = all(share is not None for stage in shares for share in stage)
    # With reversed flow, the input receives less power than the output supplies, so torques grow towards the output.
    gained = tuple(tuple(1.0 / share for share in stage) for stage in passed) if request.has_backward_flow else passed
    torques = train.torques(request.input_torque, gained)
    flow = Flow(
        train, shares, torques, float(speed[0]), request.has_backward_flow, METRES_PER_UNIT[request.length_unit]
    )
    speeds = [1.0, *(float(stage[-1]) for stage in train.speeds)]
    return {
        "input_angle": at.tolist(),
        "time": None if time is None else time.tolist(),
        "valid": [True] * len(at),
        "ratio": Ratio.from_fraction(train.ratio).model_dump(),
        "efficiency": math.prod(share for stage in passed for share in stage) if known else None,
        "shafts": [
            {"speed_ratio": w, "torque": t, **({} if train.is_parallel else {"axis": _clean_axis(axis)})}
            for w, t, axis in zip(speeds, torques, train.axes, strict=True)
        ],
        "gears": _describe_gears(request, train, at, speed),
        "meshes": list_loaded_meshes(flow, request.strength, [stage.face_width for stage in request.mechanism.stages]),
        "centre_distances": list(train.centre_distances),
        **describe_drift(train.ratio, request.wanted_ratio),
    }


def _clean_axis(axis: Real) -> tuple[float, ...]:
    """Round the components of an axis, to remove the rounding errors of right angles."""
    # Adding zero turns −0.0 into 0.0.
    return tuple(round(float(part), 15) + 0.0 for part in axis)


def list_power_shares(request: GearTrainAnalysisRequest) -> tuple[tuple[float | None, ...], ...]:
    """Return the share of the power that each mesh of each stage transmits; None for a mesh that cannot run."""
    train = request.mechanism.build_train()
    return tuple(
        (_compute_worm_share(request, stage, train),)
        if stage.kind == "worm"
        else tuple(_compute_share(request, mesh) for mesh in meshes)
        for stage, meshes in zip(train.stages, train.meshes, strict=True)
    )


def _compute_worm_share(request: GearTrainAnalysisRequest, stage: TrainStage, train: OrdinaryTrain) -> float:
    """Compute the share of the power that a worm set transmits in the direction of the flow; 0 if friction locks it."""
    worm = stage.worm(train.pressure_angle)
    return worm.back_efficiency(stage.friction) if request.has_backward_flow else worm.efficiency(stage.friction)


def _compute_share(request: GearTrainAnalysisRequest, mesh: Mesh) -> float | None:
    """Compute the share of the power that a mesh transmits; None if it cannot run."""
    # Below a contact ratio of 1 the teeth lose contact, so no efficiency is meaningful.
    if mesh.contact_ratio < 1.0:
        return None
    if request.mesh_efficiency is not None:
        return request.mesh_efficiency
    # Large friction can make the estimate negative, but a share below 0 has no meaning.
    return max(0.0, 1.0 - request.friction * mesh.loss_factor)


def _describe_gears(
    request: GearTrainAnalysisRequest, train: OrdinaryTrain, at: NDArray[np.float64], speed: NDArray[np.float64]
) -> list[JsonObject]:
    """Describe every gear with its dimensions and its motion, from the input to the output."""
    gears = []
    for number, (stage, speeds) in enumerate(zip(train.stages, train.speeds, strict=True), 1):
        roles = ["driver", *("idler" for _ in stage.idlers), "driven"]
        for role, teeth, gear, share in zip(
            roles, stage.gears, _describe_stage_gears(stage, train), speeds, strict=True
        ):
            turns = float(share)
            placed = {"stage": number, "role": role, "teeth": teeth}
            gears.append(placed | gear | {"speed_ratio": turns, **request.motion.drive_geared(turns, at, speed)})
    return gears


def _describe_stage_gears(stage: TrainStage, train: OrdinaryTrain) -> list[JsonObject]:
    """Describe the dimensions of the gears of a stage, in the order of their meshes."""
    cut, meshes = stage.cut_gears(train.pressure_angle), stage.meshes(train.pressure_angle)
    if stage.kind == "worm":
        return _describe_worm_stage(stage.worm(train.pressure_angle))
    if stage.kind == "bevel":
        pair = stage.cones(train.pressure_angle)
        # Bevel gears are undercut if the virtual gears of their back cones are, which the mesh sorts by tooth number.
        virtual = sorted((meshes[0].pinion, meshes[0].gear), key=lambda gear: gear.teeth)
        ordered = virtual if stage.driver <= stage.driven else virtual[::-1]
        return [
            _describe_dimensions(gear, back.is_undercut, math.cos(cone)) | {"base_diameter": None}
            for gear, back, cone in zip(cut, ordered, pair.cones, strict=True)
        ]
    return [_describe_dimensions(gear, gear.is_undercut) for gear in cut]


def _describe_dimensions(gear: Gear, undercut: bool, slope: float = 1.0) -> JsonObject:
    """Describe the dimensions of a gear; ``slope`` is the cosine of the cone angle of a bevel gear, otherwise 1."""
    radii = gear.pitch_radius, gear.tip_radius, gear.root_radius
    # Bevel teeth extend along the back cone, inclined to the axis by the cone angle.
    tip, root = (radii[0] + slope * (radius - radii[0]) for radius in radii[1:])
    return {
        "module": gear.module,
        "pitch_diameter": 2.0 * gear.pitch_radius,
        # For parallel axes use the radii of the gear directly, because the formula with slope 1 adds rounding errors.
        "outside_diameter": 2.0 * (gear.tip_radius if slope == 1.0 else tip),
        "root_diameter": 2.0 * (gear.root_radius if slope == 1.0 else root),
        "base_diameter": 2.0 * gear.base_radius,
        "tooth_thickness": gear.tooth_thickness,
        "undercut": undercut,
    }


def _describe_worm_stage(worm: WormDrive) -> list[JsonObject]:
    """Describe the worm, with its tooth thickness along the axis, and its gear in the middle plane."""
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
    return [threads, _describe_dimensions(worm.gear, worm.gear.is_undercut)]


FAMILY = Family(GearTrainAnalysisRequest, GearTrainAnalysis)
