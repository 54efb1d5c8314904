"""The sheets of cams: the drawing with its key, tables, diagrams over the cam angle below; a barrel cam unrolled."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from service.render.cam.scene import CamScene
from service.render.cam.view import (
    LINE_STYLES,
    MARGIN,
    MARGIN_BELOW,
    STATION_RADIUS,
    draw_barrel_panel,
    draw_cam_panel,
    find_barrel_box,
)
from service.render.checks import describe_failures, describe_verdict, make_checks_block
from service.render.outline import list_entries
from service.render.page import blocks
from service.render.page.blocks import Block
from service.render.page.diagrams import Diagram
from service.render.page.numbers import MISSING_VALUE, format_length
from service.render.page.sheet import (
    BORDER,
    GUTTER,
    INNER_WIDTH,
    TOP,
    UNIT_NAMES,
    arrange_columns,
    get_drawing_width,
    stack_blocks,
    write_sheet,
)
from service.render.page.svg import (
    Box,
    Element,
    clean_text,
    draw_circle,
    draw_line,
    draw_text,
    estimate_text_width,
    make_element,
)
from service.render.page.symbols import COUPLER, CURVE, GREY, INK, INPUT, OUTPUT, TARGET_COLOUR
from synthesis.kinds.cam.design import BarrelCamDesign, CamDesign, CamFollower, CamMechanism, ProgramTable
from synthesis.kinds.cam.problem import CamProblem

DRAWING_HEIGHT, DIAGRAM_HEIGHT, KEY_HEIGHT = 620.0, 172.0, 30.0
"""Heights of the drawing, of a diagram and of the key below the drawing, pixels."""

BARREL_HEIGHTS = 240.0, 620.0
"""Minimum and maximum height of the drawing of a groove, pixels."""

VERTICAL_GAPS = 12.0, 4.0, 8.0
"""Space above tables below a drawing, above the diagrams below these, and between diagrams, pixels."""

SAMPLE_LENGTH, KEY_FONT_SIZE, KEY_GAP, KEY_HALF_HEIGHT = 20.0, 10.0, 9.0, 4.0
"""Dimensions of the key: length of a sample, font size, space between entries, half height of letters; pixels."""

SEGMENT_COLUMNS = (0.06, 0.09, 0.58, 0.72, 0.86, 1.0)
"""Right ends of the columns of the table of segments, shares of its width; the left end for the column of words."""

FOLLOWER_NAMES = {
    "translating_roller": "translating roller follower",
    "oscillating_roller": "oscillating roller follower",
    "translating_flat": "translating flat-faced follower",
    "oscillating_flat": "oscillating flat-faced follower",
    "barrel_roller": "roller along the axis",
}

ROTATION_NAMES = {"ccw": "counter-clockwise", "cw": "clockwise"}

CURVE_FIELDS = {"profile", "outer_wall", "lower_wall", "upper_wall", "pitch_curve", "program"}
"""Fields of a mechanism that are drawn, not listed."""

TITLES = {
    "size": "maximum radius",
    "max pressure angle rise": "pressure angle, rise",
    "max pressure angle fall": "pressure angle, fall",
    "min convex radius": "minimum convex radius",
    "min concave radius": "minimum concave radius",
    "min radius": "minimum radius of the pitch curve",
    "curvature ratio": "pitch curve : roller radius",
    "face width": "contact sweeps on the face",
    "groove width": "width of the groove",
    "length": "length along the axis",
    "frequency ratio": "natural frequency : speed",
}
"""Titles of quantities whose field names are too terse."""


def draw_cam_sheet(design: CamDesign, problem: CamProblem, title: str) -> str:
    """Draw a cam design as a complete SVG document."""
    scene, unit = CamScene(design.mechanism), problem.length_unit
    # Roller cams give the prime radius; derive the base radius.
    base = (
        []
        if design.mechanism.base_radius is not None
        else [("base radius", f"{format_length(scene.base_radius)} {unit}")]
    )
    tables, y = stack_blocks(
        [
            _list_dimensions(design, problem, base),
            _list_segments(design),
            make_checks_block(design.verification, problem),
            *_list_metrics(design, problem),
        ]
    )
    # With two cams the key is wider than the drawing, and is placed below the tables.
    height = max(DRAWING_HEIGHT, y - TOP - (KEY_HEIGHT if scene.second is None else 0.0))
    drawn = draw_cam_panel(scene, Box(BORDER, TOP, BORDER + get_drawing_width(), TOP + height), unit)
    top = max(TOP + height + KEY_HEIGHT, y)
    diagrams, bottom = _draw_two_columns(_make_diagrams(design, problem, scene), top, design)
    parts = [*tables, drawn, _draw_key(scene, TOP + height + 18.0), *diagrams]
    return write_sheet(
        title or "Cam", _describe_cam("Cam", design, unit), _describe_drawing(design, unit), parts, bottom
    )


def draw_barrel_sheet(design: BarrelCamDesign, problem: CamProblem, title: str) -> str:
    """Draw a barrel cam design as a complete SVG document."""
    mechanism, unit = design.mechanism, problem.length_unit
    shown, (least, greatest) = find_barrel_box(mechanism), BARREL_HEIGHTS
    needed = (INNER_WIDTH - 2.0 * MARGIN) / shown.width * shown.height + 2.0 * MARGIN + MARGIN_BELOW
    bottom = TOP + min(max(needed, least), greatest)
    drawn = draw_barrel_panel(mechanism, Box(BORDER, TOP, BORDER + INNER_WIDTH, bottom), unit)
    columns = (
        [_list_dimensions(design, problem), _list_segments(design)],
        [make_checks_block(design.verification, problem)],
        _list_metrics(design, problem),
    )
    room = (INNER_WIDTH - 2.0 * GUTTER) / len(columns)
    tables, bottom = arrange_columns(columns, [room] * len(columns), bottom + VERTICAL_GAPS[0])
    table = mechanism.program
    diagrams = _make_motion_diagrams(table, unit, unit)
    pressure = np.degrees(np.arctan(np.abs(table.v) / mechanism.cylinder_radius))
    degrees, limit = np.append(np.asarray(table.angle), 360.0), problem.limits.pressure_angle
    heading = "pressure angle (degrees)"
    diagrams.append(Diagram(heading, "pressure_angle", degrees, _close_turn(pressure), TARGET_COLOUR, (limit,)))
    parts, bottom = _draw_two_columns(diagrams, bottom + VERTICAL_GAPS[1], design)
    described = (
        f"Unrolled groove of a barrel cam, cylinder radius {mechanism.cylinder_radius:.6g} {unit}, "
        f"turning {ROTATION_NAMES[mechanism.rotation]}; {len(design.segments)} segments. "
        f"{describe_failures(design.verification)}"
    )
    words = _describe_cam("Barrel cam, unrolled,", design, unit)
    return write_sheet(title or "Barrel cam", words, described, [drawn, *tables, *parts], bottom)


def _describe_cam(name: str, design: CamDesign | BarrelCamDesign, unit: str) -> str:
    turns = f"turns {ROTATION_NAMES[design.mechanism.rotation]}"
    follower = FOLLOWER_NAMES[design.mechanism.follower.type]
    return f"{name} with {follower}, {turns}; lengths in {UNIT_NAMES[unit]}; {describe_verdict(design.verification)}"


def _describe_drawing(design: CamDesign, unit: str) -> str:
    mechanism = design.mechanism
    name, radius = (
        ("base", mechanism.base_radius) if mechanism.prime_radius is None else ("prime", mechanism.prime_radius)
    )
    return (
        f"Drawing of a cam with a {FOLLOWER_NAMES[mechanism.follower.type]}, {name} radius {radius:.6g} {unit}, "
        f"turning {ROTATION_NAMES[mechanism.rotation]}; {len(design.segments)} segments. "
        f"{describe_failures(design.verification)}"
    )


def _list_dimensions(
    design: CamDesign | BarrelCamDesign, problem: CamProblem, derived: Sequence[tuple[str, str]] = ()
) -> Block:
    mechanism, follower = design.mechanism, design.mechanism.follower
    rows = [("follower", FOLLOWER_NAMES[follower.type])]
    rows += list_entries(mechanism, problem, {"type", "follower", "rotation", "second", *CURVE_FIELDS})
    rows += derived
    rows += list_entries(follower, problem, {"type", "sense", "offset"})
    if isinstance(follower, CamFollower) and follower.offset is not None:
        # An offset computed by the solver may be a rounding error of zero.
        size = max(mechanism.pitch_curve.x)
        rows.append(("offset", f"{format_length(follower.offset, size)} {problem.length_unit}"))
    if isinstance(follower, CamFollower) and follower.sense is not None:
        rows.append(("arm swings outward", "with the cam" if follower.sense == 1 else "against the cam"))
    if isinstance(mechanism, CamMechanism) and mechanism.second is not None:
        second = list_entries(mechanism.second, problem, {"follower", *CURVE_FIELDS})
        rows += [(f"second cam, {name}" if "prime" in name else name, value) for name, value in second]
    rows.append(("rotation", ROTATION_NAMES[mechanism.rotation]))
    rows.append(("points of a curve", f"{len(mechanism.pitch_curve.x)}"))
    return blocks.make_rows("Dimensions", rows)


def _list_segments(design: CamDesign | BarrelCamDesign) -> Block:
    """Return the block of all segments with law, place and peaks."""
    lines = []
    for k, segment in enumerate(design.segments, 1):
        law = clean_text(segment.law.replace("_", " "))
        place = f"{format_length(segment.start, digits=4)}–{format_length(segment.start + segment.angle, digits=4)}°"
        cells = [
            f"{k}",
            law if segment.motion.replace("_", " ") == law else f"{segment.motion}, {law}",
            place,
            format_length(segment.displacement[1], design.metrics.lift, digits=4),
            format_length(segment.peak_velocity, digits=3),
            format_length(segment.peak_acceleration, digits=3),
        ]
        lines.append(blocks.TableRow(cells))
    heads = ["", "motion and law", "cam angle", "to", "peak v", "peak a"]
    return blocks.make_table("Segments", heads, lines, SEGMENT_COLUMNS, worded=1)


def _list_metrics(design: CamDesign | BarrelCamDesign, problem: CamProblem) -> list[Block]:
    """Return the blocks of measured quantities, the gap to the best motion, and forces if the problem has a load."""
    metrics, optimality = design.metrics, design.optimality
    gap = MISSING_VALUE if optimality.gap is None else f"{100.0 * optimality.gap:.3g} %"
    rows = list_entries(metrics, problem, {"forces"}, TITLES)
    rows.append((f"{clean_text(optimality.criterion.replace('_', ' '))}, above its bound", gap))
    measured = [blocks.make_rows("Metrics", rows)]
    if metrics.forces is not None:
        # The warning is a sentence, too long for a row; the report and the JSON contain it.
        measured.append(blocks.make_rows("Forces", list_entries(metrics.forces, problem, {"warning"}, TITLES)))
    return measured


def _draw_two_columns(
    shown: list[Diagram], top: float, design: CamDesign | BarrelCamDesign
) -> tuple[list[Element], float]:
    """Draw diagrams in two columns with the joints of the segments marked; return them and the y below."""
    joints = [segment.start for segment in design.segments]
    wide, step = 0.5 * (INNER_WIDTH - GUTTER), DIAGRAM_HEIGHT + VERTICAL_GAPS[2]
    parts = []
    for k, diagram in enumerate(shown):
        x, low = BORDER + (k % 2) * (wide + GUTTER), top + (k // 2) * step
        parts.append(diagram.draw(Box(x, low, x + wide, low + DIAGRAM_HEIGHT), joints))
    return parts, top + math.ceil(len(shown) / 2) * step


def _close_turn(values: object) -> np.ndarray:
    """Return values over a turn, with the first repeated at the end."""
    over_turn = np.asarray(values, dtype=np.float64)
    return np.append(over_turn, over_turn[0])


def _make_motion_diagrams(table: ProgramTable, lift: str, rate: str) -> list[Diagram]:
    """Return diagrams of displacement and its derivatives from the program's table."""
    degrees = np.append(np.asarray(table.angle), 360.0)
    return [
        Diagram(f"displacement s ({lift})", "s", degrees, _close_turn(table.s), INPUT),
        Diagram(f"velocity v ({rate}/rad)", "v", degrees, _close_turn(table.v), OUTPUT),
        Diagram(f"acceleration a ({rate}/rad²)", "a", degrees, _close_turn(table.a), COUPLER),
        Diagram(f"jerk j ({rate}/rad³)", "j", degrees, _close_turn(table.j), CURVE),
    ]


def _make_diagrams(design: CamDesign, problem: CamProblem, scene: CamScene) -> list[Diagram]:
    """Return diagrams of displacement and derivatives, and of pressure angle and curvature measured on the profile."""
    table, unit = design.mechanism.program, problem.length_unit
    lift, rate = ("degrees", "rad") if scene.oscillating else (unit, unit)
    degrees = np.append(scene.angle, 360.0)
    shown = _make_motion_diagrams(table, lift, rate)
    contact = scene.contact
    pressure = np.degrees(contact.pressure_angle)
    # The pressure angle of a central flat face is constant.
    if scene.roller or design.mechanism.follower.face_offset:
        limits = (problem.limits.pressure_angle,) if scene.roller else ()
        words = "pressure angle (degrees), measured on the profile"
        shown.append(Diagram(words, "pressure_angle", degrees, _close_turn(pressure), TARGET_COLOUR, limits))
    # Straight pieces have infinite radius, thus zero curvature.
    with np.errstate(divide="ignore"):
        curvature = _close_turn(1.0 / contact.radius)
    words = f"curvature of the profile (1/{unit}), convex positive"
    shown.append(Diagram(words, "curvature", degrees, curvature, INK))
    return shown


def _draw_key(scene: CamScene, y: float) -> Element:
    """Draw the key to the line styles."""
    group, x, middle = make_element("g", data_key="true"), BORDER, y - KEY_HALF_HEIGHT
    for name, style in LINE_STYLES.items():
        if scene.roller is None and name in ("pitch curve", "prime circle"):
            continue
        if name == "second cam" and scene.second is None:
            continue
        if name == "outer wall":
            # It has the same line style as the profile.
            continue
        group.add(draw_line(complex(x, middle), complex(x + SAMPLE_LENGTH, middle), **style))
        group.add(draw_text(x + SAMPLE_LENGTH + 4.0, y, name, KEY_FONT_SIZE, fill=GREY))
        x += SAMPLE_LENGTH + 4.0 + estimate_text_width(name, KEY_FONT_SIZE) + KEY_GAP
    group.add(
        draw_circle(complex(x + 3.0, middle), STATION_RADIUS, fill=CURVE),
        draw_text(x + 8.0, y, "cam angle", KEY_FONT_SIZE, fill=GREY),
    )
    return group
