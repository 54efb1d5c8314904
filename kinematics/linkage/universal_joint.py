"""Shafts joined by universal joints (Hooke's): rotation, speed ratio, acceleration, extremes and the double joint.

A joint between shafts at an angle δ rotates the driven shaft by γ while the driver rotates by α, both from the position
in which the driver's fork lies in the plane of the shafts (Rao, Sec. 4.6; Norton, Sec. 10, writes β for δ):

    tan γ = tan α/cos δ,    ω_γ/ω_α = cos δ/(1 − cos² α sin² δ).

On the pair (cos, sin) of an angle a joint acts as the matrix diag(cos δ, 1), up to a factor, and shafts in a row as the
product M of such matrices with turns by the angles between their forks. For any matrix

    dγ/dα = det M/|M u|²,    u = (cos α, sin α),

lies between σ₂/σ₁ and σ₁/σ₂ of its singular values: a row of joints moves like a single joint with cos δ = σ₂/σ₁. Two
equal joints whose forks on the shaft between them lie in one plane, with all shafts in one plane, give σ₁ = σ₂: the
speeds are equal at every instant.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Real
from kinematics.linkage.batch import require


class Joint(NamedTuple):
    """One universal joint of a row.

    Attributes
    ----------
    angle : float
        Angle between the two shafts, radians, from 0 to below π/2.
    offset : float
        For every joint but the first, radians: the angle between the forks at both ends of the preceding shaft minus
        the angle between the planes of the shafts at the two joints. 0 is the arrangement that equalizes the speeds.
    """

    angle: float
    offset: float = 0.0


class ShaftMotion(NamedTuple):
    """Output over input angles: its angle, and the first and second derivatives by the input angle.

    ``angle`` is the rotation from the output's position at input angle 0.
    """

    angle: Real
    ratio: Real
    ratio_rate: Real


class ShaftExtremes(NamedTuple):
    """Extremes of the output over a turn of the input at constant speed.

    Attributes
    ----------
    greatest, least : float
        Ratios of output to input speed.
    fastest_at : float
        Input angle of the maximum, radians in [0, π); the minimum is π/2 away, and both repeat every half turn.
    fluctuation : float
        (greatest − least) over the mean speed, which is the input's.
    acceleration : float
        Maximum magnitude of the output's acceleration, over the square of the input speed.
    steepest_at : float
        Input angle of that acceleration, measured from ``fastest_at``, radians in [0, π/2]; it also occurs at the
        mirror image of this angle.
    equivalent_angle : float
        Angle of the single joint with the same motion, radians.
    """

    greatest: float
    least: float
    fastest_at: float
    fluctuation: float
    acceleration: float
    steepest_at: float
    equivalent_angle: float


def build_joint_matrix(joints: Sequence[Joint]) -> Real:
    """Build the matrix of a row of joints, shape (2, 2), with determinant 1.

    Raises
    ------
    DimensionError
        For no joint, or an angle outside 0 to below π/2: a joint at a right angle cannot turn.
    """
    require(
        "kinematics-joint-count", "kinematics-at-least", np.asarray(len(joints)), np.bool_(len(joints) >= 1), least=1
    )
    matrix = np.eye(2)
    for n, joint in enumerate(joints):
        angle = np.asarray(joint.angle)
        possible = (angle >= 0.0) & (angle < 0.5 * np.pi)
        require("kinematics-joint-angle", "kinematics-below-right-angle", angle, possible)
        if n:
            # The driven fork is a quarter turn from the driver's; the next joint counts from its own driving fork.
            turn = joint.offset + 0.5 * math.pi
            matrix = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]) @ matrix
        root = math.sqrt(math.cos(joint.angle))
        matrix = np.diag([root, 1.0 / root]) @ matrix
    return np.asarray(matrix)


def compute_shaft_motion(joints: Sequence[Joint], input: ArrayLike) -> ShaftMotion:
    """Compute angle and rates of the last shaft.

    Parameters
    ----------
    joints : sequence of Joint
        Joints in order from the input.
    input : float
        Input angles from the position with the driver's fork in the plane of the shafts, radians, any shape.
    """
    matrix = build_joint_matrix(joints)
    alpha = np.asarray(input, np.float64)
    u = np.stack([np.cos(alpha), np.sin(alpha)])
    v = np.stack([-u[1], u[0]])
    x, y = np.tensordot(matrix, u, 1), np.tensordot(matrix, v, 1)
    squared = np.sum(x * x, axis=0)
    ratio = 1.0 / squared
    # M is a rotation after a stretch, and the stretch leads or lags by less than a quarter turn. Relative to the
    # output's position at input angle 0 the rotation drops out.
    _, sigma, right = np.linalg.svd(matrix)
    stretch = right.T @ np.diag(sigma) @ right

    def compute_lead(at: Real) -> Real:
        moved = np.tensordot(stretch, at, 1)
        return np.asarray(np.arctan2(at[0] * moved[1] - at[1] * moved[0], at[0] * moved[0] + at[1] * moved[1]))

    angle = alpha + compute_lead(u) - compute_lead(np.array([1.0, 0.0]))
    return ShaftMotion(np.asarray(angle), np.asarray(ratio), np.asarray(-2.0 * np.sum(x * y, axis=0) * ratio * ratio))


def find_shaft_extremes(joints: Sequence[Joint]) -> ShaftExtremes:
    """Find the extremes over a turn, in closed form.

    With s = sin² δ of the equivalent joint the acceleration is maximal where, measured from the fastest position,
    (s/2) cos² 2α + (1 − s/2) cos 2α = s; Rao's eq. 4.25 drops the first term.
    """
    _, sigma, right = np.linalg.svd(build_joint_matrix(joints))
    cosine = float(min(sigma[1] / sigma[0], 1.0))
    # sin² δ without cancellation for small joint angles.
    s = (1.0 - cosine) * (1.0 + cosine)
    fastest = math.atan2(right[1, 1], right[1, 0]) % math.pi
    half = 1.0 - 0.5 * s
    twice = 2.0 * s / (half + math.sqrt(half * half + 2.0 * s * s))
    steepest = 0.5 * math.acos(min(twice, 1.0))
    at = 1.0 - s * math.cos(steepest) ** 2
    return ShaftExtremes(
        1.0 / cosine,
        cosine,
        fastest,
        1.0 / cosine - cosine,
        cosine * s * math.sin(2.0 * steepest) / (at * at),
        steepest,
        math.acos(cosine),
    )


def compute_joint_angle(fluctuation: float) -> float:
    """Compute the joint angle, radians, with a given fluctuation (ω_max − ω_min)/ω_mean (Rao, Solved Problem 4.10)."""
    value = np.asarray(fluctuation)
    require("fluctuation", "kinematics-zero-or-more-and-finite", value, np.isfinite(value) & (value >= 0.0))
    cosine = 0.5 * (math.hypot(fluctuation, 2.0) - fluctuation)
    return math.acos(min(cosine, 1.0))


def compute_max_joint_angle(least: float, greatest: float) -> float:
    """Compute the largest joint angle at which the speed ratio stays between two limits; radians.

    Parameters
    ----------
    least, greatest : float
        Limits of output over input speed, in (0, 1] and at least 1; 0 and infinity for no limit.
    """
    low, high = np.asarray(least), np.asarray(greatest)
    require("kinematics-least-ratio", "kinematics-from-0-to-1", low, (low >= 0.0) & (low <= 1.0))
    require("kinematics-greatest-ratio", "kinematics-at-least", high, high >= 1.0, least=1)
    return math.acos(max(least, 1.0 / greatest))
