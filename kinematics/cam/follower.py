"""Followers of radial cams: their trace point, their pressure angle, and the curvature of the cam under them.

The cam turns about the origin; its angle θ counts in its sense of rotation. Here it turns clockwise, so that in the
cam's own frame the follower walks around it counter-clockwise; :mod:`profile` mirrors this for the other sense. At θ =
0 the cam's frame is the ground's. A translating follower moves along the +x axis of the ground; the pivot of an
oscillating one lies on that axis. The displacement s is that of the trace point (a length) or of the arm (radians),
measured from the position in which the roller's centre is on the prime circle or the flat face touches the base circle.

With p(θ) the roller's centre in the ground's frame, the pitch curve is z = e^{iθ} p, and

    w = p′ + i p        its tangent, turned back to the ground's frame: z′ = e^{iθ} w
    n = −i w/|w|        outward normal, the line of the contact force
    κ = Im(w̄ (p″ + 2 i p′ − p))/|w|³    curvature, positive where convex.

A flat face with its normal at the angle α of the cam's frame, at a distance h from the cam's centre, touches at
z = e^{iα} (h + i dh/dα), where the radius of curvature is ρ = h + d²h/dα² (h is the support function). Norton §8.6–8.7;
Rao §5.4–5.6.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.cam.motion.pieces import Motion
from kinematics.errors import DimensionError


class Trace(NamedTuple):
    """The roller's centre in the ground's frame, its first two derivatives, and the unit vector of its motion."""

    p: Complex
    p1: Complex
    p2: Complex
    direction: Complex


@dataclass(frozen=True)
class TranslatingRoller:
    """A roller on a slide.

    Parameters
    ----------
    prime_radius : float
        Radius of the prime circle, on which the roller's centre lies at s = 0.
    roller_radius : float
        Radius of the roller; 0 for a knife edge.
    offset : float
        Distance of the slide from the cam's centre; positive to the side that lowers the pressure angle of the rise,
        tan φ = (v − offset)/(d + s) with d² = prime_radius² − offset².

    Raises
    ------
    DimensionError
        If the prime radius is not larger than the roller's, or not larger than the offset.
    """

    prime_radius: float
    roller_radius: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        _check_roller(self.prime_radius, self.roller_radius)
        if not abs(self.offset) < self.prime_radius:
            raise DimensionError(
                "offset", "kinematics-less-than-prime-radius", self.offset, radius=f"{self.prime_radius}"
            )

    @property
    def height(self) -> float:
        """Distance d of the trace point at s = 0, measured along the slide."""
        # Factored difference of squares: exact for an offset close to the prime radius.
        return math.sqrt((self.prime_radius - self.offset) * (self.prime_radius + self.offset))

    @property
    def span(self) -> tuple[float, float]:
        """Range of displacements in which the follower works."""
        return -self.height, math.inf

    def trace(self, motion: Motion) -> Trace:
        """Return p = d + s + i e and its derivatives."""
        one = np.ones_like(motion.s, dtype=np.complex128)
        p = (self.height + 1j * self.offset) * one + motion.s
        return Trace(p, motion.v * one, motion.a * one, one)

    def pressure_angle(self, motion: Motion) -> Real:
        """Return the angle between contact force and follower motion, radians; positive in a rise without offset."""
        # arctan2 stays finite when the trace point passes the cam's centre line.
        return np.asarray(np.arctan2(motion.v - self.offset, self.height + motion.s))

    def pitch_curvature(self, motion: Motion) -> Real:
        """Return the curvature of the pitch curve, positive where convex."""
        return _compute_curvature(self.trace(motion))


@dataclass(frozen=True)
class OscillatingRoller:
    """A roller on a swinging arm; displacements are angles of the arm.

    Parameters
    ----------
    prime_radius, roller_radius : float
        See :class:`TranslatingRoller`.
    arm : float
        Distance from the pivot to the roller's centre.
    pivot_distance : float
        Distance from the cam's centre to the pivot.
    sense : {1, -1}
        1: the arm swings outward in the sense in which the cam turns; −1: against it.

    Raises
    ------
    DimensionError
        If cam centre, pivot and roller form no triangle at s = 0, or the roller is larger than the prime circle.
    """

    prime_radius: float
    roller_radius: float
    arm: float
    pivot_distance: float
    sense: int = 1

    def __post_init__(self) -> None:
        _check_roller(self.prime_radius, self.roller_radius)
        _check_pivot(self.pivot_distance, self.sense)
        least, most = abs(self.pivot_distance - self.arm), self.pivot_distance + self.arm
        if not (math.isfinite(self.arm) and self.arm > 0.0):
            raise DimensionError("arm", "kinematics-positive", self.arm)
        if not least < self.prime_radius < most:
            expected = "kinematics-arm-closes-triangle"
            raise DimensionError(
                "kinematics-prime-radius", expected, self.prime_radius, least=f"{least}", most=f"{most}"
            )

    @property
    def start_angle(self) -> float:
        """Angle ψ0 between the arm and the line of centres at s = 0."""
        c, arm = self.pivot_distance, self.arm
        return math.acos((c * c + arm * arm - self.prime_radius**2) / (2.0 * c * arm))

    @property
    def span(self) -> tuple[float, float]:
        """Range of displacements in which the arm does not reach the line of centres."""
        return -self.start_angle, math.pi - self.start_angle

    def trace(self, motion: Motion) -> Trace:
        """Return p = C − L e^{∓i (ψ0 + s)} and its derivatives."""
        # Multiplication by this rotates the arm in its outward sense.
        turn = -1j * self.sense
        arm = -self.arm * np.exp(turn * (self.start_angle + motion.s))
        p1 = turn * motion.v * arm
        p2 = turn * motion.a * arm - motion.v**2 * arm
        return Trace(self.pivot_distance + arm, p1, p2, turn * arm / self.arm)

    def pressure_angle(self, motion: Motion) -> Real:
        """Return the angle between contact force and roller motion (a quarter turn from the arm), radians."""
        trace = self.trace(motion)
        normal = -1j * (trace.p1 + 1j * trace.p)
        # The sign makes the angle positive in a rise, as for the translating follower.
        return np.asarray(-np.angle(normal * np.conj(trace.direction)))

    def pitch_curvature(self, motion: Motion) -> Real:
        """Return the curvature of the pitch curve, positive where convex."""
        return _compute_curvature(self.trace(motion))


Roller = TranslatingRoller | OscillatingRoller


class Face(NamedTuple):
    """A flat face: angle of its normal in the ground's frame, its distance h, dh/dα, and ρ of the cam under it."""

    normal: Real
    h: Real
    h1: Real
    radius: Real


@dataclass(frozen=True)
class TranslatingFlat:
    """A flat face on a slide, square to its motion; an offset of the slide changes nothing on the cam.

    Parameters
    ----------
    base_radius : float
        Radius of the base circle, which the face touches at s = 0.
    offset : float
        Distance of the slide's axis from the cam's centre; positive to the side on which a rise touches the face.
    """

    base_radius: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        _check_base(self.base_radius)
        if not math.isfinite(self.offset):
            raise DimensionError("offset", "kinematics-finite", self.offset)

    @property
    def span(self) -> tuple[float, float]:
        """Range of displacements in which the face stays on its side of the cam's centre."""
        return -self.base_radius, math.inf

    def face(self, motion: Motion) -> Face:
        """Return the face with h = base_radius + s, α = θ, ρ = base_radius + s + a."""
        h = self.base_radius + motion.s
        return Face(np.zeros_like(h), h, motion.v, h + motion.a)

    def pressure_angle(self, motion: Motion) -> Real:
        """Return zero: the contact force is parallel to the motion."""
        return np.zeros_like(motion.s)


@dataclass(frozen=True)
class OscillatingFlat:
    """A flat face on a swinging arm; displacements are angles of the arm.

    Parameters
    ----------
    base_radius : float
        Radius of the base circle, which the face touches at s = 0.
    pivot_distance : float
        Distance from the cam's centre to the pivot.
    face_offset : float
        Distance of the face from the pivot, positive toward the cam.
    sense : {1, -1}
        As for :class:`OscillatingRoller`.
    """

    base_radius: float
    pivot_distance: float
    face_offset: float = 0.0
    sense: int = 1

    def __post_init__(self) -> None:
        _check_base(self.base_radius)
        _check_pivot(self.pivot_distance, self.sense)
        reach = self.base_radius + self.face_offset
        if not 0.0 <= reach < self.pivot_distance:
            most = f"{self.pivot_distance}"
            raise DimensionError("kinematics-face-offset", "kinematics-face-within-pivot", self.face_offset, most=most)

    @property
    def start_angle(self) -> float:
        """Angle ψ0 between the face and the line of centres at s = 0."""
        return math.asin((self.base_radius + self.face_offset) / self.pivot_distance)

    @property
    def span(self) -> tuple[float, float]:
        """Range of displacements in which the face touches on the cam's side of the pivot, off the cam's centre."""
        least = math.asin(min(1.0, max(0.0, self.face_offset) / self.pivot_distance))
        return least - self.start_angle, 0.5 * math.pi - self.start_angle

    def face(self, motion: Motion) -> Face:
        """Return the face with h = C sin ψ − offset, dα/dθ = 1 ∓ v."""
        angle = self.start_angle + motion.s
        # dα/dθ: it vanishes where the face turns with the cam.
        rate = 1.0 - self.sense * motion.v
        x, y = self.pivot_distance * np.cos(angle), self.pivot_distance * np.sin(angle)
        bend = (x * motion.a / rate - y * motion.v**2) / rate**2
        h = y - self.face_offset
        return Face(self.sense * (0.5 * math.pi - angle), h, x * motion.v / rate, h + bend)

    def reach(self, motion: Motion) -> Real:
        """Return the distance of the contact along the face from the foot of the pivot."""
        angle = self.start_angle + motion.s
        return np.asarray(self.pivot_distance * np.cos(angle) / (1.0 - self.sense * motion.v))

    def pressure_angle(self, motion: Motion) -> Real:
        """Return the pressure angle, radians; zero unless the face is offset from the pivot."""
        return np.asarray(np.arctan2(self.face_offset, self.reach(motion)))


Flat = TranslatingFlat | OscillatingFlat
Follower = Roller | Flat


def _compute_curvature(trace: Trace) -> Real:
    """Compute the curvature of the pitch curve, positive where convex."""
    # Derivatives in the cam's frame, rotated back to the ground's.
    tangent = trace.p1 + 1j * trace.p
    bend = trace.p2 + 2j * trace.p1 - trace.p
    return np.asarray((np.conj(tangent) * bend).imag / np.abs(tangent) ** 3)


def _check_roller(prime_radius: float, roller_radius: float) -> None:
    if not (math.isfinite(roller_radius) and roller_radius >= 0.0):
        raise DimensionError("kinematics-roller-radius", "kinematics-at-least", roller_radius, least=0)
    if not (math.isfinite(prime_radius) and prime_radius > roller_radius):
        raise DimensionError(
            "kinematics-prime-radius", "kinematics-more-than-roller", prime_radius, radius=f"{roller_radius}"
        )


def _check_base(base_radius: float) -> None:
    if not (math.isfinite(base_radius) and base_radius > 0.0):
        raise DimensionError("kinematics-base-radius", "kinematics-positive", base_radius)


def _check_pivot(pivot_distance: float, sense: int) -> None:
    if not (math.isfinite(pivot_distance) and pivot_distance > 0.0):
        raise DimensionError("kinematics-pivot-distance", "kinematics-positive", pivot_distance)
    if sense not in (1, -1):
        raise DimensionError("sense", "kinematics-swing-sense", sense)
