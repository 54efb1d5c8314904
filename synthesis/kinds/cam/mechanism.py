"""Cams between the analysis core and the answer: degrees and tables outside, radians and exact curves inside."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from kinematics.cam import follower as core
from kinematics.cam.barrel import BarrelCam
from kinematics.cam.pieces import Motion
from kinematics.cam.profile import Cam, even_angles
from kinematics.cam.program import TURN, Program
from synthesis.kinds.cam.design import (
    BarrelCamMechanism,
    BarrelFollower,
    CamCurve,
    CamFollower,
    CamMechanism,
    ProgramTable,
)
from synthesis.mechanisms.cam import dimensions_of, follower_by_dimensions, follower_type

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

SAME_ANGLE_TOLERANCE = 1e-9
"""Radians below which a joint and an equal step are one angle."""

MAX_EQUAL_STEPS = 5760
"""Equal steps of a profile at most."""

MIN_CHORDS_OF_ROLLER = 5.0
"""Chords of the profile that the roller's radius spans at least, so that its contact is resolved."""


MAX_PARTS = 8
"""Parts that a step is divided in at once, at most."""

MIN_STEPS_OF_MOVE = 12
"""Steps of the profile within a segment that moves, at least."""


def profile_angles(program: Program, curve: Callable[[Real], Complex], roller_radius: float, count: int) -> Real:
    """Cam angles of a profile: equal steps and the joints of the segments, as close as short segments ask for.

    A small roller asks for close points too: its radius spans five chords of the curve that it touches.
    """
    short = [
        np.linspace(start, end, MIN_STEPS_OF_MOVE + 1)[:-1]
        for start, end, segment in zip(program.joints[:-1], program.joints[1:], program.segments, strict=True)
        if segment.pieces.polynomial.shape[1] > 1 and end - start < MIN_STEPS_OF_MOVE * TURN / count
    ]
    while True:
        angle: Real = np.unique(np.concatenate([even_angles(count), program.joints[:-1], *short]))
        angle = angle[np.append(True, np.diff(angle) > SAME_ANGLE_TOLERANCE)]
        chord = np.abs(np.diff(curve(np.append(angle, TURN)))).max()
        if chord * MIN_CHORDS_OF_ROLLER <= roller_radius or roller_radius <= 0.0 or count >= MAX_EQUAL_STEPS:
            return angle
        count *= 2


def refined(angle: Real, off: Real, allowed: float) -> Real:
    """Steps divided where a deviation is more than half of what is allowed, and beside such a step.

    The deviation falls with the fourth power of the step where the curvature is smooth; where it bends, with less, and
    the next round divides again.
    """
    closed = np.append(angle, TURN + angle[0])
    parts = np.clip(np.ceil((off / (0.5 * allowed)) ** 0.25), 1.0, MAX_PARTS).astype(np.int64)
    parts = np.maximum(parts, np.minimum(np.roll(parts, -1), 2))
    parts = np.maximum(parts, np.minimum(np.roll(parts, 1), 2))
    low, step = np.repeat(closed[:-1], parts), np.repeat(np.diff(closed) / parts, parts)
    within = np.arange(len(low)) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.unique(np.mod(low + step * within, TURN))


def cam_mechanism(cam: Cam, angle: Real, groove: bool = False) -> CamMechanism:
    """A cam as the answer has it, at given cam angles; with both walls of its groove, or one profile."""
    oscillating = isinstance(cam.follower, core.OscillatingRoller | core.OscillatingFlat)
    unit = 180.0 / math.pi if oscillating else 1.0
    degrees = np.degrees(angle).tolist()
    roller = isinstance(cam.follower, core.TranslatingRoller | core.OscillatingRoller)
    return CamMechanism(
        follower=CamFollower(
            type=follower_type(cam.follower),
            **{name: getattr(cam.follower, name) for name in dimensions_of(type(cam.follower))},
        ),
        prime_radius=cam.size if roller else None,
        base_radius=None if roller else cam.size,
        rotation=cam.rotation,
        profile=_curve(degrees, cam.profile(angle)),
        outer_wall=_curve(degrees, cam.outer_wall(angle)) if groove else None,
        pitch_curve=_curve(degrees, cam.pitch_curve(angle)),
        program=_table(degrees, cam.program.motion(angle), unit),
    )


def barrel_mechanism(barrel: BarrelCam, rotation: Literal["ccw", "cw"], angle: Real) -> BarrelCamMechanism:
    """A barrel cam as the answer has it, at given cam angles."""
    degrees = np.degrees(angle).tolist()
    return BarrelCamMechanism(
        follower=BarrelFollower(roller_radius=barrel.roller_radius),
        cylinder_radius=barrel.radius,
        rotation=rotation,
        lower_wall=_curve(degrees, barrel.wall(angle, -1)),
        upper_wall=_curve(degrees, barrel.wall(angle, 1)),
        pitch_curve=_curve(degrees, barrel.pitch_curve(angle)),
        program=_table(degrees, barrel.program.motion(angle), 1.0),
    )


def _table(degrees: list[float], motion: Motion, unit: float) -> ProgramTable:
    """The program at cam angles; ``unit`` turns the displacement of the core into the answer's."""
    return ProgramTable(
        angle=degrees,
        s=(motion.s * unit).tolist(),
        v=motion.v.tolist(),
        a=motion.a.tolist(),
        j=motion.j.tolist(),
    )


def _curve(degrees: list[float], points: Complex) -> CamCurve:
    return CamCurve(angle=degrees, x=points.real.tolist(), y=points.imag.tolist())


def core_follower(mechanism: CamMechanism) -> core.Follower:
    """The follower of a mechanism, for the analysis core; from its dimensions alone.

    Raises
    ------
    DimensionError
        For dimensions that no follower can have.
    """
    stated = mechanism.follower
    radius = mechanism.prime_radius if stated.type.endswith("roller") else mechanism.base_radius
    return follower_by_dimensions(stated.type, radius or 0.0, stated)


def points_of(curve: CamCurve) -> Complex:
    """A curve as complex numbers."""
    return np.array(curve.x) + 1j * np.array(curve.y)


def table_angles(program: ProgramTable) -> Real:
    """Cam angles of a program's table, radians, within a turn."""
    return np.mod(np.radians(program.angle), TURN)
