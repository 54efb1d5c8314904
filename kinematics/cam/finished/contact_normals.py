"""Outward normals that a follower requires where it touches a finished cam, from the points alone.

Each point of the profile comes with its cam angle, so the follower's path is known in the cam's frame. A
roller that touches at a point q (in the ground's frame) has its centre on its path at a distance r from q, and a face
lies at its distance f from its pivot C: the direction n = e^{iλ} of the normal follows from q without a derivative.
With D = |C − q|, β the angle of q at the pivot, and σ the sense in which the arm swings outward,

    translating roller    sin λ = (e − q_y)/r
    oscillating roller    λ = arg(C − q) + σ arccos(((D − L)(D + L) + r²)/(2 D r))
    translating face      λ = 0
    oscillating face      λ = σ (π/2 − β − arcsin(f/D))
    roller in a groove    sin λ = ±(q_x − R θ)/r, λ from the axis

(the relations of :mod:`contact`, solved for the normal instead of the displacement). In the cam's frame, turned
clockwise, the normal stands at θ + λ. This does not prove that the profile is touched there: :mod:`curvature` compares
the normals with the chords.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.cam.follower import Follower, OscillatingFlat, TranslatingFlat, TranslatingRoller
from kinematics.errors import DimensionError

Side = Literal[1, -1]
"""Side of a wall on which the roller lies: 1 on it, −1 under it."""


class Normals(NamedTuple):
    """Normals at points of a profile.

    Attributes
    ----------
    lean : float, shape (n,)
        λ, radians; NaN where the follower cannot touch the point at its angle.
    arm : float, shape (n,)
        Displacement of a point per rotation of its normal, length per radian: an error ε of a point turns its normal
        by at most ε/arm.
    """

    lean: Real
    arm: Real


def compute_contact_normals(follower: Follower, points: Complex, at: Real) -> Normals:
    """Compute the normals at points of a cam that turns clockwise, touched at cam angles ``at`` (radians), shape (n,).

    Raises
    ------
    DimensionError
        For a knife edge, which determines no normal.
    """
    q = points * np.exp(-1j * at)
    if isinstance(follower, TranslatingFlat):
        # The face keeps its direction wherever it touches, so errors of the point do not turn the normal.
        return Normals(np.zeros(len(q)), np.full(len(q), math.inf))
    if isinstance(follower, OscillatingFlat):
        sense, to_pivot = follower.sense, follower.pivot_distance - q
        distance = np.abs(to_pivot)
        with np.errstate(invalid="ignore"):
            beyond = np.arcsin(follower.face_offset / distance)
        beta = np.arctan2(-sense * to_pivot.imag, to_pivot.real)
        return Normals(sense * (0.5 * math.pi - beta - beyond), distance * np.cos(beyond))
    radius = _check_roller_radius(follower.roller_radius)
    if isinstance(follower, TranslatingRoller):
        return _build_from_sine((follower.offset - q.imag) / radius, radius)
    to_pivot = follower.pivot_distance - q
    distance = np.abs(to_pivot)
    # Factored, since distance² − arm² would cancel.
    square = (distance - follower.arm) * (distance + follower.arm) + radius**2
    with np.errstate(invalid="ignore"):
        inner = np.arccos(square / (2.0 * distance * radius))
    lean = np.angle(to_pivot) + follower.sense * inner
    # Wrap to (−π, π], as the sum of two angles may exceed it.
    return Normals(np.angle(np.exp(1j * lean)), radius * np.sin(inner))


def compute_wall_normals(radius: float, roller_radius: float, side: Side, points: Complex, at: Real) -> Normals:
    """Compute the normals toward +y at points of an unrolled wall of a groove; see :func:`compute_contact_normals`.

    Parameters
    ----------
    radius : float
        Radius of the cylinder.
    side : {1, -1}
        1 if the roller lies on the wall, −1 if it lies under it.
    """
    rolling = _check_roller_radius(roller_radius)
    return _build_from_sine(side * (points.real - radius * at) / rolling, rolling)


def _build_from_sine(sine: Real, radius: float) -> Normals:
    """Build the normals of a roller of given radius from sin λ."""
    with np.errstate(invalid="ignore"):
        # NaN where the point is beyond the roller's reach; callers check.
        lean = np.arcsin(sine)
    return Normals(lean, radius * np.cos(lean))


def _check_roller_radius(radius: float) -> float:
    if not radius > 0.0:
        raise DimensionError("kinematics-roller-radius", "kinematics-positive-for-normal", radius)
    return radius
