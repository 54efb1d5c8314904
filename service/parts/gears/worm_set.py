"""Parts of a worm with its gear: a train of one stage whose shafts cross.

The worm is the involute helicoid that is a helical gear of so many threads, and its gear the helical gear of the same
hand that meshes with it at a right angle: both have the rack of the same normal plane, so that they touch in a point
and turn at the true ratio (F. L. Litvin & A. Fuentes, Gear Geometry and Applied Theory, 2004, ch. 16).
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
from service.parts.fasteners import MATERIALS
from service.parts.gears.housing import Level
from service.parts.gears.motion import TrainMotion
from service.parts.gears.sizing import FACE, GearSizing
from service.parts.gears.stand import Wheel
from service.parts.gears.upright import FIRST, FREE, Axle, Upright, frame_along
from service.parts.gears.wheels import looked_at, wheel_parts
from service.parts.model import Assembly, Part
from service.parts.sizes import NotMade, Sizes

NARROW = 0.67
"""Greatest face width of a worm gear that is not stated, in pitch diameters of the worm."""


def worm_parts(train: OrdinaryTrain, backlash: float, face_width: float | None, sizing: GearSizing) -> Assembly:
    """The parts of a worm and its gear.

    Parameters
    ----------
    train : OrdinaryTrain
        Of one stage, in millimetres.
    backlash : float
        The least of the answer, in its own unit.
    face_width : float or None
        That of the answer, in its own unit.
    sizing : GearSizing

    Raises
    ------
    NotMade
        Where there is no room.
    """
    (stage,) = train.stages
    drive = stage.worm(train.pressure_angle)
    sizing.judge_size(2.0 * drive.centre_distance)
    core = Gear(stage.quotient, stage.module, train.pressure_angle)
    smallest = min((core, drive.gear), key=lambda gear: gear.root_radius)
    refused = None
    for sizes in sizing.offered(smallest):
        play = 0.5 * max(sizes.clearance - sizing.factor * backlash, 0.0)
        stated = sizing.query.face_width is not None or face_width is not None
        wide = sizing.face_width(stage.module, face_width)
        if not stated:
            wide = min(FACE, NARROW * stage.quotient) * stage.module
        try:
            return _WormSet(stage, drive, wide, play, sizes, sizing).made()
        except DimensionError as error:
            raise NotMade(f"The gears cannot be cut: {error}.") from None
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
        """1 of a right-handed worm, −1 of a left-handed one."""
        return -1.0 if self.stage.left_handed else 1.0

    def gears(self) -> tuple[Gear, Gear]:
        """Worm and gear in their planes of rotation, tips and roots those of the axial module."""
        lead = self.drive.lead_angle
        normal = self.stage.module * math.cos(lead)
        deeper = 1.0 / math.cos(lead)
        worm, gear = (
            HelicalGear(teeth, normal, helix, self.drive.normal_pressure_angle).transverse_gear
            for teeth, helix in ((self.drive.threads, 0.5 * math.pi - lead), (self.drive.gear_teeth, lead))
        )
        return (
            replace(worm, addendum=deeper * worm.addendum, dedendum=deeper * worm.dedendum),
            replace(gear, addendum=deeper * gear.addendum, dedendum=deeper * gear.dedendum),
        )

    def made(self) -> Assembly:
        """The assembly, if no two parts of it meet."""
        worm, gear = self.gears()
        sizes, module, distance = self.sizes, self.stage.module, self.drive.centre_distance
        lead, apart, half = self.drive.lead_angle, self.sizes.apart, 0.5 * self.sizes.width
        # The thread reaches as far as the tips of the gear are over its roots.
        length = 2.0 * math.sqrt(gear.tip_radius**2 - (gear.pitch_radius - module) ** 2) + 2.0 * module
        # Bearing plates of the worm stand clear of the gear, those of the gear of the worm.
        beside = max(gear.tip_radius**2 - max(distance - half - apart, 0.0) ** 2, 0.0)
        axles = (
            self._axle(0, "worm shaft", length, max(0.5 * length + sizes.gap, math.sqrt(beside) + apart)),
            self._axle(1, "output shaft", self.face_width,
                       max(0.5 * self.face_width + sizes.gap, worm.tip_radius + apart)),
        )  # fmt: skip
        below = max(worm.tip_radius, half, 0.5 * sizes.collar) + apart + FREE * sizes.pin
        ratio = abs(axles[1].speed)
        wheels = (
            Wheel("worm_1_driver", f"worm, {self.drive.threads} threads", worm, 0, FIRST, 0j, 0.5 * math.pi,
                  worm.tip_radius, 1.0, 0, self.hand * (0.5 * math.pi - lead), play=self.play / math.tan(lead)),
            Wheel("gear_1_driven", f"worm gear, {self.drive.gear_teeth} teeth", gear, 1, FIRST + 1, 0j,
                  -0.5 * math.pi + math.pi / self.drive.gear_teeth, gear.tip_radius, ratio, 1, self.hand * lead,
                  play=self.play),
        )  # fmt: skip
        parts: list[Part] = []
        levels = [Level(0.0, 0.0)] * FIRST + [axle.levels[axle.wheel] for axle in axles]
        for wheel, axle in zip(wheels, axles, strict=True):
            parts += [
                replace(part, material=self._material(axle)) for part in wheel_parts(wheel, axle.carrier, levels, sizes)
            ]
        parts += Upright(sizes, axles, -below).parts()
        size = max(distance + worm.tip_radius + gear.tip_radius, axles[0].levels[-1].high - axles[0].levels[0].low)
        motion = TrainMotion(axles[0].bodies | axles[1].bodies, size)
        assembly = Assembly(
            tuple(parts), motion, FIRST + 1, 1, self.sizing.factor, self.sizing.query.scale, self._notes(worm, gear)
        )
        return looked_at(assembly, sizes, self.sizing)

    def _axle(self, number: int, name: str, wide: float, plate: float) -> Axle:
        """A shaft with its wheel in the middle between two plates, the inner faces of these so far from there."""
        thick = self.sizes.thickness
        levels = Level(-plate - thick, -plate), Level(-0.5 * wide, 0.5 * wide), Level(plate, plate + thick)
        along = np.array([1.0, 0.0, 0.0]) if number == 0 else np.array([0.0, 1.0, 0.0])
        origin = np.array([0.0, 0.0, number * self.drive.centre_distance])
        speed = 1.0 if number == 0 else self.hand * self.drive.threads / self.drive.gear_teeth
        return Axle(name, number, frame_along(along, origin), levels, 1, speed, stub_below=number == 0)

    def _material(self, axle: Axle) -> str:
        """A steel worm in a bronze gear, where they are not printed."""
        if self.sizes.process == "print" or axle.number == 0:
            return MATERIALS[self.sizes.process][1]
        return "bronze"

    def _notes(self, worm: Gear, gear: Gear) -> tuple[str, ...]:
        return (
            f"Centre distance of the crossing shafts {self.drive.centre_distance:.6g} mm; lead angle "
            f"{math.degrees(self.drive.lead_angle):.4g}°, {'left' if self.stage.left_handed else 'right'}-handed; "
            f"outside diameters {2.0 * worm.tip_radius:.6g} and {2.0 * gear.tip_radius:.6g} mm.",
            "The gear is cylindrical, with helical teeth that touch the thread in a point: it turns truly, and carries "
            "less than a gear that is hobbed to the worm.",
            "Bearing plates stand by their tabs in the slots of the base, and are glued or wedged there.",
        )
