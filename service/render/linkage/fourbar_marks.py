"""Marks around a fourbar's links: paths of A and P, the input's limits and rotation, targets and misses."""

from __future__ import annotations

import cmath
import math

import numpy as np

from service.render.linkage.fourbar_canvas import Canvas
from service.render.linkage.motion import Demand
from service.render.linkage.styles import LIMIT, MISS, STANCE, TARGET_CURVE, USED_PATH, WHOLE_PATH
from service.render.page import symbols
from service.render.page.numbers import angle
from service.render.page.svg import CLIP_MARGIN, circle, clipped, line, path
from service.render.page.symbols import (
    DEMAND_RADIUS,
    DEMANDED,
    INK,
    INPUT,
    arrow,
)

ROTATION_ARC = 26.0, 74.0
"""Minimum and maximum radius of the arc that shows the input's rotation, pixels."""

ARC_SHARE, MAX_ARC_SHARE, ARROW_LENGTH = 0.42, 0.8, 9.0
"""Preferred and maximum radius of that arc as shares of the input link, and the length of its arrow in pixels."""

ARC_LENGTH = 26.0
"""Minimum length of that arc, pixels; shorter arcs get a larger radius."""

LEAST_ROTATION = 1e-9
"""Rotations smaller than this, radians, are not drawn."""

TICK = 9.0
"""Length of the tick at an input limit, pixels."""

SEEN_MISS = 1.0
"""Misses shorter than this on the sheet, pixels, are not drawn."""

LARGEST_ARC = 4.0
"""Maximum radius of an arc in panel diagonals; in a detail larger arcs would look like unrelated straight lines."""


def input_circle(canvas: Canvas) -> None:
    """Draw the path of A over the input's range, and ticks at its limits."""
    scene, view = canvas.scene, canvas.viewport
    radius = view.scale * float(scene.linkage.input)
    if radius > LARGEST_ARC * view.panel.diagonal:
        return
    swept = clipped(canvas.arc(radius, *(scene.limits or (0.0, math.tau))), view.panel.grown(CLIP_MARGIN))
    style = {"stroke_dasharray": "1 4", "stroke_linecap": "round"}
    canvas.root.add(path(swept, stroke=INPUT, stroke_width=0.9, **style))
    canvas.labels.avoid(swept, 0.6)
    for limit in scene.limits or ():
        outward = cmath.exp(-1j * limit)
        tip = canvas.at(scene.o2) + radius * outward
        if view.panel.holds(tip):
            low, high = tip - TICK * outward, tip + TICK * outward
            canvas.root.add(line(low, high, **LIMIT, data_limit=repr(math.degrees(limit))))
            canvas.labels.avoid([np.array([low, high])], 6.0)


def curves(canvas: Canvas) -> None:
    """Draw the target curve, the path of P over the whole branch, and its used part."""
    scene, shown = canvas.scene, canvas.viewport.shown
    pieces, used = [piece for curve in scene.rest for piece in shown(curve)], shown(scene.used)
    if scene.target is not None:
        canvas.root.add(path(shown(scene.target), data_curve="target", **TARGET_CURVE))
    if scene.stance is not None:
        canvas.root.add(path(shown(scene.stance), data_curve="stance", **STANCE))
    canvas.root.add(
        path(pieces, **WHOLE_PATH, data_curve="branch"),
        path(used, **USED_PATH, stroke_linecap="round", data_curve="used"),
    )
    canvas.labels.avoid(pieces, 0.6)
    canvas.labels.avoid(used, 2.0)


def rotation_arc(canvas: Canvas) -> complex | None:
    """Draw an arc with an arrow from the input's first to its last angle; return its middle, or None without an arc."""
    scene = canvas.scene
    turned = scene.end - scene.start
    if abs(turned) < LEAST_ROTATION or not canvas.readable(scene.o2):
        return None
    link = canvas.viewport.scale * float(scene.linkage.input)
    least, most = ROTATION_ARC
    # Small rotations get a larger radius, so that the arc remains visible.
    radius = max(min(max(ARC_SHARE * link, least), most), min(ARC_LENGTH / abs(turned), MAX_ARC_SHARE * link))
    # The arrow head must not be longer than the arc.
    head = math.copysign(min(abs(turned), ARROW_LENGTH / radius), turned)
    arc = canvas.arc(radius, scene.start, scene.end - 0.8 * head)
    back, tip = (complex(z) for z in canvas.arc(radius, scene.end - head, scene.end)[[0, -1]])
    mark = arrow(back, tip, 4.0, INK)
    mark.attributes["data-rotation"] = repr(math.degrees(turned))
    canvas.root.add(path([arc], stroke=INK, stroke_width=1.4), mark)
    canvas.labels.avoid([arc], 2.0)
    return complex(canvas.arc(radius, scene.start, scene.start + 0.5 * turned)[-1])


def demand(canvas: Canvas, demanded: Demand) -> None:
    """Draw a target point or position."""
    if canvas.readable(demanded.point):
        symbol, lines = symbols.demanded(canvas.at(demanded.point), demanded.angle, demanded.index + 1)
        canvas.labels.avoid(lines, 3.0)
        canvas.root.add(symbol)


def misses(canvas: Canvas) -> None:
    """Draw the deviation of P from the fitted points: a line from each point to the position of P there."""
    places = {demand.index: demand.point for demand in canvas.scene.demands if demand.angle is None}
    for c in canvas.scene.configurations:
        point = places.get(c.index)
        # Positions show their error by the body line instead.
        if point is None or not canvas.readable(point):
            continue
        wanted, met = canvas.at(point), canvas.at(c.p)
        if abs(met - wanted) >= SEEN_MISS and canvas.viewport.panel.holds(met):
            mark = line(wanted, met, **MISS, data_miss=f"{c.index + 1}")
            canvas.root.add(mark, circle(met, 1.8, fill=DEMANDED))


def label_demand(canvas: Canvas, demanded: Demand) -> None:
    """Place the number of a target."""
    if canvas.readable(demanded.point):
        at, words = canvas.at(demanded.point), f"{demanded.index + 1}"
        # Put the number opposite to the direction arrow.
        away = -1j if demanded.angle is None else -cmath.exp(-1j * demanded.angle)
        style = {"fill": DEMANDED, "font_weight": "bold"}
        canvas.labels.place(at, words, 11.0, clearance=DEMAND_RADIUS + 2.0, away=away, ring=DEMANDED, style=style)


def label_input(canvas: Canvas, arc: complex | None) -> None:
    """Place the rotation of the input at the middle of its arc, and "limit" at its limits, if there is space."""
    scene, o2 = canvas.scene, canvas.at(canvas.scene.o2)
    if arc is not None:
        turned = angle(math.degrees(scene.end - scene.start), 1)
        canvas.labels.place(arc, turned, 11.0, clearance=3.0, away=arc - o2, optional=True, style={"fill": INK})
    crank = float(scene.linkage.input)
    for limit in scene.limits or ():
        if canvas.readable(scene.o2 + cmath.rect(crank, limit)):
            away = cmath.exp(-1j * limit)
            tip = o2 + (canvas.viewport.scale * crank + TICK) * away
            canvas.labels.place(tip, "limit", 10.0, clearance=2.0, away=away, optional=True, style={"fill": INPUT})
