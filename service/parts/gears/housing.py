"""Two plates with posts between them, and the shafts that they hold with all parts on them.

A shaft carries, from below: a plate, wheels with keys, washers or spacers in every gap, and the other plate. A shaft
that reaches only one plate ends beyond its farthest wheel. Its ends have the same fasteners as pins
(:mod:`service.parts.assembly.fasteners`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose
from service.parts.assembly.colours import BASE_COLOUR
from service.parts.assembly.descriptions import describe_identifier, describe_name, name_material
from service.parts.assembly.fasteners import FASTENER_COLOUR, MATERIALS, PLAIN_PIN, PinShape, make_fillers, make_pin
from service.parts.assembly.keys import find_key, make_bore, make_key_section, make_shaft_section
from service.parts.assembly.model import Carrier, Part, simplify_name
from service.parts.assembly.sizes import Sizes
from service.parts.geometry.regions import Disc, Outline, Region, widen_hull
from service.parts.geometry.solids import Prism

STUB_LENGTH = 1.5
"""Length of input and output shafts beyond their plates, in diameters."""


@dataclass(frozen=True)
class Level:
    """Height range of wheels or of a plate."""

    low: float
    high: float


@dataclass(frozen=True)
class Shaft:
    """A shaft, or an axle that does not rotate.

    Attributes
    ----------
    name : str
    carrier : Carrier
    axis : complex
    reach : pair of int
        Lowest and highest level that it passes.
    keyed : tuple of int
        Levels of wheels that rotate with it.
    free : tuple of int
        Levels of wheels that rotate freely on it.
    spanned : tuple of int
        Levels from which a wheel extends to the next one, so that no spacer fits between.
    sliding : tuple of pair of int
        Lowest and highest level of each range in which wheels slide on a feather key of the same length.
    ends : bool
        Whether one end protrudes from its plate, as input or output.
    below : bool
        Whether that is the lower end, if it reaches both plates.
    towards : complex
        Direction of its keys.
    """

    name: str
    carrier: Carrier
    axis: complex
    reach: tuple[int, int]
    keyed: tuple[int, ...] = ()
    free: tuple[int, ...] = ()
    ends: bool = False
    below: bool = False
    towards: complex = 1.0 + 0.0j
    spanned: tuple[int, ...] = ()
    sliding: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True)
class Housing:
    """Plates at levels 0 and ``len(levels) - 1``, and the shafts and posts that they hold.

    Attributes
    ----------
    sizes : Sizes
        Sizes of plates, shafts and posts.
    levels : tuple of Level
    shafts : tuple of Shaft
    around : tuple of (complex, float)
        Centres and radii of all rotating parts; the posts are outside.
    posts : tuple of complex
        Places of the posts; if empty, the corners around everything.
    standing : tuple of int
        Levels of parts held by the posts.
    """

    sizes: Sizes
    levels: tuple[Level, ...]
    shafts: tuple[Shaft, ...]
    around: tuple[tuple[complex, float], ...]
    posts: tuple[complex, ...] = ()
    standing: tuple[int, ...] = ()

    @property
    def top(self) -> int:
        """Level of the upper plate."""
        return len(self.levels) - 1

    def make_parts(self) -> list[Part]:
        """Make plates, shafts with keys and distance pieces, and posts."""
        places = self.posts or self.find_corners()
        found = [
            self._make_plate("base", 0, places),
            self._make_plate("second_base", self.top, places),
        ]
        for shaft in self.shafts:
            found += self._make_shaft(shaft)
        for number, place in enumerate(places, 1):
            name, carrier = f"post_{number}", Carrier(GROUND, None)
            found += self._stack_parts(
                name, describe_name(f"post {number}"), carrier, place, (0, self.top), (0, *self.standing, self.top)
            )
        return found

    def find_corners(self) -> tuple[complex, ...]:
        """Return the corners of the rectangle around all rotating parts, with the margin that posts need."""
        room = 0.5 * self.sizes.collar + self.sizes.min_gap
        low = min(z.real - r for z, r in self.around) - room, min(z.imag - r for z, r in self.around) - room
        high = max(z.real + r for z, r in self.around) + room, max(z.imag + r for z, r in self.around) + room
        return complex(*low), complex(high[0], low[1]), complex(*high), complex(low[0], high[1])

    def _make_plate(self, name: str, level: int, posts: Iterable[complex]) -> Part:
        radius = 0.5 * self.sizes.hole
        axes = [shaft.axis for shaft in self.shafts if level in shaft.reach and level not in shaft.keyed]
        cuts: list[Outline] = [Disc(place, radius) for place in (*axes, *posts)]
        # A shaft that is keyed to a plate is fixed to the housing.
        cuts += [
            make_bore(shaft.axis, self.sizes.pin, find_key(self.sizes.pin), self.sizes.clearance)
            for shaft in self.shafts
            if level in shaft.keyed
        ]
        outer = widen_hull([*self.find_corners(), *posts], 0.5 * self.sizes.width)
        return Part(
            name=name,
            described=describe_identifier(name),
            sort="base",
            carrier=Carrier(GROUND, None),
            bodies=(Prism(Region(outer, tuple(cuts)), self.levels[level].low, self.levels[level].high),),
            along=1.0 + 0.0j,
            planes=(level, level),
            material=name_material(MATERIALS[self.sizes.process][0]),
            colour=BASE_COLOUR,
        )

    def _make_shaft(self, shaft: Shaft) -> list[Part]:
        """Make a shaft with its keys and distance pieces."""
        sizes, name = self.sizes, simplify_name(shaft.name)
        seated = [
            make_seat(
                shaft.name, str(level), shaft.carrier, shaft.axis, self.levels[level], (level,), sizes, shaft.towards
            )
            for level in sorted(shaft.keyed)
        ]
        seated += [
            make_seat(
                shaft.name, f"{low}_{high}", shaft.carrier, shaft.axis,
                Level(self.levels[low].low, self.levels[high].high), (low, high), sizes, shaft.towards,
            )
            for low, high in shaft.sliding
        ]  # fmt: skip
        # The shank is built from below.
        seated.sort(key=lambda one: one[0].low)
        seats, keys = [prism for prism, _ in seated], [key for _, key in seated]
        inside = {level for level in (0, self.top) if level in shaft.reach}
        # A sliding range is kept free of spacers.
        slid = {level for low, high in shaft.sliding for level in range(low, high + 1)}
        levels = sorted({*shaft.keyed, *shaft.free, *slid, *inside})
        spanned = (*shaft.spanned, *(level for low, high in shaft.sliding for level in range(low, high)))
        stub = STUB_LENGTH * sizes.pin if shaft.ends else 0.0
        # The stub protrudes from the plate that the shaft reaches.
        down = shaft.reach[1] < self.top or shaft.below
        return [
            *self._stack_parts(
                name, shaft.name, shaft.carrier, shaft.axis, shaft.reach, levels, PinShape(seats, stub, down), spanned
            ),
            *keys,
        ]

    def _stack_parts(
        self,
        name: str,
        described: str,
        carrier: Carrier,
        place: complex,
        reach: tuple[int, int],
        levels: Sequence[int],
        shape: PinShape = PLAIN_PIN,
        spanned: Sequence[int] = (),
    ) -> list[Part]:
        ends = self.levels[reach[0]].low, self.levels[reach[1]].high
        parts = make_pin(name, described, carrier, place, ends, reach, self.sizes, shape)
        for lower, upper in pairwise(levels):
            if lower in spanned:
                continue
            gap = self.levels[lower].high, self.levels[upper].low
            parts += make_fillers(name, carrier, place, gap, (lower, upper), self.sizes)
        return parts


def describe_support(shaft: str, *, lower: bool) -> str:
    """Return the note that only the lower or only the upper plate holds a shaft."""
    return compose("parts-held-by-lower-plate" if lower else "parts-held-by-upper-plate", shaft=shaft)


def make_seat(
    shaft: str, number: str, carrier: Carrier, axis: complex, level: Level, planes: Sequence[int], sizes: Sizes,
    towards: complex = 1.0 + 0.0j,
) -> tuple[Prism, Part]:  # fmt: skip
    """Return the section of a shaft at a wheel, and the key there.

    Parameters
    ----------
    planes : sequence of int
        Plane of the key; lowest and highest plane of a feather key, along which wheels slide.
    """
    # Keys are shorter than their wheel, so that they do not rub on neighbours.
    key, low, high = find_key(sizes.pin), level.low + sizes.play, level.high - sizes.play
    message_id = "parts-key-of-shaft" if len(planes) == 1 else "parts-feather-key-of-shaft"
    part = Part(
        name=f"key_{simplify_name(shaft)}_{number}",
        described=compose(message_id, shaft=shaft),
        sort="key",
        carrier=carrier,
        bodies=(Prism(Region(make_key_section(axis, sizes.pin, key, towards)), low, high),),
        along=towards,
        planes=(planes[0], planes[-1]),
        material=name_material(MATERIALS[sizes.process][1]),
        colour=FASTENER_COLOUR,
        standard=f"{key.standard} x {high - low:g}" if key.standard else "",
    )
    return Prism(Region(make_shaft_section(axis, sizes.pin, key, towards)), low, high), part


def stack_levels(heights: Sequence[float], sizes: Sizes) -> tuple[Level, ...]:
    """Stack levels with a gap between each two; the upper face of the first is at height 0."""
    low = -heights[0]
    levels = []
    for height in heights:
        levels.append(Level(low, low + height))
        low += height + sizes.gap
    return tuple(levels)
