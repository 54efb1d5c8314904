"""Parts of a worm with its gear: a single-stage train whose shafts cross.

The worm is the involute helicoid of a helical gear with as many teeth as the worm has threads. Its gear is the helical
gear of the same hand that meshes with it at a right angle. Both have the rack of the same normal plane, so that they
touch in a point and turn at the exact ratio (F. L. Litvin & A. Fuentes, Gear Geometry and Applied Theory, 2004, ch.
16).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from kinematics.errors import DimensionError
from kinematics.gear.helical import HelicalGear
from kinematics.gear.teeth import Gear
from kinematics.gear.train import OrdinaryTrain, TrainStage
from kinematics.gear.worm import WormDrive
from kinematics.message import compose
from service.parts.assembly.descriptions import name_material
from service.parts.assembly.fasteners import MATERIALS
from service.parts.assembly.model import Assembly, Part
from service.parts.assembly.sizes import NotMade, Sizes
from service.parts.gears.housing import Level
from service.parts.gears.motion import TrainMotion
from service.parts.gears.sizing import DEFAULT_FACE_WIDTH, GearSizing
from service.parts.gears.stand import Wheel
from service.parts.gears.upright import FIRST_SHAFT_PLANE, FLOOR_CLEARANCE, Axle, UprightHousing, make_frame
from service.parts.gears.wheels import check_assembly, make_wheel_parts

MAX_FACE_SHARE = 0.67
"""Maximum default face width of a worm gear, in pitch diameters of the worm."""


def make_worm_parts(train: OrdinaryTrain, backlash: float, face_width: float | None, sizing: GearSizing) -> Assembly:
    """Make the parts of a worm and its gear.

    Parameters
    ----------
    train : OrdinaryTrain
        A single-stage train, in millimetres.
    backlash : float
        Minimum backlash of the answer, in its unit.
    face_width : float or None
        Face width of the answer, in its unit.
    sizing : GearSizing

    Raises
    ------
    NotMade
        If the parts do not fit.
    """
    (stage,) = train.stages
    drive = stage.worm(train.pressure_angle)
    sizing.check_size(2.0 * drive.centre_distance)
    core = Gear(stage.quotient, stage.module, train.pressure_angle)
    smallest = min((core, drive.gear), key=lambda gear: gear.root_radius)
    refused = None
    for sizes in sizing.list_sizes(smallest):
        play = 0.5 * max(sizes.clearance - sizing.factor * backlash, 0.0)
        is_width_given = sizing.query.face_width is not None or face_width is not None
        wide = sizing.choose_face_width(stage.module, face_width)
        # Wide worm gears do not touch the worm at their ends.
        if not is_width_given:
            wide = min(DEFAULT_FACE_WIDTH, MAX_FACE_SHARE * stage.quotient) * stage.module
        try:
            return _WormSet(stage, drive, wide, play, sizes, sizing).build_assembly()
        except DimensionError as error:
            raise NotMade(compose("parts-gears-cannot-be-cut", reason=str(error))) from None
        except NotMade as error:
            refused = error
    assert refused is not None
    raise refused


@dataclass(frozen=True)
class _WormSet:
    """A worm below its gear, in millimetres."""

    stage: TrainStage
    drive: WormDrive
    face_width: float
    play: float
    sizes: Sizes
    sizing: GearSizing

    @property
    def hand(self) -> float:
        """1 for a right-handed worm, −1 for a left-handed one."""
        return -1.0 if self.stage.left_handed else 1.0

    def make_gears(self) -> tuple[Gear, Gear]:
        """Return worm and gear in their planes of rotation, with tips and roots of the axial module."""
        lead = self.drive.lead_angle
        normal = self.stage.module * math.cos(lead)
        # Addendum and dedendum are given in axial modules, the gears are in normal modules.
        deeper = 1.0 / math.cos(lead)
        worm, gear = (
            HelicalGear(teeth, normal, helix, self.drive.normal_pressure_angle).transverse_gear
            for teeth, helix in ((self.drive.threads, 0.5 * math.pi - lead), (self.drive.gear_teeth, lead))
        )
        return (
            replace(worm, addendum=deeper * worm.addendum, dedendum=deeper * worm.dedendum),
            replace(gear, addendum=deeper * gear.addendum, dedendum=deeper * gear.dedendum),
        )

    def build_assembly(self) -> Assembly:
        """Build the assembly and check it for interference."""
        worm, gear = self.make_gears()
        sizes, module, distance = self.sizes, self.stage.module, self.drive.centre_distance
        lead, apart, half = self.drive.lead_angle, self.sizes.min_gap, 0.5 * self.sizes.width
        # The thread is as long as the chord of the gear's tip circle at the worm's root.
        length = 2.0 * math.sqrt(gear.tip_radius**2 - (gear.pitch_radius - module) ** 2) + 2.0 * module
        # The worm's bearing plates clear the gear, and the gear's clear the worm.
        beside = max(gear.tip_radius**2 - max(distance - half - apart, 0.0) ** 2, 0.0)
        axles = (
            self._make_axle(
                0, compose("parts-worm-shaft"), length, max(0.5 * length + sizes.gap, math.sqrt(beside) + apart)
            ),
            self._make_axle(
                1,
                compose("parts-output-shaft"),
                self.face_width,
                max(0.5 * self.face_width + sizes.gap, worm.tip_radius + apart),
            ),
        )
        below = max(worm.tip_radius, half, 0.5 * sizes.collar) + apart + FLOOR_CLEARANCE * sizes.pin
        ratio = abs(axles[1].speed)
        wheels = (
            Wheel(
                "worm_1_driver",
                compose("parts-worm", count=self.drive.threads),
                worm,
                0,
                FIRST_SHAFT_PLANE,
                0j,
                0.5 * math.pi,
                worm.tip_radius,
                1.0,
                0,
                self.hand * (0.5 * math.pi - lead),
                play=self.play / math.tan(lead),
            ),
            Wheel(
                "gear_1_driven",
                compose("parts-worm-gear", teeth=self.drive.gear_teeth),
                gear,
                1,
                FIRST_SHAFT_PLANE + 1,
                0j,
                -0.5 * math.pi + math.pi / self.drive.gear_teeth,
                gear.tip_radius,
                ratio,
                1,
                self.hand * lead,
                play=self.play,
            ),
        )
        parts: list[Part] = []
        # Dummy levels for the planes of base and bearings.
        levels = [Level(0.0, 0.0)] * FIRST_SHAFT_PLANE + [axle.levels[axle.wheel] for axle in axles]
        for wheel, axle in zip(wheels, axles, strict=True):
            parts += [
                replace(part, material=self._choose_material(axle))
                for part in make_wheel_parts(wheel, axle.carrier, levels, sizes)
            ]
        parts += UprightHousing(sizes, axles, -below).make_parts()
        size = max(distance + worm.tip_radius + gear.tip_radius, axles[0].levels[-1].high - axles[0].levels[0].low)
        motion = TrainMotion(axles[0].bodies | axles[1].bodies, size)
        assembly = Assembly(
            tuple(parts),
            motion,
            FIRST_SHAFT_PLANE + 1,
            1,
            self.sizing.factor,
            self.sizing.query.scale,
            self._list_notes(worm, gear),
        )
        return check_assembly(assembly, sizes, self.sizing)

    def _make_axle(self, number: int, name: str, wide: float, plate: float) -> Axle:
        """Return a shaft with its wheel midway between two plates whose inner faces are at the distance ``plate``."""
        thick = self.sizes.thickness
        levels = Level(-plate - thick, -plate), Level(-0.5 * wide, 0.5 * wide), Level(plate, plate + thick)
        along = np.array([1.0, 0.0, 0.0]) if number == 0 else np.array([0.0, 1.0, 0.0])
        origin = np.array([0.0, 0.0, number * self.drive.centre_distance])
        speed = 1.0 if number == 0 else self.hand * self.drive.threads / self.drive.gear_teeth
        return Axle(name, number, make_frame(along, origin), levels, 1, speed, stub_below=number == 0)

    def _choose_material(self, axle: Axle) -> str:
        """Return the material: a steel worm and a bronze gear, unless they are printed."""
        if self.sizes.process == "print" or axle.number == 0:
            return name_material(MATERIALS[self.sizes.process][1])
        return name_material("bronze")

    def _list_notes(self, worm: Gear, gear: Gear) -> tuple[str, ...]:
        return (
            compose(
                "parts-worm-left-handed" if self.stage.left_handed else "parts-worm-right-handed",
                distance=f"{self.drive.centre_distance:.6g}",
                lead=f"{math.degrees(self.drive.lead_angle):.4g}",
                worm=f"{2.0 * worm.tip_radius:.6g}",
                gear=f"{2.0 * gear.tip_radius:.6g}",
            ),
            compose("parts-worm-gear-cylindrical"),
            compose("parts-glue-bearing-plates"),
        )
