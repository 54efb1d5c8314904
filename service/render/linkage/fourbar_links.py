"""The links of a fourbar on its canvas: ground and pivots, bold at the first target, thin and grey at the others.

The input link is solid, the output link hollow, the coupler a shaded plate, the ground dash-dotted. All parts of the
linkage at a target form one group marked ``data-configuration`` (counted from 1), joints with ``data-joint``.
"""

from __future__ import annotations

import cmath

from service.render.linkage.fourbar import Configuration
from service.render.linkage.fourbar_canvas import Canvas
from service.render.linkage.styles import GHOST_LINE, GHOST_WIDTH, GROUND_LINE
from service.render.page.labels import Label, find_free_direction
from service.render.page.svg import Element, clip_polygon, draw_circle, draw_line, draw_polygon, make_element
from service.render.page.symbols import (
    COUPLER,
    DIRECTION_LENGTH,
    GREY,
    GROUND,
    INK,
    INPUT,
    OUTPUT,
    TARGET_RADIUS,
    draw_bearing,
)

LINK_WIDTH, JOINT_RADIUS, PIVOT_RADIUS = 5.0, 5.0, 6.0
"""Sizes of the bold linkage at full size, pixels."""

CLIP_DISTANCE = 40.0
"""Plates are clipped at this distance outside their panel, pixels."""

MIN_PLATE_HEIGHT = 2.5
"""A coupler triangle lower than this many pixels is drawn as a bar."""

JOINT_FONT_SIZE, LINK_FONT_SIZE, GHOST_FONT_SIZE = 15.0, 13.0, 11.0
"""Font sizes of the names of joints and links, and of joints at the other targets, pixels."""

MIN_LABELLED_LENGTH = 40.0
"""Links shorter than this on the sheet, pixels, get no letter."""


def draw_ground(canvas: Canvas) -> None:
    """Draw the line between the fixed pivots, and their bearings."""
    o2, o4 = canvas.scene.o2, canvas.scene.o4
    group = make_element("g", data_link="ground").add(canvas.draw_segment(o2, o4, 2.0, **GROUND_LINE))
    for pivot in (o2, o4):
        # Pivots inside a detail's frame are drawn there only.
        if canvas.is_readable(pivot):
            symbol, outline = draw_bearing(canvas.to_sheet(pivot), max(0.6, canvas.size))
            canvas.labels.add_obstacles(outline, 6.0)
            group.add(symbol)
    canvas.root.add(group)


def draw_linkage(canvas: Canvas, c: Configuration) -> None:
    """Draw the links at the first target."""
    o2, o4, width = canvas.scene.o2, canvas.scene.o4, LINK_WIDTH * canvas.size
    group = make_element("g", data_links="1", stroke_linecap="round", stroke_linejoin="round")
    group.add(
        *_draw_plate(canvas, c, 3.0, 0.22, width, stroke=COUPLER, stroke_width=max(1.6, 0.55 * width)),
        canvas.draw_segment(o2, c.a, 3.0, stroke=INPUT, stroke_width=width, data_link="input"),
        canvas.draw_segment(o4, c.b, 3.0, stroke=OUTPUT, stroke_width=width, data_link="output"),
        canvas.draw_segment(o4, c.b, 0.0, stroke="#fff", stroke_width=0.38 * width),
    )
    canvas.root.add(group)


def draw_joints(canvas: Canvas, c: Configuration) -> None:
    """Draw the joints at the first target."""
    group = make_element("g", data_configuration="1", data_own_assembly="true")
    _draw_body_line(canvas, group, c, INK)
    for name, joint in (("O2", canvas.scene.o2), ("O4", canvas.scene.o4)):
        canvas.draw_joint(group, name, joint, PIVOT_RADIUS * canvas.size, fill="#fff", stroke=INK, stroke_width=2.0)
        if canvas.is_visible(joint):
            group.add(draw_circle(canvas.to_sheet(joint), 1.6 * canvas.size, fill=INK))
    for name, joint in (("A", c.a), ("B", c.b)):
        canvas.draw_joint(group, name, joint, JOINT_RADIUS * canvas.size, fill="#fff", stroke=INK, stroke_width=1.8)
    canvas.draw_joint(group, "P", c.p, 3.2, fill=INK, stroke="#fff", stroke_width=0.8)
    canvas.root.add(group)


def draw_ghost(canvas: Canvas, c: Configuration) -> None:
    """Draw the linkage at another target; dashed if it has the other assembly."""
    dashes = None if c.own else "6 4"
    style = GHOST_LINE | {"stroke_dasharray": dashes}
    group = make_element("g", data_configuration=f"{c.index + 1}", data_own_assembly=str(c.own).lower())
    group.attributes |= {"stroke-linecap": "round", "stroke-linejoin": "round"}
    group.add(
        *_draw_plate(canvas, c, 1.0, 0.07, GHOST_WIDTH, **(style | {"stroke_width": 1.4})),
        canvas.draw_segment(canvas.scene.o2, c.a, 1.0, **style),
        canvas.draw_segment(canvas.scene.o4, c.b, 1.0, **style),
    )
    for name, joint, share, fill in (("A", c.a, 3.4, "#fff"), ("B", c.b, 3.4, "#fff"), ("P", c.p, 2.4, GREY)):
        canvas.draw_joint(group, name, joint, share * canvas.size, fill=fill, stroke=GREY, stroke_width=1.2)
    _draw_body_line(canvas, group, c, GREY)
    canvas.root.add(group)


def _draw_plate(
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
    if height * canvas.viewport.scale < MIN_PLATE_HEIGHT:
        return [canvas.draw_segment(*longest, weight, data_link="coupler", **(style | {"stroke_width": bar}))]
    # Huge coordinates of zoomed panels are clipped before drawing.
    seen = clip_polygon([canvas.to_sheet(corner) for corner in corners], canvas.viewport.panel.grow(CLIP_DISTANCE))
    face = draw_polygon(seen, fill=COUPLER, fill_opacity=fill, data_link="coupler") if seen else None
    return [face, *(canvas.draw_segment(u, v, weight, **style) for u, v in pairs if u != v)]


def _draw_body_line(canvas: Canvas, group: Element, c: Configuration, colour: str) -> None:
    """Draw the body's own line at P as the linkage carries it, inside the required direction if that is met."""
    if canvas.is_readable(c.p) and canvas.scene.guides_a_body:
        at = canvas.to_sheet(c.p)
        tip = at + DIRECTION_LENGTH * cmath.exp(-1j * c.body_angle)
        group.add(draw_line(at, tip, stroke=colour, stroke_width=1.2, data_body_line=f"{c.index + 1}"))


def label_joints(canvas: Canvas, c: Configuration) -> None:
    """Place the names of the joints at the first target, away from the links that meet there."""
    o2, o4, a, b, p = (canvas.to_sheet(z) for z in (canvas.scene.o2, canvas.scene.o4, c.a, c.b, c.p))
    pivots = PIVOT_RADIUS * canvas.size + 2.0, JOINT_RADIUS * canvas.size + 3.0
    style = {"fill": INK, "font_weight": "bold"}
    # Rays are the directions of the links at a joint; labels go into the widest gap.
    for joint, point, words, digit, clearance, rays in (
        (canvas.scene.o2, o2, "O", "2", pivots[0], [a - o2, o4 - o2, 1j]),
        (canvas.scene.o4, o4, "O", "4", pivots[0], [b - o4, o2 - o4, 1j]),
        (c.a, a, "A", "", pivots[1], [o2 - a, b - a, p - a]),
        (c.b, b, "B", "", pivots[1], [o4 - b, a - b, p - b]),
        (c.p, p, "P", "", TARGET_RADIUS + 1.0, [a - p, b - p, cmath.exp(-1j * c.body_angle)]),
    ):
        if canvas.is_readable(joint):
            away = find_free_direction(rays)
            canvas.labels.place(point, Label(words, JOINT_FONT_SIZE, style, digit), clearance=clearance, away=away)


def label_ghost(canvas: Canvas, c: Configuration) -> None:
    """Place the names of A and B at another target, with its number, if there is space."""
    style = {"fill": GREY}
    for words, joint, pivot in (("A", c.a, canvas.scene.o2), ("B", c.b, canvas.scene.o4)):
        if canvas.is_readable(joint):
            at, digits = canvas.to_sheet(joint), f"{c.index + 1}"
            away = at - canvas.to_sheet(pivot)
            canvas.labels.place(
                at, Label(words, GHOST_FONT_SIZE, style, digits), clearance=4.0, away=away, optional=True
            )


def label_links(canvas: Canvas, c: Configuration) -> None:
    """Place the letters of the links at their middles."""
    o2, o4 = canvas.scene.o2, canvas.scene.o4
    links = (("a", INPUT, o2, c.a), ("b", COUPLER, c.a, c.b), ("c", OUTPUT, o4, c.b), ("d", GROUND, o2, o4))
    for letter, colour, *ends in links:
        start, end = (canvas.to_sheet(z) for z in ends)
        if abs(end - start) >= MIN_LABELLED_LENGTH:
            style = {"fill": colour, "font_style": "italic", "font_weight": "bold"}
            across, middle = 1j * (end - start) / abs(end - start), 0.5 * (start + end)
            label = Label(letter, LINK_FONT_SIZE, style)
            canvas.labels.place(middle, label, clearance=6.0, away=across, optional=True)
