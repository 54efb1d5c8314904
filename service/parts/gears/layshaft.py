"""Parts of a layshaft gearbox: all pairs in mesh, the first gear keyed to the main shaft, the others free on it.

Input and main shaft are coaxial, one in the lower plate and one in the upper; the layshaft and the axle of the reverse
idler are next to them. The mechanism that engages the gears is not included.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from kinematics.errors import DimensionError
from kinematics.message import compose
from service.parts.assembly.model import Assembly, Carrier, Part
from service.parts.assembly.sizes import NotMade, PartsQuery, Sizes
from service.parts.gears.housing import Housing, Level, Shaft, stack_levels
from service.parts.gears.motion import BodyRotation, TrainMotion
from service.parts.gears.ordinary import MAX_TURNS
from service.parts.gears.sizing import GearSizing
from service.parts.gears.stand import Clearances, Reach, Wheel, find_axes, find_reaches
from service.parts.gears.wheels import check_assembly, make_wheel_parts
from service.render.gears.gearbox_layout import BoxGear, arrange_layshaft
from synthesis.kinds.layshaft_gearbox.design import LayshaftDesign
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem

INPUT_SHAFT, LAYSHAFT_SHAFT, MAIN_SHAFT = 0, 1, 2
SHAFT_MESSAGES = ("parts-input-shaft", "parts-layshaft", "parts-main-shaft", "parts-axle-of-idler")
GEAR_MESSAGES = (
    "parts-gear-on-input-shaft",
    "parts-gear-on-layshaft",
    "parts-gear-on-main-shaft",
    "parts-gear-on-idler-axle",
)
"""Messages that describe a shaft, and a gear on it, by its index."""

KEYED_PAIR = "GEAR_1"
"""The pair whose gear is keyed to the main shaft."""


def make_layshaft_parts(design: LayshaftDesign, problem: LayshaftProblem, query: PartsQuery) -> Assembly:
    """Make the parts of a layshaft gearbox.

    Parameters
    ----------
    design : LayshaftDesign
    problem : LayshaftProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        If the first gear is direct drive, or the shafts do not fit.
    """
    sizing = GearSizing(query, problem.length_unit)
    mechanism = design.mechanism.model_copy(
        update={
            "module": design.mechanism.module * sizing.factor,
            "centre_distance": design.mechanism.centre_distance * sizing.factor,
        }
    )
    if mechanism.gears[0].layshaft is None:
        raise NotMade(compose("parts-first-gear-direct"))
    gears = arrange_layshaft(mechanism).gears
    sizing.check_size(4.0 * mechanism.centre_distance)
    smallest = min((gear.gear for gear in gears), key=lambda gear: gear.root_radius)
    for sizes in sizing.list_sizes(smallest):
        task = _LayshaftTask(gears, sizes, sizing)
        reaches = task.find_reaches()
        if reaches is not None:
            try:
                return task.build_assembly(reaches)
            except DimensionError as error:
                raise NotMade(compose("parts-gears-cannot-be-cut", reason=str(error))) from None
    raise NotMade(
        compose("parts-shafts-obstructed"), sizing.path,
    )  # fmt: skip


@dataclass(frozen=True)
class _LayshaftTask:
    gears: list[BoxGear]
    sizes: Sizes
    sizing: GearSizing

    @cached_property
    def speeds(self) -> list[float]:
        """Speed of each gear relative to the input's, from mesh to mesh."""
        found: list[float] = []
        layshaft = 1.0
        for gear, before in zip(self.gears, [None, *self.gears[:-1]], strict=True):
            if gear.shaft == INPUT_SHAFT:
                speed = 1.0
            elif before is None or before.pair != gear.pair:
                speed = layshaft
            else:
                # Consecutive gears of a pair mesh externally.
                speed = -found[-1] * before.gear.teeth / gear.gear.teeth
            # All further pairs start at the layshaft's speed.
            if gear.pair == "HEAD" and gear.shaft == LAYSHAFT_SHAFT:
                layshaft = speed
            found.append(speed)
        return found

    @cached_property
    def wheels(self) -> list[Wheel]:
        """All gears, with one level per pair."""
        wheels = []
        for number, (gear, speed) in enumerate(zip(self.gears, self.speeds, strict=True)):
            pair = gear.pair.lower()
            role = ("input", "layshaft", "main", "idler")[gear.shaft]
            words = compose(GEAR_MESSAGES[gear.shaft], pair=_describe_pair(pair), teeth=f"{gear.gear.teeth:g}")
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
        """Level of the uppermost pair."""
        return max(wheel.level for wheel in self.wheels)

    def find_reaches(self) -> tuple[Reach, ...] | None:
        """Return the reach of the shafts, or None if one is obstructed."""
        room = Clearances(0.5 * self.sizes.pin, 0.5 * self.sizes.collar, self.sizes.min_gap)
        return find_reaches(self.wheels, self.highest, room)

    def _is_free(self, gear: BoxGear) -> bool:
        """Return whether a gear rotates freely on the main shaft."""
        return gear.shaft == MAIN_SHAFT and gear.pair != KEYED_PAIR

    def _name_carrier(self, gear: BoxGear) -> str:
        return f"main_{gear.pair.lower()}" if self._is_free(gear) else f"shaft_{gear.shaft + 1}"

    def build_assembly(self, reaches: tuple[Reach, ...]) -> Assembly:
        """Build the assembly and check it for interference."""
        levels = self._make_levels()
        shafts = []
        for number, axis in enumerate(find_axes(self.wheels)):
            own = [gear for gear in self.gears if gear.shaft == number]
            shafts.append(
                Shaft(
                    compose(SHAFT_MESSAGES[number]), Carrier(f"shaft_{number + 1}", None), axis, reaches[number],
                    tuple(gear.slot + 1 for gear in own if not self._is_free(gear)),
                    tuple(gear.slot + 1 for gear in own if self._is_free(gear)),
                    ends=number in (INPUT_SHAFT, MAIN_SHAFT),
                )
            )  # fmt: skip
        around = tuple((wheel.centre, wheel.outer) for wheel in self.wheels)
        housing = Housing(self.sizes, levels, tuple(shafts), around)
        parts: list[Part] = []
        bodies: dict[str, BodyRotation] = {}
        for gear, wheel in zip(self.gears, self.wheels, strict=True):
            carrier = self._name_carrier(gear)
            bodies[carrier] = BodyRotation(wheel.centre, wheel.speed)
            parts += make_wheel_parts(wheel, Carrier(carrier, None), levels, self.sizes, free=self._is_free(gear))
        # Turn the input until the slowest mesh has advanced by a tooth.
        slowest = min(abs(wheel.speed) * wheel.gear.teeth for wheel in self.wheels)
        size = max(abs(a.centre - b.centre) + a.outer + b.outer for a in self.wheels for b in self.wheels)
        motion = TrainMotion(bodies, size, min(math.ceil(1.0 / slowest), MAX_TURNS))
        assembly = Assembly(
            (*parts, *housing.make_parts()), motion, self.highest, 2, self.sizing.factor, self.sizing.query.scale,
            (compose("parts-first-gear-engaged"),
             compose("parts-gearshift-not-included")),
        )  # fmt: skip
        return check_assembly(assembly, self.sizes, self.sizing)

    def _make_levels(self) -> tuple[Level, ...]:
        face = self.sizing.choose_face_width(self.gears[0].gear.module, None)
        return stack_levels([self.sizes.thickness, *[face] * self.highest, self.sizes.thickness], self.sizes)


def _describe_pair(pair: str) -> str:
    """Return the description of a pair by its name: head, reverse, or a gear with its number."""
    if pair == "head":
        return compose("parts-head-pair")
    if pair == "reverse":
        return compose("parts-reverse-pair")
    return compose("parts-gear-pair", number=pair.removeprefix("gear_"))
