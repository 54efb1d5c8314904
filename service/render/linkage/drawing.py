"""A linkage drawn from its skeleton at chosen inputs: links, slides, joints, paths and demanded positions.

Positions come from the analysis core. The linkage stands bold at the first input and pale at the others; the input is
blue, a link with three joints is a shaded plate, a slide is a rail with a block; paths over the whole cycle are thin,
and the used part of one is heavy.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from service.render.page.labels import Labels
from service.render.page.svg import (
    Box,
    Element,
    Points,
    Viewport,
    circle,
    element,
    line,
    path,
    polygon,
)
from service.render.page.symbols import (
    COUPLER,
    CURVE,
    DEMANDED,
    INK,
    INPUT,
    OUTPUT,
    PALE,
    bearing,
    demanded_point,
    demanded_position,
    scale_bar,
)
from service.render.page.symbols import GROUND as GROUND_COLOUR
from synthesis.analyses.cycle import cycle_of
from synthesis.kinds.motion.problem import Position
from synthesis.kinds.path.problem import PathPoint

LINK_WIDTH, THIN, JOINT = 5.0, 2.4, 4.5
"""Strokes of the bold and the pale linkage, and the radius of a joint, pixels."""

BLOCK = (22.0, 13.0)
"""A slide's block, pixels."""

RAIL = 0.12
"""A slide's rail goes on beyond the places of its block by this share of the drawing's diagonal."""

SAMPLES = 361
"""Points of a path."""

Style = dict[str, str | float | None]


class Scene:
    """A linkage at inputs (radians, or lengths along the input slide), and the paths of some joints over its cycle.

    ``used``, where a joint is named, is that joint's path from the first input to the last; ``low`` and ``high`` are
    the ends of the cycle. ``target`` is a curve that is to be drawn as a whole.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        inputs: NDArray[np.float64],
        traced: Sequence[str],
        used: str | None = None,
        positions: Sequence[Position | PathPoint] = (),
        target: Points | None = None,
    ) -> None:
        self.mechanism, self.inputs, self.positions, self.target = mechanism, inputs, positions, target
        self.at = self.driven(inputs)
        self.low, self.high = cycle_of(mechanism)
        cycle = self.driven(np.linspace(self.low, self.high, SAMPLES))
        self.paths: list[Points] = [cycle.joints[joint][0] for joint in traced]
        self.used: Points = np.empty(0, np.complex128)
        if used is not None:
            self.used = self.driven(np.linspace(inputs[0], inputs[-1], SAMPLES)).joints[used][0]

    def driven(self, inputs: NDArray[np.float64], order: int = 0) -> MechanismMotion:
        """The linkage at inputs, with derivatives by the input up to an order."""
        return drive(self.mechanism, inputs, order=order)

    def joints(self, k: int) -> dict[str, complex]:
        """Joints at an input; empty where the linkage cannot be assembled there."""
        if not self.at.valid[k]:
            return {}
        return {name: complex(jet[0, k]) for name, jet in self.at.joints.items()}

    def box(self) -> Box:
        """What the drawing must show."""
        places = [z for k in range(len(self.inputs)) for z in self.joints(k).values()]
        places += [position.point for position in self.positions]
        places += [] if self.target is None else list(self.target)
        return Box.around(np.concatenate([np.array(places), self.used, *self.paths]))

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


def framed(panel: Box) -> Element:
    """The empty panel of a drawing; what is added to it and lies beyond is cut off."""
    return element(
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


def drawing(shown: Scene, view: Viewport, unit: str) -> Element:
    """The linkage at its inputs in a panel of the sheet, with labels and a scale bar."""
    panel = view.panel
    group = framed(panel)
    labels = Labels(panel.grown(-3.0))
    if shown.target is not None:
        demanded = path(
            view.shown(shown.target), stroke=DEMANDED, stroke_width=6.0, stroke_opacity=0.3, data_curve="target"
        )
        group.add(demanded)
    for points in shown.paths:
        group.add(path(view.shown(points), stroke=CURVE, stroke_width=0.9))
    group.add(path(view.shown(shown.used), stroke=CURVE, stroke_width=2.2))
    labels.avoid(view.shown(shown.used), 1.0)
    group.add(*_rails(shown, view))
    for k in range(len(shown.inputs) - 1, -1, -1):
        group.add(_configuration(shown, view, k, labels))
    for k, position in enumerate(shown.positions):
        at = view.point(position.point)
        if isinstance(position, PathPoint):
            symbol, lines = demanded_point(at, k + 1)
        else:
            symbol, lines = demanded_position(at, math.radians(position.angle), k + 1)
        labels.avoid(lines, 1.0)
        group.add(symbol)
    for k, position in enumerate(shown.positions):
        labels.place(view.point(position.point), f"{k + 1}", 11.0, clearance=9.0, ring=CURVE, style={"fill": CURVE})
    for name, place in shown.joints(0).items():
        labels.place(
            view.point(place), name[0], 13.0, subscript=name[1:], clearance=8.0, away=-1j,
            style={"fill": INK, "font-weight": "bold"},
        )  # fmt: skip
    bar, covered = scale_bar(view, unit)
    labels.reserve(covered)
    return group.add(*labels.drawn, bar)


def _rails(shown: Scene, view: Viewport) -> list[Element]:
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


def _configuration(shown: Scene, view: Viewport, k: int, labels: Labels) -> Element:
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
