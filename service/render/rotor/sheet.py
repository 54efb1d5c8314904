"""The sheet of a balanced rotor: its correction planes along the axis, and the corrections in each."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping

from service.render.checks import describe_verdict, make_checks_block
from service.render.outline import add_unit, list_entries
from service.render.page import blocks
from service.render.page.numbers import format_angle, format_length
from service.render.page.sheet import BORDER, TOP, draw_panel, get_drawing_width, stack_blocks, write_sheet
from service.render.page.svg import Box, Element, draw_circle, draw_line, draw_text, make_element
from service.render.page.symbols import COUPLER, GREY, GROUND, INK, INPUT, PALE, TARGET_COLOUR, draw_arrow
from service.render.rotor.faces import Face, make_faces
from service.units import list_symbols
from synthesis.kinds.balancing.design import RotorDesign, RotorMechanism
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.model.dimension import Dimension

TABLE_WIDTH, SIDE_VIEW_HEIGHT, FACE_HEIGHT = 400.0, 190.0, 330.0
"""Width of the tables, and heights of the side view and of the faces, pixels."""

MAX_LISTED = 24
"""Maximum number of listed masses; the CSV table has all."""

RIM_RADIUS, MARK_RADIUS = 105.0, 88.0
"""Radius of a face, and of its outermost mark, pixels."""


def draw_rotor_sheet(design: RotorDesign, problem: BalancingProblem, title: str) -> str:
    """Draw a balanced rotor as a complete SVG document."""
    mechanism, metrics, units = design.mechanism, design.metrics, list_symbols(problem)
    planes = len(mechanism.planes)
    parts = [_draw_side_view(mechanism, units)]
    width = get_drawing_width(TABLE_WIDTH) / planes
    for n, face in enumerate(make_faces(mechanism)):
        panel = Box(
            BORDER + n * width,
            TOP + SIDE_VIEW_HEIGHT + 12.0,
            BORDER + (n + 1) * width - 6.0,
            TOP + SIDE_VIEW_HEIGHT + 12.0 + FACE_HEIGHT,
        )
        parts.append(_draw_face(n, face, panel, mechanism, units))
    tables = [
        *(_list_corrections(plane, mechanism, units) for plane in range(planes)),
        blocks.make_rows("Metrics", list_entries(metrics, problem)),
        *_list_bearings(design, units),
        make_checks_block(design.verification, problem),
    ]
    drawn, y = stack_blocks(tables, width=TABLE_WIDTH)
    words = f"Rotor balanced in {planes} plane{'s' * (planes > 1)}, {metrics.places} masses or holes"
    described = f"{words}; {describe_verdict(design.verification)}"
    return write_sheet(
        title or "Balanced rotor",
        described,
        described,
        [*parts, *drawn],
        max(TOP + SIDE_VIEW_HEIGHT + FACE_HEIGHT + 12.0, y),
    )


def _list_corrections(plane: int, mechanism: RotorMechanism, units: Mapping[Dimension, str]) -> blocks.Block:
    entries = [entry for entry in mechanism.corrections if entry.plane == plane]
    rows = []
    for entry in sorted(entries, key=lambda entry: entry.angle % 360.0)[: MAX_LISTED // len(mechanism.planes)]:
        what = add_unit(format_length(entry.unbalance), units[Dimension.UNBALANCE])
        if entry.mass is not None and entry.radius is not None:
            mass, radius = add_unit(format_length(entry.mass), units[Dimension.MASS]), format_length(entry.radius)
            what = f"{mass} at radius {radius} {units[Dimension.LENGTH]}"
        rows.append((f"{'remove' if entry.removed else 'add'} at {format_angle(entry.angle % 360.0, 3)}", what))
    if len(entries) > len(rows):
        rows.append((f"and {len(entries) - len(rows)} more", ""))
    heading = f"Plane {plane + 1} at z = {format_length(mechanism.planes[plane])} {units[Dimension.LENGTH]}"
    return blocks.make_rows(heading, rows or [("nothing to do", "")])


def _list_bearings(design: RotorDesign, units: Mapping[Dimension, str]) -> list[blocks.Block]:
    """Return the block of bearing forces before and after balancing, if they are known."""
    rows = []
    for entry in design.metrics.bearings or []:
        before, after = format_length(entry.before, digits=5), format_length(entry.after, entry.before, digits=5)
        place = f"at z = {format_length(entry.z)} {units[Dimension.LENGTH]}"
        rows.append((place, add_unit(f"{before} → {after}", units[Dimension.FORCE])))
    return [blocks.make_rows("Bearings, before → after", rows)] if rows else []


def _draw_side_view(mechanism: RotorMechanism, units: Mapping[Dimension, str]) -> Element:
    """Draw the rotor from the side: its axis, planes, bearings, and the unbalances at angle 0."""
    panel = Box(BORDER, TOP, BORDER + get_drawing_width(TABLE_WIDTH), TOP + SIDE_VIEW_HEIGHT)
    group = draw_panel(panel, "axis")
    stated = [*(entry.z for entry in mechanism.unbalances), *mechanism.planes, *(mechanism.bearings or ())]
    low, high = min(stated), max(stated)
    span = (high - low) or 1.0
    middle = panel.low + 0.52 * SIDE_VIEW_HEIGHT

    def place(z: float) -> float:
        # A single plane is drawn in the middle.
        share = (z - low) / span if high > low else 0.5
        return panel.left + 70.0 + (panel.width - 140.0) * share

    axis = (complex(panel.left + 30.0, middle), complex(panel.right - 30.0, middle))
    group.add(draw_line(*axis, stroke=GROUND, stroke_width=5.0, stroke_linecap="round"))
    for z in mechanism.bearings or ():
        for side in (-1.0, 1.0):
            x, y = place(z) - 9.0, middle + side * 12.0 - 5.0
            group.add(make_element("rect", x=x, y=y, width=18.0, height=10.0, fill="#eef0f2", stroke=GROUND))
    for n, z in enumerate(mechanism.planes):
        ends = complex(place(z), panel.low + 34.0), complex(place(z), panel.high - 26.0)
        group.add(draw_line(*ends, stroke=COUPLER, stroke_width=1.3, stroke_dasharray="7 3", data_plane=f"{n + 1}"))
        group.add(draw_text(place(z), panel.low + 26.0, f"plane {n + 1}", 11.0, text_anchor="middle", fill=COUPLER))
        words = f"{format_length(z)} {units[Dimension.LENGTH]}"
        group.add(draw_text(place(z), panel.high - 10.0, words, 10.0, text_anchor="middle", fill=GREY))
    largest = max((entry.unbalance for entry in mechanism.unbalances), default=0.0) or 1.0
    for entry in mechanism.unbalances:
        # The side view shows the vertical component of each unbalance.
        up = 52.0 * entry.unbalance / largest * math.sin(math.radians(entry.angle))
        at = complex(place(entry.z), middle - up)
        group.add(draw_line(complex(at.real, middle), at, stroke=TARGET_COLOUR, stroke_width=1.5))
        group.add(draw_circle(at, 4.5, fill=TARGET_COLOUR, data_unbalance=repr(entry.unbalance)))
    return group


def _draw_face(n: int, face: Face, panel: Box, mechanism: RotorMechanism, units: Mapping[Dimension, str]) -> Element:
    """Draw a correction plane viewed along the axis: the masses at their angles and radii."""
    group = draw_panel(panel, f"plane_{n + 1}")
    centre = complex(0.5 * (panel.left + panel.right), panel.low + 0.54 * FACE_HEIGHT)
    group.add(draw_text(panel.left + 10.0, panel.low + 20.0, f"Plane {n + 1}", 12.0, font_weight="bold", fill=INK))
    group.add(draw_circle(centre, RIM_RADIUS, fill="#f7f8f9", stroke=GROUND, stroke_width=1.4))
    for quarter in range(4):
        along = cmath.exp(-0.5j * math.pi * quarter)
        group.add(
            draw_line(centre + RIM_RADIUS * along, centre + (RIM_RADIUS + 8.0) * along, stroke=GREY, stroke_width=1.0)
        )
        at = centre + (RIM_RADIUS + 22.0) * along
        group.add(
            draw_text(at.real, at.imag + 4.0, format_angle(90.0 * quarter), 10.0, text_anchor="middle", fill=GREY)
        )
    group.add(draw_circle(centre, 5.0, fill="#fff", stroke=GROUND, stroke_width=1.3))
    heaviest = max((entry.unbalance for entry in mechanism.corrections), default=0.0) or 1.0
    for mark in face.marks:
        entry = mark.correction
        # Sheet coordinates point down.
        at = centre + MARK_RADIUS * mark.at.conjugate() / face.radius
        # Drawn area is proportional to the unbalance.
        size = 3.5 + 8.0 * math.sqrt(entry.unbalance / heaviest)
        colour = TARGET_COLOUR if entry.removed else INPUT
        group.add(draw_line(centre, at, stroke=PALE, stroke_width=0.9))
        fill = "#fff" if entry.removed else colour
        marks = {"data_correction": repr(entry.unbalance), "data_angle": repr(entry.angle)}
        group.add(draw_circle(at, size, fill=fill, stroke=colour, stroke_width=1.8, **marks))
    residue = sum(
        (
            (-1.0 if mark.correction.removed else 1.0)
            * cmath.rect(mark.correction.unbalance, math.radians(mark.correction.angle))
            for mark in face.marks
        ),
        0j,
    )
    if abs(residue) > 0.0:
        along = residue.conjugate() / abs(residue)
        tip = centre + 0.5 * RIM_RADIUS * along
        group.add(
            draw_line(centre, tip, stroke=COUPLER, stroke_width=2.0), draw_arrow(tip - 8.0 * along, tip, 4.0, COUPLER)
        )
    words = f"arrow: sum of the corrections, {add_unit(format_length(abs(residue)), units[Dimension.UNBALANCE])}"
    group.add(draw_text(panel.left + 10.0, panel.high - 10.0, words, 10.0, fill=GREY))
    return group
