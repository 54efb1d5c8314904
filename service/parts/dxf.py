"""The outline of a flat part with its holes as a DXF drawing in millimetres, for a laser cutter or a router.

Everything is on the layer CUT: outlines and slots are closed polylines whose round ends are true arcs, holes are
circles, smooth contours splines. The part lies along x, with its lowest and leftmost points on the axes.

For a part cut into a round bar the drawing is its development, seen from outside: the outline on CUT, and lines as
splines on layers of their own.
"""

from __future__ import annotations

from ezdxf.layouts.layout import Modelspace
from ezdxf.math import fit_points_to_cad_cv

from service.parts.curves import Curve
from service.parts.model import Development, Part
from service.parts.shapes import Disc, Outline, extent
from service.render.page import dxf

LAYERS = {"CUT": (7, "CONTINUOUS")}

COLOURS = (1, 5, 3)
"""Colours of the layers of a development."""


def cutting(part: Part, title: str) -> str:
    """Write the drawing of one part as a DXF document (R2010)."""
    if part.unrolled is not None:
        return _development(part.unrolled, title)
    document = dxf.new_drawing(title, "mm", LAYERS)
    space = document.modelspace()
    outer, along = part.region.outer, part.along
    # Shift the lowest and leftmost points to the axes.
    corner = complex(extent(outer, along)[0], extent(outer, 1j * along)[0])
    for outline in (outer, *part.region.holes):
        _add(space, outline, along, corner)
    return dxf.written(document)


def _development(unrolled: Development, title: str) -> str:
    layers = {name: (COLOURS[n], "CONTINUOUS") for n, name in enumerate(dict(unrolled.lines))}
    document = dxf.new_drawing(title, "mm", LAYERS | layers)
    space = document.modelspace()
    box = [(0.0, 0.0), (unrolled.width, 0.0), (unrolled.width, unrolled.height), (0.0, unrolled.height)]
    space.add_lwpolyline(box, close=True, dxfattribs={"layer": "CUT"})
    for name, points in unrolled.lines:
        spline = space.add_spline(degree=3, dxfattribs={"layer": name})
        spline.apply_construction_tool(fit_points_to_cad_cv([(z.real, z.imag) for z in points]))
    return dxf.written(document)


def _add(space: Modelspace, outline: Outline, along: complex, corner: complex) -> None:
    """Add an outline, rotated so that ``along`` lies along x, and shifted by ``corner``."""
    back = along.conjugate()
    if isinstance(outline, Disc):
        dxf.add_circle(space, outline.centre * back - corner, outline.radius, "CUT")
        return
    if isinstance(outline, Curve):
        clamped = outline.clamped
        poles = (clamped.c @ (1.0, 1j)) * back - corner
        spline = space.add_spline(degree=3, dxfattribs={"layer": "CUT"})
        spline.control_points = [(z.real, z.imag, 0.0) for z in poles.tolist()]
        spline.knots = clamped.t.tolist()
        return
    points = [
        (z.real, z.imag, bulge) for z, bulge in ((start * back - corner, bulge) for start, _, bulge in outline.edges())
    ]
    space.add_lwpolyline(points, format="xyb", close=True, dxfattribs={"layer": "CUT"})
