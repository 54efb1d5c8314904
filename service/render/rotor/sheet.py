"""The sheet of a balanced rotor: its correction planes along the axis, and the corrections in each."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping

from service.render.checks import checks, verdict
from service.render.outline import entries, with_unit
from service.render.page import blocks
from service.render.page.numbers import angle, length
from service.render.page.sheet import EDGE, TOP, beside, framed, sheet, stacked
from service.render.page.svg import Box, Element, circle, element, line, text
from service.render.page.symbols import COUPLER, DEMANDED, GREY, GROUND, INK, INPUT, PALE, arrow
from service.render.rotor.faces import Face, faces
from service.units import symbols
from synthesis.kinds.balancing.design import RotorDesign, RotorMechanism
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.model.dimension import Dimension

COLUMN, SIDE, FACE = 400.0, 190.0, 330.0
"""Width of the tables, and heights of the side view and of the faces, pixels."""

LISTED = 24
"""Maximum number of listed masses; the CSV table has all."""

RIM, REACH = 105.0, 88.0
"""Radius of a face, and of its outermost mark, pixels."""


def rotor_sheet(design: RotorDesign, problem: BalancingProblem, title: str) -> str:
    """Draw a balanced rotor as a complete SVG document."""
    mechanism, metrics, units = design.mechanism, design.metrics, symbols(problem)
    planes = len(mechanism.planes)
    parts = [_along(mechanism, units)]
    width = beside(COLUMN) / planes
    for n, face in enumerate(faces(mechanism)):
        panel = Box(EDGE + n * width, TOP + SIDE + 12.0, EDGE + (n + 1) * width - 6.0, TOP + SIDE + 12.0 + FACE)
        parts.append(_face(n, face, panel, mechanism, units))
    tables = [
        *(_listed(plane, mechanism, units) for plane in range(planes)),
        blocks.rows("Metrics", entries(metrics, problem)),
        *_bearings(design, units),
        checks(design.verification, problem),
    ]
    drawn, y = stacked(tables, width=COLUMN)
    words = f"Rotor balanced in {planes} plane{'s' * (planes > 1)}, {metrics.places} masses or holes"
    described = f"{words}; {verdict(design.verification)}"
    return sheet(title or "Balanced rotor", described, described, [*parts, *drawn], max(TOP + SIDE + FACE + 12.0, y))


def _listed(plane: int, mechanism: RotorMechanism, units: Mapping[Dimension, str]) -> blocks.Block:
    entries = [entry for entry in mechanism.corrections if entry.plane == plane]
    rows = []
    for entry in sorted(entries, key=lambda entry: entry.angle % 360.0)[: LISTED // len(mechanism.planes)]:
        what = with_unit(length(entry.unbalance), units[Dimension.UNBALANCE])
        if entry.mass is not None and entry.radius is not None:
            mass, radius = with_unit(length(entry.mass), units[Dimension.MASS]), length(entry.radius)
            what = f"{mass} at radius {radius} {units[Dimension.LENGTH]}"
        rows.append((f"{'remove' if entry.removed else 'add'} at {angle(entry.angle % 360.0, 3)}", what))
    if len(entries) > len(rows):
        rows.append((f"and {len(entries) - len(rows)} more", ""))
    heading = f"Plane {plane + 1} at z = {length(mechanism.planes[plane])} {units[Dimension.LENGTH]}"
    return blocks.rows(heading, rows or [("nothing to do", "")])


def _bearings(design: RotorDesign, units: Mapping[Dimension, str]) -> list[blocks.Block]:
    """Return the block of bearing forces before and after balancing, if they are known."""
    rows = []
    for entry in design.metrics.bearings or []:
        before, after = length(entry.before, digits=5), length(entry.after, entry.before, digits=5)
        place = f"at z = {length(entry.z)} {units[Dimension.LENGTH]}"
        rows.append((place, with_unit(f"{before} → {after}", units[Dimension.FORCE])))
    return [blocks.rows("Bearings, before → after", rows)] if rows else []


def _along(mechanism: RotorMechanism, units: Mapping[Dimension, str]) -> Element:
    """Draw the rotor from the side: its axis, planes, bearings, and the unbalances at angle 0."""
    panel = Box(EDGE, TOP, EDGE + beside(COLUMN), TOP + SIDE)
    group = framed(panel, "axis")
    stated = [*(entry.z for entry in mechanism.unbalances), *mechanism.planes, *(mechanism.bearings or ())]
    low, high = min(stated), max(stated)
    span = (high - low) or 1.0
    middle = panel.low + 0.52 * SIDE

    def place(z: float) -> float:
        # A single plane is drawn in the middle.
        share = (z - low) / span if high > low else 0.5
        return panel.left + 70.0 + (panel.width - 140.0) * share

    axis = (complex(panel.left + 30.0, middle), complex(panel.right - 30.0, middle))
    group.add(line(*axis, stroke=GROUND, stroke_width=5.0, stroke_linecap="round"))
    for z in mechanism.bearings or ():
        for side in (-1.0, 1.0):
            x, y = place(z) - 9.0, middle + side * 12.0 - 5.0
            group.add(element("rect", x=x, y=y, width=18.0, height=10.0, fill="#eef0f2", stroke=GROUND))
    for n, z in enumerate(mechanism.planes):
        ends = complex(place(z), panel.low + 34.0), complex(place(z), panel.high - 26.0)
        group.add(line(*ends, stroke=COUPLER, stroke_width=1.3, stroke_dasharray="7 3", data_plane=f"{n + 1}"))
        group.add(text(place(z), panel.low + 26.0, f"plane {n + 1}", 11.0, text_anchor="middle", fill=COUPLER))
        words = f"{length(z)} {units[Dimension.LENGTH]}"
        group.add(text(place(z), panel.high - 10.0, words, 10.0, text_anchor="middle", fill=GREY))
    largest = max((entry.unbalance for entry in mechanism.unbalances), default=0.0) or 1.0
    for entry in mechanism.unbalances:
        # The side view shows the vertical component of each unbalance.
        up = 52.0 * entry.unbalance / largest * math.sin(math.radians(entry.angle))
        at = complex(place(entry.z), middle - up)
        group.add(line(complex(at.real, middle), at, stroke=DEMANDED, stroke_width=1.5))
        group.add(circle(at, 4.5, fill=DEMANDED, data_unbalance=repr(entry.unbalance)))
    return group


def _face(n: int, face: Face, panel: Box, mechanism: RotorMechanism, units: Mapping[Dimension, str]) -> Element:
    """Draw a correction plane viewed along the axis: the masses at their angles and radii."""
    group = framed(panel, f"plane_{n + 1}")
    centre = complex(0.5 * (panel.left + panel.right), panel.low + 0.54 * FACE)
    group.add(text(panel.left + 10.0, panel.low + 20.0, f"Plane {n + 1}", 12.0, font_weight="bold", fill=INK))
    group.add(circle(centre, RIM, fill="#f7f8f9", stroke=GROUND, stroke_width=1.4))
    for quarter in range(4):
        along = cmath.exp(-0.5j * math.pi * quarter)
        group.add(line(centre + RIM * along, centre + (RIM + 8.0) * along, stroke=GREY, stroke_width=1.0))
        at = centre + (RIM + 22.0) * along
        group.add(text(at.real, at.imag + 4.0, angle(90.0 * quarter), 10.0, text_anchor="middle", fill=GREY))
    group.add(circle(centre, 5.0, fill="#fff", stroke=GROUND, stroke_width=1.3))
    heaviest = max((entry.unbalance for entry in mechanism.corrections), default=0.0) or 1.0
    for mark in face.marks:
        entry = mark.correction
        # Sheet coordinates point down.
        at = centre + REACH * mark.at.conjugate() / face.radius
        # Drawn area is proportional to the unbalance.
        size = 3.5 + 8.0 * math.sqrt(entry.unbalance / heaviest)
        colour = DEMANDED if entry.removed else INPUT
        group.add(line(centre, at, stroke=PALE, stroke_width=0.9))
        fill = "#fff" if entry.removed else colour
        marks = {"data_correction": repr(entry.unbalance), "data_angle": repr(entry.angle)}
        group.add(circle(at, size, fill=fill, stroke=colour, stroke_width=1.8, **marks))
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
        tip = centre + 0.5 * RIM * along
        group.add(line(centre, tip, stroke=COUPLER, stroke_width=2.0), arrow(tip - 8.0 * along, tip, 4.0, COUPLER))
    words = f"arrow: sum of the corrections, {with_unit(length(abs(residue)), units[Dimension.UNBALANCE])}"
    group.add(text(panel.left + 10.0, panel.high - 10.0, words, 10.0, fill=GREY))
    return group
