"""Pins and shafts with their fasteners and distance pieces: heads and caps, retaining rings, washers, spacers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from kinematics.message import compose
from service.parts.assembly.descriptions import name_material
from service.parts.assembly.model import Carrier, Part, Sort
from service.parts.assembly.sizes import Process, Sizes
from service.parts.assembly.standard_parts import find_washer, name_bar
from service.parts.geometry.regions import Region, make_ring
from service.parts.geometry.solids import Prism

PIN_COLOUR, FASTENER_COLOUR = "#c9ced4", "#3c444d"

MATERIALS: dict[Process, tuple[str, str]] = {
    "print": ("PETG", "PETG"),
    "laser": ("sheet", "steel"),
    "mill": ("aluminium", "steel"),
}
"""Materials of plates and of pins."""

Stack = list[tuple[float, float, float, float]]
"""Rings on top of one another: outer and inner radius, and the heights of their faces."""


def _make_prisms(
    place: complex, stack: Stack, shank: float, seats: Sequence[Prism], mirror: float | None
) -> tuple[Prism, ...]:
    """Make the solids of a stack; the shank has its keyed sections at the seats.

    ``mirror`` is the sum of the heights of a pin's ends if the stack is upside down, else None.
    """
    found: list[Prism] = []
    for outer, inner, z, end in stack:
        if mirror is not None:
            # Mirror about the middle of the pin.
            z, end = mirror - end, mirror - z
        region = make_ring(place, outer, inner)
        if outer == shank and inner == 0.0:
            for seat in seats:
                # Replace the cylinder by the keyed section at each seat.
                if z <= seat.low and seat.high <= end:
                    found += [Prism(region, z, seat.low), seat]
                    z = seat.high
        found.append(Prism(region, z, end))
    return tuple(body for body in found if body.high > body.low)


class PinShape(NamedTuple):
    """Deviations of a pin from a plain cylinder with a head below and a cap above.

    Attributes
    ----------
    seats : sequence of Prism
        Sections of the shank that are not cylindrical, in order of height.
    stub : float
        Length of the pin beyond its cap or upper ring.
    upside_down : bool
        Whether head, cap and stub are at opposite ends.
    """

    seats: Sequence[Prism] = ()
    stub: float = 0.0
    upside_down: bool = False


PLAIN_PIN = PinShape()


def make_pin(
    name: str,
    described: str,
    carrier: Carrier,
    place: complex,
    ends: tuple[float, float],
    planes: tuple[int, int],
    sizes: Sizes,
    shape: PinShape = PLAIN_PIN,
) -> list[Part]:
    """Make a pin with its head and its cap, or with a retaining ring at either end.

    Parameters
    ----------
    ends : pair of float
        Heights of the lowest and the highest face that it holds together.
    """
    low, high = ends
    seats, stub, upside_down = shape
    shank, top = 0.5 * sizes.pin, high + sizes.play
    steel = name_material(MATERIALS[sizes.process][1])
    mirror = low + high if upside_down else None

    def make_prisms(stack: Stack, cut: Sequence[Prism] = ()) -> tuple[Prism, ...]:
        return _make_prisms(place, stack, shank, cut, mirror)

    def make_round_part(part: str, what: str, bodies: tuple[Prism, ...], colour: str, standard: str = "") -> Part:
        return Part(
            f"{part}_{name}", what, "pin" if part == "pin" else "ring", carrier, bodies, 1.0 + 0.0j, planes, steel,
            colour, standard, round=part != "pin" or not seats,
        )  # fmt: skip

    if sizes.process == "print":
        head = 0.5 * sizes.collar
        stack = [(head, 0.0, low - sizes.cap, low), (shank, 0.0, low, top + sizes.cap + stub)]
        called = "cap_below" if upside_down else "cap"
        cap = [(head, shank, top, top + sizes.cap)]
        return [
            make_round_part("pin", described, make_prisms(stack, seats), PIN_COLOUR),
            make_round_part(called, compose("parts-pin-cap", pin=described), make_prisms(cap), FASTENER_COLOUR),
        ]
    retaining = sizes.ring
    groove, bottom = 0.5 * retaining.groove, low - retaining.width
    stack = [
        (shank, 0.0, bottom - retaining.beyond, bottom),
        (groove, 0.0, bottom, low),
        (shank, 0.0, low, top),
        (groove, 0.0, top, top + retaining.width),
        (shank, 0.0, top + retaining.width, top + retaining.width + retaining.beyond + stub),
    ]
    below = [(0.5 * retaining.diameter, groove, low - retaining.thickness, low)]
    above = [(0.5 * retaining.diameter, groove, top, top + retaining.thickness)]
    what = compose("parts-retaining-ring", pin=described)
    sides = ("ring_below", above if upside_down else below), ("ring_above", below if upside_down else above)
    rings = [
        make_round_part(side, what, make_prisms(ring), FASTENER_COLOUR, retaining.standard) for side, ring in sides
    ]
    return [make_round_part("pin", described, make_prisms(stack, seats), PIN_COLOUR, name_bar(sizes.pin)), *rings]


def make_fillers(
    name: str,
    carrier: Carrier,
    place: complex,
    gap: tuple[float, float],
    planes: tuple[int, int],
    sizes: Sizes,
    *,
    washers: bool = True,
) -> list[Part]:
    """Make washers in the gap between neighbouring planes, otherwise a spacer."""
    floor, ceiling = gap
    washer = find_washer(sizes.pin, sizes.width)
    own = f"{name}_{planes[0]}_{planes[1]}"
    pieces: list[tuple[str, float, float, str]] = []
    if washers and planes[1] == planes[0] + 1 and sizes.washers and washer is not None:
        pieces = [
            (f"washer_{own}_{n + 1}", floor + n * washer.thickness, floor + (n + 1) * washer.thickness, washer.standard)
            for n in range(sizes.washers)
        ]
    else:
        # No standard washer, or a wider gap: one spacer.
        pieces = [(f"spacer_{own}", floor, ceiling - sizes.play, "")]
    parts = []
    region: Region = make_ring(place, 0.5 * sizes.collar, 0.5 * sizes.hole)
    for called, low, high, standard in pieces:
        sort: Sort = "washer" if standard else "spacer"
        parts.append(
            Part(
                called,
                compose("parts-washer") if standard else compose("parts-spacer"),
                sort,
                carrier,
                (Prism(region, low, high),),
                1.0 + 0.0j,
                planes,
                name_material(MATERIALS[sizes.process][1]),
                FASTENER_COLOUR,
                standard,
                round=True,
            )
        )
    return parts
