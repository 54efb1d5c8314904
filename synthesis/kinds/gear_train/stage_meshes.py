"""Which gears may mesh in stages that are stated one by one, and at which distances such meshes stand.

The pitch cones of bevel gears have to be less than flat, and rings are those of
:func:`~synthesis.kinds.gear_train.rings.run_in_rings`. Whether other gears dig into one another is looked at where that
is refused.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from kinematics.errors import DimensionError
from kinematics.gear.bevel import BevelCones
from kinematics.gear.teeth import largest_gear
from kinematics.gear.worm import WormDrive
from synthesis.kinds.gear_train.pairing import Integers
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.rings import Pairs, run_in_rings
from synthesis.kinds.gear_train.stated_stages import StatedStage

SAME_DISTANCE = 1e-13
"""Share of a distance within which those of stages with different helix angles are one, in rounding."""


def sound_meshes(problem: GearTrainProblem, stage: StatedStage, most: int) -> Pairs:
    """Which gears of up to ``most`` teeth may be driver and driven gear of a stage; of shape (most + 1, most + 1)."""
    if stage.type == "internal":
        return _in_rings(problem, stage, most)
    if stage.type == "bevel":
        return _bevel(problem, stage, most)
    if stage.type == "worm":
        return _worms(problem, stage, most)
    return _outside(problem, stage, most)


def _outside(problem: GearTrainProblem, stage: StatedStage, most: int) -> Pairs:
    """Spur and helical gears; of fitted ones the fit tells which are sound."""
    a, b = np.ogrid[: most + 1, : most + 1]
    sound = np.minimum(a, b) > 0
    if problem.interference == "report" or problem.is_fitted:
        return sound
    beta = math.radians(stage.helix_angle or 0.0)
    angle = math.atan(math.tan(math.radians(problem.pressure_angle)) / math.cos(beta))
    largest = [largest_gear(n, angle, math.cos(beta)) if n else 0 for n in range(most + 1)]
    bound = np.array([most if n is None else n for n in largest])
    return np.asarray(sound & (np.maximum(a, b) <= bound[np.minimum(a, b)]))


def _in_rings(problem: GearTrainProblem, stage: StatedStage, most: int) -> Pairs:
    pinion, ring = np.meshgrid(*[np.arange(most + 1.0)] * 2, indexing="ij")
    found = run_in_rings(pinion, ring, math.radians(problem.pressure_angle))
    return found.T if stage.ring == "driver" else found


def _bevel(problem: GearTrainProblem, stage: StatedStage, most: int) -> Pairs:
    """Pairs that have cones; of the teeth asked for alone, as each is made."""
    sigma = math.radians(stage.or_usual("shaft_angle"))
    found = np.zeros((most + 1, most + 1), np.bool_)
    for driver, driven in stage.given_pairs():
        try:
            mesh = BevelCones(driver, driven, 1.0, sigma, math.radians(problem.pressure_angle)).back_mesh
        except DimensionError:
            continue
        found[driver, driven] = problem.interference == "report" or not mesh.interferes
    return found


def _worms(problem: GearTrainProblem, stage: StatedStage, most: int) -> Pairs:
    quotient = stage.or_usual("diameter_quotient")
    found = np.zeros((most + 1, most + 1), np.bool_)
    for driver, driven in stage.given_pairs():
        gear = WormDrive(driver, driven, 1.0, quotient, math.radians(problem.pressure_angle)).gear
        found[driver, driven] = problem.interference == "report" or not gear.is_undercut
    return found


def distance_keys(
    stages: Sequence[StatedStage], pitch: Integers, stage: Integers, a: Integers, b: Integers
) -> Integers:
    """Whole numbers that are equal for meshes of equal distance, without shift.

    Parameters
    ----------
    pitch, stage, a, b : array of shape (n,)
        Modules as whole multiples of one measure, numbers of the stages from 0, and teeth of the meshes.
    """
    internal = np.array([one.type == "internal" for one in stages])[stage]
    whole = pitch * np.where(internal, np.abs(b - a), a + b)
    angles = np.abs(np.array([one.helix_angle or 0.0 for one in stages]))
    if (angles == angles[0]).all():
        return np.asarray(whole, np.int64)
    apart = whole / np.cos(np.radians(angles))[stage]
    order = np.argsort(apart, kind="stable")
    new = np.diff(apart[order], prepend=-1.0) > SAME_DISTANCE * apart[order]
    keys = np.empty(len(apart), np.int64)
    keys[order] = np.cumsum(new)
    return keys
