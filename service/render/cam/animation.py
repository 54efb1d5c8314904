"""A cam that turns under its follower, the roller rolling on it without slip; a barrel's groove passing its roller."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from kinematics.cam.follower import OscillatingFlat, OscillatingRoller
from kinematics.cam.profile import even_angles
from service.render.cam.scene import CamScene
from service.render.cam.view import STEM
from service.render.page.animation import FRAMES, Stroke, animated, ring
from service.render.page.svg import Box, Points
from service.render.page.symbols import COUPLER, CURVE, GREY, GROUND, INPUT, PALE
from synthesis.kinds.cam.design import BarrelCamDesign, CamDesign
from synthesis.kinds.cam.mechanism import points_of
from synthesis.kinds.cam.problem import CamProblem

CAM_FACE, ROLLER_FACE = "#e8eef6", "#f8eee2"

SPOKES = 3
"""Lines through a roller that show how it turns."""

MARK = 0.5
"""Length of the line on the cam that shows how it turns, as a share of the base radius."""


def cam_animation(design: CamDesign, problem: CamProblem, title: str) -> bytes:
    """A turn of the cam as GIF, in the ground's frame; it begins and ends at cam angle 0."""
    scene = CamScene(design.mechanism)
    theta = even_angles(FRAMES)
    contact = scene.contour.follow(scene.follower, theta, scene.mechanism.rotation)
    turns = np.exp(1j * scene.sense * theta)
    touching = contact.point * turns
    normal = contact.normal * turns
    roller = scene.roller
    radius = roller.roller_radius if roller else 0.0
    centre = touching + radius * normal
    spin = _spin(scene, contact.point, np.unwrap(np.angle(-normal)), radius) if radius > 0.0 else np.zeros(FRAMES)
    far = float(np.abs(scene.profile if scene.outer_wall is None else scene.outer_wall).max())
    reach = STEM * scene.base_radius

    def frames() -> Iterator[list[Stroke]]:
        for k in range(FRAMES):
            strokes = []
            if scene.outer_wall is not None:
                strokes.append(Stroke(ring(0j, 1.06 * far), GREY, 1.2, closed=True, fill=CAM_FACE))
                strokes.append(Stroke(scene.outer_wall * turns[k], INPUT, 2.0, closed=True, fill="#ffffff"))
            strokes.append(Stroke(scene.profile * turns[k], INPUT, 2.4, closed=True, fill=CAM_FACE))
            strokes.append(Stroke(np.array([0j, MARK * scene.base_radius * turns[k]]), INPUT, 2.0))
            strokes.append(Stroke(ring(0j, 0.05 * scene.base_radius), GROUND, 1.6, closed=True, fill="#ffffff"))
            if radius > 0.0:
                strokes += _roller(complex(centre[k]), radius, float(spin[k]))
            strokes += _holder(scene, complex(touching[k]), complex(centre[k]), reach)
            yield strokes

    corners: list[Points] = [
        ring(0j, 1.06 * far if scene.outer_wall is not None else far),
        centre + radius,
        centre + reach,
    ]
    if scene.pivot is not None:
        corners[2] = np.array([scene.pivot])
    return animated(frames(), Box.around(np.concatenate(corners)))


def _spin(scene: CamScene, point: Points, toward: np.ndarray, radius: float) -> np.ndarray:
    """How far the roller has turned: its contact has travelled along it as far as along the profile."""
    fine = even_angles(FRAMES * 12)
    closed = scene.contour.follow(scene.follower, fine, scene.mechanism.rotation).point
    travelled = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(closed)))])[::12]
    return np.asarray(toward - scene.sense * travelled / radius)


def _roller(centre: complex, radius: float, turned: float) -> list[Stroke]:
    strokes = [Stroke(ring(centre, radius), COUPLER, 2.2, closed=True, fill=ROLLER_FACE)]
    for spoke in range(SPOKES):
        end = 0.85 * radius * complex(np.exp(1j * (turned + spoke * math.pi / SPOKES)))
        strokes.append(Stroke(np.array([centre - end, centre + end]), COUPLER, 1.2))
    return strokes


def _holder(scene: CamScene, touching: complex, centre: complex, reach: float) -> list[Stroke]:
    """What carries the roller, or the face with what carries it."""
    follower, pivot = scene.follower, scene.pivot
    if isinstance(follower, OscillatingRoller) and pivot is not None:
        return [Stroke(np.array([pivot, centre]), COUPLER, 3.0), *_pivot(pivot, scene.base_radius)]
    if isinstance(follower, OscillatingFlat) and pivot is not None:
        reached = touching - pivot
        foot_distance = math.sqrt(max(abs(reached) ** 2 - follower.face_offset**2, 0.0))
        along = reached / complex(foot_distance, -follower.face_offset * follower.sense)
        start = touching - along * (reached * along.conjugate()).real
        end = touching + 0.35 * scene.base_radius * along
        face = [Stroke(np.array([start, end]), COUPLER, 3.0), Stroke(np.array([start, pivot]), COUPLER, 2.0)]
        return [*face, *_pivot(pivot, scene.base_radius)]
    if scene.roller is not None:
        return [Stroke(np.array([centre, centre + reach]), COUPLER, 3.0)]
    half = 0.45 * scene.base_radius
    foot = complex(touching.real)
    width = max(half, abs(touching.imag) * 1.1)
    face_line = np.array([foot - 1j * width, foot + 1j * width])
    return [Stroke(face_line, COUPLER, 3.0), Stroke(np.array([foot, foot + reach]), COUPLER, 3.0)]


def _pivot(at: complex, size: float) -> list[Stroke]:
    return [Stroke(ring(at, 0.06 * size), GROUND, 1.8, closed=True, fill="#ffffff")]


def barrel_animation(design: BarrelCamDesign, problem: CamProblem, title: str) -> bytes:
    """A turn of a barrel cam as GIF: the unrolled groove passes, and the roller moves along the axis."""
    mechanism = design.mechanism
    radius, roller = mechanism.cylinder_radius, mechanism.follower.roller_radius
    turn = math.tau * radius
    walls = [points_of(curve) for curve in (mechanism.lower_wall, mechanism.upper_wall)]
    centre = points_of(mechanism.pitch_curve)
    around = np.radians(mechanism.program.angle)
    low, high = float(walls[0].imag.min()), float(walls[1].imag.max())
    half = 0.5 * turn
    floor, ceiling = low - roller, high + roller

    def frames() -> Iterator[list[Stroke]]:
        for theta in even_angles(FRAMES):
            strokes = [Stroke(np.array([-half + 1j * y, half + 1j * y]), GREY, 1.2) for y in (floor, ceiling)]
            for points, colour, width in ((walls[0], INPUT, 2.4), (walls[1], INPUT, 2.4), (centre, CURVE, 1.0)):
                strokes.append(Stroke(_passing(points, radius * theta, turn), colour, width))
            height = float(np.interp(theta, around, centre.imag, period=math.tau))
            strokes.append(Stroke(np.array([complex(0.0, floor), complex(0.0, ceiling)]), PALE, 1.0))
            # The wall that pushes is the lower in a rise; between two walls the roller only slides and is not turned.
            strokes.append(Stroke(ring(complex(0.0, height), roller), COUPLER, 2.4, closed=True, fill=ROLLER_FACE))
            yield strokes

    return animated(frames(), Box(-half, floor, half, ceiling))


def _passing(points: Points, moved: float, turn: float) -> Points:
    """A wall over one turn around x = 0, moved back by so much."""
    several = np.concatenate([points + turn * k for k in (-1, 0, 1)]) - moved
    return np.asarray(several[np.abs(several.real) <= 0.5 * turn])
