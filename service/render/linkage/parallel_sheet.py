"""The sheet of a parallel motion: the sixbar at places of its range, the body's two paths, transmission angles."""

from __future__ import annotations

import math

import numpy as np

from kinematics.linkage.planar.drive import drive
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
from service.render.page.svg import line
from service.render.page.symbols import DEMANDED, OUTPUT
from synthesis.kinds.parallel_motion.design import ParallelMotionDesign
from synthesis.kinds.parallel_motion.problem import ParallelMotionProblem
from synthesis.model.answer import Check

NAME = "Watt sixbar for parallel motion"

PLACES = 4
"""Places of the range at which the sixbar is drawn; the body is drawn heavy at all of them."""

SAMPLES = 721
"""Points of a diagram's curve."""

BASES = {
    "source": "of the given fourbar",
    "left_cognate": "of its left cognate",
    "right_cognate": "of its right cognate",
    "path": "of a fourbar through the points",
}
"""What a sixbar is made of."""


def parallel_sheet(design: ParallelMotionDesign, problem: ParallelMotionProblem, title: str) -> str:
    """The drawing of a parallel-motion design as a complete SVG document."""
    mechanism = rebuilt(design)
    first, last = (math.radians(degrees) for degrees in design.metrics.input_range)
    shown = Scene(mechanism, np.linspace(first, last, PLACES + 1)[:-1], ["P", "Q"])
    unit, span = problem.length_unit, last - first
    turned = np.linspace(0.0, abs(span), SAMPLES)
    sines = drive(mechanism, first + math.copysign(1.0, span) * turned, order=0).sines
    diagrams = [
        Diagram(
            f"transmission angle at the {link} (°) over the input's rotation",
            f"transmission_{link}",
            np.degrees(turned),
            np.degrees(np.arcsin(np.minimum(np.abs(sine), 1.0))),
            OUTPUT,
            (),
            math.degrees(abs(span)),
        )
        for link, sine in sines.items()
    ]
    words = f"{NAME}, {BASES[design.metrics.base]}; lengths in {unit}; {verdict(design.verification)}"
    return driven_sheet(
        title or NAME,
        words,
        shown,
        shown.box(),
        unit,
        lambda view: [
            line(view.point(at["P"]), view.point(at["Q"]), stroke=DEMANDED, stroke_width=3.0, data_body=f"{k + 1}")
            for k in range(PLACES)
            if (at := shown.joints(k))
        ],
        diagrams,
        _tables(design, problem, shown.box().diagonal),
    )


def _tables(design: ParallelMotionDesign, problem: ParallelMotionProblem, size: float) -> list[blocks.Block]:
    metrics, mechanism, unit = design.metrics, design.mechanism, problem.length_unit
    rows = [(name.replace("_", " "), length(value)) for name, value in mechanism.links.items()]
    rows += [
        ("coupler point A–P", length(mechanism.coupler_point.distance)),
        ("its angle from A–B", angle(mechanism.coupler_point.angle)),
        ("reference input angle", angle(mechanism.reference_input_angle)),
    ]
    for name, (x, y) in mechanism.skeleton.joints.items():
        rows.append((f"{name} there", f"({length(x, size)}, {length(y, size)})"))
    measured = [
        ("rotation of the body", f"{small(metrics.rotation)}°"),
        ("Q from P", f"({length(metrics.translation[0], size)}, {length(metrics.translation[1], size)})"),
        ("input from", angle(metrics.input_range[0], 2)),
        ("to", angle(metrics.input_range[1], 2)),
        ("min transmission angle", angle(metrics.min_transmission_angle, 2)),
        ("longest : shortest link", length(metrics.link_ratio, digits=4)),
        ("size", f"{length(metrics.size, digits=4)} {unit}"),
        ("quality", length(metrics.quality, digits=3)),
    ]
    return [
        blocks.rows(f"Dimensions ({unit})", rows),
        checks(design.verification, _written),
        blocks.rows("Metrics", measured),
    ]


def _written(check: Check, value: float) -> str:
    return angle(value, 2) if check.name == "transmission_angle" else small(value)
