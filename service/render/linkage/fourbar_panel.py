"""One panel of a fourbar drawing: a scene put through a viewport, with marks, labels and a scale bar.

Line styles carry the meaning without colours too: input link solid, output link hollow, coupler a shaded plate, ground
dash-dotted, other targets thin and grey, the used part of the coupler curve heavy and the rest of it thin. The parts of
the linkage at a target stand in one group marked ``data-configuration`` (counted from 1), joints with ``data-joint``.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np

from service.render.linkage.fourbar import (
    Configuration,
    Demand,
    Scene,
)
from service.render.page.labels import Labels, direction_between
from service.render.page.numbers import angle
from service.render.page.svg import (
    CLIP_MARGIN,
    Box,
    Element,
    Points,
    Viewport,
    circle,
    clipped,
    clipped_polygon,
    element,
    line,
    path,
    polygon,
    text,
)
from service.render.page.symbols import (
    COUPLER,
    CURVE,
    DEMAND_RADIUS,
    DEMANDED,
    DIRECTION_LENGTH,
    GREY,
    GROUND,
    INK,
    INPUT,
    OUTPUT,
    PALE,
    arrow,
    bearing,
    demanded_point,
    demanded_position,
    scale_bar,
)

LINK_WIDTH, JOINT_RADIUS, PIVOT_RADIUS = 5.0, 5.0, 6.0
"""Sizes of the bold linkage, pixels, where there is room."""

BAR_HEIGHT = 2.5
"""A coupler triangle lower than this many pixels is drawn as a bar."""

ROTATION_ARC = 26.0, 74.0
"""Least and greatest radius of the arc that shows the input's rotation, pixels."""

ARC_LENGTH = 26.0
"""That arc is moved outwards along the input link where it would be shorter than this, pixels."""

TICK = 9.0
"""Length of the tick at an input limit, pixels."""

MARGIN, FOOT = 60.0, 22.0
"""Room in a panel around what must be shown, and more of it below for the scale bar, pixels."""

SEEN_MISS = 1.0
"""A point that is missed by less than so many pixels is seen to be met."""

FRAME_REACH = 12.0
"""Marks this near to the frame of a detail, pixels, are left to the detail."""

LARGEST_ARC = 4.0
"""Arcs of a larger radius, in panel diagonals, are left out: in a detail they would be straight lines of no meaning."""


class Detail(NamedTuple):
    """A part of the mechanism that is drawn again in another panel, with that panel's name and viewport."""

    box: Box
    name: str
    viewport: Viewport


def panel(scene: Scene, viewport: Viewport, name: str, unit: str, details: list[Detail]) -> Element:
    """The panel as a nested drawing that cuts off what leaves it.

    Parameters
    ----------
    scene : Scene
        What is drawn.
    viewport : Viewport
        Where it is drawn; recorded on the element as ``data-scale``, ``data-centre`` and ``data-middle``.
    name : str
        Marks the element (``data-view``) and is its heading, unless it is "main".
    unit : str
        Length unit, for the scale bar.
    details : list of Detail
        Parts that other panels show: framed in this one, and labelled there only.
    """
    return _Panel(scene, viewport, name, unit, details).drawn()


class _Panel:
    def __init__(self, scene: Scene, viewport: Viewport, name: str, unit: str, details: list[Detail]) -> None:
        self._scene, self._viewport, self._name, self._unit = scene, viewport, name, unit
        self._labels = Labels(viewport.panel.grown(-3.0))
        box, at = viewport.panel, viewport
        self._root = element(
            "svg",
            x=box.left,
            y=box.low,
            width=box.width,
            height=box.height,
            viewBox=" ".join(f"{v:g}" for v in (box.left, box.low, box.width, box.height)),
            overflow="hidden",
            data_view=name,
            data_scale=repr(at.scale),
            data_centre=f"{at.centre.real!r} {at.centre.imag!r}",
            data_middle=f"{at.middle.real!r} {at.middle.imag!r}",
        )
        self._first = next((c for c in scene.configurations if c.index == 0), None)
        self._size = 1.0
        self._details = details
        self._frames = [self._frame_box(detail) for detail in details]

    def drawn(self) -> Element:
        """The whole panel, from the back to the front."""
        box = self._viewport.panel
        border = {"x": box.left + 0.5, "y": box.low + 0.5, "width": box.width - 1.0, "height": box.height - 1.0}
        self._root.add(element("rect", fill="#fff", stroke=PALE, **border))
        annotations = self._annotations()
        self._size = self._link_size()
        self._input_circle()
        self._curves()
        ghosts = self._scene.others
        for ghost in reversed(ghosts):
            self._ghost(ghost)
        self._ground()
        if self._first is not None:
            self._linkage(self._first)
        self._rotation_arc()
        for demand in self._scene.demands:
            self._demand(demand)
        self._misses()
        if self._first is not None:
            self._joints(self._first)
        for detail, frame in zip(self._details, self._frames, strict=True):
            self._frame(detail, frame)
        if self._first is not None:
            self._label_linkage(self._first)
        for demand in self._scene.demands:
            self._label_demand(demand)
        for ghost in ghosts:
            self._label_ghost(ghost)
        if self._first is not None:
            self._label_links(self._first)
        return self._root.add(*annotations, *self._labels.drawn)

    def _annotations(self) -> list[Element]:
        """Heading and scale bar, on white, clear of all labels."""
        box = self._viewport.panel
        bar, covered = scale_bar(self._viewport, self._unit)
        self._labels.reserve(covered)
        if self._name == "main":
            return [bar]
        self._labels.reserve(Box(box.left, box.low, box.left + 76.0, box.low + 26.0))
        plate = element("rect", x=box.left + 4.0, y=box.low + 4.0, width=68.0, height=20.0, fill="#fff")
        return [plate, text(box.left + 10.0, box.low + 18.0, self._name, 12.0, font_weight="bold", fill=INK), bar]

    def _link_size(self) -> float:
        """Factor on link widths and joint sizes: below 1 where the joints stand close together on the sheet."""
        first = self._first
        if first is None:
            return 1.0
        ends = [(self._scene.o2, first.a), (first.a, first.b), (first.b, self._scene.o4)]
        spans = [abs(v - u) * self._viewport.scale for u, v in ends]
        inside = [s for s, (u, v) in zip(spans, ends, strict=True) if self._sees(u) or self._sees(v)]
        return min(1.0, max(0.4, min(inside, default=30.0) / 30.0))

    def _sees(self, point: complex) -> bool:
        return self._viewport.panel.holds(self._viewport.point(point))

    def _readable(self, point: complex) -> bool:
        """Whether a point is in sight and not left to a detail, which shows its marks and labels."""
        at = self._viewport.point(point)
        return self._viewport.panel.holds(at) and not any(
            frame.grown(FRAME_REACH).holds(at) and detail.viewport.panel.holds(detail.viewport.point(point))
            for detail, frame in zip(self._details, self._frames, strict=True)
        )

    def _arc(self, radius: float, start: float, end: float) -> Points:
        """Arc about O2 on the sheet; radius in pixels, angles in radians."""
        count = max(3, math.ceil(abs(end - start) / math.tau * 180))
        turn = np.exp(-1j * np.linspace(start, end, count))
        return np.asarray(self._viewport.point(self._scene.o2) + radius * turn)

    def _input_circle(self) -> None:
        """The path of A as far as the input reaches, and ticks at its limits."""
        scene, at = self._scene, self._viewport
        radius = at.scale * float(scene.linkage.input)
        if radius > LARGEST_ARC * at.panel.diagonal:
            return
        start, end = scene.limits or (0.0, math.tau)
        swept = clipped(self._arc(radius, start, end), at.panel.grown(CLIP_MARGIN))
        self._root.add(path(swept, stroke=INPUT, stroke_width=0.9, stroke_dasharray="1 4", stroke_linecap="round"))
        self._labels.avoid(swept, 0.6)
        if scene.limits is None:
            return
        for limit in scene.limits:
            outward = cmath.exp(-1j * limit)
            tip = at.point(scene.o2) + radius * outward
            if not at.panel.holds(tip):
                continue
            low, high = tip - TICK * outward, tip + TICK * outward
            self._root.add(line(low, high, stroke=INPUT, stroke_width=2.0, data_limit=repr(math.degrees(limit))))
            self._labels.avoid([np.array([low, high])], 6.0)

    def _curves(self) -> None:
        pieces = [piece for curve in self._scene.rest for piece in self._pieces(curve)]
        used = self._pieces(self._scene.used)
        if self._scene.target is not None:
            target = self._pieces(self._scene.target)
            self._root.add(
                path(target, stroke=DEMANDED, stroke_width=6.0, stroke_opacity=0.3, data_curve="target"),
            )
        self._root.add(
            path(pieces, stroke=CURVE, stroke_width=0.9, data_curve="branch"),
            path(used, stroke=CURVE, stroke_width=2.2, stroke_linecap="round", data_curve="used"),
        )
        self._labels.avoid(pieces, 0.6)
        self._labels.avoid(used, 2.0)

    def _pieces(self, curve: Points) -> list[Points]:
        return self._viewport.shown(curve)

    def _segment(self, start: complex, end: complex, weight: float, /, **style: str | float | None) -> Element | None:
        """A straight part of a link, cut at the panel."""
        pieces = self._viewport.shown(np.array([start, end]))
        self._labels.avoid(pieces, weight)
        return path(pieces, **style)

    def _plate(
        self, c: Configuration, weight: float, fill: float, bar: float, /, **style: str | float | None
    ) -> list[Element | None]:
        """The coupler: the triangle A B P, or a bar (of width ``bar``) where the triangle is flat."""
        corners = sorted((c.a, c.b, c.p), key=lambda z: (z.real, z.imag))
        pairs = [(c.a, c.b), (c.b, c.p), (c.p, c.a)]
        longest = max(pairs, key=lambda pair: abs(pair[1] - pair[0]))
        base = abs(longest[1] - longest[0])
        height = abs(((c.b - c.a).conjugate() * (c.p - c.a)).imag) / base if base > 0.0 else 0.0
        if height * self._viewport.scale < BAR_HEIGHT:
            return [self._segment(*longest, weight, data_link="coupler", **(style | {"stroke_width": bar}))]
        found: list[Element | None] = []
        seen = [self._viewport.point(corner) for corner in corners]
        seen = clipped_polygon(seen, self._viewport.panel.grown(40.0))
        if seen:
            found.append(polygon(seen, fill=COUPLER, fill_opacity=fill, data_link="coupler"))
        found.extend(self._segment(u, v, weight, **style) for u, v in pairs if u != v)
        return found

    def _ghost(self, c: Configuration) -> None:
        dashes = None if c.own else "6 4"
        group = element("g", data_configuration=f"{c.index + 1}", data_own_assembly=str(c.own).lower())
        group.attributes |= {"stroke-linecap": "round", "stroke-linejoin": "round"}
        group.add(
            *self._plate(c, 1.0, 0.07, 2.4, stroke=PALE, stroke_width=1.4, stroke_dasharray=dashes),
            self._segment(self._scene.o2, c.a, 1.0, stroke=PALE, stroke_width=2.4, stroke_dasharray=dashes),
            self._segment(self._scene.o4, c.b, 1.0, stroke=PALE, stroke_width=2.4, stroke_dasharray=dashes),
        )
        for name, joint in (("A", c.a), ("B", c.b), ("P", c.p)):
            radius = (3.4 if name != "P" else 2.4) * self._size
            self._mark(group, name, joint, radius, fill="#fff" if name != "P" else GREY, stroke=GREY, stroke_width=1.2)
        self._body_line(group, c, GREY)
        self._root.add(group)

    def _mark(self, group: Element, name: str, joint: complex, radius: float, **style: str | float | None) -> None:
        """A joint's circle; joints out of sight are left out."""
        at = self._viewport.point(joint)
        if self._viewport.panel.grown(radius).holds(at):
            group.add(circle(at, radius, data_joint=name, **style))
            self._labels.avoid([_cross(at, radius)], 4.0)

    def _body_line(self, group: Element, c: Configuration, colour: str) -> None:
        """The body's own line at P as the linkage carries it, inside the demanded direction when that is met."""
        if self._readable(c.p) and self._scene.guides_a_body:
            at = self._viewport.point(c.p)
            tip = at + DIRECTION_LENGTH * cmath.exp(-1j * c.body_angle)
            group.add(line(at, tip, stroke=colour, stroke_width=1.2, data_body_line=f"{c.index + 1}"))

    def _ground(self) -> None:
        group = element("g", data_link="ground")
        group.add(
            self._segment(
                self._scene.o2, self._scene.o4, 2.0, stroke=GROUND, stroke_width=1.3, stroke_dasharray="12 4 2 4"
            )
        )
        for pivot in (self._scene.o2, self._scene.o4):
            if self._readable(pivot):
                symbol, outline = bearing(self._viewport.point(pivot), max(0.6, self._size))
                self._labels.avoid(outline, 6.0)
                group.add(symbol)
        self._root.add(group)

    def _linkage(self, c: Configuration) -> None:
        """Links in the first target position."""
        width = LINK_WIDTH * self._size
        group = element("g", data_links="1", stroke_linecap="round", stroke_linejoin="round")
        outline: dict[str, str | float | None] = {"stroke": COUPLER, "stroke_width": max(1.6, 0.55 * width)}
        group.add(
            *self._plate(c, 3.0, 0.22, width, **outline),
            self._segment(self._scene.o2, c.a, 3.0, stroke=INPUT, stroke_width=width, data_link="input"),
            self._segment(self._scene.o4, c.b, 3.0, stroke=OUTPUT, stroke_width=width, data_link="output"),
            self._segment(self._scene.o4, c.b, 0.0, stroke="#fff", stroke_width=0.38 * width),
        )
        self._root.add(group)

    def _joints(self, c: Configuration) -> None:
        group = element("g", data_configuration="1", data_own_assembly="true")
        self._body_line(group, c, INK)
        pivots = (("O2", self._scene.o2), ("O4", self._scene.o4))
        for name, joint in pivots:
            self._mark(group, name, joint, PIVOT_RADIUS * self._size, fill="#fff", stroke=INK, stroke_width=2.0)
            if self._sees(joint):
                group.add(circle(self._viewport.point(joint), 1.6 * self._size, fill=INK))
        for name, joint in (("A", c.a), ("B", c.b)):
            self._mark(group, name, joint, JOINT_RADIUS * self._size, fill="#fff", stroke=INK, stroke_width=1.8)
        self._mark(group, "P", c.p, 3.2, fill=INK, stroke="#fff", stroke_width=0.8)
        self._root.add(group)

    def _rotation_arc(self) -> None:
        """Arc with an arrow from the input's first to its last angle."""
        scene, at = self._scene, self._viewport
        turned = scene.end - scene.start
        if abs(turned) < 1e-9 or not self._readable(scene.o2):
            return
        link = at.scale * float(scene.linkage.input)
        least, most = ROTATION_ARC
        radius = max(min(max(0.42 * link, least), most), min(ARC_LENGTH / abs(turned), 0.8 * link))
        head = math.copysign(min(abs(turned), 9.0 / radius), turned)
        arc = self._arc(radius, scene.start, scene.end - 0.8 * head)
        tip = complex(self._arc(radius, scene.end, scene.end)[0])
        back = complex(self._arc(radius, scene.end - head, scene.end)[0])
        middle = complex(self._arc(radius, scene.start, scene.start + 0.5 * turned)[-1])
        head_mark = arrow(back, tip, 4.0, INK)
        head_mark.attributes["data-rotation"] = repr(math.degrees(turned))
        self._root.add(path([arc], stroke=INK, stroke_width=1.4), head_mark)
        self._labels.avoid([arc], 2.0)
        self._arc_label = middle

    def _demand(self, demand: Demand) -> None:
        if self._readable(demand.point):
            at, number = self._viewport.point(demand.point), demand.index + 1
            if demand.angle is None:
                symbol, lines = demanded_point(at, number)
            else:
                symbol, lines = demanded_position(at, demand.angle, number)
            self._labels.avoid(lines, 3.0)
            self._root.add(symbol)

    def _misses(self) -> None:
        """How far P is from the points that are fitted: a line from each to where P passes it."""
        places = {demand.index: demand.point for demand in self._scene.demands if demand.angle is None}
        for c in self._scene.configurations:
            point = places.get(c.index)
            if point is None or not self._readable(point):
                continue
            one, other = self._viewport.point(point), self._viewport.point(c.p)
            if abs(other - one) >= SEEN_MISS and self._viewport.panel.holds(other):
                mark = line(one, other, stroke=DEMANDED, stroke_width=1.6, data_miss=f"{c.index + 1}")
                self._root.add(mark, circle(other, 1.8, fill=DEMANDED))

    def _label_linkage(self, c: Configuration) -> None:
        at = self._viewport.point
        o2, o4, a, b, p = (at(z) for z in (self._scene.o2, self._scene.o4, c.a, c.b, c.p))
        pivots = PIVOT_RADIUS * self._size + 2.0, JOINT_RADIUS * self._size + 3.0
        style = {"fill": INK, "font_weight": "bold"}
        for joint, point, words, digit, clearance, rays in (
            (self._scene.o2, o2, "O", "2", pivots[0], [a - o2, o4 - o2, 1j]),
            (self._scene.o4, o4, "O", "4", pivots[0], [b - o4, o2 - o4, 1j]),
            (c.a, a, "A", "", pivots[1], [o2 - a, b - a, p - a]),
            (c.b, b, "B", "", pivots[1], [o4 - b, a - b, p - b]),
            (c.p, p, "P", "", DEMAND_RADIUS + 1.0, [a - p, b - p, cmath.exp(-1j * c.body_angle)]),
        ):
            if not self._readable(joint):
                continue
            away = direction_between(rays)
            self._labels.place(point, words, 15.0, subscript=digit, clearance=clearance, away=away, style=style)

    def _label_demand(self, demand: Demand) -> None:
        if not self._readable(demand.point):
            return
        words = f"{demand.index + 1}"
        at = self._viewport.point(demand.point)
        away = -cmath.exp(-1j * demand.angle) if demand.angle is not None else -1j
        style = {"fill": DEMANDED, "font_weight": "bold"}
        self._labels.place(at, words, 11.0, clearance=DEMAND_RADIUS + 2.0, away=away, ring=DEMANDED, style=style)

    def _label_ghost(self, c: Configuration) -> None:
        for words, joint, pivot in (("A", c.a, self._scene.o2), ("B", c.b, self._scene.o4)):
            if not self._readable(joint):
                continue
            at = self._viewport.point(joint)
            self._labels.place(
                at,
                words,
                11.0,
                subscript=f"{c.index + 1}",
                clearance=4.0,
                away=at - self._viewport.point(pivot),
                optional=True,
                style={"fill": GREY},
            )

    def _label_links(self, c: Configuration) -> None:
        """Letters of the links at their middles, the turn of the input, and the word at its limits, where room is."""
        scene, at = self._scene, self._viewport
        ends = (("a", INPUT, scene.o2, c.a), ("b", COUPLER, c.a, c.b), ("c", OUTPUT, scene.o4, c.b))
        for letter, colour, start, end in (*ends, ("d", GROUND, scene.o2, scene.o4)):
            start, end = at.point(start), at.point(end)
            if abs(end - start) < 40.0:
                continue
            style = {"fill": colour, "font_style": "italic", "font_weight": "bold"}
            across = 1j * (end - start) / abs(end - start)
            self._labels.place(
                0.5 * (start + end), letter, 13.0, clearance=6.0, away=across, optional=True, style=style
            )
        if self._arc_label is not None:
            turned = angle(math.degrees(scene.end - scene.start), 1)
            away = self._arc_label - at.point(scene.o2)
            self._labels.place(
                self._arc_label, turned, 11.0, clearance=3.0, away=away, optional=True, style={"fill": INK}
            )
        radius = at.scale * float(scene.linkage.input)
        for limit in scene.limits or ():
            if not self._readable(scene.o2 + cmath.rect(float(scene.linkage.input), limit)):
                continue
            tip = at.point(scene.o2) + (radius + TICK) * cmath.exp(-1j * limit)
            away = cmath.exp(-1j * limit)
            self._labels.place(tip, "limit", 10.0, clearance=2.0, away=away, optional=True, style={"fill": INPUT})

    def _frame_box(self, detail: Detail) -> Box:
        at = self._viewport.point(detail.box.centre)
        half = [max(9.0, 0.5 * self._viewport.scale * side + 8.0) for side in (detail.box.width, detail.box.height)]
        return Box(at.real - half[0], at.imag - half[1], at.real + half[0], at.imag + half[1])

    def _frame(self, detail: Detail, box: Box) -> None:
        """Frame around a part that another panel shows."""
        corners = [complex(x, y) for x, y in ((box.left, box.low), (box.right, box.low), (box.right, box.high))]
        corners.append(complex(box.left, box.high))
        self._root.add(polygon(corners, fill="none", stroke=INK, stroke_width=0.9, stroke_dasharray="4 3"))
        self._labels.avoid([np.array([*corners, corners[0]])], 4.0)
        clearance = 0.5 * max(box.width, box.height)
        self._labels.place(box.centre, detail.name, 11.0, clearance=clearance, away=1 - 1j, style={"fill": INK})

    _arc_label: complex | None = None


def _cross(at: complex, radius: float) -> Points:
    """Sample line through a circular mark."""
    return np.array([at - radius, at + radius, at, at - 1j * radius, at + 1j * radius])
