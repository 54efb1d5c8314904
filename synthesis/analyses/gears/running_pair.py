"""Analysis of two cylindrical gears in mesh: spur or helical, with profile shifts, both external or one a ring.

All values are in the plane of rotation. External gears are cut by the rack of full-depth teeth, and a ring is shaped by
a cutter. The tools determine where the involutes begin, and so whether contact extends into a fillet. Lengths are in
the unit of the module.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import ConfigDict, Field, model_validator

from kinematics.errors import DimensionError
from kinematics.gear.flanks import (
    Contact,
    ShapedRing,
    compute_tip_shortening,
)
from kinematics.gear.helical import HelicalGear
from kinematics.gear.profile import draw_half_space
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, Gear, Mesh
from kinematics.message import compose
from synthesis.analyses.base import AnalysisRequest, Family
from synthesis.analyses.gears.gear_pair import MILLIMETRE, RAD_PER_S_PER_RPM
from synthesis.mechanisms.base import MechanismError
from synthesis.model.answer import Answer, optional_field
from synthesis.model.dimension import INVERSE_LENGTH
from synthesis.model.gears.answer import LIMIT_TOLERANCE, apply_tool_contact
from synthesis.model.gears.mesh_limits import DEFAULT_CUTTER_TEETH, choose_cutter_teeth
from synthesis.model.gears.request import Addendum, PressureAngle, ShiftCoefficient, ToothNumber
from synthesis.model.gears.strength import LoadedPair, PairStrength, StrengthSpec, describe_strength
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Flag, Number, PositiveNumber, Statement

PITCH_TOLERANCE = 1e-9
"""Relative difference of a module and a diametral pitch that are given together, up to which they are the same."""


@dataclass(frozen=True)
class RunningPair:
    """Two gears in mesh, in the plane of rotation.

    Attributes
    ----------
    contact : Contact
        The gears at their centre distance, with the starts of their involutes.
    tight : Mesh
        The gears at the centre distance without play.
    shortening : float
        Shortening of the tips, in modules of the plane of rotation.
    ring : ShapedRing or None
        The second gear as shaped by its cutter, if it is a ring.
    undercut : pair of bool
        Whether the rack undercuts the first and the second gear; False for a ring.
    """

    contact: Contact
    tight: Mesh
    shortening: float
    ring: ShapedRing | None
    undercut: tuple[bool, bool]

    @property
    def cut_gears(self) -> tuple[Gear, Gear]:
        """Both gears, as cut."""
        return self.contact.mesh.pinion, self.contact.mesh.gear

    @property
    def compute_root_radii(self) -> tuple[float, float]:
        """Root radii of both gears, as left by the tools."""
        one, two = self.cut_gears
        return one.root_radius, two.root_radius if self.ring is None else self.ring.root_radius

    @property
    def compute_form_radii(self) -> tuple[float, float]:
        """Radii at which the involutes begin, or end for a ring."""
        one, two = (
            math.hypot(gear.base_radius, form) for gear, form in zip(self.cut_gears, self.contact.forms, strict=True)
        )
        return one, two

    @property
    def compute_clearance(self) -> float:
        """Minimum clearance between the tips of a gear and the root of its mate."""
        distance, (one, two), roots = self.contact.mesh.centre_distance, self.cut_gears, self.compute_root_radii
        # In an internal pair, both clearances are measured on the side of the mesh.
        if two.internal:
            return min(roots[1] - distance - one.tip_radius, two.tip_radius - distance - roots[0])
        return min(distance - one.tip_radius - roots[1], distance - two.tip_radius - roots[0])


class GivenGearPair(Statement):
    """Two gears on parallel shafts, the second of them external or a ring."""

    type: Literal["gear_pair"]
    teeth: tuple[ToothNumber, ToothNumber]
    module: PositiveNumber = Field(default=1.0, description="Module; for helical teeth in the normal plane.")
    diametral_pitch: Annotated[PositiveNumber, INVERSE_LENGTH] | None = Field(
        default=None,
        description="Teeth per length unit of pitch diameter, in place of the module; for helical teeth in the normal "
        "plane.",
    )
    shift: tuple[ShiftCoefficient, ShiftCoefficient] = Field(
        default=(0.0, 0.0), description="Profile shifts in modules, positive outwards, also for a ring."
    )
    addendum: tuple[Addendum, Addendum] = Field(
        default=(FULL_DEPTH_ADDENDUM, FULL_DEPTH_ADDENDUM),
        description="Addenda of both gears, modules. Full-depth teeth of a ring reach below the involute that a rack "
        "leaves on the pinion, so rings are made with shorter teeth.",
    )
    internal: Flag = Field(default=False, description="Whether the second gear is a ring.")
    helix_angle: Annotated[float, Field(strict=True, gt=-60.0, lt=60.0)] = Field(
        default=0.0, description="Helix angle, degrees."
    )
    pressure_angle: PressureAngle = Field(default=20.0, description="Pressure angle in the normal plane, degrees.")
    centre_distance: PositiveNumber | None = Field(
        default=None, description="Centre distance; by default the distance without play."
    )
    face_width: PositiveNumber | None = None
    cutter_teeth: ToothNumber | None = Field(
        default=None,
        description=f"Teeth of the cutter that shapes a ring; by default {DEFAULT_CUTTER_TEETH}, or half as many as "
        "the ring has if that is less. The cutter has no profile shift, an addendum of 1.25 modules and sharp corners.",
    )

    @model_validator(mode="before")
    @classmethod
    def _fill_module(cls, given: object) -> object:
        """Take the module from the diametral pitch."""
        if not isinstance(given, dict) or given.get("module") is not None:
            return given
        pitch = given.get("diametral_pitch")
        # Other values are refused by the field itself.
        return {**given, "module": 1.0 / pitch} if isinstance(pitch, int | float) and pitch > 0.0 else given

    @model_validator(mode="after")
    def _check_module(self) -> Self:
        pitch = self.diametral_pitch
        if pitch is not None and not math.isclose(self.module * pitch, 1.0, rel_tol=PITCH_TOLERANCE):
            raise ValueError(compose("analyses-module-and-pitch"))
        return self

    def build_pair(self) -> RunningPair:
        """Build the gears in mesh.

        Raises
        ------
        MechanismError
            For teeth that cannot form a pair.
        """
        try:
            return self._build_pair()
        except DimensionError as error:
            raise MechanismError(self._locate_error(error), str(error)) from error

    def _locate_error(self, error: DimensionError) -> str:
        named = {"kinematics-centre-distance": "/centre_distance", "dedendum": "/pressure_angle"}
        return named.get(error.name, "/teeth")

    def _build_pair(self) -> RunningPair:
        angle, phi = math.radians(self.helix_angle), math.radians(self.pressure_angle)
        full = self._build_gear(0, angle, phi), self._build_gear(1, angle, phi)
        # The tight mesh uses unshortened tips, because shortening does not change the distance without play.
        tight = Mesh(full[0], full[1])
        # Shifted external gears at their centre distance lose clearance, so their tips are shortened by this amount.
        shortening = compute_tip_shortening(Mesh(full[0], full[1], self.centre_distance))
        one, two = (replace(gear, addendum=gear.addendum - shortening) for gear in full)
        for gear, message in ((one, "analyses-first-gear-without-flank"), (two, "analyses-second-gear-without-flank")):
            # Without a flank above the base circle there is no involute.
            if not gear.internal and gear.tip_radius <= gear.base_radius:
                raise MechanismError("/shift", compose(message))
        ring = ShapedRing(two, self._choose_cutter_teeth) if self.internal else None
        contact = apply_tool_contact(Mesh(one, two, self.centre_distance), ring, angle)
        return RunningPair(contact, tight, shortening, ring, (one.is_undercut, two.is_undercut))

    def _build_gear(self, place: int, angle: float, phi: float) -> Gear:
        plain = HelicalGear(self.teeth[place], self.module, angle, phi).transverse_gear
        # Shift and addendum are given in normal modules; convert them to modules of the plane of rotation.
        shift, ring = self.shift[place] * math.cos(angle), self.internal and place == 1
        addendum = self.addendum[place] * math.cos(angle)
        return replace(plain, addendum=addendum, shift=shift, internal=ring)

    @property
    def _choose_cutter_teeth(self) -> int:
        return int(choose_cutter_teeth(self.teeth[1])) if self.cutter_teeth is None else self.cutter_teeth


class RunningGear(Answer):
    """One gear of a pair; lengths in the module's unit, thicknesses in the plane of rotation."""

    teeth: int
    shift: float = Field(description="Profile shift, modules.")
    speed: float = Field(description="Speed, rad/s; the second of two external gears turns the other way.")
    pitch_diameter: float
    working_pitch_diameter: float
    base_diameter: float
    tip_diameter: float
    root_diameter: float = Field(
        description="Diameter of the root circle, which the rack cuts, or the cutter of a ring."
    )
    form_diameter: float = Field(
        description="Diameter at which the involute ends; for an undercut gear where its fillet crosses the flank."
    )
    tooth_thickness: float = Field(description="Tooth thickness on the pitch circle.")
    tip_thickness: float | None = Field(description="Tip thickness; null if a ring's tips lie below its base circle.")
    least_shift: float | None = Field(description="Profile shift below which the rack undercuts; null for a ring.")
    undercut: bool
    involute_left: float = Field(
        description="Length of the line of action between the deepest contact and the fillet; negative if the contact "
        "reaches into the fillet.",
    )
    fillet_interference: bool = Field(description="Whether the mate's tip reaches below the involute of this gear.")
    specific_sliding: float | None = Field(
        description="Ratio of sliding to rolling at the deepest contact; null at or below the base circle."
    )


class ToothSpace(Answer):
    """The outline from the middle of one tooth to that of the next, in the plane of rotation, about the gear's centre.

    A gear has it at every pitch of 360°/z. The teeth are in mesh with the first gear at the origin and the centre of
    the second at (centre distance, 0); that of a ring at (−centre distance, 0).
    """

    x: list[float]
    y: list[float]


class RunningPairAnalysis(Answer):
    """Analysis of two gears in mesh; degrees, lengths in the module's unit."""

    ratio: float = Field(description="Speed of the first gear over the second, without sign.")
    centre_distance: float
    standard_distance: float = Field(description="Centre distance of the pitch circles.")
    tight_distance: float = Field(description="Centre distance without play.")
    working_pressure_angle: float = Field(description="Working pressure angle in the plane of rotation, degrees.")
    backlash: float = Field(description="Play on the working pitch circles; negative: the teeth would overlap.")
    contact_ratio: float = Field(description="Contact ratio in the plane of rotation, limited by the tips.")
    overlap_ratio: float | None = Field(description="Face width over axial pitch of helical teeth.")
    tip_shortening: float = Field(
        description="Shortening of the tips of shifted external gears that keeps the clearance."
    )
    clearance: float = Field(description="The smaller clearance between a tip and the mate's root.")
    interference: bool = Field(description="Whether a tip touches the mate where it has no involute.")
    tips_foul: bool = Field(description="Whether the tips of an internal pair collide off the line of action.")
    cutter_teeth: int | None = Field(description="Teeth of the cutter that shapes a ring.")
    ring_trimmed: bool | None = Field(description="Whether that cutter trims the tips of the ring.")
    sound: bool = Field(
        description="No undercut, no contact in a fillet, no fouling or pointed tips, no overlap, and at least one "
        "pair of teeth in contact."
    )
    gears: list[RunningGear]
    strength: PairStrength | None = optional_field("Stresses under the given power.")
    profiles: list[ToothSpace | None] | None = optional_field(
        "Tooth outlines, if `include` contains `profiles`: involutes with the fillets that the rack of the normal "
        "plane leaves; a ring is drawn without the fillets of its cutter. Null if the rack's tooth would come to a "
        "point."
    )


class RunningPairRequest(AnalysisRequest):
    """Two gears, and how fast the first one turns."""

    model_config = ConfigDict(
        title="Running pair of gears",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "gear_pair", "teeth": [20, 50], "module": 2.0, "shift": [0.4, 0.1], "face_width": 20.0
                    },
                    "speed_rpm": 1450.0,
                    "strength": {
                        "method": "agma", "power_kw": 3.0, "allowable_bending": [200.0, 180.0],
                        "allowable_contact": [800.0, 750.0]
                    },
                }
            ]
        },
    )  # fmt: skip

    mechanism: GivenGearPair
    speed_rpm: Number = Field(default=1.0, description="Speed of the first gear, revolutions per minute.")
    length_unit: Literal["mm", "cm", "m", "in"] = Field(default="mm", description="Unit of the module, for `strength`.")
    strength: StrengthSpec | None = Field(
        default=None,
        description="Power that the gears carry; stresses are for the face width, or for the minimum that carries it.",
    )
    include: list[Literal["profiles"]] = Field(
        default=[], max_length=1, description="`profiles`: the true outlines of the teeth of both gears."
    )

    @classmethod
    def analyze_cycle(cls, mechanism: JsonObject, steps: int) -> JsonObject:
        """Build the answer, which does not depend on the input; no design is such a pair."""
        return cls.model_validate({"mechanism": mechanism}).build_answer()

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        given, faults = self.mechanism, []
        if given.internal and given.teeth[1] <= given.teeth[0]:
            faults.append(("/mechanism/teeth", compose("analyses-ring-not-second")))
        if given.cutter_teeth is not None and not given.internal:
            faults.append(("/mechanism/cutter_teeth", compose("analyses-cutter-needs-ring")))
        if given.cutter_teeth is not None and given.cutter_teeth >= given.teeth[1]:
            faults.append(("/mechanism/cutter_teeth", compose("analyses-cutter-too-large")))
        return [*faults, *self._find_strength_errors()]

    def _find_strength_errors(self) -> list[tuple[str, str]]:
        given, stated = self.mechanism, self.strength
        if stated is None:
            return []
        wrong = stated.find_errors() + (stated.find_ring_errors() if given.internal else [])
        if given.helix_angle != 0.0 and not given.internal:
            wrong += stated.find_helix_errors()
        faults = [(f"/strength{path}", detail) for path, detail in wrong]
        if given.helix_angle != 0.0 and given.internal:
            faults.append(("/strength", compose("analyses-helical-ring-not-rated")))
        if self.speed_rpm == 0.0:
            faults.append(("/speed_rpm", compose("analyses-no-power-at-rest")))
        if given.face_width is None and stated.allowable_bending is None and stated.allowable_contact is None:
            faults.append(("/mechanism/face_width", compose("analyses-face-width-missing")))
        return faults

    def build_answer(self) -> JsonObject:
        """Build the complete answer for the pair, in the form of :class:`RunningPairAnalysis`."""
        given, pair = self.mechanism, self.mechanism.build_pair()
        mesh, angle = pair.contact.mesh, math.radians(given.helix_angle)
        slack = LIMIT_TOLERANCE * mesh.pinion.module
        gears = _describe_gears(given, pair, self.speed_rpm * RAD_PER_S_PER_RPM)
        deepest = pair.contact.reaches
        # A ring has no tangent point within its teeth, so only its base circle limits the contact.
        interferes = deepest[0] < -slack or (deepest[1] < -slack and not given.internal)
        if given.internal:
            interferes = interferes or mesh.gear.tip_radius < mesh.gear.base_radius
        thin = any(gear["tip_thickness"] is None or gear["tip_thickness"] <= 0.0 for gear in gears)
        faulty = any(gear["undercut"] or gear["fillet_interference"] for gear in gears)
        trimmed = None if pair.ring is None else pair.ring.is_trimmed
        backlash = pair.contact.backlash
        bad = interferes or thin or faulty or mesh.tips_foul or bool(trimmed) or pair.compute_clearance < -slack
        answer: JsonObject = {
            "ratio": given.teeth[1] / given.teeth[0],
            "centre_distance": mesh.centre_distance,
            "standard_distance": mesh.standard_distance,
            "tight_distance": pair.tight.centre_distance,
            "working_pressure_angle": math.degrees(mesh.pressure_angle),
            "backlash": backlash,
            "contact_ratio": mesh.contact_ratio,
            "overlap_ratio": _compute_overlap(given, angle),
            "tip_shortening": pair.shortening * mesh.pinion.module,
            "clearance": pair.compute_clearance,
            "interference": interferes,
            "tips_foul": mesh.tips_foul,
            "cutter_teeth": None if pair.ring is None else pair.ring.cutter_teeth,
            "ring_trimmed": trimmed,
            "sound": not bad and backlash >= -slack and mesh.contact_ratio >= 1.0,
            "gears": gears,
        }
        if self.strength is not None:
            answer["strength"] = self._describe_strength(self.strength)
        if self.include:
            answer["profiles"] = [_describe_space(pair, place, angle) for place in range(2)]
        return answer

    def _describe_strength(self, method: StrengthSpec) -> JsonObject:
        """Describe the stresses of the pair, computed in millimetres because stresses are in MPa."""
        unit = 1.0 / MILLIMETRE[self.length_unit]
        given = self.mechanism
        distance = None if given.centre_distance is None else given.centre_distance * unit
        large = given.model_copy(update={"module": given.module * unit, "centre_distance": distance})
        helix = math.radians(given.helix_angle)
        loaded = LoadedPair(
            large.build_pair().contact,
            1000.0 * method.power_kw,
            abs(self.speed_rpm) * RAD_PER_S_PER_RPM,
            helix_angle=helix,
        )
        return describe_strength(loaded, method, given.face_width, unit)


def _describe_space(pair: RunningPair, place: int, helix_angle: float) -> dict[str, list[float]] | None:
    """Draw a tooth space in the form of :class:`ToothSpace`; None if the rack's tooth would come to a point.

    The first gear has a tooth on the line of centres, and its space is next to it. The space of the second gear is
    centred on that line.
    """
    gear = pair.cut_gears[place]
    try:
        half = draw_half_space(gear, helix_angle)
    except DimensionError:
        return None
    # Turn the space by half a pitch for the first gear, so that its tooth meets the space of the second.
    toward = math.pi / gear.teeth if place == 0 else 0.0 if gear.internal else math.pi
    # Half of the space is drawn, from its middle; mirror it for the other flank, without repeating the first point.
    points = np.concatenate([half[::-1].conj(), half[1:]]) * cmath.exp(1j * toward)
    return {"x": points.real.tolist(), "y": points.imag.tolist()}


def _compute_overlap(given: GivenGearPair, angle: float) -> float | None:
    # Spur teeth have no axial overlap.
    if given.face_width is None or angle == 0.0:
        return None
    return given.face_width * math.sin(abs(angle)) / (math.pi * given.module)


def _describe_gears(given: GivenGearPair, pair: RunningPair, speed: float) -> list[JsonObject]:
    contact, mesh = pair.contact, pair.contact.mesh
    # Working circles are larger than pitch circles by the ratio of the cosines, as the base circles stay the same.
    wide = math.cos(mesh.pinion.pressure_angle) / math.cos(mesh.pressure_angle)
    turns = speed, speed * given.teeth[0] / given.teeth[1] * (1.0 if given.internal else -1.0)
    gears = []
    for place, gear in enumerate(pair.cut_gears):
        left, sliding = contact.margins[place], contact.specific_sliding[place]
        tip, form = gear.thickness_at(gear.tip_radius), pair.compute_form_radii[place]
        gears.append(
            {
                "teeth": given.teeth[place],
                "shift": given.shift[place],
                "speed": turns[place],
                "pitch_diameter": 2.0 * gear.pitch_radius,
                "working_pitch_diameter": 2.0 * gear.pitch_radius * wide,
                "base_diameter": 2.0 * gear.base_radius,
                "tip_diameter": 2.0 * gear.tip_radius,
                "root_diameter": 2.0 * pair.compute_root_radii[place],
                "form_diameter": 2.0 * form,
                "tooth_thickness": gear.tooth_thickness,
                "tip_thickness": None if math.isnan(tip) else tip,
                "least_shift": None if gear.internal else gear.least_shift / math.cos(gear.helix_angle),
                "undercut": pair.undercut[place],
                "involute_left": left,
                "fillet_interference": left < -LIMIT_TOLERANCE * gear.module,
                "specific_sliding": sliding if math.isfinite(sliding) else None,
            }
        )
    return gears


FAMILY = Family(RunningPairRequest, RunningPairAnalysis)
