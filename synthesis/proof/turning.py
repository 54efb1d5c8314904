"""What is measured of a mechanism whose crank turns through: transmission over the turn, and the room it takes."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism

Real = NDArray[np.float64]

GRID = 721
"""Inputs of the turn that are looked at first."""

CLOSER, LOOKS = 17, 8
"""Inputs in each closer look at a least transmission angle, and the number of looks: 8⁸ times finer than the grid."""


class Turn(NamedTuple):
    """One turn of the crank.

    Attributes
    ----------
    turns : bool
        Whether the mechanism can be assembled, with a motion, all the way round.
    transmission : dict of str to float
        The least transmission angle at each closure, by the name of its first link; radians.
    size : float
        Diagonal of the box around all joints.
    """

    turns: bool
    transmission: dict[str, float]
    size: float


def turn_of(mechanism: Mechanism) -> Turn:
    """Drive a mechanism through a full turn of its input from the reference, on the reference's assemblies."""
    start = float(mechanism.reference_input)
    grid = start + np.linspace(0.0, 2.0 * np.pi, GRID)
    motion = drive(mechanism, grid, order=1)
    least = {}
    for link, sines in motion.sines.items():
        values = np.abs(sines)
        if not np.isfinite(values).any():
            least[link] = 0.0
            continue
        at, step, found = grid[int(np.nanargmin(values))], 2.0 * np.pi / (GRID - 1), float(np.nanmin(values))
        for _ in range(LOOKS):
            inputs = np.linspace(at - step, at + step, CLOSER)
            closer = np.abs(drive(mechanism, inputs, order=0).sines[link])
            if not np.isfinite(closer).all():
                found = 0.0
                break
            at, found = inputs[int(closer.argmin())], min(found, float(closer.min()))
            step *= 2.0 / (CLOSER - 1)
        least[link] = math.asin(min(found, 1.0))
    places = np.concatenate([jet[0] for jet in motion.joints.values()])
    places = places[np.isfinite(places)]
    span = np.ptp(places.view(np.float64).reshape(-1, 2), axis=0) if len(places) else np.zeros(2)
    return Turn(bool(motion.smooth.all()), least, math.hypot(*span))
