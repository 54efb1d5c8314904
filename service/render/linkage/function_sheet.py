"""The sheet of a function generator: the linkage at its targets, the diagram of its structural error, and tables.

Positions come from the analysis core, which drives the mechanism by its dimensions. The linkage stands bold at the
first target and pale at the others; the range of the input is an arc at O2. Below it the structural error is drawn over
the input, as it was measured on the driven linkage, with its extremes marked.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism
from service.render.checks import checks
from service.render.linkage.drawing import framed
from service.render.linkage.rebuilt import rebuilt
from service.render.page import blocks
from service.render.page.blocks import Block
from service.render.page.diagrams import ticks
from service.render.page.labels import Labels
from service.render.page.numbers import (
    angle,
    length,
    small,
)
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    circle,
    clean,
    document,
    element,
    line,
    path,
    polygon,
    shortened,
    text,
)
from service.render.page.symbols import (
    COUPLER,
    CURVE,
    DEMANDED,
    GREY,
    GROUND,
    INK,
    INPUT,
    OUTPUT,
    PALE,
    arrow,
    bearing,
    scale_bar,
)
from synthesis.kinds.function.design import FunctionDesign
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.model.answer import Check

WIDTH, EDGE, TOP, COLUMN, GUTTER = 1100.0, 22.0, 74.0, 370.0, 26.0
"""Width of the sheet, border, height of the title, width of the tables' column, space beside it; pixels."""

HEIGHTS = (380.0, 640.0)
"""Least and greatest height of the drawing, pixels."""

DIAGRAM = 250.0
"""Height of the error diagram, pixels."""

SHOWN = 12
"""Configurations that are drawn at most, and rows of the targets' table."""

RAIL = 0.12
"""A slide's rail goes on beyond the places of its block by this share of the drawing's diagonal."""

NAMES = {"fourbar": "Fourbar function generator", "slider_crank": "Slider-crank function generator"}

ANGLES = frozenset({"transmission_angle"})


def function_sheet(design: FunctionDesign, problem: FunctionProblem, title: str) -> str:
    """The drawing of a function generator as a complete SVG document."""
    joints, valid = _joints(design)
    heading = title or NAMES[design.mechanism.type]
    width = WIDTH - 2.0 * EDGE - COLUMN - GUTTER
    box = Box.around(np.concatenate([places[np.isfinite(places)] for places in joints.values()]))
    wanted = (width - 100.0) / max(box.width, 1e-12 * abs(box.centre), 1e-300) * box.height + 130.0
    height = min(max(wanted, HEIGHTS[0]), HEIGHTS[1])
    view = Viewport.fit(box, Box(EDGE, TOP, EDGE + width, TOP + math.floor(height)), 50.0, 26.0)
    below = view.panel.high + 14.0
    # Pairs that are met have no error to be drawn.
    met = problem.function is None and problem.aim == "precision"
    diagram = _output_diagram if met else _error_diagram
    parts = [
        _drawing(design, joints, valid, view, problem.length_unit),
        diagram(design, problem, Box(EDGE, below, EDGE + width, below + DIAGRAM)),
    ]
    y = TOP - 6.0
    for block in _tables(design, problem):
        drawn, y = block(WIDTH - EDGE - COLUMN, y, COLUMN)
        parts.append(drawn)
    bottom = math.ceil(max(below + DIAGRAM, y) + EDGE - 8.0)
    failed = [clean(c.name.replace("_", " ")) for c in design.verification.checks if not c.passed]
    verdict = f"fails {len(failed)} of {len(design.verification.checks)} checks" if failed else "passes all checks"
    words = f"{NAMES[design.mechanism.type]}; lengths in {problem.length_unit}; {verdict}"
    error = f"Structural error at most {_written(design, design.structural_error.max, problem.length_unit)}."
    return document(
        heading,
        f"Drawing of a linkage at {len(design.targets)} targets. {words}. {error}",
        (WIDTH, float(bottom)),
        text(EDGE, 34.0, shortened(heading, 20.0, WIDTH - 2.0 * EDGE), 20.0, font_weight="bold", fill=INK),
        text(EDGE, 55.0, words, 12.5, fill=GREY),
        *parts,
    )


def _mechanism(design: FunctionDesign) -> Mechanism:
    return rebuilt(design, without={"skeleton"})


def _slide_angle(design: FunctionDesign) -> float:
    """Angle of the slide's line, degrees; 0 where there is none."""
    return design.mechanism.slide.angle if design.mechanism.type == "slider_crank" else 0.0


def _joints(design: FunctionDesign) -> tuple[dict[str, NDArray[np.complex128]], NDArray[np.bool_]]:
    """Joints at the targets that are drawn, shape (n,), and where there are any."""
    mechanism = _mechanism(design)
    targets = design.targets
    chosen = np.unique(np.linspace(0, len(targets) - 1, min(SHOWN, len(targets))).astype(int))
    motion = drive(mechanism, np.radians([targets[k].input_angle for k in chosen]), order=0)
    names = [name for name in motion.joints if name != "P"]
    return {name: np.where(motion.valid, motion.joints[name][0], np.nan) for name in names}, motion.valid


def _drawing(
    design: FunctionDesign,
    joints: dict[str, NDArray[np.complex128]],
    valid: NDArray[np.bool_],
    view: Viewport,
    unit: str,
) -> Element:
    panel = view.panel
    group = framed(panel)
    labels = Labels(panel.grown(-3.0))
    tilt = math.radians(_slide_angle(design))
    if "O4" not in joints:
        group.add(_rail(design, joints["B"], view))
    else:
        ends = view.point(complex(joints["O2"][0])), view.point(complex(joints["O4"][0]))
        group.add(line(*ends, stroke=GROUND, stroke_width=1.3, stroke_dasharray="12 4 2 4", data_link="ground"))
    for k in range(len(valid) - 1, -1, -1):
        if valid[k]:
            group.add(_configuration({name: view.point(complex(z[k])) for name, z in joints.items()}, k, tilt, labels))
    group.add(*_range_arc(design, view, complex(joints["O2"][0]), abs(complex(joints["A"][0] - joints["O2"][0]))))
    for name, places in joints.items():
        if valid[0]:
            labels.place(
                view.point(complex(places[0])), name[0], 13.0, subscript=name[1:], clearance=8.0, away=-1j,
                style={"fill": INK, "font-weight": "bold"},
            )  # fmt: skip
    bar, covered = scale_bar(view, unit)
    labels.reserve(covered)
    return group.add(*labels.drawn, bar)


def _configuration(at: dict[str, complex], k: int, tilt: float, labels: Labels) -> Element:
    """The linkage at one target: bold at the first, pale at the others; the slide's angle in radians."""
    first = k == 0
    group = element("g", data_configuration=f"{k + 1}", stroke_linecap="round")
    links = [("input", "O2", "A", INPUT), ("coupler", "A", "B", COUPLER)]
    if "O4" in at:
        links.append(("output", "O4", "B", OUTPUT))
    for name, one, other, colour in links:
        style = (colour, 5.0 if name != "coupler" else 3.6) if first else (PALE, 2.0)
        group.add(line(at[one], at[other], stroke=style[0], stroke_width=style[1], data_link=name))
        labels.avoid([np.array([at[one], at[other]])], 2.0 if first else 0.3)
    if "O4" not in at:
        half = (13.0, 8.0) if first else (9.0, 5.0)
        along = cmath.exp(-1j * tilt)
        corners = [at["B"] + complex(x * half[0], y * half[1]) * along for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        group.add(polygon(corners, fill="#fff", stroke=OUTPUT if first else PALE, stroke_width=1.8, data_slide="B"))
    if first:
        for name in ("O2", "O4"):
            if name in at:
                symbol, lines = bearing(at[name], 1.0)
                labels.avoid(lines, 1.5)
                group.add(symbol)
        for name, place in at.items():
            group.add(circle(place, 4.5, fill="#fff", stroke=INK, stroke_width=1.6, data_joint=name))
    return group


def _rail(design: FunctionDesign, places: NDArray[np.complex128], view: Viewport) -> Element:
    """The slide's line over all places of its block."""
    known = places[np.isfinite(places)]
    along = cmath.exp(1j * math.radians(_slide_angle(design)))
    way = ((known - known[0]) * along.conjugate()).real
    beyond = RAIL * max(float(np.ptp(way)), view.panel.width / view.scale)
    ends = [view.point(complex(known[0] + along * t)) for t in (float(way.min()) - beyond, float(way.max()) + beyond)]
    return line(*ends, stroke=GROUND, stroke_width=1.4, stroke_dasharray="9 3 2 3", data_rail="B")


def _range_arc(design: FunctionDesign, view: Viewport, pivot: complex, crank: float) -> list[Element]:
    """An arc with an arrow from the input's first angle to its last."""
    curve = design.structural_error.curve.input_angle or [target.input_angle for target in design.targets]
    start, end = math.radians(curve[0]), math.radians(curve[-1])
    radius = max(min(0.4 * crank * view.scale, 70.0), 24.0)
    arc = view.point(pivot) + radius * np.exp(-1j * np.linspace(start, end, 60))
    drawn = path([arc], stroke=INK, stroke_width=1.4, data_range=repr(math.degrees(end - start)))
    head = arrow(complex(arc[-4]), complex(arc[-1]), 3.6, INK)
    return [drawn, head] if drawn is not None else [head]


def _error_diagram(design: FunctionDesign, problem: FunctionProblem, box: Box) -> Element:
    """Structural error over the values of the input, with its extremes, and the precision points."""
    error = design.structural_error
    x, e = np.array(error.curve.input), np.array(error.curve.error)
    unit = "degrees" if error.unit == "degrees" else problem.length_unit
    heading = f"Structural error, {unit}, over {'the input of the pairs' if problem.function is None else 'x'}"
    values = [*e, *(extreme.error for extreme in error.extremes), 0.0]
    axes = _Axes(box, (float(x.min()), float(x.max())), values)
    group = axes.drawn(heading, "structural_error")
    points = axes.at(x, e)
    if problem.function is not None:
        group.add(path([points], stroke=CURVE, stroke_width=1.6, stroke_linejoin="round", data_curve="error"))
        for extreme in error.extremes:
            place = complex(axes.at(np.array(extreme.input), np.array(extreme.error)))
            group.add(circle(place, 2.6, fill=CURVE, data_extreme=repr(extreme.input)))
        met = [target.input for target in design.targets] if problem.aim == "precision" else []
        for value in met:
            place = complex(axes.at(np.array(value), np.array(0.0)))
            group.add(circle(place, 4.5, fill="none", stroke=DEMANDED, stroke_width=1.5, data_target=repr(value)))
        return group
    feet = axes.at(x, np.zeros_like(e))
    for foot, point in zip(feet, points, strict=True):
        group.add(line(complex(foot), complex(point), stroke=CURVE, stroke_width=1.6))
        group.add(circle(complex(point), 2.6, fill=CURVE))
    return group


def _output_diagram(design: FunctionDesign, problem: FunctionProblem, box: Box) -> Element:
    """The value of the output over that of the input, as the driven linkage gives it, and the pairs that it meets."""
    dials = design.dials
    inputs = np.array([target.input for target in design.targets])
    x = np.linspace(inputs.min(), inputs.max(), 181)
    angles = np.radians(dials.input.place + dials.input.scale * (x - dials.input.at))
    motion = drive(_mechanism(design), angles, order=0)
    if problem.slides:
        along = cmath.exp(-1j * math.radians(_slide_angle(design)))
        places = ((motion.joints["B"][0] - motion.joints["O2"][0]) * along).real
    else:
        places = np.degrees(motion.angles["output"][0])
        places[motion.valid] = np.unwrap(places[motion.valid], period=360.0)
    y = dials.output.at + (places - dials.output.place) / dials.output.scale
    pairs = np.array([target.output for target in design.targets])
    if not problem.slides:
        turn = 360.0 / dials.output.scale
        y -= turn * np.round((y[np.abs(x - inputs[0]).argmin()] - pairs[0]) / turn)
    known = np.isfinite(y)
    axes = _Axes(box, (float(x[0]), float(x[-1])), [*y[known], *pairs])
    group = axes.drawn("Output over input, and the pairs", "output")
    group.add(path([axes.at(x[known], y[known])], stroke=CURVE, stroke_width=1.6, data_curve="output"))
    for value, place in zip(inputs, axes.at(inputs, pairs), strict=True):
        group.add(circle(complex(place), 4.5, fill="none", stroke=DEMANDED, stroke_width=1.5, data_target=repr(value)))
    return group


class _Axes:
    """Frame and ticks of a diagram over the values of the input."""

    def __init__(self, box: Box, interval: tuple[float, float], values: list[float]) -> None:
        self.box, self.interval = box, interval
        self.frame = Box(box.left + 74.0, box.low + 24.0, box.right - 8.0, box.high - 36.0)
        self.marks = ticks(values)

    def at(self, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Places on the sheet."""
        (first, last), low, high, frame = self.interval, self.marks[0], self.marks[-1], self.frame
        across = frame.left + frame.width * (x - first) / (last - first)
        return np.asarray(across + 1j * (frame.high - frame.height * (y - low) / ((high - low) or 1.0)))

    def drawn(self, heading: str, name: str) -> Element:
        """The empty diagram."""
        (first, last), frame, marks = self.interval, self.frame, self.marks
        group = element("g", data_diagram=name)
        group.add(text(frame.left, self.box.low + 15.0, heading, 11.5, font_weight="bold", fill=INK))
        for mark in marks:
            y = self.at(np.array(first), np.array(mark)).imag
            ends = complex(frame.left, float(y)), complex(frame.right, float(y))
            group.add(line(*ends, stroke=PALE, stroke_width=1.0 if mark == 0.0 else 0.4))
            words = length(mark, marks[-1] - marks[0], digits=4)
            group.add(text(frame.left - 5.0, float(y) + 3.5, words, 10.0, text_anchor="end", fill=GREY))
        for value in ticks([first, last]):
            if first - 1e-9 * (last - first) <= value <= last + 1e-9 * (last - first):
                foot = complex(float(self.at(np.array(value), np.array(marks[0])).real), frame.high)
                group.add(line(foot, foot + 4j, stroke=GREY, stroke_width=1.0))
                words = length(value, last - first, digits=5)
                group.add(text(foot.real, foot.imag + 15.0, words, 10.0, text_anchor="middle", fill=GREY))
        size = {"x": frame.left, "y": frame.low, "width": frame.width, "height": frame.height}
        return group.add(element("rect", **size, fill="none", stroke=GREY, stroke_width=0.8))


def _written(design: FunctionDesign, value: float, unit: str) -> str:
    """A structural error with its unit."""
    digits = length(value, digits=4)
    return f"{digits}°" if design.structural_error.unit == "degrees" else f"{digits} {unit}"


def _tables(design: FunctionDesign, problem: FunctionProblem) -> list[Block]:
    unit = problem.length_unit
    mechanism, metrics, error = design.mechanism, design.metrics, design.structural_error
    rows = [(name, length(value)) for name, value in mechanism.links.model_dump().items()]
    if mechanism.type == "slider_crank":
        rows.append(("offset", length(mechanism.offset)))
    size = max(mechanism.links.model_dump().values())
    for name, (x, y) in mechanism.skeleton.joints.items():
        if name != "P":
            rows.append((f"{name} at the first target", f"({length(x, size)}, {length(y, size)})"))
    rows.append(("assembly", mechanism.assembly))
    slides = error.unit == "length"

    def placed(place: float) -> str:
        return f"{length(place)} {unit}" if slides else angle(place)

    dials = [
        (f"input stands at {angle(design.dials.input.place)}", f"at the value {length(design.dials.input.at)}"),
        ("and turns for a unit by", angle(design.dials.input.scale, 6)),
        (f"output stands at {placed(design.dials.output.place)}", f"at the value {length(design.dials.output.at)}"),
        ("and goes for a unit by", placed(design.dials.output.scale)),
    ]
    shown = design.targets[:SHOWN]
    met = [
        (
            f"{t.index + 1}: {length(t.input, digits=5)} → {length(t.output, digits=5)}",
            f"at {angle(t.input_angle, 2)}, off by {_written(design, t.error, unit)}",
        )
        for t in shown
    ]
    if len(design.targets) > len(shown):
        met.append((f"and {len(design.targets) - len(shown)} more", ""))

    def written(check: Check, value: float) -> str:
        return angle(value, 2) if check.name in ANGLES else small(value)

    measured = [] if metrics.grashof is None else [("type", metrics.grashof.replace("_", "-"))]
    measured += [
        ("greatest structural error", _written(design, error.max, unit)),
        ("root mean square", _written(design, error.rms, unit)),
        ("alternating extremes", f"{error.alternations}"),
        ("min transmission angle", angle(metrics.min_transmission_angle, 2)),
        ("input rotation", angle(metrics.input_rotation, 3)),
        ("longest : shortest link", length(metrics.link_ratio, digits=4)),
        ("quality", length(metrics.quality, digits=3)),
    ]
    return [
        blocks.rows(f"Dimensions ({unit})", rows),
        blocks.rows("Dials", dials),
        blocks.rows("Targets", met),
        checks(design.verification, written),
        blocks.rows("Metrics", measured),
    ]
