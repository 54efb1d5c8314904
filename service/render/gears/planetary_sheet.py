"""The sheet of a planetary train: the pitch circles of each plane to scale, and tables."""

from __future__ import annotations

import cmath
import math

from kinematics.gear.arrangements import ARRANGEMENTS
from service.render.checks import describe_verdict, make_checks_block
from service.render.gears.marks import PANEL_FILL, draw_circles, draw_label, label_box
from service.render.gears.planetary_layout import PlanetaryGear, place_planetary_gears
from service.render.outline import list_entries
from service.render.page import blocks
from service.render.page.numbers import format_length
from service.render.page.sheet import (
    BORDER,
    TOP,
    draw_caption,
    draw_panel,
    get_drawing_width,
    stack_blocks,
    write_sheet,
)
from service.render.page.svg import Box, Element, Viewport, draw_circle, draw_line
from service.render.page.symbols import COUPLER, CURVE, GREY, GROUND, INPUT, OUTPUT, draw_scale_bar
from synthesis.kinds.planetary_train.design import PlanetaryDesign, PlanetaryMechanism
from synthesis.kinds.planetary_train.problem import PlanetaryProblem

SIZE_TITLE = "largest pitch diameter"
"""Name of the metric `size` of a planetary train."""

SINGLE_HEIGHT, PANEL_HEIGHT, PANEL_GAP = 560.0, 430.0, 10.0
"""Heights of a single panel and of one of several, and the space between these, pixels."""

RING_LABEL_ANGLE, SUN_LABEL_ANGLE = 140.0, 250.0
"""Angles on the pitch circles of the gears about the main axis at which their labels are placed, degrees."""

MARGIN = 24.0
"""Margins in a panel around the content, and additional space below, pixels."""


def draw_planetary_sheet(design: PlanetaryDesign, problem: PlanetaryProblem, title: str) -> str:
    """Draw a planetary train as a complete SVG document: one panel per plane."""
    mechanism, unit = design.mechanism, problem.length_unit
    gears = place_planetary_gears(mechanism)
    planes = sorted({plane for placed in gears for plane in placed.planes})
    height = PANEL_HEIGHT if len(planes) > 1 else SINGLE_HEIGHT
    parts, low = [], TOP
    for plane in planes:
        view = Viewport.fit(
            enclose_train(gears), Box(BORDER, low, BORDER + get_drawing_width(), low + height), MARGIN, MARGIN
        )
        shown = [placed for placed in gears if plane in placed.planes]
        parts.append(draw_planetary_panel(mechanism, view, shown, f"plane {plane}" if len(planes) > 1 else "", unit))
        low += height + PANEL_GAP
    tables, y = stack_blocks(_make_tables(design, problem))
    listed = ", ".join(f"{gear} {teeth}" for gear, teeth in mechanism.teeth.items())
    described = f"Pitch circles of a planetary train to scale, {mechanism.arrangement}: {listed} teeth."
    return write_sheet(title or "Planetary train", _describe_train(design), described, [*parts, *tables], max(low, y))


def enclose_train(gears: list[PlanetaryGear]) -> Box:
    """Return the box centred on the axis that contains all gears."""
    module = max((placed.gear.module for placed in gears), default=1.0)
    # Symmetric about the axis, so that all planes share one scale.
    reach = max((abs(placed.centre) + placed.gear.pitch_radius for placed in gears), default=1.0) + module
    return Box(-reach, -reach, reach, reach)


def _describe_train(design: PlanetaryDesign) -> str:
    mechanism = design.mechanism
    ratio = (
        f"{mechanism.ratio.numerator}/{mechanism.ratio.denominator} = {format_length(mechanism.ratio.value, digits=9)}"
    )
    parts = f"{mechanism.input} to {mechanism.output}, {mechanism.fixed} fixed".replace("_", " ")
    title = ARRANGEMENTS[mechanism.arrangement].title
    return f"{title.capitalize()}; {parts}, ratio {ratio}; {describe_verdict(design.verification)}".replace("-", "−")


def _choose_colour(placed: PlanetaryGear, mechanism: PlanetaryMechanism) -> str:
    colours = {mechanism.input: INPUT, mechanism.output: OUTPUT, mechanism.fixed: GROUND}
    arrangement = ARRANGEMENTS[mechanism.arrangement]
    return colours.get(placed.body, COUPLER if placed.body in arrangement.carriers else CURVE)


def draw_planetary_panel(
    mechanism: PlanetaryMechanism, view: Viewport, gears: list[PlanetaryGear], name: str, unit: str
) -> Element:
    """Draw the gears of one plane in a panel."""
    panel = view.panel
    group = draw_panel(panel, name or "main", PANEL_FILL)
    if name:
        group.add(draw_caption(panel, name))
    # Large gears first, so that small ones remain visible.
    for placed in sorted(gears, key=lambda p: -p.gear.pitch_radius):
        marks = {"data_gear": placed.name, "data_teeth": f"{placed.gear.teeth:g}", "data_copy": f"{placed.copy}"}
        group.add(
            draw_circles(placed.gear, placed.centre, view, _choose_colour(placed, mechanism), "pitch", 0.05, **marks)
        )
    arms = {placed.body: placed.centre for placed in gears if placed.centre and placed.copy == 0}
    for placed in gears:
        if placed.body in arms and placed.centre:
            start, end = view.point(0j), view.point(placed.centre)
            group.add(
                draw_line(start, end, stroke=GREY, stroke_width=3.0, stroke_opacity=0.35, data_carrier=placed.body)
            )
            group.add(draw_circle(end, 3.0, fill="#fff", stroke=GROUND, stroke_width=1.4))
    group.add(draw_circle(view.point(0j), 3.5, fill="#fff", stroke=GROUND, stroke_width=1.6))
    for placed in gears:
        if placed.copy == 0:
            group.add(_draw_label(placed, view, _choose_colour(placed, mechanism)))
    group.add(draw_scale_bar(view, unit)[0])
    return group


def _draw_label(placed: PlanetaryGear, view: Viewport, colour: str) -> Element:
    words = f"{placed.name.replace('_', ' ')} {placed.gear.teeth:g}"
    if placed.centre:
        at = view.point(placed.centre) + 16j
    else:
        degrees = RING_LABEL_ANGLE if placed.gear.internal else SUN_LABEL_ANGLE
        at = view.point(placed.pitch_radius * cmath.exp(1j * math.radians(degrees)))
    return draw_label(label_box(at, words), words, colour, placed.name)


def _name_plane(plane: int, widths: list[float | None] | None) -> str:
    """Return the name of a plane, if there are several."""
    return f" in plane {plane}" if widths is not None and len(widths) > 1 else ""


def _make_tables(design: PlanetaryDesign, problem: PlanetaryProblem) -> list[blocks.Block]:
    mechanism, metrics, unit = design.mechanism, design.metrics, problem.length_unit
    gears = [
        (name.replace("_", " "), f"{teeth} teeth, ⌀ {format_length(mechanism.module * teeth)} {unit}")
        for name, teeth in mechanism.teeth.items()
    ]
    shortened_rings = [
        (f"{name.replace('_', ' ')} addendum", f"{format_length(share)} modules")
        for name, share in mechanism.addendum.items()
        if share < 1.0
    ]
    speeds = [(body.replace("_", " "), format_length(speed)) for body, speed in metrics.speeds.items()]
    return [
        blocks.make_rows(
            "Gears",
            [
                *gears,
                ("planets", f"{mechanism.planets}"),
                ("module", f"{format_length(mechanism.module)} {unit}"),
                *shortened_rings,
                *(
                    (
                        f"face width{_name_plane(plane, mechanism.face_widths)}, a first estimate",
                        f"{format_length(width)} {unit}",
                    )
                    for plane, width in enumerate(mechanism.face_widths or [], 1)
                    if width is not None
                ),
            ],
        ),
        blocks.make_rows("Speeds over the input's", speeds),
        make_checks_block(design.verification, problem),
        blocks.make_rows(
            "Metrics", list_entries(metrics, problem, {"speeds"}, {"error": "relative error", "size": SIZE_TITLE})
        ),
    ]
