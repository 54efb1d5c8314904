"""One panel of a fourbar drawing, from the back to the front: curves, links, targets, labels and a scale bar.

Line styles distinguish the parts without colours, too: see :mod:`service.render.linkage.fourbar_links`. The used part
of the coupler curve is heavy, the rest thin.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from service.render.linkage import fourbar_links as links
from service.render.linkage import fourbar_marks as marks
from service.render.linkage.fourbar import FourbarScene
from service.render.linkage.fourbar_canvas import Canvas, Detail
from service.render.page.labels import Label
from service.render.page.svg import Box, Element, Viewport, draw_polygon, draw_text, make_element
from service.render.page.symbols import INK, draw_scale_bar

MARGIN, MARGIN_BELOW = 60.0, 22.0
"""Margins of a panel around the content, and additional space below for the scale bar, pixels."""


def draw_fourbar_panel(
    scene: FourbarScene, viewport: Viewport, name: str, unit: str, details: Sequence[Detail]
) -> Element:
    """Draw the panel as a nested drawing that clips its content.

    Parameters
    ----------
    scene : FourbarScene
        The content.
    viewport : Viewport
        The map to the panel.
    name : str
        Marks the element (``data-view``) and is its heading, unless it is "main".
    unit : str
        Length unit, for the scale bar.
    details : sequence of Detail
        Parts shown in other panels: framed in this one, and labelled only there.
    """
    canvas = Canvas(scene, viewport, name, details)
    first, ghosts = canvas.first, scene.others
    # Reserve the space of heading and scale bar before labels are placed.
    annotations = _draw_annotations(canvas, name, unit)
    marks.draw_input_circle(canvas)
    marks.draw_curves(canvas)
    # Earlier targets lie on top of later ones.
    for ghost in reversed(ghosts):
        links.draw_ghost(canvas, ghost)
    links.draw_ground(canvas)
    if first is not None:
        links.draw_linkage(canvas, first)
    arc = marks.draw_rotation_arc(canvas)
    for demand in scene.demands:
        marks.draw_demand(canvas, demand)
    marks.draw_misses(canvas)
    if first is not None:
        links.draw_joints(canvas, first)
    for detail, frame in canvas.frames:
        _draw_frame(canvas, detail, frame)
    if first is not None:
        links.label_joints(canvas, first)
    for demand in scene.demands:
        marks.label_demand(canvas, demand)
    for ghost in ghosts:
        links.label_ghost(canvas, ghost)
    if first is not None:
        links.label_links(canvas, first)
        marks.label_input(canvas, arc)
    return canvas.root.add(*annotations, *canvas.labels.drawn)


def _draw_annotations(canvas: Canvas, name: str, unit: str) -> list[Element]:
    """Draw heading and scale bar on white, and keep labels away from them."""
    box = canvas.viewport.panel
    bar, covered = draw_scale_bar(canvas.viewport, unit)
    canvas.labels.reserve(covered)
    if name == "main":
        return [bar]
    canvas.labels.reserve(Box(box.left, box.low, box.left + 76.0, box.low + 26.0))
    plate = make_element("rect", x=box.left + 4.0, y=box.low + 4.0, width=68.0, height=20.0, fill="#fff")
    return [plate, draw_text(box.left + 10.0, box.low + 18.0, name, 12.0, font_weight="bold", fill=INK), bar]


def _draw_frame(canvas: Canvas, detail: Detail, box: Box) -> None:
    """Draw a frame around a part that another panel shows."""
    corners = [complex(x, y) for x, y in ((box.left, box.low), (box.right, box.low), (box.right, box.high))]
    corners.append(complex(box.left, box.high))
    canvas.root.add(draw_polygon(corners, fill="none", stroke=INK, stroke_width=0.9, stroke_dasharray="4 3"))
    canvas.labels.add_obstacles([np.array([*corners, corners[0]])], 4.0)
    clearance = 0.5 * max(box.width, box.height)
    canvas.labels.place(box.centre, Label(detail.name, 11.0, {"fill": INK}), clearance=clearance, away=1 - 1j)
