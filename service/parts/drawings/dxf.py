"""The outline of a flat part with its holes as a DXF drawing in millimetres, for a laser cutter or a router.

Everything is on the layer CUT: outlines and slots are closed polylines whose round ends are true arcs, holes are
circles, smooth contours splines. The part lies along x, with its lowest and leftmost points on the axes.

For a part cut into a round bar the drawing is its development, seen from outside: the outline on CUT, and lines as
splines on layers of their own.
"""

from __future__ import annotations

from ezdxf.layouts.layout import Modelspace
from ezdxf.math import fit_points_to_cad_cv

from service.parts.assembly.model import Development, Part
from service.parts.geometry.regions import Disc, Outline, measure_extent
from service.parts.geometry.splines import Curve
from service.render.page import dxf

LAYERS = {"CUT": (7, "CONTINUOUS")}

LAYER_COLOURS = (1, 5, 3)
"""Colours of the layers of a development."""


def write_cutting_dxf(part: Part, title: str) -> str:
    """Write the drawing of one part as a DXF document (R2010)."""
    if part.unrolled is not None:
        return _write_development(part.unrolled, title)
    document = dxf.create_drawing(title, "mm", LAYERS)
    space = document.modelspace()
    outer, along = part.region.outer, part.along
    # Shift the lowest and leftmost points to the axes.
    corner = complex(measure_extent(outer, along)[0], measure_extent(outer, 1j * along)[0])
    for outline in (outer, *part.region.holes):
        _add_outline(space, outline, along, corner)
    return dxf.write_document(document)


def _write_development(unrolled: Development, title: str) -> str:
    layers = {name: (LAYER_COLOURS[n], "CONTINUOUS") for n, name in enumerate(dict(unrolled.lines))}
    document = dxf.create_drawing(title, "mm", LAYERS | layers)
    space = document.modelspace()
    box = [(0.0, 0.0), (unrolled.width, 0.0), (unrolled.width, unrolled.height), (0.0, unrolled.height)]
    space.add_lwpolyline(box, close=True, dxfattribs={"layer": "CUT"})
    for name, points in unrolled.lines:
        spline = space.add_spline(degree=3, dxfattribs={"layer": name})
        spline.apply_construction_tool(fit_points_to_cad_cv([(z.real, z.imag) for z in points]))
    return dxf.write_document(document)


def _add_outline(space: Modelspace, outline: Outline, along: complex, corner: complex) -> None:
    """Add an outline, rotated so that ``along`` lies along x, and shifted by ``corner``."""
    back = along.conjugate()
    if isinstance(outline, Disc):
        dxf.add_circle(space, outline.centre * back - corner, outline.radius, "CUT")
        return
    if isinstance(outline, Curve):
        clamped = outline.b_spline
        poles = (clamped.c @ (1.0, 1j)) * back - corner
        spline = space.add_spline(degree=3, dxfattribs={"layer": "CUT"})
        spline.control_points = [(z.real, z.imag, 0.0) for z in poles.tolist()]
        spline.knots = clamped.t.tolist()
        return
    points = [
        (z.real, z.imag, bulge)
        for z, bulge in ((start * back - corner, bulge) for start, _, bulge in outline.iterate_edges())
    ]
    space.add_lwpolyline(points, format="xyb", close=True, dxfattribs={"layer": "CUT"})
