"""Tables of a fourbar's sheet: dimensions and targets in blocks of rows."""

from __future__ import annotations

import math

from service.render.linkage.fourbar import Scene, fourbar_of
from service.render.linkage.styles import GROUND_LINE
from service.render.page import blocks
from service.render.page.blocks import Block
from service.render.page.numbers import NONE, angle, length, small
from service.render.page.svg import Element, element, line
from service.render.page.symbols import COUPLER, INPUT, OUTPUT
from synthesis.model.linkage_answer import LinkageDesign

GRASHOF = {
    "double_crank": "double crank",
    "crank_rocker": "crank-rocker",
    "double_rocker": "double rocker",
    "rocker_crank": "rocker-crank",
    "rocker_rocker": "rocker-rocker",
    "change_point": "change point",
}


LINKS = {"d  ground O2–O4": "ground", "a  input O2–A": "input", "b  coupler A–B": "coupler", "c  output O4–B": "output"}
"""Rows of dimensions with a sample of the link's line style."""

MIDDLE = 4.0
"""Height of the middle of lower-case letters above the base line, pixels."""

TARGET_COLUMNS = (0.05, 0.26, 0.47, 0.64, 0.84, 1.0)
"""Right ends of the columns of the table of targets, shares of its width."""


def dimensions(design: LinkageDesign, scene: Scene, unit: str) -> Block:
    """Return the block of links, coupler point, assembly, pivots and reference angle."""
    mechanism = fourbar_of(design)
    links, point, pivots = mechanism.links, mechanism.coupler_point, mechanism.fixed_pivots
    # Coordinates are rounded relative to the linkage's size.
    size = max(links.ground, links.input, links.coupler, links.output)

    def pair(x: float, y: float) -> str:
        return f"({length(x, size)}, {length(y, size)})"

    if scene.limits is None:
        reach = "turns fully"
    else:
        reach = " to ".join(angle(math.degrees(limit), 1) for limit in scene.limits)
    rows = [
        *((name, length(getattr(links, link))) for name, link in LINKS.items()),
        ("coupler point A–P", length(point.distance, size)),
        ("its angle from A–B", angle(point.angle)),
        ("fixed pivot O2", pair(*pivots.input)),
        ("fixed pivot O4", pair(*pivots.output)),
        ("assembly", mechanism.assembly),
        ("reference input angle", angle(mechanism.reference_input_angle)),
        ("input range", reach),
    ]

    return blocks.rows(f"Dimensions ({unit})", rows, _sample)


def targets(design: LinkageDesign, scene: Scene, unit: str) -> Block:
    """Return the block of target positions with the input angle at each, and the residual."""
    met = {target.index: target for target in design.targets}
    assembled = {c.index: c for c in scene.configurations}
    size = float(scene.linkage.ground + scene.linkage.coupler)
    lines = []
    for demand in scene.demands:
        k = demand.index
        place = (length(v, size, most=9) for v in (demand.point.real, demand.point.imag))
        cells = [f"{k + 1}", *place, "" if demand.angle is None else angle(math.degrees(demand.angle), 2)]
        target = met.get(k)
        if target is None:
            cells += [NONE, NONE]
        else:
            cells += [angle(target.at, 2), small(target.residual)]
        note = "" if k in assembled else "cannot be assembled here"
        if k in assembled and not assembled[k].own:
            note = "only in the other assembly (dashed)"
        lines.append(blocks.Line(cells, note))
    if len(scene.demands) < scene.demanded:
        lines.append(blocks.Line([], f"{len(scene.demands)} of {scene.demanded} targets"))
    heads = ["", f"x ({unit})", f"y ({unit})", "angle" if scene.guides_a_body else "", "input", "residual"]
    return blocks.table("Targets", heads, lines, TARGET_COLUMNS)


def _sample(name: str, left: float, y: float) -> Element | None:
    """Draw a sample of a link's line style."""
    link = LINKS.get(name)
    if link is None:
        return None
    y -= MIDDLE
    start, end = complex(left + 2.0, y), complex(left + 26.0, y)
    group = element("g", stroke_linecap="round")
    if link == "ground":
        return group.add(line(start, end, **GROUND_LINE))
    if link == "coupler":
        return element(
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
    group.add(line(start, end, stroke=INPUT if link == "input" else OUTPUT, stroke_width=5.0))
    return group.add(line(start, end, stroke="#fff", stroke_width=1.9) if link == "output" else None)
