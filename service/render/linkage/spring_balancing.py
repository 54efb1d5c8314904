"""The sheet content of a spring-balanced linkage: drawn at several places of its motion, with the drive over it."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence

import numpy as np

from kinematics.arrays import Complex
from kinematics.dynamics.places import Places
from service.render.linkage.content import Content
from service.render.linkage.drawing import PlanarPicture, Scene
from service.render.linkage.motion import DrivenLinkage
from service.render.page import blocks
from service.render.page.diagrams import Diagram
from service.render.page.numbers import format_angle, format_length
from service.render.page.svg import Box, Element, Viewport, draw_circle, draw_path
from service.render.page.symbols import CURVE, OUTPUT, PALE, TARGET_COLOUR
from service.units import list_symbols
from synthesis.kinds.spring_balancing.curves import drive_curves
from synthesis.kinds.spring_balancing.design import SprungDesign
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.model.dimension import Dimension

PLACE_COUNT = 4
"""Number of places of the motion at which the linkage is drawn, heavy at the first."""

COIL_COUNT, COIL_HALF_WIDTH, STRAIGHT_SHARE = 9, 7.0, 0.16
"""Coils of a drawn spring, half its width in pixels, and the straight part at each end as a share of its length."""

SPIRAL_TURNS, INNER_RADIUS, OUTER_RADIUS = 2.25, 7.0, 19.0
"""Turns of a drawn torsion spring, and its radii in pixels."""


def make_coil(start: complex, end: complex) -> Complex:
    """Return the line of a spring between two points of the sheet."""
    along = end - start
    across = 1j * along / abs(along) if along != 0.0 else 0j
    shares = np.linspace(STRAIGHT_SHARE, 1.0 - STRAIGHT_SHARE, 2 * COIL_COUNT + 1)
    sides = np.where(np.arange(2 * COIL_COUNT + 1) % 2 == 1, 1.0, -1.0)
    # The coil starts and ends on the axis.
    sides[[0, -1]] = 0.0
    return np.concatenate([[start], start + along * shares + COIL_HALF_WIDTH * sides * across, [end]])


def make_spiral(at: complex, turned: float) -> Complex:
    """Return the line of a torsion spring about a point of the sheet, ending in a direction (radians)."""
    angles = np.linspace(0.0, 2.0 * math.pi * SPIRAL_TURNS, 120)
    return np.asarray(at + np.linspace(INNER_RADIUS, OUTER_RADIUS, 120) * np.exp(1j * (angles - angles[-1] + turned)))


def _draw_coils(view: Viewport, ends: Mapping[int, Sequence[Complex]]) -> list[Element]:
    """Draw springs between the places of their two ends, by number; the first place is drawn last, in colour."""
    shapes: list[Element | None] = []
    for number, (one, other) in ends.items():
        # The first place is drawn last, on top of the pale ones.
        for k in range(len(one) - 1, -1, -1):
            if not (np.isfinite(one[k]) and np.isfinite(other[k])):
                continue
            start, end = view.point(complex(one[k])), view.point(complex(other[k]))
            if k:
                shapes.append(draw_path([np.array([start, end])], stroke=PALE, stroke_width=1.0))
                continue
            shapes.append(
                draw_path([make_coil(start, end)], stroke=TARGET_COLOUR, stroke_width=1.8, data_spring=f"{number}")
            )
            shapes += [draw_circle(at, 3.0, fill=TARGET_COLOUR) for at in (start, end)]
    return [shape for shape in shapes if shape is not None]


def _draw_spirals(view: Viewport, places: list[tuple[int, complex, float]]) -> list[Element]:
    """Draw torsion springs by number, centre and direction of their free end, radians."""
    shapes = [
        draw_path(
            [make_spiral(view.point(centre), -turned)], stroke=TARGET_COLOUR, stroke_width=1.8, data_spring=f"{number}"
        )
        for number, centre, turned in places
    ]
    return [shape for shape in shapes if shape is not None]


def _list_springs(design: SprungDesign, problem: SpringBalancingProblem, diagonal: float) -> list[tuple[str, str]]:
    """Return the rows of the table of springs; ``diagonal`` is the size of the picture in length units."""
    units, unit = list_symbols(problem), problem.length_unit
    rows = []
    for spring in design.springs:
        name = f"spring {spring.number + 1}"
        if spring.links is not None:
            rate = f"{format_length(spring.torsion or 0.0)} {units[Dimension.TORSION_STIFFNESS]}"
            rows += [(f"{name}: torsion", rate), ("free angle", format_angle(spring.free_angle or 0.0))]
            continue
        rows.append((f"{name}: rate", f"{format_length(spring.rate or 0.0)} {units[Dimension.STIFFNESS]}"))
        rows.append(("free length", f"{format_length(spring.free_length or 0.0)} {unit}"))
        if spring.preload:
            rows.append(("preload", f"{format_length(spring.preload)} {units[Dimension.FORCE]}"))
        rows.append(
            (
                "over the motion",
                f"{format_length(spring.min_length or 0.0)} to {format_length(spring.max_length or 0.0)} {unit}",
            )
        )
        for end in spring.ends or ():
            x, y = (format_length(value, diagonal) for value in end.point)
            rows.append((f"on {end.link}", f"({x}, {y})"))
    return rows


def make_spring_balancing(design: SprungDesign, problem: SpringBalancingProblem, linkage: DrivenLinkage) -> Content:
    """Return the content for a spring-balanced linkage.

    It shows positions of its motion with the springs, and the drive torque or force without and with them.
    """
    curves = drive_curves(problem, design)
    inputs = np.linspace(curves.at[0], curves.at[-1], PLACE_COUNT)
    scene = Scene(linkage, inputs, [])
    now = Places(linkage.mechanism, linkage.drive_over(inputs, order=2))
    ends = {
        spring.number: [now.point(end.link, np.asarray(complex(*end.point)))[0] for end in spring.ends]
        for spring in design.springs
        if spring.ends is not None
    }
    held = [points[np.isfinite(points)] for pair in ends.values() for points in pair]
    box = Box.enclose(np.concatenate([scene.list_places(), *held]))

    def draw_springs(view: Viewport) -> list[Element]:
        spirals = [
            (spring.number, *_find_torsion_place(linkage, scene, spring.links))
            for spring in design.springs
            if spring.links is not None
        ]
        return [*_draw_coils(view, ends), *_draw_spirals(view, spirals)]

    units, unit = list_symbols(problem), problem.length_unit
    places = [
        (name, f"({format_length(x, box.diagonal)}, {format_length(y, box.diagonal)})")
        for name, (x, y) in design.mechanism.skeleton.joints.items()
    ]
    slides = linkage.mechanism.has_slide_input
    per = units[Dimension.FORCE if slides else Dimension.TORQUE]
    over = "over the input's travel" if slides else "over the input's rotation"
    shown = curves.at if slides else np.degrees(curves.at)
    count = len(design.springs)
    return Content(
        "Spring-balanced linkage",
        f"Linkage with {count} spring{'s' * (count != 1)}",
        f"a linkage at {PLACE_COUNT} places of its motion, with its springs",
        PlanarPicture(scene, unit, draw_springs, box),
        [blocks.make_rows("Springs", _list_springs(design, problem, box.diagonal) or [("none", "")])],
        titles={"value": "residual drive", "bound": "lower bound"},
        dimensions=blocks.make_rows(f"Joints in the reference ({unit})", places),
        diagrams=[
            Diagram(f"drive without the springs ({per}) {over}", "drive_before", shown, curves.before, CURVE),
            Diagram(f"drive with them ({per})", "drive_after", shown, curves.after, OUTPUT),
        ],
    )


def _find_torsion_place(linkage: DrivenLinkage, scene: Scene, links: tuple[str, str]) -> tuple[complex, float]:
    """Return the place of a torsion spring in the first configuration, and the direction of its free end.

    The place is the pin that joins both links, or else the first pin of the second link. The direction is in radians.
    """
    mechanism, joints = linkage.mechanism, scene.get_joints(0)
    listed = [joint for joint in mechanism.links[links[1]] if joint in joints]
    shared = [joint for joint in listed if joint in mechanism.links[links[0]]]
    at = joints[(shared or listed or list(joints))[0]]
    # The spring's free end points along the link.
    others = [joints[joint] for joint in listed if joints[joint] != at]
    return at, cmath.phase(others[0] - at) if others else 0.0
