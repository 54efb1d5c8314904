"""The bill of materials of an assembly as a table."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from service.parts.assembly.items import Item
from service.parts.assembly.model import Part
from service.parts.geometry.regions import Disc, Loop, Outline, measure_extent
from service.render.page.table import write_table

SLOT_CORNERS = 4
"""Number of corners of a slot with round ends, and of a bore with a keyway."""

HEADER = ("part", "quantity", "material", "length", "width", "thickness", "holes", "plane", "standard", "mass")


def write_bill(listed: Sequence[Item]) -> str:
    """Write the items as a CSV table with lengths in millimetres.

    The length of a round item is its axial length, and its width is its diameter. The mass of one item is given, in the
    answer's unit of mass, if the answer contains the density.
    """
    return write_table(HEADER, [list_row(item) for item in listed])


def list_row(item: Item) -> list[str]:
    """Return the table row of an item, in the order of :data:`HEADER`."""
    part = item.part
    length, width = part.length_and_width
    sizes = (length, width, part.high - part.low)
    if part.sort == "pin":
        # Pins are measured along their axis.
        sizes = (part.high - part.low, width, width)
    extents = [format_millimetres(size) for size in sizes]
    mass = "" if part.mass is None else f"{part.mass:.9g}"
    return [
        item.name,
        str(len(item.parts)),
        part.material,
        *extents,
        describe_holes(part),
        item.planes,
        part.standard,
        mass,
    ]


def describe_holes(part: Part) -> str:
    """List the holes of a part: diameters, width and length of slots, and extents of other shapes."""
    round_ones = Counter(format_millimetres(2.0 * hole.radius) for hole in part.region.holes if isinstance(hole, Disc))
    described = [f"{count} x {diameter}" for diameter, count in round_ones.items()]
    shaped = Counter(_describe_shape(hole) for hole in part.region.holes if not isinstance(hole, Disc))
    described += [words if count == 1 else f"{count} x {words}" for words, count in shaped.items()]
    return "; ".join(described)


def format_millimetres(value: float) -> str:
    """Format a length to a thousandth of a millimetre."""
    return f"{value:.3f}".rstrip("0").rstrip(".")


def _describe_shape(outline: Outline) -> str:
    along, what = 1.0 + 0.0j, "contour"
    # A keyed bore has one arc, a slot two.
    arcs = sum(1 for _, _, bulge in outline.iterate_edges() if bulge) if isinstance(outline, Loop) else 0
    if isinstance(outline, Loop) and len(outline.corners) == SLOT_CORNERS and arcs == 1:
        what = "bore with keyway"
        # The arc of the bore runs from one side of the keyway to the other; the chord back gives the direction.
        start, end, _ = next(edge for edge in outline.iterate_edges() if edge[2])
        along = (start - end) / abs(start - end) / 1j
    elif isinstance(outline, Loop) and len(outline.corners) == SLOT_CORNERS and min(outline.bulges) >= 0.0:
        start, end, _ = max(outline.iterate_edges(), key=lambda edge: abs(edge[1] - edge[0]) if edge[2] == 0.0 else 0.0)
        along, what = (end - start) / abs(end - start), "slot"
    (low, high), (left, right) = measure_extent(outline, along), measure_extent(outline, 1j * along)
    return f"{what} {format_millimetres(right - left)} x {format_millimetres(high - low)}"
