"""Straight bevel gears: pitch cones of intersecting shafts, and the proportions of their teeth.

With the shaft angle Σ and the ratio G = z₂/z₁ the pitch cone angles are tan γ₁ = sin Σ / (G + cos Σ), γ₂ = Σ − γ₁
(Norton, Design of Machinery, Sec. 9.5, bevel gears; Rao, Sec. 7.7–7.8). Angles are radians.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from kinematics.errors import DimensionError
from kinematics.gear.teeth import PRESSURE_ANGLE, Gear, Mesh


def compute_cone_angles(shaft_angle: float, ratio: float) -> tuple[float, float]:
    """Compute the pitch cone angles of pinion and gear for a ratio of at least 1.

    Raises
    ------
    DimensionError
        For shafts that are parallel, or a ratio below 1.
    """
    if not 0.0 < shaft_angle < math.pi:
        raise DimensionError("shaft_angle", "kinematics-between-0-and-pi", shaft_angle)
    if not ratio >= 1.0:
        raise DimensionError("ratio", "kinematics-at-least", ratio, least=1)
    # atan2 also covers obtuse shaft angles.
    pinion = math.atan2(math.sin(shaft_angle), ratio + math.cos(shaft_angle))
    return pinion, shaft_angle - pinion


MIN_CONE_COSINE = 1e-6
"""Bound below which a bevel gear counts as flat (a crown gear): z₁/z₂ + cos Σ, which is positive and vanishes there."""


@dataclass(frozen=True)
class BevelTeeth:
    """A system of straight bevel teeth at a right angle, with the pinion's addendum lengthened for strength.

    With the diametral pitch P of the large end and the ratio G the working depth is 2/P, the whole depth 2.188/P +
    ``added_depth``, and the gear's addendum (``least`` + ``lessening``/G²)/P; the pinion has the rest of 2/P.

    Attributes
    ----------
    least, lessening : float
        Coefficients of the gear's addendum.
    added_depth : float
        Constant part of the whole depth, millimetres.
    """

    least: float
    lessening: float
    added_depth: float


RAO_TEETH = BevelTeeth(0.540, 0.400, 0.05)
"""Rao, Sec. 7.8: gear addendum (0.540 + 0.400/G²)/P, whole depth 2.188/P + 0.005 cm. Gears of equal teeth, G = 1, have
unequal addenda 1.06/P and 0.94/P, so it matters which of them is called the pinion."""

GLEASON_TEETH = BevelTeeth(0.540, 0.460, 0.0508)
"""Gleason's 20° straight teeth (AGMA 208.03; Shigley & Mischke, Mechanical Engineering Design, Tab. 13-3): gear
addendum (0.540 + 0.460/G²)/P, whole depth 2.188/P + 0.002 in. Gears of equal teeth have equal addenda 1/P."""


@dataclass(frozen=True)
class BevelPair:
    """A pinion and a gear of straight teeth at a right angle.

    Parameters
    ----------
    pinion, gear : int
        Tooth numbers; the gear has no fewer teeth.
    diametral_pitch : float
        P at the large end, teeth per unit of pitch diameter.
    pressure_angle : float
        Radians.
    system : BevelTeeth
        Proportions of the teeth.
    millimetre : float
        One millimetre in the unit of the distances, for the constant part of the depth.
    """

    pinion: int
    gear: int
    diametral_pitch: float
    pressure_angle: float = PRESSURE_ANGLE
    system: BevelTeeth = RAO_TEETH
    millimetre: float = 1.0

    def __post_init__(self) -> None:
        if not (0 < self.pinion <= self.gear and self.diametral_pitch > 0.0):
            raise DimensionError("teeth", "kinematics-pinion-not-larger", (self.pinion, self.gear))

    @property
    def cones(self) -> tuple[float, float]:
        """Pitch cone angles of pinion and gear, radians."""
        return compute_cone_angles(0.5 * math.pi, self.gear / self.pinion)

    @property
    def pitch_radii(self) -> tuple[float, float]:
        """Pitch radii of pinion and gear at the large end."""
        return 0.5 * self.pinion / self.diametral_pitch, 0.5 * self.gear / self.diametral_pitch

    @property
    def cone_distance(self) -> float:
        """Distance from the apex to the large end."""
        return math.hypot(*self.pitch_radii)

    @property
    def working_depth(self) -> float:
        """Working depth, 2 / P."""
        return 2.0 / self.diametral_pitch

    @property
    def whole_depth(self) -> float:
        """Whole depth: 2.188 / P plus the constant length of the system, for clearance."""
        return 2.188 / self.diametral_pitch + self.system.added_depth * self.millimetre

    @property
    def addenda(self) -> tuple[float, float]:
        """Addenda of pinion and gear."""
        share = self.system.least + self.system.lessening * (self.pinion / self.gear) ** 2
        gear = share / self.diametral_pitch
        return self.working_depth - gear, gear

    @property
    def dedenda(self) -> tuple[float, float]:
        """Dedenda of pinion and gear: 2.188/P minus the addendum."""
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
        # Both thicknesses together fill the circular pitch.
        gear = 0.5 * self.circular_pitch - (first - second) * math.tan(self.pressure_angle)
        return self.circular_pitch - gear, gear


@dataclass(frozen=True)
class BevelCones:
    """The pitch cones of two external bevel gears whose shafts meet at any angle.

    The teeth are those of the spur gears on the developed back cones, with z / cos γ virtual teeth and full depth
    (Tredgold's approximation; Norton, Sec. 9.5).

    Attributes
    ----------
    driver, driven : int
        Tooth numbers.
    module : float
        Module at the large end.
    shaft_angle, pressure_angle : float
        Radians.

    Raises
    ------
    DimensionError
        For a shaft angle at which the larger gear would be a crown gear, or an internal one.
    """

    driver: int
    driven: int
    module: float
    shaft_angle: float
    pressure_angle: float = PRESSURE_ANGLE

    def __post_init__(self) -> None:
        small, large = sorted((self.driver, self.driven))
        # At equality the larger pitch cone opens to 90°: a crown gear.
        if not small + large * math.cos(self.shaft_angle) > MIN_CONE_COSINE * large:
            raise DimensionError("shaft_angle", "kinematics-cones-not-flat", self.shaft_angle)
        # Raises for teeth that cannot mesh.
        _ = self.back_mesh

    @property
    def cones(self) -> tuple[float, float]:
        """Pitch cone angles of driver and driven gear, radians."""
        large, small = max(self.driver, self.driven), min(self.driver, self.driven)
        pinion, gear = compute_cone_angles(self.shaft_angle, large / small)
        # The cone angles are computed for the smaller gear first.
        return (pinion, gear) if self.driver <= self.driven else (gear, pinion)

    @property
    def pitch_radii(self) -> tuple[float, float]:
        """Pitch radii of driver and driven gear at the large end."""
        return 0.5 * self.module * self.driver, 0.5 * self.module * self.driven

    @property
    def cone_distance(self) -> float:
        """Distance from the apex to the large end."""
        return self.pitch_radii[0] / math.sin(self.cones[0])

    @property
    def virtual_teeth(self) -> tuple[float, float]:
        """Virtual teeth z / cos γ of driver and driven gear."""
        one, two = self.cones
        return self.driver / math.cos(one), self.driven / math.cos(two)

    @cached_property
    def back_mesh(self) -> Mesh:
        """The spur gears of the back cones, the smaller one as the pinion."""
        pinion, gear = (Gear(teeth, self.module, self.pressure_angle) for teeth in sorted(self.virtual_teeth))
        return Mesh(pinion, gear)
