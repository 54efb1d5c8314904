"""Marks around a fourbar's links: paths of A and P, the input's limits and rotation, targets and misses."""

from __future__ import annotations

import cmath
import math

import numpy as np

from service.render.linkage.fourbar_canvas import Canvas
from service.render.linkage.motion import Demand
from service.render.linkage.styles import LIMIT_TICK, MISS_LINE, STANCE_LINE, TARGET_CURVE, USED_PATH, WHOLE_PATH
from service.render.page import symbols
from service.render.page.labels import Label
from service.render.page.numbers import format_angle
from service.render.page.svg import CLIP_MARGIN, clip_polyline, draw_circle, draw_line, draw_path
from service.render.page.symbols import (
    INK,
    INPUT,
    TARGET_COLOUR,
    TARGET_RADIUS,
    draw_arrow,
)

ARC_RADII = 26.0, 74.0
"""Minimum and maximum radius of the arc that shows the input's rotation, pixels."""

ARC_SHARE, MAX_ARC_SHARE, ARROW_LENGTH = 0.42, 0.8, 9.0
"""Preferred and maximum radius of that arc as shares of the input link, and the length of its arrow in pixels."""

MIN_ARC_LENGTH = 26.0
"""Minimum length of that arc, pixels; shorter arcs get a larger radius."""

MIN_ROTATION = 1e-9
"""Rotations smaller than this, radians, are not drawn."""

TICK_LENGTH = 9.0
"""Length of the tick at an input limit, pixels."""

MIN_MISS_LENGTH = 1.0
"""Misses shorter than this on the sheet, pixels, are not drawn."""

MAX_ARC_RADIUS = 4.0
"""Maximum radius of an arc in panel diagonals; in a detail larger arcs would look like unrelated straight lines."""


def draw_input_circle(canvas: Canvas) -> None:
    """Draw the path of A over the input's range, and ticks at its limits."""
    scene, view = canvas.scene, canvas.viewport
    radius = view.scale * float(scene.linkage.input)
    if radius > MAX_ARC_RADIUS * view.panel.diagonal:
        return
    swept = clip_polyline(canvas.make_arc(radius, *(scene.limits or (0.0, math.tau))), view.panel.grow(CLIP_MARGIN))
    style = {"stroke_dasharray": "1 4", "stroke_linecap": "round"}
    canvas.root.add(draw_path(swept, stroke=INPUT, stroke_width=0.9, **style))
    canvas.labels.add_obstacles(swept, 0.6)
    for limit in scene.limits or ():
        outward = cmath.exp(-1j * limit)
        tip = canvas.to_sheet(scene.o2) + radius * outward
        if view.panel.holds(tip):
            low, high = tip - TICK_LENGTH * outward, tip + TICK_LENGTH * outward
            canvas.root.add(draw_line(low, high, **LIMIT_TICK, data_limit=repr(math.degrees(limit))))
            canvas.labels.add_obstacles([np.array([low, high])], 6.0)


def draw_curves(canvas: Canvas) -> None:
    """Draw the target curve, the path of P over the whole branch, and its used part."""
    scene, shown = canvas.scene, canvas.viewport.clip_to_panel
    pieces, used = [piece for curve in scene.rest for piece in shown(curve)], shown(scene.used)
    if scene.target is not None:
        canvas.root.add(draw_path(shown(scene.target), data_curve="target", **TARGET_CURVE))
    if scene.stance is not None:
        canvas.root.add(draw_path(shown(scene.stance), data_curve="stance", **STANCE_LINE))
    canvas.root.add(
        draw_path(pieces, **WHOLE_PATH, data_curve="branch"),
        draw_path(used, **USED_PATH, stroke_linecap="round", data_curve="used"),
    )
    canvas.labels.add_obstacles(pieces, 0.6)
    canvas.labels.add_obstacles(used, 2.0)


def draw_rotation_arc(canvas: Canvas) -> complex | None:
    """Draw an arc with an arrow from the input's first to its last angle; return its middle, or None without an arc."""
    scene = canvas.scene
    turned = scene.end - scene.start
    if abs(turned) < MIN_ROTATION or not canvas.is_readable(scene.o2):
        return None
    link = canvas.viewport.scale * float(scene.linkage.input)
    least, most = ARC_RADII
    # Small rotations get a larger radius, so that the arc remains visible.
    radius = max(min(max(ARC_SHARE * link, least), most), min(MIN_ARC_LENGTH / abs(turned), MAX_ARC_SHARE * link))
    # The arrow head must not be longer than the arc.
    head = math.copysign(min(abs(turned), ARROW_LENGTH / radius), turned)
    arc = canvas.make_arc(radius, scene.start, scene.end - 0.8 * head)
    back, tip = (complex(z) for z in canvas.make_arc(radius, scene.end - head, scene.end)[[0, -1]])
    mark = draw_arrow(back, tip, 4.0, INK)
    mark.attributes["data-rotation"] = repr(math.degrees(turned))
    canvas.root.add(draw_path([arc], stroke=INK, stroke_width=1.4), mark)
    canvas.labels.add_obstacles([arc], 2.0)
    return complex(canvas.make_arc(radius, scene.start, scene.start + 0.5 * turned)[-1])


def draw_demand(canvas: Canvas, demanded: Demand) -> None:
    """Draw a target point or position."""
    if canvas.is_readable(demanded.point):
        symbol, lines = symbols.draw_target(canvas.to_sheet(demanded.point), demanded.angle, demanded.index + 1)
        canvas.labels.add_obstacles(lines, 3.0)
        canvas.root.add(symbol)


def draw_misses(canvas: Canvas) -> None:
    """Draw the deviation of P from the fitted points: a line from each point to the position of P there."""
    places = {demand.index: demand.point for demand in canvas.scene.demands if demand.angle is None}
    for c in canvas.scene.configurations:
        point = places.get(c.index)
        # Positions show their error by the body line instead.
        if point is None or not canvas.is_readable(point):
            continue
        wanted, met = canvas.to_sheet(point), canvas.to_sheet(c.p)
        if abs(met - wanted) >= MIN_MISS_LENGTH and canvas.viewport.panel.holds(met):
            mark = draw_line(wanted, met, **MISS_LINE, data_miss=f"{c.index + 1}")
            canvas.root.add(mark, draw_circle(met, 1.8, fill=TARGET_COLOUR))


def label_demand(canvas: Canvas, demanded: Demand) -> None:
    """Place the number of a target."""
    if canvas.is_readable(demanded.point):
        at, words = canvas.to_sheet(demanded.point), f"{demanded.index + 1}"
        # Put the number opposite to the direction arrow.
        away = -1j if demanded.angle is None else -cmath.exp(-1j * demanded.angle)
        style = {"fill": TARGET_COLOUR, "font_weight": "bold"}
        label = Label(words, 11.0, style, ring=TARGET_COLOUR)
        canvas.labels.place(at, label, clearance=TARGET_RADIUS + 2.0, away=away)


def label_input(canvas: Canvas, arc: complex | None) -> None:
    """Place the rotation of the input at the middle of its arc, and "limit" at its limits, if there is space."""
    scene, o2 = canvas.scene, canvas.to_sheet(canvas.scene.o2)
    if arc is not None:
        turned = format_angle(math.degrees(scene.end - scene.start), 1)
        canvas.labels.place(arc, Label(turned, 11.0, {"fill": INK}), clearance=3.0, away=arc - o2, optional=True)
    crank = float(scene.linkage.input)
    for limit in scene.limits or ():
        if canvas.is_readable(scene.o2 + cmath.rect(crank, limit)):
            away = cmath.exp(-1j * limit)
            tip = o2 + (canvas.viewport.scale * crank + TICK_LENGTH) * away
            canvas.labels.place(tip, Label("limit", 10.0, {"fill": INPUT}), clearance=2.0, away=away, optional=True)
