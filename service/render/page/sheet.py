"""The frame of a sheet: title and subtitle above, a drawing at the left, blocks of rows next to it or below it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from service.render.page.blocks import Block
from service.render.page.svg import Box, Element, Viewport, document, element, shortened, text
from service.render.page.symbols import GREY, INK, PALE

WIDTH, EDGE, TOP, COLUMN, GUTTER = 1100.0, 22.0, 74.0, 370.0, 26.0
"""Width of the sheet, border, height of the title, width of the tables' column, space next to it; pixels."""

HEADING, WORDS = (34.0, 20.0), (55.0, 12.5)
"""Base lines and font sizes of the heading and of the subtitle, pixels."""

FULL = WIDTH - 2.0 * EDGE
"""Width between the borders, pixels."""

FOOT = 8.0
"""Reduction of the lower border, pixels: the last row already ends with a gap."""

THINNEST = 1e-12
"""A box narrower than this share of its distance from the origin has no width but rounding errors."""

UNITS = {"mm": "millimetres", "cm": "centimetres", "m": "metres", "in": "inches"}


def sheet(heading: str, words: str, described: str, parts: Iterable[Element], bottom: float) -> str:
    """Write a complete SVG document: heading, subtitle, and parts whose lower end is ``bottom``.

    ``described`` is the description for readers who cannot see the drawing.
    """
    # The last row already ends with a gap of its own.
    height = float(math.ceil(bottom + EDGE - FOOT))
    return document(
        heading,
        described,
        (WIDTH, height),
        text(EDGE, HEADING[0], shortened(heading, HEADING[1], FULL), HEADING[1], font_weight="bold", fill=INK),
        text(EDGE, WORDS[0], shortened(words, WORDS[1], FULL), WORDS[1], fill=GREY),
        *parts,
    )


def beside(column: float = COLUMN) -> float:
    """Return the width of a drawing that has a column of tables at its right."""
    return FULL - column - GUTTER


def stacked(
    blocks: Iterable[Block], left: float | None = None, top: float = TOP - 6.0, width: float = COLUMN
) -> tuple[list[Element], float]:
    """Draw blocks below one another, at the right border by default; return them and the y below them."""
    parts, y = [], top
    for block in blocks:
        drawn, y = block(WIDTH - EDGE - width if left is None else left, y, width)
        parts.append(drawn)
    return parts, y


def in_columns(columns: Sequence[Sequence[Block]], widths: Sequence[float], top: float) -> tuple[list[Element], float]:
    """Draw columns of blocks side by side from the left border, widths in pixels; return them and the y below the
    longest.
    """
    parts, left, bottom = [], EDGE, top
    for blocks, width in zip(columns, widths, strict=True):
        drawn, y = stacked(blocks, left, top, width)
        parts += drawn
        left, bottom = left + width + GUTTER, max(bottom, y)
    return parts, bottom


def framed(box: Box, name: str, fill: str = "#fff") -> Element:
    """Draw an empty panel with its frame."""
    frame = {"x": box.left, "y": box.low, "width": box.width, "height": box.height}
    return element("g", element("rect", **frame, fill=fill, stroke=PALE), data_panel=name)


def caption(panel: Box, words: str) -> Element:
    """Draw words in the upper left corner of a panel."""
    return text(panel.left + 10.0, panel.low + 18.0, words, 11.0, fill=GREY)


def clipping(panel: Box, name: str, **marks: str) -> Element:
    """Draw an empty panel with its frame that clips its content."""
    sides = {"x": panel.left, "y": panel.low, "width": panel.width, "height": panel.height}
    return element(
        "svg",
        element("rect", **sides, fill="#fff", stroke=PALE),
        **sides,
        viewBox=" ".join(f"{side:g}" for side in sides.values()),
        overflow="hidden",
        data_view=name,
        **marks,
    )


def fitted(
    box: Box, width: float, heights: tuple[float, float], margin: float, foot: float, spare: float = 4.0
) -> Viewport:
    """Return a panel at the left border, as high as its content needs between the minimum and maximum height.

    ``margin`` pixels stay free around the content, ``foot`` more below it, and ``spare`` of the height.
    """
    # A vertical line has no width: rounding errors must not set the scale.
    across = max(box.width, THINNEST * abs(box.centre))
    scale = (width - 2.0 * margin) / across if across > 0.0 else math.inf
    # A level line needs no height at any scale.
    needed = scale * box.height if box.height > 0.0 else 0.0
    height = math.floor(min(max(needed + 2.0 * margin + foot + spare, heights[0]), heights[1]))
    return Viewport.fit(box, Box(EDGE, TOP, EDGE + width, TOP + height), margin, foot)


def verdict(passed: Sequence[bool]) -> str:
    """Return the number of failed checks in words."""
    failed = len(passed) - sum(passed)
    return f"fails {failed} of {len(passed)} checks" if failed else "passes all checks"
