"""Parts of a layshaft gearbox: all pairs in mesh, the first gear keyed to the main shaft, the others free on it.

Input and main shaft are coaxial, one in the lower plate and one in the upper; the layshaft and the axle
of the reverse idler stand beside. What engages one gear or another is not made.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from kinematics.errors import DimensionError
from service.parts.gears.housing import Housing, Level, Shaft, stacked
from service.parts.gears.motion import TrainMotion, Turning
from service.parts.gears.ordinary import MOST_TURNS
from service.parts.gears.sizing import GearSizing
from service.parts.gears.stand import Reach, Room, Wheel, axes_of, reached
from service.parts.gears.wheels import looked_at, wheel_parts
from service.parts.model import Assembly, Carrier, Part
from service.parts.sizes import NotMade, PartsQuery, Sizes
from service.render.gears.gearbox_layout import BoxGear, layshaft_layout

INPUT, LAYSHAFT, MAIN = 0, 1, 2
SHAFTS = ("input shaft", "layshaft", "main shaft", "axle of the idler")
ENGAGED = "GEAR_1"
"""The pair whose gear is keyed to the main shaft."""


def layshaft_parts(design: Any, problem: Any, query: PartsQuery) -> Assembly:
    """The parts of a layshaft gearbox.

    Parameters
    ----------
    design : LayshaftDesign
    problem : LayshaftProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        Where its first gear is direct drive, or there is no room for such shafts.
    """
    sizing = GearSizing(query, problem.length_unit)
    mechanism = design.mechanism.model_copy(
        update={
            "module": design.mechanism.module * sizing.factor,
            "centre_distance": design.mechanism.centre_distance * sizing.factor,
        }
    )
    if mechanism.gears[0].layshaft is None:
        raise NotMade("Parts are made with the first gear engaged, and that of this box is direct drive.")
    gears = layshaft_layout(mechanism).gears
    sizing.judge_size(4.0 * mechanism.centre_distance)
    smallest = min((gear.gear for gear in gears), key=lambda gear: gear.root_radius)
    for sizes in sizing.offered(smallest):
        task = _Task(gears, sizes, sizing)
        reaches = task.reaches()
        if reaches is not None:
            try:
                return task.made(reaches)
            except DimensionError as error:
                raise NotMade(f"The gears cannot be cut: {error}.") from None
    raise NotMade(
        "There is no room for the shafts: one of them, or what is on it, would pass through a gear. Thinner ones may "
        "do, or another scale.", sizing.path,
    )  # fmt: skip


@dataclass(frozen=True)
class _Task:
    gears: list[BoxGear]
    sizes: Sizes
    sizing: GearSizing

    @cached_property
    def speeds(self) -> list[float]:
        """Of each gear over the input's, from mesh to mesh."""
        found: list[float] = []
        layshaft = 1.0
        for gear, before in zip(self.gears, [None, *self.gears[:-1]], strict=True):
            if gear.shaft == INPUT:
                speed = 1.0
            elif before is None or before.pair != gear.pair:
                speed = layshaft
            else:
                speed = -found[-1] * before.gear.teeth / gear.gear.teeth
            if gear.pair == "HEAD" and gear.shaft == LAYSHAFT:
                layshaft = speed
            found.append(speed)
        return found

    @cached_property
    def wheels(self) -> list[Wheel]:
        """All gears, a level for each pair."""
        wheels = []
        for number, (gear, speed) in enumerate(zip(self.gears, self.speeds, strict=True)):
            pair = gear.pair.lower()
            role = ("input", "layshaft", "main", "idler")[gear.shaft]
            words = f"{pair.replace('_', ' ')}, {role}, {gear.gear.teeth:g} teeth"
            wheels.append(
                Wheel(
                    f"gear_{pair.removeprefix('gear_')}_{role}", words, gear.gear, gear.shaft, gear.slot + 1,
                    gear.centre, gear.tooth_at, gear.gear.tip_radius, speed, number,
                    play=0.5 * self.sizes.clearance,
                )
            )  # fmt: skip
        return wheels

    @property
    def highest(self) -> int:
        """The uppermost pair's level."""
        return max(wheel.level for wheel in self.wheels)

    def reaches(self) -> tuple[Reach, ...] | None:
        """How far the shafts go, if nothing is in their way."""
        room = Room(0.5 * self.sizes.pin, 0.5 * self.sizes.collar, self.sizes.apart)
        return reached(self.wheels, self.highest, room)

    def _free(self, gear: BoxGear) -> bool:
        """Whether a gear turns on the main shaft, and not with it."""
        return gear.shaft == MAIN and gear.pair != ENGAGED

    def _carrier(self, gear: BoxGear) -> str:
        return f"main_{gear.pair.lower()}" if self._free(gear) else f"shaft_{gear.shaft + 1}"

    def made(self, reaches: tuple[Reach, ...]) -> Assembly:
        """The assembly, if no two parts of it meet."""
        levels = self._levels()
        shafts = []
        for number, axis in enumerate(axes_of(self.wheels)):
            own = [gear for gear in self.gears if gear.shaft == number]
            shafts.append(
                Shaft(
                    SHAFTS[number], Carrier(f"shaft_{number + 1}", None), axis, reaches[number],
                    tuple(gear.slot + 1 for gear in own if not self._free(gear)),
                    tuple(gear.slot + 1 for gear in own if self._free(gear)), ends=number in (INPUT, MAIN),
                )
            )  # fmt: skip
        around = tuple((wheel.centre, wheel.outer) for wheel in self.wheels)
        housing = Housing(self.sizes, levels, tuple(shafts), around)
        parts: list[Part] = []
        bodies: dict[str, Turning] = {}
        for gear, wheel in zip(self.gears, self.wheels, strict=True):
            carrier = self._carrier(gear)
            bodies[carrier] = Turning(wheel.centre, wheel.speed)
            parts += wheel_parts(wheel, Carrier(carrier, None), levels, self.sizes, free=self._free(gear))
        slowest = min(abs(wheel.speed) * wheel.gear.teeth for wheel in self.wheels)
        size = max(abs(a.centre - b.centre) + a.outer + b.outer for a in self.wheels for b in self.wheels)
        motion = TrainMotion(bodies, size, min(math.ceil(1.0 / slowest), MOST_TURNS))
        assembly = Assembly(
            (*parts, *housing.parts()), motion, self.highest, 2, self.sizing.factor, self.sizing.query.scale,
            ("The first gear is engaged: it is keyed to the main shaft, on which the others turn freely.",
             "What engages another gear, or couples input and main shaft for direct drive, is not among the parts."),
        )  # fmt: skip
        return looked_at(assembly, self.sizes, self.sizing)

    def _levels(self) -> tuple[Level, ...]:
        face = self.sizing.face_width(self.gears[0].gear.module, None)
        return stacked([self.sizes.thickness, *[face] * self.highest, self.sizes.thickness], self.sizes)
