"""The sheet of a linkage that is driven through a part of its motion: drawing and diagrams at the left, tables beside.

What is shown is the scene, what is demanded is drawn over it by the caller, and each kind brings its own tables.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from service.render.linkage.drawing import Scene, drawing
from service.render.page.blocks import Block
from service.render.page.diagrams import Diagram
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    document,
    shortened,
    text,
)
from service.render.page.symbols import GREY, INK
from synthesis.model.answer import Verification

WIDTH, EDGE, TOP, COLUMN, GUTTER = 1100.0, 22.0, 74.0, 370.0, 26.0
"""Width of the sheet, border, height of the title, width of the tables' column, space beside it; pixels."""

HEIGHTS = (420.0, 720.0)
"""Least and greatest height of the drawing, pixels."""

DIAGRAM = 170.0
"""Height of a diagram, pixels."""

Overlay = Callable[[Viewport], list[Element]]


def driven_sheet(
    heading: str,
    words: str,
    shown: Scene,
    box: Box,
    unit: str,
    overlay: Overlay,
    diagrams: Sequence[Diagram],
    tables: Sequence[Block],
    marks: Sequence[float] = (),
    *,
    heights: tuple[float, float] = HEIGHTS,
    subject: str = "a linkage",
) -> str:
    """A complete SVG document.

    Parameters
    ----------
    heading, words : str
        Title, and the line below it.
    shown : Scene
        The linkage at its inputs.
    box : Box
        What the drawing must show, in the linkage's coordinates.
    unit : str
        Of lengths.
    overlay : callable
        Draws what is demanded over the linkage.
    diagrams, tables
        Below the drawing, and beside it.
    marks : sequence of float
        Angles that the diagrams mark, degrees.
    heights : pair of float
        Least and greatest height of the drawing, pixels.
    subject : str
        What is drawn, for who does not see it.
    """
    width = WIDTH - 2.0 * EDGE - COLUMN - GUTTER
    wanted = (width - 100.0) / max(box.width, 1e-300) * box.height + 130.0
    height = math.floor(min(max(wanted, heights[0]), heights[1]))
    view = Viewport.fit(box, Box(EDGE, TOP, EDGE + width, TOP + height), 50.0, 26.0)
    panel = drawing(shown, view, unit)
    parts = [panel.add(*overlay(view))]
    bottom = view.panel.high
    for diagram in diagrams:
        parts.append(diagram.draw(Box(EDGE, bottom + 8.0, EDGE + width, bottom + 8.0 + DIAGRAM), marks))
        bottom += 8.0 + DIAGRAM
    y = TOP - 6.0
    for block in tables:
        drawn, y = block(WIDTH - EDGE - COLUMN, y, COLUMN)
        parts.append(drawn)
    return document(
        heading,
        f"Drawing of {subject}. {words}.",
        (WIDTH, float(math.ceil(max(bottom, y) + EDGE - 8.0))),
        text(EDGE, 34.0, shortened(heading, 20.0, WIDTH - 2.0 * EDGE), 20.0, font_weight="bold", fill=INK),
        text(EDGE, 55.0, shortened(words, 12.5, WIDTH - 2.0 * EDGE), 12.5, fill=GREY),
        *parts,
    )


def verdict(verification: Verification) -> str:
    """In words, how many checks fail."""
    failed = [check for check in verification.checks if not check.passed]
    return f"fails {len(failed)} of {len(verification.checks)} checks" if failed else "passes all checks"
