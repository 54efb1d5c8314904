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

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.planar.drive import MechanismMotion
from kinematics.linkage.planar.mechanism import GROUND, Slide
from service.render.linkage.motion import Demand, DrivenLinkage
from service.render.linkage.styles import GHOST_LINE, GROUND_LINE, TARGET_CURVE, USED_PATH, WHOLE_PATH, Style
from service.render.page.labels import Label, Labels
from service.render.page.sheet import draw_clipping_panel, fit_panel
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    draw_circle,
    draw_line,
    draw_path,
    draw_polygon,
    make_element,
)
from service.render.page.symbols import (
    COUPLER,
    CURVE,
    INK,
    INPUT,
    OUTPUT,
    PALE,
    draw_bearing,
    draw_scale_bar,
    draw_target,
)
from service.render.page.symbols import GROUND as GROUND_COLOUR
from synthesis.model.design_interface import AnyDesign

LINK_WIDTH, PLATE_EDGE_WIDTH, JOINT_RADIUS = 5.0, 2.4, 4.5
"""Line widths of a bar of the bold linkage and of a plate's edge, and the radius of a joint, pixels."""

BLOCK_SIZE = (22.0, 13.0)
"""Length and width of a slide's block, pixels."""

RAIL_EXTENSION = 0.12
"""Extension of a slide's rail beyond the places of its block, as a share of the drawing's diagonal."""

MARGIN, MARGIN_BELOW = 50.0, 26.0
"""Margins of the panel around the content, and additional space below for the scale bar, pixels."""

SAMPLE_COUNT = 361
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
        target: Complex | None = None,
        hidden: Set[str] = frozenset(),
    ) -> None:
        self.linkage, self.mechanism, self.inputs = linkage, linkage.mechanism, inputs
        self.demands, self.target, self.hidden = demands, target, hidden
        self.at = linkage.drive_over(inputs)
        self.paths: list[Complex] = [linkage.trace_path(joint, *linkage.cycle, SAMPLE_COUNT) for joint in traced]
        self.used: Complex = np.empty(0, np.complex128)
        if used is not None:
            self.used = linkage.trace_path(used, float(inputs[0]), float(inputs[-1]), SAMPLE_COUNT)

    @classmethod
    def from_design(cls, design: AnyDesign) -> Scene:
        """Build the scene of a design at its targets, with the path of its point P if it has one."""
        linkage = DrivenLinkage.from_design(design)
        inputs = linkage.find_target_inputs(design)
        traced = ["P"] if "P" in linkage.mechanism.joints else []
        return cls(linkage, inputs, traced, "P" if traced and len(inputs) > 1 else None)

    def get_joints(self, k: int) -> dict[str, complex]:
        """Return the joints at an input; empty if the linkage cannot be assembled there."""
        if not self.at.valid[k]:
            return {}
        return {name: complex(jet[0, k]) for name, jet in self.at.joints.items() if name not in self.hidden}

    def iterate_links(self, joints: Mapping[str, complex]) -> Iterator[tuple[str, list[complex]]]:
        """Yield the moving links with at least two joints, and the places of these joints."""
        for name, listed in self.mechanism.links.items():
            corners = [joints[joint] for joint in listed if joint in joints]
            if name != GROUND and len(corners) > 1:
                yield name, corners

    def list_pivots(self) -> list[complex]:
        """Return the fixed pivots that are drawn."""
        listed = (name for name in self.mechanism.links[GROUND] if name not in self.hidden)
        return [complex(self.mechanism.joints[name]) for name in listed]

    def list_places(self) -> Complex:
        """Return all joints at all inputs."""
        return np.array([z for k in range(len(self.inputs)) for z in self.get_joints(k).values()])

    def find_box(self) -> Box:
        """Return the box of the content."""
        demanded = [demand.point for demand in self.demands]
        target = [] if self.target is None else list(self.target)
        return Box.enclose(np.concatenate([self.list_places(), demanded, target, self.used, *self.paths]))

    def list_slides(self, k: int) -> list[tuple[str, complex, float]]:
        """Return the slides at an input: joint, place, and angle of the line in radians."""
        joints = self.get_joints(k)
        slides = self.mechanism.slides
        return [(slide.joint, joints[slide.joint], self.compute_slide_angle(slide, self.at, k)) for slide in slides]

    def compute_slide_angle(self, slide: Slide, motion: MechanismMotion, k: int) -> float:
        """Return the angle of a slide's line at an input of a motion, radians."""
        if slide.link == GROUND:
            return float(slide.angle)
        return float(slide.angle + motion.angles[slide.link][0, k] - self.mechanism.link_angle(slide.link))

    def iterate_rails(self, beyond: float) -> Iterator[tuple[Slide, complex, complex]]:
        """Yield the lines of slides with both ends.

        A line on the ground covers all positions of its block, a line on a moving link the position at the first input.
        It extends beyond them by the length ``beyond``.
        """
        first = self.get_joints(0)
        for slide in self.mechanism.slides if first else ():
            if slide.link == GROUND:
                listed = [self.get_joints(k) for k in range(len(self.inputs))]
                places = np.array([joints[slide.joint] for joints in listed if joints])
            else:
                places = np.array([first[joint] for joint in (slide.joint, *self.mechanism.links[slide.link])])
            along = complex(np.exp(1j * float(slide.angle)))
            # Positions of the block along its line.
            way = ((places - places[0]) * along.conjugate()).real
            low, high = float(way.min()) - beyond, float(way.max()) + beyond
            yield slide, complex(places[0] + along * low), complex(places[0] + along * high)


def sort_around_middle(corners: Sequence[complex]) -> list[complex]:
    """Sort the corners of a plate around its middle."""
    centre = sum(corners) / len(corners)
    return sorted(corners, key=lambda z: math.atan2((z - centre).imag, (z - centre).real))


def make_block_corners(at: complex, turned: float, width: float, height: float) -> list[complex]:
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
        return self.shown or self.scene.find_box()

    def draw(self, width: float) -> tuple[list[Element], float]:
        """Draw the panel; return it and the y below it."""
        view = fit_panel(self.box, width, self.heights, MARGIN, MARGIN_BELOW)
        return [draw_scene(self.scene, view, self.unit).add(*self.overlay(view))], view.panel.high


def draw_scene(shown: Scene, view: Viewport, unit: str) -> Element:
    """Draw the linkage at its inputs in a panel of the sheet, with labels and a scale bar."""
    panel = view.panel
    group = draw_clipping_panel(panel, "main")
    # Keep labels off the frame.
    labels = Labels(panel.grow(-3.0))
    if shown.target is not None:
        group.add(draw_path(view.clip_to_panel(shown.target), **TARGET_CURVE, data_curve="target"))
    for points in shown.paths:
        group.add(draw_path(view.clip_to_panel(points), **WHOLE_PATH))
    group.add(draw_path(view.clip_to_panel(shown.used), **USED_PATH))
    labels.add_obstacles(view.clip_to_panel(shown.used), 1.0)
    for start, end in pairwise(view.point(z) for z in shown.list_pivots()):
        group.add(draw_line(start, end, data_link=GROUND, **GROUND_LINE))
    group.add(*_draw_rails(shown, view))
    # Draw the first configuration last, so that it lies on top of the pale ones.
    for k in range(len(shown.inputs) - 1, -1, -1):
        group.add(_draw_configuration(shown, view, k, labels))
    for demand in shown.demands:
        # Readers count targets from 1.
        symbol, lines = draw_target(view.point(demand.point), demand.angle, demand.index + 1)
        labels.add_obstacles(lines, 1.0)
        group.add(symbol)
    for demand in shown.demands:
        labels.place(
            view.point(demand.point), Label(f"{demand.index + 1}", 11.0, {"fill": CURVE}, ring=CURVE), clearance=9.0
        )
    for name, place in shown.get_joints(0).items():
        label = Label(name[0], 13.0, {"fill": INK, "font-weight": "bold"}, name[1:])
        labels.place(view.point(place), label, clearance=8.0, away=-1j)
    bar, covered = draw_scale_bar(view, unit)
    labels.reserve(covered)
    return group.add(*labels.drawn, bar)


def _draw_rails(shown: Scene, view: Viewport) -> list[Element]:
    drawn = []
    for slide, low, high in shown.iterate_rails(RAIL_EXTENSION * shown.find_box().diagonal):
        style: Style = {"stroke": GROUND_COLOUR if slide.link == GROUND else COUPLER, "stroke_dasharray": "9 3 2 3"}
        drawn.append(draw_line(view.point(low), view.point(high), stroke_width=1.4, data_rail=slide.joint, **style))
    return drawn


def _draw_configuration(shown: Scene, view: Viewport, k: int, labels: Labels) -> Element:
    """Draw the linkage at one target: bold at the first, pale at the others."""
    first = k == 0
    joints = {name: view.point(z) for name, z in shown.get_joints(k).items()}
    group = make_element("g", data_configuration=f"{k + 1}")
    if not joints:
        return group
    for name, corners in shown.iterate_links(joints):
        group.add(_draw_link(name, corners, first, shown.mechanism.input == name))
        labels.add_obstacles([np.array([*corners, corners[0]])], 2.0 if first else 0.4)
    for joint, place, turned in shown.list_slides(k):
        # Sheet coordinates point down, so the angle changes sign.
        corners = make_block_corners(view.point(place), -turned, *BLOCK_SIZE)
        group.add(
            draw_polygon(corners, fill="#fff", stroke=OUTPUT if first else PALE, stroke_width=1.8, data_slide=joint)
        )
    if first:
        for name, place in joints.items():
            # Fixed pivots get a bearing and a larger ring.
            fixed = name in shown.mechanism.links[GROUND]
            if fixed:
                symbol, lines = draw_bearing(place, 1.0)
                labels.add_obstacles(lines, 1.5)
                group.add(symbol)
            group.add(
                draw_circle(place, JOINT_RADIUS + fixed, fill="#fff", stroke=INK, stroke_width=1.6, data_joint=name)
            )
    return group


def _draw_link(name: str, corners: list[complex], first: bool, driven: bool) -> Element:
    """Draw a link: a bar between two joints, a plate between three or more."""
    colour = INPUT if driven else COUPLER if name == "coupler" else OUTPUT
    style = {"stroke": colour, "stroke_width": LINK_WIDTH} if first else GHOST_LINE
    if len(corners) == 2:
        return draw_line(corners[0], corners[1], stroke_linecap="round", data_link=name, **style)
    fill: Style = {"fill": colour, "fill_opacity": 0.14} if first else {"fill": "none"}
    style = style | fill | {"stroke_width": PLATE_EDGE_WIDTH}
    return draw_polygon(sort_around_middle(corners), stroke_linejoin="round", data_link=name, **style)
