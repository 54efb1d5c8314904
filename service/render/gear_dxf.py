"""A gear train as DXF: pitch circles and true involute outlines in mesh, each stage on layers of its own.

=====================  ==============================================================
layer                  what is on it (n: number of the stage)
=====================  ==============================================================
STAGE_n_PITCH          pitch circles
STAGE_n_TEETH          closed outlines of all teeth: involutes, fillets, tips, roots
CENTRES                crosses at the shafts
TEXT                   tooth numbers and modules
=====================  ==============================================================

Stages lie one above the other in the plane as their shafts do; the input shaft is at the origin. Lengths are in the
problem's unit, which the header names.
"""

from __future__ import annotations

import io

import ezdxf
from ezdxf import units
from ezdxf.enums import TextEntityAlignment
from ezdxf.filemanagement import new
from ezdxf.layouts.layout import Modelspace

from kinematics.errors import DimensionError
from kinematics.gear.profile import outline
from service.render.gear_layout import PlacedGear, box_around, placed_gears
from service.render.svg import clean
from synthesis.designs.gear_train import GearTrainDesign
from synthesis.problems.gear_train import GearTrainProblem

# Without the time and the random marks of its making, so that the same train gives the same file.
ezdxf.options.write_fixed_meta_data_for_testing = True  # type: ignore[attr-defined]

UNITS = {"mm": units.MM, "cm": units.CM, "m": units.M, "in": units.IN}

COLOURS = (5, 3, 30, 6)
"""Colour indices of the stages."""


def gear_train_drawing(design: GearTrainDesign, problem: GearTrainProblem, title: str) -> str:
    """The drawing of a gear train as a DXF document (R2010)."""
    gears = placed_gears(design, problem.reverted)
    document = new("R2010", setup=["linetypes"])
    document.units = UNITS[problem.length_unit]
    document.header.custom_vars.append("Title", clean(title) or "Gear train")
    for number in range(1, len(design.mechanism.stages) + 1):
        document.layers.add(f"STAGE_{number}_PITCH", color=COLOURS[number - 1], linetype="DASHDOT")
        document.layers.add(f"STAGE_{number}_TEETH", color=COLOURS[number - 1])
    document.layers.add("CENTRES", color=7)
    document.layers.add("TEXT", color=7)
    space = document.modelspace()
    height = 0.02 * box_around(gears).diagonal
    for gear in gears:
        _gear(space, gear, height)
    text = io.StringIO()
    document.write(text)
    return text.getvalue()


def _gear(space: Modelspace, placed: PlacedGear, height: float) -> None:
    at, gear = placed.centre, placed.gear
    layer = f"STAGE_{placed.stage}"
    space.add_circle((at.real, at.imag), gear.pitch_radius, dxfattribs={"layer": f"{layer}_PITCH"})
    try:
        points = at + outline(gear, placed.tooth_at)
    except DimensionError:
        # Teeth whose cutter would come to a point have no outline; their pitch circle is drawn all the same.
        points = None
    if points is not None:
        listed = [(float(z.real), float(z.imag)) for z in points]
        space.add_lwpolyline(listed, close=True, dxfattribs={"layer": f"{layer}_TEETH"})
    arm = 0.5 * height
    for end in (complex(arm), 1j * arm):
        start, stop = at - end, at + end
        space.add_line((start.real, start.imag), (stop.real, stop.imag), dxfattribs={"layer": "CENTRES"})
    words = f"stage {placed.stage} {placed.role}: z={gear.teeth} m={gear.module:.6g}"
    below = at - 1j * height * (1.5 + 1.6 * (2 * placed.stage + (placed.role == "driven")))
    entity = space.add_text(words, height=height, dxfattribs={"layer": "TEXT"})
    entity.set_placement((below.real, below.imag), align=TextEntityAlignment.MIDDLE_CENTER)
