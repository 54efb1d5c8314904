"""The sheet of a fourbar design: title, drawing, details, key and tables, side by side or one below the other."""

from __future__ import annotations

import math

from service.render.checks import checks
from service.render.linkage import fourbar_tables as tables
from service.render.linkage.fourbar import (
    Scene,
    details,
    fourbar_of,
    scene,
)
from service.render.linkage.fourbar_panel import (
    FOOT,
    MARGIN,
    Detail,
    panel,
)
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    clean,
    document,
    element,
    line,
    shortened,
    text,
    text_width,
)
from service.render.page.symbols import (
    CURVE,
    DEMANDED,
    GREY,
    INK,
    INPUT,
    PALE,
)
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.linkage_answer import LinkageDesign

WIDTH, EDGE, TOP = 1100.0, 22.0, 74.0
"""Width of the sheet, its border, and the height of the title, pixels."""

COLUMN, GUTTER = 370.0, 26.0
"""Width of the tables' column beside the drawing, and the space between columns, pixels."""

WIDE = 1.7
"""Drawings wider than this in proportion to their height have their tables below instead of beside them."""

BESIDE_HEIGHT, BELOW_HEIGHT = (560.0, 860.0), (330.0, 620.0)
"""Least and greatest height of the drawing, pixels."""

UNITS = {"mm": "millimetres", "cm": "centimetres", "m": "metres", "in": "inches"}

DETAIL_HEIGHT, KEY_HEIGHT = 300.0, 30.0


def fourbar_sheet(design: LinkageDesign, problem: MotionProblem | PathProblem, title: str) -> str:
    """The drawing of a fourbar design as a complete SVG document."""
    shown = scene(design, problem)
    unit = problem.length_unit
    heading = title or "Fourbar linkage"
    blocks = [
        tables.dimensions(design, shown, unit),
        tables.targets(design, shown, unit),
        checks(design.verification, tables.written_check),
        tables.metrics(design, unit),
    ]
    box = shown.box()
    wide = box.width > WIDE * box.height
    parts: list[Element] = []
    if wide:
        bottom = _drawing(parts, shown, unit, WIDTH - 2.0 * EDGE, BELOW_HEIGHT, box)
        widths = (320.0, 390.0, WIDTH - 2.0 * EDGE - 2.0 * GUTTER - 710.0)
        left, ends = EDGE, []
        for width, column in zip(widths, ([blocks[0]], blocks[1:3], [blocks[3]]), strict=True):
            y = bottom + 10.0
            for block in column:
                drawn, y = block(left, y, width)
                parts.append(drawn)
            ends.append(y)
            left += width + GUTTER
        bottom = max(ends)
    else:
        bottom = _drawing(parts, shown, unit, WIDTH - 2.0 * EDGE - COLUMN - GUTTER, BESIDE_HEIGHT, box)
        y = TOP - 6.0
        for block in blocks:
            drawn, y = block(WIDTH - EDGE - COLUMN, y, COLUMN)
            parts.append(drawn)
        bottom = max(bottom, y)
    height = math.ceil(bottom + EDGE - 8.0)
    return document(
        heading, _description(design, problem, shown), (WIDTH, float(height)), *_title(design, heading, unit), *parts
    )


def _title(design: LinkageDesign, heading: str, unit: str) -> list[Element]:
    room = WIDTH - 2.0 * EDGE
    mechanism, failed = fourbar_of(design), [c for c in design.verification.checks if not c.passed]
    grashof = design.metrics.grashof
    kind = "" if grashof is None else f", {tables.GRASHOF[grashof]}"
    words = f"Fourbar linkage, {mechanism.assembly} assembly{kind}; lengths in {UNITS[unit]}"
    verdict = f"fails {len(failed)} of {len(design.verification.checks)} checks" if failed else "passes all checks"
    return [
        text(EDGE, 34.0, shortened(heading, 20.0, room), 20.0, font_weight="bold", fill=INK),
        text(EDGE, 55.0, f"{words}; {verdict}", 12.5, fill=GREY),
    ]


def _description(design: LinkageDesign, problem: MotionProblem | PathProblem, shown: Scene) -> str:
    mechanism = fourbar_of(design)
    links = mechanism.links
    unit = problem.length_unit
    sizes = ", ".join(
        f"{name} {value:.6g} {unit}"
        for name, value in (
            ("ground", links.ground),
            ("input", links.input),
            ("coupler", links.coupler),
            ("output", links.output),
        )
    )
    met = f"shown at {shown.met} of {shown.demanded} demanded positions"
    if len(shown.demands) < shown.demanded:
        met = f"{met}, of which {len(shown.demands)} are drawn"
    if shown.target is not None:
        met = f"shown at the first of {len(design.targets)} points of the demanded curve"
    failed = [clean(c.name.replace("_", " ")) for c in design.verification.checks if not c.passed]
    verdict = f"Failed checks: {', '.join(failed)}." if failed else "All checks passed."
    return f"Drawing of a fourbar linkage, {mechanism.assembly} assembly: {sizes}; {met}. {verdict}"


def _drawing(
    parts: list[Element], shown: Scene, unit: str, width: float, heights: tuple[float, float], box: Box
) -> float:
    """Add main panel, key and details at the left border; returns the y below them."""
    scale = (width - 2.0 * MARGIN) / box.width if box.width > 0.0 else math.inf
    height = min(max(scale * box.height + 2.0 * MARGIN + FOOT, heights[0]), heights[1])
    height = math.floor(height)
    main = Viewport.fit(box, Box(EDGE, TOP, EDGE + width, TOP + height), MARGIN, FOOT)
    y = main.panel.high
    small = []
    for k, part in enumerate(boxes := details(shown, box)):
        share = (width - 10.0 * (len(boxes) - 1)) / len(boxes)
        left, top = EDGE + k * (share + 10.0), y + 10.0
        viewport = Viewport.fit(part, Box(left, top, left + share, top + DETAIL_HEIGHT), MARGIN, FOOT)
        small.append(Detail(part, f"detail {k + 1}", viewport))
    parts.append(panel(shown, main, "main", unit, small))
    parts.extend(panel(shown, detail.viewport, detail.name, unit, []) for detail in small)
    if small:
        y += 10.0 + DETAIL_HEIGHT
    parts.append(_key(shown, y + 18.0, width))
    return y + KEY_HEIGHT


def _key(shown: Scene, y: float, width: float) -> Element:
    """What the line styles mean."""
    entries = [
        ("target", "demanded position" if shown.guides_a_body else "demanded point"),
        ("used", "path of P, used"),
        ("rest", "rest of branch"),
        *([("ghost", "other targets")] if shown.others else []),
        *([("curve", "demanded curve")] if shown.target is not None else []),
        *([("miss", "missed by")] if shown.misses else []),
    ]
    if shown.limits is not None:
        entries.append(("limit", "input limit"))
    group = element("g", data_key="true")
    sample, size = 22.0, 10.5
    spare = width - sum(sample + 6.0 + text_width(words, size) for _, words in entries)
    x = EDGE
    for kind, words in entries:
        group.add(*_sample(kind, complex(x, y - 4.0), sample))
        group.add(text(x + sample + 6.0, y, words, size, fill=GREY))
        x += sample + 6.0 + text_width(words, size) + min(26.0, spare / max(1, len(entries) - 1))
    return group


def _sample(kind: str, at: complex, width: float) -> list[Element]:
    end, middle = at + width, at + 0.5 * width
    if kind == "target":
        ring = element("circle", cx=at.real + 5.0, cy=at.imag, r=4.5, fill="none", stroke=DEMANDED, stroke_width=1.5)
        return [line(at + 5.0, end, stroke=DEMANDED, stroke_width=3.5, stroke_opacity=0.35), ring]
    if kind == "curve":
        return [line(at, end, stroke=DEMANDED, stroke_width=6.0, stroke_opacity=0.3)]
    if kind == "miss":
        return [line(at, end, stroke=DEMANDED, stroke_width=1.6)]
    if kind == "limit":
        return [line(middle - 7j, middle + 7j, stroke=INPUT, stroke_width=2.0)]
    stroke, weight = {"used": (CURVE, 2.2), "rest": (CURVE, 0.9), "ghost": (PALE, 2.4)}[kind]
    return [line(at, end, stroke=stroke, stroke_width=weight)]
