"""Where the gears of an ordinary train stand: shaft centres in the plane, and the turn of each gear so that teeth mesh.

The shafts stand in one line; those of a reverted train go back and forth between two places, or round a triangle for
three stages, so that the output shaft comes to stand on the input's axis.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from fractions import Fraction

from kinematics.gear.teeth import Gear
from service.render.gears.placed import PlacedGear, facing
from synthesis.kinds.gear_train.design import GearTrainMechanism
from synthesis.kinds.gear_train.verification import driven_train

SAME_DISTANCE = 1e-9
"""Share of a centre distance by which those of a reverted train may differ in rounding."""


@dataclass(frozen=True)
class TrainGear(PlacedGear):
    """A gear of an ordinary train; ``speed`` is its share of the input's."""

    stage: int
    role: str
    speed: Fraction


def placed_gears(mechanism: GearTrainMechanism, reverted: bool) -> list[TrainGear]:
    """All gears in the order of the power, the input shaft at 0."""
    train = driven_train(mechanism)
    distances = train.centre_distances
    coaxial = reverted and max(distances) - min(distances) <= SAME_DISTANCE * max(distances)
    placed: list[TrainGear] = []
    shaft = 0j
    for number, (stage, speeds) in enumerate(zip(train.stages, train.speeds, strict=True)):
        ahead = _direction(number, len(train.stages), coaxial)
        roles = ["driver", *("idler" for _ in stage.idlers), "driven"]
        centre, tooth_at = shaft, cmath.phase(ahead)
        previous: Gear | None = None
        # Shifted gears stand apart by more, or by less, than their pitch circles.
        wide = 1.0
        if stage.shifts != (0.0, 0.0):
            wide = distances[number] / sum(mesh.standard_distance for mesh in train.meshes[number])
        for role, gear, speed in zip(roles, stage.cut_gears(train.pressure_angle), speeds, strict=True):
            if previous is not None:
                centre += ahead * (previous.pitch_radius + gear.pitch_radius) * wide
                tooth_at = facing(previous, tooth_at, gear, cmath.phase(ahead))
            placed.append(TrainGear(gear, centre, tooth_at, number + 1, role, speed))
            previous = gear
        shaft = centre
    return placed


def _direction(number: int, stages: int, coaxial: bool) -> complex:
    """Unit vector from one shaft to the next."""
    if not coaxial:
        return 1.0 + 0j
    if stages == 3:
        return cmath.exp(2j * math.pi * number / 3.0)
    return complex((-1) ** number)
