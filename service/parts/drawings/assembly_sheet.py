"""The assembly on one sheet: its planes as an exploded side view to scale, the plan view, and the bill of materials.

The side view looks along the base in the direction in which the pins are most widely spaced. Each plane and each gap
between two planes is drawn at its true height, separated by equal spaces; the pins are above, in true length, on the
axes through everything they hold.
"""

from __future__ import annotations

import cmath
import math
from collections import Counter
from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from service.parts.assembly.bill_of_materials import HEADER, format_millimetres, list_row
from service.parts.assembly.items import Item
from service.parts.assembly.model import SHEET_SORTS, Assembly, Part
from service.parts.geometry.regions import Disc, Outline, make_polygon, measure_extent
from service.render.page.blocks import TableRow, make_table
from service.render.page.numbers import format_angle
from service.render.page.sheet import BORDER, INNER_WIDTH, SHEET_WIDTH, TOP, draw_caption, draw_panel, write_sheet
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    draw_line,
    draw_text,
    estimate_text_width,
    format_number,
    make_element,
)
from service.render.page.symbols import GREY, INK, draw_scale_bar

DIRECTION_COUNT = 36
"""Number of trial directions of the side view."""

MIN_LAYER_GAP, LINE_HEIGHT = 20.0, 13.5
"""Minimum space between two layers of the side view, and line spacing of their names, pixels."""

SIDE_VIEW_SHARE = 0.56
"""Width of the drawn part of the side view, next to the names, as a share of the sheet's."""

MAX_LAYERS_HEIGHT = 700.0
"""Maximum height of layers and pins in the side view, without the space between them, pixels."""

PLAN_HEIGHT = 420.0
"""Height of the plan view, pixels."""

MARGIN, FONT_SIZE = 26.0, 10.5

COLUMN_ENDS = (0.0, 0.25, 0.34, 0.42, 0.50, 0.58, 0.75, 0.86, 1.0)
"""Left end of the bill's names, and right ends of its other columns, shares of the width."""


class Layer(NamedTuple):
    """A plane, or the gap above it: its parts, and its lowest height."""

    name: str
    parts: tuple[Part, ...]
    low: float

    @property
    def height(self) -> float:
        """Height up to the highest part."""
        return max(part.high for part in self.parts) - self.low


def draw_assembly_sheet(assembly: Assembly, listed: Sequence[Item], title: str) -> str:
    """Draw the sheet as an SVG document.

    Parameters
    ----------
    assembly : Assembly
    listed : sequence of Item
        Items of the assembly.
    title : str
        Title without characters that XML forbids.
    """
    count = f"{assembly.planes} {'plane' if assembly.planes == 1 else 'planes'}"
    bases = "one base" if assembly.sides == 1 else "two bases"
    words = f"{len(listed)} items, {len(assembly.parts)} parts in {count} on {bases}; lengths in millimetres"
    if assembly.scale != 1.0:
        words += f"; {assembly.scale:g} times the design"
    side, y = _draw_side_view(assembly, TOP)
    plan, y = _draw_plan(assembly, y + 16.0)
    bill, y = _draw_bill(listed, y + 10.0)
    described = f"Exploded side view and plan view of an assembly of {len(assembly.parts)} parts; bill of materials."
    return write_sheet(title, words, described, [*side, *plan, bill], y)


def _draw_bill(listed: Sequence[Item], top: float) -> tuple[Element, float]:
    lines = [TableRow(list_row(item)) for item in listed]
    heads = [*HEADER]
    return make_table("Bill of materials", heads, lines, COLUMN_ENDS, worded=0)(BORDER, top, INNER_WIDTH)


# The side view


def group_layers(assembly: Assembly) -> list[Layer]:
    """Group all parts except pins by planes and gaps, from below."""
    found: dict[tuple[int, int], list[Part]] = {}
    for part in assembly.parts:
        if part.sort == "pin":
            continue
        plane, gap = part.planes[0], 1
        if part.sort in SHEET_SORTS or part.sort == "key":
            gap = 0
        elif part.sort == "ring":
            # Rings are above the highest plane of their pin, or below the lowest.
            above = part.name.startswith(("ring_above", "cap")) and not part.name.startswith("cap_below")
            plane = part.planes[1] if above else part.planes[0] - 1
        found.setdefault((plane, gap), []).append(part)
    made = []
    for (plane, gap), parts in sorted(found.items()):
        name = "" if gap else assembly.name_plane(plane)
        made.append(Layer(name, tuple(parts), min(part.low for part in parts)))
    return made


def find_view_direction(assembly: Assembly) -> complex:
    """Return the horizontal direction of the side view in which the pins are most widely spaced."""
    places = sorted(
        {_get_centre(part) for part in assembly.parts if part.sort == "pin"}, key=lambda z: (z.real, z.imag)
    )
    if len(places) < 2:
        return 1.0 + 0.0j

    def measure_spacing(direction: complex) -> float:
        along = [(z * direction.conjugate()).real for z in places]
        return min(abs(a - b) for a, b in combinations(along, 2))

    # Half a turn covers all directions of a side view.
    turns = [cmath.exp(1j * math.pi * (k - DIRECTION_COUNT // 2) / DIRECTION_COUNT) for k in range(DIRECTION_COUNT)]
    # Sorting prefers directions near x among equally good ones.
    return max(sorted(turns, key=lambda turn: abs(cmath.phase(turn))), key=measure_spacing)


def _get_centre(part: Part) -> complex:
    outer = part.region.outer
    assert isinstance(outer, Disc)
    return outer.centre


def _draw_side_view(assembly: Assembly, top: float) -> tuple[list[Element], float]:
    direction = find_view_direction(assembly)
    spans = [measure_extent(part.region.outer, direction) for part in assembly.parts]
    left, right = min(low for low, _ in spans), max(high for _, high in spans)
    stacked, pins = (
        group_layers(assembly),
        _arrange_rows([part for part in assembly.parts if part.sort == "pin"], direction),
    )
    rows = [max(part.high - part.low for part in pins_row) for pins_row in pins]
    heights = sum(layer.height for layer in stacked) + sum(rows)
    # Limited by the width and by the height of the sheet.
    scale = min((SIDE_VIEW_SHARE * INNER_WIDTH - 2.0 * MARGIN) / (right - left), MAX_LAYERS_HEIGHT / heights)
    x0 = BORDER + MARGIN + 0.5 * (SIDE_VIEW_SHARE * INNER_WIDTH - 2.0 * MARGIN - scale * (right - left)) - scale * left
    names = BORDER + SIDE_VIEW_SHARE * INNER_WIDTH + 8.0
    drawn: list[Element] = []
    y = top + 34.0
    tops: dict[str, float] = {}
    for pins_row, height in zip(pins, rows, strict=True):
        y += 14.0
        for pin in pins_row:
            x = x0 + scale * (_get_centre(pin) * direction.conjugate()).real
            base = y + scale * height
            tops[pin.name] = base
            drawn += _draw_pin(pin, x, base, scale)
            drawn.append(draw_text(x, base - scale * (pin.high - pin.low) - 4.0, _name_pin(pin), FONT_SIZE,
                              text_anchor="middle", fill=INK))  # fmt: skip
        y += scale * height
    ends: dict[complex, float] = {}
    views: list[Element] = []
    for layer in reversed(stacked):
        told = _describe_layer(layer)
        needed = max(scale * layer.height, LINE_HEIGHT * len(told))
        y += MIN_LAYER_GAP
        bottom = y + 0.5 * (needed + scale * layer.height)
        for part in sorted(layer.parts, key=lambda part: part.sort in ("block", "key")):
            views += _draw_from_side(part, layer, direction, x0, bottom, scale)
            if part.round:
                ends[_get_centre(part)] = bottom
        reach = max(measure_extent(part.region.outer, direction)[1] for part in layer.parts)
        at = bottom - 0.5 * scale * layer.height
        views.append(
            draw_line(
                complex(x0 + scale * reach + 4.0, at), complex(names - 5.0, at), stroke="#d5dade", stroke_width=0.8
            )
        )
        views += _write_lines(told, names, at)
        y += needed
    axes = [
        draw_line(
            complex(x, tops[pin.name]), complex(x, max(ends.get(_get_centre(pin), y), tops[pin.name]) + 6.0),
            stroke=GREY, stroke_width=0.7, stroke_dasharray="9 3 2 3",
        )
        for pins_row in pins for pin in pins_row
        for x in (x0 + scale * (_get_centre(pin) * direction.conjugate()).real,)
    ]  # fmt: skip
    panel = Box(BORDER, top, SHEET_WIDTH - BORDER, y + 40.0)
    bar, _ = draw_scale_bar(Viewport(panel, 0j, 0j, scale), "mm")
    seen = f"Exploded side view, the horizontal at {format_angle(math.degrees(cmath.phase(direction)), 0)} to x"
    return [draw_panel(panel, "side"), draw_caption(panel, seen), *views, *axes, *drawn, bar], panel.high


def _write_lines(lines: Sequence[tuple[str, str]], x: float, middle: float) -> list[Element]:
    """Write lines, each with its font weight, one below the other about a height."""
    first = middle - 0.5 * LINE_HEIGHT * (len(lines) - 1) + 0.35 * FONT_SIZE
    return [
        draw_text(x, first + n * LINE_HEIGHT, words, FONT_SIZE, fill=INK, font_weight=weight)
        for n, (words, weight) in enumerate(lines)
    ]


def _arrange_rows(pins: Sequence[Part], direction: complex) -> list[list[Part]]:
    """Arrange pins that would hide one another from the side in rows; the longest row is last."""
    rows: list[list[Part]] = []
    for pin in sorted(pins, key=lambda pin: pin.low - pin.high):
        low, high = measure_extent(pin.region.outer, direction)
        for row_ in rows:
            if all(high < a or b < low for a, b in (measure_extent(other.region.outer, direction) for other in row_)):
                row_.append(pin)
                break
        else:
            rows.append([pin])
    return rows[::-1]


def _draw_pin(pin: Part, x: float, base: float, scale: float) -> list[Element]:
    """Draw a pin upright on a base line, from its bodies."""
    shapes = []
    for body in pin.bodies:
        region, low, high = body.region, body.low, body.high
        low_end, high_end = measure_extent(region.outer, 1.0 + 0.0j)
        radius = scale * (region.outer.radius if isinstance(region.outer, Disc) else 0.5 * (high_end - low_end))
        shapes.append(
            _draw_rectangle(x - radius, base - scale * (high - pin.low), 2.0 * radius, scale * (high - low), pin.colour)
        )
    return shapes


def _draw_from_side(
    part: Part, layer: Layer, direction: complex, x0: float, bottom: float, scale: float
) -> list[Element]:
    """Draw a part as rectangles, with the hidden edges of its holes."""
    shapes = []
    for body in part.bodies:
        region, low, high = body.region, body.low, body.high
        left, right = (x0 + scale * end for end in measure_extent(region.outer, direction))
        y, height = bottom - scale * (high - layer.low), scale * (high - low)
        shapes.append(_draw_rectangle(left, y, right - left, height, part.colour))
        for hole in region.holes:
            for edge in measure_extent(hole, direction):
                x = x0 + scale * edge
                shapes.append(draw_line(complex(x, y), complex(x, y + height), stroke="#fff", stroke_width=0.8,
                                   stroke_dasharray="2.5 1.8"))  # fmt: skip
    return shapes


def _draw_rectangle(x: float, y: float, width: float, height: float, fill: str) -> Element:
    return make_element("rect", x=x, y=y, width=width, height=height, fill=fill, stroke=INK, stroke_width=0.7)


def _describe_layer(layer: Layer) -> list[tuple[str, str]]:
    """Return the lines of text next to a layer, with their font weights."""
    plates = [part for part in layer.parts if part.sort in SHEET_SORTS]
    if plates:
        told = []
        for part in sorted(plates, key=lambda part: part.sort == "block"):
            where = "" if part.sort == "base" else f"{layer.name}: "
            thickness = format_millimetres(part.bodies[0].high - part.bodies[0].low)
            told.append((f"{where}{part.described}, {thickness} thick", "bold" if part.sort != "block" else "normal"))
        return told
    counted = Counter(_describe_item(part) for part in layer.parts)
    lines: list[str] = []
    for (what, size), count in sorted(counted.items()):
        words = f"{count} {what}{'s' * (count > 1)} {size}"
        if (
            lines
            and estimate_text_width(f"{lines[-1]}, {words}", FONT_SIZE)
            < (1.0 - SIDE_VIEW_SHARE) * INNER_WIDTH - 2.0 * MARGIN
        ):
            lines[-1] += f", {words}"
        else:
            lines.append(words)
    return [(words, "normal") for words in lines]


def _describe_item(part: Part) -> tuple[str, str]:
    """Return the name of a part on a pin, and its standard or its height."""
    return part.name.split("_")[0], part.standard or f"{format_millimetres(part.high - part.low)} high"


# Plan view


def _draw_plan(assembly: Assembly, top: float) -> tuple[list[Element], float]:
    panel = Box(BORDER, top, SHEET_WIDTH - BORDER, top + PLAN_HEIGHT)
    rings = [make_polygon(part.region.outer, beyond=True) for part in assembly.parts]
    view = Viewport.fit(Box.enclose(np.concatenate(rings)), panel, MARGIN + 12.0, 16.0)
    shapes = []
    for part in sorted(assembly.parts, key=lambda part: part.high):
        d = "".join(_format_path(outline, view) for outline in (part.region.outer, *part.region.holes))
        # A second base, above all else, is transparent.
        opacity = 0.0 if part.sort == "base" and part.planes[0] else 0.82 if part.sort in SHEET_SORTS else 1.0
        shapes.append(
            make_element("path", d=d, fill=part.colour, fill_opacity=opacity, fill_rule="evenodd", stroke=INK,
                    stroke_width=0.7, data_part=part.name)
        )  # fmt: skip
    names: list[Element] = []
    taken: list[Box] = []
    for part in assembly.parts:
        if part.sort == "pin" and (_name_pin(part) != part.described or part.described.endswith("shaft")):
            at, words = view.point(_get_centre(part)), _name_pin(part)
            radius = 0.5 * view.scale * part.length_and_width[0]
            box = _place_name(at, radius, estimate_text_width(words, 11.5), taken)
            taken.append(box)
            names.append(
                make_element(
                    "rect", x=box.left, y=box.low, width=box.width, height=box.height, fill="#fff", fill_opacity=0.8
                )
            )
            names.append(draw_text(box.left + 2.0, box.high - 3.0, words, 11.5, fill=INK, font_weight="bold"))
    bar, _ = draw_scale_bar(view, "mm")
    return [
        draw_panel(panel, "above"),
        draw_caption(panel, "From above, in the reference configuration"),
        *shapes,
        *names,
        bar,
    ], panel.high


def _name_pin(pin: Part) -> str:
    """Return the name of a pin or shaft: that of its joint if it has one."""
    named = pin.described.startswith(("pin ", "shaft ")) and not pin.described.startswith("shaft of ")
    return pin.described.partition(" ")[2] if named else pin.described


def _place_name(at: complex, radius: float, width: float, taken: Sequence[Box]) -> Box:
    """Return the box of a name next to a pin: above right, or at the next free corner."""
    beyond = radius + 4.0
    corners = [
        Box(left, low, left + width + 4.0, low + 13.0)
        for left, low in (
            (at.real + beyond, at.imag - beyond - 10.0), (at.real - beyond - width - 4.0, at.imag - beyond - 10.0),
            (at.real - beyond - width - 4.0, at.imag + beyond - 3.0), (at.real + beyond, at.imag + beyond - 3.0),
        )
    ]  # fmt: skip
    # Take the first free corner, or overlap at the preferred one.
    free = (box for box in corners if not any(_is_overlapping(box, other) for other in taken))
    return next(free, corners[0])


def _is_overlapping(one: Box, other: Box) -> bool:
    return one.left < other.right and other.left < one.right and one.low < other.high and other.low < one.high


def _format_path(outline: Outline, view: Viewport) -> str:
    points = view.points(make_polygon(outline, beyond=True))
    return "M" + "L".join(f"{format_number(z.real)} {format_number(z.imag)}" for z in points.tolist()) + "Z"
