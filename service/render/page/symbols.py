"""Symbols of a drawing, in sheet coordinates: ground bearing, target position, arrow head, scale bar; and colours.

A symbol that labels must avoid is returned with its lines, or with the box that it covers.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from kinematics.arrays import Complex
from service.render.page.numbers import format_length
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    draw_circle,
    draw_line,
    draw_polygon,
    draw_text,
    estimate_text_width,
    make_element,
)

INK, GREY, PALE = "#1d232b", "#76818c", "#aab3bc"
INPUT, COUPLER, OUTPUT, GROUND = "#1f5a9e", "#b8600b", "#22734a", "#3c444d"
TARGET_COLOUR, CURVE = "#a3195b", "#5b3a8c"

DIRECTION_LENGTH, TARGET_RADIUS = 40.0, 7.5
"""Length of a target position's direction line, and radius of its ring, pixels."""

MAX_SCALE_BAR_SHARE = 0.2
"""Maximum length of the scale bar as a share of the panel's width."""


def draw_arrow(back: complex, tip: complex, half: float, colour: str) -> Element:
    """Draw a filled arrow head of half width ``half``."""
    along = (tip - back) / abs(tip - back)
    return draw_polygon([tip, back + 1j * half * along, back - 1j * half * along], fill=colour)


def draw_bearing(at: complex, size: float) -> tuple[Element, list[Complex]]:
    """Draw the ground symbol of a fixed pivot: a triangle on a hatched line; ``size`` 1 is the standard size."""
    half, height = 11.0 * size, 17.0 * size
    left, right = at + complex(-half, height), at + complex(half, height)
    ends = [at + complex(x * size, height) for x in (-12.0, -6.0, 0.0, 6.0, 12.0)]
    symbol = make_element(
        "g",
        draw_polygon([at, right, left], fill="#eef0f2", stroke=GROUND, stroke_width=1.3, stroke_linejoin="round"),
        draw_line(left - 4.0 * size, right + 4.0 * size, stroke=GROUND, stroke_width=1.6),
        *(draw_line(end, end + complex(-5.0, 6.0) * size, stroke=GROUND, stroke_width=1.0) for end in ends),
    )
    return symbol, [np.array([at, left, right, at]), np.array([left, right]) + 4j * size]


def draw_target(at: complex, angle: float | None, number: int) -> tuple[Element, list[Complex]]:
    """Draw the ring of a target point, and for a target position also the body's frame.

    The frame is a long arrow at the angle of the position and a short line across it. The angle is in radians, or None
    for a target point.
    """
    ring = draw_circle(at, TARGET_RADIUS, fill="none", stroke=TARGET_COLOUR, stroke_width=1.6, stroke_dasharray="3 1.6")
    if angle is None:
        return make_element("g", ring, data_target=f"{number}"), []
    # Sheet coordinates point down, so the angle changes sign.
    ahead = cmath.exp(-1j * angle)
    tip, side = at + DIRECTION_LENGTH * ahead, at - 0.42j * DIRECTION_LENGTH * ahead
    symbol = make_element(
        "g",
        draw_line(at, tip - 6.0 * ahead, stroke=TARGET_COLOUR, stroke_width=4.5, stroke_opacity=0.35),
        draw_line(at, side, stroke=TARGET_COLOUR, stroke_width=1.3),
        draw_arrow(tip - 8.0 * ahead, tip + 4.0 * ahead, 4.5, TARGET_COLOUR),
        ring,
        data_target=f"{number}",
        data_angle=repr(math.degrees(angle)),
    )
    return symbol, [np.array([at, tip + 4.0 * ahead]), np.array([at, side])]


def draw_scale_bar(viewport: Viewport, unit: str) -> tuple[Element, Box]:
    """Draw a bar of a round length (1, 2 or 5 times a power of ten) in the panel's lower left corner."""
    box = viewport.panel
    room = MAX_SCALE_BAR_SHARE * box.width / viewport.scale
    power = 10.0 ** math.floor(math.log10(room))
    # The longest round length that fits.
    marked = max(step * power for step in (1.0, 2.0, 5.0) if step == 1.0 or step * power <= room)
    left, base, width = box.left + 14.0, box.high - 14.0, marked * viewport.scale
    words = f"{format_length(marked, digits=2)} {unit}"
    covered = Box(left - 6.0, base - 14.0, left + width + 14.0 + estimate_text_width(words, 11.0), base + 8.0)
    cells = [
        make_element("rect", x=left + k * width / 4, y=base - 5.0, width=width / 4, height=5.0, fill=fill, stroke=INK)
        for k, fill in enumerate((INK, "#fff", INK, "#fff"))
    ]
    group = make_element(
        "g",
        make_element("rect", x=covered.left, y=covered.low, width=covered.width, height=covered.height, fill="#fff"),
        *cells,
        draw_text(left + width + 8.0, base, words, 11.0, fill=INK),
        data_scale_bar=repr(marked),
        stroke_width=0.8,
    )
    return group, covered
