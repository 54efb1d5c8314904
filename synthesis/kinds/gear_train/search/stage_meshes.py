"""Permitted meshes of stages that are given one by one, and the distances of such meshes.

The pitch cones of bevel gears must have less than a flat angle, and rings are checked by
:func:`~synthesis.kinds.gear_train.statement.ring_pairs.find_running_pairs`. Interference between other gears is only
checked if it is refused.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from kinematics.arrays import Integers, Mask
from kinematics.errors import DimensionError
from kinematics.gear.bevel import BevelCones
from kinematics.gear.teeth import find_largest_gear
from kinematics.gear.worm import WormDrive
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.statement.ring_pairs import find_running_pairs
from synthesis.kinds.gear_train.statement.stages import RequestedStage

DISTANCE_TOLERANCE = 1e-13
"""Relative difference up to which distances of stages with different helix angles are equal, to rounding."""


def find_sound_meshes(problem: GearTrainProblem, stage: RequestedStage, most: int) -> Mask:
    """Return the permitted pairs of driver and driven gear of a stage, up to ``most`` teeth; (most + 1, most + 1)."""
    if stage.type == "internal":
        return _find_internal(problem, stage, most)
    if stage.type == "bevel":
        return _find_bevel(problem, stage, most)
    if stage.type == "worm":
        return _find_worms(problem, stage, most)
    return _find_external(problem, stage, most)


def _find_external(problem: GearTrainProblem, stage: RequestedStage, most: int) -> Mask:
    """Return permitted pairs of spur and helical gears; fitted ones are checked by the fit."""
    a, b = np.ogrid[: most + 1, : most + 1]
    sound = np.minimum(a, b) > 0
    if problem.interference == "report" or problem.is_fitted:
        return sound
    beta = math.radians(stage.helix_angle or 0.0)
    # Interference is decided in the transverse plane, in which the addendum shrinks by cos β.
    angle = math.atan(math.tan(math.radians(problem.pressure_angle)) / math.cos(beta))
    largest = [find_largest_gear(n, angle, math.cos(beta)) if n else 0 for n in range(most + 1)]
    bound = np.array([most if n is None else n for n in largest])
    return np.asarray(sound & (np.maximum(a, b) <= bound[np.minimum(a, b)]))


def _find_internal(problem: GearTrainProblem, stage: RequestedStage, most: int) -> Mask:
    pinion, ring = np.meshgrid(*[np.arange(most + 1.0)] * 2, indexing="ij")
    found = find_running_pairs(pinion, ring, math.radians(problem.pressure_angle))
    return found.T if stage.ring == "driver" else found


def _find_bevel(problem: GearTrainProblem, stage: RequestedStage, most: int) -> Mask:
    """Return pairs that have cones; only given teeth are checked, since each pair is constructed."""
    sigma = math.radians(stage.get_or_default("shaft_angle"))
    found = np.zeros((most + 1, most + 1), np.bool_)
    for driver, driven in stage.list_given_pairs():
        try:
            mesh = BevelCones(driver, driven, 1.0, sigma, math.radians(problem.pressure_angle)).back_mesh
        except DimensionError:
            continue
        found[driver, driven] = problem.interference == "report" or not mesh.interferes
    return found


def _find_worms(problem: GearTrainProblem, stage: RequestedStage, most: int) -> Mask:
    quotient = stage.get_or_default("diameter_quotient")
    found = np.zeros((most + 1, most + 1), np.bool_)
    for driver, driven in stage.list_given_pairs():
        drive = WormDrive(driver, driven, 1.0, quotient, math.radians(problem.pressure_angle))
        found[driver, driven] = problem.interference == "report" or drive.is_free_of_interference
    return found


def compute_distance_keys(
    stages: Sequence[RequestedStage], pitch: Integers, stage: Integers, a: Integers, b: Integers
) -> Integers:
    """Compute whole numbers that are equal for meshes of equal distance without shift.

    Parameters
    ----------
    pitch, stage, a, b : array of shape (n,)
        Modules as whole multiples of one measure, numbers of the stages from 0, and teeth of the meshes.
    """
    internal = np.array([one.type == "internal" for one in stages])[stage]
    whole = pitch * np.where(internal, np.abs(b - a), a + b)
    angles = np.abs(np.array([one.helix_angle or 0.0 for one in stages]))
    # Equal helix angles scale all distances alike, so that integers suffice.
    if (angles == angles[0]).all():
        return np.asarray(whole, np.int64)
    # A helical pair's distance is m (a + b) / (2 cos β).
    apart = whole / np.cos(np.radians(angles))[stage]
    order = np.argsort(apart, kind="stable")
    # Sorted distances that differ by more than rounding begin a new key.
    new = np.diff(apart[order], prepend=-1.0) > DISTANCE_TOLERANCE * apart[order]
    keys = np.empty(len(apart), np.int64)
    keys[order] = np.cumsum(new)
    return keys
