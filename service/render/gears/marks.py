"""Elements shared by the drawings of gears: the two circles of a gear, framed labels, colours."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Complex
from kinematics.gear.teeth import Gear
from service.render.gears.placement import PlacedGear
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    draw_circle,
    draw_path,
    draw_text,
    estimate_text_width,
    make_element,
)
from service.render.page.symbols import COUPLER, CURVE, INPUT, OUTPUT

PANEL_FILL = "#fbfcfd"
"""Background of a panel."""

STAGE_COLOURS = (INPUT, OUTPUT, COUPLER, CURVE)
"""Colours of the stages."""

LABEL_FONT_SIZE = 11.5
"""Font size of a label, pixels."""

MIN_POINT_DISTANCE = 0.8
"""Minimum distance of points of an outline, pixels; closer points are dropped."""

LABEL_HALF_HEIGHT = 8.0
"""Half the height of a label's frame, pixels."""


def draw_circles(
    gear: Gear, centre: complex, view: Viewport, colour: str, shaded: str, opacity: float, /, **marks: str
) -> Element:
    """Draw the tip circle thin and the pitch circle dash-dotted.

    The circle named by ``shaded``, "tip" or "pitch", is filled.
    """
    at = view.point(centre)
    faces: dict[str, dict[str, str | float]] = {"tip": {"fill": "none"}, "pitch": {"fill": "none"}}
    faces[shaded] = {"fill": colour, "fill_opacity": opacity}
    tip = draw_circle(at, view.scale * gear.tip_radius, **faces["tip"], stroke=colour, stroke_width=0.6)
    dashed: dict[str, str | float] = {"stroke": colour, "stroke_width": 1.6, "stroke_dasharray": "9 3 2 3"}
    return make_element("g", tip, draw_circle(at, view.scale * gear.pitch_radius, **faces["pitch"], **dashed), **marks)


def draw_shifted_teeth(placed: PlacedGear, view: Viewport, colour: str) -> list[Element]:
    """Draw the true outline of a gear whose profile shift its circles alone do not show."""
    teeth = placed.get_teeth()
    # A pointed cutter has no outline; the circles remain.
    if teeth is None:
        return []
    drawn = draw_path(
        [_drop_close_points(view.points(placed.centre + np.append(teeth, teeth[:1])))], stroke=colour, stroke_width=0.7
    )
    return [] if drawn is None else [drawn]


def _drop_close_points(points: Complex) -> Complex:
    """Drop points that are too close to their predecessor to be visible."""
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(points)))])
    kept = np.concatenate([[True], np.diff(np.floor(along / MIN_POINT_DISTANCE)) > 0.0])
    kept[-1] = True
    return np.asarray(points[kept])


def label_box(at: complex, words: str) -> Box:
    """Return the box covered by a label about a point."""
    half = 0.5 * estimate_text_width(words, LABEL_FONT_SIZE) + 3.0
    return Box(at.real - half, at.imag - LABEL_HALF_HEIGHT, at.real + half, at.imag + LABEL_HALF_HEIGHT)


def draw_label(box: Box, words: str, colour: str, name: str) -> Element:
    """Draw words in a rounded frame."""
    frame = make_element(
        "rect", x=box.left, y=box.low, width=box.width, height=box.height, rx=3.0, fill="#fff", stroke=colour
    )
    middle = box.centre
    inside = draw_text(
        middle.real, middle.imag + 4.2, words, LABEL_FONT_SIZE, text_anchor="middle", fill=colour, font_weight="bold"
    )
    return make_element("g", frame, inside, data_label=name)
