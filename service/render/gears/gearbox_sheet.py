"""The sheets of gearboxes: the ray diagram with a table of tooth numbers.

The ray diagram (Rao, Sec. 8.5) has a vertical line for each shaft and the logarithm of speed as ordinate. A ray for
each gear pair leads from every speed of its driving shaft to the resulting speed of the next shaft.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from service.render.checks import checks, verdict
from service.render.gears.marks import COLOURS, PAPER
from service.render.page import blocks
from service.render.page.numbers import length
from service.render.page.sheet import EDGE, TOP, beside, framed, sheet, stacked
from service.render.page.svg import Box, Element, circle, element, line, text, text_width
from service.render.page.symbols import INK, PALE
from synthesis.kinds.gearbox.design import GearboxDesign
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.layshaft_gearbox.design import LayshaftDesign
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem

COLUMN, HEIGHT = 400.0, 620.0
"""Width of the tables, and height of the diagram, pixels."""

LEFT, RIGHT, HEAD, FOOT = 70.0, 100.0, 50.0, 30.0
"""Margins around the rays: for the speeds at both sides, for the names of the shafts above, and below; pixels."""

SHAFT_NAME, SPEED = 11.5, 10.5
"""Font sizes of the names of the shafts, and of speeds and teeth, pixels."""

RAY_LABEL = 0.72
"""Position of a ray's tooth numbers as a share of its length, near the end, where the rays have separated."""


class _Ray(NamedTuple):
    """A ray from a speed of one shaft to a speed of the next; among rays of one pair only one has ``words``."""

    shaft: int
    start: float
    end: float
    words: str


def gearbox_sheet(design: GearboxDesign, problem: GearboxProblem, title: str) -> str:
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
        blocks.rows(
            f"Stage {k}",
            [(f"pair {j}", f"{pair.driver} : {pair.driven}") for j, pair in enumerate(stage.pairs, 1)]
            + [("shaft distance", f"{length(stage.centre_distance)} {problem.length_unit}")],
        )
        for k, stage in enumerate(mechanism.stages, 1)
    ]
    speeds = [
        (f"n{k}  {length(row.nominal, digits=5)}", f"{length(row.speed, digits=6)}  ({100.0 * row.error:+.2f} %)")
        for k, row in enumerate(metrics.speeds, 1)
    ]
    tables += [blocks.rows("Speeds, nominal and reached", speeds), checks(design.verification, problem)]
    words = f"Gearbox {mechanism.formula}, {len(metrics.speeds)} speeds; {verdict(design.verification)}"
    return _sheet(title or "Gearbox", words, _diagram(names, shafts, rays), tables)


def layshaft_sheet(design: LayshaftDesign, problem: LayshaftProblem, title: str) -> str:
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
        gears.append((f"gear {k}", f"{gear.layshaft} : {gear.mainshaft}, ratio {length(gear.ratio.value, digits=5)}"))
    if mechanism.reverse is not None:
        back = mechanism.reverse
        # The ratio of reverse is negative; the diagram shows the magnitude of the speed.
        main.append(-1.0 / back.ratio.value)
        rays.append(_Ray(1, head, main[-1], f"R {back.layshaft}/{back.idler}/{back.mainshaft}"))
        ratio = length(back.ratio.value, digits=5)
        gears.append(("reverse", f"{back.layshaft} : {back.idler} : {back.mainshaft}, ratio {ratio}"))
    tables = [
        blocks.rows(
            "Gears, layshaft to main shaft",
            [
                ("head pair", f"{mechanism.head.driver} : {mechanism.head.driven}"),
                *gears,
                ("shaft distance", f"{length(mechanism.centre_distance)} {problem.length_unit}"),
            ],
        ),
        checks(design.verification, problem),
    ]
    words = f"Layshaft gearbox, {len(mechanism.gears)} forward gears; {verdict(design.verification)}"
    diagram = _diagram(["input", "layshaft", "main shaft"], [[1.0], [head], sorted(set(main))], rays)
    return _sheet(title or "Layshaft gearbox", words, diagram, tables)


def _sheet(heading: str, words: str, diagram: Element, tables: Sequence[blocks.Block]) -> str:
    parts, y = stacked(tables, width=COLUMN)
    return sheet(heading, words, words, [diagram, *parts], max(TOP + HEIGHT, y))


def _diagram(names: Sequence[str], shafts: Sequence[Sequence[float]], rays: Sequence[_Ray]) -> Element:
    """Draw the ray diagram; equal heights are equal quotients of speeds."""
    panel = Box(EDGE, TOP, EDGE + beside(COLUMN), TOP + HEIGHT)
    every = [speed for speeds in shafts for speed in speeds]
    # A logarithmic scale makes rays of one pair parallel.
    low, high = math.log(min(every)), math.log(max(every))
    span = (high - low) or 1.0

    def point(shaft: int, speed: float) -> complex:
        across = panel.left + LEFT + (panel.width - LEFT - RIGHT) * shaft / (len(shafts) - 1)
        return complex(across, panel.high - FOOT - (panel.height - HEAD - FOOT) * (math.log(speed) - low) / span)

    group = framed(panel, "ray_diagram", PAPER)
    for speed in shafts[-1]:
        end = point(len(shafts) - 1, speed)
        group.add(line(complex(point(0, speed).real, end.imag), end, stroke=PALE, stroke_width=0.7))
    for k, name in enumerate(names):
        top, foot = complex(point(k, min(every)).real, panel.low + 34.0), point(k, min(every)) + 12j
        group.add(line(top, foot, stroke=INK, stroke_width=1.2))
        group.add(text(top.real, panel.low + 24.0, name, SHAFT_NAME, fill=INK, text_anchor="middle"))
    for ray in rays:
        start, end = point(ray.shaft, ray.start), point(ray.shaft + 1, ray.end)
        colour = COLOURS[ray.shaft % len(COLOURS)]
        group.add(line(start, end, stroke=colour, stroke_width=1.6, data_ray=f"{ray.start!r} {ray.end!r}"))
        if ray.words:
            group.add(_label(start + RAY_LABEL * (end - start), ray.words, colour))
    for k, speeds in enumerate(shafts):
        for speed in speeds:
            at = point(k, speed)
            group.add(circle(at, 3.2, fill="#fff", stroke=INK, stroke_width=1.3, data_node=f"{k + 1} {speed!r}"))
            if k in (0, len(shafts) - 1):
                offset, anchor = (10.0, "start") if k else (-10.0, "end")
                words = length(speed, digits=4)
                group.add(text(at.real + offset, at.imag + 4.0, words, SPEED, fill=INK, text_anchor=anchor))
    return group


def _label(at: complex, words: str, colour: str) -> Element:
    half = 0.5 * text_width(words, SPEED) + 2.0
    # A background keeps the label legible on its ray.
    clear = element("rect", x=at.real - half, y=at.imag - 7.0, width=2.0 * half, height=14.0, fill=PAPER)
    return element("g", clear, text(at.real, at.imag + 3.8, words, SPEED, fill=colour, text_anchor="middle"))
