"""Worms and their gears on shafts at a right angle.

A worm of n threads advances its gear by the lead L = n p_x per turn, p_x the axial pitch, which is the circular pitch
of the gear: D_g = z p_x / π. The lead angle is tan λ = L / (π D_w) and equals the gear's helix angle (Norton, Design of
Machinery, Sec. 9.4, worms; Rao, Sec. 7.6). Angles are radians.

With the friction coefficient μ and the pressure angle φ_n of the normal plane the efficiency of a driving worm is

    η = (cos φ_n − μ tan λ) / (cos φ_n + μ cot λ)

and that of a driving gear η' = (cos φ_n − μ cot λ) / (cos φ_n + μ tan λ): the gear cannot drive if η' ≤ 0, that is
tan λ ≤ μ / cos φ_n (Shigley's Mechanical Engineering Design, Sec. 13-17, eq. 13-46).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from kinematics.errors import DimensionError
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, PRESSURE_ANGLE, Gear, compute_min_teeth


@dataclass(frozen=True)
class WormSet:
    """A worm with its gear.

    Raises
    ------
    DimensionError
        For numbers that are not positive.
    """

    threads: int
    gear_teeth: int
    axial_pitch: float
    worm_diameter: float

    def __post_init__(self) -> None:
        numbers = self.threads, self.gear_teeth, self.axial_pitch, self.worm_diameter
        if not all(0.0 < number < math.inf for number in numbers):
            raise DimensionError("kinematics-worm-set", "kinematics-positive-numbers", numbers)

    @property
    def ratio(self) -> float:
        """Worm speed over gear speed, z / n."""
        return self.gear_teeth / self.threads

    @property
    def lead(self) -> float:
        """Advance per turn, n p_x."""
        return self.threads * self.axial_pitch

    @property
    def lead_angle(self) -> float:
        """Lead angle, tan λ = L / π D_w; also the helix angle of the gear."""
        return math.atan(self.lead / (math.pi * self.worm_diameter))

    @property
    def worm_helix_angle(self) -> float:
        """Helix angle of the worm, 90° − λ."""
        return 0.5 * math.pi - self.lead_angle

    @property
    def gear_diameter(self) -> float:
        """Pitch diameter of the gear, z p_x / π."""
        return self.gear_teeth * self.axial_pitch / math.pi

    @property
    def centre_distance(self) -> float:
        """Centre distance (D_w + D_g) / 2."""
        return 0.5 * (self.worm_diameter + self.gear_diameter)

    def is_locking(self, friction: float) -> bool:
        """Return whether the gear cannot drive the worm: tan λ ≤ μ, for square threads."""
        return math.tan(self.lead_angle) <= friction


class WormForces(NamedTuple):
    """Forces on the teeth at a torque of the worm, in units of torque over length.

    ``worm`` is tangential to the worm and axial on the gear, ``gear`` tangential to the gear and axial on the worm.
    """

    worm: float
    gear: float
    radial: float


@dataclass(frozen=True)
class WormDrive:
    """A cylindrical worm that drives its gear; shafts at a right angle.

    ``module`` is the axial one of the worm; its pitch diameter is ``quotient`` of them, so that tan λ = threads /
    quotient. ``normal_pressure_angle`` is that of the normal plane of the worm.

    Raises
    ------
    DimensionError
        For numbers that are not positive.
    """

    threads: int
    gear_teeth: int
    module: float
    quotient: float
    normal_pressure_angle: float = PRESSURE_ANGLE

    def __post_init__(self) -> None:
        _ = self.dimensions

    @cached_property
    def dimensions(self) -> WormSet:
        """Dimensions of worm and gear; impossible ones raise a :class:`DimensionError`."""
        return WormSet(self.threads, self.gear_teeth, math.pi * self.module, self.quotient * self.module)

    @property
    def lead_angle(self) -> float:
        """Lead angle, tan λ = threads / quotient."""
        return self.dimensions.lead_angle

    @property
    def centre_distance(self) -> float:
        """Distance of the crossing shafts."""
        return self.dimensions.centre_distance

    @property
    def axial_pressure_angle(self) -> float:
        """Pressure angle of the worm's rack profile in the middle plane, tan φ_x = tan φ_n / cos λ."""
        return math.atan(math.tan(self.normal_pressure_angle) / math.cos(self.lead_angle))

    @property
    def is_free_of_interference(self) -> bool:
        """Whether the threads, a rack in the middle plane, touch the gear's teeth on their involutes only."""
        return self.gear_teeth >= compute_min_teeth(self.axial_pressure_angle)

    @property
    def gear(self) -> Gear:
        """Gear in the middle plane, where the worm is a full-depth rack."""
        return Gear(self.gear_teeth, self.module, self.axial_pressure_angle)

    @property
    def approach(self) -> float:
        """Part of the path of contact bounded by the tip circle of the gear, in the middle plane."""
        gear = self.gear
        return math.sqrt(gear.tip_radius**2 - gear.base_radius**2) - gear.pitch_radius * math.sin(gear.pressure_angle)

    @property
    def recess(self) -> float:
        """Part of the path of contact bounded by the tips of the worm, in the middle plane."""
        return FULL_DEPTH_ADDENDUM * self.module / math.sin(self.axial_pressure_angle)

    @property
    def contact_ratio(self) -> float:
        """Contact ratio in the middle plane, gear with rack."""
        return (self.approach + self.recess) / self.gear.base_pitch

    def efficiency(self, friction: float) -> float:
        """Return the efficiency of a driving worm; 0 if friction holds it."""
        cosine, slope = math.cos(self.normal_pressure_angle), math.tan(self.lead_angle)
        # A negative value would mean that the worm has to be helped by its gear.
        return max(0.0, (cosine - friction * slope) / (cosine + friction / slope))

    def back_efficiency(self, friction: float) -> float:
        """Return the efficiency of a driving gear; 0 if it cannot drive."""
        cosine, slope = math.cos(self.normal_pressure_angle), math.tan(self.lead_angle)
        return max(0.0, (cosine - friction / slope) / (cosine + friction * slope))

    def is_locking(self, friction: float) -> bool:
        """Return whether the gear cannot drive the worm: tan λ ≤ μ / cos φ_n."""
        return math.tan(self.lead_angle) * math.cos(self.normal_pressure_angle) <= friction

    def forces(self, torque: float, friction: float) -> WormForces:
        """Return the forces of sliding teeth at a torque of the worm (Shigley, eq. 13-43).

        If the gear drives, ``friction`` is negative.

        Raises
        ------
        DimensionError
            If friction holds the worm or its gear under that torque: forces of teeth at rest are not determined.
        """
        phi, lead = self.normal_pressure_angle, self.lead_angle
        # Without load the direction of friction does not matter.
        if torque == 0.0:
            return WormForces(0.0, 0.0, 0.0)
        around = math.cos(phi) * math.sin(lead) + friction * math.cos(lead)
        along = math.cos(phi) * math.cos(lead) - friction * math.sin(lead)
        # A nonpositive component means that friction holds the teeth.
        if not min(around, along) > 0.0:
            raise DimensionError("friction", "kinematics-below-worm-lock", abs(friction))
        worm = 2.0 * torque / self.dimensions.worm_diameter
        normal = worm / around
        gear = normal * along
        return WormForces(worm, gear, normal * math.sin(phi))
