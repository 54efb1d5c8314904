"""The sheet of a planetary train: the pitch circles of each plane to scale, and tables beside them."""

from __future__ import annotations

import cmath
import math

from kinematics.gear.arrangements import ARRANGEMENTS
from service.render.gears.planetary_layout import PlacedPlanetaryGear, placed_planetary_gears
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
    scale_bar,
)
from synthesis.kinds.planetary_train.design import PlanetaryDesign
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.model.answer import Check

WIDTH, EDGE, TOP, COLUMN, GUTTER = 1100.0, 22.0, 74.0, 370.0, 26.0
"""Width of the sheet, border, height of the title, width of the tables' column, space beside it; pixels."""

LABEL = 11.5


def planetary_sheet(design: PlanetaryDesign, problem: PlanetaryProblem, title: str) -> str:
    """The drawing of a planetary train as a complete SVG document: one panel a plane."""
    mechanism, unit = design.mechanism, problem.length_unit
    gears = placed_planetary_gears(mechanism)
    heading = clean(title) or "Planetary train"
    planes = sorted({plane for placed in gears for plane in placed.planes})
    reach = max((abs(placed.centre) + placed.gear.pitch_radius for placed in gears), default=1.0) + mechanism.module
    width = WIDTH - 2.0 * EDGE - COLUMN - GUTTER
    height = 430.0 if len(planes) > 1 else 560.0
    parts, low = [], TOP
    for plane in planes:
        panel = Box(EDGE, low, EDGE + width, low + height)
        view = Viewport.fit(Box(-reach, -reach, reach, reach), panel, 24.0, 24.0)
        shown = [placed for placed in gears if plane in placed.planes]
        parts.append(_panel(design, view, shown, f"plane {plane}" if len(planes) > 1 else "", unit))
        low += height + 10.0
    y = TOP - 6.0
    for block in _tables(design, problem):
        drawn, y = block(WIDTH - EDGE - COLUMN, y, COLUMN)
        parts.append(drawn)
    bottom = math.ceil(max(low, y) + EDGE - 8.0)
    listed = ", ".join(f"{gear} {teeth}" for gear, teeth in mechanism.teeth.items())
    return document(
        heading,
        f"Pitch circles of a planetary train to scale, {mechanism.arrangement}: {listed} teeth.",
        (WIDTH, float(bottom)),
        text(EDGE, 34.0, shortened(heading, 20.0, WIDTH - 2.0 * EDGE), 20.0, font_weight="bold", fill=INK),
        text(EDGE, 55.0, _words(design), 12.5, fill=GREY),
        *parts,
    )


def _words(design: PlanetaryDesign) -> str:
    mechanism = design.mechanism
    ratio = f"{mechanism.ratio.numerator}/{mechanism.ratio.denominator} = {length(mechanism.ratio.value, digits=9)}"
    parts = f"{mechanism.input} to {mechanism.output}, {mechanism.fixed} fixed".replace("_", " ")
    failed = sum(not check.passed for check in design.verification.checks)
    verdict = f"fails {failed} checks" if failed else "passes all checks"
    title = ARRANGEMENTS[mechanism.arrangement].title
    return f"{title.capitalize()}; {parts}, ratio {ratio}; {verdict}".replace("-", "−")


def _colour(placed: PlacedPlanetaryGear, design: PlanetaryDesign) -> str:
    mechanism = design.mechanism
    colours = {mechanism.input: INPUT, mechanism.output: OUTPUT, mechanism.fixed: GROUND}
    arrangement = ARRANGEMENTS[mechanism.arrangement]
    return colours.get(placed.body, COUPLER if placed.body in arrangement.carriers else CURVE)


def _panel(design: PlanetaryDesign, view: Viewport, gears: list[PlacedPlanetaryGear], name: str, unit: str) -> Element:
    panel = view.panel
    group = element(
        "g",
        element("rect", x=panel.left, y=panel.low, width=panel.width, height=panel.height, fill="#fbfcfd", stroke=PALE),
        data_panel=name or "main",
    )
    if name:
        group.add(text(panel.left + 10.0, panel.low + 18.0, name, 11.0, fill=GREY))
    for placed in sorted(gears, key=lambda p: -p.gear.pitch_radius):
        at, colour = view.point(placed.centre), _colour(placed, design)
        group.add(
            element(
                "g",
                circle(at, view.scale * placed.gear.tip_radius, fill="none", stroke=colour, stroke_width=0.6),
                circle(
                    at,
                    view.scale * placed.gear.pitch_radius,
                    fill=colour,
                    fill_opacity=0.05,
                    stroke=colour,
                    stroke_width=1.6,
                    stroke_dasharray="9 3 2 3",
                ),
                data_gear=placed.name,
                data_teeth=f"{placed.gear.teeth:g}",
                data_copy=f"{placed.copy}",
            )
        )
    arms = {placed.body: placed.centre for placed in gears if placed.centre and placed.copy == 0}
    for placed in gears:
        if placed.body in arms and placed.centre:
            start, end = view.point(0j), view.point(placed.centre)
            group.add(line(start, end, stroke=GREY, stroke_width=3.0, stroke_opacity=0.35, data_carrier=placed.body))
            group.add(circle(end, 3.0, fill="#fff", stroke=GROUND, stroke_width=1.4))
    group.add(circle(view.point(0j), 3.5, fill="#fff", stroke=GROUND, stroke_width=1.6))
    for placed in gears:
        if placed.copy == 0:
            group.add(_label(placed, view, _colour(placed, design)))
    group.add(scale_bar(view, unit)[0])
    return group


def _label(placed: PlacedPlanetaryGear, view: Viewport, colour: str) -> Element:
    words = f"{placed.name.replace('_', ' ')} {placed.gear.teeth:g}"
    if placed.centre:
        at = view.point(placed.centre) + 16j
    else:
        at = view.point(
            placed.gear.pitch_radius * cmath.exp(1j * math.radians(140.0 if placed.gear.internal else 250.0))
        )
    half = 0.5 * text_width(words, LABEL) + 4.0
    box = element(
        "rect", x=at.real - half, y=at.imag - 9.0, width=2.0 * half, height=18.0, rx=3.0, fill="#fff", stroke=colour
    )
    words_at = text(at.real, at.imag + 4.2, words, LABEL, text_anchor="middle", fill=colour, font_weight="bold")
    return element("g", box, words_at, data_label=placed.name)


def _tables(design: PlanetaryDesign, problem: PlanetaryProblem) -> list[blocks.Block]:
    mechanism, metrics, unit = design.mechanism, design.metrics, problem.length_unit
    gears = [
        (name.replace("_", " "), f"{teeth} teeth, ⌀ {length(mechanism.module * teeth)} {unit}")
        for name, teeth in mechanism.teeth.items()
    ]
    shortened_rings = [
        (f"{name.replace('_', ' ')} addendum", f"{length(share)} modules")
        for name, share in mechanism.addendum.items()
        if share < 1.0
    ]
    speeds = [(body.replace("_", " "), length(speed)) for body, speed in metrics.speeds.items()]
    return [
        blocks.rows(
            "Gears",
            [
                *gears,
                ("planets", f"{mechanism.planets}"),
                ("module", f"{length(mechanism.module)} {unit}"),
                *shortened_rings,
            ],
        ),
        blocks.rows("Speeds over the input's", speeds),
        blocks.checks(design.verification, _written),
        blocks.rows(
            "Metrics",
            [
                ("relative error", small(metrics.error)),
                ("largest pitch diameter", f"{length(metrics.size)} {unit}"),
                ("efficiency", "locks itself" if metrics.self_locking else f"{100.0 * metrics.efficiency:.2f} %"),
                ("rolling power over input", length(metrics.rolling_power, digits=4)),
                ("power circulates", "yes" if metrics.circulating_power else "no"),
            ],
        ),
    ]


def _written(check: Check, value: float) -> str:
    return small(value) if check.name == "ratio" else length(value, digits=4)
