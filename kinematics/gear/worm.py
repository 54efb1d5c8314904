"""Worms and their gears on shafts at a right angle.

A worm of n threads advances its gear by the lead L = n p_x a turn, p_x the axial pitch, which is the circular pitch of
the gear: D_g = z p_x / π. The lead angle is tan λ = L / (π D_w) and equals the gear's helix angle (Norton, Design of
Machinery, Sec. 9.4, worms; Rao, Sec. 7.6). Angles are radians.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from kinematics.errors import DimensionError


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
            raise DimensionError("worm set", "of positive numbers", numbers)

    @property
    def ratio(self) -> float:
        """Worm speed over gear speed, z / n."""
        return self.gear_teeth / self.threads

    @property
    def lead(self) -> float:
        """Advance a turn, n p_x."""
        return self.threads * self.axial_pitch

    @property
    def lead_angle(self) -> float:
        """tan λ = L / π D_w; also the helix angle of the gear."""
        return math.atan(self.lead / (math.pi * self.worm_diameter))

    @property
    def worm_helix_angle(self) -> float:
        """90° − λ."""
        return 0.5 * math.pi - self.lead_angle

    @property
    def gear_diameter(self) -> float:
        """z p_x / π."""
        return self.gear_teeth * self.axial_pitch / math.pi

    @property
    def centre_distance(self) -> float:
        """(D_w + D_g) / 2."""
        return 0.5 * (self.worm_diameter + self.gear_diameter)

    def is_locking(self, friction: float) -> bool:
        """Whether the gear cannot drive the worm: tan λ ≤ μ, for square threads."""
        return math.tan(self.lead_angle) <= friction
