"""Parts of planetary trains with one carrier: suns on shafts, planets on pins, rings on webs or on the posts."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from kinematics.errors import DimensionError
from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from kinematics.linkage.planar.mechanism import GROUND
from service.parts.bodies import Prism
from service.parts.colours import LINK_COLOURS
from service.parts.fasteners import MATERIALS
from service.parts.gears.housing import Housing, Level, Shaft, stacked
from service.parts.gears.keys import key_for, keyed_bore
from service.parts.gears.motion import TrainMotion, Turning
from service.parts.gears.planetary_build import Build, build_of
from service.parts.gears.sizing import GearSizing
from service.parts.gears.stand import Wheel
from service.parts.gears.teeth import toothed
from service.parts.gears.wheels import ROOM, looked_at, rim_radius, wheel_parts
from service.parts.model import Assembly, Carrier, Part, plain
from service.parts.shapes import Disc, Outline, Region, widened
from service.parts.sizes import WALL, NotMade, PartsQuery, Sizes
from service.render.gears.planetary_layout import PlanetaryGear, placed_planetary_gears

POSTS = 4
"""Number of posts of a train whose ring is held by them."""


def planetary_parts(design: Any, problem: Any, query: PartsQuery) -> Assembly:
    """Make the parts of a planetary train.

    Parameters
    ----------
    design : PlanetaryDesign
    problem : PlanetaryProblem
    query : PartsQuery
        Lengths in the unit of the problem.

    Raises
    ------
    NotMade
        The train has bevel gears or several carriers, cannot be built between two plates, or does not fit.
    """
    mechanism = design.mechanism
    arrangement = ARRANGEMENTS[mechanism.arrangement]
    # Only one carrier fits between the two central shafts.
    if arrangement.bevel or len(set(arrangement.carriers.values())) > 1:
        raise NotMade("Parts are only available for planetary trains of spur gears with one carrier.")
    build = build_of(arrangement, (mechanism.input, mechanism.output, mechanism.fixed))
    if build is None:
        raise NotMade("The input and the output of this train cannot both be reached from two plates.")
    sizing = GearSizing(query, problem.length_unit)
    module = mechanism.module * sizing.factor
    sizing.judge_size(design.metrics.size * sizing.factor)
    gears = placed_planetary_gears(mechanism.model_copy(update={"module": module}))
    smallest = min((one.gear for one in gears if not one.gear.internal), key=lambda gear: gear.root_radius)
    refused = None
    for sizes in sizing.offered(smallest, *_least_room(gears, arrangement, build)):
        try:
            return _Task(mechanism, arrangement, design.metrics.speeds, build, gears, sizes, sizing).made()
        except DimensionError as error:
            raise NotMade(f"The gears cannot be cut: {error}.") from None
        except NotMade as error:
            if error.path == "/query/clearance":  # teeth collide on any shafts
                raise
            refused = error
    assert refused is not None
    raise refused


def _least_room(gears: Sequence[PlanetaryGear], arrangement: Arrangement, build: Build) -> tuple[float, str]:
    """Return the minimum distance from a planet's axis to a gear that its axle passes, and their names; infinity if
    none.
    """
    near = [(math.inf, "")]
    plate = 0 if build.carrier is None else build.carrier
    for planet in (gear for gear in gears if gear.body in arrangement.carriers):
        own = [build.planes[plane] for gear in arrangement.gears if gear.body == planet.body for plane in gear.planes]
        low, high = min(plate, *own), max(plate, *own)
        for other in gears:
            levels = {build.planes[plane] for plane in other.planes}
            if (
                other.body == planet.body
                or other.gear.internal
                or all(not low <= level <= high or level in own for level in levels)
            ):
                continue
            away = abs(planet.centre - other.centre) - other.gear.tip_radius
            words = f"axle of the {planet.name.replace('_', ' ')} passes the {other.name.replace('_', ' ')}"
            # Radial space between the axle and the gear that it passes.
            near.append((away, words))
    return min(near)


@dataclass(frozen=True)
class _Task:
    """A train in millimetres, its build, and the sizes of its shafts and plates."""

    mechanism: Any
    arrangement: Arrangement
    speeds: dict[str, float]
    build: Build
    gears: Sequence[PlanetaryGear]
    sizes: Sizes
    sizing: GearSizing

    @property
    def carrier(self) -> str:
        """Name of the carrier."""
        return next(iter(self.arrangement.carriers.values()))

    @cached_property
    def levels(self) -> tuple[Level, ...]:
        """Levels of plates, webs and gears."""
        heights = [self.sizes.thickness] * (self.build.highest + 2)
        widths = self.mechanism.face_widths or [None] * len(self.build.planes)
        for plane, level in self.build.planes.items():
            heights[level] = self.sizing.face_width(self.mechanism.module * self.sizing.factor, widths[plane - 1])
        return stacked(heights, self.sizes)

    def body(self, gear: PlanetaryGear) -> str:
        """Return the body of a gear, as the motion names it."""
        if gear.body == self.mechanism.fixed:
            return GROUND
        return f"{gear.body}_{gear.copy + 1}" if gear.body in self.arrangement.carriers else gear.body

    def carried(self, member: str) -> Carrier:
        """Return the carrier of a member that rotates about the axis."""
        return Carrier(GROUND if member == self.mechanism.fixed else member, None)

    def made(self) -> Assembly:
        """Build the assembly and check it for interference."""
        wheels = [self._wheel(gear, number) for number, gear in enumerate(self.gears)]
        posts = self._posts(wheels)
        around = [(gear.centre, wheel.outer) for gear, wheel in zip(self.gears, wheels, strict=True)]
        # The carrier's plate sweeps a circle beyond its pins.
        around += [(0j, abs(pin) + 0.5 * self.sizes.width) for pin in self._pins().values()]
        # Rings without a web are fixed to the posts.
        standing = tuple(wheel.level for wheel in wheels if wheel.gear.internal and wheel.web is None)
        housing = Housing(self.sizes, self.levels, tuple(self._shafts()), tuple(around), posts, standing)
        parts: list[Part] = []
        for gear, wheel in zip(self.gears, wheels, strict=True):
            parts += self._cut(gear, wheel, posts)
        if self.build.carrier is not None:
            parts.append(self._carrier_plate(self.build.carrier))
        parts += housing.parts()
        parts = [self._alike(part) for part in parts]
        assembly = Assembly(
            tuple(parts), self._motion(wheels), self.build.highest, 2, self.sizing.factor, self.sizing.query.scale,
            self._notes(),
        )  # fmt: skip
        return looked_at(assembly, self.sizes, self.sizing)

    # Wheels

    def _wheel(self, gear: PlanetaryGear, tint: int) -> Wheel:
        levels = sorted(self.build.planes[plane] for plane in gear.planes)
        planet = gear.body in self.arrangement.carriers
        name = f"{plain(gear.name)}_{gear.copy + 1}" if planet else plain(gear.name)
        outer = rim_radius(gear.gear, self.sizes) if gear.gear.internal else gear.gear.tip_radius
        names = list(self.mechanism.teeth)
        return Wheel(
            f"gear_{name}", f"{name.replace('_', ' ')}, {gear.gear.teeth:g} teeth", gear.gear, tint, levels[0],
            gear.centre, gear.tooth_at, outer, self.speeds[gear.body], names.index(gear.name),
            web=self.build.webs.get(gear.body) if gear.gear.internal else None, play=0.5 * self.sizes.clearance,
            top=levels[-1],
        )  # fmt: skip

    def _cut(self, gear: PlanetaryGear, wheel: Wheel, posts: Sequence[complex]) -> list[Part]:
        if gear.gear.internal and wheel.web is None:
            return [self._held_ring(wheel, posts)]
        planet = gear.body in self.arrangement.carriers
        free = not self._stepped(gear.body) if planet else self.build.access[gear.body] == "loose"
        return wheel_parts(
            wheel, Carrier(self.body(gear), None), self.levels, self.sizes, free=free,
            towards=self._towards(gear) if planet else 1.0 + 0.0j, like=gear.name if planet else "",
        )  # fmt: skip

    def _held_ring(self, wheel: Wheel, posts: Sequence[complex]) -> Part:
        """Make a ring that is held by the posts."""
        outer = Disc(0j, abs(posts[0]) + 0.5 * self.sizes.hole + ROOM * WALL * self.sizes.pin)
        teeth = toothed(wheel.gear, wheel.centre, wheel.tooth_at, 0.0, wheel.play)
        holes = [Disc(post, 0.5 * self.sizes.hole) for post in posts]
        level = self.levels[wheel.level]
        return Part(
            wheel.name, wheel.described, "gear", Carrier(GROUND, None),
            (Prism(Region(outer, (teeth, *holes)), level.low, level.high),), 1.0 + 0.0j,
            (wheel.level, wheel.level), MATERIALS[self.sizes.process][0], LINK_COLOURS[wheel.tint % len(LINK_COLOURS)],
        )  # fmt: skip

    def _stepped(self, planet: str) -> bool:
        """Return whether a planet has several gears, which are keyed to one pin."""
        return sum(gear.body == planet for gear in self.arrangement.gears) > 1

    def _towards(self, gear: PlanetaryGear) -> complex:
        """Return the direction of a planet's keyways: copies are rotated like their gears."""
        first = next(one for one in self.gears if one.name == gear.name and one.copy == 0)
        return cmath.exp(1j * (gear.tooth_at - first.tooth_at))

    # Carriers and shafts

    def _pins(self) -> dict[str, complex]:
        """Return the centres of planets and their copies by body name."""
        return {self.body(gear): gear.centre for gear in self.gears if gear.body in self.arrangement.carriers}

    def _posts(self, wheels: Sequence[Wheel]) -> tuple[complex, ...]:
        """Return the posts that hold a ring, outside all rotating parts."""
        held = [wheel for wheel in wheels if wheel.gear.internal and wheel.web is None]
        if not held:
            return ()
        room = ROOM * WALL * self.sizes.pin + 0.5 * self.sizes.hole
        away = max(wheel.gear.root_radius for wheel in held) + room
        moving = [abs(wheel.centre) + wheel.outer for wheel in wheels if wheel not in held]
        moving += [abs(pin) + 0.5 * self.sizes.width for pin in self._pins().values()]
        # Posts stay outside everything that rotates.
        away = max(away, max(moving) + 0.5 * self.sizes.collar + self.sizes.apart)
        return tuple(cmath.rect(away, math.pi * (k + 0.5) / (0.5 * POSTS)) for k in range(POSTS))

    def _shafts(self) -> list[Shaft]:
        build, top = self.build, self.build.highest + 1
        found = []
        hubs = {gear.body: build.webs.get(gear.body, build.planes[gear.planes[0]]) for gear in self.gears
                if gear.body not in self.arrangement.carriers}  # fmt: skip
        if build.carrier is not None:
            hubs[self.carrier] = build.carrier
        for side, reach in (("low", (0, build.low)), ("high", (build.high, top))):
            if None in reach:
                continue
            low, high = reach
            assert low is not None
            assert high is not None
            body = next(body for body, access in build.access.items() if access == side)
            # Members without a shaft run freely on this one.
            loose = [level for one, level in hubs.items() if build.access[one] == "loose" and low <= level <= high]
            held = body == self.mechanism.fixed
            plate = 0 if side == "low" else top
            found.append(
                Shaft(
                    f"shaft of the {body.replace('_', ' ')}", self.carried(body), 0j, (low, high),
                    (hubs[body], plate) if held else (hubs[body],), tuple(loose),
                    ends=body in (self.mechanism.input, self.mechanism.output),
                )
            )  # fmt: skip
        for name, centre in self._pins().items():
            found.append(self._pin(name, centre))
        return found

    def _pin(self, name: str, centre: complex) -> Shaft:
        """Make the pin of a planet: it is held by the carrier, and rotates with a stepped planet."""
        own = [gear for gear in self.gears if self.body(gear) == name]
        plate = 0 if self.build.carrier is None else self.build.carrier
        levels = sorted({self.build.planes[plane] for gear in own for plane in gear.planes})
        reach = min(plate, *levels), max(plate, *levels)
        words = f"planet {name.replace('planet', '').strip('_').replace('_', ' ')}".strip()
        if self._stepped(own[0].body):
            keyed = tuple(self.build.planes[gear.planes[0]] for gear in own)
            return Shaft(f"axle of {words}", Carrier(name, None), centre, reach, keyed, (plate,),
                         towards=self._towards(own[0]))  # fmt: skip
        carrier = Carrier(self.carried(self.carrier).link, None)
        return Shaft(f"axle of {words}", carrier, centre, reach, (), (plate, *levels), spanned=tuple(levels[:-1]))

    def _carrier_plate(self, level: int) -> Part:
        sizes = self.sizes
        pins = list(dict.fromkeys(self._pins().values()))
        free = self.build.access[self.carrier] == "loose"
        hub: Outline = Disc(0j, 0.5 * sizes.hole)
        if not free:
            hub = keyed_bore(0j, sizes.pin, key_for(sizes.pin), sizes.clearance)
        outer = widened([0j, *pins], 0.5 * sizes.width)
        if len(pins) > 1:
            around = Disc(0j, max(abs(pin) for pin in pins) + 0.5 * sizes.width)
            # Few or uneven pins: use a disc, so that the hub is inside.
            outer = around if _hub_uncovered(pins, sizes) else outer
        holes = (hub, *(Disc(pin, 0.5 * sizes.hole) for pin in pins))
        return Part(
            plain(self.carrier), "carrier", "link", self.carried(self.carrier),
            (Prism(Region(outer, holes), self.levels[level].low, self.levels[level].high),), 1.0 + 0.0j,
            (level, level), MATERIALS[sizes.process][0], LINK_COLOURS[-1],
        )  # fmt: skip

    def _alike(self, part: Part) -> Part:
        """Mark pins of a planet's copies as identical, including keyed ones."""
        if part.sort == "pin" and part.described.startswith("axle of planet") and not part.round:
            return replace(part, like="axle of a planet")
        return part

    def _motion(self, wheels: Sequence[Wheel]) -> TrainMotion:
        carrier = self.speeds[self.carrier]
        bodies: dict[str, Turning] = {}
        for member in self.arrangement.members:
            if member != self.mechanism.fixed:
                bodies[member] = Turning(0j, self.speeds[member])
        for gear in self.gears:
            if gear.body in self.arrangement.carriers:
                bodies[self.body(gear)] = Turning(gear.centre, self.speeds[gear.body], carrier)
        # Teeth pass at speeds relative to the carrier.
        passing = [abs(wheel.speed - carrier) * wheel.gear.teeth for wheel in wheels]
        size = 2.0 * max(abs(wheel.centre) + wheel.outer for wheel in wheels)
        slowest = min((one for one in passing if one > 0.0), default=1.0)
        return TrainMotion(bodies, size, min(math.ceil(1.0 / slowest), 400))

    def _notes(self) -> tuple[str, ...]:
        told = ["Gears are keyed to their shafts; planets turn on their pins, stepped planets together with them."]
        fixed = f"The {self.mechanism.fixed.replace('_', ' ')} is fixed"
        if self.build.access[self.mechanism.fixed] == "held":
            what = "is the lower plate" if self.mechanism.fixed == self.carrier else "is held by the posts"
            told.append(f"{fixed}: it {what}.")
        else:
            told.append(f"{fixed} by a key between its shaft and the plate.")
        for role, body in (("input", self.mechanism.input), ("output", self.mechanism.output)):
            if self.build.access[body] == "loose":
                own = f"The {body.replace('_', ' ')} is the {role}"
                told.append(f"{own}, and has no shaft of its own: connect to its rim.")
        return tuple(told)


def _hub_uncovered(pins: Sequence[complex], sizes: Sizes) -> bool:
    """Return whether the hull of the pins is too narrow about the axis for a keyway with its walls."""
    turned = np.sort(np.angle(pins))
    widest = float(np.diff(turned, append=turned[0] + 2.0 * math.pi).max())
    return min(abs(pin) for pin in pins) * math.cos(min(0.5 * widest, 0.5 * math.pi)) < 0.5 * sizes.pin
