"""Wheels as parts: teeth, bores, rings with their webs; and the interference check of a train.

A ring is one piece with its web if it is printed or milled. If cut from sheets they are two, joined by pins in the rim.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from kinematics.gear.teeth import Gear
from kinematics.message import compose, make_sentence
from service.parts.assembly.colours import LINK_COLOURS
from service.parts.assembly.descriptions import name_material, name_part
from service.parts.assembly.fasteners import MATERIALS, make_fillers, make_pin
from service.parts.assembly.interference import find_overlaps, find_thin_walls
from service.parts.assembly.keys import find_key, make_bore
from service.parts.assembly.model import Assembly, Carrier, Part
from service.parts.assembly.sizes import (
    MAX_CLEARANCE_PER_PIN,
    MIN_CLEARANCE_PER_PIN,
    MIN_WALL_PER_PIN,
    WIDTH_PER_PIN,
    NotMade,
    Sizes,
    choose_pin,
)
from service.parts.gears.housing import Level
from service.parts.gears.sizing import RIM_WIDTH, GearSizing
from service.parts.gears.stand import Wheel
from service.parts.gears.teeth import make_teeth
from service.parts.geometry.regions import Disc, Outline, Region
from service.parts.geometry.solids import Body, Prism, TwistedPrism

JOINT_COUNT, MAX_JOINT_SHARE = 6, 0.4
"""Number of pins that join a ring to its web, and their maximum diameter in bores."""

JOINT_WALL_RATIO = 1.05
"""Wall next to these pins, as a multiple of the minimum wall."""


def compute_rim_radius(ring: Gear, sizes: Sizes) -> float:
    """Return the outer radius of a ring: its rim must hold the pins that join it to its web."""
    rim = RIM_WIDTH * ring.module
    if sizes.process == "laser":
        # The rim must hold the pins to the web.
        rim = max(rim, 2.0 * _measure_joint_offset(sizes))
    return ring.root_radius + rim


def _choose_joint(sizes: Sizes) -> Sizes:
    """Return the sizes of the pins that join a ring to its web."""
    pin = choose_pin(MAX_JOINT_SHARE * sizes.pin)
    clearance = min(max(sizes.clearance, MIN_CLEARANCE_PER_PIN * pin), MAX_CLEARANCE_PER_PIN * pin)
    return Sizes(sizes.process, WIDTH_PER_PIN * pin, pin, sizes.thickness, clearance)


def _measure_joint_offset(sizes: Sizes) -> float:
    """Return the minimum distance from the roots of a ring to the centres of these pins."""
    return JOINT_WALL_RATIO * MIN_WALL_PER_PIN * sizes.pin + 0.5 * _choose_joint(sizes).hole


def make_wheel_parts(
    wheel: Wheel, carrier: Carrier, levels: Sequence[Level], sizes: Sizes, *, free: bool = False,
    towards: complex = 1.0 + 0.0j, like: str = "",
) -> list[Part]:  # fmt: skip
    """Make a wheel: its teeth, and its bore, with a keyway unless it rotates freely on its shaft.

    Parameters
    ----------
    free : bool
        Whether it rotates freely on its shaft.
    towards : complex
        Direction of its keyway.
    like : str
        Key shared by identical wheels.
    """
    key = find_key(sizes.pin)
    bore: Outline = Disc(wheel.centre, 0.5 * sizes.hole)
    if not free:
        bore = make_bore(wheel.centre, sizes.pin, key, sizes.clearance, towards)
    low, high = levels[wheel.level].low, levels[wheel.top or wheel.level].high
    # Rotation of a helix along the face width.
    twist = (high - low) * math.tan(wheel.helix_angle) / wheel.gear.pitch_radius
    # The middle of the face has the nominal tooth angle.
    teeth = make_teeth(wheel.gear, wheel.centre, wheel.tooth_at - 0.5 * twist, abs(wheel.helix_angle), wheel.play)

    def make_part(name: str, described: str, bodies: tuple[Body, ...], level: int) -> Part:
        return Part(
            name,
            described,
            "gear",
            carrier,
            bodies,
            towards,
            (level, level),
            name_material(MATERIALS[sizes.process][0]),
            LINK_COLOURS[wheel.tint % len(LINK_COLOURS)],
            like=like,
        )

    if wheel.web is None:
        body: Body = Prism(Region(teeth, (bore,)), low, high)
        if twist:
            body = TwistedPrism(Region(teeth, (bore,)), low, high, twist, wheel.centre)
        return [make_part(wheel.name, wheel.described, (body,), wheel.level)]
    web, disc = levels[wheel.web], Disc(wheel.centre, wheel.outer)
    if sizes.process != "laser":
        # The ring is on its web and extends through the gap between the two levels.
        ends = (low, web.low) if web.low > low else (web.high, high)
        bodies = (Prism(Region(disc, (teeth,)), *ends), Prism(Region(disc, (bore,)), web.low, web.high))
        return [make_part(wheel.name, wheel.described, bodies, wheel.level)]
    joint = _choose_joint(sizes)
    away = 0.5 * (wheel.gear.root_radius + wheel.outer)
    places = [wheel.centre + cmath.rect(away, 2.0 * math.pi * k / JOINT_COUNT) for k in range(JOINT_COUNT)]
    holes = tuple(Disc(place, 0.5 * joint.hole) for place in places)
    parts = [
        make_part(wheel.name, wheel.described, (Prism(Region(disc, (teeth, *holes)), low, high),), wheel.level),
        make_part(
            f"web_{wheel.name.split('_', 1)[1]}", wheel.web_described,
            (Prism(Region(disc, (bore, *holes)), web.low, web.high),), wheel.web,
        ),
    ]  # fmt: skip
    lower, upper = sorted((wheel.level, wheel.web))
    for number, place in enumerate(places, 1):
        name = f"{wheel.name}_{number}"
        ends = levels[lower].low, levels[upper].high
        parts += make_pin(name, compose("parts-rim-pin", number=number), carrier, place, ends, (lower, upper), joint)
        gap = levels[lower].high, levels[upper].low
        parts += make_fillers(name, carrier, place, gap, (lower, upper), joint, washers=False)
    return parts


def check_assembly(assembly: Assembly, sizes: Sizes, sizing: GearSizing) -> Assembly:
    """Return the assembly, after a check for interference and thin walls.

    Raises
    ------
    NotMade
        If two parts collide, or a wall is too thin.
    """
    thin = find_thin_walls(assembly, 0.99 * MIN_WALL_PER_PIN * sizes.pin)
    if thin:
        fault = compose("parts-walls-too-thin", part=name_part(thin[0].part))
        raise NotMade(make_sentence(fault), sizing.path)
    meeting = find_overlaps(assembly)
    if meeting:
        one, other = (name_part(name) for name in meeting[0].parts)
        # Colliding teeth are a matter of play, not of space.
        if all(part.sort == "gear" for part in assembly.parts if part.name in meeting[0].parts):
            raise NotMade(
                compose(
                    "parts-teeth-collide",
                    first=one,
                    second=other,
                    angle=f"{math.degrees(meeting[0].at):.1f}",
                    clearance=f"{sizes.clearance / sizing.unit:.4g}",
                    unit=sizing.words,
                ),
                "/query/clearance",
            )
        raise NotMade(
            compose(
                "parts-parts-collide-at-angle", first=one, second=other, angle=f"{math.degrees(meeting[0].at):.1f}"
            ),
            sizing.path,
        )
    return assembly
