"""Motion program measured from a finished profile.

Displacement, velocity and acceleration are measured at equal cam angles by the contact search and joined by quintics,
so that forces, torques and vibrations can be computed for a cam whose program is unknown.
"""

from __future__ import annotations

import numpy as np

from kinematics.cam.finished.contact import Contour
from kinematics.cam.follower import Follower
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_knot_segment
from kinematics.cam.profile import Rotation, space_angles
from kinematics.errors import DimensionError

HERMITE_MATRIX = np.array(
    [
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.5, 0.0, 0.0, 0.0],
        [-10.0, -6.0, -1.5, 10.0, -4.0, 0.5],
        [15.0, 8.0, 1.5, -15.0, 7.0, -1.0],
        [-6.0, -3.0, -0.5, 6.0, -3.0, 0.5],
    ]
)
"""Coefficients of the quintic on [0, 1] with given s, v, a at 0 and at 1."""


def measure_program(contour: Contour, follower: Follower, rotation: Rotation, count: int) -> Program:
    """Measure the program of a profile under a follower at ``count`` equal cam angles.

    Raises
    ------
    DimensionError
        If the follower touches nothing at some angle.
    """
    found = contour.follow(follower, space_angles(count), rotation)
    if not found.valid.all():
        raise DimensionError("profile", "kinematics-touched-at-every-angle", int((~found.valid).sum()))
    h = TURN / count
    # Derivatives by the share of a step, as the Hermite matrix expects.
    states = np.stack([found.s, h * found.v, h * h * found.a], axis=1)
    ends = np.concatenate([states, np.roll(states, -1, axis=0)], axis=1)
    coefficients = (ends @ HERMITE_MATRIX.T) / h ** np.arange(6)
    return Program([build_knot_segment(np.linspace(0.0, TURN, count + 1), coefficients)])
