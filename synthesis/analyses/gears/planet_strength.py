"""Strength of a given planetary train: the fields of the design that it needs, and the load of every mesh."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Annotated

from pydantic import Field, ValidationError

from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from kinematics.gear.assembly import is_coaxial
from kinematics.gear.planetary import Train
from kinematics.gear.power import PowerFlow
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, Gear
from kinematics.message import compose
from synthesis.analyses.gears.given_planetary_train import GivenPlanetaryTrain
from synthesis.model.dynamics.request import METRES_PER_UNIT
from synthesis.model.gears.planet_strength import MeshLoad, PlanetStrength, count_planes, describe_strengths
from synthesis.model.gears.request import CommonPressureAngle, Module
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Count, Statement

Share = Annotated[float, Field(strict=True, gt=0.0, le=1.5)]


class StrengthTrain(Statement):
    """Fields of a design besides its teeth that the strength needs."""

    planets: Annotated[Count, Field(ge=1, le=12)]
    module: Module
    pressure_angle: CommonPressureAngle = 20.0
    addendum: dict[str, Share] = Field(default={})

    def build_gears(self, arrangement: Arrangement, teeth: dict[str, int]) -> dict[str, Gear]:
        """Build the gears by name, in the unit of the module."""
        return {
            name: Gear(
                count,
                self.module,
                math.radians(self.pressure_angle),
                self.addendum.get(name, FULL_DEPTH_ADDENDUM),
                internal=arrangement.places[name].internal,
            )
            for name, count in teeth.items()
        }


def parse_strength_train(mechanism: GivenPlanetaryTrain) -> StrengthTrain:
    """Extract the fields of a mechanism that the strength needs.

    Raises
    ------
    pydantic.ValidationError
        If a field is missing.
    """
    stated = {name: getattr(mechanism, name) for name in StrengthTrain.model_fields}
    return StrengthTrain.model_validate({name: value for name, value in stated.items() if value is not None})


def find_strength_errors(mechanism: GivenPlanetaryTrain, method: PlanetStrength) -> list[tuple[str, str]]:
    """Return errors of a valid mechanism whose strength is requested."""
    faults = [(f"/strength{path}", detail) for path, detail in method.find_errors()]
    arrangement = ARRANGEMENTS.get(mechanism.arrangement or "")
    if arrangement is None:
        return [*faults, ("/strength", compose("analyses-strength-needs-arrangement"))]
    if arrangement.bevel:
        return [
            *faults,
            ("/strength", compose("analyses-bevel-differential-not-rated")),
        ]
    assert mechanism.teeth is not None
    # Such gears would need profile shifts, which the statement does not contain.
    if not is_coaxial(arrangement, mechanism.teeth):
        faults.append(
            (
                "/mechanism/teeth",
                compose("analyses-unshifted-gears-not-coaxial"),
            )
        )
    faces, planes = mechanism.face_widths, count_planes(arrangement)
    if faces is not None and len(faces) != planes:
        faults.append(("/mechanism/face_widths", compose("analyses-one-face-width-per-plane", count=planes)))
    if faces is None and not method.required_safeties:
        faults.append(("/mechanism/face_widths", compose("analyses-face-width-missing")))
    try:
        whole = parse_strength_train(mechanism)
    except ValidationError as error:
        wrong = [("/".join(["/mechanism", *map(str, one["loc"])]), one["msg"]) for one in error.errors()]
        return [*faults, *wrong]
    unknown = [name for name in whole.addendum if name not in arrangement.places]
    faults += [
        (f"/mechanism/addendum/{name}", compose("analyses-name-unknown", names=", ".join(arrangement.places)))
        for name in unknown
    ]
    return [*faults, *((f"/strength{path}", detail) for path, detail in method.find_planet_errors(whole.planets))]


def describe_mesh_strengths(
    mechanism: GivenPlanetaryTrain,
    method: PlanetStrength,
    train: Train,
    rates: dict[str, Fraction | None],
    flow: PowerFlow,
    speed: float,
    length_unit: str,
) -> list[JsonObject | None]:
    """Describe the strength of every mesh in the form of ``PairStrength``; None for an unloaded mesh.

    ``rates`` are the speeds of all bodies over that of the input; ``speed`` is that of the input, rad/s.
    """
    assert mechanism.arrangement is not None
    assert mechanism.teeth is not None
    arrangement = ARRANGEMENTS[mechanism.arrangement]
    loads = []
    for mesh, load in zip(train.meshes, flow.meshes, strict=True):
        # Teeth roll at the speed relative to the carrier. A body whose speed is undetermined counts as at rest.
        past = (rates[mesh.first] or Fraction(0)) - (rates[mesh.carrier] or Fraction(0))
        # The torques contain the direction, so only the magnitude of the input speed is used.
        loads.append(MeshLoad((float(load.first_torque), float(load.second_torque)), float(past) * abs(speed)))
    whole = parse_strength_train(mechanism)
    gears = whole.build_gears(arrangement, mechanism.teeth)
    unit = 1000.0 * METRES_PER_UNIT[length_unit]
    return describe_strengths(arrangement, gears, loads, whole.planets, method, mechanism.face_widths, unit)
