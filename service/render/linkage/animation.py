"""A linkage moving through its cycle as GIF: links, slides, joints and the path of its coupler point."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.mechanism import GROUND
from service.render.linkage.drawing import Scene, make_block_corners, sort_around_middle
from service.render.linkage.motion import DrivenLinkage
from service.render.page.animation import FRAME_COUNT, Stroke, draw_gif, make_circle
from service.render.page.svg import Box
from service.render.page.symbols import COUPLER, CURVE, INK, INPUT, OUTPUT
from service.render.page.symbols import GROUND as GROUND_COLOUR
from synthesis.model.design_interface import AnyDesign
from synthesis.model.problem import ProblemBase

CLOSURE_TOLERANCE = 1e-6
"""Distance of the joints between both ends of a cycle, as a share of its size, up to which the cycle is closed."""

JOINT_RADIUS, BLOCK_SIZE = 0.011, (0.056, 0.0336)
"""Radius of a joint, and length and width of a slide's block, as shares of the picture's diagonal."""

PLATE_FILL = "#f6ece2"


def draw_linkage_animation(design: AnyDesign, problem: ProblemBase, title: str) -> bytes:
    """Draw a cycle of a linkage design: a full turn in a loop, or from toggle to toggle and back."""
    scene = Scene.from_design(design)
    motion = scene.linkage.drive_over(_choose_inputs(scene.linkage))
    names = list(motion.joints)
    places = np.array([motion.joints[name][0] for name in names])
    # Skip frames in which the linkage cannot be assembled.
    kept = [k for k in range(FRAME_COUNT) if np.isfinite(places[:, k]).all()]
    shown = Box.enclose(np.concatenate([places[:, kept].reshape(-1), *scene.paths]))
    size = shown.diagonal

    def make_frames() -> Iterator[list[Stroke]]:
        for k in kept:
            joints = {name: complex(places[n, k]) for n, name in enumerate(names)}
            strokes = [Stroke(path[np.isfinite(path)], CURVE, 1.4) for path in scene.paths]
            strokes += [_draw_link(scene, name, corners) for name, corners in scene.iterate_links(joints)]
            for slide in scene.mechanism.slides:
                turned = scene.compute_slide_angle(slide, motion, k)
                block = make_block_corners(joints[slide.joint], turned, BLOCK_SIZE[0] * size, BLOCK_SIZE[1] * size)
                strokes.append(Stroke(np.array(block), OUTPUT, 1.8, closed=True, fill="#ffffff"))
            for name, at in joints.items():
                fixed = name in scene.mechanism.links[GROUND]
                # Fixed pivots are drawn larger.
                radius = (1.3 if fixed else 1.0) * JOINT_RADIUS * size
                colour = GROUND_COLOUR if fixed else INK
                strokes.append(Stroke(make_circle(at, radius), colour, 1.6, closed=True, fill="#ffffff"))
            yield strokes

    return draw_gif(make_frames(), shown.grow(0.5 * BLOCK_SIZE[0] * size))


def _choose_inputs(linkage: DrivenLinkage) -> NDArray[np.float64]:
    """Return equal steps of a closed cycle, otherwise steps to the far end and back, slower near the ends."""
    low, high = linkage.cycle
    ends = linkage.drive_over(np.array([low, high]))
    places = np.array([jet[0] for jet in ends.joints.values()])
    size = float(np.ptp(places.real) + np.ptp(places.imag))
    share = np.arange(FRAME_COUNT) / FRAME_COUNT
    # An open cycle goes there and back, slower near its ends.
    if np.abs(places[:, 0] - places[:, 1]).max() > CLOSURE_TOLERANCE * size:
        share = 0.5 - 0.5 * np.cos(math.tau * share)
    return np.asarray(low + (high - low) * share)


def _draw_link(scene: Scene, name: str, corners: list[complex]) -> Stroke:
    """Draw a bar between two joints, or a plate between three or more."""
    colour = INPUT if scene.mechanism.input == name else COUPLER if name == "coupler" else OUTPUT
    if len(corners) == 2:
        return Stroke(np.array(corners), colour, 4.0)
    return Stroke(np.array(sort_around_middle(corners)), colour, 2.2, closed=True, fill=PLATE_FILL)
