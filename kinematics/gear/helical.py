"""Helical gears on parallel and on crossed shafts.

With the helix angle ψ and the normal module m_n the transverse module is m_n / cos ψ; the teeth are those of a spur
gear in the normal plane, of z / cos³ ψ virtual teeth (Norton, Design of Machinery, Sec. 9.4; Rao, Sec. 7.2–7.5).
Shafts that cross at the angle Σ take helix angles of ψ₁ + ψ₂ = Σ, of equal hand where both are positive. Angles are
radians.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from kinematics.errors import DimensionError
from kinematics.gear.teeth import PRESSURE_ANGLE, Gear

USUAL_OVERLAP = 1.15
"""Usual minimum advance of a tooth over the face, in transverse pitches (Rao, Sec. 7.4)."""


@dataclass(frozen=True)
class HelicalGear:
    """A helical gear of full-depth teeth in the normal plane; a negative helix angle is of the other hand.

    Raises
    ------
    DimensionError
        For a helix angle of 90° or more, or teeth or a module that are not positive.
    """

    teeth: int
    normal_module: float
    helix_angle: float
    normal_pressure_angle: float = PRESSURE_ANGLE

    def __post_init__(self) -> None:
        if not abs(self.helix_angle) < 0.5 * math.pi:
            raise DimensionError("helix_angle", "kinematics-less-than-right-angle", self.helix_angle)
        if not (self.teeth > 0 and 0.0 < self.normal_module < math.inf):
            raise DimensionError(
                "kinematics-teeth-and-normal-module", "kinematics-positive", (self.teeth, self.normal_module)
            )

    @property
    def transverse_module(self) -> float:
        """Module in the plane of rotation, m_n / cos ψ."""
        return self.normal_module / math.cos(self.helix_angle)

    @property
    def pitch_radius(self) -> float:
        """Pitch radius z m_t / 2."""
        return 0.5 * self.teeth * self.transverse_module

    @property
    def transverse_pitch(self) -> float:
        """Circular pitch in the plane of rotation."""
        return math.pi * self.transverse_module

    @property
    def axial_pitch(self) -> float:
        """Distance of neighbouring teeth along the shaft, π m_n / sin ψ; infinite for spur teeth."""
        slope = math.sin(abs(self.helix_angle))
        # Spur teeth never advance along the shaft.
        return math.pi * self.normal_module / slope if slope else math.inf

    @property
    def transverse_pressure_angle(self) -> float:
        """Pressure angle in the plane of rotation, tan φ_t = tan φ_n / cos ψ (Norton, eq. 9.10)."""
        return math.atan(math.tan(self.normal_pressure_angle) / math.cos(self.helix_angle))

    @property
    def virtual_teeth(self) -> float:
        """Teeth of the equivalent spur gear in the normal plane, z / cos³ ψ (Norton, eq. 9.11)."""
        return self.teeth / math.cos(self.helix_angle) ** 3

    @property
    def transverse_gear(self) -> Gear:
        """Spur gear of the transverse plane: its meshes have the transverse contact ratio."""
        # Depths are given in normal modules, the spur gear's in transverse modules.
        shrunk = math.cos(self.helix_angle)
        return Gear(
            self.teeth,
            self.transverse_module,
            self.transverse_pressure_angle,
            shrunk,
            1.25 * shrunk,
            helix_angle=self.helix_angle,
        )

    def min_face_width(self, overlap: float = USUAL_OVERLAP) -> float:
        """Return the face over which a tooth advances by ``overlap`` transverse pitches: overlap × axial pitch."""
        return overlap * self.axial_pitch
