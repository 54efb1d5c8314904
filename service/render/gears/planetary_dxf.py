"""A planetary train as DXF: pitch circles and true involute outlines in mesh, each plane on layers of its own."""

from __future__ import annotations

from kinematics.gear.arrangements import ARRANGEMENTS
from service.render.gears.planetary_layout import placed_planetary_gears
from service.render.page import dxf
from synthesis.kinds.planetary_train.design import PlanetaryDesign
from synthesis.kinds.planetary_train.problem import PlanetaryProblem


def planetary_drawing(design: PlanetaryDesign, problem: PlanetaryProblem, title: str) -> str:
    """A planetary train as DXF (R2010): pitch circles and true involute outlines in mesh, planes on their own layers.

    Layers are PLANE_n_PITCH, PLANE_n_TEETH and CENTRES; the axis is at the origin. Bevel gears have pitch circles only.
    """
    mechanism = design.mechanism
    gears = placed_planetary_gears(mechanism)
    layers = {"CENTRES": (7, "CONTINUOUS")}
    for plane in sorted({plane for placed in gears for plane in placed.planes}):
        layers |= dxf.gear_layers(f"PLANE_{plane}", 1 + plane)
    document = dxf.new_drawing(title or "Planetary train", problem.length_unit, layers)
    space = document.modelspace()
    bevel = ARRANGEMENTS[mechanism.arrangement].bevel
    for placed in gears:
        at = placed.centre
        teeth = None if bevel else dxf.teeth_outline(placed.gear, at, placed.tooth_at)
        for plane in placed.planes:
            dxf.add_gear(space, f"PLANE_{plane}", placed.gear, at, teeth)
        space.add_point((at.real, at.imag), dxfattribs={"layer": "CENTRES"})
    return dxf.written(document)
