"""The sheet of a linkage, whatever the kind of its problem: title, picture, dimensions, tables, checks and diagrams.

What differs from kind to kind (the picture, the tables of its own, diagrams) is declared in
:mod:`service.render.linkage.kind_tables`.
"""

from __future__ import annotations

from typing import Any

from service.render.checks import checks, outcome, verdict
from service.render.linkage.content import Content
from service.render.linkage.kind_tables import content_of
from service.render.linkage.motion import DrivenLinkage
from service.render.page import blocks
from service.render.page.blocks import Block
from service.render.page.numbers import angle, length
from service.render.page.sheet import EDGE, FULL, GUTTER, UNITS, beside, sheet, stacked
from service.render.page.svg import Box, Element

DIAGRAM = 170.0
"""Height of a diagram, pixels."""

APART = 8.0, 10.0
"""Space above a diagram, and above tables that stand below the picture, pixels."""

BELOW = (320.0, 390.0, FULL - 2.0 * GUTTER - 710.0)
"""Widths of the columns of tables below a picture, pixels."""


def linkage_sheet(design: Any, problem: Any, title: str) -> str:
    """The drawing of a linkage design as a complete SVG document."""
    content = content_of(design, problem, DrivenLinkage.of(design))
    unit = problem.length_unit
    tables = [
        content.dimensions or blocks.rows(f"Dimensions ({unit})", _dimensions(design, content)),
        *content.tables,
        checks(design.verification, problem),
        blocks.rows("Metrics", content.metrics),
    ]
    picture = content.picture
    width = FULL if picture.wide else beside()
    parts, bottom = picture.draw(width)
    for diagram in content.diagrams:
        top = bottom + APART[0]
        parts.append(diagram.draw(Box(EDGE, top, EDGE + width, top + diagram.height), content.marks))
        bottom = top + diagram.height
    drawn, y = _below(tables, bottom + APART[1]) if picture.wide else stacked(tables)
    words = f"{content.words}; lengths in {UNITS[unit]}; {verdict(design.verification)}"
    described = f"Drawing of {content.described}. {content.words}. {outcome(design.verification)}"
    return sheet(title or content.name, words, described, [*parts, *drawn], max(bottom, y))


def _below(tables: list[Block], top: float) -> tuple[list[Element], float]:
    """Dimensions, what is demanded and checked, and metrics in three columns."""
    parts, left, bottom = [], EDGE, top
    for width, column in zip(BELOW, (tables[:1], tables[1:-1], tables[-1:]), strict=True):
        drawn, y = stacked(column, left, top, width)
        parts += drawn
        left, bottom = left + width + GUTTER, max(bottom, y)
    return parts, bottom


def _dimensions(design: Any, content: Content) -> list[tuple[str, str]]:
    """Links, what else the kind has of dimensions, and the skeleton."""
    mechanism, size = design.mechanism, content.picture.box.diagonal
    links = mechanism.links if isinstance(mechanism.links, dict) else mechanism.links.model_dump()
    rows = [(name.replace("_", " "), length(value)) for name, value in links.items()]
    rows += content.more_dimensions
    rows += [
        (f"{name} {content.standing}", f"({length(x, size)}, {length(y, size)})")
        for name, (x, y) in mechanism.skeleton.joints.items()
        if name not in content.hidden
    ]
    rows += [(f"gear ratio {' : '.join(reversed(gear.links))}", f"{gear.ratio:g}") for gear in mechanism.skeleton.gears]
    rows += [(f"slide of {slide.joint} on {slide.link}", angle(slide.angle)) for slide in mechanism.skeleton.slides]
    return rows
