"""Torque and pin force of an index at steady speed of the crank.

The wheel takes T = J ω² φ'' + T_L; without friction the crank gives M = T φ', and the roller presses on the side of its
slot with F = T/ρ, square to the slot, at its distance ρ from the wheel's axis (Norton, *Design of Machinery*, ch. 11).
Where F is negative it is the slot's other side that holds the wheel back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.extremes import extremes
from kinematics.indexing.geneva import Geneva

Real = NDArray[np.float64]


@dataclass(frozen=True)
class Load:
    """What the wheel carries, and how fast the crank turns (rad/s)."""

    inertia: float
    torque: float
    speed: float


def arm(drive: Geneva, angle: Real, size: float) -> Real:
    """Distance of the roller from the wheel's axis; ``size`` is the center distance, or the sphere's radius."""
    if drive.drive == "geneva_spherical":
        sine, cosine = math.sin(math.atan(drive.ratio)), math.cos(math.atan(drive.ratio))
        return np.asarray(size * np.hypot(cosine, sine * np.sin(angle)))
    ratio = drive.signed
    return np.asarray(size * np.sqrt(1.0 - 2.0 * ratio * np.cos(angle) + ratio * ratio))


def wheel_torque(drive: Geneva, load: Load, angle: Real) -> Real:
    """Torque on the wheel at angles (radians) from the middle of the index."""
    return np.asarray(load.inertia * load.speed**2 * drive.motion(angle).a + load.torque)


@dataclass(frozen=True)
class Peaks:
    """Greatest magnitudes over an index."""

    velocity: float
    jerk: float
    wheel_torque: float
    drive_torque: float
    pin_force: float


def peaks(drive: Geneva, load: Load, size: float) -> Peaks:
    """The greatest of motion and forces; ``size`` in the unit of torque over force."""
    breaks = [-drive.half, 0.0, drive.half]
    return Peaks(
        velocity=extremes(lambda at: drive.motion(at).v, breaks).largest,
        jerk=extremes(lambda at: drive.motion(at).j, breaks).largest,
        wheel_torque=extremes(lambda at: wheel_torque(drive, load, at), breaks).largest,
        drive_torque=extremes(lambda at: wheel_torque(drive, load, at) * drive.motion(at).v, breaks).largest,
        pin_force=extremes(lambda at: wheel_torque(drive, load, at) / arm(drive, at, size), breaks).largest,
    )
