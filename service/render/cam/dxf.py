"""A cam as DXF: profile and pitch curve as splines, the profile again as tangent arcs, circles and follower, by layers.

=================  ==================================================================
layer              content
=================  ==================================================================
PROFILE            closed cubic spline through the profile's points, tangents kept
PROFILE_ARCS       the profile as a closed polyline of tangent arcs (biarcs); frozen
OUTER_WALL         spline through the points of a groove's outer wall, of form-closed cams
PITCH_CURVE        spline of the roller's centres
PRIME_CIRCLE       prime circle of a roller's cam
BASE_CIRCLE        base circle
FOLLOWER           roller or face, arm and pivot at cam angle 0
CENTRE             cross at the cam's centre, and the mark of cam angle 0
=================  ==================================================================

Coordinates are in the cam's own frame and the problem's unit, which the header contains.

A barrel cam is drawn unrolled, x along the circumference on which the roller's middle runs and y along the axis:

============  ==================================================================
layer         content
============  ==================================================================
WALLS         both walls of the groove over one turn, as splines
PITCH_CURVE   spline of the roller's centres
FOLLOWER      the roller at cam angle 0
BLANK         the rectangle that is wound around the cylinder
============  ==================================================================
"""

from __future__ import annotations

import math

import numpy as np
from ezdxf.layouts.layout import Modelspace

from kinematics.arrays import Complex
from kinematics.cam.finished.barrel_contact import UnrolledWall
from kinematics.cam.finished.contact import Contour
from service.render.cam.scene import CamScene, SecondScene
from service.render.page import dxf
from synthesis.kinds.cam.design import BarrelCamDesign, CamDesign
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.profile import read_points

LAYERS = {
    "PROFILE": (5, "CONTINUOUS"),
    "PROFILE_ARCS": (4, "CONTINUOUS"),
    "OUTER_WALL": (5, "CONTINUOUS"),
    "PITCH_CURVE": (6, "DASHED"),
    "PRIME_CIRCLE": (8, "DOT"),
    "BASE_CIRCLE": (8, "DASHDOT"),
    "FOLLOWER": (30, "CONTINUOUS"),
    "CENTRE": (7, "CONTINUOUS"),
}
"""Colour index and line type of each layer."""

SECOND_LAYERS = {"SECOND_PROFILE": (3, "CONTINUOUS"), "SECOND_PITCH_CURVE": (3, "DASHED")}
"""Additional layers of a drawing of conjugate cams."""

BARREL_LAYERS = {
    "WALLS": (5, "CONTINUOUS"),
    "PITCH_CURVE": (6, "DASHED"),
    "FOLLOWER": (30, "CONTINUOUS"),
    "BLANK": (8, "DASHDOT"),
}
"""Layers of a barrel cam's drawing."""

ARC_TOLERANCE = 1e-5
"""Maximum distance of the arcs from the points they replace, as a share of the base radius: 0.4 µm at 40 mm."""

CROSS_ARM, PIVOT_RADIUS = 0.08, 0.04
"""Arm of the cross at the cam's centre, and radius of a pivot, as shares of the base radius."""

MAX_RUN = 64
"""Maximum number of points that one pair of arcs replaces."""

STRAIGHT_BULGE = 1e-12
"""Bulge below which a piece is a line."""


def write_cam_dxf(design: CamDesign, problem: CamProblem, title: str) -> str:
    """Write a cam design as a DXF document (R2010)."""
    scene = CamScene(design.mechanism)
    layers = LAYERS if scene.second is None else LAYERS | SECOND_LAYERS
    document = dxf.create_drawing(title or "Cam", problem.length_unit, layers, frozen="PROFILE_ARCS")
    space = document.modelspace()
    _add_closed(space, scene.contour, "PROFILE")
    space.add_lwpolyline(
        _fit_biarcs(scene.contour, ARC_TOLERANCE * scene.base_radius),
        format="xyb",
        close=True,
        dxfattribs={"layer": "PROFILE_ARCS"},
    )
    dxf.add_circle(space, 0j, scene.base_radius, "BASE_CIRCLE")
    if scene.outer_wall is not None:
        _add_closed(space, Contour(scene.outer_wall), "OUTER_WALL")
    if scene.roller:
        _add_closed(space, Contour(scene.pitch_curve), "PITCH_CURVE")
        dxf.add_circle(space, 0j, scene.roller.prime_radius, "PRIME_CIRCLE")
    if scene.second is not None:
        _add_second(space, scene, scene.second)
    _add_follower(space, scene)
    arm = CROSS_ARM * scene.base_radius
    dxf.add_cross(space, 0j, arm, "CENTRE")
    dxf.add_line(space, complex(arm), complex(3.0 * arm), "CENTRE")
    return dxf.write_document(document)


def _add_second(space: Modelspace, scene: CamScene, second: SecondScene) -> None:
    """Add the second of two conjugate cams, its roller at cam angle 0 and its carrier."""
    _add_closed(space, Contour(second.profile), "SECOND_PROFILE")
    _add_closed(space, Contour(second.pitch_curve), "SECOND_PITCH_CURVE")
    centre = complex(second.pitch_curve[0])
    dxf.add_circle(space, centre, second.follower.roller_radius, "FOLLOWER")
    dxf.add_line(space, centre, complex(scene.pitch_curve[0]) if scene.pivot is None else scene.pivot, "FOLLOWER")


def write_barrel_dxf(design: BarrelCamDesign, problem: CamProblem, title: str) -> str:
    """Write a barrel cam design as a DXF document (R2010)."""
    mechanism = design.mechanism
    document = dxf.create_drawing(title or "Barrel cam", problem.length_unit, BARREL_LAYERS)
    space, turn = document.modelspace(), math.tau * mechanism.cylinder_radius
    for curve, layer in (
        (mechanism.lower_wall, "WALLS"),
        (mechanism.upper_wall, "WALLS"),
        (mechanism.pitch_curve, "PITCH_CURVE"),
    ):
        wall = UnrolledWall(read_points(curve), turn)
        # The unrolled wall closes after one circumference.
        over = np.append(wall.points, wall.points[0] + turn), np.append(wall.tangents, wall.tangents[0])
        dxf.add_spline(space, *over, layer)
    dxf.add_circle(space, read_points(mechanism.pitch_curve)[0], mechanism.follower.roller_radius, "FOLLOWER")
    low, high = min(mechanism.lower_wall.y), max(mechanism.upper_wall.y)
    dxf.add_outline(space, [1j * low, turn + 1j * low, turn + 1j * high, 1j * high], "BLANK")
    return dxf.write_document(document)


def _fit_biarcs(contour: Contour, tolerance: float) -> list[tuple[float, float, float]]:
    """Return vertices with bulges: pairs of tangent arcs over runs of points, as long as the tolerance permits."""
    points = np.append(contour.points, contour.points[0])
    tangents = np.append(contour.tangents, contour.tangents[0])
    vertices, k, last = [], 0, len(points) - 1
    while k < last:
        run = min(MAX_RUN, last - k)
        while True:
            pair = _compute_biarc(
                complex(points[k]), complex(tangents[k]), complex(points[k + run]), complex(tangents[k + run])
            )
            # Accept the pair, or halve the run; a single step is always accepted.
            if run == 1 or _measure_distance(points[k + 1 : k + run], pair) <= tolerance:
                break
            run = max(1, run // 2)
        vertices += [(start.real, start.imag, bulge) for start, _, bulge in pair]
        k += run
    return vertices


def _compute_biarc(a: complex, ta: complex, b: complex, tb: complex) -> list[tuple[complex, complex, float]]:
    """Compute two arcs, (start, end, bulge), from given ends and unit tangents, with tangents of equal length.

    With d the length of the tangents, the arcs meet at the middle of a + d ta and b − d tb, where
    |a + d ta − (b − d tb)| = 2 d (Bolton, Computer-Aided Design 7 (1975) 29).
    """
    v, t = b - a, ta + tb
    # Coefficient of d² in the condition of equal tangent lengths.
    square = 2.0 * (1.0 - (ta * tb.conjugate()).real)
    along = (v * t.conjugate()).real
    # Parallel tangents make the quadratic equation linear.
    if square > STRAIGHT_BULGE:
        d = (-along + math.sqrt(along * along + square * abs(v) ** 2)) / square
    else:
        d = 0.5 * abs(v) ** 2 / along
    middle = 0.5 * (a + d * ta + b - d * tb)
    return [(a, middle, _compute_bulge(a, ta, middle)), (middle, b, -_compute_bulge(b, -tb, middle))]


def _compute_bulge(start: complex, tangent: complex, end: complex) -> float:
    """Return tan of a quarter of the arc's angle, which is twice that from tangent to chord; positive to the left."""
    chord = (end - start) * tangent.conjugate()
    return math.tan(0.5 * math.atan2(chord.imag, chord.real))


def _measure_distance(points: Complex, pair: list[tuple[complex, complex, float]]) -> float:
    """Return the maximum distance of points from the nearer of two arcs."""
    off = []
    for start, end, bulge in pair:
        if abs(bulge) < STRAIGHT_BULGE:
            along = (end - start) / abs(end - start)
            off.append(np.abs(((points - start) * along.conjugate()).imag))
            continue
        # Centre of the arc from its bulge.
        centre = start + (end - start) * complex(0.5, 0.25 * (1.0 / bulge - bulge))
        off.append(np.abs(np.abs(points - centre) - abs(start - centre)))
    middle = pair[0][1]
    chord = pair[1][1] - pair[0][0]
    # Assign each point to the arc on its side of the joint.
    first = ((points - middle) * chord.conjugate()).real < 0.0
    return float(np.where(first, *off).max())


def _add_closed(space: Modelspace, contour: Contour, layer: str) -> None:
    """Add a closed curve with its own tangents at its points."""
    around = np.append(contour.points, contour.points[0])
    dxf.add_spline(space, around, np.append(contour.tangents, contour.tangents[0]), layer)


def _add_follower(space: Modelspace, scene: CamScene) -> None:
    """Add roller or face at cam angle 0, with the arm and its pivot."""
    for start, end in scene.carrier_lines:
        dxf.add_line(space, start, end, "FOLLOWER")
    if scene.roller is not None:
        centre = complex(scene.pitch_curve[0])
        if scene.roller.roller_radius > 0.0:
            dxf.add_circle(space, centre, scene.roller.roller_radius, "FOLLOWER")
        if scene.pivot is None:
            dxf.add_line(space, centre, centre + scene.base_radius, "FOLLOWER")
    if scene.pivot is not None:
        dxf.add_circle(space, scene.pivot, PIVOT_RADIUS * scene.base_radius, "FOLLOWER")
