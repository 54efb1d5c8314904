"""The sheet of any linkage that has no sheet of its own, from its skeleton: links, slides, the path of P and tables.

Positions come from the analysis core. The linkage stands bold at the first target and pale at the others; the input is
blue, the link that carries the body is shaded, a slide is a rail with a block, and the path of P over the whole cycle
is thin with the used part heavy.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter

from kinematics.linkage.drive import MechanismMotion, drive
from kinematics.linkage.mechanism import GROUND, Mechanism
from service.render import blocks, tables
from service.render.labels import Labels
from service.render.numbers import angle, length, small
from service.render.svg import (
    Box,
    Element,
    Points,
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
from service.render.symbols import (
    COUPLER,
    CURVE,
    GREY,
    INK,
    INPUT,
    OUTPUT,
    PALE,
    bearing,
    demanded_position,
    scale_bar,
)
from service.render.symbols import GROUND as GROUND_COLOUR
from synthesis.analyses.cycle import cycle_of
from synthesis.designs import LinkageDesign
from synthesis.mechanisms import GivenMechanism
from synthesis.problems import MotionProblem

WIDTH, EDGE, TOP, COLUMN, GUTTER = 1100.0, 22.0, 74.0, 370.0, 26.0
"""Width of the sheet, border, height of the title, width of the tables' column, space beside it; pixels."""

HEIGHTS = (460.0, 860.0)
"""Least and greatest height of the drawing, pixels."""

LINK_WIDTH, THIN, JOINT = 5.0, 2.4, 4.5
"""Strokes of the bold and the pale linkage, and the radius of a joint, pixels."""

BLOCK = (22.0, 13.0)
"""A slide's block, pixels."""

RAIL = 0.12
"""A slide's rail goes on beyond the places of its block by this share of the drawing's diagonal."""

SAMPLES = 361
"""Points of a path of P."""

NAMES = {
    "slider_crank": "Slider-crank",
    "inverted_slider_crank": "Inverted slider-crank",
    "watt_2": "Fourbar with a driver dyad (Watt's sixbar)",
    "stephenson_3": "Fourbar with a driver dyad on its coupler (Stephenson's sixbar)",
}
"""What the types are called on a sheet."""

Style = dict[str, str | float | None]

_GIVEN: TypeAdapter[GivenMechanism] = TypeAdapter(GivenMechanism)


def linkage_sheet(design: LinkageDesign, problem: MotionProblem, title: str) -> str:
    """The drawing of a linkage design as a complete SVG document."""
    shown = _Scene(design, problem)
    heading = clean(title) or NAMES[design.mechanism.type]
    width = WIDTH - 2.0 * EDGE - COLUMN - GUTTER
    box = shown.box()
    wanted = (width - 100.0) / max(box.width, 1e-12) * box.height + 130.0
    height = min(max(wanted, HEIGHTS[0]), HEIGHTS[1])
    view = Viewport.fit(box, Box(EDGE, TOP, EDGE + width, TOP + math.floor(height)), 50.0, 26.0)
    parts = [_drawing(shown, view, problem.length_unit)]
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


class _Scene:
    """The linkage at its targets, and the paths of P; in mechanism coordinates."""

    def __init__(self, design: LinkageDesign, problem: MotionProblem) -> None:
        self.mechanism: Mechanism = _GIVEN.validate_python(design.mechanism.model_dump()).mechanism()
        self.problem = problem
        stated = np.array([target.input_angle for target in design.targets])
        self.inputs = stated if self.mechanism.driven_by_slide else np.radians(stated)
        self.at = self._driven(self.inputs)
        low, high = cycle_of(self.mechanism)
        self.cycle = self._driven(np.linspace(low, high, SAMPLES)).joints["P"][0]
        self.used = self._driven(np.linspace(self.inputs[0], self.inputs[-1], SAMPLES)).joints["P"][0]

    def _driven(self, inputs: NDArray[np.float64]) -> MechanismMotion:
        return drive(self.mechanism, inputs, order=0)

    def joints(self, k: int) -> dict[str, complex]:
        """Joints at a target; empty where the linkage cannot be assembled there."""
        if not self.at.valid[k]:
            return {}
        return {name: complex(jet[0, k]) for name, jet in self.at.joints.items()}

    def box(self) -> Box:
        """What the drawing must show."""
        places = [z for k in range(len(self.inputs)) for z in self.joints(k).values()]
        places += [position.point for position in self.problem.positions]
        return Box.around(np.concatenate([np.array(places), self.used, self.cycle]))

    def lines(self, k: int) -> list[tuple[str, complex, float]]:
        """Slides at a target: the joint, and the line's direction by a point of it and its angle, radians."""
        found = []
        joints = self.joints(k)
        for slide in self.mechanism.slides:
            turned = 0.0
            if slide.link != GROUND:
                turned = float(self.at.angles[slide.link][0, k] - self.mechanism.link_angle(slide.link))
            found.append((slide.joint, joints[slide.joint], float(slide.angle) + turned))
        return found


def _drawing(shown: _Scene, view: Viewport, unit: str) -> Element:
    panel = view.panel
    group = element(
        "svg",
        element("rect", x=panel.left, y=panel.low, width=panel.width, height=panel.height, fill="#fff", stroke=PALE),
        x=panel.left,
        y=panel.low,
        width=panel.width,
        height=panel.height,
        viewBox=" ".join(f"{v:g}" for v in (panel.left, panel.low, panel.width, panel.height)),
        overflow="hidden",
        data_view="main",
    )
    labels = Labels(panel.grown(-3.0))
    group.add(path(view.shown(shown.cycle), stroke=CURVE, stroke_width=0.9))
    group.add(path(view.shown(shown.used), stroke=CURVE, stroke_width=2.2))
    labels.avoid(view.shown(shown.used), 1.0)
    group.add(*_rails(shown, view))
    for k in range(len(shown.inputs) - 1, -1, -1):
        group.add(_configuration(shown, view, k, labels))
    for k, position in enumerate(shown.problem.positions):
        symbol, lines = demanded_position(view.point(position.point), math.radians(position.angle), k + 1)
        labels.avoid(lines, 1.0)
        group.add(symbol)
    for k, position in enumerate(shown.problem.positions):
        labels.place(view.point(position.point), f"{k + 1}", 11.0, clearance=9.0, ring=CURVE, style={"fill": CURVE})
    for name, place in shown.joints(0).items():
        labels.place(
            view.point(place), name[0], 13.0, subscript=name[1:], clearance=8.0, away=-1j,
            style={"fill": INK, "font-weight": "bold"},
        )  # fmt: skip
    bar, covered = scale_bar(view, unit)
    labels.reserve(covered)
    return group.add(*labels.drawn, bar)


def _rails(shown: _Scene, view: Viewport) -> list[Element]:
    """Rails of the slides: on the ground over all places of their blocks, on a link at the first target."""
    drawn = []
    beyond = RAIL * shown.box().diagonal
    first = shown.joints(0)
    for slide in shown.mechanism.slides:
        if not first:
            continue
        if slide.link == GROUND:
            listed = [shown.joints(k) for k in range(len(shown.inputs))]
            places = np.array([joints[slide.joint] for joints in listed if joints])
        else:
            places = np.array([first[joint] for joint in (slide.joint, *shown.mechanism.links[slide.link])])
        along = complex(np.exp(1j * float(slide.angle)))
        way = ((places - places[0]) * along.conjugate()).real
        ends = [places[0] + along * t for t in (float(way.min()) - beyond, float(way.max()) + beyond)]
        style: Style = {"stroke": GROUND_COLOUR if slide.link == GROUND else COUPLER, "stroke_dasharray": "9 3 2 3"}
        drawn.append(line(view.point(ends[0]), view.point(ends[1]), stroke_width=1.4, data_rail=slide.joint, **style))
    return drawn


def _configuration(shown: _Scene, view: Viewport, k: int, labels: Labels) -> Element:
    """The linkage at one target: bold at the first, pale at the others."""
    first = k == 0
    joints = {name: view.point(z) for name, z in shown.joints(k).items()}
    group = element("g", data_configuration=f"{k + 1}")
    if not joints:
        return group
    for name, listed in shown.mechanism.links.items():
        if name != GROUND:
            corners = [joints[joint] for joint in listed]
            group.add(_link(name, corners, first, shown.mechanism.input == name))
            labels.avoid([_closed(corners)], 2.0 if first else 0.4)
    for joint, place, turned in shown.lines(k):
        group.add(_block(view.point(place), turned, joint, first))
    if first:
        for name, place in joints.items():
            fixed = name in shown.mechanism.links[GROUND]
            if fixed:
                symbol, lines = bearing(place, 1.0)
                labels.avoid(lines, 1.5)
                group.add(symbol)
            group.add(circle(place, JOINT + fixed, fill="#fff", stroke=INK, stroke_width=1.6, data_joint=name))
    return group


def _link(name: str, corners: list[complex], first: bool, driven: bool) -> Element:
    """A link: a bar between two joints, a plate between three or more."""
    colour = INPUT if driven else COUPLER if name == "coupler" else OUTPUT
    style: Style = {"stroke": colour if first else PALE, "stroke_width": LINK_WIDTH if first else THIN}
    if len(corners) == 2:
        return line(corners[0], corners[1], stroke_linecap="round", data_link=name, **style)
    centre = sum(corners) / len(corners)
    around = sorted(corners, key=lambda z: math.atan2((z - centre).imag, (z - centre).real))
    fill: Style = {"fill": colour, "fill_opacity": 0.14} if first else {"fill": "none"}
    return polygon(around, stroke_linejoin="round", data_link=name, **{**style, **fill, "stroke_width": THIN})


def _closed(corners: list[complex]) -> Points:
    return np.array([*corners, corners[0]])


def _block(at: complex, turned: float, joint: str, first: bool) -> Element:
    """A slide's block, along its line."""
    along = complex(math.cos(turned), -math.sin(turned))
    half = [complex(x * BLOCK[0], y * BLOCK[1]) / 2.0 for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    colour = OUTPUT if first else PALE
    corners = [at + corner * along for corner in half]
    return polygon(corners, fill="#fff", stroke=colour, stroke_width=1.8, data_slide=joint)


def _tables(design: LinkageDesign, problem: MotionProblem, size: float) -> list[blocks.Block]:
    unit = problem.length_unit
    links = design.mechanism.links
    lengths = links if isinstance(links, dict) else links.model_dump()
    rows = [(name.replace("_", " "), length(value)) for name, value in lengths.items()]
    for name, (x, y) in design.mechanism.skeleton.joints.items():
        rows.append((f"{name} at the first target", f"({length(x, size)}, {length(y, size)})"))
    for slide in design.mechanism.skeleton.slides:
        rows.append((f"slide of {slide.joint} on {slide.link}", angle(slide.angle)))
    slides = design.mechanism.skeleton.input_link in design.mechanism.skeleton.joints
    met = [
        (
            f"{target.index + 1}: input {length(target.input_angle) if slides else angle(target.input_angle, 2)}",
            f"off by {small(target.point_residual)} {unit}, {angle(target.angle_residual or 0.0, 2)}",
        )
        for target in design.targets
    ]
    least = [
        (f"transmission at {link.replace('_', ' ')}", angle(value, 2))
        for link, value in design.metrics.transmission_angles.items()
    ]
    return [
        blocks.rows(f"Dimensions ({unit})", rows),
        blocks.rows("Targets", met),
        tables.checks(design),
        blocks.rows("Least angles", least),
        tables.metrics(design, unit),
    ]
