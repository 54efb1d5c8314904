"""Formulas of the textbooks for cams that no analysis offers, for the rows of the literature that ask for them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.cam.dynamics import FollowerLoad
from kinematics.cam.extremes import Extremes, extremes
from kinematics.cam.follower import OscillatingFlat, TranslatingFlat
from kinematics.cam.profile import Cam


def profile_radius(cam: Cam, angle: ArrayLike) -> NDArray[np.float64]:
    """Radius of curvature of the profile: positive convex, negative concave, infinite at an inflection.

    Under a roller it is ρ − roller_radius with ρ of the pitch curve; where ρ is positive and that is not, the
    profile is undercut (Norton, Sec. 8.7).
    """
    with np.errstate(divide="ignore"):
        return np.asarray(1.0 / cam.pitch_curvature(angle) - cam.roller_radius)


def pressure_angle_extremes(cam: Cam) -> Extremes:
    """Exact extremes of the pressure angle, radians."""
    return extremes(lambda angle: cam.follower.pressure_angle(cam.program.pieces.motion(angle)), cam.program.breaks)


def reach_extremes(cam: Cam) -> Extremes:
    """Exact extremes of the contact's place on a flat face: its width is their difference.

    On a translating face it is v from the line through the cam's centre (Norton, Sec. 8.7).
    """
    flat = cam.follower
    assert isinstance(flat, TranslatingFlat | OscillatingFlat)

    def reach(angle: NDArray[np.float64]) -> NDArray[np.float64]:
        motion = cam.program.pieces.motion(angle)
        return motion.v if isinstance(flat, TranslatingFlat) else flat.reach(motion)

    return extremes(reach, cam.program.breaks)


def largest_cutter(cam: Cam) -> float:
    """Radius of the largest cutter that reaches every concave part under a roller; infinite without such a part."""
    least = cam.pitch_curvature_extremes.least
    return -1.0 / least + cam.roller_radius if least < 0.0 else math.inf


def damped_frequency(load: FollowerLoad) -> float:
    """ω_n √(1 − ζ²), radians per unit of time; 0 where the damping is critical or more."""
    square = load.natural_frequency**2 - (0.5 * load.damping / load.mass) ** 2
    return math.sqrt(max(square, 0.0))
