"""Export of a linkage to PMKS+ as an address, whose query contains the model.

PMKS+ (Worcester Polytechnic Institute, https://app.pmksplus.com) writes a model as sections separated by points:
settings, joints, links, forces, the selection, and a character that encodes the total length; see
``src/app/services/transcoding`` of its public sources ``PMKS-Web/PMKSWeb``. Numbers are whole thousandths to base 64,
with a 0 before negative ones; flags are bits of such a number.

A joint is ``flags id,name,x,y,angle``; a joint that slides in a link adds that link and two of its joints. A sliding
joint coincides with the pin that it carries, and a link of the sort P, the block, joins both. A link is ``Y sort
id,name,mass,inertia,x,y,colour,joints,,``; mass and inertia are 1, PMKS+'s values for new links.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from kinematics.linkage.planar.mechanism import GROUND, Mechanism, Slide
from kinematics.message import compose
from service.simulation.query import NotSimulated

BASE_URL = "https://app.pmksplus.com/?"

BASE64_DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_-"
LENGTH_DIGITS = BASE64_DIGITS[:62]
"""Digits of base 62. The last character of a model encodes its length modulo 62."""

JOINT_LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"

THOUSANDTHS = 1000
MAX_MODEL_SIZE = 50.0
"""Maximum size of a model in PMKS+'s units. The minimum is a tenth of it, so that a thousandth of a unit is at most
1/5000 of the model's size.
"""

SLOT_HALF_LENGTH = 2.5
"""Half the drawn length of a slot, in PMKS+'s units."""

SLIDE_FLAG, INPUT_FLAG, GROUND_FLAG, CURVE_FLAG = 1, 2, 4, 16

COLOURS = ("c5cae9", "303e9f", "0d125a", "B2DFDB", "26A69A", "00695C")

CLOCKWISE_FLAG = 1
SETTING_FLAGS = 8 + 16 + 128
"""Bits of the settings: grids and forces on, as in PMKS+'s own templates."""


class PmksModel(NamedTuple):
    """An address, and the number of PMKS+ length units in one of the design's."""

    url: str
    scale: float


def write_pmks(mechanism: Mechanism, rpm: float) -> PmksModel:
    """Write a linkage as a PMKS+ address.

    Parameters
    ----------
    mechanism : Mechanism
    rpm : float
        Speed of a rotating input, rev/min.

    Raises
    ------
    NotSimulated
        If the mechanism has gears, more joints than there are letters, or links with equal names.
    """
    if mechanism.gears:
        raise NotSimulated(compose("simulation-pmks-without-gears"))
    return _Writer(mechanism).write_model(rpm)


def format_integer(value: int) -> str:
    """Format a whole number to base 64.

    Examples
    --------
    >>> format_integer(1000), format_integer(-3000), format_integer(0)
    ('Fe', '0ku', '0')
    """
    digits, rest = "", abs(value)
    while rest or not digits:
        rest, digit = divmod(rest, 64)
        digits = BASE64_DIGITS[digit] + digits
    return f"0{digits}" if value < 0 else digits


def format_decimal(value: float) -> str:
    """Format a number in thousandths."""
    return format_integer(round(value * THOUSANDTHS))


class _Writer:
    def __init__(self, mechanism: Mechanism) -> None:
        self._mechanism = mechanism
        places = [complex(z) for z in mechanism.joints.values()]
        size = max(abs(a - b) for a in places for b in places)
        # A power of ten keeps the numbers on screen comparable with the design's.
        self._scale = 10.0 ** math.floor(math.log10(MAX_MODEL_SIZE / size))
        self._origin = places[0]
        letters = iter(JOINT_LETTERS)
        self._letters = {}
        for joint in mechanism.joints:
            self._letters[joint] = self._take_letter(letters)
        self._free = letters
        self._records: list[str] = []
        self._links: list[str] = []
        self._members = {link: [self._letters[j] for j in listed] for link, listed in mechanism.links.items()}

    def write_model(self, rpm: float) -> PmksModel:
        mechanism = self._mechanism
        ground = set(mechanism.links[GROUND])
        driven = None if mechanism.has_slide_input else mechanism.input_pivot
        for joint, z in mechanism.joints.items():
            flags = CURVE_FLAG + GROUND_FLAG * (joint in ground) + INPUT_FLAG * (joint == driven)
            self._add_joint(flags, self._letters[joint], complex(z), 0.0)
        slots = [self._add_slot(slide) for slide in mechanism.slides]
        blocks = [self._add_block(slide, ends) for slide, ends in zip(mechanism.slides, slots, strict=True)]
        for link in mechanism.links:
            if link != GROUND:
                self._add_link("R", self._members[link], self._find_middle(link))
        for pin, slot in blocks:
            self._add_link("P", (pin, slot), None)
        # PMKS+ names a link by the letters of its joints, so two links with the same joints would collide.
        if len({link.split(",")[0][2:] for link in self._links}) < len(self._links):
            raise NotSimulated(compose("simulation-pmks-equal-joints"))
        # Whole speeds from 1 to 1000 rev/min; the direction is one of the settings.
        speed = min(max(round(abs(rpm)), 1), 1000)
        settings = format_integer(SETTING_FLAGS + CLOCKWISE_FLAG * (rpm < 0.0)).rjust(2, "0")
        head = (settings, f"{format_decimal(0.7)},{format_decimal(5.0)}", f"{format_integer(speed)},0", "1011")
        joints, links = "".join(f"{one}." for one in self._records), "".join(f"{one}." for one in self._links)
        text = ".".join((*head, joints, links, "", "N_"))
        return PmksModel(f"{BASE_URL}{text}{LENGTH_DIGITS[len(text) % 62]}", self._scale)

    @staticmethod
    def _take_letter(letters: Iterator[str]) -> str:
        for letter in letters:
            return letter
        raise NotSimulated(compose("simulation-pmks-too-many-joints", limit=len(JOINT_LETTERS)))

    def _format_point(self, place: complex) -> str:
        moved = self._scale * (place - self._origin)
        return f"{format_decimal(moved.real)},{format_decimal(moved.imag)}"

    def _add_joint(self, flags: int, letter: str, place: complex, angle: float, slot: str = "") -> None:
        self._records.append(
            f"{format_integer(flags)}{letter},{letter},{self._format_point(place)},{format_decimal(angle)}{slot}"
        )

    def _add_slot(self, slide: Slide) -> tuple[str, ...]:
        """Add two points of a slot in a moving link as joints of that link, and return their letters.

        A slot in the ground needs no such points: the result is empty.
        """
        if slide.link == GROUND:
            return ()
        ends = []
        for step in (-SLOT_HALF_LENGTH, SLOT_HALF_LENGTH):
            end = self._take_letter(self._free)
            away = step / self._scale * cmath.exp(1j * float(slide.angle))
            self._add_joint(0, end, complex(self._mechanism.joints[slide.joint]) + away, 0.0)
            self._members[slide.link].append(end)
            ends.append(end)
        return tuple(ends)

    def _add_block(self, slide: Slide, ends: tuple[str, ...]) -> tuple[str, str]:
        """Add a block on a slide; return the letters of its pin and of its own joint."""
        pin, place = self._letters[slide.joint], complex(self._mechanism.joints[slide.joint])
        own = self._take_letter(self._free)
        drives = self._mechanism.has_slide_input and self._mechanism.input == slide.joint and slide.link == GROUND
        flags = SLIDE_FLAG + CURVE_FLAG + INPUT_FLAG * drives
        if slide.link == GROUND:
            # Slots are undirected: PMKS+ expects angles from -90 to 90 degrees.
            turned = (float(slide.angle) + math.pi / 2.0) % math.pi - math.pi / 2.0
            self._add_joint(flags + GROUND_FLAG, own, place, turned)
        else:
            slot = ",".join(("".join(self._members[slide.link]), *ends))
            self._add_joint(flags, own, place, 0.0, f",{slot}")
        return pin, own

    def _find_middle(self, link: str) -> complex:
        places = [complex(self._mechanism.joints[joint]) for joint in self._mechanism.links[link]]
        return sum(places) / len(places)

    def _add_link(self, sort: str, members: Sequence[str], centre: complex | None) -> None:
        name = "".join(members)
        mass = format_decimal(1.0)
        if centre is None:
            what = f"{mass},0,0,0,"
        else:
            what = f"{mass},{mass},{self._format_point(centre)},{COLOURS[len(self._links) % len(COLOURS)]}"
        self._links.append(f"Y{sort}{name},{name},{what},{','.join(members)},,")
