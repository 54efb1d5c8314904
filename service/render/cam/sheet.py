"""The sheet of a cam design: title, drawing and key, tables beside them, diagrams over the cam angle below."""

from __future__ import annotations

import math

import numpy as np

from service.render.cam.scene import CamScene
from service.render.cam.view import STYLES, panel
from service.render.checks import checks, outcome, verdict
from service.render.page import blocks
from service.render.page.blocks import (
    GAP,
    ROW,
    SMALL,
    Block,
    block_start,
)
from service.render.page.diagrams import Diagram
from service.render.page.numbers import (
    NONE,
    angle,
    length,
)
from service.render.page.sheet import EDGE, FULL, GUTTER, TOP, UNITS, beside, sheet, stacked
from service.render.page.svg import (
    Box,
    Element,
    circle,
    clean,
    element,
    line,
    shortened,
    text,
    text_width,
)
from service.render.page.symbols import (
    COUPLER,
    CURVE,
    DEMANDED,
    GREY,
    INK,
    INPUT,
    OUTPUT,
)
from synthesis.kinds.cam.design import (
    BarrelCamDesign,
    CamDesign,
    CamSegment,
    ProgramTable,
)
from synthesis.kinds.cam.problem import CamProblem

DRAWING_HEIGHT, DIAGRAM_HEIGHT, KEY_HEIGHT = 620.0, 172.0, 30.0
"""Heights of the drawing, of a diagram and of the key below the drawing, pixels."""

FOLLOWERS = {
    "translating_roller": "translating roller follower",
    "oscillating_roller": "oscillating roller follower",
    "translating_flat": "translating flat-faced follower",
    "oscillating_flat": "oscillating flat-faced follower",
}

ROTATIONS = {"ccw": "counter-clockwise", "cw": "clockwise"}


def cam_sheet(design: CamDesign, problem: CamProblem, title: str) -> str:
    """The drawing of a cam design as a complete SVG document."""
    scene, unit = CamScene(design.mechanism), problem.length_unit
    tables, y = stacked(
        [
            _dimensions(design, scene, unit),
            segments_block(design),
            checks(design.verification, problem),
            _metrics(design, unit),
            *([forces_block(design)] if design.metrics.forces else []),
        ]
    )
    height = max(DRAWING_HEIGHT, y - TOP - KEY_HEIGHT)
    drawn = panel(scene, Box(EDGE, TOP, EDGE + beside(), TOP + height), unit)
    top = max(TOP + height + KEY_HEIGHT, y)
    joints = [segment.start for segment in design.segments]
    diagrams, bottom = in_two_columns(_diagrams(design, problem, scene), top, joints)
    parts = [*tables, drawn, _key(scene, TOP + height + 18.0), *diagrams]
    return sheet(title or "Cam", _words(design, unit), _description(design, unit), parts, bottom)


def _words(design: CamDesign, unit: str) -> str:
    turns = f"turns {ROTATIONS[design.mechanism.rotation]}"
    follower = FOLLOWERS[design.mechanism.follower.type]
    return f"Cam with {follower}, {turns}; lengths in {UNITS[unit]}; {verdict(design.verification)}"


def _description(design: CamDesign, unit: str) -> str:
    mechanism = design.mechanism
    name, radius = _radius(design)
    return (
        f"Drawing of a cam with a {FOLLOWERS[mechanism.follower.type]}, {name} {radius:.6g} {unit}, "
        f"turning {ROTATIONS[mechanism.rotation]}; {len(design.segments)} segments. {outcome(design.verification)}"
    )


def _radius(design: CamDesign) -> tuple[str, float]:
    mechanism = design.mechanism
    if mechanism.prime_radius is not None:
        return "prime radius", mechanism.prime_radius
    return "base radius", mechanism.base_radius or 0.0


def _dimensions(design: CamDesign, scene: CamScene, unit: str) -> Block:
    follower, entries = design.mechanism.follower, [("follower", FOLLOWERS[design.mechanism.follower.type])]
    if scene.roller:
        entries.append(("prime radius", length(scene.roller.prime_radius)))
    entries.append(("base radius", length(scene.base_radius)))
    for name, value in (
        ("roller radius", follower.roller_radius),
        ("offset", follower.offset),
        ("arm", follower.arm),
        ("pivot distance", follower.pivot_distance),
        ("face offset", follower.face_offset),
    ):
        if value is not None:
            entries.append((name, length(value, scene.base_radius)))
    if follower.sense is not None:
        entries.append(("arm swings outward", "with the cam" if follower.sense == 1 else "against the cam"))
    entries.append(("rotation", ROTATIONS[design.mechanism.rotation]))
    entries.append(("points of the profile", f"{len(scene.profile)}"))
    return blocks.rows(f"Dimensions ({unit})", entries)


def segments_block(design: CamDesign | BarrelCamDesign) -> Block:
    """Every segment with its law, its place and its peaks."""
    shares = (0.06, 0.09, 0.58, 0.72, 0.86, 1.0)

    def row(k: int, segment: CamSegment) -> list[str]:
        place = f"{length(segment.start, digits=4)}–{length(segment.start + segment.angle, digits=4)}°"
        peaks = (segment.peak_velocity, segment.peak_acceleration)
        law = clean(segment.law.replace("_", " "))
        name = law if segment.motion.replace("_", " ") == law else f"{segment.motion}, {law}"
        return [
            f"{k + 1}",
            name,
            place,
            length(segment.displacement[1], design.metrics.lift, digits=4),
            *(length(v, digits=3) for v in peaks),
        ]

    def draw(left: float, top: float, width: float) -> tuple[Element, float]:
        block, y = block_start("Segments", left, top, width)
        heads = ["", "motion and law", "cam angle", "to", "peak v", "peak a"]
        for cells in (heads, *(row(k, segment) for k, segment in enumerate(design.segments))):
            y += ROW
            for n, (cell, share) in enumerate(zip(cells, shares, strict=True)):
                words, anchor = shortened(cell, SMALL, (0.36 if n == 1 else 0.22) * width), "start" if n == 1 else "end"
                fill = GREY if cells is heads else INK
                block.add(text(left + share * width, y, words, SMALL, text_anchor=anchor, fill=fill))
        return block, y + GAP

    return draw


def _metrics(design: CamDesign, unit: str) -> Block:
    found = design.metrics
    entries = [("greatest radius", f"{length(found.size)} {unit}"), ("lift", length(found.lift))]
    for name, value in (
        ("pressure angle, rise", found.max_pressure_angle_rise),
        ("pressure angle, fall", found.max_pressure_angle_fall),
    ):
        if value is not None:
            entries.append((name, angle(value, 2)))
    entries.append(("least convex radius", length(found.min_convex_radius, digits=4)))
    if found.min_concave_radius is not None:
        entries.append(("least hollow radius", length(found.min_concave_radius, digits=4)))
    if found.curvature_ratio is not None:
        entries.append(("pitch curve : roller radius", length(found.curvature_ratio, digits=4)))
    if found.face_width is not None:
        entries.append(("contact sweeps on the face", length(found.face_width, digits=4)))
    peaks = (found.peak_velocity, found.peak_acceleration, found.peak_jerk)
    entries.append(("peak v, a, j (per radian)", ", ".join(length(value, digits=4) for value in peaks)))
    optimality = design.optimality
    gap = NONE if optimality.gap is None else f"{100.0 * optimality.gap:.3g} %"
    entries.append((f"{clean(optimality.criterion.replace('_', ' '))}, above its bound", gap))
    return blocks.rows("Metrics", entries)


def forces_block(design: CamDesign | BarrelCamDesign) -> Block:
    """Forces and torque of a design whose problem has a load."""
    found = design.metrics.forces
    assert found is not None, "only drawn where the problem has a load"
    entries = [
        ("preload", length(found.preload, digits=4)),
        (
            "contact force",
            f"{length(found.min_contact_force, digits=4)} to {length(found.max_contact_force, digits=4)}",
        ),
        ("camshaft torque", f"{length(found.min_torque, digits=4)} to {length(found.max_torque, digits=4)}"),
        ("natural frequency", f"{length(found.natural_frequency, digits=4)} rad/s"),
        ("natural frequency : speed", length(found.frequency_ratio, digits=4)),
    ]
    return blocks.rows("Forces", entries)


def in_two_columns(shown: list[Diagram], top: float, joints: list[float]) -> tuple[list[Element], float]:
    """Diagrams side by side below each other, and the y below them."""
    wide, step = 0.5 * (FULL - GUTTER), DIAGRAM_HEIGHT + 8.0
    parts = []
    for k, diagram in enumerate(shown):
        x, low = EDGE + (k % 2) * (wide + GUTTER), top + (k // 2) * step
        parts.append(diagram.draw(Box(x, low, x + wide, low + DIAGRAM_HEIGHT), joints))
    return parts, top + math.ceil(len(shown) / 2) * step


def closed(values: object) -> np.ndarray:
    """Values over a turn with the first again at its end."""
    found = np.asarray(values, dtype=np.float64)
    return np.append(found, found[0])


def motion_diagrams(table: ProgramTable, lift: str, rate: str) -> list[Diagram]:
    """Displacement and its derivatives, as the program's table has them."""
    degrees = np.append(np.asarray(table.angle), 360.0)
    return [
        Diagram(f"displacement s ({lift})", "s", degrees, closed(table.s), INPUT),
        Diagram(f"velocity v ({rate}/rad)", "v", degrees, closed(table.v), OUTPUT),
        Diagram(f"acceleration a ({rate}/rad²)", "a", degrees, closed(table.a), COUPLER),
        Diagram(f"jerk j ({rate}/rad³)", "j", degrees, closed(table.j), CURVE),
    ]


def _diagrams(design: CamDesign, problem: CamProblem, scene: CamScene) -> list[Diagram]:
    """Displacement and its derivatives, pressure angle and curvature, measured on the profile."""
    table, unit = design.mechanism.program, problem.length_unit
    lift, rate = ("degrees", "rad") if scene.oscillating else (unit, unit)
    degrees = np.append(scene.angle, 360.0)
    shown = motion_diagrams(table, lift, rate)
    contact = scene.contact
    pressure = np.degrees(contact.pressure_angle)
    if scene.roller or design.mechanism.follower.face_offset:
        limits = (problem.limits.pressure_angle,) if scene.roller else ()
        words = "pressure angle (degrees), measured on the profile"
        shown.append(Diagram(words, "pressure_angle", degrees, closed(pressure), DEMANDED, limits))
    with np.errstate(divide="ignore"):
        curvature = closed(1.0 / contact.radius)
    words = f"curvature of the profile (1/{unit}), convex positive"
    shown.append(Diagram(words, "curvature", degrees, curvature, INK))
    return shown


def _key(scene: CamScene, y: float) -> Element:
    """What the line styles mean."""
    group, x = element("g", data_key="true"), EDGE
    for name, style in STYLES.items():
        if scene.roller is None and name in ("pitch curve", "prime circle"):
            continue
        if name == "outer wall":
            # Its line is the profile's.
            continue
        group.add(line(complex(x, y - 4.0), complex(x + 20.0, y - 4.0), **style))
        group.add(text(x + 24.0, y, name, 10.0, fill=GREY))
        x += 24.0 + text_width(name, 10.0) + 9.0
    group.add(circle(complex(x + 3.0, y - 4.0), 1.8, fill=CURVE), text(x + 8.0, y, "cam angle", 10.0, fill=GREY))
    return group
