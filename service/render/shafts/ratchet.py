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

from kinematics.indexing.ratchet import Ratchet
from service.render.checks import checks, verdict
from service.render.outline import entries
from service.render.page import blocks, dxf
from service.render.page.diagrams import Diagram
from service.render.page.sheet import EDGE, TOP, beside, framed, sheet, stacked
from service.render.page.svg import Box, Element, Viewport, circle, polygon
from service.render.page.symbols import GROUND, INPUT, OUTPUT, scale_bar
from service.render.page.table import table
from synthesis.kinds.indexing.design import Pawl, RatchetDesign, RatchetMechanism
from synthesis.kinds.indexing.problem import IndexingProblem

Complex = NDArray[np.complex128]

PANEL, DIAGRAM, MARGIN = 400.0, 175.0, 24.0
"""Heights of the panel and of the diagram, and margin around the content, pixels."""

FILL, PAWL = "#dfe7ef", "#f3e7d3"
"""Fill colours of the wheel and of pawls."""

LETTERS = 0.04
"""Height of letters in the drawing, in radii of the wheel."""

SHOWN = 361
"""Number of samples of the lift diagram, which covers three pitches."""


def ratchet_sheet(design: RatchetDesign, problem: IndexingProblem, title: str) -> str:
    """Draw wheel and pawls to scale, the lift of a pawl over three teeth, and tables as an SVG document."""
    mechanism = design.mechanism
    parts = [_panel(mechanism, problem.length_unit)]
    at, lift = _lifts(mechanism)
    low = TOP + PANEL + 10.0
    parts.append(
        Diagram("Lift of a pawl (°)", "lift", at, lift, INPUT).draw(Box(EDGE, low, EDGE + beside(), low + DIAGRAM))
    )
    tables, bottom = stacked(
        [
            blocks.rows("Ratchet", _dimensions(design, problem)),
            checks(design.verification, problem),
            blocks.rows("Metrics", entries(design.metrics, problem)),
        ]
    )
    words = f"Ratchet of {mechanism.teeth} teeth, {mechanism.stations} stops; {verdict(design.verification)}"
    described = "A ratchet wheel with its pawls, and the lift of a pawl by three passing teeth."
    return sheet(title or "Ratchet", words, described, [*parts, *tables], max(low + DIAGRAM, bottom))


def _dimensions(design: RatchetDesign, problem: IndexingProblem) -> list[tuple[str, str]]:
    rows = entries(design.mechanism, problem, {"type", "profile", "pawls"})
    return [*rows, ("pawls", str(len(design.mechanism.pawls)))]


def _ratchet(mechanism: RatchetMechanism) -> Ratchet:
    return Ratchet(
        mechanism.teeth,
        mechanism.wheel_radius,
        mechanism.tooth_height,
        math.radians(mechanism.face_angle),
        mechanism.pawl_length,
    )


def _lifts(mechanism: RatchetMechanism) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the wheel's angle over three teeth and the lift of the first pawl, degrees."""
    ratchet = _ratchet(mechanism)
    angle = 3.0 * ratchet.pitch * np.arange(SHOWN) / (SHOWN - 1)
    return np.degrees(angle), np.degrees(ratchet.lifted(angle))


def _wheel(mechanism: RatchetMechanism) -> Complex:
    return np.asarray(np.array(mechanism.profile.x) + 1j * np.array(mechanism.profile.y))


def _pawl(mechanism: RatchetMechanism, pawl: Pawl) -> list[complex]:
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
    lift = 0.0 if pawl.stop == 0.0 else float(_ratchet(mechanism).lifted(np.radians(-pawl.stop)))
    return [complex(pivot + (corner - pivot) * np.exp(-1j * lift)) for corner in corners]


def _panel(mechanism: RatchetMechanism, unit: str) -> Element:
    wheel, pawls = _wheel(mechanism), [_pawl(mechanism, pawl) for pawl in mechanism.pawls]
    around = Box.around(np.concatenate([wheel, np.array(pawls).ravel()])).grown(mechanism.tooth_height)
    view = Viewport.fit(around, Box(EDGE, TOP, EDGE + beside(), TOP + PANEL), MARGIN, MARGIN)
    group = framed(view.panel, "ratchet")
    group.add(polygon([view.point(z) for z in wheel], fill=FILL, stroke=OUTPUT, stroke_width=1.4, data_part="wheel"))
    if mechanism.bore > 0.0:
        group.add(circle(view.point(0j), 0.5 * view.scale * mechanism.bore, fill="#fff", stroke=OUTPUT))
    for corners, pawl in zip(pawls, mechanism.pawls, strict=True):
        shape = [view.point(z) for z in corners]
        group.add(polygon(shape, fill=PAWL, stroke=INPUT, stroke_width=1.4, data_part="pawl"))
        group.add(circle(view.point(complex(*pawl.pivot)), 3.0, fill=GROUND))
    group.add(circle(view.point(0j), 3.0, fill=GROUND))
    return group.add(scale_bar(view, unit)[0])


def ratchet_drawing(design: RatchetDesign, problem: IndexingProblem, title: str) -> str:
    """Write wheel and pawls as a DXF document (R2010)."""
    mechanism = design.mechanism
    layers = {"WHEEL": (5, "CONTINUOUS"), "PAWLS": (3, "CONTINUOUS"), "CENTRES": (7, "CENTER")}
    document = dxf.new_drawing(title or "Ratchet", problem.length_unit, layers | {"TEXT": (7, "CONTINUOUS")})
    space, letters = document.modelspace(), LETTERS * mechanism.wheel_radius
    dxf.add_outline(space, (complex(z) for z in _wheel(mechanism)), "WHEEL")
    if mechanism.bore > 0.0:
        dxf.add_circle(space, 0j, 0.5 * mechanism.bore, "WHEEL")
    for pawl in mechanism.pawls:
        dxf.add_outline(space, _pawl(mechanism, pawl), "PAWLS")
        dxf.add_circle(space, complex(*pawl.pivot), 0.3 * mechanism.tooth_height, "PAWLS")
    dxf.add_cross(space, 0j, 2.0 * letters, "CENTRES")
    for n, (name, value) in enumerate(_dimensions(design, problem)):
        # Dimensions are listed below the wheel and its pawls.
        at = complex(0.0, -2.2 * mechanism.wheel_radius - 1.6 * n * letters)
        dxf.add_words(space, at, f"{name} {value}", letters)
    return dxf.written(document)


def ratchet_table(design: RatchetDesign, problem: IndexingProblem, title: str) -> str:
    """Write the lift of the first pawl over three teeth."""
    at, lift = _lifts(design.mechanism)
    return table(["wheel_deg", "lift_deg"], (list(row) for row in zip(at.tolist(), lift.tolist(), strict=True)))
