"""The sheet of any linkage that guides a body and has no sheet of its own: drawn at the targets, with tables."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.branches import cycle
from kinematics.linkage.planar.mechanism import Mechanism
from service.render.checks import checks
from service.render.linkage import fourbar_tables as tables
from service.render.linkage.drawing import Scene, drawing
from service.render.linkage.rebuilt import rebuilt
from service.render.page import blocks
from service.render.page.numbers import (
    angle,
    length,
    small,
)
from service.render.page.svg import (
    Box,
    Viewport,
    clean,
    document,
    shortened,
    text,
)
from service.render.page.symbols import GREY, INK
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage_answer import LinkageDesign

WIDTH, EDGE, TOP, COLUMN, GUTTER = 1100.0, 22.0, 74.0, 370.0, 26.0
"""Width of the sheet, border, height of the title, width of the tables' column, space beside it; pixels."""

HEIGHTS = (460.0, 860.0)
"""Least and greatest height of the drawing, pixels."""

MOST_ROWS = 12
"""Targets that are listed."""

NAMES = {
    "slider_crank": "Slider-crank",
    "geared_fivebar": "Geared fivebar",
    "inverted_slider_crank": "Inverted slider-crank",
    "watt_2": "Fourbar with a driver dyad (Watt's sixbar)",
    "stephenson_3": "Fourbar with a driver dyad on its coupler (Stephenson's sixbar)",
}
"""What the types are called on a sheet."""


def linkage_sheet(design: LinkageDesign, problem: MotionProblem | PathProblem, title: str) -> str:
    """The drawing of a linkage design as a complete SVG document."""
    mechanism = rebuilt(design)
    stated = np.array([target.input_angle for target in design.targets])
    inputs = stated if mechanism.driven_by_slide else np.radians(stated)
    shown = _scene(mechanism, inputs, problem)
    heading = title or NAMES[design.mechanism.type]
    width = WIDTH - 2.0 * EDGE - COLUMN - GUTTER
    box = shown.box()
    wanted = (width - 100.0) / max(box.width, 1e-12) * box.height + 130.0
    height = min(max(wanted, HEIGHTS[0]), HEIGHTS[1])
    view = Viewport.fit(box, Box(EDGE, TOP, EDGE + width, TOP + math.floor(height)), 50.0, 26.0)
    parts = [drawing(shown, view, problem.length_unit)]
    y = TOP - 6.0
    for block in _tables(design, problem, box.diagonal):
        drawn, y = block(WIDTH - EDGE - COLUMN, y, COLUMN)
        parts.append(drawn)
    bottom = math.ceil(max(view.panel.high, y) + EDGE - 8.0)
    failed = [clean(c.name.replace("_", " ")) for c in design.verification.checks if not c.passed]
    verdict = f"fails {len(failed)} of {len(design.verification.checks)} checks" if failed else "passes all checks"
    words = f"{NAMES[design.mechanism.type]}; lengths in {problem.length_unit}; {verdict}"
    return document(
        heading,
        f"Drawing of a linkage at {len(shown.inputs)} targets. {words}.",
        (WIDTH, float(bottom)),
        text(EDGE, 34.0, shortened(heading, 20.0, WIDTH - 2.0 * EDGE), 20.0, font_weight="bold", fill=INK),
        text(EDGE, 55.0, words, 12.5, fill=GREY),
        *parts,
    )


def _scene(mechanism: Mechanism, inputs: NDArray[np.float64], problem: MotionProblem | PathProblem) -> Scene:
    """The linkage at its targets; along a curve that is drawn as a whole, at its first and last point."""
    if isinstance(problem, MotionProblem):
        return Scene(mechanism, inputs, ["P"], "P", problem.positions)
    if not problem.matched:
        return Scene(mechanism, inputs, ["P"], "P", problem.points)
    target = np.array([point.point for point in problem.points])
    last = inputs[-1]
    if problem.closed:
        target, last = np.append(target, target[0]), inputs[0] + cycle(mechanism)
    return Scene(mechanism, np.array([inputs[0], last]), ["P"], "P", problem.points[:1], target)


def _tables(design: LinkageDesign, problem: MotionProblem | PathProblem, size: float) -> list[blocks.Block]:
    unit = problem.length_unit
    links = design.mechanism.links
    lengths = links if isinstance(links, dict) else links.model_dump()
    rows = [(name.replace("_", " "), length(value)) for name, value in lengths.items()]
    for name, (x, y) in design.mechanism.skeleton.joints.items():
        rows.append((f"{name} at the first target", f"({length(x, size)}, {length(y, size)})"))
    for gear in design.mechanism.skeleton.gears:
        rows.append((f"gear ratio {' : '.join(reversed(gear.links))}", f"{gear.ratio:g}"))
    for slide in design.mechanism.skeleton.slides:
        rows.append((f"slide of {slide.joint} on {slide.link}", angle(slide.angle)))
    slides = design.mechanism.skeleton.input_link in design.mechanism.skeleton.joints
    met = [
        (
            f"{target.index + 1}: input {length(target.input_angle) if slides else angle(target.input_angle, 2)}",
            f"off by {small(target.point_residual)} {unit}"
            + ("" if target.angle_residual is None else f", {angle(target.angle_residual, 2)}"),
        )
        for target in design.targets[:MOST_ROWS]
    ]
    if len(design.targets) > MOST_ROWS:
        met.append((f"and {len(design.targets) - MOST_ROWS} more", ""))
    least = [
        (f"transmission at {link.replace('_', ' ')}", angle(value, 2))
        for link, value in design.metrics.transmission_angles.items()
    ]
    return [
        blocks.rows(f"Dimensions ({unit})", rows),
        blocks.rows("Targets", met),
        checks(design.verification, tables.written_check),
        blocks.rows("Least angles", least),
        tables.metrics(design, unit),
    ]
