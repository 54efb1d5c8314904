"""The sheet of a gear train: pitch circles to scale, with teeth, shafts and directions, and tables."""

from __future__ import annotations

import math

import numpy as np

from service.render.checks import describe_verdict, make_checks_block
from service.render.gears.crossing import Section
from service.render.gears.marks import (
    PANEL_FILL,
    STAGE_COLOURS,
    draw_circles,
    draw_label,
    draw_shifted_teeth,
    label_box,
)
from service.render.gears.placement import enclose_gears
from service.render.gears.train_layout import TrainGear, assign_caption_rows, describe_views, place_gears
from service.render.outline import list_entries
from service.render.page import blocks
from service.render.page.numbers import format_length
from service.render.page.sheet import draw_panel, fit_panel, get_drawing_width, stack_blocks, write_sheet
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    draw_circle,
    draw_line,
    draw_path,
    draw_polygon,
    draw_text,
    estimate_text_width,
    make_element,
)
from service.render.page.symbols import GREY, GROUND, draw_arrow, draw_scale_bar
from synthesis.kinds.gear_train.design import GearTrainDesign, Stage
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.verification import build_train
from synthesis.model.gears.answer import MeshGeometry

PANEL_HEIGHTS = (420.0, 860.0)
"""Minimum and maximum height of the drawing, pixels."""

MARGIN, MARGIN_BELOW = 20.0, 26.0
"""Margins in the panel around the content, and additional space below for the scale bar, pixels."""

CAPTION_HEIGHT, CAPTION_GAP = 14.0, 14.0
"""Height of a row of captions below the content, and space between two captions of a row, pixels."""

CAPTION_FONT_SIZE = 10.5
"""Font size of a caption, pixels."""

ARROW_RADII, ARROW_ANGLE = (14.0, 30.0), 140.0
"""Minimum and maximum radius (pixels) and angle (degrees) of the arrow that shows a shaft's rotation."""

DRIVER_ARROW_START, OUTPUT_ARROW_START = 200.0, 20.0
"""Start angles of these arrows, degrees: on coaxial shafts the output's is opposite to the input's."""

LABEL_ANGLES = (90.0, 65.0, 115.0, 40.0, 140.0, 270.0, 245.0, 295.0, 220.0, 320.0, 15.0, 165.0)
"""Trial angles of a gear's label on the pitch circle, degrees, in order of preference."""


def draw_gear_train_sheet(design: GearTrainDesign, problem: GearTrainProblem, title: str) -> str:
    """Draw a gear train as a complete SVG document."""
    gears = place_gears(design.mechanism, problem.reverted)
    view, captions = _fit_captions(gears, describe_views(gears, build_train(design.mechanism).stages))
    tables, y = stack_blocks(_make_tables(design, problem, gears))
    drawn = draw_train_panel(gears, view, problem.length_unit, typed=problem.stages is not None)
    drawn.add(*captions)
    bottom = max(view.panel.high, y)
    words = _describe_train(design, problem)
    return write_sheet(title or "Gear train", words, _describe_drawing(design, problem), [drawn, *tables], bottom)


def _fit_captions(gears: list[TrainGear], captions: list[tuple[Box, str]]) -> tuple[Viewport, list[Element]]:
    """Return a panel with captions of all views below, in enough rows to keep the words separate."""
    shown, depth = enclose_gears(gears), 0
    while True:
        view = fit_panel(shown, get_drawing_width(), PANEL_HEIGHTS, MARGIN, MARGIN_BELOW + depth * CAPTION_HEIGHT)
        spans = []
        for box, words in captions:
            wide, panel = estimate_text_width(words, CAPTION_FONT_SIZE), view.panel
            # Keep captions inside the panel.
            left = max(panel.left + 6.0, min(view.point(complex(box.left)).real, panel.right - 6.0 - wide))
            spans.append((left, left + wide))
        rows = assign_caption_rows(spans, CAPTION_GAP)
        # More rows leave less space for the views, which may need still more rows; at most one row per view.
        if max(rows, default=-1) < depth:
            break
        depth += 1
    low = view.point(complex(shown.left, shown.low)).imag
    return view, [
        draw_text(left, low + (row + 1) * CAPTION_HEIGHT, words, CAPTION_FONT_SIZE, fill=GROUND)
        for (left, _), row, (_, words) in zip(spans, rows, captions, strict=True)
    ]


def _describe_train(design: GearTrainDesign, problem: GearTrainProblem) -> str:
    count = len(design.mechanism.stages)
    ratio = design.mechanism.ratio
    kind = "reverted gear train" if problem.reverted else "gear train"
    stages = "1 stage" if count == 1 else f"{count} stages"
    fraction = f"{ratio.numerator}/{ratio.denominator}".replace("-", "−")
    words = f"{kind.capitalize()} of {stages}, ratio {fraction} = {format_length(ratio.value, digits=9)}"
    return f"{words}; {describe_verdict(design.verification)}"


def _describe_drawing(design: GearTrainDesign, problem: GearTrainProblem) -> str:
    listed = "; ".join(
        f"stage {number}{f', {stage.type}' if stage.type else ''}: {stage.driver} drives {stage.driven} teeth, "
        f"module {stage.module:.6g} {problem.length_unit}"
        for number, stage in enumerate(design.mechanism.stages, 1)
    )
    idlers = "".join(f"; idler of {idler.teeth} teeth in stage {idler.stage}" for idler in design.mechanism.idlers)
    return f"Pitch circles of a gear train to scale: {listed}{idlers}."


def draw_train_panel(
    gears: list[TrainGear], view: Viewport, unit: str, name: str = "main", typed: bool = False
) -> Element:
    """Draw all gears with their shafts and directions in a panel; for typed stages with all their teeth."""
    group = draw_panel(view.panel, name, PANEL_FILL)
    # Rings lie behind the gears that run inside them.
    for placed in sorted(gears, key=lambda gear: not gear.gear.internal):
        marks = {"data_stage": f"{placed.stage}", "data_gear": placed.role, "data_teeth": f"{placed.count}"}
        colour = STAGE_COLOURS[placed.stage - 1]
        if placed.section is not None:
            group.add(_draw_section(placed, placed.section, view, colour, marks))
            continue
        group.add(draw_circles(placed.gear, placed.centre, view, colour, "tip", 0.06, **marks))
        if placed.gear.internal:
            rim = view.scale * placed.reach
            group.add(draw_circle(view.point(placed.centre), rim, fill="none", stroke=colour, stroke_width=0.9))
        if placed.gear.shift or typed:
            group.add(*draw_shifted_teeth(placed, view, colour))
    shafts: list[complex] = []
    for placed in gears:
        if placed.section is not None:
            continue
        at = view.point(placed.centre)
        # Coaxial gears share one shaft symbol.
        if all(abs(at - shaft) > 0.5 for shaft in shafts):
            shafts.append(at)
            group.add(*_draw_shaft(at))
    last = {placed.view: placed for placed in gears}
    for placed in gears:
        if placed.section is None and (
            placed.role != "driven" or (placed is not gears[-1] and placed is last[placed.view])
        ):
            group.add(*_draw_turn(placed, view, DRIVER_ARROW_START))
    # The output's arrow starts opposite, so that it stays visible on coaxial shafts.
    if gears[-1].section is None:
        group.add(*_draw_turn(gears[-1], view, OUTPUT_ARROW_START))
    for placed, words, below in ((gears[0], "in", 1.0), (gears[-1], "out", -1.0)):
        at = view.point(placed.centre if placed.section is None else placed.centre + placed.section.axis[-1])
        at += below * 11j
        group.add(draw_text(at.real + 5.0, at.imag + 4.0, words, 10.5, fill=GROUND))
    taken: list[Box] = []
    # Threads and teeth in mesh stay visible: no label of a round gear covers a worm.
    bodies = [Box.enclose(view.points(one.centre + one.section.outline)) for one in gears if one.section is not None]
    for placed in gears:
        group.add(_draw_label(placed, view, taken, bodies))
    group.add(draw_scale_bar(view, unit)[0])
    return group


def _draw_section(placed: TrainGear, section: Section, view: Viewport, colour: str, marks: dict[str, str]) -> Element:
    """Draw a gear in axial section, with its pitch lines and the axis."""
    body = view.points(placed.centre + section.outline).tolist()
    drawn: list[Element | None] = [draw_polygon(body, stroke=colour, stroke_width=0.9, fill=colour, fill_opacity=0.06)]
    dashed: dict[str, str | float] = {"stroke": colour, "stroke_width": 1.4, "stroke_dasharray": "9 3 2 3"}
    drawn += [draw_path([view.points(placed.centre + row)], **dashed) for row in section.pitch_lines]
    drawn.append(draw_path([view.points(placed.centre + section.axis)], stroke=GROUND, stroke_width=1.0))
    return make_element("g", *(one for one in drawn if one is not None), **marks)


def _draw_shaft(at: complex) -> list[Element]:
    arms = [draw_line(at - end, at + end, stroke=GROUND, stroke_width=1.0) for end in (9.0 + 0j, 9j)]
    return [draw_circle(at, 3.0, fill="#fff", stroke=GROUND, stroke_width=1.4), *arms]


def _draw_turn(placed: TrainGear, view: Viewport, start: float) -> list[Element]:
    """Draw an arrow around the shaft in its sense of rotation, from an angle of ``start`` degrees."""
    at = view.point(placed.centre)
    radius = max(ARROW_RADII[0], min(ARROW_RADII[1], 0.4 * view.scale * placed.pitch_radius))
    way = 1.0 if placed.speed > 0 else -1.0
    angles = np.radians(np.linspace(start, start + ARROW_ANGLE, 25))[:: 1 if way > 0 else -1]
    # Sheet coordinates point down: the conjugate turns as the gear does.
    points = np.asarray(at + radius * np.exp(-1j * angles), np.complex128)
    head = draw_arrow(complex(points[-2]), complex(points[-1] + 5.0 * _normalize(points[-1] - points[-2])), 3.6, GREY)
    drawn = draw_path([points], stroke=GREY, stroke_width=1.4)
    assert drawn is not None
    return [drawn, head]


def _normalize(vector: complex) -> complex:
    return complex(vector / abs(vector))


def _draw_label(placed: TrainGear, view: Viewport, taken: list[Box], bodies: list[Box]) -> Element:
    """Draw the tooth number at the pitch circle, at the first place that covers no other label and no section."""
    words = f"{placed.count}"
    panel = view.panel.grow(-3.0)
    boxes = []
    if placed.section is not None:
        boxes.append(label_box(view.point(placed.centre + placed.section.words), words))
    for degrees in LABEL_ANGLES:
        radius = view.scale * placed.pitch_radius
        at = view.point(placed.centre) + radius * np.exp(-1j * math.radians(degrees))
        boxes.append(label_box(complex(at), words))
    inside = [
        box for box in boxes if panel.holds(complex(box.left, box.low)) and panel.holds(complex(box.right, box.high))
    ]
    # A section may carry its own label.
    covered = taken if placed.section is not None else [*taken, *bodies]
    free = [box for box in inside if not any(box.overlaps(other) for other in covered)]
    # Prefer free places inside the panel, then any inside, then the first.
    box = (free or inside or boxes)[0]
    taken.append(box)
    return draw_label(box, words, STAGE_COLOURS[placed.stage - 1], words)


def _describe_gear(placed: TrainGear, stage: Stage, unit: str) -> str:
    """Return teeth and pitch diameter of a gear as words."""
    what = "teeth"
    if stage.type == "worm" and placed.role == "driver":
        what = "thread" if placed.count == 1 else "threads"
    ring = ", ring" if placed.gear.internal else ""
    return f"{placed.count} {what}{ring}, ⌀ {format_length(2.0 * placed.pitch_radius)} {unit}"


def _list_type_rows(stage: Stage, mesh: MeshGeometry, unit: str) -> list[tuple[str, str]]:
    """Return the rows that depend on the type of a stage."""
    rows = []
    if stage.type == "internal" and mesh.addendum is not None:
        # Only the ring's addendum is shortened.
        short = min(mesh.addendum.driver, mesh.addendum.driven)
        rows.append(("addendum of the ring", f"{short:.6g} modules"))
    if mesh.helix_angle is not None and mesh.transverse_module is not None:
        hand = "right-handed driver" if mesh.helix_angle.driver > 0 else "left-handed driver"
        rows.append(("helix angle", f"{abs(mesh.helix_angle.driver):.6g}°, {hand}"))
        rows.append(("transverse module", f"{format_length(mesh.transverse_module)} {unit}"))
    if mesh.overlap_ratio is not None:
        rows.append(("overlap ratio", f"{mesh.overlap_ratio:.3f}"))
    if mesh.cone_angle is not None and mesh.cone_distance is not None:
        rows.append(("shaft angle", f"{stage.shaft_angle:.6g}°"))
        rows.append(("cone angles", f"{mesh.cone_angle.driver:.4f}°, {mesh.cone_angle.driven:.4f}°"))
        rows.append(("cone distance", f"{format_length(mesh.cone_distance)} {unit}"))
        rows.append(("face, as drawn", "a third of the cone distance"))
    if mesh.lead_angle is not None and mesh.efficiency is not None:
        rows.append(("lead angle", f"{mesh.lead_angle:.4f}°, {stage.hand}-handed"))
        locked = "self-locking" if mesh.self_locking else "not self-locking"
        rows.append(("efficiency", f"{mesh.efficiency:.3f} with friction {stage.friction:.3g}, {locked}"))
    return rows


def _list_shafts(design: GearTrainDesign) -> list[blocks.Block]:
    """Return the block of all shafts' rotations, for typed stages."""
    if design.metrics.shafts is None:
        return []
    rows = []
    for number, shaft in enumerate(design.metrics.shafts):
        name = "input" if number == 0 else "output" if number == len(design.metrics.shafts) - 1 else f"shaft {number}"
        ratio = f"{shaft.speed.numerator}/{shaft.speed.denominator}".replace("-", "−")
        way = {"same": "as the input", "opposite": "against the input", None: "not parallel with the input"}
        rows.append((name, f"{ratio} × input, {way[shaft.turns]}"))
    return [blocks.make_rows("Shafts", rows)]


def _make_tables(design: GearTrainDesign, problem: GearTrainProblem, gears: list[TrainGear]) -> list[blocks.Block]:
    unit, metrics = problem.length_unit, design.metrics
    tables = []
    for number, stage in enumerate(design.mechanism.stages, 1):
        own = [placed for placed in gears if placed.stage == number]
        meshes = [mesh for mesh in metrics.meshes if mesh.stage == number]
        rows: list[tuple[str, str]] = [("type", stage.type)] if stage.type else []
        rows += [(placed.role, _describe_gear(placed, stage, unit)) for placed in own]
        rows += _list_type_rows(stage, meshes[0], unit)
        rows.append(("module", f"{format_length(stage.module)} {unit}"))
        if stage.type != "bevel":
            rows.append(("shaft distance", f"{format_length(metrics.centre_distances[number - 1])} {unit}"))
        rows.append(("contact ratio", ", ".join(f"{mesh.contact_ratio:.3f}" for mesh in meshes)))
        if problem.is_fitted:
            cut = [placed.gear for placed in own]
            rows += [
                ("profile shifts", ", ".join(f"{gear.shift:.5f}".replace("-", "−") for gear in cut)),
                ("tip circles", ", ".join(f"⌀ {format_length(2.0 * gear.tip_radius)} {unit}" for gear in cut)),
                ("working pressure angle", ", ".join(f"{mesh.working_pressure_angle:.4f}°" for mesh in meshes)),
            ]
        if stage.face_width is not None:
            estimate = ", a first estimate" if problem.strength is not None else ""
            rows.append((f"face width{estimate}", f"{format_length(stage.face_width)} {unit}"))
        if any(mesh.interferes for mesh in meshes):
            rows.append(("interference", "yes; see the suggested shift"))
        tables.append(blocks.make_rows(f"Stage {number}", rows))
    tables += _list_shafts(design)
    tables.append(make_checks_block(design.verification, problem))
    tables.append(blocks.make_rows("Metrics", list_entries(metrics, problem, {"error", "centre_distances", "shafts"})))
    return tables
