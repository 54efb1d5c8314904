"""Gearboxes as files: the ray diagram with the tooth numbers beside it, and tables.

The ray diagram (Rao, Sec. 8.5) has a line for each shaft and the logarithm of the speed upwards; a ray for each pair of
gears goes from every speed of its driving shaft to the speed that it gives the next.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from typing import NamedTuple

from service.render.page import blocks
from service.render.page.numbers import length, small
from service.render.page.svg import (
    Box,
    Element,
    circle,
    clean,
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
    INK,
    INPUT,
    OUTPUT,
    PALE,
)
from synthesis.kinds.gearbox.design import GearboxDesign
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.layshaft_gearbox.design import LayshaftDesign
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem
from synthesis.model.answer import Check, Verification

WIDTH, EDGE, TOP, COLUMN, GUTTER, HEIGHT = 1100.0, 22.0, 74.0, 400.0, 26.0, 620.0
"""Width of the sheet, border, height of the title, width of the tables, space beside them, height of the diagram."""

RAY_LABEL = 0.72
"""Share of a ray's length at which its teeth stand, towards the end, where the rays have parted."""

COLOURS = (INPUT, OUTPUT, COUPLER, CURVE)
"""Of the stages."""


class _Ray(NamedTuple):
    """From a speed of one shaft to a speed of the next, by a pair of gears; ``words`` stand on one of equal rays."""

    shaft: int
    start: float
    end: float
    words: str


def gearbox_sheet(design: GearboxDesign, problem: GearboxProblem, title: str) -> str:
    """The ray diagram and tooth numbers of a machine-tool gearbox as a complete SVG document."""
    mechanism, metrics = design.mechanism, design.metrics
    rays = []
    for k, stage in enumerate(mechanism.stages):
        for speed in metrics.shafts[k].speeds:
            for pair in stage.pairs:
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
    tables += [blocks.rows("Speeds, nominal and reached", speeds), blocks.checks(design.verification, _written)]
    words = f"Gearbox {mechanism.formula}, {len(metrics.speeds)} speeds; {_verdict(design.verification)}"
    return _sheet(clean(title) or "Gearbox", words, _diagram(names, shafts, rays), tables)


def layshaft_sheet(design: LayshaftDesign, problem: LayshaftProblem, title: str) -> str:
    """The speeds of a layshaft gearbox, for an input of 1, as a ray diagram with the tooth numbers beside it."""
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
        blocks.checks(design.verification, _written),
    ]
    words = f"Layshaft gearbox, {len(mechanism.gears)} forward gears; {_verdict(design.verification)}"
    diagram = _diagram(["input", "layshaft", "main shaft"], [[1.0], [head], sorted(set(main))], rays)
    return _sheet(clean(title) or "Layshaft gearbox", words, diagram, tables)


def _verdict(verification: Verification) -> str:
    failed = sum(not check.passed for check in verification.checks)
    return f"fails {failed} checks" if failed else "passes all checks"


def _written(check: Check, value: float) -> str:
    return small(value) if check.name in ("speeds", "ratios") else length(value, digits=4)


def _sheet(heading: str, words: str, diagram: Element, tables: Sequence[blocks.Block]) -> str:
    parts, y = [], TOP - 6.0
    for block in tables:
        drawn, y = block(WIDTH - EDGE - COLUMN, y, COLUMN)
        parts.append(drawn)
    bottom = math.ceil(max(TOP + HEIGHT, y) + EDGE - 8.0)
    sheet = element(
        "svg",
        element("title", heading),
        element("desc", words),
        element("rect", x=0.0, y=0.0, width=WIDTH, height=float(bottom), fill="#fff"),
        text(EDGE, 34.0, shortened(heading, 20.0, WIDTH - 2.0 * EDGE), 20.0, font_weight="bold", fill=INK),
        text(EDGE, 55.0, words, 12.5, fill=GREY),
        diagram,
        *parts,
        xmlns="http://www.w3.org/2000/svg",
        role="img",
        width=WIDTH,
        height=float(bottom),
        viewBox=f"0 0 {WIDTH:g} {bottom}",
        font_family="sans-serif",
    )
    return sheet.write() + "\n"


def _diagram(names: Sequence[str], shafts: Sequence[Sequence[float]], rays: Sequence[_Ray]) -> Element:
    """The ray diagram: equal heights are equal quotients of speeds."""
    panel = Box(EDGE, TOP, WIDTH - EDGE - COLUMN - GUTTER, TOP + HEIGHT)
    every = [speed for speeds in shafts for speed in speeds]
    low, high = math.log(min(every)), math.log(max(every))
    span = (high - low) or 1.0

    def point(shaft: int, speed: float) -> complex:
        across = panel.left + 70.0 + (panel.width - 170.0) * shaft / (len(shafts) - 1)
        return complex(across, panel.high - 30.0 - (panel.height - 80.0) * (math.log(speed) - low) / span)

    group = element(
        "g",
        element("rect", x=panel.left, y=panel.low, width=panel.width, height=panel.height, fill="#fbfcfd", stroke=PALE),
        data_panel="ray_diagram",
    )
    for speed in shafts[-1]:
        end = point(len(shafts) - 1, speed)
        group.add(line(complex(point(0, speed).real, end.imag), end, stroke=PALE, stroke_width=0.7))
    for k, name in enumerate(names):
        top, foot = complex(point(k, min(every)).real, panel.low + 34.0), point(k, min(every)) + 12j
        group.add(line(top, foot, stroke=INK, stroke_width=1.2))
        group.add(text(top.real, panel.low + 24.0, name, 11.5, fill=INK, text_anchor="middle"))
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
                group.add(text(at.real + offset, at.imag + 4.0, words, 10.5, fill=INK, text_anchor=anchor))
    return group


def _label(at: complex, words: str, colour: str) -> Element:
    half = 0.5 * text_width(words, 10.5) + 2.0
    clear = element("rect", x=at.real - half, y=at.imag - 7.0, width=2.0 * half, height=14.0, fill="#fbfcfd")
    return element("g", clear, text(at.real, at.imag + 3.8, words, 10.5, fill=colour, text_anchor="middle"))


def gearbox_table(design: GearboxDesign, problem: GearboxProblem, title: str) -> str:
    """Every spindle speed with its nominal value, deviation and the pairs that are engaged."""
    mechanism = design.mechanism
    written = io.StringIO()
    table = csv.writer(written, lineterminator="\r\n")
    stages = [f"stage_{k}_driver_driven" for k in range(1, len(mechanism.stages) + 1)]
    table.writerow(["speed_rpm", "nominal_rpm", "standard_rpm", "error", *stages])
    for row in design.metrics.speeds:
        pairs = [stage.pairs[at] for stage, at in zip(mechanism.stages, row.engaged, strict=True)]
        standard = "" if row.standard is None else repr(row.standard)
        engaged = [f"{pair.driver}/{pair.driven}" for pair in pairs]
        table.writerow([repr(row.speed), repr(row.nominal), standard, repr(row.error), *engaged])
    return written.getvalue()


def layshaft_table(design: LayshaftDesign, problem: LayshaftProblem, title: str) -> str:
    """Every gear with its teeth, its ratio and the error of it; the head pair comes first."""
    mechanism, errors = design.mechanism, design.metrics.errors
    written = io.StringIO()
    table = csv.writer(written, lineterminator="\r\n")
    table.writerow(["gear", "layshaft", "idler", "mainshaft", "ratio", "error"])
    table.writerow(["head", mechanism.head.driven, "", mechanism.head.driver, "", ""])
    for k, (gear, error) in enumerate(zip(mechanism.gears, errors, strict=False), 1):
        teeth = (gear.layshaft, gear.mainshaft) if gear.layshaft is not None else ("", "")
        table.writerow([k, teeth[0], "", teeth[1], repr(gear.ratio.value), repr(error)])
    if mechanism.reverse is not None:
        back = mechanism.reverse
        table.writerow(["reverse", back.layshaft, back.idler, back.mainshaft, repr(back.ratio.value), repr(errors[-1])])
    return written.getvalue()
