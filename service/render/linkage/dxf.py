"""A linkage as DXF: links, joints and slides at the first target, the path of P as a spline, and the other targets.

=================  ==================================================================
layer              content
=================  ==================================================================
GROUND             crosses at the fixed pivots, lines of slides on the ground
LINK_<NAME>        a link at the first target: a line, or a closed outline of more joints
JOINTS             circles at the pins
SLIDES             blocks and lines of slides on moving links
COUPLER_CURVE      the path of P over the cycle, a spline
USED_CURVE         its part between the first target and the last
TARGETS            required points, with their directions
OTHER_POSITIONS    links at the other targets; frozen
DIMENSIONS         lengths between the joints of each link, and the ground's
TEXT               names of joints, numbers of targets
=================  ==================================================================

Coordinates are those of the problem, in its unit; the header contains the unit.
"""

from __future__ import annotations

import cmath
from itertools import pairwise

import numpy as np
from ezdxf.layouts.layout import Modelspace
from ezdxf.math import Matrix44, global_bspline_interpolation

from kinematics.arrays import Complex
from kinematics.linkage.planar.mechanism import GROUND
from service.render.linkage.drawing import Scene, make_block_corners, sort_around_middle
from service.render.linkage.motion import Demand, list_demands
from service.render.page import dxf
from service.render.page.svg import Box
from synthesis.model.design_interface import AnyDesign
from synthesis.model.problem import ProblemBase

LAYERS = {
    "GROUND": (8, "CONTINUOUS"),
    "JOINTS": (7, "CONTINUOUS"),
    "SLIDES": (3, "DASHDOT"),
    "COUPLER_CURVE": (6, "CONTINUOUS"),
    "USED_CURVE": (200, "CONTINUOUS"),
    "TARGETS": (1, "CONTINUOUS"),
    "OTHER_POSITIONS": (9, "CONTINUOUS"),
    "DIMENSIONS": (5, "CONTINUOUS"),
    "TEXT": (7, "CONTINUOUS"),
}
"""Colour index and line type of each layer except those of the links."""

LINK_COLOURS = (5, 30, 3, 4, 2, 6)
"""Colour indices of the links, in order."""

PIN_RADIUS, CROSS_ARM, LETTER_HEIGHT, BLOCK_LENGTH = 0.008, 0.02, 0.018, 0.03
"""Radius of a pin, arm of a cross, height of letters and length of a block, as shares of the drawing's diagonal."""

BLOCK_HEIGHT, TARGET_RADIUS, DIRECTION_LENGTH = 0.6 * BLOCK_LENGTH, 1.5 * PIN_RADIUS, 3.0 * CROSS_ARM
"""Height of a block, radius of a target point and length of its direction, as shares of the diagonal."""

ARROW_SIZE, EXTENSION_GAP = 0.6 * LETTER_HEIGHT, 0.3 * LETTER_HEIGHT
"""Size of a dimension's arrows; gap between joint and extension line, and its overshoot; as shares of the diagonal."""

NAME_OFFSET = 1.6
"""Distance in x and y from a joint to the middle of its name, in letter heights."""

DIMENSION_OFFSET = 0.045
"""Distance of a dimension line from its link, as a share of the diagonal."""

MAX_CURVE_EXTENT = 20.0
"""Maximum extent of a path in diagonals of the linkage; larger paths would dwarf it and are left out."""

COINCIDENCE_TOLERANCE = 1e-9
"""Ends of a path closer together than this share of the diagonal coincide."""


def write_linkage_dxf(design: AnyDesign, problem: ProblemBase, title: str) -> str:
    """Write a linkage design as a DXF document (R2010)."""
    scene, demanded = Scene.from_design(design), list_demands(problem)
    moving = [name for name in scene.mechanism.links if name != GROUND]
    colours = {_name_layer(name): (LINK_COLOURS[n % len(LINK_COLOURS)], "CONTINUOUS") for n, name in enumerate(moving)}
    document = dxf.create_drawing(
        title or "Linkage", problem.length_unit, LAYERS | colours, frozen="OTHER_POSITIONS", dimensions=True
    )
    # All symbols scale with the drawing; guard against a single point.
    size = max(_find_box(scene, demanded).diagonal, np.finfo(np.float64).tiny)
    space = document.modelspace()
    # The first target is drawn last, on top.
    for k in range(len(scene.inputs) - 1, -1, -1):
        _add_links(space, scene, k, size)
    _add_ground(space, scene, size)
    for points in scene.paths:
        _add_curve(space, points, "COUPLER_CURVE", size)
    _add_curve(space, scene.used, "USED_CURVE", size)
    _add_targets(space, demanded, size)
    _add_dimensions(space, scene, size)
    return dxf.write_document(document)


def _find_box(scene: Scene, demanded: list[Demand]) -> Box:
    """Return the box of the content, without the path of P."""
    return Box.enclose(np.array([*scene.list_places(), *(demand.point for demand in demanded)]))


def _name_layer(link: str) -> str:
    return f"LINK_{link.upper()}"


def _add_links(space: Modelspace, scene: Scene, k: int, size: float) -> None:
    """Add the links at one target; at the first target they are on layers of their own."""
    joints = scene.get_joints(k)
    for name, corners in scene.iterate_links(joints):
        layer = _name_layer(name) if k == 0 else "OTHER_POSITIONS"
        if len(corners) == 2:
            dxf.add_line(space, corners[0], corners[1], layer)
        else:
            dxf.add_outline(space, sort_around_middle(corners), layer)
    if k or not joints:
        return
    for name, place in joints.items():
        dxf.add_circle(space, place, PIN_RADIUS * size, "JOINTS")
        dxf.add_words(space, place + NAME_OFFSET * LETTER_HEIGHT * size * (1.0 + 1.0j), name, LETTER_HEIGHT * size)
    for _, place, turned in scene.list_slides(0):
        dxf.add_outline(space, make_block_corners(place, turned, BLOCK_LENGTH * size, BLOCK_HEIGHT * size), "SLIDES")


def _add_ground(space: Modelspace, scene: Scene, size: float) -> None:
    """Add crosses at the fixed pivots, and the lines of slides over all targets."""
    for joint in scene.mechanism.links[GROUND]:
        dxf.add_cross(space, complex(scene.mechanism.joints[joint]), CROSS_ARM * size, "GROUND")
    for slide, low, high in scene.iterate_rails(2.0 * BLOCK_LENGTH * size):
        dxf.add_line(space, low, high, "GROUND" if slide.link == GROUND else "SLIDES")


def _add_curve(space: Modelspace, points: Complex, layer: str, size: float) -> None:
    """Add a path as a cubic spline through its points."""
    kept = points[np.isfinite(points)]
    if len(kept) < 4 or float(np.ptp(kept.real) + np.ptp(kept.imag)) > MAX_CURVE_EXTENT * size:
        return
    # Coincident points would break the interpolation.
    apart = np.append(np.abs(np.diff(kept)) > COINCIDENCE_TOLERANCE * COINCIDENCE_TOLERANCE * size, True)
    kept = kept[apart]
    if len(kept) < 4:
        return
    # Interpolate at unit size, because the library treats lengths below 1e-12 as zero.
    corner = kept[0]
    unit = [(z.real, z.imag, 0.0) for z in ((kept - corner) / size).tolist()]
    back = Matrix44.chain(Matrix44.scale(size), Matrix44.translate(corner.real, corner.imag, 0.0))
    spline = global_bspline_interpolation(unit, degree=3).transform(back)
    space.add_spline(dxfattribs={"layer": layer}).apply_construction_tool(spline)


def _add_targets(space: Modelspace, demanded: list[Demand], size: float) -> None:
    """Add target points as circles, with the direction of the body."""
    for k, demand in enumerate(demanded):
        at = demand.point
        dxf.add_circle(space, at, TARGET_RADIUS * size, "TARGETS")
        if demand.angle is not None:
            dxf.add_line(space, at, at + DIRECTION_LENGTH * size * cmath.exp(1j * demand.angle), "TARGETS")
        dxf.add_words(space, at - NAME_OFFSET * LETTER_HEIGHT * size * (1.0 + 1.0j), str(k + 1), LETTER_HEIGHT * size)


def _add_dimensions(space: Modelspace, scene: Scene, size: float) -> None:
    """Add dimensions from joint to joint of every link at the first target."""
    joints = scene.get_joints(0)
    for listed in scene.mechanism.links.values():
        # A plate is dimensioned along its whole outline, a bar once.
        around = [*listed, listed[0]] if len(listed) > 2 else list(listed)
        for start, end in pairwise(around):
            if joints and abs(joints[end] - joints[start]) > COINCIDENCE_TOLERANCE * size:
                p1, p2 = joints[start], joints[end]
                dimension = space.add_aligned_dim(
                    p1=(p1.real, p1.imag),
                    p2=(p2.real, p2.imag),
                    distance=DIMENSION_OFFSET * size,
                    dimstyle="EZDXF",
                    override={"dimtxt": LETTER_HEIGHT * size, "dimasz": ARROW_SIZE * size,
                              "dimexe": EXTENSION_GAP * size, "dimexo": EXTENSION_GAP * size, "dimdec": 4, "dimzin": 8},
                    dxfattribs={"layer": "DIMENSIONS"},
                )  # fmt: skip
                dimension.render()
