"""An assembly of crossing shafts on one sheet: from above and from the front, notes, and the bill of materials.

Each part is drawn as the shadow of its mesh. Parts closer to the viewer are drawn later.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from service.parts.assembly.bill_of_materials import HEADER, list_row
from service.parts.assembly.items import Item
from service.parts.assembly.model import SHEET_SORTS, Assembly, Frame, Part
from service.render.page.blocks import TableRow, make_table
from service.render.page.sheet import BORDER, INNER_WIDTH, SHEET_WIDTH, TOP, draw_caption, draw_panel, write_sheet
from service.render.page.svg import Box, Element, Viewport, draw_line, draw_text, format_number, make_element
from service.render.page.symbols import GREY, INK, draw_scale_bar

if TYPE_CHECKING:
    from manifold3d import Manifold

VIEW_HEIGHT, MARGIN = 380.0, 30.0
"""Height of a view and its margin, pixels."""

LINE_LENGTH, LINE_HEIGHT, FONT_SIZE = 140, 16.0, 11.5
"""Characters per line of the notes, line height and font size, pixels."""

COLUMN_ENDS = (0.0, 0.25, 0.34, 0.42, 0.50, 0.58, 0.75, 0.86, 1.0)
"""Left end of the bill's names, and right ends of its other columns, shares of the width."""

AXIS_OVERHANG = 0.04
"""Extension of an axis line beyond its parts, as a share of the assembly's size."""

LEVEL_FRAME = Frame(np.zeros(3), np.eye(3))
"""The plane of the assembly."""


class View(NamedTuple):
    """A direction of view: unit vectors to the right, upwards, and towards the viewer."""

    words: str
    right: Real
    up: Real
    toward: Real

    def project(self, points: Real) -> Complex:
        """Project points in space, shape (n, 3), to the picture."""
        return np.asarray(points @ self.right + 1j * (points @ self.up))


X, Y, Z = np.eye(3)
VIEWS = (View("From above", X, Y, Z), View("From the front", X, Z, -Y))


def draw_crossing_sheet(assembly: Assembly, listed: Sequence[Item], title: str) -> str:
    """Draw the sheet as an SVG document.

    Parameters
    ----------
    assembly : Assembly
        An assembly with non-parallel axes.
    listed : sequence of Item
        Items of the assembly.
    title : str
        Title without characters that XML forbids.
    """
    words = f"{len(listed)} items, {len(assembly.parts)} parts on non-parallel shafts; lengths in millimetres"
    if assembly.scale != 1.0:
        words += f"; {assembly.scale:g} times the design"
    drawn, y = [], TOP
    for view in VIEWS:
        panel, y = _draw_view(assembly, view, y)
        drawn += panel
        y += 16.0
    told = [piece for note in assembly.notes for piece in textwrap.wrap(note, LINE_LENGTH)]
    for piece in told:
        y += LINE_HEIGHT
        drawn.append(draw_text(BORDER, y, piece, FONT_SIZE, fill=INK))
    bill, y = make_table(
        "Bill of materials", [*HEADER], [TableRow(list_row(item)) for item in listed], COLUMN_ENDS, worded=0
    )(BORDER, y + 14.0, INNER_WIDTH)
    described = f"Views from above and from the front of an assembly of {len(assembly.parts)} parts; bill of materials."
    return write_sheet(title, words, described, [*drawn, bill], y)


def _draw_view(assembly: Assembly, view: View, top: float) -> tuple[list[Element], float]:
    panel = Box(BORDER, top, SHEET_WIDTH - BORDER, top + VIEW_HEIGHT)
    axes = np.array([view.right, view.up, view.toward])
    seen = {part.name: _turn_mesh(part, assembly.frames.get(part.name, LEVEL_FRAME), axes) for part in assembly.parts}
    bounds = np.array([mesh.bounding_box() for mesh in seen.values()])
    (left, low), (right, high) = bounds[:, :2].min(axis=0), bounds[:, 3:5].max(axis=0)
    port = Viewport.fit(Box(left, low, right, high), panel, MARGIN, 16.0)
    shapes: list[Element] = []
    # Painter's algorithm: the nearest part is drawn last.
    for part in sorted(assembly.parts, key=lambda part: float(seen[part.name].bounding_box()[5])):
        d = "".join(_format_path(contour, port) for contour in seen[part.name].project().to_polygons())
        shapes.append(
            make_element("path", d=d, fill=part.colour, fill_opacity=0.82 if part.sort in SHEET_SORTS else 1.0,
                    fill_rule="evenodd", stroke=INK, stroke_width=0.7, data_part=part.name)
        )  # fmt: skip
    bar, _ = draw_scale_bar(port, "mm")
    return [
        draw_panel(panel, view.words),
        draw_caption(panel, view.words),
        *shapes,
        *_draw_axes(assembly, view, port),
        bar,
    ], panel.high


def _turn_mesh(part: Part, frame: Frame, axes: Real) -> Manifold:
    """Return the mesh of a part in its frame, seen along the last of the axes."""
    return part.mesh.transform(np.column_stack([axes @ frame.axes, axes @ frame.origin]))


def _draw_axes(assembly: Assembly, view: View, port: Viewport) -> list[Element]:
    """Draw lines along the shafts, unless they are seen end-on."""
    lines = []
    for pin in (part for part in assembly.parts if part.sort == "pin"):
        frame = assembly.frames.get(pin.name, LEVEL_FRAME)
        beyond = AXIS_OVERHANG * assembly.size
        ends = [frame.origin + height * frame.axes[:, 2] for height in (pin.low - beyond, pin.high + beyond)]
        start, end = (port.point(complex(z)) for z in view.project(np.array(ends)))
        if abs(end - start) > 1.0:
            lines.append(draw_line(start, end, stroke=GREY, stroke_width=0.7, stroke_dasharray="9 3 2 3"))
    return lines


def _format_path(contour: Real, port: Viewport) -> str:
    points = port.points(contour @ np.array([1.0, 1.0j]))
    return "M" + "L".join(f"{format_number(z.real)} {format_number(z.imag)}" for z in points.tolist()) + "Z"
