"""Inspection tables of cams as CSV: program, contact and profile at each cam angle; a barrel cam's groove unrolled.

Displacement and its derivatives are those of the program; pressure angle and radius of curvature are measured on the
profile by the analysis core. The polar columns are the readings of a dial indicator on a rotary table. Column names
contain units; lines that begin with ``#`` describe the table.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from service.render.cam.scene import CamScene
from service.render.page import table
from synthesis.kinds.cam.design import BarrelCamDesign, CamDesign, ProgramTable
from synthesis.kinds.cam.problem import CamProblem


def write_cam_table(design: CamDesign, problem: CamProblem, title: str) -> str:
    """Write the inspection table of a cam design.

    Numbers have twelve digits. Cells are empty where the follower has no contact.
    """
    scene, unit = CamScene(design.mechanism), problem.length_unit
    contact = scene.contact
    pitch, profile = scene.pitch_curve, contact.point
    lift, rate = ("deg", "rad") if scene.oscillating else (unit, unit)
    columns = _list_program(design.mechanism.program, lift, rate) | {
        "pressure_angle [deg]": np.degrees(contact.pressure_angle),
        f"radius_of_curvature [{unit}]": contact.radius,
        f"profile_x [{unit}]": profile.real,
        f"profile_y [{unit}]": profile.imag,
        f"profile_radius [{unit}]": np.abs(profile),
        "profile_polar_angle [deg]": _compute_polar_angles(profile),
    }
    # Curves with points of their own do not fit the table's rows.
    if scene.roller and len(pitch) == len(scene.angle):
        columns |= {
            f"roller_centre_x [{unit}]": pitch.real,
            f"roller_centre_y [{unit}]": pitch.imag,
            f"roller_centre_radius [{unit}]": np.abs(pitch),
            "roller_centre_polar_angle [deg]": _compute_polar_angles(pitch),
        }
    wall = scene.outer_wall
    if wall is not None and len(wall) == len(scene.angle):
        columns |= {f"outer_wall_x [{unit}]": wall.real, f"outer_wall_y [{unit}]": wall.imag}
    second = scene.second
    if second is not None and len(second.profile) == len(scene.angle):
        columns |= {
            f"second_profile_x [{unit}]": second.profile.real,
            f"second_profile_y [{unit}]": second.profile.imag,
            f"second_roller_centre_x [{unit}]": second.pitch_curve.real,
            f"second_roller_centre_y [{unit}]": second.pitch_curve.imag,
        }
    follower = design.mechanism.follower
    given = {name: value for name, value in follower.model_dump().items() if value is not None and name != "type"}
    remarks = [f"{follower.type}, {_describe_radius(design)} {unit}, turns {design.mechanism.rotation}"]
    remarks += [", ".join(f"{name} {value:.12g}" for name, value in given.items())] if given else []
    remarks.append("x and y in the cam's own frame, the follower on +x at cam angle 0")
    return table.write_number_table([title or "Cam", *remarks], columns, table.format_rounded)


def write_barrel_table(design: BarrelCamDesign, problem: CamProblem, title: str) -> str:
    """Write the table of a barrel cam design; numbers to twelve digits."""
    mechanism, unit = design.mechanism, problem.length_unit
    program, radius = mechanism.program, mechanism.cylinder_radius
    columns = _list_program(program, unit, unit) | {
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
    return table.write_number_table([title or "Barrel cam", *remarks], columns, table.format_rounded)


def _list_program(program: ProgramTable, lift: str, rate: str) -> dict[str, ArrayLike]:
    """Return the motion program, displacements in ``lift`` and derivatives in ``rate`` per radian."""
    return {
        "cam_angle [deg]": program.angle,
        f"s [{lift}]": program.s,
        f"v [{rate}/rad]": program.v,
        f"a [{rate}/rad^2]": program.a,
        f"j [{rate}/rad^3]": program.j,
    }


def _describe_radius(design: CamDesign) -> str:
    mechanism = design.mechanism
    if mechanism.prime_radius is not None:
        return f"prime radius {mechanism.prime_radius:.12g}"
    return f"base radius {mechanism.base_radius:.12g}"


def _compute_polar_angles(points: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Return polar angles from 0 to 360 degrees; rounding errors of 0 become 0."""
    # Round before the modulus: -1e-12 would become 360.
    return np.asarray(np.mod(np.round(np.degrees(np.angle(points)), 9), 360.0))
