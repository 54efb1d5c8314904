"""Parts of planetary trains with one carrier: suns on shafts, planets on pins, rings on webs or on the posts."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from kinematics.errors import DimensionError
from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose
from service.parts.assembly.colours import LINK_COLOURS
from service.parts.assembly.descriptions import describe_identifier, describe_name, name_material
from service.parts.assembly.fasteners import MATERIALS
from service.parts.assembly.keys import find_key, make_bore
from service.parts.assembly.model import Assembly, Carrier, Part, simplify_name
from service.parts.assembly.sizes import MIN_WALL_PER_PIN, NotMade, PartsQuery, Sizes
from service.parts.gears.housing import Housing, Level, Shaft, stack_levels
from service.parts.gears.motion import BodyRotation, TrainMotion
from service.parts.gears.planetary_build import Build, choose_build
from service.parts.gears.sizing import GearSizing, Passage
from service.parts.gears.stand import Wheel
from service.parts.gears.teeth import make_teeth
from service.parts.gears.wheels import JOINT_WALL_RATIO, check_assembly, compute_rim_radius, make_wheel_parts
from service.parts.geometry.regions import Disc, Outline, Region, widen_hull
from service.parts.geometry.solids import Prism
from service.render.gears.planetary_layout import PlanetaryGear, place_planetary_gears
from synthesis.kinds.planetary_train.design import PlanetaryDesign, PlanetaryMechanism
from synthesis.kinds.planetary_train.problem import PlanetaryProblem

POST_COUNT = 4
"""Number of posts of a train whose ring is held by them."""


def make_planetary_parts(design: PlanetaryDesign, problem: PlanetaryProblem, query: PartsQuery) -> Assembly:
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
        If the train has bevel gears or several carriers, cannot be built between two plates, or does not fit.
    """
    mechanism = design.mechanism
    arrangement = ARRANGEMENTS[mechanism.arrangement]
    # Only one carrier fits between the two central shafts.
    if arrangement.bevel or len(set(arrangement.carriers.values())) > 1:
        raise NotMade(compose("parts-planetary-type-not-available"))
    build = choose_build(arrangement, (mechanism.input, mechanism.output, mechanism.fixed))
    if build is None:
        raise NotMade(compose("parts-planetary-shafts-unreachable"))
    sizing = GearSizing(query, problem.length_unit)
    module = mechanism.module * sizing.factor
    sizing.check_size(design.metrics.size * sizing.factor)
    gears = place_planetary_gears(mechanism.model_copy(update={"module": module}))
    smallest = min((one.gear for one in gears if not one.gear.internal), key=lambda gear: gear.root_radius)
    refused = None
    for sizes in sizing.list_sizes(smallest, _find_narrowest_passage(gears, arrangement, build)):
        try:
            return _PlanetaryTask(
                mechanism, arrangement, design.metrics.speeds, build, gears, sizes, sizing
            ).build_assembly()
        except DimensionError as error:
            raise NotMade(compose("parts-gears-cannot-be-cut", reason=str(error))) from None
        except NotMade as error:
            if error.path == "/query/clearance":  # teeth collide on any shafts
                raise
            refused = error
    assert refused is not None
    raise refused


def _find_narrowest_passage(gears: Sequence[PlanetaryGear], arrangement: Arrangement, build: Build) -> Passage | None:
    """Return the passage with the minimum distance from a planet's axis to a gear that its axle passes, or None."""
    near: list[Passage] = []
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
            # Radial space between the axle and the gear that it passes.
            near.append(Passage(away, planet.name, other.name))
    return min(near, default=None)


@dataclass(frozen=True)
class _PlanetaryTask:
    """A train in millimetres, its build, and the sizes of its shafts and plates."""

    mechanism: PlanetaryMechanism
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
            heights[level] = self.sizing.choose_face_width(
                self.mechanism.module * self.sizing.factor, widths[plane - 1]
            )
        return stack_levels(heights, self.sizes)

    def name_body(self, gear: PlanetaryGear) -> str:
        """Return the body of a gear, as the motion names it."""
        if gear.body == self.mechanism.fixed:
            return GROUND
        return f"{gear.body}_{gear.copy + 1}" if gear.body in self.arrangement.carriers else gear.body

    def get_carrier(self, member: str) -> Carrier:
        """Return the carrier of a member that rotates about the axis."""
        return Carrier(GROUND if member == self.mechanism.fixed else member, None)

    def build_assembly(self) -> Assembly:
        """Build the assembly and check it for interference."""
        wheels = [self._make_wheel(gear, number) for number, gear in enumerate(self.gears)]
        posts = self._place_posts(wheels)
        around = [(gear.centre, wheel.outer) for gear, wheel in zip(self.gears, wheels, strict=True)]
        # The carrier's plate sweeps a circle beyond its pins.
        around += [(0j, abs(pin) + 0.5 * self.sizes.width) for pin in self._find_pins().values()]
        # Rings without a web are fixed to the posts.
        standing = tuple(wheel.level for wheel in wheels if wheel.gear.internal and wheel.web is None)
        housing = Housing(self.sizes, self.levels, tuple(self._make_shafts()), tuple(around), posts, standing)
        parts: list[Part] = []
        for gear, wheel in zip(self.gears, wheels, strict=True):
            parts += self._make_parts(gear, wheel, posts)
        if self.build.carrier is not None:
            parts.append(self._make_carrier_plate(self.build.carrier))
        parts += housing.make_parts()
        parts = [self._mark_identical(part) for part in parts]
        assembly = Assembly(
            tuple(parts), self._make_motion(wheels), self.build.highest, 2, self.sizing.factor, self.sizing.query.scale,
            self._list_notes(),
        )  # fmt: skip
        return check_assembly(assembly, self.sizes, self.sizing)

    # Wheels

    def _make_wheel(self, gear: PlanetaryGear, tint: int) -> Wheel:
        levels = sorted(self.build.planes[plane] for plane in gear.planes)
        planet = gear.body in self.arrangement.carriers
        name = f"{simplify_name(gear.name)}_{gear.copy + 1}" if planet else simplify_name(gear.name)
        outer = compute_rim_radius(gear.gear, self.sizes) if gear.gear.internal else gear.gear.tip_radius
        names = list(self.mechanism.teeth)
        described = compose("parts-wheel-with-teeth", wheel=describe_identifier(name), teeth=f"{gear.gear.teeth:g}")
        return Wheel(
            f"gear_{name}", described, gear.gear, tint, levels[0],
            gear.centre, gear.tooth_at, outer, self.speeds[gear.body], names.index(gear.name),
            web=self.build.webs.get(gear.body) if gear.gear.internal else None, play=0.5 * self.sizes.clearance,
            top=levels[-1], web_described=compose("parts-web-of-wheel", wheel=described),
        )  # fmt: skip

    def _make_parts(self, gear: PlanetaryGear, wheel: Wheel, posts: Sequence[complex]) -> list[Part]:
        if gear.gear.internal and wheel.web is None:
            return [self._make_fixed_ring(wheel, posts)]
        planet = gear.body in self.arrangement.carriers
        free = not self._is_stepped(gear.body) if planet else self.build.access[gear.body] == "loose"
        return make_wheel_parts(
            wheel, Carrier(self.name_body(gear), None), self.levels, self.sizes, free=free,
            towards=self._find_key_direction(gear) if planet else 1.0 + 0.0j, like=gear.name if planet else "",
        )  # fmt: skip

    def _make_fixed_ring(self, wheel: Wheel, posts: Sequence[complex]) -> Part:
        """Make a ring that is held by the posts."""
        outer = Disc(0j, abs(posts[0]) + 0.5 * self.sizes.hole + JOINT_WALL_RATIO * MIN_WALL_PER_PIN * self.sizes.pin)
        teeth = make_teeth(wheel.gear, wheel.centre, wheel.tooth_at, 0.0, wheel.play)
        holes = [Disc(post, 0.5 * self.sizes.hole) for post in posts]
        level = self.levels[wheel.level]
        return Part(
            wheel.name,
            wheel.described,
            "gear",
            Carrier(GROUND, None),
            (Prism(Region(outer, (teeth, *holes)), level.low, level.high),),
            1.0 + 0.0j,
            (wheel.level, wheel.level),
            name_material(MATERIALS[self.sizes.process][0]),
            LINK_COLOURS[wheel.tint % len(LINK_COLOURS)],
        )

    def _is_stepped(self, planet: str) -> bool:
        """Return whether a planet has several gears, which are keyed to one pin."""
        return sum(gear.body == planet for gear in self.arrangement.gears) > 1

    def _find_key_direction(self, gear: PlanetaryGear) -> complex:
        """Return the direction of a planet's keyways: copies are rotated like their gears."""
        first = next(one for one in self.gears if one.name == gear.name and one.copy == 0)
        return cmath.exp(1j * (gear.tooth_at - first.tooth_at))

    # Carriers and shafts

    def _find_pins(self) -> dict[str, complex]:
        """Return the centres of planets and their copies by body name."""
        return {self.name_body(gear): gear.centre for gear in self.gears if gear.body in self.arrangement.carriers}

    def _place_posts(self, wheels: Sequence[Wheel]) -> tuple[complex, ...]:
        """Return the posts that hold a ring, outside all rotating parts."""
        rings = [wheel for wheel in wheels if wheel.gear.internal and wheel.web is None]
        if not rings:
            return ()
        room = JOINT_WALL_RATIO * MIN_WALL_PER_PIN * self.sizes.pin + 0.5 * self.sizes.hole
        away = max(wheel.gear.root_radius for wheel in rings) + room
        moving = [abs(wheel.centre) + wheel.outer for wheel in wheels if wheel not in rings]
        moving += [abs(pin) + 0.5 * self.sizes.width for pin in self._find_pins().values()]
        # Posts stay outside everything that rotates.
        away = max(away, max(moving) + 0.5 * self.sizes.collar + self.sizes.min_gap)
        return tuple(cmath.rect(away, math.pi * (k + 0.5) / (0.5 * POST_COUNT)) for k in range(POST_COUNT))

    def _make_shafts(self) -> list[Shaft]:
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
            is_fixed = body == self.mechanism.fixed
            plate = 0 if side == "low" else top
            found.append(
                Shaft(
                    compose("parts-shaft-of-member", member=describe_identifier(body)),
                    self.get_carrier(body),
                    0j,
                    (low, high),
                    (hubs[body], plate) if is_fixed else (hubs[body],),
                    tuple(loose),
                    ends=body in (self.mechanism.input, self.mechanism.output),
                )
            )
        for name, centre in self._find_pins().items():
            found.append(self._make_pin(name, centre))
        return found

    def _make_pin(self, name: str, centre: complex) -> Shaft:
        """Make the pin of a planet: it is held by the carrier, and rotates with a stepped planet."""
        own = [gear for gear in self.gears if self.name_body(gear) == name]
        plate = 0 if self.build.carrier is None else self.build.carrier
        levels = sorted({self.build.planes[plane] for gear in own for plane in gear.planes})
        reach = min(plate, *levels), max(plate, *levels)
        planet = describe_name(f"planet {name.replace('planet', '').strip('_').replace('_', ' ')}".strip())
        described = compose("parts-axle-of-planet", planet=planet)
        if self._is_stepped(own[0].body):
            keyed = tuple(self.build.planes[gear.planes[0]] for gear in own)
            return Shaft(described, Carrier(name, None), centre, reach, keyed, (plate,),
                         towards=self._find_key_direction(own[0]))  # fmt: skip
        carrier = Carrier(self.get_carrier(self.carrier).link, None)
        return Shaft(described, carrier, centre, reach, (), (plate, *levels), spanned=tuple(levels[:-1]))

    def _make_carrier_plate(self, level: int) -> Part:
        sizes = self.sizes
        pins = list(dict.fromkeys(self._find_pins().values()))
        free = self.build.access[self.carrier] == "loose"
        hub: Outline = Disc(0j, 0.5 * sizes.hole)
        if not free:
            hub = make_bore(0j, sizes.pin, find_key(sizes.pin), sizes.clearance)
        outer = widen_hull([0j, *pins], 0.5 * sizes.width)
        if len(pins) > 1:
            around = Disc(0j, max(abs(pin) for pin in pins) + 0.5 * sizes.width)
            # Few or uneven pins: use a disc, so that the hub is inside.
            outer = around if _is_hub_uncovered(pins, sizes) else outer
        holes = (hub, *(Disc(pin, 0.5 * sizes.hole) for pin in pins))
        return Part(
            simplify_name(self.carrier), compose("parts-carrier"), "link", self.get_carrier(self.carrier),
            (Prism(Region(outer, holes), self.levels[level].low, self.levels[level].high),), 1.0 + 0.0j,
            (level, level), name_material(MATERIALS[sizes.process][0]), LINK_COLOURS[-1],
        )  # fmt: skip

    def _mark_identical(self, part: Part) -> Part:
        """Mark pins of a planet's copies as identical, including keyed ones."""
        if part.sort == "pin" and part.name.startswith("pin_axle_of_planet") and not part.round:
            return replace(part, like="axle of a planet")
        return part

    def _make_motion(self, wheels: Sequence[Wheel]) -> TrainMotion:
        carrier = self.speeds[self.carrier]
        bodies: dict[str, BodyRotation] = {}
        for member in self.arrangement.members:
            if member != self.mechanism.fixed:
                bodies[member] = BodyRotation(0j, self.speeds[member])
        for gear in self.gears:
            if gear.body in self.arrangement.carriers:
                bodies[self.name_body(gear)] = BodyRotation(gear.centre, self.speeds[gear.body], carrier)
        # Teeth pass at speeds relative to the carrier.
        passing = [abs(wheel.speed - carrier) * wheel.gear.teeth for wheel in wheels]
        size = 2.0 * max(abs(wheel.centre) + wheel.outer for wheel in wheels)
        slowest = min((one for one in passing if one > 0.0), default=1.0)
        return TrainMotion(bodies, size, min(math.ceil(1.0 / slowest), 400))

    def _list_notes(self) -> tuple[str, ...]:
        notes = [compose("parts-planetary-gears-keyed")]
        if self.build.access[self.mechanism.fixed] != "held":
            message_id = "parts-member-fixed-by-key"
        elif self.mechanism.fixed == self.carrier:
            message_id = "parts-member-is-lower-plate"
        else:
            message_id = "parts-member-held-by-posts"
        notes.append(compose(message_id, member=describe_identifier(self.mechanism.fixed)))
        if self.build.access[self.mechanism.input] == "loose":
            notes.append(compose("parts-input-without-shaft", member=describe_identifier(self.mechanism.input)))
        if self.build.access[self.mechanism.output] == "loose":
            notes.append(compose("parts-output-without-shaft", member=describe_identifier(self.mechanism.output)))
        return tuple(notes)


def _is_hub_uncovered(pins: Sequence[complex], sizes: Sizes) -> bool:
    """Return whether the hull of the pins is too narrow about the axis for a keyway with its walls."""
    turned = np.sort(np.angle(pins))
    widest = float(np.diff(turned, append=turned[0] + 2.0 * math.pi).max())
    return min(abs(pin) for pin in pins) * math.cos(min(0.5 * widest, 0.5 * math.pi)) < 0.5 * sizes.pin
