"""Two plates with posts between them, and the shafts that they hold, with all that stands on these.

On a shaft lie, from below: a plate, wheels with keys, washers or spacers in every gap, and the other plate; a shaft
that reaches one plate alone ends beyond its farthest wheel. Its ends are held as pins are (:mod:`fasteners`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from kinematics.linkage.planar.mechanism import GROUND
from service.parts.bodies import Prism
from service.parts.colours import BASE_COLOUR
from service.parts.fasteners import FASTENER_COLOUR, MATERIALS, fillers, held_pin
from service.parts.gears.keys import key_for, key_section, keyed_bore, keyed_shaft
from service.parts.model import Carrier, Part, plain
from service.parts.shapes import Disc, Outline, Region, widened
from service.parts.sizes import Sizes

STUB = 1.5
"""Length of the ends of input and output shafts beyond their plates, in diameters."""


@dataclass(frozen=True)
class Level:
    """Heights between which wheels or a plate lie."""

    low: float
    high: float


@dataclass(frozen=True)
class Shaft:
    """A shaft, or an axle that does not turn.

    Attributes
    ----------
    name : str
    carrier : Carrier
    axis : complex
    reach : pair of int
        The lowest and the highest level that it passes.
    keyed : tuple of int
        Levels of what turns with it.
    free : tuple of int
        Levels of what turns on it.
    spanned : tuple of int
        Levels from which a wheel goes on to the next, so that nothing stands between these on the shaft.
    sliding : tuple of pair of int
        The lowest and the highest level of each range in which wheels slide on a feather key, as long as the range.
    ends : bool
        Whether one end stands out of its plate, to be turned, or to turn something.
    below : bool
        Whether that is the lower end, where it reaches both plates.
    towards : complex
        Where its keys point.
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
    """Plates at levels 0 and ``len(levels) - 1``, and what they hold.

    Attributes
    ----------
    sizes : Sizes
        Of plates, shafts and posts.
    levels : tuple of Level
    shafts : tuple of Shaft
    around : tuple of (complex, float)
        Centres and radii of all that turns, which the posts stand beyond.
    posts : tuple of complex
        Where they are to stand; in the corners around everything if empty.
    standing : tuple of int
        Levels of what stands on the posts.
    """

    sizes: Sizes
    levels: tuple[Level, ...]
    shafts: tuple[Shaft, ...]
    around: tuple[tuple[complex, float], ...]
    posts: tuple[complex, ...] = ()
    standing: tuple[int, ...] = ()

    @property
    def top(self) -> int:
        """The level of the upper plate."""
        return len(self.levels) - 1

    def parts(self) -> list[Part]:
        """Plates, shafts with keys and what parts their wheels, and posts."""
        places = self.posts or self.corners()
        found = [
            self._plate("base", 0, places),
            self._plate("second_base", self.top, places),
        ]
        for shaft in self.shafts:
            found += self._on(shaft)
        for number, place in enumerate(places, 1):
            name, carrier = f"post_{number}", Carrier(GROUND, None)
            found += self._stack(name, f"post {number}", carrier, place, (0, self.top), (0, *self.standing, self.top))
        return found

    def corners(self) -> tuple[complex, ...]:
        """Of the rectangle around all that turns, as far beyond as posts need."""
        room = 0.5 * self.sizes.collar + self.sizes.apart
        low = min(z.real - r for z, r in self.around) - room, min(z.imag - r for z, r in self.around) - room
        high = max(z.real + r for z, r in self.around) + room, max(z.imag + r for z, r in self.around) + room
        return complex(*low), complex(high[0], low[1]), complex(*high), complex(low[0], high[1])

    def _plate(self, name: str, level: int, posts: Iterable[complex]) -> Part:
        radius = 0.5 * self.sizes.hole
        held = [shaft.axis for shaft in self.shafts if level in shaft.reach and level not in shaft.keyed]
        cuts: list[Outline] = [Disc(place, radius) for place in (*held, *posts)]
        cuts += [
            keyed_bore(shaft.axis, self.sizes.pin, key_for(self.sizes.pin), self.sizes.clearance)
            for shaft in self.shafts
            if level in shaft.keyed
        ]
        outer = widened([*self.corners(), *posts], 0.5 * self.sizes.width)
        return Part(
            name=name,
            described=name.replace("_", " "),
            sort="base",
            carrier=Carrier(GROUND, None),
            bodies=(Prism(Region(outer, tuple(cuts)), self.levels[level].low, self.levels[level].high),),
            along=1.0 + 0.0j,
            planes=(level, level),
            material=MATERIALS[self.sizes.process][0],
            colour=BASE_COLOUR,
        )

    def _on(self, shaft: Shaft) -> list[Part]:
        """A shaft with its keys, and what parts its wheels."""
        sizes, name = self.sizes, plain(shaft.name)
        seated = [
            seat(shaft.name, str(level), shaft.carrier, shaft.axis, self.levels[level], level, sizes, shaft.towards)
            for level in sorted(shaft.keyed)
        ]
        seated += [
            seat(
                shaft.name, f"{low}_{high}", shaft.carrier, shaft.axis,
                Level(self.levels[low].low, self.levels[high].high), low, sizes, shaft.towards, top=high,
            )
            for low, high in shaft.sliding
        ]  # fmt: skip
        seated.sort(key=lambda one: one[0].low)
        seats, keys = [prism for prism, _ in seated], [key for _, key in seated]
        inside = {level for level in (0, self.top) if level in shaft.reach}
        slid = {level for low, high in shaft.sliding for level in range(low, high + 1)}
        levels = sorted({*shaft.keyed, *shaft.free, *slid, *inside})
        spanned = (*shaft.spanned, *(level for low, high in shaft.sliding for level in range(low, high)))
        stub = STUB * sizes.pin if shaft.ends else 0.0
        down = shaft.reach[1] < self.top or shaft.below
        return [
            *self._stack(name, shaft.name, shaft.carrier, shaft.axis, shaft.reach, levels, seats, stub, down, spanned),
            *keys,
        ]

    def _stack(
        self,
        name: str,
        described: str,
        carrier: Carrier,
        place: complex,
        reach: tuple[int, int],
        levels: Sequence[int],
        seats: Sequence[Prism] = (),
        stub: float = 0.0,
        upside_down: bool = False,
        spanned: Sequence[int] = (),
    ) -> list[Part]:
        ends = self.levels[reach[0]].low, self.levels[reach[1]].high
        parts = held_pin(
            name, described, carrier, place, ends, reach, self.sizes,
            seats=seats, stub=stub, upside_down=upside_down,
        )  # fmt: skip
        for lower, upper in pairwise(levels):
            if lower in spanned:
                continue
            gap = self.levels[lower].high, self.levels[upper].low
            parts += fillers(name, carrier, place, gap, (lower, upper), self.sizes)
        return parts


def seat(
    shaft: str, number: str, carrier: Carrier, axis: complex, level: Level, plane: int, sizes: Sizes,
    towards: complex = 1.0 + 0.0j, *, top: int | None = None,
) -> tuple[Prism, Part]:  # fmt: skip
    """What a shaft is where it has a wheel on it, and the key there.

    Parameters
    ----------
    top : int or None
        The highest plane of a feather key, along which wheels slide from ``plane`` on.
    """
    key, low, high = key_for(sizes.pin), level.low + sizes.play, level.high - sizes.play
    part = Part(
        name=f"key_{plain(shaft)}_{number}",
        described=f"{'key' if top is None else 'feather key'} of the {shaft}",
        sort="key",
        carrier=carrier,
        bodies=(Prism(Region(key_section(axis, sizes.pin, key, towards)), low, high),),
        along=towards,
        planes=(plane, plane if top is None else top),
        material=MATERIALS[sizes.process][1],
        colour=FASTENER_COLOUR,
        standard=f"{key.standard} x {high - low:g}" if key.standard else "",
    )
    return Prism(Region(keyed_shaft(axis, sizes.pin, key, towards)), low, high), part


def stacked(heights: Sequence[float], sizes: Sizes) -> tuple[Level, ...]:
    """Levels over one another, a gap between each two; the first has its upper face at height 0."""
    low = -heights[0]
    levels = []
    for height in heights:
        levels.append(Level(low, low + height))
        low += height + sizes.gap
    return tuple(levels)
