"""Ratchets: the outline of a wheel with undercut teeth, and its pawl.

The wheel's axis is the origin; it turns counter-clockwise freely and is locked against turning back. A tooth has a
face, which leans over by an angle ξ so that it draws the pawl in, and a straight back from the foot of its face's space
to the next tip. The middle M of the held face lies on x, at the distance ρ from the axis, and the pawl's pivot at M − i
l: on the tangent, so that the force at M passes the pivot at ξ.

A point of the face at s outward from M pushes the pawl along −i e^{−iξ}; towards the pivot that would be
−i l − s e^{−iξ}. The pawl is drawn in if the angle between the two exceeds the friction angle; its minimum is at the
tip: ξ − tan⁻¹(s cos ξ/(l − s sin ξ)).
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Complex, Real

MAX_FACE_ANGLE = 60
"""Maximum face angle of the search, degrees."""

HALVING_STEPS = 60
"""Halvings of an interval of angles below 90°, down to rounding."""


@dataclass(frozen=True)
class Ratchet:
    """A ratchet wheel and its pawl by their dimensions, in any one unit of length.

    Attributes
    ----------
    teeth : int
    radius, height : float
        Radius to the tips, and height of a tooth.
    face : float
        Face angle ξ, radians.
    pawl : float
        Distance l from the middle of the face to the pawl's pivot.
    """

    teeth: int
    radius: float
    height: float
    face: float
    pawl: float

    @property
    def pitch(self) -> float:
        """Angle from tooth to tooth."""
        return 2.0 * math.pi / self.teeth

    @property
    def middle(self) -> float:
        """Distance ρ of the middle of the face from the axis; NaN if the face does not reach the foot circle."""
        outer, inner = self.radius**2, (self.radius - self.height) ** 2
        # ρ² + s² = (R² + (R − h)²)/2 and ρ s = (R² − (R − h)²)/(4 cos ξ).
        square = 0.5 * (outer + inner)
        gap = (0.25 * (outer - inner) / math.cos(self.face)) ** 2
        root = square * square - 4.0 * gap
        # The larger root of the biquadratic is ρ², the smaller one s².
        return math.sqrt(0.5 * (square + math.sqrt(root))) if root >= 0.0 else math.nan

    @property
    def reach(self) -> float:
        """Half the length of the face, s at the tip."""
        return 0.25 * (self.radius**2 - (self.radius - self.height) ** 2) / (self.middle * math.cos(self.face))

    @property
    def tip(self) -> complex:
        """Tip of the tooth in contact."""
        return self.middle + self.reach * cmath.exp(-1j * self.face)

    @property
    def foot(self) -> complex:
        """Foot of its face, where the pawl's nose rests."""
        return self.middle - self.reach * cmath.exp(-1j * self.face)

    @property
    def pivot(self) -> complex:
        """Pivot of the pawl."""
        return complex(self.middle, -self.pawl)

    @property
    def locking_angle(self) -> float:
        """Minimum over the face of the angle between its normal and the line to the pivot, radians.

        It is positive if the pawl is drawn in.
        """
        return _compute_locking_angle(self.face, self.reach, self.pawl)

    @property
    def thickness(self) -> float:
        """Thickness of a tooth at its foot."""
        return 2.0 * (self.radius - self.height) * math.sin(0.5 * self.pitch)

    @property
    def lift(self) -> float:
        """Angle by which a passing tip lifts the pawl, radians; law of cosines."""
        far, nose = abs(self.pivot), abs(self.foot - self.pivot)
        angles = [
            math.acos(max(-1.0, min(1.0, (far**2 + nose**2 - at**2) / (2.0 * far * nose))))
            for at in (self.radius, self.radius - self.height)
        ]
        return angles[0] - angles[1]

    @property
    def overtravel(self) -> float:
        """Angle beyond the pitch, radians, at which the tip leaves the circle of the nose and the pawl drops in."""
        far, nose = abs(self.pivot), abs(self.foot - self.pivot)
        cosine = (far**2 + self.radius**2 - nose**2) / (2.0 * far * self.radius)
        return cmath.phase(self.pivot) + math.acos(max(-1.0, min(1.0, cosine))) - cmath.phase(self.tip)

    @property
    def outline(self) -> Complex:
        """Tip and foot of every tooth, counter-clockwise; closed by its first point."""
        # Counter-clockwise: from a foot's space over the overhanging tip back to the foot, then along the tooth's back.
        tooth = np.array([self.foot, self.tip])
        turns = np.exp(1j * self.pitch * np.arange(self.teeth))
        return np.asarray((turns[:, None] * tooth).ravel())

    def pawl_lift(self, angle: Real) -> Real:
        """Return the lift of the pawl, radians, while the wheel turns by angles from its locked position.

        The nose rides on the back of the tooth behind, a line from this foot to the tip one pitch before.
        """
        # The pawl drops in after the overtravel, so the cycle starts there.
        turned = np.mod(angle - self.overtravel, self.pitch) + self.overtravel
        nose = abs(self.foot - self.pivot)
        start = self.foot * np.exp(1j * turned)
        back = self.tip * cmath.exp(-1j * self.pitch) * np.exp(1j * turned) - start
        apart = start - self.pivot
        # |apart + u back| = nose: the point of the back that the nose is on, between foot and tip.
        a, b, c = np.abs(back) ** 2, (apart * back.conj()).real, np.abs(apart) ** 2 - nose * nose
        # The smaller root of the quadratic, in the form without cancellation.
        share = c / (np.sqrt(np.maximum(b * b - a * c, 0.0)) - b)
        place = apart + np.clip(share, 0.0, 1.0) * back
        return np.asarray(np.angle((self.foot - self.pivot) / place))


def _compute_locking_angle(face: float, reach: float, pawl: float) -> float:
    return face - math.atan2(reach * math.cos(face), pawl - reach * math.sin(face))


def find_min_face(teeth: int, radius: float, height: float, pawl: float, wanted: float) -> float | None:
    """Find the minimum face angle, radians, with the required locking angle; None if it exceeds 60°."""

    def is_short(face: float) -> bool:
        return not Ratchet(teeth, radius, height, face, pawl).locking_angle >= wanted

    # Feasibility is not monotonic, since a face that leans too far misses the foot: scan for the first success.
    degrees = next((degree for degree in range(1, MAX_FACE_ANGLE + 1) if not is_short(math.radians(degree))), None)
    if degrees is None:
        return None
    # The first success lies within the last degree; bisect there.
    low, high = math.radians(degrees - 1), math.radians(degrees)
    for _ in range(HALVING_STEPS):
        middle = 0.5 * (low + high)
        if is_short(middle):
            low = middle
        else:
            high = middle
    return high
