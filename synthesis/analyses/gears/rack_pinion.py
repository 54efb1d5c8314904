"""Analysis of a pinion and its rack: travel, forms of the teeth, contact, and the fewest teeth without undercut.

The rack is a gear of infinite radius. It touches the pinion along the line of action, which meets the rack's tips at a
distance (a − x) m / sin φ before the pitch point, with the addendum a of the rack and the profile shift x of the
pinion. The involute of the pinion begins r sin φ before it. A rack whose tips reach farther interferes, and a rack
cutter of the same form undercuts, so that at least 2 (a − x) / sin² φ teeth are needed (Norton, *Design of Machinery*,
Sec. 9.4). Lengths are in the unit of the module; helical teeth are measured in the normal plane.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from kinematics.errors import DimensionError
from kinematics.gear.helical import HelicalGear
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, Gear
from synthesis.analyses.base import AnalysisRequest, Family
from synthesis.analyses.gears.gear_pair import RAD_PER_S_PER_RPM
from synthesis.mechanisms.base import MechanismError
from synthesis.model.answer import Answer
from synthesis.model.gears.request import Addendum, PressureAngle, ShiftCoefficient, ToothNumber
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Number, PositiveNumber, Statement

ROUNDING = 1e-9
"""Relative rounding of a number of teeth, and of the length by which a tip reaches too far."""


class GivenRackPinion(Statement):
    """A pinion and a rack."""

    type: Literal["rack_pinion"]
    teeth: ToothNumber = Field(description="Teeth of the pinion.")
    module: PositiveNumber = Field(default=1.0, description="Module; for helical teeth in the normal plane.")
    shift: ShiftCoefficient = Field(default=0.0, description="Profile shift of the pinion, modules.")
    addendum: tuple[Addendum, Addendum] = Field(
        default=(FULL_DEPTH_ADDENDUM, FULL_DEPTH_ADDENDUM), description="Addenda of pinion and rack, modules."
    )
    helix_angle: Annotated[float, Field(strict=True, gt=-60.0, lt=60.0)] = Field(
        default=0.0, description="Helix angle of the pinion, degrees."
    )
    pressure_angle: PressureAngle = Field(default=20.0, description="Pressure angle in the normal plane, degrees.")

    def build_pinion(self) -> Gear:
        """Build the pinion in the plane of rotation.

        Raises
        ------
        MechanismError
            If the pinion has no involute above its base circle.
        """
        angle = math.radians(self.helix_angle)
        try:
            plain = HelicalGear(self.teeth, self.module, angle, math.radians(self.pressure_angle)).transverse_gear
            # Shift and addendum are given in normal modules.
            gear = replace(plain, addendum=self.addendum[0] * math.cos(angle), shift=self.shift * math.cos(angle))
        except DimensionError as error:
            raise MechanismError("/teeth", str(error)) from error
        return gear


class RackPinionAnalysis(Answer):
    """Analysis of a pinion and a rack; degrees, lengths in the module's unit, in the plane of rotation."""

    travel: float = Field(description="Travel of the rack for one turn of the pinion.")
    speed: float = Field(description="Speed of the rack, per second.")
    pitch_diameter: float
    base_diameter: float
    tip_diameter: float
    reference_distance: float = Field(
        description="Distance of the pinion's axis from the rack's reference line, on which teeth and spaces are equal."
    )
    circular_pitch: float
    pressure_angle: float = Field(description="Pressure angle in the plane of rotation, degrees.")
    contact_ratio: float = Field(description="Contact ratio in the plane of rotation, limited by the involute.")
    interference: bool = Field(description="Whether the rack's tips reach below the involute of the pinion.")
    least_teeth: int = Field(description="Fewest teeth of a pinion without interference, with these addenda and shift.")
    least_shift: float = Field(description="Profile shift of this pinion without interference, modules.")


class RackPinionRequest(AnalysisRequest):
    """A pinion that drives a rack."""

    model_config = ConfigDict(
        title="Rack and pinion",
        json_schema_extra={
            "examples": [{"mechanism": {"type": "rack_pinion", "teeth": 20, "module": 2.0}, "speed_rpm": 60.0}]
        },
    )

    mechanism: GivenRackPinion
    speed_rpm: Number = Field(default=1.0, description="Speed of the pinion, revolutions per minute.")

    def build_answer(self) -> JsonObject:
        """Build the answer in the form of :class:`RackPinionAnalysis`."""
        given = self.mechanism
        pinion, normal = given.build_pinion(), given.module
        phi = pinion.pressure_angle
        radius, sine = pinion.pitch_radius, math.sin(phi)
        reach = (given.addendum[1] - given.shift) * normal / sine
        involute = radius * sine
        recess = math.sqrt(max(pinion.tip_radius**2 - pinion.base_radius**2, 0.0)) - involute
        pitch = math.tau * radius / given.teeth
        # The teeth of the pinion and the depth of the rack grow alike with the module, here per tooth.
        needed = reach / (involute / given.teeth)
        return {
            "travel": math.tau * radius,
            "speed": self.speed_rpm * RAD_PER_S_PER_RPM * radius,
            "pitch_diameter": 2.0 * radius,
            "base_diameter": 2.0 * pinion.base_radius,
            "tip_diameter": 2.0 * pinion.tip_radius,
            "reference_distance": radius + given.shift * normal,
            "circular_pitch": pitch,
            "pressure_angle": math.degrees(phi),
            "contact_ratio": max(recess + min(reach, involute), 0.0) / (pitch * math.cos(phi)),
            "interference": reach > involute * (1.0 + ROUNDING),
            "least_teeth": max(math.ceil(needed * (1.0 - ROUNDING)), 0),
            "least_shift": given.addendum[1] - involute * sine / normal,
        }

    @classmethod
    def analyze_cycle(cls, mechanism: JsonObject, steps: int) -> JsonObject:
        """Build the answer, which does not depend on the input; no design is a rack."""
        return cls.model_validate({"mechanism": mechanism}).build_answer()


FAMILY = Family(RackPinionRequest, RackPinionAnalysis)
