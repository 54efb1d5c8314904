"""Radial cam that moves a follower by its program: pitch curve, profile, cutter path and their conditions.

Everything is in the cam's own frame, see :mod:`follower`. The curve at a distance along the outward normal of the pitch
curve is the path of a roller or cutter of another size: −roller_radius gives the profile, cutter_radius − roller_radius
the cutter's centre. Where the pitch curve's radius of curvature is convex and not larger than the roller's, the profile
has a cusp or is undercut (Norton §8.7); a flat face requires ρ = h + d²h/dα² > 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Real
from kinematics.cam.follower import (
    Follower,
    OscillatingFlat,
    OscillatingRoller,
    TranslatingFlat,
    TranslatingRoller,
)
from kinematics.cam.motion.extremes import Extremes, find_extremes
from kinematics.cam.motion.program import TURN, Program
from kinematics.errors import DimensionError

Rotation = Literal["ccw", "cw"]


@dataclass(frozen=True, eq=False)
class Cam:
    """A cam: its program, its follower and the sense in which it turns.

    Raises
    ------
    DimensionError
        If the program moves the follower over the cam's centre or the arm over the line of centres, or turns a flat
        face as fast as the cam.
    """

    program: Program
    follower: Follower
    rotation: Rotation = "ccw"

    def __post_init__(self) -> None:
        if self.rotation not in ("ccw", "cw"):
            raise DimensionError("rotation", "kinematics-ccw-or-cw", self.rotation)
        # Exact extremes, so that no sample between angles can violate the limits.
        s, v = self.program.peaks[:2]
        low, high = self.follower.span
        if not low < s.least <= s.greatest < high:
            expected = "kinematics-displacement-of-follower"
            raise DimensionError("displacement", expected, (s.least, s.greatest), lowest=f"{low}", highest=f"{high}")
        if isinstance(self.follower, OscillatingFlat):
            # dα/dθ = 1 − sense · v must stay positive.
            rate = v.greatest if self.follower.sense == 1 else -v.least
            if not rate < 1.0:
                raise DimensionError("kinematics-flat-arm-velocity", "kinematics-less-than-cam-velocity", rate)

    @property
    def size(self) -> float:
        """Prime radius of a roller's cam, base radius of a flat face's: the unit of its lengths."""
        follower = self.follower
        if isinstance(follower, TranslatingFlat | OscillatingFlat):
            return follower.base_radius
        return follower.prime_radius

    @property
    def roller_radius(self) -> float:
        """Radius of the roller; 0 for a flat face."""
        follower = self.follower
        return follower.roller_radius if isinstance(follower, TranslatingRoller | OscillatingRoller) else 0.0

    def offset_curve(self, angle: ArrayLike, distance: float = 0.0) -> Complex:
        """Return points at a distance along the outward normal of the pitch curve (roller) or the profile (face).

        Parameters
        ----------
        angle : array_like
            Cam angles of the follower.
        distance : float
            0 gives the curve itself.
        """
        theta = np.asarray(angle, dtype=np.float64)
        z, normal = self._evaluate_curve(theta)
        return self._mirror(z + distance * normal)

    def pitch_curve(self, angle: ArrayLike) -> Complex:
        """Return the centres of the roller; for a flat face the contact points, which are the profile."""
        return self.offset_curve(angle)

    def profile(self, angle: ArrayLike) -> Complex:
        """Return the contact points."""
        return self.offset_curve(angle, -self.roller_radius)

    def outer_wall(self, angle: ArrayLike) -> Complex:
        """Return the other wall of the groove of a form-closed cam, on the far side of the roller."""
        return self.offset_curve(angle, self.roller_radius)

    def normal(self, angle: ArrayLike) -> Complex:
        """Return the outward unit normals at the contact points."""
        return self._mirror(self._evaluate_curve(np.asarray(angle, dtype=np.float64))[1])

    def pressure_angle(self, angle: ArrayLike) -> Real:
        """Return the angle between contact force and follower motion, radians; positive in a rise without offset."""
        return self.follower.pressure_angle(self.program.motion(angle))

    def pitch_curvature(self, angle: ArrayLike) -> Real:
        """Return the curvature of the pitch curve (for a flat face, of the profile), positive where convex."""
        follower, motion = self.follower, self.program.motion(angle)
        if isinstance(follower, TranslatingFlat | OscillatingFlat):
            return _invert(follower.face(motion).radius)
        return follower.pitch_curvature(motion)

    @cached_property
    def pitch_curvature_extremes(self) -> Extremes:
        """Exact extremes of a roller's pitch curvature: the maximum belongs to the smallest convex radius."""
        follower = self.follower
        if isinstance(follower, TranslatingFlat | OscillatingFlat):
            raise DimensionError("follower", "a roller; a flat face has radius_extremes", type(follower).__name__)
        return find_extremes(
            lambda angle: follower.pitch_curvature(self.program.pieces.motion(angle)), self.program.breaks
        )

    @cached_property
    def radius_extremes(self) -> Extremes:
        """Exact extremes of the profile's radius of curvature under a flat face; a minimum ≤ 0 means undercut."""
        flat = self.follower
        if not isinstance(flat, TranslatingFlat | OscillatingFlat):
            raise DimensionError("follower", "flat-faced", type(flat).__name__)
        return find_extremes(lambda angle: flat.face(self.program.pieces.motion(angle)).radius, self.program.breaks)

    def _evaluate_curve(self, theta: Real) -> tuple[Complex, Complex]:
        """Return trace or contact points and outward normals, for a cam that turns clockwise."""
        motion, follower = self.program.motion(theta), self.follower
        if isinstance(follower, TranslatingFlat | OscillatingFlat):
            face = follower.face(motion)
            # Support function: the contact lies h along the normal and dh/dα along the face.
            normal = np.exp(1j * (theta + face.normal))
            return normal * (face.h + 1j * face.h1), normal
        # The normal is the tangent turned clockwise, since the pitch curve runs counter-clockwise.
        turn, trace = np.exp(1j * theta), follower.trace(motion)
        tangent = trace.p1 + 1j * trace.p
        return turn * trace.p, -1j * turn * tangent / np.abs(tangent)

    def _mirror(self, points: Complex) -> Complex:
        # All formulas hold for a clockwise cam; the other sense is its mirror image.
        return np.conj(points) if self.rotation == "ccw" else points


def space_angles(count: int) -> Real:
    """Return cam angles of equal steps once around, from 0 inclusive to 2π exclusive."""
    return np.arange(count, dtype=np.float64) * (TURN / count)


def _invert(values: Real) -> Real:
    """Return 1/x; infinity for zero."""
    infinite: Real = np.full(values.shape, np.inf)
    np.divide(1.0, values, out=infinite, where=values != 0.0)
    return infinite
