"""Gear trains as DXF: pitch circles and true involute outlines in mesh, each stage or plane on its own layers.

=====================  ==============================================================
layer                  content (n: number of the stage; PLANE_n of a planetary train)
=====================  ==============================================================
STAGE_n_PITCH          pitch circles; layers of trains in series begin with UNIT_n_
STAGE_n_TEETH          closed outlines of all teeth: involutes, fillets, tips, roots
CENTRES                crosses at the shafts, axes of shafts that lie in the plane of the drawing; points at the axes
                       of a planetary train
TEXT                   tooth numbers, modules and profile shifts, of ordinary trains
=====================  ==============================================================

Stages overlap in the plane as their shafts do. The input shaft is at the origin, and so is the axis of a planetary
train. Trains in series are side by side, and so are the views of trains with non-parallel shafts, each with a caption.
Bevel gears have pitch circles only. Lengths are in the unit of the problem, which the header contains.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from ezdxf.layouts.layout import Modelspace

from kinematics.gear.arrangements import ARRANGEMENTS
from service.render.gears.crossing import Section
from service.render.gears.placement import PlacedGear, enclose_gears
from service.render.gears.planetary_layout import place_planetary_gears
from service.render.gears.series_layout import arrange_series
from service.render.gears.train_layout import TrainGear, assign_caption_rows, describe_views, place_gears
from service.render.page import dxf
from synthesis.kinds.gear_train.design import GearTrainDesign
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.verification import build_train
from synthesis.kinds.planetary_train.design import PlanetaryDesign
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.train_series.design import TrainSeriesDesign
from synthesis.kinds.train_series.problem import TrainSeriesProblem

STAGE_COLOURS = (5, 3, 30, 6)
"""Colour indices of the stages."""

LETTER_HEIGHT, CROSS_ARM = 0.02, 0.01
"""Height of letters, and half the size of a cross at a shaft, as shares of the drawing's diagonal."""

LINE_SPACING = 1.6
"""Line spacing of text, in letter heights."""


def list_gear_layers(name: str, colour: int) -> dict[str, tuple[int, str]]:
    """Return the two layers of a gear: its pitch circle, and the outline of its teeth."""
    return {f"{name}_PITCH": (colour, "DASHDOT"), f"{name}_TEETH": (colour, "CONTINUOUS")}


def add_gear(space: Modelspace, placed: PlacedGear, names: Iterable[str], *, toothed: bool = True) -> None:
    """Add the pitch circle and, if ``toothed``, the outline of a gear on the layers of each name."""
    teeth = placed.get_teeth() if toothed else None
    for name in names:
        dxf.add_circle(space, placed.centre, placed.pitch_radius, f"{name}_PITCH")
        if teeth is not None:
            dxf.add_outline(space, placed.centre + teeth, f"{name}_TEETH")


def write_gear_train_dxf(design: GearTrainDesign, problem: GearTrainProblem, title: str) -> str:
    """Write a gear train as a DXF document (R2010)."""
    gears = place_gears(design.mechanism, problem.reverted)
    layers = {"CENTRES": (7, "CONTINUOUS"), "TEXT": (7, "CONTINUOUS")}
    for number in range(1, len(design.mechanism.stages) + 1):
        layers |= list_gear_layers(f"STAGE_{number}", STAGE_COLOURS[number - 1])
    document = dxf.create_drawing(title or "Gear train", problem.length_unit, layers)
    space, size = document.modelspace(), enclose_gears(gears).diagonal
    for placed in gears:
        at, height = placed.centre, LETTER_HEIGHT * size
        if placed.section is None:
            add_gear(space, placed, [f"STAGE_{placed.stage}"])
            dxf.add_cross(space, at, CROSS_ARM * size, "CENTRES")
        else:
            add_section(space, placed.section, at, f"STAGE_{placed.stage}")
        # Labels of gears on one shaft are placed below one another.
        below = at - 1j * height * (1.5 + LINE_SPACING * (2 * placed.stage + (placed.role == "driven")))
        module = design.mechanism.stages[placed.stage - 1].module
        words = f"stage {placed.stage} {placed.role}: z={placed.count} m={module:.6g}{_describe_type(design, placed)}"
        dxf.add_words(
            space, below, f"{words} x={_get_normal_shift(placed):.6g}" if problem.is_fitted else words, height
        )
    captions, height = describe_views(gears, build_train(design.mechanism).stages), LETTER_HEIGHT * size
    middles = [0.5 * (box.left + box.right) for box, _ in captions]
    # Letters are at most about as wide as high.
    halves = [0.5 * height * len(caption) for _, caption in captions]
    rows = assign_caption_rows([(at - half, at + half) for at, half in zip(middles, halves, strict=True)], height)
    for at, row, (_, caption) in zip(middles, rows, captions, strict=True):
        dxf.add_words(
            space, complex(at, enclose_gears(gears).high + height * (1.0 + LINE_SPACING * row)), caption, height
        )
    return dxf.write_document(document)


def _get_normal_shift(placed: TrainGear) -> float:
    """Return the profile shift in the modules of the problem: for helical teeth, those of the normal plane."""
    return placed.gear.shift / math.cos(placed.helix_angle)


def _describe_type(design: GearTrainDesign, placed: TrainGear) -> str:
    """Return the words that distinguish the teeth of a typed stage from those of a spur gear."""
    stage = design.mechanism.stages[placed.stage - 1]
    if stage.type == "helical" and stage.helix_angle is not None:
        # The angle is that of the driver; its mate has the opposite hand.
        hand = "right" if (stage.helix_angle > 0) == (placed.role == "driver") else "left"
        return f" helical {abs(stage.helix_angle):.6g} deg {hand}"
    return f" {stage.type}" if stage.type not in (None, "external") else ""


def add_section(space: Modelspace, section: Section, at: complex, name: str) -> None:
    """Add a gear in axial section: its body with the teeth, its pitch lines, its axis."""
    dxf.add_outline(space, at + section.outline, f"{name}_TEETH")
    for start, end in section.pitch_lines:
        dxf.add_line(space, at + start, at + end, f"{name}_PITCH")
    dxf.add_line(space, at + section.axis[0], at + section.axis[1], "CENTRES")


def write_planetary_dxf(design: PlanetaryDesign, problem: PlanetaryProblem, title: str) -> str:
    """Write a planetary train as a DXF document (R2010)."""
    mechanism = design.mechanism
    gears = place_planetary_gears(mechanism)
    layers = {"CENTRES": (7, "CONTINUOUS")}
    for plane in sorted({plane for placed in gears for plane in placed.planes}):
        layers |= list_gear_layers(f"PLANE_{plane}", 1 + plane)
    document = dxf.create_drawing(title or "Planetary train", problem.length_unit, layers)
    space = document.modelspace()
    # Bevel gears are drawn by their pitch circles only.
    bevel = ARRANGEMENTS[mechanism.arrangement].bevel
    for placed in gears:
        add_gear(space, placed, [f"PLANE_{plane}" for plane in placed.planes], toothed=not bevel)
        space.add_point((placed.centre.real, placed.centre.imag), dxfattribs={"layer": "CENTRES"})
    return dxf.write_document(document)


def write_series_dxf(design: TrainSeriesDesign, problem: TrainSeriesProblem, title: str) -> str:
    """Write trains in series as a DXF document (R2010)."""
    placed = arrange_series(design, problem)
    layers = {"CENTRES": (7, "CONTINUOUS"), "TEXT": (7, "CONTINUOUS")}
    for gear in placed:
        for layer in gear.layers:
            layers |= list_gear_layers(layer, STAGE_COLOURS[(gear.unit - 1) % len(STAGE_COLOURS)])
    document = dxf.create_drawing(title or "Trains in series", problem.length_unit, layers)
    space = document.modelspace()
    height = LETTER_HEIGHT * enclose_gears(gear.placed for gear in placed).diagonal
    for gear in placed:
        add_gear(space, gear.placed, gear.layers, toothed=gear.toothed)
        at = gear.placed.centre
        space.add_point((at.real, at.imag), dxfattribs={"layer": "CENTRES"})
        # Label each gear once, not every copy of a planet.
        if gear.copy == 0:
            dxf.add_words(
                space, at - 1j * height * LINE_SPACING * gear.line, f"{gear.name}: z={gear.placed.gear.teeth:g}", height
            )
    return dxf.write_document(document)
