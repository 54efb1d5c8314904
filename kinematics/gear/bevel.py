"""Straight bevel gears: pitch cones of intersecting shafts, and the proportions of their teeth.

With the shaft angle Σ and the ratio G = z₂/z₁ the pitch cone angles are tan γ₁ = sin Σ / (G + cos Σ), γ₂ = Σ − γ₁
(Norton, Design of Machinery, Sec. 9.5, bevel gears; Rao, Sec. 7.7–7.8). Angles are radians.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from kinematics.errors import DimensionError
from kinematics.gear.teeth import PRESSURE_ANGLE


def cone_angles(shaft_angle: float, ratio: float) -> tuple[float, float]:
    """Pitch cone angles of pinion and gear for a ratio of at least 1.

    Raises
    ------
    DimensionError
        For shafts that are parallel, or a ratio below 1.
    """
    if not 0.0 < shaft_angle < math.pi:
        raise DimensionError("shaft_angle", "between 0 and π", shaft_angle)
    if not ratio >= 1.0:
        raise DimensionError("ratio", "at least 1", ratio)
    pinion = math.atan2(math.sin(shaft_angle), ratio + math.cos(shaft_angle))
    return pinion, shaft_angle - pinion


@dataclass(frozen=True)
class BevelPair:
    """A pinion and a gear of straight teeth at a right angle, with the pinion's addendum lengthened for strength.

    Depths are those of the Gleason system (Shigley & Mischke, Mechanical Engineering Design, Tab. 13-3; Rao, 7.8). With
    the diametral pitch P of the large end: working depth 2/P, whole depth 2.188/P + 0.005 (a length in the unit of the
    distances), gear addendum (0.540 + 0.460/G²)/P. Equal gears, G = 1, have equal addenda 1/P.
    """

    pinion: int
    gear: int
    diametral_pitch: float
    pressure_angle: float = PRESSURE_ANGLE

    def __post_init__(self) -> None:
        if not (0 < self.pinion <= self.gear and self.diametral_pitch > 0.0):
            raise DimensionError("teeth", "pinion teeth not above gear teeth, all positive", (self.pinion, self.gear))

    @property
    def cones(self) -> tuple[float, float]:
        """Pitch cone angles of pinion and gear."""
        return cone_angles(0.5 * math.pi, self.gear / self.pinion)

    @property
    def pitch_radii(self) -> tuple[float, float]:
        """At the large end."""
        return 0.5 * self.pinion / self.diametral_pitch, 0.5 * self.gear / self.diametral_pitch

    @property
    def equivalent_radii(self) -> tuple[float, float]:
        """Pitch radii of the spur gears that the back cones roll out to, r / cos γ (Tredgold)."""
        (first, second), (one, other) = self.pitch_radii, self.cones
        return first / math.cos(one), second / math.cos(other)

    @property
    def cone_distance(self) -> float:
        """From the apex to the large end."""
        return math.hypot(*self.pitch_radii)

    @property
    def working_depth(self) -> float:
        """2 / P."""
        return 2.0 / self.diametral_pitch

    @property
    def whole_depth(self) -> float:
        """2.188 / P + 0.005."""
        return 2.188 / self.diametral_pitch + 0.005

    @property
    def addenda(self) -> tuple[float, float]:
        """Of pinion and gear."""
        gear = (0.54 + 0.46 * (self.pinion / self.gear) ** 2) / self.diametral_pitch
        return self.working_depth - gear, gear

    @property
    def dedenda(self) -> tuple[float, float]:
        """2.188/P less the addendum."""
        first, second = self.addenda
        return 2.188 / self.diametral_pitch - first, 2.188 / self.diametral_pitch - second

    @property
    def circular_pitch(self) -> float:
        """π / P at the large end."""
        return math.pi / self.diametral_pitch

    @property
    def thicknesses(self) -> tuple[float, float]:
        """Circular tooth thicknesses: the longer addendum has the thicker tooth, t₂ = p/2 − (a₁ − a₂) tan φ."""
        first, second = self.addenda
        gear = 0.5 * self.circular_pitch - (first - second) * math.tan(self.pressure_angle)
        return self.circular_pitch - gear, gear
