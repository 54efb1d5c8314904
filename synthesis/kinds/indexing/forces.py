"""Torque and pin force during an index at constant speed of the crank.

The wheel requires the torque T = J ω² φ'' + T_L. Without friction, the drive torque is M = T φ', and the roller presses
on the side of its slot with F = T/ρ, normal to the slot, at the distance ρ from the wheel's axis (Norton, *Design of
Machinery*, ch. 11). If F is negative, the other side of the slot decelerates the wheel.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real
from kinematics.cam.motion.extremes import find_extremes
from kinematics.indexing.drag_link import CrankCourse
from kinematics.indexing.geneva import Geneva

TIE_TOLERANCE = 1e-9
"""Relative difference up to which two peaks count as equal, so that the first is reported."""


@dataclass(frozen=True)
class Load:
    """Load of the wheel, and speed of the crank (rad/s)."""

    inertia: float
    torque: float
    speed: float


def compute_arm(drive: Geneva, angle: Real, size: float) -> Real:
    """Return the distance of the roller from the wheel's axis; ``size`` is the center distance or the sphere radius."""
    if drive.drive == "geneva_spherical":
        sine, cosine = math.sin(math.atan(drive.ratio)), math.cos(math.atan(drive.ratio))
        return np.asarray(size * np.hypot(cosine, sine * np.sin(angle)))
    ratio = drive.signed
    return np.asarray(size * np.sqrt(1.0 - 2.0 * ratio * np.cos(angle) + ratio * ratio))


def compute_wheel_torque(course: CrankCourse, load: Load, angle: Real) -> Real:
    """Return the torque on the wheel at angles (radians) of the input."""
    return np.asarray(load.inertia * load.speed**2 * course.motion(angle).a + load.torque)


def compute_pin_force(course: CrankCourse, load: Load, angle: Real, size: float) -> Real:
    """Return the force of the roller on the slot's side at angles of the input."""
    return np.asarray(
        compute_wheel_torque(course, load, angle) / compute_arm(course.geneva, course.crank(angle).s, size)
    )


@dataclass(frozen=True)
class Peaks:
    """Maximum magnitudes over an index."""

    velocity: float
    acceleration: float
    acceleration_at: float
    jerk: float
    wheel_torque: float
    drive_torque: float
    pin_force: float


def find_peaks(course: CrankCourse, load: Load, size: float) -> Peaks:
    """Find the peaks of motion and forces; ``size`` in the unit of torque over force.

    ``acceleration_at`` is the input's angle from the entry.
    """
    start, end = course.start, course.end
    # The motion is symmetrical about mid-index; its derivatives are smooth on each half.
    breaks = [start, 0.5 * (start + end), end]
    acceleration = find_extremes(lambda at: course.motion(at).a, breaks)
    # Of two equal peaks the positive one is reported, independent of rounding.
    at = acceleration.at_greatest
    if abs(acceleration.least) > acceleration.greatest * (1.0 + TIE_TOLERANCE):
        at = acceleration.at_least
    return Peaks(
        velocity=find_extremes(lambda at: course.motion(at).v, breaks).largest,
        acceleration=acceleration.largest,
        acceleration_at=at - start,
        jerk=find_extremes(lambda at: course.motion(at).j, breaks).largest,
        wheel_torque=find_extremes(lambda at: compute_wheel_torque(course, load, at), breaks).largest,
        drive_torque=find_extremes(
            lambda at: compute_wheel_torque(course, load, at) * course.motion(at).v, breaks
        ).largest,
        pin_force=find_extremes(lambda at: compute_pin_force(course, load, at, size), breaks).largest,
    )
