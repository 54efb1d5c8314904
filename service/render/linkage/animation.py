"""A linkage that goes through its cycle as GIF: links, slides, joints and the path of its coupler point."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.mechanism import GROUND
from service.render.linkage.drawing import Scene
from service.render.linkage.scene import scene_of
from service.render.page.animation import (
    FRAMES,
    Stroke,
    animated,
    ring,
)
from service.render.page.svg import Box, Points
from service.render.page.symbols import (
    COUPLER,
    CURVE,
    INK,
    INPUT,
    OUTPUT,
)
from service.render.page.symbols import GROUND as GROUND_COLOUR

CLOSES = 1e-6
"""Distance of the joints at both ends of a cycle, as a share of its size, at which it is a closed one."""

JOINT, BLOCK = 0.011, 0.028
"""Radius of a joint and half the length of a slide's block, as shares of the picture's diagonal."""

FACE = "#f6ece2"


def linkage_animation(design: Any, problem: Any, title: str) -> bytes:
    """A cycle of a linkage design: a full turn over and over, or from toggle to toggle and back."""
    scene = scene_of(design)
    motion = scene.driven(_inputs(scene))
    names = list(motion.joints)
    places = np.array([motion.joints[name][0] for name in names])
    kept = [k for k in range(FRAMES) if np.isfinite(places[:, k]).all()]
    shown = Box.around(np.concatenate([places[:, kept].reshape(-1), *scene.paths]))
    size = shown.diagonal

    def frames() -> Iterator[list[Stroke]]:
        for k in kept:
            joints = {name: complex(places[n, k]) for n, name in enumerate(names)}
            strokes = [Stroke(path[np.isfinite(path)], CURVE, 1.4) for path in scene.paths]
            for name, listed in scene.mechanism.links.items():
                if name != GROUND:
                    strokes.append(_link(scene, name, [joints[joint] for joint in listed]))
            for slide in scene.mechanism.slides:
                turned = float(slide.angle)
                if slide.link != GROUND:
                    turned += float(motion.angles[slide.link][0, k] - scene.mechanism.link_angle(slide.link))
                strokes.append(_block(joints[slide.joint], turned, BLOCK * size))
            for name, at in joints.items():
                fixed = name in scene.mechanism.links[GROUND]
                radius = (1.3 if fixed else 1.0) * JOINT * size
                colour = GROUND_COLOUR if fixed else INK
                strokes.append(Stroke(ring(at, radius), colour, 1.6, closed=True, fill="#ffffff"))
            yield strokes

    return animated(frames(), shown.grown(BLOCK * size))


def _inputs(scene: Scene) -> NDArray[np.float64]:
    """Equal steps of a cycle that closes; there and back, slowly at the ends, through one that does not."""
    ends = scene.driven(np.array([scene.low, scene.high]))
    places = np.array([jet[0] for jet in ends.joints.values()])
    size = float(np.ptp(places.real) + np.ptp(places.imag))
    share = np.arange(FRAMES) / FRAMES
    if np.abs(places[:, 0] - places[:, 1]).max() > CLOSES * size:
        share = 0.5 - 0.5 * np.cos(math.tau * share)
    return np.asarray(scene.low + (scene.high - scene.low) * share)


def _link(scene: Scene, name: str, corners: list[complex]) -> Stroke:
    """A bar between two joints, a plate between three or more."""
    colour = INPUT if scene.mechanism.input == name else COUPLER if name == "coupler" else OUTPUT
    points: Points = np.array(corners)
    if len(corners) == 2:
        return Stroke(points, colour, 4.0)
    return Stroke(points[np.argsort(np.angle(points - points.mean()))], colour, 2.2, closed=True, fill=FACE)


def _block(at: complex, turned: float, half: float) -> Stroke:
    along = complex(math.cos(turned), math.sin(turned))
    corners = np.array([complex(x * half, 0.6 * y * half) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    return Stroke(at + along * corners, OUTPUT, 1.8, closed=True, fill="#ffffff")
