"""A barrel cam as DXF and as CSV, unrolled: x along the circumference on which the roller's middle runs, y the axis.

============  ==================================================================
layer         what is on it
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
from numpy.typing import ArrayLike

from kinematics.cam.unrolled import UnrolledWall
from service.render.page import dxf, table
from synthesis.kinds.cam.design import BarrelCamDesign
from synthesis.kinds.cam.mechanism import points_of
from synthesis.kinds.cam.problem import CamProblem

LAYERS = {
    "WALLS": (5, "CONTINUOUS"),
    "PITCH_CURVE": (6, "DASHED"),
    "FOLLOWER": (30, "CONTINUOUS"),
    "BLANK": (8, "DASHDOT"),
}
"""Colour index and line type of each layer."""


def barrel_drawing(design: BarrelCamDesign, problem: CamProblem, title: str) -> str:
    """The drawing of a barrel cam design as a DXF document (R2010)."""
    mechanism = design.mechanism
    document = dxf.new_drawing(title or "Barrel cam", problem.length_unit, LAYERS)
    space, turn = document.modelspace(), math.tau * mechanism.cylinder_radius
    for curve, layer in (
        (mechanism.lower_wall, "WALLS"),
        (mechanism.upper_wall, "WALLS"),
        (mechanism.pitch_curve, "PITCH_CURVE"),
    ):
        wall = UnrolledWall(points_of(curve), turn)
        over = np.append(wall.points, wall.points[0] + turn), np.append(wall.tangents, wall.tangents[0])
        dxf.add_spline(space, *over, layer)
    dxf.add_circle(space, points_of(mechanism.pitch_curve)[0], mechanism.follower.roller_radius, "FOLLOWER")
    low, high = min(mechanism.lower_wall.y), max(mechanism.upper_wall.y)
    dxf.add_outline(space, [1j * low, turn + 1j * low, turn + 1j * high, 1j * high], "BLANK")
    return dxf.written(document)


def barrel_table(design: BarrelCamDesign, problem: CamProblem, title: str) -> str:
    """The table of a barrel cam design; numbers in full precision."""
    mechanism, unit = design.mechanism, problem.length_unit
    program, radius = mechanism.program, mechanism.cylinder_radius
    columns: dict[str, ArrayLike] = {
        "cam_angle [deg]": program.angle,
        f"s [{unit}]": program.s,
        f"v [{unit}/rad]": program.v,
        f"a [{unit}/rad^2]": program.a,
        f"j [{unit}/rad^3]": program.j,
        "pressure_angle [deg]": np.degrees(np.arctan(np.abs(program.v) / radius)),
    }
    for name, curve in (
        ("centre", mechanism.pitch_curve),
        ("lower_wall", mechanism.lower_wall),
        ("upper_wall", mechanism.upper_wall),
    ):
        columns |= {f"{name}_x [{unit}]": curve.x, f"{name}_y [{unit}]": curve.y}
    remarks = [
        f"barrel cam, cylinder radius {radius:.12g} {unit}, roller radius {mechanism.follower.roller_radius:.12g}, "
        f"turns {mechanism.rotation}",
        "x along the circumference of the cylinder on which the roller's middle runs, y along the axis",
    ]
    return table.numbers([title or "Barrel cam", *remarks], columns, table.short)
