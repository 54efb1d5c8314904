"""The sheet of a linkage for every kind of problem: title, picture, dimensions, tables, checks and diagrams.

The parts that depend on the kind (the picture, its own tables, diagrams) are in
:mod:`service.render.linkage.kind_tables`.
"""

from __future__ import annotations

from typing import Any

from service.render.checks import checks, outcome, verdict
from service.render.linkage.content import Content
from service.render.linkage.kind_tables import content_of
from service.render.linkage.motion import DrivenLinkage
from service.render.outline import entries
from service.render.page import blocks
from service.render.page.numbers import angle, length
from service.render.page.sheet import EDGE, FULL, GUTTER, UNITS, beside, in_columns, sheet, stacked
from service.render.page.svg import Box

APART = 8.0, 10.0
"""Space above a diagram, and above tables below the picture, pixels."""

BELOW = (320.0, 390.0, FULL - 2.0 * GUTTER - 710.0)
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


def linkage_sheet(design: Any, problem: Any, title: str) -> str:
    """Draw a linkage design as a complete SVG document."""
    content = content_of(design, problem, DrivenLinkage.of(design))
    unit = problem.length_unit
    tables = [
        content.dimensions or blocks.rows(f"Dimensions ({unit})", _dimensions(design, content)),
        *content.tables,
        checks(design.verification, problem),
        blocks.rows("Metrics", _metrics(design, problem, content)),
    ]
    picture = content.picture
    width = FULL if picture.wide else beside()
    parts, bottom = picture.draw(width)
    for diagram in content.diagrams:
        top = bottom + APART[0]
        parts.append(diagram.draw(Box(EDGE, top, EDGE + width, top + diagram.height), content.marks))
        bottom = top + diagram.height
    if picture.wide:
        # The columns are: dimensions; targets and checks; metrics.
        drawn, y = in_columns((tables[:1], tables[1:-1], tables[-1:]), BELOW, bottom + APART[1])
    else:
        drawn, y = stacked(tables)
    words = f"{content.words}; lengths in {UNITS[unit]}; {verdict(design.verification)}"
    described = f"Drawing of {content.described}. {content.words}. {outcome(design.verification)}"
    return sheet(title or content.name, words, described, [*parts, *drawn], max(bottom, y))


def _metrics(design: Any, problem: Any, content: Content) -> list[tuple[str, str]]:
    """Return the metrics; individual transmission angles only if there are several, because their minimum is listed
    anyway.
    """
    metrics, left_out = design.metrics, set(content.left_out)
    # A single transmission angle is already listed as the minimum.
    if len(getattr(metrics, "transmission_angles", ())) < 2:
        left_out.add("transmission_angles")
    return entries(metrics, problem, left_out, {**TITLES, **content.titles})


def _dimensions(design: Any, content: Content) -> list[tuple[str, str]]:
    """Return links, further dimensions of the kind, and the skeleton."""
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
