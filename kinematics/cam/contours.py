"""Cams of specified contour: eccentric circles, circular arcs and straight flanks under a translating follower.

The contour is given and the motion follows (Rao, *Kinematics of Machinery*, §5.7). With γ the angle from the slide to
the centre of an arc of radius ρ at a distance E from the cam's centre, a roller of radius r on a slide at an offset e
stands at

    x = E cos γ ± √((ρ ± r)² − (E sin γ − e)²),      + convex, − hollow,

on a straight flank at x = (h + r − e sin β)/cos β with β the angle of its normal and h its distance, and a flat face on
an arc at x = E cos γ + ρ. The nose points along the +x axis of the cam, so that the follower is at its highest at
cam angle 0; conventions are those of :mod:`follower`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Real
from kinematics.cam.follower import TranslatingFlat, TranslatingRoller
from kinematics.cam.motion.pieces import Motion
from kinematics.cam.motion.program import TURN
from kinematics.cam.profile import Rotation
from kinematics.errors import DimensionError

TANGENCY_TOLERANCE = 1e-9
"""Largest gap between the ends of neighbouring parts, as a share of the base radius: rounding of given numbers."""


class Arc(NamedTuple):
    """A circular arc: its centre, its radius (negative if hollow) and the angle of the normal at its start."""

    centre: complex
    radius: float
    start: float


class Flank(NamedTuple):
    """A straight flank with its distance from the cam's centre and the angle of its outward normal."""

    distance: float
    start: float


@dataclass(frozen=True)
class SpecifiedContour:
    """A closed contour of arcs and flanks that are tangent to their neighbours.

    Parameters
    ----------
    base_radius : float
        Radius of the base circle, from which displacements are measured.
    parts : tuple of Arc or Flank
        Parts in counter-clockwise order; the outward normal at the start of each equals that at its predecessor's end.
    """

    base_radius: float
    parts: tuple[Arc | Flank, ...]

    def __post_init__(self) -> None:
        for k, part in enumerate(self.parts):
            before, after = self._find_end(k - 1), self._find_end(k)
            if isinstance(part, Arc):
                off = abs(part.centre + part.radius * np.exp(1j * part.start) - before)
            else:
                normal = np.exp(-1j * part.start)
                turn = np.exp(1j * self.parts[(k + 1) % len(self.parts)].start) * normal - 1.0
                ends = np.array([before * normal, after * normal]).real - part.distance
                # A flank must lie at its distance at both ends, and the next normal must be its own.
                off = max(np.abs(ends).max(), abs(turn) * self.base_radius)
            if not off <= TANGENCY_TOLERANCE * self.base_radius:
                raise DimensionError("contour", "kinematics-tangent-parts", (k, float(off)))

    @property
    def joints(self) -> Complex:
        """Points at which the parts begin, shape (parts,)."""
        return np.array([self._find_end(k - 1) for k in range(len(self.parts))])

    @property
    def least_radius(self) -> float:
        """Smallest convex radius of curvature."""
        return min(part.radius for part in self.parts if isinstance(part, Arc) and part.radius > 0.0)

    def points(self, count: int) -> Complex:
        """Return about ``count`` points along the contour, every joint included."""
        sections: list[Complex] = []
        lengths = [abs(self._compute_length(k)) for k in range(len(self.parts))]
        for k, part in enumerate(self.parts):
            number = max(2, round(count * lengths[k] / sum(lengths)))
            share = np.arange(number) / number
            if isinstance(part, Arc):
                angle = part.start + share * self._compute_turn(k)
                sections.append(np.asarray(part.centre + part.radius * np.exp(1j * angle), np.complex128))
            else:
                start, end = self._find_end(k - 1), self._find_end(k)
                sections.append(np.asarray(start + share * (end - start), np.complex128))
        return np.concatenate(sections)

    def breaks(self, follower: TranslatingRoller | TranslatingFlat, rotation: Rotation = "ccw") -> Real:
        """Return the cam angles between which the follower stays on one part, ascending from 0 to 2π."""
        starts = np.mod(self._find_starts(follower, rotation)[0], TURN)
        return np.unique(np.concatenate([[0.0], starts, [TURN]]))

    def motion(
        self, follower: TranslatingRoller | TranslatingFlat, angle: ArrayLike, rotation: Rotation = "ccw"
    ) -> Motion:
        """Return s, v, a, j of the follower at cam angles, per radian.

        s counts from the base circle: it is zero where a roller's centre is on the prime circle.

        Raises
        ------
        DimensionError
            If the follower's prime or base radius does not match the contour, the roller is too large for a hollow, or
            a flat face follows a contour with a hollow.
        """
        own = follower.base_radius if isinstance(follower, TranslatingFlat) else follower.prime_radius
        roller = 0.0 if isinstance(follower, TranslatingFlat) else follower.roller_radius
        if abs(own - self.base_radius - roller) > TANGENCY_TOLERANCE * self.base_radius:
            raise DimensionError(
                "kinematics-prime-or-base-radius",
                "kinematics-radius-of-contour",
                own,
                radius=f"{self.base_radius + roller}",
            )
        theta = np.asarray(angle, dtype=np.float64)
        starts, parts = self._find_starts(follower, rotation)
        # The parts begin in cyclic order; sorted by angle, the last one wraps around to angle 0 (index −1).
        order = np.argsort(np.mod(starts, TURN))
        index = order[np.searchsorted(np.mod(starts, TURN)[order], np.mod(theta, TURN), side="right") - 1]
        result = np.zeros((4, *theta.shape))
        for k, part in enumerate(parts):
            here = index == k
            if here.any():
                result[:, here] = _evaluate_part(part, follower, theta[here])
        return Motion(*result)

    def _find_starts(
        self, follower: TranslatingRoller | TranslatingFlat, rotation: Rotation
    ) -> tuple[Real, tuple[Arc | Flank, ...]]:
        """Return the cam angles at which the follower reaches each part, and those parts, for a clockwise cam."""
        contour = self if rotation == "cw" else self._mirror()
        normals = np.array([part.start for part in contour.parts])
        if isinstance(follower, TranslatingFlat):
            if any(isinstance(part, Arc) and part.radius <= 0.0 for part in self.parts):
                raise DimensionError("kinematics-contour-under-flat-face", "kinematics-nowhere-hollow", self.parts)
            arcs = [k for k, part in enumerate(contour.parts) if isinstance(part, Arc)]
            # A flat face stands at the angle of the contour's normal, so it passes a flank in an instant.
            return normals[arcs], tuple(contour.parts[k] for k in arcs)
        hollows = [-part.radius for part in self.parts if isinstance(part, Arc) and part.radius < 0.0]
        if hollows and follower.roller_radius >= min(hollows):
            raise DimensionError(
                "kinematics-roller-radius",
                "kinematics-less-than-hollow-radius",
                follower.roller_radius,
                radius=f"{min(hollows)}",
            )
        centre = contour.joints + follower.roller_radius * np.exp(1j * normals)
        # The roller's centre reaches a joint's offset point when this lies on the slide, e off the centre.
        return np.angle(centre) - np.arcsin(follower.offset / np.abs(centre)), contour.parts

    def _mirror(self) -> SpecifiedContour:
        """Return the contour mirrored in the real axis, again counter-clockwise."""
        parts: list[Arc | Flank] = []
        for k in range(len(self.parts) - 1, -1, -1):
            part = self.parts[k]
            end = -(part.start + self._compute_turn(k))
            parts.append(
                Arc(part.centre.conjugate(), part.radius, end) if isinstance(part, Arc) else Flank(part[0], end)
            )
        return SpecifiedContour(self.base_radius, tuple(parts))

    def _compute_turn(self, k: int) -> float:
        """Compute the angle by which the normal turns along a part: negative in a hollow, 2π on a single arc."""
        part, following = self.parts[k], self.parts[(k + 1) % len(self.parts)]
        if isinstance(part, Flank):
            return 0.0
        turn = (following.start - part.start) % TURN
        if part.radius < 0.0:
            return turn - TURN if turn > 0.0 else 0.0
        return turn or TURN

    def _find_end(self, k: int) -> complex:
        """Return the end of a part.

        An arc ends where its normal equals that of the next part, and a flank where the next arc starts.
        """
        part, following = self.parts[k], self.parts[(k + 1) % len(self.parts)]
        if isinstance(part, Flank):
            if isinstance(following, Flank):
                raise DimensionError("contour", "kinematics-no-flanks-in-row", k)
            part = following
        return complex(part.centre + part.radius * np.exp(1j * following.start))

    def _compute_length(self, k: int) -> float:
        """Compute the arc length of a part."""
        part = self.parts[k]
        if isinstance(part, Arc):
            return part.radius * self._compute_turn(k)
        return abs(self._find_end(k) - self._find_end(k - 1))


def build_eccentric_circle(radius: float, eccentricity: float) -> SpecifiedContour:
    """Build a circle that turns about a point off its centre; the base circle is inscribed about that point."""
    if not (math.isfinite(radius) and 0.0 <= eccentricity < radius):
        raise DimensionError("eccentricity", "kinematics-within-radius", eccentricity, radius=f"{radius}")
    return SpecifiedContour(radius - eccentricity, (Arc(complex(eccentricity), radius, 0.0),))


def build_tangent_cam(base_radius: float, nose_radius: float, nose_distance: float) -> SpecifiedContour:
    """Build a cam with straight flanks tangent to the base circle and to a nose at a distance (Rao §5.7)."""
    _check_nose(base_radius, nose_radius, nose_distance)
    normal = math.acos((base_radius - nose_radius) / nose_distance)
    nose, base = complex(nose_distance), 0j
    return SpecifiedContour(
        base_radius,
        (
            Arc(nose, nose_radius, -normal),
            Flank(base_radius, normal),
            Arc(base, base_radius, normal),
            Flank(base_radius, -normal),
        ),
    )


def build_circular_arc_cam(
    base_radius: float, nose_radius: float, nose_distance: float, flank_radius: float
) -> SpecifiedContour:
    """Build a cam whose flanks are arcs tangent to base circle and nose; a negative flank radius makes them hollow.

    The flank's centre is at flank_radius − base_radius from the cam's centre and flank_radius − nose_radius from the
    nose's.
    """
    _check_nose(base_radius, nose_radius, nose_distance)
    to_base, to_nose = abs(flank_radius - base_radius), abs(flank_radius - nose_radius)
    # The centres of base circle, nose and flank must form a triangle.
    closes = abs(to_base - to_nose) < nose_distance < to_base + to_nose
    convex = flank_radius > max(base_radius, nose_radius)
    if not (math.isfinite(flank_radius) and closes and (convex or flank_radius < 0.0)):
        raise DimensionError("kinematics-flank-radius", "kinematics-flank-is-tangent", flank_radius)
    # Angle at the cam's centre between the nose and the flank's centre.
    cosine = (to_base**2 + nose_distance**2 - to_nose**2) / (2.0 * to_base * nose_distance)
    angle = math.acos(cosine)
    centre = to_base * complex(math.cos(angle), -math.sin(angle) if convex else math.sin(angle))
    outward = 1.0 if convex else -1.0
    at_nose = float(np.angle(outward * (nose_distance - centre)))
    at_base = float(np.angle(-outward * centre))
    nose = complex(nose_distance)
    return SpecifiedContour(
        base_radius,
        (
            Arc(nose, nose_radius, -at_nose),
            Arc(centre, flank_radius, at_nose),
            Arc(0j, base_radius, at_base),
            Arc(centre.conjugate(), flank_radius, -at_base),
        ),
    )


def compute_flank_radius(base_radius: float, nose_radius: float, nose_distance: float, half_action: float) -> float:
    """Compute the flank radius of a circular-arc cam from the angle of its rise, radians; infinite for a tangent cam.

    The base circle ends at the half action angle from the nose, where the flank is tangent to it.
    """
    _check_nose(base_radius, nose_radius, nose_distance)
    if not 0.0 < half_action < math.pi:
        raise DimensionError("kinematics-half-action-angle", "kinematics-between-0-and-pi", half_action)
    # Law of cosines in the triangle of base, nose and flank centres, solved for the flank's radius.
    along = nose_distance * math.cos(half_action)
    top = base_radius**2 + nose_distance**2 - nose_radius**2 - 2.0 * base_radius * along
    bottom = 2.0 * (base_radius - nose_radius - along)
    return top / bottom if bottom != 0.0 else math.inf


def _check_nose(base_radius: float, nose_radius: float, nose_distance: float) -> None:
    if not (math.isfinite(base_radius) and base_radius > 0.0):
        raise DimensionError("kinematics-base-radius", "kinematics-positive", base_radius)
    if not (math.isfinite(nose_radius) and nose_radius > 0.0):
        raise DimensionError("kinematics-nose-radius", "kinematics-positive", nose_radius)
    if not (math.isfinite(nose_distance) and nose_distance > abs(base_radius - nose_radius)):
        least = f"{abs(base_radius - nose_radius)}"
        raise DimensionError("kinematics-nose-distance", "kinematics-nose-outside-base", nose_distance, least=least)


def _evaluate_part(part: Arc | Flank, follower: TranslatingRoller | TranslatingFlat, theta: Real) -> Real:
    """Evaluate s, v, a, j on one part; dγ/dθ = dβ/dθ = −1."""
    if isinstance(part, Flank):
        # A flat face passes a flank in an instant, so no cam angle belongs to a flank.
        assert isinstance(follower, TranslatingRoller), "a flat face stays on no flank"
        beta, h, e = part.start - theta, part.distance + follower.roller_radius, follower.offset
        sec, tan = 1.0 / np.cos(beta), np.tan(beta)
        s = h * sec - e * tan - follower.height
        v = -h * sec * tan + e * sec**2
        a = h * sec * (tan**2 + sec**2) - 2.0 * e * sec**2 * tan
        j = -h * sec * tan * (tan**2 + 5.0 * sec**2) + e * sec**2 * (4.0 * tan**2 + 2.0 * sec**2)
        return np.stack([s, v, a, j])
    reach, gamma = abs(part.centre), float(np.angle(part.centre)) - theta
    p, q1 = reach * np.cos(gamma), -reach * np.cos(gamma)
    p1 = reach * np.sin(gamma)
    if isinstance(follower, TranslatingFlat):
        return np.stack([p + part.radius - follower.base_radius, p1, -p, -p1])
    radius, q = part.radius + follower.roller_radius, p1 - follower.offset
    q2, q3 = -p1, p
    # A hollow (negative radius) touches the roller on the other branch of the root.
    w = math.copysign(1.0, radius) * np.sqrt(radius**2 - q**2)
    w1 = -q * q1 / w
    w2 = -(q1**2 + q * q2 + w1**2) / w
    w3 = -(3.0 * q1 * q2 + q * q3 + 3.0 * w1 * w2) / w
    return np.stack([p + w - follower.height, p1 + w1, -p + w2, -p1 + w3])
