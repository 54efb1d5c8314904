"""The sheet of a mechanism whose output goes to and fro: both limit positions, tables, and the output over the turn."""

from __future__ import annotations

import math

import numpy as np

from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
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
from service.render.page.symbols import CURVE, OUTPUT
from synthesis.kinds.quick_return.design import QuickReturnDesign
from synthesis.kinds.quick_return.problem import QuickReturnProblem
from synthesis.kinds.quick_return.verification import OUTPUTS
from synthesis.model.answer import Check

HEIGHTS = (400.0, 700.0)
"""Least and greatest height of the drawing, pixels."""

SAMPLES = 721
"""Points of a diagram's curve."""

NAMES = {
    "fourbar": "Crank-rocker",
    "slider_crank": "Offset slider-crank",
    "crank_shaper": "Crank-shaper",
    "whitworth": "Whitworth quick return",
    "drag_link_rocker": "Drag-link sixbar with a rocker",
    "drag_link_slider": "Drag-link sixbar with a slider",
}
"""What the types are called on a sheet."""


def stroke_sheet(design: QuickReturnDesign, problem: QuickReturnProblem, title: str) -> str:
    """The drawing of a quick-return design as a complete SVG document."""
    mechanism = rebuilt(design)
    traced = [joint for joint in mechanism.joints if joint not in mechanism.links[GROUND] and joint != "P"]
    shown = Scene(mechanism, np.radians([target.input_angle for target in design.targets]), traced)
    name, unit = NAMES[design.mechanism.type], problem.length_unit
    words = (
        f"{name} with a time ratio of {length(design.metrics.time_ratio)}; lengths in {unit}; "
        f"{verdict(design.verification)}"
    )
    return driven_sheet(
        title or name,
        words,
        shown,
        shown.box(),
        unit,
        lambda view: [],
        _diagrams(design, mechanism, unit),
        _tables(design, problem, shown.box().diagonal),
        heights=HEIGHTS,
        subject="a mechanism at both limit positions of its output",
    )


def _diagrams(design: QuickReturnDesign, mechanism: Mechanism, unit: str) -> list[Diagram]:
    """The output and its rate over a turn of the crank from the beginning of the slow stroke."""
    start = math.radians(design.targets[0].input_angle)
    turned = np.linspace(0.0, 360.0, SAMPLES)
    motion = drive(mechanism, start + np.radians(turned), order=1)
    output = OUTPUTS[design.mechanism.type]
    if output in mechanism.links:
        place, rate = motion.angles[output]
        turned_by = np.unwrap(place)
        value, what, by = np.degrees(turned_by - turned_by[0]), "swing (°)", "output speed over crank speed"
    else:
        place, rate = motion.slides[output]
        value, what, by = place - place[0], f"stroke ({unit})", f"slider speed ({unit} per radian of the crank)"
    over = "over the crank's rotation from the first limit position"
    return [
        Diagram(f"{what} {over}", "output", turned, value, CURVE),
        Diagram(by, "rate", turned, rate, OUTPUT),
    ]


def _tables(design: QuickReturnDesign, problem: QuickReturnProblem, size: float) -> list[blocks.Block]:
    unit, metrics = problem.length_unit, design.metrics
    links = design.mechanism.links
    lengths = links if isinstance(links, dict) else links.model_dump()
    rows = [(name.replace("_", " "), length(value)) for name, value in lengths.items()]
    for name, (x, y) in design.mechanism.skeleton.joints.items():
        rows.append((f"{name} at the first limit", f"({length(x, size)}, {length(y, size)})"))
    for slide in design.mechanism.skeleton.slides:
        rows.append((f"slide of {slide.joint} on {slide.link}", angle(slide.angle)))
    swings = metrics.swing is not None
    limits = [
        (
            f"limit {target.index + 1}: crank {angle(target.input_angle, 3)}",
            angle(target.output, 3) if swings else f"{length(target.output, size)} {unit}",
        )
        for target in design.targets
    ]
    measured = [
        ("time ratio", length(metrics.time_ratio, digits=9)),
        ("crank rotation, slow and fast", f"{angle(metrics.slow_rotation)}, {angle(metrics.fast_rotation)}"),
        ("swing", angle(metrics.swing, 6)) if metrics.swing is not None else ("stroke", _stroke(metrics.stroke, unit)),
        *(
            (f"transmission at {link.replace('_', ' ')}", angle(value, 2))
            for link, value in metrics.transmission_angles.items()
        ),
        ("longest : shortest link", length(metrics.link_ratio, digits=4)),
        ("size", f"{length(metrics.size, digits=4)} {unit}"),
        ("quality", length(metrics.quality, digits=3)),
    ]
    return [
        blocks.rows(f"Dimensions ({unit})", rows),
        blocks.rows("Limits", limits),
        checks(design.verification, _written),
        blocks.rows("Metrics", measured),
    ]


def _stroke(value: float | None, unit: str) -> str:
    return f"{length(value or 0.0, digits=9)} {unit}"


def _written(check: Check, value: float) -> str:
    return angle(value, 2) if check.name == "transmission_angle" else small(value)
