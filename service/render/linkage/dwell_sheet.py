"""The sheet of a dwell sixbar: as a dwell begins and ends, the paths of P and D, the output over the turn."""

from __future__ import annotations

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
from service.render.page.svg import path
from service.render.page.symbols import (
    CURVE,
    DEMANDED,
    OUTPUT,
)
from synthesis.kinds.dwell.design import DwellDesign
from synthesis.kinds.dwell.problem import DwellProblem
from synthesis.model.answer import Check

SAMPLES = 721
"""Points of a diagram's curve, and of P's path during a dwell."""

NAMES = {
    "dwell_rocker": "Dwell sixbar with a rocker",
    "dwell_slider": "Dwell sixbar with a slider",
    "dwell_slot": "Dwell sixbar with a slotted rocker",
}
"""What the types are called on a sheet."""


def dwell_sheet(design: DwellDesign, problem: DwellProblem, title: str) -> str:
    """The drawing of a dwell design as a complete SVG document."""
    mechanism = rebuilt(design)
    begun = [math.radians(rest.input_angle) for rest in design.targets]
    rotation = math.radians(problem.dwell_angle)
    # The last place is that in which the output stands farthest from its first rest, or the second rest.
    away = begun[1] if len(begun) == 2 else begun[0] + 0.5 * rotation + math.pi
    traced = [name for name in ("P", "D") if name in mechanism.joints]
    shown = Scene(mechanism, np.array([begun[0], begun[0] + rotation, away]), traced)
    name, unit = NAMES[design.mechanism.type], problem.length_unit
    resting = [drive(mechanism, at + rotation * np.linspace(0.0, 1.0, SAMPLES), order=0).joints["P"][0] for at in begun]
    words = f"{name}, crank turns counter-clockwise; lengths in {unit}; {verdict(design.verification)}"
    return driven_sheet(
        title or name,
        words,
        shown,
        shown.box(),
        unit,
        lambda view: [
            drawn
            for points in resting
            if (drawn := path(view.shown(points), stroke=DEMANDED, stroke_width=2.6, data_curve="dwell")) is not None
        ],
        _diagrams(design, problem, mechanism),
        _tables(design, problem, shown.box().diagonal),
        [mark for at in begun for mark in _marks(at - begun[0], rotation)],
    )


def _marks(start: float, rotation: float) -> list[float]:
    """Where a dwell begins and ends, degrees from the beginning of the first."""
    return [math.degrees(start) % 360.0, math.degrees(start + rotation) % 360.0]


def _diagrams(design: DwellDesign, problem: DwellProblem, mechanism: Mechanism) -> list[Diagram]:
    """The output and its acceleration over a turn of the crank from where the first dwell begins."""
    turned = np.linspace(0.0, 360.0, SAMPLES)
    motion = drive(mechanism, math.radians(design.targets[0].input_angle) + np.radians(turned), order=2)
    over = "over the crank's rotation from the first dwell"
    if design.mechanism.type == "dwell_slider":
        jet = motion.slides["D"]
        place, what = jet[0], f"slider ({problem.length_unit}) {over}"
        bend = f"acceleration ({problem.length_unit}/rad²)"
    else:
        jet = motion.angles["output"]
        place, what = np.degrees(np.unwrap(jet[0])), f"output angle (°) {over}"
        bend = "angular acceleration (rad per rad² of the crank)"
    return [
        Diagram(what, "output", turned, place - place[0], CURVE),
        Diagram(bend, "acceleration", turned, jet[2], OUTPUT),
    ]


def _tables(design: DwellDesign, problem: DwellProblem, size: float) -> list[blocks.Block]:
    metrics, mechanism = design.metrics, design.mechanism
    slides = mechanism.type == "dwell_slider"
    unit = problem.length_unit

    def measure(value: float) -> str:
        return f"{length(value, digits=4)} {unit}" if slides else angle(value, 4)

    rows = [(name.replace("_", " "), length(value)) for name, value in mechanism.links.items()]
    rows += [
        ("coupler point A–P", length(mechanism.coupler_point.distance)),
        ("its angle from A–B", angle(mechanism.coupler_point.angle)),
        ("reference input angle", angle(mechanism.reference_input_angle)),
    ]
    for name, (x, y) in mechanism.skeleton.joints.items():
        rows.append((f"{name} there", f"({length(x, size)}, {length(y, size)})"))
    rows += [(f"slide of {slide.joint} on {slide.link}", angle(slide.angle)) for slide in mechanism.skeleton.slides]
    rests = []
    for rest in design.targets:
        rests += [
            (f"dwell {rest.index + 1} from", angle(rest.input_angle, 2)),
            ("jitter", measure(rest.jitter)),
            (f"width at {measure(problem.allowed)}", angle(rest.width, 2)),
        ]
    per = f"{unit}/rad²" if slides else "rad/rad²"
    measured = [
        ("stroke" if slides else "swing", measure(metrics.way)),
        ("peak acceleration", f"{length(metrics.peak_acceleration, digits=4)} {per}"),
        ("min transmission angle", angle(metrics.min_transmission_angle, 2)),
        ("longest : shortest link", length(metrics.link_ratio, digits=4)),
        ("size", f"{length(metrics.size, digits=4)} {unit}"),
        ("quality", length(metrics.quality, digits=3)),
    ]
    return [
        blocks.rows(f"Dimensions ({unit})", rows),
        blocks.rows("Dwells", rests),
        checks(design.verification, _written),
        blocks.rows("Metrics", measured),
    ]


def _written(check: Check, value: float) -> str:
    return angle(value, 2) if check.name == "transmission_angle" else small(value)
