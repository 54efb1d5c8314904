"""The sheets of cams: the drawing with its key, tables, diagrams over the cam angle below; a barrel cam unrolled."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from service.render.cam.scene import CamScene
from service.render.cam.view import FOOT, MARGIN, STATION, STYLES, barrel_box, barrel_panel, panel
from service.render.checks import checks, outcome, verdict
from service.render.outline import entries
from service.render.page import blocks
from service.render.page.blocks import Block
from service.render.page.diagrams import Diagram
from service.render.page.numbers import NONE, length
from service.render.page.sheet import EDGE, FULL, GUTTER, TOP, UNITS, beside, in_columns, sheet, stacked
from service.render.page.svg import Box, Element, circle, clean, element, line, text, text_width
from service.render.page.symbols import COUPLER, CURVE, DEMANDED, GREY, INK, INPUT, OUTPUT
from synthesis.kinds.cam.design import BarrelCamDesign, CamDesign, CamFollower, CamMechanism, ProgramTable
from synthesis.kinds.cam.problem import CamProblem

DRAWING_HEIGHT, DIAGRAM_HEIGHT, KEY_HEIGHT = 620.0, 172.0, 30.0
"""Heights of the drawing, of a diagram and of the key below the drawing, pixels."""

BARREL_HEIGHTS = 240.0, 620.0
"""Minimum and maximum height of the drawing of a groove, pixels."""

APART = 12.0, 4.0, 8.0
"""Space above tables below a drawing, above the diagrams below these, and between diagrams, pixels."""

SAMPLE, KEY_SIZE, KEY_GAP, KEY_MIDDLE = 20.0, 10.0, 9.0, 4.0
"""Dimensions of the key: length of a sample, font size, space between entries, half height of letters; pixels."""

SEGMENT_COLUMNS = (0.06, 0.09, 0.58, 0.72, 0.86, 1.0)
"""Right ends of the columns of the table of segments, shares of its width; the left end for the column of words."""

FOLLOWERS = {
    "translating_roller": "translating roller follower",
    "oscillating_roller": "oscillating roller follower",
    "translating_flat": "translating flat-faced follower",
    "oscillating_flat": "oscillating flat-faced follower",
    "barrel_roller": "roller along the axis",
}

ROTATIONS = {"ccw": "counter-clockwise", "cw": "clockwise"}

CURVES = {"profile", "outer_wall", "lower_wall", "upper_wall", "pitch_curve", "program"}
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


def cam_sheet(design: CamDesign, problem: CamProblem, title: str) -> str:
    """Draw a cam design as a complete SVG document."""
    scene, unit = CamScene(design.mechanism), problem.length_unit
    # Roller cams give the prime radius; derive the base radius.
    base = [] if design.mechanism.base_radius is not None else [("base radius", f"{length(scene.base_radius)} {unit}")]
    tables, y = stacked(
        [
            _dimensions(design, problem, base),
            _segments(design),
            checks(design.verification, problem),
            *_measured(design, problem),
        ]
    )
    # With two cams the key is wider than the drawing, and is placed below the tables.
    height = max(DRAWING_HEIGHT, y - TOP - (KEY_HEIGHT if scene.second is None else 0.0))
    drawn = panel(scene, Box(EDGE, TOP, EDGE + beside(), TOP + height), unit)
    top = max(TOP + height + KEY_HEIGHT, y)
    diagrams, bottom = _in_two_columns(_diagrams(design, problem, scene), top, design)
    parts = [*tables, drawn, _key(scene, TOP + height + 18.0), *diagrams]
    return sheet(title or "Cam", _words("Cam", design, unit), _description(design, unit), parts, bottom)


def barrel_sheet(design: BarrelCamDesign, problem: CamProblem, title: str) -> str:
    """Draw a barrel cam design as a complete SVG document."""
    mechanism, unit = design.mechanism, problem.length_unit
    shown, (least, greatest) = barrel_box(mechanism), BARREL_HEIGHTS
    needed = (FULL - 2.0 * MARGIN) / shown.width * shown.height + 2.0 * MARGIN + FOOT
    bottom = TOP + min(max(needed, least), greatest)
    drawn = barrel_panel(mechanism, Box(EDGE, TOP, EDGE + FULL, bottom), unit)
    columns = (
        [_dimensions(design, problem), _segments(design)],
        [checks(design.verification, problem)],
        _measured(design, problem),
    )
    room = (FULL - 2.0 * GUTTER) / len(columns)
    tables, bottom = in_columns(columns, [room] * len(columns), bottom + APART[0])
    table = mechanism.program
    diagrams = _motion_diagrams(table, unit, unit)
    pressure = np.degrees(np.arctan(np.abs(table.v) / mechanism.cylinder_radius))
    degrees, limit = np.append(np.asarray(table.angle), 360.0), problem.limits.pressure_angle
    heading = "pressure angle (degrees)"
    diagrams.append(Diagram(heading, "pressure_angle", degrees, _closed(pressure), DEMANDED, (limit,)))
    parts, bottom = _in_two_columns(diagrams, bottom + APART[1], design)
    described = (
        f"Unrolled groove of a barrel cam, cylinder radius {mechanism.cylinder_radius:.6g} {unit}, "
        f"turning {ROTATIONS[mechanism.rotation]}; {len(design.segments)} segments. {outcome(design.verification)}"
    )
    words = _words("Barrel cam, unrolled,", design, unit)
    return sheet(title or "Barrel cam", words, described, [drawn, *tables, *parts], bottom)


def _words(name: str, design: CamDesign | BarrelCamDesign, unit: str) -> str:
    turns = f"turns {ROTATIONS[design.mechanism.rotation]}"
    follower = FOLLOWERS[design.mechanism.follower.type]
    return f"{name} with {follower}, {turns}; lengths in {UNITS[unit]}; {verdict(design.verification)}"


def _description(design: CamDesign, unit: str) -> str:
    mechanism = design.mechanism
    name, radius = (
        ("base", mechanism.base_radius) if mechanism.prime_radius is None else ("prime", mechanism.prime_radius)
    )
    return (
        f"Drawing of a cam with a {FOLLOWERS[mechanism.follower.type]}, {name} radius {radius:.6g} {unit}, "
        f"turning {ROTATIONS[mechanism.rotation]}; {len(design.segments)} segments. {outcome(design.verification)}"
    )


def _dimensions(
    design: CamDesign | BarrelCamDesign, problem: CamProblem, derived: Sequence[tuple[str, str]] = ()
) -> Block:
    mechanism, follower = design.mechanism, design.mechanism.follower
    rows = [("follower", FOLLOWERS[follower.type])]
    rows += entries(mechanism, problem, {"type", "follower", "rotation", "second", *CURVES})
    rows += derived
    rows += entries(follower, problem, {"type", "sense", "offset"})
    if isinstance(follower, CamFollower) and follower.offset is not None:
        # An offset computed by the solver may be a rounding error of zero.
        size = max(mechanism.pitch_curve.x)
        rows.append(("offset", f"{length(follower.offset, size)} {problem.length_unit}"))
    if isinstance(follower, CamFollower) and follower.sense is not None:
        rows.append(("arm swings outward", "with the cam" if follower.sense == 1 else "against the cam"))
    if isinstance(mechanism, CamMechanism) and mechanism.second is not None:
        second = entries(mechanism.second, problem, {"follower", *CURVES})
        rows += [(f"second cam, {name}" if "prime" in name else name, value) for name, value in second]
    rows.append(("rotation", ROTATIONS[mechanism.rotation]))
    rows.append(("points of a curve", f"{len(mechanism.pitch_curve.x)}"))
    return blocks.rows("Dimensions", rows)


def _segments(design: CamDesign | BarrelCamDesign) -> Block:
    """Return the block of all segments with law, place and peaks."""
    lines = []
    for k, segment in enumerate(design.segments, 1):
        law = clean(segment.law.replace("_", " "))
        place = f"{length(segment.start, digits=4)}–{length(segment.start + segment.angle, digits=4)}°"
        cells = [
            f"{k}",
            law if segment.motion.replace("_", " ") == law else f"{segment.motion}, {law}",
            place,
            length(segment.displacement[1], design.metrics.lift, digits=4),
            length(segment.peak_velocity, digits=3),
            length(segment.peak_acceleration, digits=3),
        ]
        lines.append(blocks.Line(cells))
    heads = ["", "motion and law", "cam angle", "to", "peak v", "peak a"]
    return blocks.table("Segments", heads, lines, SEGMENT_COLUMNS, worded=1)


def _measured(design: CamDesign | BarrelCamDesign, problem: CamProblem) -> list[Block]:
    """Return the blocks of measured quantities, the gap to the best motion, and forces if the problem has a load."""
    metrics, optimality = design.metrics, design.optimality
    gap = NONE if optimality.gap is None else f"{100.0 * optimality.gap:.3g} %"
    rows = entries(metrics, problem, {"forces"}, TITLES)
    rows.append((f"{clean(optimality.criterion.replace('_', ' '))}, above its bound", gap))
    measured = [blocks.rows("Metrics", rows)]
    if metrics.forces is not None:
        # The warning is a sentence, too long for a row; the report and the JSON contain it.
        measured.append(blocks.rows("Forces", entries(metrics.forces, problem, {"warning"}, TITLES)))
    return measured


def _in_two_columns(
    shown: list[Diagram], top: float, design: CamDesign | BarrelCamDesign
) -> tuple[list[Element], float]:
    """Draw diagrams in two columns with the joints of the segments marked; return them and the y below."""
    joints = [segment.start for segment in design.segments]
    wide, step = 0.5 * (FULL - GUTTER), DIAGRAM_HEIGHT + APART[2]
    parts = []
    for k, diagram in enumerate(shown):
        x, low = EDGE + (k % 2) * (wide + GUTTER), top + (k // 2) * step
        parts.append(diagram.draw(Box(x, low, x + wide, low + DIAGRAM_HEIGHT), joints))
    return parts, top + math.ceil(len(shown) / 2) * step


def _closed(values: object) -> np.ndarray:
    """Return values over a turn, with the first repeated at the end."""
    over_turn = np.asarray(values, dtype=np.float64)
    return np.append(over_turn, over_turn[0])


def _motion_diagrams(table: ProgramTable, lift: str, rate: str) -> list[Diagram]:
    """Return diagrams of displacement and its derivatives from the program's table."""
    degrees = np.append(np.asarray(table.angle), 360.0)
    return [
        Diagram(f"displacement s ({lift})", "s", degrees, _closed(table.s), INPUT),
        Diagram(f"velocity v ({rate}/rad)", "v", degrees, _closed(table.v), OUTPUT),
        Diagram(f"acceleration a ({rate}/rad²)", "a", degrees, _closed(table.a), COUPLER),
        Diagram(f"jerk j ({rate}/rad³)", "j", degrees, _closed(table.j), CURVE),
    ]


def _diagrams(design: CamDesign, problem: CamProblem, scene: CamScene) -> list[Diagram]:
    """Return diagrams of displacement and derivatives, and of pressure angle and curvature measured on the profile."""
    table, unit = design.mechanism.program, problem.length_unit
    lift, rate = ("degrees", "rad") if scene.oscillating else (unit, unit)
    degrees = np.append(scene.angle, 360.0)
    shown = _motion_diagrams(table, lift, rate)
    contact = scene.contact
    pressure = np.degrees(contact.pressure_angle)
    # The pressure angle of a central flat face is constant.
    if scene.roller or design.mechanism.follower.face_offset:
        limits = (problem.limits.pressure_angle,) if scene.roller else ()
        words = "pressure angle (degrees), measured on the profile"
        shown.append(Diagram(words, "pressure_angle", degrees, _closed(pressure), DEMANDED, limits))
    # Straight pieces have infinite radius, thus zero curvature.
    with np.errstate(divide="ignore"):
        curvature = _closed(1.0 / contact.radius)
    words = f"curvature of the profile (1/{unit}), convex positive"
    shown.append(Diagram(words, "curvature", degrees, curvature, INK))
    return shown


def _key(scene: CamScene, y: float) -> Element:
    """Draw the key to the line styles."""
    group, x, middle = element("g", data_key="true"), EDGE, y - KEY_MIDDLE
    for name, style in STYLES.items():
        if scene.roller is None and name in ("pitch curve", "prime circle"):
            continue
        if name == "second cam" and scene.second is None:
            continue
        if name == "outer wall":
            # It has the same line style as the profile.
            continue
        group.add(line(complex(x, middle), complex(x + SAMPLE, middle), **style))
        group.add(text(x + SAMPLE + 4.0, y, name, KEY_SIZE, fill=GREY))
        x += SAMPLE + 4.0 + text_width(name, KEY_SIZE) + KEY_GAP
    group.add(circle(complex(x + 3.0, middle), STATION, fill=CURVE), text(x + 8.0, y, "cam angle", KEY_SIZE, fill=GREY))
    return group
