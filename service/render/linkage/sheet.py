"""The sheet of a linkage for every kind of problem: title, picture, dimensions, tables, checks and diagrams.

The parts that depend on the kind (the picture, its own tables, diagrams) are in
:mod:`service.render.linkage.kind_tables`.
"""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from service.render.checks import describe_failures, describe_verdict, make_checks_block
from service.render.linkage.content import Content
from service.render.linkage.kind_tables import make_content
from service.render.linkage.motion import DrivenLinkage
from service.render.outline import list_entries
from service.render.page import blocks
from service.render.page.numbers import format_angle, format_length
from service.render.page.sheet import (
    BORDER,
    GUTTER,
    INNER_WIDTH,
    UNIT_NAMES,
    arrange_columns,
    get_drawing_width,
    stack_blocks,
    write_sheet,
)
from service.render.page.svg import Box
from synthesis.model.design_interface import AnyDesign
from synthesis.model.problem import ProblemBase

VERTICAL_GAPS = 8.0, 10.0
"""Space above a diagram, and above tables below the picture, pixels."""

COLUMN_WIDTHS = (320.0, 390.0, INNER_WIDTH - 2.0 * GUTTER - 710.0)
"""Widths of the columns of tables below a picture, pixels."""


TITLES = {
    "grashof": "type",
    "barker": "Barker's type",
    "full rotation": "input turns fully",
    "same branch": "one branch",
    "visits in order": "targets in order",
    "link ratio": "longest : shortest link",
}
"""Titles of metrics shared by several kinds whose field names are too terse."""


def draw_linkage_sheet(design: AnyDesign, problem: ProblemBase, title: str) -> str:
    """Draw a linkage design as a complete SVG document."""
    content = make_content(design, problem, DrivenLinkage.from_design(design))
    unit = problem.length_unit
    tables = [
        content.dimensions or blocks.make_rows(f"Dimensions ({unit})", _list_dimensions(design.mechanism, content)),
        *content.tables,
        make_checks_block(design.verification, problem),
        blocks.make_rows("Metrics", _list_metrics(design.metrics, problem, content)),
    ]
    picture = content.picture
    width = INNER_WIDTH if picture.wide else get_drawing_width()
    parts, bottom = picture.draw(width)
    for diagram in content.diagrams:
        top = bottom + VERTICAL_GAPS[0]
        parts.append(diagram.draw(Box(BORDER, top, BORDER + width, top + diagram.height), content.marks))
        bottom = top + diagram.height
    if picture.wide:
        # The columns are: dimensions; targets and checks; metrics.
        drawn, y = arrange_columns((tables[:1], tables[1:-1], tables[-1:]), COLUMN_WIDTHS, bottom + VERTICAL_GAPS[1])
    else:
        drawn, y = stack_blocks(tables)
    words = f"{content.words}; lengths in {UNIT_NAMES[unit]}; {describe_verdict(design.verification)}"
    described = f"Drawing of {content.described}. {content.words}. {describe_failures(design.verification)}"
    return write_sheet(title or content.name, words, described, [*parts, *drawn], max(bottom, y))


def _list_metrics(metrics: BaseModel, problem: ProblemBase, content: Content) -> list[tuple[str, str]]:
    """Return the rows of the metrics, without those that the sheet shows elsewhere."""
    left_out = set(content.left_out)
    # A single transmission angle is already listed as the minimum; individual ones are listed if there are several.
    if len(getattr(metrics, "transmission_angles", ())) < 2:
        left_out.add("transmission_angles")
    return list_entries(metrics, problem, left_out, {**TITLES, **content.titles})


def _list_dimensions(mechanism: Any, content: Content) -> list[tuple[str, str]]:
    """Return links, further dimensions of the kind, and the skeleton."""
    size = content.picture.box.diagonal
    links = mechanism.links if isinstance(mechanism.links, dict) else mechanism.links.model_dump()
    rows = [(name.replace("_", " "), format_length(value)) for name, value in links.items()]
    rows += content.more_dimensions
    rows += [
        (f"{name} {content.standing}", f"({format_length(x, size)}, {format_length(y, size)})")
        for name, (x, y) in mechanism.skeleton.joints.items()
        if name not in content.hidden
    ]
    rows += [(f"gear ratio {' : '.join(reversed(gear.links))}", f"{gear.ratio:g}") for gear in mechanism.skeleton.gears]
    rows += [
        (f"slide of {slide.joint} on {slide.link}", format_angle(slide.angle)) for slide in mechanism.skeleton.slides
    ]
    return rows
