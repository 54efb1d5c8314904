"""Gearboxes as DXF, in two views to scale: the end view of the shafts, and the developed view along them.

=====================  ==============================================================
layer                  content (NAME: STAGE_n_PAIR_k; HEAD, GEAR_n, REVERSE)
=====================  ==============================================================
NAME_PITCH             pitch circles in the end view
NAME_TEETH             closed outlines of all teeth in mesh: involutes, fillets, tips
NAME_DEVELOPED         outside diameters along the shafts, below the other view
SHAFTS                 crosses at the shafts, and their axes in the developed view
TEXT                   tooth numbers, names of the shafts
=====================  ==============================================================

All pairs of a stage overlap in the end view: freeze the layers of those that are not engaged. The developed view has
the shafts in one plane, at their true distances; the reverse idler is rotated into it about the layshaft. Diameters and
distances are true in both views. A design has no face widths: faces are drawn 8 modules wide.
"""

from __future__ import annotations

from ezdxf.document import Drawing

from service.render.gears.dxf import LINE_SPACING, add_gear, list_gear_layers
from service.render.gears.gearbox_layout import BoxLayout, arrange_gearbox, arrange_layshaft
from service.render.gears.placement import enclose_gears
from service.render.page import dxf
from synthesis.kinds.gearbox.design import GearboxDesign
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.layshaft_gearbox.design import LayshaftDesign
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem

PAIR_COLOURS = (5, 3, 30, 6, 4, 1, 2)
"""Colour indices, taken in turn."""

FACE_WIDTH, FACE_GAP, LETTER_HEIGHT = 8.0, 4.0, 2.0
"""Width of a face, space next to it and height of letters, in modules."""

AXIS_OVERHANG = 0.4 * FACE_GAP
"""Extension of an axis beyond its last face, in modules."""

NAME_WIDTH, VIEW_GAP = 8.0, 6.0
"""Space at the left for the names of the shafts, and between the two views, in letter heights."""


def write_gearbox_dxf(design: GearboxDesign, problem: GearboxProblem, title: str) -> str:
    """Write a machine-tool gearbox as a DXF document (R2010)."""
    layout = arrange_gearbox(design.mechanism)
    return _write_layout(title or "Gearbox", problem.length_unit, layout, design.mechanism.module)


def write_layshaft_dxf(design: LayshaftDesign, problem: LayshaftProblem, title: str) -> str:
    """Write a layshaft gearbox as a DXF document (R2010)."""
    layout = arrange_layshaft(design.mechanism)
    return _write_layout(title or "Layshaft gearbox", problem.length_unit, layout, design.mechanism.module)


def _write_layout(title: str, unit: str, layout: BoxLayout, module: float) -> str:
    layers = {"SHAFTS": (7, "CENTER"), "TEXT": (7, "CONTINUOUS")}
    for pair, stage in {placed.pair: placed.stage for placed in layout.gears}.items():
        colour = PAIR_COLOURS[stage % len(PAIR_COLOURS)]
        layers |= list_gear_layers(pair, colour) | {f"{pair}_DEVELOPED": (colour, "CONTINUOUS")}
    document = dxf.create_drawing(title, unit, layers)
    _add_end_view(document, layout, module)
    _add_developed_view(document, layout, module)
    return dxf.write_document(document)


def _add_end_view(document: Drawing, layout: BoxLayout, module: float) -> None:
    space = document.modelspace()
    for placed in layout.gears:
        add_gear(space, placed, [placed.pair])
    top = enclose_gears(layout.gears).high
    for k, shaft in enumerate(layout.shafts):
        dxf.add_cross(space, shaft.centre, LETTER_HEIGHT * module, "SHAFTS")
        # Names of coaxial shafts are on separate lines.
        above = complex(shaft.centre.real, top + (2.0 + LINE_SPACING * k) * LETTER_HEIGHT * module)
        dxf.add_words(space, above, shaft.name, LETTER_HEIGHT * module)


def _add_developed_view(document: Drawing, layout: BoxLayout, module: float) -> None:
    space = document.modelspace()
    seen = enclose_gears(layout.gears)
    # Upper end of the developed view above its first shaft.
    highest = max(placed.gear.tip_radius - layout.shafts[placed.shaft].below for placed in layout.gears)
    left = seen.left + NAME_WIDTH * LETTER_HEIGHT * module
    axis = seen.low - highest - VIEW_GAP * LETTER_HEIGHT * module
    face, step = FACE_WIDTH * module, (FACE_WIDTH + FACE_GAP) * module

    for placed in layout.gears:
        low = complex(left + placed.slot * step, axis - layout.shafts[placed.shaft].below)
        radius = placed.gear.tip_radius
        corners = [low - 1j * radius, low + face - 1j * radius, low + face + 1j * radius, low + 1j * radius]
        dxf.add_outline(space, corners, f"{placed.pair}_DEVELOPED")
        for side in (1j, -1j):
            pitch = low + side * placed.gear.pitch_radius
            dxf.add_line(space, pitch, pitch + face, f"{placed.pair}_PITCH")
        words = low + 0.5 * face + 1j * (0.5 * placed.gear.pitch_radius)
        dxf.add_words(space, words, f"z={placed.gear.teeth:g}", LETTER_HEIGHT * module)
    for shaft in layout.shafts:
        start = complex(left + shaft.slots[0] * step - AXIS_OVERHANG * module, axis - shaft.below)
        end = complex(left + shaft.slots[1] * step + face + AXIS_OVERHANG * module, axis - shaft.below)
        dxf.add_line(space, start, end, "SHAFTS")
        # Names stand at the left end of shafts that start there, otherwise at the right end.
        if shaft.slots[0] == 0:
            dxf.add_words(space, start - 4.0 * LETTER_HEIGHT * module, shaft.name, LETTER_HEIGHT * module)
        else:
            dxf.add_words(space, end + 5.0 * LETTER_HEIGHT * module, shaft.name, LETTER_HEIGHT * module)
