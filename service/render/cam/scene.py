"""Content of a cam's drawing, from the mechanism's dimensions and points: curves, follower, measured contact."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.cam.conjugate import transform_between_cams
from kinematics.cam.finished.contact import ContactMotion, Contour
from kinematics.cam.follower import Follower, OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.profile import Rotation
from synthesis.kinds.cam.design import CamMechanism, SecondCam
from synthesis.kinds.cam.profile import build_core_follower, read_points
from synthesis.mechanisms.cam import build_follower

HALF_FACE_SHARE = 0.35
"""Half the drawn length of a face, as a share of the base radius."""


@dataclass(frozen=True, eq=False)
class SecondScene:
    """The second of two conjugate cams, in the frame of the first."""

    cam: SecondCam
    rotation: Rotation

    @cached_property
    def follower(self) -> TranslatingRoller | OscillatingRoller:
        """The follower in the analysis core."""
        found = build_follower(self.cam.follower.type, self.cam.prime_radius, self.cam.follower)
        assert isinstance(found, TranslatingRoller | OscillatingRoller)
        return found

    @cached_property
    def profile(self) -> Complex:
        """Points of the profile."""
        return read_points(self.cam.profile)

    @cached_property
    def pitch_curve(self) -> Complex:
        """Path of the roller's centre around the cam."""
        return read_points(self.cam.pitch_curve)

    def find_centres(self, angle: Real) -> Complex:
        """Return centres of the roller in contact with the profile, at cam angles."""
        own = transform_between_cams(self.follower, self.profile)
        found = Contour(own).follow(self.follower, angle, self.rotation)
        return transform_between_cams(self.follower, found.point + self.follower.roller_radius * found.normal)


@dataclass(frozen=True, eq=False)
class CamScene:
    """A cam with its follower, ready to be drawn or listed. Everything is in the cam's frame, at cam angle 0."""

    mechanism: CamMechanism

    @cached_property
    def follower(self) -> Follower:
        """The follower in the analysis core."""
        return build_core_follower(self.mechanism)

    @property
    def sense(self) -> float:
        """1 for a cam that turns counter-clockwise, −1 for clockwise."""
        return 1.0 if self.mechanism.rotation == "ccw" else -1.0

    @property
    def base_radius(self) -> float:
        """Radius of the base circle, the largest circle within the profile about the cam's centre."""
        follower = self.follower
        # Flat faces have a base circle of their own; rollers are reduced by their radius.
        if isinstance(follower, TranslatingFlat | OscillatingFlat):
            return follower.base_radius
        return follower.prime_radius - follower.roller_radius

    @property
    def roller(self) -> TranslatingRoller | OscillatingRoller | None:
        """The follower if it has a roller, else None."""
        return self.follower if isinstance(self.follower, TranslatingRoller | OscillatingRoller) else None

    @cached_property
    def profile(self) -> Complex:
        """Points of the profile."""
        return read_points(self.mechanism.profile)

    @cached_property
    def pitch_curve(self) -> Complex:
        """Path of the roller's centre around the cam; the profile under a flat face."""
        return read_points(self.mechanism.pitch_curve)

    @cached_property
    def outer_wall(self) -> Complex | None:
        """Points of the groove's outer wall; None without a groove."""
        wall = self.mechanism.outer_wall
        return None if wall is None else read_points(wall)

    @cached_property
    def second(self) -> SecondScene | None:
        """The second of two conjugate cams; None for a single cam."""
        second = self.mechanism.second
        return None if second is None else SecondScene(second, self.mechanism.rotation)

    @cached_property
    def contour(self) -> Contour:
        """The profile as a contour of the analysis core."""
        return Contour(self.profile)

    @cached_property
    def angle(self) -> Real:
        """Cam angles of the program's table, degrees."""
        return np.array(self.mechanism.program.angle)

    @cached_property
    def contact(self) -> ContactMotion:
        """Motion of the follower on the profile, measured at the table's angles."""
        return self.contour.follow(self.follower, np.radians(self.angle), self.mechanism.rotation)

    @property
    def oscillating(self) -> bool:
        """Whether displacements are angles of an arm."""
        return isinstance(self.follower, OscillatingRoller | OscillatingFlat)

    def find_station(self, degrees: float) -> complex:
        """Return the unit vector, in the cam's frame, of the ground's +x axis after a rotation of the cam."""
        # In the cam's frame the ground turns backwards.
        turn = -self.sense * math.radians(degrees)
        return complex(math.cos(turn), math.sin(turn))

    @cached_property
    def pivot(self) -> complex | None:
        """Pivot of an oscillating follower at cam angle 0, else None."""
        follower = self.follower
        return complex(follower.pivot_distance) if isinstance(follower, OscillatingRoller | OscillatingFlat) else None

    @property
    def stem(self) -> float:
        """Height of a face's stem above the cam's centre at cam angle 0."""
        follower = self.follower
        return -self.sense * follower.offset if isinstance(follower, TranslatingFlat) else 0.0

    @cached_property
    def carrier_lines(self) -> list[tuple[complex, complex]]:
        """Lines that carry the contact at cam angle 0: an arm, or a flat face and its arm; none for a stem."""
        if self.pivot is not None and self.roller is not None:
            return [(complex(self.pitch_curve[0]), self.pivot)]
        if self.roller is not None:
            return []
        if self.pivot is None:
            return self.list_faces(len(self.angle))[:1]
        return self.get_arm_face(complex(self.contact.point[0]))

    def get_arm_face(self, point: complex) -> list[tuple[complex, complex]]:
        """Return a flat face from the foot of its pivot to beyond its contact, and its arm, as lines.

        The contact is a point of the ground's frame, in which the pivot is fixed.
        """
        assert self.pivot is not None
        along = self.compute_face_direction(point, 1.0 + 0j)
        foot = point + along * ((self.pivot - point) * along.conjugate()).real
        return [(foot, point + HALF_FACE_SHARE * self.base_radius * along), (foot, self.pivot)]

    def list_faces(self, every: int) -> list[tuple[complex, complex]]:
        """Return a flat face around its contact, at every ``every``-th position of the table."""
        faces = []
        for degrees, point in zip(self.angle[::every].tolist(), self.contact.point[::every].tolist(), strict=True):
            # Faces of equal length in all positions.
            half = HALF_FACE_SHARE * self.base_radius * self.compute_face_direction(point, self.find_station(degrees))
            faces.append((point - half, point + half))
        return faces

    def compute_face_direction(self, point: complex, station: complex) -> complex:
        """Return the unit vector along a flat face that touches the cam at a point; away from its pivot, if it has one.

        ``station`` is the ground's +x axis in the frame of the point.
        """
        follower = self.follower
        if not isinstance(follower, OscillatingFlat):
            return station * 1j
        reach = point - follower.pivot_distance * station
        # Distance along the face; rounding may make the square slightly negative.
        foot = math.sqrt(max(abs(reach) ** 2 - follower.face_offset**2, 0.0))
        return reach / complex(foot, -follower.face_offset * follower.sense * self.sense)
