"""Meshes of an ordinary gear train under load: contact, forces and stresses, at one speed of the input."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from pydantic import Field

from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, FULL_DEPTH_DEDENDUM
from kinematics.gear.train import OrdinaryTrain, TrainStage
from synthesis.model.answer import optional_field
from synthesis.model.gears.answer import GearNumbers, MeshGeometry, describe_meshes
from synthesis.model.gears.strength import (
    LoadedPair,
    PairStrength,
    StrengthMethod,
    build_stage_contact,
    describe_strength,
    mark_idlers,
)
from synthesis.model.json_object import JsonObject


@dataclass(frozen=True)
class Flow:
    """Power flow through a gear train.

    Parameters
    ----------
    train : OrdinaryTrain
    shares : tuple of tuple of float or None
        Share of the power that each mesh of each stage transmits; None for a mesh that cannot run.
    torques : tuple of float
        Torques on the input shaft and on the output shaft of each stage, N·m.
    speed : float
        Speed of the input, rad/s.
    flows_back : bool
        Whether the output drives.
    unit : float
        Length unit of the train, metres.
    """

    train: OrdinaryTrain
    shares: tuple[tuple[float | None, ...], ...]
    torques: tuple[float, ...]
    speed: float
    flows_back: bool
    unit: float


class LoadedMesh(MeshGeometry):
    """A mesh with its contact and its load."""

    path_of_contact: float
    approach: float = Field(description="Part of the contact path before the pitch point, with the driver driving.")
    recess: float
    clearance: float
    efficiency: float | None = Field(
        description="Efficiency of the mesh; null if fewer than one pair of teeth is in contact."
    )
    pitch_line_velocity: float = Field(
        description="Pitch line velocity at the first position, length units per second; for a worm that of its "
        "threads."
    )
    tangential_force: float = Field(
        description="Tangential force, N; for a worm set the tangential force on the gear, which is axial on the worm."
    )
    radial_force: float = Field(
        description="Radial force that separates the gears, N; for bevel gears the one on the driver."
    )
    radial_forces: GearNumbers | None = optional_field(
        "Radial forces on the driver and on the driven gear, each towards its axis, N; only for bevel gears. For all "
        "others both equal `radial_force`."
    )
    axial_force: GearNumbers | None = optional_field(
        "Axial forces on the driver and on the driven gear, N; only for helical, bevel and worm gears. Helical "
        "gears: while the input's speed is positive, a positive force points along the axis about which the speeds "
        "of the shafts are counted (`axis` in `shafts` for a train with bevel or worm stages, otherwise the input's "
        "axis); while the input's speed is negative, it points against that axis. Bevel gears: positive away from "
        "the apex. Worm gears: the magnitude."
    )
    strength: PairStrength | None = optional_field("Stresses, if a method is given.")


def list_loaded_meshes(flow: Flow, strength: StrengthMethod | None, widths: Sequence[float | None]) -> list[JsonObject]:
    """Return every mesh with its contact, its forces and its stresses, in the form of :class:`LoadedMesh`.

    Parameters
    ----------
    flow : Flow
    strength : StrengthMethod or None
        Strength method; without it stresses are left out.
    widths : sequence of float or None
        Face width of each stage, length units; None if it is not given.
    """
    train = flow.train
    geometries = iter(describe_meshes(train))
    loaded: list[JsonObject] = []
    for number, (stage, meshes, efficiencies, turns, torque) in enumerate(
        zip(train.stages, train.meshes, flow.shares, train.speeds, flow.torques[:-1], strict=True)
    ):
        begin = len(loaded)
        if stage.kind == "worm":
            worm_mesh = _describe_loaded_worm(flow, stage, torque, float(turns[0]) * flow.speed)
            loaded.append({**next(geometries).model_dump(), **worm_mesh, "efficiency": efficiencies[0]})
            continue
        # The tangential force is that on the driving gear. It passes through idlers, and each mesh reduces it by its
        # losses. If the output drives, the force at each mesh is larger than that on the gear towards the input.
        radius = _compute_force_radius(stage, train)
        # Shifted gears run on working circles, whose radii are those of the pitch circles times the ratio of distances.
        if stage.shifts != (0.0, 0.0):
            radius *= meshes[0].centre_distance / meshes[0].standard_distance
        force = abs(torque) / (radius * flow.unit)
        for (driver, driven), mesh, share, turn in zip(
            itertools.pairwise(stage.gears), meshes, efficiencies, turns[:-1], strict=True
        ):
            passed = 1.0 if share is None else share
            if flow.flows_back:
                force /= passed
            on_pitch_circle = stage.shifts == (0.0, 0.0) and stage.kind == "external"
            pitch_radius = 0.5 * stage.module * driver if on_pitch_circle else radius
            # Approach and recess of the mesh are defined with the smaller gear driving; otherwise they change places.
            approach, recess = (mesh.approach, mesh.recess)[:: 1 if driver <= driven else -1]
            loaded.append(
                {
                    **next(geometries).model_dump(),
                    "path_of_contact": mesh.path_of_contact,
                    "approach": approach,
                    "recess": recess,
                    "clearance": mesh.clearance,
                    "efficiency": share,
                    "pitch_line_velocity": abs(float(turn) * flow.speed) * pitch_radius,
                    "tangential_force": force,
                    "radial_force": force * math.tan(mesh.pressure_angle),
                    # The thrust changes sides with the direction of rotation and with the driving gear.
                    **_compute_side_forces(stage, train, force, 1.0 if (turn > 0) != flow.flows_back else -1.0),
                }
            )
            if strength is not None:
                place = len(loaded) - begin - 1
                power = force * abs(float(turn) * flow.speed) * flow.unit * 0.5 * stage.module * driver
                if stage.shifts != (0.0, 0.0):
                    power *= mesh.centre_distance / mesh.standard_distance
                # The pitch diameter of a helical gear is the normal module times the teeth, divided by the cosine.
                power /= math.cos(stage.helix_angle)
                turning = abs(float(turn) * flow.speed)
                loaded[-1]["strength"] = _describe_strength(
                    flow, strength, stage, place, widths[number], power, turning
                )
            if not flow.flows_back:
                force *= passed
    return loaded


def _compute_force_radius(stage: TrainStage, train: OrdinaryTrain) -> float:
    """Compute the radius at which the tangential force of an unshifted stage acts on the driver, length units."""
    if stage.kind == "helical":
        return 0.5 * stage.module * stage.driver / math.cos(stage.helix_angle)
    radius = 0.5 * stage.module * stage.driver
    if stage.kind == "bevel" and stage.face_width is not None:
        # The force on a bevel gear acts in the middle of the face, nearer to the axis than the outer pitch circle.
        radius -= 0.5 * stage.face_width * math.sin(stage.cones(train.pressure_angle).cones[0])
    return radius


def _compute_side_forces(stage: TrainStage, train: OrdinaryTrain, force: float, way: float) -> JsonObject:
    """Compute the axial forces of helical gears, or the axial and radial forces of bevel gears, in form of fields.

    ``force`` is the tangential force, N; ``way`` is the sign of the thrust of helical gears.
    """
    if stage.kind == "helical":
        axial = force * math.tan(stage.helix_angle) * way
        return {"axial_force": {"driver": axial, "driven": -axial}}
    if stage.kind == "bevel":
        # The separating force is normal to the pitch cone, so the cone angle resolves it into radial and axial parts.
        apart, (one, two) = force * math.tan(train.pressure_angle), stage.cones(train.pressure_angle).cones
        return {
            "radial_force": apart * math.cos(one),
            "radial_forces": {"driver": apart * math.cos(one), "driven": apart * math.cos(two)},
            "axial_force": {"driver": apart * math.sin(one), "driven": apart * math.sin(two)},
        }
    return {}


def _describe_loaded_worm(flow: Flow, stage: TrainStage, torque: float, turning: float) -> JsonObject:
    """Describe the contact of a worm and its gear in the middle plane, and their forces."""
    worm, friction = stage.worm(flow.train.pressure_angle), stage.friction
    # If the gear drives, the friction acts in the opposite direction.
    sign = -1.0 if flow.flows_back else 1.0
    forces = worm.forces(abs(torque) / flow.unit, sign * friction)
    return {
        "path_of_contact": worm.approach + worm.recess,
        "approach": worm.approach,
        "recess": worm.recess,
        # Both have full-depth teeth, so the clearance is the difference of dedendum and addendum.
        "clearance": (FULL_DEPTH_DEDENDUM - FULL_DEPTH_ADDENDUM) * worm.module,
        "pitch_line_velocity": abs(turning) * 0.5 * worm.dimensions.worm_diameter,
        "tangential_force": forces.gear,
        "radial_force": forces.radial,
        "axial_force": {"driver": forces.gear, "driven": forces.worm},
    }


def _describe_strength(
    flow: Flow,
    method: StrengthMethod,
    stage: TrainStage,
    place: int,
    width: float | None,
    power: float,
    turning: float,
) -> JsonObject:
    """Describe the stresses of a mesh of a stage, computed in millimetres, with its gears in the order of the flow."""
    unit = 1000.0 * flow.unit
    contact = build_stage_contact(stage, place, flow.train.pressure_angle, unit)
    ways = mark_idlers(stage, place)
    return describe_strength(
        LoadedPair(contact, power, turning, ways, helix_angle=stage.helix_angle), method, width, unit
    )
