"""The sheet of a barrel cam design: the groove unrolled, tables, diagrams over the cam angle."""

from __future__ import annotations

import math

import numpy as np

from service.render.cam.sheet import (
    ROTATIONS,
    closed,
    forces_block,
    in_two_columns,
    motion_diagrams,
    segments_block,
)
from service.render.cam.view import STYLES
from service.render.checks import checks, verdict
from service.render.page import blocks
from service.render.page.blocks import Block
from service.render.page.diagrams import Diagram
from service.render.page.labels import Labels
from service.render.page.numbers import angle, length
from service.render.page.sheet import COLUMN, EDGE, FULL, GUTTER, TOP, UNITS, sheet, stacked
from service.render.page.svg import (
    Box,
    Element,
    Viewport,
    circle,
    element,
    line,
    path,
)
from service.render.page.symbols import (
    CURVE,
    DEMANDED,
    GREY,
    PALE,
    scale_bar,
)
from synthesis.kinds.cam.design import BarrelCamDesign, BarrelCamMechanism
from synthesis.kinds.cam.mechanism import points_of
from synthesis.kinds.cam.problem import CamProblem

MARGIN, FOOT = 34.0, 26.0
"""Room in the panel around what is shown, and more of it below, pixels."""

LEAST_HEIGHT = 240.0
"""Height of the drawing at least, pixels."""

STATIONS = 30
"""Degrees between the cam angles that are written, and between the rollers that are drawn."""


def barrel_sheet(design: BarrelCamDesign, problem: CamProblem, title: str) -> str:
    """The drawing of a barrel cam design as a complete SVG document."""
    mechanism, unit = design.mechanism, problem.length_unit
    turn = math.tau * mechanism.cylinder_radius
    low, high = min(mechanism.lower_wall.y), max(mechanism.upper_wall.y)
    roller = mechanism.follower.roller_radius
    scale = (FULL - 2.0 * MARGIN) / (turn + 2.0 * roller)
    height = min(max(scale * (high - low) + 2.0 * MARGIN + FOOT, LEAST_HEIGHT), 620.0)
    parts = [_panel(mechanism, Box(EDGE, TOP, EDGE + FULL, TOP + height), unit)]
    bottom, left = TOP + height + 12.0, EDGE
    ends = [bottom]
    columns: list[list[Block]] = [
        [_dimensions(design, unit), segments_block(design)],
        [checks(design.verification, problem)],
        [_metrics(design), *([forces_block(design)] if design.metrics.forces else [])],
    ]
    room = (FULL - 2.0 * GUTTER) / 3.0
    for column in columns:
        drawn, y = stacked(column, left, bottom, min(room, COLUMN))
        parts += drawn
        ends.append(y)
        left += room + GUTTER
    table = mechanism.program
    shown = motion_diagrams(table, unit, unit)
    pressure = np.degrees(np.arctan(np.abs(table.v) / mechanism.cylinder_radius))
    degrees, limit = np.append(np.asarray(table.angle), 360.0), problem.limits.pressure_angle
    shown.append(Diagram("pressure angle (degrees)", "pressure_angle", degrees, closed(pressure), DEMANDED, (limit,)))
    diagrams, end = in_two_columns(shown, max(ends) + 4.0, [segment.start for segment in design.segments])
    words = f"Barrel cam, unrolled, turns {ROTATIONS[mechanism.rotation]}; lengths in {UNITS[unit]}"
    described = f"Unrolled groove of a barrel cam, cylinder radius {mechanism.cylinder_radius:.6g} {unit}"
    outcome = verdict(design.verification)
    parts += diagrams
    return sheet(title or "Barrel cam", f"{words}; {outcome}", f"{described}; {outcome}.", parts, end)


def _panel(mechanism: BarrelCamMechanism, box: Box, unit: str) -> Element:
    """Walls heavy, pitch curve dashed, the roller bold at cam angle 0 and thin at its other stations."""
    turn, roller = math.tau * mechanism.cylinder_radius, mechanism.follower.roller_radius
    low, high = min(mechanism.lower_wall.y), max(mechanism.upper_wall.y)
    viewport = Viewport.fit(Box(-roller, low, turn + roller, high), box, MARGIN, FOOT)
    labels = Labels(box)
    group = element("g", data_panel="barrel cam", fill="none")
    frame = {"x": box.left, "y": box.low, "width": box.width, "height": box.height}
    group.add(element("rect", **frame, fill="#fff", stroke=PALE, stroke_width=1.0))
    for x in (0.0, turn):
        ends = viewport.point(complex(x, low)), viewport.point(complex(x, high))
        group.add(line(*ends, data_part="seam", stroke=GREY, stroke_width=1.0, stroke_dasharray="11 3 2 3"))
    centre = points_of(mechanism.pitch_curve)
    around = np.array(mechanism.program.angle)
    rollers = element("g", data_part="other positions", **STYLES["other positions"])
    stations = element("g", data_part="cam angles")
    for degrees in range(0, 360, STATIONS):
        at = viewport.point(complex(centre[int(np.argmin(np.abs(around - degrees)))]))
        rollers.add(circle(at, viewport.scale * roller))
        stations.add(circle(at, 1.8, fill=CURVE))
        labels.place(at, angle(float(degrees), 1), 9.5, clearance=4.0, away=1j, optional=True, style={"fill": GREY})
    group.add(rollers)
    for part, curve, style in (
        ("lower wall", mechanism.lower_wall, "profile"),
        ("upper wall", mechanism.upper_wall, "profile"),
        ("pitch curve", mechanism.pitch_curve, "pitch curve"),
    ):
        points = points_of(curve)
        shown = viewport.shown(np.append(points, points[0] + turn))
        group.add(path(shown, data_part=part, **STYLES[style]))
    group.add(
        circle(viewport.point(complex(centre[0])), viewport.scale * roller, data_part="follower", **STYLES["follower"])
    )
    bar, _ = scale_bar(viewport, unit)
    return group.add(stations, bar, *labels.drawn)


def _dimensions(design: BarrelCamDesign, unit: str) -> Block:
    mechanism = design.mechanism
    entries = [
        ("cylinder radius", length(mechanism.cylinder_radius)),
        ("roller radius", length(mechanism.follower.roller_radius)),
        ("width of the groove", length(design.metrics.groove_width)),
        ("length along the axis", length(design.metrics.length)),
        ("rotation", ROTATIONS[mechanism.rotation]),
        ("points of each wall", f"{len(mechanism.lower_wall.x)}"),
    ]
    return blocks.rows(f"Dimensions ({unit})", entries)


def _metrics(design: BarrelCamDesign) -> Block:
    found = design.metrics
    peaks = (found.peak_velocity, found.peak_acceleration, found.peak_jerk)
    entries = [
        ("lift", length(found.lift)),
        ("pressure angle, rise", angle(found.max_pressure_angle_rise, 2)),
        ("pressure angle, fall", angle(found.max_pressure_angle_fall, 2)),
        ("least radius of the pitch curve", length(found.min_radius, digits=4)),
        ("pitch curve : roller radius", length(found.curvature_ratio, digits=4)),
        ("peak v, a, j (per radian)", ", ".join(length(value, digits=4) for value in peaks)),
    ]
    return blocks.rows("Metrics", entries)
