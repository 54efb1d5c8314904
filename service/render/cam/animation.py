"""Animations of cams: a cam turns under its follower, whose roller rolls without slip; a barrel's groove passes its
roller.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from kinematics.arrays import Complex
from kinematics.cam.profile import space_angles
from service.render.cam.scene import CamScene
from service.render.cam.view import STEM_LENGTH
from service.render.page.animation import FRAME_COUNT, Stroke, draw_gif, make_circle
from service.render.page.svg import Box
from service.render.page.symbols import COUPLER, CURVE, GREY, GROUND, INPUT, OUTPUT, PALE
from synthesis.kinds.cam.design import BarrelCamDesign, CamDesign
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.profile import read_points

CAM_FILL, ROLLER_FILL = "#e8eef6", "#f8eee2"

SPOKE_COUNT = 3
"""Number of lines through a roller that show its rotation."""

MARK_LENGTH, HUB_RADIUS, PIVOT_RADIUS = 0.5, 0.05, 0.06
"""Length of the line that shows the cam's rotation, radii of its shaft and of a pivot, as shares of the base radius."""

MIN_HALF_FACE, FACE_CONTACT_RATIO = 0.45, 1.1
"""Minimum half length of a translating face as a share of the base radius; its half length in contact distances."""

BLANK_RATIO = 1.06
"""Radius of the disc with a groove, in maximum radii of the groove's outer wall."""

SPOKE_LENGTH = 0.85
"""Length of a roller's spokes, as a share of its radius."""

STEPS_PER_FRAME = 12
"""Steps per frame in summing the roller's path length along the profile."""


def draw_cam_animation(design: CamDesign, problem: CamProblem, title: str) -> bytes:
    """Draw a turn of the cam as GIF, in the ground's frame, from cam angle 0."""
    scene = CamScene(design.mechanism)
    theta = space_angles(FRAME_COUNT)
    contact = scene.contour.follow(scene.follower, theta, scene.mechanism.rotation)
    turns = np.exp(1j * scene.sense * theta)
    touching = contact.point * turns
    normal = contact.normal * turns
    roller = scene.roller
    radius = roller.roller_radius if roller else 0.0
    # The roller's centre lies on the normal at the contact.
    centre = touching + radius * normal
    # A knife edge has no radius and does not roll.
    spin = (
        _compute_spin(scene, contact.point, np.unwrap(np.angle(-normal)), radius)
        if radius > 0.0
        else np.zeros(FRAME_COUNT)
    )
    far = float(np.abs(scene.profile if scene.outer_wall is None else scene.outer_wall).max())
    reach = STEM_LENGTH * scene.base_radius
    second = scene.second
    carried = second.find_centres(theta) if second else centre[:0]

    def make_frames() -> Iterator[list[Stroke]]:
        for k in range(FRAME_COUNT):
            strokes = []
            if scene.outer_wall is not None:
                strokes.append(Stroke(make_circle(0j, BLANK_RATIO * far), GREY, 1.2, closed=True, fill=CAM_FILL))
                strokes.append(Stroke(scene.outer_wall * turns[k], INPUT, 2.0, closed=True, fill="#ffffff"))
            strokes.append(Stroke(scene.profile * turns[k], INPUT, 2.4, closed=True, fill=CAM_FILL))
            strokes.append(Stroke(np.array([0j, MARK_LENGTH * scene.base_radius * turns[k]]), INPUT, 2.0))
            strokes.append(
                Stroke(make_circle(0j, HUB_RADIUS * scene.base_radius), GROUND, 1.6, closed=True, fill="#ffffff")
            )
            if radius > 0.0:
                strokes += _draw_roller(complex(centre[k]), radius, float(spin[k]))
            if second is not None:
                other = complex(carried[k] * turns[k])
                strokes.append(Stroke(second.profile * turns[k], OUTPUT, 2.0, closed=True))
                strokes.append(Stroke(make_circle(other, second.follower.roller_radius), COUPLER, 2.2, closed=True))
                strokes.append(
                    Stroke(np.array([other, centre[k] if scene.pivot is None else scene.pivot]), COUPLER, 2.0)
                )
            strokes += _draw_holder(scene, complex(touching[k]), complex(centre[k]), reach)
            yield strokes

    corners: list[Complex] = [
        make_circle(0j, BLANK_RATIO * far if scene.outer_wall is not None else far),
        centre + radius,
        centre + reach,
    ]
    if scene.pivot is not None:
        corners[2] = np.array([scene.pivot])
    if second is not None:
        corners.append(make_circle(0j, float(np.abs(carried).max()) + second.follower.roller_radius))
    return draw_gif(make_frames(), Box.enclose(np.concatenate(corners)))


def _compute_spin(scene: CamScene, point: Complex, toward: np.ndarray, radius: float) -> np.ndarray:
    """Return the roller's angle: its contact travels the same length along roller and profile."""
    # Sum the path in small steps: chords are shorter than arcs.
    fine = space_angles(FRAME_COUNT * STEPS_PER_FRAME)
    closed = scene.contour.follow(scene.follower, fine, scene.mechanism.rotation).point
    travelled = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(closed)))])[::STEPS_PER_FRAME]
    return np.asarray(toward - scene.sense * travelled / radius)


def _draw_roller(centre: complex, radius: float, turned: float) -> list[Stroke]:
    strokes = [Stroke(make_circle(centre, radius), COUPLER, 2.2, closed=True, fill=ROLLER_FILL)]
    for spoke in range(SPOKE_COUNT):
        end = SPOKE_LENGTH * radius * complex(np.exp(1j * (turned + spoke * math.pi / SPOKE_COUNT)))
        strokes.append(Stroke(np.array([centre - end, centre + end]), COUPLER, 1.2))
    return strokes


def _draw_holder(scene: CamScene, touching: complex, centre: complex, reach: float) -> list[Stroke]:
    """Return the carrier of the roller, or the face with its carrier."""
    pivot = scene.pivot
    if pivot is not None:
        held = [(pivot, centre)] if scene.roller is not None else scene.get_arm_face(touching)
        strokes = [Stroke(np.array(ends), COUPLER, width) for ends, width in zip(held, (3.0, 2.0), strict=False)]
        return [
            *strokes,
            Stroke(make_circle(pivot, PIVOT_RADIUS * scene.base_radius), GROUND, 1.8, closed=True, fill="#ffffff"),
        ]
    if scene.roller is not None:
        return [Stroke(np.array([centre, centre + reach]), COUPLER, 3.0)]
    # A face normal to the stem touches at the height of the contact.
    foot = complex(touching.real)
    # The face always reaches beyond its contact.
    half = max(MIN_HALF_FACE * scene.base_radius, FACE_CONTACT_RATIO * abs(touching.imag))
    face = np.array([foot - 1j * half, foot + 1j * half])
    stem = foot + 1j * scene.stem
    return [Stroke(face, COUPLER, 3.0), Stroke(np.array([stem, stem + reach]), COUPLER, 3.0)]


def draw_barrel_animation(design: BarrelCamDesign, problem: CamProblem, title: str) -> bytes:
    """Draw a turn of a barrel cam as GIF: the unrolled groove passes, and the roller moves along the axis."""
    mechanism = design.mechanism
    radius, roller = mechanism.cylinder_radius, mechanism.follower.roller_radius
    turn = math.tau * radius
    walls = [read_points(curve) for curve in (mechanism.lower_wall, mechanism.upper_wall)]
    centre = read_points(mechanism.pitch_curve)
    around = np.radians(mechanism.program.angle)
    low, high = float(walls[0].imag.min()), float(walls[1].imag.max())
    half = 0.5 * turn
    floor, ceiling = low - roller, high + roller

    def make_frames() -> Iterator[list[Stroke]]:
        for theta in space_angles(FRAME_COUNT):
            strokes = [Stroke(np.array([-half + 1j * y, half + 1j * y]), GREY, 1.2) for y in (floor, ceiling)]
            for points, colour, width in ((walls[0], INPUT, 2.4), (walls[1], INPUT, 2.4), (centre, CURVE, 1.0)):
                strokes.append(Stroke(_shift_wall(points, radius * theta, turn), colour, width))
            height = float(np.interp(theta, around, centre.imag, period=math.tau))
            strokes.append(Stroke(np.array([complex(0.0, floor), complex(0.0, ceiling)]), PALE, 1.0))
            # In a rise the lower wall pushes. Between two walls the roller only slides; its rotation is not drawn.
            strokes.append(
                Stroke(make_circle(complex(0.0, height), roller), COUPLER, 2.4, closed=True, fill=ROLLER_FILL)
            )
            yield strokes

    return draw_gif(make_frames(), Box(-half, floor, half, ceiling))


def _shift_wall(points: Complex, moved: float, turn: float) -> Complex:
    """Return a wall over one turn around x = 0, shifted back by a length."""
    # Three copies cover one turn at any shift.
    several = np.concatenate([points + turn * k for k in (-1, 0, 1)]) - moved
    return np.asarray(several[np.abs(several.real) <= 0.5 * turn])
