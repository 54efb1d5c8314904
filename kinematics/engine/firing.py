"""Firing orders: a cylinder fires at its top dead centre, in a four-stroke engine at every other one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real

ANGLE_TOLERANCE = 1e-9
"""Degrees within which two angles, or two unevennesses, are equal."""

MAX_CYLINDERS = 20
"""Maximum number of cylinders: the 2^(n−1) choices of a four-stroke engine are all enumerated."""


class Firing(NamedTuple):
    """Choices of the firing angle of each cylinder.

    Attributes
    ----------
    angles : float, shape (C, n)
        Firing angles after that of the first cylinder, degrees, by cylinder: the choices that are as even as possible.
    unevenness : float
        Largest minus smallest gap between firings, degrees.
    choices : int
        Total number of choices.
    """

    angles: Real
    unevenness: float
    choices: int


def compute_unevenness(angles: Real, cycle: float) -> Real:
    """Compute the largest minus the smallest gap between firings, shape S.

    ``angles``, shape S + (n,), and ``cycle`` are in degrees.
    """
    ordered = np.sort(np.mod(angles, cycle), axis=-1)
    gaps = np.diff(np.concatenate([ordered, ordered[..., :1] + cycle], axis=-1), axis=-1)
    return np.asarray(gaps.max(axis=-1) - gaps.min(axis=-1))


def list_firing_choices(top: Real, strokes: int) -> Firing:
    """List the most even choices of firing angles, given the top dead centres τ (degrees, by cylinder) of an engine of
    2 or 4 strokes."""
    count = len(top)
    own = np.mod(top - top[0], 360.0)
    # An angle that rounding left just below a full turn is a full turn.
    own = np.where(own > 360.0 - ANGLE_TOLERANCE, 0.0, own)
    if strokes == 2:
        return Firing(own[None], float(compute_unevenness(own, 360.0)), 1)
    if count > MAX_CYLINDERS:
        raise ValueError(f"expected at most {MAX_CYLINDERS} cylinders, got {count}")
    # Each bit decides whether a cylinder fires in the first or the second turn; the first cylinder is the origin.
    number = np.arange(1 << (count - 1))[:, None]
    late = np.concatenate([np.zeros((len(number), 1), np.int64), (number >> np.arange(count - 1)) & 1], axis=1)
    angles = own + 360.0 * late
    uneven = compute_unevenness(angles, 720.0)
    least = float(uneven.min())
    # Keep all ties, which differ only by rounding.
    return Firing(angles[uneven <= least + ANGLE_TOLERANCE], least, len(number))
