"""Dimensions of pairs of helical gears (on parallel or crossed shafts), of bevel gears, and of a worm with its gear.

The pairs are not part of a train; the speed of the first gear determines that of the second. Lengths are in the unit of
the module, by default millimetres.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.gear.bevel import GLEASON_TEETH, RAO_TEETH, BevelPair
from kinematics.gear.helical import HelicalGear
from kinematics.gear.teeth import Mesh
from kinematics.gear.worm import WormSet
from kinematics.message import compose
from synthesis.analyses.base import AnalysisRequest, Family
from synthesis.mechanisms.base import MechanismError
from synthesis.model.answer import Answer
from synthesis.model.gears.request import PressureAngle, ToothNumber
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Number, PositiveNumber, Statement

RAD_PER_S_PER_RPM = 2.0 * math.pi / 60.0

MILLIMETRE = {"mm": 1.0, "cm": 0.1, "m": 0.001, "in": 1.0 / 25.4}
"""Length of one millimetre in each length unit."""

BEVEL_TEETH = {"rao": RAO_TEETH, "gleason": GLEASON_TEETH}


class GivenHelicalPair(Statement):
    """Two helical gears. On parallel shafts the second helix angle is the first one's opposite."""

    type: Literal["helical_pair"]
    teeth: tuple[ToothNumber, ToothNumber]
    normal_module: PositiveNumber
    helix_angle: Annotated[float, Field(strict=True, gt=-85.0, lt=85.0)] = Field(
        description="Helix angle of the first gear, degrees; its sign gives the hand."
    )
    shaft_angle: Annotated[float, Field(strict=True, ge=0.0, le=90.0)] = Field(
        default=0.0, description="Angle between the shafts, degrees: the sum of both helix angles."
    )
    normal_pressure_angle: PressureAngle = 20.0
    face_width: PositiveNumber | None = None

    def build_gears(self) -> tuple[HelicalGear, HelicalGear]:
        """Build both gears.

        Raises
        ------
        MechanismError
            If the second helix angle is too large.
        """
        second = self.shaft_angle - self.helix_angle
        if not abs(second) < 85.0:
            raise MechanismError("/helix_angle", compose("analyses-second-helix-angle-too-large", angle=f"{second:g}"))
        angles = math.radians(self.helix_angle), math.radians(second)
        pressure = math.radians(self.normal_pressure_angle)
        first, other = (
            HelicalGear(z, self.normal_module, angle, pressure) for z, angle in zip(self.teeth, angles, strict=True)
        )
        return first, other


class GivenBevelPair(Statement):
    """Two straight bevel gears on shafts at a right angle."""

    type: Literal["bevel_pair"]
    teeth: tuple[ToothNumber, ToothNumber] = Field(
        description="Teeth of pinion and gear; the gear has at least as many as the pinion."
    )
    module: PositiveNumber = Field(description="Module at the large end.")
    pressure_angle: PressureAngle = 20.0
    tooth_system: Literal["rao", "gleason"] = Field(
        default="rao",
        description="Proportions of the teeth. rao: Rao, Sec. 7.8, gear addendum (0.540 + 0.400/G²) modules. "
        "gleason: (0.540 + 0.460/G²) modules, with which equal gears are alike.",
    )
    face_width: PositiveNumber | None = None


class GivenWormSet(Statement):
    """A worm and its gear on shafts at a right angle; the worm is the input."""

    type: Literal["worm_set"]
    threads: Annotated[int, Field(strict=True, ge=1, le=20)]
    gear_teeth: ToothNumber
    axial_pitch: PositiveNumber
    worm_diameter: PositiveNumber = Field(description="Pitch diameter of the worm.")
    friction: Annotated[float, Field(strict=True, ge=0.0, le=1.0)] = 0.1


class PairedGear(Answer):
    """One gear of a pair; angles in degrees, lengths in the module's unit."""

    teeth: int
    pitch_diameter: float
    outside_diameter: float | None = Field(description="Outside diameter; null without a tooth depth.")
    addendum: float | None
    dedendum: float | None
    helix_angle: float | None = Field(description="Helix angle; only for helical gears and worm sets.")
    pitch_cone_angle: float | None = Field(description="Cone angle; only for bevel gears.")
    virtual_teeth: float | None = Field(description="Teeth of the equivalent spur gear, not rounded.")
    circular_pitch: float = Field(
        description="Circular pitch in the plane of rotation; for bevel gears at the large end."
    )
    tooth_thickness: float | None
    speed: float = Field(description="rad/s")


class GearPairAnalysis(Answer):
    """Dimensions of a pair of gears."""

    ratio: float = Field(description="Speed of the first gear over the second, without sign.")
    centre_distance: float | None = Field(description="Centre distance; null for bevel gears, whose shafts intersect.")
    cone_distance: float | None = Field(description="Distance from the apex of bevel gears to the large end.")
    tooth_system: str | None = Field(description="Tooth proportions of bevel gears.")
    whole_depth: float | None
    transverse_contact_ratio: float | None = Field(
        description="Contact ratio in the plane of rotation; only for helical gears on parallel shafts."
    )
    face_contact_ratio: float | None = Field(description="Face width over axial pitch, if a face width is given.")
    least_face_width: float | None = Field(description="Face width for an overlap of 1.15 pitches.")
    lead: float | None = Field(description="Lead of the worm; only for a worm set.")
    lead_angle: float | None
    self_locking: bool | None = Field(description="Whether the gear cannot drive the worm, with square threads.")
    gears: list[PairedGear]


class _PairRequest(AnalysisRequest):
    speed_rpm: Number = Field(default=1.0, description="Speed of the first gear, revolutions per minute.")

    @classmethod
    def analyze_cycle(cls, mechanism: JsonObject, steps: int) -> JsonObject:
        """Build the answer, which does not depend on the input; no design is such a pair."""
        return cls.model_validate({"mechanism": mechanism}).build_answer()


def _build_schema_extra(title: str, mechanism: JsonObject) -> ConfigDict:
    return ConfigDict(title=title, json_schema_extra={"examples": [{"mechanism": mechanism, "speed_rpm": 1200.0}]})


class HelicalPairRequest(_PairRequest):
    """A pair of helical gears."""

    model_config = _build_schema_extra(
        "Helical gears",
        {"type": "helical_pair", "teeth": [20, 50], "normal_module": 3.0, "helix_angle": 18.0, "face_width": 40.0},
    )

    mechanism: GivenHelicalPair

    def build_answer(self) -> JsonObject:
        """Build the dimensions in the form of :class:`GearPairAnalysis`."""
        given = self.mechanism
        first, second = given.build_gears()
        parallel = given.shaft_angle == 0.0
        mesh = Mesh(first.transverse_gear, second.transverse_gear) if parallel else None
        face, speed = given.face_width, self.speed_rpm * RAD_PER_S_PER_RPM
        ratio = second.teeth / first.teeth
        gears = []
        for gear, turns in ((first, speed), (second, speed / ratio)):
            depths = gear.normal_module, 1.25 * gear.normal_module
            gears.append(
                _describe_gear(
                    gear.teeth, 2.0 * gear.pitch_radius, gear.transverse_pitch, turns,
                    outside_diameter=2.0 * (gear.pitch_radius + depths[0]), addendum=depths[0], dedendum=depths[1],
                    helix_angle=math.degrees(gear.helix_angle), virtual_teeth=gear.virtual_teeth,
                    tooth_thickness=0.5 * gear.transverse_pitch,
                )
            )  # fmt: skip
        helical = given.helix_angle != 0.0
        return _build_answer(
            ratio, gears,
            centre_distance=first.pitch_radius + second.pitch_radius,
            whole_depth=2.25 * given.normal_module,
            transverse_contact_ratio=None if mesh is None else mesh.contact_ratio,
            face_contact_ratio=face / first.axial_pitch if face is not None and parallel else None,
            least_face_width=first.min_face_width() if parallel and helical else None,
        )  # fmt: skip


class BevelPairRequest(_PairRequest):
    """A pair of straight bevel gears."""

    model_config = _build_schema_extra(
        "Bevel gears", {"type": "bevel_pair", "teeth": [20, 40], "module": 4.0, "face_width": 25.0}
    )

    mechanism: GivenBevelPair
    length_unit: Literal["mm", "cm", "m", "in"] = "mm"

    def find_errors(self) -> list[tuple[str, str]]:
        """Return an error if the gear has fewer teeth than its pinion."""
        if self.mechanism.teeth[0] > self.mechanism.teeth[1]:
            return [("/mechanism/teeth", compose("analyses-pinion-not-first"))]
        return []

    def build_answer(self) -> JsonObject:
        """Build the dimensions in the form of :class:`GearPairAnalysis`."""
        given, speed = self.mechanism, self.speed_rpm * RAD_PER_S_PER_RPM
        pair = BevelPair(
            *given.teeth, 1.0 / given.module, math.radians(given.pressure_angle), BEVEL_TEETH[given.tooth_system],
            MILLIMETRE[self.length_unit],
        )  # fmt: skip
        ratio = given.teeth[1] / given.teeth[0]
        gears = [
            _describe_gear(
                teeth, 2.0 * radius, pair.circular_pitch, turns,
                outside_diameter=2.0 * (radius + addendum * math.cos(cone)), addendum=addendum, dedendum=dedendum,
                pitch_cone_angle=math.degrees(cone), virtual_teeth=teeth / math.cos(cone), tooth_thickness=thickness,
            )
            for teeth, radius, cone, addendum, dedendum, thickness, turns in zip(
                given.teeth, pair.pitch_radii, pair.cones, pair.addenda, pair.dedenda, pair.thicknesses,
                (speed, speed / ratio), strict=True,
            )
        ]  # fmt: skip
        return _build_answer(
            ratio, gears, cone_distance=pair.cone_distance, whole_depth=pair.whole_depth,
            tooth_system=given.tooth_system,
        )  # fmt: skip


class WormSetRequest(_PairRequest):
    """A worm and its gear."""

    model_config = _build_schema_extra(
        "Worm and gear",
        {"type": "worm_set", "threads": 2, "gear_teeth": 40, "axial_pitch": 12.0, "worm_diameter": 50.0},
    )

    mechanism: GivenWormSet

    def build_answer(self) -> JsonObject:
        """Build the dimensions in the form of :class:`GearPairAnalysis`."""
        given, speed = self.mechanism, self.speed_rpm * RAD_PER_S_PER_RPM
        pair = WormSet(given.threads, given.gear_teeth, given.axial_pitch, given.worm_diameter)
        gears = [
            _describe_gear(
                given.threads, given.worm_diameter, math.pi * given.worm_diameter / given.threads, speed,
                helix_angle=math.degrees(pair.worm_helix_angle),
            ),
            _describe_gear(
                given.gear_teeth, pair.gear_diameter, given.axial_pitch, speed / pair.ratio,
                helix_angle=math.degrees(pair.lead_angle),
            ),
        ]  # fmt: skip
        return _build_answer(
            pair.ratio, gears, centre_distance=pair.centre_distance, lead=pair.lead,
            lead_angle=math.degrees(pair.lead_angle), self_locking=pair.is_locking(given.friction),
        )  # fmt: skip


def _describe_gear(teeth: int, pitch_diameter: float, circular_pitch: float, speed: float, **more: float) -> JsonObject:
    known = {"teeth": teeth, "pitch_diameter": pitch_diameter, "circular_pitch": circular_pitch, "speed": speed, **more}
    return {name: known.get(name) for name in PairedGear.model_fields}


def _build_answer(ratio: float, gears: list[JsonObject], **more: object) -> JsonObject:
    known = {"ratio": ratio, "gears": gears, **more}
    return {name: known.get(name) for name in GearPairAnalysis.model_fields}


HELICAL_FAMILY = Family(HelicalPairRequest, GearPairAnalysis)
BEVEL_FAMILY = Family(BevelPairRequest, GearPairAnalysis)
WORM_FAMILY = Family(WormSetRequest, GearPairAnalysis)
