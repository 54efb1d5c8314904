"""Drawings specific to function generators: the range of the input, the structural error, or the output."""

from __future__ import annotations

import cmath
import math

import numpy as np

from service.render.linkage.drawing import Scene
from service.render.linkage.motion import DrivenLinkage
from service.render.page.diagrams import Diagram
from service.render.page.svg import Element, Viewport, draw_path
from service.render.page.symbols import CURVE, INK, draw_arrow
from synthesis.kinds.function.design import FunctionDesign
from synthesis.kinds.function.problem import FunctionProblem

DIAGRAM_HEIGHT = 250.0
"""Height of the diagram, pixels."""

SAMPLE_COUNT = 181
"""Number of points of the output's curve."""

ARC_RADII = (24.0, 70.0)
"""Minimum and maximum radius of the arc that shows the input's range, pixels."""

ARC_SHARE, ARC_SAMPLES = 0.4, 60
"""Radius of that arc as a share of the crank, and its number of points."""


def draw_range_arc(design: FunctionDesign, scene: Scene, view: Viewport) -> list[Element]:
    """Draw an arc with an arrow from the input's first angle to its last."""
    joints = scene.get_joints(0)
    if not joints:
        return []
    stated = design.structural_error.curve.input_angle or [target.input_angle for target in design.targets]
    start, end = math.radians(stated[0]), math.radians(stated[-1])
    radius = max(min(ARC_SHARE * abs(joints["A"] - joints["O2"]) * view.scale, ARC_RADII[1]), ARC_RADII[0])
    arc = view.point(joints["O2"]) + radius * np.exp(-1j * np.linspace(start, end, ARC_SAMPLES))
    drawn = draw_path([arc], stroke=INK, stroke_width=1.4, data_range=repr(math.degrees(end - start)))
    head = draw_arrow(complex(arc[-4]), complex(arc[-1]), 3.6, INK)
    return [drawn, head] if drawn is not None else [head]


def make_function_diagram(design: FunctionDesign, problem: FunctionProblem, linkage: DrivenLinkage) -> Diagram:
    """Return the diagram of the structural error; for exact pairs, without an error curve, that of the output."""
    if problem.function is None and problem.aim == "precision":
        return _make_output_diagram(design, problem, linkage)
    # Pairs have errors only at themselves: draw stems instead of a curve.
    error, pairs = design.structural_error, problem.function is None
    x, e = np.array(error.curve.input), np.array(error.curve.error)
    unit = "degrees" if error.unit == "degrees" else problem.length_unit
    met = [] if pairs or problem.aim != "precision" else [complex(target.input) for target in design.targets]
    extremes = x + 1j * e if pairs else [complex(extreme.input, extreme.error) for extreme in error.extremes]
    return Diagram(
        f"Structural error, {unit}, over {'the input of the pairs' if pairs else 'x'}",
        "structural_error",
        x,
        e,
        CURVE,
        turned=False,
        stems=pairs,
        dots=extremes,
        rings=met,
        height=DIAGRAM_HEIGHT,
    )


def _make_output_diagram(design: FunctionDesign, problem: FunctionProblem, linkage: DrivenLinkage) -> Diagram:
    """Return the diagram of the output value over the input value from the driven linkage, with the required pairs."""
    dials = design.dials
    inputs = np.array([target.input for target in design.targets])
    pairs = np.array([target.output for target in design.targets])
    x = np.linspace(inputs.min(), inputs.max(), SAMPLE_COUNT)
    motion = linkage.drive_over(np.radians(dials.input.place + dials.input.scale * (x - dials.input.at)))
    # A slider's output is a place along its line, a rocker's an angle.
    if design.mechanism.type == "slider_crank":
        along = cmath.exp(-1j * math.radians(design.mechanism.slide.angle))
        places = ((motion.joints["B"][0] - motion.joints["O2"][0]) * along).real
    else:
        places = np.degrees(motion.angles["output"][0])
        # Angles are known only up to whole turns: unwrap them, and shift the curve to the first pair.
        places[motion.valid] = np.unwrap(places[motion.valid], period=360.0)
    y = dials.output.at + (places - dials.output.place) / dials.output.scale
    if design.mechanism.type != "slider_crank":
        turn = 360.0 / dials.output.scale
        y -= turn * np.round((y[np.abs(x - inputs[0]).argmin()] - pairs[0]) / turn)
    return Diagram(
        "Output over input, and the pairs",
        "output",
        x,
        y,
        CURVE,
        turned=False,
        from_zero=False,
        rings=inputs + 1j * pairs,
        height=DIAGRAM_HEIGHT,
    )
