"""Plates in planes, and the parts on the pins and shafts that join them.

The upper face of plane k is at k pitches, its lower face one thickness below; the base is plane 0. A shaft rotates with
the plates keyed to it, and protrudes below the base, where it is driven or drives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from kinematics.message import compose
from service.parts.assembly.colours import BASE_COLOUR
from service.parts.assembly.descriptions import describe_identifier, name_material
from service.parts.assembly.fasteners import FASTENER_COLOUR, MATERIALS, PinShape, make_fillers, make_pin
from service.parts.assembly.keys import find_key, make_bore, make_key_section, make_shaft_section
from service.parts.assembly.model import Carrier, Part, Sort
from service.parts.assembly.sizes import Sizes
from service.parts.geometry.regions import Outline, Region, make_ring
from service.parts.geometry.solids import Prism

COLLAR_RATIO = 1.4
"""Diameter of rings and spacers in shaft diameters, on shafts whose diameter differs from the pins'."""

STUB_LENGTH = 1.5
"""Length of a shaft beyond its support, in shaft diameters."""

GROUND_CARRIER = Carrier("ground", None)
"""Carrier of the base."""


class PlateStack:
    """Planes of one pitch for pins and shafts of given sizes.

    Parameters
    ----------
    sizes : Sizes
        Sizes of plates and pins.
    shafts : sequence of float
        Diameters of shafts that differ from the pins.
    """

    def __init__(self, sizes: Sizes, shafts: Sequence[float]) -> None:
        self.sizes = sizes
        self._gap = max([sizes.gap, *(self.get_sizes(diameter).gap for diameter in shafts)])

    def get_sizes(self, diameter: float) -> Sizes:
        """Return the sizes of parts on a pin or shaft of a diameter."""
        if diameter == self.sizes.pin:
            return self.sizes
        return replace(self.sizes, pin=diameter, width=COLLAR_RATIO * diameter)

    def get_level(self, plane: int) -> tuple[float, float]:
        """Return the heights of a plane's lower and upper face."""
        top = plane * (self.sizes.thickness + self._gap)
        return top - self.sizes.thickness, top

    def make_plate(
        self, name: str, described: str, sort: Sort, carrier: Carrier, region: Region, plane: int, colour: str,
        along: complex = 1.0 + 0.0j,
    ) -> Part:  # fmt: skip
        """Make a plate in a plane."""
        material = name_material(MATERIALS[self.sizes.process][0])
        body = Prism(region, *self.get_level(plane))
        return Part(name, described, sort, carrier, (body,), along, (plane, plane), material, colour)

    def make_base(
        self, name: str, outer: Outline, cuts: Sequence[Outline], bosses: Sequence[tuple[complex, float, int]],
        plane: int = 0, along: complex = 1.0 + 0.0j,
    ) -> Part:  # fmt: skip
        """Make a base; a printed one has bosses around its shafts, given by place, diameter and nearest plane."""
        low, high = self.get_level(plane)
        bodies = [Prism(Region(outer, tuple(cuts)), low, high)]
        if self.sizes.process == "print":
            for place, diameter, nearest in bosses:
                sizes = self.get_sizes(diameter)
                region = make_ring(place, 0.5 * sizes.collar, 0.5 * sizes.hole)
                # Bosses replace spacers; a play remains to the next plate.
                if nearest > plane:
                    bodies.append(Prism(region, high, self.get_level(nearest)[0] - sizes.play))
                else:
                    bodies.append(Prism(region, self.get_level(nearest)[1] + sizes.play, low))
        material = name_material(MATERIALS[self.sizes.process][0])
        return Part(
            name,
            describe_identifier(name),
            "base",
            GROUND_CARRIER,
            tuple(bodies),
            along,
            (plane, plane),
            material,
            BASE_COLOUR,
        )

    def make_pin(
        self, name: str, described: str, carrier: Carrier, place: complex, levels: Sequence[int], *,
        diameter: float | None = None, keyed: Sequence[int] = (), stub: int = 0,
    ) -> list[Part]:  # fmt: skip
        """Make a pin with its fasteners at both ends; for a shaft also its keys.

        Parameters
        ----------
        levels : sequence of int
            The lowest and the highest plane that it holds.
        keyed : sequence of int
            Planes of the plates that are keyed to it.
        stub : {-1, 0, 1}
            Whether it protrudes below (-1) or above (1) for the drive.
        """
        sizes = self.get_sizes(self.sizes.pin if diameter is None else diameter)
        key = find_key(sizes.pin)
        # From the lower face of the lowest plate to the upper face of the highest.
        ends = self.get_level(min(levels))[0], self.get_level(max(levels))[1]
        section = Region(make_shaft_section(place, sizes.pin, key))
        seats = [Prism(section, *self.get_level(plane)) for plane in sorted(keyed)]
        shape = PinShape(seats, STUB_LENGTH * sizes.pin if stub else 0.0, stub < 0)
        parts = make_pin(name, described, carrier, place, ends, (min(levels), max(levels)), sizes, shape)
        steel, seated = name_material(MATERIALS[self.sizes.process][1]), Region(make_key_section(place, sizes.pin, key))
        for plane in keyed:
            bodies = (Prism(seated, *self.get_level(plane)),)
            designation = key.standard and f"{key.standard} x {self.sizes.thickness:g}"
            parts.append(
                Part(
                    f"key_{name}_{plane}",
                    compose("parts-key"),
                    "key",
                    carrier,
                    bodies,
                    1.0 + 0.0j,
                    (plane, plane),
                    steel,
                    FASTENER_COLOUR,
                    designation,
                )
            )
        return parts

    def make_fillers(
        self, name: str, carrier: Carrier, place: complex, spans: Sequence[tuple[int, int]],
        diameter: float | None = None,
    ) -> list[Part]:  # fmt: skip
        """Make washers in the gaps between neighbouring planes, and spacers through planes that are passed."""
        sizes, parts = self.get_sizes(self.sizes.pin if diameter is None else diameter), []
        for lower, upper in spans:
            gap = self.get_level(lower)[1], self.get_level(upper)[0]
            parts += make_fillers(name, carrier, place, gap, (lower, upper), sizes, washers=sizes.gap == self._gap)
        return parts

    def make_bore(self, place: complex, diameter: float | None = None) -> Outline:
        """Return the bore of a plate that is keyed to a shaft."""
        pin = self.sizes.pin if diameter is None else diameter
        return make_bore(place, pin, find_key(pin), self.sizes.clearance)

    def measure_hub(self, diameter: float) -> float:
        """Return the distance from the axis that the bore for a shaft and its key reaches."""
        return 0.5 * diameter + find_key(diameter).in_hub + self.sizes.clearance
