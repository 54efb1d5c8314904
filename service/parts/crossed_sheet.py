"""An assembly of crossing shafts on one sheet: from above and from the front, what is to be known of it, and the bill.

A body seen along its axis is its region, and at right angles to it its height and what it is wide; seen from elsewhere
it is the hull of its ends. What is nearer to the viewer is drawn later.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from service.parts.bodies import Body, Tapered, Turned
from service.parts.bom import HEADER, row
from service.parts.carved import Carved
from service.parts.items import Item
from service.parts.model import FLAT, Assembly, Frame, Part
from service.parts.shapes import extent, ring_of
from service.render.page.blocks import Line, table
from service.render.page.sheet import EDGE, FULL, TOP, WIDTH, caption, framed, sheet
from service.render.page.svg import Box, Element, Viewport, element, line, number, text
from service.render.page.symbols import GREY, INK, scale_bar

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

HEIGHT, MARGIN = 380.0, 30.0
"""Height of a view, and what is left free in it, pixels."""

LETTERS, LEADING, SMALL = 140, 16.0, 11.5
"""Of a line of what is to be known, its height and that of its letters, pixels."""

ENDS = (0.0, 0.25, 0.34, 0.42, 0.50, 0.58, 0.75, 0.86, 1.0)
"""Where the names of the bill begin, and the right ends of its other columns, shares of the width."""

SQUARE = 1e-9
"""Cosine below which an axis is at right angles to the view."""

BEYOND = 0.04
"""By how much the line of an axis is longer than what is on it, as a share of the assembly's size."""

LEVEL = Frame(np.zeros(3), np.eye(3))
"""The plane of the assembly."""


class View(NamedTuple):
    """A direction of view: what is to the right, what is upwards, and what points to the viewer, of length 1."""

    words: str
    right: Real
    up: Real
    toward: Real

    def seen(self, points: Real) -> Complex:
        """Places of the picture of points in space, shape (n, 3)."""
        return np.asarray(points @ self.right + 1j * (points @ self.up))


X, Y, Z = np.eye(3)
VIEWS = (View("From above", X, Y, Z), View("From the front", X, Z, -Y))


def crossed_sheet(assembly: Assembly, listed: Sequence[Item], title: str) -> str:
    """The sheet as an SVG document.

    Parameters
    ----------
    assembly : Assembly
        In which not all axes are parallel.
    listed : sequence of Item
        Its items.
    title : str
        Without characters that XML forbids.
    """
    words = f"{len(listed)} items, {len(assembly.parts)} parts on shafts that are not parallel; lengths in millimetres"
    if assembly.scale != 1.0:
        words += f"; {assembly.scale:g} times the design"
    drawn, y = [], TOP
    for view in VIEWS:
        panel, y = _view(assembly, view, y)
        drawn += panel
        y += 16.0
    told = [piece for note in assembly.notes for piece in textwrap.wrap(note, LETTERS)]
    for piece in told:
        y += LEADING
        drawn.append(text(EDGE, y, piece, SMALL, fill=INK))
    bill, y = table("Bill of materials", [*HEADER], [Line(row(item)) for item in listed], ENDS, worded=0)(
        EDGE, y + 14.0, FULL
    )
    described = f"Views from above and from the front of an assembly of {len(assembly.parts)} parts, and their bill."
    return sheet(title, words, described, [*drawn, bill], y)


def _view(assembly: Assembly, view: View, top: float) -> tuple[list[Element], float]:
    panel = Box(EDGE, top, WIDTH - EDGE, top + HEIGHT)
    frames = {part.name: assembly.frames.get(part.name, LEVEL) for part in assembly.parts}
    seen = {part.name: [_shadow(body, frames[part.name], view) for body in part.bodies] for part in assembly.parts}
    bounds = np.array([shape.bounds for shapes in seen.values() for shape in shapes])
    (left, low), (right, high) = bounds[:, :2].min(axis=0), bounds[:, 2:].max(axis=0)
    port = Viewport.fit(Box(left, low, right, high), panel, MARGIN, 16.0)
    shapes: list[Element] = []
    for part in sorted(assembly.parts, key=lambda part: _nearest(part, frames[part.name], view)):
        whole = shapely.union_all(seen[part.name])
        d = "".join(_path(ring, port) for face in shapely.get_parts(whole) for ring in (face.exterior, *face.interiors))
        shapes.append(
            element("path", d=d, fill=part.colour, fill_opacity=0.82 if part.sort in FLAT else 1.0,
                    fill_rule="evenodd", stroke=INK, stroke_width=0.7, data_part=part.name)
        )  # fmt: skip
    bar, _ = scale_bar(port, "mm")
    return [
        framed(panel, view.words),
        caption(panel, view.words),
        *shapes,
        *_axes(assembly, view, port),
        bar,
    ], panel.high


def _axes(assembly: Assembly, view: View, port: Viewport) -> list[Element]:
    """Lines along the shafts, where they are not seen from their ends."""
    lines = []
    for pin in (part for part in assembly.parts if part.sort == "pin"):
        frame = assembly.frames.get(pin.name, LEVEL)
        beyond = BEYOND * assembly.size
        ends = [frame.origin + height * frame.axes[:, 2] for height in (pin.low - beyond, pin.high + beyond)]
        start, end = (port.point(complex(z)) for z in view.seen(np.array(ends)))
        if abs(end - start) > 1.0:
            lines.append(line(start, end, stroke=GREY, stroke_width=0.7, stroke_dasharray="9 3 2 3"))
    return lines


def _shadow(body: Body, frame: Frame, view: View) -> shapely.Geometry:
    """What a body covers of the picture."""
    normal, region = frame.axes[:, 2], body.region
    if abs(float(normal @ view.toward)) > 1.0 - SQUARE:
        outer, *holes = (_placed(ring_of(outline, beyond=True), 0.0, frame, view)
                         for outline in (region.outer, *region.holes))  # fmt: skip
        return shapely.Polygon(outer, holes)
    if abs(float(normal @ view.toward)) < SQUARE:
        across = np.cross(view.toward, normal)
        direction = complex(across @ frame.axes[:, 0], across @ frame.axes[:, 1])
        if isinstance(body, Turned | Tapered | Carved):
            around = (
                ring_of(body.profile, beyond=True)
                if isinstance(body, Carved)
                else np.array(body.profile, np.complex128)
            )
            middle = 0.0 if isinstance(body, Carved) else (body.centre * direction.conjugate()).real
            halves = [
                shapely.Polygon(
                    _placed(np.asarray(direction * (middle + side * around.real)), around.imag, frame, view)
                )
                for side in (1.0, -1.0)
            ]
            return shapely.union_all(halves)
        low, high = extent(region.outer, direction)
        ends = np.array([low, high, high, low]) * direction
        return shapely.Polygon(_placed(ends, np.array([body.low, body.low, body.high, body.high]), frame, view))
    around = ring_of(region.outer, beyond=True)
    both = np.concatenate([_placed(around, height, frame, view) for height in (body.low, body.high)])
    return shapely.convex_hull(shapely.MultiPoint(both))


def _placed(places: Complex, heights: float | Real, frame: Frame, view: View) -> Real:
    """Places of a plane at heights as the view has them, shape (n, 2)."""
    local = np.stack([places.real, places.imag, np.broadcast_to(heights, places.shape)], axis=-1)
    seen = view.seen(frame.origin + local @ frame.axes.T)
    return np.column_stack([seen.real, seen.imag])


def _nearest(part: Part, frame: Frame, view: View) -> float:
    """How near to the viewer a part comes."""
    outer = ring_of(part.region.outer, beyond=True)
    near = []
    for height in (part.low, part.high):
        local = np.stack([outer.real, outer.imag, np.full(outer.shape, height)], axis=-1)
        near.append(float(((frame.origin + local @ frame.axes.T) @ view.toward).max()))
    return max(near)


def _path(ring: shapely.LinearRing, port: Viewport) -> str:
    points = port.points(shapely.get_coordinates(ring) @ np.array([1.0, 1.0j]))
    return "M" + "L".join(f"{number(z.real)} {number(z.imag)}" for z in points.tolist()) + "Z"
