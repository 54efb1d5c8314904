"""Tables of a fourbar's sheet: dimensions and targets in blocks of rows."""

from __future__ import annotations

import math

from service.render.linkage.fourbar import FourbarScene, get_fourbar
from service.render.linkage.styles import GROUND_LINE
from service.render.page import blocks
from service.render.page.blocks import Block
from service.render.page.numbers import MISSING_VALUE, format_angle, format_length, format_small
from service.render.page.svg import Element, draw_line, make_element
from service.render.page.symbols import COUPLER, INPUT, OUTPUT
from synthesis.model.linkage.answer import LinkageDesign

GRASHOF_NAMES = {
    "double_crank": "double crank",
    "crank_rocker": "crank-rocker",
    "double_rocker": "double rocker",
    "rocker_crank": "rocker-crank",
    "rocker_rocker": "rocker-rocker",
    "change_point": "change point",
}


LINK_ROWS = {
    "d  ground O2–O4": "ground",
    "a  input O2–A": "input",
    "b  coupler A–B": "coupler",
    "c  output O4–B": "output",
}
"""Rows of dimensions with a sample of the link's line style."""

LETTER_HALF_HEIGHT = 4.0
"""Height of the middle of lower-case letters above the base line, pixels."""

TARGET_COLUMNS = (0.05, 0.26, 0.47, 0.64, 0.84, 1.0)
"""Right ends of the columns of the table of targets, shares of its width."""


def make_dimensions_block(design: LinkageDesign, scene: FourbarScene, unit: str) -> Block:
    """Return the block of links, coupler point, assembly, pivots and reference angle."""
    mechanism = get_fourbar(design)
    links, point, pivots = mechanism.links, mechanism.coupler_point, mechanism.fixed_pivots
    # Coordinates are rounded relative to the linkage's size.
    size = max(links.ground, links.input, links.coupler, links.output)

    def format_pair(x: float, y: float) -> str:
        return f"({format_length(x, size)}, {format_length(y, size)})"

    if scene.limits is None:
        reach = "turns fully"
    else:
        reach = " to ".join(format_angle(math.degrees(limit), 1) for limit in scene.limits)
    rows = [
        *((name, format_length(getattr(links, link))) for name, link in LINK_ROWS.items()),
        ("coupler point A–P", format_length(point.distance, size)),
        ("its angle from A–B", format_angle(point.angle)),
        ("fixed pivot O2", format_pair(*pivots.input)),
        ("fixed pivot O4", format_pair(*pivots.output)),
        ("assembly", mechanism.assembly),
        ("reference input angle", format_angle(mechanism.reference_input_angle)),
        ("input range", reach),
    ]

    return blocks.make_rows(f"Dimensions ({unit})", rows, _draw_sample)


def make_targets_block(design: LinkageDesign, scene: FourbarScene, unit: str) -> Block:
    """Return the block of target positions with the input angle at each, and the residual."""
    met = {target.index: target for target in design.targets}
    assembled = {c.index: c for c in scene.configurations}
    size = float(scene.linkage.ground + scene.linkage.coupler)
    lines = []
    for demand in scene.demands:
        k = demand.index
        place = (format_length(v, size, most=9) for v in (demand.point.real, demand.point.imag))
        cells = [f"{k + 1}", *place, "" if demand.angle is None else format_angle(math.degrees(demand.angle), 2)]
        target = met.get(k)
        if target is None:
            cells += [MISSING_VALUE, MISSING_VALUE]
        else:
            cells += [format_angle(target.position, 2), format_small(target.residual)]
        note = "" if k in assembled else "cannot be assembled here"
        if k in assembled and not assembled[k].own:
            note = "only in the other assembly (dashed)"
        lines.append(blocks.TableRow(cells, note))
    if len(scene.demands) < scene.demanded:
        lines.append(blocks.TableRow([], f"{len(scene.demands)} of {scene.demanded} targets"))
    heads = ["", f"x ({unit})", f"y ({unit})", "angle" if scene.guides_a_body else "", "input", "residual"]
    return blocks.make_table("Targets", heads, lines, TARGET_COLUMNS)


def _draw_sample(name: str, left: float, y: float) -> Element | None:
    """Draw a sample of a link's line style."""
    link = LINK_ROWS.get(name)
    if link is None:
        return None
    y -= LETTER_HALF_HEIGHT
    start, end = complex(left + 2.0, y), complex(left + 26.0, y)
    group = make_element("g", stroke_linecap="round")
    if link == "ground":
        return group.add(draw_line(start, end, **GROUND_LINE))
    if link == "coupler":
        return make_element(
            "rect",
            x=left + 2.0,
            y=y - 4.0,
            width=24.0,
            height=8.0,
            fill=COUPLER,
            fill_opacity=0.22,
            stroke=COUPLER,
            stroke_width=1.8,
        )
    group.add(draw_line(start, end, stroke=INPUT if link == "input" else OUTPUT, stroke_width=5.0))
    return group.add(draw_line(start, end, stroke="#fff", stroke_width=1.9) if link == "output" else None)
