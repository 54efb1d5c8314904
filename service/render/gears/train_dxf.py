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

from ezdxf.layouts.layout import Modelspace

from service.render.gears.train_layout import (
    PlacedGear,
    box_around,
    placed_gears,
)
from service.render.page import dxf
from synthesis.kinds.gear_train.design import GearTrainDesign
from synthesis.kinds.gear_train.problem import GearTrainProblem

COLOURS = (5, 3, 30, 6)
"""Colour indices of the stages."""


def gear_train_drawing(design: GearTrainDesign, problem: GearTrainProblem, title: str) -> str:
    """The drawing of a gear train as a DXF document (R2010)."""
    gears = placed_gears(design, problem.reverted)
    layers = {"CENTRES": (7, "CONTINUOUS"), "TEXT": (7, "CONTINUOUS")}
    for number in range(1, len(design.mechanism.stages) + 1):
        layers |= dxf.gear_layers(f"STAGE_{number}", COLOURS[number - 1])
    document = dxf.new_drawing(title or "Gear train", problem.length_unit, layers)
    height = 0.02 * box_around(gears).diagonal
    for gear in gears:
        _add(document.modelspace(), gear, height)
    return dxf.written(document)


def _add(space: Modelspace, placed: PlacedGear, height: float) -> None:
    at, gear = placed.centre, placed.gear
    dxf.add_gear(space, f"STAGE_{placed.stage}", gear, at, dxf.teeth_outline(gear, at, placed.tooth_at))
    dxf.add_cross(space, at, 0.5 * height, "CENTRES")
    below = at - 1j * height * (1.5 + 1.6 * (2 * placed.stage + (placed.role == "driven")))
    dxf.add_words(space, below, f"stage {placed.stage} {placed.role}: z={gear.teeth} m={gear.module:.6g}", height)
