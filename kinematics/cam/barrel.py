"""Cylindrical (barrel) cams: a groove around a cylinder moves a roller along the cylinder's axis.

The groove's pitch curve, unrolled, is x = R θ, y = s(θ) (Norton §8.1; Rao §5.1): its slope is the pressure angle,
tan φ = v/R, and its curvature a R/(R² + v²)^{3/2}, since x″ = 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Real
from kinematics.cam.motion.program import Program
from kinematics.errors import DimensionError


@dataclass(frozen=True, eq=False)
class BarrelCam:
    """A barrel cam with a translating roller.

    Parameters
    ----------
    program : Program
        Displacement along the axis.
    radius : float
        Radius of the cylinder on which the middle of the roller runs.
    roller_radius : float
        Half the groove's width; 0 for a thin pin.
    """

    program: Program
    radius: float
    roller_radius: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.radius) and self.radius > 0.0):
            raise DimensionError("kinematics-cylinder-radius", "kinematics-positive", self.radius)
        if not (math.isfinite(self.roller_radius) and self.roller_radius >= 0.0):
            raise DimensionError("kinematics-roller-radius", "kinematics-at-least", self.roller_radius, least=0)

    def pressure_angle(self, angle: ArrayLike) -> Real:
        """Return the pressure angle in radians, positive in a rise."""
        return np.asarray(np.arctan(self.program.motion(angle).v / self.radius))

    def pitch_curve(self, angle: ArrayLike) -> Complex:
        """Return the unrolled pitch curve: real part along the circumference, imaginary part along the axis."""
        theta = np.asarray(angle, dtype=np.float64)
        return np.asarray(self.radius * theta + 1j * self.program.motion(theta).s)

    def wall(self, angle: ArrayLike, side: int) -> Complex:
        """Return an unrolled wall of the groove, on the side to which the follower rises (1) or the other (−1)."""
        theta = np.asarray(angle, dtype=np.float64)
        # The wall is the offset curve of the pitch curve by the roller radius, along its normal i·tangent.
        tangent = self.radius + 1j * self.program.motion(theta).v
        return np.asarray(self.pitch_curve(theta) + side * self.roller_radius * 1j * tangent / np.abs(tangent))
