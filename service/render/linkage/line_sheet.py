"""The sheet of a straight-line mechanism: at both ends and in the middle, the demanded line, deviation and velocity."""

from __future__ import annotations

import cmath
import math

import numpy as np

from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism
from service.render.checks import checks
from service.render.linkage.drawing import Scene
from service.render.linkage.driven_sheet import driven_sheet, verdict
from service.render.linkage.rebuilt import rebuilt
from service.render.page import blocks
from service.render.page.diagrams import Diagram
from service.render.page.numbers import (
    angle,
    length,
    small,
)
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    line,
)
from service.render.page.symbols import (
    CURVE,
    DEMANDED,
    OUTPUT,
)
from synthesis.kinds.straight_line.design import StraightLineDesign
from synthesis.kinds.straight_line.problem import StraightLineProblem
from synthesis.model.answer import Check

SAMPLES = 721
"""Points of a diagram's curve."""

NAMES = {
    "hoeken": "Hoeken's straight-line linkage",
    "chebyshev": "Chebyshev's straight-line linkage",
    "watt": "Watt's straight-line linkage",
    "roberts": "Roberts' straight-line linkage",
    "evans": "Evans' straight-line linkage",
    "peaucellier": "Peaucellier's inversor",
    "hart": "Hart's inversor",
    "scott_russell": "Scott-Russell's mechanism",
}
"""What the families are called on a sheet."""

PERCENT = frozenset({"velocity_variation"})
"""Checks whose value is a percentage."""


def line_sheet(design: StraightLineDesign, problem: StraightLineProblem, title: str) -> str:
    """The drawing of a straight-line design as a complete SVG document."""
    mechanism = rebuilt(design)
    first, last = (math.radians(target.input_angle) for target in design.targets)
    shown = Scene(mechanism, np.array([first, 0.5 * (first + last), last]), ["P"], "P")
    name, unit = NAMES[design.metrics.family], problem.length_unit
    start = complex(*problem.start)
    end = start + cmath.rect(problem.length, math.radians(problem.direction))
    places = [z for k in range(3) for z in shown.joints(k).values()]
    box = Box.around(np.concatenate([np.array([*places, start, end]), shown.used]))

    def demanded(view: Viewport) -> list[Element]:
        ends = view.point(start), view.point(end)
        return [line(*ends, stroke=DEMANDED, stroke_width=1.4, stroke_dasharray="6 4", data_line="demanded")]

    proportions = {"optimal": "best", "classical": "classical", "exact": "exact"}[design.metrics.proportions]
    words = f"{name}, {proportions} proportions; lengths in {unit}; {verdict(design.verification)}"
    return driven_sheet(
        title or name,
        words,
        shown,
        box,
        unit,
        demanded,
        _diagrams(mechanism, first, last, start, (end - start) / problem.length, unit),
        _tables(design, problem, box.diagonal),
    )


def _diagrams(
    mechanism: Mechanism, first: float, last: float, start: complex, along: complex, unit: str
) -> list[Diagram]:
    turned = np.linspace(0.0, abs(last - first), SAMPLES)
    sense = math.copysign(1.0, last - first)
    motion = drive(mechanism, first + sense * turned, order=1)
    point, rate = motion.joints["P"]
    span, at = math.degrees(abs(last - first)), np.degrees(turned)
    over = "over the input's rotation"
    across = ((point - start) * along.conjugate()).imag
    velocity = sense * (rate * along.conjugate()).real
    return [
        Diagram(f"distance from the line ({unit}) {over}", "deviation", at, across, CURVE, (), span),
        Diagram(f"velocity along the line ({unit}/rad) {over}", "velocity", at, velocity, OUTPUT, (), span),
    ]


def _tables(design: StraightLineDesign, problem: StraightLineProblem, size: float) -> list[blocks.Block]:
    unit, metrics = problem.length_unit, design.metrics
    links = design.mechanism.links
    lengths = links if isinstance(links, dict) else links.model_dump()
    rows = [(name.replace("_", " "), length(value)) for name, value in lengths.items()]
    for name, (x, y) in design.mechanism.skeleton.joints.items():
        rows.append((f"{name} at the start", f"({length(x, size)}, {length(y, size)})"))
    rows += [
        (f"slide of {slide.joint} on {slide.link}", angle(slide.angle)) for slide in design.mechanism.skeleton.slides
    ]
    ends = [
        (f"{what}: input {angle(target.input_angle)}", f"({length(target.x, size)}, {length(target.y, size)})")
        for what, target in zip(("start", "end"), design.targets, strict=True)
    ]
    measured = [
        ("greatest deviation", f"{small(metrics.deviation)} {unit}"),
        ("straightness error", f"{small(metrics.straightness_error)} %"),
        ("velocity variation", f"{length(metrics.velocity_variation, digits=4)} %"),
        ("mean velocity", f"{length(metrics.mean_velocity, digits=5)} {unit}/rad"),
        ("velocity in the middle", f"{length(metrics.middle_velocity, digits=5)} {unit}/rad"),
        ("input rotation", angle(metrics.input_rotation)),
        ("input turns fully", "yes" if metrics.full_rotation else "no"),
        ("min transmission angle", angle(metrics.min_transmission_angle, 2)),
        ("longest : shortest link", length(metrics.link_ratio, digits=4)),
        ("size", f"{length(metrics.size, digits=4)} {unit}"),
        ("quality", length(metrics.quality, digits=3)),
    ]
    return [
        blocks.rows(f"Dimensions ({unit})", rows),
        blocks.rows("Line", ends),
        checks(design.verification, _written),
        blocks.rows("Metrics", measured),
    ]


def _written(check: Check, value: float) -> str:
    if check.name == "transmission_angle":
        return angle(value, 2)
    return f"{small(value)} %" if check.name in PERCENT else small(value)
