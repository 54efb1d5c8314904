"""Cams between the analysis core and the answer: degrees and tables outside, radians and exact curves inside."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from kinematics.cam import follower as core
from kinematics.cam.profile import Cam, even_angles
from kinematics.cam.program import TURN
from synthesis.designs.cam import CamCurve, CamFollower, CamMechanism, ProgramTable

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

SPAN_OF_ROLLER = 5.0
"""Chords of the profile that the roller's radius spans at least, so that its contact is resolved."""


def points_for(cam: Cam, stated: int) -> int:
    """How many points a profile needs: the stated number, doubled as often as a small roller asks for it."""
    radius = cam.roller_radius
    if radius <= 0.0:
        return stated
    count = stated
    while np.abs(np.diff(cam.profile(even_angles(count)))).max() * SPAN_OF_ROLLER > radius and count < 64 * stated:
        count *= 2
    return count


def cam_mechanism(cam: Cam, count: int) -> CamMechanism:
    """A cam as the answer has it, at equal cam angles."""
    angle = even_angles(count)
    motion = cam.program.motion(angle)
    oscillating = isinstance(cam.follower, core.OscillatingRoller | core.OscillatingFlat)
    unit = 180.0 / math.pi if oscillating else 1.0
    degrees = (np.arange(count) * (360.0 / count)).tolist()
    roller = isinstance(cam.follower, core.TranslatingRoller | core.OscillatingRoller)
    return CamMechanism(
        follower=follower_model(cam.follower),
        prime_radius=cam.size if roller else None,
        base_radius=None if roller else cam.size,
        rotation=cam.rotation,
        profile=_curve(degrees, cam.profile(angle)),
        pitch_curve=_curve(degrees, cam.pitch_curve(angle)),
        program=ProgramTable(
            angle=degrees,
            s=(motion.s * unit).tolist(),
            v=motion.v.tolist(),
            a=motion.a.tolist(),
            j=motion.j.tolist(),
        ),
    )


def _curve(degrees: list[float], points: Complex) -> CamCurve:
    return CamCurve(angle=degrees, x=points.real.tolist(), y=points.imag.tolist())


def follower_model(follower: core.Follower) -> CamFollower:
    """The follower as the answer has it."""
    if isinstance(follower, core.TranslatingRoller):
        return CamFollower(type="translating_roller", roller_radius=follower.roller_radius, offset=follower.offset)
    if isinstance(follower, core.OscillatingRoller):
        return CamFollower(
            type="oscillating_roller",
            roller_radius=follower.roller_radius,
            arm=follower.arm,
            pivot_distance=follower.pivot_distance,
            sense=_sense(follower.sense),
        )
    if isinstance(follower, core.TranslatingFlat):
        return CamFollower(type="translating_flat")
    return CamFollower(
        type="oscillating_flat",
        pivot_distance=follower.pivot_distance,
        face_offset=follower.face_offset,
        sense=_sense(follower.sense),
    )


def core_follower(mechanism: CamMechanism) -> core.Follower:
    """The follower of a mechanism, for the analysis core; from its dimensions alone.

    Raises
    ------
    DimensionError
        For dimensions that no follower can have.
    """
    follower = mechanism.follower
    prime, base = mechanism.prime_radius or 0.0, mechanism.base_radius or 0.0
    if follower.type == "translating_roller":
        return core.TranslatingRoller(prime, follower.roller_radius or 0.0, follower.offset or 0.0)
    if follower.type == "oscillating_roller":
        return core.OscillatingRoller(
            prime,
            follower.roller_radius or 0.0,
            follower.arm or 0.0,
            follower.pivot_distance or 0.0,
            follower.sense or 1,
        )
    if follower.type == "translating_flat":
        return core.TranslatingFlat(base)
    return core.OscillatingFlat(base, follower.pivot_distance or 0.0, follower.face_offset or 0.0, follower.sense or 1)


def _sense(sense: int) -> Literal[1, -1]:
    return 1 if sense == 1 else -1


def profile_points(mechanism: CamMechanism) -> Complex:
    """The profile as complex numbers."""
    return np.array(mechanism.profile.x) + 1j * np.array(mechanism.profile.y)


def table_angles(mechanism: CamMechanism) -> Real:
    """Cam angles of the program's table, radians, within a turn."""
    return np.mod(np.radians(mechanism.program.angle), TURN)
