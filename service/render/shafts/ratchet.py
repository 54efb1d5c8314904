"""Ratchets: the sheet with wheel and pawls; the DXF drawing; the CSV table of a pawl's lift.

=========  =====================================
layer      content
=========  =====================================
WHEEL      outline of the teeth, bore
PAWLS      pawls with their pivots
CENTRES    cross at the axis
TEXT       the dimensions
=========  =====================================
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex
from kinematics.indexing.ratchet import Ratchet
from service.render.checks import describe_verdict, make_checks_block
from service.render.outline import list_entries
from service.render.page import blocks, dxf
from service.render.page.diagrams import Diagram
from service.render.page.sheet import BORDER, TOP, draw_panel, get_drawing_width, stack_blocks, write_sheet
from service.render.page.svg import Box, Element, Viewport, draw_circle, draw_polygon
from service.render.page.symbols import GROUND, INPUT, OUTPUT, draw_scale_bar
from service.render.page.table import write_table
from synthesis.kinds.indexing.design import Pawl, RatchetDesign, RatchetMechanism
from synthesis.kinds.indexing.problem import IndexingProblem

PANEL_HEIGHT, DIAGRAM_HEIGHT, MARGIN = 400.0, 175.0, 24.0
"""Heights of the panel and of the diagram, and margin around the content, pixels."""

WHEEL_FILL, PAWL_FILL = "#dfe7ef", "#f3e7d3"
"""Fill colours of the wheel and of pawls."""

LETTER_HEIGHT = 0.04
"""Height of letters in the drawing, in radii of the wheel."""

LIFT_SAMPLES = 361
"""Number of samples of the lift diagram, which covers three pitches."""


def draw_ratchet_sheet(design: RatchetDesign, problem: IndexingProblem, title: str) -> str:
    """Draw wheel and pawls to scale, the lift of a pawl over three teeth, and tables as an SVG document."""
    mechanism = design.mechanism
    parts = [_draw_panel(mechanism, problem.length_unit)]
    at, lift = _compute_lifts(mechanism)
    low = TOP + PANEL_HEIGHT + 10.0
    parts.append(
        Diagram("Lift of a pawl (°)", "lift", at, lift, INPUT).draw(
            Box(BORDER, low, BORDER + get_drawing_width(), low + DIAGRAM_HEIGHT)
        )
    )
    tables, bottom = stack_blocks(
        [
            blocks.make_rows("Ratchet", _list_dimensions(design, problem)),
            make_checks_block(design.verification, problem),
            blocks.make_rows("Metrics", list_entries(design.metrics, problem)),
        ]
    )
    words = f"Ratchet of {mechanism.teeth} teeth, {mechanism.stations} stops; {describe_verdict(design.verification)}"
    described = "A ratchet wheel with its pawls, and the lift of a pawl by three passing teeth."
    return write_sheet(title or "Ratchet", words, described, [*parts, *tables], max(low + DIAGRAM_HEIGHT, bottom))


def _list_dimensions(design: RatchetDesign, problem: IndexingProblem) -> list[tuple[str, str]]:
    rows = list_entries(design.mechanism, problem, {"type", "profile", "pawls"})
    return [*rows, ("pawls", str(len(design.mechanism.pawls)))]


def _make_ratchet(mechanism: RatchetMechanism) -> Ratchet:
    return Ratchet(
        mechanism.teeth,
        mechanism.wheel_radius,
        mechanism.tooth_height,
        math.radians(mechanism.face_angle),
        mechanism.pawl_length,
    )


def _compute_lifts(mechanism: RatchetMechanism) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the wheel's angle over three teeth and the lift of the first pawl, degrees."""
    ratchet = _make_ratchet(mechanism)
    angle = 3.0 * ratchet.pitch * np.arange(LIFT_SAMPLES) / (LIFT_SAMPLES - 1)
    return np.degrees(angle), np.degrees(ratchet.pawl_lift(angle))


def _make_wheel(mechanism: RatchetMechanism) -> Complex:
    return np.asarray(np.array(mechanism.profile.x) + 1j * np.array(mechanism.profile.y))


def _make_pawl(mechanism: RatchetMechanism, pawl: Pawl) -> list[complex]:
    """Return a pawl as a bar with a nose while the first one holds the wheel; others rest on the backs of teeth."""
    pivot, nose, height = complex(*pawl.pivot), complex(*pawl.nose), mechanism.tooth_height
    out = nose / abs(nose)
    back = (pivot - nose) / abs(pivot - nose)
    face = out * np.exp(-1j * math.radians(mechanism.face_angle))
    clear = 1.3 * height
    corners = [
        nose,
        nose + 1.9 * height * face,
        pivot + 1.5 * height * out,
        pivot + 0.6 * height * back,
        pivot + 0.3 * height * out,
        nose + clear * out + 1.2 * height * back,
    ]
    # Only the first pawl rests on a face; others lie on backs of teeth.
    lift = 0.0 if pawl.stop == 0.0 else float(_make_ratchet(mechanism).pawl_lift(np.radians(-pawl.stop)))
    return [complex(pivot + (corner - pivot) * np.exp(-1j * lift)) for corner in corners]


def _draw_panel(mechanism: RatchetMechanism, unit: str) -> Element:
    wheel, pawls = _make_wheel(mechanism), [_make_pawl(mechanism, pawl) for pawl in mechanism.pawls]
    around = Box.enclose(np.concatenate([wheel, np.array(pawls).ravel()])).grow(mechanism.tooth_height)
    view = Viewport.fit(around, Box(BORDER, TOP, BORDER + get_drawing_width(), TOP + PANEL_HEIGHT), MARGIN, MARGIN)
    group = draw_panel(view.panel, "ratchet")
    group.add(
        draw_polygon(
            [view.point(z) for z in wheel], fill=WHEEL_FILL, stroke=OUTPUT, stroke_width=1.4, data_part="wheel"
        )
    )
    if mechanism.bore > 0.0:
        group.add(draw_circle(view.point(0j), 0.5 * view.scale * mechanism.bore, fill="#fff", stroke=OUTPUT))
    for corners, pawl in zip(pawls, mechanism.pawls, strict=True):
        shape = [view.point(z) for z in corners]
        group.add(draw_polygon(shape, fill=PAWL_FILL, stroke=INPUT, stroke_width=1.4, data_part="pawl"))
        group.add(draw_circle(view.point(complex(*pawl.pivot)), 3.0, fill=GROUND))
    group.add(draw_circle(view.point(0j), 3.0, fill=GROUND))
    return group.add(draw_scale_bar(view, unit)[0])


def write_ratchet_dxf(design: RatchetDesign, problem: IndexingProblem, title: str) -> str:
    """Write wheel and pawls as a DXF document (R2010)."""
    mechanism = design.mechanism
    layers = {"WHEEL": (5, "CONTINUOUS"), "PAWLS": (3, "CONTINUOUS"), "CENTRES": (7, "CENTER")}
    document = dxf.create_drawing(title or "Ratchet", problem.length_unit, layers | {"TEXT": (7, "CONTINUOUS")})
    space, letters = document.modelspace(), LETTER_HEIGHT * mechanism.wheel_radius
    dxf.add_outline(space, (complex(z) for z in _make_wheel(mechanism)), "WHEEL")
    if mechanism.bore > 0.0:
        dxf.add_circle(space, 0j, 0.5 * mechanism.bore, "WHEEL")
    for pawl in mechanism.pawls:
        dxf.add_outline(space, _make_pawl(mechanism, pawl), "PAWLS")
        dxf.add_circle(space, complex(*pawl.pivot), 0.3 * mechanism.tooth_height, "PAWLS")
    dxf.add_cross(space, 0j, 2.0 * letters, "CENTRES")
    for n, (name, value) in enumerate(_list_dimensions(design, problem)):
        # Dimensions are listed below the wheel and its pawls.
        at = complex(0.0, -2.2 * mechanism.wheel_radius - 1.6 * n * letters)
        dxf.add_words(space, at, f"{name} {value}", letters)
    return dxf.write_document(document)


def write_ratchet_table(design: RatchetDesign, problem: IndexingProblem, title: str) -> str:
    """Write the lift of the first pawl over three teeth."""
    at, lift = _compute_lifts(design.mechanism)
    return write_table(["wheel_deg", "lift_deg"], (list(row) for row in zip(at.tolist(), lift.tolist(), strict=True)))
