"""Piston engines: the sheet with end view, crankshaft and torque; the DXF drawing of both views; the CSV table.

=========  ============================================================
layer      content
=========  ============================================================
CYLINDERS  axes of the cylinders, viewed from the front
PISTONS    pistons and rods, viewed from the front, with the first throw up
CRANK      the throws, viewed from the front, and the shaft from the side
TEXT       numbers of the cylinders
=========  ============================================================
"""

from __future__ import annotations

import cmath
import math
from itertools import pairwise

import numpy as np

from service.render.checks import describe_verdict, make_checks_block
from service.render.outline import list_entries
from service.render.page import blocks, dxf
from service.render.page.diagrams import Diagram
from service.render.page.numbers import format_angle, format_length
from service.render.page.sheet import BORDER, TOP, draw_panel, get_drawing_width, stack_blocks, write_sheet
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    draw_circle,
    draw_line,
    draw_path,
    draw_polygon,
    draw_text,
    make_element,
)
from service.render.page.symbols import COUPLER, CURVE, GREY, GROUND, INK, INPUT, OUTPUT, draw_scale_bar
from service.render.page.table import write_table
from service.units import list_symbols
from synthesis.kinds.engine.design import EngineDesign, EngineMechanism
from synthesis.kinds.engine.problem import EngineProblem
from synthesis.model.dimension import FORCE, TORQUE

PANEL_HEIGHT, DIAGRAM_HEIGHT, MARGIN = 400.0, 175.0, 26.0
"""Heights of the panel and of each diagram, and margin around the content, pixels."""

LETTER_SIZE = 11.0
"""Font size of the numbers of cylinders, pixels."""

MAX_ORDERS = 6
"""Maximum number of firing orders on the sheet."""

PISTON_HALF_WIDTH, MIN_UPRIGHT = 0.72, 0.25
"""Half a piston's width in crank radii; minimum vertical component of an axis that is shown in the side view."""

COLUMN_ENDS = (0.1, 0.3, 0.5, 0.7, 0.85, 1.0)
"""Right ends of the columns of the table of harmonics."""


def draw_engine_sheet(design: EngineDesign, problem: EngineProblem, title: str) -> str:
    """Draw the engine from the front, its shaft from the side, torque, shaking force and tables as an SVG document."""
    mechanism, units = design.mechanism, list_symbols(problem)
    view = Viewport.fit(
        _find_box(mechanism), Box(BORDER, TOP, BORDER + get_drawing_width(), TOP + PANEL_HEIGHT), MARGIN, MARGIN
    )
    parts = [_draw_panel(mechanism, view, problem.length_unit)]
    low = TOP + PANEL_HEIGHT + 10.0
    for diagram in _make_diagrams(design, units[TORQUE], units[FORCE]):
        parts.append(diagram.draw(Box(BORDER, low, BORDER + get_drawing_width(), low + DIAGRAM_HEIGHT)))
        low += DIAGRAM_HEIGHT
    tables, bottom = stack_blocks(_make_tables(design, problem))
    order = "-".join(map(str, design.firing.orders[0].order))
    count = len(mechanism.cylinders)
    words = (
        f"{mechanism.layout.capitalize()} engine of {count} cylinders, firing {order}; "
        f"{describe_verdict(design.verification)}"
    )
    described = (
        "A piston engine from the front, with its throws, rods and pistons by bank, and its crankshaft from the side."
    )
    return write_sheet(title or "Piston engine", words, described, [*parts, *tables], max(low, bottom))


def _make_diagrams(design: EngineDesign, torque: str, force: str) -> list[Diagram]:
    course = design.course
    if course is None:
        return []
    at = np.array(course.angle)
    # Torque on the crankshaft before friction and load.
    given = np.array(course.gas_torque) + np.array(course.inertia_torque)
    shaking = np.hypot(course.shaking_x, course.shaking_y)
    return [
        Diagram(f"Torque of gas and inertia ({torque})" if torque else "Torque", "torque", at, given, INPUT),
        Diagram(f"Shaking force ({force})" if force else "Shaking force", "shaking", at, shaking, OUTPUT),
    ]


def _make_tables(design: EngineDesign, problem: EngineProblem) -> list[blocks.Block]:
    mechanism, unit, firing = design.mechanism, problem.length_unit, design.firing
    built = [
        ("radius of the crank", f"{format_length(mechanism.crank)} {unit}"),
        ("rod", f"{format_length(mechanism.rod)} {unit}"),
        ("throws", ", ".join(format_angle(phase) for phase in mechanism.throws)),
        ("moments of harmonics, forces", f"about the {problem.moment_about.replace('_', ' ')}"),
        ("moments of metrics", "about the middle"),
    ]
    orders = [(f"order {k}", "-".join(map(str, order.order))) for k, order in enumerate(firing.orders[:MAX_ORDERS], 1)]
    lines = [
        blocks.TableRow(
            [
                str(harmonic.order),
                format_length(harmonic.force.forward, digits=4),
                format_length(harmonic.force.backward, digits=4),
                format_length(harmonic.moment.forward, digits=4),
                format_length(harmonic.moment.backward, digits=4),
                format_length(harmonic.torque, digits=4),
            ]
        )
        for harmonic in design.harmonics
    ]
    heads = ["k", "force +", "force −", "moment +", "moment −", "torque"]
    tables = [
        blocks.make_rows("Engine", built),
        blocks.make_rows("Firing", [("unevenness", format_angle(firing.unevenness)), *orders]),
        blocks.make_table("Harmonics, with the crank and against it", heads, lines, COLUMN_ENDS),
        make_checks_block(design.verification, problem),
        blocks.make_rows("Metrics", list_entries(design.metrics, problem, {"forces"})),
    ]
    if design.metrics.forces is not None:
        tables.append(blocks.make_rows("Greatest forces", list_entries(design.metrics.forces, problem)))
    return tables


def _measure_reach(mechanism: EngineMechanism) -> float:
    """Return the distance from the shaft to beyond a piston at top dead centre."""
    return mechanism.rod + 2.1 * mechanism.crank


def _find_box(mechanism: EngineMechanism) -> Box:
    """Return the box around the end view, whose shaft is the origin, and the crankshaft at its right."""
    reach = _measure_reach(mechanism)
    tips = [1j * reach * cmath.rect(1.0, math.radians(cylinder.axis)) for cylinder in mechanism.cylinders]
    shaft = _trace_shaft(mechanism)
    around = np.array([*tips, *shaft, complex(-mechanism.crank, -mechanism.crank)])
    return Box.enclose(around).grow(0.3 * mechanism.crank)


def _trace_shaft(mechanism: EngineMechanism) -> list[complex]:
    """Return the line of the crankshaft in side view, to the right of the end view."""
    reach, step = _measure_reach(mechanism), 1.6 * mechanism.crank
    left = 1.2 * reach
    points = [complex(left)]
    for n, phase in enumerate(mechanism.throws):
        # The side view shows the vertical component of each throw.
        high = 1j * mechanism.crank * math.cos(math.radians(phase))
        near, far = left + step * (n + 0.3), left + step * (n + 0.9)
        points += [complex(near), near + high, far + high, complex(far)]
    return [*points, complex(left + step * (len(mechanism.throws) + 0.2))]


def _place_throws(mechanism: EngineMechanism) -> list[complex]:
    """Return the crank pins from the front with the first throw up; lagging throws follow clockwise."""
    first = mechanism.throws[0]
    return [1j * cmath.rect(mechanism.crank, math.radians(first - phase)) for phase in mechanism.throws]


def _place_pistons(mechanism: EngineMechanism) -> list[tuple[int, complex, complex, complex]]:
    """Return for each cylinder its number, crank pin, piston pin, and axis direction, with the first throw up.

    The distance of the piston from the shaft is r cos θ + √(l² − r² sin² θ) (Norton 13.1).
    """
    pins, listed = _place_throws(mechanism), []
    for cylinder in mechanism.cylinders:
        way, pin = 1j * cmath.rect(1.0, math.radians(cylinder.axis)), pins[cylinder.throw - 1]
        # Rotate so that the cylinder's axis is the real axis.
        turned = pin * way.conjugate()
        piston = (turned.real + math.sqrt(mechanism.rod**2 - turned.imag**2)) * way
        listed.append((cylinder.number, pin, piston, way))
    return listed


def _make_crown(mechanism: EngineMechanism, piston: complex, way: complex) -> list[complex]:
    """Return the corners of a piston around its pin."""
    half = PISTON_HALF_WIDTH * mechanism.crank
    return [piston + (along + 1j * side) * half * way for along, side in ((-0.7, 1), (-0.7, -1), (0.8, -1), (0.8, 1))]


def _draw_moving(mechanism: EngineMechanism, view: Viewport) -> list[Element]:
    """Draw rods and pistons from the front; of those that coincide only the foremost."""
    drawn, seen = [], set[tuple[float, float]]()
    for number, pin, piston, way in _place_pistons(mechanism):
        place = round(piston.real, 6), round(piston.imag, 6)
        # Cylinders behind one another coincide in the end view.
        if place in seen:
            continue
        seen.add(place)
        corners = [view.point(corner) for corner in _make_crown(mechanism, piston, way)]
        at = view.point(piston)
        drawn.append(
            draw_polygon(
                corners, fill="#fff", fill_opacity=0.75, stroke=OUTPUT, stroke_width=1.6, data_piston=str(number)
            )
        )
        drawn.append(draw_line(view.point(pin), at, stroke=COUPLER, stroke_width=3.0, stroke_linecap="round"))
        drawn.append(draw_circle(at, 3.0, fill="#fff", stroke=OUTPUT, stroke_width=1.4))
    return drawn


def _draw_side_pistons(mechanism: EngineMechanism, view: Viewport) -> list[Element]:
    """Draw rods and pistons of upright cylinders from the side; two on one throw are side by side."""
    left, step = 1.2 * _measure_reach(mechanism), 1.6 * mechanism.crank
    drawn = []
    throws = {cylinder.number: cylinder.throw for cylinder in mechanism.cylinders}
    for number, pin, piston, way in _place_pistons(mechanism):
        # Nearly horizontal cylinders have no useful side view.
        if way.imag < MIN_UPRIGHT:
            continue
        on = [other for other, throw in throws.items() if throw == throws[number]]
        # Pistons on one throw share its width.
        half = 0.36 * step / len(on)
        x = left + step * (throws[number] - 0.4) + half * (2 * on.index(number) + 1 - len(on))
        high = PISTON_HALF_WIDTH * mechanism.crank * way.imag
        corners = [
            complex(x + a * half, piston.imag + b * high) for a, b in ((-1, -0.7), (1, -0.7), (1, 0.8), (-1, 0.8))
        ]
        shown = [view.point(corner) for corner in corners]
        drawn.append(
            draw_line(
                view.point(complex(x, pin.imag)), view.point(complex(x, piston.imag)), stroke=COUPLER, stroke_width=2.4
            )
        )
        drawn.append(draw_polygon(shown, fill="#fff", stroke=OUTPUT, stroke_width=1.4, data_side=str(number)))
    return drawn


def _draw_panel(mechanism: EngineMechanism, view: Viewport, unit: str) -> Element:
    group = draw_panel(view.panel, "engine")
    middle, reach = view.point(0j), _measure_reach(mechanism)
    numbers: dict[float, list[int]] = {}
    for cylinder in mechanism.cylinders:
        # Cylinders of one bank share an axis.
        numbers.setdefault(cylinder.axis, []).append(cylinder.number)
    half = PISTON_HALF_WIDTH * mechanism.crank
    for axis, on in numbers.items():
        way = 1j * cmath.rect(1.0, math.radians(axis))
        low, high = mechanism.rod - mechanism.crank, mechanism.rod + mechanism.crank
        group.add(draw_line(middle, view.point(reach * way), stroke=GREY, stroke_width=0.8, stroke_dasharray="9 3 2 3"))
        for side in (-1j * half * way, 1j * half * way):
            walls = view.point(low * way + side), view.point(high * way + side)
            group.add(draw_line(*walls, stroke=GROUND, stroke_width=1.6))
        at = view.point(reach * way)
        words = ", ".join(map(str, on))
        group.add(draw_text(at.real, at.imag, words, LETTER_SIZE, text_anchor="middle", fill=INK, data_bank=words))
    group.add(*_draw_moving(mechanism, view), *_draw_side_pistons(mechanism, view))
    for n, pin in enumerate(_place_throws(mechanism), 1):
        at = view.point(pin)
        group.add(draw_line(middle, at, stroke=INPUT, stroke_width=4.0, stroke_opacity=0.5, data_throw=str(n)))
        group.add(draw_circle(at, 4.0, fill="#fff", stroke=INPUT, stroke_width=1.6))
    group.add(draw_circle(middle, 4.0, fill=GROUND))
    points = np.array([view.point(point) for point in _trace_shaft(mechanism)])
    group.add(draw_path([points], stroke=COUPLER, stroke_width=3.0, stroke_linejoin="round"))
    group.add(make_element("g", *_draw_shaft_numbers(mechanism, view), fill=CURVE))
    return group.add(draw_scale_bar(view, unit)[0])


def _draw_shaft_numbers(mechanism: EngineMechanism, view: Viewport) -> list[Element]:
    """Draw the numbers of each throw's cylinders below the side view of the shaft."""
    left, step = 1.2 * _measure_reach(mechanism), 1.6 * mechanism.crank
    listed = []
    for n in range(len(mechanism.throws)):
        on = [str(cylinder.number) for cylinder in mechanism.cylinders if cylinder.throw == n + 1]
        at = view.point(complex(left + step * (n + 0.6), -1.5 * mechanism.crank))
        listed.append(draw_text(at.real, at.imag, ", ".join(on), LETTER_SIZE, text_anchor="middle"))
    return listed


def write_engine_dxf(design: EngineDesign, problem: EngineProblem, title: str) -> str:
    """Write end view and shaft as a DXF document (R2010)."""
    mechanism = design.mechanism
    layers = {
        "CYLINDERS": (7, "CENTER"),
        "PISTONS": (3, "CONTINUOUS"),
        "CRANK": (5, "CONTINUOUS"),
        "TEXT": (7, "CONTINUOUS"),
    }
    document = dxf.create_drawing(title or "Piston engine", problem.length_unit, layers)
    space, letters = document.modelspace(), 0.25 * mechanism.crank
    for axis in sorted({cylinder.axis for cylinder in mechanism.cylinders}):
        tip = 1j * _measure_reach(mechanism) * cmath.rect(1.0, math.radians(axis))
        on = ", ".join(str(cylinder.number) for cylinder in mechanism.cylinders if cylinder.axis == axis)
        dxf.add_line(space, 0j, tip, "CYLINDERS")
        dxf.add_words(space, tip * 1.05, on, letters)
    dxf.add_circle(space, 0j, mechanism.crank, "CRANK")
    for _, pin, piston, way in _place_pistons(mechanism):
        corners = _make_crown(mechanism, piston, way)
        dxf.add_line(space, pin, piston, "PISTONS")
        for start, end in pairwise([*corners, corners[0]]):
            dxf.add_line(space, start, end, "PISTONS")
    for pin in _place_throws(mechanism):
        dxf.add_line(space, 0j, pin, "CRANK")
        dxf.add_circle(space, pin, 0.15 * mechanism.crank, "CRANK")
    points = _trace_shaft(mechanism)
    for start, end in pairwise(points):
        dxf.add_line(space, start, end, "CRANK")
    return dxf.write_document(document)


def write_engine_table(design: EngineDesign, problem: EngineProblem, title: str) -> str:
    """Write torques, shaking force and pin forces over a cycle if known; otherwise the cylinders and their firing."""
    course = design.course
    if course is not None:
        columns = {name: getattr(course, name) for name in type(course).model_fields}
        return write_table(columns, (list(row) for row in zip(*columns.values(), strict=True)))
    order = design.firing.orders[0]
    fires = dict(zip(order.order, order.angles, strict=True))
    return write_table(
        ["cylinder", "throw", "axis_deg", "phase_deg", "place", "fires_deg"],
        (
            [one.number, one.throw, one.axis, one.phase, one.place, fires[one.number]]
            for one in design.mechanism.cylinders
        ),
    )
