"""Geneva drives: the sheet with wheel, crank and program; the DXF drawing with true arcs; the animation; the CSV table.

=========  ===================================================================
layer      content
=========  ===================================================================
WHEEL      outline of the wheel: slots, locking arcs, lands, bore, a ring's outside
CRANK      locking disc and rollers
CENTRES    crosses at both axes, the circle of the rollers, axes of slots
TEXT       the dimensions
=========  ===================================================================
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from ezdxf.layouts.layout import Modelspace

from kinematics.arrays import Complex
from service.render.checks import describe_verdict, make_checks_block
from service.render.outline import list_entries
from service.render.page import blocks, dxf
from service.render.page.animation import Stroke, draw_gif, make_circle
from service.render.page.diagrams import Diagram
from service.render.page.numbers import format_angle, format_length
from service.render.page.sheet import BORDER, TOP, draw_panel, get_drawing_width, stack_blocks, write_sheet
from service.render.page.svg import Box, Element, Viewport, draw_circle, draw_line, draw_path, draw_polygon
from service.render.page.symbols import COUPLER, GREY, GROUND, INPUT, OUTPUT, draw_scale_bar
from service.render.page.table import write_table
from service.units import list_symbols
from synthesis.kinds.indexing.design import GenevaMechanism, IndexingDesign, SphericalGenevaMechanism
from synthesis.kinds.indexing.problem import IndexingProblem
from synthesis.mechanisms.geneva import build_drive
from synthesis.model.dimension import ACCELERATION, FORCE, JERK, TORQUE, VELOCITY

Mechanism = GenevaMechanism | SphericalGenevaMechanism

PANEL_HEIGHT, DIAGRAM_HEIGHT, MARGIN = 380.0, 150.0, 24.0
"""Heights of the panel and of each diagram, and margin around the content, pixels."""

WHEEL_FILL, DISC_FILL = "#dfe7ef", "#f3e7d3"
"""Fill colours of the wheel and of the disc."""

TURN_FRAMES = 72
"""Number of frames per turn of the crank."""

CIRCLE_POINTS = 73
"""Number of points of a drawn circle."""

LETTER_HEIGHT = 0.03
"""Height of letters in the drawing, in sizes of the drive."""


def draw_indexing_sheet(design: IndexingDesign, problem: IndexingProblem, title: str) -> str:
    """Draw wheel and crank as a roller enters, the program, torque and pin force, and tables as an SVG document."""
    units, program, course = list_symbols(problem), design.program, design.course
    parts = [_draw_panel(design, problem)]
    at = np.array(program.angle)
    low = TOP + PANEL_HEIGHT + 10.0
    for heading, name, unit, values, colour in (
        ("Velocity v", "v", units[VELOCITY], program.v, INPUT),
        ("Acceleration a", "a", units[ACCELERATION], program.a, OUTPUT),
        ("Jerk j", "j", units[JERK], program.j, COUPLER),
        ("Drive torque", "torque", units[TORQUE], course.drive_torque, INPUT),
        ("Pin force", "force", units[FORCE], course.pin_force, OUTPUT),
    ):
        headed = f"{heading} ({unit})" if unit else heading
        diagram = Diagram(headed, name, at, np.array(values), colour)
        parts.append(diagram.draw(Box(BORDER, low, BORDER + get_drawing_width(), low + DIAGRAM_HEIGHT)))
        low += DIAGRAM_HEIGHT
    tables, bottom = stack_blocks(
        [
            blocks.make_rows("Drive", _list_dimensions(design, problem)),
            make_checks_block(design.verification, problem),
            blocks.make_rows("Metrics", list_entries(design.metrics, problem)),
        ]
    )
    words = f"{_name(design)} of {design.mechanism.stations} stations; {describe_verdict(design.verification)}"
    described = "Wheel and crank of a Geneva drive, and the motion of the wheel over an index of the crank."
    return write_sheet(title or "Indexing drive", words, described, [*parts, *tables], max(low, bottom))


def _name(design: IndexingDesign) -> str:
    return f"{design.mechanism.type.removeprefix('geneva_').capitalize()} Geneva drive"


def _list_dimensions(design: IndexingDesign, problem: IndexingProblem) -> list[tuple[str, str]]:
    rows = list_entries(design.mechanism, problem, {"type", "profile", "disc"})
    share = f"{format_length(100.0 * design.dwell_share, digits=4)} %"
    return [*rows, ("index", format_angle(design.index_angle)), ("rest, of the time", share)]


def _make_circle(radius: float, center: complex = 0j) -> Complex:
    return np.asarray(center + radius * np.exp(2j * math.pi * np.arange(CIRCLE_POINTS) / (CIRCLE_POINTS - 1)))


def _make_wheel(design: IndexingDesign) -> Complex:
    """Return the wheel in the crank's frame as a roller enters; the crank is at +x."""
    profile = design.mechanism.profile
    # As a roller enters, its slot is half a station off the line of centres.
    sense = 1.0 if design.mechanism.type == "geneva_external" else -1.0
    turned = sense * math.pi / design.mechanism.stations
    return np.asarray((np.array(profile.x) + 1j * np.array(profile.y)) * np.exp(1j * turned))


def _make_plane_crank(mechanism: GenevaMechanism, half: float) -> tuple[Complex, list[complex]]:
    """Return the disc as a polygon, and the rollers, as the first of them enters."""
    sense = 1.0 if mechanism.type == "geneva_external" else -1.0
    way = -sense * np.exp(-1j * half)
    at = np.exp(1j * np.radians(mechanism.disc.angle))
    outer, inner = np.array(mechanism.disc.outer_radius) * at, np.array(mechanism.disc.inner_radius) * at
    # A crescent has an inner edge, a full disc has none.
    corners = np.concatenate([outer, inner[::-1]]) if inner.any() else outer
    turns = np.exp(2j * math.pi * np.arange(mechanism.rollers) / mechanism.rollers)
    rollers = mechanism.center_distance + way * mechanism.crank_radius * turns
    return np.asarray(mechanism.center_distance + way * corners), [complex(roller) for roller in rollers]


def _make_cap(mechanism: SphericalGenevaMechanism) -> tuple[Complex, complex]:
    """Return the outline of the cap, and the roller, viewed from outside along the crank's axis.

    The view is next to that of the wheel, and the roller points up.
    """
    center = 2.4 * mechanism.sphere_radius
    radius = mechanism.sphere_radius * math.sin(math.radians(mechanism.cap_angle))
    # The cap is cut off by a plane at this share of its radius.
    share = min(1.0, mechanism.cap_offset / radius)
    ends = math.asin(share)
    arc = radius * np.exp(1j * np.linspace(math.pi + ends, 2.0 * math.pi - ends, CIRCLE_POINTS))
    roller = center + 1j * mechanism.sphere_radius * math.sin(math.radians(mechanism.cone_angle))
    return np.asarray(center + arc), roller


def _make_crank(design: IndexingDesign) -> tuple[Complex, list[complex], complex, float]:
    """Return disc, rollers, the crank's axis and the radius of the rollers' circle."""
    mechanism = design.mechanism
    if isinstance(mechanism, GenevaMechanism):
        disc, rollers = _make_plane_crank(mechanism, build_drive(mechanism).geneva.half)
        return disc, rollers, complex(mechanism.center_distance), mechanism.crank_radius
    cap, roller = _make_cap(mechanism)
    center = complex(2.4 * mechanism.sphere_radius)
    return cap, [roller], center, abs(roller - center)


def _place_links(mechanism: Mechanism, angle: float, crank: float) -> list[Complex]:
    """Return the lines of the links of a drag link; an empty list without a drag link.

    The position is given by the angles of its input and of the crank since a roller entered.
    """
    link = getattr(mechanism, "drag_link", None)
    if link is None or not isinstance(mechanism, GenevaMechanism):
        return []
    # In the middle of an index the crank points to an external wheel's axis, and away from an internal one's.
    towards = math.pi if mechanism.type == "geneva_external" else 0.0
    output = towards - build_drive(mechanism).geneva.half + crank - math.radians(link.crank_offset)
    pivot, axis = complex(*link.input_pivot), complex(mechanism.center_distance)
    pin = pivot - link.input * np.exp(1j * (math.radians(link.entry_angle) + angle))
    return [np.array([pivot, pin, axis + link.output * np.exp(1j * output), axis])]


def _enclose_drag_link(mechanism: Mechanism) -> Complex:
    """Return a circle around the range of a drag link; empty without one."""
    link = getattr(mechanism, "drag_link", None)
    return np.empty(0, np.complex128) if link is None else _make_circle(link.input, complex(*link.input_pivot))


def _make_outside(design: IndexingDesign) -> Complex:
    ring = getattr(design.mechanism, "ring_radius", None)
    return np.empty(0, np.complex128) if ring is None else _make_circle(ring)


def _draw_panel(design: IndexingDesign, problem: IndexingProblem) -> Element:
    wheel, outside = _make_wheel(design), _make_outside(design)
    disc, rollers, center, reach = _make_crank(design)
    size = 0.5 * design.mechanism.roller_diameter
    around = np.concatenate(
        [wheel, outside, disc, _make_circle(reach + size, center), _enclose_drag_link(design.mechanism)]
    )
    view = Viewport.fit(
        Box.enclose(around), Box(BORDER, TOP, BORDER + get_drawing_width(), TOP + PANEL_HEIGHT), MARGIN, MARGIN
    )
    group = draw_panel(view.panel, "indexing")

    def shape(corners: Complex, fill: str, stroke: str, name: str) -> Element:
        return draw_polygon(
            [view.point(z) for z in corners], fill=fill, stroke=stroke, stroke_width=1.4, data_part=name
        )

    if len(outside):
        group.add(shape(outside, WHEEL_FILL, OUTPUT, "ring"))
    group.add(shape(wheel, "#fff" if len(outside) else WHEEL_FILL, OUTPUT, "wheel"))
    if design.mechanism.bore > 0.0:
        group.add(draw_circle(view.point(0j), 0.5 * view.scale * design.mechanism.bore, fill="#fff", stroke=OUTPUT))
    group.add(
        draw_path(
            [np.array([view.point(z) for z in _make_circle(reach, center)])], stroke=GREY, stroke_dasharray="9 3 2 3"
        )
    )
    group.add(shape(disc, DISC_FILL, INPUT, "disc"))
    for roller in rollers:
        group.add(draw_line(view.point(center), view.point(roller), stroke=INPUT, stroke_width=3.0, stroke_opacity=0.4))
        group.add(draw_circle(view.point(roller), view.scale * size, fill="#fff", stroke=INPUT, stroke_width=1.6))
    for links in _place_links(design.mechanism, 0.0, 0.0):
        group.add(
            draw_path(
                [np.array([view.point(z) for z in links])], stroke=COUPLER, stroke_width=2.4, data_part="drag_link"
            )
        )
        group.add(draw_circle(view.point(complex(links[0])), 3.0, fill=GROUND))
    for axis in (0j, center):
        group.add(draw_circle(view.point(axis), 3.0, fill=GROUND))
    return group.add(draw_scale_bar(view, problem.length_unit)[0])


def write_indexing_dxf(design: IndexingDesign, problem: IndexingProblem, title: str) -> str:
    """Write wheel and crank as a DXF document (R2010): a plane wheel of true lines and arcs."""
    mechanism, letters = design.mechanism, LETTER_HEIGHT * design.metrics.size
    layers = {"WHEEL": (5, "CONTINUOUS"), "CRANK": (3, "CONTINUOUS"), "CENTRES": (7, "CENTER")}
    document = dxf.create_drawing(title or _name(design), problem.length_unit, layers | {"TEXT": (7, "CONTINUOUS")})
    space = document.modelspace()
    disc, rollers, center, reach = _make_crank(design)
    if isinstance(mechanism, GenevaMechanism):
        _add_true_wheel(space, mechanism)
    else:
        dxf.add_outline(space, (complex(z) for z in _make_wheel(design)), "WHEEL")
    if mechanism.bore > 0.0:
        dxf.add_circle(space, 0j, 0.5 * mechanism.bore, "WHEEL")
    outside = _make_outside(design)
    if len(outside):
        dxf.add_circle(space, 0j, float(abs(outside[0])), "WHEEL")
    dxf.add_outline(space, (complex(z) for z in disc), "CRANK")
    for roller in rollers:
        dxf.add_circle(space, roller, 0.5 * mechanism.roller_diameter, "CRANK")
    for links in _place_links(mechanism, 0.0, 0.0):
        for first, last in pairwise(links):
            dxf.add_line(space, complex(first), complex(last), "CRANK")
        dxf.add_cross(space, complex(links[0]), 2.0 * letters, "CENTRES")
    dxf.add_circle(space, center, reach, "CENTRES")
    dxf.add_cross(space, 0j, 2.0 * letters, "CENTRES")
    for n, (name, value) in enumerate(_list_dimensions(design, problem)):
        dxf.add_words(space, complex(0.0, -0.7 * design.metrics.size - 1.6 * n * letters), f"{name} {value}", letters)
    return dxf.write_document(document)


def _add_true_wheel(space: Modelspace, mechanism: GenevaMechanism) -> None:
    """Add a plane wheel made of lines and arcs, as a roller enters."""
    internal = mechanism.type == "geneva_internal"
    step, half_slot, reach = math.pi / mechanism.stations, 0.5 * mechanism.slot_width, mechanism.wheel_radius
    # Corner between the slot's side and the rim.
    mouth = complex(math.sqrt(reach**2 - half_slot**2), half_slot)
    end = complex(mechanism.slot_end_radius)
    c, lock = mechanism.center_distance, mechanism.locking_arc_radius
    # Angle at which the locking arc meets the rim, by the law of cosines.
    beside = step - math.acos((reach**2 + c**2 - lock**2) / (2.0 * reach * c))
    corner = reach * np.exp(1j * beside)
    for k in range(mechanism.stations):
        turn = complex(np.exp(1j * step * (2 * k + (-1.0 if internal else 1.0))))
        for side in (mouth, mouth.conjugate()):
            dxf.add_line(space, turn * complex(end.real, side.imag), turn * side, "WHEEL")
        ends = (
            (end - 1j * half_slot, end + 1j * half_slot) if internal else (end + 1j * half_slot, end - 1j * half_slot)
        )
        dxf.add_arc(space, turn * end, half_slot, turn * ends[0], turn * ends[1], "WHEEL")
        dxf.add_arc(space, 0j, reach, turn * mouth, turn * corner, "WHEEL")
        dxf.add_arc(space, 0j, reach, turn * corner.conjugate(), turn * mouth.conjugate(), "WHEEL")
        # A ring's arc is the far side of its circle, from the corner of this slot; another wheel's is the near side.
        ends = corner, corner.conjugate() * np.exp(2j * step)
        first, last = ends if internal else ends[::-1]
        dxf.add_arc(space, turn * c * np.exp(1j * step), lock, turn * first, turn * last, "WHEEL")


def draw_indexing_animation(design: IndexingDesign, problem: IndexingProblem, title: str) -> bytes:
    """Draw one turn of the crank as GIF."""
    mechanism = design.mechanism
    course = build_drive(mechanism)
    wheel, outside = _make_wheel(design), _make_outside(design)
    disc, rollers, center, reach = _make_crank(design)
    sense = -1.0 if mechanism.type == "geneva_external" else 1.0
    turns = 2.0 * math.pi * np.arange(TURN_FRAMES) / TURN_FRAMES
    turned = course.wheel_motion(turns, mechanism.rollers).s
    cranks = course.from_entry(turns).s
    size = 0.5 * mechanism.roller_diameter

    def make_frames() -> Iterator[list[Stroke]]:
        for driven, crank, by in zip(turns, cranks, turned, strict=True):
            arm = np.exp(1j * crank)
            strokes = [Stroke(outside, OUTPUT, 1.4, True, WHEEL_FILL)] if len(outside) else []
            inside = "#ffffff" if len(outside) else WHEEL_FILL
            strokes.append(Stroke(wheel * np.exp(1j * sense * by), OUTPUT, 1.4, True, inside))
            strokes.append(Stroke(center + (disc - center) * arm, INPUT, 1.4, True, DISC_FILL))
            for one in rollers:
                strokes.append(
                    Stroke(make_circle(complex(center + (one - center) * arm), size), INPUT, 1.6, True, "#ffffff")
                )
            strokes += [Stroke(links, COUPLER, 2.0) for links in _place_links(mechanism, float(driven), float(crank))]
            yield strokes

    around = np.concatenate(
        [
            _make_circle(float(np.abs(wheel).max())),
            outside,
            _make_circle(reach + size, center),
            _enclose_drag_link(mechanism),
        ]
    )
    return draw_gif(make_frames(), Box.enclose(around))


def write_indexing_table(design: IndexingDesign, problem: IndexingProblem, title: str) -> str:
    """Write the program of an index with torque and pin force."""
    program, course = design.program, design.course
    columns = {
        "crank_deg": program.angle,
        "s_deg": program.s,
        "v": program.v,
        "a": program.a,
        "j": program.j,
        "wheel_torque": course.wheel_torque,
        "drive_torque": course.drive_torque,
        "pin_force": course.pin_force,
    }
    return write_table(columns, (list(row) for row in zip(*columns.values(), strict=True)))
