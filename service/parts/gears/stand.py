"""Where the shafts of a train stand between two plates, so that no wheel is in the way of another shaft.

A shaft reaches from plate to plate where it can, and otherwise from one plate to its farthest wheel. Stages stand as
they are drawn, one ahead of the other, where that can be built, and otherwise turned by the least angles with which it
can; of a reverted train the stages go round a polygon, so that the output comes back to the input's axis.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Sequence
from itertools import combinations, product
from typing import NamedTuple

from kinematics.gear.teeth import Gear

STEP = math.radians(15.0)
"""By which a stage is turned against the one before, where it cannot stand as it is drawn."""

MOST_TRIED = 4000
"""Stands that are looked at."""

ONE_AXIS = 1e-9
"""Share of a bore below which two shafts have one axis."""

Reach = tuple[int, int]


class Wheel(NamedTuple):
    """A gear at its place.

    Attributes
    ----------
    name, described : str
    gear : Gear
        In millimetres, in the plane of rotation.
    shaft : int
        Number of the shaft that it is on.
    level : int
    centre : complex
    tooth_at, helix_angle : float
        Radians; the helix is positive for a right-handed one.
    outer : float
        Radius of all of it, the rim of a ring included.
    speed : float
        Over the input's.
    tint : int
        Which colour it has.
    web : int or None
        The level of the disc that holds a ring.
    play : float
        By which a tooth is thinner on the pitch circle.
    top : int or None
        The uppermost level of one that goes through several.
    """

    name: str
    described: str
    gear: Gear
    shaft: int
    level: int
    centre: complex
    tooth_at: float
    outer: float
    speed: float
    tint: int
    helix_angle: float = 0.0
    web: int | None = None
    play: float = 0.0
    top: int | None = None

    @property
    def levels(self) -> tuple[int, ...]:
        """Those in which something of it is."""
        return (self.level,) if self.web is None else (self.level, self.web)


class Room(NamedTuple):
    """What must be left: radii of shafts and of what stands on them between wheels, and what parts keep apart."""

    shaft: float
    collar: float
    apart: float


class Stand(NamedTuple):
    """The wheels at their places, and the axis and the reach of each shaft."""

    wheels: tuple[Wheel, ...]
    axes: tuple[complex, ...]
    reaches: tuple[Reach, ...]


Stage = Callable[[int, complex, complex], Sequence[Wheel]]
"""The wheels of a stage by its number, from the axis of its first shaft on in a direction."""


def stood(stage: Stage, stages: int, highest: int, room: Room, polygon: bool) -> Stand | None:
    """A stand in which nothing is in the way; None where none was found.

    Parameters
    ----------
    stage : callable
    stages : int
    highest : int
        The highest level of a wheel.
    room : Room
    polygon : bool
        Whether the stages go round, back to the first axis.
    """
    if polygon:
        ways = [cmath.exp(2j * math.pi * k / stages) for k in range(stages)]
        wheels = _along(stage, ways)
        reaches = reached(wheels, highest, room)
        return None if reaches is None else Stand(tuple(wheels), axes_of(wheels), reaches)
    for ways in _ways(stages, lambda some: reached(_along(stage, some), highest, room) is not None):
        wheels = _along(stage, ways)
        reaches = reached(wheels, highest, room)
        assert reaches is not None
        return Stand(tuple(wheels), axes_of(wheels), reaches)
    return None


def _ways(stages: int, suits: Callable[[list[complex]], bool]) -> Iterator[list[complex]]:
    """Directions of all stages, straight on first; stages that do not suit by themselves are not gone on with."""
    turns = [0.0]
    for k in range(1, round(math.pi / STEP) + 1):
        turns += [k * STEP, -k * STEP]
    tried = 0

    def after(ways: list[complex]) -> Iterator[list[complex]]:
        nonlocal tried
        if len(ways) == stages:
            yield ways
            return
        for turn in turns:
            longer = [*ways, ways[-1] * cmath.exp(1j * turn)]
            tried += 1
            if tried > MOST_TRIED:
                return
            if suits(longer):
                yield from after(longer)

    yield from after([1.0 + 0.0j])


def _along(stage: Stage, ways: Sequence[complex]) -> list[Wheel]:
    wheels: list[Wheel] = []
    axis = 0j
    for number, ahead in enumerate(ways):
        wheels += stage(number, axis, ahead)
        axis = wheels[-1].centre
    return wheels


def axes_of(wheels: Sequence[Wheel]) -> tuple[complex, ...]:
    """The axis of each shaft."""
    found = {wheel.shaft: wheel.centre for wheel in wheels}
    return tuple(found[shaft] for shaft in sorted(found))


def reached(wheels: Sequence[Wheel], highest: int, room: Room) -> tuple[Reach, ...] | None:
    """From where to where each shaft goes, from plate to plate where that is free; None where some cannot be held."""
    if any(_in_the_way(one, other, room) for one, other in combinations(wheels, 2)):
        return None
    axes = axes_of(wheels)
    choices: list[list[Reach]] = []
    for shaft, axis in enumerate(axes):
        own = [level for wheel in wheels if wheel.shaft == shaft for level in wheel.levels]
        offered = [(0, highest + 1), (0, max(own)), (min(own), highest + 1)]
        free = [reach for reach in offered if all(_passes(axis, shaft, own, reach, wheel, room) for wheel in wheels)]
        if not free:
            return None
        choices.append(free)
    near = [
        (one, other)
        for one, other in combinations(range(len(axes)), 2)
        if abs(axes[one] - axes[other]) < 2.0 * room.collar + room.apart
    ]
    for reaches in product(*choices):
        if all(reaches[one][1] < reaches[other][0] or reaches[other][1] < reaches[one][0] for one, other in near):
            return reaches
    return None


def _passes(axis: complex, shaft: int, own: Sequence[int], reach: Reach, wheel: Wheel, room: Room) -> bool:
    """Whether a shaft goes by a wheel of another."""
    if wheel.shaft == shaft:
        return True
    away = abs(axis - wheel.centre)
    for level in wheel.levels:
        if not reach[0] <= level <= reach[1]:
            continue
        needed = (room.shaft if level in own else room.collar) + room.apart
        inside = wheel.gear.internal and level == wheel.level and away + needed <= wheel.gear.tip_radius
        if not inside and away < wheel.outer + needed:
            return False
    return True


def _in_the_way(one: Wheel, other: Wheel, room: Room) -> bool:
    """Whether two wheels of one level stand in one another, beyond what teeth in mesh do."""
    if one.shaft == other.shaft or not set(one.levels) & set(other.levels):
        return False
    away = abs(one.centre - other.centre)
    if one.level == other.level:
        deep = max(one.gear.whole_depth, other.gear.whole_depth)
        if one.gear.internal != other.gear.internal:
            ring, pinion = (one, other) if one.gear.internal else (other, one)
            return away + pinion.outer > ring.gear.tip_radius + deep
        return away < one.outer + other.outer + room.apart and abs(away - one.outer - other.outer) > deep
    return away < one.outer + other.outer + room.apart
