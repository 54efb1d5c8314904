"""A planetary train as DXF: pitch circles and true involute outlines in mesh, each plane on layers of its own."""

from __future__ import annotations

import io

import ezdxf
from ezdxf import units
from ezdxf.filemanagement import new

from kinematics.errors import DimensionError
from kinematics.gear.arrangements import ARRANGEMENTS
from kinematics.gear.profile import outline
from service.render.planetary_layout import placed_planetary_gears
from service.render.svg import clean
from synthesis.designs.planetary_train import PlanetaryDesign
from synthesis.problems.planetary_train import PlanetaryProblem

# Without the time and the random marks of its making, so that the same train gives the same file.
ezdxf.options.write_fixed_meta_data_for_testing = True  # type: ignore[attr-defined]

UNITS = {"mm": units.MM, "cm": units.CM, "m": units.M, "in": units.IN}


def planetary_drawing(design: PlanetaryDesign, problem: PlanetaryProblem, title: str) -> str:
    """A planetary train as DXF (R2010): pitch circles and true involute outlines in mesh, planes on their own layers.

    Layers are PLANE_n_PITCH, PLANE_n_TEETH and CENTRES; the axis is at the origin. Bevel gears have pitch circles only.
    """
    mechanism = design.mechanism
    gears = placed_planetary_gears(mechanism)
    document = new("R2010", setup=["linetypes"])
    document.units = UNITS[problem.length_unit]
    document.header.custom_vars.append("Title", clean(title) or "Planetary train")
    for plane in sorted({plane for placed in gears for plane in placed.planes}):
        document.layers.add(f"PLANE_{plane}_PITCH", color=1 + plane, linetype="DASHDOT")
        document.layers.add(f"PLANE_{plane}_TEETH", color=1 + plane)
    document.layers.add("CENTRES", color=7)
    space = document.modelspace()
    for placed in gears:
        at = placed.centre
        points = None
        if not ARRANGEMENTS[mechanism.arrangement].bevel:
            try:
                points = at + outline(placed.gear, placed.tooth_at)
            except DimensionError:
                # Teeth whose cutter would come to a point have no outline; their pitch circle is drawn all the same.
                points = None
        for plane in placed.planes:
            layer = f"PLANE_{plane}"
            space.add_circle((at.real, at.imag), placed.gear.pitch_radius, dxfattribs={"layer": f"{layer}_PITCH"})
            if points is not None:
                listed = [(float(z.real), float(z.imag)) for z in points]
                space.add_lwpolyline(listed, close=True, dxfattribs={"layer": f"{layer}_TEETH"})
        space.add_point((at.real, at.imag), dxfattribs={"layer": "CENTRES"})
    written = io.StringIO()
    document.write(written)
    return written.getvalue()
