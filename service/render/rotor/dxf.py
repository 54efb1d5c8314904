"""A balanced rotor as DXF: a template of each correction plane, side by side.

==========  ==================================================
layer       content
==========  ==================================================
PLANE_n     the circle on which the masses lie, and its axis
ADDED       crosses where masses are added
REMOVED     circles where masses are removed, with a cross
TEXT        the mass of each, its angle, and the plane's place
==========  ==================================================

Angles are measured from the x axis, viewed against the z axis; radii are to scale if the problem gives a radius.
"""

from __future__ import annotations

import cmath
import math

from service.render.page import dxf
from service.render.page.numbers import format_angle, format_length
from service.render.rotor.faces import make_faces
from service.units import list_symbols
from synthesis.kinds.balancing.design import RotorDesign
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.model.dimension import Dimension

FACE_SPACING, LETTER_HEIGHT, MARK_SIZE = 3.2, 0.06, 0.05
"""Distance of the faces, height of letters, and size of a mark, in radii of a face."""


def write_rotor_dxf(design: RotorDesign, problem: BalancingProblem, title: str) -> str:
    """Write the templates of a balanced rotor as a DXF document (R2010)."""
    units, shown = list_symbols(problem), make_faces(design.mechanism)
    layers = {"ADDED": (5, "CONTINUOUS"), "REMOVED": (1, "CONTINUOUS"), "TEXT": (7, "CONTINUOUS")}
    layers |= {f"PLANE_{n}": (3, "CONTINUOUS") for n in range(1, len(shown) + 1)}
    document = dxf.create_drawing(title or "Balanced rotor", problem.length_unit, layers)
    space = document.modelspace()
    for n, face in enumerate(shown):
        size = face.radius
        centre = complex(FACE_SPACING * size * n)
        dxf.add_circle(space, centre, size, f"PLANE_{n + 1}")
        dxf.add_cross(space, centre, 0.1 * size, f"PLANE_{n + 1}")
        heading = f"PLANE {n + 1}, z = {format_length(face.z)} {problem.length_unit}"
        dxf.add_words(space, centre - 1.35j * size, heading, LETTER_HEIGHT * size)
        for mark in face.marks:
            entry, at = mark.correction, centre + mark.at
            layer = "REMOVED" if entry.removed else "ADDED"
            dxf.add_cross(space, at, MARK_SIZE * size, layer)
            if entry.removed:
                dxf.add_circle(space, at, 0.7 * MARK_SIZE * size, layer)
            mass, dimension = (
                (entry.unbalance, Dimension.UNBALANCE) if entry.mass is None else (entry.mass, Dimension.MASS)
            )
            words = f"{format_length(mass)} {units[dimension]} {format_angle(entry.angle % 360.0, 2)}"
            # Words stand outside the circle at the angle of their mass.
            beyond = centre + cmath.rect(1.18 * size, math.radians(entry.angle))
            dxf.add_words(space, beyond, words.replace("°", " deg"), 0.8 * LETTER_HEIGHT * size)
    return dxf.write_document(document)
