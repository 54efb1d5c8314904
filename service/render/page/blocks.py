"""Blocks of rows on a sheet: a heading, names with values, and the checks of a design."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from service.render.page.svg import (
    Element,
    clean_text,
    draw_line,
    draw_text,
    estimate_text_width,
    make_element,
    truncate_text,
)
from service.render.page.symbols import GREY, INK, OUTPUT, PALE

ROW_HEIGHT, HEADING_HEIGHT, BLOCK_GAP = 18.0, 24.0, 16.0
"""Heights of a row and of a block's heading, and the space after a block, pixels."""

FONT_SIZE, SMALL_FONT_SIZE = 11.5, 10.5
"""Font sizes of rows, and of tables with their many columns, pixels."""

MARK_OFFSET, NAME_OFFSET = 8.0, 22.0
"""Offset of a check's mark from the left edge, and of its name, pixels."""

MIN_COLUMN_GAP, NOTE_SHIFT = 5.0, 3.0
"""Minimum space between the columns of a table, and the reduction of line spacing before a note, pixels."""

TEXT_COLUMN_SHARE = 0.36
"""Width of a text column as a share of the table's width."""

Block = Callable[[float, float, float], tuple[Element, float]]
"""Draws a block at left, top and width; returns its element and the y below it."""

Sample = Callable[[str, float, float], Element | None]
"""Draws a sample of a row's line style at the left on the row's base line; returns None for a row without a style."""

SAMPLE_WIDTH = 34.0
"""Width of the samples of line styles, pixels."""


class CheckRow(NamedTuple):
    """A check as text: value and limit with their units, empty if it has none."""

    name: str
    passed: bool
    value: str
    limit: str


def make_rows(heading: str, entries: Sequence[tuple[str, str]], sample: Sample | None = None) -> Block:
    """Return a block of names at the left and values at the right, optionally with samples of line styles."""

    def draw(left: float, top: float, width: float) -> tuple[Element, float]:
        block, y = start_block(heading, left, top, width)
        start = left if sample is None else left + SAMPLE_WIDTH
        for name, value in entries:
            y += ROW_HEIGHT
            block.add(
                sample(name, left, y) if sample is not None else None, draw_text(start, y, name, FONT_SIZE, fill=INK)
            )
            block.add(_draw_value(left + width, y, value, start + estimate_text_width(name, FONT_SIZE)))
        return block, y + BLOCK_GAP

    return draw


class TableRow(NamedTuple):
    """Cells of a table row, and a note on a line of its own below; a line may consist of the note only."""

    cells: Sequence[str]
    note: str = ""


def make_table(
    heading: str, heads: Sequence[str], lines: Sequence[TableRow], ends: Sequence[float], worded: int | None = None
) -> Block:
    """Return a block with a table in small type.

    ``ends`` are the right ends of its columns as shares of the width; cells that are too wide are set in smaller type.
    The column ``worded`` contains words instead of numbers: they start at its end and are truncated where the next
    begins.
    """

    def draw(left: float, top: float, width: float) -> tuple[Element, float]:
        block, y = start_block(heading, left, top, width)
        for cells, note in (TableRow(heads), *lines):
            fill = GREY if cells is heads else INK
            y += ROW_HEIGHT if cells else 0.0
            for n, (cell, end) in enumerate(zip(cells, ends, strict=False)):
                x = left + end * width
                # Words start where the previous column ends and are not shrunk.
                if n == worded:
                    words = truncate_text(cell, SMALL_FONT_SIZE, TEXT_COLUMN_SHARE * width)
                    block.add(draw_text(x, y, words, SMALL_FONT_SIZE, fill=fill))
                    continue
                room = (end - (ends[n - 1] if n else 0.0)) * width - MIN_COLUMN_GAP
                # Shrink only cells that are too wide.
                size = SMALL_FONT_SIZE * min(1.0, room / max(estimate_text_width(cell, SMALL_FONT_SIZE), 1.0))
                block.add(draw_text(x, y, cell, size, text_anchor="end", fill=fill))
            if note:
                y += ROW_HEIGHT - NOTE_SHIFT if cells else ROW_HEIGHT
                block.add(
                    draw_text(left + width, y, note, SMALL_FONT_SIZE, text_anchor="end", fill=INK, font_style="italic")
                )
        return block, y + BLOCK_GAP

    return draw


def make_checks(listed: Sequence[CheckRow]) -> Block:
    """Return a block of every check with a mark, its name, value and limit; long values get a line of their own."""

    def draw(left: float, top: float, width: float) -> tuple[Element, float]:
        verdict = "all passed" if all(check.passed for check in listed) else "not all passed"
        block, y = start_block(f"Checks: {verdict}", left, top, width)
        for check in listed:
            y += ROW_HEIGHT
            measure = f"{check.value}  (limit {check.limit})" if check.limit else check.value
            room = width - NAME_OFFSET
            words = truncate_text(clean_text(check.name.replace("_", " ")), FONT_SIZE, room)
            row = make_element(
                "g", _draw_mark(check.passed, left + MARK_OFFSET, y - 4.0), data_check=clean_text(check.name)
            )
            row.add(draw_text(left + NAME_OFFSET, y, words, FONT_SIZE, fill=INK))
            # Name and measure do not fit on one line: put the measure below.
            if estimate_text_width(words, FONT_SIZE) + MARK_OFFSET + estimate_text_width(measure, FONT_SIZE) > room:
                y += ROW_HEIGHT - NOTE_SHIFT
            row.add(draw_text(left + width, y, measure, FONT_SIZE, text_anchor="end", fill=INK))
            block.add(row)
        return block, y + BLOCK_GAP

    return draw


def start_block(heading: str, left: float, top: float, width: float) -> tuple[Element, float]:
    """Start a block with its heading and rule; return it and the y from which rows are counted."""
    base = top + HEADING_HEIGHT - 9.0
    rule = draw_line(complex(left, base + 6.0), complex(left + width, base + 6.0), stroke=PALE, stroke_width=1.0)
    title = draw_text(left, base, heading, 12.5, font_weight="bold", fill=INK)
    return make_element(
        "g", title, rule, data_block=heading.split(" ")[0].rstrip(":").lower()
    ), top + HEADING_HEIGHT - 2.0


def _draw_value(right: float, y: float, value: str, after: float) -> Element:
    """Draw a value at the right end of a row, in smaller type if it would touch the row's name."""
    width = estimate_text_width(value, FONT_SIZE)
    size = FONT_SIZE * min(1.0, (right - after - 6.0) / width) if width > 0.0 else FONT_SIZE
    return draw_text(right, y, value, size, text_anchor="end", fill=INK)


def _draw_mark(passed: bool, x: float, y: float) -> Element:
    """Draw a tick or a cross as a path, so that it does not depend on a font."""
    colour = OUTPUT if passed else "#b3261e"
    shape = f"M{x - 5:.1f} {y:.1f}l3.5 4l6.5 -8.5" if passed else f"M{x - 4:.1f} {y - 4:.1f}l8 8m0 -8l-8 8"
    return make_element("path", d=shape, fill="none", stroke=colour, stroke_width=2.2, data_passed=str(passed).lower())
