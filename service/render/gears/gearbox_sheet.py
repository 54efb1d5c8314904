"""The sheets of gearboxes: the ray diagram with a table of tooth numbers.

The ray diagram (Rao, Sec. 8.5) has a vertical line for each shaft and the logarithm of speed as ordinate. A ray for
each gear pair leads from every speed of its driving shaft to the resulting speed of the next shaft.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from service.render.checks import describe_verdict, make_checks_block
from service.render.gears.marks import PANEL_FILL, STAGE_COLOURS
from service.render.page import blocks
from service.render.page.numbers import format_length
from service.render.page.sheet import BORDER, TOP, draw_panel, get_drawing_width, stack_blocks, write_sheet
from service.render.page.svg import Box, Element, draw_circle, draw_line, draw_text, estimate_text_width, make_element
from service.render.page.symbols import INK, PALE
from synthesis.kinds.gearbox.design import GearboxDesign
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.layshaft_gearbox.design import LayshaftDesign
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem

TABLE_WIDTH, DIAGRAM_HEIGHT = 400.0, 620.0
"""Width of the tables, and height of the diagram, pixels."""

MARGIN_LEFT, MARGIN_RIGHT, MARGIN_ABOVE, MARGIN_BELOW = 70.0, 100.0, 50.0, 30.0
"""Margins around the rays: for the speeds at both sides, for the names of the shafts above, and below; pixels."""

SHAFT_FONT_SIZE, SPEED_FONT_SIZE = 11.5, 10.5
"""Font sizes of the names of the shafts, and of speeds and teeth, pixels."""

RAY_LABEL_SHARE = 0.72
"""Position of a ray's tooth numbers as a share of its length, near the end, where the rays have separated."""


class _Ray(NamedTuple):
    """A ray from a speed of one shaft to a speed of the next; among rays of one pair only one has ``words``."""

    shaft: int
    start: float
    end: float
    words: str


def draw_gearbox_sheet(design: GearboxDesign, problem: GearboxProblem, title: str) -> str:
    """Draw the ray diagram and tooth numbers of a machine-tool gearbox as a complete SVG document."""
    mechanism, metrics = design.mechanism, design.metrics
    rays = []
    for k, stage in enumerate(mechanism.stages):
        for speed in metrics.shafts[k].speeds:
            for pair in stage.pairs:
                # Parallel rays of a pair are labelled once, at the highest speed.
                words = f"{pair.driver}/{pair.driven}" if speed == metrics.shafts[k].speeds[-1] else ""
                rays.append(_Ray(k, speed, speed * pair.driver / pair.driven, words))
    shafts = [shaft.speeds for shaft in metrics.shafts]
    names = ["input", *(f"shaft {k}" for k in range(2, len(shafts))), "spindle"]
    tables = [
        blocks.make_rows(
            f"Stage {k}",
            [(f"pair {j}", f"{pair.driver} : {pair.driven}") for j, pair in enumerate(stage.pairs, 1)]
            + [("shaft distance", f"{format_length(stage.centre_distance)} {problem.length_unit}")],
        )
        for k, stage in enumerate(mechanism.stages, 1)
    ]
    speeds = [
        (
            f"n{k}  {format_length(row.nominal, digits=5)}",
            f"{format_length(row.speed, digits=6)}  ({100.0 * row.error:+.2f} %)",
        )
        for k, row in enumerate(metrics.speeds, 1)
    ]
    tables += [blocks.make_rows("Speeds, nominal and reached", speeds), make_checks_block(design.verification, problem)]
    words = f"Gearbox {mechanism.formula}, {len(metrics.speeds)} speeds; {describe_verdict(design.verification)}"
    return _write_sheet(title or "Gearbox", words, _draw_diagram(names, shafts, rays), tables)


def draw_layshaft_sheet(design: LayshaftDesign, problem: LayshaftProblem, title: str) -> str:
    """Draw the speeds of a layshaft gearbox, for an input of 1, as a ray diagram with a table of tooth numbers."""
    mechanism = design.mechanism
    head = mechanism.head.driver / mechanism.head.driven
    rays = [_Ray(0, 1.0, head, f"{mechanism.head.driver}/{mechanism.head.driven}")]
    main = []
    gears = []
    for k, gear in enumerate(mechanism.gears, 1):
        speed = 1.0 / gear.ratio.value
        main.append(speed)
        if gear.layshaft is None or gear.mainshaft is None:
            gears.append((f"gear {k}", "direct drive"))
            continue
        rays.append(_Ray(1, head, speed, f"{gear.layshaft}/{gear.mainshaft}"))
        gears.append(
            (f"gear {k}", f"{gear.layshaft} : {gear.mainshaft}, ratio {format_length(gear.ratio.value, digits=5)}")
        )
    if mechanism.reverse is not None:
        back = mechanism.reverse
        # The ratio of reverse is negative; the diagram shows the magnitude of the speed.
        main.append(-1.0 / back.ratio.value)
        rays.append(_Ray(1, head, main[-1], f"R {back.layshaft}/{back.idler}/{back.mainshaft}"))
        ratio = format_length(back.ratio.value, digits=5)
        gears.append(("reverse", f"{back.layshaft} : {back.idler} : {back.mainshaft}, ratio {ratio}"))
    tables = [
        blocks.make_rows(
            "Gears, layshaft to main shaft",
            [
                ("head pair", f"{mechanism.head.driver} : {mechanism.head.driven}"),
                *gears,
                ("shaft distance", f"{format_length(mechanism.centre_distance)} {problem.length_unit}"),
            ],
        ),
        make_checks_block(design.verification, problem),
    ]
    words = f"Layshaft gearbox, {len(mechanism.gears)} forward gears; {describe_verdict(design.verification)}"
    diagram = _draw_diagram(["input", "layshaft", "main shaft"], [[1.0], [head], sorted(set(main))], rays)
    return _write_sheet(title or "Layshaft gearbox", words, diagram, tables)


def _write_sheet(heading: str, words: str, diagram: Element, tables: Sequence[blocks.Block]) -> str:
    parts, y = stack_blocks(tables, width=TABLE_WIDTH)
    return write_sheet(heading, words, words, [diagram, *parts], max(TOP + DIAGRAM_HEIGHT, y))


def _draw_diagram(names: Sequence[str], shafts: Sequence[Sequence[float]], rays: Sequence[_Ray]) -> Element:
    """Draw the ray diagram; equal heights are equal quotients of speeds."""
    panel = Box(BORDER, TOP, BORDER + get_drawing_width(TABLE_WIDTH), TOP + DIAGRAM_HEIGHT)
    every = [speed for speeds in shafts for speed in speeds]
    # A logarithmic scale makes rays of one pair parallel.
    low, high = math.log(min(every)), math.log(max(every))
    span = (high - low) or 1.0

    def find_point(shaft: int, speed: float) -> complex:
        across = panel.left + MARGIN_LEFT + (panel.width - MARGIN_LEFT - MARGIN_RIGHT) * shaft / (len(shafts) - 1)
        return complex(
            across,
            panel.high - MARGIN_BELOW - (panel.height - MARGIN_ABOVE - MARGIN_BELOW) * (math.log(speed) - low) / span,
        )

    group = draw_panel(panel, "ray_diagram", PANEL_FILL)
    for speed in shafts[-1]:
        end = find_point(len(shafts) - 1, speed)
        group.add(draw_line(complex(find_point(0, speed).real, end.imag), end, stroke=PALE, stroke_width=0.7))
    for k, name in enumerate(names):
        top, foot = complex(find_point(k, min(every)).real, panel.low + 34.0), find_point(k, min(every)) + 12j
        group.add(draw_line(top, foot, stroke=INK, stroke_width=1.2))
        group.add(draw_text(top.real, panel.low + 24.0, name, SHAFT_FONT_SIZE, fill=INK, text_anchor="middle"))
    for ray in rays:
        start, end = find_point(ray.shaft, ray.start), find_point(ray.shaft + 1, ray.end)
        colour = STAGE_COLOURS[ray.shaft % len(STAGE_COLOURS)]
        group.add(draw_line(start, end, stroke=colour, stroke_width=1.6, data_ray=f"{ray.start!r} {ray.end!r}"))
        if ray.words:
            group.add(_draw_label(start + RAY_LABEL_SHARE * (end - start), ray.words, colour))
    for k, speeds in enumerate(shafts):
        for speed in speeds:
            at = find_point(k, speed)
            group.add(draw_circle(at, 3.2, fill="#fff", stroke=INK, stroke_width=1.3, data_node=f"{k + 1} {speed!r}"))
            if k in (0, len(shafts) - 1):
                offset, anchor = (10.0, "start") if k else (-10.0, "end")
                words = format_length(speed, digits=4)
                group.add(
                    draw_text(at.real + offset, at.imag + 4.0, words, SPEED_FONT_SIZE, fill=INK, text_anchor=anchor)
                )
    return group


def _draw_label(at: complex, words: str, colour: str) -> Element:
    half = 0.5 * estimate_text_width(words, SPEED_FONT_SIZE) + 2.0
    # A background keeps the label legible on its ray.
    clear = make_element("rect", x=at.real - half, y=at.imag - 7.0, width=2.0 * half, height=14.0, fill=PANEL_FILL)
    return make_element(
        "g", clear, draw_text(at.real, at.imag + 3.8, words, SPEED_FONT_SIZE, fill=colour, text_anchor="middle")
    )
