"""The sheet of a gear train: its pitch circles to scale, with teeth, shafts and directions, and tables beside them."""

from __future__ import annotations

import math

import numpy as np

from service.render.gears.train_layout import (
    PlacedGear,
    box_around,
    placed_gears,
)
from service.render.page import blocks
from service.render.page.numbers import length, small
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    circle,
    clean,
    document,
    element,
    line,
    path,
    shortened,
    text,
    text_width,
)
from service.render.page.symbols import (
    COUPLER,
    CURVE,
    GREY,
    GROUND,
    INK,
    INPUT,
    OUTPUT,
    PALE,
    arrow,
    scale_bar,
)
from synthesis.kinds.gear_train.design import GearTrainDesign
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.model.answer import Check

WIDTH, EDGE, TOP, COLUMN, GUTTER = 1100.0, 22.0, 74.0, 370.0, 26.0
"""Width of the sheet, border, height of the title, width of the tables' column, space beside it; pixels."""

HEIGHTS = (420.0, 860.0)
"""Least and greatest height of the drawing, pixels."""

COLOURS = (INPUT, OUTPUT, COUPLER, CURVE)
"""Of the stages."""

PLACES = (90.0, 65.0, 115.0, 40.0, 140.0, 270.0, 245.0, 295.0, 220.0, 320.0, 15.0, 165.0)
"""Angles on the pitch circle, degrees, at which a gear's label is tried, the first that is free."""

LABEL = 11.5


def gear_train_sheet(design: GearTrainDesign, problem: GearTrainProblem, title: str) -> str:
    """The drawing of a gear train as a complete SVG document."""
    gears = placed_gears(design, problem.reverted)
    unit = problem.length_unit
    heading = clean(title) or "Gear train"
    width = WIDTH - 2.0 * EDGE - COLUMN - GUTTER
    box = box_around(gears)
    height = min(max((width - 40.0) / box.width * box.height + 70.0, HEIGHTS[0]), HEIGHTS[1])
    view = Viewport.fit(box, Box(EDGE, TOP, EDGE + width, TOP + math.floor(height)), 20.0, 26.0)
    parts = [_drawing(gears, view, unit)]
    y = TOP - 6.0
    for block in _tables(design, problem, gears):
        drawn, y = block(WIDTH - EDGE - COLUMN, y, COLUMN)
        parts.append(drawn)
    bottom = math.ceil(max(view.panel.high, y) + EDGE - 8.0)
    return document(
        heading,
        _description(design, problem),
        (WIDTH, float(bottom)),
        text(EDGE, 34.0, shortened(heading, 20.0, WIDTH - 2.0 * EDGE), 20.0, font_weight="bold", fill=INK),
        text(EDGE, 55.0, _words(design, problem), 12.5, fill=GREY),
        *parts,
    )


def _words(design: GearTrainDesign, problem: GearTrainProblem) -> str:
    count = len(design.mechanism.stages)
    ratio = design.mechanism.ratio
    kind = "reverted gear train" if problem.reverted else "gear train"
    stages = "1 stage" if count == 1 else f"{count} stages"
    failed = sum(not check.passed for check in design.verification.checks)
    verdict = f"fails {failed} checks" if failed else "passes all checks"
    fraction = f"{ratio.numerator}/{ratio.denominator}".replace("-", "−")
    return f"{kind.capitalize()} of {stages}, ratio {fraction} = {length(ratio.value, digits=9)}; {verdict}"


def _description(design: GearTrainDesign, problem: GearTrainProblem) -> str:
    listed = "; ".join(
        f"stage {number}: {stage.driver} drives {stage.driven} teeth, module {stage.module:.6g} {problem.length_unit}"
        for number, stage in enumerate(design.mechanism.stages, 1)
    )
    idlers = "".join(f"; idler of {idler.teeth} teeth in stage {idler.stage}" for idler in design.mechanism.idlers)
    return f"Pitch circles of a gear train to scale: {listed}{idlers}."


def _drawing(gears: list[PlacedGear], view: Viewport, unit: str) -> Element:
    panel = view.panel
    group = element(
        "g",
        element("rect", x=panel.left, y=panel.low, width=panel.width, height=panel.height, fill="#fbfcfd", stroke=PALE),
        data_panel="main",
    )
    for placed in gears:
        group.add(_gear(placed, view))
    shafts: list[complex] = []
    for placed in gears:
        at = view.point(placed.centre)
        if all(abs(at - shaft) > 0.5 for shaft in shafts):
            shafts.append(at)
            group.add(*_shaft(at))
    for placed in gears:
        if placed.role != "driven":
            group.add(*_turn(placed, view, 200.0))
    group.add(*_turn(gears[-1], view, 20.0))
    for placed, words, below in ((gears[0], "in", 1.0), (gears[-1], "out", -1.0)):
        at = view.point(placed.centre) + below * 11j
        group.add(text(at.real + 5.0, at.imag + 4.0, words, 10.5, fill=GROUND))
    taken: list[Box] = []
    for placed in gears:
        group.add(_label(placed, view, taken))
    group.add(scale_bar(view, unit)[0])
    return group


def _gear(placed: PlacedGear, view: Viewport) -> Element:
    colour, at = COLOURS[placed.stage - 1], view.point(placed.centre)
    gear = placed.gear
    return element(
        "g",
        circle(at, view.scale * gear.tip_radius, fill=colour, fill_opacity=0.06, stroke=colour, stroke_width=0.6),
        circle(
            at, view.scale * gear.pitch_radius, fill="none", stroke=colour, stroke_width=1.6, stroke_dasharray="9 3 2 3"
        ),
        data_stage=str(placed.stage),
        data_gear=placed.role,
        data_teeth=str(gear.teeth),
    )


def _shaft(at: complex) -> list[Element]:
    arms = [line(at - end, at + end, stroke=GROUND, stroke_width=1.0) for end in (9.0 + 0j, 9j)]
    return [circle(at, 3.0, fill="#fff", stroke=GROUND, stroke_width=1.4), *arms]


def _turn(placed: PlacedGear, view: Viewport, start: float) -> list[Element]:
    """An arrow round the shaft the way it turns, from an angle of ``start`` degrees over 140."""
    at = view.point(placed.centre)
    radius = max(14.0, min(30.0, 0.4 * view.scale * placed.pitch_radius))
    way = 1.0 if placed.speed > 0 else -1.0
    angles = np.radians(np.linspace(start, start + 140.0, 25))[:: 1 if way > 0 else -1]
    # Sheet coordinates run down: the conjugate turns the way the gear does.
    points = np.asarray(at + radius * np.exp(-1j * angles), np.complex128)
    head = arrow(complex(points[-2]), complex(points[-1] + 5.0 * _unit(points[-1] - points[-2])), 3.6, GREY)
    drawn = path([points], stroke=GREY, stroke_width=1.4)
    assert drawn is not None
    return [drawn, head]


def _unit(vector: complex) -> complex:
    return complex(vector / abs(vector))


def _label(placed: PlacedGear, view: Viewport, taken: list[Box]) -> Element:
    """Tooth number at the pitch circle, at the first place where it covers no other label."""
    words = f"{placed.gear.teeth}"
    half = 0.5 * text_width(words, LABEL) + 3.0
    panel = view.panel.grown(-3.0)
    boxes = []
    for degrees in PLACES:
        radius = view.scale * placed.pitch_radius
        at = view.point(placed.centre) + radius * np.exp(-1j * math.radians(degrees))
        boxes.append(Box(at.real - half, at.imag - 8.0, at.real + half, at.imag + 8.0))
    inside = [
        box for box in boxes if panel.holds(complex(box.left, box.low)) and panel.holds(complex(box.right, box.high))
    ]
    free = [box for box in inside if not any(box.overlaps(other) for other in taken)]
    box = (free or inside or boxes)[0]
    taken.append(box)
    colour = COLOURS[placed.stage - 1]
    frame = element(
        "rect", x=box.left, y=box.low, width=box.width, height=box.height, rx=3.0, fill="#fff", stroke=colour
    )
    middle = box.centre
    words_at = text(middle.real, middle.imag + 4.2, words, LABEL, text_anchor="middle", fill=colour, font_weight="bold")
    return element("g", frame, words_at, data_label=words)


def _tables(design: GearTrainDesign, problem: GearTrainProblem, gears: list[PlacedGear]) -> list[blocks.Block]:
    unit, metrics = problem.length_unit, design.metrics
    found = []
    for number, stage in enumerate(design.mechanism.stages, 1):
        entries = [
            (placed.role, f"{placed.gear.teeth} teeth, ⌀ {length(2.0 * placed.pitch_radius)} {unit}")
            for placed in gears
            if placed.stage == number
        ]
        meshes = [mesh for mesh in metrics.meshes if mesh.stage == number]
        entries += [
            ("module", f"{length(stage.module)} {unit}"),
            ("shaft distance", f"{length(metrics.centre_distances[number - 1])} {unit}"),
            ("contact ratio", ", ".join(f"{mesh.contact_ratio:.3f}" for mesh in meshes)),
        ]
        if any(mesh.interferes for mesh in meshes):
            entries.append(("interference", "yes; see suggested shift"))
        found.append(blocks.rows(f"Stage {number}", entries))
    found.append(blocks.checks(design.verification, _written))
    found.append(
        blocks.rows(
            "Metrics",
            [
                ("relative error", small(metrics.relative_error)),
                ("total teeth", f"{metrics.total_teeth}"),
                ("largest stage ratio", length(metrics.largest_stage_ratio)),
                ("hunting teeth", "yes" if metrics.hunting_tooth else "no"),
            ],
        )
    )
    return found


def _written(check: Check, value: float) -> str:
    return small(value) if check.name in ("ratio_error", "coaxial") else length(value)
