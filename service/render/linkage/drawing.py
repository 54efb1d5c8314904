"""A linkage drawn from its skeleton at chosen inputs: links, slides, joints, paths and target positions.

Positions come from the analysis core. The linkage is bold at the first input and pale at the others. The input is blue,
a link with three joints is a shaded plate, a slide is a rail with a block. Paths over the whole cycle are thin, their
used parts heavy.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from kinematics.linkage.planar.drive import MechanismMotion
from kinematics.linkage.planar.mechanism import GROUND, Slide
from service.render.linkage.motion import Demand, DrivenLinkage, Real
from service.render.linkage.styles import GHOST, GROUND_LINE, TARGET_CURVE, USED_PATH, WHOLE_PATH, Style
from service.render.page.labels import Labels
from service.render.page.sheet import clipping, fitted
from service.render.page.svg import Box, Element, Points, Viewport, circle, element, line, path, polygon
from service.render.page.symbols import (
    COUPLER,
    CURVE,
    INK,
    INPUT,
    OUTPUT,
    PALE,
    bearing,
    demanded,
    scale_bar,
)
from service.render.page.symbols import GROUND as GROUND_COLOUR

LINK_WIDTH, PLATE_EDGE, JOINT = 5.0, 2.4, 4.5
"""Line widths of a bar of the bold linkage and of a plate's edge, and the radius of a joint, pixels."""

BLOCK = (22.0, 13.0)
"""Length and width of a slide's block, pixels."""

RAIL = 0.12
"""Extension of a slide's rail beyond the places of its block, as a share of the drawing's diagonal."""

MARGIN, FOOT = 50.0, 26.0
"""Margins of the panel around the content, and additional space below for the scale bar, pixels."""

SAMPLES = 361
"""Number of points of a path."""


class Scene:
    """A linkage at several inputs, and the paths of some joints over its cycle.

    ``used`` is the path of the named joint from the first input to the last, if one is named. ``target`` is a curve
    that is required as a whole. Joints in ``hidden`` are not drawn.
    """

    def __init__(
        self,
        linkage: DrivenLinkage,
        inputs: Real,
        traced: Sequence[str],
        used: str | None = None,
        demands: Sequence[Demand] = (),
        target: Points | None = None,
        hidden: Set[str] = frozenset(),
    ) -> None:
        self.linkage, self.mechanism, self.inputs = linkage, linkage.mechanism, inputs
        self.demands, self.target, self.hidden = demands, target, hidden
        self.at = linkage.driven(inputs)
        self.paths: list[Points] = [linkage.path(joint, *linkage.cycle, SAMPLES) for joint in traced]
        self.used: Points = np.empty(0, np.complex128)
        if used is not None:
            self.used = linkage.path(used, float(inputs[0]), float(inputs[-1]), SAMPLES)

    @classmethod
    def of(cls, design: Any) -> Scene:
        """Build the scene of a design at its targets, with the path of its point P if it has one."""
        linkage = DrivenLinkage.of(design)
        inputs = linkage.targets(design)
        traced = ["P"] if "P" in linkage.mechanism.joints else []
        return cls(linkage, inputs, traced, "P" if traced and len(inputs) > 1 else None)

    def joints(self, k: int) -> dict[str, complex]:
        """Return the joints at an input; empty if the linkage cannot be assembled there."""
        if not self.at.valid[k]:
            return {}
        return {name: complex(jet[0, k]) for name, jet in self.at.joints.items() if name not in self.hidden}

    def links(self, joints: Mapping[str, complex]) -> Iterator[tuple[str, list[complex]]]:
        """Yield the moving links with at least two joints, and the places of these joints."""
        for name, listed in self.mechanism.links.items():
            corners = [joints[joint] for joint in listed if joint in joints]
            if name != GROUND and len(corners) > 1:
                yield name, corners

    def pivots(self) -> list[complex]:
        """Return the fixed pivots that are drawn."""
        listed = (name for name in self.mechanism.links[GROUND] if name not in self.hidden)
        return [complex(self.mechanism.joints[name]) for name in listed]

    def places(self) -> Points:
        """Return all joints at all inputs."""
        return np.array([z for k in range(len(self.inputs)) for z in self.joints(k).values()])

    def box(self) -> Box:
        """Return the box of the content."""
        demanded = [demand.point for demand in self.demands]
        target = [] if self.target is None else list(self.target)
        return Box.around(np.concatenate([self.places(), demanded, target, self.used, *self.paths]))

    def slides(self, k: int) -> list[tuple[str, complex, float]]:
        """Return the slides at an input: joint, place, and angle of the line in radians."""
        joints = self.joints(k)
        slides = self.mechanism.slides
        return [(slide.joint, joints[slide.joint], self.slide_angle(slide, self.at, k)) for slide in slides]

    def slide_angle(self, slide: Slide, motion: MechanismMotion, k: int) -> float:
        """Return the angle of a slide's line at an input of a motion, radians."""
        if slide.link == GROUND:
            return float(slide.angle)
        return float(slide.angle + motion.angles[slide.link][0, k] - self.mechanism.link_angle(slide.link))

    def rails(self, beyond: float) -> Iterator[tuple[Slide, complex, complex]]:
        """Yield the lines of slides with both ends: on the ground over all places of their blocks, on a link at the
        first input.

        The lines extend beyond these places by the length ``beyond``.
        """
        first = self.joints(0)
        for slide in self.mechanism.slides if first else ():
            if slide.link == GROUND:
                listed = [self.joints(k) for k in range(len(self.inputs))]
                places = np.array([joints[slide.joint] for joints in listed if joints])
            else:
                places = np.array([first[joint] for joint in (slide.joint, *self.mechanism.links[slide.link])])
            along = complex(np.exp(1j * float(slide.angle)))
            # Positions of the block along its line.
            way = ((places - places[0]) * along.conjugate()).real
            low, high = float(way.min()) - beyond, float(way.max()) + beyond
            yield slide, complex(places[0] + along * low), complex(places[0] + along * high)


def around(corners: Sequence[complex]) -> list[complex]:
    """Sort the corners of a plate around its middle."""
    centre = sum(corners) / len(corners)
    return sorted(corners, key=lambda z: math.atan2((z - centre).imag, (z - centre).real))


def block_corners(at: complex, turned: float, width: float, height: float) -> list[complex]:
    """Return the corners of a slide's block, rotated by an angle."""
    along = cmath.rect(0.5, turned)
    return [at + along * complex(x * width, y * height) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


Overlay = Callable[[Viewport], list[Element]]


@dataclass(frozen=True)
class PlanarPicture:
    """The linkage of a scene in one panel, with the requirements drawn over it."""

    scene: Scene
    unit: str
    overlay: Overlay = lambda view: []
    shown: Box | None = None
    heights: tuple[float, float] = (420.0, 720.0)
    wide: bool = False

    @property
    def box(self) -> Box:
        """Box of the content."""
        return self.shown or self.scene.box()

    def draw(self, width: float) -> tuple[list[Element], float]:
        """Draw the panel; return it and the y below it."""
        view = fitted(self.box, width, self.heights, MARGIN, FOOT)
        return [drawing(self.scene, view, self.unit).add(*self.overlay(view))], view.panel.high


def drawing(shown: Scene, view: Viewport, unit: str) -> Element:
    """Draw the linkage at its inputs in a panel of the sheet, with labels and a scale bar."""
    panel = view.panel
    group = clipping(panel, "main")
    # Keep labels off the frame.
    labels = Labels(panel.grown(-3.0))
    if shown.target is not None:
        group.add(path(view.shown(shown.target), **TARGET_CURVE, data_curve="target"))
    for points in shown.paths:
        group.add(path(view.shown(points), **WHOLE_PATH))
    group.add(path(view.shown(shown.used), **USED_PATH))
    labels.avoid(view.shown(shown.used), 1.0)
    for start, end in pairwise(view.point(z) for z in shown.pivots()):
        group.add(line(start, end, data_link=GROUND, **GROUND_LINE))
    group.add(*_rails(shown, view))
    # Draw the first configuration last, so that it lies on top of the pale ones.
    for k in range(len(shown.inputs) - 1, -1, -1):
        group.add(_configuration(shown, view, k, labels))
    for demand in shown.demands:
        # Readers count targets from 1.
        symbol, lines = demanded(view.point(demand.point), demand.angle, demand.index + 1)
        labels.avoid(lines, 1.0)
        group.add(symbol)
    for demand in shown.demands:
        labels.place(
            view.point(demand.point), f"{demand.index + 1}", 11.0, clearance=9.0, ring=CURVE, style={"fill": CURVE}
        )
    for name, place in shown.joints(0).items():
        labels.place(
            view.point(place), name[0], 13.0, subscript=name[1:], clearance=8.0, away=-1j,
            style={"fill": INK, "font-weight": "bold"},
        )  # fmt: skip
    bar, covered = scale_bar(view, unit)
    labels.reserve(covered)
    return group.add(*labels.drawn, bar)


def _rails(shown: Scene, view: Viewport) -> list[Element]:
    drawn = []
    for slide, low, high in shown.rails(RAIL * shown.box().diagonal):
        style: Style = {"stroke": GROUND_COLOUR if slide.link == GROUND else COUPLER, "stroke_dasharray": "9 3 2 3"}
        drawn.append(line(view.point(low), view.point(high), stroke_width=1.4, data_rail=slide.joint, **style))
    return drawn


def _configuration(shown: Scene, view: Viewport, k: int, labels: Labels) -> Element:
    """Draw the linkage at one target: bold at the first, pale at the others."""
    first = k == 0
    joints = {name: view.point(z) for name, z in shown.joints(k).items()}
    group = element("g", data_configuration=f"{k + 1}")
    if not joints:
        return group
    for name, corners in shown.links(joints):
        group.add(_link(name, corners, first, shown.mechanism.input == name))
        labels.avoid([np.array([*corners, corners[0]])], 2.0 if first else 0.4)
    for joint, place, turned in shown.slides(k):
        # Sheet coordinates point down, so the angle changes sign.
        corners = block_corners(view.point(place), -turned, *BLOCK)
        group.add(polygon(corners, fill="#fff", stroke=OUTPUT if first else PALE, stroke_width=1.8, data_slide=joint))
    if first:
        for name, place in joints.items():
            # Fixed pivots get a bearing and a larger ring.
            fixed = name in shown.mechanism.links[GROUND]
            if fixed:
                symbol, lines = bearing(place, 1.0)
                labels.avoid(lines, 1.5)
                group.add(symbol)
            group.add(circle(place, JOINT + fixed, fill="#fff", stroke=INK, stroke_width=1.6, data_joint=name))
    return group


def _link(name: str, corners: list[complex], first: bool, driven: bool) -> Element:
    """Draw a link: a bar between two joints, a plate between three or more."""
    colour = INPUT if driven else COUPLER if name == "coupler" else OUTPUT
    style = {"stroke": colour, "stroke_width": LINK_WIDTH} if first else GHOST
    if len(corners) == 2:
        return line(corners[0], corners[1], stroke_linecap="round", data_link=name, **style)
    fill: Style = {"fill": colour, "fill_opacity": 0.14} if first else {"fill": "none"}
    style = style | fill | {"stroke_width": PLATE_EDGE}
    return polygon(around(corners), stroke_linejoin="round", data_link=name, **style)
