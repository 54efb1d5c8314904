"""The written part of a fourbar's sheet: dimensions and targets in blocks of rows."""

from __future__ import annotations

import math

from service.render.linkage.fourbar import Scene, fourbar_of
from service.render.page.blocks import (
    GAP,
    ROW,
    SIZE,
    SMALL,
    Block,
    block_start,
    value_at,
)
from service.render.page.numbers import (
    NONE,
    angle,
    length,
    small,
)
from service.render.page.svg import (
    Element,
    element,
    line,
    text,
    text_width,
)
from service.render.page.symbols import (
    COUPLER,
    GREY,
    GROUND,
    INK,
    INPUT,
    OUTPUT,
)
from synthesis.model.linkage_answer import LinkageDesign

GRASHOF = {
    "double_crank": "double crank",
    "crank_rocker": "crank-rocker",
    "double_rocker": "double rocker",
    "rocker_crank": "rocker-crank",
    "rocker_rocker": "rocker-rocker",
    "change_point": "change point",
}


def dimensions(design: LinkageDesign, scene: Scene, unit: str) -> Block:
    """Links, coupler point, assembly, pivots and reference angle."""
    mechanism = fourbar_of(design)
    links, point, pivots = mechanism.links, mechanism.coupler_point, mechanism.fixed_pivots
    size = max(links.ground, links.input, links.coupler, links.output)

    def pair(x: float, y: float) -> str:
        return f"({length(x, size)}, {length(y, size)})"

    if scene.limits is None:
        reach = "turns fully"
    else:
        reach = " to ".join(angle(math.degrees(limit), 1) for limit in scene.limits)
    rows: list[tuple[str, str, str]] = [
        ("ground", "d  ground O2–O4", length(links.ground)),
        ("input", "a  input O2–A", length(links.input)),
        ("coupler", "b  coupler A–B", length(links.coupler)),
        ("output", "c  output O4–B", length(links.output)),
        ("", "coupler point A–P", length(point.distance, size)),
        ("", "its angle from A–B", angle(point.angle)),
        ("", "fixed pivot O2", pair(*pivots.input)),
        ("", "fixed pivot O4", pair(*pivots.output)),
        ("", "assembly", mechanism.assembly),
        ("", "reference input angle", angle(mechanism.reference_input_angle)),
        ("", "input range", reach),
    ]

    def draw(left: float, top: float, width: float) -> tuple[Element, float]:
        block, y = block_start(f"Dimensions ({unit})", left, top, width)
        for link, name, value in rows:
            y += ROW
            block.add(_swatch(link, left, y - 4.0) if link else None, text(left + 34.0, y, name, SIZE, fill=INK))
            block.add(value_at(left + width, y, value, left + 34.0 + text_width(name, SIZE)))
        return block, y + GAP

    return draw


def targets(design: LinkageDesign, scene: Scene, unit: str) -> Block:
    """Demanded positions with the input angle that meets each, and how exactly."""
    shares = (0.05, 0.26, 0.47, 0.64, 0.84, 1.0)
    met = {target.index: target for target in design.targets}
    assembled = {c.index: c for c in scene.configurations}
    size = float(scene.linkage.ground + scene.linkage.coupler)
    rows = []
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
        rows.append((cells, note))

    def draw(left: float, top: float, width: float) -> tuple[Element, float]:
        block, y = block_start("Targets", left, top, width)

        def write(cells: list[str], colour: str) -> None:
            for cell, share, before in zip(cells, shares, (0.0, *shares), strict=False):
                room = (share - before) * width - 5.0
                size = SMALL * min(1.0, room / max(text_width(cell, SMALL), 1.0))
                block.add(text(left + share * width, y, cell, size, text_anchor="end", fill=colour))

        y += ROW
        write(["", f"x ({unit})", f"y ({unit})", "angle" if scene.guides_a_body else "", "input", "residual"], GREY)
        for cells, note in rows:
            y += ROW
            write(cells, INK)
            if note:
                y += ROW - 3.0
                block.add(text(left + width, y, note, SMALL, text_anchor="end", fill=INK, font_style="italic"))
        if len(scene.demands) < scene.demanded:
            y += ROW
            note = f"{len(scene.demands)} of {scene.demanded} targets"
            block.add(text(left + width, y, note, SMALL, text_anchor="end", fill=INK, font_style="italic"))
        return block, y + GAP

    return draw


def _swatch(link: str, left: float, y: float) -> Element:
    """Sample of a link's line style."""
    start, end = complex(left + 2.0, y), complex(left + 26.0, y)
    group = element("g", stroke_linecap="round")
    if link == "ground":
        return group.add(line(start, end, stroke=GROUND, stroke_width=1.3, stroke_dasharray="12 4 2 4"))
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
