"""Formulas of the textbooks for cams that no analysis offers, for the rows of the literature that ask for them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.cam.barrel import BarrelCam
from kinematics.cam.dynamics import FollowerLoad
from kinematics.cam.follower import OscillatingFlat, TranslatingFlat
from kinematics.cam.motion.extremes import Extremes, find_extremes
from kinematics.cam.profile import Cam

POINTED = 1e-9
"""Share of the roller radius by which the pitch curve's must be larger: at equality the profile has a cusp."""


def profile_radius(cam: Cam, angle: ArrayLike) -> NDArray[np.float64]:
    """Radius of curvature of the profile: positive convex, negative concave, infinite at an inflection.

    Under a roller it is ρ − roller_radius with ρ of the pitch curve; where ρ is positive and that is not, the
    profile is undercut (Norton, Sec. 8.7).
    """
    with np.errstate(divide="ignore"):
        return np.asarray(1.0 / cam.pitch_curvature(angle) - cam.roller_radius)


def pressure_angle_extremes(cam: Cam) -> Extremes:
    """Exact extremes of the pressure angle, radians."""
    return find_extremes(
        lambda angle: cam.follower.pressure_angle(cam.program.pieces.motion(angle)), cam.program.breaks
    )


def reach_extremes(cam: Cam) -> Extremes:
    """Exact extremes of the contact's place on a flat face: its width is their difference.

    On a translating face it is v from the line through the cam's centre (Norton, Sec. 8.7).
    """
    flat = cam.follower
    assert isinstance(flat, TranslatingFlat | OscillatingFlat)

    def reach(angle: NDArray[np.float64]) -> NDArray[np.float64]:
        motion = cam.program.pieces.motion(angle)
        return motion.v if isinstance(flat, TranslatingFlat) else flat.reach(motion)

    return find_extremes(reach, cam.program.breaks)


def largest_cutter(cam: Cam) -> float:
    """Radius of the largest cutter that reaches every concave part under a roller; infinite without such a part."""
    least = cam.pitch_curvature_extremes.least
    return -1.0 / least + cam.roller_radius if least < 0.0 else math.inf


def cutter_path(cam: Cam, angle: ArrayLike, cutter_radius: float) -> NDArray[np.complex128]:
    """Centres of a cutter or grinding wheel that touches the profile where the follower does."""
    return cam.offset_curve(angle, cutter_radius - cam.roller_radius)


def least_convex_radius(cam: Cam) -> float:
    """Smallest radius of curvature of the convex parts: of the pitch curve, or of a flat face's profile.

    Infinite where a roller's pitch curve is nowhere convex, which no closed one is.
    """
    if isinstance(cam.follower, TranslatingFlat | OscillatingFlat):
        return cam.radius_extremes.least
    greatest = cam.pitch_curvature_extremes.greatest
    return 1.0 / greatest if greatest > 0.0 else math.inf


def undercut(cam: Cam) -> bool:
    """Whether the profile has a cusp or runs back on itself somewhere: no cam gives this motion (Norton §8.7)."""
    return least_convex_radius(cam) <= cam.roller_radius * (1.0 + POINTED)


def least_groove_radius(cam: BarrelCam) -> float:
    """Smallest radius of curvature of a barrel's unrolled pitch curve; infinite for a straight one.

    A wall of the groove has a cusp where the roller is as large.
    """

    def curvature(angle: NDArray[np.float64]) -> NDArray[np.float64]:
        motion = cam.program.pieces.motion(angle)
        return np.asarray(motion.a * cam.radius / np.hypot(cam.radius, motion.v) ** 3)

    worst = find_extremes(curvature, cam.program.breaks).largest
    return 1.0 / worst if worst > 0.0 else math.inf


def damped_frequency(load: FollowerLoad) -> float:
    """ω_n √(1 − ζ²), radians per unit of time; 0 where the damping is critical or more."""
    square = load.natural_frequency**2 - (0.5 * load.damping / load.mass) ** 2
    return math.sqrt(max(square, 0.0))
