"""Ordinary gear trains: gears on fixed shafts, in stages, with idlers.

Each mesh divides the speed by the ratio of the teeth (Norton, Design of Machinery, Sec. 9.6–9.8), and an external one
reverses the direction; speeds are computed mesh by mesh as exact fractions of the input's. With the power P on the
input shaft and the efficiency η of every mesh, the torque on a shaft is P/ω times the product of the efficiencies so
far.

The shafts of a bevel stage intersect, those of a worm and its gear cross: there is no common sense of rotation. The
speed of a shaft counts about its own axis, for the input from its outer end in the direction of the power:
parallel shafts share it; the driven shaft of a bevel stage has its axis from the apex on outwards; that of a
worm gear is d × w, d the direction from the worm to its gear and w the axis of the worm. So a bevel stage keeps the
sign, and so does a right-handed worm; a left-handed one reverses it.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Literal

import numpy as np

from kinematics.arrays import Real
from kinematics.errors import DimensionError
from kinematics.gear.bevel import BevelCones
from kinematics.gear.flanks import compute_tip_shortening
from kinematics.gear.helical import HelicalGear
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, PRESSURE_ANGLE, Gear, Mesh
from kinematics.gear.worm import WormDrive

StageKind = Literal["external", "internal", "helical", "bevel", "worm"]
"""Kinds of stages: two spur gears; a pinion in a ring; two helical gears; two bevel gears; a worm and its gear."""

CROSSED_KINDS: tuple[StageKind, ...] = ("bevel", "worm")
"""Kinds of stages whose shafts are not parallel."""

USUAL_QUOTIENT = 10.0
"""Default pitch diameter of a worm in axial modules."""

USUAL_FRICTION = 0.05
"""Default friction coefficient of lubricated teeth."""


@dataclass(frozen=True)
class TrainStage:
    """Gears in line from the driver over any idlers to the driven gear, of one module.

    ``shifts`` are the profile shifts of driver and driven gear, modules; idlers have none. The tips of a shifted pair
    are shortened so that the clearance stays.

    The module of helical teeth is that of the normal plane, of bevel teeth that of the large end, of a worm the axial
    one; ``helix_angle`` is the driver's, the driven gear has the other hand. In an internal stage the larger gear is
    the ring; ``addenda`` are those of driver and driven gear there, modules. A worm drives, and ``driver`` are its
    threads. Angles are radians. ``face_width`` and ``friction`` do not affect the motion of a train.
    """

    driver: int
    driven: int
    module: float = 1.0
    idlers: tuple[int, ...] = ()
    shifts: tuple[float, float] = (0.0, 0.0)
    kind: StageKind = "external"
    helix_angle: float = 0.0
    shaft_angle: float = 0.5 * math.pi
    addenda: tuple[float, float] = (FULL_DEPTH_ADDENDUM, FULL_DEPTH_ADDENDUM)
    quotient: float = USUAL_QUOTIENT
    left_handed: bool = False
    face_width: float | None = None
    friction: float = USUAL_FRICTION

    @property
    def gears(self) -> tuple[int, ...]:
        """Teeth of all gears in the order in which they mesh."""
        return (self.driver, *self.idlers, self.driven)

    @property
    def sense(self) -> int:
        """Sign by which a mesh multiplies the speed, about the axes of its shafts."""
        if self.kind == "worm":
            return -1 if self.left_handed else 1
        return 1 if self.kind in ("internal", "bevel") else -1

    @property
    def is_parallel(self) -> bool:
        """Whether its shafts are parallel."""
        return self.kind not in CROSSED_KINDS

    def worm(self, pressure_angle: float) -> WormDrive:
        """Return the worm and its gear."""
        return WormDrive(self.driver, self.driven, self.module, self.quotient, pressure_angle)

    def cones(self, pressure_angle: float) -> BevelCones:
        """Return the pitch cones of a bevel stage, the driver's first."""
        return BevelCones(self.driver, self.driven, self.module, self.shaft_angle, pressure_angle)

    def meshes(self, pressure_angle: float) -> tuple[Mesh, ...]:
        """Return the meshes without play, the smaller gear as the pinion, of equal ones the first.

        Helical teeth are those of the plane of rotation, bevel teeth those of the back cones; a worm and its gear have
        none.

        Raises
        ------
        DimensionError
            For impossible gears, shifts in a stage with idlers, or either in a kind of stage that allows neither.
        """
        if self.kind != "external":
            return self._build_other_meshes(pressure_angle)
        pairs = itertools.pairwise(self.gears)
        if self.shifts == (0.0, 0.0):
            return tuple(Mesh.standard((min(pair), max(pair)), self.module, pressure_angle) for pair in pairs)
        if self.idlers:
            raise DimensionError("shifts", "kinematics-absent-with-idlers", self.shifts)
        # Keep each shift with its gear while the smaller one becomes the pinion.
        ends = sorted(zip((self.driver, self.driven), self.shifts, strict=True), key=lambda end: end[0])
        pinion, gear = (Gear(teeth, self.module, pressure_angle, shift=shift) for teeth, shift in ends)
        addendum = FULL_DEPTH_ADDENDUM - compute_tip_shortening(Mesh(pinion, gear))
        return (Mesh(replace(pinion, addendum=addendum), replace(gear, addendum=addendum)),)

    def _build_other_meshes(self, pressure_angle: float) -> tuple[Mesh, ...]:
        """Return the mesh of a stage that is not external."""
        if self.idlers:
            raise DimensionError("idlers", "kinematics-absent-in-stage", self.idlers, kind=self.kind)
        if self.kind != "helical" and self.shifts != (0.0, 0.0):
            raise DimensionError("shifts", "kinematics-absent-in-stage", self.shifts, kind=self.kind)
        if self.kind == "worm":
            # Raises for impossible dimensions.
            _ = self.worm(pressure_angle)
            return ()
        if self.kind == "bevel":
            return (self.cones(pressure_angle).back_mesh,)
        one, two = self.cut_gears(pressure_angle)
        return (Mesh(one, two) if self.driver <= self.driven else Mesh(two, one),)

    def _build_transverse_gears(self, pressure_angle: float) -> tuple[Gear, Gear]:
        """Return driver and driven gear of a helical stage in the plane of rotation, shifted tips shortened."""
        shrunk = math.cos(self.helix_angle)
        one, two = (
            replace(HelicalGear(teeth, self.module, angle, pressure_angle).transverse_gear, shift=shrunk * shift)
            for teeth, angle, shift in zip(
                (self.driver, self.driven), (self.helix_angle, -self.helix_angle), self.shifts, strict=True
            )
        )
        if self.shifts == (0.0, 0.0):
            return one, two
        addendum = one.addendum - compute_tip_shortening(Mesh(one, two))
        return replace(one, addendum=addendum), replace(two, addendum=addendum)

    def cut_gears(self, pressure_angle: float) -> tuple[Gear, ...]:
        """Return all gears in the order in which they mesh, with their shifts and tips.

        They are given in the plane of rotation: bevel gears at their large ends, like spur gears; a worm stage has only
        the gear, in its middle plane.
        """
        if self.kind == "helical":
            return self._build_transverse_gears(pressure_angle)
        if self.kind == "internal":
            one, two = (
                Gear(teeth, self.module, pressure_angle, addendum, internal=teeth > mate)
                for teeth, mate, addendum in zip(
                    (self.driver, self.driven), (self.driven, self.driver), self.addenda, strict=True
                )
            )
            return one, two
        if self.kind == "worm":
            return (self.worm(pressure_angle).gear,)
        if self.shifts == (0.0, 0.0):
            return tuple(Gear(teeth, self.module, pressure_angle) for teeth in self.gears)
        mesh = self.meshes(pressure_angle)[0]
        return (mesh.pinion, mesh.gear) if self.driver <= self.driven else (mesh.gear, mesh.pinion)


@dataclass(frozen=True)
class OrdinaryTrain:
    """Stages in the order of the power flow; the driven gear of each sits on the shaft of the next driver.

    Raises
    ------
    DimensionError
        For a train without stages, or impossible gears.
    """

    stages: tuple[TrainStage, ...]
    pressure_angle: float = PRESSURE_ANGLE

    def __post_init__(self) -> None:
        if not self.stages:
            raise DimensionError("stages", "kinematics-at-least-one-stage", self.stages)
        # Building the meshes raises for impossible gears.
        _ = self.meshes

    @cached_property
    def meshes(self) -> tuple[tuple[Mesh, ...], ...]:
        """Meshes of each stage without play, the smaller gear as the pinion."""
        return tuple(stage.meshes(self.pressure_angle) for stage in self.stages)

    @cached_property
    def speeds(self) -> tuple[tuple[Fraction, ...], ...]:
        """Speeds of the gears of each stage, as fractions of the input's; negative for the opposite sense.

        Each counts about the axis of its shaft (:attr:`axes`)."""
        speed, stages = Fraction(1), []
        for stage in self.stages:
            at = [speed]
            for driver, driven in itertools.pairwise(stage.gears):
                at.append(stage.sense * at[-1] * driver / driven)
            stages.append(tuple(at))
            speed = at[-1]
        return tuple(stages)

    @property
    def ratio(self) -> Fraction:
        """Input speed over output speed; negative where they turn in opposite directions."""
        return 1 / self.speeds[-1][-1]

    @property
    def is_parallel(self) -> bool:
        """Whether all shafts are parallel."""
        return all(stage.is_parallel for stage in self.stages)

    @cached_property
    def axes(self) -> tuple[Real, ...]:
        """Axes of the shafts from the input on, unit vectors of shape (3,), the input along z.

        A bevel stage rotates the axis about y, its driven shaft towards x if the shafts before it are along z; a worm
        has its gear on the side towards which a bevel gear's shaft would point.
        """
        along, aside = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
        axes = [along]
        for stage in self.stages:
            if stage.kind == "bevel":
                cosine, sine = math.cos(stage.shaft_angle), math.sin(stage.shaft_angle)
                along, aside = sine * aside - cosine * along, -cosine * aside - sine * along
            elif stage.kind == "worm":
                # The gear's axis is d × w, with d from the worm to the gear and w the worm's axis.
                along = np.cross(aside, along)
            axes.append(along)
        return tuple(axes)

    @property
    def centre_distances(self) -> tuple[float, ...]:
        """Distance of the shafts of each stage, with the idlers in line; 0 if they intersect."""
        return tuple(
            0.0
            if stage.kind == "bevel"
            else stage.worm(self.pressure_angle).centre_distance
            if stage.kind == "worm"
            else sum(mesh.centre_distance for mesh in meshes)
            for stage, meshes in zip(self.stages, self.meshes, strict=True)
        )

    def torques(self, input_torque: float, mesh_efficiency: tuple[tuple[float, ...], ...]) -> tuple[float, ...]:
        """Return the torque of each shaft from input to output; idler shafts are left out.

        Parameters
        ----------
        input_torque : float
        mesh_efficiency : tuple
            Efficiency of each mesh, in the shape of :attr:`meshes`.
        """
        shafts = [input_torque]
        for speeds, shares in zip(self.speeds, mesh_efficiency, strict=True):
            passed = 1.0
            for share in shares:
                passed *= share
            # Torque rises by the speed ratio and falls by the efficiency.
            shafts.append(shafts[-1] * float(speeds[0] / speeds[-1]) * passed)
        return tuple(shafts)
