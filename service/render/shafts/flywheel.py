"""Flywheels: the sheet with face, section, torque and speed over the cycle; the DXF drawing; the CSV table.

=========  =====================================================
layer      content
=========  =====================================================
WHEEL      outer and inner circle, viewed along the axis
SECTION    outlines of the cut through the axis, at the right
CENTRES    cross at the shaft, axis of the section
TEXT       the dimensions
=========  =====================================================
"""

from __future__ import annotations

import numpy as np

from service.render.checks import describe_verdict, make_checks_block
from service.render.outline import add_unit, list_entries
from service.render.page import blocks, dxf
from service.render.page.diagrams import Diagram
from service.render.page.numbers import format_length
from service.render.page.sheet import BORDER, TOP, draw_panel, get_drawing_width, stack_blocks, write_sheet
from service.render.page.svg import Box, Element, Viewport, draw_circle, draw_line, draw_polygon
from service.render.page.symbols import GREY, GROUND, INPUT, OUTPUT, draw_scale_bar
from service.render.page.table import write_table
from service.units import list_symbols
from synthesis.kinds.flywheel.design import FlywheelDesign, FlywheelMechanism
from synthesis.kinds.flywheel.problem import FlywheelProblem
from synthesis.model.dimension import DENSITY, ROTATIONAL_SPEED, TORQUE

PANEL_HEIGHT, DIAGRAM_HEIGHT, MARGIN = 360.0, 175.0, 30.0
"""Heights of the panel and of each diagram, and margin around the content, pixels."""

SECTION_GAP = 0.35
"""Space between the face and the section, in radii."""

WHEEL_FILL = "#dfe7ef"
"""Fill colour of the wheel's face and section."""

LETTER_HEIGHT = 0.05
"""Height of letters in the drawing, in radii."""


def draw_flywheel_sheet(design: FlywheelDesign, problem: FlywheelProblem, title: str) -> str:
    """Draw face and section of a flywheel to scale, its torque and speed, and tables as a complete SVG document."""
    wheel, units = design.mechanism, list_symbols(problem)
    box = _find_box(wheel)
    view = Viewport.fit(box, Box(BORDER, TOP, BORDER + get_drawing_width(), TOP + PANEL_HEIGHT), MARGIN, MARGIN)
    parts = [_draw_panel(wheel, view, problem.length_unit)]
    at = np.array(design.course.angle)
    torque, speed = np.array(design.course.torque), np.array(design.course.speed)
    metrics = design.metrics
    diagrams = [
        Diagram(_format_heading("Torque", units[TORQUE]), "torque", at, torque, INPUT),
        Diagram(
            _format_heading("Speed of the shaft", units[ROTATIONAL_SPEED]),
            "speed",
            at,
            speed,
            OUTPUT,
            # The dashed lines show the fluctuation of speed.
            limits=(metrics.least_speed, metrics.greatest_speed),
            from_zero=False,
        ),
    ]
    low = TOP + PANEL_HEIGHT + 10.0
    for diagram in diagrams:
        parts.append(diagram.draw(Box(BORDER, low, BORDER + get_drawing_width(), low + DIAGRAM_HEIGHT)))
        low += DIAGRAM_HEIGHT
    tables, bottom = stack_blocks(
        [
            blocks.make_rows("Wheel", _list_dimensions(wheel, problem)),
            make_checks_block(design.verification, problem),
            blocks.make_rows("Metrics", list_entries(metrics, problem)),
        ]
    )
    words = f"{wheel.form.capitalize()} of radius {format_length(wheel.radius)} {problem.length_unit}; "
    described = "A flywheel seen along its axis and cut through it, with torque and speed over a cycle of the shaft."
    heading = title or "Flywheel"
    return write_sheet(
        heading, words + describe_verdict(design.verification), described, [*parts, *tables], max(low, bottom)
    )


def _format_heading(name: str, unit: str) -> str:
    return f"{name} ({unit})" if unit else name


def _list_dimensions(wheel: FlywheelMechanism, problem: FlywheelProblem) -> list[tuple[str, str]]:
    unit = problem.length_unit
    rows = [("outer radius", f"{format_length(wheel.radius)} {unit}")]
    if wheel.form == "rim":
        rows.append(("inner radius", f"{format_length(wheel.inner_radius)} {unit}"))
    density = add_unit(format_length(wheel.density), list_symbols(problem)[DENSITY])
    return [*rows, ("thickness", f"{format_length(wheel.thickness)} {unit}"), ("density", density)]


def _find_box(wheel: FlywheelMechanism) -> Box:
    """Return the box around the face, whose centre is the origin, and the section at its right."""
    right = (1.0 + SECTION_GAP) * wheel.radius + wheel.thickness
    return Box(-wheel.radius, -wheel.radius, right, wheel.radius)


def _list_cuts(wheel: FlywheelMechanism) -> list[list[complex]]:
    """Return the corners of the cut faces of the section."""
    left = (1.0 + SECTION_GAP) * wheel.radius
    right = left + wheel.thickness
    halves = [(-wheel.radius, wheel.radius)]
    if wheel.inner_radius > 0.0:
        halves = [(wheel.inner_radius, wheel.radius), (-wheel.radius, -wheel.inner_radius)]
    return [
        [complex(left, low), complex(right, low), complex(right, high), complex(left, high)] for low, high in halves
    ]


def _draw_panel(wheel: FlywheelMechanism, view: Viewport, unit: str) -> Element:
    group = draw_panel(view.panel, "flywheel")
    centre = view.point(0j)
    outside = view.scale * wheel.radius
    group.add(draw_circle(centre, outside, fill=WHEEL_FILL, stroke=INPUT, stroke_width=1.6, data_circle="outside"))
    if wheel.inner_radius > 0.0:
        inside = view.scale * wheel.inner_radius
        group.add(draw_circle(centre, inside, fill="#fff", stroke=INPUT, stroke_width=1.6, data_circle="inside"))
    for corners in _list_cuts(wheel):
        group.add(
            draw_polygon([view.point(corner) for corner in corners], fill=WHEEL_FILL, stroke=INPUT, stroke_width=1.6)
        )
    for arm in (complex(outside + 8.0), 1j * (outside + 8.0)):
        group.add(draw_line(centre - arm, centre + arm, stroke=GREY, stroke_width=0.8, stroke_dasharray="9 3 2 3"))
    left, right = (
        view.point(complex(_find_box(wheel).right - wheel.thickness)),
        view.point(complex(_find_box(wheel).right)),
    )
    group.add(draw_line(left - 8.0, right + 8.0, stroke=GREY, stroke_width=0.8, stroke_dasharray="9 3 2 3"))
    group.add(draw_circle(centre, 3.0, fill=GROUND))
    return group.add(draw_scale_bar(view, unit)[0])


def write_flywheel_dxf(design: FlywheelDesign, problem: FlywheelProblem, title: str) -> str:
    """Write face and section as a DXF document (R2010)."""
    wheel = design.mechanism
    layers = {name: (colour, "CONTINUOUS") for name, colour in (("WHEEL", 5), ("SECTION", 3), ("TEXT", 7))}
    document = dxf.create_drawing(title or "Flywheel", problem.length_unit, layers | {"CENTRES": (7, "CENTER")})
    space = document.modelspace()
    dxf.add_circle(space, 0j, wheel.radius, "WHEEL")
    if wheel.inner_radius > 0.0:
        dxf.add_circle(space, 0j, wheel.inner_radius, "WHEEL")
    for corners in _list_cuts(wheel):
        dxf.add_outline(space, corners, "SECTION")
    height = LETTER_HEIGHT * wheel.radius
    dxf.add_cross(space, 0j, 2.0 * height, "CENTRES")
    right = _find_box(wheel).right
    dxf.add_line(space, complex(right - wheel.thickness - height), complex(right + height), "CENTRES")
    for n, (name, value) in enumerate(_list_dimensions(wheel, problem)):
        dxf.add_words(space, complex(0.0, -wheel.radius - (2.0 + 1.6 * n) * height), f"{name} {value}", height)
    return dxf.write_document(document)


def write_flywheel_table(design: FlywheelDesign, problem: FlywheelProblem, title: str) -> str:
    """Write angle, torque and speed over a cycle."""
    course = design.course
    unit = "n_m" if problem.units == "si" else "consistent"
    rows = zip(course.angle, course.torque, course.speed, strict=True)
    return write_table(["angle_deg", f"torque_{unit}", "speed_rpm"], (list(row) for row in rows))
