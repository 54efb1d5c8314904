"""The frame of a sheet: title and subtitle above, a drawing at the left, blocks of rows next to it or below it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from service.render.page.blocks import Block
from service.render.page.svg import Box, Element, Viewport, draw_text, make_element, truncate_text, write_document
from service.render.page.symbols import GREY, INK, PALE

SHEET_WIDTH, BORDER, TOP, COLUMN_WIDTH, GUTTER = 1100.0, 22.0, 74.0, 370.0, 26.0
"""Width of the sheet, border, height of the title, width of the tables' column, space next to it; pixels."""

HEADING_STYLE, SUBTITLE_STYLE = (34.0, 20.0), (55.0, 12.5)
"""Base lines and font sizes of the heading and of the subtitle, pixels."""

INNER_WIDTH = SHEET_WIDTH - 2.0 * BORDER
"""Width between the borders, pixels."""

BOTTOM_REDUCTION = 8.0
"""Reduction of the lower border, pixels: the last row already ends with a gap."""

MIN_RELATIVE_WIDTH = 1e-12
"""A box narrower than this share of its distance from the origin has no width but rounding errors."""

UNIT_NAMES = {"mm": "millimetres", "cm": "centimetres", "m": "metres", "in": "inches"}


def write_sheet(heading: str, words: str, described: str, parts: Iterable[Element], bottom: float) -> str:
    """Write a complete SVG document: heading, subtitle, and parts whose lower end is ``bottom``.

    ``described`` is the description for readers who cannot see the drawing.
    """
    # The last row already ends with a gap of its own.
    height = float(math.ceil(bottom + BORDER - BOTTOM_REDUCTION))
    return write_document(
        heading,
        described,
        (SHEET_WIDTH, height),
        draw_text(
            BORDER,
            HEADING_STYLE[0],
            truncate_text(heading, HEADING_STYLE[1], INNER_WIDTH),
            HEADING_STYLE[1],
            font_weight="bold",
            fill=INK,
        ),
        draw_text(
            BORDER,
            SUBTITLE_STYLE[0],
            truncate_text(words, SUBTITLE_STYLE[1], INNER_WIDTH),
            SUBTITLE_STYLE[1],
            fill=GREY,
        ),
        *parts,
    )


def get_drawing_width(column: float = COLUMN_WIDTH) -> float:
    """Return the width of a drawing that has a column of tables at its right."""
    return INNER_WIDTH - column - GUTTER


def stack_blocks(
    blocks: Iterable[Block], left: float | None = None, top: float = TOP - 6.0, width: float = COLUMN_WIDTH
) -> tuple[list[Element], float]:
    """Draw blocks below one another, at the right border by default; return them and the y below them."""
    parts, y = [], top
    for block in blocks:
        drawn, y = block(SHEET_WIDTH - BORDER - width if left is None else left, y, width)
        parts.append(drawn)
    return parts, y


def arrange_columns(
    columns: Sequence[Sequence[Block]], widths: Sequence[float], top: float
) -> tuple[list[Element], float]:
    """Draw columns of blocks side by side, starting at the left border.

    The widths are in pixels. Return the elements and the y below the longest column.
    """
    parts, left, bottom = [], BORDER, top
    for blocks, width in zip(columns, widths, strict=True):
        drawn, y = stack_blocks(blocks, left, top, width)
        parts += drawn
        left, bottom = left + width + GUTTER, max(bottom, y)
    return parts, bottom


def draw_panel(box: Box, name: str, fill: str = "#fff") -> Element:
    """Draw an empty panel with its frame."""
    frame = {"x": box.left, "y": box.low, "width": box.width, "height": box.height}
    return make_element("g", make_element("rect", **frame, fill=fill, stroke=PALE), data_panel=name)


def draw_caption(panel: Box, words: str) -> Element:
    """Draw words in the upper left corner of a panel."""
    return draw_text(panel.left + 10.0, panel.low + 18.0, words, 11.0, fill=GREY)


def draw_clipping_panel(panel: Box, name: str, **marks: str) -> Element:
    """Draw an empty panel with its frame that clips its content."""
    sides = {"x": panel.left, "y": panel.low, "width": panel.width, "height": panel.height}
    return make_element(
        "svg",
        make_element("rect", **sides, fill="#fff", stroke=PALE),
        **sides,
        viewBox=" ".join(f"{side:g}" for side in sides.values()),
        overflow="hidden",
        data_view=name,
        **marks,
    )


def fit_panel(
    box: Box, width: float, heights: tuple[float, float], margin: float, foot: float, spare: float = 4.0
) -> Viewport:
    """Return a panel at the left border, as high as its content needs between the minimum and maximum height.

    ``margin`` pixels stay free around the content, ``foot`` more below it, and ``spare`` of the height.
    """
    # A vertical line has no width: rounding errors must not set the scale.
    across = max(box.width, MIN_RELATIVE_WIDTH * abs(box.centre))
    scale = (width - 2.0 * margin) / across if across > 0.0 else math.inf
    # A level line needs no height at any scale.
    needed = scale * box.height if box.height > 0.0 else 0.0
    height = math.floor(min(max(needed + 2.0 * margin + foot + spare, heights[0]), heights[1]))
    return Viewport.fit(box, Box(BORDER, TOP, BORDER + width, TOP + height), margin, foot)


def describe_verdict(passed: Sequence[bool]) -> str:
    """Return the number of failed checks in words."""
    failed = len(passed) - sum(passed)
    return f"fails {failed} of {len(passed)} checks" if failed else "passes all checks"
