"""Ordinary gear trains: external spur gears on fixed shafts, in stages, with idlers.

Each mesh turns the direction round and divides the speed by the ratio of the teeth (Norton, Design of Machinery,
Sec. 9.6–9.8); speeds are followed mesh by mesh as exact fractions of the input's. With the power P on the input shaft
and a share η of it passed on by every mesh, the torque on a shaft is P/ω times the product of the shares so far.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

from kinematics.errors import DimensionError
from kinematics.gear.flanks import shortened_tips
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, PRESSURE_ANGLE, Gear, Mesh


@dataclass(frozen=True)
class TrainStage:
    """Gears in line from the driver over any idlers to the driven gear, of one module.

    ``shifts`` are the profile shifts of driver and driven gear, modules; idlers have none. The tips of a shifted pair
    are shortened so that the clearance stays.
    """

    driver: int
    driven: int
    module: float = 1.0
    idlers: tuple[int, ...] = ()
    shifts: tuple[float, float] = (0.0, 0.0)

    @property
    def gears(self) -> tuple[int, ...]:
        """Teeth of all gears in the order in which they mesh."""
        return (self.driver, *self.idlers, self.driven)

    def meshes(self, pressure_angle: float) -> tuple[Mesh, ...]:
        """The meshes without play, the smaller gear as the pinion, of equal ones the first.

        Raises
        ------
        DimensionError
            For gears that do not exist, or shifts of a stage with idlers.
        """
        pairs = itertools.pairwise(self.gears)
        if self.shifts == (0.0, 0.0):
            return tuple(Mesh.standard((min(pair), max(pair)), self.module, pressure_angle) for pair in pairs)
        if self.idlers:
            raise DimensionError("shifts", "none in a stage with idlers", self.shifts)
        ends = sorted(zip((self.driver, self.driven), self.shifts, strict=True), key=lambda end: end[0])
        pinion, gear = (Gear(teeth, self.module, pressure_angle, shift=shift) for teeth, shift in ends)
        addendum = FULL_DEPTH_ADDENDUM - shortened_tips(Mesh(pinion, gear))
        return (Mesh(replace(pinion, addendum=addendum), replace(gear, addendum=addendum)),)

    def cut_gears(self, pressure_angle: float) -> tuple[Gear, ...]:
        """All gears in the order in which they mesh, with their shifts and tips."""
        if self.shifts == (0.0, 0.0):
            return tuple(Gear(teeth, self.module, pressure_angle) for teeth in self.gears)
        mesh = self.meshes(pressure_angle)[0]
        return (mesh.pinion, mesh.gear) if self.driver <= self.driven else (mesh.gear, mesh.pinion)


@dataclass(frozen=True)
class OrdinaryTrain:
    """Stages in the order of the power; the driven gear of one sits on the shaft of the next one's driver.

    Raises
    ------
    DimensionError
        For a train without stages, or gears that do not exist.
    """

    stages: tuple[TrainStage, ...]
    pressure_angle: float = PRESSURE_ANGLE

    def __post_init__(self) -> None:
        if not self.stages:
            raise DimensionError("stages", "at least one", self.stages)
        # Gears that do not exist are refused when they are made.
        _ = self.meshes

    @cached_property
    def meshes(self) -> tuple[tuple[Mesh, ...], ...]:
        """The meshes of each stage without play, the smaller gear as the pinion."""
        return tuple(stage.meshes(self.pressure_angle) for stage in self.stages)

    @cached_property
    def speeds(self) -> tuple[tuple[Fraction, ...], ...]:
        """Speeds of the gears of each stage, as fractions of the input's; a negative one turns the other way."""
        speed, stages = Fraction(1), []
        for stage in self.stages:
            at = [speed]
            for driver, driven in itertools.pairwise(stage.gears):
                at.append(-at[-1] * driver / driven)
            stages.append(tuple(at))
            speed = at[-1]
        return tuple(stages)

    @property
    def ratio(self) -> Fraction:
        """Input speed over output speed; negative where they turn in opposite directions."""
        return 1 / self.speeds[-1][-1]

    @property
    def centre_distances(self) -> tuple[float, ...]:
        """Distance of the shafts of each stage, with the idlers in line."""
        return tuple(sum(mesh.centre_distance for mesh in stage) for stage in self.meshes)

    def torques(self, input_torque: float, mesh_efficiency: tuple[tuple[float, ...], ...]) -> tuple[float, ...]:
        """Torque that each shaft passes on, from the input shaft to the output shaft; idlers pass on none.

        Parameters
        ----------
        input_torque : float
        mesh_efficiency : tuple
            Share of the power that each mesh passes on, in the shape of :attr:`meshes`.
        """
        shafts = [input_torque]
        for speeds, shares in zip(self.speeds, mesh_efficiency, strict=True):
            passed = 1.0
            for share in shares:
                passed *= share
            shafts.append(shafts[-1] * float(speeds[0] / speeds[-1]) * passed)
        return tuple(shafts)
