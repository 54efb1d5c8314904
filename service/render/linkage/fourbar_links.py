"""The links of a fourbar on its canvas: ground and pivots, bold at the first target, thin and grey at the others.

The input link is solid, the output link hollow, the coupler a shaded plate, the ground dash-dotted. All parts of the
linkage at a target form one group marked ``data-configuration`` (counted from 1), joints with ``data-joint``.
"""

from __future__ import annotations

import cmath

from service.render.linkage.fourbar import Configuration
from service.render.linkage.fourbar_canvas import Canvas
from service.render.linkage.styles import GHOST, GHOST_WIDTH, GROUND_LINE
from service.render.page.labels import direction_between
from service.render.page.svg import Element, circle, clipped_polygon, element, line, polygon
from service.render.page.symbols import (
    COUPLER,
    DEMAND_RADIUS,
    DIRECTION_LENGTH,
    GREY,
    GROUND,
    INK,
    INPUT,
    OUTPUT,
    bearing,
)

LINK_WIDTH, JOINT_RADIUS, PIVOT_RADIUS = 5.0, 5.0, 6.0
"""Sizes of the bold linkage at full size, pixels."""

SEEN_BEYOND = 40.0
"""Plates are clipped at this distance outside their panel, pixels."""

BAR_HEIGHT = 2.5
"""A coupler triangle lower than this many pixels is drawn as a bar."""

JOINT_NAME, LINK_NAME, GHOST_NAME = 15.0, 13.0, 11.0
"""Font sizes of the names of joints and links, and of joints at the other targets, pixels."""

NAMED_LENGTH = 40.0
"""Links shorter than this on the sheet, pixels, get no letter."""


def ground(canvas: Canvas) -> None:
    """Draw the line between the fixed pivots, and their bearings."""
    o2, o4 = canvas.scene.o2, canvas.scene.o4
    group = element("g", data_link="ground").add(canvas.segment(o2, o4, 2.0, **GROUND_LINE))
    for pivot in (o2, o4):
        # Pivots inside a detail's frame are drawn there only.
        if canvas.readable(pivot):
            symbol, outline = bearing(canvas.at(pivot), max(0.6, canvas.size))
            canvas.labels.avoid(outline, 6.0)
            group.add(symbol)
    canvas.root.add(group)


def linkage(canvas: Canvas, c: Configuration) -> None:
    """Draw the links at the first target."""
    o2, o4, width = canvas.scene.o2, canvas.scene.o4, LINK_WIDTH * canvas.size
    group = element("g", data_links="1", stroke_linecap="round", stroke_linejoin="round")
    group.add(
        *_plate(canvas, c, 3.0, 0.22, width, stroke=COUPLER, stroke_width=max(1.6, 0.55 * width)),
        canvas.segment(o2, c.a, 3.0, stroke=INPUT, stroke_width=width, data_link="input"),
        canvas.segment(o4, c.b, 3.0, stroke=OUTPUT, stroke_width=width, data_link="output"),
        canvas.segment(o4, c.b, 0.0, stroke="#fff", stroke_width=0.38 * width),
    )
    canvas.root.add(group)


def joints(canvas: Canvas, c: Configuration) -> None:
    """Draw the joints at the first target."""
    group = element("g", data_configuration="1", data_own_assembly="true")
    _body_line(canvas, group, c, INK)
    for name, joint in (("O2", canvas.scene.o2), ("O4", canvas.scene.o4)):
        canvas.mark(group, name, joint, PIVOT_RADIUS * canvas.size, fill="#fff", stroke=INK, stroke_width=2.0)
        if canvas.sees(joint):
            group.add(circle(canvas.at(joint), 1.6 * canvas.size, fill=INK))
    for name, joint in (("A", c.a), ("B", c.b)):
        canvas.mark(group, name, joint, JOINT_RADIUS * canvas.size, fill="#fff", stroke=INK, stroke_width=1.8)
    canvas.mark(group, "P", c.p, 3.2, fill=INK, stroke="#fff", stroke_width=0.8)
    canvas.root.add(group)


def ghost(canvas: Canvas, c: Configuration) -> None:
    """Draw the linkage at another target; dashed if it has the other assembly."""
    dashes = None if c.own else "6 4"
    style = GHOST | {"stroke_dasharray": dashes}
    group = element("g", data_configuration=f"{c.index + 1}", data_own_assembly=str(c.own).lower())
    group.attributes |= {"stroke-linecap": "round", "stroke-linejoin": "round"}
    group.add(
        *_plate(canvas, c, 1.0, 0.07, GHOST_WIDTH, **(style | {"stroke_width": 1.4})),
        canvas.segment(canvas.scene.o2, c.a, 1.0, **style),
        canvas.segment(canvas.scene.o4, c.b, 1.0, **style),
    )
    for name, joint, share, fill in (("A", c.a, 3.4, "#fff"), ("B", c.b, 3.4, "#fff"), ("P", c.p, 2.4, GREY)):
        canvas.mark(group, name, joint, share * canvas.size, fill=fill, stroke=GREY, stroke_width=1.2)
    _body_line(canvas, group, c, GREY)
    canvas.root.add(group)


def _plate(
    canvas: Canvas, c: Configuration, weight: float, fill: float, bar: float, /, **style: str | float | None
) -> list[Element | None]:
    """Draw the coupler: the triangle A B P, or a bar (of width ``bar``) if the triangle is flat."""
    # A fixed order makes the polygon independent of the assembly.
    corners = sorted((c.a, c.b, c.p), key=lambda z: (z.real, z.imag))
    pairs = [(c.a, c.b), (c.b, c.p), (c.p, c.a)]
    # The height over the longest side decides between plate and bar.
    longest = max(pairs, key=lambda pair: abs(pair[1] - pair[0]))
    base = abs(longest[1] - longest[0])
    height = abs(((c.b - c.a).conjugate() * (c.p - c.a)).imag) / base if base > 0.0 else 0.0
    if height * canvas.viewport.scale < BAR_HEIGHT:
        return [canvas.segment(*longest, weight, data_link="coupler", **(style | {"stroke_width": bar}))]
    # Huge coordinates of zoomed panels are clipped before drawing.
    seen = clipped_polygon([canvas.at(corner) for corner in corners], canvas.viewport.panel.grown(SEEN_BEYOND))
    face = polygon(seen, fill=COUPLER, fill_opacity=fill, data_link="coupler") if seen else None
    return [face, *(canvas.segment(u, v, weight, **style) for u, v in pairs if u != v)]


def _body_line(canvas: Canvas, group: Element, c: Configuration, colour: str) -> None:
    """Draw the body's own line at P as the linkage carries it, inside the required direction if that is met."""
    if canvas.readable(c.p) and canvas.scene.guides_a_body:
        at = canvas.at(c.p)
        tip = at + DIRECTION_LENGTH * cmath.exp(-1j * c.body_angle)
        group.add(line(at, tip, stroke=colour, stroke_width=1.2, data_body_line=f"{c.index + 1}"))


def label_joints(canvas: Canvas, c: Configuration) -> None:
    """Place the names of the joints at the first target, away from the links that meet there."""
    o2, o4, a, b, p = (canvas.at(z) for z in (canvas.scene.o2, canvas.scene.o4, c.a, c.b, c.p))
    pivots = PIVOT_RADIUS * canvas.size + 2.0, JOINT_RADIUS * canvas.size + 3.0
    style = {"fill": INK, "font_weight": "bold"}
    # Rays are the directions of the links at a joint; labels go into the widest gap.
    for joint, point, words, digit, clearance, rays in (
        (canvas.scene.o2, o2, "O", "2", pivots[0], [a - o2, o4 - o2, 1j]),
        (canvas.scene.o4, o4, "O", "4", pivots[0], [b - o4, o2 - o4, 1j]),
        (c.a, a, "A", "", pivots[1], [o2 - a, b - a, p - a]),
        (c.b, b, "B", "", pivots[1], [o4 - b, a - b, p - b]),
        (c.p, p, "P", "", DEMAND_RADIUS + 1.0, [a - p, b - p, cmath.exp(-1j * c.body_angle)]),
    ):
        if canvas.readable(joint):
            away = direction_between(rays)
            canvas.labels.place(point, words, JOINT_NAME, subscript=digit, clearance=clearance, away=away, style=style)


def label_ghost(canvas: Canvas, c: Configuration) -> None:
    """Place the names of A and B at another target, with its number, if there is space."""
    style = {"fill": GREY}
    for words, joint, pivot in (("A", c.a, canvas.scene.o2), ("B", c.b, canvas.scene.o4)):
        if canvas.readable(joint):
            at, digits = canvas.at(joint), f"{c.index + 1}"
            away = at - canvas.at(pivot)
            canvas.labels.place(
                at, words, GHOST_NAME, subscript=digits, clearance=4.0, away=away, optional=True, style=style
            )


def label_links(canvas: Canvas, c: Configuration) -> None:
    """Place the letters of the links at their middles."""
    o2, o4 = canvas.scene.o2, canvas.scene.o4
    links = (("a", INPUT, o2, c.a), ("b", COUPLER, c.a, c.b), ("c", OUTPUT, o4, c.b), ("d", GROUND, o2, o4))
    for letter, colour, *ends in links:
        start, end = (canvas.at(z) for z in ends)
        if abs(end - start) >= NAMED_LENGTH:
            style = {"fill": colour, "font_style": "italic", "font_weight": "bold"}
            across, middle = 1j * (end - start) / abs(end - start), 0.5 * (start + end)
            canvas.labels.place(middle, letter, LINK_NAME, clearance=6.0, away=across, optional=True, style=style)
