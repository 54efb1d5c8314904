"""Arrangement of the shafts of a train between two plates, in which no wheel obstructs another shaft.

A shaft reaches from plate to plate if possible, otherwise from one plate to its farthest wheel. Stages are in a
straight line if that can be built, otherwise rotated by the smallest possible angles. The stages of a reverted train go
round a polygon, so that the output returns to the input's axis.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Sequence
from itertools import combinations, product
from typing import NamedTuple

from kinematics.gear.teeth import Gear

ANGLE_STEP = math.radians(15.0)
"""Step of the rotation of a stage relative to the previous one, if a straight line is impossible."""

MAX_TRIED = 4000
"""Maximum number of arrangements that are tried."""

COAXIAL_TOLERANCE = 1e-9
"""Distance of two axes, as a share of the bore, below which the shafts are coaxial."""

Reach = tuple[int, int]


class Wheel(NamedTuple):
    """A gear at its place.

    Attributes
    ----------
    name, described : str
    gear : Gear
        Gear in millimetres, in the plane of rotation.
    shaft : int
        Index of its shaft.
    level : int
    centre : complex
    tooth_at, helix_angle : float
        Radians; the helix angle is positive for a right-handed gear.
    outer : float
        Outer radius, including the rim of a ring.
    speed : float
        Speed relative to the input's.
    tint : int
        Index of its colour.
    web : int or None
        Level of the disc that holds a ring.
    play : float
        Reduction of tooth thickness on the pitch circle, millimetres.
    top : int or None
        Highest level of a gear that extends over several.
    web_described : str
        Description of the disc that holds a ring.
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
    web_described: str = ""

    @property
    def levels(self) -> tuple[int, ...]:
        """Levels that the wheel occupies."""
        return (self.level,) if self.web is None else (self.level, self.web)


class Clearances(NamedTuple):
    """Required clearances: radii of shafts and of parts on them between wheels, and minimum distance of parts."""

    shaft: float
    collar: float
    apart: float


class Arrangement(NamedTuple):
    """The placed wheels, and the axis and the reach of each shaft."""

    wheels: tuple[Wheel, ...]
    axes: tuple[complex, ...]
    reaches: tuple[Reach, ...]


Stage = Callable[[int, complex, complex], Sequence[Wheel]]
"""Returns the wheels of a stage by its index, from the axis of its first shaft in a direction."""


def find_arrangement(stage: Stage, stages: int, highest: int, room: Clearances, polygon: bool) -> Arrangement | None:
    """Find an arrangement without obstruction; return None if none was found.

    Parameters
    ----------
    stage : callable
        Places the wheels of a stage.
    stages : int
        Number of stages.
    highest : int
        Highest level of a wheel.
    room : Clearances
    polygon : bool
        Whether the stages return to the first axis along a polygon.
    """
    if polygon:
        ways = [cmath.exp(2j * math.pi * k / stages) for k in range(stages)]
        wheels = _place_stages(stage, ways)
        reaches = find_reaches(wheels, highest, room)
        return None if reaches is None else Arrangement(tuple(wheels), find_axes(wheels), reaches)
    for ways in _iterate_directions(
        stages, lambda some: find_reaches(_place_stages(stage, some), highest, room) is not None
    ):
        wheels = _place_stages(stage, ways)
        reaches = find_reaches(wheels, highest, room)
        assert reaches is not None
        return Arrangement(tuple(wheels), find_axes(wheels), reaches)
    return None


def _iterate_directions(stages: int, suits: Callable[[list[complex]], bool]) -> Iterator[list[complex]]:
    """Yield directions of all stages, straight ahead first; unsuitable beginnings are not continued."""
    turns = [0.0]
    for k in range(1, round(math.pi / ANGLE_STEP) + 1):
        # Try small deviations from the straight line first.
        turns += [k * ANGLE_STEP, -k * ANGLE_STEP]
    tried = 0

    def extend_directions(ways: list[complex]) -> Iterator[list[complex]]:
        nonlocal tried
        if len(ways) == stages:
            yield ways
            return
        for turn in turns:
            longer = [*ways, ways[-1] * cmath.exp(1j * turn)]
            tried += 1
            if tried > MAX_TRIED:
                return
            if suits(longer):
                yield from extend_directions(longer)

    yield from extend_directions([1.0 + 0.0j])


def _place_stages(stage: Stage, ways: Sequence[complex]) -> list[Wheel]:
    wheels: list[Wheel] = []
    axis = 0j
    for number, ahead in enumerate(ways):
        wheels += stage(number, axis, ahead)
        axis = wheels[-1].centre
    return wheels


def find_axes(wheels: Sequence[Wheel]) -> tuple[complex, ...]:
    """Return the axis of each shaft."""
    found = {wheel.shaft: wheel.centre for wheel in wheels}
    return tuple(found[shaft] for shaft in sorted(found))


def find_reaches(wheels: Sequence[Wheel], highest: int, room: Clearances) -> tuple[Reach, ...] | None:
    """Return the reach of each shaft, from plate to plate if unobstructed; None if a shaft cannot be held."""
    # Overlapping wheels cannot be fixed by shorter shafts.
    if any(_is_obstructed(one, other, room) for one, other in combinations(wheels, 2)):
        return None
    axes = find_axes(wheels)
    choices: list[list[Reach]] = []
    for shaft, axis in enumerate(axes):
        own = [level for wheel in wheels if wheel.shaft == shaft for level in wheel.levels]
        # Both plates, only the lower, or only the upper.
        offered = [(0, highest + 1), (0, max(own)), (min(own), highest + 1)]
        free = [
            reach for reach in offered if all(_is_passing(axis, shaft, own, reach, wheel, room) for wheel in wheels)
        ]
        if not free:
            return None
        choices.append(free)
    near = [
        (one, other)
        for one, other in combinations(range(len(axes)), 2)
        # Close or coaxial shafts must not share levels.
        if abs(axes[one] - axes[other]) < 2.0 * room.collar + room.apart
    ]
    for reaches in product(*choices):
        if all(reaches[one][1] < reaches[other][0] or reaches[other][1] < reaches[one][0] for one, other in near):
            return reaches
    return None


def _is_passing(axis: complex, shaft: int, own: Sequence[int], reach: Reach, wheel: Wheel, room: Clearances) -> bool:
    """Return whether a shaft passes a wheel of another shaft freely."""
    if wheel.shaft == shaft:
        return True
    away = abs(axis - wheel.centre)
    for level in wheel.levels:
        if not reach[0] <= level <= reach[1]:
            continue
        # Next to its own wheel a shaft has no spacer.
        needed = (room.shaft if level in own else room.collar) + room.apart
        # A shaft may pass inside a ring.
        inside = wheel.gear.internal and level == wheel.level and away + needed <= wheel.gear.tip_radius
        if not inside and away < wheel.outer + needed:
            return False
    return True


def _is_obstructed(one: Wheel, other: Wheel, room: Clearances) -> bool:
    """Return whether two wheels of one level overlap, apart from the engagement of teeth in mesh."""
    if one.shaft == other.shaft or not set(one.levels) & set(other.levels):
        return False
    away = abs(one.centre - other.centre)
    if one.level == other.level:
        deep = max(one.gear.whole_depth, other.gear.whole_depth)
        if one.gear.internal != other.gear.internal:
            ring, pinion = (one, other) if one.gear.internal else (other, one)
            # A pinion inside its ring may reach the ring's teeth, not beyond.
            return away + pinion.outer > ring.gear.tip_radius + deep
        return away < one.outer + other.outer + room.apart and abs(away - one.outer - other.outer) > deep
    return away < one.outer + other.outer + room.apart
